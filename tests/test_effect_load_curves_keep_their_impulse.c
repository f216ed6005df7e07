/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ramps and pulses give the impulse of the curve whatever the steps. */
#include "engine/effects/load_curve.h"
#include "engine/effects/params.h"
#include "tests/harness.h"

static const double pi = 3.14159265358979323846;

/* Sum of mean * dt over random steps of at most `longest` that end exactly at t1. */
static double impulse(const pw_pulse *p, double t1, double longest, uint64_t seed)
{
  double t = 0.0, sum = 0.0;
  while (t < t1) {
    double dt = longest * (0.01 + 0.99 * test_random(&seed));
    dt = t + dt > t1 ? t1 - t : dt;
    sum += dt * pw_pulse_mean(p, t, dt);
    t += dt;
  }
  return sum;
}

static void impulse_does_not_depend_on_steps(void **state)
{
  (void)state;
  const pw_pulse train[] = {
      {PW_PULSE_RECTANGULAR, 2.0, 0.1, 0.0, 0.5, 20},
      {PW_PULSE_RECTANGULAR, 2.0, 0.1, 0.005, 0.5, 20},
      {PW_PULSE_HALF_SINE, 2.0, 0.1, 0.0, 0.5, 20},
      {PW_PULSE_RECTANGULAR, 0.0, 0.1, 0.0, 0.0, 1},
      {PW_PULSE_RECTANGULAR, 0.3, 0.2, 0.1, 0.3, 3}, /* a fall ends where the next rise begins */
  };
  /* Areas under the curves: rectangle D, trapezoid with ramps outside D: D, half sine 2 D / pi. */
  const double area[] = {2.0, 2.0, 4.0 / pi, 0.1, 0.6};
  const double step[] = {1e-4, 3e-3, 0.07, 0.4, 3.0};
  for (size_t k = 0; k < sizeof train / sizeof train[0]; k++) {
    for (size_t s = 0; s < sizeof step / sizeof step[0]; s++) {
      assert_relative(impulse(&train[k], 12.5, step[s], 7 + s), area[k], 1e-12);
    }
    assert_relative(pw_pulse_impulse(&train[k]) * train[k].count, area[k], 1e-14);
  }
}

static void means_match_quadrature_of_the_curve(void **state)
{
  (void)state;
  const pw_pulse sine = {PW_PULSE_HALF_SINE, 0.2, 0.1, 0.0, 0.5, 2};
  const pw_pulse ramped = {PW_PULSE_RECTANGULAR, 0.2, 0.1, 0.02, 0.5, 2};
  uint64_t seed = 3;
  for (int k = 0; k < 200; k++) {
    double t = 1.0 * test_random(&seed), dt = 0.3 * test_random(&seed) + 1e-3;
    double s = 0.0, r = 0.0;
    const int n = 20000;
    for (int q = 0; q < n; q++) {
      double x = t + dt * (q + 0.5) / n;
      for (int blow = 0; blow < 2; blow++) {
        double a = x - 0.2 - 0.5 * blow;
        s += a > 0.0 && a < 0.1 ? sin(pi * a / 0.1) / n : 0.0;
        double up = fmin(fmax(a / 0.02, 0.0), 1.0), down = fmin(fmax((a - 0.1) / 0.02, 0.0), 1.0);
        r += (up - down) / n;
      }
    }
    assert_near(pw_pulse_mean(&sine, t, dt), s, 1e-6); /* midpoint rule with kinks */
    assert_near(pw_pulse_mean(&ramped, t, dt), r, 1e-6);
  }
}

static void ramp_is_linear_between_its_ends(void **state)
{
  (void)state;
  assert_near(pw_ramp(0.9, 1.0, 2.0), 0.0, 0.0);
  assert_near(pw_ramp(1.5, 1.0, 2.0), 0.25, 1e-15);
  assert_near(pw_ramp(3.0, 1.0, 2.0), 1.0, 0.0);
  assert_near(pw_ramp(1.0, 1.0, 0.0), 1.0, 0.0);
  assert_near(pw_ramp_mean(1.2, 0.2, 1.0, 2.0), 0.15, 1e-15); /* its value in the middle */
  assert_near(pw_ramp_mean(0.0, 4.0, 1.0, 2.0), 0.5, 1e-15);  /* (0 + 2/2 + 1) / 4 */
  assert_near(pw_ramp_mean(0.0, 4.0, 1.0, 0.0), 0.75, 1e-15);
  assert_near(pw_ramp_mean(5.0, 1e-7, 1.0, 2.0), 1.0, 1e-8);
  assert_near(pw_ramp_mean(0.0, 0.5, 1.0, 2.0), 0.0, 0.0);
}

static void blows_are_counted_from_their_starts(void **state)
{
  (void)state;
  const pw_pulse p = {PW_PULSE_RECTANGULAR, 2.0, 0.1, 0.0, 0.5, 20};
  const pw_pulse none = {PW_PULSE_RECTANGULAR, 2.0, 0.1, 0.0, 0.5, 0};
  assert_int_equal(pw_pulse_started(&p, 1.999), 0);
  assert_int_equal(pw_pulse_started(&p, 2.0), 1);
  assert_int_equal(pw_pulse_started(&p, 2.49), 1);
  assert_int_equal(pw_pulse_started(&p, 2.5), 2);
  assert_int_equal(pw_pulse_started(&p, 1e9), 20);
  assert_int_equal(pw_pulse_started(&none, 5.0), 0);
  assert_near(pw_pulse_mean(&none, 2.0, 0.1), 0.0, 0.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(impulse_does_not_depend_on_steps),
      cmocka_unit_test(means_match_quadrature_of_the_curve),
      cmocka_unit_test(ramp_is_linear_between_its_ends),
      cmocka_unit_test(blows_are_counted_from_their_starts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
