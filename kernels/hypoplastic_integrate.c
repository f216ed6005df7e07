/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/hypoplastic.h"

#include "kernels/hypoplastic_heun.h"

/** One integration in progress; stresses are sigma* throughout. */
typedef struct run {
  const pw_hypo *h;
  pw_t6 de;
  pw_real size, dvol; /* |dE|, the volume ratio of the increment */
  pw_real log_dvol;   /* its logarithm, once it is needed; else NaN */
  pw_real specific;   /* 1 + e at the start */
  pw_t6 stress, delta;
  pw_real substep;
  pw_hypo_slope last; /* at the end of the last substep tried */
  bool swept;         /* delta has reached R dE/|dE| and stays there */
  pw_hypo_path *path;
  pw_material_counts counts;
} run;

/** 1 + e grows as exp(t ln dvol); the ends and the middle of the increment do without both. */
static pw_real void_ratio_at(run *r, pw_real t)
{
  if (t == 0.0 || t == 0.5 || t == 1.0) {
    return r->specific * (t == 0.0 ? 1.0 : (t == 1.0 ? r->dvol : sqrt(r->dvol))) - 1.0;
  }
  r->log_dvol = isnan(r->log_dvol) ? pw_log(r->dvol) : r->log_dvol;
  return r->specific * pw_exp(t * r->log_dvol) - 1.0;
}

/** Rates in one of their forms, each compiled on its own. */
#define RATES(form)                                                                                \
  static void rates_##form(const run *r, const pw_t6 *stress, const pw_t6 *delta, pw_real e,       \
                           pw_hypo_slope *k)                                                       \
  {                                                                                                \
    *k = pw_hypo_slope_of(r->h, *stress, *delta, e, r->de, r->size, form);                         \
  }
RATES(0)
RATES(1)
RATES(2)
RATES(3)
static void (*const rates[PW_HYPO_FORMS])(const run *, const pw_t6 *, const pw_t6 *, pw_real,
                                          pw_hypo_slope *) = {rates_0, rates_1, rates_2, rates_3};

/** Rates at a stage; a stress beyond the limits is moved back first. */
PW_INLINE void stage(run *r, pw_t6 *stress, const pw_t6 *delta, pw_real t, pw_hypo_slope *k)
{
  int form = r->swept ? r->h->form & ~PW_HYPO_WITH : r->h->form;
  pw_real e = void_ratio_at(r, t);
  r->counts.rhs++;
  rates[form](r, stress, delta, e, k);
  if (!(k->inside > 0.0)) {
    *stress = pw_hypo_limit(r->h, *stress);
    rates[form](r, stress, delta, e, k);
  }
  if (r->swept) {
    k->delta = (pw_t6){0};
  }
}

/** An embedded step of orders 3(2) from @p k1: nodes 0, 1/2, 1, weights 1/6, 2/3, 1/6. */
PW_INLINE pw_real attempt(run *r, const pw_hypo_slope *k1, pw_real t, pw_real step, pw_t6 *stress,
                          pw_t6 *delta)
{
  pw_t6 mid = pw_t6_axpy(r->stress, 0.5 * step, k1->stress);
  pw_t6 mid_delta = pw_t6_axpy(r->delta, 0.5 * step, k1->delta);
  pw_hypo_slope k2, *k3 = &r->last;
  stage(r, &mid, &mid_delta, t + 0.5 * step, &k2);
  pw_t6 end = pw_t6_axpy(pw_t6_axpy(r->stress, -step, k1->stress), 2.0 * step, k2.stress);
  pw_t6 end_delta = pw_t6_axpy(pw_t6_axpy(r->delta, -step, k1->delta), 2.0 * step, k2.delta);
  stage(r, &end, &end_delta, t + step, k3);
  pw_t6 sum = pw_t6_axpy(pw_t6_axpy(k1->stress, 4.0, k2.stress), 1.0, k3->stress);
  pw_t6 sum_delta = pw_t6_axpy(pw_t6_axpy(k1->delta, 4.0, k2.delta), 1.0, k3->delta);
  pw_t6 err = pw_t6_axpy(pw_t6_axpy(k1->stress, -2.0, k2.stress), 1.0, k3->stress);
  pw_t6 err_delta = pw_t6_axpy(pw_t6_axpy(k1->delta, -2.0, k2.delta), 1.0, k3->delta);
  pw_real sixth = step * (1.0 / 6.0);
  *stress = pw_t6_axpy(r->stress, sixth, sum);
  *delta = pw_t6_axpy(r->delta, sixth, sum_delta);
  pw_real on_stress = pw_t6_norm(err) / (pw_t6_norm(*stress) + 1000.0);
  pw_real on_delta = pw_t6_norm(err_delta) * r->h->inv_r;
  return sixth * (on_delta > on_stress ? on_delta : on_stress); /* NaN when the stress is */
}

/** Intergranular strain alone over a part @p rest of the increment (it needs no stress). */
static pw_t6 evolve_delta(const run *r, pw_real rest)
{
  const pw_hypo *h = r->h;
  pw_real length = rest * r->size / (0.5 * h->r);
  if (!h->intergranular || r->size == 0.0) {
    return r->delta;
  }
  if (length > 30.0) { /* more than 15 R: it has turned into the direction of the increment */
    return pw_t6_scale(h->r / r->size, r->de);
  }
  int n = (int)length + 1;
  pw_t6 delta = r->delta, step = pw_t6_scale(rest / n, r->de);
  for (int i = 0; i < n; i++) {
    pw_t6 at = delta, move = step;
    for (int k = 0; k < 2; k++) {
      pw_real dd = pw_max(pw_t6_dot(at, at), 1e-200), turn = pw_t6_dot(at, step);
      pw_real rho_beta = pw_exp(0.5 * h->beta_r * pw_log(dd * h->inv_r2));
      move = pw_t6_axpy(step, turn > 0.0 ? -rho_beta * turn / dd : 0.0, at);
      at = pw_t6_axpy(delta, 0.5, move);
    }
    delta = pw_hypo_clip(h, pw_t6_axpy(delta, 1.0, move));
  }
  return delta;
}

static void record(run *r, pw_real t, int kind)
{
  r->counts.substeps++;
  if (r->path && r->path->n < PW_HYPO_PATH_STEPS) {
    r->path->end[r->path->n] = t;
    r->path->kind[r->path->n++] = (unsigned char)kind;
  }
}

static void accept(run *r, pw_t6 stress, pw_t6 delta)
{
  bool inside = pw_hypo_inside(r->h, stress);
  r->stress = inside ? stress : pw_hypo_limit(r->h, stress);
  r->counts.cut_off += inside ? 0 : 1;
  if (r->h->intergranular) {
    r->delta = pw_hypo_clip(r->h, delta);
  }
}

/**
 * A stress-free point that the rest of the increment keeps stress-free takes it at once: the
 * error control would spend its substeps on a stress that is cut off after each of them.
 */
static bool separated(run *r, const pw_hypo_slope *k1, pw_real rest)
{
  pw_real trace = pw_t6_trace(r->stress), least = -3.0 * r->h->p_min;
  if (trace < least * (1.0 + 1e-9) || trace + rest * pw_t6_trace(k1->stress) < least) {
    return false;
  }
  accept(r, pw_t6_axpy(r->stress, rest, k1->stress), evolve_delta(r, rest));
  r->last = *k1;
  return true;
}

/** Within a hundredth of the tolerance (relative to R) of full mobilisation, delta = R dE/|dE| solves its rate and
 *  the rates become those without intergranular strain: no need to follow its decay. */
static bool becomes_swept(run *r)
{
  if (!r->h->intergranular || r->swept || r->size <= PW_HYPO_SWEEP * r->h->r) {
    return false;
  }
  pw_t6 full = pw_t6_scale(r->h->r / r->size, r->de);
  pw_t6 off = pw_t6_axpy(full, -1.0, r->delta);
  pw_real near = 0.01 * r->h->tolerance * r->h->r;
  if (pw_t6_dot(off, off) > near * near) {
    return false;
  }
  r->delta = full;
  r->swept = true;
  return true;
}

/** One step of Heun's method, in one of the forms of the rates, each compiled on its own. */
#define HEUN(form)                                                                                 \
  static void heun_##form(const run *r, const pw_hypo_increment *whole, pw_hypo_heun *out)         \
  {                                                                                                \
    *out = pw_hypo_heun_step(r->h, r->stress, r->delta, *whole, form);                             \
  }
HEUN(1)
HEUN(3)

/** One step of Heun's method over the whole increment; true when it stands. */
static bool one_step(run *r, pw_hypo_heun *to)
{
  pw_hypo_increment whole = {r->de, r->size, r->specific - 1.0, void_ratio_at(r, 1.0)};
  r->counts.rhs += 2;
  (r->h->form & PW_HYPO_UNIT ? heun_3 : heun_1)(r, &whole, to);
  return to->good > 0.0;
}

/** Take the whole increment in one step of Heun's method where it is small enough; else false. */
static bool small(run *r)
{
  pw_hypo_heun to;
  bool pressed = -pw_t6_trace(r->stress) > 3.0 * r->h->p_min * (1.0 + 1e-9); /* not stress-free */
  if (!r->h->intergranular || r->substep < 1.0 || !pressed ||
      !(pw_hypo_heun_pays(r->h, r->size) > 0.0) || !one_step(r, &to)) {
    return false;
  }
  accept(r, to.stress, to.delta);
  r->last = to.last;
  record(r, 1.0, PW_HYPO_HEUN);
  return true;
}

/** Integrate from @p t to @p end with error control. */
static void advance(run *r, pw_real t, pw_real end)
{
  pw_hypo_slope k1;
  bool moved = true;
  while (t < end) {
    if (moved) {
      stage(r, &r->stress, &r->delta, t, &k1);
      if (separated(r, &k1, end - t)) {
        record(r, end, PW_HYPO_SEPARATED);
        return;
      }
    }
    bool exhausted = r->counts.substeps >= r->h->max_substeps;
    bool last = exhausted || r->substep >= (end - t) * (1.0 - 1e-9);
    pw_real step = last ? end - t : r->substep;
    pw_t6 stress, delta;
    pw_real err = attempt(r, &k1, t, step, &stress, &delta);
    bool good = err <= r->h->tolerance;
    bool forced = !good && (exhausted || step <= PW_HYPO_SUBSTEP_MIN);
    if (!(good && last && r->substep >= 1.0)) { /* else it stays at 1 */
      /* an error that is not a number: a quarter */
      pw_real next = pw_hypo_next_substep(r->h, step, err);
      next = err >= 0.0 ? next : pw_max(PW_HYPO_SUBSTEP_MIN, 0.25 * step);
      r->substep = good && last ? pw_max(r->substep, next) : next;
    }
    moved = good || forced;
    if (!moved) {
      r->counts.rejected++;
      continue;
    }
    if (!(pw_t6_is_finite(stress) > 0.0) || !(pw_t6_is_finite(delta) > 0.0)) {
      stress = r->stress;
      delta = pw_t6_axpy(r->delta, step, r->de);
    }
    accept(r, stress, delta);
    t = last ? end : t + step;
    r->counts.forced += forced ? 1 : 0;
    record(r, t, t < 1.0 && becomes_swept(r) ? PW_HYPO_SWEPT : PW_HYPO_RUNGE_KUTTA);
  }
}

/** Start a run; false when the increment cannot be taken. */
static bool begin(run *r, const pw_hypo *h, pw_t6 de, pw_real dvol, const pw_hypo_point *p)
{
  *r = (run){.h = h, .de = de, .size = pw_t6_norm(de), .delta = p->delta, .substep = p->substep};
  r->stress = pw_t6_shift(p->stress, -h->p_t);
  r->specific = 1.0 + p->void_ratio;
  bool usable = dvol > 0.0 && r->specific * dvol > 1.0 + 1e-9 && isfinite(r->specific * dvol);
  r->dvol = usable ? dvol : 1.0;
  r->log_dvol = (pw_real)NAN;
  if (!(r->substep > 0.0 && r->substep <= 1.0)) {
    r->substep = 1.0;
  }
  return usable && isfinite(r->size) && pw_t6_is_finite(p->stress) > 0.0 &&
         pw_t6_is_finite(p->delta) > 0.0;
}

static pw_real turning_time(const run *r)
{
  return r->h->intergranular ? pw_hypo_turning_time(r->delta, r->de) : 0.0;
}

static pw_status finish(const run *r, pw_real dvol, pw_hypo_point *p)
{
  if (!(pw_t6_is_finite(r->stress) > 0.0) || !(pw_t6_is_finite(r->delta) > 0.0)) {
    return PW_RETRY_STRESS;
  }
  p->stress = pw_t6_shift(r->stress, r->h->p_t);
  p->delta = r->delta;
  p->void_ratio = (1.0 + p->void_ratio) * dvol - 1.0;
  p->substep = r->substep;
  return PW_OK;
}

pw_status pw_hypo_integrate(const pw_hypo *h, pw_t6 de, pw_real dvol, pw_hypo_point *p,
                            pw_hypo_path *path, pw_material_counts *counts, pw_real *modulus)
{
  run r;
  if (!begin(&r, h, de, dvol, p)) {
    return PW_RETRY_STRESS;
  }
  pw_real split = turning_time(&r);
  r.path = path;
  if (path) {
    path->n = 0;
    path->split = split;
  }
  if (split > 0.0) {
    advance(&r, 0.0, split);
  }
  if (split > 0.0 || !small(&r)) {
    advance(&r, split, 1.0);
  }
  PW_TRY(finish(&r, dvol, p));
  if (counts) {
    counts->substeps += r.counts.substeps;
    counts->rhs += r.counts.rhs;
    counts->rejected += r.counts.rejected;
    counts->forced += r.counts.forced;
    counts->cut_off += r.counts.cut_off;
  }
  if (modulus) {
    *modulus = pw_hypo_modulus(h, r.last);
  }
  return PW_OK;
}

pw_status pw_hypo_repeat(const pw_hypo *h, pw_t6 de, pw_real dvol, pw_hypo_point *p,
                         const pw_hypo_path *path)
{
  run r;
  if (!begin(&r, h, de, dvol, p)) {
    return PW_RETRY_STRESS;
  }
  pw_real t = 0.0, split = turning_time(&r), was = path->split;
  bool stretch = was > 0.0 && split > 0.0;
  for (int i = 0; i < path->n; i++) {
    pw_hypo_slope k1;
    if (path->kind[i] == PW_HYPO_HEUN) {
      pw_hypo_heun to;
      (void)one_step(&r, &to);
      accept(&r, to.stress, to.delta);
      continue;
    }
    stage(&r, &r.stress, &r.delta, t, &k1);
    pw_real end = path->end[i];
    if (stretch && i < path->n - 1) {
      end = end <= was ? end * (split / was) : 1.0 - (1.0 - end) * ((1.0 - split) / (1.0 - was));
    }
    pw_real step = end - t;
    t = end;
    if (path->kind[i] == PW_HYPO_SEPARATED && separated(&r, &k1, step)) {
      continue;
    }
    pw_t6 stress, delta;
    (void)attempt(&r, &k1, t - step, step, &stress, &delta);
    accept(&r, stress, delta);
    if (path->kind[i] == PW_HYPO_SWEPT && r.size > 0.0) {
      r.delta = pw_t6_scale(h->r / r.size, de);
      r.swept = true;
    }
  }
  return finish(&r, dvol, p);
}
