/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/mesh.h
 * @brief The background grid: structured cells, all square or graded along the axes (layer 3).
 *
 * Node (i, j) is number j * nodes[0] + i, element (i, j) is j * cells[0] + i, both from the lower
 * left corner, x first. A graded grid is a product of two axes (engine/mesh_grade.h); a uniform
 * one keeps no tables, and its places are computed from whole numbers.
 */
#ifndef PW_ENGINE_MESH_H
#define PW_ENGINE_MESH_H

#include "engine/core/status.h"
#include "kernels/grid_axis.h"

/** A grid as a scene describes it. */
typedef struct pw_grid {
  pw_real origin_m[2], size_m[2];
  pw_real cell_m;                   /**< of the fine zone, or of the whole grid */
  pw_real fine_x_m[2], fine_y_m[2]; /**< fine zone; equal ends: the whole axis */
  pw_real growth;                   /**< largest ratio of neighbouring cells outside of it */
  pw_real cell_max_m;               /**< largest cell; 0: no limit */
  pw_real paired_rows_x_m; /**< beyond it rows of the fine zone are taken in pairs; 0: nowhere */
} pw_grid;

typedef struct pw_mesh {
  pw_real origin[2]; /**< lower left corner; m */
  pw_real cell;      /**< edge of a cell; of a graded grid: the smallest; m */
  pw_idx cells[2];   /**< cells along x and y */
  pw_idx nodes[2];   /**< nodes along x and y: cells + 1 */
  pw_idx nelem;
  pw_idx nnode;
  bool graded;
  pw_grid_axis axis[2]; /**< of a graded grid */
  pw_idx pair_column;   /**< first column of cells whose rows are in pairs; cells[0]: none */
  pw_idx pair_row[2];   /**< those rows: [first, last), an even number */
} pw_mesh;

/**
 * @brief A uniform grid of @p size metres with square cells; holds no memory.
 * @param[in] origin [2] m
 * @param[in] size   [2] m; a whole number of cells to 1e-6 of a cell
 * @return PW_OK; PW_ERR_SCENE when size is not a whole number of cells or there are too many.
 */
pw_status pw_mesh_create(const pw_real *origin, const pw_real *size, pw_real cell, pw_mesh *out);

/** @brief The grid of a scene, graded when it has a fine zone. Free with pw_mesh_destroy.
 *  @return PW_OK; PW_ERR_SCENE as pw_mesh_plan; PW_ERR_MEMORY. */
pw_status pw_mesh_create_grid(const pw_grid *grid, pw_mesh *out);

/** @brief Free; a zeroed or uniform grid is accepted. */
void pw_mesh_destroy(pw_mesh *m);

/** @brief Element that holds @p x [2], or -1 outside. On a shared edge: the upper/right element,
 *  on the grid's far edges: the last one; of two rows in a pair: the lower. */
pw_idx pw_mesh_locate(const pw_mesh *m, const pw_real *x);

/** @brief The same for @p n points. @param[in] x [2][ld] m @param[out] element [n] */
void pw_mesh_locate_points(const pw_mesh *m, const pw_real *x, pw_idx ld, pw_idx n,
                           pw_idx *element);

static inline pw_real pw_mesh_node_x(const pw_mesh *m, pw_idx node)
{
  pw_idx i = node % m->nodes[0];
  return m->graded ? m->axis[0].node[i] : m->origin[0] + m->cell * (pw_real)i;
}

static inline pw_real pw_mesh_node_y(const pw_mesh *m, pw_idx node)
{
  pw_idx j = node / m->nodes[0];
  return m->graded ? m->axis[1].node[j] : m->origin[1] + m->cell * (pw_real)j;
}

/** @brief Upper end of the grid along axis @p a (0 or 1); m. */
static inline pw_real pw_mesh_end(const pw_mesh *m, int a)
{
  return m->graded ? m->axis[a].node[m->cells[a]] : m->origin[a] + m->cell * m->cells[a];
}

/** @brief Rows that cell (i, j) is high: 2 where rows are in pairs (engine/pairs.h). */
static inline int pw_mesh_rows(const pw_mesh *m, pw_idx i, pw_idx j)
{
  return i >= m->pair_column && j >= m->pair_row[0] && j < m->pair_row[1] ? 2 : 1;
}

/** @brief Whether node (i, j) hangs on those below and above. */
static inline bool pw_mesh_hangs(const pw_mesh *m, pw_idx i, pw_idx j)
{
  return i >= m->pair_column && j > m->pair_row[0] && j < m->pair_row[1] &&
         (j - m->pair_row[0]) % 2 == 1;
}

/** @brief Width and height of an element. @param[out] size [2] m */
static inline void pw_mesh_cell_size(const pw_mesh *m, pw_idx element, pw_real *size)
{
  const pw_idx i = element % m->cells[0], j = element / m->cells[0];
  size[0] = m->graded ? m->axis[0].size[i] : m->cell;
  size[1] = m->graded ? m->axis[1].size[j] * pw_mesh_rows(m, i, j) : m->cell;
}

/** @brief Width and height of the element at @p x [2], outside the grid that of the nearest one.
 *  @param[out] size [2] m */
static inline void pw_mesh_size_at(const pw_mesh *m, const pw_real *x, pw_real *size)
{
  pw_idx k[2] = {0, 0};
  for (int a = 0; a < 2; a++) {
    const pw_grid_axis *axis = &m->axis[a];
    k[a] = m->graded ? pw_grid_axis_cell(axis, pw_grid_axis_clamp(axis, x[a])) : 0;
    size[a] = m->graded ? axis->size[k[a]] : m->cell;
  }
  size[1] *= m->graded ? pw_mesh_rows(m, k[0], k[1]) : 1;
}

/** @brief Smallest edge of the element at @p x [2] and of its neighbours; m. */
static inline pw_real pw_mesh_near_size(const pw_mesh *m, const pw_real *x)
{
  if (!m->graded) {
    return m->cell;
  }
  pw_idx k[2];
  for (int a = 0; a < 2; a++) {
    k[a] = pw_grid_axis_cell(&m->axis[a], pw_grid_axis_clamp(&m->axis[a], x[a]));
  }
  const pw_idx before = k[0] - 1; /* column; two rows up and down there are pairs, too */
  const bool pairs =
      pw_mesh_rows(m, before, k[1] - 2) == 2 && pw_mesh_rows(m, before, k[1] + 2) == 2;
  return pw_min(m->axis[0].near[k[0]], (pairs ? 2.0 : 1.0) * m->axis[1].near[k[1]]);
}

/** @brief Largest edge of any cell; m. */
pw_real pw_mesh_largest_cell(const pw_mesh *m);

/**
 * @brief Bilinear shape functions at @p x [2].
 * @param[out] node   [4] lower left, lower right, upper left, upper right
 * @param[out] weight [4] sum 1; a point outside is first moved to the nearest place inside
 */
void pw_mesh_shape(const pw_mesh *m, const pw_real *x, pw_idx *node, pw_real *weight);

#endif /* PW_ENGINE_MESH_H */
