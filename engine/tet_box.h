/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/tet_box.h
 * @brief Tetrahedra that fill a box of equal bricks: meshes for tests and simple cases (layer 3).
 */
#ifndef PW_ENGINE_TET_BOX_H
#define PW_ENGINE_TET_BOX_H

#include "engine/tet_mesh.h"

typedef struct pw_tet_box {
  pw_idx bricks[3];         /**< along each axis, >= 1 */
  pw_real low[3], high[3];  /**< corners of the box; m */
  int per_brick;            /**< 5 (neighbours are mirror images) or 6 (all alike, Kuhn's) */
  int nodes;                /**< of a cell: 10 or 4 */
  pw_tet_diagonal diagonal; /**< with ten nodes */
} pw_tet_box;

/**
 * @brief Nodes and cells of a box, to be freed with pw_tet_box_destroy(); the caller may move
 *        nodes before pw_tet_mesh_create().
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_ARGUMENT for numbers that make no box.
 */
pw_status pw_tet_box_create(const pw_tet_box *box, pw_tet_input *out);

/** @brief Free the arrays of pw_tet_box_create(). */
void pw_tet_box_destroy(pw_tet_input *in);

#endif /* PW_ENGINE_TET_BOX_H */
