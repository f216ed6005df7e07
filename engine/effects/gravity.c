/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Weight of all points, with a linear ramp; the direction may turn once (inclined planes), at once or
 * smoothly. */
#include "engine/effects/common.h"
#include "engine/effects/load_curve.h"
#include "engine/effects/params.h"

#include <math.h>

#include "engine/core/mem.h"

#define AT(member) offsetof(pw_gravity_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"acceleration_m_s2", PW_KEY_REAL, AT(acceleration_m_s2), 0, 1e6, "9.81", NULL, NULL,
   "of gravity, along -y unless tilted"},
  {"ramp_s", PW_KEY_REAL, AT(ramp_s), 0, 1e12, "0", NULL, NULL,
   "time over which it grows linearly from zero; 0: at once"},
  {"tilt_deg", PW_KEY_REAL, AT(tilt_deg), -180, 180, "0", NULL, NULL,
   "angle by which it turns from -y towards +x"},
  {"tilt_at_s", PW_KEY_REAL, AT(tilt_at_s), 0, 1e12, "0", NULL, NULL, "time at which it turns"},
  {"tilt_over_s", PW_KEY_REAL, AT(tilt_over_s), 0, 1e12, "0", NULL, NULL,
   "time over which it turns, from then on, the angle as half a cosine; 0: at once"},
  {0}};
/* clang-format on */

typedef struct gravity {
  const pw_gravity_param *param;
  pw_real tilted[2]; /* direction after the turn */
  pw_real g[2];      /* of the step being made; m/s2 */
  pw_real *part;     /* scratch of sums */
} gravity;

static pw_real radians(pw_real degrees)
{
  return degrees * (PW_PI / 180.0);
}

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_gravity_param *p = param;
  PW_REQUIRE(scene->geometry != PW_AXI || !(fabs(p->tilt_deg) > 0.0), PW_ERR_SCENE,
             "tilt_deg = %g: in axisymmetry gravity acts along the axis", p->tilt_deg);
  return PW_OK;
}

/* Explicit: mean over the step of the acceleration, so that ramp and turn do not depend on the
 * steps; of a smooth turn, up to the square of the step. */
static void set_acceleration(pw_sim *sim, gravity *c)
{
  const pw_gravity_param *p = c->param;
  const pw_real ramp = pw_effect_ramp(sim, 0.0, p->ramp_s), a = p->acceleration_m_s2 * ramp;
  const pw_real turned = pw_effect_ramp(sim, p->tilt_at_s, p->tilt_over_s);
  if (p->tilt_over_s > 0.0) {
    const pw_real angle = 0.5 * (1.0 - cos(PW_PI * turned)) * radians(p->tilt_deg);
    c->g[0] = a * sin(angle);
    c->g[1] = -a * cos(angle);
  } else {
    c->g[0] = a * turned * c->tilted[0];
    c->g[1] = a * (turned * c->tilted[1] - (1.0 - turned));
  }
  sim->load_factor = ramp;
}

/* Mass of the water displaced at a record. */
static pw_real water_at(const pw_sim *sim, pw_off k)
{
  const pw_off i = k - (pw_off)sim->buoyant_field * sim->nodes.nnode;
  return i >= 0 && i < sim->nodes.nnode ? sim->buoyant[i * PW_NODE + PW_NODE_MASS] : 0.0;
}

static void weigh(const pw_sim *sim, const pw_real *g, pw_off first, pw_off last)
{
  const bool wet = sim->buoyant != NULL;
  for (pw_off k = first; k < last; k++) {
    pw_real *r = sim->nodes.rec + k * PW_NODE;
    const pw_real m = wet ? r[PW_NODE_MASS] - water_at(sim, k) : r[PW_NODE_MASS];
    r[PW_NODE_FORCE] += m * g[0];
    r[PW_NODE_FORCE + 1] += m * g[1];
  }
}

static void weigh_part(const pw_sim *sim, void *ctx, int part, int parts)
{
  const gravity *c = ctx;
  pw_idx i, end;
  for (pw_nodes_part(&sim->nodes, part, parts, &i, &end); i < end; i++) {
    pw_off first, last;
    pw_nodes_group(&sim->nodes, i, &first, &last);
    weigh(sim, c->g, first, last);
  }
}

static pw_status begin(pw_sim *sim, void *ctx)
{
  gravity *c = ctx;
  set_acceleration(sim, c);
  for (int k = 0; k < sim->nstructure; k++) { /* its work is the structure's own affair */
    pw_structure_add_weight(&sim->structure[k], c->g);
  }
  return PW_OK;
}

static pw_status weigh_all(pw_sim *sim, void *ctx)
{
  PW_TRY(begin(sim, ctx));
  weigh_part(sim, ctx, 0, 1);
  return PW_OK;
}

/* Momentum with the mean velocities of the step, without that of the water displaced. */
static void momentum(const void *ctx, pw_off first, pw_off last, pw_real *sum)
{
  const pw_sim *sim = ctx;
  const bool wet = sim->buoyant != NULL;
  pw_real x = sum[0], y = sum[1];
  for (pw_off k = first; k < last; k++) {
    const pw_real *r = sim->nodes.rec + k * PW_NODE;
    const pw_real m = wet ? r[PW_NODE_MASS] - water_at(sim, k) : r[PW_NODE_MASS];
    x += m * pw_node_mean_velocity(sim, r, 0);
    y += m * pw_node_mean_velocity(sim, r, 1);
  }
  sum[0] = x;
  sum[1] = y;
}

static void sum_part(const pw_sim *sim, void *ctx, int part, int parts)
{
  const gravity *c = ctx;
  pw_sum_nodes_part(momentum, sim, sim, (const int[]){0, sim->nodes.nfield}, c->part, part, parts);
}

/* Work of the nodal weights: in axisymmetry this is the weight's work over the whole domain of a
 * point, which its centre alone does not give. */
static pw_status add_work(pw_sim *sim, void *ctx)
{
  const gravity *c = ctx;
  pw_real sum[PW_SUMS];
  pw_sum_nodes_end(sim, (const int[]){0, sim->nodes.nfield}, c->part, sum);
  sim->energy.external += sim->measure * sim->dt * (c->g[0] * sum[0] + c->g[1] * sum[1]);
  return PW_OK;
}

static pw_status sum_and_add_work(pw_sim *sim, void *ctx)
{
  sum_part(sim, ctx, 0, 1);
  return add_work(sim, ctx);
}

static void destroy(void **ctx)
{
  gravity *c = *ctx;
  if (c) {
    pw_mem_free(&c->part);
  }
  pw_mem_free(ctx);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  gravity *c;
  PW_TRY(pw_mem_alloc("gravity", 1, sizeof *c, &c));
  *ctx = c;
  c->param = param;
  pw_real tilt = radians(c->param->tilt_deg);
  c->tilted[0] = sin(tilt);
  c->tilted[1] = -cos(tilt);
  sim->load_factor = c->param->ramp_s > 0.0 ? 0.0 : 1.0;
  return pw_mem_alloc("gravity sums", pw_sum_scratch((pw_off)sim->nodes.nnode * sim->nodes.nfield),
                      sizeof(pw_real), &c->part);
}

static const pw_hook hooks[] = {
    {PW_STAGE_NODE_FORCE, begin},
    {PW_STAGE_END, add_work},
    {0, NULL},
};

static const pw_part_hook part_hooks[] = {
    {PW_STAGE_WEIGHT, weigh_part},
    {PW_STAGE_MOTION, sum_part},
    {0, NULL},
};

static const pw_hook implicit_hooks[] = {
    {PW_STAGE_NODE_FORCE, weigh_all},
    {PW_STAGE_END, sum_and_add_work},
    {0, NULL},
};

const pw_effect pw_effect_gravity = {
    .name = "gravity",
    .brief = "weight of all points, with a ramp; may turn by an angle",
    .keys = keys,
    .hooks = hooks,
    .part_hooks = part_hooks,
    .implicit = implicit_hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
};
