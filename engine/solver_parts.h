/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/solver_parts.h
 * @brief What an engine behind engine/solver.h provides (layer 3, of the solver's files only).
 */
#ifndef PW_ENGINE_SOLVER_PARTS_H
#define PW_ENGINE_SOLVER_PARTS_H

#include "engine/solver.h"

/** An engine. Its state is its own; counts belong to the solver and are kept up by the engine. */
typedef struct pw_solver_calls {
  pw_status (*create)(const pw_solver_options *options, void **state);
  void (*destroy)(void **state);
  pw_status (*factor)(void *state, const pw_csr *m, pw_solver_counts *counts);
  pw_status (*solve)(void *state, const pw_csr *m, pw_real reduction, const pw_real *b, pw_real *x,
                     pw_solver_counts *counts);
  void (*forget)(void *state);
  const char *(*describe)(const void *state); /**< static text */
} pw_solver_calls;

extern const pw_solver_calls pw_solver_direct_calls;
extern const pw_solver_calls pw_solver_krylov_calls;
extern const pw_solver_calls pw_solver_petsc_calls;

/** @brief Bytes that PETSc's engines would need for @p m, roughly. */
pw_off pw_solver_petsc_bytes(const pw_csr *m);

/**
 * @brief Refuse a factor that would not fit.
 * @param[in] what  library, for the message
 * @param[in] bytes needed; the matrix stands already
 * @param[in] most  allowed; 0: what the machine has left
 * @return PW_OK; PW_ERR_MEMORY, naming an engine that would fit.
 */
pw_status pw_solver_check_memory(const char *what, const pw_csr *m, pw_off bytes, pw_off most);

#endif /* PW_ENGINE_SOLVER_PARTS_H */
