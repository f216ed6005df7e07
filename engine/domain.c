/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/domain.h"

#include <math.h>

/* Shorten the half diagonals r1 + r2 and r1 - r2 to at most limit; true when one was longer. */
static bool limit_diagonals(pw_real r[4], pw_real limit)
{
  pw_real ax = r[0] + r[2], ay = r[1] + r[3], bx = r[0] - r[2], by = r[1] - r[3];
  pw_real a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, l2 = limit * limit;
  if (a2 <= l2 && b2 <= l2) {
    return false;
  }
  pw_real sa = a2 > l2 ? limit / sqrt(a2) : 1.0, sb = b2 > l2 ? limit / sqrt(b2) : 1.0;
  r[0] = 0.5 * (sa * ax + sb * bx);
  r[1] = 0.5 * (sa * ay + sb * by);
  r[2] = 0.5 * (sa * ax - sb * bx);
  r[3] = 0.5 * (sa * ay - sb * by);
  return true;
}

/* Replace a degenerate domain by a square and its initial half-sides by F^-1 of it. */
static void rebuild(pw_points *p, pw_idx i, pw_real area, pw_real limit, pw_real r[4])
{
  const pw_idx ld = p->ld;
  pw_real h = pw_min(0.5 * sqrt(area), limit * sqrt(0.5));
  pw_real f0 = p->def_grad[i], f1 = p->def_grad[ld + i];
  pw_real f2 = p->def_grad[2 * ld + i], f3 = p->def_grad[3 * ld + i];
  pw_real scale = h / (f0 * f3 - f1 * f2);
  r[0] = r[3] = h;
  r[1] = r[2] = 0.0;
  p->half0[i] = scale * f3;
  p->half0[ld + i] = -scale * f2;
  p->half0[2 * ld + i] = -scale * f1;
  p->half0[3 * ld + i] = scale * f0;
}

void pw_domain_convect(pw_sim *sim, pw_idx first, pw_idx n, pw_block_sums *sums)
{
  pw_points *p = &sim->points;
  const pw_idx ld = p->ld;
  const bool axi = sim->scene.geometry == PW_AXI;
  for (pw_idx i = first; i < first + n; i++) {
    const pw_real *f = p->def_grad + i, *r0 = p->half0 + i;
    pw_real r[4];
    for (int k = 0; k < 2; k++) {
      pw_real x = r0[2 * k * ld], y = r0[(2 * k + 1) * ld];
      r[2 * k] = f[0] * x + f[ld] * y;
      r[2 * k + 1] = f[2 * ld] * x + f[3 * ld] * y;
    }
    pw_real limit = sim->limit[p->id[i]];
    if (limit_diagonals(r, limit)) {
      sums->limited++;
      pw_real area = axi ? p->vol[i] / p->x[i] : p->vol[i];
      if (4.0 * (r[0] * r[3] - r[1] * r[2]) < PW_DOMAIN_DEGENERATE * area) {
        rebuild(p, i, area, limit, r);
        sums->rebuilt++;
      }
    }
    for (int k = 0; k < 4; k++) {
      p->half[k * ld + i] = r[k];
    }
  }
}
