/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random increments of every size on the default limits: no NaN, stress within its limits, void
 * ratio exact; stress-free points cost about one substep. */
#include "kernels/element_driver.h"
#include "tests/hypoplastic_reference.h"

static void default_limits(pw_hypo *h, bool intergranular)
{
  pw_real v[PW_HYPO_PARAMS];
  reference_set(0, 1e-3, v);
  v[PW_HYPO_P_MIN] = 100.0;
  v[PW_HYPO_INTERGRANULAR] = intergranular ? 1.0 : 0.0;
  pw_hypo_derive(v, h);
}

/** A direction of unit norm whose trace pulls the void ratio back into 0.4 .. 1.2. */
static pw_t6 direction(uint64_t *seed, double e)
{
  pw_real a[6];
  for (int c = 0; c < 6; c++) {
    a[c] = test_random(seed) - 0.5;
  }
  pw_t6 d = pw_t6_load(a, 1);
  double pull = e > 1.2 ? -1.0 : (e < 0.4 ? 1.0 : 0.0);
  d = pull == 0.0 ? d : pw_t6_shift(d, pull * fabs(pw_t6_trace(d)) - pw_t6_trace(d) / 3.0);
  return pw_t6_scale(1.0 / pw_t6_norm(d), d);
}

static void torture(double size, int count, bool intergranular, pw_material_counts *n)
{
  pw_hypo h;
  uint64_t seed = 20;
  pw_hypo_point p = {.stress = {.xx = -1e5, .yy = -1e5, .zz = -1e5}, .void_ratio = 0.65};
  p.substep = 1.0;
  default_limits(&h, intergranular);
  for (int i = 0; i < count; i++) {
    pw_t6 de = pw_t6_scale(size, direction(&seed, p.void_ratio));
    pw_real dvol = exp(pw_t6_trace(de)), e = p.void_ratio, modulus = -1.0;
    assert_int_equal(pw_hypo_integrate(&h, de, dvol, &p, NULL, n, &modulus), PW_OK);
    assert_true(pw_t6_is_finite(p.stress) > 0.0 && pw_t6_is_finite(p.delta) > 0.0);
    pw_t6 shifted = pw_t6_shift(p.stress, -h.p_t);
    assert_true(-pw_t6_trace(shifted) / 3.0 >= h.p_min * (1.0 - 1e-9));
    assert_true(pw_hypo_friction_angle(shifted) <= 60.0001 * 3.14159265358979 / 180.0);
    assert_true(pw_t6_norm(p.delta) <= h.r * (1.0 + 1e-12));
    assert_near(p.void_ratio, (1.0 + e) * dvol - 1.0, 1e-14);
    assert_true(p.substep > 0.0 && p.substep <= 1.0);
    assert_true(modulus >= 0.0 && modulus < 1e12);
  }
}

static void random_increments_of_every_size(void **unused)
{
  (void)unused;
  const double size[4] = {1e-5, 1e-4, 1e-3, 1e-2};
  /* means of an independent program: 3.5, 14, 37, 132 */
  const double most[4] = {5.0, 20.0, 50.0, 160.0};
  for (int with = 0; with < 2; with++) {
    for (int k = 0; k < 4; k++) {
      pw_material_counts n = {0};
      const int count = k == 3 ? 5000 : 20000;
      torture(size[k], count, with, &n);
      double mean = (double)n.substeps / count;
      print_message("%.0e, intergranular strain %d: substeps %.2f, rhs %.2f, forced %.2g, cut off "
                    "%.2g a substep\n",
                    size[k], with, mean, (double)n.rhs / count,
                    (double)n.forced / (double)n.substeps, (double)n.cut_off / (double)n.substeps);
      assert_true(mean < most[k]);
      assert_true((double)n.forced <= 0.01 * (double)n.substeps);
    }
  }
}

/** Extension of a stress-free point: about one substep an increment, whatever its size. */
static void stress_free_points_are_cheap(void **unused)
{
  (void)unused;
  const double size[3] = {1e-6, 1e-4, 1e-3};
  for (int k = 0; k < 3; k++) {
    pw_hypo h;
    pw_material_counts n = {0};
    uint64_t seed = 7;
    default_limits(&h, true);
    pw_hypo_point p = {.stress = {.xx = 1500, .yy = 1500, .zz = 1500}, .void_ratio = 0.7};
    p.substep = 1.0;
    const int count = 100;
    for (int i = 0; i < count; i++) {
      pw_t6 de = pw_t6_scale(size[k], pw_t6_shift(direction(&seed, 0.7), 1.0));
      assert_int_equal(pw_hypo_integrate(&h, de, exp(pw_t6_trace(de)), &p, NULL, &n, NULL), PW_OK);
      assert_near(pw_t6_trace(p.stress) / 3.0, 1500.0, 1e-6);
    }
    print_message("stress-free, %.0e: substeps %.2f, rhs %.2f\n", size[k],
                  (double)n.substeps / count, (double)n.rhs / count);
    assert_true((double)n.substeps <= 1.2 * count);
  }
}

/** Oedometric extension by 2 % and recompression: the void ratio comes back, stress returns only
 *  when the soil is as dense as when it left. */
static void extension_and_recompression(void **unused)
{
  (void)unused;
  pw_hypo h;
  default_limits(&h, true);
  pw_hypo_point p = {.stress = {.xx = -5e4, .yy = -1e5, .zz = -5e4}, .void_ratio = 0.65};
  p.substep = 1.0;
  for (int i = 0; i < 4400; i++) {
    double eps = i < 2000 ? 1e-5 : -1e-5;
    pw_t6 de = {.yy = eps};
    assert_int_equal(pw_hypo_integrate(&h, de, exp(eps), &p, NULL, NULL, NULL), PW_OK);
    if (i == 1999) {
      assert_near(pw_t6_trace(p.stress) / 3.0, 1500.0, 1e-6);
    }
  }
  assert_near(p.void_ratio, 1.65 * exp(-0.004) - 1.0, 1e-12);
  assert_true(p.stress.yy < -1e5);
}

static void impossible_increments_are_refused(void **unused)
{
  (void)unused;
  pw_hypo h;
  default_limits(&h, true);
  const pw_hypo_point start = {
      .stress = {-1e5, -1e5, -1e5, 0, 0, 0}, .void_ratio = 0.65, .substep = 1.0};
  const struct {
    pw_t6 de;
    double dvol;
  } bad[] = {{{.yy = -0.6}, 0.6}, /* below 1 / 1.65: no voids left */
             {{.yy = -0.1}, 0.0}, {{.yy = -0.1}, -1.0},   {{.yy = NAN}, 1.0},
             {{.yy = -0.1}, NAN}, {{.xy = INFINITY}, 1.0}};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    pw_hypo_point p = start;
    assert_int_equal(pw_hypo_integrate(&h, bad[i].de, bad[i].dvol, &p, NULL, NULL, NULL),
                     PW_RETRY_STRESS);
    assert_memory_equal(&p, &start, sizeof p);
  }
}

/** One oedometric increment of 1 % and of 5 %, against small ones, within 0.5 %. */
static void large_increments_in_one_step(void **unused)
{
  (void)unused;
  pw_real v[PW_HYPO_PARAMS];
  pw_hypo h;
  const double sizes[2] = {0.01, 0.05};
  reference_set(0, 1e-4, v);
  pw_hypo_derive(v, &h);
  for (int k = 0; k < 2; k++) {
    pw_material_counts n = {0};
    pw_hypo_point one = {.stress = {.xx = -1e5, .yy = -1e5, .zz = -1e5}, .void_ratio = 0.65};
    one.substep = 1.0;
    pw_hypo_point many = one;
    pw_t6 de = {.yy = -sizes[k]};
    assert_int_equal(pw_hypo_integrate(&h, de, exp(de.yy), &one, NULL, &n, NULL), PW_OK);
    de.yy /= 5000;
    for (int i = 0; i < 5000; i++) {
      assert_int_equal(pw_hypo_integrate(&h, de, exp(de.yy), &many, NULL, NULL, NULL), PW_OK);
    }
    print_message("one increment of %g: sigma_yy %.6g kPa (small ones %.6g), substeps %d\n",
                  sizes[k], 1e-3 * one.stress.yy, 1e-3 * many.stress.yy, (int)n.substeps);
    assert_true(n.forced <= 1); /* the first substep from delta = 0 */
    assert_relative(one.stress.yy, many.stress.yy, 5e-3);
    assert_relative(one.stress.xx, many.stress.xx, 5e-3);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(random_increments_of_every_size),
                                     cmocka_unit_test(stress_free_points_are_cheap),
                                     cmocka_unit_test(extension_and_recompression),
                                     cmocka_unit_test(impossible_increments_are_refused),
                                     cmocka_unit_test(large_increments_in_one_step)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
