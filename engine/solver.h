/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/solver.h
 * @brief Sparse linear systems of an implicit step: one door, several engines behind it (layer 3).
 *
 * - direct: CHOLMOD (supernodal L L^T) for symmetric matrices, UMFPACK (multifrontal L U) for
 *   others, METIS ordering (engine/solver_direct.h). Nothing depends on what was solved before.
 * - krylov: the same factor, kept for the matrices that follow as preconditioner of conjugate
 *   gradients or GMRES (engine/krylov.h); renewed when iterations cost more than a factorisation.
 * - petsc_gamg, petsc_ilu: conjugate gradients or GMRES of PETSc, preconditioned by algebraic
 *   multigrid that knows the rigid body motions, or by ICC(0) or ILU(0). A plug-in that is
 *   loaded when one of them is asked for; a build may lack it.
 * - automatic: direct up to PW_SOLVER_DIRECT_SYMMETRIC or PW_SOLVER_DIRECT_GENERAL equations;
 *   beyond, petsc_gamg, or krylov in a build without PETSc and after iterations of petsc_gamg have
 *   not converged. ILU(0) is not chosen: it is quicker in easy problems and fails in nearly
 *   incompressible ones.
 *
 * All run on one thread, with BLAS on the threads asked for, so that they never add to ours, and
 * give the same bits on any number of them but those of BLAS.
 */
#ifndef PW_ENGINE_SOLVER_H
#define PW_ENGINE_SOLVER_H

#include "engine/csr.h"

typedef enum pw_solver_engine {
  PW_SOLVER_AUTO,
  PW_SOLVER_DIRECT,
  PW_SOLVER_KRYLOV,
  PW_SOLVER_PETSC_GAMG,
  PW_SOLVER_PETSC_ILU,
  PW_SOLVER_ENGINES /**< how many */
} pw_solver_engine;

/** Most equations for which "automatic" means direct (bench/README.md). */
enum { PW_SOLVER_DIRECT_SYMMETRIC = 100000, PW_SOLVER_DIRECT_GENERAL = 50000 };

/** What is asked of a solver. */
typedef struct pw_solver_options {
  pw_solver_engine engine;
  bool symmetric;      /**< the matrices will be symmetric */
  int threads;         /**< of BLAS, >= 1 */
  pw_off most_bytes;   /**< memory a factor may take; 0: what the machine has left */
  pw_idx most_direct;  /**< equations up to which automatic means direct; 0: the numbers above */
  pw_real least_pivot; /**< a factor with a smaller pivot, as part of the diagonal it comes from,
                            counts as singular; 1e-13: elimination has left rounding alone */
  const pw_real *x;    /**< [3][nnode] where nodes are, for multigrid, borrowed; NULL: unknown; m */
} pw_solver_options;

typedef struct pw_solver pw_solver;

/** What a solver has done. */
typedef struct pw_solver_counts {
  pw_off analyses;        /**< symbolic analyses */
  pw_off factors;         /**< numeric factorisations, or set-ups of a preconditioner */
  pw_off indefinite;      /**< of them, symmetric ones that went to UMFPACK */
  pw_off solves;          /**< right-hand sides */
  pw_off iterations;      /**< of Krylov solves, all together */
  pw_off last;            /**< iterations of the last solve; 0: with a factor of its own */
  pw_off factor_nonzeros; /**< of the last factor */
  pw_off factor_bytes;    /**< memory of the last factor, as estimated before it was made */
  pw_real pivot_ratio;    /**< of the last factor: least pivot over the diagonal it comes from */
} pw_solver_counts;

/** @brief Automatic choice, one thread. */
pw_solver_options pw_solver_defaults(bool symmetric);

/** @brief Name of an engine: "automatic", "direct", "krylov", "petsc_gamg", "petsc_ilu". */
const char *pw_solver_name(pw_solver_engine engine);

/** @brief The engine of that name. @return false: there is none. */
bool pw_solver_find(const char *name, pw_solver_engine *engine);

/** @brief PETSc's engines can be loaded; the error record says why not. */
bool pw_solver_has_petsc(void);

/**
 * @brief A solver without a matrix.
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_ARGUMENT; PW_ERR_UNSUPPORTED for an engine that this build
 *         or machine lacks, saying what is missing.
 */
pw_status pw_solver_create(const pw_solver_options *options, pw_solver **out);

/** @brief Free; NULL is accepted. */
void pw_solver_destroy(pw_solver **s);

/**
 * @brief Take the matrix @p m: factor it, or see that an earlier factor may serve. Its pattern is
 *        analysed when m->revision has changed.
 * @return PW_OK; PW_RETRY_DIVERGED for a singular matrix or one with values that are no numbers;
 *         PW_ERR_MEMORY, naming what would fit, when a factor would not; PW_ERR_SOLVER with the
 *         library's code.
 */
pw_status pw_solver_factor(pw_solver *s, const pw_csr *m);

/**
 * @brief Reduction of the residual that iterative solves are to reach, from now on; 1e-10 at the
 *        start. Direct solves pay no heed.
 */
void pw_solver_aim(pw_solver *s, pw_real reduction);

/**
 * @brief Solve with the matrix last taken.
 * @param[in]  m that matrix
 * @param[in]  b [n] right-hand side
 * @param[out] x [n]
 * @return PW_OK; PW_RETRY_NAN when x is no number; PW_RETRY_DIVERGED when iterations do not
 *         converge or the matrix, factored after all, is singular; PW_ERR_SOLVER; PW_ERR_MEMORY.
 */
pw_status pw_solver_solve(pw_solver *s, const pw_csr *m, const pw_real *b, pw_real *x);

/** @brief Keep no factor for matrices to come: what follows does not depend on what was before. */
void pw_solver_forget(pw_solver *s);

pw_solver_counts pw_solver_counted(const pw_solver *s);

/** @brief Engine, libraries, and the rule that chose them, for the log; owned by the solver. */
const char *pw_solver_describe(const pw_solver *s);

#endif /* PW_ENGINE_SOLVER_H */
