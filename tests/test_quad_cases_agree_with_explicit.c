/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cases that are run by explicit steps, run by implicit ones with one key changed: the elastic
 * column settles as far, and the biaxial test of sand follows the reference curve of the material
 * (reference/hypoplastic/a1_biaxial_e065.csv: peak q = 309.133 kPa at eps_yy = -0.0287). */
#include "engine/step_implicit.h"
#include "tests/case_helpers.h"
#include "tests/hypoplastic_reference.h"

static pw_sim *run_case(const char *file, int nset, const char *const *set)
{
  pw_sim *sim = test_case(file, nset, set);
  const pw_real end = sim->scene.time.end_s;
  while (sim->time < end * (1.0 - 1e-12)) {
    assert_ok(pw_sim_step(sim, end - sim->time));
  }
  return sim;
}

static void elastic_column_settles_as_far(void **state)
{
  (void)state;
  const char *const set[] = {"method.update=implicit"};
  pw_sim *moving = run_case("elastic_column/scene.yaml", 0, NULL);
  pw_sim *still = run_case("elastic_column/scene.yaml", 1, set);
  const double a = 5.0 - test_history(moving, "soil_y_m");
  const double b = 5.0 - test_history(still, "soil_y_m");
  print_message("settlement of the mean: explicit %.6g m in %d steps, implicit %.6g m in %d\n", a,
                (int)moving->step, b, (int)still->step);
  assert_relative(b, a, 0.002);
  assert_relative(test_history(still, "boundary_0_force_y_n"), 1500.0 * 10.0 * 10.0, 1e-9);
  pw_sim_destroy(&moving);
  pw_sim_destroy(&still);
}

static void sand_follows_its_curve(void **state)
{
  (void)state;
  const char *const set[] = {"method.update=implicit", "implicit.steps=400",
                             "implicit.tolerance=1e-6"};
  double peak = 0.0, at = 0.0, worst = 0.0;
  table t;
  table_read("a1_biaxial_e065.csv", &t);
  const int strain = table_column(&t, "eps_yy"), stress = table_column(&t, "sig_yy");
  pw_sim *sim = test_case("biaxial_test/scene.yaml", 3, set);
  const pw_points *p = &sim->points;
  for (int row = 1; sim->time < 200.0;) {
    assert_ok(pw_sim_step(sim, 0.0));
    const double y = log(2.0 * p->x[p->ld]), q = p->stress[0] - p->stress[p->ld];
    at = q > peak ? y : at;
    peak = fmax(peak, q);
    while (row + 1 < t.rows && t.value[row * t.columns + strain] > y) {
      row++;
    }
    const double *now = t.value + row * t.columns, *before = now - t.columns;
    const double part = (y - before[strain]) / (now[strain] - before[strain]);
    const double expected = -1e3 * (before[stress] + part * (now[stress] - before[stress])) - 1e5;
    worst = part >= 0.0 && part <= 1.0 ? fmax(worst, fabs(q - expected) / 1e5) : worst;
  }
  print_message(
      "%d steps, %d iterations: peak q %.3f kPa at %.5f, at most %.2e p0 from the curve\n",
      (int)sim->step, (int)sim->quad->iterations, 1e-3 * peak, at, worst);
  assert_int_equal(sim->step, 400);
  assert_relative(peak, 309.133e3, 1e-3);
  assert_near(at, -0.0287, 1e-4);
  assert_true(worst <= 5e-3);
  pw_sim_destroy(&sim);
  table_free(&t);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(elastic_column_settles_as_far),
      cmocka_unit_test(sand_follows_its_curve),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
