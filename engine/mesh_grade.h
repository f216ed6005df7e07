/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/mesh_grade.h
 * @brief Sizes of the cells along an axis: a fine zone and geometric growth outwards (layer 3).
 *
 * Cell k = 1, 2, ... outwards from the fine zone is min(cell q^k, cell_max) long. On each side the
 * number of cells is the smallest that can fill it with a ratio q no larger than `growth`, and q
 * the ratio with which that number fills it exactly. The fine zone's cells are exactly cell_m.
 */
#ifndef PW_ENGINE_MESH_GRADE_H
#define PW_ENGINE_MESH_GRADE_H

#include "engine/mesh.h"

/** How an axis is divided; side 0 is below the fine zone, side 1 above it. */
typedef struct pw_axis_plan {
  pw_idx fine;     /**< cells of the fine zone */
  pw_idx outer[2]; /**< cells beyond it */
  pw_real ratio[2];
  pw_real largest; /**< cell; m */
} pw_axis_plan;

/** @brief Whether the grid has a fine zone along some axis. */
bool pw_grid_is_graded(const pw_grid *grid);

/**
 * @brief Divide axis @p a (0 or 1); an axis without a fine zone is all fine.
 * @return PW_OK; PW_ERR_SCENE, the message beginning with the key of the grid that is to blame.
 */
pw_status pw_mesh_plan(const pw_grid *grid, int a, pw_axis_plan *out);

/** @brief Coordinates of the nodes. @param[out] node [cells + 1] m; both ends are exact */
void pw_mesh_grade(const pw_grid *grid, int a, const pw_axis_plan *plan, pw_real *node);

#endif /* PW_ENGINE_MESH_GRADE_H */
