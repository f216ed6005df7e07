/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hypoplastic clay of 2005 against what its equations promise in closed form: the virgin line, the
 * slope of swelling, K/G = r, the critical state (stress, volume, no dilation), homogeneity in the
 * stress, 1 : m_T : m_R after turns, undrained strength; tangent, torture, rotation, batches. */
#include "kernels/hypoplastic_clay.h"
#include "tests/material_batch.h"

static const double pi = 3.14159265358979323846;
static const double phi = 25.0, lambda = 0.10, kappa = 0.01, big_n = 1.0, ratio = 0.4;

/** London clay of Masin (2005) rounded, without intergranular strain. */
static test_material clay(double ocr)
{
  test_material m = test_material_of("hypoplastic_clay");
  test_set(&m, "critical_friction_angle_deg", phi);
  test_set(&m, "compression_index_lambda_star", lambda);
  test_set(&m, "swelling_index_kappa_star", kappa);
  test_set(&m, "virgin_line_n", big_n);
  test_set(&m, "stiffness_ratio_r", ratio);
  test_set(&m, "overconsolidation_ratio", ocr);
  test_set(&m, "density_kg_m3", 1900.0);
  test_set(&m, "intergranular_strain", 0.0);
  return m;
}

static double pressure(const pw_real *s)
{
  return -(s[0] + s[1] + s[2]) / 3.0;
}

/** Isotropic: ln(1 + e) = N - lambda* ln(p/p_r) on loading from it; swelling starts with kappa*. */
static void virgin_line_and_swelling(void **unused)
{
  (void)unused;
  test_material m = clay(1.0);
  test_set(&m, "substep_tolerance", 1e-9);
  pw_element el = test_start(&m, 1e5);
  const pw_real press[6] = {-1e-3, -1e-3, -1e-3}, open[6] = {1e-7, 1e-7, 1e-7};
  for (int i = 0; i < 100; i++) {
    assert_ok(pw_element_move(&el, press, NULL, NULL));
    double line = big_n - lambda * log(pressure(el.stress) / 1000.0);
    assert_near(log1p(el.state[0]), line, 1e-9);
  }
  double p = pressure(el.stress);
  assert_ok(pw_element_move(&el, open, NULL, NULL));
  assert_relative(3e-7 / log(p / pressure(el.stress)), kappa, 1e-4);
}

/** On the virgin line the shear modulus of L is that of virgin compression, p/lambda*, over r. */
static void stiffness_ratio(void **unused)
{
  (void)unused;
  test_material m = clay(1.0);
  pw_clay c;
  pw_clay_derive(m.v, &c);
  pw_hypo_point at = {.stress = {-1e5, -1e5, -1e5, 0, 0, 0}};
  at.void_ratio = expm1(big_n - lambda * log(100.0));
  const pw_t6 shear = {.xy = 1e-6}, opposite = {.xy = -1e-6}, press = {-1, -1, -1, 0, 0, 0};
  double g =
      (pw_clay_evaluate(&c, &at, shear).stress.xy - pw_clay_evaluate(&c, &at, opposite).stress.xy) /
      4e-6;
  double k = -pw_t6_trace(pw_clay_evaluate(&c, &at, press).stress) / 9.0;
  assert_relative(k, 1e5 / lambda, 1e-12);
  assert_relative(k / g, ratio, 1e-12);
}

static pw_t6 on_cone(double p, double lode)
{
  pw_t6 dev = {.xx = cos(lode), .yy = cos(lode - 2.0 * pi / 3.0), .zz = cos(lode + 2.0 * pi / 3.0)};
  double low = 0.0, high = p;
  for (int i = 0; i < 100; i++) {
    double size = 0.5 * (low + high);
    pw_t6 stress = pw_t6_shift(pw_t6_scale(-size, dev), -p);
    *(pw_hypo_friction_angle(stress) < phi * pi / 180.0 ? &low : &high) = size;
  }
  return pw_t6_shift(pw_t6_scale(-low, dev), -p);
}

/** On the Matsuoka-Nakai cone of phi_c with p = p_e/2: Y = 1, f_d = 1, and for flow along m, which
 *  keeps the volume, the stress rests. */
static void critical_state(void **unused)
{
  (void)unused;
  test_material m = clay(1.0);
  pw_clay c;
  pw_clay_derive(m.v, &c);
  for (int i = 0; i <= 60; i++) {
    double p = 1e5;
    pw_hypo_point at = {.stress = on_cone(p, i * pi / 60.0)};
    at.void_ratio = expm1(big_n - lambda * log(2.0 * p / 1000.0));
    pw_clay_rates r = pw_clay_evaluate(&c, &at, (pw_t6){0});
    assert_near(r.y, 1.0, 1e-11);
    assert_near(r.f_d, 1.0, 1e-12);
    /* flow: L:D = -N |D| with L = f_s 3 (c1 I + c2 a^2 s s) inverted */
    pw_t6 s = pw_t6_scale(-1.0 / (3.0 * p), at.stress);
    double along = c.c2a * pw_t6_dot(s, r.n) / (c.c1 + c.c2a * pw_t6_dot(s, s));
    pw_t6 d = pw_t6_scale(-1.0 / (3.0 * r.f_s * c.c1), pw_t6_axpy(r.n, -along, s));
    assert_near(pw_t6_norm(d), 1.0, 1e-10);
    assert_near(pw_t6_trace(d), 0.0, 1e-10);
    r = pw_clay_evaluate(&c, &at, d);
    assert_true(pw_t6_norm(r.stress) < 1e-9 * r.f_s);
  }
}

/** Undrained shearing from any overconsolidation ends at p = p_e/2, phi_c: q/p = 6 sin/(3 - sin). */
static void undrained_strength(void **unused)
{
  (void)unused;
  for (int k = 0; k < 3; k++) {
    const double ocr[3] = {1.0, 2.0, 6.0};
    test_material m = clay(ocr[k]);
    pw_element el = test_start(&m, 1e5);
    const pw_real push[6] = {5e-4, -1e-3, 5e-4, 0, 0, 0};
    for (int i = 0; i < 1500; i++) {
      assert_ok(pw_element_move(&el, push, NULL, NULL));
    }
    double s = sin(phi * pi / 180.0), p = 0.5e5 * ocr[k];
    assert_relative(pressure(el.stress), p, 1e-4);
    assert_relative(sqrt(1.5) * test_dev_norm(el.stress), 6.0 * s / (3.0 - s) * p, 1e-4);
  }
}

/** Rates are of first degree in the stress at constant p/p_e. */
static void homogeneous_in_the_stress(void **unused)
{
  (void)unused;
  test_material m = clay(1.0);
  pw_clay c;
  pw_clay_derive(m.v, &c);
  const pw_t6 d = {1e-3, -2e-3, 0, 5e-4, 0, 1e-4};
  pw_hypo_point a = {.stress = {-8e4, -1.2e5, -9e4, 1e4, 5e3, 0}}, b = a;
  b.stress = pw_t6_scale(3.0, a.stress);
  a.void_ratio = 0.8;
  b.void_ratio = expm1(log1p(0.8) - lambda * log(3.0));
  pw_t6 x = pw_clay_evaluate(&c, &a, d).stress, y = pw_clay_evaluate(&c, &b, d).stress;
  assert_true(pw_t6_norm(pw_t6_axpy(y, -3.0, x)) < 1e-12 * pw_t6_norm(y));
}

/** With full intergranular strain along d: the basic model for D along d, m_T L across, m_R L back. */
static void stiffness_after_turns(void **unused)
{
  (void)unused;
  test_material m = clay(1.5), basic = m;
  test_set(&m, "intergranular_strain", 1.0);
  test_set(&m, "stiffness_ratio_m_r", 5.0);
  test_set(&m, "stiffness_ratio_m_t", 2.0);
  pw_clay c, c0;
  pw_clay_derive(m.v, &c);
  pw_clay_derive(basic.v, &c0);
  const pw_t6 d = {.xy = 0.6 / sqrt(2.0), .yy = -0.8}, across = {.yy = 0.6, .xy = 0.8 / sqrt(2.0)};
  pw_hypo_point at = {.stress = {-8e4, -1.2e5, -9e4, 1e4, 5e3, 0}, .void_ratio = 0.8};
  at.delta = pw_t6_scale(c.r, d);
  pw_t6 on = pw_clay_evaluate(&c, &at, d).stress, want = pw_clay_evaluate(&c0, &at, d).stress;
  assert_true(pw_t6_norm(pw_t6_axpy(on, -1.0, want)) < 1e-11 * pw_t6_norm(on));
  pw_t6 n = pw_clay_evaluate(&c0, &at, d).n;
  pw_t6 linear = pw_t6_axpy(pw_clay_evaluate(&c0, &at, across).stress, -1.0, n);
  on = pw_clay_evaluate(&c, &at, across).stress;
  assert_true(pw_t6_norm(pw_t6_axpy(on, -2.0, linear)) < 1e-11 * pw_t6_norm(on));
  pw_t6 back = pw_t6_scale(-1.0, d);
  linear = pw_t6_axpy(pw_clay_evaluate(&c0, &at, back).stress, -1.0, n);
  on = pw_clay_evaluate(&c, &at, back).stress;
  assert_true(pw_t6_norm(pw_t6_axpy(on, -5.0, linear)) < 1e-11 * pw_t6_norm(on));
}

/** Central differences of the update itself with a tight tolerance. */
static void tangent_is_the_derivative(void **unused)
{
  (void)unused;
  uint64_t seed = 41;
  double worst = 0.0;
  for (int trial = 0; trial < 60; trial++) {
    test_material m = clay(1.0 + 3.0 * test_random(&seed));
    test_set(&m, "intergranular_strain", trial % 2);
    test_set(&m, "initial_intergranular", trial % 3);
    test_set(&m, "substep_tolerance", 1e-9);
    test_set(&m, "max_substeps", 1000.0);
    pw_element el = test_start(&m, 1e5);
    pw_real de[6];
    test_random_strain(&seed, trial % 4 ? 1e-5 : 1e-4, de);
    worst = fmax(worst, test_tangent_error(&el, de, 1e-8, 4.5 * 3.0 * 1e5 / kappa));
  }
  print_message("tangent against differences: %.2e of the largest stiffness\n", worst);
  assert_true(worst < 1e-6);
}

/** 10^5 random increments up to 1e-3: finite, at least the least pressure. */
static void survives_torture(void **unused)
{
  (void)unused;
  uint64_t seed = 43;
  test_material m = clay(1.3);
  test_set(&m, "intergranular_strain", 1.0);
  pw_element el = test_start(&m, 1e5);
  for (int i = 0; i < 100000; i++) {
    pw_real de[6];
    if (i % 200 == 0) {
      el = test_start(&m, 1e3 + 3e5 * test_random(&seed));
    }
    test_random_strain(&seed, pow(10.0, -6.0 + 3.0 * test_random(&seed)), de);
    assert_ok(pw_element_move(&el, de, NULL, NULL));
    assert_true(pressure(el.stress) >= 100.0 * (1.0 - 1e-9) && isfinite(test_dev_norm(el.stress)));
    assert_true(isfinite(el.wave_speed) && el.wave_speed > 0.0);
  }
  print_message("%.1f right-hand sides an increment\n", (double)el.counts.rhs / 200.0);
}

/** f_d Y of a soil far looser than the virgin line at the largest stress ratio would be 20 and
 *  more; bounded, |N| is at most 1.2 |L:m|/|m| and the stress cannot grow by N alone. */
static void loose_soil_stays_soft(void **unused)
{
  (void)unused;
  test_material m = clay(0.0);
  test_set(&m, "void_ratio", 3.0);
  pw_clay c;
  pw_clay_derive(m.v, &c);
  uint64_t seed = 47;
  double most = 0.0;
  for (int i = 0; i < 2000; i++) {
    pw_hypo_point at = {.void_ratio = 3.0, .stress = {-1e3, -1e3, -1e3, 0, 0, 0}};
    pw_real de[6], far[6];
    test_random_strain(&seed, 1e4, far);
    at.stress = pw_hypo_limit(&c.limits, pw_t6_axpy(at.stress, 1.0, pw_t6_load(far, 1)));
    test_random_strain(&seed, 1.0, de);
    pw_t6 d = pw_t6_load(de, 1);
    pw_clay_rates r = pw_clay_evaluate(&c, &at, d);
    pw_real stiff = r.f_s * 3.0 * (c.c1 + c.c2a);
    most = fmax(most, pw_t6_norm(r.n) / stiff);
  }
  assert_true(most <= 1.2);
}

/** Stiffness of plane waves, m.sigma_dot(m n).n for |m| = |n| = 1, against the bound, over stresses
 *  up to the limiting ratio, overconsolidation, and intergranular strains of any direction. */
static void wave_speed_is_an_upper_bound(void **unused)
{
  (void)unused;
  uint64_t seed = 53;
  for (int with = 0; with < 2; with++) {
    double most = 0.0;
    for (int i = 0; i < 20000; i++) {
      test_material m = clay(1.0);
      test_set(&m, "intergranular_strain", with);
      test_set(&m, "stiffness_ratio_m_r", i % 2 ? 4.5 : 10.0);
      test_set(&m, "stiffness_ratio_m_t", i % 3 ? 4.5 : 1.0);
      pw_clay c;
      pw_clay_derive(m.v, &c);
      pw_real far[6], delta[6], d[3], n[3], size = 0.0, nn = 0.0;
      test_random_strain(&seed, 4e5 * test_random(&seed), far);
      pw_hypo_point at = {.stress = {-1e5, -1e5, -1e5, 0, 0, 0}};
      at.stress = pw_hypo_limit(&c.limits, pw_t6_axpy(at.stress, 1.0, pw_t6_load(far, 1)));
      const double p = -pw_t6_trace(at.stress) / 3.0,
                   ocr = pow(10.0, 2.0 * test_random(&seed) - 0.3);
      at.void_ratio = expm1(big_n - lambda * log(ocr * p / 1000.0));
      test_random_strain(&seed, 1.0, delta);
      at.delta = pw_t6_load(delta, 1);
      at.delta = pw_t6_scale(c.r * test_random(&seed) / pw_t6_norm(at.delta), at.delta);
      for (int k = 0; k < 3; k++) {
        n[k] = test_random(&seed) - 0.5;
        d[k] = i % 2 ? n[k] : test_random(&seed) - 0.5;
        nn += n[k] * n[k];
        size += d[k] * d[k];
      }
      const pw_t6 e = {d[0] * n[0],
                       d[1] * n[1],
                       d[2] * n[2],
                       0.5 * (d[0] * n[1] + d[1] * n[0]),
                       0.5 * (d[1] * n[2] + d[2] * n[1]),
                       0.5 * (d[2] * n[0] + d[0] * n[2])};
      const pw_clay_rates r = pw_clay_evaluate(&c, &at, e);
      most = fmax(most, pw_t6_dot(e, r.stress) / (nn * size * r.modulus));
    }
    print_message("waves: at most %.3f of the modulus of the bound\n", most);
    assert_true(most <= 1.0 && most > 0.6);
  }
}

static void rotation_keeps_the_invariants(void **unused)
{
  (void)unused;
  test_material m = clay(2.0);
  test_set(&m, "intergranular_strain", 1.0);
  pw_element el = test_start(&m, 1e5);
  const pw_real de[6] = {1e-4, -2e-3, 3e-4, 1e-4, -5e-4, 2e-4};
  assert_ok(pw_element_move(&el, de, NULL, NULL));
  assert_true(test_turning_error(&el) < 1e-10);
}

static void place_does_not_matter(void **unused)
{
  (void)unused;
  test_material m = clay(1.5);
  test_set(&m, "intergranular_strain", 1.0);
  test_place_does_not_matter(&m, 1e5, 1e-4, true);
  test_place_does_not_matter(&m, 1e5, 1e-4, false);
}

/** Several points at once give what one by one gives (the update with a tangent is one by one). */
static void lanes_follow_the_single_point(void **unused)
{
  (void)unused;
  uint64_t seed = 59;
  double worst = 0.0;
  for (int trial = 0; trial < 4000; trial++) {
    test_material m = clay(1.0 + 3.0 * test_random(&seed));
    test_set(&m, "intergranular_strain", trial % 3 != 0);
    test_set(&m, "initial_intergranular", trial % 2);
    pw_element el = test_start(&m, 5e4 + 1e5 * test_random(&seed)), lanes, single;
    const double size = pow(10.0, -7.0 + 3.5 * test_random(&seed));
    for (int step = 0; step < 3; step++) {
      pw_real de[6], tangent[36];
      test_random_strain(&seed, size, de);
      assert_ok(test_update(&el, de, NULL, &lanes, NULL));
      assert_ok(test_update(&el, de, NULL, &single, tangent));
      for (int c = 0; c < 6; c++) {
        worst = fmax(worst, fabs(lanes.stress[c] - single.stress[c]) / pressure(el.stress));
        worst =
            fmax(worst, trial % 3 ? fabs(lanes.state[1 + c] - single.state[1 + c]) / 1e-4 : 0.0);
      }
      worst = fmax(worst, fabs(lanes.state[0] - single.state[0]));
      el = lanes;
    }
  }
  print_message("several points at once or one by one: %.1e apart\n", worst);
  assert_true(worst < 1e-12);
}

static void bad_parameters_are_named(void **unused)
{
  (void)unused;
  test_material m = clay(1.0);
  assert_ok(m.model->check(m.v));
  test_set(&m, "void_ratio", 0.8);
  test_refuses(&m, "exactly one of void_ratio and overconsolidation_ratio");
  m = clay(1.0);
  test_set(&m, "swelling_index_kappa_star", 0.2);
  test_refuses(&m, "compression_index_lambda_star > swelling_index_kappa_star");
  m = clay(1.0);
  test_set(&m, "swelling_index_kappa_star", 0.05);
  test_refuses(&m, "alpha");
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(virgin_line_and_swelling),
                                     cmocka_unit_test(stiffness_ratio),
                                     cmocka_unit_test(critical_state),
                                     cmocka_unit_test(undrained_strength),
                                     cmocka_unit_test(homogeneous_in_the_stress),
                                     cmocka_unit_test(stiffness_after_turns),
                                     cmocka_unit_test(tangent_is_the_derivative),
                                     cmocka_unit_test(survives_torture),
                                     cmocka_unit_test(loose_soil_stays_soft),
                                     cmocka_unit_test(wave_speed_is_an_upper_bound),
                                     cmocka_unit_test(rotation_keeps_the_invariants),
                                     cmocka_unit_test(place_does_not_matter),
                                     cmocka_unit_test(lanes_follow_the_single_point),
                                     cmocka_unit_test(bad_parameters_are_named)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
