/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/cook_helpers.h
 * @brief Cook's membrane at finite strain, nearly incompressible: plane strain, unit thickness.
 *
 * Corners (0, 0) (48, 44) (48, 60) (0, 44); the left edge is clamped, the right edge bears a shear
 * of 100 in all, 6.25 per area. Neo-Hookean, mu = 80.1938, K = 40.0942e4. Source of the set: de Souza
 * Neto, Andrade Pires, Owen, Int. J. Numer. Meth. Engng 62 (2005) 353-383.
 */
#ifndef PW_TESTS_COOK_HELPERS_H
#define PW_TESTS_COOK_HELPERS_H

#include "tests/solid_helpers.h"

/** Of the top corner, from mixed quadratic triangles of an independent program, n -> infinity. */
#define COOK_TOP 6.925

static inline void cook_map(const void *ctx, pw_real *x)
{
  const double along = x[0], up = x[1];
  (void)ctx;
  x[0] = 48.0 * along;
  x[1] = 44.0 * along + up * (44.0 - 28.0 * along);
}

/** Dead load 6.25 per area of the faces at x = 48, upwards. */
static inline void cook_load(solid *s)
{
  const pw_tets *t = &s->mesh.tets;
  const pw_idx n = s->nnode;
  for (pw_idx l = 0; l < s->mesh.nface; l++) {
    const pw_idx *node = t->node + 4 * (s->mesh.face[l] / 4);
    const int *face = pw_tet_face[s->mesh.face[l] % 4];
    const pw_idx a = node[face[0]], b = node[face[1]], c = node[face[2]];
    if (s->x[a] < 47.999 || s->x[b] < 47.999 || s->x[c] < 47.999) {
      continue;
    }
    const double *y = s->x + n, *z = s->x + 2 * n;
    double area = 0.5 * fabs((y[b] - y[a]) * (z[c] - z[a]) - (y[c] - y[a]) * (z[b] - z[a]));
    s->load[n + a] += 6.25 * area / 3.0;
    s->load[n + b] += 6.25 * area / 3.0;
    s->load[n + c] += 6.25 * area / 3.0;
  }
}

/** @p n bricks of six ten-node tetrahedra along each edge. */
static inline pw_status cook_start(solid *s, pw_idx n, pw_fbar fbar)
{
  const double thick = 48.0 / n;
  pw_tet_box box = {.bricks = {n, n, 1}, .high = {1.0, 1.0, thick}, .per_brick = 6, .nodes = 10};
  memset(s, 0, sizeof *s);
  s->approach = 8;
  s->material.model = pw_material_find("neo_hookean");
  solid_set(&s->material, "bulk_modulus_pa", 40.0942e4);
  solid_set(&s->material, "shear_modulus_pa", 80.1938);
  solid_set(&s->material, "density_kg_m3", 1.0);
  PW_TRY(solid_mesh(&box, cook_map, NULL, &s->mesh));
  PW_TRY(solid_start(s, fbar, 1, NULL));
  for (int c = 0; c < 3; c++) {
    solid_hold(s, c, 0, 0.0, 1e-9);
  }
  solid_hold(s, 2, 2, 0.0, 1e-9);
  solid_hold(s, 2, 2, thick, 1e-9);
  cook_load(s);
  return PW_OK;
}

/** Displacement [3] over the last step of the node at (@p x, @p y) on the near face. */
static inline void cook_displacement(const solid *s, double x, double y, double *out)
{
  const double *u = pw_newton_displacement(s->newton);
  const pw_idx n = s->nnode;
  for (pw_idx a = 0; a < n; a++) {
    if (fabs(s->x[a] - x) + fabs(s->x[n + a] - y) + fabs(s->x[2 * n + a]) < 1e-9) {
      for (pw_idx c = 0; c < 3; c++) {
        out[c] = u[c * n + a];
      }
    }
  }
}

/** Checkerboard index: rms of the difference in pressure between elements that share a face, over the
 *  rms pressure; between elements of one patch, and of two. */
static inline void cook_checkerboard(const solid *s, double *inside, double *across)
{
  const pw_tets *t = &s->mesh.tets;
  const pw_tet_points *p = &s->model.points; /* one in each element, in their order */
  double square = 0.0, sum[2] = {0.0, 0.0};
  pw_idx count[2] = {0, 0};
  for (pw_idx e = 0; e < t->nelem; e++) {
    const double mine = p->stress[e] + p->stress[p->ld + e] + p->stress[2 * p->ld + e];
    square += mine * mine;
    for (pw_idx f = 0; f < 4; f++) {
      const pw_idx o = t->beside[4 * e + f];
      if (o > e) {
        double d = mine - p->stress[o] - p->stress[p->ld + o] - p->stress[2 * p->ld + o];
        sum[o / s->mesh.per != e / s->mesh.per] += d * d;
        count[o / s->mesh.per != e / s->mesh.per]++;
      }
    }
  }
  *inside = sqrt(sum[0] / count[0] / (square / t->nelem));
  *across = sqrt(sum[1] / count[1] / (square / t->nelem));
}

#endif /* PW_TESTS_COOK_HELPERS_H */
