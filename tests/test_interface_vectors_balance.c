/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gap, slip and force vectors of a slave and a segment: gradients (C1), balance (C2), sign (C3).
 * Reference: finite differences; statics. */
#include "kernels/interface_law.h"
#include "tests/harness.h"

static unsigned long long seed = 1;

/* Uniform in [-1, 1]. */
static pw_real uniform(void)
{
  seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return (pw_real)(seed >> 11) / 4503599627370496.0 - 1.0;
}

/* Slave, node 1, node 2: a segment of length about 1 and a slave near it. */
static void random_pair(pw_real *x)
{
  for (int i = 0; i < 6; i++) {
    x[i] = 0.2 * uniform();
  }
  x[4] += 1.0;
  x[0] += 0.5;
}

static pw_pair pair_of(const pw_real *x)
{
  return pw_pair_project(x, x + 2, x + 4);
}

/* grad g_n = N and l grad xi = T + (g_n/l) P. */
static void vectors_are_gradients(void **state)
{
  (void)state;
  const pw_real step = 1e-6;
  for (int trial = 0; trial < 200; trial++) {
    pw_real x[6], cn[6], ct[6];
    random_pair(x);
    pw_pair p = pair_of(x);
    pw_pair_vectors(&p, cn, ct);
    for (int i = 0; i < 6; i++) {
      pw_real up[6], down[6];
      for (int k = 0; k < 6; k++) {
        up[k] = x[k] + (k == i ? step : 0.0);
        down[k] = x[k] - (k == i ? step : 0.0);
      }
      pw_pair pu = pair_of(up), pd = pair_of(down);
      assert_near(cn[i], (pu.gap - pd.gap) / (2.0 * step), 1e-8);
      assert_near(ct[i], p.lever * (pu.xi - pd.xi) / (2.0 * step), 1e-8);
    }
  }
}

static void assert_balanced(const pw_real *x, const pw_real *f)
{
  pw_real fx = 0.0, fy = 0.0, moment = 0.0;
  for (int k = 0; k < 6; k += 2) {
    fx += f[k];
    fy += f[k + 1];
    moment += x[k] * f[k + 1] - x[k + 1] * f[k];
  }
  assert_near(fx, 0.0, 1e-14);
  assert_near(fy, 0.0, 1e-14);
  assert_near(moment, 0.0, 1e-14);
}

static void vectors_balance(void **state)
{
  (void)state;
  for (int trial = 0; trial < 1000; trial++) {
    pw_real x[6], cn[6], ct[6], f[6];
    random_pair(x);
    pw_pair p = pair_of(x);
    pw_pair_vectors(&p, cn, ct);
    assert_balanced(x, cn);
    assert_balanced(x, ct);
    pw_pair_force(cn, ct, 0.6, -0.4, 0.5, f);
    assert_balanced(x, f);
  }
}

/* A slave in the body (left of the segment) is pushed out and the segment pushed in; a spring
 * stretched along the segment pulls the slave back. */
static void overlap_pushes_out(void **state)
{
  (void)state;
  const pw_real x[6] = {0.25, 0.1, 0.0, 0.0, 1.0, 0.0};
  pw_real cn[6], ct[6], f[6];
  pw_pair p = pair_of(x);
  assert_near(p.gap, -0.1, 1e-15);
  assert_near(p.xi, 0.25, 1e-15);
  pw_pair_vectors(&p, cn, ct);
  pw_real pressure = pw_normal_pressure(1e6, p.gap);
  assert_near(pressure, 1e5, 1e-9);
  pw_pair_force(cn, ct, pressure, 0.0, 2.0, f);
  const pw_real expected[6] = {0.0, -2e5, 0.0, 1.5e5, 0.0, 0.5e5};
  for (int i = 0; i < 6; i++) {
    assert_near(f[i], expected[i], 1e-9);
  }
  pw_pair_force(cn, ct, 0.0, 3.0, 1.0, f);
  assert_near(f[0], -3.0, 1e-14);
  assert_near(pw_normal_pressure(1e6, 1e-3), 0.0, 0.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(vectors_are_gradients),
      cmocka_unit_test(vectors_balance),
      cmocka_unit_test(overlap_pushes_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
