/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/sphere_mesh.h
 * @brief An octant of a hollow sphere in ten-node tetrahedra: its outer triangle divided into rows
 *        of triangles, in shells of prisms of three tetrahedra each.
 */
#ifndef PW_TESTS_SPHERE_MESH_H
#define PW_TESTS_SPHERE_MESH_H

#include "tests/solid_helpers.h"

typedef struct sphere_shape {
  pw_idx radial, round; /* shells through the wall, triangles along an edge of the octant */
  const double *radius; /* [2 radial + 1] of layers of nodes, every second one between shells; m */
} sphere_shape;

/** Number of the point (i, j) of a triangle of points in rows, j <= rows - i. */
static inline pw_idx sphere_surface(pw_idx rows, pw_idx i, pw_idx j)
{
  return i * (rows + 1) - i * (i - 1) / 2 + j;
}

/** Three tetrahedra of a prism over the triangle of corners (i, j) in @p at, ascending by number; the
 *  lattice has points at corners and at middles of edges. */
static inline void sphere_prism(pw_idx rows, pw_idx shell, pw_idx at[3][2], pw_idx *cell)
{
  static const int ends[10][2] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1},
                                  {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  static const int part[3][4][2] = {{{0, 0}, {1, 0}, {2, 0}, {2, 1}},
                                    {{0, 0}, {1, 0}, {1, 1}, {2, 1}},
                                    {{0, 0}, {0, 1}, {1, 1}, {2, 1}}};
  const pw_idx layer = (rows + 1) * (rows + 2) / 2;
  for (int t = 0; t < 3; t++) {
    for (int k = 0; k < 10; k++) {
      const int *a = part[t][ends[k][0]], *b = part[t][ends[k][1]];
      const pw_idx i = at[a[0]][0] + at[b[0]][0], j = at[a[0]][1] + at[b[0]][1];
      cell[10 * t + k] = (2 * shell + a[1] + b[1]) * layer + sphere_surface(rows, i, j);
    }
  }
}

/** Swap two corners, and the middles that belong to them, of cells that are inside out. */
static inline void sphere_orient(const pw_tet_input *in, pw_idx *cell)
{
  static const int swap[3][2] = {{2, 3}, {6, 7}, {5, 8}};
  const pw_idx n = in->nnode;
  for (pw_idx k = 0; k < in->ncell; k++) {
    pw_idx *p = cell + 10 * k;
    double d[3][3];
    for (int i = 0; i < 3; i++) {
      for (pw_idx c = 0; c < 3; c++) {
        d[i][c] = in->x[c * n + p[i + 1]] - in->x[c * n + p[0]];
      }
    }
    double volume = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
                    d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
                    d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
    for (int i = 0; volume < 0.0 && i < 3; i++) {
      const pw_idx keep = p[swap[i][0]];
      p[swap[i][0]] = p[swap[i][1]];
      p[swap[i][1]] = keep;
    }
  }
}

static inline void sphere_cells(const sphere_shape *c, pw_idx *cell)
{
  const pw_idx m = c->round;
  for (pw_idx shell = 0; shell < c->radial; shell++) {
    for (pw_idx i = 0; i < m; i++) {
      for (pw_idx j = 0; i + j < m; j++) {
        pw_idx up[3][2] = {{i, j}, {i, j + 1}, {i + 1, j}};
        sphere_prism(2 * m, shell, up, cell);
        cell += 30;
        if (i + j + 1 < m) {
          pw_idx down[3][2] = {{i, j + 1}, {i + 1, j}, {i + 1, j + 1}};
          sphere_prism(2 * m, shell, down, cell);
          cell += 30;
        }
      }
    }
  }
}

/** Direction of the point (i, j) of a triangle of points in @p rows. */
static inline void sphere_direction(pw_idx rows, pw_idx i, pw_idx j, double *v)
{
  const double at[3] = {(double)i, (double)j, (double)(rows - i - j)};
  const double r = sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]);
  for (int k = 0; k < 3; k++) {
    v[k] = at[k] / r;
  }
}

static inline pw_status sphere_mesh(const sphere_shape *c, pw_tet_mesh *out)
{
  const pw_idx rows = 2 * c->round, layer = (rows + 1) * (rows + 2) / 2;
  pw_tet_input in = {.nodes = 10, .nnode = layer * (2 * c->radial + 1)};
  in.ncell = 3 * c->radial * c->round * c->round;
  pw_real *x = malloc(3 * (size_t)in.nnode * sizeof *x);
  pw_idx *cell = malloc(10 * (size_t)in.ncell * sizeof *cell);
  PW_REQUIRE(x && cell, PW_ERR_MEMORY, "%d nodes", (int)in.nnode);
  for (pw_idx l = 0; l <= 2 * c->radial; l++) {
    for (pw_idx i = 0; i <= rows; i++) {
      for (pw_idx j = 0; i + j <= rows; j++) {
        double v[3];
        sphere_direction(rows, i, j, v);
        for (pw_idx k = 0; k < 3; k++) {
          x[k * in.nnode + l * layer + sphere_surface(rows, i, j)] = c->radius[l] * v[k];
        }
      }
    }
  }
  sphere_cells(c, cell);
  in.x = x;
  in.cell = cell;
  solid_straighten(&in, x);
  sphere_orient(&in, cell);
  pw_status s = pw_tet_mesh_create(&in, out);
  free(x);
  free(cell);
  return s;
}

#endif /* PW_TESTS_SPHERE_MESH_H */
