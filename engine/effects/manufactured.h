/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/manufactured.h
 * @brief Manufactured motions of a neo-Hookean body, and their body forces (layer 3).
 *
 * Material: P = lambda ln(J) F^-T + mu F^-1 (F F^T - I), c = sqrt(E / rho).
 * Axis aligned (Wallstedt and Guilkey, J. Comput. Phys. 227, 2008): the unit square 0 <= X, Y <= 1
 * with u_x = A sin(pi X) sin(c pi t), u_y = -A sin(pi Y) sin(c pi t).
 * Vortex (Kamojjala et al., Engng with Computers 31, 2015): the ring 0.75 <= R <= 1.25 turns by
 * alpha(R, t) = A g(t) H(R), H = ((4 R - 3)(4 R - 5))^2, g = sin(c pi t) or (1 - cos(2 pi c t)) / 2;
 * its rims do not move and carry no traction, and its volume does not change.
 * Both are motions of plane strain. Expanding ring (Wallstedt and Guilkey 2008), axisymmetric with
 * F_z = 1: 0.4 <= R <= 0.6 moves by u_r = A sin(c pi t) f(R), f = c3 R^3 + c2 R^2 + c1 R with
 * f' = 0 at both rims and f(0.6) = 1; without lateral contraction (lambda = 0) its rims carry no
 * traction.
 */
#ifndef PW_EFFECTS_MANUFACTURED_H
#define PW_EFFECTS_MANUFACTURED_H

#include "engine/core/types.h"

typedef struct pw_mms {
  int kind;           /**< pw_body_force_kind */
  int course;         /**< pw_mms_course of the vortex */
  pw_real amplitude;  /**< A: m (axis aligned, expanding ring), rad (vortex) */
  pw_real lambda, mu; /**< Lame constants; Pa */
  pw_real density;    /**< kg/m3 */
} pw_mms;

/** @brief sqrt(E / rho); m/s. */
pw_real pw_mms_speed(const pw_mms *m);

/** @brief Displacement at time @p t of the point that was at @p x0 [2], relative to the origin.
 *  @param[out] u [2] m */
void pw_mms_displacement(const pw_mms *m, const pw_real *x0, pw_real t, pw_real *u);

/** @brief Its velocity. @param[out] v [2] m/s */
void pw_mms_velocity(const pw_mms *m, const pw_real *x0, pw_real t, pw_real *v);

/** @brief The body force per mass that makes the motion a solution. @param[out] b [2] m/s2 */
void pw_mms_body_force(const pw_mms *m, const pw_real *x0, pw_real t, pw_real *b);

#endif /* PW_EFFECTS_MANUFACTURED_H */
