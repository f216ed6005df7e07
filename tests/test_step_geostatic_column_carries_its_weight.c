/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The case geostatic_column with cells of 0.25 m: ten metres of hypoplastic sand get their weight
 * in 2 s. An independent program, undamped: vertical stress with an rms error of about 1.5 % of
 * gamma H, K0 of 0.44 to 0.45. Damped: 157.6 kPa = gamma H at the base, within 2 %. */
#include "tests/case_helpers.h"

static const char *const coarse[] = {"grid.cell_m=0.25", "grid.size_m=[0.25,10.5]",
                                     "bodies.soil.x_m=[0,0.25]", "bodies.soil.point_size_m=0.125"};

static const double gamma_h = 2600.0 / 1.65 * 10.0 * 10.0; /* Pa */

typedef struct {
  double rms;  /* error of the vertical stress, of gamma H */
  double k0;   /* sum of the horizontal over sum of the vertical stresses */
  double base; /* vertical stress of the lowest points; Pa */
} at_rest;

static at_rest measure(const pw_sim *sim)
{
  const pw_points *p = &sim->points;
  double square = 0.0, horizontal = 0.0, vertical = 0.0;
  at_rest r = {0.0, 0.0, 0.0};
  for (pw_idx i = 0; i < p->n; i++) {
    double yy = p->stress[p->ld + i], depth = 10.0 - p->x[p->ld + i];
    double error = yy / gamma_h + 0.1 * depth;
    square += error * error;
    horizontal += p->stress[i];
    vertical += yy;
    r.base = fmin(r.base, yy);
  }
  r.rms = sqrt(square / p->n);
  r.k0 = horizontal / vertical;
  return r;
}

static void undamped(void **state)
{
  (void)state;
  pw_sim *sim = test_case("geostatic_column/undamped.yaml", 4, coarse);
  test_run_to(sim, 2.0);
  at_rest r = measure(sim);
  print_message("undamped: rms error %.2f %% of gamma H, K0 %.4f\n", 100.0 * r.rms, r.k0);
  assert_near(r.rms, 0.015, 0.005);
  assert_true(r.k0 >= 0.44 && r.k0 <= 0.45);
  pw_sim_destroy(&sim);
}

static void damped(void **state)
{
  (void)state;
  pw_sim *sim = test_case("geostatic_column/damped.yaml", 4, coarse);
  test_run_to(sim, 3.0);
  at_rest r = measure(sim);
  print_message("damped: rms error %.2f %% of gamma H, K0 %.4f, lowest points %.2f kPa\n",
                100.0 * r.rms, r.k0, 1e-3 * r.base);
  assert_relative(r.base, -157.6e3, 0.02);
  assert_true(r.rms <= 0.015);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(undamped),
      cmocka_unit_test(damped),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
