/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nodes that turn about an axis and advance along it, exactly as a rigid body does: a vane, a screw
 * pile. And the mesh that moves with them, or is stretched.
 *
 * Over a part of a step the nodes move from where the mesh has them: on a mesh that moves along they
 * are on the body, on a fixed one the material flows past them.
 */
#include "engine/effects/solid_params.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"

#define AT(member) offsetof(pw_driven_boundary_param, member)

/* clang-format off */
static const pw_key keys[] = {
  PW_SOLID_NODES_KEYS(AT(nodes)),
  {"axis", PW_KEY_TRIPLE, AT(axis), -1e6, 1e6, "[0, 0, 1]", NULL, NULL,
   "direction of the axis, of any length"},
  {"centre_m", PW_KEY_TRIPLE, AT(centre_m), -1e6, 1e6, "[0, 0, 0]", NULL, NULL,
   "a point of the axis"},
  {"angle_deg", PW_KEY_REAL, AT(angle_deg), -1e6, 1e6, "0", NULL, NULL,
   "whole angle of the turn, right-handed about the axis, reached at the end of the ramp"},
  {"advance_m", PW_KEY_REAL, AT(advance_m), -1e6, 1e6, "0", NULL, NULL,
   "whole displacement along the axis, reached at the end of the ramp"},
  PW_SOLID_RAMP_KEYS(AT(ramp)),
  {0}};
/* clang-format on */

typedef struct driven {
  const pw_driven_boundary_param *param;
  pw_idx n;
  pw_idx *node;     /* [n] ascending */
  pw_real part;     /* of the whole motion, so far */
  pw_real force[3]; /* of the boundary on the body; N */
  pw_real torque;   /* about the axis; N m */
} driven;

const pw_driven_boundary_param *pw_solid_driven_param(const pw_scene *scene)
{
  return pw_scene_find_effect(scene, "driven_boundary");
}

static pw_real radians(pw_real degrees)
{
  return degrees * (PW_PI / 180.0);
}

static void unit(const pw_real *axis, pw_real *out)
{
  const pw_real length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  for (int c = 0; c < 3; c++) {
    out[c] = axis[c] / length;
  }
}

void pw_solid_driven_motion(const pw_driven_boundary_param *p, pw_real part, pw_real *map,
                            pw_real *shift)
{
  pw_real axis[3];
  unit(p->axis, axis);
  pw_rotation_about(axis, part * radians(p->angle_deg), map);
  for (int i = 0; i < 3; i++) {
    shift[i] = p->centre_m[i] + part * p->advance_m * axis[i];
    for (int j = 0; j < 3; j++) {
      shift[i] -= map[3 * i + j] * p->centre_m[j];
    }
  }
}

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_driven_boundary_param *p = param;
  (void)scene;
  PW_REQUIRE(p->axis[0] != 0.0 || p->axis[1] != 0.0 || p->axis[2] != 0.0, PW_ERR_SCENE,
             "axis: it has no direction");
  return pw_solid_nodes_check(&p->nodes);
}

static pw_status create(pw_implicit *sim, const pw_solid_mesh *mesh, const void *param, void **ctx)
{
  driven *d;
  const size_t nnode = (size_t)sim->mesh.tets.nnode;
  PW_TRY(pw_mem_alloc("driven boundary", 1, sizeof *d, &d));
  *ctx = d;
  d->param = param;
  PW_TRY(pw_solid_nodes_find(sim, mesh, &d->param->nodes, "driven_boundary", &d->node, &d->n));
  for (pw_idx i = 0; i < d->n; i++) {
    for (size_t c = 0; c < 3; c++) {
      sim->model.fixed[c * nnode + (size_t)d->node[i]] = 1;
    }
  }
  sim->has_axis = true;
  unit(d->param->axis, sim->axis);
  memcpy(sim->centre, d->param->centre_m, sizeof sim->centre);
  return PW_OK;
}

static void destroy(void **ctx)
{
  driven *d = *ctx;
  if (d) {
    pw_mem_free(&d->node);
  }
  pw_mem_free(ctx);
}

static pw_real course(const pw_implicit *sim, const pw_driven_boundary_param *p, pw_real t)
{
  return pw_solid_course(sim, p->ramp.start_step, p->ramp.ramp_steps, t);
}

/* u = sin(a) k x r + (cos(a) - 1) (r - k (k . r)) + advance k, with r from the axis: no digits are
 * lost at small angles. */
static void apply(pw_implicit *sim, void *ctx, pw_real from, pw_real to)
{
  const driven *d = ctx;
  const size_t nnode = (size_t)sim->mesh.tets.nnode;
  const pw_real part = course(sim, d->param, to) - course(sim, d->param, from);
  const pw_real angle = part * radians(d->param->angle_deg), half = sin(0.5 * angle);
  const pw_real sine = sin(angle), less = -2.0 * half * half, *k = sim->axis;
  for (pw_idx i = 0; i < d->n; i++) {
    pw_real r[3], along = 0.0;
    for (size_t c = 0; c < 3; c++) {
      r[c] = sim->mesh.x[c * nnode + (size_t)d->node[i]] - sim->centre[c];
      along += k[c] * r[c];
    }
    for (size_t c = 0; c < 3; c++) {
      const size_t p = (c + 1) % 3, q = (c + 2) % 3;
      sim->model.prescribed[c * nnode + (size_t)d->node[i]] = sine * (k[p] * r[q] - k[q] * r[p]) +
                                                              less * (r[c] - k[c] * along) +
                                                              part * d->param->advance_m * k[c];
    }
  }
}

static void moved(pw_implicit *sim, void *ctx, pw_real to)
{
  driven *d = ctx;
  const pw_tet_model *m = &sim->model;
  const pw_real *u = pw_newton_displacement(sim->newton);
  const size_t nnode = (size_t)sim->mesh.tets.nnode;
  d->part = course(sim, d->param, to);
  d->torque = 0.0;
  memset(d->force, 0, sizeof d->force);
  for (pw_idx i = 0; i < d->n; i++) {
    pw_real force[3], arm[3];
    for (size_t c = 0; c < 3; c++) {
      const size_t at = c * nnode + (size_t)d->node[i];
      force[c] = pw_tet_model_reaction(m, at);
      arm[c] = sim->mesh.x[at] + u[at] - sim->centre[c];
      d->force[c] += force[c];
    }
    d->torque += pw_solid_torque(sim->axis, arm, force);
  }
}

static void history(const pw_implicit *sim, void *ctx, pw_record *row)
{
  const driven *d = ctx;
  char name[64];
  (void)sim;
  pw_record_put(row, "driven_angle_deg", d->part * d->param->angle_deg);
  pw_record_put(row, "driven_advance_m", d->part * d->param->advance_m);
  pw_record_put(row, "driven_torque_n_m", d->torque);
  for (int c = 0; c < 3; c++) {
    snprintf(name, sizeof name, "driven_force_%c_n", "xyz"[c]);
    pw_record_put(row, name, d->force[c]);
  }
}

static pw_status archive(pw_implicit *sim, void *ctx, pw_archive *ar)
{
  driven *d = ctx;
  (void)sim;
  PW_TRY(ar->real(ar, "driven_boundary/force", d->force, 3));
  PW_TRY(ar->real(ar, "driven_boundary/torque", &d->torque, 1));
  return ar->real(ar, "driven_boundary/part", &d->part, 1);
}

static const pw_solid_hooks hooks = {
    .create = create,
    .destroy = destroy,
    .apply = apply,
    .moved = moved,
    .history = history,
    .archive = archive,
};

const pw_effect pw_effect_driven_boundary = {
    .name = "driven_boundary",
    .brief = "nodes of a group turn about an axis and advance along it as a rigid body",
    .keys = keys,
    .check = check,
    .solid = &hooks,
};
