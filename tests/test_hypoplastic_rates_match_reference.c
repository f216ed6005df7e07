/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rates of single states against rhs_samples.csv, 1e-12 relative (reference README, acceptance).
 */
#include "tests/hypoplastic_reference.h"

static double relative(double a, double b)
{
  return b == 0.0 ? fabs(a) : fabs(a - b) / fabs(b);
}

/** f_d = r^alpha of the file, made linear below r = 1e-3, where its slope grows without bound. */
static double regularised(double f_d, double alpha)
{
  double r = pow(f_d, 1.0 / alpha);
  return r >= 1e-3 ? f_d : pow(1e-3, alpha) * r / 1e-3;
}

static void rates_of_samples(void **unused)
{
  (void)unused;
  table t;
  double worst = 0.0, worst_factor = 0.0;
  table_read("rhs_samples.csv", &t);
  assert_int_equal(t.rows, 400);
  for (int row = 0; row < t.rows; row++) {
    pw_real v[PW_HYPO_PARAMS];
    pw_hypo h;
    pw_hypo_rates r;
    reference_set((int)table_get(&t, row, "parset"), 1e-3, v);
    pw_hypo_derive(v, &h);
    pw_hypo_point p = reference_point(&t, row);
    pw_t6 d = table_tensor(&t, row, "D_xx", 1.0);
    pw_hypo_evaluate(&h, &p, d, &r);
    pw_t6 stress = table_tensor(&t, row, "sigdot_xx", 1e3);
    pw_t6 delta = table_tensor(&t, row, "deldot_xx", 1.0);
    double err = pw_t6_norm(pw_t6_axpy(r.stress, -1.0, stress)) / pw_t6_norm(stress);
    err = fmax(err, pw_t6_norm(pw_t6_axpy(r.delta, -1.0, delta)) / pw_t6_norm(delta));
    err = fmax(err, relative(r.void_ratio, table_get(&t, row, "edot")));
    worst = fmax(worst, err);
    err = relative(r.f_b, 1e3 * table_get(&t, row, "f_b"));
    err = fmax(err, relative(r.f_e, table_get(&t, row, "f_e")));
    err = fmax(err, relative(r.f_d, regularised(table_get(&t, row, "f_d"), v[PW_HYPO_ALPHA])));
    err = fmax(err, relative(r.f, table_get(&t, row, "F")));
    worst_factor = fmax(worst_factor, err);
    /* isotropic states have no Lode angle; the file prints cos 3theta to 12 digits */
    if (r.tan_psi > 1e-6) {
      assert_true(relative(r.tan_psi, table_get(&t, row, "tanpsi")) < 1e-11);
      assert_true(fabs(r.cos_3theta - table_get(&t, row, "cos3theta")) < 1e-9);
    }
  }
  print_message("rates %.1e, factors %.1e\n", worst, worst_factor);
  assert_true(worst < 1e-12);
  assert_true(worst_factor < 1e-12);
  table_free(&t);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(rates_of_samples)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
