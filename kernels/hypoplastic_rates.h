/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/hypoplastic_rates.h
 * @brief The right-hand side of the hypoplastic model as one branch-free function (layer 1).
 *
 * Shared by the integration of one point and by that of a chunk of points, so that both give the
 * same bits.
 */
#ifndef PW_KERNELS_HYPOPLASTIC_RATES_H
#define PW_KERNELS_HYPOPLASTIC_RATES_H

#include "kernels/hypoplastic_powers.h"

/** Smallest substep, as a fraction of the increment. */
#define PW_HYPO_SUBSTEP_MIN 1e-5

/** Increments beyond this many R may bring delta to full mobilisation on the way. */
#define PW_HYPO_SWEEP 5.0

/** Normalised stress s = sigma* / tr sigma* and what follows from its invariants. */
typedef struct pw_hypo_shape {
  pw_t6 s;
  pw_real trace;  /**< of sigma*; negative in compression; Pa */
  pw_real np, j3; /**< s':s' and det s' */
  pw_real inv_ss; /**< 1 / s:s */
  pw_real f;      /**< F of Matsuoka-Nakai */
} pw_hypo_shape;

/** Scalar factors at one state: L:x = c1 x + c2 (s:x) s, N = c_n (s + s'). */
typedef struct pw_hypo_factors {
  pw_real c1, c2, c_n;
  pw_real fade; /**< of the stiffness of points looser than e_i */
} pw_hypo_factors;

/** Rates of one state. */
typedef struct pw_hypo_slope {
  pw_t6 stress, delta;
  pw_real inside;              /**< 1 when the state keeps the limits of stress, else 0 */
  pw_real c1, c2, c_n, np, j3; /**< what pw_hypo_modulus() needs */
} pw_hypo_slope;

PW_INLINE pw_hypo_shape pw_hypo_shape_of(pw_t6 shifted)
{
  pw_hypo_shape g;
  g.trace = pw_t6_trace(shifted);
  g.s = pw_t6_scale(1.0 / g.trace, shifted);
  pw_t6 dev = pw_t6_shift(g.s, -1.0 / 3.0);
  g.np = pw_t6_dot(dev, dev);
  g.j3 = pw_t6_det(dev);
  /* sqrt2 tan psi cos 3theta = -18 det s' / |s'|^2; it vanishes with s' */
  pw_real t2 = 3.0 * g.np, guarded = g.np + 1e-60, ss = g.np + 1.0 / 3.0;
  pw_real under = 2.0 * guarded - 18.0 * g.j3, inv = 1.0 / (under * ss); /* two inverses in one */
  pw_real root = 0.125 * t2 + (2.0 - t2) * guarded * (inv * ss);
  g.inv_ss = inv * under;
  g.f = sqrt(root > 0.0 ? root : 0.0) - sqrt(t2) * 0.35355339059327376220; /* 1/(2 sqrt2) */
  return g;
}

/** @brief 1 when p* >= p_min and I1 I2 / I3 <= x_limit with I1, I2, I3 of -sigma* positive. */
PW_INLINE pw_real pw_hypo_inside_shape(const pw_hypo *h, const pw_hypo_shape *g)
{
  pw_real i2 = 1.0 / 3.0 - 0.5 * g->np; /* I1 = 1 */
  pw_real i3 = 1.0 / 27.0 - g->np * (1.0 / 6.0) + g->j3;
  pw_real pressure = -g->trace >= 3.0 * h->p_min ? 1.0 : 0.0;
  pw_real ratio = i2 <= h->x_limit * i3 ? 1.0 : 0.0;
  return i2 > 0.0 ? pressure * ratio : 0.0;
}

/** @brief The same for a stress sigma*, without divisions. */
PW_INLINE pw_real pw_hypo_inside_stress(const pw_hypo *h, pw_t6 shifted)
{
  pw_real i1 = -pw_t6_trace(shifted), third = i1 * (1.0 / 3.0);
  pw_t6 dev = pw_t6_shift(shifted, third);
  pw_real j2 = 0.5 * pw_t6_dot(dev, dev), j3 = -pw_t6_det(dev);
  pw_real i2 = 3.0 * third * third - j2;
  pw_real i3 = third * (third * third - j2) + j3;
  pw_real pressure = i1 >= 3.0 * h->p_min ? 1.0 : 0.0;
  pw_real ratio = i1 * i2 <= h->x_limit * i3 ? 1.0 : 0.0;
  return i2 > 0.0 ? pressure * ratio : 0.0;
}

/** @brief Scalar factors from the shape of the stress and the powers. */
PW_INLINE pw_hypo_factors pw_hypo_factors_from(const pw_hypo *h, const pw_hypo_shape *g,
                                               const pw_hypo_powers *p)
{
  pw_real loose = 2.0 * (p->e0 * h->inv_e_i0 - 1.0);
  pw_real fbe = h->k_b * (1.0 + p->inv_b * h->inv_e_i0) * p->stiff; /* f_b f_e */
  pw_real common = fbe * g->inv_ss;
  pw_hypo_factors k;
  k.fade = loose <= 0.0 ? 1.0 : (loose < 1.0 ? 1.0 - loose : 0.0);
  k.c1 = common * g->f * g->f;
  k.c2 = common * h->a2;
  k.c_n = common * (p->r_alpha * p->r_line) * h->a * g->f;
  return k;
}

PW_INLINE pw_hypo_factors pw_hypo_factors_of(const pw_hypo *h, const pw_hypo_shape *g,
                                             pw_real void_ratio, bool unit)
{
  pw_hypo_powers p =
      pw_hypo_powers_of(h, g->trace, void_ratio, (pw_t6){0}, unit ? PW_HYPO_UNIT : 0);
  return pw_hypo_factors_from(h, g, &p);
}

/**
 * @brief Rates of stress and intergranular strain from the shape of the stress and the powers.
 * @param[in] delta          intergranular strain; unused without it
 * @param[in] d              strain rate; d_norm: its Frobenius norm
 * @param[in] form           h->form, as a literal where the compiler can use it
 */
PW_INLINE pw_hypo_slope pw_hypo_slope_from(const pw_hypo *h, const pw_hypo_shape *g,
                                           const pw_hypo_powers *p, pw_t6 delta, pw_t6 d,
                                           pw_real d_norm, int form)
{
  pw_hypo_factors k = pw_hypo_factors_from(h, g, p);
  pw_hypo_slope out;
  pw_real along_d = 1.0, along_dir = 0.0, n_part = d_norm; /* of L:D, L:d and N */
  pw_t6 dir = {0};
  pw_real s_dir = 0.0;
  out.delta = d;
  if (form & PW_HYPO_WITH) {
    dir = pw_t6_scale(p->inv_norm, delta);
    pw_real turn = pw_t6_dot(dir, d); /* d:D */
    pw_real loading = turn > 0.0 ? turn : 0.0;
    along_d = h->m_r + p->rho_chi * (h->m_t - h->m_r);
    along_dir = p->rho_chi * (turn > 0.0 ? 1.0 - h->m_t : h->m_r - h->m_t) * turn;
    n_part = p->rho_chi * loading;
    s_dir = pw_t6_dot(g->s, dir);
    out.delta = pw_t6_axpy(d, -p->rho_beta * loading, dir);
  }
  pw_real s_d = pw_t6_dot(g->s, d);
  pw_real n_coef = k.c_n * n_part; /* N = c_n (2 s - 1/3) */
  pw_real on_s = k.c2 * (along_d * s_d + along_dir * s_dir) + 2.0 * n_coef;
  pw_t6 x = pw_t6_scale(k.c1 * along_d, d);
  x = pw_t6_axpy(x, k.c1 * along_dir, dir);
  x = pw_t6_shift(pw_t6_axpy(x, on_s, g->s), -n_coef * (1.0 / 3.0));
  out.stress = pw_t6_scale(k.fade, x);
  out.inside = pw_hypo_inside_shape(h, g);
  out.c1 = k.c1;
  out.c2 = k.c2;
  out.c_n = k.c_n;
  out.np = g->np;
  out.j3 = g->j3;
  return out;
}

/** @brief The same at a state. @param[in] shifted sigma*; Pa */
PW_INLINE pw_hypo_slope pw_hypo_slope_of(const pw_hypo *h, pw_t6 shifted, pw_t6 delta,
                                         pw_real void_ratio, pw_t6 d, pw_real d_norm, int form)
{
  pw_hypo_shape g = pw_hypo_shape_of(shifted);
  pw_hypo_powers p = pw_hypo_powers_of(h, g.trace, void_ratio, delta, form);
  return pw_hypo_slope_from(h, &g, &p, delta, d, d_norm, form);
}

/**
 * @brief Modulus that no plane wave exceeds at the state of a slope; Pa.
 *
 * For a wave along n moving along a, D = sym(a n) has |D| <= 1, a.s.n <= s_max, and N:D is at most
 * the largest principal value of N: d:(L:d + N |d|) <= c1 + c2 s_max^2 + c_n (2 s_max - 1/3). With
 * intergranular strain M exceeds m_R L by 5.4 % at most, found numerically: a tenth is added.
 */
PW_INLINE pw_real pw_hypo_modulus(const pw_hypo *h, pw_hypo_slope k)
{
  pw_real s_max = 1.0 / 3.0 + pw_t6_largest_bound(0.5 * k.np, k.j3);
  pw_real linear = k.c1 + k.c2 * s_max * s_max;
  return h->speed_linear * linear + h->speed_n * k.c_n * (2.0 * s_max - 1.0 / 3.0);
}

/** @brief |delta| never exceeds R; only rounding and the truncation of a step would make it. */
PW_INLINE pw_t6 pw_hypo_clip(const pw_hypo *h, pw_t6 delta)
{
  pw_real rho2 = pw_t6_dot(delta, delta) * h->inv_r2;
  return pw_t6_scale(rho2 > 1.0 ? 1.0 / sqrt(rho2) : 1.0, delta);
}

/** @brief Substep to try after one of size @p step with the error @p err, of order 3. */
PW_INLINE pw_real pw_hypo_next_substep(const pw_hypo *h, pw_real step, pw_real err)
{
  pw_real ratio = h->tolerance / (err > 1e-30 ? err : 1e-30);
  pw_real factor = 0.9 * pw_exp(pw_log(ratio) * (1.0 / 3.0));
  factor = factor < 0.2 ? 0.2 : (factor < 4.0 ? factor : 4.0);
  pw_real next = step * factor;
  next = next > PW_HYPO_SUBSTEP_MIN ? next : PW_HYPO_SUBSTEP_MIN;
  return next < 1.0 ? next : 1.0;
}

/** @brief Time at which delta:D changes sign, 0 if it does not: as long as delta:D <= 0, delta
 *  moves along D and the product grows linearly. */
PW_INLINE pw_real pw_hypo_turning_time(pw_t6 delta, pw_t6 de)
{
  pw_real size2 = pw_t6_dot(de, de), turn = -pw_t6_dot(delta, de);
  turn = size2 > 0.0 ? turn / size2 : 0.0;
  return turn > 1e-6 ? (turn < 1.0 - 1e-6 ? turn : 0.0) : 0.0;
}

#endif /* PW_KERNELS_HYPOPLASTIC_RATES_H */
