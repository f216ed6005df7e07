/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Everything is placed on the lattice of half bricks, where corners have even and middles of edges
 * may have odd coordinates; lattice points that no cell uses get no node. */
#include "engine/tet_box.h"

#include <string.h>

#include "engine/core/mem.h"

static const int edge_ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

/* Corners of a brick as bits x, y, z. Five: the regular one inside, then those at its corners. */
static const int five[5][4] = {
    {0, 3, 5, 6}, {1, 0, 3, 5}, {2, 0, 3, 6}, {4, 0, 5, 6}, {7, 3, 5, 6}};
static const int six[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7},
                              {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};

typedef struct {
  const pw_tet_box *box;
  pw_idx points[3]; /* of the lattice */
  pw_idx *number;   /* [points] node + 1 of a lattice point */
  pw_idx *cell;     /* [ncell][nodes] lattice points */
} lattice;

void pw_tet_box_destroy(pw_tet_input *in)
{
  pw_mem_free(&in->x);
  pw_mem_free(&in->cell);
  memset(in, 0, sizeof *in);
}

static pw_status check_box(const pw_tet_box *box)
{
  pw_off n = 1;
  for (int c = 0; c < 3; c++) {
    PW_REQUIRE(box->bricks[c] >= 1 && box->bricks[c] <= 1000, PW_ERR_ARGUMENT,
               "%d bricks along axis %c", (int)box->bricks[c], "xyz"[c]);
    PW_REQUIRE(box->high[c] > box->low[c], PW_ERR_ARGUMENT, "a box from %g to %g m along axis %c",
               box->low[c], box->high[c], "xyz"[c]);
    n *= 2 * box->bricks[c] + 1;
  }
  PW_REQUIRE(n < 1 << 27, PW_ERR_ARGUMENT, "a box of %lld lattice points", (long long)n);
  PW_REQUIRE(box->per_brick == 5 || box->per_brick == 6, PW_ERR_ARGUMENT,
             "%d tetrahedra in a brick: 5 or 6 are known", box->per_brick);
  PW_REQUIRE(box->nodes == 4 || box->nodes == 10, PW_ERR_ARGUMENT,
             "a tetrahedron of %d nodes: 4 or 10 are known", box->nodes);
  return PW_OK;
}

static pw_idx lattice_point(const lattice *l, const pw_idx *at)
{
  return (at[2] * l->points[1] + at[1]) * l->points[0] + at[0];
}

static pw_idx volume_of(pw_idx c[4][3])
{
  pw_idx d[3][3];
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) {
      d[i][k] = c[i + 1][k] - c[0][k];
    }
  }
  return d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
         d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
         d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
}

/* One cell: corners of a brick, bit masks turned over by `mirror`. */
static void add_cell(const lattice *l, const pw_idx *brick, const int *mask, int mirror,
                     pw_idx *cell)
{
  pw_idx c[4][3], middle[3];
  for (int i = 0; i < 4; i++) {
    for (int k = 0; k < 3; k++) {
      c[i][k] = 2 * (brick[k] + ((mask[i] ^ mirror) >> k & 1));
    }
  }
  if (volume_of(c) < 0) {
    for (int k = 0; k < 3; k++) {
      pw_idx swap = c[2][k];
      c[2][k] = c[3][k];
      c[3][k] = swap;
    }
  }
  for (int i = 0; i < 4; i++) {
    cell[i] = lattice_point(l, c[i]);
  }
  for (int i = 4; i < l->box->nodes; i++) {
    const int *end = edge_ends[i - 4];
    for (int k = 0; k < 3; k++) {
      middle[k] = (c[end[0]][k] + c[end[1]][k]) / 2;
    }
    cell[i] = lattice_point(l, middle);
  }
}

static void add_brick(const lattice *l, const pw_idx *brick, pw_idx *cell)
{
  bool odd = (brick[0] + brick[1] + brick[2]) & 1;
  for (int t = 0; t < l->box->per_brick; t++) {
    const int *mask = l->box->per_brick == 5 ? five[t] : six[t];
    add_cell(l, brick, mask, l->box->per_brick == 5 && odd ? 1 : 0, cell + t * l->box->nodes);
  }
}

static pw_idx number_nodes(lattice *l, pw_off n)
{
  pw_idx nnode = 0, npoint = l->points[0] * l->points[1] * l->points[2];
  for (pw_off i = 0; i < n; i++) {
    l->number[l->cell[i]] = 1;
  }
  for (pw_idx p = 0; p < npoint; p++) {
    if (l->number[p]) {
      l->number[p] = ++nnode;
    }
  }
  for (pw_off i = 0; i < n; i++) {
    l->cell[i] = l->number[l->cell[i]] - 1;
  }
  return nnode;
}

static void place_nodes(const lattice *l, pw_idx nnode, pw_real *x)
{
  pw_idx at[3];
  for (at[2] = 0; at[2] < l->points[2]; at[2]++) {
    for (at[1] = 0; at[1] < l->points[1]; at[1]++) {
      for (at[0] = 0; at[0] < l->points[0]; at[0]++) {
        pw_idx node = l->number[lattice_point(l, at)] - 1;
        for (int c = 0; c < 3 && node >= 0; c++) {
          pw_real part = (pw_real)at[c] / (pw_real)(l->points[c] - 1);
          x[(size_t)c * (size_t)nnode + (size_t)node] =
              l->box->low[c] * (1.0 - part) + l->box->high[c] * part;
        }
      }
    }
  }
}

static pw_status build(lattice *l, pw_tet_input *in, pw_real **x)
{
  const pw_idx *n = l->box->bricks;
  pw_idx brick[3], *cell = l->cell;
  for (brick[2] = 0; brick[2] < n[2]; brick[2]++) {
    for (brick[1] = 0; brick[1] < n[1]; brick[1]++) {
      for (brick[0] = 0; brick[0] < n[0]; brick[0]++) {
        add_brick(l, brick, cell);
        cell += l->box->per_brick * l->box->nodes;
      }
    }
  }
  in->nnode = number_nodes(l, (pw_off)in->ncell * in->nodes);
  PW_TRY(pw_mem_alloc("box: coordinates", 3 * (pw_off)in->nnode, sizeof **x, x));
  place_nodes(l, in->nnode, *x);
  return PW_OK;
}

pw_status pw_tet_box_create(const pw_tet_box *box, pw_tet_input *out)
{
  PW_TRY(check_box(box));
  lattice l = {.box = box};
  pw_real *x = NULL;
  pw_off npoint = 1;
  pw_tet_input in = {.nodes = box->nodes, .diagonal = box->diagonal, .ncell = box->per_brick};
  for (int c = 0; c < 3; c++) {
    l.points[c] = 2 * box->bricks[c] + 1;
    npoint *= l.points[c];
    in.ncell *= box->bricks[c];
  }
  pw_status s = pw_mem_alloc("box: lattice", npoint, sizeof *l.number, &l.number);
  if (s == PW_OK) {
    s = pw_mem_alloc("box: cells", (pw_off)in.ncell * in.nodes, sizeof *l.cell, &l.cell);
  }
  if (s == PW_OK) {
    s = build(&l, &in, &x);
  }
  pw_mem_free(&l.number);
  if (s != PW_OK) {
    pw_mem_free(&l.cell);
    return s;
  }
  in.cell = l.cell;
  in.x = x;
  *out = in;
  return PW_OK;
}
