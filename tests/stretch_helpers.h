/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/stretch_helpers.h
 * @brief Simple stretch of a cube: the first example of Wang et al.
 *
 * Cube of edge 2 in five ten-node tetrahedra, E = 1e3, nu = 0, rollers on x = 0, y = 0, z = 0; the
 * face y = 2 moves by 0.4 in every load step, and the mesh is stretched along with it. The body draws
 * back from the other faces, so that which corner of the cube an element cuts off counts.
 */
#ifndef PW_TESTS_STRETCH_HELPERS_H
#define PW_TESTS_STRETCH_HELPERS_H

#include "engine/step_newton.h"
#include "tests/tet_helpers.h"

typedef struct {
  pw_tet_rule rule;
  bool per_patch;
  pw_fbar fbar;
  pw_tet_diagonal diagonal;
  const char *yield; /* key, its value is 400 */
  bool uniform;      /* y of all nodes is prescribed */
  bool mirrored;     /* rollers on x = 2: the cube's other division into five */
} stretch_case;

typedef struct {
  pw_tet_mesh mesh;
  pw_tet_material material;
  pw_tet_model model;
  pw_newton *newton;
  pw_newton_report report;
  bool uniform;
  int step;
} stretch;

static inline void stretch_apply(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const stretch *s = ctx;
  const pw_tets *t = &m->mesh->tets;
  for (pw_idx a = 0; a < t->nnode; a++) {
    pw_real y = t->x[t->nnode + a];
    m->prescribed[t->nnode + a] = s->uniform || y == 2.0 ? 0.4 * (t1 - t0) * 0.5 * y : 0.0;
  }
}

static inline pw_status stretch_move(void *ctx, pw_tet_model *m, pw_real t1)
{
  const stretch *s = ctx;
  const pw_real shift[3] = {0}, map[9] = {[0] = 1, [4] = 1.0 + 0.2 * (s->step + t1), [8] = 1};
  return pw_tet_mesh_move(m->mesh, map, shift);
}

static inline void stretch_start(const stretch_case *c, stretch *s)
{
  pw_tet_box box = test_cube(1, 2.0, 5, 10);
  box.diagonal = c->diagonal;
  memset(s, 0, sizeof *s);
  s->mesh = test_box_mesh(&box);
  s->material = test_von_mises(1e3, 0.0, c->yield, 400.0, 0.0);
  s->uniform = c->uniform;
  pw_tet_fill fill = {.rule = c->rule,
                      .per_patch = c->per_patch,
                      .allow_negative = true,
                      .nmaterial = 1,
                      .material = &s->material};
  pw_tet_setup setup = {.mesh = &s->mesh, .fill = &fill, .fbar = c->fbar, .threads = 1};
  assert_ok(pw_tet_model_create(&setup, &s->model));
  const pw_idx n = s->mesh.tets.nnode;
  for (pw_idx i = 0; i < 3 * n; i++) {
    pw_real x = s->mesh.tets.x[i];
    pw_real roller = i < n && c->mirrored ? 2.0 : 0.0;
    s->model.fixed[i] = x == roller || (i / n == 1 && (x == 2.0 || c->uniform));
  }
  pw_newton_options options = pw_newton_defaults();
  assert_ok(pw_newton_create(&s->model, &options, &s->newton));
}

static inline void stretch_end(stretch *s)
{
  pw_newton_destroy(&s->newton);
  pw_tet_model_destroy(&s->model);
  pw_tet_mesh_destroy(&s->mesh);
}

/** The next load step. */
static inline pw_status stretch_step(stretch *s)
{
  pw_newton_load load = {.ctx = s, .apply = stretch_apply, .move = stretch_move};
  pw_status status = pw_newton_step(s->newton, &load, &s->report);
  s->step++;
  return status;
}

/** Kirchhoff stress along y of a point; Pa. */
static inline double stretch_tau(const stretch *s, pw_idx i)
{
  const pw_tet_points *q = &s->model.points;
  return q->jac_bar[i] * q->stress[q->ld + i];
}

/** Mean (by volume at the start), least and largest Kirchhoff stress along y. */
static inline void stretch_range(const stretch *s, double *range)
{
  const pw_tet_points *q = &s->model.points;
  double sum = 0.0, volume = 0.0;
  range[1] = range[2] = stretch_tau(s, 0);
  for (pw_idx i = 0; i < q->n; i++) {
    double tau = stretch_tau(s, i), v = q->volume[i] / q->jac[i];
    sum += v * tau;
    volume += v;
    range[1] = fmin(range[1], tau);
    range[2] = fmax(range[2], tau);
  }
  range[0] = sum / volume;
}

/** Internal force along y of the nodes of y = 2. */
static inline double stretch_reaction(const stretch *s)
{
  const pw_tets *t = &s->mesh.tets;
  double sum = 0.0;
  for (pw_idx a = 0; a < t->nnode; a++) {
    sum += t->x[t->nnode + a] == 2.0 ? s->model.force[t->nnode + a] : 0.0;
  }
  return sum;
}

#endif /* PW_TESTS_STRETCH_HELPERS_H */
