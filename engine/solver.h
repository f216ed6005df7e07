/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/solver.h
 * @brief Sparse linear systems of an implicit step: the only door to SuiteSparse (layer 3).
 *
 * Symmetric systems go to CHOLMOD (supernodal L L^T), others to UMFPACK (multifrontal L U), both
 * with METIS ordering. The symbolic analysis is kept as long as the pattern stands. A symmetric
 * matrix that is not positive definite, as a softening body may have, is factored by UMFPACK for
 * that once. Both libraries call BLAS inside serial code; its threads are set to one, or to the
 * number asked for, before every factorisation, so that they never add to ours.
 */
#ifndef PW_ENGINE_SOLVER_H
#define PW_ENGINE_SOLVER_H

#include "engine/csr.h"

typedef struct pw_solver pw_solver;

/** What a solver has done. */
typedef struct pw_solver_counts {
  pw_off analyses;        /**< symbolic analyses */
  pw_off factors;         /**< numeric factorisations */
  pw_off indefinite;      /**< of them, symmetric ones that went to UMFPACK */
  pw_off factor_nonzeros; /**< of the last factor */
} pw_solver_counts;

/**
 * @brief A solver without a matrix.
 * @param[in] symmetric the matrices will be symmetric
 * @param[in] threads   threads of BLAS, >= 1
 * @return PW_OK; PW_ERR_MEMORY.
 */
pw_status pw_solver_create(bool symmetric, int threads, pw_solver **out);

/** @brief Free; NULL is accepted. */
void pw_solver_destroy(pw_solver **s);

/**
 * @brief Factor @p m; its pattern is analysed when m->revision has changed.
 * @return PW_OK; PW_RETRY_DIVERGED for a singular matrix or one with values that are no numbers;
 *         PW_ERR_MEMORY; PW_ERR_SOLVER with the library's code.
 */
pw_status pw_solver_factor(pw_solver *s, const pw_csr *m);

/**
 * @brief Solve with the last factor; one step of refinement where UMFPACK does it.
 * @param[in]  m the matrix that was factored
 * @param[in]  b [n] right-hand side
 * @param[out] x [n]
 * @return PW_OK; PW_RETRY_NAN when x is no number; PW_ERR_SOLVER.
 */
pw_status pw_solver_solve(pw_solver *s, const pw_csr *m, const pw_real *b, pw_real *x);

pw_solver_counts pw_solver_counted(const pw_solver *s);

/** @brief Libraries and ordering in use, for the log. */
const char *pw_solver_describe(const pw_solver *s);

#endif /* PW_ENGINE_SOLVER_H */
