/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The manufactured body forces balance inertia and the divergence of the neo-Hookean stress, by
 * finite differences of the displacement alone. */
#include "engine/effects/manufactured.h"
#include "engine/effects/params.h"
#include "tests/harness.h"

static const double step_x = 2e-4; /* m: cubic remainders below the tolerance, rounding too */

/* First Piola-Kirchhoff stress at x0, P = lambda ln J F^-T + mu F^-1 (F F^T - I), whose transpose
 * (lambda ln J - mu) F^-1 + mu F^T is used: plane strain, 2 x 2. */
static void piola(const pw_mms *m, const double *x0, double t, double p[2][2])
{
  double f[2][2];
  for (int j = 0; j < 2; j++) {
    double a[2] = {x0[0], x0[1]}, b[2] = {x0[0], x0[1]}, ua[2], ub[2];
    double c[2] = {x0[0], x0[1]}, d[2] = {x0[0], x0[1]}, uc[2], ud[2];
    a[j] -= step_x;
    b[j] += step_x;
    c[j] -= 2.0 * step_x;
    d[j] += 2.0 * step_x;
    pw_mms_displacement(m, a, t, ua);
    pw_mms_displacement(m, b, t, ub);
    pw_mms_displacement(m, c, t, uc);
    pw_mms_displacement(m, d, t, ud);
    for (int i = 0; i < 2; i++) {
      f[i][j] = (i == j) + (8.0 * (ub[i] - ua[i]) - (ud[i] - uc[i])) / (12.0 * step_x);
    }
  }
  double jac = f[0][0] * f[1][1] - f[0][1] * f[1][0], s = m->lambda * log(jac) - m->mu;
  const double inv_t[2][2] = {{f[1][1] / jac, -f[1][0] / jac}, {-f[0][1] / jac, f[0][0] / jac}};
  for (int i = 0; i < 2; i++) {
    for (int j = 0; j < 2; j++) {
      p[i][j] = s * inv_t[i][j] + m->mu * f[i][j];
    }
  }
}

/* Body force per mass from differences: acceleration - Div P / rho. */
static void balance(const pw_mms *m, const double *x0, double t, double *b)
{
  const double step_t = 1e-3 / pw_mms_speed(m);
  double u[5][2];
  for (int k = 0; k < 5; k++) {
    pw_mms_displacement(m, x0, t + (k - 2) * step_t, u[k]);
  }
  for (int i = 0; i < 2; i++) {
    b[i] = (16.0 * (u[1][i] + u[3][i]) - u[0][i] - u[4][i] - 30.0 * u[2][i]) /
           (12.0 * step_t * step_t);
  }
  for (int j = 0; j < 2; j++) {
    double p[4][2][2];
    const double at[4] = {-2.0, -1.0, 1.0, 2.0};
    for (int k = 0; k < 4; k++) {
      double x[2] = {x0[0], x0[1]};
      x[j] += 10.0 * at[k] * step_x;
      piola(m, x, t, p[k]);
    }
    for (int i = 0; i < 2; i++) {
      b[i] -= (8.0 * (p[2][i][j] - p[1][i][j]) - (p[3][i][j] - p[0][i][j])) /
              (120.0 * step_x * m->density);
    }
  }
}

static pw_mms motion(int kind, int course, double amplitude)
{
  double young = kind == PW_MMS_VORTEX ? 1000.0 : 1e7, nu = 0.3; /* verification A3, A4 */
  return (pw_mms){.kind = kind,
                  .course = course,
                  .amplitude = amplitude,
                  .lambda = young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
                  .mu = 0.5 * young / (1.0 + nu),
                  .density = 1000.0};
}

/* Largest error relative to the largest force over random places and times. */
static double worst(const pw_mms *m)
{
  uint64_t seed = 11;
  double error = 0.0, size = 0.0;
  for (int k = 0; k < 400; k++) {
    double a = test_random(&seed), c = test_random(&seed), x0[2] = {a, c}, b[2], expect[2];
    double t = 2.0 * test_random(&seed) / pw_mms_speed(m);
    if (m->kind == PW_MMS_VORTEX) {
      double r = 0.77 + 0.46 * a, angle = 6.283 * c;
      x0[0] = r * cos(angle);
      x0[1] = r * sin(angle);
    }
    balance(m, x0, t, expect);
    pw_mms_body_force(m, x0, t, b);
    error = fmax(error, hypot(b[0] - expect[0], b[1] - expect[1]));
    size = fmax(size, hypot(expect[0], expect[1]));
  }
  return error / size;
}

static void forces_balance_momentum(void **state)
{
  (void)state;
  const pw_mms m[] = {
      motion(PW_MMS_AXIS_ALIGNED, PW_MMS_SINE, 0.05), motion(PW_MMS_AXIS_ALIGNED, PW_MMS_SINE, 0.1),
      motion(PW_MMS_VORTEX, PW_MMS_SINE, 1.0), motion(PW_MMS_VORTEX, PW_MMS_ONE_MINUS_COSINE, 1.0)};
  for (size_t k = 0; k < sizeof m / sizeof m[0]; k++) {
    assert_near(worst(&m[k]), 0.0, 2e-6); /* truncation of the fourth-order differences */
  }
}

/* Expanding ring, radial: P_rr and P_tt from the determinant of F = diag(u', 1, u / R) + I, with
 * F^-1 (F F^T - I) = F^T - F^-1. */
static void ring_piola(const pw_mms *m, double r, double t, double *rr, double *tt)
{
  double u[5][2];
  for (int k = 0; k < 5; k++) {
    pw_mms_displacement(m, (double[]){r + (k - 2) * step_x, 0.3}, t, u[k]);
  }
  double f = 1.0 + (8.0 * (u[3][0] - u[1][0]) - (u[4][0] - u[0][0])) / (12.0 * step_x);
  double hoop = 1.0 + u[2][0] / r, volume = m->lambda * log(f * hoop);
  *rr = volume / f + m->mu * (f - 1.0 / f);
  *tt = volume / hoop + m->mu * (hoop - 1.0 / hoop);
}

/* b_r = acceleration - (dP_rr/dR + (P_rr - P_tt)/R) / rho. */
static double ring_balance(const pw_mms *m, double r, double t)
{
  const double step_t = 1e-3 / pw_mms_speed(m), at[4] = {-2.0, -1.0, 1.0, 2.0};
  double u[5][2], rr[4], tt[4], here[2];
  for (int k = 0; k < 5; k++) {
    pw_mms_displacement(m, (double[]){r, 0.3}, t + (k - 2) * step_t, u[k]);
  }
  for (int k = 0; k < 4; k++) {
    ring_piola(m, r + 10.0 * at[k] * step_x, t, &rr[k], &tt[k]);
  }
  ring_piola(m, r, t, &here[0], &here[1]);
  double slope = (8.0 * (rr[2] - rr[1]) - (rr[3] - rr[0])) / (120.0 * step_x);
  double inertia =
      (16.0 * (u[1][0] + u[3][0]) - u[0][0] - u[4][0] - 30.0 * u[2][0]) / (12.0 * step_t * step_t);
  return inertia - (slope + (here[0] - here[1]) / r) / m->density;
}

static void ring_forces_balance_momentum(void **state)
{
  (void)state;
  const double young = 1e7, nu[2] = {0.0, 0.3};
  uint64_t seed = 3;
  for (int j = 0; j < 2; j++) {
    pw_mms m = {.kind = PW_MMS_RING,
                .amplitude = 0.1,
                .lambda = young * nu[j] / ((1.0 + nu[j]) * (1.0 - 2.0 * nu[j])),
                .mu = 0.5 * young / (1.0 + nu[j]),
                .density = 1000.0};
    double error = 0.0, size = 0.0;
    for (int k = 0; k < 400; k++) {
      double r = 0.41 + 0.18 * test_random(&seed), t = 2.0 * test_random(&seed) / pw_mms_speed(&m);
      double expect = ring_balance(&m, r, t), b[2];
      pw_mms_body_force(&m, (double[]){r, 0.3}, t, b);
      assert_true(b[1] == 0.0);
      error = fmax(error, fabs(b[0] - expect));
      size = fmax(size, fabs(expect));
    }
    assert_near(error / size, 0.0, 2e-6); /* truncation of the fourth-order differences */
  }
}

/* Places and size of Wallstedt and Guilkey's ring: rims with F_r = 1, u(0.6) = A sin(c pi t). */
static void rims_of_the_ring_are_free(void **state)
{
  (void)state;
  pw_mms m = {.kind = PW_MMS_RING, .amplitude = 0.1, .mu = 5e6, .density = 1000.0};
  double t = 0.3 / pw_mms_speed(&m), u[2], rr, tt;
  pw_mms_displacement(&m, (double[]){0.6, 0.0}, t, u);
  assert_relative(u[0], 0.1 * sin(0.3 * acos(-1.0)), 1e-13);
  for (int k = 0; k < 2; k++) {
    ring_piola(&m, k == 0 ? 0.4 : 0.6, t, &rr, &tt);
    assert_near(rr / tt, 0.0, 1e-9);
  }
}

static void velocity_is_the_rate_of_displacement(void **state)
{
  (void)state;
  uint64_t seed = 5;
  for (int kind = PW_MMS_AXIS_ALIGNED; kind <= PW_MMS_RING; kind++) {
    for (int course = 0; course < 2; course++) {
      pw_mms m = motion(kind, course, 0.3);
      double scale = 0.3 * 3.1416 * pw_mms_speed(&m);
      for (int k = 0; k < 50; k++) {
        double x0[2] = {0.6 + 0.3 * test_random(&seed), 0.6 + 0.3 * test_random(&seed)};
        double t = test_random(&seed) / pw_mms_speed(&m), dt = 1e-5 / pw_mms_speed(&m);
        double a[2], b[2], v[2];
        pw_mms_displacement(&m, x0, t - dt, a);
        pw_mms_displacement(&m, x0, t + dt, b);
        pw_mms_velocity(&m, x0, t, v);
        for (int i = 0; i < 2; i++) {
          assert_near(v[i], (b[i] - a[i]) / (2.0 * dt), 1e-8 * scale);
        }
      }
    }
  }
}

static void wave_speeds_are_those_of_the_catalogue(void **state)
{
  (void)state;
  pw_mms a = motion(PW_MMS_AXIS_ALIGNED, PW_MMS_SINE, 0.05);
  pw_mms b = motion(PW_MMS_VORTEX, PW_MMS_SINE, 1.0);
  assert_relative(pw_mms_speed(&a), 100.0, 1e-14);
  assert_relative(pw_mms_speed(&b), 1.0, 1e-14);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(forces_balance_momentum),
      cmocka_unit_test(ring_forces_balance_momentum),
      cmocka_unit_test(rims_of_the_ring_are_free),
      cmocka_unit_test(velocity_is_the_rate_of_displacement),
      cmocka_unit_test(wave_speeds_are_those_of_the_catalogue),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
