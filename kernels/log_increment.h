/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/log_increment.h
 * @brief Finite increments of models in rate form: logarithmic strain and rotation (layer 1).
 *
 * Models in rate form take an increment of strain and one of spin. From the deformation gradient
 * F = V R of a step they get ln V and the rotation R: rigid rotations of any size are exact, the
 * trace of the strain is ln det F, and a step without rotation of the axes is one in logarithmic
 * strain. Steps of an implicit calculation are large enough for this to matter; the symmetric part
 * of F - 1 would take a rotation by a for a compression of a^2/2.
 *
 * Tangent. A further strain e, F <- (1 + e) F, changes in the axes of V, with x = ln V_i - ln V_j,
 *
 *     ln V by x coth(x) e_ij,   R by W R with W_ij = -tanh(x/2) e_ij.
 *
 * An isotropic model turns with its arguments, so that all that W does to the stress and state at
 * the start is W sigma - sigma W less what turning ln V alone would do, and
 *
 *     d sigma = D : (x / sinh(x) e) + W sigma - sigma W,   D = d sigma / d ln V.
 */
#ifndef PW_KERNELS_LOG_INCREMENT_H
#define PW_KERNELS_LOG_INCREMENT_H

#include "engine/core/types.h"

/** The increment of a step, tensors in the order xx yy zz xy yz zx. */
typedef struct pw_log_increment {
  pw_real strain[6]; /**< ln V, tensor shears; - */
  pw_real spin[3];   /**< xy, yz, zx of W with R = (1 - W/2)^-1 (1 + W/2); rad */
  pw_real seen[36];  /**< [6][6] rows: what D takes of e, both with engineering shears */
  pw_real turn[18];  /**< [3][6] rows: W by e with engineering shears */
} pw_log_increment;

/** @brief Increment of a deformation gradient @p f [9] (row-major) with a positive determinant and
 *  a rotation of less than half a turn. */
void pw_log_increment_of(const pw_real *f, pw_log_increment *out);

/**
 * @brief From d sigma / d ln V to d sigma / d e.
 * @param[in]     stress  [6] at the end of the step, stride @p ld; Pa
 * @param[in,out] tangent [36] row-major with engineering shear columns, stride @p ld; Pa
 */
void pw_log_increment_tangent(const pw_log_increment *inc, const pw_real *stress, pw_real *tangent,
                              size_t ld);

#endif /* PW_KERNELS_LOG_INCREMENT_H */
