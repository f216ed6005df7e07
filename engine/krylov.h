/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/krylov.h
 * @brief Conjugate gradients and GMRES with a preconditioner of the caller's (layer 3).
 *
 * Sources: Hestenes & Stiefel, J. Res. Nat. Bur. Standards 49 (1952) 409; Saad & Schultz, SIAM J.
 * Sci. Stat. Comput. 7 (1986) 856, with right preconditioning (Saad, Iterative Methods for Sparse
 * Linear Systems, 2nd ed., algorithm 9.5), so that the residual watched is that of the system.
 * Sums run in the order of the equations: nothing depends on a number of threads.
 */
#ifndef PW_ENGINE_KRYLOV_H
#define PW_ENGINE_KRYLOV_H

#include "engine/csr.h"

enum { PW_KRYLOV_RESTART = 30 }; /**< directions that GMRES keeps */

/** A system to solve. */
typedef struct pw_krylov {
  const pw_csr *matrix;
  void *ctx;
  /** @brief z = M^-1 r; both [n]. */
  pw_status (*precondition)(void *ctx, const pw_real *r, pw_real *z);
  pw_real reduction; /**< of the norm of the residual, from that of b */
  int most;          /**< iterations */
  pw_real *work;     /**< [pw_krylov_room(n, ...)] */
} pw_krylov;

/** @brief Numbers of work space for @p n equations. */
pw_off pw_krylov_room(pw_idx n, bool symmetric);

/**
 * @brief Solve A x = b from x = 0 by conjugate gradients; A and M symmetric positive definite.
 * @param[in]  b          [n]
 * @param[out] x          [n]
 * @param[out] iterations what it took
 * @return PW_OK; PW_RETRY_DIVERGED when A or M turns out not to be positive definite or k->most
 *         iterations are not enough; what the preconditioner gives.
 */
pw_status pw_krylov_cg(const pw_krylov *k, const pw_real *b, pw_real *x, int *iterations);

/** @brief The same by GMRES, for any A and M. */
pw_status pw_krylov_gmres(const pw_krylov *k, const pw_real *b, pw_real *x, int *iterations);

#endif /* PW_ENGINE_KRYLOV_H */
