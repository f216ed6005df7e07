/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A rectangle with points_per_cell n: its part of each grid cell is divided into equal domains, n
 * by n of them in a whole cell, and in a cell that its edge cuts as many as keep them no larger
 * than those. So domains follow the grading of the grid, none lies across two cells, and edges of
 * neighbours are computed from the same numbers and meet exactly.
 */
#include "engine/bodies_shapes.h"

#include <math.h>

static const pw_real same =
    1e-9; /* of a cell: a rectangle that only touches it does not enter it */

typedef struct {
  const pw_mesh *mesh;
  const pw_scene_body *b;
  pw_idx first[2], last[2]; /* cells that the rectangle enters: [first, last) along each axis */
} cover;

static const pw_real *side_of(const pw_scene_body *b, int a)
{
  return a == 0 ? b->x_m : b->y_m;
}

static pw_real node_at(const pw_mesh *m, int a, pw_idx k)
{
  return a == 0 ? pw_mesh_node_x(m, k) : pw_mesh_node_y(m, k * m->nodes[0]);
}

/* Part of cell k that lies within the rectangle, and its share of the cell. */
static pw_real part_of(const cover *c, int a, pw_idx k, pw_real *part)
{
  const pw_real *side = side_of(c->b, a);
  pw_real low = node_at(c->mesh, a, k), high = node_at(c->mesh, a, k + 1);
  pw_real slack = same * (high - low);
  part[0] = side[0] > low + slack ? side[0] : low;
  part[1] = side[1] < high - slack ? side[1] : high;
  if (k == c->first[a]) {
    part[0] = side[0];
  }
  if (k == c->last[a] - 1) {
    part[1] = side[1];
  }
  return (part[1] - part[0]) / (high - low);
}

static void find_cells(cover *c)
{
  for (int a = 0; a < 2; a++) {
    const pw_real *side = side_of(c->b, a);
    pw_idx k = 0, n = c->mesh->cells[a];
    while (k < n - 1 && node_at(c->mesh, a, k + 1) <= side[0] + same * c->mesh->cell) {
      k++;
    }
    c->first[a] = k;
    while (k < n - 1 && node_at(c->mesh, a, k + 1) < side[1] - same * c->mesh->cell) {
      k++;
    }
    c->last[a] = k + 1;
  }
}

/* Domains across a whole cell: the most that the body or a box it overlaps asks for. */
static int wanted(const pw_scene_body *b, const pw_real x[2], const pw_real y[2])
{
  int n = b->points_per_cell;
  for (int r = 0; r < b->nrefine; r++) {
    const pw_scene_refine *box = &b->refine[r];
    pw_real slack_x = same * (x[1] - x[0]), slack_y = same * (y[1] - y[0]);
    bool overlap = x[0] < box->x_m[1] - slack_x && x[1] > box->x_m[0] + slack_x &&
                   y[0] < box->y_m[1] - slack_y && y[1] > box->y_m[0] + slack_y;
    n = overlap && box->points_per_cell > n ? box->points_per_cell : n;
  }
  return n;
}

static pw_real edge(const pw_real part[2], int k, int n)
{
  return k == n ? part[1] : part[0] + (part[1] - part[0]) * (k / (pw_real)n);
}

/* The same along y of a cell that may be two rows high, from its lower row; rows that the rectangle
 * enters. */
static int part_of_rows(const cover *c, pw_idx i, pw_idx j, pw_real *part, pw_real *share)
{
  const pw_mesh *m = c->mesh;
  const bool lower = (j - m->pair_row[0]) % 2 == 0;
  *share = part_of(c, 1, j, part);
  if (pw_mesh_rows(m, i, j) == 1) {
    return 1;
  }
  if (lower && j + 1 < c->last[1]) {
    pw_real upper[2];
    *share = 0.5 * (*share + part_of(c, 1, j + 1, upper));
    part[1] = upper[1];
    return 2;
  }
  *share *= 0.5;
  return lower || j == c->first[1] ? 1 : 0; /* an upper row belongs to the lower one */
}

static void fill_cell(const cover *c, pw_idx i, pw_idx j, pw_domain_list *list)
{
  pw_real x[2], y[2], share_x = part_of(c, 0, i, x), share_y;
  if (part_of_rows(c, i, j, y, &share_y) == 0) {
    return;
  }
  int n = wanted(c->b, x, y);
  int nx = (int)pw_max(1.0, ceil(n * share_x - 1e-6)),
      ny = (int)pw_max(1.0, ceil(n * share_y - 1e-6));
  for (int l = 0; l < ny; l++) {
    for (int k = 0; k < nx; k++) {
      pw_real x0 = edge(x, k, nx), x1 = edge(x, k + 1, nx);
      pw_real y0 = edge(y, l, ny), y1 = edge(y, l + 1, ny);
      pw_domain_add(list, (pw_real[]){0.5 * (x0 + x1), 0.5 * (y0 + y1)},
                    (pw_real[]){0.5 * (x1 - x0), 0, 0, 0.5 * (y1 - y0)});
    }
  }
}

pw_status pw_body_fill_cells(const pw_scene_body *b, const pw_mesh *mesh, pw_domain_list *list)
{
  cover c = {.mesh = mesh, .b = b};
  find_cells(&c);
  pw_real cells = (pw_real)(c.last[0] - c.first[0]) * (pw_real)(c.last[1] - c.first[1]);
  PW_TRY(pw_body_check_count(b, cells * b->points_per_cell * b->points_per_cell));
  for (pw_idx j = c.first[1]; j < c.last[1]; j++) {
    for (pw_idx i = c.first[0]; i < c.last[0]; i++) {
      fill_cell(&c, i, j, list);
    }
  }
  return PW_OK;
}
