/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/rate_form.h
 * @brief What models with the Jaumann rate share: turned stress, trial stress, results (layer 1).
 *
 * sigma(n+1) = return(R sigma(n) R^T + C dE) with the rotation of the step R (Hughes, Winget 1980).
 */
#ifndef PW_KERNELS_RATE_FORM_H
#define PW_KERNELS_RATE_FORM_H

#include "kernels/material.h"
#include "kernels/tensor.h"

/** @brief Stress of point @p p before the step, turned with it.
 *  @param[in] plane the spin is xy alone: same bits with fewer operations */
PW_INLINE pw_t6 pw_rate_turned(const pw_stress_args *a, size_t p, bool plane)
{
  const size_t li = (size_t)a->ldi;
  pw_t6 old = pw_t6_load(a->stress + p, (size_t)a->ld);
  if (plane) {
    return pw_t6_rotate_plane(a->spin[p], old);
  }
  pw_rot r = pw_rot_hughes_winget(a->spin[p], a->spin[li + p], a->spin[2 * li + p]);
  return pw_t6_rotate(r, old);
}

/** @brief @p turned + lambda tr(dE) 1 + 2 shear dE. */
PW_INLINE pw_t6 pw_rate_trial(pw_t6 turned, pw_real lambda, pw_real shear, pw_t6 de)
{
  return pw_t6_shift(pw_t6_axpy(turned, 2.0 * shear, de), lambda * pw_t6_trace(de));
}

/** @brief Store the stress of point @p p when it is finite, and sqrt(modulus/density).
 *  @return 1 when stored, else 0: the point keeps its stress. */
PW_INLINE pw_real pw_rate_store(const pw_stress_args *a, size_t p, pw_t6 stress, pw_real modulus)
{
  const size_t l = (size_t)a->ld;
  pw_real good = pw_t6_is_finite(stress);
  pw_t6 old = pw_t6_load(a->stress + p, l);
  pw_t6_store(pw_t6_select(good, stress, old), a->stress + p, l);
  a->wave_speed[p] = sqrt(modulus / a->density[p]);
  return good;
}

/** @brief Tangent of point @p p from a row-major matrix [6][6] in Pa. */
static inline void pw_rate_store_tangent(const pw_stress_args *a, size_t p, const pw_real *matrix)
{
  for (size_t c = 0; c < 36; c++) {
    a->tangent[c * (size_t)a->ldi + p] = matrix[c];
  }
}

/** @brief Isotropic elastic matrix, row-major [6][6], engineering shear columns; Pa. */
static inline void pw_elastic_matrix(pw_real lambda, pw_real shear, pw_real *matrix)
{
  for (int c = 0; c < 36; c++) {
    int row = c / 6, col = c % 6;
    matrix[c] =
        (row < 3 && col < 3 ? lambda : 0.0) + (row == col ? (row < 3 ? 2.0 * shear : shear) : 0.0);
  }
}

/** @brief The arguments of @p n points of a batch from @p first on, for models in rate form. */
static inline pw_stress_args pw_rate_part(const pw_stress_args *a, pw_idx first, pw_idx n)
{
  pw_stress_args part = *a;
  part.n = n;
  part.dstrain += first;
  part.spin += first;
  part.dvol += first;
  part.density += first;
  part.stress += first;
  part.state = a->state ? a->state + first : NULL;
  part.wave_speed += first;
  part.guide = a->guide ? a->guide + first : NULL;
  part.tangent = a->tangent ? a->tangent + first : NULL;
  return part;
}

/** @brief True when neither spin nor stress nor strain of @p n points leaves the plane. */
static inline bool pw_rate_is_plane(const pw_stress_args *a, pw_idx first, pw_idx n)
{
  const size_t l = (size_t)a->ld, li = (size_t)a->ldi;
  const pw_real *s = a->stress + first, *d = a->dstrain + first, *w = a->spin + first;
  pw_real sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (pw_idx k = 0; k < n; k++) {
    const size_t i = (size_t)k;
    sum += fabs(s[4 * l + i]) + fabs(s[5 * l + i]) + fabs(d[4 * li + i]) + fabs(d[5 * li + i]) +
           fabs(w[li + i]) + fabs(w[2 * li + i]);
  }
  return sum == 0.0;
}

#endif /* PW_KERNELS_RATE_FORM_H */
