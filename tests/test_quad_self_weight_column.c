/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene of the program, the column that its own weight compacts to less than half its height in 40
 * implicit steps, on the grid: 50 m, rho0 = 80, g = 10, E = 1e4 Pa, nu = 0, two points in a cell.
 * Exact: sigma = -rho0 g (H - Y) whatever the material. The errors expected of each basis, sum
 * |sigma - exact| V0 / (rho0 g H sum V0), are those of an independent one-dimensional program (see
 * tests/test_self_weight_column_converges.c, which solves the same with its own equations). */
#include "tests/case_helpers.h"
#include "tests/quad_helpers.h"

static const double height = 50.0, weight = 800.0;

/* Runs the column: error of the stresses, and the upper edge of the highest domain. */
static double compact(pw_sim *sim, double h, double *top)
{
  const pw_points *p = &sim->points;
  double *begin = calloc((size_t)p->n, sizeof *begin), sum = 0.0, volume = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    begin[p->id[i]] = p->x[p->ld + i];
  }
  test_quad_run(sim);
  *top = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    const double volume0 = p->mass[i] / 80.0, y = begin[p->id[i]];
    sum += volume0 * fabs(p->stress[p->ld + i] + weight * (height - y));
    volume += volume0;
    *top = fmax(*top, p->x[p->ld + i] + 0.25 * h * p->def_grad[3 * p->ld + i]);
  }
  assert_int_equal(sim->step, 40);
  assert_int_equal(sim->quad->cuts, 0);
  pw_sim_destroy(&sim);
  free(begin);
  return sum / volume / (weight * height);
}

static double settle(int basis, int cells, double *top)
{
  static pw_scene s;
  const double h = height / cells;
  test_quad_scene(&s, PW_PLANE, basis, (pw_real[]){0.0, 2.0 * h, 0.0, height + h}, h, 40);
  const int m = test_hencky(&s, 1e4, 0.0, 80.0, 1e12);
  test_rectangle(&s, m, (pw_real[]){0.0, 2.0 * h, 0.0, height}, 0.5 * h);
  test_gravity(&s, 1.0)->acceleration_m_s2 = 10.0;
  test_roller(&s, PW_SIDE_LEFT);
  test_roller(&s, PW_SIDE_RIGHT);
  test_roller(&s, PW_SIDE_BOTTOM);
  return compact(test_sim(&s, 1), h, top);
}

static void errors_are_those_of_the_basis(void **state)
{
  (void)state;
  enum { LEVELS = 4 };
  static const double expected[3][LEVELS] = {{6.33e-2, 9.70e-2, 8.67e-2, 8.01e-2},
                                             {1.09e-1, 5.70e-2, 2.96e-2, 1.77e-2},
                                             {2.79e-2, 9.02e-3, 2.57e-3, 8.02e-4}};
  for (int basis = PW_LINEAR; basis <= PW_CPDI; basis++) {
    double error[LEVELS], top = 0.0;
    for (int i = 0; i < LEVELS; i++) {
      error[i] = settle(basis, 4 << i, &top);
      print_message("%s, %d cells: error %.4g, expected %.4g; top %.4f m\n", test_basis_name[basis],
                    4 << i, error[i], expected[basis][i], top);
    }
    for (int i = 0; i < LEVELS; i++) {
      assert_relative(error[i], expected[basis][i], 0.03);
      assert_true(basis != PW_CPDI || i == 0 || log2(error[i - 1] / error[i]) >= 1.6);
    }
    assert_true(basis != PW_CPDI || fabs(top - 24.05965) < 0.01); /* exact height */
  }
}

static void the_case_is_that_column(void **state)
{
  (void)state;
  static const double expected[3] = {8.01e-2, 1.77e-2, 8.02e-4};
  for (int basis = PW_LINEAR; basis <= PW_CPDI; basis++) {
    char set[64];
    double top;
    snprintf(set, sizeof set, "method.basis=%s", test_basis_name[basis]);
    const double error =
        compact(test_case("self_weight_column/grid.yaml", 1, (const char *[]){set}), 1.5625, &top);
    print_message("case, %s: error %.4g\n", test_basis_name[basis], error);
    assert_relative(error, expected[basis], 0.005);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(errors_are_those_of_the_basis),
      cmocka_unit_test(the_case_is_that_column),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
