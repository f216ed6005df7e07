/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/tet_element.h
 * @brief Internal force and consistent tangent of one linear tetrahedron (layer 1).
 *
 * All points of a linear tetrahedron share the deformation increment and the gradients, so that
 * the element needs only sums over its points. With g the gradients of the shape functions where
 * the nodes are now, v the true volume of a point and sigma its Cauchy stress:
 *
 *   f_ai  = sum v sigma_ij g_aj
 *   K     = g_aj A_ijkl g_bl + (g_aj Q_ij) (T - t)_bk,   A = sum v a,   Q = sum v q
 *   a_ijkl = (1/J) d tau_ij / d F_km F_lm - sigma_il delta_jk,   q_ij = a_ijkk / 3 - 2/3 sigma_ij
 *
 * t_bk = g_bk belongs to the element and T is the mean of the t of all elements of the patch
 * weighted by their volumes; the second term is there with F-bar alone. Source: de Souza Neto,
 * Andrade Pires, Owen, Int. J. Numer. Meth. Engng 62 (2005) 353-383; Wang et al., equations 1-4,
 * with v_s / v_patch for v_e / v_patch in equation 3, where s is the other element.
 *
 * Matrices 3 x 3 are row-major; pairs of indices ij stand at 3 i + j.
 */
#ifndef PW_KERNELS_TET_ELEMENT_H
#define PW_KERNELS_TET_ELEMENT_H

#include "engine/core/types.h"

/** Where an element stands in an iteration. */
typedef struct pw_tet_motion {
  pw_real increment[9]; /**< F of the step so far */
  pw_real det;          /**< its determinant */
  pw_real g[12];        /**< [4][3] gradients where the nodes are now; 1/m. Not set if det <= 0 */
} pw_tet_motion;

/** Sums over the points of an element. */
typedef struct pw_tet_sums {
  pw_real stress[9];     /**< v sigma; N m */
  pw_real modulus[81];   /**< v a; N m */
  pw_real volumetric[9]; /**< v q; N m */
} pw_tet_sums;

/**
 * @brief F = 1 + sum u_a g0_a of the step, and the gradients it leads to.
 * @param[in] start [12] gradients at the start of the step; 1/m
 * @param[in] u     [12] displacements [4][3] of the nodes; m
 */
void pw_tet_motion_of(const pw_real *start, const pw_real *u, pw_tet_motion *out);

/**
 * @brief Add one point.
 * @param[in] volume  its true volume; m3
 * @param[in] stress  [6] Cauchy stress, stride @p ld; Pa
 * @param[in] tangent [36] d stress / d strain in the convention of kernels/material.h, stride @p ld,
 *                    or NULL: the stress alone is added; Pa
 */
void pw_tet_add_point(pw_real volume, const pw_real *stress, const pw_real *tangent, pw_idx ld,
                      pw_tet_sums *sums);

/** @brief Internal force [4][3]; N. */
void pw_tet_force(const pw_tet_sums *sums, const pw_real *g, pw_real *force);

/** @brief Tangent [12][12] of the force by the displacements without the term of the patch; N/m. */
void pw_tet_tangent(const pw_tet_sums *sums, const pw_real *g, pw_real *tangent);

/** @brief g_aj Q_ij, [4][3]: the force per unit of volumetric strain of the patch; N. */
void pw_tet_volumetric_force(const pw_tet_sums *sums, const pw_real *g, pw_real *force);

#endif /* PW_KERNELS_TET_ELEMENT_H */
