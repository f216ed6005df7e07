/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Effects that change the model itself: stress at the start, ghost stabilisation, inertia. */
#include "engine/effects/solid_params.h"

#include <string.h>

#include "engine/points.h"
#include "engine/tet_loads.h"

#define AT(member) offsetof(pw_solid_stress_param, member)

/* clang-format off */
static const pw_key stress_keys[] = {
  {"body", PW_KEY_BODY, AT(body), 0, 0, "", NULL, NULL, "absent: every body"},
  {"kind", PW_KEY_CHOICE, AT(kind), 0, 0, "k0", "k0|uniform", NULL,
   "growing with depth, or the same everywhere"},
  {"vertical", PW_KEY_CHOICE, AT(vertical), 0, 0, "y", "x|y|z", "kind=k0",
   "the axis that points up"},
  {"top_m", PW_KEY_REAL, AT(top_m), -1e6, 1e6, NULL, NULL, "kind=k0",
   "height of the free surface"},
  {"unit_weight_n_m3", PW_KEY_REAL, AT(unit_weight_n_m3), 0, 1e9, NULL, NULL, "kind=k0",
   "weight of the material per volume"},
  {"k0", PW_KEY_REAL, AT(k0), 0, 10, NULL, NULL, "kind=k0",
   "horizontal over vertical stress"},
  {"surcharge_pa", PW_KEY_REAL, AT(surcharge_pa), 0, 1e15, "0", NULL, "kind=k0",
   "pressure on the free surface"},
  {"normal_pa", PW_KEY_TRIPLE, AT(normal_pa), -1e15, 1e15, NULL, NULL, "kind=uniform",
   "stresses xx, yy, zz, tension positive"},
  {"shear_pa", PW_KEY_TRIPLE, AT(shear_pa), -1e15, 1e15, "[0, 0, 0]", NULL, "kind=uniform",
   "stresses xy, yz, zx"},
  {0}};

static const pw_key ghost_keys[] = {
  {"stiffness_pa", PW_KEY_REAL, offsetof(pw_ghost_param, stiffness_pa), PW_TINY, 1e18, NULL, NULL,
   NULL, "of the order of a tenth of the shear modulus"},
  {0}};

static const pw_key dynamics_keys[] = {
  {"mass", PW_KEY_CHOICE, offsetof(pw_dynamics_param, mass), 0, 0, "lumped", "lumped|consistent",
   NULL, "mass matrix of the nodes"},
  {"rates", PW_KEY_CHOICE, offsetof(pw_dynamics_param, rates), 0, 0, "points", "points|nodes", NULL,
   "velocities and accelerations go with the points, or stay with nodes that go with the material"},
  {"beta", PW_KEY_REAL, offsetof(pw_dynamics_param, beta), PW_TINY, 1, "0.25", NULL, NULL,
   "of Newmark's method"},
  {"gamma", PW_KEY_REAL, offsetof(pw_dynamics_param, gamma), 0.5, 1.5, "0.5", NULL, NULL,
   "of Newmark's method; above 0.5 it dissipates"},
  {"damping_per_s", PW_KEY_REAL, offsetof(pw_dynamics_param, damping_per_s), 0, 1e9, "0", NULL, NULL,
   "force of damping over mass and velocity"},
  {0}};
/* clang-format on */

/* ---- initial stress ---- */

/* The stress of one entry or of several; bodies that none names stay free of it. */
static void stress_at(void *ctx, const pw_real *x, pw_idx body, pw_real *stress)
{
  const pw_implicit *sim = ctx;
  memset(stress, 0, 6 * sizeof *stress);
  for (int k = 0; k < sim->neffect; k++) {
    const pw_solid_stress_param *p = sim->effect[k].param;
    if (sim->effect[k].type != &pw_effect_solid_initial_stress ||
        (p->body >= 0 && p->body != body)) {
      continue;
    }
    if (p->kind == PW_SOLID_UNIFORM) {
      memcpy(stress, p->normal_pa, sizeof p->normal_pa);
      memcpy(stress + 3, p->shear_pa, sizeof p->shear_pa);
      continue;
    }
    const pw_real depth = pw_max(p->top_m - x[p->vertical], 0.0);
    const pw_real vertical = -(p->surcharge_pa + depth * p->unit_weight_n_m3);
    for (int c = 0; c < 3; c++) {
      stress[c] = c == p->vertical ? vertical : p->k0 * vertical;
      stress[3 + c] = 0.0;
    }
  }
}

static pw_status check_stress(const pw_scene *scene, const void *param)
{
  const pw_solid_stress_param *p = param;
  for (int b = 0; b < scene->nbody; b++) {
    if (p->body >= 0 && p->body != b) {
      continue;
    }
    const pw_material *model = scene->material[scene->body[b].material].model;
    PW_REQUIRE(model->takes_initial_stress, PW_ERR_SCENE,
               "body: the material of '%s' (%s) cannot start from a stress", scene->body[b].name,
               model->name);
  }
  return PW_OK;
}

/* The last of them gives all points the stress of the entry that counts. */
static pw_status create_stress(pw_implicit *sim, const pw_solid_mesh *mesh, const void *param,
                               void **ctx)
{
  (void)mesh, (void)param;
  *ctx = NULL;
  return pw_tet_model_prestress(&sim->model, stress_at, sim);
}

static const pw_solid_hooks stress_hooks = {.create = create_stress};

const pw_effect pw_effect_solid_initial_stress = {
    .name = "initial_stress",
    .brief = "stress of bodies at the start; of two entries for a body the last one counts",
    .many = true,
    .keys = stress_keys,
    .check = check_stress,
    .solid = &stress_hooks,
};

/* ---- options of the model and the driver: nothing is created beside them ---- */

static pw_status create_nothing(pw_implicit *sim, const pw_solid_mesh *mesh, const void *param,
                                void **ctx)
{
  (void)sim, (void)mesh, (void)param;
  *ctx = NULL;
  return PW_OK;
}

void pw_solid_model_options(const pw_scene *scene, pw_tet_setup *setup, pw_newton_options *options)
{
  const pw_ghost_param *ghost = pw_scene_find_effect(scene, pw_effect_ghost.name);
  const pw_dynamics_param *d = pw_scene_find_effect(scene, pw_effect_dynamics.name);
  if (ghost) {
    setup->ghost = ghost->stiffness_pa;
  }
  for (int e = 0; e < scene->neffect; e++) {
    const pw_traction_param *p = (const void *)scene->effect[e].param;
    const bool traction = scene->effect[e].type == &pw_effect_traction;
    setup->follower = setup->follower || (traction && p->follower);
  }
  if (d) {
    options->newmark = (pw_newmark){.on = true,
                                    .beta = d->beta,
                                    .gamma = d->gamma,
                                    .damping = d->damping_per_s,
                                    .consistent = d->mass == 1,
                                    .keep = d->rates == 1};
  }
}

static pw_status check_dynamics(const pw_scene *scene, const void *param)
{
  const pw_dynamics_param *p = param;
  const bool grid = scene->geometry != PW_SOLID;
  PW_REQUIRE(!grid || scene->method.update == PW_IMPLICIT, PW_ERR_SCENE,
             "explicit steps have their own inertia (method.update: implicit needs this one)");
  PW_REQUIRE(!grid || p->mass == 0, PW_ERR_SCENE, "mass: on a grid masses are lumped");
  PW_REQUIRE(!grid || p->rates == 0, PW_ERR_SCENE, "rates: on a grid they go with the points");
  PW_REQUIRE(p->gamma <= 2.0 * p->beta + 0.5, PW_ERR_SCENE,
             "gamma: it must not be above 2 beta + 0.5 = %g", 2.0 * p->beta + 0.5);
  return PW_OK;
}

static void history_dynamics(const pw_implicit *sim, void *ctx, pw_record *row)
{
  (void)ctx;
  pw_record_put(row, "kinetic_j", pw_tet_points_kinetic(&sim->model.points));
}

static pw_status check_ghost(const pw_scene *scene, const void *param)
{
  (void)param;
  PW_REQUIRE(scene->geometry == PW_SOLID || scene->method.update == PW_IMPLICIT, PW_ERR_SCENE,
             "explicit steps know no stabilisation of cut cells (method.update: implicit does)");
  return PW_OK;
}

/* engine/quad_ghost.h and engine/quad_inertia.h do it. */
static const pw_hook no_hooks[] = {{0, NULL}};

static const pw_solid_hooks ghost_hooks = {.create = create_nothing};
static const pw_solid_hooks dynamics_hooks = {.create = create_nothing,
                                              .history = history_dynamics};

const pw_effect pw_effect_ghost = {
    .name = "ghost_stabilisation",
    .brief = "barely filled elements follow their neighbours (Coombs 2023)",
    .keys = ghost_keys,
    .implicit = no_hooks,
    .check = check_ghost,
    .solid = &ghost_hooks,
};

const pw_effect pw_effect_dynamics = {
    .name = "dynamics",
    .brief = "inertia, by Newmark's method; step_s is then the time of a step",
    .point_fields = PW_FIELD_BIT(PW_FIELD_ACCELERATION),
    .keys = dynamics_keys,
    .implicit = no_hooks,
    .check = check_dynamics,
    .solid = &dynamics_hooks,
};
