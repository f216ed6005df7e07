/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/hypoplastic.h"

enum {
  VOID_RATIO = PW_HYPO_STATE_VOID_RATIO,
  DELTA = PW_HYPO_STATE_DELTA,
  SUBSTEP = PW_HYPO_STATE_SUBSTEP
};

#define AT(index) ((index) * sizeof(pw_real))
#define REAL(name, index, lo, hi, fallback, meaning)                                               \
  {                                                                                                \
    name, PW_KEY_REAL, AT(index), lo, hi, fallback, NULL, NULL, meaning                            \
  }

static const pw_key keys[] = {
    REAL("grain_density_kg_m3", PW_HYPO_GRAIN_DENSITY, PW_TINY, 1e5, NULL,
         "density of the grains; the bulk density is this over 1 + e"),
    REAL("void_ratio", PW_HYPO_VOID_RATIO, 1e-3, 10.0, NULL, "initial void ratio"),
    {"void_ratio_rule", PW_KEY_CHOICE, AT(PW_HYPO_VOID_RATIO_RULE), 0, 1, "current",
     "current|bauer_scaled", NULL,
     "void_ratio holds at the initial stress, or at zero stress and is scaled to it"},
    REAL("critical_friction_angle_deg", PW_HYPO_PHI_C, 1e-3, 89.999, NULL,
         "friction angle of critical states, phi_c"),
    REAL("cohesion_shift_pa", PW_HYPO_P_T, 0.0, PW_HUGE, "0",
         "p_t, subtracted from every normal stress"),
    REAL("granular_hardness_pa", PW_HYPO_H_S, PW_TINY, PW_HUGE, NULL, "h_s of Bauer's law"),
    REAL("exponent_n", PW_HYPO_N, 1e-3, 0.999, NULL, "n of Bauer's law"),
    REAL("void_ratio_d0", PW_HYPO_E_D0, 1e-3, 10.0, NULL, "densest, at zero pressure"),
    REAL("void_ratio_c0", PW_HYPO_E_C0, 1e-3, 10.0, NULL, "critical, at zero pressure"),
    REAL("void_ratio_i0", PW_HYPO_E_I0, 1e-3, 10.0, NULL, "loosest, at zero pressure"),
    REAL("exponent_alpha", PW_HYPO_ALPHA, 1e-6, 10.0, NULL, "of the relative density, f_d"),
    REAL("exponent_beta", PW_HYPO_BETA, 0.0, 20.0, NULL, "of the void ratio in the stiffness, f_e"),
    {"intergranular_strain", PW_KEY_BOOL, AT(PW_HYPO_INTERGRANULAR), 0, 1, "true", NULL, NULL,
     "stiffness at small strain; false is the model without it"},
    REAL("stiffness_ratio_m_r", PW_HYPO_M_R, 1.0, 1e3, "10", "stiffness after a reversal, m_R"),
    REAL("stiffness_ratio_m_t", PW_HYPO_M_T, 1.0, 1e3, "2", "stiffness after a right turn, m_T"),
    REAL("elastic_range_r", PW_HYPO_R, 1e-9, 0.1, "5e-5", "largest intergranular strain, R"),
    REAL("exponent_beta_r", PW_HYPO_BETA_R, 1e-3, 100.0, "0.3", "of its evolution, beta_r"),
    REAL("exponent_chi", PW_HYPO_CHI, 1e-3, 100.0, "1", "of the change of stiffness, chi"),
    {"initial_intergranular", PW_KEY_CHOICE, AT(PW_HYPO_INITIAL_DELTA), 0, 2, "zero",
     "zero|isotropic|oedometric", NULL, "intergranular strain at the start; oedometric is along y"},
    REAL("substep_tolerance", PW_HYPO_TOLERANCE, 1e-12, 0.1, "1e-3",
         "relative error of stress and of intergranular strain over R in a substep"),
    REAL("pressure_min_pa", PW_HYPO_P_MIN, 1e-6, PW_HUGE, "100", "least pressure p + p_t"),
    REAL("stress_ratio_limit_deg", PW_HYPO_PHI_LIMIT, 1.0, 89.0, "60",
         "largest Matsuoka-Nakai friction angle"),
    REAL("max_substeps", PW_HYPO_MAX_SUBSTEPS, 10.0, PW_HYPO_SUBSTEP_LIMIT, "400",
         "substeps of one increment, after which the rest is taken at once"),
    REAL("step_stiffness_ratio", PW_HYPO_STEP_RATIO, 0.0, 1e3, "0",
         "stiffness that explicit steps resolve, from m_T (and 1.5) up to m_R, which holds within "
         "strains of elastic_range_r only; 0: m_R"),
    {NULL, PW_KEY_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

static const pw_state_def states[] = {
    {"void_ratio", true},
    {"intergranular_strain_xx", true},
    {"intergranular_strain_yy", true},
    {"intergranular_strain_zz", true},
    {"intergranular_strain_xy", true},
    {"intergranular_strain_yz", true},
    {"intergranular_strain_zx", true},
    {"substep_fraction", false},
    {NULL, false},
};

static pw_status check(const pw_real *v)
{
  pw_real n = v[PW_HYPO_N], e_d0 = v[PW_HYPO_E_D0], e_c0 = v[PW_HYPO_E_C0], e_i0 = v[PW_HYPO_E_I0];
  PW_REQUIRE(n > 0.0 && n < 1.0, PW_ERR_SCENE, "exponent_n = %g must lie between 0 and 1", n);
  PW_REQUIRE(v[PW_HYPO_H_S] > 0.0, PW_ERR_SCENE, "granular_hardness_pa = %g must be positive",
             v[PW_HYPO_H_S]);
  PW_REQUIRE(v[PW_HYPO_PHI_C] > 0.0 && v[PW_HYPO_PHI_C] < 90.0, PW_ERR_SCENE,
             "critical_friction_angle_deg = %g must lie between 0 and 90", v[PW_HYPO_PHI_C]);
  PW_REQUIRE(0.0 < e_d0 && e_d0 < e_c0 && e_c0 < e_i0, PW_ERR_SCENE,
             "void_ratio_d0 < void_ratio_c0 < void_ratio_i0 must hold: %g, %g, %g", e_d0, e_c0,
             e_i0);
  pw_real sin_c = sin(v[PW_HYPO_PHI_C] * 0.017453292519943295769);
  pw_real a = sqrt(3.0) * (3.0 - sin_c) / (2.0 * sqrt(2.0) * sin_c);
  pw_real bracket =
      3.0 + a * a - sqrt(3.0) * a * pow((e_i0 - e_d0) / (e_c0 - e_d0), v[PW_HYPO_ALPHA]);
  PW_REQUIRE(bracket > 0.0, PW_ERR_SCENE,
             "3 + a^2 - sqrt(3) a ((e_i0 - e_d0)/(e_c0 - e_d0))^alpha = %g must be positive: lower "
             "exponent_alpha or widen void_ratio_c0 - void_ratio_d0",
             bracket);
  PW_REQUIRE(v[PW_HYPO_PHI_LIMIT] > v[PW_HYPO_PHI_C], PW_ERR_SCENE,
             "stress_ratio_limit_deg = %g must exceed critical_friction_angle_deg = %g",
             v[PW_HYPO_PHI_LIMIT], v[PW_HYPO_PHI_C]);
  if (v[PW_HYPO_INTERGRANULAR] > 0.5) {
    PW_REQUIRE(v[PW_HYPO_M_R] >= v[PW_HYPO_M_T] && v[PW_HYPO_M_T] >= 1.0, PW_ERR_SCENE,
               "stiffness_ratio_m_r >= stiffness_ratio_m_t >= 1 must hold: %g, %g", v[PW_HYPO_M_R],
               v[PW_HYPO_M_T]);
    PW_REQUIRE(v[PW_HYPO_R] > 0.0 && v[PW_HYPO_BETA_R] > 0.0 && v[PW_HYPO_CHI] > 0.0, PW_ERR_SCENE,
               "elastic_range_r, exponent_beta_r, exponent_chi must be positive: %g, %g, %g",
               v[PW_HYPO_R], v[PW_HYPO_BETA_R], v[PW_HYPO_CHI]);
    /* Sand that yields goes on with up to L + N, about 1.5 L. */
    const pw_real ratio = v[PW_HYPO_STEP_RATIO], least = fmax(1.5, v[PW_HYPO_M_T]);
    PW_REQUIRE(ratio == 0.0 || (ratio >= least && ratio <= v[PW_HYPO_M_R]), PW_ERR_SCENE,
               "step_stiffness_ratio = %g must lie between %g, stiffness_ratio_m_t or 1.5, and "
               "stiffness_ratio_m_r = %g",
               ratio, least, v[PW_HYPO_M_R]);
  }
  return PW_OK;
}

static int nstate(const pw_real *v)
{
  return v[PW_HYPO_INTERGRANULAR] > 0.5 ? SUBSTEP + 1 : 1;
}

static pw_real density(const pw_real *v)
{
  return v[PW_HYPO_GRAIN_DENSITY] / (1.0 + v[PW_HYPO_VOID_RATIO]);
}

static pw_real step_part(const pw_real *v)
{
  const bool less = v[PW_HYPO_INTERGRANULAR] > 0.5 && v[PW_HYPO_STEP_RATIO] > 0.0;
  return less ? sqrt(v[PW_HYPO_STEP_RATIO] / v[PW_HYPO_M_R]) : 1.0;
}

static void init(const pw_real *v, pw_idx n, pw_idx ld, const pw_real *stress, pw_real *state)
{
  size_t l = (size_t)ld;
  pw_real r = v[PW_HYPO_R];
  int choice = (int)v[PW_HYPO_INITIAL_DELTA];
  pw_t6 delta = {0};
  if (choice == PW_HYPO_DELTA_ISOTROPIC) {
    delta = pw_t6_shift(delta, -r / sqrt(3.0));
  } else if (choice == PW_HYPO_DELTA_OEDOMETRIC) {
    delta.yy = -r;
  }
  for (pw_idx i = 0; i < n; i++) {
    pw_real e = v[PW_HYPO_VOID_RATIO];
    pw_real q = -pw_t6_trace(pw_t6_load(stress + i, l)); /* 3 p, without the shift */
    if ((int)v[PW_HYPO_VOID_RATIO_RULE] == PW_HYPO_RULE_BAUER && q > 3.0) {
      e *= exp(-pow(q / v[PW_HYPO_H_S], v[PW_HYPO_N]));
    }
    state[VOID_RATIO * l + (size_t)i] = e;
    if (v[PW_HYPO_INTERGRANULAR] > 0.5) {
      pw_t6_store(delta, state + DELTA * l + (size_t)i, l);
      state[SUBSTEP * l + (size_t)i] = 1.0;
    }
  }
}

static void tangent_of(const pw_hypo *h, const pw_stress_args *a, const pw_hypo_point *start,
                       const pw_hypo_point *end, const pw_hypo_path *path, pw_idx i)
{
  size_t li = (size_t)a->ldi, p = (size_t)i;
  pw_real matrix[36];
  pw_hypo_tangent(h, pw_t6_load(a->dstrain + p, li), a->dvol[p], start, end->stress, path, matrix);
  for (size_t c = 0; c < 36; c++) {
    a->tangent[c * li + p] = matrix[c];
  }
}

/** Advance a point by the substeps that its guide takes from where it starts. */
static pw_status repeat(const pw_hypo *h, const pw_stress_args *a, pw_idx i, pw_hypo_point *p,
                        pw_hypo_path *path, pw_real *modulus)
{
  const size_t li = (size_t)a->ldi;
  pw_stress_args g = *a;
  pw_hypo_rates end;
  g.spin = a->guide + 6 * li;
  pw_hypo_point first = pw_hypo_read(h, &g, pw_spin_is_plane(g.spin + i, li, 1), i);
  pw_t6 de = pw_t6_load(a->guide + i, li);
  PW_TRY(pw_hypo_integrate(h, de, a->guide[9 * li + (size_t)i], &first, path, a->counts, NULL));
  PW_TRY(pw_hypo_repeat(h, pw_t6_load(a->dstrain + i, li), a->dvol[i], p, path));
  p->substep = first.substep;
  pw_hypo_evaluate(h, p, (pw_t6){0}, &end);
  *modulus = end.modulus;
  return PW_OK;
}

/** Advance point @p i on its own, with as many substeps as it takes. */
static pw_status update_point(const pw_hypo *h, pw_stress_args *a, bool plane, pw_idx i)
{
  pw_hypo_path path;
  pw_real modulus = 0.0;
  pw_hypo_point start = pw_hypo_read(h, a, plane, i), end = start;
  pw_status s = a->guide
                    ? repeat(h, a, i, &end, &path, &modulus)
                    : pw_hypo_integrate(h, pw_t6_load(a->dstrain + i, (size_t)a->ldi), a->dvol[i],
                                        &end, a->tangent ? &path : NULL, a->counts, &modulus);
  if (s == PW_OK) {
    pw_hypo_write(h, a, &end, i);
  } else { /* the point keeps its state: its wave speed is that of the start */
    pw_hypo_rates r;
    pw_hypo_evaluate(h, &start, (pw_t6){0}, &r);
    modulus = r.modulus;
    path.n = 0;
  }
  a->wave_speed[i] = sqrt(modulus / a->density[i]);
  if (a->tangent) {
    tangent_of(h, a, &start, &end, &path, i);
  }
  return s;
}

static pw_status update(const pw_real *param, pw_stress_args *a)
{
  pw_hypo h;
  pw_real done[PW_CHUNK];
  pw_hypo_derive(param, &h);
  bool plane = pw_spin_is_plane(a->spin, (size_t)a->ldi, a->n);
  bool several = !a->tangent && !a->guide && a->n <= PW_CHUNK;
  if (several) {
    pw_hypo_advance_smooth(&h, plane, a, done);
    pw_hypo_advance_rest(&h, plane, a, done);
  }
  a->bad = -1;
  for (pw_idx i = 0; i < a->n; i++) {
    if (several && done[i] > 0.0) {
      continue;
    }
    if (update_point(&h, a, plane, i) != PW_OK) {
      a->bad = a->bad < 0 ? i : a->bad;
    }
  }
  return a->bad < 0 ? PW_OK : PW_RETRY_STRESS;
}

static pw_real mobilised_angle(const pw_real *v, const pw_real *stress)
{
  return pw_hypo_friction_angle(pw_t6_shift(pw_t6_load(stress, 1), -v[PW_HYPO_P_T]));
}

extern const pw_material pw_material_hypoplastic_sand;
const pw_material pw_material_hypoplastic_sand = {
    .name = "hypoplastic_sand",
    .brief = "hypoplastic sand (von Wolffersdorff 1996) with intergranular strain (Niemunis and "
             "Herle 1997)",
    .keys = keys,
    .states = states,
    .substeps = true,
    .takes_initial_stress = true,
    .check = check,
    .nstate = nstate,
    .density = density,
    .step_part = step_part,
    .init = init,
    .update = update,
    .mobilised_angle = mobilised_angle,
};
