/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/mohr_coulomb.h
 * @brief Plasticity with planes in principal stress: Mohr-Coulomb, Tresca, tension (layer 1).
 *
 * With s1 >= s2 >= s3 (tension positive): f = (s1 - s3) + (s1 + s3) sin(phi) - 2 c cos(phi) <= 0
 * and s1 <= t. Flow follows the same planes with the dilation angle in the place of phi, and the
 * normals of the tension planes. Every active set of planes is returned to exactly: within one set
 * the stress is linear in the trial stress. Source: de Souza Neto, Peric, Owen, Computational
 * Methods for Plasticity, sections 8.2 and 8.3; Clausen, Damkilde, Andersen, Comput. Struct. 85
 * (2007) 1795-1807.
 */
#ifndef PW_KERNELS_MOHR_COULOMB_H
#define PW_KERNELS_MOHR_COULOMB_H

#include "kernels/material.h"
#include "kernels/tensor.h"

/** State variables: accumulated (largest - smallest) principal plastic strain increment, and with
 *  growth the depth at the start. */
enum { PW_MC_PLASTIC, PW_MC_DEPTH };

/** Derived constants; tension is PW_HUGE without a cut-off. */
typedef struct pw_mc {
  pw_real lambda, shear;     /**< at the reference height; Pa */
  pw_real sin_phi, sin_psi;  /**< - */
  pw_real strength;          /**< 2 c cos(phi) at the reference height; Pa */
  pw_real tension;           /**< t; Pa */
  pw_real stiffer, stronger; /**< relative growth per metre of depth; 1/m */
  bool graded;               /**< the depth is among the states */
} pw_mc;

/** @brief Stress update of a batch; as pw_material.update. */
pw_status pw_mc_update(const pw_mc *m, pw_stress_args *a);

/**
 * @brief Return of principal stresses.
 * @param[in]     m       constants at the point's own depth
 * @param[in]     trial   [3] s1 >= s2 >= s3; Pa
 * @param[out]    stress  [3] Pa
 * @param[out]    tangent [9] row-major d stress / d principal strain, or NULL; Pa
 * @return true when the trial stress was outside.
 */
bool pw_mc_return(const pw_mc *m, const pw_real *trial, pw_real *stress, pw_real *tangent);

#endif /* PW_KERNELS_MOHR_COULOMB_H */
