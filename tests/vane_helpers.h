/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/vane_helpers.h
 * @brief Vane shear: the second example of Wang et al., for the test and the bench.
 *
 * Cross blades 0.1 rv thick to the radius rv = 0.05 m in soil to 3 rv, rollers at the top and the
 * bottom, E = 1e8 Pa, nu = 0.3, c_u = 1e4 Pa. All nodes on the vane turn exactly by the same angle
 * in every step, and the mesh turns with them.
 */
#ifndef PW_TESTS_VANE_HELPERS_H
#define PW_TESTS_VANE_HELPERS_H

#include <math.h>
#include <string.h>

#include "engine/step_newton.h"
#include "io/gmsh_mesh.h"

/** Torque of a cylinder of radius rv and height h at yield: 2 pi rv^2 h c_u; N m. */
static inline double vane_cylinder(double height)
{
  return 2.0 * acos(-1.0) * 0.05 * 0.05 * height * 1e4;
}

typedef struct {
  pw_gmsh_mesh file;
  pw_tet_mesh mesh;
  pw_tet_material material;
  pw_tet_model model;
  pw_newton *newton;
  pw_newton_report report;
  const pw_gmsh_group *vane, *outer;
  double step;  /* rad */
  double angle; /* at the start of the step; rad */
  double height;
} vane;

static inline void vane_apply(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const vane *v = ctx;
  const pw_idx n = m->mesh->tets.nnode;
  const double s = sin((t1 - t0) * v->step), half = sin(0.5 * (t1 - t0) * v->step);
  for (pw_idx i = 0; i < v->vane->nnode; i++) {
    const pw_idx a = v->vane->node[i];
    const double x = m->mesh->x[a], y = m->mesh->x[n + a], c = -2.0 * half * half; /* cos - 1 */
    m->prescribed[a] = c * x - s * y;
    m->prescribed[n + a] = s * x + c * y;
  }
}

static inline pw_status vane_move(void *ctx, pw_tet_model *m, pw_real t1)
{
  const vane *v = ctx;
  const pw_real axis[3] = {0, 0, 1}, shift[3] = {0};
  pw_real rot[9];
  pw_rotation_about(axis, v->angle + t1 * v->step, rot);
  return pw_tet_mesh_move(m->mesh, rot, shift);
}

static inline void vane_fix(vane *v, const pw_gmsh_group *g, int first, int last)
{
  for (pw_idx i = 0; i < g->nnode; i++) {
    for (int c = first; c <= last; c++) {
      v->model.fixed[c * v->mesh.tets.nnode + g->node[i]] = 1;
    }
  }
}

static inline pw_status vane_start(const char *path, pw_fbar fbar, int threads, vane *v)
{
  const pw_gmsh_group *bottom, *top;
  memset(v, 0, sizeof *v);
  PW_TRY(pw_gmsh_read(path, &v->file));
  PW_TRY(pw_gmsh_find(&v->file, 2, "vane", &v->vane));
  PW_TRY(pw_gmsh_find(&v->file, 2, "outer", &v->outer));
  PW_TRY(pw_gmsh_find(&v->file, 2, "bottom", &bottom));
  PW_TRY(pw_gmsh_find(&v->file, 2, "top", &top));
  PW_TRY(pw_tet_mesh_create(&v->file.mesh, &v->mesh));
  v->height = v->mesh.tets.high[2] - v->mesh.tets.low[2];
  v->step = 5e-5;
  v->material.model = pw_material_find("hencky_von_mises");
  for (const pw_key *k = v->material.model->keys; k->name; k++) {
    pw_real *p = &v->material.param[k->offset / sizeof(pw_real)];
    *p = strcmp(k->name, "youngs_modulus_pa") == 0             ? 1e8
         : strcmp(k->name, "poisson_ratio") == 0               ? 0.3
         : strcmp(k->name, "density_kg_m3") == 0               ? 2000.0
         : strcmp(k->name, "undrained_shear_strength_pa") == 0 ? 1e4
                                                               : 0.0;
  }
  pw_tet_fill fill = {.rule = PW_TET_RULE_ONE, .nmaterial = 1, .material = &v->material};
  pw_tet_setup setup = {.mesh = &v->mesh, .fill = &fill, .fbar = fbar, .threads = threads};
  PW_TRY(pw_tet_model_create(&setup, &v->model));
  vane_fix(v, v->vane, 0, 2);
  vane_fix(v, v->outer, 0, 2);
  vane_fix(v, bottom, 2, 2);
  vane_fix(v, top, 2, 2);
  pw_newton_options options = pw_newton_defaults();
  options.tolerance = 1e-10; /* torques balance as well as the residual does */
  return pw_newton_create(&v->model, &options, &v->newton);
}

static inline void vane_end(vane *v)
{
  pw_newton_destroy(&v->newton);
  pw_tet_model_destroy(&v->model);
  pw_tet_mesh_destroy(&v->mesh);
  pw_gmsh_destroy(&v->file);
}

/** Torque about z of the internal force on a group, nodes where the step has taken them; N m. */
static inline double vane_torque(const vane *v, const pw_gmsh_group *g, const pw_real *x)
{
  const pw_idx n = v->mesh.tets.nnode;
  double sum = 0.0;
  for (pw_idx i = 0; i < g->nnode; i++) {
    const pw_idx a = g->node[i];
    sum += x[a] * v->model.force[n + a] - x[n + a] * v->model.force[a];
  }
  return sum;
}

/** One step; torque[0] on the vane, torque[1] on the outer boundary, where nodes stand at its end. */
static inline pw_status vane_turn(vane *v, double *torque)
{
  pw_newton_load load = {.ctx = v, .apply = vane_apply, .move = vane_move};
  PW_TRY(pw_newton_step(v->newton, &load, &v->report));
  v->angle += v->step;
  torque[0] = vane_torque(v, v->vane, v->mesh.x); /* the mesh has turned with the vane */
  /* Outer nodes stood still while the mesh turned under them. */
  const pw_real axis[3] = {0, 0, 1};
  const pw_idx n = v->mesh.tets.nnode;
  pw_real rot[9];
  pw_rotation_about(axis, -v->step, rot);
  torque[1] = 0.0;
  for (pw_idx i = 0; i < v->outer->nnode; i++) {
    const pw_idx a = v->outer->node[i];
    const double x = rot[0] * v->mesh.x[a] + rot[1] * v->mesh.x[n + a];
    const double y = rot[3] * v->mesh.x[a] + rot[4] * v->mesh.x[n + a];
    torque[1] += x * v->model.force[n + a] - y * v->model.force[a];
  }
  return PW_OK;
}

#endif /* PW_TESTS_VANE_HELPERS_H */
