/* SPDX-License-Identifier: GPL-3.0-or-later */
/* UMATs in C with Fortran's names: von Mises plasticity as in cases/umat_von_mises, and routines
 * that fail in every way a host must cope with. A shared library of its own. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "kernels/spectral.h"

typedef double real;
typedef int32_t integer;

#define ARGUMENTS                                                                                  \
  real *stress, real *statev, real *ddsdde, real *sse, real *spd, real *scd, real *rpl,            \
      real *ddsddt, real *drplde, real *drpldt, real *stran, real *dstran, real *time,             \
      real *dtime, real *temp, real *dtemp, real *predef, real *dpred, char *cmname, integer *ndi, \
      integer *nshr, integer *ntens, integer *nstatv, real *props, integer *nprops, real *coords,  \
      real *drot, real *pnewdt, real *celent, real *dfgrd0, real *dfgrd1, integer *noel,           \
      integer *npt, integer *layer, integer *kspt, integer *kstep, integer *kinc,                  \
      size_t cmname_length
#define PASSED                                                                                     \
  stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime,  \
      temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot,   \
      pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc, cmname_length

void umat_(ARGUMENTS);
void umat_hencky_(ARGUMENTS);
void umat_elastic_(ARGUMENTS);
void umat_stop_(ARGUMENTS);
void umat_xit_(ARGUMENTS);
void umat_reports_(ARGUMENTS);
void umat_nan_(ARGUMENTS);
void umat_reads_beyond_(ARGUMENTS);
void umat_writes_beyond_(ARGUMENTS);
void umat_small_steps_(ARGUMENTS);
void umat_never_content_(ARGUMENTS);
void umat_fragile_(ARGUMENTS);
void umat_lazy_(ARGUMENTS);
void umat_no_tangent_(ARGUMENTS);
void umat_careless_(ARGUMENTS);
void umat_spy_(ARGUMENTS);
void umat_utilities_(ARGUMENTS);

extern _Noreturn void _gfortran_stop_string(const char *, size_t, bool);
extern _Noreturn void xit_(void);
extern void stdb_abqerr_(const integer *, const char *, const integer *, const real *, const char *,
                         size_t, size_t);
extern void sinv_(const real *, real *, real *, const integer *, const integer *);
extern void sprind_(const real *, real *, real *, const integer *, const integer *,
                    const integer *);
extern void rotsig_(const real *, const real *, real *, const integer *, const integer *,
                    const integer *);

/* props: E, nu, yield stress, hardening modulus; statev(1): plastic strain. */
void umat_(ARGUMENTS)
{
  const real shear = 0.5 * props[0] / (1.0 + props[1]);
  const real lambda = 2.0 * shear * props[1] / (1.0 - 2.0 * props[1]);
  real tr = dstran[0] + dstran[1] + dstran[2], dev[6], j2 = 0.0;
  for (int i = 0; i < 6; i++) {
    stress[i] += i < 3 ? lambda * tr + 2.0 * shear * dstran[i] : shear * dstran[i];
  }
  real mean = (stress[0] + stress[1] + stress[2]) / 3.0;
  for (int i = 0; i < 6; i++) {
    dev[i] = stress[i] - (i < 3 ? mean : 0.0);
    j2 += (i < 3 ? 0.5 : 1.0) * dev[i] * dev[i];
  }
  real q = sqrt(3.0 * j2), over = q - props[2] - props[3] * statev[0];
  real flow = over > 0.0 ? over / (3.0 * shear + props[3]) : 0.0;
  real ratio = over > 0.0 ? 1.0 - 3.0 * shear * flow / q : 1.0;
  for (int i = 0; i < 6; i++) {
    stress[i] = ratio * dev[i] + (i < 3 ? mean : 0.0);
  }
  statev[0] += flow;
  real along = over > 0.0 ? 3.0 * shear * (ratio - props[3] / (3.0 * shear + props[3])) : 0.0;
  for (int i = 0; i < 6; i++) {
    for (int j = 0; j < 6; j++) {
      real c = i < 3 && j < 3 ? lambda + 2.0 / 3.0 * shear * (1.0 - ratio) : 0.0;
      c += i == j ? (i < 3 ? 2.0 : 1.0) * ratio * shear : 0.0;
      ddsdde[i + 6 * j] = over > 0.0 ? c - along / (q * q) * dev[i] * dev[j] : c;
    }
  }
}

/* Finite strain as in cases/umat_von_mises: Hencky elasticity from DFGRD0 and DFGRD1, DDSDDE of the
 * Kirchhoff stress. props as of umat_; statev: plastic strain, elastic b (11 22 33 12 13 23). */
static void increment_of_f(const real *before, const real *after, real *f)
{
  real inverse[9], det = 0.0; /* column-major like the others */
  for (int k = 0; k < 9; k++) {
    int i = k % 3, j = k / 3, r = (i + 1) % 3, s = (i + 2) % 3, u = (j + 1) % 3, w = (j + 2) % 3;
    inverse[j + 3 * i] =
        before[r + 3 * u] * before[s + 3 * w] - before[r + 3 * w] * before[s + 3 * u];
    det += j == 0 ? before[i] * inverse[3 * i] : 0.0;
  }
  for (int k = 0; k < 9; k++) {
    const real *row = after + k % 3, *col = inverse + 3 * (k / 3);
    f[k] = (row[0] * col[0] + row[3] * col[1] + row[6] * col[2]) / det;
  }
}

/* Principal logarithmic strains and axes of the trial state. */
static pw_spectrum trial_of(const real *f, const real *b, real *strain)
{
  const pw_rot r = {f[0], f[3], f[6], f[1], f[4], f[7], f[2], f[5], f[8]};
  const pw_t6 old = {b[0], b[1], b[2], b[3], b[5], b[4]};
  pw_spectrum s = pw_t6_spectrum(pw_t6_rotate(r, old));
  for (int k = 0; k < 3; k++) {
    strain[k] = 0.5 * log(s.value[k]);
  }
  return s;
}

static void store(pw_t6 t, real factor, real *out)
{
  const real v[6] = {t.xx, t.yy, t.zz, t.xy, t.zx, t.yz};
  for (int k = 0; k < 6; k++) {
    out[k] = factor * v[k];
  }
}

void umat_hencky_(ARGUMENTS)
{
  const int row[6] = {0, 1, 2, 0, 0, 1}, col[6] = {0, 1, 2, 1, 2, 2};
  const real shear = 0.5 * props[0] / (1.0 + props[1]), bulk = props[0] / (3.0 - 6.0 * props[1]);
  real f[9], e[3], dev[3], tau[3], b[3], q = 0.0, start[6] = {1, 1, 1, 0, 0, 0};
  increment_of_f(dfgrd0, dfgrd1, f);
  const pw_spectrum s = trial_of(f, statev[1] > 0.0 ? statev + 1 : start, e);
  const real tr = e[0] + e[1] + e[2], jac = exp(tr);
  for (int k = 0; k < 3; k++) {
    dev[k] = 2.0 * shear * (e[k] - tr / 3.0);
    q += 1.5 * dev[k] * dev[k];
  }
  q = sqrt(q);
  real over = q - props[2] - props[3] * statev[0], stiff = 3.0 * shear + props[3];
  real flow = over > 0.0 ? over / stiff : 0.0,
       ratio = over > 0.0 ? 1.0 - 3.0 * shear * flow / q : 1.0;
  real along = over > 0.0 ? 3.0 * shear * (ratio - props[3] / stiff) / (q * q) : 0.0;
  statev[0] += flow;
  for (int k = 0; k < 3; k++) {
    tau[k] = bulk * tr + ratio * dev[k];
    b[k] = exp(ratio * dev[k] / shear + 2.0 / 3.0 * tr);
  }
  store(pw_spectrum_tensor(&s, tau), 1.0 / jac, stress);
  store(pw_spectrum_tensor(&s, b), 1.0, statev + 1);
  for (int k = 0; k < 36; k++) { /* change of tau_ij in the axes for a unit strain, summed back */
    const int p = row[k / 6], r = col[k / 6];
    real sum = 0.0, unit[9], trace = 0.0, onto = 0.0;
    for (int ij = 0; ij < 9; ij++) {
      const real *n = s.vector + 3 * (ij / 3), *m = s.vector + 3 * (ij % 3);
      const real x = e[ij / 3] - e[ij % 3];
      unit[ij] =
          0.5 * (n[p] * m[r] + n[r] * m[p]) * (fabs(x) > 1e-4 ? x / tanh(x) : 1.0 + x * x / 3.0);
      trace += ij % 4 == 0 ? unit[ij] : 0.0;
      onto += ij % 4 == 0 ? unit[ij] * dev[ij / 3] : 0.0;
    }
    for (int ij = 0; ij < 9; ij++) {
      real change = 2.0 * shear * ratio * unit[ij];
      change += ij % 4 == 0
                    ? (bulk - 2.0 / 3.0 * shear * ratio) * trace - along * onto * dev[ij / 3]
                    : 0.0;
      sum += change * s.vector[3 * (ij / 3) + row[k % 6]] * s.vector[3 * (ij % 3) + col[k % 6]];
    }
    ddsdde[k] = sum / jac;
  }
}

static bool moves(const real *dstran)
{
  for (int i = 0; i < 6; i++) {
    if (dstran[i] != 0.0) {
      return true;
    }
  }
  return false;
}

/* Hooke's law and nothing in the state. props: E, nu. */
void umat_elastic_(ARGUMENTS)
{
  const real shear = 0.5 * props[0] / (1.0 + props[1]);
  const real lambda = 2.0 * shear * props[1] / (1.0 - 2.0 * props[1]);
  for (int j = 0; j < 6; j++) {
    for (int i = 0; i < 6; i++) {
      ddsdde[i + 6 * j] =
          (i < 3 && j < 3 ? lambda : 0.0) + (i == j ? (i < 3 ? 2.0 : 1.0) * shear : 0.0);
      stress[i] += ddsdde[i + 6 * j] * dstran[j];
    }
  }
}

void umat_stop_(ARGUMENTS)
{
  umat_elastic_(PASSED);
  if (moves(dstran)) {
    _gfortran_stop_string("no convergence   ", 17, false);
  }
}

void umat_xit_(ARGUMENTS)
{
  umat_elastic_(PASSED);
  if (moves(dstran)) {
    xit_();
  }
}

/* A note, a warning, then an error. */
void umat_reports_(ARGUMENTS)
{
  const integer note = 1, warning = -1, error = -3, whole[1] = {0};
  const real number[1] = {0.0};
  umat_elastic_(PASSED);
  stdb_abqerr_(&note, "a note", whole, number, "", 6, 0);
  stdb_abqerr_(&warning, "a warning", whole, number, "", 9, 0);
  if (moves(dstran)) {
    stdb_abqerr_(&error, "bad constants", whole, number, "", 13, 0);
  }
}

void umat_nan_(ARGUMENTS)
{
  umat_elastic_(PASSED);
  stress[3] = moves(dstran) ? (real)NAN : stress[3];
}

void umat_reads_beyond_(ARGUMENTS)
{
  umat_elastic_(PASSED);
  stress[0] += props[*nprops];
}

void umat_writes_beyond_(ARGUMENTS)
{
  umat_elastic_(PASSED);
  statev[*nstatv] = 1.0;
}

/* Wants strain increments of at most 1e-4, and takes nothing back. */
void umat_small_steps_(ARGUMENTS)
{
  umat_(PASSED);
  for (int i = 0; i < 6; i++) {
    *pnewdt = fabs(dstran[i]) > 1.00001e-4 ? 0.5 : *pnewdt;
  }
}

void umat_never_content_(ARGUMENTS)
{
  umat_elastic_(PASSED);
  *pnewdt = moves(dstran) ? 0.25 : 1.0;
}

/* Stops at a strain increment beyond 2.5e-3. */
void umat_fragile_(ARGUMENTS)
{
  umat_(PASSED);
  for (int i = 0; i < 6; i++) {
    if (fabs(dstran[i]) > 2.5e-3) {
      _gfortran_stop_string("increment too large", 19, false);
    }
  }
}

/* Drops the increment, as routines do whose integration has failed. */
void umat_lazy_(ARGUMENTS)
{
  real old[6];
  memcpy(old, stress, sizeof old);
  umat_elastic_(PASSED);
  memcpy(stress, old, sizeof old);
}

void umat_no_tangent_(ARGUMENTS)
{
  umat_elastic_(PASSED);
  memset(ddsdde, 0, 36 * sizeof *ddsdde);
}

/* Spoils all it is given besides its results. */
void umat_careless_(ARGUMENTS)
{
  umat_(PASSED);
  for (int i = 0; i < 6; i++) {
    dstran[i] = -dstran[i];
    stran[i] = 1e3;
  }
  for (int i = 0; i < *nprops; i++) {
    props[i] = -1.0;
  }
  *dtime = 0.0;
  *ntens = *nstatv = *nprops = 0;
  drot[0] = drot[4] = 7.0;
  memset(cmname, 'x', cmname_length);
}

/* What it is told, as state: 6 strains, times, length of the increment, calls, rotation, the two
 * deformation gradients (rows 1 and 2 of columns 1 and 2), length of the name: 24 numbers; where
 * there is room, NOEL and the place: 28. */
void umat_spy_(ARGUMENTS)
{
  umat_elastic_(PASSED);
  memcpy(statev, stran, 6 * sizeof *stran);
  statev[6] = time[0];
  statev[7] = time[1];
  statev[8] = *dtime;
  statev[9] = *kinc;
  statev[10] = *kstep;
  const real *const matrix[3] = {drot, dfgrd0, dfgrd1};
  for (int k = 0; k < 3; k++) {
    statev[11 + 4 * k] = matrix[k][0];
    statev[12 + 4 * k] = matrix[k][1]; /* row 2, column 1 */
    statev[13 + 4 * k] = matrix[k][3];
    statev[14 + 4 * k] = matrix[k][4];
  }
  statev[23] = (real)cmname_length + (cmname[0] == 'S' && cmname[3] == ' ' ? 0.5 : 0.0);
  if (*nstatv >= 28) {
    statev[24] = *noel;
    memcpy(statev + 25, coords, 3 * sizeof *coords);
  }
}

/* Abaqus' own routines on a tensor 11 22 33 12 13 23 = 1..6: 20 numbers. */
void umat_utilities_(ARGUMENTS)
{
  const real s[6] = {1, 2, 3, 4, 5, 6}, turn[9] = {0, 1, 0, -1, 0, 0, 0, 0, 1};
  const integer as_stress = 1, as_strain = 2;
  real axes[9];
  umat_elastic_(PASSED);
  sinv_(s, statev, statev + 1, ndi, nshr);
  sprind_(s, statev + 2, axes, &as_stress, ndi, nshr);
  statev[5] = axes[0] * axes[0] + axes[3] * axes[3] + axes[6] * axes[6];
  rotsig_(s, turn, statev + 6, &as_stress, ndi, nshr);
  rotsig_(s, turn, statev + 12, &as_strain, ndi, nshr);
}
