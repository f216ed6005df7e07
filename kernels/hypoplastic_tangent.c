/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/hypoplastic.h"

#include "kernels/hypoplastic_rates.h"

/** m_R L (L without intergranular strain): stiffness where the direction of strain is unknown. */
static void linear_stiffness(const pw_hypo *h, const pw_hypo_point *p, pw_real *tangent)
{
  pw_t6 shifted = pw_t6_shift(p->stress, -h->p_t);
  if (!pw_hypo_inside(h, shifted)) {
    shifted = pw_hypo_limit(h, shifted);
  }
  pw_hypo_shape g = pw_hypo_shape_of(shifted);
  pw_hypo_factors k = pw_hypo_factors_of(h, &g, p->void_ratio, false);
  pw_real m = h->intergranular ? h->m_r : 1.0;
  pw_real s[6];
  pw_t6_store(g.s, s, 1);
  for (int i = 0; i < 6; i++) {
    for (int j = 0; j < 6; j++) {
      /* the unit tensor's shear rows: d e_xy / d gamma_xy = 1/2; s:e counts s_xy gamma_xy once */
      pw_real unit = i != j ? 0.0 : (i < 3 ? 1.0 : 0.5);
      tangent[6 * i + j] = m * (k.c1 * unit + k.c2 * s[i] * s[j]);
    }
  }
}

void pw_hypo_tangent(const pw_hypo *h, pw_t6 de, pw_real dvol, const pw_hypo_point *start,
                     pw_t6 end, const pw_hypo_path *path, pw_real *tangent)
{
  /* On fixed substeps the end stress is a smooth function: the error of a difference falls with
   * eta until rounding (1e-16 stress / (eta stiffness)) shows. */
  pw_real size = pw_t6_norm(de), eta = pw_max(1e-5 * size, 1e-11), base[6], strain[6];
  bool separated = path->n > 0 && path->kind[path->n - 1] == PW_HYPO_SEPARATED;
  if (size == 0.0 || separated) {
    linear_stiffness(h, start, tangent);
    return;
  }
  pw_t6_store(end, base, 1);
  for (int j = 0; j < 6; j++) {
    pw_hypo_point p = *start;
    pw_real moved[6];
    pw_t6_store(de, strain, 1);
    strain[j] += eta;
    pw_real stretch = j < 3 ? exp(eta) : 1.0;
    pw_status s = pw_hypo_repeat(h, pw_t6_load(strain, 1), dvol * stretch, &p, path);
    if (s != PW_OK) {
      linear_stiffness(h, start, tangent);
      return;
    }
    pw_t6_store(p.stress, moved, 1);
    pw_real per_column = 1.0 / (j < 3 ? eta : 2.0 * eta); /* a shear column is per gamma */
    for (int i = 0; i < 6; i++) {
      tangent[6 * i + j] = (moved[i] - base[i]) * per_column;
    }
  }
}
