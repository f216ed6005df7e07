/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/hypoplastic_clay_rates.h
 * @brief The right-hand side of the hypoplastic clay model as branch-free functions (layer 1).
 *
 * Shared by the integration of one point and by that of several points at once.
 */
#ifndef PW_KERNELS_HYPOPLASTIC_CLAY_RATES_H
#define PW_KERNELS_HYPOPLASTIC_CLAY_RATES_H

#include "kernels/hypoplastic_clay.h"
#include "kernels/hypoplastic_rates.h"

/** L:x. */
PW_INLINE pw_t6 pw_clay_linear(const pw_clay *c, pw_t6 s, pw_t6 x)
{
  return pw_t6_axpy(pw_t6_scale(3.0 * c->c1, x), 3.0 * c->c2a * pw_t6_dot(s, x), s);
}

/** The scalar factors and N at a state given by its stress and ln(1 + e). */
typedef struct pw_clay_factors {
  pw_hypo_shape g;
  pw_t6 n; /* f_s f_d N; Pa */
  pw_real f_s, f_d, y;
} pw_clay_factors;

PW_INLINE pw_clay_factors pw_clay_factors_of(const pw_clay *c, pw_t6 stress, pw_real log_specific)
{
  pw_clay_factors k = {.g = pw_hypo_shape_of(stress)};
  const pw_real pressure = -k.g.trace * (1.0 / 3.0), ss = k.g.np + 1.0 / 3.0;
  const pw_real i3 = 1.0 / 27.0 - k.g.np * (1.0 / 6.0) + k.g.j3;
  const pw_real ratio = pw_max(k.g.f, 1e-6) * c->inv_a;
  k.f_s = c->stiff * pressure;
  /* ln(2 p/p_e) */
  pw_real log_state =
      pw_log(pressure * (2.0 / PW_CLAY_P_R)) + (log_specific - c->n) * c->inv_lambda;
  k.f_d = pw_exp(c->alpha * log_state);
  k.y = c->y_slope * (0.5 * (ss - 1.0) / i3 + 9.0) + c->y;
  pw_real on_s = 2.0 - (2.0 * ss - 1.0 / 3.0) / (ratio * ratio + ss); /* -m F/a = on_s s - 1/3 */
  pw_t6 m = pw_t6_shift(pw_t6_scale(on_s, k.g.s), -1.0 / 3.0);
  pw_real size = pw_min(k.f_d * k.y, PW_CLAY_N_MAX);
  k.n = pw_t6_scale(k.f_s * size / pw_t6_norm(m), pw_clay_linear(c, k.g.s, m));
  return k;
}

/** Rates of stress and intergranular strain for the strain rate @p d of norm @p size; @p with:
 *  c->intergranular, as a literal where the compiler can use it. */
PW_INLINE pw_clay_rates pw_clay_rates_of(const pw_clay *c, const pw_clay_factors *k, pw_t6 delta,
                                         pw_t6 d, pw_real size, bool with)
{
  pw_clay_rates out = {.n = k->n, .f_s = k->f_s, .f_d = k->f_d, .y = k->y};
  pw_t6 x = d;
  pw_real n_part = size;
  if (with) {
    pw_real dd = pw_max(pw_t6_dot(delta, delta), 1e-200), log_rho = 0.5 * pw_log(dd * c->inv_r2);
    pw_t6 dir = pw_t6_scale(1.0 / sqrt(dd), delta);
    pw_real turn = pw_t6_dot(dir, d), chi = pw_exp(c->chi * log_rho);
    pw_real loading = turn > 0.0 ? turn : 0.0;
    pw_real along_dir = chi * (turn > 0.0 ? 1.0 - c->m_t : c->m_r - c->m_t) * turn;
    x = pw_t6_axpy(pw_t6_scale(c->m_r + chi * (c->m_t - c->m_r), d), along_dir, dir);
    n_part = chi * loading;
    out.delta = pw_t6_axpy(d, -pw_exp(c->beta_r * log_rho) * loading, dir);
  }
  out.stress = pw_t6_axpy(pw_t6_scale(k->f_s, pw_clay_linear(c, k->g.s, x)), n_part, k->n);
  return out;
}

/** Modulus that no plane wave exceeds; Pa. As the sand's: M exceeds m_R L by a few per cent at most
 *  where the rates turn. */
PW_INLINE pw_real pw_clay_modulus(const pw_clay *c, const pw_clay_factors *k, bool with)
{
  pw_real s_max = 1.0 / 3.0 + pw_t6_largest_bound(0.5 * k->g.np, k->g.j3);
  pw_real modulus = 3.0 * k->f_s * (c->c1 + c->c2a * s_max * s_max);
  return with ? 1.1 * c->m_r * modulus : modulus + pw_t6_norm(k->n);
}

#endif /* PW_KERNELS_HYPOPLASTIC_CLAY_RATES_H */
