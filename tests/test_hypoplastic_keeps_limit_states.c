/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed-form facts of the model: critical states are the Matsuoka-Nakai cone at phi_c, isotropic
 * virgin compression stays on Bauer's curve e_i(p), stiffness after turns of 0, 90, 180 degrees is
 * 1 : m_T : m_R, rates are homogeneous in the strain rate. */
#include "kernels/hypoplastic_rates.h"
#include "tests/hypoplastic_reference.h"

static const double pi = 3.14159265358979323846;

static void derive(bool intergranular, double p_t, double tolerance, pw_hypo *h)
{
  pw_real v[PW_HYPO_PARAMS];
  reference_set(0, tolerance, v);
  v[PW_HYPO_P_T] = p_t;
  v[PW_HYPO_INTERGRANULAR] = intergranular ? 1.0 : 0.0;
  pw_hypo_derive(v, h);
}

/** Stress of mean p at a Lode angle whose mobilised angle is @p phi. */
static pw_t6 stress_on_cone(double p, double lode, double phi)
{
  pw_t6 dev = {.xx = cos(lode), .yy = cos(lode - 2.0 * pi / 3.0), .zz = cos(lode + 2.0 * pi / 3.0)};
  double low = 0.0, high = p;
  for (int i = 0; i < 100; i++) {
    double size = 0.5 * (low + high);
    pw_t6 stress = pw_t6_shift(pw_t6_scale(-size, dev), -p);
    *(pw_hypo_friction_angle(stress) < phi ? &low : &high) = size;
  }
  return pw_t6_shift(pw_t6_scale(-low, dev), -p);
}

static void critical_state_is_the_cone(void **unused)
{
  (void)unused;
  pw_hypo h;
  derive(false, 0.0, 1e-3, &h);
  for (int i = 0; i <= 60; i++) {
    double lode = i * pi / 60.0, p = 1e5;
    pw_hypo_point at = {.stress = stress_on_cone(p, lode, pi / 6.0)};
    at.void_ratio = h.e_c0 * exp(-pow(3.0 * p * h.inv_h_s, h.n));
    pw_hypo_shape g = pw_hypo_shape_of(at.stress);
    pw_hypo_factors k = pw_hypo_factors_of(&h, &g, at.void_ratio, false);
    /* flow: D = -L^-1:N |D| */
    pw_t6 n = pw_t6_scale(k.c_n, pw_t6_shift(pw_t6_scale(2.0, g.s), -1.0 / 3.0));
    double along = k.c2 * pw_t6_dot(g.s, n) / (k.c1 + k.c2 * pw_t6_dot(g.s, g.s));
    pw_t6 d = pw_t6_scale(-1.0 / k.c1, pw_t6_axpy(n, -along, g.s));
    assert_near(pw_t6_norm(d), 1.0, 1e-11);
    assert_near(pw_t6_trace(d), 0.0, 1e-11);
    pw_hypo_rates r;
    pw_hypo_evaluate(&h, &at, d, &r);
    assert_near(r.f_d, 1.0, 1e-12);
    assert_true(pw_t6_norm(r.stress) < 1e-11 * k.c1);
  }
}

/** e_i(p) of the basic model; from 10 kPa to 179 MPa in small increments. */
static void virgin_compression_stays_on_bauers_curve(void **unused)
{
  (void)unused;
  pw_hypo h;
  double p = 1e4;
  derive(false, 0.0, 1e-3, &h);
  pw_hypo_point at = {.stress = {.xx = -p, .yy = -p, .zz = -p}, .substep = 1.0};
  at.void_ratio = h.e_i0 * exp(-pow(3.0 * p * h.inv_h_s, h.n));
  const double start = at.void_ratio;
  const int steps = 100000;
  double end = h.e_i0 * exp(-pow(3.0 * 179e6 * h.inv_h_s, h.n));
  double eps = log((1.0 + end) / (1.0 + start)) / steps / 3.0;
  for (int i = 0; i < steps; i++) {
    pw_t6 de = {.xx = eps, .yy = eps, .zz = eps};
    assert_int_equal(pw_hypo_integrate(&h, de, exp(3.0 * eps), &at, NULL, NULL, NULL), PW_OK);
  }
  p = -pw_t6_trace(at.stress) / 3.0;
  assert_relative(p, 179e6, 1e-8);
  assert_relative(at.void_ratio, h.e_i0 * exp(-pow(3.0 * p * h.inv_h_s, h.n)), 1e-11);
}

/** The same for the rate alone: de/dp = -n e_i (3p/h_s)^n / p. */
static void bauers_curve_is_tangent_to_the_rate(void **unused)
{
  (void)unused;
  pw_hypo h;
  derive(false, 1600.0, 1e-3, &h);
  for (double p = 1e3; p < 2e8; p *= 3.0) { /* p*: the shift is part of it */
    double x = pow(3.0 * p * h.inv_h_s, h.n), stress = -p + h.p_t;
    pw_hypo_point at = {.stress = {.xx = stress, .yy = stress, .zz = stress}};
    pw_hypo_rates r;
    at.void_ratio = h.e_i0 * exp(-x);
    pw_hypo_evaluate(&h, &at, (pw_t6){.xx = -1.0, .yy = -1.0, .zz = -1.0}, &r);
    assert_relative(r.void_ratio / -r.stress.xx, -h.n * at.void_ratio * x / p, 1e-12);
  }
}

static void stiffness_after_turns(void **unused)
{
  (void)unused;
  pw_hypo h;
  derive(true, 1600.0, 1e-3, &h);
  pw_t6 d0 = pw_t6_scale(1.0 / sqrt(1.5), (pw_t6){.xx = 0.5, .yy = -1.0, .zz = 0.5});
  pw_t6 turn[3] = {d0, {.xy = sqrt(0.5)}, pw_t6_scale(-1.0, d0)};
  double g[3];
  for (int i = 0; i < 3; i++) {
    pw_hypo_point at = {.stress = {.xx = -1e5, .yy = -1e5, .zz = -1e5}, .void_ratio = 0.65};
    pw_hypo_rates r;
    at.delta = pw_t6_scale(h.r, d0);
    pw_hypo_evaluate(&h, &at, turn[i], &r);
    g[i] = 0.5 * pw_t6_dot(turn[i], r.stress) / pw_t6_dot(turn[i], turn[i]);
  }
  /* shear moduli of the reference README, MPa */
  assert_relative(g[0], 11.343e6, 1e-4);
  assert_relative(g[1], h.m_t * g[0], 1e-13);
  assert_relative(g[2], h.m_r * g[0], 1e-13);
}

static void rates_are_homogeneous(void **unused)
{
  (void)unused;
  pw_hypo h;
  for (int with = 0; with < 2; with++) {
    derive(with, 1600.0, 1e-3, &h);
    pw_hypo_point at = {.stress = {-1e5, -2e5, -1.2e5, 2e4, -1e4, 5e3}, .void_ratio = 0.7};
    at.delta = (pw_t6){1e-5, -2e-5, 1e-5, 5e-6, 0, 0};
    pw_t6 d = {0.3, -0.6, 0.1, 0.4, -0.2, 0.1};
    pw_hypo_rates one, seven;
    pw_hypo_evaluate(&h, &at, d, &one);
    pw_hypo_evaluate(&h, &at, pw_t6_scale(7.0, d), &seven);
    pw_t6 off = pw_t6_axpy(seven.stress, -7.0, one.stress);
    assert_true(pw_t6_norm(off) <= 1e-12 * pw_t6_norm(seven.stress));
    off = pw_t6_axpy(seven.delta, -7.0, one.delta);
    assert_true(pw_t6_norm(off) <= 1e-12 * pw_t6_norm(seven.delta));
  }
}

/** F = 1 in triaxial compression and for isotropic stress, 5/7 for 3:3:1. */
static void matsuoka_nakai_factor(void **unused)
{
  (void)unused;
  for (double ratio = 1.0; ratio < 8.0; ratio += 0.25) {
    pw_hypo_shape g = pw_hypo_shape_of((pw_t6){.xx = -1.0, .yy = -ratio, .zz = -1.0});
    assert_near(g.f, 1.0, 1e-14);
  }
  pw_hypo_shape g = pw_hypo_shape_of((pw_t6){.xx = -3.0, .yy = -1.0, .zz = -3.0});
  assert_near(g.f, 5.0 / 7.0, 1e-14);
}

/** The bound is never below the acoustic tensor of M, and m_R L1 = 4.63e4 kPa x 10 at 100 kPa. */
static void wave_speed_bounds_every_direction(void **unused)
{
  (void)unused;
  uint64_t seed = 5;
  pw_hypo h;
  double closest = 0.0;
  for (int i = 0; i < 4000; i++) {
    derive(i % 4 != 0, 1600.0, 1e-3, &h);
    double angle = (5.0 + 45.0 * test_random(&seed)) * pi / 180.0;
    pw_hypo_point at = {.void_ratio = 0.55 + 0.4 * test_random(&seed)};
    at.stress =
        stress_on_cone(1e3 + 1e6 * test_random(&seed), 2.0 * pi * test_random(&seed), angle);
    at.stress = pw_t6_shift(at.stress, h.p_t);
    pw_real n[3], a[3], c[6];
    double nn = 0.0, aa = 0.0, cc = 0.0;
    for (int k = 0; k < 6; k++) {
      c[k] = test_random(&seed) - 0.5;
      cc += c[k] * c[k] * (k < 3 ? 1.0 : 2.0);
      if (k < 3) {
        n[k] = test_random(&seed) - 0.5;
        a[k] = test_random(&seed) < 0.5 ? n[k] : test_random(&seed) - 0.5;
        nn += n[k] * n[k];
        aa += a[k] * a[k];
      }
    }
    at.delta = pw_t6_scale(h.r * test_random(&seed) / sqrt(cc), pw_t6_load(c, 1));
    /* plane wave: D = sym(a n), traction rate sigma_dot.n; its part along a is the modulus */
    double f = 1.0 / sqrt(nn * aa);
    pw_t6 d = {a[0] * n[0] * f,
               a[1] * n[1] * f,
               a[2] * n[2] * f,
               0.5 * f * (a[0] * n[1] + a[1] * n[0]),
               0.5 * f * (a[1] * n[2] + a[2] * n[1]),
               0.5 * f * (a[2] * n[0] + a[0] * n[2])};
    pw_hypo_rates r;
    for (int sign = -1; sign <= 1; sign += 2) {
      pw_hypo_evaluate(&h, &at, pw_t6_scale(sign, d), &r);
      closest = fmax(closest, sign * pw_t6_dot(r.stress, d) / r.modulus);
    }
  }
  print_message("largest modulus found over its bound: %.3f\n", closest);
  assert_true(closest < 1.0);
  assert_true(closest > 0.7);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(critical_state_is_the_cone),
                                     cmocka_unit_test(virgin_compression_stays_on_bauers_curve),
                                     cmocka_unit_test(bauers_curve_is_tangent_to_the_rate),
                                     cmocka_unit_test(stiffness_after_turns),
                                     cmocka_unit_test(rates_are_homogeneous),
                                     cmocka_unit_test(matsuoka_nakai_factor),
                                     cmocka_unit_test(wave_speed_bounds_every_direction)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
