/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/mesh.h
 * @brief The background grid: structured square cells (layer 3).
 *
 * Node (i, j) is number j * nodes[0] + i, element (i, j) is j * cells[0] + i, both from the lower
 * left corner, x first.
 */
#ifndef PW_ENGINE_MESH_H
#define PW_ENGINE_MESH_H

#include "engine/core/status.h"

typedef struct pw_mesh {
  pw_real origin[2]; /**< lower left corner; m */
  pw_real cell;      /**< edge of a cell; m */
  pw_idx cells[2];   /**< cells along x and y */
  pw_idx nodes[2];   /**< nodes along x and y: cells + 1 */
  pw_idx nelem;
  pw_idx nnode;
} pw_mesh;

/**
 * @brief A grid of @p size metres with square cells.
 * @param[in] origin [2] m
 * @param[in] size   [2] m; a whole number of cells to 1e-6 of a cell
 * @return PW_OK; PW_ERR_SCENE when size is not a whole number of cells or there are too many.
 */
pw_status pw_mesh_create(const pw_real *origin, const pw_real *size, pw_real cell, pw_mesh *out);

/** @brief Element that holds @p x [2], or -1 outside. On a shared edge: the upper/right element,
 *  on the grid's far edges: the last one. */
pw_idx pw_mesh_locate(const pw_mesh *m, const pw_real *x);

static inline pw_real pw_mesh_node_x(const pw_mesh *m, pw_idx node)
{
  return m->origin[0] + m->cell * (pw_real)(node % m->nodes[0]);
}

static inline pw_real pw_mesh_node_y(const pw_mesh *m, pw_idx node)
{
  return m->origin[1] + m->cell * (pw_real)(node / m->nodes[0]);
}

/**
 * @brief Bilinear shape functions at @p x [2].
 * @param[out] node   [4] lower left, lower right, upper left, upper right
 * @param[out] weight [4] sum 1; a point outside is first moved to the nearest place inside
 */
void pw_mesh_shape(const pw_mesh *m, const pw_real *x, pw_idx *node, pw_real *weight);

#endif /* PW_ENGINE_MESH_H */
