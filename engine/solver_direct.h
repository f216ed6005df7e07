/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/solver_direct.h
 * @brief Factors of sparse matrices: the only door to SuiteSparse (layer 3, of the solver's files).
 *
 * A symmetric matrix that is not positive definite, as a softening body may have, is factored by
 * UMFPACK for that once.
 */
#ifndef PW_ENGINE_SOLVER_DIRECT_H
#define PW_ENGINE_SOLVER_DIRECT_H

#include "engine/solver.h"

typedef struct pw_direct pw_direct;

/** @brief No factor yet. @return PW_OK; PW_ERR_MEMORY. */
pw_status pw_direct_create(const pw_solver_options *options, pw_direct **out);

/** @brief Free; NULL is accepted. */
void pw_direct_destroy(pw_direct **d);

/** @brief Factor @p m; see pw_solver_factor(). */
pw_status pw_direct_factor(pw_direct *d, const pw_csr *m, pw_solver_counts *counts);

/**
 * @brief Solve with the last factor.
 * @param[in] m      the matrix of the factor; with refine false any of its pattern
 * @param[in] refine one step of refinement where UMFPACK does it
 * @param[in] b      [n] right-hand side
 * @param[out] x     [n]
 * @return PW_OK; PW_ERR_SOLVER.
 */
pw_status pw_direct_solve(pw_direct *d, const pw_csr *m, bool refine, const pw_real *b, pw_real *x);

/** @brief There is a factor of a matrix of m's pattern. */
bool pw_direct_has(const pw_direct *d, const pw_csr *m);

/** @brief That factor is CHOLMOD's: its matrix was positive definite. */
bool pw_direct_is_definite(const pw_direct *d);

/** @brief Multiplications and additions the last factorisation took. */
pw_real pw_direct_flops(const pw_direct *d);

#endif /* PW_ENGINE_SOLVER_DIRECT_H */
