/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A body whose velocity is given: held at rest until start_s, then moved, with a linear ramp.
 *
 * Its points carry the velocity of the step from the start of the step on, so nodes of its field
 * give them no increment. The force that drives the body is what keeps its momentum M v against
 * the forces on its nodes, contact included: R = M (v - v_old) / dt - sum m (v(n+1) - v(n)) / dt
 * with the velocities before they are overwritten.
 *
 * A vibration adds a sin(2 pi f (t - start)) to the place along y. The velocity of a step is the
 * mean over it, so that the places at its ends are exact; points must make every step for that.
 *
 * A body without points keeps that force and its work itself (engine/structure.h); of a rod it is
 * the head that moves as given.
 */
#include "engine/assemble.h"
#include "engine/effects/common.h"
#include "engine/effects/load_curve.h"
#include "engine/effects/params.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"
#include "engine/full_mass.h"

#define AT(member) offsetof(pw_prescribed_motion_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"body", PW_KEY_BODY, AT(body), 0, 0, NULL, NULL, NULL,
   "body that moves as given, or rod whose head does; of points it is alone, or a contact's side"},
  {"velocity_m_s", PW_KEY_PAIR, AT(velocity_m_s), -1e6, 1e6, NULL, NULL, NULL,
   "its velocity after the ramp"},
  {"start_s", PW_KEY_REAL, AT(start_s), 0, 1e12, "0", NULL, NULL,
   "time at which it starts to move; it is held at rest before"},
  {"ramp_s", PW_KEY_REAL, AT(ramp_s), 0, 1e12, "0", NULL, NULL,
   "time over which the velocity grows linearly from zero; 0: at once"},
  {"vibration_amplitude_m", PW_KEY_REAL, AT(vibration_amplitude_m), 0, 1e6, "0", NULL, NULL,
   "from start_s on it vibrates along y besides, at once in full, so far to each side"},
  {"vibration_frequency_hz", PW_KEY_REAL, AT(vibration_frequency_hz), 0, 1e9, "0", NULL, NULL,
   "full swings per second"},
  {0}};
/* clang-format on */

typedef struct motion {
  const pw_prescribed_motion_param *param;
  int instance;
  pw_real mass;        /* of the body (per radian); kg */
  pw_real velocity[2]; /* of the last step; m/s */
  pw_real force[2];    /* that drives the body, mean over the last step, whole body; N */
  pw_real work;        /* of that force so far, whole body; J */
  pw_real *part;       /* scratch of sums */
} motion;

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_prescribed_motion_param *p = param;
  const pw_scene_body *b = &scene->body[p->body];
  PW_REQUIRE(b->kind != PW_BODY_ROD || p->velocity_m_s[0] == 0.0, PW_ERR_SCENE,
             "velocity_m_s: the rod '%s' moves along y only", b->name);
  PW_REQUIRE(scene->nbody == 1 || pw_scene_contacts(scene) > 0 || b->kind != PW_BODY_POINTS,
             PW_ERR_SCENE, "body '%s' needs its own velocity field: add a contact effect", b->name);
  PW_REQUIRE((p->vibration_amplitude_m > 0.0) == (p->vibration_frequency_hz > 0.0), PW_ERR_SCENE,
             "vibration_amplitude_m = %g and vibration_frequency_hz = %g: a vibration needs both",
             p->vibration_amplitude_m, p->vibration_frequency_hz);
  PW_REQUIRE(p->vibration_amplitude_m <= 0.0 || b->kind != PW_BODY_POINTS ||
                 scene->method.step_ratio_max <= 1,
             PW_ERR_SCENE, "a vibration of the points of '%s': not with step_ratio_max = %d",
             b->name, (int)scene->method.step_ratio_max);
  PW_REQUIRE(scene->geometry != PW_AXI || p->velocity_m_s[0] == 0.0, PW_ERR_SCENE,
             "velocity_m_s: in axisymmetry a body cannot be moved along the radius");
  return PW_OK;
}

/* Displacement along y that the vibration adds at time t. */
static pw_real vibration(const pw_prescribed_motion_param *p, pw_real t)
{
  const pw_real since = pw_max(t - p->start_s, 0.0);
  return p->vibration_amplitude_m * sin(2.0 * PW_PI * p->vibration_frequency_hz * since);
}

static pw_status begin(pw_sim *sim, void *ctx)
{
  motion *c = ctx;
  const pw_prescribed_motion_param *p = c->param;
  pw_body *b = &sim->body[p->body];
  pw_real ramp = pw_ramp_mean(sim->time, sim->dt, p->start_s, p->ramp_s);
  b->prescribed = true;
  for (int a = 0; a < 2; a++) {
    b->prescribed_v[a] = ramp * p->velocity_m_s[a];
  }
  if (p->vibration_amplitude_m > 0.0) {
    b->prescribed_v[1] += (vibration(p, sim->time + sim->dt) - vibration(p, sim->time)) / sim->dt;
  }
  const pw_idx n = sim->points.n, ld = sim->points.ld, body = p->body;
  const pw_idx *of = sim->points.body;
  pw_real *v = sim->points.v;
  const pw_real vx = b->prescribed_v[0], vy = b->prescribed_v[1];
#pragma omp parallel for default(none) shared(v, of, n, ld, body, vx, vy)                          \
    num_threads(sim->threads) schedule(static)
  for (pw_idx i = 0; i < n; i++) {
    if (of[i] == body) {
      v[i] = vx;
      v[ld + i] = vy;
    }
  }
  return PW_OK;
}

static void gained_momentum(const void *ctx, pw_off first, pw_off last, pw_real *sum)
{
  const pw_sim *sim = ctx;
  for (pw_off k = first; k < last; k++) {
    const pw_real *r = sim->nodes.rec + k * PW_NODE;
    for (int a = 0; a < 2; a++) {
      sum[a] += r[PW_NODE_MASS] * (r[PW_NODE_VEL + a] - r[PW_NODE_FORCE + a]);
    }
  }
}

/* A body whose given velocity goes into a slot of its field's records. */
typedef struct overwriting {
  const pw_nodes *nodes;
  const pw_body *body;
  int slot;
} overwriting;

static void overwrite_part(void *ctx, int part, int parts)
{
  const overwriting *o = ctx;
  const pw_off from = (pw_off)o->body->field * o->nodes->nnode, to = from + o->nodes->nnode;
  pw_idx i, end;
  for (pw_nodes_part(o->nodes, part, parts, &i, &end); i < end; i++) {
    pw_off k, last;
    pw_nodes_group(o->nodes, i, &k, &last);
    for (k = k > from ? k : from; k < last && k < to; k++) {
      pw_real *v = o->nodes->rec + k * PW_NODE + o->slot;
      v[0] = o->body->prescribed_v[0];
      v[1] = o->body->prescribed_v[1];
    }
  }
}

static void overwrite(const pw_sim *sim, const motion *c, int slot)
{
  pw_for_parts(sim->threads, overwrite_part,
               &(overwriting){&sim->nodes, &sim->body[c->param->body], slot});
}

/* The step of a structure is over: its force and work are known. */
static pw_status read_structure(pw_sim *sim, void *ctx)
{
  motion *c = ctx;
  const pw_structure *s = sim->structure_of[c->param->body];
  if (s) {
    for (int a = 0; a < 2; a++) {
      c->force[a] = sim->measure * s->reaction[a];
      c->velocity[a] = sim->body[s->body].prescribed_v[a];
    }
    c->work += sim->measure * s->given_work;
  }
  return PW_OK;
}

static pw_status drive(pw_sim *sim, void *ctx)
{
  motion *c = ctx;
  if (sim->structure_of[c->param->body]) {
    return PW_OK;
  }
  const pw_body *b = &sim->body[c->param->body];
  pw_real sum[PW_SUMS], work = 0.0;
  pw_sum_nodes(gained_momentum, sim, sim, (const int[]){b->field, b->field + 1}, c->part, sum);
  for (int a = 0; a < 2; a++) {
    pw_real v = b->prescribed_v[a], inertia = c->mass * (v - c->velocity[a]);
    c->force[a] = sim->measure * (inertia - sum[a]) / sim->dt;
    work += inertia * 0.5 * (v + c->velocity[a]) - sum[a] * v;
    c->velocity[a] = v;
  }
  c->work += sim->measure * work;
  sim->energy.external += sim->measure * work;
  overwrite(sim, c, PW_NODE_VEL);
  overwrite(sim, c, PW_NODE_FORCE);
  return PW_OK;
}

static pw_status drive_remapped(pw_sim *sim, void *ctx)
{
  const motion *c = ctx; /* without a first term there is no second */
  if (!sim->structure_of[c->param->body] && !pw_full_mass_adding(sim)) {
    overwrite(sim, c, sim->node_slot);
  }
  return PW_OK;
}

static void history(const pw_sim *sim, void *ctx, pw_record *row)
{
  static const char *const what[3] = {"force_x_n", "force_y_n", "work_j"};
  const motion *c = ctx;
  const pw_real value[3] = {c->force[0], c->force[1], c->work};
  (void)sim;
  for (int k = 0; k < 3; k++) {
    char name[64];
    snprintf(name, sizeof name, "prescribed_motion_%d_%s", c->instance, what[k]);
    pw_record_put(row, name, value[k]);
  }
}

static pw_status archive(pw_sim *sim, void *ctx, pw_archive *ar)
{
  motion *c = ctx;
  char name[64];
  pw_real value[5] = {c->velocity[0], c->velocity[1], c->force[0], c->force[1], c->work};
  (void)sim;
  snprintf(name, sizeof name, "prescribed_motion_%d/state", c->instance);
  PW_TRY(ar->real(ar, name, value, 5));
  memcpy(c->velocity, value, sizeof c->velocity);
  memcpy(c->force, value + 2, sizeof c->force);
  c->work = value[4];
  return PW_OK;
}

static void destroy(void **ctx)
{
  motion *c = *ctx;
  if (c) {
    pw_mem_free(&c->part);
  }
  pw_mem_free(ctx);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  motion *c;
  PW_TRY(pw_mem_alloc("prescribed motion", 1, sizeof *c, &c));
  *ctx = c;
  c->param = param;
  c->instance = pw_effect_instance(sim, param);
  const int body = c->param->body;
  const bool points = !sim->structure_of[body];
  for (int b = 0; b < sim->nbody; b++) {
    PW_REQUIRE(b == body || !points || sim->structure_of[b] ||
                   sim->body[b].field != sim->body[body].field,
               PW_ERR_SCENE,
               "bodies '%s' and '%s' share a velocity field: '%s' must be the contact's master or "
               "its only slave",
               sim->body[body].name, sim->body[b].name, sim->body[body].name);
  }
  pw_points *p = &sim->points;
  for (int a = 0; a < 2; a++) {
    c->velocity[a] = c->param->start_s + c->param->ramp_s > 0.0 ? 0.0 : c->param->velocity_m_s[a];
    sim->body[body].prescribed_v[a] = c->velocity[a];
  }
  sim->body[body].prescribed = true;
  if (!points) {
    pw_structure_set_velocity(sim->structure_of[body], c->velocity);
    return PW_OK;
  }
  for (pw_idx i = 0; i < p->n; i++) {
    if (p->body[i] == body) {
      c->mass += p->mass[i];
      p->v[i] = c->velocity[0];
      p->v[p->ld + i] = c->velocity[1];
    }
  }
  return pw_mem_alloc("prescribed motion sums", pw_sum_scratch(sim->nodes.nnode), sizeof(pw_real),
                      &c->part);
}

static const pw_hook hooks[] = {
    {PW_STAGE_BEGIN, begin},
    {PW_STAGE_CONSTRAINT, drive},
    {PW_STAGE_REMAP, drive_remapped},
    {PW_STAGE_END, read_structure},
    {0, NULL},
};

const pw_effect pw_effect_prescribed_motion = {
    .name = "prescribed_motion",
    .brief = "a body whose velocity is given",
    .structure_key = "body",
    .many = true,
    .keys = keys,
    .hooks = hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
    .history = history,
    .archive = archive,
};
