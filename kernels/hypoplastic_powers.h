/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/hypoplastic_powers.h
 * @brief The powers in the hypoplastic rates: of pressure, density and intergranular strain.
 *
 * They go through one logarithm per base; with B = exp(-x), x = (3p/h_s)^n, the void ratio enters
 * only as e/B, and e_i, e_c, e_d only as their values at zero pressure. At a state near another
 * those of pressure and density follow from that one by binomial series. Layer 1.
 */
#ifndef PW_KERNELS_HYPOPLASTIC_POWERS_H
#define PW_KERNELS_HYPOPLASTIC_POWERS_H

#include "kernels/hypoplastic.h"

/** Least ratio (e - e_d)/(e_c - e_d) for which f_d is a power; below, it falls linearly to 0. */
#define PW_HYPO_R_MIN 1e-3

/** Powers at one state. */
typedef struct pw_hypo_powers {
  pw_real trace;     /**< of sigma*; Pa */
  pw_real q_n;       /**< (3p/h_s)^n */
  pw_real inv_b;     /**< exp(q_n) */
  pw_real e0;        /**< what e would be at zero pressure on Bauer's curves */
  pw_real e0_e;      /**< the same, between 0.9 e_d0 and e_i0 */
  pw_real r, r_line; /**< (e - e_d)/(e_c - e_d), at least PW_HYPO_R_MIN; factor of f_d below it */
  pw_real stiff;     /**< (3p/h_s)^(1-n) (e_c/e)^beta */
  pw_real r_alpha;   /**< r^alpha */
  pw_real inv_norm;  /**< 1 / |delta| */
  pw_real rho_beta, rho_chi; /**< rho^beta_r, rho^chi */
} pw_hypo_powers;

/** @brief What follows from inv_b and the void ratio without a power. */
PW_INLINE void pw_hypo_density(const pw_hypo *h, pw_real void_ratio, pw_hypo_powers *p)
{
  p->e0 = void_ratio * p->inv_b;
  pw_real dense = p->e0 > h->e_i0 ? h->e_i0 : p->e0;
  p->e0_e = dense < 0.9 * h->e_d0 ? 0.9 * h->e_d0 : dense;
  pw_real r = (dense - h->e_d0) * h->inv_e_range;
  p->r = r > PW_HYPO_R_MIN ? r : PW_HYPO_R_MIN;
  p->r_line = r < PW_HYPO_R_MIN ? (r > 0.0 ? r * (1.0 / PW_HYPO_R_MIN) : 0.0) : 1.0;
}

/** @brief |delta|, not below a number whose square is one, and its powers. */
PW_INLINE void pw_hypo_mobilised(const pw_hypo *h, pw_t6 delta, int form, pw_hypo_powers *p)
{
  pw_real dd = pw_t6_dot(delta, delta);
  dd = dd > 1e-200 ? dd : 1e-200;
  p->inv_norm = 1.0 / sqrt(dd);
  pw_real log_rho = 0.5 * pw_log(dd * h->inv_r2);
  p->rho_beta = pw_exp(h->beta_r * log_rho);
  p->rho_chi = form & PW_HYPO_UNIT ? dd * p->inv_norm * h->inv_r : pw_exp(h->chi * log_rho);
}

/** @brief The powers at a state; @p form as in pw_hypo_slope_of(). */
PW_INLINE pw_hypo_powers pw_hypo_powers_of(const pw_hypo *h, pw_real trace, pw_real void_ratio,
                                           pw_t6 delta, int form)
{
  pw_hypo_powers p = {.trace = trace};
  pw_real q = -trace * h->inv_h_s;
  q = q > 1e-30 ? q : 1e-30;
  pw_real log_q = pw_log(q);
  p.q_n = pw_exp(h->n * log_q);
  p.inv_b = pw_exp(p.q_n);
  pw_hypo_density(h, void_ratio, &p);
  p.stiff = form & PW_HYPO_UNIT
                ? q * h->e_c0 / (p.q_n * p.e0_e)
                : pw_exp((1.0 - h->n) * log_q + h->beta * (h->log_e_c0 - pw_log(p.e0_e)));
  p.r_alpha = pw_exp(h->alpha * pw_log(p.r));
  if (form & PW_HYPO_WITH) {
    pw_hypo_mobilised(h, delta, form, &p);
  }
  return p;
}

/** @brief (1 + y)^a - 1 to the fourth power of y. */
PW_INLINE pw_real pw_hypo_binomial(pw_real y, pw_real a)
{
  pw_real s = PW_FMA(y, (a - 3.0) * 0.25, 1.0);
  s = PW_FMA(y * s, (a - 2.0) * (1.0 / 3.0), 1.0);
  s = PW_FMA(y * s, (a - 1.0) * 0.5, 1.0);
  return a * y * s;
}

/**
 * @brief The powers at a state near that of @p from, with intergranular strain.
 *
 * With ratios of the bases 1 + y, |y| <= h->near, the series leave a relative error below 4e-5
 * (largest |y|), which falls with the fifth power of y.
 * @param[in,out] close multiplied by 0 where a base has changed by more
 */
PW_INLINE pw_hypo_powers pw_hypo_powers_near(const pw_hypo *h, const pw_hypo_powers *from,
                                             pw_real trace, pw_real void_ratio, pw_t6 delta,
                                             int form, pw_real *close)
{
  pw_hypo_powers p = {.trace = trace};
  pw_real on_p = trace / from->trace - 1.0;
  pw_real dq = from->q_n * pw_hypo_binomial(on_p, h->n);
  p.q_n = from->q_n + dq;
  /* e^dq; q_n is below 1 for pressures below h_s / 3 */
  pw_real up = PW_FMA(dq, PW_FMA(dq, PW_FMA(dq, 1.0 / 24.0, 1.0 / 6.0), 0.5), 1.0);
  p.inv_b = PW_FMA(from->inv_b * dq, up, from->inv_b);
  pw_hypo_density(h, void_ratio, &p);
  pw_real on_e = 0.0, on_r = p.r / from->r - 1.0;
  if (form & PW_HYPO_UNIT) {
    p.stiff = -trace * h->inv_h_s * h->e_c0 / (p.q_n * p.e0_e);
  } else {
    on_e = p.e0_e / from->e0_e - 1.0;
    pw_real stiff = PW_FMA(from->stiff, pw_hypo_binomial(on_p, 1.0 - h->n), from->stiff);
    p.stiff = PW_FMA(stiff, pw_hypo_binomial(on_e, -h->beta), stiff);
  }
  p.r_alpha = PW_FMA(from->r_alpha, pw_hypo_binomial(on_r, h->alpha), from->r_alpha);
  pw_hypo_mobilised(h, delta, form, &p); /* |delta| may change by more than itself */
  pw_real most = fabs(on_p);
  most = most > fabs(on_r) ? most : fabs(on_r);
  most = most > fabs(on_e) ? most : fabs(on_e);
  *close = most <= h->near ? *close : 0.0;
  return p;
}

#endif /* PW_KERNELS_HYPOPLASTIC_POWERS_H */
