/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/tet_patch.h
 * @brief One patch of a model: its motion, stress, force and tangent (layer 3, internal).
 */
#ifndef PW_ENGINE_TET_PATCH_H
#define PW_ENGINE_TET_PATCH_H

#include "engine/tet_model.h"
#include "kernels/tet_element.h"

enum { PW_PATCH_ELEMENTS = 8 };

/** Motion of the elements of a patch; those without points are left out. */
typedef struct pw_patch_motion {
  pw_idx nactive;
  pw_tet_motion motion[PW_PATCH_ELEMENTS];
  pw_real volume[PW_PATCH_ELEMENTS]; /**< of the points now; m3 */
  bool active[PW_PATCH_ELEMENTS];
  pw_real ratio;    /**< v_patch / V_patch, or J_patch */
  pw_real now;      /**< v_patch; m3 */
  const char *why;  /**< out of pw_patch_evaluate(): what the material of the failing element says,
                         or NULL */
  pw_real rounding; /**< out of pw_patch_evaluate() with k: sum over the elements of the square of
                         sum v times modulus times length of the gradients; N2 */
} pw_patch_motion;

/** @brief Kinematics of patch @p p for displacements @p u [3][nnode].
 *  @return -1, or the first element that is turned inside out. */
pw_idx pw_patch_move(const pw_tet_model *m, pw_idx p, const pw_real *u, pw_patch_motion *out);

/**
 * @brief Trial stress of the points of patch @p p, then its force and matrix.
 * @param[out] force [PW_PATCH_DOFS] component c of node a at 3 a + c; N
 * @param[out] k     [PW_PATCH_DOFS][PW_PATCH_DOFS] N/m, or NULL
 * @return -1, or the first element with a point whose stress cannot be found.
 */
pw_idx pw_patch_evaluate(const pw_tet_model *m, pw_idx p, pw_patch_motion *motion, pw_real *force,
                         pw_real *k);

#endif /* PW_ENGINE_TET_PATCH_H */
