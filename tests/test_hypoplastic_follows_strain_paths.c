/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Strain-driven reference paths, row by row (rows are straight strain increments). Tolerances are
 * those of the acceptance table in reference/hypoplastic/README.md. */
#include "tests/hypoplastic_reference.h"

typedef struct family {
  double tolerance, accept;
  double floor; /* added to the reference's size; Pa */
} family;

static double error_of(pw_t6 stress, pw_t6 reference, const pw_hypo *h, double floor)
{
  double size = pw_t6_norm(pw_t6_shift(reference, -h->p_t));
  return pw_t6_norm(pw_t6_axpy(stress, -1.0, reference)) / (size + floor);
}

static void replay(const char *file, void *ctx)
{
  const family *f = ctx;
  pw_real v[PW_HYPO_PARAMS];
  pw_hypo h;
  table t;
  pw_material_counts counts = {0};
  table_read(file, &t);
  assert_true(t.rows > 1);
  reference_set_of(file, f->tolerance, v);
  pw_hypo_derive(v, &h);
  pw_hypo_point p = reference_point(&t, 0);
  double worst = 0.0, void_error = 0.0;
  pw_t6 before = table_tensor(&t, 0, "eps_xx", 1.0);
  for (int row = 1; row < t.rows; row++) {
    pw_t6 eps = table_tensor(&t, row, "eps_xx", 1.0);
    pw_t6 de = pw_t6_axpy(eps, -1.0, before);
    before = eps;
    assert_int_equal(pw_hypo_integrate(&h, de, exp(pw_t6_trace(de)), &p, NULL, &counts, NULL),
                     PW_OK);
    worst = fmax(worst, error_of(p.stress, table_tensor(&t, row, "sig_xx", 1e3), &h, f->floor));
    void_error = fmax(void_error, fabs(p.void_ratio - table_get(&t, row, "e")));
  }
  print_message("%-38s tol %.0e: %.1e, rhs a row %.1f\n", file, f->tolerance, worst,
                (double)counts.rhs / (t.rows - 1));
  /* from delta = 0, where rho^beta_r has an infinite slope, one smallest substep may be forced */
  assert_true(counts.forced <= 1);
  assert_int_equal(counts.cut_off, 0);
  assert_true(worst <= f->accept);
  assert_true(void_error < 1e-8);
  table_free(&t);
}

static int replay_family(const char *prefix, double coarse, double fine, double floor)
{
  family loose = {1e-3, coarse, floor}, tight = {1e-6, fine, floor};
  return reference_each(prefix, replay, &loose) + reference_each(prefix, replay, &tight);
}

static void smooth_and_cyclic_paths(void **unused)
{
  (void)unused;
  const char *const prefix[] = {"b", "d_", "i_", "e1_", "e2_", "e3_"};
  for (int i = 0; i < 6; i++) {
    assert_true(replay_family(prefix[i], 5e-4, 1e-5, 0.0) > 0);
  }
}

/** Down to p* = 10 Pa, where stress goes to zero as a power of strain: the error is measured as
 *  the integration controls it, against the stress plus 1 kPa. */
static void extension_to_the_apex(void **unused)
{
  (void)unused;
  assert_true(replay_family("h_", 5e-4, 1e-5, 1000.0) > 0);
}

static void random_increments(void **unused)
{
  (void)unused;
  assert_true(replay_family("f1_", 1e-2, 2e-5, 0.0) > 0);
  assert_true(replay_family("f3_", 3e-2, 1e-4, 0.0) > 0);
  (void)replay_family("f2_", 3e-2, 1e-4, 0.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(smooth_and_cyclic_paths),
                                     cmocka_unit_test(extension_to_the_apex),
                                     cmocka_unit_test(random_increments)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
