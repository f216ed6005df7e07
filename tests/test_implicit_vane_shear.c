/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vane shear (tests/vane_helpers.h) on a coarse mesh of 5648 elements, half the paper's height, with
 * ten-node tetrahedra of l = 0.4 rv at the blades. Plane strain with c_u everywhere: a cylinder that
 * turns rigidly bounds the torque from above by T_cyl; with F-bar the mesh adds about l / rv to it,
 * without F-bar it locks and the torque rises on. Elastic stiffness: 4.63e4 N m/rad per 0.05 m of
 * height in plane strain (quadratic triangles, 0.5 %), 4.69e4 here for l -> 0. */
#include "tests/harness.h"
#include "tests/vane_helpers.h"

enum { STEPS = 14 };

static void turn(pw_fbar fbar, double *relative)
{
  static vane v;
  double torque[2] = {0.0, 0.0};
  assert_ok(vane_start("reference/gmsh/vane_coarse.msh", fbar, 1, &v));
  v.step = 1.5e-4;
  for (int k = 0; k < STEPS; k++) {
    assert_ok(vane_turn(&v, torque));
    assert_int_equal(v.report.cuts, 0);
    assert_true(v.report.iterations <= 9);
    assert_near(torque[0] + torque[1], 0.0, 1e-10 * fabs(torque[0]));
    assert_true(v.model.walked.tests <= 1.2 * (double)v.model.walked.points);
    assert_int_equal(v.model.walked.outside, 0);
    relative[k] = torque[0] / vane_cylinder(v.height);
    print_message("F-bar %d, %.2e rad: T/T_cyl %.4f, %d iterations\n", (int)fbar, v.angle,
                  relative[k], v.report.iterations);
  }
  vane_end(&v);
}

static void torque_has_a_plateau_with_fbar_alone(void **state)
{
  (void)state;
  static double barred[STEPS], plain[STEPS];
  if (!pw_gmsh_available()) {
    skip();
  }
  turn(PW_FBAR_INCREMENT, barred);
  turn(PW_FBAR_NONE, plain);
  const int last = STEPS - 1;
  double slope = (barred[last] - barred[last - 2]) / 2.0;
  assert_true(slope < 0.01 * barred[0]); /* of the elastic slope */
  assert_true((plain[last] - plain[last - 2]) / 2.0 > 5.0 * slope);
  assert_true(plain[last] > 1.3 * barred[last]);
}

static void elastic_stiffness_is_that_of_plane_strain(void **state)
{
  (void)state;
  static vane v;
  double torque[2] = {0.0, 0.0};
  if (!pw_gmsh_available()) {
    skip();
  }
  assert_ok(vane_start("reference/gmsh/vane_coarse.msh", PW_FBAR_INCREMENT, 1, &v));
  v.step = 1e-6;
  assert_ok(vane_turn(&v, torque));
  double stiffness = torque[0] / v.step * 0.05 / v.height;
  print_message("elastic stiffness %.4g N m/rad per 0.05 m\n", stiffness);
  assert_near(stiffness, 4.69e4, 0.06 * 4.69e4); /* from above, by what the coarse mesh adds */
  assert_true(stiffness > 4.63e4);
  vane_end(&v);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(torque_has_a_plateau_with_fbar_alone),
      cmocka_unit_test(elastic_stiffness_is_that_of_plane_strain),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
