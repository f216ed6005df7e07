/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Manufactured solution of an axisymmetric ring (verification A8 f; Wallstedt and Guilkey 2008):
 * 0.4 <= R <= 0.6, u_r = A sin(c pi t) (c3 R^3 + c2 R^2 + c1 R), A = 0.1 m, E = 1e7, nu = 0,
 * rho = 1000; the rims are free, nothing moves along the axis, one period. A layer one cell high
 * between rollers. Error: largest L2 norm over the steps of the difference of displacements, over
 * the largest L2 norm of the exact one. The hoop stress reaches a quarter of E and the ring
 * crosses cells: a body of n cells through its wall moves by half of them. */
#include "tests/engine_helpers.h"

static const double young = 1e7, density = 1e3;

static double ring_error(int update, int n, pw_status *status)
{
  static pw_scene s;
  double h = 0.2 / n, low = 0.4 - h * ceil(0.11 / h + 2.0), high = 0.6 + h * ceil(0.11 / h + 2.0);
  pw_record out;
  pw_scene_default(&s);
  s.geometry = PW_AXI;
  s.method.update = update;
  test_grid(&s, (double[]){low, high, 0.0, h}, h);
  int m = test_neo_hookean(&s, young / 3.0, 0.5 * young, density);
  test_rectangle(&s, m, (double[]){0.4, 0.6, 0.0, h}, 0.5 * h);
  pw_body_force_param *force = pw_scene_add_effect(&s, "body_force");
  force->body = 0;
  force->kind = PW_MMS_RING;
  force->amplitude_m = 0.1;
  for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_TOP; side++) {
    pw_boundary_param *b = pw_scene_add_effect(&s, "boundary");
    b->side = side;
    b->fix_y = true;
  }
  s.time.dt_s = 0.4 * h / (sqrt(young / density) * (1.0 + 0.1 * 3.1416));
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
  for (int update = PW_MUSL; update <= PW_USL; update++) {
    double error[4];
    for (int k = 0; k < 4; k++) {
      pw_status status;
      error[k] = ring_error(update, 8 << k, &status);
      double rate = k > 0 ? log2(error[k - 1] / error[k]) : 0.0;
      print_message("update %d, %d cells through the wall: %.4e, rate %.3f\n", update, 8 << k,
                    error[k], rate);
      assert_int_equal(status, PW_OK);
      assert_true(k == 0 || rate >= 1.8);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cpdi_is_of_second_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
