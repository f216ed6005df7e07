/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Local non-viscous damping (Cundall 1987): each component of a node's out-of-balance force is
 * reduced, or raised, by a fraction of its size against the direction of motion,
 * f <- f - alpha |f| sign(v). */
#include "engine/effects/common.h"
#include "engine/effects/params.h"

#include "engine/core/mem.h"

#define AT(member) offsetof(pw_damping_local_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"coefficient", PW_KEY_REAL, AT(coefficient), 0, 1, NULL, NULL, NULL,
   "part of the out-of-balance force that opposes the motion"},
  {"body", PW_KEY_BODY, AT(body), 0, 0, "", NULL, NULL,
   "damp only this body's velocity field; absent: every body"},
  {"until_s", PW_KEY_REAL, AT(until_s), 0, 1e12, "0", NULL, NULL,
   "time at which it ends; 0: the whole run"},
  {0}};
/* clang-format on */

typedef struct damping {
  const pw_damping_local_param *param;
  int first, last; /* velocity fields */
  pw_real *force;  /* [fields * nnode * 2] damping forces of this step; N (per radian) */
  pw_real *part;   /* scratch of sums */
  bool on;         /* in this step */
} damping;

/* What the sum of the dissipated work needs. */
typedef struct damped {
  const pw_sim *sim;
  const damping *c;
} damped;

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_damping_local_param *p = param;
  PW_REQUIRE(scene->method.update != PW_IMPLICIT || !pw_scene_find_effect(scene, "dynamics"),
             PW_ERR_SCENE, "implicit steps know it in equilibrium only; dynamics: damping_per_s");
  PW_REQUIRE(p->body < 0 || scene->nbody == 1 || pw_scene_contacts(scene) > 0, PW_ERR_SCENE,
             "body: without a contact all bodies share one velocity field");
  return PW_OK;
}

static pw_off node_count(const pw_sim *sim, const damping *c)
{
  return (pw_off)(c->last - c->first) * sim->nodes.nnode;
}

static void damp_node(pw_real alpha, pw_real *r, pw_real *force)
{
  for (int a = 0; a < 2; a++) {
    pw_real f = r[PW_NODE_FORCE + a], p = r[PW_NODE_VEL + a];
    pw_real sign = (pw_real)((p > 0.0) - (p < 0.0));
    force[a] = -alpha * (f < 0.0 ? -f : f) * sign;
    r[PW_NODE_FORCE + a] = f + force[a];
  }
}

/* Opposes what all others together have added, so one by one after them. */
static pw_status damp(pw_sim *sim, void *ctx)
{
  damping *c = ctx;
  c->on = c->param->until_s <= 0.0 || sim->time < c->param->until_s;
  if (!c->on) {
    return PW_OK;
  }
  const pw_off from = (pw_off)c->first * sim->nodes.nnode, to = from + node_count(sim, c);
  const pw_real alpha = c->param->coefficient;
  const pw_nodes *nodes = &sim->nodes;
  pw_real *force = c->force;
#pragma omp parallel for default(none) shared(nodes, force, from, to, alpha)                       \
    num_threads(sim->threads) schedule(static)
  for (pw_idx i = 0; i < nodes->nused; i++) {
    pw_off k, last;
    pw_nodes_group(nodes, i, &k, &last);
    last = last < to ? last : to;
    for (k = k > from ? k : from; k < last; k++) {
      damp_node(alpha, nodes->rec + k * PW_NODE, force + 2 * (k - from));
    }
  }
  return PW_OK;
}

static void power(const void *ctx, pw_off first, pw_off last, pw_real *sum)
{
  const damped *d = ctx;
  const pw_real *rec = d->sim->nodes.rec;
  const pw_off from = (pw_off)d->c->first * d->sim->nodes.nnode;
  for (pw_off k = first; k < last; k++) {
    for (int a = 0; a < 2; a++) {
      sum[0] +=
          d->c->force[2 * (k - from) + a] * pw_node_mean_velocity(d->sim, rec + k * PW_NODE, a);
    }
  }
}

/* The forces are kept until the velocities of the step are known: at held nodes they do no work. */
static pw_status add_dissipation(pw_sim *sim, void *ctx)
{
  const damping *c = ctx;
  if (c->on) {
    pw_real sum[PW_SUMS];
    damped d = {sim, c};
    pw_sum_nodes(power, &d, sim, (const int[]){c->first, c->last}, c->part, sum);
    sim->energy.damping -= sum[0] * sim->dt * sim->measure;
  }
  return PW_OK;
}

static void destroy(void **ctx)
{
  damping *c = *ctx;
  if (c) {
    pw_mem_free(&c->force);
    pw_mem_free(&c->part);
  }
  pw_mem_free(ctx);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  damping *c;
  PW_TRY(pw_mem_alloc("local damping", 1, sizeof *c, &c));
  *ctx = c;
  c->param = param;
  pw_effect_fields(sim, c->param->body, &c->first, &c->last);
  pw_off count = node_count(sim, c);
  PW_TRY(pw_mem_alloc("local damping forces", 2 * count, sizeof(pw_real), &c->force));
  return pw_mem_alloc("local damping sums", pw_sum_scratch(count), sizeof(pw_real), &c->part);
}

static const pw_hook hooks[] = {
    {PW_STAGE_NODE_TOTAL, damp},
    {PW_STAGE_END, add_dissipation},
    {0, NULL},
};

/* In equilibrium nothing is out of balance, so that damping has no force. */
static const pw_hook no_hooks[] = {{0, NULL}};

const pw_effect pw_effect_damping_local = {
    .name = "damping_local",
    .brief = "local damping: a part of the out-of-balance force opposes the motion",
    .many = true,
    .keys = keys,
    .hooks = hooks,
    .implicit = no_hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
};
