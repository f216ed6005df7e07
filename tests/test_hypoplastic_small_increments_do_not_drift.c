/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small increments are one step of Heun's method each: over long paths and many reversals their sum
 * stays as near a tight integration as the three stages do; the same path is repeated bit by bit. */
#include "tests/hypoplastic_reference.h"

enum { CYCLES = 25, STEPS = 200 };

static void derive(double tolerance, pw_hypo *h)
{
  pw_real v[PW_HYPO_PARAMS];
  reference_set(0, tolerance, v);
  v[PW_HYPO_MAX_SUBSTEPS] = PW_HYPO_SUBSTEP_LIMIT;
  pw_hypo_derive(v, h);
}

static pw_hypo_point start(void)
{
  return (pw_hypo_point){.stress = {.xx = -8e4, .yy = -1e5, .zz = -8e4, .xy = 1e4},
                         .void_ratio = 0.65,
                         .substep = 1.0};
}

typedef struct totals {
  pw_material_counts counts;
  double work; /* of the trapezoidal rule; J/m3 */
} totals;

/** @p n increments of @p de. @p three: with three stages, as after a substep that was cut. */
static void walk(const pw_hypo *h, pw_t6 de, int n, bool three, pw_hypo_point *p, totals *sum)
{
  const double dvol = exp(pw_t6_trace(de));
  for (int i = 0; i < n; i++) {
    const pw_t6 before = p->stress;
    p->substep = three ? 1.0 - 1e-12 : p->substep;
    assert_int_equal(pw_hypo_integrate(h, de, dvol, p, NULL, &sum->counts, NULL), PW_OK);
    sum->work += 0.5 * pw_t6_dot(pw_t6_axpy(before, 1.0, p->stress), de);
  }
}

static double distance(const pw_hypo *h, const pw_hypo_point *a, const pw_hypo_point *b)
{
  double size = pw_t6_norm(pw_t6_shift(b->stress, -h->p_t));
  double on_stress = pw_t6_norm(pw_t6_axpy(a->stress, -1.0, b->stress)) / size;
  return fmax(on_stress, pw_t6_norm(pw_t6_axpy(a->delta, -1.0, b->delta)) / h->r);
}

/** 1 % of strain in 10^5 increments: what error there is comes from the beginning. From delta = 0,
 *  where rho^beta_r has an infinite slope, the first increment of x R errs by about x^(1+beta_r). */
static void straight_path(pw_t6 delta, double bound)
{
  pw_hypo h, fine;
  const pw_t6 direction = {.yy = -0.9, .xy = 0.3};
  totals heun = {0}, three = {0}, tight = {0};
  pw_hypo_point a = start(), b, c;
  double early = 0.0;
  derive(1e-3, &h);
  derive(1e-10, &fine);
  a.delta = delta;
  b = c = a;
  for (int part = 0; part < 2; part++) {
    const int n = part == 0 ? 1000 : 99000;
    walk(&h, pw_t6_scale(1e-7, direction), n, false, &a, &heun);
    walk(&h, pw_t6_scale(1e-7, direction), n, true, &b, &three);
    walk(&fine, pw_t6_scale(1e-6, direction), n / 10, false, &c, &tight);
    print_message("%d increments more: Heun %.1e, three stages %.1e\n", n, distance(&h, &a, &c),
                  distance(&h, &b, &c));
    early = part == 0 ? distance(&h, &a, &c) : early;
  }
  assert_true(heun.counts.rhs < 200100);
  assert_true(three.counts.rhs >= 300000);
  assert_true(early < bound);
  assert_true(distance(&h, &a, &c) < early);
  assert_near(a.void_ratio, c.void_ratio, 1e-11);
}

static void long_straight_paths(void **unused)
{
  (void)unused;
  straight_path((pw_t6){.xx = 2e-5, .yy = 1e-5, .xy = 1e-5, .yz = 1e-5}, 1e-6);
  straight_path((pw_t6){0}, pow(1e-7 / 5e-5, 1.3));
}

/** Shear cycles with a reversal every 200 increments; stress, and the work put in. */
static void cycles(const pw_hypo *h, int refine, bool three, pw_hypo_point *p, totals *sum)
{
  const pw_t6 step = {.xy = 2e-7 / refine, .yy = 2e-8 / refine};
  *p = start();
  for (int i = 0; i < 2 * CYCLES; i++) {
    walk(h, pw_t6_scale(i % 2 ? -1.0 : 1.0, step), STEPS * refine, three, p, sum);
  }
}

static void cyclic_reversals(void **unused)
{
  (void)unused;
  pw_hypo h, fine;
  totals heun = {0}, three = {0}, tight = {0};
  pw_hypo_point a, b, c;
  derive(1e-3, &h);
  derive(1e-9, &fine);
  cycles(&h, 1, false, &a, &heun);
  cycles(&h, 1, true, &b, &three);
  cycles(&fine, 4, true, &c, &tight); /* the trapezoidal rule needs small increments */
  print_message("%d cycles: Heun %.1e, three stages %.1e; work %.6g, %.6g, tight %.6g J/m3\n",
                CYCLES, distance(&h, &a, &c), distance(&h, &b, &c), heun.work, three.work,
                tight.work);
  assert_true(heun.counts.rhs < 5 * CYCLES * STEPS); /* less than 2.5 an increment */
  assert_true(distance(&h, &a, &c) < 1e-4);
  assert_true(tight.work > 0.0); /* dissipated */
  assert_relative(heun.work, tight.work, 1e-3);
}

/** The step is of second order: half the increments, a quarter of the error. */
static void second_order(void **unused)
{
  (void)unused;
  pw_hypo h, fine;
  const pw_t6 direction = {.xx = 0.4, .yy = -0.7, .xy = 0.4};
  double error[2];
  pw_hypo_point c = start();
  totals unused_totals = {0};
  derive(1e-3, &h);
  derive(1e-10, &fine);
  c.delta = (pw_t6){.xx = 2e-5, .yz = 3e-5};
  pw_hypo_point from = c;
  walk(&fine, pw_t6_scale(1e-6, direction), 80, true, &c, &unused_totals);
  for (int k = 0; k < 2; k++) {
    const int n = 160 << k;
    pw_hypo_point a = from;
    totals sum = {0};
    walk(&h, pw_t6_scale(80e-6 / n, direction), n, false, &a, &sum);
    assert_int_equal(sum.counts.rhs, 2 * n);
    error[k] = distance(&h, &a, &c);
  }
  print_message("errors %.2e, %.2e\n", error[0], error[1]);
  assert_true(error[0] / error[1] > 3.5 && error[0] / error[1] < 4.5);
}

/** A recorded step is repeated to the last bit, and is a smooth function of the increment. */
static void repeated_exactly(void **unused)
{
  (void)unused;
  pw_hypo h;
  uint64_t seed = 11;
  pw_hypo_path path;
  int steps = 0;
  derive(1e-3, &h);
  for (int k = 0; k < 200; k++) {
    pw_hypo_point at = start(), once, again;
    pw_real d[6], delta[6], tangent[36];
    for (int c = 0; c < 6; c++) {
      d[c] = 6e-7 * (test_random(&seed) - 0.5);
      delta[c] = 3e-5 * (test_random(&seed) - 0.5);
    }
    at.delta = pw_t6_load(delta, 1);
    once = again = at;
    const pw_t6 de = pw_t6_load(d, 1);
    const double dvol = exp(pw_t6_trace(de));
    assert_int_equal(pw_hypo_integrate(&h, de, dvol, &once, &path, NULL, NULL), PW_OK);
    assert_int_equal(pw_hypo_repeat(&h, de, dvol, &again, &path), PW_OK);
    assert_memory_equal(&once.stress, &again.stress, sizeof once.stress);
    assert_memory_equal(&once.delta, &again.delta, sizeof once.delta);
    if (path.n != 1 || path.kind[0] != PW_HYPO_HEUN) {
      continue;
    }
    steps++;
    pw_hypo_tangent(&h, de, dvol, &at, once.stress, &path, tangent);
    /* the rates are homogeneous in the increment, so the tangent times it is nearly its stress */
    pw_real to[6], from[6];
    pw_t6_store(once.stress, to, 1);
    pw_t6_store(at.stress, from, 1);
    double miss = 0.0, size = 0.0;
    for (int i = 0; i < 6; i++) {
      double sum = 0.0;
      for (int j = 0; j < 6; j++) {
        sum += tangent[6 * i + j] * (j < 3 ? 1.0 : 2.0) * d[j];
      }
      miss += pow(sum - (to[i] - from[i]), 2);
      size += pow(to[i] - from[i], 2);
    }
    assert_true(sqrt(miss) < 0.05 * sqrt(size));
  }
  assert_true(steps > 100);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(long_straight_paths), cmocka_unit_test(cyclic_reversals),
      cmocka_unit_test(second_order), cmocka_unit_test(repeated_exactly)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
