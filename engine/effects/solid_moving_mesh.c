/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh moves as one after every step: with the driven boundary, or stretched with the body. */
#include "engine/effects/solid_params.h"

#include "engine/core/mem.h"

#define AT(member) offsetof(pw_moving_mesh_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"with", PW_KEY_CHOICE, AT(with), 0, 0, "driven", "driven|stretch", NULL,
   "the mesh follows the driven boundary, or is stretched about centre_m"},
  {"stretch_end", PW_KEY_TRIPLE, AT(stretch_end), 1e-3, 1e3, NULL, NULL, "with=stretch",
   "lengths along x, y and z at the end of the ramp over those at the start"},
  {"centre_m", PW_KEY_TRIPLE, AT(centre_m), -1e6, 1e6, "[0, 0, 0]", NULL, "with=stretch",
   "the point that stays where it is"},
  {"start_step", PW_KEY_INT, AT(ramp.start_step), 0, 1e6, "0", NULL, "with=stretch",
   "load steps made before the stretch begins"},
  {"ramp_steps", PW_KEY_INT, AT(ramp.ramp_steps), 0, 1e6, "0", NULL, "with=stretch",
   "load steps of the stretch; 0: to the end of the run"},
  {0}};
/* clang-format on */

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_moving_mesh_param *p = param;
  PW_REQUIRE(p->with != PW_MOTION_DRIVEN || pw_solid_driven_param(scene), PW_ERR_SCENE,
             "with: driven needs driven_boundary, which is not in the scene");
  return PW_OK;
}

static pw_status create(pw_implicit *sim, const pw_solid_mesh *mesh, const void *param, void **ctx)
{
  const pw_moving_mesh_param **p;
  (void)sim, (void)mesh;
  PW_TRY(pw_mem_alloc("moving mesh", 1, sizeof *p, &p));
  *p = param;
  *ctx = p;
  return PW_OK;
}

static void destroy(void **ctx)
{
  pw_mem_free(ctx);
}

static pw_status move(pw_implicit *sim, void *ctx, pw_real to)
{
  const pw_moving_mesh_param *p = *(const pw_moving_mesh_param *const *)ctx;
  pw_real map[9] = {0}, shift[3];
  if (p->with == PW_MOTION_DRIVEN) {
    const pw_driven_boundary_param *d = pw_solid_driven_param(&sim->scene);
    const pw_real part = pw_solid_course(sim, d->ramp.start_step, d->ramp.ramp_steps, to);
    pw_solid_driven_motion(d, part, map, shift);
    return pw_tet_mesh_move(&sim->mesh, map, shift);
  }
  const pw_real part = pw_solid_course(sim, p->ramp.start_step, p->ramp.ramp_steps, to);
  for (int c = 0; c < 3; c++) {
    map[4 * c] = 1.0 + part * (p->stretch_end[c] - 1.0);
    shift[c] = (1.0 - map[4 * c]) * p->centre_m[c];
  }
  return pw_tet_mesh_move(&sim->mesh, map, shift);
}

static const pw_solid_hooks hooks = {
    .create = create,
    .destroy = destroy,
    .mesh = move,
};

const pw_effect pw_effect_moving_mesh = {
    .name = "moving_mesh",
    .brief = "the mesh moves with the driven boundary or is stretched, instead of staying",
    .keys = keys,
    .check = check,
    .solid = &hooks,
};
