/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bar with deep notches on both sides in plane strain (tests/limit_problems.h): with F-bar the stress
 * in the ligament reaches (2 + pi)/sqrt(3) = 2.9685 of the yield stress within 3 % from above
 * (Nagtegaal, Parks, Rice, Comput. Methods Appl. Mech. Engrg 4 (1974) 153-177); without F-bar linear
 * tetrahedra lock and the load rises on. */
#include "tests/harness.h"
#include "tests/limit_problems.h"

static limit_result run(pw_fbar fbar)
{
  limit_case c = limit_notch_case(1, fbar);
  limit_result r;
  assert_ok(limit_strip_run(limit_notch_start, &c, 8e-5, 9, &r));
  print_message("%d tets, F-bar %d: load/limit %.4f, slope %.4f of the first\n", (int)r.tets,
                (int)fbar, r.load, r.slope);
  assert_int_equal(r.crossed, 0); /* the limit is reached before points cross */
  return r;
}

static void notched_bar_bears_two_point_nine_seven(void **state)
{
  (void)state;
  limit_result barred = run(PW_FBAR_INCREMENT), plain = run(PW_FBAR_NONE);
  assert_near(barred.load, 1.0, 0.03);
  assert_true(barred.load > 1.0 && barred.slope < 0.01);
  assert_int_equal(barred.cuts, 0);
  assert_true(plain.load > 1.15 && plain.slope > 0.02);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(notched_bar_bears_two_point_nine_seven),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
