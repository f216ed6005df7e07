/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finite simple shear to gamma = 2 with the Zaremba-Jaumann rate on stress and intergranular
 * strain, against the reference; and rigid rotation, which may change no invariant. */
#include "kernels/element_driver.h"
#include "tests/hypoplastic_reference.h"

typedef struct division {
  int pieces;   /* of each row */
  double worst; /* error found */
} division;

/** Drive gamma of the file through the material's own update: rotation, then strain. */
static void simple_shear(const char *file, void *ctx)
{
  division *d = ctx;
  pw_real v[PW_HYPO_PARAMS], stress[6];
  pw_element el;
  table t;
  table_read(file, &t);
  reference_set_of(file, 1e-5, v);
  pw_t6_store(reference_point(&t, 0).stress, stress, 1);
  assert_ok(pw_element_start(&el, pw_material_find("hypoplastic_sand"), v, stress));
  el.state[0] = table_get(&t, 0, "e");
  for (int row = 1; row < t.rows; row++) {
    double eps = table_get(&t, row, "eps_xy") - table_get(&t, row - 1, "eps_xy");
    /* v_x = gamma_dot y: D_xy = W_xy = gamma_dot / 2 */
    const pw_real de[6] = {0, 0, 0, eps / d->pieces, 0, 0}, spin[3] = {eps / d->pieces, 0, 0};
    for (int k = 0; k < d->pieces; k++) {
      assert_ok(pw_element_move(&el, de, spin, NULL));
    }
    pw_t6 expected = table_tensor(&t, row, "sig_xx", 1e3);
    d->worst = fmax(d->worst, stress_error(pw_t6_load(el.stress, 1), expected, v[PW_HYPO_P_T]));
    assert_near(el.state[0], table_get(&t, row, "e"), 1e-12);
  }
  table_free(&t);
}

/** The error is that of rotation and strain taken one after the other: of first order. */
static void simple_shear_converges(void **unused)
{
  (void)unused;
  division one = {1, 0.0}, eight = {8, 0.0};
  assert_true(reference_each("g_", simple_shear, &one) > 0);
  (void)reference_each("g_", simple_shear, &eight);
  print_message("simple shear: %.2e with rows of 0.25 %%, %.2e with an eighth\n", one.worst,
                eight.worst);
  assert_true(one.worst < 1e-3);
  assert_true(eight.worst < 1.5e-4);
}

static void invariants(const pw_real *a, double *out)
{
  pw_t6 t = pw_t6_load(a, 1);
  out[0] = pw_t6_trace(t);
  out[1] = pw_t6_norm(t);
  out[2] = cbrt(pw_t6_det(t));
}

/** Ten turns about an axis in general position and about z. */
static void rigid_rotation_keeps_invariants(void **unused)
{
  (void)unused;
  const double axis[2][3] = {{1.0, 0.0, 0.0}, {0.48, -0.64, 0.6}};
  const pw_real stress[6] = {-1e5, -2e5, -1.5e5, 3e4, -2e4, 1e4};
  for (int k = 0; k < 2; k++) {
    pw_real v[PW_HYPO_PARAMS], before[3], after[3], delta_before[3], delta_after[3];
    pw_element el;
    reference_set(0, 1e-3, v);
    assert_ok(pw_element_start(&el, pw_material_find("hypoplastic_sand"), v, stress));
    const pw_real delta[6] = {1e-5, -2e-5, 5e-6, 8e-6, -4e-6, 1e-5}, none[6] = {0};
    memcpy(el.state + PW_HYPO_STATE_DELTA, delta, sizeof delta);
    invariants(el.stress, before);
    invariants(el.state + PW_HYPO_STATE_DELTA, delta_before);
    pw_real spin[3];
    const int steps = 10000;
    for (int c = 0; c < 3; c++) { /* the angle of a step is 2 atan(|w| / 2) */
      spin[c] = axis[k][c] * 2.0 * tan(0.5 * 20.0 * 3.14159265358979323846 / steps);
    }
    for (int i = 0; i < steps; i++) {
      assert_ok(pw_element_move(&el, none, spin, NULL));
    }
    invariants(el.stress, after);
    invariants(el.state + PW_HYPO_STATE_DELTA, delta_after);
    for (int c = 0; c < 3; c++) {
      assert_relative(after[c], before[c], 1e-10);
      assert_relative(delta_after[c], delta_before[c], 1e-10);
    }
    for (int c = 0; c < 6; c++) { /* whole turns: every component is back */
      assert_near(el.stress[c], stress[c], 1e-10 * 2e5);
      assert_near(el.state[PW_HYPO_STATE_DELTA + c], delta[c], 1e-10 * 2e-5);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(simple_shear_converges),
                                     cmocka_unit_test(rigid_rotation_keeps_invariants)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
