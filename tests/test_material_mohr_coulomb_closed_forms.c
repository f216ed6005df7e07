/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mohr-Coulomb and Tresca: triaxial and plane limits, flow, cavity pressure, tension cut-off, the
 * return as a projection, round-off, yield, dissipation, tangents in every region, rotation,
 * batches. */
#include "kernels/mohr_coulomb.h"
#include "tests/material_batch.h"

#define RADIANS 0.017453292519943295769

static test_material soil(double phi, double psi, double cohesion)
{
  test_material m = test_material_of("mohr_coulomb");
  test_set(&m, "youngs_modulus_pa", 2e7);
  test_set(&m, "poisson_ratio", 0.25);
  test_set(&m, "density_kg_m3", 1800.0);
  test_set(&m, "friction_angle_deg", phi);
  test_set(&m, "dilation_angle_deg", psi);
  test_set(&m, "cohesion_pa", cohesion);
  return m;
}

static test_material with_cut(test_material m, double tension)
{
  test_set(&m, "tension_cutoff", 1.0);
  test_set(&m, "tensile_strength_pa", tension);
  return m;
}

/** Largest excess of the conditions over the size of the stress. */
static double excess(const test_material *m, const pw_real *stress)
{
  pw_spectrum s = pw_t6_spectrum(pw_t6_load(stress, 1));
  double high = fmax(s.value[0], fmax(s.value[1], s.value[2]));
  double low = fmin(s.value[0], fmin(s.value[1], s.value[2]));
  double phi = m->v[3] * RADIANS, cohesion = m->v[5];
  double size = fabs(high) + fabs(low) + cohesion;
  double f = (high - low) + (high + low) * sin(phi) - 2.0 * cohesion * cos(phi);
  if (m->v[6] > 0.5) {
    f = fmax(f, high - m->v[7]);
  }
  return f / size;
}

/** Triaxial compression at constant cell pressure: s_a = s_r N + 2 c sqrt(N), N = (1 + sin phi)/
 *  (1 - sin phi); e_r/e_a = -(1 + sin psi)/(2 (1 - sin psi)) in plastic flow. Extension: the
 *  axial stress is the small one. */
static void triaxial_limits(void **unused)
{
  (void)unused;
  const double set[4][3] = {{30, 10, 0}, {35, 35, 5e3}, {20, 0, 1e4}, {0, 0, 3e4}};
  for (int k = 0; k < 4; k++) {
    test_material m = soil(set[k][0], set[k][1], set[k][2]);
    double n = (1.0 + sin(set[k][0] * RADIANS)) / (1.0 - sin(set[k][0] * RADIANS));
    double sin_psi = sin(set[k][1] * RADIANS), cell = 1e5;
    for (int extension = 0; extension < 2; extension++) {
      pw_element el = test_start(&m, cell), last;
      pw_element_step step = {.control = {PW_CONTROL_STRESS, PW_CONTROL_STRAIN, PW_CONTROL_STRESS},
                              .value = {-cell, extension ? 1e-3 : -1e-3, -cell}};
      last = el;
      for (int i = 0; i < 60; i++) {
        last = el;
        assert_ok(pw_element_drive(&el, &step));
      }
      double limit =
          extension ? (cell - 2.0 * set[k][2] * sqrt(n)) / n : cell * n + 2.0 * set[k][2] * sqrt(n);
      assert_relative(el.stress[1], -limit, 1e-6);
      double lateral = (el.strain[0] - last.strain[0]) / (el.strain[1] - last.strain[1]);
      double flow = extension ? -(1.0 - sin_psi) / (2.0 * (1.0 + sin_psi))
                              : -(1.0 + sin_psi) / (2.0 * (1.0 - sin_psi));
      assert_near(lateral, flow, 1e-6);
    }
  }
}

/** Biaxial: the out-of-plane stress is the middle one, so that limit and flow in the plane are
 *  those of the Mohr circle: sin psi = (e_1 + e_3)/(e_1 - e_3) of plastic strains. */
static void plane_strain_limit(void **unused)
{
  (void)unused;
  test_material m = soil(32, 8, 2e3);
  const double n = (1.0 + sin(32 * RADIANS)) / (1.0 - sin(32 * RADIANS)), cell = 5e4;
  pw_element el = test_start(&m, cell), last;
  pw_element_step step = {.control = {PW_CONTROL_STRESS}, .value = {-cell, -5e-4}};
  last = el;
  for (int i = 0; i < 100; i++) {
    last = el;
    assert_ok(pw_element_drive(&el, &step));
  }
  assert_relative(el.stress[1], -(cell * n + 4e3 * sqrt(n)), 1e-6);
  assert_true(el.stress[2] < el.stress[0] && el.stress[2] > el.stress[1]);
  double e1 = el.strain[0] - last.strain[0], e3 = el.strain[1] - last.strain[1];
  assert_near((e1 + e3) / (e1 - e3), sin(8 * RADIANS), 1e-6);
}

/** Without friction: elastic part of the pressure 4 G (e_y/2 - e_y^2/4 + e_y^3/18), then
 *  -c ln(1 - e^(-c/G)); first order c (1 + ln(G/c)) (Gibson, Anderson 1961). The clay too. */
static void cavity_pressure(void **unused)
{
  (void)unused;
  test_material m[2] = {soil(0, 0, 2e4), test_material_of("tresca")};
  test_set(&m[1], "undrained_shear_strength_pa", 2e4);
  test_set(&m[1], "rigidity_index", 400.0);
  test_set(&m[1], "density_kg_m3", 1800.0);
  for (int k = 0; k < 2; k++) {
    const double cu = 2e4, shear = 8e6, ey = 0.5 * cu / shear;
    pw_element el = test_start(&m[k], 1e5);
    double p = test_cavity_pressure(&el, 1e-3 * ey, 1.002);
    double elastic = 4.0 * shear * (0.5 * ey - 0.25 * ey * ey + ey * ey * ey / 18.0);
    assert_relative(p, elastic - cu * log(-expm1(-cu / shear)), 1e-3);
    assert_relative(p, cu * (1.0 + log(shear / cu)), 1e-2);
  }
}

/** Simple shear to 100 %: t_max = c cos(phi) + |s_m| sin(phi) with the normal stress held. */
static void simple_shear(void **unused)
{
  (void)unused;
  const double cu = 2e4;
  test_material m = soil(0, 0, cu);
  pw_element el = test_start(&m, 1e5);
  const pw_real de[6] = {0, 0, 0, 5e-5, 0, 0}, spin[3] = {5e-5, 0, 0};
  for (int i = 0; i < 10000; i++) {
    assert_ok(pw_element_move(&el, de, spin, NULL));
    double radius = hypot(0.5 * (el.stress[0] - el.stress[1]), el.stress[3]);
    assert_true(radius <= cu * (1.0 + 1e-10));
  }
  /* steady: the spin turns the stress as fast as shear straightens it; second order in c/G */
  assert_relative(el.stress[3], cu, 1e-5);
  m = soil(30, 0, cu); /* without dilation the mean stress in the plane stays */
  el = test_start(&m, 1e5);
  for (int i = 0; i < 10000; i++) {
    assert_ok(pw_element_move(&el, de, spin, NULL));
  }
  assert_near(el.stress[0] + el.stress[1], -2e5, 1e-6 * 1e5);
  assert_relative(el.stress[3], cu * cos(30 * RADIANS) + 1e5 * sin(30 * RADIANS), 2e-4);
}

static void tension_is_cut_off(void **unused)
{
  (void)unused;
  test_material m = with_cut(soil(30, 0, 1e4), 2e3);
  pw_element el = test_start(&m, 0.0);
  pw_element_step step = {.control = {PW_CONTROL_STRESS, PW_CONTROL_STRAIN, PW_CONTROL_STRESS},
                          .value = {0, 1e-4, 0}};
  for (int i = 0; i < 20; i++) {
    assert_ok(pw_element_drive(&el, &step));
  }
  assert_relative(el.stress[1], 2e3, 1e-9);
  const pw_real open[6] = {1e-3, 2e-3, 3e-3, 0, 0, 0};
  assert_ok(pw_element_move(&el, open, NULL, NULL));
  for (int c = 0; c < 3; c++) {
    assert_relative(el.stress[c], 2e3, 1e-12);
  }
  m = soil(30, 10, 1e4); /* without a cut-off: the apex c cot(phi) */
  el = test_start(&m, 0.0);
  assert_ok(pw_element_move(&el, open, NULL, NULL));
  for (int c = 0; c < 3; c++) {
    assert_relative(el.stress[c], 1e4 / tan(30 * RADIANS), 1e-12);
  }
}

/** Associated flow: the return is the projection in the energy norm, so that
 *  (trial - s).C^-1.(y - s) <= 0 for every admissible y. Independent of how it is computed. */
/* Plastic flow of dilation psi >= 0 never lowers the mean stress that it takes off: a trial stress
 * with less than the mean stress of the apex does not return there, however stiff in volume and
 * steep the cone. Two equal trial stresses stay equal: the edge is where round-off decides. */
static void round_off_does_not_lead_to_the_apex(void **unused)
{
  (void)unused;
  uint64_t seed = 23;
  const double poisson[4] = {0.3, 0.49, 0.4999, 0.49999}, angle[4] = {30, 45, 60, 75};
  double furthest = 0.0;
  for (int k = 0; k < 64; k++) {
    const double nu = poisson[k % 4], phi = angle[k / 4 % 4] * RADIANS, psi = k / 16 * phi / 3.0;
    const double shear = 5e6 / (1.0 + nu), cohesion = 1e4, apex = cohesion / tan(phi);
    const pw_mc m = {.lambda = 2.0 * shear * nu / (1.0 - 2.0 * nu),
                     .shear = shear,
                     .sin_phi = sin(phi),
                     .sin_psi = sin(psi),
                     .strength = 2.0 * cohesion * cos(phi),
                     .tension = PW_HUGE};
    for (int trial = 0; trial < 10000; trial++) {
      const double size = pow(10.0, 2.0 + 4.0 * test_random(&seed));
      const double gap = size * test_random(&seed), mean = -size * test_random(&seed);
      pw_real t[3] = {mean + gap, mean - 0.5 * gap, mean - 0.5 * gap}, s[3];
      if (trial % 2 == 1) { /* the other edge */
        t[0] = t[1] = mean + 0.5 * gap;
        t[2] = mean - gap;
      }
      if (!pw_mc_return(&m, t, s, NULL)) {
        continue;
      }
      const int twin = trial % 2 == 1 ? 0 : 2;
      const double total = fabs(t[0]) + fabs(t[2]) + m.strength;
      const double f = s[0] - s[2] + (s[0] + s[2]) * m.sin_phi - m.strength;
      assert_true(f <= 1e-10 * total);
      furthest = fmax(furthest, fmax(fabs(f), fabs(s[1] - s[twin])) / total);
      assert_true(s[0] + s[1] + s[2] <= t[0] + t[1] + t[2] + 3e-6 * total);
      assert_true(s[2] < apex || t[0] + t[1] + t[2] > 3.0 * apex - 3e-6 * total);
    }
  }
  print_message("off the edge by at most %.1e of the stress\n", furthest);
  assert_true(furthest < 1e-6);
}

static void associated_return_is_the_projection(void **unused)
{
  (void)unused;
  uint64_t seed = 17;
  const double shear = 8e6, lambda = 8e6, bulk = lambda + 2.0 / 3.0 * shear;
  for (int trial = 0; trial < 20000; trial++) {
    double phi = trial % 4 ? 50.0 * test_random(&seed) : 0.0, cohesion = 1e4 + trial % 2 * 2e4;
    double s = sin(phi * RADIANS), strength = 2.0 * cohesion * cos(phi * RADIANS);
    double tension = trial % 3 ? PW_HUGE : 3e4 * test_random(&seed);
    pw_mc m = {.lambda = lambda,
               .shear = shear,
               .sin_phi = s,
               .sin_psi = s,
               .strength = strength,
               .tension = tension};
    pw_real t[3], out[3], y[3];
    do {
      for (int c = 0; c < 3; c++) {
        t[c] = 4e5 * (test_random(&seed) - 0.6);
      }
    } while (!(t[0] >= t[1] && t[1] >= t[2]));
    pw_mc_return(&m, t, out, NULL);
    assert_true(out[0] >= out[1] - 1e-6 && out[1] >= out[2] - 1e-6);
    assert_true(out[0] - out[2] + (out[0] + out[2]) * s <= strength + 1e-10 * 4e5);
    assert_true(out[0] <= tension + 1e-10 * 4e5);
    for (int k = 0; k < 30; k++) {
      do {
        for (int c = 0; c < 3; c++) {
          y[c] = out[c] + pow(10.0, 5.5 * test_random(&seed)) * (test_random(&seed) - 0.5);
        }
        double high = fmax(y[0], fmax(y[1], y[2])), low = fmin(y[0], fmin(y[1], y[2]));
        if (high - low + (high + low) * s <= strength && high <= tension) {
          break;
        }
        y[0] = y[1] = y[2] = fmin(-1e5 * test_random(&seed), tension);
      } while (0);
      double d[3], z[3], sum = 0, trace = 0, other = 0;
      for (int c = 0; c < 3; c++) {
        d[c] = t[c] - out[c];
        z[c] = y[c] - out[c];
        trace += d[c];
        other += z[c];
        sum += d[c] * z[c];
      }
      double energy = (sum - trace * other / 3.0) / (2.0 * shear) + trace * other / (9.0 * bulk);
      assert_true(energy <= 1e-10 * 4e5 * 4e5 / shear);
    }
  }
}

/** 10^5 paths: yield kept to 1e-10, and s:d e_p >= 0 with d e_p from what elasticity leaves. */
static void yield_and_dissipation(void **unused)
{
  (void)unused;
  uint64_t seed = 23;
  double worst = 0.0, least = 0.0;
  for (int path = 0; path < 100000; path++) {
    double phi = path % 3 ? 45.0 * test_random(&seed) : 0.0;
    test_material m = soil(phi, phi * test_random(&seed), 1e3 + 3e4 * test_random(&seed));
    if (path % 2) {
      m = with_cut(m, 2e4 * test_random(&seed));
    }
    pw_element el = test_start(&m, 1e5 * test_random(&seed));
    for (int i = 0; i < 8; i++) {
      pw_real de[6];
      test_random_strain(&seed, pow(10.0, -5.0 + 4.0 * test_random(&seed)), de);
      pw_t6 before = pw_t6_load(el.stress, 1), strain = pw_t6_load(de, 1);
      assert_ok(pw_element_move(&el, de, NULL, NULL));
      worst = fmax(worst, excess(&m, el.stress));
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

/** Regions: planes, edges, apex, tension plane, its edge and corner; tangents by differences. */
static void tangents_are_derivatives(void **unused)
{
  (void)unused;
  uint64_t seed = 29;
  double worst = 0.0;
  int sharp = 0;
  for (int trial = 0; trial < 400; trial++) {
    double phi = trial % 5 ? 10.0 + 30.0 * test_random(&seed) : 0.0;
    test_material m = soil(phi, 0.5 * phi, 1e4);
    if (trial % 2) {
      m = with_cut(m, 5e3);
    }
    pw_element el = test_start(&m, 5e4);
    pw_real de[6];
    test_random_strain(&seed, trial % 7 ? 1e-2 : 1e-4, de);
    double error = test_tangent_error(&el, de, 1e-8, 2e7);
    if (error > 1e-6) { /* a difference across the border of two regions: halves must agree */
      error = test_tangent_error(&el, de, 1e-10, 2e7) > 1e-3 ? error : 0.0;
      sharp++;
    }
    worst = fmax(worst, error);
  }
  print_message("tangent against differences: %.2e of E, %d across a border\n", worst, sharp);
  assert_true(worst < 1e-6);
  assert_true(sharp <= 2);
}

static void rotation_keeps_the_invariants(void **unused)
{
  (void)unused;
  for (int k = 0; k < 2; k++) {
    test_material m = soil(k ? 30 : 0, 0, 1e4);
    pw_element el = test_start(&m, 4e4);
    const pw_real de[6] = {1e-3, -2e-2, 3e-3, 1e-3, -5e-3, 2e-3};
    assert_ok(pw_element_move(&el, de, NULL, NULL));
    assert_true(test_turning_error(&el) < 1e-10);
  }
}

static void place_does_not_matter(void **unused)
{
  (void)unused;
  test_material m = with_cut(soil(30, 5, 1e3), 500.0);
  test_place_does_not_matter(&m, 3e4, 1e-3, true);
  test_place_does_not_matter(&m, 3e4, 1e-3, false);
  m = soil(0, 0, 1e4);
  test_place_does_not_matter(&m, 3e4, 1e-3, true);
}

static void grows_with_depth(void **unused)
{
  (void)unused;
  test_material m = test_material_of("tresca");
  test_set(&m, "undrained_shear_strength_pa", 1e4);
  test_set(&m, "undrained_shear_strength_gradient_pa_m", 2e3);
  test_set(&m, "rigidity_index", 100.0);
  test_set(&m, "density_kg_m3", 1600.0);
  const double y = -5.0;
  pw_element el = test_start(&m, 0.0);
  m.model->place(m.v, 1, 1, &y, el.state);
  m.model->init(m.v, 1, 1, el.stress, el.state);
  const pw_real small[6] = {0, 0, 0, 1e-6, 0, 0}, large[6] = {0, 0, 0, 0.1, 0, 0};
  assert_ok(pw_element_move(&el, small, NULL, NULL));
  assert_relative(el.stress[3], 2e-6 * 100.0 * 2e4, 1e-12);
  assert_ok(pw_element_move(&el, large, NULL, NULL));
  assert_relative(el.stress[3], 2e4, 1e-12);
}

static void bad_parameters_are_named(void **unused)
{
  (void)unused;
  test_material m = soil(0, 0, 0);
  test_refuses(&m, "friction_angle_deg = 0 needs a cohesion_pa above 0");
  m = soil(20, 25, 0);
  test_refuses(&m, "must not exceed friction_angle_deg");
  m = soil(20, 0, 0);
  assert_ok(m.model->check(m.v));
  test_set(&m, "tensile_strength_pa", 1.0);
  test_refuses(&m, "tension_cutoff: true");
  m = soil(0, 0, 1e3);
  assert_ok(m.model->check(m.v));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(triaxial_limits),
                                     cmocka_unit_test(plane_strain_limit),
                                     cmocka_unit_test(cavity_pressure),
                                     cmocka_unit_test(simple_shear),
                                     cmocka_unit_test(tension_is_cut_off),
                                     cmocka_unit_test(associated_return_is_the_projection),
                                     cmocka_unit_test(round_off_does_not_lead_to_the_apex),
                                     cmocka_unit_test(yield_and_dissipation),
                                     cmocka_unit_test(tangents_are_derivatives),
                                     cmocka_unit_test(rotation_keeps_the_invariants),
                                     cmocka_unit_test(place_does_not_matter),
                                     cmocka_unit_test(grows_with_depth),
                                     cmocka_unit_test(bad_parameters_are_named)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
