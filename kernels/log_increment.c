/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/log_increment.h"

#include "kernels/spectral.h"

/* Component of a tensor in the order xx yy zz xy yz zx at 3 i + j, and back. */
static const int six[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
static const int row_of[6] = {0, 1, 2, 0, 1, 0}, col_of[6] = {0, 1, 2, 1, 2, 2};

/** F F^T - 1, from F - 1: small increments keep their digits. */
static pw_t6 stretch_less_one(const pw_real *f)
{
  pw_real g[9], c[6];
  for (int k = 0; k < 9; k++) {
    g[k] = f[k] - (k % 4 == 0 ? 1.0 : 0.0);
  }
  for (int k = 0; k < 6; k++) {
    const pw_real *a = g + 3 * row_of[k], *b = g + 3 * col_of[k];
    c[k] = (a[col_of[k]] + b[row_of[k]]) +
           (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]); /* G + G^T + GG^T */
  }
  return pw_t6_load(c, 1);
}

/** W of R = V^-1 F: the skew part of R times 4/(1 + tr R). */
static void spin_of(const pw_real *f, pw_t6 inverse, pw_real *spin)
{
  pw_real v[6], r[9], trace = 1.0;
  pw_t6_store(inverse, v, 1);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      r[3 * i + j] =
          v[six[3 * i]] * f[j] + v[six[3 * i + 1]] * f[3 + j] + v[six[3 * i + 2]] * f[6 + j];
    }
    trace += r[4 * i];
  }
  spin[0] = 2.0 * (r[1] - r[3]) / trace;
  spin[1] = 2.0 * (r[5] - r[7]) / trace;
  spin[2] = 2.0 * (r[6] - r[2]) / trace;
}

/** x / sinh(x). */
static pw_real over_sinh(pw_real x)
{
  return fabs(x) < 1e-4 ? 1.0 - x * x / 6.0 : x / sinh(x);
}

/** Columns of the two maps for each unit strain e: into the axes, scaled there, and back. */
static void set_maps(const pw_spectrum *s, const pw_real *log_stretch, pw_log_increment *out)
{
  const pw_real *n = s->vector;
  pw_real share[9], angle[9];
  for (int ij = 0; ij < 9; ij++) {
    const pw_real x = log_stretch[ij / 3] - log_stretch[ij % 3];
    share[ij] = over_sinh(x);
    angle[ij] = -tanh(0.5 * x);
  }
  for (int col = 0; col < 6; col++) {
    const int p = row_of[col], q = col_of[col];
    pw_real seen[9] = {0}, turn[9] = {0};
    for (int ij = 0; ij < 9; ij++) {
      const pw_real *a = n + 3 * (ij / 3), *b = n + 3 * (ij % 3);
      const pw_real e = 0.5 * (a[p] * b[q] + a[q] * b[p]);
      for (int k = 0; k < 9; k++) {
        seen[k] += share[ij] * e * a[k / 3] * b[k % 3];
        turn[k] += angle[ij] * e * a[k / 3] * b[k % 3];
      }
    }
    for (int row = 0; row < 6; row++) {
      out->seen[6 * row + col] = (row < 3 ? 1.0 : 2.0) * seen[3 * row_of[row] + col_of[row]];
    }
    out->turn[col] = turn[1];
    out->turn[6 + col] = turn[5];
    out->turn[12 + col] = turn[6];
  }
}

void pw_log_increment_of(const pw_real *f, pw_log_increment *out)
{
  const pw_spectrum s = pw_t6_spectrum(stretch_less_one(f));
  pw_real log_stretch[3], inverse[3];
  for (int k = 0; k < 3; k++) {
    log_stretch[k] = 0.5 * log1p(s.value[k]);
    inverse[k] = 1.0 / sqrt(1.0 + s.value[k]);
  }
  pw_t6_store(pw_spectrum_tensor(&s, log_stretch), out->strain, 1);
  spin_of(f, pw_spectrum_tensor(&s, inverse), out->spin);
  set_maps(&s, log_stretch, out);
}

void pw_log_increment_tangent(const pw_log_increment *inc, const pw_real *stress, pw_real *tangent,
                              size_t ld)
{
  const pw_t6 t = pw_t6_load(stress, ld);
  const pw_real sig[9] = {t.xx, t.xy, t.zx, t.xy, t.yy, t.yz, t.zx, t.yz, t.zz};
  pw_real out[36];
  for (int col = 0; col < 6; col++) {
    const pw_real xy = inc->turn[col], yz = inc->turn[6 + col], zx = inc->turn[12 + col];
    const pw_real w[9] = {0, xy, -zx, -xy, 0, yz, zx, -yz, 0};
    for (int row = 0; row < 6; row++) {
      const int i = row_of[row], j = col_of[row];
      pw_real sum = 0.0;
      for (int k = 0; k < 6; k++) {
        sum += tangent[(size_t)(6 * row + k) * ld] * inc->seen[6 * k + col];
      }
      for (int k = 0; k < 3; k++) { /* W sigma - sigma W */
        sum += w[3 * i + k] * sig[3 * k + j] - sig[3 * i + k] * w[3 * k + j];
      }
      out[6 * row + col] = sum;
    }
  }
  for (size_t k = 0; k < 36; k++) {
    tangent[k * ld] = out[k];
  }
}
