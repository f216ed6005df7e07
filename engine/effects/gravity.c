/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Weight of all points, with a linear ramp; the direction may turn once (inclined planes). */
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
  {0}};
/* clang-format on */

typedef struct gravity {
  const pw_gravity_param *param;
  pw_real tilted[2]; /* direction after the turn */
  pw_real g[2];      /* of the step being made; m/s2 */
  pw_real *part;     /* scratch of sums */
} gravity;

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_gravity_param *p = param;
  PW_REQUIRE(scene->geometry != PW_AXI || !(fabs(p->tilt_deg) > 0.0), PW_ERR_SCENE,
             "tilt_deg = %g: in axisymmetry gravity acts along the axis", p->tilt_deg);
  return PW_OK;
}

/* Explicit: mean over the step of the acceleration, so that ramp and turn do not depend on the
 * steps. */
static void set_acceleration(pw_sim *sim, gravity *c)
{
  const pw_gravity_param *p = c->param;
  pw_real ramp = pw_effect_ramp(sim, 0.0, p->ramp_s);
  pw_real turned = pw_effect_ramp(sim, p->tilt_at_s, 0.0);
  pw_real a = p->acceleration_m_s2 * ramp;
  c->g[0] = a * turned * c->tilted[0];
  c->g[1] = a * (turned * c->tilted[1] - (1.0 - turned));
  sim->load_factor = ramp;
}

/* The weight of the water displaced at the nodes, against gravity. */
static void add_buoyancy(pw_sim *sim, const gravity *c)
{
  const pw_real *water = sim->buoyant, gx = c->g[0], gy = c->g[1];
  pw_real *rec = pw_nodes_field(&sim->nodes, sim->buoyant_field);
  const pw_off n = sim->nodes.nnode;
#pragma omp parallel for default(none) shared(water, rec, n, gx, gy) num_threads(sim->threads)     \
    schedule(static)
  for (pw_off k = 0; k < n; k++) {
    rec[k * PW_NODE + PW_NODE_FORCE] -= water[k * PW_NODE + PW_NODE_MASS] * gx;
    rec[k * PW_NODE + PW_NODE_FORCE + 1] -= water[k * PW_NODE + PW_NODE_MASS] * gy;
  }
}

static pw_status add_weight(pw_sim *sim, void *ctx)
{
  gravity *c = ctx;
  set_acceleration(sim, c);
  const pw_nodes *nodes = &sim->nodes;
  const pw_real gx = c->g[0], gy = c->g[1];
#pragma omp parallel for default(none) shared(nodes, gx, gy) num_threads(sim->threads)             \
    schedule(static)
  for (pw_idx i = 0; i < nodes->nused; i++) {
    pw_off k, last;
    for (pw_nodes_group(nodes, i, &k, &last); k < last; k++) {
      pw_real *r = nodes->rec + k * PW_NODE;
      r[PW_NODE_FORCE] += r[PW_NODE_MASS] * gx;
      r[PW_NODE_FORCE + 1] += r[PW_NODE_MASS] * gy;
    }
  }
  if (sim->buoyant) {
    add_buoyancy(sim, c);
  }
  for (int k = 0; k < sim->nstructure; k++) { /* its work is the structure's own affair */
    pw_structure_add_weight(&sim->structure[k], c->g);
  }
  return PW_OK;
}

/* Momentum with the mean velocities of the step. */
static void momentum(const void *ctx, pw_off first, pw_off last, pw_real *sum)
{
  const pw_sim *sim = ctx;
  for (pw_off k = first; k < last; k++) {
    const pw_real *r = sim->nodes.rec + k * PW_NODE;
    sum[0] += r[PW_NODE_MASS] * pw_node_mean_velocity(sim, r, 0);
    sum[1] += r[PW_NODE_MASS] * pw_node_mean_velocity(sim, r, 1);
  }
}

/* The same of the water displaced. */
static void momentum_of_water(const void *ctx, pw_off first, pw_off last, pw_real *sum)
{
  const pw_sim *sim = ctx;
  const pw_real *water = sim->buoyant;
  const pw_real *rec = pw_nodes_field(&sim->nodes, sim->buoyant_field);
  for (pw_off k = first; k < last; k++) {
    for (int a = 0; a < 2; a++) {
      sum[a] +=
          water[k * PW_NODE + PW_NODE_MASS] * pw_node_mean_velocity(sim, rec + k * PW_NODE, a);
    }
  }
}

/* Work of the nodal weights: in axisymmetry this is the weight's work over the whole domain of a
 * point, which its centre alone does not give. */
static pw_status add_work(pw_sim *sim, void *ctx)
{
  const gravity *c = ctx;
  pw_real sum[PW_SUMS];
  pw_sum_nodes(momentum, sim, sim, (const int[]){0, sim->nodes.nfield}, c->part, sum);
  sim->energy.external += sim->measure * sim->dt * (c->g[0] * sum[0] + c->g[1] * sum[1]);
  if (sim->buoyant) {
    pw_sum_items(momentum_of_water, sim, sim->nodes.nnode, sim->threads, c->part, sum);
    sim->energy.external -= sim->measure * sim->dt * (c->g[0] * sum[0] + c->g[1] * sum[1]);
  }
  return PW_OK;
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
  pw_real tilt = c->param->tilt_deg * (PW_PI / 180.0);
  c->tilted[0] = sin(tilt);
  c->tilted[1] = -cos(tilt);
  sim->load_factor = c->param->ramp_s > 0.0 ? 0.0 : 1.0;
  return pw_mem_alloc("gravity sums", pw_sum_scratch((pw_off)sim->nodes.nnode * sim->nodes.nfield),
                      sizeof(pw_real), &c->part);
}

static const pw_hook hooks[] = {
    {PW_STAGE_NODE_FORCE, add_weight},
    {PW_STAGE_END, add_work},
    {0, NULL},
};

const pw_effect pw_effect_gravity = {
    .name = "gravity",
    .brief = "weight of all points, with a ramp; may turn by an angle",
    .keys = keys,
    .hooks = hooks,
    .implicit = hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
};
