/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each rule on the parameters gives PW_ERR_SCENE with its keys named; initial states. */
#include "kernels/material.h"
#include "tests/hypoplastic_reference.h"

static const pw_material *sand(void)
{
  return pw_material_find("hypoplastic_sand");
}

static const struct {
  int index;
  double value;
  const char *named; /* must stand in the message */
} broken[] = {{PW_HYPO_N, 0.0, "exponent_n"},
              {PW_HYPO_N, 1.0, "exponent_n"},
              {PW_HYPO_H_S, 0.0, "granular_hardness_pa"},
              {PW_HYPO_PHI_C, 0.0, "critical_friction_angle_deg"},
              {PW_HYPO_PHI_C, 90.0, "critical_friction_angle_deg"},
              {PW_HYPO_E_D0, 0.84, "void_ratio_d0"},
              {PW_HYPO_E_D0, 0.0, "void_ratio_d0"},
              {PW_HYPO_E_I0, 0.84, "void_ratio_i0"},
              {PW_HYPO_ALPHA, 3.0, "exponent_alpha"}, /* the bracket of f_b is negative */
              {PW_HYPO_M_R, 1.5, "stiffness_ratio_m_r"},
              {PW_HYPO_M_T, 0.5, "stiffness_ratio_m_t"},
              {PW_HYPO_R, 0.0, "elastic_range_r"},
              {PW_HYPO_BETA_R, 0.0, "exponent_beta_r"},
              {PW_HYPO_CHI, 0.0, "exponent_chi"},
              {PW_HYPO_PHI_LIMIT, 30.0, "stress_ratio_limit_deg"}};

static void every_rule_is_checked(void **unused)
{
  (void)unused;
  pw_real v[PW_HYPO_PARAMS];
  reference_set(0, 1e-3, v);
  assert_ok(sand()->check(v));
  for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++) {
    reference_set(0, 1e-3, v);
    v[broken[i].index] = broken[i].value;
    pw_error_clear();
    assert_int_equal(sand()->check(v), PW_ERR_SCENE);
    assert_non_null(strstr(pw_error_text(), broken[i].named));
  }
}

/** Ratios of an intergranular strain that is off are not looked at. */
static void rules_of_what_is_off_do_not_apply(void **unused)
{
  (void)unused;
  pw_real v[PW_HYPO_PARAMS];
  reference_set(0, 1e-3, v);
  v[PW_HYPO_INTERGRANULAR] = 0.0;
  v[PW_HYPO_M_R] = 1.0;
  assert_ok(sand()->check(v));
  assert_int_equal(sand()->nstate(v), 1);
  v[PW_HYPO_INTERGRANULAR] = 1.0;
  assert_int_equal(sand()->nstate(v), 8);
}

/** The keys stand in the order of the parameters; defaults are those of the Karlsruhe sand. */
static void keys_match_the_parameters(void **unused)
{
  (void)unused;
  const pw_key *k = sand()->keys;
  const struct {
    int index;
    const char *name, *fallback;
  } some[] = {{PW_HYPO_GRAIN_DENSITY, "grain_density_kg_m3", NULL},
              {PW_HYPO_VOID_RATIO, "void_ratio", NULL},
              {PW_HYPO_P_T, "cohesion_shift_pa", "0"},
              {PW_HYPO_M_R, "stiffness_ratio_m_r", "10"},
              {PW_HYPO_M_T, "stiffness_ratio_m_t", "2"},
              {PW_HYPO_R, "elastic_range_r", "5e-5"},
              {PW_HYPO_BETA_R, "exponent_beta_r", "0.3"},
              {PW_HYPO_CHI, "exponent_chi", "1"},
              {PW_HYPO_TOLERANCE, "substep_tolerance", "1e-3"},
              {PW_HYPO_P_MIN, "pressure_min_pa", "100"},
              {PW_HYPO_MAX_SUBSTEPS, "max_substeps", "400"}};
  int count = 0;
  for (; k[count].name; count++) {
    assert_int_equal(k[count].offset, (size_t)count * sizeof(pw_real));
  }
  assert_int_equal(count, PW_HYPO_PARAMS);
  assert_true(count <= PW_MAX_PARAMS);
  for (size_t i = 0; i < sizeof some / sizeof some[0]; i++) {
    assert_string_equal(k[some[i].index].name, some[i].name);
    if (some[i].fallback) {
      assert_string_equal(k[some[i].index].fallback, some[i].fallback);
    } else {
      assert_null(k[some[i].index].fallback);
    }
  }
}

static void initial_states(void **unused)
{
  (void)unused;
  const pw_real stress[12] = {-1e5, -1e4, -1e5, -2e4, -1e5, -1e4, 0, 1e3, 0, 0, 0, 0};
  pw_real v[PW_HYPO_PARAMS], state[8][2];
  reference_set(0, 1e-3, v);
  sand()->init(v, 2, 2, stress, state[0]);
  assert_near(state[0][0], 0.65, 0.0);
  assert_near(state[2][1], 0.0, 0.0);
  assert_near(state[7][1], 1.0, 0.0);
  assert_near(sand()->density(v), 2600.0 / 1.65, 1e-9);
  v[PW_HYPO_VOID_RATIO_RULE] = PW_HYPO_RULE_BAUER;
  v[PW_HYPO_INITIAL_DELTA] = PW_HYPO_DELTA_ISOTROPIC;
  sand()->init(v, 2, 2, stress, state[0]);
  assert_near(state[0][0], 0.6102695, 5e-8); /* 0.65 at zero pressure is this at 100 kPa */
  assert_near(state[1][0], -5e-5 / sqrt(3.0), 1e-18);
  assert_near(state[3][1], -5e-5 / sqrt(3.0), 1e-18);
  assert_near(state[4][0], 0.0, 0.0);
  v[PW_HYPO_INITIAL_DELTA] = PW_HYPO_DELTA_OEDOMETRIC;
  const pw_real none[12] = {0};
  sand()->init(v, 2, 2, none, state[0]);
  assert_near(state[0][0], 0.65, 0.0);
  assert_near(state[1][0], 0.0, 0.0);
  assert_near(state[2][0], -5e-5, 0.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_rule_is_checked), cmocka_unit_test(rules_of_what_is_off_do_not_apply),
      cmocka_unit_test(keys_match_the_parameters), cmocka_unit_test(initial_states)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
