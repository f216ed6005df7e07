/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Biaxial and triaxial reference tests under mixed control: eps_yy from the file, the lateral
 * stress held. Tolerances are those of the acceptance table in reference/hypoplastic/README.md. */
#include "kernels/element_driver.h"
#include "tests/hypoplastic_reference.h"

typedef struct family {
  double tolerance, accept;
  bool triaxial;
} family;

static void start_from(const table *t, const pw_real *v, pw_element *el)
{
  pw_hypo_point p = reference_point(t, 0);
  pw_real stress[6];
  pw_t6_store(p.stress, stress, 1);
  assert_int_equal(pw_element_start(el, pw_material_find("hypoplastic_sand"), v, stress), PW_OK);
  el->state[0] = p.void_ratio;
  if (v[PW_HYPO_INTERGRANULAR] > 0.5) {
    pw_t6_store(p.delta, el->state + 1, 1);
  }
}

static void drive(const char *file, void *ctx)
{
  const family *f = ctx;
  pw_real v[PW_HYPO_PARAMS];
  pw_element el;
  table t;
  table_read(file, &t);
  reference_set_of(file, f->tolerance, v);
  start_from(&t, v, &el);
  pw_element_step step = {.control = {PW_CONTROL_STRESS}};
  step.control[2] = f->triaxial ? PW_CONTROL_STRESS : PW_CONTROL_STRAIN;
  step.value[0] = el.stress[0];
  step.value[2] = f->triaxial ? el.stress[2] : 0.0;
  double worst = 0.0, void_error = 0.0;
  for (int row = 1; row < t.rows; row++) {
    step.value[1] = table_get(&t, row, "eps_yy") - table_get(&t, row - 1, "eps_yy");
    assert_int_equal(pw_element_drive(&el, &step), PW_OK);
    pw_t6 stress = table_tensor(&t, row, "sig_xx", 1e3);
    worst = fmax(worst, stress_error(pw_t6_load(el.stress, 1), stress, v[PW_HYPO_P_T]));
    void_error = fmax(void_error, fabs(el.state[0] - table_get(&t, row, "e")));
  }
  print_message("%-34s tol %.0e: stress %.1e, void ratio %.1e, rhs a row %.1f\n", file,
                f->tolerance, worst, void_error, (double)el.counts.rhs / (t.rows - 1));
  assert_true(worst <= f->accept);
  assert_true(void_error <= f->accept);
  table_free(&t);
}

static void biaxial(void **unused)
{
  (void)unused;
  family coarse = {1e-3, 5e-4, false}, fine = {1e-6, 1e-4, false};
  assert_true(reference_each("a", drive, &coarse) > 0);
  assert_true(reference_each("a", drive, &fine) > 0);
}

static void triaxial(void **unused)
{
  (void)unused;
  family coarse = {1e-3, 5e-4, true}, fine = {1e-6, 1e-4, true};
  assert_true(reference_each("c_", drive, &coarse) > 0);
  assert_true(reference_each("c_", drive, &fine) > 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(biaxial), cmocka_unit_test(triaxial)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
