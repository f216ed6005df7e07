/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Thick cylinder in plane strain and thick sphere opened from inside until all of the wall yields
 * (tests/thick_wall_helpers.h). Hill, The Mathematical Theory of Plasticity (1950), chapter V: with
 * the wall plastic up to the radius c, Y' = 2 Y / sqrt(3),
 *   cylinder: p = Y' (ln(c/a) + (1 - c2/b2)/2),       u_b = Y' c2 (1 - nu2) / (E b)
 *   sphere:   p = 2 Y ln(c/a) + 2/3 Y (1 - c3/b3),    u_b = Y c3 (1 - nu) / (E b2).
 * Data of de Souza Neto, Peric, Owen: a = 0.1 m, b = 0.2 m, E = 210 GPa, nu = 0.3, Y = 0.24 GPa. */
#include "tests/harness.h"
#include "tests/thick_wall_helpers.h"

static double pressure_at(const wall_case *c, double z)
{
  const double b = c->outer;
  return c->sphere
             ? 2.0 * c->yield * (log(z / c->inner) + (1.0 - pow(z / b, 3.0)) / 3.0)
             : 2.0 / sqrt(3.0) * c->yield * (log(z / c->inner) + 0.5 * (1.0 - z * z / (b * b)));
}

static double outside_at(const wall_case *c, double z)
{
  const double b = c->outer;
  return c->sphere ? c->yield * z * z * z * (1.0 - c->poisson) / (c->young * b * b)
                   : 2.0 / sqrt(3.0) * c->yield * z * z * (1.0 - c->poisson * c->poisson) /
                         (c->young * b);
}

/* Radius up to which the wall is plastic at a pressure. */
static double plastic_zone(const wall_case *c, double pressure)
{
  double zone[2] = {c->inner, c->outer};
  for (int i = 0; i < 60; i++) {
    double middle = 0.5 * (zone[0] + zone[1]);
    zone[pressure_at(c, middle) >= pressure] = middle;
  }
  return zone[0];
}

/* Pressure over the limit at the end. On the way the outer face has to be where Hill has it at the
 * same pressure, while the wall is plastic up to between `inner` and `most`. Towards the limit the
 * pressure no longer determines it. */
static double widen(const wall_case *c, double push, int steps, double most)
{
  static solid s;
  memset(&s, 0, sizeof s);
  double outside = 0.0, ratio = 0.0;
  int compared = 0;
  assert_ok(wall_start(&s, c, push));
  for (int k = 0; k < steps; k++) {
    assert_ok(solid_step(&s, 0.0));
    outside += wall_outside(&s, c, pw_newton_displacement(s.newton));
    double p = wall_pressure(&s, c, push, 0.0), zone = plastic_zone(c, p);
    ratio = p / pressure_at(c, c->outer);
    print_message("p/limit %.4f, plastic to %.4f m, u_b %.4f of Hill's, %d iterations\n", ratio,
                  zone, outside / outside_at(c, zone), s.report.iterations);
    if (c->fbar != PW_FBAR_NONE && zone > c->inner && zone < most) {
      assert_near(outside / outside_at(c, zone), 1.0, 0.03);
      compared++;
    }
  }
  assert_true(compared >= 4 || c->fbar == PW_FBAR_NONE);
  solid_end(&s);
  return ratio;
}

static void cylinder_reaches_its_limit(void **state)
{
  (void)state;
  wall_case c = wall_steel(false, 6, PW_FBAR_INCREMENT);
  assert_near(widen(&c, 0.045e-3, 10, 0.18), 1.0, 0.01);
}

static void sphere_reaches_its_limit(void **state)
{
  (void)state;
  wall_case c = wall_steel(true, 8, PW_FBAR_INCREMENT);
  c.round = 4;
  assert_near(widen(&c, 0.05e-3, 12, 0.175), 1.0, 0.01);
  c.fbar = PW_FBAR_NONE; /* too stiff, and the pressure rises on */
  assert_true(widen(&c, 0.05e-3, 12, 0.175) > 1.02);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cylinder_reaches_its_limit),
      cmocka_unit_test(sphere_reaches_its_limit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
