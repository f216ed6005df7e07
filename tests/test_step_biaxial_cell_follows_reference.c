/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The case biaxial_test, one cell run by the explicit dynamics, against the reference curve of the
 * material (reference/hypoplastic/a1_biaxial_e065.csv): peak q = 309.133 kPa at eps_yy = -0.0287,
 * and every row on the way; the lateral stress shows what inertia is worth. */
#include "tests/case_helpers.h"
#include "tests/hypoplastic_reference.h"

static const double rate = 2e-4, pressure = 1e5; /* 1/s, Pa */

typedef struct {
  double peak, peak_at;    /* q in Pa, eps_yy */
  double worst_q, worst_e; /* largest distances from the curve: of the pressure; void ratio */
  double worst_lateral;    /* of the pressure */
} comparison;

/* Compare at the rows of the reference whose strain lies between those of two steps. */
static void compare_rows(const table *t, int *row, const double *before, const double *now,
                         comparison *c)
{
  int strain = table_column(t, "eps_yy"), stress = table_column(t, "sig_yy");
  int void_ratio = table_column(t, "e");
  for (; *row < t->rows; ++*row) {
    const double *r = t->value + *row * t->columns;
    if (r[strain] <= now[0]) {
      return;
    }
    double part = (r[strain] - before[0]) / (now[0] - before[0]);
    double q = before[1] + part * (now[1] - before[1]), e = before[2] + part * (now[2] - before[2]);
    c->worst_q = fmax(c->worst_q, fabs(q - (-1e3 * r[stress] - pressure)) / pressure);
    c->worst_e = fmax(c->worst_e, fabs(e - r[void_ratio]));
  }
}

static void curve_is_that_of_the_material(void **state)
{
  (void)state;
  table t;
  comparison c = {0.0, 0.0, 0.0, 0.0, 0.0};
  table_read("a1_biaxial_e065.csv", &t);
  assert_true(t.rows > 1000);
  pw_sim *sim = test_case("biaxial_test/scene.yaml", 0, NULL);
  const pw_points *p = &sim->points;
  assert_int_equal(p->n, 1);
  double before[3] = {0.0, 0.0, 0.65}, now[3];
  for (int row = 1; sim->time < 200.0;) {
    assert_ok(pw_sim_step(sim, 0.0));
    now[0] = -rate * sim->time; /* logarithmic strain */
    now[1] = p->stress[0] - p->stress[p->ld];
    now[2] = p->state[0];
    compare_rows(&t, &row, before, now, &c);
    c.peak_at = now[1] > c.peak ? now[0] : c.peak_at;
    c.peak = fmax(c.peak, now[1]);
    c.worst_lateral = fmax(c.worst_lateral, fabs(-p->stress[0] / pressure - 1.0));
    memcpy(before, now, sizeof now);
  }
  print_message("%d steps: peak q %.3f kPa at %.5f; at most %.2e p0 and e %.1e from the curve; "
                "lateral stress within %.2e p0\n",
                (int)sim->step, 1e-3 * c.peak, c.peak_at, c.worst_q, c.worst_e, c.worst_lateral);
  assert_relative(c.peak, 309.133e3, 1e-3);
  assert_near(c.peak_at, -0.0287, 1e-4);
  assert_true(c.worst_q <= 2e-3);
  assert_true(c.worst_e <= 2e-5);
  assert_true(c.worst_lateral <= 2e-3);
  pw_sim_destroy(&sim);
  table_free(&t);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(curve_is_that_of_the_material),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
