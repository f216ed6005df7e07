/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/petsc/petsc_module.h
 * @brief The plug-in that holds all that knows PETSc and MPI, as the program sees it.
 *
 * The library pilewright_petsc.so is loaded when an engine of PETSc's is asked for; a program that
 * does not ask starts no MPI. It exports one symbol, PW_PETSC_SYMBOL, a pw_petsc_module. Its calls
 * return PW_OK or a status whose message is in the text of PW_PETSC_TEXT bytes.
 */
#ifndef PW_ENGINE_PETSC_MODULE_H
#define PW_ENGINE_PETSC_MODULE_H

#include "engine/csr.h"

#define PW_PETSC_LIBRARY "pilewright_petsc.so"
#define PW_PETSC_SYMBOL  "pw_petsc"

enum { PW_PETSC_TEXT = 256, PW_PETSC_VERSION = 1 };

/** What is asked of a system. */
typedef struct pw_petsc_setup {
  bool symmetric;
  bool multigrid;   /**< GAMG, else ICC(0) or ILU(0) */
  const pw_real *x; /**< [3][nnode] where nodes are, or NULL */
} pw_petsc_setup;

typedef struct pw_petsc_module {
  int version; /**< PW_PETSC_VERSION */
  /** @brief Start PETSc and MPI, once; they end with the process. */
  pw_status (*start)(char *text);
  pw_status (*create)(const pw_petsc_setup *setup, void **system, char *text);
  void (*destroy)(void **system);
  /** @brief Take a matrix and set up its preconditioner. */
  pw_status (*load)(void *system, const pw_csr *m, char *text);
  /** @brief Keep nothing for matrices to come. */
  void (*forget)(void *system);
  /** @brief Solve with it; PW_RETRY_DIVERGED when iterations do not converge. */
  pw_status (*solve)(void *system, pw_real reduction, const pw_real *b, pw_real *x, int *iterations,
                     char *text);
} pw_petsc_module;

#endif /* PW_ENGINE_PETSC_MODULE_H */
