/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/spectral.h
 * @brief Principal values, exponential and logarithm of symmetric tensors (layer 1).
 *
 * The functions named _plane need yz = zx = 0: they are free of branches and stand inside loops
 * over points. The general ones iterate and serve single points.
 */
#ifndef PW_KERNELS_SPECTRAL_H
#define PW_KERNELS_SPECTRAL_H

#include "kernels/tensor.h"

/** Principal values and directions of a tensor. */
typedef struct pw_spectrum {
  pw_real value[3];  /**< not sorted */
  pw_real vector[9]; /**< [3][3] vector[3 k ..] belongs to value[k] */
} pw_spectrum;

/**
 * @brief Principal values and directions by cyclic Jacobi rotations, accurate to round-off of the
 * largest value, whether or not values coincide. Source: Golub, Van Loan, Matrix Computations,
 * section 8.5.
 */
static inline pw_spectrum pw_t6_spectrum(pw_t6 a)
{
  pw_real m[3][3] = {{a.xx, a.xy, a.zx}, {a.xy, a.yy, a.yz}, {a.zx, a.yz, a.zz}};
  pw_spectrum s = {.vector = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  for (int sweep = 0; sweep < 12; sweep++) {
    pw_real off = fabs(m[0][1]) + fabs(m[0][2]) + fabs(m[1][2]);
    pw_real size = fabs(m[0][0]) + fabs(m[1][1]) + fabs(m[2][2]);
    if (!(off > 1e-20 * size)) {
      break;
    }
    for (int k = 0; k < 3; k++) {
      const int p = k == 2 ? 1 : 0, q = k == 0 ? 1 : 2, r = 3 - p - q;
      if (m[p][q] == 0.0) {
        continue;
      }
      pw_real theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
      pw_real t = copysign(1.0, theta) / (fabs(theta) + sqrt(theta * theta + 1.0));
      pw_real c = 1.0 / sqrt(t * t + 1.0), d = t * c, pr = m[p][r], qr = m[q][r];
      m[p][p] -= t * m[p][q];
      m[q][q] += t * m[p][q];
      m[p][q] = m[q][p] = 0.0;
      m[p][r] = m[r][p] = c * pr - d * qr;
      m[q][r] = m[r][q] = d * pr + c * qr;
      for (int i = 0; i < 3; i++) {
        pw_real vp = s.vector[3 * p + i], vq = s.vector[3 * q + i];
        s.vector[3 * p + i] = c * vp - d * vq;
        s.vector[3 * q + i] = d * vp + c * vq;
      }
    }
  }
  for (int k = 0; k < 3; k++) {
    s.value[k] = m[k][k];
  }
  return s;
}

/** @brief sum_k value[k] n_k n_k with the directions of @p s. */
static inline pw_t6 pw_spectrum_tensor(const pw_spectrum *s, const pw_real *value)
{
  pw_t6 t = {0};
  for (int k = 0; k < 3; k++) {
    const pw_real *n = s->vector + 3 * k;
    pw_t6 dyad = {n[0] * n[0], n[1] * n[1], n[2] * n[2], n[0] * n[1], n[1] * n[2], n[2] * n[0]};
    t = pw_t6_axpy(t, value[k], dyad);
  }
  return t;
}

/** @brief exp(2 a). */
static inline pw_t6 pw_t6_exp_twice(pw_t6 a)
{
  pw_spectrum s = pw_t6_spectrum(a);
  pw_real e[3] = {pw_exp(2.0 * s.value[0]), pw_exp(2.0 * s.value[1]), pw_exp(2.0 * s.value[2])};
  return pw_spectrum_tensor(&s, e);
}

/** @brief ln(b) / 2 for b with positive principal values; otherwise it holds NaN. */
static inline pw_t6 pw_t6_half_log(pw_t6 b)
{
  pw_spectrum s = pw_t6_spectrum(b);
  pw_real e[3];
  for (int k = 0; k < 3; k++) {
    e[k] = s.value[k] > 1e-300 ? 0.5 * pw_log(s.value[k]) : (pw_real)NAN;
  }
  return pw_spectrum_tensor(&s, e);
}

/** @brief sinh(r)/r for the square of r: a series for small r, where exponentials cancel. */
PW_INLINE pw_real pw_sinh_over(pw_real r2, pw_real r, pw_real exp_r)
{
  pw_real s = 1.0 / 1307674368000.0;
  s = PW_FMA(s, r2, 1.0 / 6227020800.0);
  s = PW_FMA(s, r2, 1.0 / 39916800.0);
  s = PW_FMA(s, r2, 1.0 / 362880.0);
  s = PW_FMA(s, r2, 1.0 / 5040.0);
  s = PW_FMA(s, r2, 1.0 / 120.0);
  s = PW_FMA(s, r2, 1.0 / 6.0);
  s = PW_FMA(s, r2, 1.0);
  pw_real full = 0.5 * (exp_r - 1.0 / exp_r) / (r + 1e-300);
  return r2 < 0.25 ? s : full;
}

/** @brief artanh(t)/t for the square of 0 <= t < 1; a series for small t. */
PW_INLINE pw_real pw_artanh_over(pw_real t2, pw_real t)
{
  pw_real s = 1.0 / 17.0;
  s = PW_FMA(s, t2, 1.0 / 15.0);
  s = PW_FMA(s, t2, 1.0 / 13.0);
  s = PW_FMA(s, t2, 1.0 / 11.0);
  s = PW_FMA(s, t2, 1.0 / 9.0);
  s = PW_FMA(s, t2, 1.0 / 7.0);
  s = PW_FMA(s, t2, 1.0 / 5.0);
  s = PW_FMA(s, t2, 1.0 / 3.0);
  s = PW_FMA(s, t2, 1.0);
  pw_real full = 0.5 * pw_log((1.0 + t) / (1.0 - t)) / (t + 1e-300);
  return t2 < 0.01 ? s : full;
}

/** @brief exp(2 a) for a with yz = zx = 0: with mean m and radius r in the plane,
 *  e^2m (cosh 2r 1 + sinh 2r / 2r (2 a - 2m 1)). */
PW_INLINE pw_t6 pw_t6_exp_twice_plane(pw_t6 a)
{
  pw_real d = a.xx - a.yy, c = 2.0 * a.xy, r2 = d * d + c * c, r = sqrt(r2), exp_r = pw_exp(r);
  pw_real size = pw_exp(a.xx + a.yy), cosh_r = 0.5 * (exp_r + 1.0 / exp_r);
  pw_real sinh_r = pw_sinh_over(r2, r, exp_r);
  return (pw_t6){.xx = size * (cosh_r + sinh_r * d),
                 .yy = size * (cosh_r - sinh_r * d),
                 .zz = pw_exp(2.0 * a.zz),
                 .xy = size * sinh_r * c};
}

/** @brief ln(b) / 2 for positive definite b with yz = zx = 0; holds NaN for any other b. */
PW_INLINE pw_t6 pw_t6_half_log_plane(pw_t6 b)
{
  pw_real m = 0.5 * (b.xx + b.yy), d = 0.5 * (b.xx - b.yy), r2 = d * d + b.xy * b.xy;
  pw_real r = sqrt(r2), inv = 1.0 / m, t = r * inv, det = (m - r) * (m + r);
  pw_real half = 0.5 * inv * pw_artanh_over(t * t, t), mean = 0.25 * pw_log(det);
  pw_real good = m > 1e-150 && det > 1e-300 && b.zz > 1e-300 ? 0.0 : (pw_real)NAN;
  return (pw_t6){.xx = mean + half * d + good,
                 .yy = mean - half * d,
                 .zz = 0.5 * pw_log(b.zz),
                 .xy = half * b.xy};
}

#endif /* PW_KERNELS_SPECTRAL_H */
