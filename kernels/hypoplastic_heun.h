/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/hypoplastic_heun.h
 * @brief A small increment as one step of Heun's method instead of three stages (layer 1).
 *
 * y1 = y0 + (k1 + k2)/2 with k1 = f(y0), k2 = f(y0 + k1); the error of the Euler step, |k2 - k1|/2,
 * is its estimate. The step is of second order: its own error is smaller by |dE|/R. The powers of
 * pressure and density in k2 follow from those in k1. Without intergranular strain the rates vary so
 * little that three stages are nearly exact, and no other step is offered.
 */
#ifndef PW_KERNELS_HYPOPLASTIC_HEUN_H
#define PW_KERNELS_HYPOPLASTIC_HEUN_H

#include "kernels/hypoplastic_rates.h"

/** An increment. */
typedef struct pw_hypo_increment {
  pw_t6 de;
  pw_real size;   /**< |de| */
  pw_real e0, e1; /**< void ratio at its start and end */
} pw_hypo_increment;

/** One step. */
typedef struct pw_hypo_heun {
  pw_t6 stress, delta; /**< at its end */
  pw_hypo_slope last;  /**< k2 */
  pw_real good;        /**< 1 when it is within the tolerance, meets no limit, and the powers may be
                            taken from those of k1; else 0 */
} pw_hypo_heun;

/** @brief 1 for an increment whose step is likely to be within the tolerance, else 0: delta turns by
 *  x = |dE|/R at most, and its rate by about as much. */
PW_INLINE pw_real pw_hypo_heun_pays(const pw_hypo *h, pw_real size)
{
  return size * size * h->inv_r2 <= h->tolerance ? 1.0 : 0.0;
}

/** @brief The end of the step from both rates; its error in the measures of a substep. */
PW_INLINE void pw_hypo_heun_end(const pw_hypo *h, pw_t6 stress, pw_t6 delta,
                                const pw_hypo_slope *k1, pw_hypo_heun *out)
{
  pw_t6 err = pw_t6_axpy(out->last.stress, -1.0, k1->stress);
  pw_t6 err_delta = pw_t6_axpy(out->last.delta, -1.0, k1->delta);
  out->stress = pw_t6_axpy(pw_t6_axpy(stress, 0.5, k1->stress), 0.5, out->last.stress);
  delta = pw_t6_axpy(pw_t6_axpy(delta, 0.5, k1->delta), 0.5, out->last.delta);
  /* |delta| exceeds R by the error of the step at most: its factor is a series */
  pw_real over = pw_t6_dot(delta, delta) * h->inv_r2 - 1.0;
  over = over > 0.0 ? over : 0.0;
  out->delta = pw_t6_scale(1.0 + pw_hypo_binomial(over, -0.5), delta);
  pw_real size = pw_t6_norm(out->stress) + 1000.0, most = 4.0 * h->tolerance * h->tolerance;
  pw_real within = pw_t6_dot(err_delta, err_delta) * h->inv_r2 <= most ? out->good : 0.0;
  within = pw_t6_dot(err, err) <= most * size * size ? within : 0.0;
  out->good = within * pw_hypo_inside_stress(h, out->stress);
}

/** @brief One step over an increment, with intergranular strain.
 *  @param[in] stress sigma* at its start; Pa; delta: the intergranular strain there
 *  @param[in] form   as in pw_hypo_slope_of() */
PW_INLINE pw_hypo_heun pw_hypo_heun_step(const pw_hypo *h, pw_t6 stress, pw_t6 delta,
                                         pw_hypo_increment whole, int form)
{
  const pw_t6 de = whole.de;
  pw_hypo_shape g1 = pw_hypo_shape_of(stress);
  pw_hypo_powers p1 = pw_hypo_powers_of(h, g1.trace, whole.e0, delta, form);
  pw_hypo_slope k1 = pw_hypo_slope_from(h, &g1, &p1, delta, de, whole.size, form);
  pw_hypo_heun out = {.good = k1.inside};
  pw_t6 end = pw_t6_axpy(stress, 1.0, k1.stress), end_delta = pw_t6_axpy(delta, 1.0, k1.delta);
  pw_hypo_shape g2 = pw_hypo_shape_of(end);
  pw_hypo_powers p2 = pw_hypo_powers_near(h, &p1, g2.trace, whole.e1, end_delta, form, &out.good);
  out.last = pw_hypo_slope_from(h, &g2, &p2, end_delta, de, whole.size, form);
  out.good *= out.last.inside;
  pw_hypo_heun_end(h, stress, delta, &k1, &out);
  return out;
}

#endif /* PW_KERNELS_HYPOPLASTIC_HEUN_H */
