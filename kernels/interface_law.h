/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/interface_law.h
 * @brief Contact of a slave node with a two-node master segment: gap, force vectors, penalty law
 *        with Coulomb's cap (layer 1).
 *
 * The body of the master lies to the left of 1 -> 2, its outward normal e_n to the right. Vectors
 * of a pair have six components: slave x, y, node 1 x, y, node 2 x, y.
 * Source: Giridharan 2016, section 2.6.4, eq. 2.40-2.48, with three corrections: C_n is N alone,
 * which is the gradient of g_n (the printed N - (g_n/l) Q is not); the force on the nodes is MINUS
 * the sum of eq. 2.48, so that it pushes the slave out; the tangential part is capped by friction.
 */
#ifndef PW_KERNELS_INTERFACE_LAW_H
#define PW_KERNELS_INTERFACE_LAW_H

#include "engine/core/types.h"

#include <math.h>

/** A slave node against its place on a segment. */
typedef struct pw_pair {
  pw_real n[2], t[2]; /**< unit normal, out of the master, and tangent, along 1 -> 2 */
  pw_real gap;        /**< g_n, distance along n, < 0 where the bodies overlap; m */
  pw_real xi;         /**< place on the segment: 0 at node 1, 1 at node 2 */
  pw_real lever;      /**< length of the segment along t: arm of the couple P; m */
} pw_pair;

/**
 * @brief Project a slave on the line through a segment (eq. 2.42, 2.43); xi is not clamped.
 * @param[in] xs [2] slave; m
 * @param[in] x1 [2] first end of the segment; m
 * @param[in] x2 [2] second end, not at the first; m
 */
static inline pw_pair pw_pair_project(const pw_real *xs, const pw_real *x1, const pw_real *x2)
{
  pw_pair p;
  pw_real tx = x2[0] - x1[0], ty = x2[1] - x1[1];
  pw_real inv = 1.0 / sqrt(tx * tx + ty * ty);
  pw_real dx = xs[0] - x1[0], dy = xs[1] - x1[1];
  p.t[0] = tx * inv;
  p.t[1] = ty * inv;
  p.n[0] = p.t[1];
  p.n[1] = -p.t[0];
  p.gap = dx * p.n[0] + dy * p.n[1];
  p.xi = (dx * tx + dy * ty) * inv * inv;
  p.lever = 1.0 / inv;
  return p;
}

/**
 * @brief The vectors C_n = N and C_t = T + (g_n/l) P of eq. 2.46, 2.47.
 *
 * C_n is the gradient of the gap, C_t that of the slave's place along the segment, l grad xi: both
 * balance in force and in moment. Beyond one arm of overlap the couple P is held at its value
 * there, so that a short segment cannot be torn apart by it.
 * @param[out] cn [6] C_n; -
 * @param[out] ct [6] C_t; -
 */
static inline void pw_pair_vectors(const pw_pair *p, pw_real *cn, pw_real *ct)
{
  pw_real a = 1.0 - p->xi, b = p->xi;
  pw_real couple = p->gap < -p->lever ? -1.0 : p->gap / p->lever;
  for (int c = 0; c < 2; c++) {
    cn[c] = p->n[c];
    cn[2 + c] = -a * p->n[c];
    cn[4 + c] = -b * p->n[c];
    ct[c] = p->t[c];
    ct[2 + c] = -a * p->t[c] - couple * p->n[c];
    ct[4 + c] = -b * p->t[c] + couple * p->n[c];
  }
}

/** @brief Sum of products of two vectors of a pair. */
static inline pw_real pw_pair_dot(const pw_real *c, const pw_real *u)
{
  return (c[0] * u[0] + c[1] * u[1]) + (c[2] * u[2] + c[3] * u[3]) + (c[4] * u[4] + c[5] * u[5]);
}

/** @brief Contact pressure of an overlap: -omega g in contact, none when open; Pa.
 *  @param[in] omega normal stiffness; Pa per metre of overlap */
static inline pw_real pw_normal_pressure(pw_real omega, pw_real gap)
{
  return gap < 0.0 ? -omega * gap : 0.0;
}

/**
 * @brief Return map of Coulomb's law: hold the tangential spring within the cap.
 * @param[in]     omega tangential stiffness, > 0; Pa per metre
 * @param[in]     cap   friction coefficient times contact pressure, >= 0; Pa
 * @param[in,out] slip  stretch g_t of the tangential spring: trial in, admissible out; m
 * @return energy dissipated per area, cap times the slip that was not elastic, >= 0; J/m2.
 */
static inline pw_real pw_coulomb_return(pw_real omega, pw_real cap, pw_real *slip)
{
  pw_real trial = fabs(*slip), elastic = cap / omega;
  if (trial <= elastic) {
    return 0.0;
  }
  *slip = copysign(elastic, *slip);
  return cap * (trial - elastic);
}

/**
 * @brief Force of a pair on slave, node 1, node 2: F = -A (omega_n g_n C_n + omega_t g_t C_t).
 * @param[in]  pressure normal pressure, >= 0; Pa
 * @param[in]  shear    omega_t g_t; Pa
 * @param[in]  area     tributary area of the slave; m2 (per metre or radian)
 * @param[out] f        [6] N
 */
static inline void pw_pair_force(const pw_real *cn, const pw_real *ct, pw_real pressure,
                                 pw_real shear, pw_real area, pw_real *f)
{
  for (int c = 0; c < 6; c++) {
    f[c] = area * (pressure * cn[c] - shear * ct[c]);
  }
}

#endif /* PW_KERNELS_INTERFACE_LAW_H */
