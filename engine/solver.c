/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/solver.h"

#include <cholmod.h>
#include <math.h>
#include <string.h>
#include <umfpack.h>

#include "engine/core/mem.h"

/* Present when the BLAS in use is OpenBLAS. */
extern void openblas_set_num_threads(int n) __attribute__((weak));

struct pw_solver {
  bool symmetric;
  int threads;
  pw_off revision; /* of the pattern in col */
  bool in_umfpack; /* the last factor is UMFPACK's */
  pw_off room_rows, room;
  SuiteSparse_long *start, *col; /* pattern with long indices, as both libraries take it */
  cholmod_common common;
  cholmod_factor *factor;
  bool analysed; /* by UMFPACK */
  void *symbolic, *numeric;
  double control[UMFPACK_CONTROL], info[UMFPACK_INFO];
  cholmod_dense *y, *e; /* workspace of CHOLMOD's solves */
  pw_solver_counts counts;
};

pw_status pw_solver_create(bool symmetric, int threads, pw_solver **out)
{
  pw_solver *s = NULL;
  PW_REQUIRE(threads >= 1, PW_ERR_ARGUMENT, "%d threads for a solver", threads);
  PW_TRY(pw_mem_alloc("linear solver", 1, sizeof *s, &s));
  s->symmetric = symmetric;
  s->threads = threads;
  s->revision = -1;
  umfpack_dl_defaults(s->control);
  s->control[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
  s->control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC; /* the pattern is */
  s->control[UMFPACK_IRSTEP] = 1;
  cholmod_l_start(&s->common);
  s->common.nmethods = 1;
  s->common.method[0].ordering = CHOLMOD_METIS;
  s->common.postorder = 1;
  s->common.supernodal = CHOLMOD_SUPERNODAL;
  s->common.final_ll = 1;
  s->common.print = 0;
  s->common.try_catch = 1; /* no messages */
  *out = s;
  return PW_OK;
}

static void forget(pw_solver *s)
{
  umfpack_dl_free_numeric(&s->numeric);
  umfpack_dl_free_symbolic(&s->symbolic);
  s->analysed = false;
  if (s->factor) {
    cholmod_l_free_factor(&s->factor, &s->common);
  }
}

void pw_solver_destroy(pw_solver **solver)
{
  pw_solver *s = *solver;
  if (!s) {
    return;
  }
  forget(s);
  cholmod_l_free_dense(&s->y, &s->common);
  cholmod_l_free_dense(&s->e, &s->common);
  cholmod_l_finish(&s->common);
  pw_mem_free(&s->start);
  pw_mem_free(&s->col);
  pw_mem_free(solver);
}

/* Row pointers and columns as long integers; room grows by an eighth more than is needed. */
static pw_status copy_pattern(pw_solver *s, const pw_csr *m)
{
  const pw_off nnz = m->start[m->n];
  if (m->n + 1 > s->room_rows || nnz > s->room) {
    pw_mem_free(&s->start);
    pw_mem_free(&s->col);
    s->room_rows = s->room = 0;
    pw_off rows = (pw_off)m->n + 1 + m->n / 8, room = nnz + nnz / 8;
    PW_TRY(pw_mem_alloc("solver: rows", rows, sizeof *s->start, &s->start));
    PW_TRY(pw_mem_alloc("solver: columns", room, sizeof *s->col, &s->col));
    s->room_rows = rows;
    s->room = room;
  }
  for (pw_idx i = 0; i <= m->n; i++) {
    s->start[i] = m->start[i];
  }
  for (pw_off k = 0; k < nnz; k++) {
    s->col[k] = m->col[k];
  }
  s->revision = m->revision;
  return PW_OK;
}

/* The matrix as CHOLMOD sees it: by columns, of which it reads the upper triangle. */
static cholmod_sparse as_sparse(const pw_solver *s, const pw_csr *m)
{
  return (cholmod_sparse){.nrow = (size_t)m->n,
                          .ncol = (size_t)m->n,
                          .nzmax = (size_t)m->start[m->n],
                          .p = s->start,
                          .i = s->col,
                          .x = m->value,
                          .stype = 1,
                          .itype = CHOLMOD_LONG,
                          .xtype = CHOLMOD_REAL,
                          .dtype = CHOLMOD_DOUBLE,
                          .sorted = 1,
                          .packed = 1};
}

/* PW_RETRY_DIVERGED: not positive definite. */
static pw_status factor_symmetric(pw_solver *s, const pw_csr *m)
{
  cholmod_sparse a = as_sparse(s, m);
  if (!s->factor) {
    s->factor = cholmod_l_analyze(&a, &s->common);
    s->counts.analyses++;
    PW_REQUIRE(s->factor, s->common.status == CHOLMOD_OUT_OF_MEMORY ? PW_ERR_MEMORY : PW_ERR_SOLVER,
               "CHOLMOD: analysis of %d equations fails with %d", (int)m->n, s->common.status);
  }
  cholmod_l_factorize(&a, s->factor, &s->common);
  PW_REQUIRE(s->common.status != CHOLMOD_OUT_OF_MEMORY, PW_ERR_MEMORY,
             "CHOLMOD: no memory to factor %d equations", (int)m->n);
  if (s->common.status == CHOLMOD_NOT_POSDEF) {
    return PW_RETRY_DIVERGED;
  }
  PW_REQUIRE(s->common.status == CHOLMOD_OK, PW_ERR_SOLVER,
             "CHOLMOD: factorisation of %d equations ends with %d", (int)m->n, s->common.status);
  s->counts.factor_nonzeros = (pw_off)s->common.lnz;
  return PW_OK;
}

/* UMFPACK takes columns: our rows are the columns of the transpose. */
static pw_status factor_general(pw_solver *s, const pw_csr *m)
{
  long rc = UMFPACK_OK;
  if (!s->analysed) {
    rc = umfpack_dl_symbolic(m->n, m->n, s->start, s->col, m->value, &s->symbolic, s->control,
                             s->info);
    s->counts.analyses++;
    PW_REQUIRE(rc == UMFPACK_OK, rc == UMFPACK_ERROR_out_of_memory ? PW_ERR_MEMORY : PW_ERR_SOLVER,
               "UMFPACK: analysis of %d equations fails with %ld", (int)m->n, rc);
    s->analysed = true;
  }
  umfpack_dl_free_numeric(&s->numeric);
  rc =
      umfpack_dl_numeric(s->start, s->col, m->value, s->symbolic, &s->numeric, s->control, s->info);
  PW_REQUIRE(rc != UMFPACK_ERROR_out_of_memory, PW_ERR_MEMORY,
             "UMFPACK: no memory to factor %d equations", (int)m->n);
  PW_REQUIRE(rc != UMFPACK_WARNING_singular_matrix, PW_RETRY_DIVERGED,
             "UMFPACK: the matrix of %d equations is singular", (int)m->n);
  PW_REQUIRE(rc == UMFPACK_OK, PW_ERR_SOLVER,
             "UMFPACK: factorisation of %d equations ends with %ld", (int)m->n, rc);
  s->counts.factor_nonzeros = (pw_off)(s->info[UMFPACK_LNZ] + s->info[UMFPACK_UNZ]);
  return PW_OK;
}

pw_status pw_solver_factor(pw_solver *s, const pw_csr *m)
{
  PW_REQUIRE(m->n > 0, PW_ERR_ARGUMENT, "a matrix of %d equations", (int)m->n);
  if (&openblas_set_num_threads) {
    openblas_set_num_threads(s->threads);
  }
  if (s->revision != m->revision) {
    forget(s);
    PW_TRY(copy_pattern(s, m));
  }
  s->counts.factors++;
  s->in_umfpack = !s->symmetric;
  if (s->symmetric) {
    pw_status status = factor_symmetric(s, m);
    if (status != PW_RETRY_DIVERGED) {
      return status;
    }
    s->counts.indefinite++;
    s->in_umfpack = true;
  }
  return factor_general(s, m);
}

static pw_status solve_symmetric(pw_solver *s, const pw_csr *m, const pw_real *b, pw_real *x)
{
  cholmod_dense right = {.nrow = (size_t)m->n,
                         .ncol = 1,
                         .nzmax = (size_t)m->n,
                         .d = (size_t)m->n,
                         .x = (void *)b, /* read only */
                         .xtype = CHOLMOD_REAL,
                         .dtype = CHOLMOD_DOUBLE};
  cholmod_dense left = right, *out = &left;
  left.x = x;
  int ok =
      cholmod_l_solve2(CHOLMOD_A, s->factor, &right, NULL, &out, NULL, &s->y, &s->e, &s->common);
  PW_REQUIRE(ok && out == &left, PW_ERR_SOLVER, "CHOLMOD: solution of %d equations ends with %d",
             (int)m->n, s->common.status);
  return PW_OK;
}

pw_status pw_solver_solve(pw_solver *s, const pw_csr *m, const pw_real *b, pw_real *x)
{
  PW_REQUIRE(s->revision == m->revision, PW_ERR_ARGUMENT, "this matrix has not been factored");
  if (s->in_umfpack) {
    long rc = umfpack_dl_solve(UMFPACK_Aat, s->start, s->col, m->value, x, b, s->numeric,
                               s->control, s->info);
    PW_REQUIRE(rc == UMFPACK_OK, PW_ERR_SOLVER, "UMFPACK: solution of %d equations ends with %ld",
               (int)m->n, rc);
  } else {
    PW_TRY(solve_symmetric(s, m, b, x));
  }
  pw_real sum = 0.0;
  for (pw_idx i = 0; i < m->n; i++) {
    sum += x[i];
  }
  PW_REQUIRE(isfinite(sum), PW_RETRY_NAN, "the solution of %d equations is no number", (int)m->n);
  return PW_OK;
}

pw_solver_counts pw_solver_counted(const pw_solver *s)
{
  return s->counts;
}

const char *pw_solver_describe(const pw_solver *s)
{
  return s->symmetric ? "CHOLMOD (supernodal L L^T, METIS)" : "UMFPACK (multifrontal L U, METIS)";
}
