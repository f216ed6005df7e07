/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hypoplastic clay between rigid walls, pressed and dragged along by its top, in implicit steps of a
 * mesh, with intergranular strain and without. As with sand (test_implicit_sand_converges.c) substeps
 * are kept from the third iteration and a residual of 1e-3 on, and every iteration then leaves less than
 * a hundredth of the residual. Increments of 5 steps are forty times the elastic range R: substeps that
 * follow how intergranular strain decays to its end would enlarge rounding, and the residual would stay
 * at 5e-9 after any number of iterations. */
#include "engine/implicit_state.h"
#include "tests/implicit_helpers.h"

static void run(const char *steps, const char *fbar, const char *intergranular)
{
  const char *const set[] = {steps, fbar, intergranular};
  double most = 0.0;
  int iterations = 0;
  pw_implicit *sim = test_implicit("scenes/confined_clay.yaml", 3, set);
  while (sim->now < sim->scene.solid.implicit.steps) {
    assert_ok(pw_implicit_step(sim));
    const pw_newton_report *r = pw_implicit_newton(sim);
    assert_int_equal(r->cuts + r->approaches + r->searches, 0);
    for (int i = 3; i < r->count; i++) {
      const double left = r->residual[i] / r->residual[i - 1];
      most = fmax(most, r->residual[i - 1] <= 1e-3 ? left : 0.0);
    }
    iterations = r->count - 1 > iterations ? r->count - 1 : iterations;
    assert_true(r->residual[r->count - 1] <= 1e-9);
    assert_true(sim->model.rounding < 1e-4); /* N, of 1e5: the tangent keeps its size */
  }
  print_message("%s, %s, %s: at most %d iterations; with kept substeps each leaves %.1e at most\n",
                steps, fbar, intergranular, iterations, most);
  assert_true(most < 0.01 && iterations <= 5);
  pw_implicit_destroy(&sim);
}

static void every_iteration_leaves_a_hundredth(void **state)
{
  (void)state;
  const char *const with = "materials.clay.intergranular_strain=true";
  run("implicit.steps=5", "implicit.fbar=none", with);
  run("implicit.steps=20", "implicit.fbar=none", with);
  run("implicit.steps=20", "implicit.fbar=increment", with);
  run("implicit.steps=10", "implicit.fbar=none", "materials.clay.intergranular_strain=false");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_iteration_leaves_a_hundredth),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
