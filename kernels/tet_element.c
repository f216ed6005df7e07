/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/tet_element.h"

/* Component of a symmetric tensor, order xx yy zz xy yz zx, at 3 i + j. */
static const int six[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};

static pw_real invert(const pw_real *f, pw_real *inverse)
{
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const pw_real *a = f + 3 * ((j + 1) % 3), *b = f + 3 * ((j + 2) % 3);
      inverse[3 * i + j] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
  }
  pw_real det = f[0] * inverse[0] + f[1] * inverse[3] + f[2] * inverse[6];
  for (int i = 0; i < 9; i++) {
    inverse[i] /= det;
  }
  return det;
}

void pw_tet_motion_of(const pw_real *start, const pw_real *u, pw_tet_motion *out)
{
  pw_real inverse[9];
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      pw_real sum = i == j ? 1.0 : 0.0;
      for (int a = 0; a < 4; a++) {
        sum += u[3 * a + i] * start[3 * a + j];
      }
      out->increment[3 * i + j] = sum;
    }
  }
  out->det = invert(out->increment, inverse);
  for (int a = 0; a < 4; a++) {
    for (int j = 0; j < 3; j++) {
      out->g[3 * a + j] = start[3 * a] * inverse[j] + start[3 * a + 1] * inverse[3 + j] +
                          start[3 * a + 2] * inverse[6 + j];
    }
  }
}

/*
 * The material gives D with d sigma_ij = D_ijkl e_kl for a symmetric e. From it
 *   (1/J) d tau_ij = D_ijkl e_kl + sigma_ij e_kk          for the symmetric part of dF F^-1 and
 *   (1/J) d tau_ij = w_im sigma_mj - sigma_im w_mj        for its skew part w,
 * and with - sigma_il delta_jk:
 *   a_ijkl = D_ijkl + sigma_ij delta_kl
 *            + (delta_ik sigma_jl - delta_il sigma_jk - sigma_ik delta_jl - sigma_il delta_jk) / 2.
 * Then a_ijkk = D_ijkk + 2 sigma_ij, so that q_ij = D_ijkk / 3.
 */
static void add_modulus(pw_real volume, const pw_real *s, const pw_real *tangent, pw_idx ld,
                        pw_tet_sums *sums)
{
  const pw_real half = 0.5 * volume;
  for (int ij = 0; ij < 9; ij++) {
    const int i = ij / 3, j = ij % 3;
    const pw_real *row = tangent + (size_t)(6 * six[ij]) * (size_t)ld;
    pw_real *a = sums->modulus + 9 * ij;
    for (int kl = 0; kl < 9; kl++) {
      a[kl] += volume * row[(size_t)six[kl] * (size_t)ld];
    }
    for (int k = 0; k < 3; k++) {
      a[4 * k] += volume * s[ij];
      a[3 * i + k] += half * s[3 * j + k];
      a[3 * k + i] -= half * s[3 * j + k];
      a[3 * k + j] -= half * s[3 * i + k];
      a[3 * j + k] -= half * s[3 * i + k];
    }
    sums->volumetric[ij] += volume / 3.0 * (row[0] + row[ld] + row[2 * (size_t)ld]);
  }
}

void pw_tet_add_point(pw_real volume, const pw_real *stress, const pw_real *tangent, pw_idx ld,
                      pw_tet_sums *sums)
{
  pw_real s[9];
  for (int ij = 0; ij < 9; ij++) {
    s[ij] = stress[(size_t)six[ij] * (size_t)ld];
    sums->stress[ij] += volume * s[ij];
  }
  if (tangent) {
    add_modulus(volume, s, tangent, ld, sums);
  }
}

/* out_ai = m_ij g_aj */
static void contract(const pw_real *m, const pw_real *g, pw_real *out)
{
  for (int a = 0; a < 4; a++) {
    for (int i = 0; i < 3; i++) {
      out[3 * a + i] =
          m[3 * i] * g[3 * a] + m[3 * i + 1] * g[3 * a + 1] + m[3 * i + 2] * g[3 * a + 2];
    }
  }
}

void pw_tet_force(const pw_tet_sums *sums, const pw_real *g, pw_real *force)
{
  contract(sums->stress, g, force);
}

void pw_tet_volumetric_force(const pw_tet_sums *sums, const pw_real *g, pw_real *force)
{
  contract(sums->volumetric, g, force);
}

void pw_tet_tangent(const pw_tet_sums *sums, const pw_real *g, pw_real *tangent)
{
  pw_real right[9][12]; /* A_ijkl g_bl */
  for (int ij = 0; ij < 9; ij++) {
    const pw_real *m = sums->modulus + 9 * ij;
    contract(m, g, right[ij]);
  }
  for (int a = 0; a < 4; a++) {
    for (int i = 0; i < 3; i++) {
      const pw_real *x = right[3 * i], *y = right[3 * i + 1], *z = right[3 * i + 2];
      for (int bk = 0; bk < 12; bk++) {
        tangent[12 * (3 * a + i) + bk] =
            g[3 * a] * x[bk] + g[3 * a + 1] * y[bk] + g[3 * a + 2] * z[bk];
      }
    }
  }
}
