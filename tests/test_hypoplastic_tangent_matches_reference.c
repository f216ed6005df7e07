/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Algorithmic tangent by one-sided differences against the exact matrices of
 * tangent_samples.csv: 1e-3 relative Frobenius at tolerance 1e-6 (reference README). */
#include "tests/hypoplastic_reference.h"

/** Place of our components xx yy zz xy yz zx in the file's order xx yy zz xy xz yz. */
static const int place[6] = {0, 1, 2, 3, 5, 4};

static double frobenius_error(const pw_real *tangent, const table *t, int row)
{
  const double *exact = t->value + row * t->columns + table_column(t, "D11");
  double off = 0.0, size = 0.0;
  for (int i = 0; i < 6; i++) {
    for (int j = 0; j < 6; j++) {
      double d = 1e3 * exact[6 * place[i] + place[j]], diff = tangent[6 * i + j] - d;
      off += diff * diff;
      size += d * d;
    }
  }
  return sqrt(off / size);
}

/** Between e_d and e_d + 1e-3 (e_c - e_d) our f_d falls linearly to 0; that of the file is a
 *  power whose slope grows without bound. 0 there, 1 above, -1 below. */
static int side_of_e_d(const pw_hypo *h, const pw_hypo_point *p)
{
  pw_hypo_rates r;
  pw_hypo_evaluate(h, p, (pw_t6){.xx = 1.0}, &r);
  return r.f_d >= pow(1e-3, h->alpha) ? 1 : (r.f_d > 0.0 ? 0 : -1);
}

static void tangent_of_samples(void **unused)
{
  (void)unused;
  static pw_hypo_path path;
  double worst = 0.0, worst_stress = 0.0;
  int left_out = 0;
  table t;
  table_read("tangent_samples.csv", &t);
  assert_int_equal(t.rows, 120);
  for (int row = 0; row < t.rows; row++) {
    pw_real v[PW_HYPO_PARAMS], tangent[36];
    pw_hypo h;
    reference_set((int)table_get(&t, row, "parset"), 1e-6, v);
    pw_hypo_derive(v, &h);
    pw_hypo_point start = reference_point(&t, row), end = start;
    pw_t6 de = table_tensor(&t, row, "dE_xx", 1.0);
    pw_real dvol = exp(pw_t6_trace(de));
    assert_int_equal(pw_hypo_integrate(&h, de, dvol, &end, &path, NULL, NULL), PW_OK);
    pw_hypo_tangent(&h, de, dvol, &start, end.stress, &path, tangent);
    if (side_of_e_d(&h, &start) * side_of_e_d(&h, &end) != 1) {
      left_out++;
      continue;
    }
    double err = frobenius_error(tangent, &t, row);
    worst = fmax(worst, err);
    worst_stress =
        fmax(worst_stress, stress_error(end.stress, table_tensor(&t, row, "sig1_xx", 1e3), h.p_t));
  }
  print_message("tangent %.1e, stress %.1e, %d left out\n", worst, worst_stress, left_out);
  assert_true(left_out <= 1);
  assert_true(worst < 1e-3);
  assert_true(worst_stress < 1e-5);
  table_free(&t);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(tangent_of_samples)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
