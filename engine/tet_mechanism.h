/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/tet_mechanism.h
 * @brief Groups of elements that can move without any strain (layer 3).
 *
 * Elements with points that share faces make up a piece, which can only move as a rigid body
 * without strain. Pieces meet at vertices and edges: every node two pieces share ties three
 * components, every fixed component of a node one. A piece held in all its six motions by fixed
 * components and by pieces already held is held itself; pieces left over are free mechanisms, for
 * which the tangent is singular: one node leaves three turns, an edge leaves one. Two pieces that
 * hold only each other, as the halves of an arch do, are left over as well: what is reported may
 * be held, what is not reported is.
 *
 * Only which components are fixed and which elements hold points count, not stress.
 */
#ifndef PW_ENGINE_TET_MECHANISM_H
#define PW_ENGINE_TET_MECHANISM_H

#include "engine/tet_model.h"

/** What to do about free mechanisms. */
typedef enum pw_mechanisms {
  PW_MECHANISMS_IGNORE, /**< they are not looked for */
  PW_MECHANISMS_WARN,   /**< they are counted */
  PW_MECHANISMS_ERROR,  /**< PW_ERR_SCENE */
} pw_mechanisms;

typedef struct pw_mechanism_report {
  pw_idx pieces;   /**< of elements with points joined by faces */
  pw_idx free;     /**< of them, not held */
  pw_idx elements; /**< in pieces that are not held */
  pw_idx first;    /**< the first such element, or -1 */
  pw_idx motions;  /**< rigid motions left to its piece: 1 to 6 */
} pw_mechanism_report;

/** Scratch of the search; zero it first. */
typedef struct pw_mechanism {
  pw_idx *piece;     /**< [nelem] piece of an element, or -1: no points */
  pw_idx *next;      /**< [nelem] elements of a piece in turn, and a stack */
  pw_idx *held_node; /**< [nnode] 1: a piece that is held has the node */
  pw_idx *first;     /**< [nelem] first element of a piece */
  uint8_t *held;     /**< [nelem] of pieces */
} pw_mechanism;

/** @brief Room for the meshes of @p m. @return PW_OK; PW_ERR_MEMORY. */
pw_status pw_mechanism_create(const pw_tet_model *m, pw_mechanism *out);

/** @brief Free; a zeroed struct is accepted. */
void pw_mechanism_destroy(pw_mechanism *k);

/** @brief Look for pieces that are not held in the step begun by pw_tet_model_begin(). */
void pw_mechanism_find(const pw_tet_model *m, pw_mechanism *k, pw_mechanism_report *out);

#endif /* PW_ENGINE_TET_MECHANISM_H */
