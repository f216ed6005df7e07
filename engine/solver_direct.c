/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/solver_direct.h"

#include <cholmod.h>
#include <math.h>
#include <omp.h>
#include <umfpack.h>

#include "engine/core/mem.h"
#include "engine/solver_parts.h"
#include "engine/solver_store.h"

/* Present when the BLAS in use is OpenBLAS. */
extern void openblas_set_num_threads(int n) __attribute__((weak));

struct pw_direct {
  bool symmetric;
  int threads;
  pw_off most_bytes;
  pw_real least_pivot;
  pw_off revision; /* of the pattern in col */
  bool factored;   /* the last factorisation succeeded */
  bool in_umfpack; /* and is UMFPACK's */
  pw_real flops;
  pw_off room_rows, room;
  SuiteSparse_long *start, *col; /* pattern with long indices, as both libraries take it */
  cholmod_common common;
  cholmod_factor *factor;
  void *symbolic, *numeric; /* of UMFPACK */
  double control[UMFPACK_CONTROL], info[UMFPACK_INFO];
  cholmod_dense *y, *e;        /* workspace of CHOLMOD's solves */
  SuiteSparse_long *row_space; /* [2 n] */
  double *space;               /* [5 n] */
};

pw_status pw_direct_create(const pw_solver_options *options, pw_direct **out)
{
  pw_direct *d = NULL;
  PW_TRY(pw_mem_alloc("direct solver", 1, sizeof *d, &d));
  d->symmetric = options->symmetric;
  d->threads = options->threads;
  d->most_bytes = options->most_bytes;
  d->least_pivot = options->least_pivot;
  d->revision = -1;
  umfpack_dl_defaults(d->control);
  d->control[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
  d->control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC; /* the pattern is */
  pw_solver_store_open();
  cholmod_l_start(&d->common);
  d->common.nmethods = 1;
  d->common.method[0].ordering = CHOLMOD_METIS;
  d->common.postorder = 1;
  d->common.supernodal = CHOLMOD_SUPERNODAL;
  d->common.final_ll = 1;
  d->common.print = 0;
  d->common.try_catch = 1; /* no messages */
  *out = d;
  return PW_OK;
}

static void forget(pw_direct *d)
{
  umfpack_dl_free_numeric(&d->numeric);
  umfpack_dl_free_symbolic(&d->symbolic);
  if (d->factor) {
    cholmod_l_free_factor(&d->factor, &d->common);
  }
  d->factored = false;
}

void pw_direct_destroy(pw_direct **direct)
{
  pw_direct *d = *direct;
  if (!d) {
    return;
  }
  forget(d);
  cholmod_l_free_dense(&d->y, &d->common);
  cholmod_l_free_dense(&d->e, &d->common);
  cholmod_l_finish(&d->common);
  pw_solver_store_close();
  pw_mem_free(&d->start);
  pw_mem_free(&d->col);
  pw_mem_free(&d->row_space);
  pw_mem_free(&d->space);
  pw_mem_free(direct);
}

/* Room for a pattern, an eighth more than is needed. */
static pw_status make_room(pw_direct *d, pw_idx n, pw_off nnz)
{
  if (n + 1 <= d->room_rows && nnz <= d->room) {
    return PW_OK;
  }
  pw_mem_free(&d->start);
  pw_mem_free(&d->col);
  pw_mem_free(&d->row_space);
  pw_mem_free(&d->space);
  d->room_rows = d->room = 0;
  const pw_off rows = (pw_off)n + 1 + n / 8, room = nnz + nnz / 8;
  PW_TRY(pw_mem_alloc("solver: rows", rows, sizeof *d->start, &d->start));
  PW_TRY(pw_mem_alloc("solver: columns", room, sizeof *d->col, &d->col));
  PW_TRY(pw_mem_alloc("solver: work rows", 2 * rows, sizeof *d->row_space, &d->row_space));
  PW_TRY(pw_mem_alloc("solver: work space", 5 * rows, sizeof *d->space, &d->space));
  d->room_rows = rows;
  d->room = room;
  return PW_OK;
}

static pw_status take_pattern(pw_direct *d, const pw_csr *m)
{
  const pw_off nnz = m->start[m->n];
  forget(d);
  d->revision = -1;
  PW_TRY(make_room(d, m->n, nnz));
  for (pw_idx i = 0; i <= m->n; i++) {
    d->start[i] = m->start[i];
  }
  for (pw_off k = 0; k < nnz; k++) {
    d->col[k] = m->col[k];
  }
  d->revision = m->revision;
  return PW_OK;
}

/* The matrix as CHOLMOD sees it: by columns, of which it reads the upper triangle. */
static cholmod_sparse as_sparse(const pw_direct *d, const pw_csr *m)
{
  return (cholmod_sparse){.nrow = (size_t)m->n,
                          .ncol = (size_t)m->n,
                          .nzmax = (size_t)m->start[m->n],
                          .p = d->start,
                          .i = d->col,
                          .x = m->value,
                          .stype = 1,
                          .itype = CHOLMOD_LONG,
                          .xtype = CHOLMOD_REAL,
                          .dtype = CHOLMOD_DOUBLE,
                          .sorted = 1,
                          .packed = 1};
}

/* Bytes of copies of the matrix that the libraries make. */
static pw_off copies(const pw_csr *m)
{
  return m->start[m->n] * (pw_off)(sizeof(double) + sizeof(SuiteSparse_long));
}

static pw_status analyse_symmetric(pw_direct *d, const pw_csr *m, cholmod_sparse *a,
                                   pw_solver_counts *counts)
{
  d->factor = cholmod_l_analyze(a, &d->common);
  counts->analyses++;
  PW_REQUIRE(d->factor, d->common.status == CHOLMOD_OUT_OF_MEMORY ? PW_ERR_MEMORY : PW_ERR_SOLVER,
             "CHOLMOD: analysis of %d equations fails with %d", (int)m->n, d->common.status);
  counts->factor_bytes =
      copies(m) + (pw_off)(sizeof(double) * (d->factor->xsize + d->factor->maxcsize) +
                           sizeof *d->col * d->factor->ssize);
  return pw_solver_check_memory("CHOLMOD", m, counts->factor_bytes, d->most_bytes);
}

static pw_real diagonal(const pw_csr *m, pw_off row)
{
  pw_off low = m->start[row], high = m->start[row + 1] - 1;
  while (low < high) {
    const pw_off middle = (low + high) / 2;
    if (m->col[middle] < row) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low == high && m->col[low] == row ? fabs(m->value[low]) : 0.0;
}

/* Least pivot as part of the diagonal it comes from, and its row. */
typedef struct {
  pw_real ratio;
  pw_off row;
} least_pivot;

static void look_at(least_pivot *least, pw_real ratio, pw_off row)
{
  if (!(ratio >= least->ratio)) {
    *least = (least_pivot){ratio, row};
  }
}

/* Of CHOLMOD's supernodes. */
static least_pivot least_symmetric(const pw_direct *d, const pw_csr *m)
{
  const cholmod_factor *f = d->factor;
  const SuiteSparse_long *super = f->super, *pi = f->pi, *px = f->px, *perm = f->Perm;
  const double *x = f->x;
  least_pivot least = {.ratio = INFINITY};
  for (size_t s = 0; s < f->nsuper; s++) {
    const SuiteSparse_long rows = pi[s + 1] - pi[s];
    for (SuiteSparse_long j = super[s]; j < super[s + 1]; j++) {
      const pw_real root = x[px[s] + (j - super[s]) * (rows + 1)];
      look_at(&least, root * root / diagonal(m, perm[j]), perm[j]);
    }
  }
  return least;
}

/* Of UMFPACK, which scales the rows it sees: our columns. */
static pw_status least_general(pw_direct *d, const pw_csr *m, least_pivot *least)
{
  double *pivot = d->space, *scale = d->space + m->n;
  SuiteSparse_long *row = d->row_space, *column = row + m->n, multiply = 0;
  long rc = umfpack_dl_get_numeric(NULL, NULL, NULL, NULL, NULL, NULL, row, column, pivot,
                                   &multiply, scale, d->numeric);
  PW_REQUIRE(rc == UMFPACK_OK, PW_ERR_SOLVER, "UMFPACK: no pivots of %d equations: %ld", (int)m->n,
             rc);
  *least = (least_pivot){.ratio = INFINITY};
  for (pw_idx i = 0; i < m->n; i++) {
    const pw_real s = scale[row[i]], from = diagonal(m, column[i]) * (multiply ? s : 1.0 / s);
    look_at(least, fabs(pivot[i]) / from, column[i]);
  }
  return PW_OK;
}

/* PW_RETRY_DIVERGED: not positive definite. CHOLMOD would start threads of its own. */
static pw_status factor_symmetric(pw_direct *d, const pw_csr *m, pw_solver_counts *counts)
{
  cholmod_sparse a = as_sparse(d, m);
  if (!d->factor) {
    PW_TRY(analyse_symmetric(d, m, &a, counts));
  }
  const int levels = omp_get_max_active_levels();
  omp_set_max_active_levels(0);
  cholmod_l_factorize(&a, d->factor, &d->common);
  omp_set_max_active_levels(levels);
  PW_REQUIRE(d->common.status != CHOLMOD_OUT_OF_MEMORY, PW_ERR_MEMORY,
             "CHOLMOD: no memory to factor %d equations", (int)m->n);
  if (d->common.status == CHOLMOD_NOT_POSDEF) {
    return PW_RETRY_DIVERGED;
  }
  PW_REQUIRE(d->common.status == CHOLMOD_OK, PW_ERR_SOLVER,
             "CHOLMOD: factorisation of %d equations ends with %d", (int)m->n, d->common.status);
  counts->factor_nonzeros = (pw_off)d->common.lnz;
  counts->pivot_ratio = least_symmetric(d, m).ratio;
  d->flops = d->common.fl;
  return counts->pivot_ratio >= d->least_pivot ? PW_OK : PW_RETRY_DIVERGED;
}

/* UMFPACK's own estimates are bounds for any pivots, many times too high for a symmetric pattern;
 * those of the ordering are close while pivots stay on the diagonal. Fronts and indices take as much
 * again (bench_solver: 1.9 to 2.2 times the numbers of L and U). */
static pw_status analyse_general(pw_direct *d, const pw_csr *m, pw_solver_counts *counts)
{
  long rc = umfpack_dl_symbolic(m->n, m->n, d->start, d->col, m->value, &d->symbolic, d->control,
                                d->info);
  counts->analyses++;
  PW_REQUIRE(rc == UMFPACK_OK, rc == UMFPACK_ERROR_out_of_memory ? PW_ERR_MEMORY : PW_ERR_SOLVER,
             "UMFPACK: analysis of %d equations fails with %ld", (int)m->n, rc);
  counts->factor_bytes =
      copies(m) + (pw_off)(2.0 * sizeof(double) * d->info[UMFPACK_SYMMETRIC_LUNZ]);
  return pw_solver_check_memory("UMFPACK", m, counts->factor_bytes, d->most_bytes);
}

static pw_status tell_pivot(const pw_csr *m, least_pivot least)
{
  pw_idx i = 0; /* component and node of the row */
  while (i < 3 * m->nnode - 1 && m->equation[i] != least.row) {
    i++;
  }
  return pw_error_set(PW_RETRY_DIVERGED, __FILE__, __LINE__, __func__,
                      "the matrix of %d equations is singular: at node %d, component %c, "
                      "elimination leaves %.1e of the diagonal",
                      (int)m->n, (int)(i % m->nnode), "xyz"[i / m->nnode], least.ratio);
}

/* UMFPACK takes columns: our rows are the columns of the transpose. */
static pw_status factor_general(pw_direct *d, const pw_csr *m, pw_solver_counts *counts)
{
  umfpack_dl_free_numeric(&d->numeric);
  if (!d->symbolic) {
    PW_TRY(analyse_general(d, m, counts));
  }
  long rc =
      umfpack_dl_numeric(d->start, d->col, m->value, d->symbolic, &d->numeric, d->control, d->info);
  PW_REQUIRE(rc != UMFPACK_ERROR_out_of_memory, PW_ERR_MEMORY,
             "UMFPACK: no memory to factor %d equations", (int)m->n);
  PW_REQUIRE(rc != UMFPACK_WARNING_singular_matrix, PW_RETRY_DIVERGED,
             "UMFPACK: the matrix of %d equations is singular", (int)m->n);
  PW_REQUIRE(rc == UMFPACK_OK, PW_ERR_SOLVER,
             "UMFPACK: factorisation of %d equations ends with %ld", (int)m->n, rc);
  counts->factor_nonzeros = (pw_off)(d->info[UMFPACK_LNZ] + d->info[UMFPACK_UNZ]);
  d->flops = d->info[UMFPACK_FLOPS];
  least_pivot least;
  PW_TRY(least_general(d, m, &least));
  counts->pivot_ratio = least.ratio;
  if (!(least.ratio >= d->least_pivot)) {
    return tell_pivot(m, least);
  }
  return PW_OK;
}

pw_status pw_direct_factor(pw_direct *d, const pw_csr *m, pw_solver_counts *counts)
{
  if (&openblas_set_num_threads) {
    openblas_set_num_threads(d->threads);
  }
  d->factored = false;
  if (d->revision != m->revision) {
    PW_TRY(take_pattern(d, m));
  }
  counts->factors++;
  d->in_umfpack = false;
  pw_status status = d->symmetric ? factor_symmetric(d, m, counts) : PW_RETRY_DIVERGED;
  if (status == PW_RETRY_DIVERGED) {
    counts->indefinite += d->symmetric ? 1 : 0;
    d->in_umfpack = true;
    status = factor_general(d, m, counts);
  }
  if (status < 0) { /* analyses that led nowhere are not kept */
    forget(d);
  }
  d->factored = status == PW_OK;
  return status;
}

static pw_status solve_symmetric(pw_direct *d, pw_idx n, const pw_real *b, pw_real *x)
{
  cholmod_dense right = {.nrow = (size_t)n,
                         .ncol = 1,
                         .nzmax = (size_t)n,
                         .d = (size_t)n,
                         .x = (void *)b, /* read only */
                         .xtype = CHOLMOD_REAL,
                         .dtype = CHOLMOD_DOUBLE};
  cholmod_dense left = right, *out = &left;
  left.x = x;
  int ok =
      cholmod_l_solve2(CHOLMOD_A, d->factor, &right, NULL, &out, NULL, &d->y, &d->e, &d->common);
  PW_REQUIRE(ok && out == &left, PW_ERR_SOLVER, "CHOLMOD: solution of %d equations ends with %d",
             (int)n, d->common.status);
  return PW_OK;
}

pw_status pw_direct_solve(pw_direct *d, const pw_csr *m, bool refine, const pw_real *b, pw_real *x)
{
  PW_REQUIRE(pw_direct_has(d, m), PW_ERR_ARGUMENT, "this matrix has not been factored");
  if (!d->in_umfpack) {
    return solve_symmetric(d, m->n, b, x);
  }
  d->control[UMFPACK_IRSTEP] = refine ? 1 : 0;
  long rc = umfpack_dl_wsolve(UMFPACK_Aat, d->start, d->col, m->value, x, b, d->numeric, d->control,
                              d->info, d->row_space, d->space);
  PW_REQUIRE(rc == UMFPACK_OK, PW_ERR_SOLVER, "UMFPACK: solution of %d equations ends with %ld",
             (int)m->n, rc);
  return PW_OK;
}

bool pw_direct_has(const pw_direct *d, const pw_csr *m)
{
  return d->factored && d->revision == m->revision;
}

bool pw_direct_is_definite(const pw_direct *d)
{
  return d->factored && !d->in_umfpack;
}

pw_real pw_direct_flops(const pw_direct *d)
{
  return d->flops;
}

/* As an engine: every matrix is factored. */

static pw_status engine_create(const pw_solver_options *options, void **state)
{
  return pw_direct_create(options, (pw_direct **)state);
}

static void engine_destroy(void **state)
{
  pw_direct_destroy((pw_direct **)state);
}

static pw_status engine_factor(void *state, const pw_csr *m, pw_solver_counts *counts)
{
  return pw_direct_factor(state, m, counts);
}

static pw_status engine_solve(void *state, const pw_csr *m, pw_real reduction, const pw_real *b,
                              pw_real *x, pw_solver_counts *counts)
{
  (void)reduction;
  counts->last = 0;
  return pw_direct_solve(state, m, true, b, x);
}

static void engine_forget(void *state)
{
  (void)state;
}

static const char *engine_describe(const void *state)
{
  const pw_direct *d = state;
  return d->symmetric ? "CHOLMOD (supernodal L L^T, METIS)" : "UMFPACK (multifrontal L U, METIS)";
}

const pw_solver_calls pw_solver_direct_calls = {engine_create, engine_destroy, engine_factor,
                                                engine_solve,  engine_forget,  engine_describe};
