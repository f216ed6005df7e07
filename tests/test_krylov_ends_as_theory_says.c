/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Conjugate gradients and GMRES end after as many steps as the matrix has distinct eigenvalues
 * (Saad, Iterative Methods for Sparse Linear Systems, 2nd ed., 6.11.3: the degree of its minimal
 * polynomial), GMRES without a step of progress before the last on a cyclic shift (6.11.4), and a
 * matrix that is not definite is noticed. */
#include <stdlib.h>

#include "engine/krylov.h"
#include "tests/harness.h"

enum { N = 60 };

static pw_off start[N + 1];
static pw_idx col[N];
static double value[N], work[(PW_KRYLOV_RESTART + 2) * N];

/* One entry in each row. */
static pw_csr one_each(pw_idx shift, const double *v, int distinct)
{
  for (pw_idx i = 0; i < N; i++) {
    start[i + 1] = i + 1;
    col[i] = (i + shift) % N;
    value[i] = v[i % distinct];
  }
  return (pw_csr){.n = N, .start = start, .col = col, .value = value};
}

static pw_status identity(void *ctx, const pw_real *r, pw_real *z)
{
  (void)ctx;
  memcpy(z, r, N * sizeof *z);
  return PW_OK;
}

static pw_status jacobi(void *ctx, const pw_real *r, pw_real *z)
{
  (void)ctx;
  for (int i = 0; i < N; i++) {
    z[i] = r[i] / value[i];
  }
  return PW_OK;
}

static void check_end(pw_status (*solve)(const pw_krylov *, const pw_real *, pw_real *, int *),
                      const pw_krylov *k, int expected)
{
  double x[N], b[N], y[N];
  int iterations = -1;
  for (int i = 0; i < N; i++) {
    y[i] = cos(1.0 + i);
  }
  pw_csr_multiply(k->matrix, y, b);
  assert_ok(solve(k, b, x, &iterations));
  assert_int_equal(iterations, expected);
  for (int i = 0; i < N; i++) {
    assert_near(x[i], y[i], 1e-10);
  }
}

static void distinct_eigenvalues_are_counted(void **state)
{
  (void)state;
  const double v[] = {1.0, 3.0, 10.0, 40.0, 7.0};
  for (int distinct = 1; distinct <= 5; distinct++) {
    pw_csr m = one_each(0, v, distinct);
    pw_krylov k = {
        .matrix = &m, .precondition = identity, .reduction = 1e-11, .most = 20, .work = work};
    check_end(pw_krylov_cg, &k, distinct);
    check_end(pw_krylov_gmres, &k, distinct);
    k.precondition = jacobi; /* the inverse itself */
    check_end(pw_krylov_cg, &k, 1);
    check_end(pw_krylov_gmres, &k, 1);
  }
}

static void nothing_to_solve_is_nothing(void **state)
{
  (void)state;
  const double v[] = {2.0};
  double b[N] = {0.0}, x[N];
  int iterations = -1;
  pw_csr m = one_each(0, v, 1);
  pw_krylov k = {
      .matrix = &m, .precondition = identity, .reduction = 1e-10, .most = 5, .work = work};
  memset(x, 1, sizeof x);
  assert_ok(pw_krylov_cg(&k, b, x, &iterations));
  assert_true(iterations == 0 && x[0] == 0.0 && x[N - 1] == 0.0);
  memset(x, 1, sizeof x);
  assert_ok(pw_krylov_gmres(&k, b, x, &iterations));
  assert_true(iterations == 0 && x[0] == 0.0 && x[N - 1] == 0.0);
}

/* b = e_0: the residual stays that of x = 0 until all directions are known. A restart comes first. */
static void a_cyclic_shift_defeats_gmres(void **state)
{
  (void)state;
  const double v[] = {1.0};
  double b[N] = {1.0}, x[N];
  int iterations = -1;
  pw_csr m = one_each(1, v, 1);
  pw_krylov k = {
      .matrix = &m, .precondition = identity, .reduction = 1e-10, .most = 50, .work = work};
  assert_int_equal(pw_krylov_gmres(&k, b, x, &iterations), PW_RETRY_DIVERGED);
  assert_int_equal(iterations, 50);
  assert_non_null(strstr(pw_error_text(), "after 50 iterations"));
}

static void cg_notices_what_is_not_definite(void **state)
{
  (void)state;
  const double v[] = {1.0, -2.0}, zero[] = {0.0}, nan[] = {NAN};
  double b[N], x[N];
  int iterations = -1;
  for (int i = 0; i < N; i++) {
    b[i] = i % 2 == 0 ? 1.0 : 2.0;
  }
  pw_csr m = one_each(0, v, 2);
  pw_krylov k = {
      .matrix = &m, .precondition = identity, .reduction = 1e-10, .most = 50, .work = work};
  assert_int_equal(pw_krylov_cg(&k, b, x, &iterations), PW_RETRY_DIVERGED);
  assert_non_null(strstr(pw_error_text(), "not positive definite"));
  check_end(pw_krylov_gmres, &k, 2);
  m = one_each(0, zero, 1);
  assert_int_equal(pw_krylov_gmres(&k, b, x, &iterations), PW_RETRY_DIVERGED);
  m = one_each(0, nan, 1);
  assert_int_equal(pw_krylov_cg(&k, b, x, &iterations), PW_RETRY_DIVERGED);
  assert_int_equal(pw_krylov_gmres(&k, b, x, &iterations), PW_RETRY_DIVERGED);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(distinct_eigenvalues_are_counted),
      cmocka_unit_test(nothing_to_solve_is_nothing),
      cmocka_unit_test(a_cyclic_shift_defeats_gmres),
      cmocka_unit_test(cg_notices_what_is_not_definite),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
