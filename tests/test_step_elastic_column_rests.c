/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The case elastic_column: at rest the vertical stress of a column of height H, width fixed, is
 * -rho g (H - y) with y the place of the point in the column before it is compressed, whatever the
 * material, and the horizontal one nu/(1 - nu) of it. The points of a cell share its mean strain,
 * so that each of two points above each other is off by gamma h/4 and their mean is not. */
#include "tests/case_helpers.h"

static void stress_is_linear_in_depth(void **state)
{
  (void)state;
  pw_sim *sim = test_case("elastic_column/scene.yaml", 0, NULL);
  const pw_points *p = &sim->points;
  enum { ACROSS = 4, ROWS = 40 };
  const double gamma = 1500.0 * 10.0, height = 10.0, cell = 0.5;
  double row[ROWS] = {0.0}, lateral = 0.0, worst = 0.0, pair = 0.0;
  assert_int_equal(p->n, ACROSS * ROWS);
  test_run_to(sim, 6.0);
  for (pw_idx i = 0; i < p->n; i++) {
    double yy = p->stress[p->ld + i];
    row[p->id[i] / ACROSS] += yy / ACROSS; /* ids run along the rows */
    lateral = fmax(lateral, fabs(p->stress[i] - yy * 0.3 / 0.7));
  }
  for (int k = 0; k < ROWS; k += 2) {
    double middle = -gamma * (height - 0.5 * cell * (k + 1.0));
    pair = fmax(pair, fabs(0.5 * (row[k] + row[k + 1]) - middle));
    worst = fmax(worst, fabs(row[k] - middle + 0.25 * gamma * cell));
    worst = fmax(worst, fabs(row[k + 1] - middle - 0.25 * gamma * cell));
  }
  print_message("%d steps: vertical stress of a point off by %.2e gamma H, of pairs %.2e, "
                "horizontal %.2e\n",
                (int)sim->step, worst / (gamma * height), pair / (gamma * height),
                lateral / (gamma * height));
  assert_true(worst <= 1.1 * 0.25 * gamma * cell);
  assert_true(pair <= 2e-3 * gamma * height);
  assert_true(lateral <= 1e-9 * gamma * height);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stress_is_linear_in_depth),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
