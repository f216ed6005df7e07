/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PETSc behind engine/solver.h: sequential matrices and Krylov solves on PETSC_COMM_SELF.
 *
 * Multigrid wants three rows of every node and their rigid motions. A node with fixed components
 * therefore gets rows of their own for these, which hold a diagonal as large as the others' and
 * nothing else; nodes without equations have no rows. */
#include "engine/petsc/petsc_module.h"

#include <math.h>
#include <petscksp.h>
#include <stdio.h>
#include <stdlib.h>

enum { RESTART = 100, MOST = 2000 }; /* directions of GMRES, iterations */

typedef struct {
  pw_petsc_setup setup;
  pw_off revision; /* of the pattern in matrix, -1: none */
  PetscInt n;      /* rows: three for every node that has equations */
  PetscInt *start; /* [n + 1] */
  PetscInt *col;   /* [start[n]] ascending in each row */
  PetscScalar *value;
  PetscInt *row;      /* [equations] row of an equation */
  PetscInt *equation; /* [n] equation of a row, or -1 */
  Mat matrix;
  KSP ksp;
  Vec right, left;
} petsc_system;

static pw_status failed(PetscErrorCode code, char *text)
{
  const char *kind = NULL;
  char *message = NULL;
  PetscErrorMessage(code, &kind, &message);
  snprintf(text, PW_PETSC_TEXT, "%.90s: %.140s", kind ? kind : "an error", message ? message : "");
  return code == PETSC_ERR_MEM ? PW_ERR_MEMORY : PW_ERR_SOLVER;
}

/* Return early when PETSc reports an error. */
#define TRY_PETSC(call)                                                                            \
  do {                                                                                             \
    PetscErrorCode code_ = (call);                                                                 \
    if (code_ != 0) {                                                                              \
      return code_;                                                                                \
    }                                                                                              \
  } while (0)

static void finish(void)
{
  PetscFinalize();
}

/* A process by itself: Open MPI needs no daemon beside it. Signals stay the program's. */
static pw_status start(char *text)
{
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  PetscErrorCode code = PetscInitializeNoArguments();
  if (code == 0) {
    code = PetscPopSignalHandler();
  }
  if (code == 0) {
    code = PetscPushErrorHandler(PetscIgnoreErrorHandler, NULL);
  }
  if (code != 0) {
    snprintf(text, PW_PETSC_TEXT, "code %d", (int)code);
    return PW_ERR_UNSUPPORTED;
  }
  atexit(finish);
  return PW_OK;
}

/* Forget the matrix. */
static PetscErrorCode drop(petsc_system *s)
{
  s->revision = -1;
  TRY_PETSC(KSPReset(s->ksp));
  TRY_PETSC(VecDestroy(&s->right));
  TRY_PETSC(VecDestroy(&s->left));
  TRY_PETSC(MatDestroy(&s->matrix));
  TRY_PETSC(PetscFree2(s->row, s->equation));
  TRY_PETSC(PetscFree(s->start));
  return PetscFree2(s->col, s->value);
}

static void destroy(void **system)
{
  petsc_system *s = *system;
  if (s->ksp) {
    drop(s);
  }
  KSPDestroy(&s->ksp);
  PetscFree(s);
  *system = NULL;
}

/* Coarse nodes are found once for a pattern; their matrices follow every matrix. */
static PetscErrorCode set_up_multigrid(PC pc)
{
  TRY_PETSC(PCSetType(pc, PCGAMG));
  TRY_PETSC(PCGAMGSetType(pc, PCGAMGAGG));
  return PCGAMGSetReuseInterpolation(pc, PETSC_TRUE);
}

/* A pivot that is not positive, or zero, is shifted until it is. */
static PetscErrorCode set_up_incomplete(PC pc, bool symmetric)
{
  TRY_PETSC(PCSetType(pc, symmetric ? PCICC : PCILU));
  TRY_PETSC(PCFactorSetLevels(pc, 0));
  return PCFactorSetShiftType(pc, symmetric ? MAT_SHIFT_POSITIVE_DEFINITE : MAT_SHIFT_NONZERO);
}

static PetscErrorCode set_up(petsc_system *s)
{
  PC pc;
  TRY_PETSC(KSPCreate(PETSC_COMM_SELF, &s->ksp));
  TRY_PETSC(KSPSetOptionsPrefix(s->ksp, "pw_"));
  TRY_PETSC(KSPSetType(s->ksp, s->setup.symmetric ? KSPCG : KSPGMRES));
  if (!s->setup.symmetric) {
    TRY_PETSC(KSPGMRESSetRestart(s->ksp, RESTART));
    TRY_PETSC(KSPSetPCSide(s->ksp, PC_RIGHT));
  }
  TRY_PETSC(KSPSetNormType(s->ksp, KSP_NORM_UNPRECONDITIONED));
  TRY_PETSC(KSPGetPC(s->ksp, &pc));
  TRY_PETSC(s->setup.multigrid ? set_up_multigrid(pc) : set_up_incomplete(pc, s->setup.symmetric));
  return KSPSetFromOptions(s->ksp); /* PETSC_OPTIONS of the environment, for trials */
}

static pw_status create(const pw_petsc_setup *setup, void **system, char *text)
{
  petsc_system *s = NULL;
  if (PetscNew(&s) != 0) {
    snprintf(text, PW_PETSC_TEXT, "no memory");
    return PW_ERR_MEMORY;
  }
  s->setup = *setup;
  s->revision = -1;
  *system = s;
  PetscErrorCode code = set_up(s);
  if (code != 0) {
    pw_status status = failed(code, text);
    destroy(system);
    return status;
  }
  return PW_OK;
}

/* Rows of the equations: nodes ascending, three rows each. */
static PetscErrorCode number_rows(petsc_system *s, const pw_csr *m)
{
  const size_t nnode = (size_t)m->nnode;
  PetscInt nodes = 0;
  for (size_t a = 0; a < nnode; a++) {
    nodes += m->equation[a] >= 0 || m->equation[nnode + a] >= 0 || m->equation[2 * nnode + a] >= 0;
  }
  s->n = 3 * nodes;
  TRY_PETSC(PetscMalloc2(m->n, &s->row, s->n, &s->equation));
  nodes = 0;
  for (size_t a = 0; a < nnode; a++) {
    bool any = false;
    for (size_t c = 0; c < 3; c++) {
      const pw_idx eq = m->equation[c * nnode + a];
      if (eq >= 0) {
        s->row[eq] = 3 * nodes + (PetscInt)c;
        any = true;
      }
    }
    for (size_t c = 0; any && c < 3; c++) {
      s->equation[3 * nodes + (PetscInt)c] = m->equation[c * nnode + a];
    }
    nodes += any ? 1 : 0;
  }
  return 0;
}

static PetscErrorCode take_pattern(petsc_system *s, const pw_csr *m)
{
  const pw_off extra = s->n - m->n;
  PetscInt at = 0;
  TRY_PETSC(PetscMalloc1(s->n + 1, &s->start));
  TRY_PETSC(PetscMalloc2(m->start[m->n] + extra, &s->col, m->start[m->n] + extra, &s->value));
  for (PetscInt r = 0; r < s->n; r++) {
    const PetscInt eq = s->equation[r];
    s->start[r] = at;
    if (eq < 0) {
      s->col[at++] = r;
      continue;
    }
    for (pw_off k = m->start[eq]; k < m->start[eq + 1]; k++) {
      s->col[at++] = s->row[m->col[k]];
    }
  }
  s->start[s->n] = at;
  return 0;
}

/* Rigid motions of the nodes at hand. */
static PetscErrorCode give_motions(petsc_system *s, const pw_csr *m)
{
  const size_t nnode = (size_t)m->nnode;
  MatNullSpace motions;
  Vec x;
  PetscScalar *v;
  PetscInt at = 0;
  TRY_PETSC(VecCreateSeq(PETSC_COMM_SELF, s->n, &x));
  TRY_PETSC(VecSetBlockSize(x, 3));
  TRY_PETSC(VecGetArray(x, &v));
  for (size_t a = 0; a < nnode; a++) {
    if (m->equation[a] >= 0 || m->equation[nnode + a] >= 0 || m->equation[2 * nnode + a] >= 0) {
      for (size_t c = 0; c < 3; c++) {
        v[at++] = s->setup.x[c * nnode + a];
      }
    }
  }
  TRY_PETSC(VecRestoreArray(x, &v));
  TRY_PETSC(MatNullSpaceCreateRigidBody(x, &motions));
  TRY_PETSC(MatSetNearNullSpace(s->matrix, motions));
  TRY_PETSC(MatNullSpaceDestroy(&motions));
  return VecDestroy(&x);
}

static PetscErrorCode new_pattern(petsc_system *s, const pw_csr *m)
{
  TRY_PETSC(drop(s));
  TRY_PETSC(KSPDestroy(&s->ksp)); /* multigrid that is reset keeps the sizes of its levels */
  TRY_PETSC(set_up(s));
  TRY_PETSC(number_rows(s, m));
  TRY_PETSC(take_pattern(s, m));
  TRY_PETSC(PetscArrayzero(s->value, s->start[s->n]));
  TRY_PETSC(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, s->n, s->n, s->start, s->col, s->value,
                                      &s->matrix));
  TRY_PETSC(MatSetBlockSize(s->matrix, 3));
  if (s->setup.symmetric) {
    TRY_PETSC(MatSetOption(s->matrix, MAT_SPD, PETSC_TRUE));
  }
  if (s->setup.x && s->setup.multigrid) {
    TRY_PETSC(give_motions(s, m));
  }
  TRY_PETSC(MatCreateVecs(s->matrix, &s->left, &s->right));
  s->revision = m->revision;
  return 0;
}

/* Values of the equations, then diagonals of the other rows. PW_RETRY_DIVERGED: a value is no
 * number, or a diagonal is zero. */
static pw_status copy_values(petsc_system *s, const pw_csr *m, char *text)
{
  for (PetscInt r = 0; r < s->n; r++) {
    const PetscInt eq = s->equation[r];
    if (eq < 0) {
      continue;
    }
    const pw_real *from = m->value + m->start[eq];
    pw_real sum = 0.0, diagonal = 0.0;
    for (PetscInt k = s->start[r]; k < s->start[r + 1]; k++, from++) {
      s->value[k] = *from;
      sum += *from;
      diagonal = s->col[k] == r ? *from : diagonal;
    }
    if (!isfinite(sum) || diagonal == 0.0) {
      snprintf(text, PW_PETSC_TEXT, "the matrix is singular: row %d has %s", (int)eq,
               isfinite(sum) ? "no diagonal" : "values that are no numbers");
      return PW_RETRY_DIVERGED;
    }
    for (PetscInt other = r - r % 3; other < r - r % 3 + 3; other++) {
      if (s->equation[other] < 0) {
        s->value[s->start[other]] = diagonal;
      }
    }
  }
  return PW_OK;
}

/* Values have been written behind the matrix' back. */
static PetscErrorCode set_up_solver(petsc_system *s)
{
  PetscScalar *v;
  TRY_PETSC(MatSeqAIJGetArray(s->matrix, &v));
  TRY_PETSC(MatSeqAIJRestoreArray(s->matrix, &v));
  TRY_PETSC(MatAssemblyBegin(s->matrix, MAT_FINAL_ASSEMBLY));
  TRY_PETSC(MatAssemblyEnd(s->matrix, MAT_FINAL_ASSEMBLY));
  TRY_PETSC(KSPSetOperators(s->ksp, s->matrix, s->matrix));
  return KSPSetUp(s->ksp);
}

static pw_status load(void *system, const pw_csr *m, char *text)
{
  petsc_system *s = system;
  PetscErrorCode code = 0;
  if (s->revision != m->revision) {
    code = new_pattern(s, m);
  }
  if (code != 0) {
    return failed(code, text);
  }
  pw_status status = copy_values(s, m, text);
  if (status != PW_OK) {
    return status;
  }
  code = set_up_solver(s);
  return code == 0 ? PW_OK : failed(code, text);
}

static void forget(void *system)
{
  petsc_system *s = system;
  s->revision = -1;
}

static PetscErrorCode iterate(petsc_system *s, pw_real reduction, const pw_real *b, pw_real *x,
                              PetscInt *iterations, KSPConvergedReason *reason)
{
  PetscScalar *v;
  const PetscScalar *w;
  TRY_PETSC(VecGetArray(s->right, &v));
  for (PetscInt r = 0; r < s->n; r++) {
    v[r] = s->equation[r] >= 0 ? b[s->equation[r]] : 0.0;
  }
  TRY_PETSC(VecRestoreArray(s->right, &v));
  TRY_PETSC(KSPSetTolerances(s->ksp, reduction, 1e-300, 1e10, MOST));
  TRY_PETSC(KSPSolve(s->ksp, s->right, s->left));
  TRY_PETSC(KSPGetIterationNumber(s->ksp, iterations));
  TRY_PETSC(KSPGetConvergedReason(s->ksp, reason));
  TRY_PETSC(VecGetArrayRead(s->left, &w));
  for (PetscInt r = 0; r < s->n; r++) {
    if (s->equation[r] >= 0) {
      x[s->equation[r]] = w[r];
    }
  }
  return VecRestoreArrayRead(s->left, &w);
}

static pw_status solve(void *system, pw_real reduction, const pw_real *b, pw_real *x,
                       int *iterations, char *text)
{
  petsc_system *s = system;
  PetscInt count = 0;
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscErrorCode code = iterate(s, reduction, b, x, &count, &reason);
  if (code != 0) {
    return failed(code, text);
  }
  *iterations = (int)count;
  if (reason < 0) {
    snprintf(text, PW_PETSC_TEXT, "no convergence in %d iterations: %s", (int)count,
             KSPConvergedReasons[reason]);
    return PW_RETRY_DIVERGED;
  }
  return PW_OK;
}

extern const pw_petsc_module pw_petsc;
const pw_petsc_module pw_petsc = {PW_PETSC_VERSION, start, create, destroy, load, forget, solve};
