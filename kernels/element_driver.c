/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/element_driver.h"

#include <math.h>
#include <string.h>

enum { ITERATIONS = 30, HALVINGS = 6, SMALLEST_PIECE = 1024 };

pw_status pw_element_start(pw_element *el, const pw_material *material, const pw_real *param,
                           const pw_real *stress)
{
  memset(el, 0, sizeof *el);
  PW_TRY(material->check(param));
  el->material = material;
  el->param = param;
  memcpy(el->stress, stress, sizeof el->stress);
  el->f[0] = el->f[4] = el->f[8] = 1.0;
  el->density = material->density(param);
  el->tolerance = 1e-8;
  material->init(param, 1, 1, el->stress, el->state);
  return PW_OK;
}

static void multiply(const pw_real *a, const pw_real *b, pw_real *c)
{
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
    }
  }
}

/** exp(a) by squaring the Taylor series of exp(a / 2^k). */
static void exponential(const pw_real *a, pw_real *out)
{
  pw_real size = 0.0, term[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, scaled[9], next[9];
  int k = 0;
  for (int i = 0; i < 9; i++) {
    size += fabs(a[i]);
  }
  for (; size > 0.1 && k < 40; k++) {
    size *= 0.5;
  }
  memcpy(out, term, sizeof term);
  for (int i = 0; i < 9; i++) {
    scaled[i] = ldexp(a[i], -k);
  }
  for (int n = 1; n <= 10; n++) {
    multiply(term, scaled, next);
    for (int i = 0; i < 9; i++) {
      term[i] = next[i] / n;
      out[i] += term[i];
    }
  }
  for (; k > 0; k--) {
    multiply(out, out, next);
    memcpy(out, next, sizeof next);
  }
}

/** Deformation gradient after the increment, and that of the increment alone. */
static void deform(const pw_real *f, const pw_real *de, const pw_real *spin, pw_real *step,
                   pw_real *out)
{
  const pw_real a[9] = {de[0],           de[3] + spin[0], de[5] - spin[2],
                        de[3] - spin[0], de[1],           de[4] + spin[1],
                        de[5] + spin[2], de[4] - spin[1], de[2]};
  exponential(a, step);
  multiply(step, f, out);
}

pw_status pw_element_move(pw_element *el, const pw_real *de, const pw_real *spin, pw_real *tangent)
{
  const pw_real none[3] = {0};
  pw_element next = *el;
  pw_real dvol = exp(de[0] + de[1] + de[2]), b[6], step[9];
  const pw_real *turn = spin ? spin : none, *f = next.f;
  deform(el->f, de, turn, step, next.f);
  pw_real jac = f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
                f[2] * (f[3] * f[7] - f[4] * f[6]);
  if (!(jac > 0.0) || !isfinite(jac)) {
    return PW_RETRY_DOMAIN_INVERTED;
  }
  const int row[6] = {0, 1, 2, 0, 1, 2}, col[6] = {0, 1, 2, 1, 2, 0};
  for (int c = 0; c < 6; c++) {
    const pw_real *p = f + 3 * row[c], *q = f + 3 * col[c];
    b[c] = p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
  }
  next.density = el->density / dvol;
  pw_stress_args args = {.n = 1,
                         .ld = 1,
                         .ldi = 1,
                         .dt = 1.0,
                         .time = (pw_real)el->moves,
                         .step = el->moves,
                         .dstrain = de,
                         .spin = turn,
                         .dvol = &dvol,
                         .left_cg = b,
                         .jac = &jac,
                         .density = &next.density,
                         .def_grad = next.f,
                         .increment = step,
                         .stress = next.stress,
                         .state = next.state,
                         .wave_speed = &next.wave_speed,
                         .of_f = el->material->of_f,
                         .tangent = tangent,
                         .counts = &next.counts};
  pw_status s = el->material->update(el->param, &args);
  if (s != PW_OK) {
    el->why = args.why;
    return s;
  }
  for (int c = 0; c < 6; c++) {
    next.strain[c] += de[c];
  }
  next.moves++;
  *el = next;
  return PW_OK;
}

/** Solve a x = b in place by elimination with row exchanges; false when singular. */
static bool eliminate(int n, pw_real a[6][6], pw_real *b)
{
  pw_real first = 0.0;
  for (int k = 0; k < n; k++) {
    int best = k;
    for (int i = k + 1; i < n; i++) {
      best = fabs(a[i][k]) > fabs(a[best][k]) ? i : best;
    }
    first = pw_max(first, fabs(a[best][k]));
    if (!(fabs(a[best][k]) > 1e-11 * first)) {
      return false;
    }
    for (int j = 0; j < n; j++) {
      pw_real swap = a[k][j];
      a[k][j] = a[best][j];
      a[best][j] = swap;
    }
    pw_real swap = b[k];
    b[k] = b[best];
    b[best] = swap;
    for (int i = k + 1; i < n; i++) {
      pw_real f = a[i][k] / a[k][k];
      for (int j = k; j < n; j++) {
        a[i][j] -= f * a[k][j];
      }
      b[i] -= f * b[k];
    }
  }
  for (int k = n - 1; k >= 0; k--) {
    for (int j = k + 1; j < n; j++) {
      b[k] -= a[k][j] * b[j];
    }
    b[k] /= a[k][k];
  }
  return true;
}

/**
 * Rows of @p a made orthogonal by Jacobi rotations that act on @p b as well; then the shortest x
 * with a x = b is the sum of the rows, each times b over its square. Rows that vanish are left out.
 */
static void shortest(int n, pw_real a[6][6], pw_real *b)
{
  pw_real x[6] = {0}, size = 0.0;
  for (int sweep = 0; sweep < 30; sweep++) {
    for (int p = 0; p < n; p++) {
      for (int q = p + 1; q < n; q++) {
        pw_real pp = 0.0, qq = 0.0, pq = 0.0;
        for (int j = 0; j < n; j++) {
          pp += a[p][j] * a[p][j];
          qq += a[q][j] * a[q][j];
          pq += a[p][j] * a[q][j];
        }
        if (!(fabs(pq) > 1e-15 * sqrt(pp * qq))) {
          continue;
        }
        pw_real zeta = (qq - pp) / (2.0 * pq);
        pw_real t = copysign(1.0, zeta) / (fabs(zeta) + sqrt(1.0 + zeta * zeta));
        pw_real c = 1.0 / sqrt(1.0 + t * t), s = t * c, bp = b[p];
        for (int j = 0; j < n; j++) {
          pw_real ap = a[p][j];
          a[p][j] = c * ap - s * a[q][j];
          a[q][j] = s * ap + c * a[q][j];
        }
        b[p] = c * bp - s * b[q];
        b[q] = s * bp + c * b[q];
      }
    }
  }
  pw_real square[6] = {0};
  for (int p = 0; p < n; p++) {
    for (int j = 0; j < n; j++) {
      square[p] += a[p][j] * a[p][j];
    }
    size = pw_max(size, square[p]);
  }
  for (int p = 0; p < n; p++) {
    for (int j = 0; square[p] > 1e-20 * size && j < n; j++) {
      x[j] += a[p][j] * b[p] / square[p];
    }
  }
  memcpy(b, x, (size_t)n * sizeof *b);
}

/** Solve a x = b in place. Where a is singular, as on the edges of a yield surface, the shortest
 *  of the best solutions is taken: it keeps the symmetry of the loading. */
static bool solve(int n, pw_real a[6][6], pw_real *b)
{
  pw_real copy[6][6], rhs[6], sum = 0.0;
  memcpy(copy, a, sizeof copy);
  memcpy(rhs, b, (size_t)n * sizeof *rhs);
  if (!eliminate(n, a, b)) {
    memcpy(b, rhs, (size_t)n * sizeof *b);
    shortest(n, copy, b);
  }
  for (int k = 0; k < n; k++) {
    sum += fabs(b[k]);
  }
  return isfinite(sum);
}

/** Components whose strain is open, their count. */
static int open_components(const pw_element_step *step, int *open)
{
  int n = 0;
  for (int c = 0; c < 6; c++) {
    if (step->control[c] == PW_CONTROL_STRESS) {
      open[n++] = c;
    }
  }
  return n;
}

/** Largest deviation from a prescribed stress, relative to the size of the stress. */
static pw_real mismatch(const pw_element *el, const pw_element_step *step)
{
  pw_real worst = 0.0, size = 1.0;
  for (int c = 0; c < 6; c++) {
    size += fabs(el->stress[c]);
    if (step->control[c] == PW_CONTROL_STRESS) {
      worst = pw_max(worst, fabs(step->value[c] - el->stress[c]));
    }
  }
  return worst / size;
}

/** Newton correction of the open strains from the residual of @p trial. */
static bool correction(const pw_element *trial, const pw_element_step *step, const pw_real *tangent,
                       pw_real *change)
{
  int open[6], n = open_components(step, open);
  pw_real a[6][6], rhs[6];
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) { /* columns are per engineering shear */
      a[i][j] = tangent[6 * open[i] + open[j]] * (open[j] < 3 ? 1.0 : 2.0);
    }
    rhs[i] = step->value[open[i]] - trial->stress[open[i]];
  }
  if (!solve(n, a, rhs)) {
    return false;
  }
  memset(change, 0, 6 * sizeof *change);
  for (int i = 0; i < n; i++) {
    change[open[i]] = rhs[i];
  }
  return true;
}

/** First guess of the increment: the last one, scaled to the strains prescribed now. */
static void predict(const pw_element *el, const pw_element_step *step, pw_real *de)
{
  pw_real along = 0.0, size = 0.0;
  for (int c = 0; c < 6; c++) {
    if (step->control[c] == PW_CONTROL_STRAIN) {
      along += step->value[c] * el->last[c];
      size += el->last[c] * el->last[c];
    }
  }
  pw_real ratio = size > 0.0 ? along / size : 0.0;
  ratio = ratio > 0.0 && ratio < 10.0 ? ratio : 0.0; /* a turn: no guess */
  for (int c = 0; c < 6; c++) {
    de[c] = step->control[c] == PW_CONTROL_STRAIN ? step->value[c] : ratio * el->last[c];
  }
}

/** One piece of a step by Newton's method with halved corrections. */
static pw_status newton(pw_element *el, const pw_element_step *step)
{
  pw_real de[6], next_de[6], change[6] = {0}, tangent[36], next_tangent[36];
  pw_element trial = *el;
  predict(el, step, de);
  pw_status first = pw_element_move(&trial, de, step->spin, tangent);
  el->why = first != PW_OK ? trial.why : el->why;
  PW_TRY(first);
  pw_real miss = mismatch(&trial, step);
  for (int it = 0; it < ITERATIONS && miss > el->tolerance; it++) {
    pw_real scale = 1.0, next_miss = HUGE_VAL;
    pw_element next = *el;
    if (!correction(&trial, step, tangent, change)) {
      return PW_RETRY_DIVERGED;
    }
    for (int k = 0; k < HALVINGS && !(next_miss < miss); k++, scale *= 0.5) {
      next = *el;
      for (int c = 0; c < 6; c++) {
        next_de[c] = de[c] + scale * change[c];
      }
      pw_status s = pw_element_move(&next, next_de, step->spin, next_tangent);
      next_miss = s == PW_OK ? mismatch(&next, step) : HUGE_VAL;
      el->why = s == PW_OK ? el->why : next.why;
    }
    if (!(next_miss < miss)) {
      break;
    }
    trial = next;
    miss = next_miss;
    memcpy(de, next_de, sizeof de);
    memcpy(tangent, next_tangent, sizeof tangent);
  }
  /* Substeps make the stress jump within their tolerance: a residual of that size may remain. */
  if (!(miss <= 100.0 * el->tolerance)) {
    return PW_RETRY_DIVERGED;
  }
  *el = trial;
  memcpy(el->last, de, sizeof de);
  return PW_OK;
}

pw_status pw_element_drive(pw_element *el, const pw_element_step *step)
{
  const pw_element start = *el;
  int done = 0, piece = SMALLEST_PIECE; /* in units of 1/SMALLEST_PIECE of the step */
  while (done < SMALLEST_PIECE) {
    pw_element_step part = *step;
    pw_real share = (pw_real)piece / SMALLEST_PIECE;
    for (int c = 0; c < 6; c++) {
      pw_real goal = (pw_real)(done + piece) / SMALLEST_PIECE;
      part.value[c] = step->control[c] == PW_CONTROL_STRAIN
                          ? share * step->value[c]
                          : start.stress[c] + goal * (step->value[c] - start.stress[c]);
    }
    for (int c = 0; c < 3; c++) {
      part.spin[c] = share * step->spin[c];
    }
    if (newton(el, &part) == PW_OK) {
      done += piece;
      piece = done + 2 * piece <= SMALLEST_PIECE && done % (2 * piece) == 0 ? 2 * piece : piece;
    } else if (piece > 1) {
      piece /= 2;
    } else {
      const char *why = el->why;
      *el = start;
      el->why = why;
      return PW_RETRY_DIVERGED;
    }
  }
  return PW_OK;
}
