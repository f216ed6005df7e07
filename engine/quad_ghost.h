/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/quad_ghost.h
 * @brief Ghost stabilisation on the grid: cells that hold little material follow their neighbours
 *        (layer 3).
 *
 * As engine/tet_ghost.h: over every edge between two cells that take part, of which one is cut, the
 * jump of the displacement gradient of the part is penalised by
 *
 *   W = gamma/2 sum_edges (V1 + V2)/2 mean |d u_1/dn - d u_2/dn|^2,
 *
 * V the volumes of the cells (per radian), n across the edge, the mean that of the two ends of the
 * edge: a cell's gradient across an edge runs linearly along it. Displacements linear over both
 * cells have no jump. A cell takes part when all its nodes do; it is cut when the volumes of the
 * points in it fill less than half of it, or a cell beside it does not take part.
 */
#ifndef PW_ENGINE_QUAD_GHOST_H
#define PW_ENGINE_QUAD_GHOST_H

#include "engine/quad_pattern.h"

typedef struct pw_quad_model pw_quad_model;

typedef struct pw_quad_ghost {
  pw_real gamma;   /**< Pa; 0: off */
  pw_idx nedge;    /**< edges of the part */
  pw_idx *edge;    /**< [2 nelem] 2 e + a: between e and the next cell along axis a, ascending */
  pw_real *filled; /**< [nelem] volume of the points in a cell, over that of the cell */
  uint8_t *state;  /**< [nelem] bit 1: takes part, bit 2: cut */
} pw_quad_ghost;

/** @brief Memory where the scene asks for it. @return PW_OK; PW_ERR_MEMORY. */
pw_status pw_quad_ghost_create(pw_quad_model *m);
void pw_quad_ghost_destroy(pw_quad_ghost *g);

/** @brief Edges of the part begun, and which nodes they couple; after the weights of nodes. */
void pw_quad_ghost_begin(pw_quad_model *m);

/** @brief Add forces and, when asked for, tangent and lift to those of the model. */
void pw_quad_ghost_add(pw_quad_model *m, const pw_real *u, bool tangent);

#endif /* PW_ENGINE_QUAD_GHOST_H */
