/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Krylov solves with a factor kept from an earlier matrix.
 *
 * Counted in iterations, each of which reads the factor once, a factorisation of F flops and nz
 * nonzeros costs `price` = F/nz/`worth`. Iterations grow as the matrix moves away from the factor; a
 * new one is due when the last solve cost more than the mean of all since the last factorisation,
 * that included, which is the cheapest moment while they grow. A solve that takes more than the
 * price is broken off, and done with a new factor. Nothing is decided by a clock: runs repeat to
 * the bit. */
#include <math.h>

#include "engine/core/mem.h"
#include "engine/krylov.h"
#include "engine/solver_direct.h"
#include "engine/solver_parts.h"

/* Flops of a dense kernel in the time that a nonzero of a factor takes in a solve, measured
 * (bench/README.md). */
static const pw_real worth = 30.0;

enum { LOWEST = 8, HIGHEST = 60 }; /* price */

typedef struct {
  pw_solver_options options;
  pw_direct *direct;
  const pw_csr *matrix; /* at hand, while solving */
  bool own;             /* the factor is of the matrix at hand */
  int price;            /* iterations that cost as much as a factorisation */
  int solves, paid;     /* with this factor: solves, and their iterations */
  bool due;             /* the next matrix gets a factor of its own */
  pw_off room;
  pw_real *work;
} kept;

static pw_status kept_create(const pw_solver_options *options, void **state)
{
  kept *k = NULL;
  PW_TRY(pw_mem_alloc("krylov solver", 1, sizeof *k, &k));
  k->options = *options;
  pw_status s = pw_direct_create(options, &k->direct);
  if (s != PW_OK) {
    pw_mem_free(&k);
    return s;
  }
  *state = k;
  return PW_OK;
}

static void kept_destroy(void **state)
{
  kept *k = *state;
  pw_direct_destroy(&k->direct);
  pw_mem_free(&k->work);
  pw_mem_free(state);
}

static pw_status make_room(kept *k, const pw_csr *m)
{
  const pw_off room = pw_krylov_room(m->n, false);
  if (room > k->room) {
    pw_mem_free(&k->work);
    k->room = 0;
    PW_TRY(pw_mem_alloc("krylov: directions", room + room / 8, sizeof *k->work, &k->work));
    k->room = room + room / 8;
  }
  return PW_OK;
}

static pw_status renew(kept *k, const pw_csr *m, pw_solver_counts *counts)
{
  k->own = false;
  PW_TRY(pw_direct_factor(k->direct, m, counts));
  k->own = true;
  k->due = false;
  k->solves = k->paid = 0;
  const pw_real price = pw_direct_flops(k->direct) / (worth * (pw_real)counts->factor_nonzeros);
  k->price = (int)pw_min(pw_max(price, LOWEST), HIGHEST);
  return PW_OK;
}

static pw_status kept_factor(void *state, const pw_csr *m, pw_solver_counts *counts)
{
  kept *k = state;
  PW_TRY(make_room(k, m));
  if (!pw_direct_has(k->direct, m) || k->due) {
    return renew(k, m, counts);
  }
  k->own = false;
  return PW_OK;
}

static pw_status apply_factor(void *ctx, const pw_real *r, pw_real *z)
{
  kept *k = ctx;
  return pw_direct_solve(k->direct, k->matrix, false, r, z);
}

static pw_status kept_solve(void *state, const pw_csr *m, pw_real reduction, const pw_real *b,
                            pw_real *x, pw_solver_counts *counts)
{
  kept *k = state;
  counts->last = 0;
  if (!k->own) {
    k->matrix = m;
    pw_krylov system = {.matrix = m,
                        .ctx = k,
                        .precondition = apply_factor,
                        .reduction = reduction,
                        .most = k->price,
                        .work = k->work};
    int last = 0;
    pw_status s = pw_direct_is_definite(k->direct) ? pw_krylov_cg(&system, b, x, &last)
                                                   : pw_krylov_gmres(&system, b, x, &last);
    counts->last = last;
    k->solves++;
    k->paid += last;
    k->due = last * k->solves > k->price + k->paid;
    if (s != PW_RETRY_DIVERGED) {
      return s;
    }
    PW_TRY(renew(k, m, counts));
  }
  return pw_direct_solve(k->direct, m, true, b, x);
}

static void kept_forget(void *state)
{
  kept *k = state;
  k->due = true;
}

static const char *kept_describe(const void *state)
{
  const kept *k = state;
  return k->options.symmetric ? "conjugate gradients with a kept factor of CHOLMOD"
                              : "GMRES with a kept factor of UMFPACK";
}

const pw_solver_calls pw_solver_krylov_calls = {kept_create, kept_destroy, kept_factor,
                                                kept_solve,  kept_forget,  kept_describe};
