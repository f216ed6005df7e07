/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elastic rod. Its drift solves M v' = -B^T N, e' = B v with the stretches e = B u of the elements
 * and their pulls N = S e by the implicit midpoint rule. With the mean pulls as the unknowns,
 *
 *   (S^-1 + dt^2/4 B M^-1 B^T) N = e + dt/2 B v,   v <- v - dt M^-1 B^T N,   e += dt B (mean v)
 *
 * momentum is kept whatever the rounding of N, and the energy v M v / 2 + e S e / 2 for any dt
 * (Hairer, Lubich, Wanner 2006, Geometric Numerical Integration, section IV.2.1). The matrix is
 * positive definite and tridiagonal. */
#include "engine/structure_parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"

static pw_real youngs_modulus(const pw_scene_material *m)
{
  for (int k = 0; m->model->keys[k].name; k++) {
    if (strcmp(m->model->keys[k].name, "youngs_modulus_pa") == 0) {
      return m->param[k];
    }
  }
  return 0.0;
}

static pw_status allocate(pw_rod *rod)
{
  PW_TRY(pw_mem_alloc("rod stiffness", rod->n - 1, sizeof(pw_real), &rod->stiffness));
  PW_TRY(pw_mem_alloc("rod displacement", rod->n, sizeof(pw_real), &rod->u));
  PW_TRY(pw_mem_alloc("rod stretch", rod->n - 1, sizeof(pw_real), &rod->stretch));
  PW_TRY(pw_mem_alloc("rod velocity", rod->n, sizeof(pw_real), &rod->v));
  PW_TRY(pw_mem_alloc("rod mass", rod->n, sizeof(pw_real), &rod->mass));
  PW_TRY(pw_mem_alloc("rod force", rod->n, sizeof(pw_real), &rod->force));
  PW_TRY(pw_mem_alloc("rod load", rod->n, sizeof(pw_real), &rod->load));
  return pw_mem_alloc("rod scratch", 3 * (pw_off)rod->n, sizeof(pw_real), &rod->scratch);
}

void pw_rod_destroy(pw_rod *rod)
{
  pw_mem_free(&rod->stiffness);
  pw_mem_free(&rod->u);
  pw_mem_free(&rod->stretch);
  pw_mem_free(&rod->v);
  pw_mem_free(&rod->mass);
  pw_mem_free(&rod->force);
  pw_mem_free(&rod->load);
  pw_mem_free(&rod->scratch);
  *rod = (pw_rod){0};
}

pw_status pw_rod_create(const pw_scene *scene, int body, pw_rod *out)
{
  const pw_scene_body *b = &scene->body[body];
  const pw_real density = pw_scene_density(scene, body);
  const pw_real youngs = youngs_modulus(&scene->material[b->material]);
  *out = (pw_rod){
      .n = b->rod_elements + 1, .y0 = b->tip_y_m, .length = b->length_m / (pw_real)b->rod_elements};
  PW_TRY(allocate(out));
  for (pw_idx k = 0; k + 1 < out->n; k++) {
    pw_real low = b->tip_y_m + (pw_real)k * out->length, high = low + out->length;
    pw_slice s = pw_shape_slice(scene, body, low, k + 2 < out->n ? high : PW_HUGE);
    pw_real upper = density * (s.y - low * s.vol) / out->length;
    out->mass[k] += density * s.vol - upper;
    out->mass[k + 1] += upper;
    out->stiffness[k] = youngs * s.vol / (out->length * out->length);
  }
  for (pw_idx k = 0; k < out->n; k++) {
    out->v[k] = b->velocity_m_s[1];
  }
  return PW_OK;
}

/* Element and place in it, 0..1, of a height of the start. */
static pw_idx locate(const pw_rod *rod, pw_real y0, pw_real *place)
{
  pw_real at = pw_max(0.0, (y0 - rod->y0) / rod->length);
  pw_idx k = at < (pw_real)(rod->n - 2) ? (pw_idx)at : rod->n - 2;
  *place = pw_min(1.0, at - (pw_real)k);
  return k;
}

void pw_rod_add(pw_rod *rod, pw_real y0, pw_real f)
{
  pw_real place;
  pw_idx k = locate(rod, y0, &place);
  rod->force[k] += (1.0 - place) * f;
  rod->force[k + 1] += place * f;
}

void pw_rod_add_weight(pw_rod *rod, pw_real a)
{
  for (pw_idx k = 0; k < rod->n; k++) {
    rod->force[k] += rod->mass[k] * a;
    rod->load[k] += rod->mass[k] * a;
  }
}

void pw_rod_kick(pw_structure *s, pw_real dt, const pw_real *given)
{
  pw_rod *rod = &s->rod;
  const pw_idx head = rod->n - 1;
  s->work = s->given_work = s->reaction[0] = s->reaction[1] = 0.0;
  rod->held = given != NULL;
  for (pw_idx k = 0; k < rod->n; k++) {
    pw_real dv = dt * rod->force[k] / rod->mass[k];
    if (given && k == head) {
      dv = given[1] - rod->v[k];
      s->reaction[1] = rod->mass[k] * dv / dt - rod->force[k];
      s->given_work = dt * s->reaction[1] * (rod->v[k] + 0.5 * dv);
    }
    s->work += dt * rod->load[k] * (rod->v[k] + 0.5 * dv);
    rod->v[k] += dv;
  }
}

/* Mean pulls of the elements over the drift by elimination from the tip up. A held head counts as
 * infinitely heavy. */
static void mean_pulls(const pw_rod *rod, pw_real dt, const pw_real *flex, pw_real *pull)
{
  pw_real *diagonal = rod->scratch + 2 * (pw_off)rod->n, q = 0.25 * dt * dt;
  const pw_idx n = rod->n - 1;
  for (pw_idx k = 0; k < n; k++) {
    diagonal[k] = 1.0 / rod->stiffness[k] + q * (flex[k] + flex[k + 1]);
    pull[k] = rod->stretch[k] + 0.5 * dt * (rod->v[k + 1] - rod->v[k]);
  }
  for (pw_idx k = 1; k < n; k++) {
    pw_real f = q * flex[k] / diagonal[k - 1];
    diagonal[k] -= f * q * flex[k];
    pull[k] += f * pull[k - 1];
  }
  pull[n - 1] /= diagonal[n - 1];
  for (pw_idx k = n - 2; k >= 0; k--) {
    pull[k] = (pull[k] + q * flex[k + 1] * pull[k + 1]) / diagonal[k];
  }
}

void pw_rod_drift(pw_structure *s, pw_real dt)
{
  pw_rod *rod = &s->rod;
  const pw_idx head = rod->n - 1;
  pw_real *flex = rod->scratch, *pull = rod->scratch + rod->n;
  for (pw_idx k = 0; k < rod->n; k++) {
    flex[k] = rod->held && k == head ? 0.0 : 1.0 / rod->mass[k];
  }
  mean_pulls(rod, dt, flex, pull);
  pw_real below = 0.0; /* mean velocity of the node below */
  for (pw_idx k = 0; k < rod->n; k++) {
    pw_real net = (k < head ? pull[k] : 0.0) - (k > 0 ? pull[k - 1] : 0.0);
    pw_real dv = dt * flex[k] * net, mean = rod->v[k] + 0.5 * dv;
    rod->v[k] += dv;
    rod->u[k] += dt * mean;
    if (k > 0) {
      rod->stretch[k - 1] += dt * (mean - below);
    }
    below = mean;
  }
  if (rod->held) { /* what keeps the head's velocity against the rod */
    s->reaction[1] += pull[head - 1];
    s->given_work += dt * pull[head - 1] * rod->v[head];
  }
}

void pw_rod_place(const pw_structure *s, pw_idx node, pw_real *x, pw_real *v)
{
  const pw_rod *rod = &s->rod;
  const pw_real *x0 = s->line_x0 + 2 * node;
  pw_real place;
  pw_idx k = locate(rod, x0[1], &place);
  x[0] = x0[0];
  x[1] = x0[1] + (1.0 - place) * rod->u[k] + place * rod->u[k + 1];
  v[0] = 0.0;
  v[1] = (1.0 - place) * rod->v[k] + place * rod->v[k + 1];
}

pw_real pw_rod_kinetic(const pw_rod *rod)
{
  pw_real sum = 0.0;
  for (pw_idx k = 0; k < rod->n; k++) {
    sum += 0.5 * rod->mass[k] * rod->v[k] * rod->v[k];
  }
  return sum;
}

pw_real pw_rod_strain(const pw_rod *rod)
{
  pw_real sum = 0.0;
  for (pw_idx k = 0; k + 1 < rod->n; k++) {
    sum += 0.5 * rod->stiffness[k] * rod->stretch[k] * rod->stretch[k];
  }
  return sum;
}

pw_status pw_rod_archive(pw_rod *rod, const char *name, pw_archive *ar)
{
  char path[2 * PW_NAME];
  snprintf(path, sizeof path, "%s/u", name);
  PW_TRY(ar->real(ar, path, rod->u, rod->n));
  snprintf(path, sizeof path, "%s/stretch", name);
  PW_TRY(ar->real(ar, path, rod->stretch, rod->n - 1));
  snprintf(path, sizeof path, "%s/v", name);
  return ar->real(ar, path, rod->v, rod->n);
}
