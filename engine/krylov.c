/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/krylov.h"

#include <math.h>
#include <string.h>

enum { BASIS = PW_KRYLOV_RESTART + 1 };

pw_off pw_krylov_room(pw_idx n, bool symmetric)
{
  return (pw_off)n * (symmetric ? 4 : BASIS + 1);
}

static pw_real dot(pw_idx n, const pw_real *x, const pw_real *y)
{
  pw_real sum = 0.0;
  for (pw_idx i = 0; i < n; i++) {
    sum += x[i] * y[i];
  }
  return sum;
}

/* y = y + a x */
static void add(pw_idx n, pw_real a, const pw_real *x, pw_real *y)
{
  for (pw_idx i = 0; i < n; i++) {
    y[i] += a * x[i];
  }
}

static pw_status give_up(const char *method, int iterations, pw_real left)
{
  return pw_error_set(PW_RETRY_DIVERGED, __FILE__, __LINE__, __func__,
                      "%s: %g of the residual is left after %d iterations", method, left,
                      iterations);
}

pw_status pw_krylov_cg(const pw_krylov *k, const pw_real *b, pw_real *x, int *iterations)
{
  const pw_idx n = k->matrix->n;
  pw_real *r = k->work, *z = r + n, *p = z + n, *q = p + n;
  const pw_real first = sqrt(dot(n, b, b));
  pw_real rz = 0.0, left = first;
  memset(x, 0, (size_t)n * sizeof *x);
  memcpy(r, b, (size_t)n * sizeof *r);
  *iterations = 0;
  while (left > k->reduction * first) {
    if (*iterations == k->most) {
      return give_up("conjugate gradients", *iterations, left / first);
    }
    PW_TRY(k->precondition(k->ctx, r, z));
    const pw_real before = rz;
    rz = dot(n, r, z);
    PW_REQUIRE(rz > 0.0, PW_RETRY_DIVERGED, "the preconditioner is not positive definite");
    const pw_real beta = *iterations == 0 ? 0.0 : rz / before;
    for (pw_idx i = 0; i < n; i++) {
      p[i] = z[i] + (*iterations == 0 ? 0.0 : beta * p[i]);
    }
    pw_csr_multiply(k->matrix, p, q);
    const pw_real curvature = dot(n, p, q);
    PW_REQUIRE(curvature > 0.0, PW_RETRY_DIVERGED, "the matrix is not positive definite");
    add(n, rz / curvature, p, x);
    add(n, -rz / curvature, q, r);
    left = sqrt(dot(n, r, r));
    ++*iterations;
  }
  PW_REQUIRE(isfinite(left), PW_RETRY_DIVERGED, "conjugate gradients meet what is no number");
  return PW_OK;
}

/* The small least-squares problem of GMRES: H by columns, made triangular by rotations. */
typedef struct {
  pw_real h[PW_KRYLOV_RESTART][BASIS]; /* h[column][row] */
  pw_real cosine[PW_KRYLOV_RESTART], sine[PW_KRYLOV_RESTART];
  pw_real g[BASIS]; /* right-hand side; |g[j]| is what is left after j columns */
} hessenberg;

/* Takes column j of H, of j + 2 entries, to triangular form. */
static void rotate_column(hessenberg *s, int j)
{
  pw_real *h = s->h[j];
  for (int i = 0; i < j; i++) {
    const pw_real upper = h[i], lower = h[i + 1];
    h[i] = s->cosine[i] * upper + s->sine[i] * lower;
    h[i + 1] = s->cosine[i] * lower - s->sine[i] * upper;
  }
  const pw_real norm = sqrt(h[j] * h[j] + h[j + 1] * h[j + 1]);
  s->cosine[j] = norm > 0.0 ? h[j] / norm : 1.0;
  s->sine[j] = norm > 0.0 ? h[j + 1] / norm : 0.0;
  h[j] = norm;
  h[j + 1] = 0.0;
  s->g[j + 1] = -s->sine[j] * s->g[j];
  s->g[j] *= s->cosine[j];
}

/* x = x + M^-1 V y with y from the first m columns; z [2 n] is scratch. */
static pw_status correct(const pw_krylov *k, const hessenberg *s, int m, pw_real *x)
{
  const pw_idx n = k->matrix->n;
  pw_real y[PW_KRYLOV_RESTART], *z = k->work, *v = z + n;
  for (int i = m - 1; i >= 0; i--) {
    y[i] = s->g[i];
    for (int j = i + 1; j < m; j++) {
      y[i] -= s->h[j][i] * y[j];
    }
    PW_REQUIRE(s->h[i][i] > 0.0, PW_RETRY_DIVERGED, "GMRES: the matrix is singular");
    y[i] /= s->h[i][i];
  }
  for (pw_idx i = 0; i < n; i++) { /* the first direction is no longer needed */
    v[i] *= y[0];
  }
  for (int j = 1; j < m; j++) {
    add(n, y[j], v + (size_t)j * (size_t)n, v);
  }
  PW_TRY(k->precondition(k->ctx, v, z));
  add(n, 1.0, z, x);
  return PW_OK;
}

/* One cycle: up to PW_KRYLOV_RESTART directions from the residual in v[0], whose norm is `left`. */
static pw_status cycle(const pw_krylov *k, hessenberg *s, pw_real goal, pw_real *left, pw_real *x,
                       int *iterations)
{
  const size_t n = (size_t)k->matrix->n;
  pw_real *z = k->work, *v = z + n;
  int j = 0;
  memset(s->g, 0, sizeof s->g);
  s->g[0] = *left;
  for (size_t i = 0; i < n; i++) {
    v[i] /= *left;
  }
  while (j < PW_KRYLOV_RESTART && *iterations<k->most && * left> goal) {
    pw_real *next = v + (size_t)(j + 1) * n;
    PW_TRY(k->precondition(k->ctx, v + (size_t)j * n, z));
    pw_csr_multiply(k->matrix, z, next);
    for (int i = 0; i <= j; i++) {
      s->h[j][i] = dot(k->matrix->n, v + (size_t)i * n, next);
      add(k->matrix->n, -s->h[j][i], v + (size_t)i * n, next);
    }
    const pw_real norm = sqrt(dot(k->matrix->n, next, next));
    PW_REQUIRE(isfinite(norm), PW_RETRY_DIVERGED, "GMRES meets what is no number");
    s->h[j][j + 1] = norm;
    for (size_t i = 0; i < n && norm > 0.0; i++) {
      next[i] /= norm;
    }
    rotate_column(s, j);
    *left = fabs(s->g[++j]);
    ++*iterations;
  }
  return correct(k, s, j, x);
}

pw_status pw_krylov_gmres(const pw_krylov *k, const pw_real *b, pw_real *x, int *iterations)
{
  const pw_idx n = k->matrix->n;
  hessenberg s;
  pw_real *v = k->work + n, left = sqrt(dot(n, b, b));
  const pw_real first = left;
  memset(x, 0, (size_t)n * sizeof *x);
  memcpy(v, b, (size_t)n * sizeof *v);
  *iterations = 0;
  while (left > k->reduction * first) {
    if (*iterations == k->most) {
      return give_up("GMRES", *iterations, left / first);
    }
    PW_TRY(cycle(k, &s, k->reduction * first, &left, x, iterations));
    if (left > k->reduction * first) {
      pw_csr_multiply(k->matrix, x, v);
      for (pw_idx i = 0; i < n; i++) {
        v[i] = b[i] - v[i];
      }
      left = sqrt(dot(n, v, v));
    }
  }
  PW_REQUIRE(isfinite(left), PW_RETRY_DIVERGED, "GMRES meets what is no number");
  return PW_OK;
}
