/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/hypoplastic.h"

#include "kernels/hypoplastic_rates.h"

#include <string.h>

#define DEGREE 0.017453292519943295769

void pw_hypo_derive(const pw_real *param, pw_hypo *h)
{
  memset(h, 0, sizeof *h);
  pw_real h_s = param[PW_HYPO_H_S], n = param[PW_HYPO_N], beta = param[PW_HYPO_BETA];
  pw_real e_d0 = param[PW_HYPO_E_D0], e_c0 = param[PW_HYPO_E_C0], e_i0 = param[PW_HYPO_E_I0];
  pw_real sin_c = sin(param[PW_HYPO_PHI_C] * DEGREE);
  pw_real a = sqrt(3.0) * (3.0 - sin_c) / (2.0 * sqrt(2.0) * sin_c);
  pw_real dense = pow((e_i0 - e_d0) / (e_c0 - e_d0), param[PW_HYPO_ALPHA]);
  h->p_t = param[PW_HYPO_P_T];
  h->inv_h_s = 1.0 / h_s;
  h->n = n;
  h->alpha = param[PW_HYPO_ALPHA];
  h->beta = beta;
  h->e_d0 = e_d0;
  h->e_i0 = e_i0;
  h->e_c0 = e_c0;
  h->log_e_c0 = log(e_c0);
  h->inv_e_i0 = 1.0 / e_i0;
  h->inv_e_range = 1.0 / (e_c0 - e_d0);
  h->a = a;
  h->a2 = a * a;
  h->k_b = h_s / n * pow(e_i0 / e_c0, beta) / (3.0 + a * a - sqrt(3.0) * a * dense);
  h->m_r = param[PW_HYPO_M_R];
  h->m_t = param[PW_HYPO_M_T];
  h->r = param[PW_HYPO_R];
  h->inv_r2 = 1.0 / (h->r * h->r);
  h->beta_r = param[PW_HYPO_BETA_R];
  h->chi = param[PW_HYPO_CHI];
  h->tolerance = param[PW_HYPO_TOLERANCE];
  h->p_min = param[PW_HYPO_P_MIN];
  pw_real sin_l = sin(param[PW_HYPO_PHI_LIMIT] * DEGREE);
  h->x_limit = (9.0 - sin_l * sin_l) / (1.0 - sin_l * sin_l);
  h->max_substeps = (int)param[PW_HYPO_MAX_SUBSTEPS];
  h->intergranular = param[PW_HYPO_INTERGRANULAR] > 0.5;
  h->inv_r = h->intergranular ? 1.0 / h->r : 0.0;
  bool unit = beta == 1.0 && (h->chi == 1.0 || !h->intergranular);
  h->form = (h->intergranular ? PW_HYPO_WITH : 0) + (unit ? PW_HYPO_UNIT : 0);
  h->near = 0.25 / pw_max(pw_max(1.0, h->alpha), beta); /* less for powers above one */
  h->speed_linear = h->intergranular ? 1.1 * h->m_r : 1.0;
  h->speed_n = h->intergranular ? 0.0 : 1.0;
}

void pw_hypo_evaluate(const pw_hypo *h, const pw_hypo_point *p, pw_t6 d, pw_hypo_rates *out)
{
  pw_t6 shifted = pw_t6_shift(p->stress, -h->p_t);
  pw_hypo_slope k =
      pw_hypo_slope_of(h, shifted, p->delta, p->void_ratio, d, pw_t6_norm(d), h->intergranular);
  pw_hypo_shape g = pw_hypo_shape_of(shifted);
  pw_hypo_factors c = pw_hypo_factors_of(h, &g, p->void_ratio, false);
  pw_real q = -g.trace * h->inv_h_s;
  pw_real inv_b = exp(pow(q, h->n));
  pw_real e0 = p->void_ratio * inv_b;
  e0 = pw_max(pw_min(e0, h->e_i0), 0.9 * h->e_d0);
  out->stress = k.stress;
  out->delta = k.delta;
  out->void_ratio = (1.0 + p->void_ratio) * pw_t6_trace(d);
  out->f_b = h->k_b * (1.0 + inv_b * h->inv_e_i0) * pow(q, 1.0 - h->n);
  out->f_e = pow(h->e_c0 / e0, h->beta);
  out->f_d = c.c_n * g.f / (c.c1 * h->a);
  out->f = g.f;
  out->tan_psi = sqrt(3.0 * g.np);
  out->cos_3theta = g.np > 1e-28 ? -sqrt(6.0) * 3.0 * g.j3 / (g.np * sqrt(g.np)) : 1.0;
  out->cos_3theta = pw_max(-1.0, pw_min(1.0, out->cos_3theta));
  out->modulus = pw_hypo_modulus(h, k);
}

bool pw_hypo_inside(const pw_hypo *h, pw_t6 shifted)
{
  return pw_hypo_inside_stress(h, shifted) > 0.0;
}

pw_t6 pw_hypo_limit(const pw_hypo *h, pw_t6 shifted)
{
  pw_real p = -pw_t6_trace(shifted) * (1.0 / 3.0);
  pw_t6 dev = pw_t6_shift(shifted, p);
  /* A hair above the least pressure, so that rounding does not put the result below it. */
  p = p >= h->p_min ? p : h->p_min * (1.0 + 1e-12);
  pw_real j2 = 0.5 * pw_t6_dot(dev, dev), j3 = -pw_t6_det(dev);
  pw_real low = 0.0, high = 1.0, size = 1.0;
  /* The accepted stresses are a convex cone: on a ray from its axis they end once. */
  for (int i = 0; i < 40; i++) {
    pw_real i2 = 3.0 * p * p - size * size * j2;
    pw_real i3 = p * (p * p - size * size * j2) + size * size * size * j3;
    bool inside = i2 > 0.0 && 3.0 * p * i2 <= h->x_limit * i3;
    if (inside && i == 0) {
      low = 1.0;
      break;
    }
    *(inside ? &low : &high) = size;
    size = 0.5 * (low + high);
  }
  return pw_t6_shift(pw_t6_scale(low, dev), -p);
}

pw_real pw_hypo_friction_angle(pw_t6 shifted)
{
  pw_real i1 = -pw_t6_trace(shifted), third = i1 * (1.0 / 3.0);
  pw_t6 dev = pw_t6_shift(shifted, third);
  pw_real j2 = 0.5 * pw_t6_dot(dev, dev), j3 = -pw_t6_det(dev);
  pw_real i2 = 3.0 * third * third - j2;
  pw_real i3 = third * (third * third - j2) + j3;
  if (!(i1 > 0.0 && i2 > 0.0 && i3 > 0.0)) {
    return 0.5 * PW_PI;
  }
  /* X - 9 from the deviator itself: it vanishes as its square. */
  pw_real above = (6.0 * third * j2 - 9.0 * j3) / i3;
  return asin(sqrt(pw_max(0.0, above) / (above + 8.0)));
}
