/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hencky-von Mises: uniaxial tension, simple shear, cavity pressure, measures of yield, hardening,
 * growth with depth, tangent, wave speed, rotation, dissipation, batches. */
#include "tests/material_batch.h"

#define PI 3.14159265358979323846

static test_material clay(void)
{
  test_material m = test_material_of("hencky_von_mises");
  test_set(&m, "youngs_modulus_pa", 6e6);
  test_set(&m, "poisson_ratio", 0.3);
  test_set(&m, "density_kg_m3", 2000.0);
  test_set(&m, "undrained_shear_strength_pa", 2e4);
  return m;
}

/** Uniaxial: tau = E e up to sigma_y, then the slope E H/(E + H); sigma = tau/J. The strain is
 *  logarithmic, J = exp((1 - 2 nu) tau/E). */
static void uniaxial_tension(void **unused)
{
  (void)unused;
  test_material m = clay();
  const double young = 6e6, nu = 0.3, yield = 5e4, slope = 4e5;
  test_set(&m, "undrained_shear_strength_pa", 0.0);
  test_set(&m, "yield_uniaxial_pa", yield);
  for (int hard = 0; hard < 2; hard++) {
    double h = hard ? slope : 0.0;
    test_set(&m, "hardening_modulus_pa", h);
    pw_element el = test_start(&m, 0.0);
    el.tolerance = 1e-13;
    pw_element_step step = {.control = {PW_CONTROL_STRESS, PW_CONTROL_STRAIN, PW_CONTROL_STRESS}};
    step.value[1] = 1e-3;
    for (int i = 1; i <= 500; i++) {
      assert_ok(pw_element_drive(&el, &step));
      double e = 1e-3 * i, tau = young * e;
      bool flows = tau > yield;
      if (flows) {
        tau = yield + young * h / (young + h) * (e - yield / young);
      }
      double expected = tau * exp(-(1.0 - 2.0 * nu) * tau / young);
      assert_relative(el.stress[1], expected, 1e-9);
      double plastic = flows ? e - tau / young : 0.0;
      assert_near(el.state[0], plastic, 1e-9 * e);
    }
  }
}

/** The stretched cube of the implicit paper: E = 1e3, nu = 0, 400 read as radius or uniaxial;
 *  tau_yy = min(E ln(1 + 0.2 n), sqrt(3/2) 400 or 400). */
static void stretched_cube(void **unused)
{
  (void)unused;
  test_material m = clay();
  test_set(&m, "youngs_modulus_pa", 1e3);
  test_set(&m, "poisson_ratio", 0.0);
  test_set(&m, "undrained_shear_strength_pa", 0.0);
  const char *key[2] = {"yield_radius_pa", "yield_uniaxial_pa"};
  const double yield[2] = {sqrt(1.5) * 400.0, 400.0};
  for (int k = 0; k < 2; k++) {
    test_material cube = m;
    test_set(&cube, key[k], 400.0);
    pw_element el = test_start(&cube, 0.0);
    pw_element_step step = {.control = {PW_CONTROL_STRESS, PW_CONTROL_STRAIN, PW_CONTROL_STRESS}};
    for (int n = 1; n <= 20; n++) {
      step.value[1] = log((1.0 + 0.2 * n) / (1.0 + 0.2 * (n - 1)));
      assert_ok(pw_element_drive(&el, &step));
      double tau = el.stress[1] * exp(el.state[1]);
      assert_relative(tau, fmin(1e3 * log(1.0 + 0.2 * n), yield[k]), 1e-8);
    }
  }
}

/** F = 1 + gamma e_x e_y below yield: the Hencky strain is asinh(gamma/2) with its axis at
 *  tan 2 phi = 2/gamma. Exact for any number of steps. */
static void elastic_simple_shear(void **unused)
{
  (void)unused;
  test_material m = clay();
  test_set(&m, "undrained_shear_strength_pa", 1e9);
  const double shear = 6e6 / 2.6;
  pw_element el = test_start(&m, 0.0);
  const pw_real de[6] = {0, 0, 0, 0.05, 0, 0}, spin[3] = {0.05, 0, 0};
  for (int i = 1; i <= 20; i++) {
    assert_ok(pw_element_move(&el, de, spin, NULL));
    double gamma = 0.1 * i, r = sqrt(1.0 + 0.25 * gamma * gamma);
    double tau = 2.0 * shear * asinh(0.5 * gamma);
    assert_relative(el.stress[3], tau / r, 1e-12);
    assert_relative(el.stress[0], tau * 0.5 * gamma / r, 1e-12);
    assert_relative(el.stress[1], -tau * 0.5 * gamma / r, 1e-12);
  }
}

/** Simple shear to 100 %: steady once the spin of the axes of b vanishes, which for flow along b
 *  asks for cos 2 phi = tanh(2 e) with the elastic strain e = c_u/(2 G) along the axes; so
 *  sigma_xx = c_u tanh(c_u/G), sigma_xy = c_u/cosh(c_u/G). Steps of 1e-4 tilt the axes by as much. */
static void plastic_simple_shear(void **unused)
{
  (void)unused;
  test_material m = clay();
  const double cu = 2e4, shear = 6e6 / 2.6;
  pw_element el = test_start(&m, 0.0);
  const pw_real de[6] = {0, 0, 0, 5e-5, 0, 0}, spin[3] = {5e-5, 0, 0};
  for (int i = 0; i < 10000; i++) {
    assert_ok(pw_element_move(&el, de, spin, NULL));
    assert_true(test_dev_norm(el.stress) <= sqrt(2.0) * cu * (1.0 + 1e-12));
  }
  assert_near(el.stress[3], cu / cosh(cu / shear), 1e-6 * cu);
  assert_near(el.stress[0], cu * tanh(cu / shear), 1e-4 * cu);
  assert_near(el.stress[0] + el.stress[1], 0.0, 1e-9 * cu);
}

/** Cavity opened from nothing: elastic part int_0^ey 4 G e/(e^2e - 1) de, plastic part
 *  -c_u ln(1 - e^(-c_u/G)) with e_y = c_u/(2 G); to first order c_u (1 + ln(G/c_u)) (Gibson,
 *  Anderson 1961). */
static void cavity_pressure(void **unused)
{
  (void)unused;
  test_material m = clay();
  const double cu = 2e4, shear = 6e6 / 2.6, ey = 0.5 * cu / shear;
  pw_element el = test_start(&m, 0.0);
  double p = test_cavity_pressure(&el, 1e-3 * ey, 1.002);
  /* e/(e^2e - 1) = 1/2 - e/2 + e^2/6 - ... */
  double elastic = 4.0 * shear * (0.5 * ey - 0.25 * ey * ey + ey * ey * ey / 18.0);
  double plastic = -cu * log(-expm1(-cu / shear));
  print_message("cavity: %.6g Pa, closed form %.6g Pa, first order %.6g Pa\n", p, elastic + plastic,
                cu * (1.0 + log(shear / cu)));
  assert_relative(p, elastic + plastic, 1e-3);
  assert_relative(p, cu * (1.0 + log(shear / cu)), 2e-2);
}

/** c_u = radius/sqrt(2) = uniaxial/sqrt(3). */
static void measures_of_yield_agree(void **unused)
{
  (void)unused;
  const char *key[3] = {"undrained_shear_strength_pa", "yield_radius_pa", "yield_uniaxial_pa"};
  const double size[3] = {1.0, sqrt(2.0), sqrt(3.0)};
  pw_real first[6] = {0};
  for (int k = 0; k < 3; k++) {
    test_material m = clay();
    test_set(&m, key[0], 0.0);
    test_set(&m, key[k], 2e4 * size[k]);
    test_set(&m, "hardening_modulus_pa", 1e5);
    pw_element el = test_start(&m, 1e5);
    const pw_real de[6] = {0.02, -0.03, 0.005, 0.01, 0.02, -0.01};
    assert_ok(pw_element_move(&el, de, NULL, NULL));
    for (int c = 0; c < 6; c++) {
      if (k == 0) {
        first[c] = el.stress[c];
      }
      assert_near(el.stress[c], first[c], 1e-9 * 1e5);
    }
  }
}

static void grows_with_depth(void **unused)
{
  (void)unused;
  test_material m = clay();
  test_set(&m, "yield_gradient_pa_m", 1500.0);
  test_set(&m, "youngs_modulus_gradient_pa_m", 4e5);
  test_set(&m, "reference_y_m", 3.0);
  const double height[3] = {5.0, 3.0, -7.0}, depth[3] = {0.0, 0.0, 10.0};
  for (int k = 0; k < 3; k++) {
    pw_element el = test_start(&m, 0.0);
    m.model->place(m.v, 1, 1, &height[k], el.state);
    const pw_real stress[6] = {-3e4, -3e4, -3e4, 0, 0, 0}, none[6] = {0};
    memcpy(el.stress, stress, sizeof stress);
    m.model->init(m.v, 1, 1, el.stress, el.state);
    assert_ok(pw_element_move(&el, none, NULL, NULL));
    assert_relative(el.stress[1], -3e4, 1e-12);
    const pw_real small[6] = {0, 0, 0, 1e-6, 0, 0}, large[6] = {0, 0, 0, 0.1, 0, 0};
    pw_element one = el;
    assert_ok(pw_element_move(&one, small, NULL, NULL));
    double shear = (6e6 + 4e5 * depth[k]) / 2.6;
    assert_relative(one.stress[3], 2e-6 * shear * exp(-one.state[1]), 1e-9);
    assert_ok(pw_element_move(&el, large, NULL, NULL));
    assert_relative(el.stress[3] * exp(el.state[1]), 2e4 + 1500.0 * depth[k], 1e-10);
  }
}

/** (1 + e) exp(dE + dW): central differences of the update with the increment given. */
static void tangent_is_the_derivative(void **unused)
{
  (void)unused;
  uint64_t seed = 5;
  double worst = 0.0;
  for (int trial = 0; trial < 60; trial++) {
    test_material m = clay();
    const double size = trial % 3 == 0 ? 1e-3 : trial % 3 == 1 ? 2e-2 : 0.3, h = 1e-6;
    test_set(&m, "hardening_modulus_pa", trial % 2 ? 3e5 : 0.0);
    test_set(&m, "undrained_shear_strength_pa", trial % 5 == 0 ? 1e7 : 2e4);
    pw_element el = test_start(&m, trial % 4 ? 5e4 : 0.0), out;
    pw_real de[6], f[9], g[9], tangent[36], stress[2][6];
    test_random_strain(&seed, size, de);
    const pw_real base[9] = {1 + de[0], de[3], de[5], de[3],    1 + de[1],
                             de[4],     de[5], de[4], 1 + de[2]};
    memcpy(f, base, sizeof f);
    f[1] += 0.3 * size; /* a spin */
    assert_ok(test_update(&el, de, f, &out, tangent));
    for (int j = 0; j < 6; j++) {
      const int row[6] = {0, 1, 2, 0, 1, 2}, col[6] = {0, 1, 2, 1, 2, 0};
      for (int side = 0; side < 2; side++) {
        pw_real e[9] = {0}, step = side ? h : -h;
        e[3 * row[j] + col[j]] = step;
        e[3 * col[j] + row[j]] = step;
        for (int r = 0; r < 3; r++) {
          for (int c = 0; c < 3; c++) {
            g[3 * r + c] =
                f[3 * r + c] + e[3 * r] * f[c] + e[3 * r + 1] * f[3 + c] + e[3 * r + 2] * f[6 + c];
          }
        }
        pw_element moved;
        assert_ok(test_update(&el, de, g, &moved, NULL));
        memcpy(stress[side], moved.stress, sizeof moved.stress);
      }
      for (int i = 0; i < 6; i++) {
        double slope = (stress[1][i] - stress[0][i]) / (2.0 * h * (j < 3 ? 1.0 : 2.0));
        worst = fmax(worst, fabs(tangent[6 * i + j] - slope) / 6e6);
      }
    }
  }
  print_message("tangent against differences: %.2e of E\n", worst);
  assert_true(worst < 1e-6);
}

/** Traction rate (d sigma + sigma tr l - sigma l^T) n of l = m n^T along m: at most rho c^2. */
static void wave_speed_is_an_upper_bound(void **unused)
{
  (void)unused;
  uint64_t seed = 3;
  double closest = 0.0;
  for (int trial = 0; trial < 300; trial++) {
    test_material m = clay();
    test_set(&m, "undrained_shear_strength_pa", trial % 2 ? 1e9 : 5e5);
    pw_element el = test_start(&m, 0.0);
    pw_real de[6], t[36], none[6] = {0};
    test_random_strain(&seed, trial % 3 ? 0.3 : 1e-3, de);
    assert_ok(pw_element_move(&el, de, NULL, NULL));
    assert_ok(pw_element_move(&el, none, NULL, t));
    const pw_real *s = el.stress, sig[9] = {s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]};
    for (int k = 0; k < 200; k++) {
      double n[3], p[3], nn = 0, pp = 0, l[9], w[9], rate[9], q = 0;
      for (int c = 0; c < 3; c++) {
        n[c] = test_random(&seed) - 0.5;
        p[c] = k % 2 ? test_random(&seed) - 0.5 : n[c];
        nn += n[c] * n[c];
        pp += p[c] * p[c];
      }
      for (int r = 0; r < 9; r++) {
        l[r] = p[r / 3] * n[r % 3];
        w[r] = 0.5 * (p[r / 3] * n[r % 3] - n[r / 3] * p[r % 3]);
      }
      const double eng[6] = {l[0], l[4], l[8], l[1] + l[3], l[5] + l[7], l[2] + l[6]};
      const int at[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
      for (int r = 0; r < 9; r++) {
        rate[r] = sig[r] * (l[0] + l[4] + l[8]);
        for (int c = 0; c < 6; c++) {
          rate[r] += t[6 * at[r] + c] * eng[c];
        }
        for (int c = 0; c < 3; c++) {
          int i = r / 3, j = r % 3;
          rate[r] += w[3 * i + c] * sig[3 * c + j] - sig[3 * i + c] * w[3 * c + j];
          rate[r] -= sig[3 * i + c] * l[3 * j + c];
        }
        q += p[r / 3] * rate[r] * n[r % 3];
      }
      closest = fmax(closest, sqrt(fmax(q, 0.0) / (nn * pp * el.density)) / el.wave_speed);
    }
  }
  print_message("waves: at most %.3f of the bound\n", closest);
  assert_true(closest <= 1.0 && closest > 0.8);
}

/** After any increment |dev tau| <= R (1 + 1e-10), and the plastic strain never falls: the energy
 *  dissipated is R |d e_p| >= 0. Work and elastic energy agree with it where b keeps its axes. */
static void yield_and_dissipation(void **unused)
{
  (void)unused;
  uint64_t seed = 11;
  test_material m = clay();
  const double cu = 2e4, hardening = 2e5;
  test_set(&m, "hardening_modulus_pa", hardening);
  double worst = 0.0;
  for (int path = 0; path < 100000; path++) {
    pw_element el = test_start(&m, 1e5 * test_random(&seed));
    for (int i = 0; i < 8; i++) {
      pw_real de[6], spin[3];
      test_random_strain(&seed, pow(10.0, -5.0 + 4.0 * test_random(&seed)), de);
      for (int c = 0; c < 3; c++) {
        spin[c] = 0.1 * (test_random(&seed) - 0.5);
      }
      double before = el.state[0];
      assert_ok(pw_element_move(&el, de, spin, NULL));
      assert_true(el.state[0] >= before);
      double radius = sqrt(2.0) * cu + sqrt(2.0 / 3.0) * hardening * el.state[0];
      worst = fmax(worst, test_dev_norm(el.stress) * exp(el.state[1]) / radius - 1.0);
    }
  }
  print_message("yield exceeded by %.1e\n", worst);
  assert_true(worst < 1e-10);
}

static void rotation_keeps_the_invariants(void **unused)
{
  (void)unused;
  test_material m = clay();
  pw_element el = test_start(&m, 4e4);
  const pw_real de[6] = {0.01, -0.02, 0.003, 0.01, -0.005, 0.002};
  assert_ok(pw_element_move(&el, de, NULL, NULL));
  assert_true(test_turning_error(&el) < 1e-10);
}

static void place_does_not_matter(void **unused)
{
  (void)unused;
  test_material m = clay();
  test_place_does_not_matter(&m, 3e4, 1e-2, true);
  test_place_does_not_matter(&m, 3e4, 1e-2, false);
  test_set(&m, "hardening_modulus_pa", 1e5);
  test_place_does_not_matter(&m, 0.0, 0.2, true);
}

static void bad_parameters_are_named(void **unused)
{
  (void)unused;
  test_material m = clay();
  assert_ok(m.model->check(m.v));
  test_set(&m, "yield_radius_pa", 1.0);
  test_refuses(&m, "exactly one of");
  test_set(&m, "yield_radius_pa", 0.0);
  test_set(&m, "undrained_shear_strength_pa", 0.0);
  test_refuses(&m, "exactly one of");
  m = clay();
  test_set(&m, "poisson_ratio", 0.5);
  test_refuses(&m, "poisson_ratio");
}

static void inverted_points_are_reported(void **unused)
{
  (void)unused;
  test_material m = clay();
  pw_element el = test_start(&m, 1e4), out;
  const pw_real flat[6] = {-1.0, 0, 0, 0, 0, 0};
  assert_int_equal(test_update(&el, flat, NULL, &out, NULL), PW_RETRY_STRESS);
  assert_memory_equal(out.stress, el.stress, sizeof el.stress);
  assert_true(isfinite(out.wave_speed));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(uniaxial_tension),
                                     cmocka_unit_test(stretched_cube),
                                     cmocka_unit_test(elastic_simple_shear),
                                     cmocka_unit_test(plastic_simple_shear),
                                     cmocka_unit_test(cavity_pressure),
                                     cmocka_unit_test(measures_of_yield_agree),
                                     cmocka_unit_test(grows_with_depth),
                                     cmocka_unit_test(tangent_is_the_derivative),
                                     cmocka_unit_test(wave_speed_is_an_upper_bound),
                                     cmocka_unit_test(yield_and_dissipation),
                                     cmocka_unit_test(rotation_keeps_the_invariants),
                                     cmocka_unit_test(place_does_not_matter),
                                     cmocka_unit_test(bad_parameters_are_named),
                                     cmocka_unit_test(inverted_points_are_reported)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
