/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What Newton's method starts from and how far it goes along a correction, in the scenes of cases/.
 *
 * The increment of the step before turns with a mesh that turns: a block that is turned by 30 degrees in
 * every step moves by Q u in the next one, Q the turn. It comes to balance in the first step and begins to
 * turn in the second; few iterations of the next ones mend what that has changed, then none is needed.
 *
 * A part of a correction is taken when it takes a fifth off the slope (Matthies, Strang, Int. J. Numer.
 * Meth. Engng 14 (1979) 1613) or half off the residual. Compared with whole corrections, where yield
 * spreads fewer are needed and no step has to be approached; large turns and stretches, which have to
 * pass through larger residuals, take about as many, a tenth more at most. The results are the same. */
#include "engine/implicit_state.h"
#include "io/gmsh_mesh.h"
#include "tests/implicit_helpers.h"

static void turning_blocks_need_no_iteration(void **state)
{
  (void)state;
  const char *const set[] = {"implicit.steps=13", "driven_boundary.angle_deg=360"};
  pw_implicit *sim = test_implicit_case("rotating_block/scene.yaml", 2, set);
  for (int k = 1; k <= 13; k++) {
    assert_ok(pw_implicit_step(sim));
    const pw_newton_report *r = pw_implicit_newton(sim);
    print_message("step %d: %d iterations, first residual %.1e\n", k, r->iterations,
                  r->residual[0]);
    assert_int_equal(r->cuts, 0);
    assert_true(k < 3 || r->iterations <= (k < 8 ? 2 : 0));
  }
  pw_implicit_destroy(&sim);
}

/* Iterations, and of the last step what its column of the history is. */
typedef struct {
  pw_off iterations;
  int searches, approaches;
  double value;
} course;

static course run(const char *file, int steps, const char *search, const char *more,
                  const char *column)
{
  const char *const set[] = {search, more};
  pw_implicit *sim = test_implicit_case(file, more ? 2 : 1, set);
  course c = {.iterations = 0};
  for (int k = 0; k < steps; k++) {
    assert_ok(pw_implicit_step(sim));
    c.searches += pw_implicit_newton(sim)->searches;
    c.approaches += pw_implicit_newton(sim)->approaches;
  }
  c.iterations = sim->iterations;
  c.value = test_implicit_history(sim, column);
  print_message("%s, %s: %d iterations, %d parts that did not help, %d approaches; %s %.10g\n",
                file, search, (int)c.iterations, c.searches, c.approaches, column, c.value);
  pw_implicit_destroy(&sim);
  return c;
}

static void parts_of_corrections_help(void **state)
{
  (void)state;
  static const struct {
    const char *file, *more, *column;
    int steps;
    bool yields;
  } scenes[] = {
      {"footing/scene.yaml", NULL, "boundary_0_force_y_n", 2, true},
      {"double_notch/scene.yaml", NULL, "boundary_1_force_y_n", 1, true},
      {"rubber_tube/scene.yaml", NULL, "tracer_0_x_m", 1, false},
      {"cooks_membrane/scene.yaml", "mesh.numbers=n=3", "tracer_0_y_m", 1, false},
  };
  if (!pw_gmsh_available()) {
    skip();
  }
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
    course whole = run(scenes[i].file, scenes[i].steps, "implicit.line_search=0", scenes[i].more,
                       scenes[i].column);
    course parts = run(scenes[i].file, scenes[i].steps, "implicit.line_search=4", scenes[i].more,
                       scenes[i].column);
    assert_true(10 * parts.iterations <= 11 * whole.iterations);
    assert_relative(parts.value, whole.value, 1e-6);
    if (scenes[i].yields) {
      assert_int_equal(parts.approaches, 0);
      assert_true(whole.approaches > 0 && 5 * parts.iterations <= 4 * whole.iterations);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(turning_blocks_need_no_iteration),
      cmocka_unit_test(parts_of_corrections_help),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
