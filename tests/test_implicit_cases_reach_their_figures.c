/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The implicit cases as scenes: figures of their READMEs, which come from closed forms and from an
 * independent program (sources there). */
#include "io/gmsh_mesh.h"
#include "tests/implicit_helpers.h"

/* Reactions are exact while the stress is uniform; later means stay near the yield stress and F-bar
 * shrinks the range. */
static void simple_stretch(void **state)
{
  (void)state;
  static const double reaction[] = {607.74, 961.35, 1175.01, 1088.66};
  const char *const plain[] = {"implicit.fbar=none"};
  const double yield = sqrt(1.5) * 400.0;
  double width[2];
  for (int k = 0; k < 2; k++) {
    pw_implicit *sim = test_implicit_case("simple_stretch/scene.yaml", k, plain);
    for (int n = 1; n <= 20; n++) {
      assert_ok(pw_implicit_step(sim));
      const double mean = test_implicit_history(sim, "stress_record_0_mean_pa");
      if (n <= 4) {
        assert_near(test_implicit_history(sim, "boundary_3_force_y_n"), reaction[n - 1], 0.005);
        assert_relative(mean, fmin(1e3 * log(1.0 + 0.2 * n), yield), 1e-8);
      } else {
        assert_near(mean, yield, k == 1 ? 2.0 : 0.5);
      }
      if (n == 17) {
        width[k] = test_implicit_history(sim, "stress_record_0_largest_pa") -
                   test_implicit_history(sim, "stress_record_0_least_pa");
      }
    }
    pw_implicit_destroy(&sim);
  }
  print_message("range at step 17: F-bar %.1f Pa, F %.1f Pa\n", width[0], width[1]);
  assert_true(5.0 * width[0] < width[1]);
}

static void bonded_block(void **state)
{
  (void)state;
  const char *const sets[][2] = {
      {"implicit.fbar=increment", "materials.rubber.poisson_ratio=0.49"},
      {"implicit.fbar=increment", "materials.rubber.poisson_ratio=0.4999"},
      {"implicit.fbar=none", "materials.rubber.poisson_ratio=0.49"},
      {"implicit.fbar=none", "materials.rubber.poisson_ratio=0.499"},
  };
  const double force[] = {-72.9, -74.6, -124.0, -410.0};
  for (int k = 0; k < 4; k++) {
    pw_implicit *sim = test_implicit_case("bonded_block/scene.yaml", 2, sets[k]);
    test_implicit_run(sim);
    assert_relative(test_implicit_history(sim, "boundary_1_force_y_n"), force[k],
                    k < 2 ? 0.01 : 0.04);
    assert_true(k >= 2 || test_implicit_history(sim, "iterations") <= 5.0);
    pw_implicit_destroy(&sim);
  }
}

/* After the first step of the turn, stress stays to four digits. */
static void rotating_block(void **state)
{
  (void)state;
  const char *const set[] = {"implicit.steps=9", "driven_boundary.angle_deg=240"};
  pw_implicit *sim = test_implicit_case("rotating_block/scene.yaml", 2, set);
  assert_ok(pw_implicit_step(sim));
  assert_ok(pw_implicit_step(sim));
  const double first = test_implicit_history(sim, "stress_record_0_mean_pa");
  test_implicit_run(sim);
  assert_true(first > 5.0);
  assert_relative(test_implicit_history(sim, "stress_record_0_mean_pa"), first, 1e-4);
  pw_implicit_destroy(&sim);
}

/* A coarse mesh of half the height, made from the geometry. The torque ends on a plateau above that
 * of the cylinder, which bounds it from below in plane strain, and below the line 1.005 + 1.03 l of
 * finer meshes, for the thin blades make this one finer than l at their tips. */
static void vane_shear(void **state)
{
  (void)state;
  const char *const set[] = {"mesh.numbers=l=0.4 far=1.5 height=0.025", "implicit.steps=14"};
  const double cylinder = 2.0 * acos(-1.0) * 0.05 * 0.05 * 0.025 * 1e4;
  double torque = 0.0, before = 0.0, first = 0.0;
  if (!pw_gmsh_available()) {
    skip();
  }
  pw_implicit *sim = test_implicit_case("vane_shear/scene.yaml", 2, set);
  for (int k = 1; k <= 14; k++) {
    assert_ok(pw_implicit_step(sim));
    before = torque;
    torque = test_implicit_history(sim, "driven_torque_n_m") / cylinder;
    first = k == 1 ? torque : first;
    assert_relative(test_implicit_history(sim, "boundary_0_torque_n_m"), -torque * cylinder, 1e-10);
    assert_true(test_implicit_history(sim, "tests_per_point") <= 1.2);
  }
  print_message("T/T_cyl %.4f, grows by %.4f in the last step\n", torque, torque - before);
  assert_true(torque > 1.005 && torque < 1.005 + 1.03 * 0.4);
  assert_true(torque - before < 0.01 * first);
  pw_implicit_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(simple_stretch),
      cmocka_unit_test(bonded_block),
      cmocka_unit_test(rotating_block),
      cmocka_unit_test(vane_shear),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
