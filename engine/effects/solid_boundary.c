/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Held components of displacement: rollers, fixities, moving walls.
 *
 * The reaction is what the nodes' internal force leaves of the external one at the components held
 * here: the force of the support on the body. A component held by two entries belongs to the first
 * one, so that every reaction is counted once.
 */
#include "engine/effects/solid_params.h"

#include <math.h>
#include <stdio.h>

#include "engine/core/mem.h"

#define AT(member) offsetof(pw_solid_boundary_param, member)

/* clang-format off */
static const pw_key keys[] = {
  PW_SOLID_NODES_KEYS(AT(nodes)),
  {"fix_x", PW_KEY_BOOL, AT(fix[0]), 0, 0, "false", NULL, NULL,
   "hold the displacement along x at that of displacement_m"},
  {"fix_y", PW_KEY_BOOL, AT(fix[1]), 0, 0, "false", NULL, NULL,
   "hold the displacement along y"},
  {"fix_z", PW_KEY_BOOL, AT(fix[2]), 0, 0, "false", NULL, NULL,
   "hold the displacement along z"},
  {"displacement_m", PW_KEY_TRIPLE, AT(displacement_m), -1e6, 1e6, "[0, 0, 0]", NULL, NULL,
   "whole displacement of the held components, reached at the end of the ramp; without moving_mesh "
   "less than an element, or the body leaves the nodes"},
  PW_SOLID_RAMP_KEYS(AT(ramp)),
  {0}};
/* clang-format on */

typedef struct boundary {
  const pw_solid_boundary_param *param;
  int number;
  pw_idx n;
  pw_idx *node;        /* [n] ascending */
  uint8_t *held;       /* [n] bits of the components that are its own */
  pw_real moved[3];    /* displacement so far; m */
  pw_real reaction[3]; /* N */
  pw_real torque;      /* of the reaction about the driven boundary's axis; N m */
} boundary;

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_solid_boundary_param *p = param;
  (void)scene;
  PW_REQUIRE(p->fix[0] || p->fix[1] || p->fix[2], PW_ERR_SCENE,
             "none of fix_x, fix_y and fix_z is true");
  for (int c = 0; c < 3; c++) {
    PW_REQUIRE(p->fix[c] || p->displacement_m[c] == 0.0, PW_ERR_SCENE,
               "displacement_m: along %c it needs fix_%c: true", "xyz"[c], "xyz"[c]);
  }
  return pw_solid_nodes_check(&p->nodes);
}

/* Largest extent along c of the elements at the nodes. */
static pw_real element_size(const pw_implicit *sim, const boundary *b, int c)
{
  const pw_tets *t = &sim->mesh.tets;
  const pw_real *x = sim->mesh.x + (pw_off)c * t->nnode;
  pw_real most = 0.0;
  for (pw_idx i = 0; i < b->n; i++) {
    for (pw_idx k = t->node_start[b->node[i]]; k < t->node_start[b->node[i] + 1]; k++) {
      const pw_idx *node = t->node + 4 * (pw_off)t->node_elem[k];
      for (int a = 0; a < 4; a++) {
        most = pw_max(most, fabs(x[node[a]] - x[b->node[i]]));
      }
    }
  }
  return most;
}

/* Nodes that go back after every step lose the body they push or pull. */
static void note_leaving(pw_implicit *sim, const boundary *b)
{
  const bool stays = !pw_scene_find_effect(&sim->scene, "moving_mesh");
  for (int c = 0; c < 3 && stays && !sim->note[0]; c++) {
    const pw_real far = fabs(b->param->displacement_m[c]);
    const pw_real size = far > 0.0 ? element_size(sim, b, c) : 0.0;
    if (far > size) {
      snprintf(
          sim->note, sizeof sim->note,
          "boundary.%d.displacement_m: %g m along %c on a mesh that stays, with elements of %g "
          "m: the body leaves the nodes that move it; moving_mesh takes the mesh along",
          b->number, far, "xyz"[c], size);
    }
  }
}

static pw_status create(pw_implicit *sim, const pw_solid_mesh *mesh, const void *param, void **ctx)
{
  boundary *b;
  char path[PW_NAME];
  const size_t nnode = (size_t)sim->mesh.tets.nnode;
  PW_TRY(pw_mem_alloc("boundary", 1, sizeof *b, &b));
  *ctx = b;
  b->param = param;
  b->number = pw_solid_instance_of(sim, param);
  snprintf(path, sizeof path, "boundary.%d", b->number);
  PW_TRY(pw_solid_nodes_find(sim, mesh, &b->param->nodes, path, &b->node, &b->n));
  PW_TRY(pw_mem_alloc("boundary: components", b->n, sizeof *b->held, &b->held));
  for (pw_idx i = 0; i < b->n; i++) {
    for (size_t c = 0; c < 3; c++) {
      uint8_t *fixed = &sim->model.fixed[c * nnode + (size_t)b->node[i]];
      if (b->param->fix[c] && !*fixed) {
        *fixed = 1;
        b->held[i] = (uint8_t)(b->held[i] | 1u << c);
      }
    }
  }
  note_leaving(sim, b);
  return PW_OK;
}

static void destroy(void **ctx)
{
  boundary *b = *ctx;
  if (b) {
    pw_mem_free(&b->node);
    pw_mem_free(&b->held);
  }
  pw_mem_free(ctx);
}

static pw_real course(const pw_implicit *sim, const boundary *b, pw_real t)
{
  return pw_solid_course(sim, b->param->ramp.start_step, b->param->ramp.ramp_steps, t);
}

static void apply(pw_implicit *sim, void *ctx, pw_real from, pw_real to)
{
  const boundary *b = ctx;
  const size_t nnode = (size_t)sim->mesh.tets.nnode;
  const pw_real part = course(sim, b, to) - course(sim, b, from);
  for (pw_idx i = 0; i < b->n; i++) {
    for (size_t c = 0; c < 3; c++) {
      if (b->held[i] >> c & 1) {
        sim->model.prescribed[c * nnode + (size_t)b->node[i]] = part * b->param->displacement_m[c];
      }
    }
  }
}

static void moved(pw_implicit *sim, void *ctx, pw_real to)
{
  boundary *b = ctx;
  const pw_tet_model *m = &sim->model;
  const pw_real *u = pw_newton_displacement(sim->newton), part = course(sim, b, to);
  const size_t nnode = (size_t)sim->mesh.tets.nnode;
  b->torque = 0.0;
  for (size_t c = 0; c < 3; c++) {
    b->reaction[c] = 0.0;
    b->moved[c] = part * b->param->displacement_m[c];
  }
  for (pw_idx i = 0; i < b->n; i++) {
    pw_real force[3], arm[3];
    for (size_t c = 0; c < 3; c++) {
      const size_t at = c * nnode + (size_t)b->node[i];
      force[c] = b->held[i] >> c & 1 ? pw_tet_model_reaction(m, at) : 0.0;
      arm[c] = sim->mesh.x[at] + u[at] - sim->centre[c];
      b->reaction[c] += force[c];
    }
    b->torque += pw_solid_torque(sim->axis, arm, force);
  }
}

static void history(const pw_implicit *sim, void *ctx, pw_record *row)
{
  const boundary *b = ctx;
  char name[64];
  for (int c = 0; c < 3; c++) {
    if (b->param->fix[c]) {
      snprintf(name, sizeof name, "boundary_%d_force_%c_n", b->number, "xyz"[c]);
      pw_record_put(row, name, b->reaction[c]);
    }
  }
  for (int c = 0; c < 3; c++) {
    if (b->param->displacement_m[c] != 0.0) {
      snprintf(name, sizeof name, "boundary_%d_displacement_%c_m", b->number, "xyz"[c]);
      pw_record_put(row, name, b->moved[c]);
    }
  }
  if (sim->has_axis) {
    snprintf(name, sizeof name, "boundary_%d_torque_n_m", b->number);
    pw_record_put(row, name, b->torque);
  }
}

static pw_status archive(pw_implicit *sim, void *ctx, pw_archive *ar)
{
  boundary *b = ctx;
  char name[64];
  (void)sim;
  snprintf(name, sizeof name, "boundary_%d/reaction", b->number);
  PW_TRY(ar->real(ar, name, b->reaction, 3));
  snprintf(name, sizeof name, "boundary_%d/moved", b->number);
  PW_TRY(ar->real(ar, name, b->moved, 3));
  snprintf(name, sizeof name, "boundary_%d/torque", b->number);
  return ar->real(ar, name, &b->torque, 1);
}

static const pw_solid_hooks hooks = {
    .create = create,
    .destroy = destroy,
    .apply = apply,
    .moved = moved,
    .history = history,
    .archive = archive,
};

const pw_effect pw_effect_solid_boundary = {
    .name = "boundary",
    .brief = "held components of displacement at nodes: rollers, fixities, moving walls",
    .many = true,
    .keys = keys,
    .check = check,
    .solid = &hooks,
};
