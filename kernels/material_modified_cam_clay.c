/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Modified Cam clay (Roscoe, Burland 1968), implicit integration after Borja, Lee, Comput. Methods
 * Appl. Mech. Engrg 78 (1990) 49-72. Compression positive in this comment, v = 1 + e:
 *   f = q^2/M^2 + p (p - pc) <= 0, associated;   dv_e = -kappa dp/p;   dv_p = -(lambda - kappa)
 *   dpc/pc;   G = 3 (1 - 2 nu)/(2 (1 + nu)) v p/kappa of the start of the step.
 * The volume equations are integrated exactly: with the volume strain the step prescribes,
 *   kappa ln(p/p_n) + (lambda - kappa) ln(pc/pc_n) = v_n - v.
 * With n = q/p, f = 0 is pc = p (1 + n^2/M^2); so p and pc follow from n, the multiplier from q =
 * n p, and one equation is left: n (plastic volume strain) = n multiplier (2 p - pc). It changes
 * sign between n = M and the other end of the wet (n < M) or dry side of the ellipse, where a
 * bracketed Newton iteration finds its only root. */
#include "kernels/modified_cam_clay.h"
#include "kernels/rate_form.h"

enum { LAMBDA, KAPPA, SLOPE, POISSON, VOID_RATIO, PRECONSOLIDATION, OCR, DENSITY, P_MIN };
enum { STATE_VOID, STATE_PC };

#define REAL(name, index, lo, hi, fallback, meaning)                                               \
  {                                                                                                \
    name, PW_KEY_REAL, (index) * sizeof(pw_real), lo, hi, fallback, NULL, NULL, meaning            \
  }

static const pw_key keys[] = {
    REAL("compression_index_lambda", LAMBDA, 1e-6, 10, NULL, "slope of virgin v over ln p, lambda"),
    REAL("swelling_index_kappa", KAPPA, 1e-7, 10, NULL, "slope of elastic v over ln p, kappa"),
    REAL("critical_stress_ratio", SLOPE, 1e-3, 3, NULL,
         "q/p at the critical state, M = 6 sin(phi_c)/(3 - sin(phi_c)) in triaxial compression"),
    REAL("poisson_ratio", POISSON, -0.999, 0.4999, NULL, "elastic; the shear modulus follows p"),
    REAL("void_ratio", VOID_RATIO, 1e-3, 20, NULL, "at the start, e"),
    REAL("preconsolidation_pressure_pa", PRECONSOLIDATION, 0, PW_HUGE, "0",
         "size pc of the yield ellipse at the start; it or overconsolidation_ratio"),
    REAL("overconsolidation_ratio", OCR, 0, 1e6, "0",
         "pc over that of the ellipse through the initial stress; 1 is normally consolidated"),
    REAL("density_kg_m3", DENSITY, PW_TINY, PW_HUGE, NULL, "density at the start"),
    REAL("pressure_min_pa", P_MIN, 1e-6, PW_HUGE, "100",
         "least mean pressure; keep it well below weight times the size of a point"),
    {NULL, PW_KEY_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

static const pw_state_def states[] = {
    {"void_ratio", true},
    {"preconsolidation_pressure_pa", true},
    {NULL, false},
};

static pw_status check(const pw_real *v)
{
  int given = (v[PRECONSOLIDATION] > 0.0) + (v[OCR] > 0.0);
  PW_REQUIRE(v[LAMBDA] > v[KAPPA] && v[KAPPA] > 0.0, PW_ERR_SCENE,
             "compression_index_lambda > swelling_index_kappa > 0 must hold: %g, %g", v[LAMBDA],
             v[KAPPA]);
  PW_REQUIRE(v[SLOPE] > 0.0 && v[VOID_RATIO] > 0.0 && v[DENSITY] > 0.0 && v[P_MIN] > 0.0,
             PW_ERR_SCENE,
             "critical_stress_ratio, void_ratio, density_kg_m3, pressure_min_pa must be positive: "
             "%g, %g, %g, %g",
             v[SLOPE], v[VOID_RATIO], v[DENSITY], v[P_MIN]);
  PW_REQUIRE(v[POISSON] > -1.0 && v[POISSON] < 0.5, PW_ERR_SCENE,
             "poisson_ratio = %g must lie between -1 and 0.5", v[POISSON]);
  PW_REQUIRE(
      given == 1, PW_ERR_SCENE,
      "exactly one of preconsolidation_pressure_pa and overconsolidation_ratio must be given "
      "and positive, not %d of them",
      given);
  PW_REQUIRE(v[OCR] == 0.0 || v[OCR] >= 1.0, PW_ERR_SCENE,
             "overconsolidation_ratio = %g must be at least 1", v[OCR]);
  return PW_OK;
}

static int nstate(const pw_real *v)
{
  (void)v;
  return 2;
}

static pw_real density(const pw_real *v)
{
  return v[DENSITY];
}

static void init(const pw_real *v, pw_idx n, pw_idx ld, const pw_real *stress, pw_real *state)
{
  const size_t l = (size_t)ld;
  for (size_t i = 0; i < (size_t)n; i++) {
    pw_t6 s = pw_t6_load(stress + i, l);
    pw_real mean = pw_t6_trace(s) / 3.0, p = pw_max(-mean, v[P_MIN]);
    pw_t6 dev = pw_t6_shift(s, -mean);
    pw_real through = p + 1.5 * pw_t6_dot(dev, dev) / (v[SLOPE] * v[SLOPE] * p);
    state[STATE_VOID * l + i] = v[VOID_RATIO];
    state[STATE_PC * l + i] = v[OCR] > 0.0 ? v[OCR] * through : v[PRECONSOLIDATION];
  }
}

/** What the points of a batch share. */
typedef struct model {
  pw_real lambda, kappa, slope, ratio, p_min, log_min; /* ratio: G/K */
  pw_real wave;                                        /* (K + 4/3 G)/K */
} model;

static model derive(const pw_real *v)
{
  const pw_real ratio = 1.5 * (1.0 - 2.0 * v[POISSON]) / (1.0 + v[POISSON]);
  return (model){.lambda = v[LAMBDA],
                 .kappa = v[KAPPA],
                 .slope = v[SLOPE],
                 .ratio = ratio,
                 .p_min = v[P_MIN],
                 .log_min = pw_log(v[P_MIN]),
                 .wave = 1.0 + 4.0 / 3.0 * ratio};
}

/** The elastic trial of a step. */
typedef struct trial {
  pw_t6 dev;                        /* of the trial stress */
  pw_real x, volume, change, shear; /* tr(dE), v before the step, its change, G */
  pw_real p, log_p, log_pc0, pc, q_trial;
  pw_real cut, plastic; /* 1: p is held at its least value; beyond yield */
} trial;

PW_INLINE trial try_elastic(const model *m, pw_t6 turned, pw_t6 de, pw_real void_ratio, pw_real pc)
{
  const pw_real mean = -pw_t6_trace(turned) / 3.0, start = pw_max(mean, m->p_min);
  trial t = {.x = pw_t6_trace(de), .volume = 1.0 + void_ratio, .pc = pc};
  t.change = t.volume * pw_exp_less_one(t.x);
  t.shear = m->ratio * t.volume * start / m->kappa;
  pw_real log_p = pw_log(start) - t.change / m->kappa;
  log_p = log_p < 690.0 ? log_p : 690.0;
  const pw_real keeps = log_p >= m->log_min ? 1.0 : 0.0; /* NaN does not */
  t.cut = 1.0 - keeps;
  t.log_p = keeps > 0.0 ? log_p : m->log_min;
  t.p = pw_exp(t.log_p);
  t.log_pc0 = pw_log(pc);
  t.dev = pw_t6_axpy(pw_t6_shift(turned, mean), 2.0 * t.shear, pw_t6_shift(de, -t.x / 3.0));
  const pw_real q2 = 1.5 * pw_t6_dot(t.dev, t.dev), q = sqrt(q2);
  const pw_real least = 1e-12 * t.p; /* isotropic states keep their derivative */
  t.q_trial = q > least ? q : least;
  t.plastic = q2 / (m->slope * m->slope) + t.p * (t.p - pc) > 0.0 ? 1.0 : 0.0;
  return t;
}

/** The equation of a plastic step. */
PW_INLINE pw_mcc_step step_of(const model *m, const trial *t)
{
  const pw_real small = t->volume * (1.0 + 0.5 * t->x), soft = m->lambda - m->kappa;
  return (pw_mcc_step){.lambda = m->lambda,
                       .soft = soft,
                       .slope = m->slope,
                       .stiff = m->slope * m->slope / (6.0 * t->shear),
                       .mean_volume = fabs(t->x) > 1e-9 ? t->change / t->x : small,
                       .base = m->kappa * t->log_p + soft * t->log_pc0,
                       .log_pc0 = t->log_pc0,
                       .q_trial = t->q_trial};
}

enum { SEEKS = 200, LANES = 16 };

/** Plastic steps whose equations are solved together, each on its own. */
typedef struct lanes {
  pw_real stiff[LANES], mean_volume[LANES], base[LANES], log_pc0[LANES], q_trial[LANES];
  pw_real p[LANES], pc[LANES];
  pw_real low[LANES], high[LANES], x[LANES], value[LANES], slope[LANES], busy[LANES];
} lanes;

PW_INLINE pw_mcc_step load_step(const model *m, const lanes *g, int i)
{
  return (pw_mcc_step){.lambda = m->lambda,
                       .soft = m->lambda - m->kappa,
                       .slope = m->slope,
                       .stiff = g->stiff[i],
                       .mean_volume = g->mean_volume[i],
                       .base = g->base[i],
                       .log_pc0 = g->log_pc0[i],
                       .q_trial = g->q_trial[i]};
}

PW_INLINE void store_search(pw_mcc_search s, lanes *g, int i)
{
  g->low[i] = s.low;
  g->high[i] = s.high;
  g->x[i] = s.x;
  g->value[i] = s.value;
  g->slope[i] = s.slope;
  g->busy[i] = s.busy;
}

/** q/p of all lanes into x. */
static void solve_lanes(const model *shared, lanes *g)
{
  const model m = *shared;
  pw_real busy = 1.0;
#pragma omp simd
  for (int i = 0; i < LANES; i++) {
    const pw_mcc_step t = load_step(&m, g, i);
    store_search(pw_mcc_begin(&t, g->p[i], g->pc[i]), g, i);
  }
  for (int k = 0; k < SEEKS && busy > 0.0; k++) {
    busy = 0.0;
#pragma omp simd reduction(+ : busy)
    for (int i = 0; i < LANES; i++) {
      const pw_mcc_step t = load_step(&m, g, i);
      const pw_mcc_search s =
          pw_mcc_seek(&t, (pw_mcc_search){g->low[i], g->high[i], g->x[i], g->value[i], g->slope[i],
                                          g->busy[i]});
      store_search(s, g, i);
      busy += s.busy;
    }
  }
}

/** The trials of a batch, and q/p at the end of its plastic steps. */
typedef struct trials {
  pw_real dev[6][PW_CHUNK], x[PW_CHUNK], volume[PW_CHUNK], change[PW_CHUNK], shear[PW_CHUNK];
  pw_real p[PW_CHUNK], log_p[PW_CHUNK], log_pc0[PW_CHUNK], pc[PW_CHUNK], q_trial[PW_CHUNK];
  pw_real cut[PW_CHUNK], plastic[PW_CHUNK], n[PW_CHUNK];
} trials;

PW_INLINE trial load_trial(const trials *b, size_t i)
{
  return (trial){.dev = pw_t6_load(&b->dev[0][i], PW_CHUNK),
                 .x = b->x[i],
                 .volume = b->volume[i],
                 .change = b->change[i],
                 .shear = b->shear[i],
                 .p = b->p[i],
                 .log_p = b->log_p[i],
                 .log_pc0 = b->log_pc0[i],
                 .pc = b->pc[i],
                 .q_trial = b->q_trial[i],
                 .cut = b->cut[i],
                 .plastic = b->plastic[i]};
}

PW_INLINE void try_point(const model *m, const pw_stress_args *a, size_t i, bool plane, trials *b)
{
  const size_t l = (size_t)a->ld;
  const trial t =
      try_elastic(m, pw_rate_turned(a, i, plane), pw_t6_load(a->dstrain + i, (size_t)a->ldi),
                  a->state[STATE_VOID * l + i], a->state[STATE_PC * l + i]);
  pw_t6_store(t.dev, &b->dev[0][i], PW_CHUNK);
  b->x[i] = t.x;
  b->volume[i] = t.volume;
  b->change[i] = t.change;
  b->shear[i] = t.shear;
  b->p[i] = t.p;
  b->log_p[i] = t.log_p;
  b->log_pc0[i] = t.log_pc0;
  b->pc[i] = t.pc;
  b->q_trial[i] = t.q_trial;
  b->cut[i] = t.cut;
  b->plastic[i] = t.plastic;
  b->n[i] = m->slope;
}

static void try_points(const model *shared, const pw_stress_args *args, trials *b)
{
  const model m = *shared;
  const pw_stress_args a = *args;
  if (pw_spin_is_plane(a.spin, (size_t)a.ldi, a.n)) {
#pragma omp simd
    for (pw_idx i = 0; i < a.n; i++) {
      try_point(&m, &a, (size_t)i, true, b);
    }
  } else {
#pragma omp simd
    for (pw_idx i = 0; i < a.n; i++) {
      try_point(&m, &a, (size_t)i, false, b);
    }
  }
}

/** Solve for the plastic steps; lanes without one repeat the first of their group. */
static void solve_plastic(const model *m, pw_idx n, trials *b)
{
  pw_idx list[PW_CHUNK], count = 0;
  for (pw_idx i = 0; i < n; i++) {
    if (b->plastic[i] > 0.0) {
      list[count++] = i;
    }
  }
  for (pw_idx first = 0; first < count; first += LANES) {
    const int in_use = count - first < LANES ? (int)(count - first) : LANES;
    lanes g;
    for (int k = 0; k < LANES; k++) {
      const size_t i = (size_t)list[first + (k < in_use ? k : 0)];
      const trial t = load_trial(b, i);
      const pw_mcc_step s = step_of(m, &t);
      g.stiff[k] = s.stiff;
      g.mean_volume[k] = s.mean_volume;
      g.base[k] = s.base;
      g.log_pc0[k] = s.log_pc0;
      g.q_trial[k] = s.q_trial;
      g.p[k] = t.p;
      g.pc[k] = t.pc;
    }
    solve_lanes(m, &g);
    for (int k = 0; k < in_use; k++) {
      b->n[list[first + k]] = g.x[k];
    }
  }
}

/** Stress and state at the end of a step; 1 when they are finite, else 0: the point keeps its own. */
PW_INLINE pw_real finish_point(const model *m, const trials *b, const pw_stress_args *a, size_t i)
{
  const size_t l = (size_t)a->ld;
  const trial t = load_trial(b, i);
  const pw_mcc_step s = step_of(m, &t);
  const pw_mcc_residual r = pw_mcc_evaluate(&s, b->n[i]);
  const bool flows = t.plastic > 0.0;
  const pw_real p = flows ? r.p : t.p, pc = flows ? r.pc : t.pc;
  const pw_real shrink = flows ? r.n * r.p / t.q_trial : 1.0;
  const pw_t6 stress = pw_t6_shift(pw_t6_scale(shrink, t.dev), -p);
  const pw_real sound = pc > 0.0 && pc < PW_HUGE ? 1.0 : 0.0,
                good = pw_t6_is_finite(stress) * sound;
  const pw_real before = -pw_t6_trace(pw_t6_load(a->stress + i, l)) / 3.0;
  const pw_real least = before > m->p_min ? before : m->p_min;
  const pw_real now = t.volume + t.change;
  const pw_real stiff = good > 0.0 ? now * p : t.volume * least;
  pw_t6_store(pw_t6_select(good, stress, pw_t6_load(a->stress + i, l)), a->stress + i, l);
  a->wave_speed[i] = sqrt(m->wave * stiff / m->kappa / a->density[i]);
  a->state[STATE_PC * l + i] = good > 0.0 ? pc : t.pc;
  a->state[STATE_VOID * l + i] = good > 0.0 ? now - 1.0 : a->state[STATE_VOID * l + i];
  return good;
}

/** Tangent of a plastic step by implicit differentiation: value(n; x, q_trial) = 0 where x is the
 *  volume strain (tension positive); sigma = -p 1 + q/q_trial s_trial. */
static void plastic_tangent(const pw_mcc_step *t, const pw_mcc_residual *r, const trial *e,
                            pw_real *matrix)
{
  const pw_real x = e->x, now = e->cut > 0.0 ? 0.0 : e->volume + e->change, shear = e->shear;
  const pw_real way = 1.0 - r->n * r->n / (t->slope * t->slope), log_p_x = -now / t->lambda;
  /* slope of the mean volume (exp(x) - 1)/x v */
  const pw_real mean_slope = e->volume * (fabs(x) > 1e-3 ? (exp(x) * (x - 1.0) + 1.0) / (x * x)
                                                         : 0.5 + x * (1.0 / 3.0 + 0.125 * x));
  const pw_t6 dev = e->dev;
  const pw_real q = r->n * r->p, shrink = q / t->q_trial;
  pw_real plastic_x = (t->soft * log_p_x - r->plastic * mean_slope) / t->mean_volume;
  pw_real value_x = r->n * plastic_x + t->stiff * way * q * log_p_x, value_q = -t->stiff * way;
  for (int col = 0; col < 6; col++) {
    pw_real unit[6] = {0}, rows[6];
    unit[col] = col < 3 ? 1.0 : 0.5; /* per engineering shear */
    pw_t6 de = pw_t6_load(unit, 1);
    pw_real tr = pw_t6_trace(de);
    pw_t6 d_dev = pw_t6_scale(2.0 * shear, pw_t6_shift(de, -tr / 3.0));
    pw_real d_trial = 1.5 * pw_t6_dot(dev, d_dev) / t->q_trial;
    pw_real d_n = -(value_x * tr + value_q * d_trial) / r->slope;
    pw_real d_log = r->log_p_n * d_n + log_p_x * tr, d_q = r->p * d_n + q * d_log;
    pw_t6 out = pw_t6_scale(shrink, d_dev);
    out = pw_t6_axpy(out, (d_q - shrink * d_trial) / t->q_trial, dev);
    pw_t6_store(pw_t6_shift(out, -r->p * d_log), rows, 1);
    for (int row = 0; row < 6; row++) {
      matrix[6 * row + col] = rows[row];
    }
  }
}

/** Tangent of a point whose step is solved. */
static void tangent_of(const model *m, const trials *b, const pw_stress_args *a, size_t i)
{
  const trial t = load_trial(b, i);
  pw_real matrix[36];
  if (t.plastic > 0.0) {
    const pw_mcc_step s = step_of(m, &t);
    const pw_mcc_residual r = pw_mcc_evaluate(&s, b->n[i]);
    plastic_tangent(&s, &r, &t, matrix);
  } else {
    const pw_real now = t.cut > 0.0 ? 0.0 : t.volume + t.change;
    pw_elastic_matrix(t.p * now / m->kappa - 2.0 / 3.0 * t.shear, t.shear, matrix);
  }
  pw_rate_store_tangent(a, i, matrix);
}

/** Advance @p args->n <= PW_CHUNK points; the first failing one, or -1. */
static pw_idx update_chunk(const model *shared, const pw_stress_args *args)
{
  const model m = *shared;
  const pw_stress_args a = *args;
  trials b;
  pw_real good[PW_CHUNK], count = 0.0, cut = 0.0;
  try_points(&m, &a, &b);
  solve_plastic(&m, a.n, &b);
#pragma omp simd reduction(+ : count, cut)
  for (pw_idx i = 0; i < a.n; i++) {
    good[i] = finish_point(&m, &b, &a, (size_t)i);
    count += good[i];
    cut += b.cut[i];
  }
  for (pw_idx i = 0; a.tangent && i < a.n; i++) {
    tangent_of(&m, &b, &a, (size_t)i);
  }
  if (a.counts) {
    a.counts->cut_off += (pw_off)cut;
  }
  return count == (pw_real)a.n ? -1 : pw_first_zero(good, a.n);
}

static pw_status update(const pw_real *v, pw_stress_args *a)
{
  const model m = derive(v);
  a->bad = -1;
  for (pw_idx first = 0; first < a->n; first += PW_CHUNK) {
    const pw_idx n = a->n - first < PW_CHUNK ? a->n - first : PW_CHUNK;
    const pw_stress_args part = pw_rate_part(a, first, n);
    const pw_idx bad = update_chunk(&m, &part);
    a->bad = a->bad < 0 && bad >= 0 ? first + bad : a->bad;
  }
  return a->bad < 0 ? PW_OK : PW_RETRY_STRESS;
}

extern const pw_material pw_material_modified_cam_clay;
const pw_material pw_material_modified_cam_clay = {
    .name = "modified_cam_clay",
    .brief = "modified Cam clay (Roscoe and Burland 1968), implicit (after Borja and Lee 1990)",
    .keys = keys,
    .states = states,
    .takes_initial_stress = true,
    .check = check,
    .nstate = nstate,
    .density = density,
    .init = init,
    .update = update,
};
