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
    REAL("pressure_min_pa", P_MIN, 1e-6, PW_HUGE, "100", "least mean pressure"),
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

/** A step of one point; compression positive. */
typedef struct step {
  pw_real lambda, soft, slope;     /* lambda, lambda - kappa, M */
  pw_real stiff;                   /* M^2/(6 G) */
  pw_real now;                     /* v at the end, or 0: p is held at its least value */
  pw_real mean_volume, mean_slope; /* v that times the volume strain gives v - v_n; its slope */
  pw_real base;                    /* lambda ln p of an isotropic virgin state with this v */
  pw_real log_pc0;
  pw_real q_trial;
} step;

/** The equation at n = q/p, and what belongs to n. */
typedef struct residual {
  pw_real n, p, pc, plastic; /* plastic: volume strain */
  pw_real log_p_n;           /* d ln p/d n */
  pw_real value, slope;
} residual;

static residual evaluate(const step *t, pw_real n)
{
  const pw_real r2 = n * n / (t->slope * t->slope), size = pw_log(1.0 + r2);
  const pw_real size_n = 2.0 * n / (t->slope * t->slope + n * n);
  residual r = {.n = n, .log_p_n = -t->soft / t->lambda * size_n};
  pw_real log_p = (t->base - t->soft * size) / t->lambda;
  r.p = pw_exp(log_p);
  r.pc = r.p * (1.0 + r2);
  r.plastic = t->soft * (log_p + size - t->log_pc0) / t->mean_volume;
  pw_real plastic_n = t->soft * (r.log_p_n + size_n) / t->mean_volume;
  pw_real rest = t->q_trial - n * r.p; /* 3 G times the plastic shear strain */
  r.value = n * r.plastic - t->stiff * rest * (1.0 - r2);
  pw_real rest_n = -r.p * (1.0 + n * r.log_p_n);
  pw_real way_n = -2.0 * n / (t->slope * t->slope);
  r.slope = r.plastic + n * plastic_n - t->stiff * (rest_n * (1.0 - r2) + rest * way_n);
  return r;
}

/** Root between two values of n, @p low of negative and @p high of positive residual, from @p x. */
static residual find_root(const step *t, pw_real low, pw_real high, pw_real x)
{
  x = (x - low) * (x - high) < 0.0 ? x : 0.5 * (low + high);
  residual r = evaluate(t, x);
  for (int i = 0; i < 200; i++) {
    if (r.value < 0.0) {
      low = x;
    } else {
      high = x;
    }
    pw_real next = x - r.value / r.slope;
    next = (next - low) * (next - high) <= 0.0 ? next : 0.5 * (low + high);
    pw_real moved = fabs(next - x);
    x = next;
    r = evaluate(t, x);
    if (moved <= 1e-14 * fabs(x)) {
      break;
    }
  }
  return r;
}

/**
 * Tangent of a plastic step by implicit differentiation: value(n; x, q_trial) = 0 where x is the
 * volume strain (tension positive); sigma = -p 1 + q/q_trial s_trial.
 */
static void plastic_tangent(const step *t, const residual *r, pw_t6 dev, pw_real shear,
                            pw_real *matrix)
{
  const pw_real way = 1.0 - r->n * r->n / (t->slope * t->slope), log_p_x = -t->now / t->lambda;
  const pw_real q = r->n * r->p, shrink = q / t->q_trial;
  pw_real plastic_x = (t->soft * log_p_x - r->plastic * t->mean_slope) / t->mean_volume;
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

/** What a point has at the end of its step. */
typedef struct result {
  pw_t6 stress;
  pw_real p, pc;
  bool cut;
} result;

/** Step of a point from the turned stress; @p matrix the tangent, or NULL. */
static result advance(const pw_real *v, pw_t6 turned, pw_t6 de, const pw_real *state,
                      pw_real *matrix)
{
  const pw_real volume = 1.0 + state[STATE_VOID], x = pw_t6_trace(de), change = volume * expm1(x);
  const pw_real mean = -pw_t6_trace(turned) / 3.0, start = pw_max(mean, v[P_MIN]);
  const pw_real kappa = v[KAPPA], ratio = 1.5 * (1.0 - 2.0 * v[POISSON]) / (1.0 + v[POISSON]);
  const pw_real shear = ratio * volume * start / kappa, log_min = pw_log(v[P_MIN]);
  pw_real log_p0 = pw_log(start), log_trial = pw_min(log_p0 - change / kappa, 690.0);
  bool cut = !(log_trial >= log_min);
  log_trial = cut ? log_min : log_trial;
  pw_real p = pw_exp(log_trial), pc = state[STATE_PC], m2 = v[SLOPE] * v[SLOPE];
  pw_t6 dev = pw_t6_axpy(pw_t6_shift(turned, mean), 2.0 * shear, pw_t6_shift(de, -x / 3.0));
  pw_real q2 = 1.5 * pw_t6_dot(dev, dev), now = cut ? 0.0 : volume + change;
  result r = {.stress = pw_t6_shift(dev, -p), .p = p, .pc = pc, .cut = cut};
  if (!(q2 / m2 + p * (p - pc) > 0.0)) {
    if (matrix) {
      pw_elastic_matrix(p * now / kappa - 2.0 / 3.0 * shear, shear, matrix);
    }
    return r;
  }
  step t = {.lambda = v[LAMBDA],
            .soft = v[LAMBDA] - kappa,
            .slope = v[SLOPE],
            .stiff = m2 / (6.0 * shear),
            .now = now,
            .mean_volume = fabs(x) > 1e-9 ? change / x : volume * (1.0 + 0.5 * x),
            .mean_slope = fabs(x) > 1e-3 ? volume * (exp(x) * (x - 1.0) + 1.0) / (x * x)
                                         : volume * (0.5 + x * (1.0 / 3.0 + 0.125 * x)),
            .log_pc0 = pw_log(pc),
            .q_trial = pw_max(sqrt(q2), 1e-12 * p)}; /* isotropic states keep their derivative */
  t.base = kappa * log_trial + t.soft * t.log_pc0;
  bool dry = 2.0 * p < pc;
  pw_real n = t.q_trial / p; /* near the root in small steps */
  residual at = dry ? find_root(&t, v[SLOPE], v[SLOPE] * sqrt(pc / p - 1.0), n)
                    : find_root(&t, 0.0, v[SLOPE], n);
  if (matrix) {
    plastic_tangent(&t, &at, dev, shear, matrix);
  }
  pw_t6 shape = pw_t6_scale(at.n * at.p / t.q_trial, dev);
  return (result){.stress = pw_t6_shift(shape, -at.p), .p = at.p, .pc = at.pc, .cut = cut};
}

static pw_real update_point(const pw_real *v, const pw_stress_args *a, size_t p)
{
  const size_t l = (size_t)a->ld, li = (size_t)a->ldi;
  pw_real *void_ratio = a->state + STATE_VOID * l + p, *pc = a->state + STATE_PC * l + p;
  pw_t6 de = pw_t6_load(a->dstrain + p, li);
  pw_t6 turned = pw_rate_turned(a, p, pw_spin_is_plane(a->spin + p, li, 1));
  pw_real state[2] = {*void_ratio, *pc}, matrix[36];
  result r = advance(v, turned, de, state, a->tangent ? matrix : NULL);
  pw_real good = pw_t6_is_finite(r.stress) > 0.0 && r.pc > 0.0 && isfinite(r.pc) ? 1.0 : 0.0;
  pw_real volume = 1.0 + *void_ratio, now = volume * exp(pw_t6_trace(de));
  r.p = good > 0.0 ? r.p : pw_max(-pw_t6_trace(turned) / 3.0, v[P_MIN]);
  pw_real modulus = (good > 0.0 ? now : volume) * r.p / v[KAPPA];
  modulus *= 1.0 + 2.0 * (1.0 - 2.0 * v[POISSON]) / (1.0 + v[POISSON]);
  pw_rate_store(a, p, good > 0.0 ? r.stress : pw_t6_load(a->stress + p, l), modulus);
  if (good > 0.0) {
    *pc = r.pc;
    *void_ratio = now - 1.0;
  }
  if (a->counts) {
    a->counts->cut_off += r.cut;
  }
  if (a->tangent) {
    pw_rate_store_tangent(a, p, matrix);
  }
  return good;
}

static pw_status update(const pw_real *v, pw_stress_args *a)
{
  a->bad = -1;
  for (pw_idx i = 0; i < a->n; i++) {
    if (update_point(v, a, (size_t)i) == 0.0 && a->bad < 0) {
      a->bad = i;
    }
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
