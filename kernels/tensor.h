/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/tensor.h
 * @brief Symmetric second-order tensors of six components as plain values (layer 1).
 *
 * Component order xx yy zz xy yz zx, shears as tensor components (half the engineering ones), so
 * that a:b counts each shear twice. Everything is inline and free of branches: the functions
 * stand inside loops over points.
 */
#ifndef PW_KERNELS_TENSOR_H
#define PW_KERNELS_TENSOR_H

#include "kernels/explog.h"

#include <math.h>

/** A symmetric tensor. */
typedef struct pw_t6 {
  pw_real xx, yy, zz, xy, yz, zx;
} pw_t6;

/** A rotation: x -> R x. */
typedef struct pw_rot {
  pw_real xx, xy, xz, yx, yy, yz, zx, zy, zz;
} pw_rot;

/** @brief Components c of a point stored at a[c * ld]. */
PW_INLINE pw_t6 pw_t6_load(const pw_real *a, size_t ld)
{
  return (pw_t6){a[0], a[ld], a[2 * ld], a[3 * ld], a[4 * ld], a[5 * ld]};
}

/** @brief The reverse of pw_t6_load(). */
PW_INLINE void pw_t6_store(pw_t6 t, pw_real *a, size_t ld)
{
  a[0] = t.xx;
  a[ld] = t.yy;
  a[2 * ld] = t.zz;
  a[3 * ld] = t.xy;
  a[4 * ld] = t.yz;
  a[5 * ld] = t.zx;
}

PW_INLINE pw_real pw_t6_trace(pw_t6 a)
{
  return a.xx + a.yy + a.zz;
}

/** @brief a:b. */
PW_INLINE pw_real pw_t6_dot(pw_t6 a, pw_t6 b)
{
  pw_real shear = PW_FMA(a.xy, b.xy, PW_FMA(a.yz, b.yz, a.zx * b.zx));
  return PW_FMA(2.0, shear, PW_FMA(a.xx, b.xx, PW_FMA(a.yy, b.yy, a.zz * b.zz)));
}

/** @brief Frobenius norm. */
PW_INLINE pw_real pw_t6_norm(pw_t6 a)
{
  return sqrt(pw_t6_dot(a, a));
}

/** @brief f a. */
PW_INLINE pw_t6 pw_t6_scale(pw_real f, pw_t6 a)
{
  return (pw_t6){f * a.xx, f * a.yy, f * a.zz, f * a.xy, f * a.yz, f * a.zx};
}

/** @brief a + f b. */
PW_INLINE pw_t6 pw_t6_axpy(pw_t6 a, pw_real f, pw_t6 b)
{
  return (pw_t6){PW_FMA(f, b.xx, a.xx), PW_FMA(f, b.yy, a.yy), PW_FMA(f, b.zz, a.zz),
                 PW_FMA(f, b.xy, a.xy), PW_FMA(f, b.yz, a.yz), PW_FMA(f, b.zx, a.zx)};
}

/** @brief a + f 1, with 1 the unit tensor. */
PW_INLINE pw_t6 pw_t6_shift(pw_t6 a, pw_real f)
{
  return (pw_t6){a.xx + f, a.yy + f, a.zz + f, a.xy, a.yz, a.zx};
}

PW_INLINE pw_real pw_t6_det(pw_t6 a)
{
  pw_real x = PW_FMA(a.yy, a.zz, -a.yz * a.yz), y = PW_FMA(a.yz, a.zx, -a.xy * a.zz);
  pw_real z = PW_FMA(a.xy, a.yz, -a.yy * a.zx);
  return PW_FMA(a.xx, x, PW_FMA(a.xy, y, a.zx * z));
}

/** @brief 1 when every component is a finite number, else 0. */
PW_INLINE pw_real pw_t6_is_finite(pw_t6 a)
{
  pw_real sum = (a.xx + a.yy + a.zz) + (a.xy + a.yz + a.zx);
  return sum - sum == 0.0 ? 1.0 : 0.0;
}

/** @brief a where flag > 0, else b. */
PW_INLINE pw_t6 pw_t6_select(pw_real flag, pw_t6 a, pw_t6 b)
{
  return (pw_t6){flag > 0.0 ? a.xx : b.xx, flag > 0.0 ? a.yy : b.yy, flag > 0.0 ? a.zz : b.zz,
                 flag > 0.0 ? a.xy : b.xy, flag > 0.0 ? a.yz : b.yz, flag > 0.0 ? a.zx : b.zx};
}

/**
 * @brief Largest eigenvalue of a deviator, from above.
 *
 * Newton iterations on l^3 - J2 l - J3 = 0 from the upper bound 2 sqrt(J2/3) fall monotonically
 * towards the largest root, so that every iterate is an upper bound. Three of them leave an
 * excess of at most 0.16 times the root (where two largest roots coincide), usually far less.
 * @param[in] j2  half of s':s'
 * @param[in] j3  det s'
 */
PW_INLINE pw_real pw_t6_largest_bound(pw_real j2, pw_real j3)
{
  pw_real root = 2.0 * sqrt(j2 * (1.0 / 3.0)) + 1e-150;
  for (int i = 0; i < 3; i++) {
    root = (2.0 * root * root * root + j3) / (3.0 * root * root - j2 + 1e-300);
  }
  return root;
}

/**
 * @brief Rotation of one step from its spin increment W dt, second order and exactly orthogonal.
 *
 * R = (1 - W/2)^-1 (1 + W/2). Source: Hughes, Winget, Int. J. Numer. Meth. Engng 15 (1980)
 * 1862-1867. With W x = w cross x this is 1 + (W + W W / 2) / (1 + w.w / 4).
 * @param[in] wxy,wyz,wzx  components xy, yz, zx of W dt; rad
 */
PW_INLINE pw_rot pw_rot_hughes_winget(pw_real wxy, pw_real wyz, pw_real wzx)
{
  pw_real a = wxy * wxy, b = wyz * wyz, c = wzx * wzx;
  pw_real f = 1.0 / (1.0 + 0.25 * (a + b + c)), g = 0.5 * f;
  return (pw_rot){.xx = 1.0 - g * (a + c),
                  .xy = f * wxy + g * wzx * wyz,
                  .xz = -f * wzx + g * wxy * wyz,
                  .yx = -f * wxy + g * wzx * wyz,
                  .yy = 1.0 - g * (a + b),
                  .yz = f * wyz + g * wxy * wzx,
                  .zx = f * wzx + g * wxy * wyz,
                  .zy = -f * wyz + g * wxy * wzx,
                  .zz = 1.0 - g * (b + c)};
}

/** @brief R a R^T. */
PW_INLINE pw_t6 pw_t6_rotate(pw_rot r, pw_t6 a)
{
  pw_real xx = r.xx * a.xx + r.xy * a.xy + r.xz * a.zx; /* rows of R a */
  pw_real xy = r.xx * a.xy + r.xy * a.yy + r.xz * a.yz;
  pw_real xz = r.xx * a.zx + r.xy * a.yz + r.xz * a.zz;
  pw_real yx = r.yx * a.xx + r.yy * a.xy + r.yz * a.zx;
  pw_real yy = r.yx * a.xy + r.yy * a.yy + r.yz * a.yz;
  pw_real yz = r.yx * a.zx + r.yy * a.yz + r.yz * a.zz;
  pw_real zx = r.zx * a.xx + r.zy * a.xy + r.zz * a.zx;
  pw_real zy = r.zx * a.xy + r.zy * a.yy + r.zz * a.yz;
  pw_real zz = r.zx * a.zx + r.zy * a.yz + r.zz * a.zz;
  return (pw_t6){.xx = xx * r.xx + xy * r.xy + xz * r.xz,
                 .yy = yx * r.yx + yy * r.yy + yz * r.yz,
                 .zz = zx * r.zx + zy * r.zy + zz * r.zz,
                 .xy = xx * r.yx + xy * r.yy + xz * r.yz,
                 .yz = yx * r.zx + yy * r.zy + yz * r.zz,
                 .zx = zx * r.xx + zy * r.xy + zz * r.xz};
}

/** @brief R a R^T for a spin of xy alone: the same operations without those on zeros, so that the
 *  result has the bits of pw_rot_hughes_winget() with pw_t6_rotate(). */
PW_INLINE pw_t6 pw_t6_rotate_plane(pw_real wxy, pw_t6 a)
{
  pw_real f = 1.0 / (1.0 + 0.25 * (wxy * wxy)), g = 0.5 * f;
  pw_real c = 1.0 - g * (wxy * wxy), s = f * wxy, r = -f * wxy;
  pw_real xx = c * a.xx + s * a.xy, xy = c * a.xy + s * a.yy; /* rows of R a */
  pw_real yx = r * a.xx + c * a.xy, yy = r * a.xy + c * a.yy;
  return (pw_t6){.xx = xx * c + xy * s,
                 .yy = yx * r + yy * c,
                 .zz = a.zz,
                 .xy = xx * r + xy * c,
                 .yz = r * a.zx + c * a.yz,
                 .zx = a.zx * c + a.yz * s};
}

/** @brief True when the spins yz and zx of all @p n points are exactly zero.
 *  @param[in] spin [3][ldi] xy, yz, zx; rad */
PW_INLINE bool pw_spin_is_plane(const pw_real *spin, size_t ldi, pw_idx n)
{
  pw_real sum = 0.0;
  for (pw_idx i = 0; i < n; i++) {
    sum += fabs(spin[ldi + (size_t)i]) + fabs(spin[2 * ldi + (size_t)i]);
  }
  return sum == 0.0;
}

/** @brief The first of @p n flags that is 0, or n. */
static inline pw_idx pw_first_zero(const pw_real *flag, pw_idx n)
{
  pw_idx i = 0;
  while (i < n && flag[i] > 0.0) {
    i++;
  }
  return i;
}

#endif /* PW_KERNELS_TENSOR_H */
