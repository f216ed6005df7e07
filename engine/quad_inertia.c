/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/quad_inertia.h"

#include <string.h>

#include "engine/core/mem.h"
#include "engine/effects/solid_params.h"
#include "engine/quad_model.h"

pw_status pw_quad_inertia_create(pw_quad_model *m)
{
  pw_quad_inertia *q = &m->inertia;
  const pw_dynamics_param *p = pw_scene_find_effect(&m->sim->scene, pw_effect_dynamics.name);
  const pw_off n = m->sim->mesh.nnode;
  if (!p) {
    return PW_OK;
  }
  q->on = true;
  q->beta = p->beta;
  q->gamma = p->gamma;
  q->damping = p->damping_per_s;
  PW_TRY(pw_mem_alloc("nodes: velocity at the start", 2 * n, sizeof *q->v0, &q->v0));
  PW_TRY(pw_mem_alloc("nodes: acceleration at the start", 2 * n, sizeof *q->a0, &q->a0));
  PW_TRY(pw_mem_alloc("nodes: velocity", 2 * n, sizeof *q->v, &q->v));
  PW_TRY(pw_mem_alloc("nodes: acceleration", 2 * n, sizeof *q->a, &q->a));
  PW_TRY(pw_mem_alloc("nodes: inertia", 2 * n, sizeof *q->force, &q->force));
  return pw_mem_alloc("nodes: accelerations of points", PW_NODE * n, sizeof *q->rec, &q->rec);
}

void pw_quad_inertia_destroy(pw_quad_inertia *q)
{
  pw_mem_free(&q->v0);
  pw_mem_free(&q->a0);
  pw_mem_free(&q->v);
  pw_mem_free(&q->a);
  pw_mem_free(&q->force);
  pw_mem_free(&q->rec);
}

void pw_quad_inertia_scatter(pw_quad_model *m, pw_idx block)
{
  const pw_sim *sim = m->sim;
  const pw_idx *start = sim->blocks.point_start + (pw_off)block * sim->nbody;
  pw_transfer t = sim->transfer;
  t.v = sim->points.acceleration; /* in place of the velocity: its momentum is m a */
  if (start[0] < start[sim->nbody]) {
    sim->kernels->p2g_momentum(&t, m->inertia.rec, start[0], start[sim->nbody]);
  }
}

void pw_quad_inertia_begin(pw_quad_model *m)
{
  pw_quad_inertia *q = &m->inertia;
  const pw_off n = m->sim->mesh.nnode;
  for (pw_off k = 0; k < n; k++) {
    const pw_real *moving = m->sim->nodes.rec + k * PW_NODE, *pushed = q->rec + k * PW_NODE;
    const pw_real mass = moving[PW_NODE_MASS];
    for (pw_off c = 0; c < 2; c++) {
      q->v0[c * n + k] = mass > 0.0 ? moving[PW_NODE_VEL + c] / mass : 0.0;
      q->a0[c * n + k] = mass > 0.0 ? pushed[PW_NODE_VEL + c] / mass : 0.0;
    }
  }
}

void pw_quad_inertia_start(pw_quad_model *m)
{
  pw_quad_inertia *q = &m->inertia;
  pw_points *p = &m->sim->points;
  const pw_off n = m->sim->mesh.nnode;
  for (pw_off at = 0; at < 2 * n; at++) {
    const pw_real mass = m->sim->nodes.rec[at % n * PW_NODE + PW_NODE_MASS];
    const pw_real out = m->external[at] - m->force[at];
    q->a[at] = m->equation[at] >= 0 && mass > 0.0 ? out / mass - q->damping * q->v0[at] : 0.0;
  }
  for (pw_idx i = 0; i < p->n; i++) {
    pw_support s;
    m->sim->kernels->support(&m->sim->transfer, i, &s);
    for (pw_off c = 0; c < 2; c++) {
      pw_real sum = 0.0;
      for (int k = 0; k < s.n; k++) {
        sum += s.s[k] * q->a[c * n + s.node[k]];
      }
      p->acceleration[c * p->ld + i] = sum;
    }
  }
}

/* Rates of component at of a node at the end of the part. */
static void set_rates(const pw_quad_model *m, pw_off at, pw_real u)
{
  const pw_quad_inertia *q = &m->inertia;
  const pw_real dt = m->dt;
  if (m->fixed[at]) {
    q->v[at] = q->v0[at] = m->prescribed[at] / dt;
    q->a[at] = 0.0;
    return;
  }
  q->a[at] = (u - dt * q->v0[at]) / (q->beta * dt * dt) - (0.5 / q->beta - 1.0) * q->a0[at];
  q->v[at] = q->v0[at] + dt * ((1.0 - q->gamma) * q->a0[at] + q->gamma * q->a[at]);
}

void pw_quad_inertia_add(pw_quad_model *m, const pw_real *u, bool tangent)
{
  pw_quad_inertia *q = &m->inertia;
  const pw_off n = m->sim->mesh.nnode;
  const pw_real dt = m->dt;
  const pw_real factor = (1.0 / dt + q->damping * q->gamma) / (q->beta * dt);
  for (pw_off k = 0; k < n; k++) {
    const pw_real mass = m->sim->nodes.rec[k * PW_NODE + PW_NODE_MASS];
    for (pw_off c = 0; c < 2; c++) {
      const pw_off at = c * n + k;
      if (!(m->weight[k] > 0.0)) { /* takes no part: nothing changes there */
        q->v[at] = q->v0[at];
        q->a[at] = q->force[at] = 0.0;
        continue;
      }
      set_rates(m, at, u[at]);
      q->force[at] = mass * (q->a[at] + q->damping * q->v[at]);
      if (tangent && m->equation[at] >= 0) {
        *pw_quad_pattern_diagonal(&m->pattern, &m->csr, (pw_idx)k, (int)c) += mass * factor;
      }
    }
  }
}

pw_real pw_quad_inertia_commit(pw_quad_model *m, const pw_support *s, pw_idx i)
{
  const pw_quad_inertia *q = &m->inertia;
  pw_points *p = &m->sim->points;
  const pw_off n = m->sim->mesh.nnode;
  pw_real square = 0.0;
  for (pw_off c = 0; c < 2; c++) {
    pw_real *v = p->v + c * p->ld + i, a = 0.0;
    for (int k = 0; k < s->n; k++) {
      const pw_off at = c * n + s->node[k];
      *v += s->s[k] * (q->v[at] - q->v0[at]);
      a += s->s[k] * q->a[at];
    }
    p->acceleration[c * p->ld + i] = a;
    square += *v * *v;
  }
  return 0.5 * p->mass[i] * square;
}
