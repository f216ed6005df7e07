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
static double limit(wall_case *c, double rigidity, pw_status expected)
{
  static solid s;
  memset(&s, 0, sizeof s);
  s.approach = 12;
  s.line_search = 4;
  c->young = 2.0 * rigidity * (1.0 + c->poisson);
  c->yield = c->sphere ? 2.0 : sqrt(3.0); /* von Mises with c_u = 1 where two stresses are equal,
                                             and in plane strain */
  const double wider = (c->sphere ? cbrt(2.0) : sqrt(2.0)) - 1.0;
  assert_ok(wall_start(&s, c, wider * c->inner));
  assert_int_equal(solid_step(&s, 0.0), expected);
  double doubled = wall_pressure(&s, c, wider * c->inner, wider);
  double all = doubled + (c->sphere ? 4.0 / 3.0 : 1.0) * log(2.0);
  print_message("G/c_u %g: %.3f c_u at twice the volume, limit %.3f, %d iterations\n", rigidity,
                doubled, all, s.report.iterations);
  solid_end(&s);
  return all;
}

static wall_case cavity(bool sphere, pw_fbar fbar)
{
  wall_case c = {.sphere = sphere, .fbar = fbar, .inner = 1.0, .poisson = 0.49};
  c.outer = sphere ? 15.0 : 40.0; /* the rest of the infinite body: 0.1 and 0.01 c_u */
  c.radial = 12;
  c.round = sphere ? 3 : 5;
  c.growth = sphere ? 3.3 : 4.0;
  c.thick = 0.3;
  return c;
}

static void cylinder_needs_its_limit_pressure(void **state)
{
  (void)state;
  wall_case c = cavity(false, PW_FBAR_INCREMENT);
  assert_relative(limit(&c, 100.0, PW_OK), 1.0 + log(100.0), 0.02);
  c.fbar = PW_FBAR_NONE; /* locked */
  assert_true(limit(&c, 100.0, PW_OK) > 1.5 * (1.0 + log(100.0)));
}

static void sphere_needs_its_limit_pressure(void **state)
{
  (void)state;
  wall_case c = cavity(true, PW_FBAR_INCREMENT);
  assert_relative(limit(&c, 100.0, PW_OK), 4.0 / 3.0 * (1.0 + log(100.0)), 0.02);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cylinder_needs_its_limit_pressure),
      cmocka_unit_test(sphere_needs_its_limit_pressure),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
