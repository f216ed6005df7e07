/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/tet_inertia.h"

#include <string.h>

#include "engine/core/mem.h"
#include "engine/tet_loads.h"

pw_newmark pw_newmark_defaults(void)
{
  return (pw_newmark){.on = true, .beta = 0.25, .gamma = 0.5};
}

static pw_status allocate(pw_tet_model *m, pw_tet_rates *r)
{
  const pw_off n = 3 * (pw_off)m->mesh->tets.nnode;
  PW_TRY(pw_mem_alloc("nodes: velocity at the start", n, sizeof *r->v0, &r->v0));
  PW_TRY(pw_mem_alloc("nodes: acceleration at the start", n, sizeof *r->a0, &r->a0));
  PW_TRY(pw_mem_alloc("nodes: velocity", n, sizeof *r->v, &r->v));
  PW_TRY(pw_mem_alloc("nodes: acceleration", n, sizeof *r->a, &r->a));
  PW_TRY(pw_mem_alloc("nodes: rate of momentum", n, sizeof *m->inertia.rate, &m->inertia.rate));
  PW_TRY(pw_mem_alloc("nodes: inertia", n, sizeof *m->inertia.force, &m->inertia.force));
  return pw_tet_points_let_move(&m->points);
}

pw_status pw_tet_rates_create(pw_tet_model *m, const pw_newmark *method, pw_tet_rates *out)
{
  PW_REQUIRE(method->beta > 0.0 && method->gamma >= 0.5 &&
                 method->gamma <= 2.0 * method->beta + 0.5 && method->damping >= 0.0,
             PW_ERR_ARGUMENT, "Newmark's method with beta = %g, gamma = %g, damping %g 1/s",
             method->beta, method->gamma, method->damping);
  pw_tet_rates r = {.method = *method};
  pw_status s = allocate(m, &r);
  if (s != PW_OK) {
    pw_tet_rates_destroy(m, &r);
    return s;
  }
  m->inertia.on = true;
  m->inertia.consistent = method->consistent;
  *out = r;
  return PW_OK;
}

void pw_tet_rates_destroy(pw_tet_model *m, pw_tet_rates *r)
{
  pw_mem_free(&r->v0);
  pw_mem_free(&r->a0);
  pw_mem_free(&r->v);
  pw_mem_free(&r->a);
  pw_mem_free(&m->inertia.rate);
  pw_mem_free(&m->inertia.force);
  memset(r, 0, sizeof *r);
  memset(&m->inertia, 0, sizeof m->inertia);
}

/* Momentum of the points and mass times their acceleration at the nodes, then over the mass. */
static void map_to_nodes(const pw_tet_model *m, pw_tet_rates *r)
{
  const pw_tet_points *q = &m->points;
  const size_t n = (size_t)m->mesh->tets.nnode, l = (size_t)q->ld;
  memset(r->v0, 0, 3 * n * sizeof *r->v0);
  memset(r->a0, 0, 3 * n * sizeof *r->a0);
  for (pw_idx i = 0; i < q->n; i++) {
    const pw_idx *node = m->mesh->tets.node + 4 * (size_t)q->elem[i];
    pw_real shape[4];
    pw_tet_model_shape(m, i, shape);
    for (size_t k = 0; k < 12; k++) {
      const size_t at = k / 4 * n + (size_t)node[k % 4], from = k / 4 * l + (size_t)i;
      r->v0[at] += q->mass[i] * shape[k % 4] * q->velocity[from];
      r->a0[at] += q->mass[i] * shape[k % 4] * q->acceleration[from];
    }
  }
  for (size_t i = 0; i < 3 * n; i++) {
    const pw_real mass = m->mass[i % n];
    r->v0[i] = mass > 0.0 ? r->v0[i] / mass : 0.0;
    r->a0[i] = mass > 0.0 ? r->a0[i] / mass : 0.0;
  }
}

void pw_tet_rates_start(pw_tet_model *m, pw_tet_rates *r)
{
  const size_t n = 3 * (size_t)m->mesh->tets.nnode;
  const bool again = r->open; /* the part before has failed: v and a are its own */
  pw_tet_model_masses(m);
  r->open = true;
  if (again) { /* v0 and a0 are still those of the start */
    return;
  }
  if (r->method.keep && r->begun) {
    memcpy(r->v0, r->v, n * sizeof *r->v);
    memcpy(r->a0, r->a, n * sizeof *r->a);
    return;
  }
  map_to_nodes(m, r);
  if (r->method.keep && r->given) {
    memcpy(r->v0, r->v, n * sizeof *r->v);
  }
}

void pw_tet_rates_balance(const pw_tet_model *m, pw_tet_rates *r)
{
  const size_t n = (size_t)m->mesh->tets.nnode;
  for (size_t i = 0; i < 3 * n; i++) {
    const pw_real load = m->external[i] + (m->follow ? m->follow[i] : 0.0);
    const pw_real mass = m->mass[i % n], left = load - m->force[i];
    r->a0[i] = m->equation[i] >= 0 && mass > 0.0 ? left / mass - r->method.damping * r->v0[i] : 0.0;
  }
  r->begun = true;
}

void pw_tet_rates_update(pw_tet_model *m, pw_tet_rates *r, const pw_real *u, pw_real dt)
{
  const size_t n = 3 * (size_t)m->mesh->tets.nnode;
  const pw_newmark *k = &r->method;
  const pw_real push = 1.0 / (k->beta * dt * dt);
  for (size_t i = 0; i < n; i++) {
    if (m->fixed[i] && !k->keep) { /* it moves as it is told; rates of points would be reflected */
      r->v0[i] = u[i] / dt;
      r->a0[i] = 0.0;
    }
    r->a[i] = push * (u[i] - dt * r->v0[i]) - (0.5 / k->beta - 1.0) * r->a0[i];
    r->v[i] = r->v0[i] + dt * ((1.0 - k->gamma) * r->a0[i] + k->gamma * r->a[i]);
    m->inertia.rate[i] = r->a[i] + k->damping * r->v[i];
  }
  m->inertia.factor = push * (1.0 + k->damping * k->gamma * dt);
}

void pw_tet_rates_commit(pw_tet_model *m, pw_tet_rates *r)
{
  pw_tet_points *q = &m->points;
  const size_t n = (size_t)m->mesh->tets.nnode, l = (size_t)q->ld;
  r->open = false;
  for (pw_idx i = 0; i < q->n; i++) {
    const pw_idx *node = m->mesh->tets.node + 4 * (size_t)q->elem[i];
    pw_real shape[4];
    pw_tet_model_shape(m, i, shape);
    for (size_t c = 0; c < 3; c++) {
      pw_real change = 0.0, a = 0.0;
      for (size_t k = 0; k < 4; k++) {
        const size_t at = c * n + (size_t)node[k];
        change += shape[k] * (r->v[at] - r->v0[at]);
        a += shape[k] * r->a[at];
      }
      q->velocity[c * l + (size_t)i] += change;
      q->acceleration[c * l + (size_t)i] = a;
    }
  }
}

/* Mass matrix [4][4] of element e; diagonal when lumped. */
static void element_mass(const pw_tet_model *m, pw_idx e, pw_real *mass)
{
  memset(mass, 0, 16 * sizeof *mass);
  for (pw_idx k = m->elem_start[e]; k < m->elem_start[e + 1]; k++) {
    const pw_idx i = m->elem_point[k];
    pw_real shape[4];
    pw_tet_model_shape(m, i, shape);
    for (int ab = 0; ab < 16; ab++) {
      const int a = ab / 4, b = ab % 4;
      if (m->inertia.consistent) {
        mass[ab] += m->points.mass[i] * shape[a] * shape[b];
      } else if (a == b) {
        mass[ab] += m->points.mass[i] * shape[a];
      }
    }
  }
}

void pw_patch_inertia(const pw_tet_model *m, pw_idx p, pw_real *force, pw_real *k)
{
  const size_t n = (size_t)m->mesh->tets.nnode;
  memset(force, 0, PW_PATCH_DOFS * sizeof *force);
  for (pw_idx e = p * m->mesh->per; e < (p + 1) * m->mesh->per; e++) {
    const int8_t *local = m->mesh->local + 4 * (size_t)e;
    const pw_idx *node = m->mesh->tets.node + 4 * (size_t)e;
    pw_real mass[16];
    if (m->elem_start[e + 1] == m->elem_start[e]) {
      continue;
    }
    element_mass(m, e, mass);
    for (int abc = 0; abc < 48; abc++) {
      const int ab = abc / 3, c = abc % 3, row = 3 * local[ab / 4] + c, col = 3 * local[ab % 4] + c;
      force[row] += mass[ab] * m->inertia.rate[(size_t)c * n + (size_t)node[ab % 4]];
      if (k) {
        k[PW_PATCH_DOFS * row + col] += m->inertia.factor * mass[ab];
      }
    }
  }
}

pw_real pw_tet_points_kinetic(const pw_tet_points *q)
{
  const size_t l = (size_t)q->ld;
  pw_real sum = 0.0;
  for (size_t i = 0; q->velocity && i < (size_t)q->n; i++) {
    const pw_real *v = q->velocity + i;
    sum += 0.5 * q->mass[i] * (v[0] * v[0] + v[l] * v[l] + v[2 * l] * v[2 * l]);
  }
  return sum;
}
