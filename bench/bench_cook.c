/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cook's membrane (tests/cook_helpers.h) in one load step, the mesh not put back in between.
 * usage: bench_cook N [none|increment|total] */
#include <omp.h>
#include <stdio.h>

#include "tests/cook_helpers.h"

int main(int argc, char **argv)
{
  static solid s;
  const char *name = argc > 2 ? argv[2] : "increment";
  const pw_fbar fbar = strcmp(name, "none") == 0    ? PW_FBAR_NONE
                       : strcmp(name, "total") == 0 ? PW_FBAR_TOTAL
                                                    : PW_FBAR_INCREMENT;
  double top[3] = {0}, middle[3] = {0}, inside, across, start = omp_get_wtime();
  if (argc < 2 || cook_start(&s, atoi(argv[1]), fbar) != PW_OK || solid_step(&s, 1.0) != PW_OK) {
    fprintf(stderr, "usage: bench_cook N [none|increment|total]: %s\n", pw_error_text());
    return 1;
  }
  cook_displacement(&s, 48.0, 60.0, top);
  cook_displacement(&s, 48.0, 52.0, middle);
  cook_checkerboard(&s, &inside, &across);
  printf(
      "%s bricks, F-bar %s: top %.4f (%.4f of %.3f), along x %.4f, middle %.4f, checkerboard %.3f "
      "in patches, %.3f between, %d iterations, %d equations, %.1f s\n",
      argv[1], name, top[1], top[1] / COOK_TOP, COOK_TOP, top[0], middle[1], inside, across,
      s.report.iterations, (int)s.model.csr.n, omp_get_wtime() - start);
  solid_end(&s);
  return 0;
}
