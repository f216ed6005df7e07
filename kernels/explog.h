/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/explog.h
 * @brief Branch-free exponential and logarithm for loops over points (layer 1).
 *
 * The library's exp() and log() keep a loop from being vectorised, and nothing in C promises that
 * their vector forms round as the scalar ones do. These use arithmetic and integer operations
 * only, so that a value never depends on the lane that computes it. Relative error below 4e-16
 * (measured); test_material_explog_is_accurate.c asserts 1e-15 over the whole range.
 */
#ifndef PW_KERNELS_EXPLOG_H
#define PW_KERNELS_EXPLOG_H

#include "engine/core/types.h"

#include <string.h>

/** Inlined whatever the size: a loop over points is vectorised only when it calls nothing. */
#define PW_INLINE static inline __attribute__((always_inline))

/** a b + c, rounded once where the processor has the instruction. Written out, because the choice
 *  must not be the optimiser's, which may differ between the scalar and the vector form. */
#if defined(__FMA__) || defined(__ARM_FEATURE_FMA)
#define PW_FMA(a, b, c) __builtin_fma(a, b, c)
#else
#define PW_FMA(a, b, c) ((a) * (b) + (c))
#endif

/** ln 2 split so that k times the first part is exact for every exponent k. */
#define PW_LN2_HI 0x1.62e42fefa3800p-1
#define PW_LN2_LO 0x1.ef35793c76730p-45

/** @brief e^x for |x| <= 700; the argument is clamped to that range (NaN stays NaN). */
PW_INLINE pw_real pw_exp(pw_real x)
{
  const pw_real magic = 0x1.8p52; /* adding it rounds to an integer in the low bits */
  pw_real y = x > 700.0 ? 700.0 : x;
  y = y < -700.0 ? -700.0 : y;
  pw_real shifted = PW_FMA(y, 0x1.71547652b82fep0, magic);
  pw_real k = shifted - magic;
  pw_real r = PW_FMA(-k, PW_LN2_LO, PW_FMA(-k, PW_LN2_HI, y)); /* |r| <= ln 2 / 2 */
  pw_real r2 = r * r, r4 = r2 * r2, r8 = r4 * r4;
  /* (e^r - 1 - r) / r^2 as a polynomial fitted in Chebyshev points; its error is 1.3e-17. */
  pw_real p01 = PW_FMA(r, 0.16666666666666667452, 0.50000000000000010211);
  pw_real p23 = PW_FMA(r, 0.0083333333333300644495, 0.041666666666624161903);
  pw_real p45 = PW_FMA(r, 0.00019841269863040545271, 0.0013888888917196719077);
  pw_real p67 = PW_FMA(r, 2.7557268480310025526e-6, 2.4801521322368693266e-5);
  pw_real p89 = PW_FMA(r, 2.5100375832561233664e-8, 2.7620075879983366586e-7);
  pw_real low = PW_FMA(r2, p23, p01), high = PW_FMA(r2, p67, p45);
  pw_real p = PW_FMA(r8, p89, PW_FMA(r4, high, low));
  pw_real sum = 1.0 + PW_FMA(r2, p, r);
  uint64_t bits, scale;
  memcpy(&bits, &shifted, sizeof bits);
  memcpy(&scale, &sum, sizeof scale);
  scale += bits << 52;
  memcpy(&sum, &scale, sizeof sum);
  return sum;
}

/** @brief ln x for a normal x > 0; NaN stays NaN, other arguments give a meaningless number. */
PW_INLINE pw_real pw_log(pw_real x)
{
  const uint64_t half_root = 0x3fe6a09e667f3bcdu; /* bits of sqrt(1/2) */
  const uint64_t exponent = 0xfff0000000000000u;
  uint64_t bits, scale, kbits;
  memcpy(&bits, &x, sizeof bits);
  scale = (bits - half_root) & exponent; /* x = 2^k m with sqrt(1/2) <= m < sqrt(2) */
  bits -= scale;
  /* k + 1024 is positive: as the low bits of 2^52 it becomes a double without a conversion. */
  kbits = ((scale + (1024ull << 52)) >> 52) | 0x4330000000000000u;
  pw_real m, k;
  memcpy(&m, &bits, sizeof m);
  memcpy(&k, &kbits, sizeof k);
  k -= 0x1p52 + 1024.0;
  pw_real f = m - 1.0, s = f / (2.0 + f), z = s * s, z2 = z * z;
  /* ln m = 2 artanh s; (artanh(s)/s - 1)/s^2 is a polynomial in s^2 fitted in Chebyshev points
   * with an error of 4.6e-18 in artanh(s)/s. */
  pw_real p01 = PW_FMA(z, 0.19999999999949752245, 0.33333333333333348431);
  pw_real p23 = PW_FMA(z, 0.11111105567397539928, 0.14285714312987742461);
  pw_real p45 = PW_FMA(z, 0.076658608002780206343, 0.090914445626308610401);
  pw_real high = PW_FMA(z2, 0.073082248425217029302, p45);
  pw_real p = PW_FMA(z2, PW_FMA(z2, high, p23), p01);
  pw_real s2 = s + s;
  pw_real tail = PW_FMA(k, PW_LN2_LO, x - x); /* x - x: 0, or NaN for a NaN */
  return PW_FMA(k, PW_LN2_HI, s2 + PW_FMA(s2 * z, p, tail));
}

/** @brief exp(x) - 1; a series for small x, where the difference cancels. */
PW_INLINE pw_real pw_exp_less_one(pw_real x)
{
  pw_real s = 1.0 / 6227020800.0; /* 13! */
  s = PW_FMA(s, x, 1.0 / 479001600.0);
  s = PW_FMA(s, x, 1.0 / 39916800.0);
  s = PW_FMA(s, x, 1.0 / 3628800.0);
  s = PW_FMA(s, x, 1.0 / 362880.0);
  s = PW_FMA(s, x, 1.0 / 40320.0);
  s = PW_FMA(s, x, 1.0 / 5040.0);
  s = PW_FMA(s, x, 1.0 / 720.0);
  s = PW_FMA(s, x, 1.0 / 120.0);
  s = PW_FMA(s, x, 1.0 / 24.0);
  s = PW_FMA(s, x, 1.0 / 6.0);
  s = PW_FMA(s, x, 0.5);
  s = PW_FMA(s, x, 1.0);
  pw_real full = pw_exp(x) - 1.0;
  return x * x < 0.0625 ? x * s : full;
}

#endif /* PW_KERNELS_EXPLOG_H */
