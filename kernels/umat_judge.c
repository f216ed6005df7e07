/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a call of a UMAT has come to: its stiffness, and whether its result can be taken. */
#include "kernels/umat.h"

#include <math.h>
#include <string.h>

/* The stiffness of plane waves along n that move along m (unit vectors) is e:C:e with e the
 * symmetric part of m n, so that tr e = m.n = a and e:e = (1 + a^2)/2. With C split into k 1 1 and
 * a rest of norm N (largest row sum of its symmetric part) it is at most k a^2 + N (1 + a^2)/2,
 * which is largest at a = 0 or 1. */
pw_real pw_umat_stiffness(const pw_real *ddsdde)
{
  pw_real c[36], normal = 0.0, norm = 0.0;
  for (int i = 0; i < 6; i++) {
    for (int j = 0; j < 6; j++) { /* orthonormal components: shears times the root of 2 */
      pw_real root = (i < 3 ? 1.0 : sqrt(2.0)) * (j < 3 ? 1.0 : sqrt(2.0));
      c[6 * i + j] = 0.5 * root * (ddsdde[i + 6 * j] + ddsdde[j + 6 * i]);
    }
  }
  normal = (c[1] + c[2] + c[8]) / 3.0;
  for (int i = 0; i < 6; i++) {
    pw_real sum = 0.0;
    for (int j = 0; j < 6; j++) {
      sum += fabs(c[6 * i + j] - (i < 3 && j < 3 ? normal : 0.0));
    }
    norm = !(sum <= norm) ? sum : norm; /* NaN stays */
  }
  return pw_max(0.5 * norm, normal + norm);
}

/* Smaller strains may vanish in the rounding of a deformation gradient. */
static const pw_real visible = 1e-14;

/** Whether the stress stayed as it was although the stiffness asks for a change. */
static bool is_lost(const pw_real *param, const pw_umat_call *sent, const pw_umat_call *c)
{
  pw_real change = 0.0, size = 0.0, strain = 0.0;
  for (int i = 0; i < 6; i++) {
    pw_real sum = 0.0;
    for (int j = 0; j < 6; j++) {
      sum += c->ddsdde[i + 6 * j] * sent->dstran[j];
    }
    change = pw_max(change, fabs(sum));
    size = pw_max(size, fabs(sent->stress[i]));
    strain = pw_max(strain, fabs(sent->dstran[i]));
  }
  change = change > 0.0 || !(pw_umat_stiffness(c->ddsdde) == 0.0) ? change
                                                                  : param[PW_UMAT_BOUND] * strain;
  return param[PW_UMAT_UNCHANGED] < 0.5 && change > 1e-10 * size && strain > visible &&
         memcmp(c->stress, sent->stress, sizeof c->stress) == 0;
}

static bool all_finite(const pw_real *x, int n)
{
  pw_real sum = 0.0;
  for (int i = 0; i < n; i++) {
    sum += x[i] - x[i];
  }
  return sum == 0.0;
}

const char *pw_umat_judge(const pw_real *param, const pw_umat_call *sent, const pw_umat_call *c,
                          bool *over)
{
  const int nstatv = sent->nstatv;
  const size_t spare = (size_t)(PW_UMAT_STATEV + PW_UMAT_SPARE - nstatv);
  if (memcmp(c->statev + nstatv, sent->statev + nstatv, spare * sizeof *c->statev) != 0) {
    *over = true;
    return "the UMAT wrote more state variables than nstatv";
  }
  if (!all_finite(c->stress, 6) || !all_finite(c->statev, nstatv)) {
    return "the UMAT returned a stress or a state variable that is not a finite number (constants "
           "beyond nprops, COORDS and CELENT that were not given are none)";
  }
  if (c->pnewdt < 1.0) {
    return "the UMAT asks for smaller steps (PNEWDT < 1)";
  }
  if (!all_finite(c->ddsdde, 36)) {
    return "the UMAT returned a DDSDDE that is not finite";
  }
  if (is_lost(param, sent, c)) {
    return "the UMAT left the stress as it was although the strain changed: a lost increment "
           "(unchanged_stress: accept, if the soil flows at constant stress)";
  }
  if (!(param[PW_UMAT_BOUND] > 0.0) && !(pw_umat_stiffness(c->ddsdde) > 0.0)) {
    *over = true;
    return "the UMAT returned no stiffness in DDSDDE: stiffness_bound_pa must be given";
  }
  return NULL;
}
