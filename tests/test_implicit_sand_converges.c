/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hypoplastic sand between rigid walls, pressed and dragged along by its top, in implicit steps of a
 * mesh. Its substeps, and with them jumps of its stress, depend on the increment; from the third
 * iteration on they are kept (engine/newton_guide.h), the tangent is that of the stress, and every
 * iteration leaves less than a hundredth of the residual. */
#include "engine/implicit_state.h"
#include "tests/implicit_helpers.h"

static void run(const char *steps, const char *fbar)
{
  const char *const set[] = {steps, fbar};
  double most = 0.0;
  int iterations = 0;
  pw_implicit *sim = test_implicit("scenes/confined_sand.yaml", 2, set);
  while (sim->now < sim->scene.solid.implicit.steps) {
    assert_ok(pw_implicit_step(sim));
    const pw_newton_report *r = pw_implicit_newton(sim);
    for (int i = 3; i < r->count; i++) {
      most = fmax(most, r->residual[i] / r->residual[i - 1]);
    }
    iterations = r->count - 1 > iterations ? r->count - 1 : iterations;
    assert_true(r->residual[r->count - 1] <= 1e-9);
  }
  print_message("%s, %s: at most %d iterations; from the third each leaves %.1e at most\n", steps,
                fbar, iterations, most);
  assert_true(most < 0.01 && iterations <= 5);
  pw_implicit_destroy(&sim);
}

static void every_iteration_leaves_a_hundredth(void **state)
{
  (void)state;
  run("implicit.steps=5", "implicit.fbar=none");
  run("implicit.steps=20", "implicit.fbar=none");
  run("implicit.steps=20", "implicit.fbar=increment");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_iteration_leaves_a_hundredth),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
