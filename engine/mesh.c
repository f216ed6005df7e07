/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/mesh.h"

#include <math.h>

#include "engine/core/key.h"
#include "engine/core/mem.h"
#include "engine/mesh_grade.h"

static void set_cells(pw_mesh *m, pw_idx nx, pw_idx ny)
{
  m->cells[0] = nx;
  m->cells[1] = ny;
  m->nodes[0] = nx + 1;
  m->nodes[1] = ny + 1;
  m->nelem = nx * ny;
  m->nnode = m->nodes[0] * m->nodes[1];
  m->pair_column = nx;
}

/* Columns and rows of the pairs: rows of the fine zone, from its lower end. */
static pw_status set_pairs(const pw_grid *grid, const pw_axis_plan *rows, pw_mesh *m)
{
  if (!m->graded || grid->paired_rows_x_m <= 0.0) {
    return PW_OK;
  }
  const pw_real slack = 1e-6 * m->cell;
  m->pair_column = 0;
  while (m->pair_column < m->cells[0] &&
         m->axis[0].node[m->pair_column] < grid->paired_rows_x_m - slack) {
    m->pair_column++;
  }
  m->pair_row[0] = rows->outer[0];
  m->pair_row[1] = rows->outer[0] + rows->fine / 2 * 2;
  PW_REQUIRE(
      m->pair_column < m->cells[0], PW_ERR_SCENE,
      "grid: paired_rows_x_m = %g m: no line of nodes before the end of the grid lies beyond it",
      grid->paired_rows_x_m);
  return PW_OK;
}

/* The lower row of the pair that cell (i, j) is in. */
static pw_idx lower_row(const pw_mesh *m, pw_idx i, pw_idx j)
{
  return pw_mesh_rows(m, i, j) == 2 ? j - (j - m->pair_row[0]) % 2 : j;
}

pw_status pw_mesh_create(const pw_real *origin, const pw_real *size, pw_real cell, pw_mesh *out)
{
  pw_grid grid = {.origin_m = {origin[0], origin[1]}, .size_m = {size[0], size[1]}, .cell_m = cell};
  return pw_mesh_create_grid(&grid, out);
}

static void destroy_axis(pw_grid_axis *a)
{
  pw_mem_free(&a->node);
  pw_mem_free(&a->size);
  pw_mem_free(&a->inv);
  pw_mem_free(&a->near);
  pw_mem_free(&a->bin);
}

void pw_mesh_destroy(pw_mesh *m)
{
  destroy_axis(&m->axis[0]);
  destroy_axis(&m->axis[1]);
  m->graded = false;
}

/* Sizes of the cells, and the smallest of each and its neighbours. */
static pw_real measure_cells(pw_grid_axis *a)
{
  pw_real smallest = a->node[a->cells] - a->node[0];
  for (pw_idx k = 0; k < a->cells; k++) {
    a->size[k] = a->node[k + 1] - a->node[k];
    a->inv[k] = 1.0 / a->size[k];
    smallest = pw_min(smallest, a->size[k]);
  }
  for (pw_idx k = 0; k < a->cells; k++) {
    pw_real below = a->size[k > 0 ? k - 1 : 0];
    pw_real above = a->size[k + 1 < a->cells ? k + 1 : k];
    a->near[k] = pw_min(a->size[k], pw_min(below, above));
  }
  return smallest;
}

/* Bins with a margin of 1e-7 of their width on both sides, together narrower than any cell. */
static pw_status fill_bins(pw_grid_axis *a, pw_real smallest)
{
  pw_real length = a->node[a->cells] - a->node[0];
  a->nbin = (pw_idx)ceil(length / smallest * (1.0 + 1e-6)) + 1;
  a->inv_bin = (pw_real)a->nbin / length;
  PW_TRY(pw_mem_alloc("grid: bins", a->nbin, sizeof *a->bin, &a->bin));
  pw_idx cell = 0;
  for (pw_idx b = 0; b < a->nbin; b++) {
    pw_real lower = a->node[0] + ((pw_real)b - 1e-7) / a->inv_bin;
    while (cell + 1 < a->cells && lower >= a->node[cell + 1]) {
      cell++;
    }
    a->bin[b] = (pw_grid_bin){cell + 1 < a->cells ? a->node[cell + 1] : PW_HUGE, cell};
  }
  return PW_OK;
}

static pw_status create_axis(const pw_grid *grid, int dir, const pw_axis_plan *plan,
                             pw_grid_axis *a)
{
  a->cells = plan->fine + plan->outer[0] + plan->outer[1];
  PW_TRY(pw_mem_alloc("grid: nodes", (pw_off)a->cells + 1, sizeof *a->node, &a->node));
  PW_TRY(pw_mem_alloc("grid: sizes", a->cells, sizeof *a->size, &a->size));
  PW_TRY(pw_mem_alloc("grid: inverse sizes", a->cells, sizeof *a->inv, &a->inv));
  PW_TRY(pw_mem_alloc("grid: sizes nearby", a->cells, sizeof *a->near, &a->near));
  pw_mesh_grade(grid, dir, plan, a->node);
  return fill_bins(a, measure_cells(a));
}

pw_status pw_mesh_create_grid(const pw_grid *grid, pw_mesh *out)
{
  PW_REQUIRE(grid->cell_m > 0.0 && isfinite(grid->cell_m), PW_ERR_SCENE,
             "grid: cell_m = %g is not a length", grid->cell_m);
  pw_mesh m = {.origin = {grid->origin_m[0], grid->origin_m[1]},
               .cell = grid->cell_m,
               .graded = pw_grid_is_graded(grid)};
  pw_axis_plan plan[2];
  pw_status status = PW_OK;
  for (int a = 0; a < 2; a++) {
    PW_TRY(pw_mesh_plan(grid, a, &plan[a]));
  }
  for (int a = 0; a < 2 && m.graded && status == PW_OK; a++) {
    status = create_axis(grid, a, &plan[a], &m.axis[a]);
  }
  if (status != PW_OK) {
    pw_mesh_destroy(&m);
    return status;
  }
  set_cells(&m, plan[0].fine + plan[0].outer[0] + plan[0].outer[1],
            plan[1].fine + plan[1].outer[0] + plan[1].outer[1]);
  status = set_pairs(grid, &plan[1], &m);
  if (status != PW_OK) {
    pw_mesh_destroy(&m);
    return status;
  }
  *out = m;
  return PW_OK;
}

pw_real pw_mesh_largest_cell(const pw_mesh *m)
{
  pw_real largest = m->cell;
  for (int a = 0; a < 2 && m->graded; a++) {
    for (pw_idx k = 0; k < m->cells[a]; k++) {
      largest = pw_max(largest, m->axis[a].size[k]);
    }
  }
  return largest;
}

static pw_idx locate_graded(const pw_mesh *m, const pw_real *x)
{
  pw_idx k[2];
  for (int a = 0; a < 2; a++) {
    const pw_grid_axis *axis = &m->axis[a];
    if (!(x[a] >= axis->node[0] && x[a] <= axis->node[axis->cells])) {
      return -1;
    }
    k[a] = pw_grid_axis_cell(axis, x[a]);
  }
  return lower_row(m, k[0], k[1]) * m->cells[0] + k[0];
}

pw_idx pw_mesh_locate(const pw_mesh *m, const pw_real *x)
{
  if (m->graded) {
    return locate_graded(m, x);
  }
  pw_idx k[2];
  for (int a = 0; a < 2; a++) {
    pw_real g = (x[a] - m->origin[a]) / m->cell;
    if (!(g >= 0.0 && g <= (pw_real)m->cells[a])) {
      return -1;
    }
    k[a] = (pw_idx)g < m->cells[a] ? (pw_idx)g : m->cells[a] - 1;
  }
  return k[1] * m->cells[0] + k[0];
}

/* Bins of at most PW_CHUNK coordinates of a graded axis, then the cells at those; -1 outside. */
static void locate_along(const pw_grid_axis *a, const pw_real *restrict x, pw_idx n,
                         pw_idx *restrict cell)
{
  const pw_real lower = a->node[0], upper = a->node[a->cells], inv_bin = a->inv_bin;
  const pw_grid_bin *restrict bin = a->bin;
  const pw_idx last = a->nbin - 1;
#pragma omp simd
  for (pw_idx i = 0; i < n; i++) {
    pw_real k = x[i] > lower ? x[i] : lower; /* NaN too */
    pw_idx b = (pw_idx)(((k < upper ? k : upper) - lower) * inv_bin);
    cell[i] = b < last ? b : last;
  }
  for (pw_idx i = 0; i < n; i++) {
    const pw_grid_bin *b = &bin[cell[i]];
    cell[i] = b->cell + (x[i] >= b->split);
  }
#pragma omp simd
  for (pw_idx i = 0; i < n; i++) {
    cell[i] = ((x[i] >= lower) & (x[i] <= upper)) ? cell[i] : -1;
  }
}

void pw_mesh_locate_points(const pw_mesh *m, const pw_real *x, pw_idx ld, pw_idx n, pw_idx *element)
{
  pw_idx kx[PW_CHUNK], ky[PW_CHUNK];
  for (pw_idx i = 0; !m->graded && i < n; i++) {
    const pw_real at[2] = {x[i], x[ld + i]};
    element[i] = pw_mesh_locate(m, at);
  }
  for (pw_idx first = 0; m->graded && first < n; first += PW_CHUNK) {
    const pw_idx count = n - first < PW_CHUNK ? n - first : PW_CHUNK;
    locate_along(&m->axis[0], x + first, count, kx);
    locate_along(&m->axis[1], x + ld + first, count, ky);
    for (pw_idx i = 0; i < count && m->pair_column < m->cells[0]; i++) {
      ky[i] = lower_row(m, kx[i], ky[i]);
    }
#pragma omp simd
    for (pw_idx i = 0; i < count; i++) {
      element[first + i] = ((kx[i] >= 0) & (ky[i] >= 0)) ? ky[i] * m->cells[0] + kx[i] : -1;
    }
  }
}

/* Cell and place in it, 0..1, along an axis; a coordinate outside is moved to the edge. */
static pw_idx place(const pw_mesh *m, int d, pw_real x, pw_real *local)
{
  if (m->graded) {
    const pw_grid_axis *axis = &m->axis[d];
    x = pw_grid_axis_clamp(axis, x);
    pw_idx k = pw_grid_axis_cell(axis, x);
    *local = (x - axis->node[k]) * axis->inv[k];
    return k;
  }
  pw_real g = (x - m->origin[d]) / m->cell;
  g = pw_min(g > 0.0 ? g : 0.0, (pw_real)m->cells[d]);
  pw_idx k = (pw_idx)g < m->cells[d] ? (pw_idx)g : m->cells[d] - 1;
  *local = g - (pw_real)k;
  return k;
}

void pw_mesh_shape(const pw_mesh *m, const pw_real *x, pw_idx *node, pw_real *weight)
{
  pw_idx k[2];
  pw_real a[2];
  for (int d = 0; d < 2; d++) {
    k[d] = place(m, d, x[d], &a[d]);
  }
  node[0] = k[1] * m->nodes[0] + k[0];
  node[1] = node[0] + 1;
  node[2] = node[0] + m->nodes[0];
  node[3] = node[2] + 1;
  weight[0] = (1.0 - a[0]) * (1.0 - a[1]);
  weight[1] = a[0] * (1.0 - a[1]);
  weight[2] = (1.0 - a[0]) * a[1];
  weight[3] = a[0] * a[1];
}
