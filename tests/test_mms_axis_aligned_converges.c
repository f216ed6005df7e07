/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Manufactured solution of a unit square with axis-aligned displacements (verification A3;
 * Sadeghirad, Brannon, Burghardt 2011): u_x = A sin(pi X) sin(c pi t), u_y likewise with the
 * opposite sign, A = 0.05 m, E = 1e7, nu = 0.3, rho = 1000, rollers on four sides, one period.
 * Error: largest L2 norm over the steps of the difference of displacements, over the largest L2
 * norm of the exact one. References: an independent program, 2 points per direction, USL, steps of
 * 0.4 h / c_p. */
#include "tests/engine_helpers.h"

static const double young = 1e7, poisson = 0.3, density = 1e3;

static void mms_scene(pw_scene *s, int basis, int update, int n)
{
  double h = 1.0 / n, c_p;
  pw_scene_default(s);
  s->method.basis = basis;
  s->method.update = update;
  test_grid(s, (double[]){0.0, 1.0, 0.0, 1.0}, h);
  int m = test_neo_hookean(s, young / (3.0 * (1.0 - 2.0 * poisson)), 0.5 * young / (1.0 + poisson),
                           density);
  test_rectangle(s, m, (double[]){0.0, 1.0, 0.0, 1.0}, 0.5 * h);
  pw_body_force_param *force = pw_scene_add_effect(s, "body_force");
  force->body = 0;
  force->kind = PW_MMS_AXIS_ALIGNED;
  force->amplitude_m = 0.05;
  for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_RIGHT; side++) {
    pw_boundary_param *b = pw_scene_add_effect(s, "boundary");
    b->side = side;
    b->fix_x = side == PW_SIDE_LEFT || side == PW_SIDE_RIGHT;
    b->fix_y = !b->fix_x;
  }
  c_p = sqrt(young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson)) / density);
  s->time.dt_s = 0.4 * h / c_p;
}

/* The error at the end of the run, or at the step that failed. */
static double mms_error(int basis, int update, int terms, int n, pw_status *status)
{
  static pw_scene s;
  pw_record out;
  mms_scene(&s, basis, update, n);
  s.method.mass_terms = terms;
  pw_sim *sim = test_sim(&s, 1);
  for (*status = PW_OK; *status == PW_OK && sim->time < 0.02 * (1.0 - 1e-12);) {
    *status = pw_sim_step(sim, 0.02 - sim->time);
  }
  pw_sim_results(sim, &out);
  double error = -1.0;
  for (int k = 0; k < out.n; k++) {
    error = strcmp(out.item[k].name, "mms_displacement_error") == 0 ? out.item[k].value : error;
  }
  pw_sim_destroy(&sim);
  return error;
}

static void cpdi_is_of_second_order(void **state)
{
  (void)state;
  const double want[4] = {1.546e-1, 3.850e-2, 9.707e-3, 2.439e-3};
  double error[4];
  for (int k = 0; k < 4; k++) {
    pw_status status;
    error[k] = mms_error(PW_CPDI, PW_USL, 1, 8 << k, &status);
    assert_int_equal(status, PW_OK);
    print_message("cpdi n %d: %.4e, independent program %.4e\n", 8 << k, error[k], want[k]);
    assert_relative(error[k], want[k], 0.05);
  }
  double rate = 0.5 * log2(error[1] / error[3]);
  print_message("rate from n = 16 to 64: %.3f\n", rate);
  assert_true(rate >= 1.9);
}

static void musl_converges_as_well(void **state)
{
  (void)state;
  pw_status status[2];
  double coarse = mms_error(PW_CPDI, PW_MUSL, 1, 16, &status[0]);
  double fine = mms_error(PW_CPDI, PW_MUSL, 1, 32, &status[1]);
  print_message("cpdi, musl: %.4e, %.4e, rate %.3f\n", coarse, fine, log2(coarse / fine));
  assert_true(status[0] == PW_OK && status[1] == PW_OK);
  assert_true(log2(coarse / fine) >= 1.9);
}

/* Two terms of the mass matrix: half the error. */
static void second_term_halves_the_error(void **state)
{
  (void)state;
  for (int update = PW_MUSL; update <= PW_USL; update++) {
    double two[2];
    for (int k = 0; k < 2; k++) {
      pw_status status[2];
      double one = mms_error(PW_CPDI, update, 1, 16 << k, &status[0]);
      two[k] = mms_error(PW_CPDI, update, 2, 16 << k, &status[1]);
      print_message("update %d, n %d: %.4e, with two terms %.4e\n", update, 16 << k, one, two[k]);
      assert_true(status[0] == PW_OK && status[1] == PW_OK);
      assert_true(two[k] < 0.51 * one);
    }
    assert_true(log2(two[0] / two[1]) >= 1.9);
  }
}

/* uGIMP's fixed domains stop tiling the body and its rate falls; standard MPM does not converge:
 * its error grows, or the run stops with a named error. */
static void other_bases_are_reported(void **state)
{
  (void)state;
  const double ugimp[3] = {1.88e-1, 5.66e-2, 2.03e-2}, linear[3] = {2.64e-1, 2.83e-1, 5.00e-1};
  double last[2] = {0.0, 0.0};
  for (int k = 0; k < 3; k++) {
    pw_status status[2];
    double g = mms_error(PW_UGIMP, PW_USL, 1, 8 << k, &status[0]);
    double l = mms_error(PW_LINEAR, PW_USL, 1, 8 << k, &status[1]);
    print_message("n %d: ugimp %.3e (independent program %.3e), linear %.3e (%.3e), %s\n", 8 << k,
                  g, ugimp[k], l, linear[k],
                  status[1] == PW_OK ? "non-convergent" : pw_status_text(status[1]));
    assert_int_equal(status[0], PW_OK);
    assert_true(k == 0 || g < last[0]);
    assert_true(k == 0 || l > 0.9 * last[1] || status[1] != PW_OK);
    last[0] = g;
    last[1] = l;
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cpdi_is_of_second_order),
      cmocka_unit_test(musl_converges_as_well),
      cmocka_unit_test(second_term_halves_the_error),
      cmocka_unit_test(other_bases_are_reported),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
