/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/interface.h
 * @brief Interface lines: two-node segments with mass on the surface of a body, their motion in
 *        the body's velocity field, contact history of their nodes (layer 3).
 *
 * Segment k runs from node k to node k + 1 (closed lines: from the last node to the first); the
 * body lies to its left. The line is part of its body: it scatters mass and momentum to the
 * body's velocity field and moves with it. Source: Giridharan 2016, sections 2.6.5-2.6.8.
 */
#ifndef PW_ENGINE_INTERFACE_H
#define PW_ENGINE_INTERFACE_H

#include "engine/mesh.h"
#include "engine/nodes.h"
#include "engine/sim.h"

/** Contact of one slave node, kept from step to step. */
typedef struct pw_touch {
  pw_idx owner;    /**< master segment it is in contact with, -1: none */
  bool fresh;      /**< made by a split: takes its offset at the next search */
  pw_real overlap; /**< effective overlap, -(gap - offset) >= 0; m */
  pw_real offset;  /**< part of the gap that makes no force, <= 0; m */
  pw_real slip;    /**< g_t, stretch of the tangential spring; m */
  pw_real stiff_n; /**< area times normal stiffness of the last step; N/m */
  pw_real stiff_t; /**< area times tangential stiffness of the last step; N/m */
} pw_touch;

/** A node of an interface line. */
typedef struct pw_interface_node {
  pw_real x[2];      /**< m */
  pw_real du[2];     /**< displacement of the last step; m */
  pw_real v[2];      /**< m/s */
  pw_real mass;      /**< kg (per metre or radian) */
  pw_real area;      /**< tributary area; m2 (per metre or radian) */
  pw_real shape[4];  /**< of the four nodes of its element: lower left, right, upper left, right */
  pw_real weight[4]; /**< the same, but nodes with hardly any mass of the body take no part */
  pw_idx node;       /**< lower left node of its element */
  bool tip;          /**< on the tip part of a pile */
  bool axis;         /**< stays at x = 0 */
  pw_touch touch;    /**< of a slave */
} pw_interface_node;

enum { PW_INTERFACE_REALS = 13 /**< reals of a node that a checkpoint keeps */ };

/** A line. All its memory is taken at the start; splits end when it is full. */
typedef struct pw_interface {
  int body; /**< index of its body */
  bool closed;
  bool axi; /**< axisymmetric: areas and masses carry r */
  pw_idx n; /**< nodes now */
  pw_idx capacity;
  pw_idx row;              /**< nodes of the grid along x */
  pw_interface_node *node; /**< [capacity] */
  pw_real *packed;         /**< [capacity][PW_INTERFACE_REALS] scratch of the archive */
  pw_idx *marks;           /**< [capacity][2] likewise */
} pw_interface;

/** How a dragged line is kept even. */
typedef struct pw_refine_rule {
  pw_real longest;  /**< longer segments are split; m */
  pw_real shortest; /**< shorter ones are merged into their neighbours; m */
} pw_refine_rule;

/** What pw_interface_refine() has done; added to. */
typedef struct pw_refine_counts {
  pw_off splits, merges, refused;
  pw_real released; /**< energy of the springs of nodes taken out; J per radian or metre */
} pw_refine_counts;

/**
 * @brief A line through @p n vertices; areas are set, masses and velocities are zero.
 * @param[in] xy   [2 n] pairs; m
 * @param[in] tip  [n] or NULL
 * @param[in] axi  axisymmetric; end nodes of an open line at x = 0 then stay there
 * @param[in] capacity nodes it may grow to, at least @p n
 * @return PW_OK; PW_ERR_ARGUMENT (fewer than 2 nodes, 3 when closed; a segment without length);
 *         PW_ERR_MEMORY.
 */
pw_status pw_interface_create(const pw_real *xy, const bool *tip, pw_idx n, bool closed, bool axi,
                              pw_idx capacity, pw_interface *out);

/**
 * @brief The line of a body of a scene, with mass and initial velocity.
 * @param[in] facing   another body: of a rectangle in axisymmetry only the side towards it is
 *                     taken; -1 takes the whole outline (but for what lies on the axis)
 * @param[in] segment  largest length of a segment; m
 * @param[in] thickness of the layer whose mass the nodes carry; m
 * @return as pw_interface_create(); PW_ERR_SCENE when the body has no outline.
 */
pw_status pw_interface_from_body(const pw_scene *scene, int body, int facing, pw_real segment,
                                 pw_real thickness, pw_interface *out);

/** @brief Free; a zeroed struct is accepted. */
void pw_interface_destroy(pw_interface *line);

/** @brief Number of segments. */
static inline pw_idx pw_interface_segments(const pw_interface *line)
{
  return line->closed ? line->n : line->n - 1;
}

/** @brief Node after node @p k around the line. */
static inline pw_idx pw_interface_next(const pw_interface *line, pw_idx k)
{
  return k + 1 < line->n ? k + 1 : 0;
}

/** @brief Recompute the tributary areas from the present shape. */
void pw_interface_measure(pw_interface *line);

/** @brief Masses: @p surface_density (kg/m2) times the present tributary areas. */
void pw_interface_set_mass(pw_interface *line, pw_real surface_density);

/** @brief Find element and shape functions of every node. */
void pw_interface_locate(pw_interface *line, const pw_mesh *mesh);

/** @brief The grid nodes of all elements with a node of the line are in use (engine/nodes.h), in
 *  field @p f: to be called before the line scatters to it. */
void pw_interface_use(const pw_interface *line, pw_nodes *nodes, int f);

/** @brief Add mass and momentum to the records @p rec of the body's field (slots MASS, VEL). */
void pw_interface_p2g(const pw_interface *line, pw_real *rec);

/**
 * @brief Weights with which nodes exchange force and motion with the grid.
 *
 * The shape functions, faded out on grid nodes that carry less than a fiftieth of the largest
 * mass of the four (so that no force falls on an almost empty node), and scaled to sum 1. All
 * zero where no node of the element is active.
 * @param[in] cut_off mass below which a node is passive; kg
 */
void pw_interface_weights(pw_interface *line, const pw_real *rec, pw_real cut_off);

/** @brief v += sum N dv: the reverse of the scatter of momentum, so that the sum over points and
 *  line is conserved. @param[in] increments slot FORCE holds dv; else v(n), and slot VEL v(n+1) */
void pw_interface_velocity(pw_interface *line, const pw_real *rec, bool increments);

/** @brief Add the nodes' mass times the velocity that slot FORCE has there to slot REMAP. */
void pw_interface_mass(const pw_interface *line, pw_real *rec);

/** @brief Add momentum to slot REMAP. */
void pw_interface_remap(const pw_interface *line, pw_real *rec);

/** @brief x += dt sum w v, with the velocities in slot @p slot; du is renewed, areas are not. Nodes
 *  without weights (a line without mass, off the grid nodes of its body) go with the nearest node
 *  of the line that has some, or the master would pass those that stay behind. */
void pw_interface_move(pw_interface *line, const pw_real *rec, int slot, pw_real dt);

/** @brief Give every node the velocity @p v [2]. */
void pw_interface_set_velocity(pw_interface *line, const pw_real *v);

/** @brief x += dt v with the nodes' own velocities: for a body whose motion is prescribed. */
void pw_interface_move_rigid(pw_interface *line, pw_real dt);

/** @brief Split and merge segments, with mass, momentum and contact history; renews the areas. */
void pw_interface_refine(pw_interface *line, const pw_refine_rule *rule, pw_refine_counts *counts);

/** @brief Save or load under "<name>/". @return as the archive's calls. */
pw_status pw_interface_archive(pw_interface *line, const char *name, pw_archive *ar);

/**
 * @brief Present polylines of a penalty contact, for pictures; closed ones repeat their first node.
 * @param[in]  which 0 master, 1 slave
 * @param[out] xy    [2 max] pairs; m
 * @return nodes written; 0 without a penalty contact; -1 when @p max is too small.
 */
int pw_contact_outline(const pw_sim *sim, int which, pw_real *xy, int max);

#endif /* PW_ENGINE_INTERFACE_H */
