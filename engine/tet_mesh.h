/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/tet_mesh.h
 * @brief Background mesh of linear tetrahedra in patches, at rest or moving as one (layer 3).
 *
 * A patch is the eight linear tetrahedra of one ten-node tetrahedron, or a single linear one.
 * Elements per * p .. per * p + per - 1 make up patch p.
 *
 * Nodes of a ten-node tetrahedron: corners 0 1 2 3, then the middles of the edges 0-1 1-2 2-0 0-3
 * 1-3 2-3 as 4 5 6 7 8 9 (VTK's order; gmsh swaps the last two). The tetrahedra at the corners
 * are (0 4 6 7) (1 5 4 8) (2 6 5 9) (3 8 7 9); what is left between the middles of the edges is an
 * octahedron, divided into four around one of its three diagonals: between the middles of edges
 * 0-1 and 2-3 (4-9), 1-2 and 0-3 (5-7), or 2-0 and 1-3 (6-8). Edges are taken as straight: the
 * middles are used where they are, and a middle off its chord is an error.
 */
#ifndef PW_ENGINE_TET_MESH_H
#define PW_ENGINE_TET_MESH_H

#include "partition/tets.h"
#include "partition/walk.h"

/** The inner diagonal of the octahedron in a ten-node tetrahedron. */
typedef enum pw_tet_diagonal {
  PW_TET_DIAGONAL_SHORTEST, /**< of those equally long within 1e-9 the first of the three below */
  PW_TET_DIAGONAL_49,
  PW_TET_DIAGONAL_57,
  PW_TET_DIAGONAL_68,
  PW_TET_DIAGONAL_ALONG_X, /**< the one most nearly parallel to x; ties as for the shortest */
  PW_TET_DIAGONAL_ALONG_Y,
  PW_TET_DIAGONAL_ALONG_Z,
} pw_tet_diagonal;

/** Elements as a mesh file or generator gives them; arrays borrowed. */
typedef struct pw_tet_input {
  pw_idx nnode;
  const pw_real *x;         /**< [3][nnode] m */
  pw_idx ncell;             /**< ten-node or linear tetrahedra */
  int nodes;                /**< of a cell: 10 or 4 */
  const pw_idx *cell;       /**< [ncell][nodes] */
  pw_tet_diagonal diagonal; /**< with ten nodes */
} pw_tet_input;

typedef struct pw_tet_mesh {
  pw_tets tets;       /**< elements at the start, neighbours, inverse matrices */
  pw_idx npatch;      /**< patches */
  pw_idx per;         /**< elements of a patch: 8 or 1 */
  pw_idx patch_nodes; /**< nodes of a patch: 10 or 4 */
  pw_idx *patch_node; /**< [npatch][patch_nodes] */
  int8_t *local;      /**< [nelem][4] place of an element's node in patch_node of its patch */
  pw_idx nface;       /**< faces on the boundary */
  pw_idx *face;       /**< [nface] 4 e + f, ascending */
  pw_motion motion;   /**< from the start */
  pw_real *x;         /**< [3][nnode] coordinates now; m */
} pw_tet_mesh;

/**
 * @brief Divide the cells and build all tables.
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_ARGUMENT as pw_tets_create(), or for a cell of another
 *         number of nodes, an unknown diagonal, or a middle node further than 1e-6 edge lengths
 *         from the middle of its edge.
 */
pw_status pw_tet_mesh_create(const pw_tet_input *in, pw_tet_mesh *out);

/** @brief Free; a zeroed struct is accepted. */
void pw_tet_mesh_destroy(pw_tet_mesh *m);

/**
 * @brief Put the mesh where turning, stretching and shifting it as one from its start takes it; only
 *        coordinates change, the inverse matrices are kept.
 * @param[in] map   [9] row-major, of positive determinant: a rotation, a stretch
 * @param[in] shift [3] m: x = map X + shift
 * @return PW_OK; PW_ERR_ARGUMENT when map turns the mesh inside out or flattens it.
 */
pw_status pw_tet_mesh_move(pw_tet_mesh *m, const pw_real *map, const pw_real *shift);

/** @brief Gradients [4][3] of the shape functions of element @p e where the mesh is now; 1/m. */
void pw_tet_mesh_gradients(const pw_tet_mesh *m, pw_idx e, pw_real *gradient);

/** @brief Rotation matrix [9] by @p angle (rad) around @p axis [3] (any length, not zero). */
void pw_rotation_about(const pw_real *axis, pw_real angle, pw_real *rot);

#endif /* PW_ENGINE_TET_MESH_H */
