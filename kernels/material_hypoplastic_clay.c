/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/hypoplastic_clay.h"
#include "kernels/rate_form.h"

enum { VOID_RATIO, DELTA, SUBSTEP = 7 };

#define AT(index) ((index) * sizeof(pw_real))
#define REAL(name, index, lo, hi, fallback, meaning)                                               \
  {                                                                                                \
    name, PW_KEY_REAL, AT(index), lo, hi, fallback, NULL, NULL, meaning                            \
  }

static const pw_key keys[] = {
    REAL("critical_friction_angle_deg", PW_CLAY_PHI_C, 1e-3, 89.999, NULL,
         "friction angle of critical states, phi_c"),
    REAL("compression_index_lambda_star", PW_CLAY_LAMBDA, 1e-6, 10, NULL,
         "slope of the isotropic virgin line in ln(1 + e) over ln p, lambda*"),
    REAL("swelling_index_kappa_star", PW_CLAY_KAPPA, 1e-7, 10, NULL,
         "slope in the same plane where swelling from the virgin line begins, kappa*"),
    REAL("virgin_line_n", PW_CLAY_N, 1e-3, 20, NULL, "ln(1 + e) of the virgin line at 1 kPa, N"),
    REAL("stiffness_ratio_r", PW_CLAY_RATIO, 1e-3, 10, NULL,
         "bulk over shear modulus of isotropic virgin states, r"),
    REAL("void_ratio", PW_CLAY_VOID_RATIO, 0, 20, "0",
         "at the start; it or overconsolidation_ratio"),
    REAL("overconsolidation_ratio", PW_CLAY_OCR, 0, 1e4, "0",
         "p_e/p at the initial stress, from which the void ratio follows; 1 is the virgin line"),
    REAL("density_kg_m3", PW_CLAY_DENSITY, PW_TINY, PW_HUGE, NULL, "density at the start"),
    {"intergranular_strain", PW_KEY_BOOL, AT(PW_CLAY_INTERGRANULAR), 0, 1, "true", NULL, NULL,
     "stiffness at small strain; false is the model without it"},
    REAL("stiffness_ratio_m_r", PW_CLAY_M_R, 1.0, 1e3, "4.5", "stiffness after a reversal, m_R"),
    REAL("stiffness_ratio_m_t", PW_CLAY_M_T, 1.0, 1e3, "4.5", "stiffness after a right turn, m_T"),
    REAL("elastic_range_r", PW_CLAY_R, 1e-9, 0.1, "1e-4", "largest intergranular strain, R"),
    REAL("exponent_beta_r", PW_CLAY_BETA_R, 1e-3, 100.0, "0.2", "of its evolution, beta_r"),
    REAL("exponent_chi", PW_CLAY_CHI, 1e-3, 100.0, "6", "of the change of stiffness, chi"),
    {"initial_intergranular", PW_KEY_CHOICE, AT(PW_CLAY_INITIAL_DELTA), 0, 2, "zero",
     "zero|isotropic|oedometric", NULL, "intergranular strain at the start; oedometric is along y"},
    REAL("substep_tolerance", PW_CLAY_TOLERANCE, 1e-12, 0.1, "1e-3",
         "relative error of stress and of intergranular strain over R in a substep"),
    REAL("pressure_min_pa", PW_CLAY_P_MIN, 1e-6, PW_HUGE, "100",
         "least mean pressure. Soil that has come apart presses with it: keep it well below weight "
         "times the size of a point, or a free surface takes off"),
    REAL("stress_ratio_limit_deg", PW_CLAY_PHI_LIMIT, 1.0, 89.0, "60",
         "largest Matsuoka-Nakai friction angle"),
    REAL("max_substeps", PW_CLAY_MAX_SUBSTEPS, 10.0, PW_HYPO_SUBSTEP_LIMIT, "400",
         "substeps of one increment, after which the rest is taken at once"),
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
  int given = (v[PW_CLAY_VOID_RATIO] > 0.0) + (v[PW_CLAY_OCR] > 0.0);
  pw_clay c;
  PW_REQUIRE(v[PW_CLAY_PHI_C] > 0.0 && v[PW_CLAY_PHI_C] < 90.0, PW_ERR_SCENE,
             "critical_friction_angle_deg = %g must lie between 0 and 90", v[PW_CLAY_PHI_C]);
  PW_REQUIRE(v[PW_CLAY_LAMBDA] > v[PW_CLAY_KAPPA] && v[PW_CLAY_KAPPA] > 0.0, PW_ERR_SCENE,
             "compression_index_lambda_star > swelling_index_kappa_star > 0 must hold: %g, %g",
             v[PW_CLAY_LAMBDA], v[PW_CLAY_KAPPA]);
  PW_REQUIRE(v[PW_CLAY_RATIO] > 0.0 && v[PW_CLAY_DENSITY] > 0.0, PW_ERR_SCENE,
             "stiffness_ratio_r = %g and density_kg_m3 = %g must be positive", v[PW_CLAY_RATIO],
             v[PW_CLAY_DENSITY]);
  PW_REQUIRE(
      given == 1, PW_ERR_SCENE,
      "exactly one of void_ratio and overconsolidation_ratio must be given and positive, not "
      "%d of them",
      given);
  PW_REQUIRE(v[PW_CLAY_PHI_LIMIT] > v[PW_CLAY_PHI_C], PW_ERR_SCENE,
             "stress_ratio_limit_deg = %g must exceed critical_friction_angle_deg = %g",
             v[PW_CLAY_PHI_LIMIT], v[PW_CLAY_PHI_C]);
  pw_clay_derive(v, &c);
  PW_REQUIRE(
      c.alpha > 0.0, PW_ERR_SCENE,
      "swelling_index_kappa_star = %g is too large for compression_index_lambda_star = %g at "
      "this friction angle: alpha = %g must be positive",
      v[PW_CLAY_KAPPA], v[PW_CLAY_LAMBDA], c.alpha);
  PW_REQUIRE(c.c2a > 0.0, PW_ERR_SCENE,
             "stiffness_ratio_r = %g is too small: c2 = %g must be positive", v[PW_CLAY_RATIO],
             c.c2a * c.inv_a * c.inv_a);
  if (v[PW_CLAY_INTERGRANULAR] > 0.5) {
    PW_REQUIRE(v[PW_CLAY_M_R] >= v[PW_CLAY_M_T] && v[PW_CLAY_M_T] >= 1.0, PW_ERR_SCENE,
               "stiffness_ratio_m_r >= stiffness_ratio_m_t >= 1 must hold: %g, %g", v[PW_CLAY_M_R],
               v[PW_CLAY_M_T]);
  }
  return PW_OK;
}

static int nstate(const pw_real *v)
{
  return v[PW_CLAY_INTERGRANULAR] > 0.5 ? SUBSTEP + 1 : 1;
}

static pw_real density(const pw_real *v)
{
  return v[PW_CLAY_DENSITY];
}

static void init(const pw_real *v, pw_idx n, pw_idx ld, const pw_real *stress, pw_real *state)
{
  const size_t l = (size_t)ld;
  const int choice = (int)v[PW_CLAY_INITIAL_DELTA];
  pw_t6 delta = {0};
  if (choice == PW_HYPO_DELTA_ISOTROPIC) {
    delta = pw_t6_shift(delta, -v[PW_CLAY_R] / sqrt(3.0));
  } else if (choice == PW_HYPO_DELTA_OEDOMETRIC) {
    delta.yy = -v[PW_CLAY_R];
  }
  for (size_t i = 0; i < (size_t)n; i++) {
    pw_real p = pw_max(-pw_t6_trace(pw_t6_load(stress + i, l)) / 3.0, v[PW_CLAY_P_MIN]);
    pw_real e = v[PW_CLAY_VOID_RATIO];
    if (v[PW_CLAY_OCR] > 0.0) {
      e = expm1(v[PW_CLAY_N] - v[PW_CLAY_LAMBDA] * log(v[PW_CLAY_OCR] * p / PW_CLAY_P_R));
      e = pw_max(e, 1e-3);
    }
    state[VOID_RATIO * l + i] = e;
    if (v[PW_CLAY_INTERGRANULAR] > 0.5) {
      pw_t6_store(delta, state + DELTA * l + i, l);
      state[SUBSTEP * l + i] = 1.0;
    }
  }
}

static pw_hypo_point read(const pw_clay *c, const pw_stress_args *a, size_t p)
{
  const size_t l = (size_t)a->ld, li = (size_t)a->ldi;
  const bool plane = pw_spin_is_plane(a->spin + p, li, 1);
  pw_hypo_point at = {.stress = pw_rate_turned(a, p, plane),
                      .void_ratio = a->state[VOID_RATIO * l + p],
                      .substep = 1.0};
  if (c->intergranular) {
    pw_rot r = pw_rot_hughes_winget(a->spin[p], a->spin[li + p], a->spin[2 * li + p]);
    pw_t6 delta = pw_t6_load(a->state + DELTA * l + p, l);
    at.delta = plane ? pw_t6_rotate_plane(a->spin[p], delta) : pw_t6_rotate(r, delta);
    at.substep = a->state[SUBSTEP * l + p];
  }
  return at;
}

/** Advance a point by the substeps that its guide takes from where it starts. */
static pw_status repeat(const pw_clay *c, const pw_stress_args *a, size_t p, pw_hypo_point *at,
                        pw_hypo_path *path)
{
  const size_t li = (size_t)a->ldi;
  pw_stress_args g = *a;
  g.spin = a->guide + 6 * li;
  pw_hypo_point first = read(c, &g, p);
  pw_t6 de = pw_t6_load(a->guide + p, li);
  PW_TRY(pw_clay_integrate(c, de, a->guide[9 * li + p], &first, path, a->counts));
  PW_TRY(pw_clay_repeat(c, pw_t6_load(a->dstrain + p, li), a->dvol[p], at, path));
  at->substep = first.substep;
  return PW_OK;
}

static pw_status update_point(const pw_clay *c, const pw_stress_args *a, size_t p)
{
  const size_t l = (size_t)a->ld;
  pw_hypo_path path;
  pw_hypo_point start = read(c, a, p), end = start;
  pw_t6 de = pw_t6_load(a->dstrain + p, (size_t)a->ldi);
  pw_status s =
      a->guide ? repeat(c, a, p, &end, &path)
               : pw_clay_integrate(c, de, a->dvol[p], &end, a->tangent ? &path : NULL, a->counts);
  if (s == PW_OK) {
    pw_t6_store(end.stress, a->stress + p, l);
    a->state[VOID_RATIO * l + p] = end.void_ratio;
    if (c->intergranular) {
      pw_t6_store(end.delta, a->state + DELTA * l + p, l);
      a->state[SUBSTEP * l + p] = end.substep;
    }
  } else {
    path.n = 0;
  }
  pw_hypo_point at = end;
  if (!pw_hypo_inside(&c->limits, at.stress)) {
    at.stress = pw_hypo_limit(&c->limits, at.stress);
  }
  a->wave_speed[p] = sqrt(pw_clay_evaluate(c, &at, (pw_t6){0}).modulus / a->density[p]);
  if (a->tangent) {
    pw_real matrix[36];
    pw_clay_tangent(c, de, a->dvol[p], &start, &path, matrix);
    pw_rate_store_tangent(a, p, matrix);
  }
  return s;
}

/** Advance @p a->n <= PW_CHUNK points; the first failing one, or -1. */
static pw_idx update_chunk(const pw_clay *c, const pw_stress_args *a)
{
  pw_real done[PW_CHUNK] = {0};
  pw_idx bad = -1;
  if (!a->tangent && !a->guide) {
    pw_clay_advance(c, pw_spin_is_plane(a->spin, (size_t)a->ldi, a->n), a, done);
  }
  for (pw_idx i = 0; i < a->n; i++) {
    if (!(done[i] > 0.0) && update_point(c, a, (size_t)i) != PW_OK && bad < 0) {
      bad = i;
    }
  }
  return bad;
}

static pw_status update(const pw_real *param, pw_stress_args *a)
{
  pw_clay c;
  pw_clay_derive(param, &c);
  a->bad = -1;
  for (pw_idx first = 0; first < a->n; first += PW_CHUNK) {
    const pw_idx n = a->n - first < PW_CHUNK ? a->n - first : PW_CHUNK;
    const pw_stress_args part = pw_rate_part(a, first, n);
    const pw_idx bad = update_chunk(&c, &part);
    a->bad = a->bad < 0 && bad >= 0 ? first + bad : a->bad;
  }
  return a->bad < 0 ? PW_OK : PW_RETRY_STRESS;
}

static pw_real mobilised_angle(const pw_real *v, const pw_real *stress)
{
  (void)v;
  return pw_hypo_friction_angle(pw_t6_load(stress, 1));
}

extern const pw_material pw_material_hypoplastic_clay;
const pw_material pw_material_hypoplastic_clay = {
    .name = "hypoplastic_clay",
    .brief = "hypoplastic clay (Masin 2005) with intergranular strain (Niemunis and Herle 1997)",
    .keys = keys,
    .states = states,
    .substeps = true,
    .takes_initial_stress = true,
    .check = check,
    .nstate = nstate,
    .density = density,
    .init = init,
    .update = update,
    .mobilised_angle = mobilised_angle,
};
