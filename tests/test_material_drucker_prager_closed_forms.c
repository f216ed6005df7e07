/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Drucker-Prager: agreement with Mohr-Coulomb where it is matched, flow, apex, yield, dissipation,
 * tangent, rotation, batches. */
#include "tests/material_batch.h"

#define RADIANS 0.017453292519943295769

static test_material soil(double phi, double psi, double cohesion, const char *match)
{
  test_material m = test_material_of("drucker_prager");
  test_set(&m, "youngs_modulus_pa", 2e7);
  test_set(&m, "poisson_ratio", 0.25);
  test_set(&m, "density_kg_m3", 1800.0);
  test_set(&m, "friction_angle_deg", phi);
  test_set(&m, "dilation_angle_deg", psi);
  test_set(&m, "cohesion_pa", cohesion);
  test_set(&m, "match", test_choice(test_key(m.model, "match")->choices, match));
  return m;
}

/** Axial stress at the limit of Mohr-Coulomb, N = (1 + sin phi)/(1 - sin phi). */
static void triaxial_limits_match(void **unused)
{
  (void)unused;
  for (int extension = 0; extension < 2; extension++) {
    test_material m = soil(30, 10, 5e3, extension ? "extension" : "compression");
    double n = 3.0, cell = 1e5;
    pw_element el = test_start(&m, cell);
    pw_element_step step = {.control = {PW_CONTROL_STRESS, PW_CONTROL_STRAIN, PW_CONTROL_STRESS},
                            .value = {-cell, extension ? 1e-3 : -1e-3, -cell}};
    for (int i = 0; i < 100; i++) {
      assert_ok(pw_element_drive(&el, &step));
    }
    double limit = extension ? (cell - 1e4 * sqrt(n)) / n : cell * n + 1e4 * sqrt(n);
    assert_relative(el.stress[1], -limit, 1e-6);
  }
}

/** Plane strain with associated flow: at the limit the stresses in the plane meet Mohr-Coulomb's
 *  condition (that is how eta and xi of this match are derived). */
static void plane_strain_limit_matches(void **unused)
{
  (void)unused;
  test_material m = soil(25, 25, 1e4, "plane_strain");
  double cell = 5e4, n = (1.0 + sin(25 * RADIANS)) / (1.0 - sin(25 * RADIANS));
  pw_element el = test_start(&m, cell);
  pw_element_step step = {.control = {PW_CONTROL_STRESS}, .value = {-cell, -1e-3}};
  for (int i = 0; i < 400; i++) {
    assert_ok(pw_element_drive(&el, &step));
  }
  assert_relative(el.stress[1], -(cell * n + 2e4 * sqrt(n)), 1e-5);
}

static void apex(void **unused)
{
  (void)unused;
  test_material m = soil(30, 0, 1e4, "compression");
  pw_element el = test_start(&m, 0.0);
  const pw_real open[6] = {1e-3, 2e-3, 3e-3, 1e-4, 0, 0};
  assert_ok(pw_element_move(&el, open, NULL, NULL));
  for (int c = 0; c < 6; c++) { /* c cot(phi), as Mohr-Coulomb's */
    assert_near(el.stress[c], c < 3 ? 1e4 / tan(30 * RADIANS) : 0.0, 1e-9 * 1e4);
  }
}

/** Simple shear to 100 %: without dilation the mean stress stays, sqrt(J2) = (6 c cos(phi) + 6 p
 *  sin(phi))/(sqrt(3) (3 - sin(phi))); the spin tilts the stress by the order of sqrt(J2)/G. */
static void simple_shear(void **unused)
{
  (void)unused;
  for (int k = 0; k < 2; k++) {
    const double phi = k ? 30.0 : 0.0, c = 1e4, s = sin(phi * RADIANS);
    test_material m = soil(phi, 0, c, "compression");
    pw_element el = test_start(&m, 1e5);
    const pw_real de[6] = {0, 0, 0, 5e-5, 0, 0}, spin[3] = {5e-5, 0, 0};
    for (int i = 0; i < 10000; i++) {
      assert_ok(pw_element_move(&el, de, spin, NULL));
    }
    double root = (6.0 * c * cos(phi * RADIANS) + 6e5 * s) / (sqrt(3.0) * (3.0 - s));
    assert_near(el.stress[0] + el.stress[1] + el.stress[2], -3e5, 1e-6 * 1e5);
    assert_relative(test_dev_norm(el.stress) / sqrt(2.0), root, 1e-10);
    assert_relative(el.stress[3], root, 2e-4);
  }
}

/** Without friction the strength in pure shear is 2 c/sqrt(3) when matched in compression; pressure
 *  in a cavity as of Mohr-Coulomb with it: elastic part 4 G (e_y/2 - e_y^2/4 + e_y^3/18), then
 *  -c_u ln(1 - e^(-c_u/G)). */
static void cavity_pressure(void **unused)
{
  (void)unused;
  const double c = 2e4, cu = 2.0 * c / sqrt(3.0), shear = 8e6, ey = 0.5 * cu / shear;
  test_material m = soil(0, 0, c, "compression");
  pw_element el = test_start(&m, 1e5);
  double p = test_cavity_pressure(&el, 1e-3 * ey, 1.002);
  double elastic = 4.0 * shear * (0.5 * ey - 0.25 * ey * ey + ey * ey * ey / 18.0);
  assert_relative(p, elastic - cu * log(-expm1(-cu / shear)), 1e-3);
}

static void yield_and_dissipation(void **unused)
{
  (void)unused;
  uint64_t seed = 23;
  double worst = -1.0, least = 0.0;
  for (int path = 0; path < 100000; path++) {
    double phi = path % 3 ? 40.0 * test_random(&seed) : 0.0, c = 1e3 + 3e4 * test_random(&seed);
    test_material m = soil(phi, phi * test_random(&seed), c, "compression");
    double s = sin(phi * RADIANS), f = sqrt(3.0) * (3.0 - s);
    pw_element el = test_start(&m, 1e5 * test_random(&seed));
    for (int i = 0; i < 8; i++) {
      pw_real de[6];
      test_random_strain(&seed, pow(10.0, -5.0 + 4.0 * test_random(&seed)), de);
      pw_t6 before = pw_t6_load(el.stress, 1), strain = pw_t6_load(de, 1);
      double plastic_before = el.state[0];
      assert_ok(pw_element_move(&el, de, NULL, NULL));
      assert_true(el.state[0] >= plastic_before);
      double p = (el.stress[0] + el.stress[1] + el.stress[2]) / 3.0;
      double root = test_dev_norm(el.stress) / sqrt(2.0);
      double over = root + 6.0 * s / f * p - 6.0 * cos(phi * RADIANS) / f * c;
      worst = fmax(worst, over / (root + fabs(p) + c));
      pw_t6 change = pw_t6_axpy(pw_t6_load(el.stress, 1), -1.0, before);
      double trace = pw_t6_trace(change), young = 2e7, nu = 0.25;
      pw_t6 elastic = pw_t6_shift(pw_t6_scale((1 + nu) / young, change), -nu / young * trace);
      pw_t6 plastic = pw_t6_axpy(strain, -1.0, elastic);
      double work = pw_t6_dot(pw_t6_load(el.stress, 1), plastic);
      least = fmin(least, work / (pw_t6_norm(strain) * (pw_t6_norm(before) + 1e4)));
    }
  }
  print_message("yield exceeded by %.1e, least dissipation %.1e\n", worst, least);
  assert_true(worst < 1e-10);
  assert_true(least > -1e-9);
}

static void tangents_are_derivatives(void **unused)
{
  (void)unused;
  uint64_t seed = 29;
  double worst = 0.0;
  for (int trial = 0; trial < 400; trial++) {
    double phi = trial % 5 ? 10.0 + 30.0 * test_random(&seed) : 0.0;
    test_material m = soil(phi, 0.5 * phi, 1e4, "compression");
    pw_element el = test_start(&m, trial % 2 ? 5e4 : 0.0);
    pw_real de[6];
    test_random_strain(&seed, trial % 7 ? 1e-2 : 1e-4, de);
    worst = fmax(worst, test_tangent_error(&el, de, 1e-8, 2e7));
  }
  print_message("tangent against differences: %.2e of E\n", worst);
  assert_true(worst < 1e-6);
}

static void rotation_keeps_the_invariants(void **unused)
{
  (void)unused;
  test_material m = soil(30, 0, 1e4, "compression");
  pw_element el = test_start(&m, 4e4);
  const pw_real de[6] = {1e-3, -2e-2, 3e-3, 1e-3, -5e-3, 2e-3};
  assert_ok(pw_element_move(&el, de, NULL, NULL));
  assert_true(test_turning_error(&el) < 1e-10);
}

static void place_does_not_matter(void **unused)
{
  (void)unused;
  test_material m = soil(30, 5, 1e3, "plane_strain");
  test_place_does_not_matter(&m, 3e4, 1e-3, true);
  test_place_does_not_matter(&m, 3e4, 1e-3, false);
}

static void bad_parameters_are_named(void **unused)
{
  (void)unused;
  test_material m = soil(0, 0, 0, "compression");
  test_refuses(&m, "friction_angle_deg = 0 needs a cohesion_pa above 0");
  m = soil(20, 25, 0, "compression");
  test_refuses(&m, "must not exceed friction_angle_deg");
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(triaxial_limits_match),
                                     cmocka_unit_test(plane_strain_limit_matches),
                                     cmocka_unit_test(apex),
                                     cmocka_unit_test(simple_shear),
                                     cmocka_unit_test(cavity_pressure),
                                     cmocka_unit_test(yield_and_dissipation),
                                     cmocka_unit_test(tangents_are_derivatives),
                                     cmocka_unit_test(rotation_keeps_the_invariants),
                                     cmocka_unit_test(place_does_not_matter),
                                     cmocka_unit_test(bad_parameters_are_named)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
