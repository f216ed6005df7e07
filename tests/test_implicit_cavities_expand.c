/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cavities in nearly incompressible, perfectly plastic material, opened until their volume has
 * doubled, at large strain. In an infinite incompressible body the pressure that opens a cavity from
 * nothing is c_u (1 + ln(G/c_u)) for a cylinder and 4/3 of it for a sphere; at twice the first volume
 * it is less by ln 2 (and 4/3 ln 2) c_u, whatever the size (Gibson, Anderson, Civ. Engng Publ. Wks
 * Rev. 56 (1961) 615-618). The tangential strains follow one path, so that one increment without the
 * mesh being put back in between is exact in the material. */
#include "tests/harness.h"
#include "tests/thick_wall_helpers.h"

/* Pressure that opens the cavity from nothing, over c_u, from that at twice the volume. */
static double limit(const wall_case *c)
{
  static solid s;
  double doubled = 0.0;
  assert_ok(wall_double(&s, c, &doubled));
  double all = doubled + (c->sphere ? 4.0 / 3.0 : 1.0) * log(2.0);
  print_message("%.3f c_u at twice the volume, limit %.3f, %d iterations\n", doubled, all,
                s.report.iterations);
  solid_end(&s);
  return all;
}

static void cylinder_needs_its_limit_pressure(void **state)
{
  (void)state;
  wall_case c = wall_cavity(false, 100.0, PW_FBAR_INCREMENT);
  assert_relative(limit(&c), 1.0 + log(100.0), 0.02);
  c.fbar = PW_FBAR_NONE; /* locked */
  assert_true(limit(&c) > 1.5 * (1.0 + log(100.0)));
}

static void sphere_needs_its_limit_pressure(void **state)
{
  (void)state;
  wall_case c = wall_cavity(true, 100.0, PW_FBAR_INCREMENT);
  assert_relative(limit(&c), 4.0 / 3.0 * (1.0 + log(100.0)), 0.02);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cylinder_needs_its_limit_pressure),
      cmocka_unit_test(sphere_needs_its_limit_pressure),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
