/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stages of element tests as steps of the driver. */
#include "engine/element_test.h"

#include <math.h>
#include <string.h>

#include "kernels/spectral.h"

enum { XX, YY, ZZ, XY, SECANT = 60 };

/** A test under way. */
typedef struct stages {
  const pw_element_test *t;
  pw_element el;
  pw_element_report report;
  void *ctx;
  int stage, step;
  pw_real pore, pore_start; /* excess pore pressure now and at the start of the stage */
  pw_real stress_start[6];  /* at the start of the stage */
  pw_real strain_start[6];
  pw_real slope; /* of the measured stress over the driven strain; 0: not known */
} stages;

static const pw_element_stage *stage_of(const stages *s)
{
  return &s->t->stage[s->stage - 1];
}

static bool is_undrained(const pw_element_stage *g)
{
  return !g->drained && g->kind >= PW_STAGE_TRIAXIAL && g->kind <= PW_STAGE_SIMPLE_SHEAR;
}

/** The step that a strain @p x of the driven component makes. */
static pw_element_step strain_step(const stages *s, pw_real x)
{
  const pw_element_stage *g = stage_of(s);
  const bool undrained = is_undrained(g);
  pw_element_step step = {.value = {0}};
  switch (g->kind) {
  case PW_STAGE_ISOTROPIC:
    step.value[XX] = step.value[YY] = step.value[ZZ] = x;
    break;
  case PW_STAGE_TRIAXIAL:
    step.value[YY] = x;
    step.value[XX] = step.value[ZZ] = -0.5 * x;
    if (!undrained) {
      step.control[XX] = step.control[ZZ] = PW_CONTROL_STRESS;
      step.value[XX] = s->stress_start[XX];
      step.value[ZZ] = s->stress_start[ZZ];
    }
    break;
  case PW_STAGE_BIAXIAL:
    step.value[YY] = x;
    step.value[XX] = -x;
    if (!undrained) {
      step.control[XX] = PW_CONTROL_STRESS;
      step.value[XX] = s->stress_start[XX];
    }
    break;
  case PW_STAGE_SIMPLE_SHEAR:
    step.value[XY] = 0.5 * x;
    step.spin[0] = 0.5 * x;
    if (!undrained) {
      step.control[YY] = PW_CONTROL_STRESS;
      step.value[YY] = s->stress_start[YY];
    }
    break;
  default: /* oedometric */
    step.value[YY] = x;
    break;
  }
  return step;
}

/** The stress that belongs to the driven strain: sigma_yy (undrained: total), or sigma_xy. */
static pw_real measured(const stages *s, const pw_element *el)
{
  const pw_element_stage *g = stage_of(s);
  if (g->kind == PW_STAGE_SIMPLE_SHEAR) {
    return el->stress[XY];
  }
  if (is_undrained(g)) {
    return el->stress[YY] - el->stress[XX] + s->stress_start[XX] - s->pore_start;
  }
  return el->stress[YY];
}

static pw_status done(stages *s)
{
  const pw_element_stage *g = stage_of(s);
  int held = g->kind == PW_STAGE_SIMPLE_SHEAR ? YY : XX;
  if (is_undrained(g)) {
    s->pore = s->pore_start + s->el.stress[held] - s->stress_start[held];
  }
  s->step++;
  pw_element_row row = {s->stage, s->step, s->pore, &s->el};
  return s->report(s->ctx, &row);
}

static pw_status drive(stages *s, const pw_element_step *step)
{
  s->el.why = NULL;
  pw_status status = pw_element_drive(&s->el, step);
  PW_REQUIRE(status == PW_OK || !s->el.why, PW_RETRY_DIVERGED, "stage %d, step %d: %s", s->stage,
             s->step + 1, s->el.why);
  PW_REQUIRE(status == PW_OK, PW_RETRY_DIVERGED,
             "stage %d, step %d cannot be made (%s): the stress asked for may be out of reach",
             s->stage, s->step + 1, pw_status_text(status));
  return done(s);
}

/** Find the driven strain that gives a stress, by secants; strains that fail are halved. */
static pw_status drive_to_stress(stages *s, pw_real target)
{
  const pw_real tolerance = 1e-9 * (fabs(target) + fabs(s->el.stress[YY]) + 1.0);
  const pw_element start = s->el;
  pw_real x0 = 0.0, f0 = measured(s, &start) - target;
  pw_real x1 = s->slope > 0.0 ? -f0 / s->slope : copysign(1e-7, -f0);
  bool reached = fabs(f0) <= tolerance;
  for (int it = 0; it < SECANT && !reached; it++) {
    pw_element trial = start;
    pw_element_step step = strain_step(s, x1);
    if (pw_element_drive(&trial, &step) != PW_OK) {
      x1 = 0.5 * (x0 + x1);
      continue;
    }
    pw_real f1 = measured(s, &trial) - target, slope = (f1 - f0) / (x1 - x0);
    reached = fabs(f1) <= tolerance;
    s->el = trial;
    s->slope = slope > 0.0 ? slope : s->slope;
    pw_real next = x1 - f1 / (slope > 0.0 ? slope : pw_max(s->slope, 1e-3));
    pw_real limit = 4.0 * fabs(x1) + 1e-7;
    x0 = x1;
    f0 = f1;
    x1 = pw_max(-limit, pw_min(limit, next));
  }
  if (!reached) {
    s->el = start;
  }
  PW_REQUIRE(reached && isfinite(x0), PW_RETRY_DIVERGED,
             "stage %d, step %d: a stress of %g Pa is out of reach", s->stage, s->step + 1, target);
  return done(s);
}

static pw_status strain_leg(stages *s, pw_real from, pw_real to)
{
  const int n = stage_of(s)->steps;
  for (int i = 0; i < n; i++) {
    pw_element_step step = strain_step(s, (to - from) / n);
    PW_TRY(drive(s, &step));
  }
  return PW_OK;
}

static pw_status stress_leg(stages *s, pw_real to)
{
  const pw_element_stage *g = stage_of(s);
  const bool by_secants = is_undrained(g) || g->kind == PW_STAGE_SIMPLE_SHEAR;
  const pw_real from = measured(s, &s->el);
  pw_real begin[6];
  memcpy(begin, s->el.stress, sizeof begin);
  s->slope = 0.0;
  for (int i = 1; i <= g->steps; i++) {
    pw_real share = (pw_real)i / g->steps;
    if (by_secants) {
      PW_TRY(drive_to_stress(s, from + share * (to - from)));
      continue;
    }
    pw_element_step step = strain_step(s, 0.0);
    for (int c = 0; c < 3; c++) {
      if (c == YY || g->kind == PW_STAGE_ISOTROPIC) {
        step.control[c] = PW_CONTROL_STRESS;
        step.value[c] = begin[c] + share * (to - begin[c]);
      }
    }
    PW_TRY(drive(s, &step));
  }
  return PW_OK;
}

static pw_status loaded_stage(stages *s)
{
  const pw_element_stage *g = stage_of(s);
  pw_real at = 0.0;
  for (int cycle = 0; cycle < g->cycles; cycle++) {
    for (int k = 0; k < g->to_strain.n; k++) {
      PW_TRY(strain_leg(s, at, g->to_strain.v[k]));
      at = g->to_strain.v[k];
    }
    for (int k = 0; k < g->to_stress_pa.n; k++) {
      PW_TRY(stress_leg(s, g->to_stress_pa.v[k]));
    }
  }
  return PW_OK;
}

/** One way of a mixed stage: to its targets, or back to where it began. */
static pw_status mixed_leg(stages *s, bool back)
{
  const pw_element_stage *g = stage_of(s);
  const pw_element begin = s->el;
  for (int i = 1; i <= g->steps; i++) {
    pw_element_step step = {.value = {0}};
    for (int c = 0; c < 6; c++) {
      pw_real share = (pw_real)i / g->steps, target = g->mixed_target.v[c];
      if (g->mixed_stress.v[c] > 0.5) {
        pw_real to = back ? s->stress_start[c] : target;
        step.control[c] = PW_CONTROL_STRESS;
        step.value[c] = begin.stress[c] + share * (to - begin.stress[c]);
      } else {
        pw_real to = s->strain_start[c] + (back ? 0.0 : target);
        step.value[c] = (to - begin.strain[c]) / g->steps;
      }
    }
    PW_TRY(drive(s, &step));
  }
  return PW_OK;
}

static pw_status mixed_stage(stages *s)
{
  const int cycles = stage_of(s)->cycles;
  for (int cycle = 0; cycle < cycles; cycle++) {
    PW_TRY(mixed_leg(s, false));
    if (cycles > 1) {
      PW_TRY(mixed_leg(s, true));
    }
  }
  return PW_OK;
}

static pw_status path_stage(stages *s)
{
  const pw_element_stage *g = stage_of(s);
  pw_real last[9] = {0};
  for (int i = 0; i < g->npath; i++) {
    const pw_real *row = g->path[i];
    pw_element_step step = {.value = {0}};
    for (int c = 0; c < 6; c++) {
      step.value[c] = row[c] - last[c];
    }
    for (int c = 0; c < 3; c++) {
      step.spin[c] = row[6 + c] - last[6 + c];
    }
    memcpy(last, row, sizeof last);
    PW_TRY(drive(s, &step));
  }
  return PW_OK;
}

static pw_status start(stages *s)
{
  const pw_element_test *t = s->t;
  const pw_material *m = t->material.model;
  PW_TRY(pw_element_start(&s->el, m, t->material.param, t->stress_pa));
  if (m->place) {
    m->place(t->material.param, 1, 1, &t->height_y_m, s->el.state);
    m->init(t->material.param, 1, 1, s->el.stress, s->el.state);
  }
  const pw_real none[6] = {0};
  pw_element first = s->el; /* for the wave speed; the state stays that of the start */
  if (pw_element_move(&first, none, NULL, NULL) == PW_OK) {
    s->el.wave_speed = first.wave_speed;
  }
  pw_element_row row = {0, 0, 0.0, &s->el};
  return s->report(s->ctx, &row);
}

pw_status pw_element_test_run(const pw_element_test *t, pw_element_report report, void *ctx)
{
  stages s = {.t = t, .report = report, .ctx = ctx};
  PW_TRY(start(&s));
  for (s.stage = 1; s.stage <= t->nstage; s.stage++) {
    const pw_element_stage *g = stage_of(&s);
    s.step = 0;
    s.pore_start = s.pore;
    memcpy(s.stress_start, s.el.stress, sizeof s.stress_start);
    memcpy(s.strain_start, s.el.strain, sizeof s.strain_start);
    PW_TRY(g->kind == PW_STAGE_MIXED  ? mixed_stage(&s)
           : g->kind == PW_STAGE_PATH ? path_stage(&s)
                                      : loaded_stage(&s));
  }
  return PW_OK;
}

pw_real pw_element_friction_angle(const pw_real *stress)
{
  pw_spectrum s = pw_t6_spectrum(pw_t6_load(stress, 1));
  pw_real high = pw_max(s.value[0], pw_max(s.value[1], s.value[2]));
  pw_real low = pw_min(s.value[0], pw_min(s.value[1], s.value[2]));
  if (high == low) {
    return 0.0;
  }
  return high < 0.0 ? asin((low - high) / (low + high)) * 57.295779513082320877 : 90.0;
}
