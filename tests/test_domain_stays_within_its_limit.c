/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CPDI domains that follow large deformations: half diagonals never exceed the limit (Homel and
 * others 2016), degenerate domains are rebuilt as squares, and the deformation gradient that the
 * material sees is not touched. */
#include "tests/engine_helpers.h"

#include "engine/domain.h"

static pw_sim *one_block(double limit_cells)
{
  static pw_scene s;
  pw_scene_default(&s);
  test_grid(&s, (double[]){0.0, 4.0, 0.0, 4.0}, 0.5);
  int m = test_elastic(&s, 1e6, 0.3, 1000.0);
  test_rectangle(&s, m, (double[]){1.0, 3.0, 1.0, 3.0}, 0.25);
  s.method.domain_limit_cells = limit_cells;
  return test_sim(&s, 1);
}

static void set_gradient(pw_points *p, pw_idx i, const double f[4])
{
  for (int k = 0; k < 4; k++) {
    p->def_grad[k * p->ld + i] = f[k];
  }
  p->vol[i] = 0.0625 * (f[0] * f[3] - f[1] * f[2]);
}

static double half_diagonal(const pw_points *p, pw_idx i, int sign)
{
  return hypot(p->half[i] + sign * p->half[2 * p->ld + i],
               p->half[p->ld + i] + sign * p->half[3 * p->ld + i]);
}

/* Without reaching the limit, r = F r0 exactly. */
static void small_deformations_are_followed(void **state)
{
  (void)state;
  pw_sim *sim = one_block(1.0);
  pw_points *p = &sim->points;
  pw_block_sums sums = {0};
  set_gradient(p, 0, (double[]){1.2, 0.3, -0.1, 0.9});
  pw_domain_convect(sim, NULL, 0, p->n, &sums);
  assert_near(p->half[0], 1.2 * 0.125, 1e-15);
  assert_near(p->half[p->ld], -0.1 * 0.125, 1e-15);
  assert_near(p->half[2 * p->ld], 0.3 * 0.125, 1e-15);
  assert_near(p->half[3 * p->ld], 0.9 * 0.125, 1e-15);
  assert_int_equal(sums.limited, 0);
  pw_sim_destroy(&sim);
}

/* Simple shear to gamma = 20 and a stretch of 30 along r1. */
static void long_domains_are_shortened(void **state)
{
  (void)state;
  pw_sim *sim = one_block(1.0);
  pw_points *p = &sim->points;
  pw_block_sums sums = {0};
  set_gradient(p, 0, (double[]){1.0, 20.0, 0.0, 1.0});
  set_gradient(p, 1, (double[]){30.0, 0.0, 0.0, 1.0 / 30.0});
  pw_domain_convect(sim, NULL, 0, p->n, &sums);
  assert_int_equal(sums.limited, 2);
  for (pw_idx i = 0; i < 2; i++) {
    for (int sign = -1; sign <= 1; sign += 2) {
      assert_true(half_diagonal(p, i, sign) <= 0.5 * (1.0 + 1e-12));
    }
    assert_true(p->half[i] * p->half[3 * p->ld + i] > p->half[p->ld + i] * p->half[2 * p->ld + i]);
  }
  assert_near(p->def_grad[p->ld], 20.0, 0.0);
  pw_sim_destroy(&sim);
}

/* Sheared until both diagonals fall together, the domain becomes a square of its area, and goes on
 * from there: F r0 with the new r0 is that square. */
static void degenerate_domains_are_rebuilt(void **state)
{
  (void)state;
  pw_sim *sim = one_block(1.0);
  pw_points *p = &sim->points;
  pw_block_sums sums = {0};
  set_gradient(p, 0, (double[]){1.0, 3e4, 0.0, 1.0});
  pw_domain_convect(sim, NULL, 0, p->n, &sums);
  assert_int_equal(sums.rebuilt, 1);
  double area = 4.0 * (p->half[0] * p->half[3 * p->ld] - p->half[p->ld] * p->half[2 * p->ld]);
  assert_relative(area, 0.0625, 1e-12);
  sums = (pw_block_sums){0};
  pw_domain_convect(sim, NULL, 0, p->n, &sums);
  assert_int_equal(sums.limited, 0);
  assert_near(p->half[0], 0.125, 1e-12);
  assert_near(p->half[2 * p->ld], 0.0, 1e-9);
  pw_sim_destroy(&sim);
}

/* Above the aspect allowed a domain gets the area of its material and just that aspect along its
 * own principal directions; a second look finds nothing to do. */
static void slender_domains_are_reshaped(void **state)
{
  (void)state;
  pw_sim *sim = one_block(2.0);
  sim->scene.method.domain_aspect_max = 2.0;
  pw_points *p = &sim->points;
  pw_block_sums sums = {0};
  const double c = cos(0.4), s = sin(0.4), longer = 0.125 * sqrt(2.0), shorter = 0.125 / sqrt(2.0);
  set_gradient(p, 0, (double[]){3.0, 0.0, 0.0, 1.0 / 3.0});
  set_gradient(p, 1, (double[]){3.0 * c, -s / 3.0, 3.0 * s, c / 3.0});
  set_gradient(p, 2, (double[]){1.3, 0.2, 0.1, 0.9});
  for (int again = 0; again < 2; again++) {
    pw_domain_convect(sim, NULL, 0, p->n, &sums);
    assert_int_equal(sums.reshaped, 2);
    assert_near(p->half[0], longer, 1e-14);
    assert_near(p->half[3 * p->ld], shorter, 1e-14);
    const double r[4] = {longer * c, longer * s, -shorter * s, shorter * c};
    for (int k = 0; k < 4; k++) {
      assert_near(p->half[k * p->ld + 1], r[k], 1e-14);
    }
    assert_near(p->half[2], 1.3 * 0.125, 1e-15);
  }
  assert_near(p->def_grad[0], 3.0, 0.0);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(small_deformations_are_followed),
      cmocka_unit_test(long_domains_are_shortened),
      cmocka_unit_test(degenerate_domains_are_rebuilt),
      cmocka_unit_test(slender_domains_are_reshaped),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
