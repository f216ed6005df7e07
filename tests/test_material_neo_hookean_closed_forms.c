/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Neo-Hookean solid: P = lambda ln(J) F^-T + mu F^-1 (F F^T - 1) gives J sigma = lambda ln J 1 +
 * mu (b - 1). Dilation, uniaxial stretch, simple shear, rotation, tangent, wave speed, failure. */
#include "kernels/element_driver.h"
#include "kernels/tensor.h"
#include "tests/harness.h"

static const pw_real param[3] = {8e6, 3e6, 1200.0};
static const double mu = 3e6, lambda = 8e6 - 2e6;

static void start(pw_element *el)
{
  const pw_real zero[6] = {0};
  assert_ok(pw_element_start(el, pw_material_find("neo_hookean"), param, zero));
}

static void move(pw_element *el, double xx, double yy, double zz, double xy, double spin)
{
  const pw_real de[6] = {xx, yy, zz, xy, 0, 0}, w[3] = {spin, 0, 0};
  assert_ok(pw_element_move(el, de, w, NULL));
}

static void dilation(void **unused)
{
  (void)unused;
  for (double stretch = 0.5; stretch < 2.5; stretch += 0.25) {
    pw_element el;
    double e = log(stretch), jac = stretch * stretch * stretch;
    start(&el);
    move(&el, e, e, e, 0, 0);
    double expected = (lambda * log(jac) + mu * (stretch * stretch - 1.0)) / jac;
    for (int c = 0; c < 6; c++) {
      assert_near(el.stress[c], c < 3 ? expected : 0.0, 1e-12 * 8e6);
    }
    assert_relative(el.density, 1200.0 / jac, 1e-13);
  }
}

static void uniaxial_stretch(void **unused)
{
  (void)unused;
  for (double stretch = 0.3; stretch < 3.0; stretch += 0.3) {
    pw_element el;
    start(&el);
    move(&el, 0, log(stretch), 0, 0, 0);
    double side = lambda * log(stretch) / stretch;
    assert_near(el.stress[1], side + mu * (stretch * stretch - 1.0) / stretch, 1e-12 * 3e7);
    assert_near(el.stress[0], side, 1e-12 * 3e7);
    assert_near(el.stress[2], side, 1e-12 * 3e7);
  }
}

/** F = 1 + gamma e_x e_y in one move: exp(dE + dW) with D_xy = W_xy = gamma / 2 is exact. */
static void simple_shear(void **unused)
{
  (void)unused;
  for (double gamma = -2.0; gamma <= 2.0; gamma += 0.5) {
    pw_element el;
    start(&el);
    move(&el, 0, 0, 0, 0.5 * gamma, 0.5 * gamma);
    assert_near(el.stress[0], mu * gamma * gamma, 1e-12 * 2e7);
    assert_near(el.stress[3], mu * gamma, 1e-12 * 2e7);
    assert_near(el.stress[1], 0.0, 1e-12 * 2e7);
    assert_near(el.stress[2], 0.0, 1e-12 * 2e7);
  }
}

static void rotation_keeps_the_invariants(void **unused)
{
  (void)unused;
  const double axis[3] = {0.48, -0.64, 0.6};
  const pw_real de[6] = {0.1, -0.2, 0.05, 0.1, -0.05, 0.02}, none[6] = {0};
  pw_element el;
  start(&el);
  assert_ok(pw_element_move(&el, de, NULL, NULL));
  pw_t6 before = pw_t6_load(el.stress, 1);
  const int steps = 1000;
  for (int i = 0; i < steps; i++) {
    pw_real spin[3];
    for (int c = 0; c < 3; c++) {
      spin[c] = axis[c] * 20.0 * 3.14159265358979323846 / steps;
    }
    assert_ok(pw_element_move(&el, none, spin, NULL));
  }
  pw_t6 after = pw_t6_load(el.stress, 1);
  assert_true(pw_t6_norm(pw_t6_axpy(after, -1.0, before)) < 1e-10 * pw_t6_norm(before));
}

/** Central differences of the stress of exp(dE) F at dE = 0. */
static void tangent_is_the_derivative(void **unused)
{
  (void)unused;
  const pw_real de[6] = {0.2, -0.3, 0.1, 0.15, -0.1, 0.05}, none[6] = {0};
  pw_real tangent[36];
  pw_element el;
  start(&el);
  assert_ok(pw_element_move(&el, de, NULL, NULL));
  assert_ok(pw_element_move(&el, none, NULL, tangent));
  for (int j = 0; j < 6; j++) {
    pw_element plus = el, minus = el;
    pw_real step[6] = {0};
    step[j] = 1e-5;
    assert_ok(pw_element_move(&plus, step, NULL, NULL));
    step[j] = -1e-5;
    assert_ok(pw_element_move(&minus, step, NULL, NULL));
    for (int i = 0; i < 6; i++) {
      double slope = (plus.stress[i] - minus.stress[i]) / (j < 3 ? 2e-5 : 4e-5);
      assert_near(tangent[6 * i + j], slope, 1e-7 * 1e7);
    }
  }
}

/** Eigenvalues of the acoustic tensor ((lambda (1 - ln J) + mu) n n + mu (n.b.n) 1) / J in random
 *  directions n: never above the bound, and equal to it when undeformed. */
static void wave_speed_is_an_upper_bound(void **unused)
{
  (void)unused;
  uint64_t seed = 9;
  const pw_real none[6] = {0};
  double closest = 0.0;
  for (int i = 0; i < 2000; i++) {
    pw_element el;
    pw_real de[6], n[3], t[36];
    double nn = 0.0;
    start(&el);
    for (int c = 0; c < 6; c++) {
      de[c] = i == 0 ? 0.0 : 1.4 * (test_random(&seed) - 0.5) * (c < 3 ? 1.0 : 0.7);
    }
    assert_ok(pw_element_move(&el, de, NULL, NULL));
    assert_ok(pw_element_move(&el, none, NULL, t));
    /* b from the stress: J sigma = lambda ln J + mu (b - 1) */
    double jac = exp(de[0] + de[1] + de[2]);
    pw_t6 b = pw_t6_scale(jac / mu, pw_t6_load(el.stress, 1));
    b = pw_t6_shift(b, 1.0 - lambda * log(jac) / mu);
    for (int k = 0; k < 200; k++) {
      nn = 0.0;
      for (int c = 0; c < 3; c++) {
        n[c] = test_random(&seed) - 0.5;
        nn += n[c] * n[c];
      }
      pw_t6 dyad = {n[0] * n[0], n[1] * n[1], n[2] * n[2], n[0] * n[1], n[1] * n[2], n[2] * n[0]};
      double stretch = pw_t6_dot(b, dyad) / nn;
      double along = (lambda * (1.0 - log(jac)) + mu + mu * stretch) / jac;
      double across = mu * stretch / jac;
      closest = fmax(closest, sqrt(fmax(along, across) / el.density) / el.wave_speed);
    }
    if (i == 0) {
      assert_relative(el.wave_speed, sqrt((lambda + 2 * mu) / 1200.0), 1e-12);
    }
  }
  assert_true(closest <= 1.0 + 1e-12);
  assert_true(closest > 0.95);
}

static void inverted_points_are_reported(void **unused)
{
  (void)unused;
  enum { N = 4 };
  pw_real b[6][N] = {{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}}, jac[N] = {1, 1, -0.1, 0.0};
  pw_real zero[6][N] = {{0}}, stress[6][N] = {{0}}, speed[N], density[N] = {1200, 1200, 1200, 1200};
  stress[0][2] = 5.0;
  pw_stress_args a = {.n = N,
                      .ld = N,
                      .ldi = N,
                      .dstrain = zero[0],
                      .spin = zero[0],
                      .dvol = jac,
                      .left_cg = b[0],
                      .jac = jac,
                      .density = density,
                      .stress = stress[0],
                      .wave_speed = speed};
  assert_int_equal(pw_material_find("neo_hookean")->update(param, &a), PW_RETRY_STRESS);
  assert_int_equal(a.bad, 2);
  assert_near(stress[0][2], 5.0, 0.0);
  assert_true(isfinite(speed[2]) && isfinite(speed[3]));
  assert_near(stress[0][1], 0.0, 0.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(dilation),
                                     cmocka_unit_test(uniaxial_stretch),
                                     cmocka_unit_test(simple_shear),
                                     cmocka_unit_test(rotation_keeps_the_invariants),
                                     cmocka_unit_test(tangent_is_the_derivative),
                                     cmocka_unit_test(wave_speed_is_an_upper_bound),
                                     cmocka_unit_test(inverted_points_are_reported)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
