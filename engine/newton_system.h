/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/newton_system.h
 * @brief What Newton's method works on: a model of tetrahedra or of quadrilaterals (layer 3).
 *
 * The driver (engine/step_newton.h) sees a model through its nodal arrays and a handful of calls.
 * Arrays are borrowed as long as the driver lives; component c of node a is at [c * nnode + a].
 */
#ifndef PW_ENGINE_NEWTON_SYSTEM_H
#define PW_ENGINE_NEWTON_SYSTEM_H

#include "engine/csr.h"

typedef struct pw_newton_system {
  void *ctx;                 /**< the model, handed to the calls below */
  size_t dofs;               /**< components of all nodes */
  const pw_csr *csr;         /**< tangent of the last evaluation */
  const pw_idx *equation;    /**< [dofs] row, or -1 */
  const uint8_t *fixed;      /**< [dofs] not 0: displacement prescribed */
  const pw_real *prescribed; /**< [dofs] displacement over the part where fixed; m */
  const pw_real *external;   /**< [dofs] force at the end of the part; N */
  const pw_real *follow;     /**< [dofs] load that follows the motion, of the last evaluation; NULL:
                                  none; N */
  const pw_real *force;      /**< [dofs] internal force of the last evaluation; N */
  const pw_real
      *inertia;        /**< [dofs] force of inertia of the last evaluation; NULL: quasi-static, or
                                  a model whose rates the driver keeps itself; N */
  const pw_real *lift; /**< [dofs] tangent times prescribed where fixed; N */
  const pw_real *rounding; /**< norm of the forces that rounding of strains may leave; N */
  pw_real *time, *dt;      /**< start and length of the part, set by the driver; s */
  const pw_real *x;        /**< [3][nnode] where nodes are, for multigrid; m */
  bool symmetric;          /**< the tangent */
  /** @brief Begin a part: weights of points, equations. */
  pw_status (*begin)(void *ctx);
  /** @brief Forces and, when asked for, tangent and lift for displacements @p u [dofs].
   *  @return PW_OK; a positive code where a smaller displacement may help. */
  pw_status (*evaluate)(void *ctx, const pw_real *u, bool tangent);
  /** @brief The load that follows for @p u [dofs], after the loads have changed; NULL where follow
   *  is. */
  void (*reload)(void *ctx, const pw_real *u);
  /** @brief From the next evaluation on take the substeps of materials as the last one did, or, when
   *  not @p on, as every increment needs them; NULL: there are none. */
  void (*settle)(void *ctx, bool on);
  /** @brief Least and largest change of a volume with material over the part. */
  void (*volumes)(void *ctx, const pw_real *u, pw_real *ratio);
  /** @brief End a part: points take over what the last evaluation, of @p u, gave. */
  void (*commit)(void *ctx, const pw_real *u);
} pw_newton_system;

#endif /* PW_ENGINE_NEWTON_SYSTEM_H */
