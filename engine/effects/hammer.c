/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pulses of pressure on the top of a body (thesis section 4.2). */
#include "engine/effects/common.h"
#include "engine/effects/load_curve.h"
#include "engine/effects/params.h"
#include "engine/effects/surface_load.h"

#include "engine/core/mem.h"

#define AT(member) offsetof(pw_hammer_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"body", PW_KEY_BODY, AT(body), 0, 0, NULL, NULL, NULL, "body that is struck on its top"},
  {"pressure_pa", PW_KEY_REAL, AT(pressure_pa), 0, 1e15, NULL, NULL, NULL, "peak of the pulses"},
  {"duration_s", PW_KEY_REAL, AT(duration_s), 1e-9, 1e6, NULL, NULL, NULL, "length of a pulse"},
  {"period_s", PW_KEY_REAL, AT(period_s), 0, 1e6, "0", NULL, NULL,
   "time from the start of one pulse to the next; 0 with a single pulse"},
  {"count", PW_KEY_INT, AT(count), 1, 1e6, "1", NULL, NULL, "number of pulses"},
  {"start_s", PW_KEY_REAL, AT(start_s), 0, 1e12, "0", NULL, NULL, "start of the first pulse"},
  {"pulse", PW_KEY_CHOICE, AT(pulse), 0, 0, "rectangular", "rectangular|half_sine", NULL,
   "impulse per area: pressure x duration, or 2/pi of it for a half sine of the same peak"},
  {"rise_s", PW_KEY_REAL, AT(rise_s), 0, 1e6, "0", NULL, "pulse=rectangular",
   "linear rise from the start and fall from start + duration; the impulse does not change"},
  {0}};
/* clang-format on */

typedef struct hammer {
  const pw_hammer_param *param;
  pw_surface_load load;
  pw_pulse pulse;
  pw_real force;   /* mean over the last step, whole body; N */
  pw_real impulse; /* given so far, whole body; N s */
} hammer;

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_hammer_param *p = param;
  const pw_scene_body *b = &scene->body[p->body];
  PW_REQUIRE(scene->method.update != PW_IMPLICIT || pw_scene_find_effect(scene, "dynamics"),
             PW_ERR_SCENE, "hammer: implicit steps (method.update) know it with dynamics only");
  PW_REQUIRE(b->kind == PW_BODY_POINTS || b->shape != PW_SHAPE_DISC, PW_ERR_SCENE,
             "body: the disc '%s' has no head that a hammer could strike", b->name);
  PW_REQUIRE(p->rise_s <= p->duration_s, PW_ERR_SCENE,
             "rise_s = %g s is longer than duration_s = %g s", p->rise_s, p->duration_s);
  pw_real length = p->duration_s + (p->pulse == PW_PULSE_RECTANGULAR ? p->rise_s : 0.0);
  PW_REQUIRE(p->count == 1 || p->period_s >= length, PW_ERR_SCENE,
             "period_s = %g s is shorter than a pulse of %g s", p->period_s, length);
  return PW_OK;
}

static pw_status add_force(pw_sim *sim, void *ctx)
{
  hammer *c = ctx;
  pw_real factor = pw_pulse_mean(&c->pulse, sim->time, sim->dt);
  c->force = 0.0;
  pw_structure *s = sim->structure_of[c->param->body];
  if (factor > 0.0 && s) {
    pw_real force = c->param->pressure_pa * factor * s->head_area;
    pw_structure_add_head_force(s, -force);
    c->force = sim->measure * force;
  } else if (factor > 0.0) {
    c->force = pw_surface_load_apply(sim, &c->load, c->param->pressure_pa * factor);
  }
  c->impulse += c->force * sim->dt;
  return PW_OK;
}

static pw_status add_work(pw_sim *sim, void *ctx)
{
  const hammer *c = ctx;
  if (c->force > 0.0 && !sim->structure_of[c->param->body]) {
    sim->energy.external += pw_surface_load_work(sim, &c->load);
  }
  return PW_OK;
}

/* Implicit steps: the mean over the part acts at its end, so that the whole impulse is given. At rest,
 * before the first step, nothing acts yet. */
static pw_status press(pw_sim *sim, void *ctx)
{
  hammer *c = ctx;
  pw_real factor = sim->dt > 0.0 ? pw_pulse_mean(&c->pulse, sim->time, sim->dt) : 0.0;
  c->force = 0.0;
  if (factor > 0.0) {
    c->force = pw_surface_load_apply(sim, &c->load, c->param->pressure_pa * factor);
  }
  return PW_OK;
}

static pw_status add_impulse(pw_sim *sim, void *ctx)
{
  hammer *c = ctx;
  c->impulse += c->force * sim->dt;
  return add_work(sim, ctx);
}

static void history(const pw_sim *sim, void *ctx, pw_record *row)
{
  const hammer *c = ctx;
  (void)sim;
  pw_record_put(row, "hammer_force_n", c->force);
}

static void results(const pw_sim *sim, void *ctx, pw_record *out)
{
  const hammer *c = ctx;
  pw_record_put(out, "hammer_impulse_n_s", c->impulse);
  pw_record_put(out, "blows", (pw_real)pw_pulse_started(&c->pulse, sim->time));
}

static pw_status archive(pw_sim *sim, void *ctx, pw_archive *ar)
{
  hammer *c = ctx;
  (void)sim;
  PW_TRY(ar->real(ar, "hammer/force", &c->force, 1));
  return ar->real(ar, "hammer/impulse", &c->impulse, 1);
}

static void destroy(void **ctx)
{
  hammer *c = *ctx;
  if (c) {
    pw_surface_load_destroy(&c->load);
  }
  pw_mem_free(ctx);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  hammer *c;
  PW_TRY(pw_mem_alloc("hammer", 1, sizeof *c, &c));
  *ctx = c;
  const pw_hammer_param *p = param;
  c->param = p;
  c->pulse = (pw_pulse){p->pulse, p->start_s, p->duration_s, p->rise_s, p->period_s, p->count};
  return sim->structure_of[p->body] ? PW_OK
                                    : pw_surface_load_create(sim, p->body, PW_SIDE_TOP, &c->load);
}

static const pw_hook hooks[] = {
    {PW_STAGE_NODE_FORCE, add_force},
    {PW_STAGE_END, add_work},
    {0, NULL},
};

static const pw_hook implicit_hooks[] = {
    {PW_STAGE_NODE_FORCE, press},
    {PW_STAGE_END, add_impulse},
    {0, NULL},
};

const pw_effect pw_effect_hammer = {
    .name = "hammer",
    .brief = "pulses of pressure on the top of a body",
    .structure_key = "body",
    .keys = keys,
    .hooks = hooks,
    .implicit = implicit_hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
    .history = history,
    .results = results,
    .archive = archive,
};
