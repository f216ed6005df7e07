/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/nodes.h
 * @brief Nodal records of each velocity field (layer 3).
 *
 * A node of a field is one record of PW_NODE reals, one cache line, so that a vertex scatters to
 * it with one vector operation. With a contact effect each body has its own velocity field; the
 * record of node k of field f is at rec[(f * nnode + k) * PW_NODE]. What a slot holds changes in
 * the course of a step (engine/step_explicit.c):
 *
 *   slot                      after P2G        after momentum update     after remap (MUSL)
 *   PW_NODE_MASS              mass             mass                      mass
 *   PW_NODE_VEL, +1           momentum         velocity at t(n+1)        same
 *   PW_NODE_FORCE, +1         force            velocity at t(n), later   same
 *                                              increment of velocity
 *   PW_NODE_REMAP, +1         0                0                         remapped velocity
 *   PW_NODE_ACTIVE            0                1 when mass > cut-off     same
 *
 * With two terms of the mass matrix (engine/full_mass.h) VEL and the increment have the second term
 * from before the remap on, and without remap REMAP keeps v(n+1) of lumped masses.
 *
 * A field seldom fills the grid: the pile's has a tenth of its nodes. Loops run over groups of
 * PW_NODE_GROUP records that are in use, which are those within reach of an element that held a
 * point at the last sort (pw_nodes_reset, pw_nodes_use: engine/ranges.c) and those of interface
 * lines. Nothing may be scattered to the others, no step clears them, and nobody may read more of
 * them than that they have no mass.
 */
#ifndef PW_ENGINE_NODES_H
#define PW_ENGINE_NODES_H

#include "engine/core/status.h"

enum {
  PW_NODE = 8,        /**< reals in a record */
  PW_NODE_MASS = 0,   /**< kg (per metre or radian) */
  PW_NODE_VEL = 1,    /**< kg m/s, then m/s */
  PW_NODE_FORCE = 3,  /**< N, then m/s: see above */
  PW_NODE_REMAP = 5,  /**< kg m/s, then m/s */
  PW_NODE_ACTIVE = 7, /**< 1.0 or 0.0 */
  PW_NODE_GROUP = 8   /**< records that are in use together */
};

typedef struct pw_nodes {
  pw_idx nnode; /**< nodes of the grid */
  int nfield;   /**< velocity fields */
  pw_real *rec; /**< [nfield][nnode][PW_NODE] */
  pw_off count; /**< records: nfield * nnode */
  pw_idx ngroup, nused;
  pw_idx *used;  /**< [nused] groups in use: group g has the records [g, g + 1) * PW_NODE_GROUP */
  bool *in_use;  /**< [ngroup] */
  pw_idx *place; /**< [ngroup] of a group that is in use, its place in used */
} pw_nodes;

/** @brief All records zero and in use. @return PW_OK; PW_ERR_ARGUMENT; PW_ERR_MEMORY. */
pw_status pw_nodes_create(pw_idx nnode, int nfield, pw_nodes *out);
void pw_nodes_destroy(pw_nodes *nodes);

/** @brief Records of field @p f: [nnode][PW_NODE]. */
static inline pw_real *pw_nodes_field(const pw_nodes *nodes, int f)
{
  return nodes->rec + (pw_off)f * nodes->nnode * PW_NODE;
}

/** @brief All records zero, none in use. */
void pw_nodes_reset(pw_nodes *nodes);

/** @brief Nodes [first, first + n) of field @p f are in use from now on; those that were not are
 *  zero. Serial: for set-up, sorts, and lines of some hundred nodes. */
void pw_nodes_use(pw_nodes *nodes, int f, pw_idx first, pw_idx n);

/** @brief Whether node @p k of field @p f is in use. */
static inline bool pw_nodes_in_use(const pw_nodes *nodes, int f, pw_idx k)
{
  return nodes->in_use[((pw_off)f * nodes->nnode + k) / PW_NODE_GROUP];
}

/** @brief Whether it is among groups [first, last) in use: those of a part (pw_nodes_part). */
static inline bool pw_nodes_in_part(const pw_nodes *nodes, int f, pw_idx k, pw_idx first,
                                    pw_idx last)
{
  const pw_off group = ((pw_off)f * nodes->nnode + k) / PW_NODE_GROUP;
  return nodes->in_use[group] && nodes->place[group] >= first && nodes->place[group] < last;
}

/** @brief The first node of field @p f after the group of node @p k; at most nnode. */
static inline pw_idx pw_nodes_group_end(const pw_nodes *nodes, int f, pw_idx k)
{
  const pw_off at = (pw_off)f * nodes->nnode;
  const pw_off end = ((at + k) / PW_NODE_GROUP + 1) * PW_NODE_GROUP - at;
  return end < nodes->nnode ? (pw_idx)end : nodes->nnode;
}

/** @brief Records [*first, *last) of the @p i-th group in use. */
static inline void pw_nodes_group(const pw_nodes *nodes, pw_idx i, pw_off *first, pw_off *last)
{
  *first = (pw_off)nodes->used[i] * PW_NODE_GROUP;
  *last = *first + PW_NODE_GROUP < nodes->count ? *first + PW_NODE_GROUP : nodes->count;
}

/** @brief Groups in use [*first, *last) of one of @p parts; part 0 has those that were put in use
 *  last, at the top of the grid or its right, but for a few of lines (partition/share.h). */
void pw_nodes_part(const pw_nodes *nodes, int part, int parts, pw_idx *first, pw_idx *last);

/** @brief Set every record in use to zero. */
void pw_nodes_clear(pw_nodes *nodes);

/** @brief The same for one of @p parts of the records in use. */
void pw_nodes_clear_part(pw_nodes *nodes, int part, int parts);

/**
 * @brief Momentum to velocity, forces to the step's velocity: v(n) = p/m, v(n+1) = v(n) + dt f/m.
 * @param[in] cut_off nodes with less mass take no part: velocity zero, not active; kg
 */
void pw_nodes_momentum_part(pw_nodes *nodes, pw_real dt, pw_real cut_off, int part, int parts);

/** @brief After the constraints: slot FORCE becomes v(n+1) - v(n), what the points receive.
 *  One of @p parts of the records in use. */
void pw_nodes_increment_part(pw_nodes *nodes, int part, int parts);

/** @brief Remapped momentum to velocity (MUSL); one of @p parts of the records in use. */
void pw_nodes_remap_part(pw_nodes *nodes, int part, int parts);

#endif /* PW_ENGINE_NODES_H */
