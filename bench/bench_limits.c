/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plastic limit loads in plane strain on finer meshes (tests/limit_problems.h,
 * tests/thick_wall_helpers.h): every step's figure.
 * usage: bench_limits footing|rough_footing|notch|cylinder|sphere LEVEL [none|increment|total]
 *        bench_limits cavity|spherical_cavity G/c_u [none|increment|total]
 * LEVEL: bricks along each axis, times those of the tests. */
#include <omp.h>
#include <stdio.h>

#include "tests/limit_problems.h"
#include "tests/thick_wall_helpers.h"

static int fail(const char *what)
{
  fprintf(stderr, "%s: %s (%s)\n", what, pw_error_text(), pw_error_where());
  return 1;
}

static int strip(const limit_case *c, double push, int steps, bool notch)
{
  static solid s;
  if ((notch ? limit_notch_start : limit_footing_start)(&s, c, push) != PW_OK) {
    return fail("start");
  }
  double first = 0.0, before = 0.0, start = omp_get_wtime();
  for (int k = 0; k < steps; k++) {
    if (solid_step(&s, 0.0) != PW_OK) {
      return fail("step");
    }
    double ratio = limit_strip_ratio(&s, c, push), slope = ratio - before;
    first = k == 0 ? slope : first;
    printf("%2d load/limit %.4f slope/first %.4f, %d iterations, %d points crossed, %.1f s\n",
           k + 1, ratio, slope / first, s.report.iterations, (int)s.model.walked.moved,
           omp_get_wtime() - start);
    fflush(stdout);
    before = ratio;
  }
  printf("%d tets, %d equations\n", (int)s.mesh.tets.nelem, (int)s.model.csr.n);
  solid_end(&s);
  return 0;
}

/* Hill: plastic up to the radius z at the pressure p, and the displacement of the outer face. */
static double hill_pressure(const wall_case *c, double z)
{
  const double b = c->outer, y = c->yield;
  return c->sphere ? 2.0 * y * (log(z / c->inner) + (1.0 - pow(z / b, 3.0)) / 3.0)
                   : 2.0 / sqrt(3.0) * y * (log(z / c->inner) + 0.5 * (1.0 - z * z / (b * b)));
}

static double hill_outside(const wall_case *c, double z)
{
  const double b = c->outer, y = c->yield;
  return c->sphere ? y * z * z * z * (1.0 - c->poisson) / (c->young * b * b)
                   : 2.0 / sqrt(3.0) * y * z * z * (1.0 - c->poisson * c->poisson) / (c->young * b);
}

static int wall(const wall_case *c, double push, int steps)
{
  static solid s;
  double outside = 0.0, start = omp_get_wtime();
  if (wall_start(&s, c, push) != PW_OK) {
    return fail("start");
  }
  for (int k = 0; k < steps; k++) {
    if (solid_step(&s, 0.0) != PW_OK) {
      return fail("step");
    }
    outside += wall_outside(&s, c, pw_newton_displacement(s.newton));
    double p = wall_pressure(&s, c, push, 0.0), zone[2] = {c->inner, c->outer};
    for (int i = 0; i < 60; i++) {
      double m = 0.5 * (zone[0] + zone[1]);
      zone[hill_pressure(c, m) >= p] = m;
    }
    double hill = hill_outside(c, zone[0]);
    printf("%2d p/limit %.4f, plastic to %.4f m, outside %.6f mm, Hill's %.6f mm at this pressure "
           "(%.4f), %d iterations, %.1f s\n",
           k + 1, p / hill_pressure(c, c->outer), zone[0], 1e3 * outside, 1e3 * hill,
           outside / hill, s.report.iterations, omp_get_wtime() - start);
    fflush(stdout);
  }
  printf("%d tets, %d equations\n", (int)s.mesh.tets.nelem, (int)s.model.csr.n);
  solid_end(&s);
  return 0;
}

static int cavity(bool sphere, double rigidity, pw_fbar fbar)
{
  static solid s;
  const wall_case c = wall_cavity(sphere, rigidity, fbar);
  const double factor = sphere ? 4.0 / 3.0 : 1.0, exact = factor * (1.0 + log(rigidity));
  double doubled;
  if (wall_double(&s, &c, &doubled) != PW_OK) {
    return fail("step");
  }
  const double limit = doubled + factor * log(2.0);
  printf(
      "%.4f c_u at twice the volume, limit %.4f c_u, exact %.4f (%.4f), %d iterations, %d tets\n",
      doubled, limit, exact, limit / exact, s.report.iterations, (int)s.mesh.tets.nelem);
  solid_end(&s);
  return 0;
}

int main(int argc, char **argv)
{
  const int level = argc > 2 ? atoi(argv[2]) : 0;
  if (level < 1) {
    fprintf(stderr, "usage: bench_limits footing|rough_footing|notch|cylinder|sphere LEVEL "
                    "[none|increment|total], or cavity|spherical_cavity G/c_u\n");
    return 2;
  }
  const char *name = argc > 3 ? argv[3] : "increment";
  limit_case c = {.per_brick = 6};
  c.fbar = strcmp(name, "none") == 0    ? PW_FBAR_NONE
           : strcmp(name, "total") == 0 ? PW_FBAR_TOTAL
                                        : PW_FBAR_INCREMENT;
  if (strcmp(argv[1], "cylinder") == 0 || strcmp(argv[1], "sphere") == 0) {
    wall_case w = wall_steel(argv[1][0] == 's', 6 * level, c.fbar);
    const double stiffer = argc > 4 ? atof(argv[4]) : 1.0;
    w.young *= stiffer;
    return wall(&w, (w.sphere ? 0.025e-3 : 0.035e-3) / stiffer, w.sphere ? 24 : 20);
  }
  if (strstr(argv[1], "cavity")) {
    return cavity(argv[1][0] == 's', level, c.fbar);
  }
  if (strcmp(argv[1], "notch") == 0) {
    c = limit_notch_case(level, c.fbar);
    return strip(&c, 4e-5, 25, true);
  }
  c = limit_footing_case(level, c.fbar);
  c.rough = strcmp(argv[1], "rough_footing") == 0;
  return strip(&c, 1.25e-5, 16, false);
}
