/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Modified Cam clay: compression and swelling lines, undrained strength, drained critical state,
 * undrained path, yield, dissipation, tangent, rotation, batches. */
#include "tests/material_batch.h"

static const double lambda = 0.2, kappa = 0.04, slope = 1.0, nu = 0.3, e0 = 1.1;

static test_material clay(double ocr)
{
  test_material m = test_material_of("modified_cam_clay");
  test_set(&m, "compression_index_lambda", lambda);
  test_set(&m, "swelling_index_kappa", kappa);
  test_set(&m, "critical_stress_ratio", slope);
  test_set(&m, "poisson_ratio", nu);
  test_set(&m, "void_ratio", e0);
  test_set(&m, "overconsolidation_ratio", ocr);
  test_set(&m, "density_kg_m3", 1700.0);
  return m;
}

static double pressure(const pw_real *s)
{
  return -(s[0] + s[1] + s[2]) / 3.0;
}

static double shear_stress(const pw_real *s)
{
  return sqrt(1.5) * test_dev_norm(s);
}

/** Isotropic: v falls by lambda ln p on the virgin line, rises by kappa ln p on unloading. */
static void compression_lines(void **unused)
{
  (void)unused;
  test_material m = clay(1.0);
  pw_element el = test_start(&m, 1e5);
  const pw_real press[6] = {-2e-3, -2e-3, -2e-3}, open[6] = {1e-3, 1e-3, 1e-3};
  for (int i = 0; i < 20; i++) {
    assert_ok(pw_element_move(&el, press, NULL, NULL));
    double p = pressure(el.stress);
    assert_near(el.state[0], e0 - lambda * log(p / 1e5), 1e-12);
    assert_relative(el.state[1], p, 1e-12);
    assert_near(shear_stress(el.stress), 0.0, 1e-9 * p);
  }
  double top = pressure(el.stress), e_top = el.state[0];
  for (int i = 0; i < 10; i++) {
    assert_ok(pw_element_move(&el, open, NULL, NULL));
    assert_near(el.state[0], e_top - kappa * log(pressure(el.stress) / top), 1e-12);
    assert_relative(el.state[1], top, 1e-14);
  }
}

/** Undrained shearing to failure: p_f = p0 (R/2)^((lambda - kappa)/lambda), q_f = M p_f, whatever
 *  the shape of the test (Wood, Soil Behaviour and Critical State Soil Mechanics, section 7.2). */
static void undrained_strength(void **unused)
{
  (void)unused;
  for (int k = 0; k < 4; k++) {
    const double ocr[4] = {1.0, 1.5, 4.0, 10.0};
    test_material m = clay(ocr[k]);
    pw_element axial = test_start(&m, 1e5), shear = axial;
    const pw_real push[6] = {1e-4, -2e-4, 1e-4, 0, 0, 0}, slide[6] = {0, 0, 0, 2e-4, 0, 0};
    for (int i = 0; i < 20000; i++) {
      assert_ok(pw_element_move(&axial, push, NULL, NULL));
      assert_ok(pw_element_move(&shear, slide, NULL, NULL));
    }
    double p = 1e5 * pow(0.5 * ocr[k], (lambda - kappa) / lambda);
    assert_relative(pressure(axial.stress), p, 1e-6);
    assert_relative(shear_stress(axial.stress), slope * p, 1e-6);
    assert_relative(pressure(shear.stress), p, 1e-6);
    assert_relative(shear_stress(shear.stress), slope * p, 1e-6);
  }
}

/** Undrained path of normally consolidated clay: p/p0 = (1 + n^2/M^2)^-(1 - kappa/lambda) with
 *  n = q/p, exact for any step. */
static void undrained_path(void **unused)
{
  (void)unused;
  test_material m = clay(1.0);
  pw_element el = test_start(&m, 1e5);
  const pw_real push[6] = {1e-3, -2e-3, 1e-3, 0, 0, 0};
  for (int i = 0; i < 40; i++) {
    assert_ok(pw_element_move(&el, push, NULL, NULL));
    double p = pressure(el.stress), n = shear_stress(el.stress) / p;
    double expected = 1e5 * pow(1.0 + n * n / (slope * slope), kappa / lambda - 1.0);
    assert_relative(p, expected, 1e-10);
  }
}

/** Undrained, normally consolidated, n = q/p = M tanh(y): p as above; shear strain by integrating
 *  elastic and plastic parts over n at v = 1 + e0, G = r v p/kappa, L = 1 - kappa/lambda:
 *    e_q = kappa/(3 r v) (n - 2 L (n - M atan(n/M))) + 2 kappa L/(v M) (y - atan(n/M)). */
static double undrained_shear_strain(double y)
{
  const double v = 1.0 + e0, n = slope * tanh(y), share = 1.0 - kappa / lambda;
  const double r = 1.5 * (1.0 - 2.0 * nu) / (1.0 + nu), angle = atan(n / slope);
  return kappa / (3.0 * r * v) * (n - 2.0 * share * (n - slope * angle)) +
         2.0 * kappa * share / (v * slope) * (y - angle);
}

static double undrained_q(double y)
{
  const double n = slope * tanh(y);
  return n * 1e5 * pow(1.0 + n * n / (slope * slope), kappa / lambda - 1.0);
}

static void undrained_stress_strain(void **unused)
{
  (void)unused;
  test_material m = clay(1.0);
  pw_element el = test_start(&m, 1e5);
  const pw_real push[6] = {1e-5, -2e-5, 1e-5, 0, 0, 0}; /* e_q = 2e-5 */
  for (int i = 1; i <= 5000; i++) {
    assert_ok(pw_element_move(&el, push, NULL, NULL));
    double n = shear_stress(el.stress) / pressure(el.stress);
    if (i > 50 && n < 0.999 * slope) {
      assert_relative(undrained_shear_strain(atanh(n / slope)), 2e-5 * i, 2e-3);
    }
  }
}

/** A cavity opened from nothing in undrained clay: every shell is in pure shear e, so that
 *  p = int 2 q/sqrt(3) de/(exp(2 e) - 1) with e_q = 2 e/sqrt(3) and the curve above. */
static void cavity_pressure(void **unused)
{
  (void)unused;
  test_material m = clay(1.0);
  pw_element el = test_start(&m, 1e5);
  double p = test_cavity_pressure(&el, 1e-6, 1.002), expected = 0.0;
  double last = undrained_shear_strain(1e-6), y = 1e-6;
  while (last < 20.0) {
    double middle = y * 1.0005, next = y * 1.001, strain = undrained_shear_strain(next);
    double e = 0.5 * sqrt(3.0) * undrained_shear_strain(middle);
    expected += undrained_q(middle) * (strain - last) / expm1(2.0 * e);
    y = next;
    last = strain;
  }
  print_message("cavity: %.6g Pa, by quadrature of the closed form %.6g Pa\n", p, expected);
  assert_relative(p, expected, 3e-3);
}

/** One-dimensional compression on the virgin line: n = q/p solves
 *  (1 - kappa/lambda) 2 n/(M^2 - n^2) + kappa n/(3 r lambda) = 2/3. */
static void compression_at_rest(void **unused)
{
  (void)unused;
  test_material m = clay(1.0);
  pw_element el = test_start(&m, 1e4);
  const pw_real press[6] = {0, -5e-5, 0, 0, 0, 0};
  for (int i = 0; i < 8000; i++) {
    assert_ok(pw_element_move(&el, press, NULL, NULL));
  }
  double low = 0.0, high = slope, r = 1.5 * (1.0 - 2.0 * nu) / (1.0 + nu);
  for (int i = 0; i < 60; i++) {
    double n = 0.5 * (low + high);
    double rest = (1.0 - kappa / lambda) * 2.0 * n / (slope * slope - n * n) +
                  kappa * n / (3.0 * r * lambda) - 2.0 / 3.0;
    *(rest < 0.0 ? &low : &high) = n;
  }
  assert_relative(shear_stress(el.stress) / pressure(el.stress), low, 1e-3);
}

/** Simple shear to 100 % with its spin: p and q of the critical state; the spin tilts the stress by
 *  the order of q/G. */
static void simple_shear(void **unused)
{
  (void)unused;
  test_material m = clay(1.0);
  pw_element el = test_start(&m, 1e5);
  const pw_real de[6] = {0, 0, 0, 5e-5, 0, 0}, spin[3] = {5e-5, 0, 0};
  for (int i = 0; i < 10000; i++) {
    assert_ok(pw_element_move(&el, de, spin, NULL));
  }
  double p = 1e5 * pow(0.5, (lambda - kappa) / lambda);
  assert_relative(pressure(el.stress), p, 1e-4);
  assert_relative(shear_stress(el.stress), slope * p, 1e-4);
  assert_relative(el.stress[3], slope * p / sqrt(3.0), 1e-3);
}

/** Drained triaxial compression ends at q = 3 (p - p0), q = M p; and v on the critical line. */
static void drained_critical_state(void **unused)
{
  (void)unused;
  for (int k = 0; k < 2; k++) {
    double ocr = k ? 8.0 : 1.0;
    test_material m = clay(ocr);
    pw_element el = test_start(&m, 1e5);
    pw_element_step step = {.control = {PW_CONTROL_STRESS, PW_CONTROL_STRAIN, PW_CONTROL_STRESS},
                            .value = {-1e5, -1e-3, -1e5}};
    for (int i = 0; i < 3000; i++) {
      assert_ok(pw_element_drive(&el, &step));
    }
    double p = 1e5 / (1.0 - slope / 3.0);
    assert_relative(pressure(el.stress), p, 1e-5);
    assert_relative(shear_stress(el.stress), slope * p, 1e-5);
    double e = e0 - lambda * log(p / 1e5) - (lambda - kappa) * log(2.0 / ocr);
    assert_near(el.state[0], e, 1e-5);
  }
}

/** f = 0 to 1e-10 after every plastic step; s:d e_p = multiplier (2 p^2 - p pc + 2 q^2/M^2), which
 *  is multiplier p pc > 0 on the ellipse: plastic shear strain shares the sign of the stress. */
static void yield_and_dissipation(void **unused)
{
  (void)unused;
  uint64_t seed = 31;
  double worst = -1.0, least = 0.0;
  for (int path = 0; path < 100000; path++) {
    test_material m = clay(1.0 + 5.0 * test_random(&seed));
    pw_element el = test_start(&m, 1e4 + 3e5 * test_random(&seed));
    for (int i = 0; i < 8; i++) {
      pw_real de[6];
      test_random_strain(&seed, pow(10.0, -6.0 + 3.7 * test_random(&seed)), de);
      pw_element old = el;
      assert_ok(pw_element_move(&el, de, NULL, NULL));
      double p = pressure(el.stress), q = shear_stress(el.stress), pc = el.state[1];
      worst = fmax(worst, (q * q / (slope * slope) + p * (p - pc)) / (p * pc));
      /* elastic strains: kappa ln p over v, and dev s over the G of the start */
      double p0 = pressure(old.stress), v = 1.0 + old.state[0], x = de[0] + de[1] + de[2];
      double mean = fabs(x) > 1e-12 ? v * expm1(x) / x : v;
      double shear = 1.5 * (1 - 2 * nu) / (1 + nu) * v * p0 / kappa;
      pw_t6 s = pw_t6_load(el.stress, 1), s0 = pw_t6_load(old.stress, 1);
      pw_t6 dev = pw_t6_axpy(pw_t6_shift(s, p), -1.0, pw_t6_shift(s0, p0));
      pw_t6 plastic = pw_t6_axpy(pw_t6_load(de, 1), -0.5 / shear, dev);
      plastic = pw_t6_shift(plastic, kappa * log(p / p0) / mean / 3.0);
      double work = pw_t6_dot(s, plastic) / (p * pw_t6_norm(pw_t6_load(de, 1)));
      least = fmin(least, work);
    }
  }
  print_message("yield exceeded by %.1e, least dissipation %.1e\n", worst, least);
  assert_true(worst < 1e-10);
  assert_true(least > -1e-9);
}

static void tangents_are_derivatives(void **unused)
{
  (void)unused;
  uint64_t seed = 37;
  double worst = 0.0;
  for (int trial = 0; trial < 400; trial++) {
    test_material m = clay(trial % 2 ? 1.0 : 1.0 + 7.0 * test_random(&seed));
    pw_element el = test_start(&m, 1e5);
    pw_real de[6];
    test_random_strain(&seed, trial % 3 ? 1e-2 : 1e-4, de);
    if (trial % 10 == 0) {
      de[0] = de[1] = de[2] = -1e-3; /* isotropic */
      de[3] = de[4] = de[5] = 0.0;
    }
    double bulk = (1.0 + e0) * 1e5 / kappa;
    worst = fmax(worst, test_tangent_error(&el, de, 1e-7, bulk));
  }
  print_message("tangent against differences: %.2e of K\n", worst);
  assert_true(worst < 1e-6);
}

static void rotation_keeps_the_invariants(void **unused)
{
  (void)unused;
  test_material m = clay(2.0);
  pw_element el = test_start(&m, 4e4);
  const pw_real de[6] = {1e-3, -2e-2, 3e-3, 1e-3, -5e-3, 2e-3};
  assert_ok(pw_element_move(&el, de, NULL, NULL));
  assert_true(test_turning_error(&el) < 1e-10);
}

static void place_does_not_matter(void **unused)
{
  (void)unused;
  test_material m = clay(1.5);
  test_place_does_not_matter(&m, 3e4, 1e-3, true);
  test_place_does_not_matter(&m, 3e4, 1e-3, false);
}

/** Opened far beyond p = 0: the least pressure holds and nothing is NaN; pressed again it works. */
static void low_stress(void **unused)
{
  (void)unused;
  test_material m = clay(1.0);
  pw_element el = test_start(&m, 1e4);
  const pw_real open[6] = {0.05, 0.05, 0.05, 0.01, 0, 0}, press[6] = {-0.02, -0.04, -0.03, 0, 0, 0};
  for (int i = 0; i < 5; i++) {
    assert_ok(pw_element_move(&el, open, NULL, NULL));
    assert_true(pressure(el.stress) >= 100.0 * (1 - 1e-12) && pressure(el.stress) < 1e4);
  }
  assert_true(el.counts.cut_off > 0);
  for (int i = 0; i < 10; i++) {
    assert_ok(pw_element_move(&el, press, NULL, NULL));
  }
  assert_true(pressure(el.stress) > 1e4 && isfinite(el.wave_speed));
}

static void bad_parameters_are_named(void **unused)
{
  (void)unused;
  test_material m = clay(0.5);
  test_refuses(&m, "overconsolidation_ratio = 0.5");
  test_set(&m, "overconsolidation_ratio", 0.0);
  test_refuses(&m, "exactly one of");
  m = clay(1.0);
  test_set(&m, "swelling_index_kappa", 0.3);
  test_refuses(&m, "compression_index_lambda > swelling_index_kappa");
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(compression_lines),
                                     cmocka_unit_test(undrained_strength),
                                     cmocka_unit_test(undrained_path),
                                     cmocka_unit_test(undrained_stress_strain),
                                     cmocka_unit_test(cavity_pressure),
                                     cmocka_unit_test(compression_at_rest),
                                     cmocka_unit_test(simple_shear),
                                     cmocka_unit_test(drained_critical_state),
                                     cmocka_unit_test(yield_and_dissipation),
                                     cmocka_unit_test(tangents_are_derivatives),
                                     cmocka_unit_test(rotation_keeps_the_invariants),
                                     cmocka_unit_test(place_does_not_matter),
                                     cmocka_unit_test(low_stress),
                                     cmocka_unit_test(bad_parameters_are_named)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
