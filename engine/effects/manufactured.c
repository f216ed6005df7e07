/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effects/manufactured.h"

#include <math.h>

#include "engine/effects/params.h"

static const pw_real pi = PW_PI;

static pw_real youngs_modulus(const pw_mms *m)
{
  return m->mu * (3.0 * m->lambda + 2.0 * m->mu) / (m->lambda + m->mu);
}

pw_real pw_mms_speed(const pw_mms *m)
{
  return sqrt(youngs_modulus(m) / m->density);
}

/* Vortex: g and its first two derivatives in time. */
static void course_of_time(const pw_mms *m, pw_real t, pw_real *g)
{
  pw_real w = pi * pw_mms_speed(m);
  if (m->course == PW_MMS_SINE) {
    g[0] = sin(w * t);
    g[1] = w * cos(w * t);
    g[2] = -w * w * sin(w * t);
    return;
  }
  w *= 2.0;
  g[0] = 0.5 * (1.0 - cos(w * t));
  g[1] = 0.5 * w * sin(w * t);
  g[2] = 0.5 * w * w * cos(w * t);
}

/* Vortex: H(R). */
static pw_real profile(pw_real r)
{
  pw_real h = (4.0 * r - 3.0) * (4.0 * r - 5.0);
  return h * h;
}

static void vortex_displacement(const pw_mms *m, const pw_real *x0, pw_real t, pw_real *u)
{
  pw_real g[3];
  course_of_time(m, t, g);
  pw_real alpha = m->amplitude * g[0] * profile(hypot(x0[0], x0[1]));
  pw_real half = sin(0.5 * alpha), c = -2.0 * half * half, s = sin(alpha); /* c = cos - 1 */
  u[0] = c * x0[0] - s * x0[1];
  u[1] = s * x0[0] + c * x0[1];
}

static void vortex_velocity(const pw_mms *m, const pw_real *x0, pw_real t, pw_real *v)
{
  pw_real g[3], h = profile(hypot(x0[0], x0[1]));
  course_of_time(m, t, g);
  pw_real alpha = m->amplitude * g[0] * h, rate = m->amplitude * g[1] * h;
  v[0] = -rate * (sin(alpha) * x0[0] + cos(alpha) * x0[1]);
  v[1] = rate * (cos(alpha) * x0[0] - sin(alpha) * x0[1]);
}

/* With sigma = mu [[0, R a'], [R a', R^2 a'^2]] in the basis turned with the point:
 * b_r = -R a.^2 + mu/rho R a'^2,  b_t = R a.. - mu/rho (3 a' + R a''). */
static void vortex_force(const pw_mms *m, const pw_real *x0, pw_real t, pw_real *b)
{
  pw_real g[3], r = hypot(x0[0], x0[1]), q = r - 1.0, a = m->amplitude;
  course_of_time(m, t, g);
  pw_real h = profile(r), slope = 64.0 * q * (16.0 * q * q - 1.0);
  pw_real bend = 64.0 * (((96.0 * r - 240.0) * r + 188.0) * r - 45.0); /* 3 H' + R H'' */
  pw_real stiff = m->mu / m->density, da = a * g[0] * slope;
  pw_real radial = r * (stiff * da * da - a * a * g[1] * g[1] * h * h);
  pw_real along = r * a * g[2] * h - stiff * a * g[0] * bend;
  pw_real angle = atan2(x0[1], x0[0]) + a * g[0] * h, c = cos(angle), s = sin(angle);
  b[0] = radial * c - along * s;
  b[1] = radial * s + along * c;
}

/* Expanding ring: f(R) with f' = 0 at both rims and f(0.6) = 1, and its first two derivatives. */
static void ring_profile(pw_real r, pw_real *f)
{
  const pw_real ri = 0.4, ro = 0.6, scale = 1.0 / (ro * ro * (ro - 3.0 * ri));
  const pw_real c1 = -6.0 * ri * ro * scale, c2 = 3.0 * (ro + ri) * scale, c3 = -2.0 * scale;
  f[0] = ((c3 * r + c2) * r + c1) * r;
  f[1] = (3.0 * c3 * r + 2.0 * c2) * r + c1;
  f[2] = 6.0 * c3 * r + 2.0 * c2;
}

/* With the principal stretches F_r = 1 + u', F_t = 1 + u / R, F_z = 1 the first Piola-Kirchhoff
 * stress has P_k = mu (F_k - 1 / F_k) + lambda ln(F_r F_t) / F_k, and
 * b_r = u.. - (P_r' + (P_r - P_t) / R) / rho, where F_r' = u'', F_t' = (F_r - F_t) / R. */
static void ring_force(const pw_mms *m, const pw_real *x0, pw_real t, pw_real *b)
{
  pw_real f[3], r = x0[0], w = pi * pw_mms_speed(m), a = m->amplitude * sin(w * t);
  ring_profile(r, f);
  pw_real fr = 1.0 + a * f[1], ft = 1.0 + a * f[0] / r, dr = a * f[2], dt = (fr - ft) / r;
  pw_real volume = log(fr * ft);
  pw_real slope = m->mu * (1.0 + 1.0 / (fr * fr)) * dr +
                  m->lambda / fr * (dr / fr + dt / ft - volume * dr / fr);
  pw_real difference =
      m->mu * (fr - 1.0 / fr - ft + 1.0 / ft) + m->lambda * volume * (1.0 / fr - 1.0 / ft);
  b[0] = -w * w * a * f[0] - (slope + difference / r) / m->density;
  b[1] = 0.0;
}

void pw_mms_displacement(const pw_mms *m, const pw_real *x0, pw_real t, pw_real *u)
{
  if (m->kind == PW_MMS_RING) {
    pw_real f[3];
    ring_profile(x0[0], f);
    u[0] = m->amplitude * sin(pi * pw_mms_speed(m) * t) * f[0];
    u[1] = 0.0;
    return;
  }
  if (m->kind == PW_MMS_VORTEX) {
    vortex_displacement(m, x0, t, u);
    return;
  }
  pw_real a = m->amplitude * sin(pi * pw_mms_speed(m) * t);
  u[0] = a * sin(pi * x0[0]);
  u[1] = -a * sin(pi * x0[1]);
}

void pw_mms_velocity(const pw_mms *m, const pw_real *x0, pw_real t, pw_real *v)
{
  if (m->kind == PW_MMS_RING) {
    pw_real f[3], w = pi * pw_mms_speed(m);
    ring_profile(x0[0], f);
    v[0] = m->amplitude * w * cos(w * t) * f[0];
    v[1] = 0.0;
    return;
  }
  if (m->kind == PW_MMS_VORTEX) {
    vortex_velocity(m, x0, t, v);
    return;
  }
  pw_real w = pi * pw_mms_speed(m), a = m->amplitude * w * cos(w * t);
  v[0] = a * sin(pi * x0[0]);
  v[1] = -a * sin(pi * x0[1]);
}

/* b_i = pi^2 u_i / rho (lambda / F_i^2 (1 - ln(F_x F_y)) + mu (1 + 1 / F_i^2) - E). */
static void aligned_force(const pw_mms *m, const pw_real *x0, pw_real t, pw_real *b)
{
  pw_real a = m->amplitude * sin(pi * pw_mms_speed(m) * t);
  const pw_real u[2] = {a * sin(pi * x0[0]), -a * sin(pi * x0[1])};
  const pw_real f[2] = {1.0 + pi * a * cos(pi * x0[0]), 1.0 - pi * a * cos(pi * x0[1])};
  const pw_real volume = log(f[0] * f[1]), young = youngs_modulus(m);
  for (int i = 0; i < 2; i++) {
    pw_real inv2 = 1.0 / (f[i] * f[i]);
    pw_real stiffness = m->lambda * inv2 * (1.0 - volume) + m->mu * (1.0 + inv2) - young;
    b[i] = pi * pi * u[i] / m->density * stiffness;
  }
}

void pw_mms_body_force(const pw_mms *m, const pw_real *x0, pw_real t, pw_real *b)
{
  if (m->kind == PW_MMS_VORTEX) {
    vortex_force(m, x0, t, b);
  } else if (m->kind == PW_MMS_RING) {
    ring_force(m, x0, t, b);
  } else {
    aligned_force(m, x0, t, b);
  }
}
