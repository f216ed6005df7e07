/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cook's membrane (tests/cook_helpers.h), in one load step that is approached without the mesh being
 * put back: with F-bar the top corner goes up by 6.925 for n -> infinity, without it the membrane
 * locks. bench/bench_cook runs finer meshes: 6.793 with 16 bricks along each edge. */
#include "tests/cook_helpers.h"
#include "tests/harness.h"

/* Displacement of the top corner. */
static double top(pw_idx n, pw_fbar fbar, double *inside, double *across)
{
  static solid s;
  double u[3] = {0.0, 0.0, 0.0};
  assert_ok(cook_start(&s, n, fbar));
  assert_ok(solid_step(&s, 1.0));
  cook_displacement(&s, 48.0, 60.0, u);
  cook_checkerboard(&s, inside, across);
  print_message("%d bricks, F-bar %d: %.4f, pressure jumps %.3f in patches, %.3f between, %d "
                "iterations\n",
                (int)n, (int)fbar, u[1], *inside, *across, s.report.iterations);
  assert_int_equal(s.report.parts, 1);
  solid_end(&s);
  return u[1];
}

static void corner_goes_where_quadratic_elements_take_it(void **state)
{
  (void)state;
  double inside[3], across[3];
  const double coarse = top(4, PW_FBAR_INCREMENT, &inside[0], &across[0]);
  const double fine = top(8, PW_FBAR_INCREMENT, &inside[1], &across[1]);
  assert_true(coarse < fine && fine < COOK_TOP); /* from below */
  double rate = log2((COOK_TOP - coarse) / (COOK_TOP - fine));
  assert_true(rate >= 1.2);
  /* What is left, at that rate, is 2 % with 16 bricks and less with 32. */
  assert_true((COOK_TOP - fine) / pow(2.0, 2.0 * rate) < 0.02 * COOK_TOP);
  assert_true(inside[1] < 0.05); /* one pressure in a patch */
  assert_true(across[1] < across[0]);
  const double plain = top(8, PW_FBAR_NONE, &inside[2], &across[2]);
  assert_true(plain < 0.5 * fine && inside[2] > 1.0);
}

/* In one increment from the start both forms of F-bar are the same. */
static void forms_of_fbar_agree_in_one_step(void **state)
{
  (void)state;
  double inside, across;
  double increment = top(4, PW_FBAR_INCREMENT, &inside, &across);
  assert_relative(top(4, PW_FBAR_TOTAL, &inside, &across), increment, 1e-8);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(corner_goes_where_quadratic_elements_take_it),
      cmocka_unit_test(forms_of_fbar_agree_in_one_step),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
