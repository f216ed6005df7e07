/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/schedule.h"

#include <stdio.h>

#include "engine/assemble.h"

static void append_effect(pw_sim *sim, int e, pw_stage stage)
{
  const pw_effect *type = sim->scene.effect[e].type;
  const bool implicit = sim->scene.method.update == PW_IMPLICIT;
  for (const pw_hook *h = implicit ? type->implicit : type->hooks; h && h->fn; h++) {
    if (h->stage == stage) {
      sim->schedule.hook[sim->schedule.n++] =
          (pw_scheduled){.stage = stage, .fn = h->fn, .ctx = sim->ctx[e], .effect = type->name};
    }
  }
  for (const pw_part_hook *h = implicit ? NULL : type->part_hooks; h && h->fn; h++) {
    if (h->stage == stage) {
      sim->schedule.hook[sim->schedule.n++] =
          (pw_scheduled){.stage = stage, .ctx = sim->ctx[e], .effect = type->name, .part = h->fn};
    }
  }
}

void pw_schedule_build(pw_sim *sim)
{
  sim->schedule = (pw_schedule){0};
  for (int stage = 0; stage < PW_STAGE_COUNT; stage++) {
    const bool runs = stage != PW_STAGE_MASS || sim->full_mass;
    sim->schedule.start[stage] = sim->schedule.n;
    for (int rank = 0; runs && pw_effect_at(rank); rank++) {
      for (int e = 0; e < sim->scene.neffect; e++) {
        if (sim->scene.effect[e].type == pw_effect_at(rank)) {
          append_effect(sim, e, (pw_stage)stage);
        }
      }
    }
  }
  sim->schedule.start[PW_STAGE_COUNT] = sim->schedule.n;
}

/* A hook that runs by parts, after one that does not. */
typedef struct late_hook {
  const pw_sim *sim;
  const pw_scheduled *hook;
} late_hook;

static void run_late(void *ctx, int part, int parts)
{
  const late_hook *l = ctx;
  l->hook->part(l->sim, l->hook->ctx, part, parts);
}

/* The first hook of a stage that does not run by parts, or the end of the stage. */
static int first_whole(const pw_schedule *s, pw_stage stage)
{
  int k = s->start[stage];
  while (k < s->start[stage + 1] && s->hook[k].part) {
    k++;
  }
  return k;
}

pw_status pw_schedule_run(pw_sim *sim, pw_stage stage)
{
  const pw_schedule *s = &sim->schedule;
  for (int k = first_whole(s, stage); k < s->start[stage + 1]; k++) {
    if (s->hook[k].part) {
      pw_for_parts(sim->threads, run_late, &(late_hook){sim, &s->hook[k]});
    } else {
      PW_TRY(s->hook[k].fn(sim, s->hook[k].ctx));
    }
  }
  return PW_OK;
}

void pw_schedule_run_part(const pw_sim *sim, pw_stage stage, int part, int parts)
{
  const pw_schedule *s = &sim->schedule;
  for (int k = s->start[stage]; k < first_whole(s, stage); k++) {
    s->hook[k].part(sim, s->hook[k].ctx, part, parts);
  }
}

void pw_sim_schedule_text(const pw_sim *sim, char *text, size_t size)
{
  static const char *const names[PW_STAGE_COUNT] = {
      "start", "begin",     "p2g",   "node_force", "weight", "node_total", "constraint",
      "mass",  "remap_p2g", "remap", "motion",     "mesh",   "end"};
  size_t used = 0;
  if (size > 0) {
    text[0] = '\0';
  }
  for (int k = 0; k < sim->schedule.n && used < size; k++) {
    const pw_scheduled *h = &sim->schedule.hook[k];
    int n = snprintf(text + used, size - used, "%s: %s\n", names[h->stage], h->effect);
    used += n > 0 ? (size_t)n : 0;
  }
}
