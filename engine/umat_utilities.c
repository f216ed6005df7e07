/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What Abaqus offers its user routines, as Fortran calls it. Symmetric tensors have ndi normal and
 * nshr shear components in the order 11 22 33 12 13 23; LSTR is 1 for stresses, 2 for strains with
 * engineering shears. Source: Abaqus User Subroutines Reference Guide, utility routines. */
#include "engine/umat.h"

#include <math.h>
#include <string.h>

#include "kernels/spectral.h"

const char pw_umat_utilities[] = "XIT, STDB_ABQERR, SINV, SPRINC, SPRIND, ROTSIG, GETOUTDIR, "
                                 "GETJOBNAME, GETNUMCPUS";

_Noreturn void xit_(void);
void stdb_abqerr_(const int32_t *lop, const char *text, const int32_t *whole, const pw_real *real,
                  const char *word, size_t text_length, size_t word_length);
void sinv_(const pw_real *stress, pw_real *mean, pw_real *mises, const int32_t *ndi,
           const int32_t *nshr);
void sprinc_(const pw_real *s, pw_real *ps, const int32_t *lstr, const int32_t *ndi,
             const int32_t *nshr);
void sprind_(const pw_real *s, pw_real *ps, pw_real *an, const int32_t *lstr, const int32_t *ndi,
             const int32_t *nshr);
void rotsig_(const pw_real *s, const pw_real *r, pw_real *out, const int32_t *lstr,
             const int32_t *ndi, const int32_t *nshr);
void getoutdir_(char *name, int32_t *length, size_t size);
void getjobname_(char *name, int32_t *length, size_t size);
void getnumcpus_(int32_t *count);

void xit_(void)
{
  pw_umat_give_up("called XIT", NULL, 0);
}

/* Messages and warnings (lop 1, -1) are the library's own affair; errors end the call. */
void stdb_abqerr_(const int32_t *lop, const char *text, const int32_t *whole, const pw_real *real,
                  const char *word, size_t text_length, size_t word_length)
{
  (void)whole, (void)real, (void)word, (void)word_length;
  if (*lop <= -2) {
    pw_umat_give_up("reported an error", text, text_length);
  }
}

static pw_t6 load(const pw_real *s, pw_real shear, int ndi, int nshr)
{
  const pw_real f = 1.0 / shear;
  return (pw_t6){.xx = s[0],
                 .yy = ndi > 1 ? s[1] : 0.0,
                 .zz = ndi > 2 ? s[2] : 0.0,
                 .xy = nshr > 0 ? f * s[ndi] : 0.0,
                 .zx = nshr > 1 ? f * s[ndi + 1] : 0.0,
                 .yz = nshr > 2 ? f * s[ndi + 2] : 0.0};
}

static pw_real shear_factor(int lstr)
{
  return lstr == 2 ? 2.0 : 1.0;
}

void sinv_(const pw_real *stress, pw_real *mean, pw_real *mises, const int32_t *ndi,
           const int32_t *nshr)
{
  pw_t6 s = load(stress, 1.0, *ndi, *nshr);
  *mean = pw_t6_trace(s) / 3.0;
  *mises = sqrt(1.5) * pw_t6_norm(pw_t6_shift(s, -*mean));
}

void sprinc_(const pw_real *s, pw_real *ps, const int32_t *lstr, const int32_t *ndi,
             const int32_t *nshr)
{
  pw_real axes[9];
  sprind_(s, ps, axes, lstr, ndi, nshr);
}

void sprind_(const pw_real *s, pw_real *ps, pw_real *an, const int32_t *lstr, const int32_t *ndi,
             const int32_t *nshr)
{
  pw_spectrum p = pw_t6_spectrum(load(s, shear_factor(*lstr), *ndi, *nshr));
  for (int k = 0; k < 3; k++) {
    ps[k] = p.value[k];
    for (int i = 0; i < 3; i++) {
      an[k + 3 * i] = p.vector[3 * k + i];
    }
  }
}

void rotsig_(const pw_real *s, const pw_real *r, pw_real *out, const int32_t *lstr,
             const int32_t *ndi, const int32_t *nshr)
{
  const pw_real shear = shear_factor(*lstr);
  const pw_rot rot = {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]};
  pw_t6 t = pw_t6_rotate(rot, load(s, shear, *ndi, *nshr));
  const pw_real normals[3] = {t.xx, t.yy, t.zz}, shears[3] = {t.xy, t.zx, t.yz};
  for (int k = 0; k < *ndi; k++) {
    out[k] = normals[k];
  }
  for (int k = 0; k < *nshr; k++) {
    out[*ndi + k] = shear * shears[k];
  }
}

/** A Fortran text of @p size characters, blank behind. */
static void give_text(const char *text, char *name, int32_t *length, size_t size)
{
  size_t n = strlen(text) < size ? strlen(text) : size;
  memset(name, ' ', size);
  memcpy(name, text, n);
  *length = (int32_t)n;
}

void getoutdir_(char *name, int32_t *length, size_t size)
{
  give_text(".", name, length, size);
}

void getjobname_(char *name, int32_t *length, size_t size)
{
  give_text("pilewright", name, length, size);
}

void getnumcpus_(int32_t *count)
{
  *count = 1;
}
