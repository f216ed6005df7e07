/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/hypoplastic_clay_rates.h"

#include <string.h>

#define DEGREE 0.017453292519943295769
#define ROOT3  1.7320508075688772935

void pw_clay_derive(const pw_real *v, pw_clay *c)
{
  memset(c, 0, sizeof *c);
  const pw_real sin_c = sin(v[PW_CLAY_PHI_C] * DEGREE), sin2 = sin_c * sin_c;
  const pw_real a = ROOT3 * (3.0 - sin_c) / (2.0 * sqrt(2.0) * sin_c);
  const pw_real sin_l = sin(v[PW_CLAY_PHI_LIMIT] * DEGREE);
  c->inv_lambda = 1.0 / v[PW_CLAY_LAMBDA];
  c->n = v[PW_CLAY_N];
  c->inv_a = 1.0 / a;
  c->y = ROOT3 * a / (3.0 + a * a);
  c->y_slope = (c->y - 1.0) * (1.0 - sin2) / (8.0 * sin2);
  pw_real turn = (v[PW_CLAY_LAMBDA] - v[PW_CLAY_KAPPA]) / (v[PW_CLAY_LAMBDA] + v[PW_CLAY_KAPPA]);
  c->alpha = log2(turn / c->y);
  pw_real rest = (3.0 + a * a) * (1.0 - turn); /* 3 + a^2 - 2^alpha a sqrt3 */
  c->c1 = 2.0 * rest / (9.0 * v[PW_CLAY_RATIO]);
  c->c2a = a * a + 3.0 * (1.0 - c->c1);
  c->stiff = 3.0 / (v[PW_CLAY_LAMBDA] * rest);
  c->m_r = v[PW_CLAY_M_R];
  c->m_t = v[PW_CLAY_M_T];
  c->r = v[PW_CLAY_R];
  c->inv_r2 = 1.0 / (c->r * c->r);
  c->beta_r = v[PW_CLAY_BETA_R];
  c->chi = v[PW_CLAY_CHI];
  c->tolerance = v[PW_CLAY_TOLERANCE];
  c->intergranular = v[PW_CLAY_INTERGRANULAR] > 0.5;
  c->max_substeps = (int)v[PW_CLAY_MAX_SUBSTEPS];
  c->limits.p_min = v[PW_CLAY_P_MIN];
  c->limits.x_limit = (9.0 - sin_l * sin_l) / (1.0 - sin_l * sin_l);
  c->limits.tolerance = c->tolerance;
  c->limits.intergranular = c->intergranular;
  c->limits.r = c->r;
  c->limits.inv_r = c->intergranular ? 1.0 / c->r : 0.0;
  c->limits.inv_r2 = c->inv_r2;
  c->limits.max_substeps = c->max_substeps;
}

pw_clay_rates pw_clay_evaluate(const pw_clay *c, const pw_hypo_point *p, pw_t6 d)
{
  pw_clay_factors k = pw_clay_factors_of(c, p->stress, log1p(p->void_ratio));
  pw_clay_rates out = pw_clay_rates_of(c, &k, p->delta, d, pw_t6_norm(d), c->intergranular);
  out.modulus = pw_clay_modulus(c, &k, c->intergranular);
  return out;
}

/** One integration under way. */
typedef struct run {
  const pw_clay *c;
  pw_t6 de;
  pw_real size, log_dvol, log_specific; /* |dE|, ln of the volume ratio, ln(1 + e) at the start */
  pw_hypo_point now;
  bool swept; /* delta has turned along de and stays there */
  pw_hypo_path *path;
  pw_material_counts counts;
} run;

static bool begin(run *r, const pw_clay *c, pw_t6 de, pw_real dvol, const pw_hypo_point *p)
{
  pw_real specific = 1.0 + p->void_ratio;
  bool usable = dvol > 0.0 && specific * dvol > 1.0 + 1e-9 && isfinite(specific * dvol);
  *r = (run){.c = c, .de = de, .size = pw_t6_norm(de), .now = *p};
  r->log_dvol = usable ? pw_log(dvol) : 0.0;
  r->log_specific = usable ? pw_log(specific) : 0.0;
  if (!(p->substep > 0.0 && p->substep <= 1.0)) {
    r->now.substep = 1.0;
  }
  return usable && isfinite(r->size) && pw_t6_is_finite(p->stress) > 0.0 &&
         pw_t6_is_finite(p->delta) > 0.0;
}

/** Rates at a stage; a stress beyond the limits is moved back first. */
static pw_clay_rates stage(run *r, pw_hypo_point *at, pw_real t)
{
  r->counts.rhs++;
  if (!pw_hypo_inside(&r->c->limits, at->stress)) {
    at->stress = pw_hypo_limit(&r->c->limits, at->stress);
  }
  pw_clay_factors k = pw_clay_factors_of(r->c, at->stress, r->log_specific + t * r->log_dvol);
  return pw_clay_rates_of(r->c, &k, at->delta, r->de, r->size, r->c->intergranular && !r->swept);
}

static pw_t6 clip(const pw_clay *c, pw_t6 delta)
{
  pw_real rho = pw_t6_norm(delta) / c->r;
  return rho > 1.0 ? pw_t6_scale(1.0 / rho, delta) : delta;
}

/** An embedded step of orders 3(2) from @p k1: nodes 0, 1/2, 1, weights 1/6, 2/3, 1/6; its error
 *  relative to the stress, and to R. */
static pw_real attempt(run *r, const pw_clay_rates *k1, pw_real t, pw_real step, pw_hypo_point *end)
{
  const pw_hypo_point *p = &r->now;
  pw_hypo_point mid = *p, last = *p;
  mid.stress = pw_t6_axpy(p->stress, 0.5 * step, k1->stress);
  mid.delta = pw_t6_axpy(p->delta, 0.5 * step, k1->delta);
  pw_clay_rates k2 = stage(r, &mid, t + 0.5 * step);
  last.stress = pw_t6_axpy(pw_t6_axpy(p->stress, -step, k1->stress), 2.0 * step, k2.stress);
  last.delta = pw_t6_axpy(pw_t6_axpy(p->delta, -step, k1->delta), 2.0 * step, k2.delta);
  pw_clay_rates k3 = stage(r, &last, t + step);
  const pw_real sixth = step / 6.0;
  pw_t6 sum = pw_t6_axpy(pw_t6_axpy(k1->stress, 4.0, k2.stress), 1.0, k3.stress);
  pw_t6 err = pw_t6_axpy(pw_t6_axpy(k1->stress, -2.0, k2.stress), 1.0, k3.stress);
  pw_t6 turn = pw_t6_axpy(pw_t6_axpy(k1->delta, 4.0, k2.delta), 1.0, k3.delta);
  pw_t6 miss = pw_t6_axpy(pw_t6_axpy(k1->delta, -2.0, k2.delta), 1.0, k3.delta);
  *end = *p;
  end->stress = pw_t6_axpy(p->stress, sixth, sum);
  end->delta = pw_t6_axpy(p->delta, sixth, turn);
  pw_real on_stress = pw_t6_norm(err) / (pw_t6_norm(end->stress) + 1000.0);
  pw_real on_delta = r->c->intergranular ? pw_t6_norm(miss) / r->c->r : 0.0;
  return sixth * (on_delta > on_stress ? on_delta : on_stress);
}

/** Within a hundredth of the tolerance of full mobilisation, delta = R dE/|dE| solves its rate and the
 *  rates become those without intergranular strain, as in the sand. Its decay, followed on, would keep
 *  substeps at the limit of stability: they would enlarge rounding, and the tangent without bound. */
static void sweep(run *r)
{
  const pw_clay *c = r->c;
  if (!c->intergranular || r->swept || r->size <= PW_HYPO_SWEEP * c->r) {
    return;
  }
  const pw_t6 full = pw_t6_scale(c->r / r->size, r->de);
  if (pw_t6_norm(pw_t6_axpy(full, -1.0, r->now.delta)) <= 0.01 * c->tolerance * c->r) {
    r->now.delta = full;
    r->swept = true;
  }
}

static void accept(run *r, const pw_hypo_point *end, pw_real t, int kind)
{
  bool inside = pw_hypo_inside(&r->c->limits, end->stress);
  r->now.stress = inside ? end->stress : pw_hypo_limit(&r->c->limits, end->stress);
  r->now.delta = r->c->intergranular ? clip(r->c, end->delta) : end->delta;
  r->counts.cut_off += !inside;
  r->counts.substeps++;
  if (r->path && r->path->n < PW_HYPO_PATH_STEPS) {
    r->path->end[r->path->n] = t;
    r->path->kind[r->path->n++] = (unsigned char)kind;
  }
}

/** The rest of the increment as a whole, for a point that it keeps at the least pressure: delta
 *  turns into the direction of strain, and the stress is cut off after it in any case. */
static bool separated(run *r, const pw_clay_rates *k1, pw_real t, pw_real end)
{
  pw_real trace = pw_t6_trace(r->now.stress), least = -3.0 * r->c->limits.p_min, rest = end - t;
  if (trace < least * (1.0 + 1e-9) || trace + rest * pw_t6_trace(k1->stress) < least) {
    return false;
  }
  pw_hypo_point to = r->now;
  to.stress = pw_t6_axpy(r->now.stress, rest, k1->stress);
  int n = (int)pw_min(60.0, rest * r->size / (0.5 * r->c->r)) + 1;
  for (int i = 0; r->c->intergranular && i < n; i++) { /* exact once delta lies along the strain */
    pw_hypo_point at = {.delta = to.delta, .stress = r->now.stress, .void_ratio = 0.5};
    pw_t6 rate = pw_clay_evaluate(r->c, &at, r->de).delta;
    to.delta = clip(r->c, pw_t6_axpy(to.delta, rest / n, rate));
  }
  accept(r, &to, end, PW_HYPO_SEPARATED);
  return true;
}

/** Integrate from @p t to @p end with error control. */
static void advance(run *r, pw_real t, pw_real end)
{
  pw_clay_rates k1 = {0};
  for (bool moved = true; t < end;) {
    if (moved) {
      k1 = stage(r, &r->now, t);
      if (separated(r, &k1, t, end)) {
        return;
      }
    }
    bool exhausted = r->counts.substeps >= r->c->max_substeps;
    bool last = exhausted || r->now.substep >= (end - t) * (1.0 - 1e-9);
    pw_real step = last ? end - t : r->now.substep;
    pw_hypo_point to;
    pw_real err = attempt(r, &k1, t, step, &to);
    bool good = err <= r->c->tolerance;
    bool forced = !good && (exhausted || step <= PW_HYPO_SUBSTEP_MIN);
    pw_real next = pw_hypo_next_substep(&r->c->limits, step, err);
    next = err >= 0.0 ? next : pw_max(PW_HYPO_SUBSTEP_MIN, 0.25 * step);
    r->now.substep = good && last ? pw_max(r->now.substep, next) : next;
    moved = good || forced;
    if (!moved) {
      r->counts.rejected++;
      continue;
    }
    if (!(pw_t6_is_finite(to.stress) > 0.0) || !(pw_t6_is_finite(to.delta) > 0.0)) {
      to.stress = r->now.stress;
      to.delta = pw_t6_axpy(r->now.delta, step, r->de);
    }
    t = last ? end : t + step;
    r->counts.forced += forced;
    accept(r, &to, t, PW_HYPO_RUNGE_KUTTA);
    const bool before = r->swept;
    sweep(r);
    if (r->path && r->swept && !before) {
      r->path->kind[r->path->n - 1] = PW_HYPO_SWEPT;
    }
  }
}

static pw_status finish(const run *r, pw_real dvol, pw_hypo_point *p)
{
  if (!(pw_t6_is_finite(r->now.stress) > 0.0) || !(pw_t6_is_finite(r->now.delta) > 0.0)) {
    return PW_RETRY_STRESS;
  }
  pw_real specific = (1.0 + p->void_ratio) * dvol;
  *p = r->now;
  p->void_ratio = specific - 1.0;
  return PW_OK;
}

static pw_real turning_time(const run *r)
{
  return r->c->intergranular ? pw_hypo_turning_time(r->now.delta, r->de) : 0.0;
}

pw_status pw_clay_integrate(const pw_clay *c, pw_t6 de, pw_real dvol, pw_hypo_point *p,
                            pw_hypo_path *path, pw_material_counts *counts)
{
  run r;
  if (!begin(&r, c, de, dvol, p)) {
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
  advance(&r, split, 1.0);
  PW_TRY(finish(&r, dvol, p));
  if (counts) {
    counts->substeps += r.counts.substeps;
    counts->rhs += r.counts.rhs;
    counts->rejected += r.counts.rejected;
    counts->forced += r.counts.forced;
    counts->cut_off += r.counts.cut_off;
  }
  return PW_OK;
}

pw_status pw_clay_repeat(const pw_clay *c, pw_t6 de, pw_real dvol, pw_hypo_point *p,
                         const pw_hypo_path *path)
{
  run r;
  if (!begin(&r, c, de, dvol, p)) {
    return PW_RETRY_STRESS;
  }
  pw_real t = 0.0, split = turning_time(&r), was = path->split;
  bool stretch = was > 0.0 && split > 0.0;
  for (int i = 0; i < path->n; i++) {
    pw_clay_rates k1 = stage(&r, &r.now, t);
    pw_real end = path->end[i];
    if (stretch && i < path->n - 1) { /* delta:D changes sign between the same two substeps */
      end = end <= was ? end * (split / was) : 1.0 - (1.0 - end) * ((1.0 - split) / (1.0 - was));
    }
    pw_hypo_point to;
    if (path->kind[i] != PW_HYPO_SEPARATED || !separated(&r, &k1, t, end)) {
      (void)attempt(&r, &k1, t, end - t, &to);
      accept(&r, &to, end, PW_HYPO_RUNGE_KUTTA);
    }
    if (path->kind[i] == PW_HYPO_SWEPT && r.size > 0.0) {
      r.now.delta = pw_t6_scale(c->r / r.size, de);
      r.swept = true;
    }
    t = end;
  }
  return finish(&r, dvol, p);
}

/** m_R f_s L, or f_s L without intergranular strain. */
static void linear_stiffness(const pw_clay *c, const pw_hypo_point *start, pw_real *tangent)
{
  pw_hypo_point p = *start;
  if (!pw_hypo_inside(&c->limits, p.stress)) {
    p.stress = pw_hypo_limit(&c->limits, p.stress);
  }
  pw_real f = c->stiff * -pw_t6_trace(p.stress) / 3.0 * (c->intergranular ? c->m_r : 1.0);
  for (int j = 0; j < 6; j++) {
    pw_real unit[6] = {0}, rows[6];
    unit[j] = j < 3 ? 1.0 : 0.5;
    pw_t6 s = pw_t6_scale(1.0 / pw_t6_trace(p.stress), p.stress);
    pw_t6_store(pw_t6_scale(f, pw_clay_linear(c, s, pw_t6_load(unit, 1))), rows, 1);
    for (int i = 0; i < 6; i++) {
      tangent[6 * i + j] = rows[i];
    }
  }
}

void pw_clay_tangent(const pw_clay *c, pw_t6 de, pw_real dvol, const pw_hypo_point *start,
                     const pw_hypo_path *path, pw_real *tangent)
{
  pw_real size = pw_t6_norm(de), eta = pw_max(1e-5 * size, 1e-10), strain[6];
  linear_stiffness(c, start, tangent);
  if (size == 0.0 || path->n == 0 || path->kind[path->n - 1] == PW_HYPO_SEPARATED) {
    return;
  }
  for (int j = 0; j < 6; j++) {
    pw_real end[2][6];
    for (int side = 0; side < 2; side++) {
      pw_hypo_point p = *start;
      pw_real move = side ? eta : -eta, stretch = j < 3 ? exp(move) : 1.0;
      pw_t6_store(de, strain, 1);
      strain[j] += move;
      if (pw_clay_repeat(c, pw_t6_load(strain, 1), dvol * stretch, &p, path) != PW_OK) {
        return;
      }
      pw_t6_store(p.stress, end[side], 1);
    }
    for (int i = 0; i < 6; i++) {
      tangent[6 * i + j] = (end[1][i] - end[0][i]) / (2.0 * eta * (j < 3 ? 1.0 : 2.0));
    }
  }
}
