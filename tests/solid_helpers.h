/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/solid_helpers.h
 * @brief A solid of ten-node tetrahedra on a mapped box under prescribed displacements and dead
 *        loads: what the plastic limit problems of tests and bench programs share.
 */
#ifndef PW_TESTS_SOLID_HELPERS_H
#define PW_TESTS_SOLID_HELPERS_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/step_newton.h"
#include "engine/tet_box.h"

/** Where the corner of the box at @p x goes; in place. */
typedef void solid_map(const void *ctx, pw_real *x);

typedef struct solid {
  pw_tet_mesh mesh;
  pw_tet_material material;
  pw_tet_rule rule;          /* of the points: one by default */
  int approach, line_search; /* of the driver; 0: as by default */
  bool follower;             /* pressures may follow the surface */
  pw_tet_model model;
  pw_newton *newton;
  pw_newton_report report;
  pw_idx nnode;
  double *push;   /* [3][nnode] displacement of the fixed components over a step; m */
  double *load;   /* [3][nnode] dead load in full; N */
  double part[2]; /* of the load at the start and the end of the step */
  double *x;      /* [3][nnode] nodes at the start; m: of the mesh, borrowed */
} solid;

/** Middles of the edges of ten-node cells go to the middles of the chords; @p x [3][nnode] of it. */
static inline void solid_straighten(const pw_tet_input *in, pw_real *x)
{
  static const int ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  const pw_idx n = in->nnode;
  for (pw_idx k = 0; k < in->ncell; k++) {
    const pw_idx *cell = in->cell + k * in->nodes;
    for (pw_idx i = 4; i < in->nodes; i++) {
      const pw_idx a = cell[ends[i - 4][0]], b = cell[ends[i - 4][1]];
      for (pw_idx c = 0; c < 3; c++) {
        x[c * n + cell[i]] = 0.5 * (x[c * n + a] + x[c * n + b]);
      }
    }
  }
}

/** Corners of cells go where @p map takes them. */
static inline pw_status solid_mesh(const pw_tet_box *box, solid_map *map, const void *ctx,
                                   pw_tet_mesh *out)
{
  pw_tet_input in;
  PW_TRY(pw_tet_box_create(box, &in));
  const pw_idx n = in.nnode;
  pw_real *x = (pw_real *)in.x; /* the box is ours */
  for (pw_idx a = 0; a < n; a++) {
    pw_real at[3] = {x[a], x[n + a], x[2 * n + a]};
    map(ctx, at);
    for (pw_idx c = 0; c < 3; c++) {
      x[c * n + a] = at[c];
    }
  }
  solid_straighten(&in, x);
  pw_status s = pw_tet_mesh_create(&in, out);
  pw_tet_box_destroy(&in);
  return s;
}

/** Set a parameter by the name of its key. */
static inline void solid_set(pw_tet_material *m, const char *name, double value)
{
  for (const pw_key *k = m->model->keys; k->name; k++) {
    if (strcmp(k->name, name) == 0) {
      m->param[k->offset / sizeof(pw_real)] = value;
    }
  }
}

/** Hencky elasticity with perfect von Mises plasticity; yield as the stress of a uniaxial test. */
static inline pw_tet_material solid_von_mises(double young, double poisson, double yield)
{
  pw_tet_material m = {.model = pw_material_find("hencky_von_mises")};
  solid_set(&m, "youngs_modulus_pa", young);
  solid_set(&m, "poisson_ratio", poisson);
  solid_set(&m, "density_kg_m3", 1.0);
  solid_set(&m, "yield_uniaxial_pa", yield);
  return m;
}

/** Points, equations and driver on s->mesh with s->material; @p body as in pw_tet_fill. */
static inline pw_status solid_start(solid *s, pw_fbar fbar, int threads, const pw_idx *body)
{
  pw_tet_fill fill = {.rule = s->rule, .body = body, .nmaterial = 1, .material = &s->material};
  pw_tet_setup setup = {
      .mesh = &s->mesh, .fill = &fill, .fbar = fbar, .threads = threads, .follower = s->follower};
  pw_newton_options options = pw_newton_defaults();
  options.approach = s->approach > 0 ? s->approach : options.approach;
  options.line_search = s->line_search > 0 ? s->line_search : options.line_search;
  PW_TRY(pw_tet_model_create(&setup, &s->model));
  s->nnode = s->mesh.tets.nnode;
  s->x = s->mesh.tets.x;
  s->push = calloc(3 * (size_t)s->nnode, sizeof *s->push);
  s->load = calloc(3 * (size_t)s->nnode, sizeof *s->load);
  PW_REQUIRE(s->push && s->load, PW_ERR_MEMORY, "%d nodes", (int)s->nnode);
  return pw_newton_create(&s->model, &options, &s->newton);
}

static inline void solid_end(solid *s)
{
  pw_newton_destroy(&s->newton);
  pw_tet_model_destroy(&s->model);
  pw_tet_mesh_destroy(&s->mesh);
  free(s->push);
  free(s->load);
}

/** Hold component @p c of the nodes whose coordinate @p axis is @p value within @p near. */
static inline void solid_hold(solid *s, int c, int axis, double value, double near)
{
  for (pw_idx a = 0; a < s->nnode; a++) {
    if (fabs(s->x[axis * s->nnode + a] - value) <= near) {
      s->model.fixed[c * s->nnode + a] = 1;
    }
  }
}

static inline void solid_apply(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const solid *s = ctx;
  const double part = s->part[0] + t1 * (s->part[1] - s->part[0]);
  for (pw_idx i = 0; i < 3 * s->nnode; i++) {
    m->prescribed[i] = (t1 - t0) * s->push[i];
    m->external[i] = part * s->load[i];
  }
}

/** One load step, up to the part @p part of the dead load. */
static inline pw_status solid_step(solid *s, double part)
{
  pw_newton_load load = {.ctx = s, .apply = solid_apply};
  s->part[1] = part;
  PW_TRY(pw_newton_step(s->newton, &load, &s->report));
  s->part[0] = part;
  return PW_OK;
}

/** Work of the internal forces on the displacements @p u [3][nnode]; J. */
static inline double solid_work(const solid *s, const double *u)
{
  double sum = 0.0;
  for (pw_idx i = 0; i < 3 * s->nnode; i++) {
    sum += s->model.force[i] * u[i];
  }
  return sum;
}

#endif /* PW_TESTS_SOLID_HELPERS_H */
