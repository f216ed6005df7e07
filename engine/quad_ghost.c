/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/quad_ghost.h"

#include <string.h>

#include "engine/core/mem.h"
#include "engine/effects/solid_params.h"
#include "engine/quad_model.h"

enum { TAKES_PART = 1, CUT = 2 };

static const pw_real enough = 0.5; /* of a cell filled: not cut for that reason */

/* The jump of the gradient across an edge at one of its ends: three nodes in a line. */
typedef struct {
  pw_idx node[3];
  pw_real d[3];   /* weights of their displacements; 1/m */
  pw_real weight; /* stiffness times volume; J */
} jump;

pw_status pw_quad_ghost_create(pw_quad_model *m)
{
  pw_quad_ghost *g = &m->ghost;
  const pw_ghost_param *p = pw_scene_find_effect(&m->sim->scene, pw_effect_ghost.name);
  const pw_off n = m->sim->mesh.nelem;
  if (!p) {
    return PW_OK;
  }
  g->gamma = p->stiffness_pa;
  PW_TRY(pw_mem_alloc("ghost: edges", 2 * n, sizeof *g->edge, &g->edge));
  PW_TRY(pw_mem_alloc("ghost: filled parts", n, sizeof *g->filled, &g->filled));
  return pw_mem_alloc("ghost: cells", n, sizeof *g->state, &g->state);
}

void pw_quad_ghost_destroy(pw_quad_ghost *g)
{
  pw_mem_free(&g->edge);
  pw_mem_free(&g->filled);
  pw_mem_free(&g->state);
}

/* Lower left node of cell e. */
static pw_idx first_node(const pw_mesh *mesh, pw_idx e)
{
  return e + e / mesh->cells[0];
}

/* Volume of a cell, per radian in axisymmetry. */
static pw_real cell_volume(const pw_sim *sim, pw_idx e)
{
  pw_real size[2];
  pw_mesh_cell_size(&sim->mesh, e, size);
  const pw_real left = pw_mesh_node_x(&sim->mesh, first_node(&sim->mesh, e));
  return size[0] * size[1] * (sim->scene.geometry == PW_AXI ? left + 0.5 * size[0] : 1.0);
}

/* The cell beside e along axis a in direction way, or -1. */
static pw_idx beside(const pw_mesh *mesh, pw_idx e, int a, pw_idx way)
{
  const pw_idx at = a == 0 ? e % mesh->cells[0] : e / mesh->cells[0];
  const bool inside = at + way >= 0 && at + way < mesh->cells[a];
  return inside ? e + way * (a == 0 ? 1 : mesh->cells[0]) : -1;
}

static void find_states(pw_quad_model *m)
{
  const pw_mesh *mesh = &m->sim->mesh;
  const pw_points *p = &m->sim->points;
  pw_quad_ghost *g = &m->ghost;
  memset(g->filled, 0, (size_t)mesh->nelem * sizeof *g->filled);
  for (pw_idx i = 0; i < p->n; i++) {
    const pw_real x[2] = {p->x[i], p->x[p->ld + i]};
    const pw_idx e = pw_mesh_locate(mesh, x);
    if (e >= 0) {
      g->filled[e] += p->vol[i] / cell_volume(m->sim, e);
    }
  }
  for (pw_idx e = 0; e < mesh->nelem; e++) {
    const pw_idx a = first_node(mesh, e), up = a + mesh->nodes[0];
    const bool part = m->weight[a] > 0.0 && m->weight[a + 1] > 0.0 && m->weight[up] > 0.0 &&
                      m->weight[up + 1] > 0.0;
    g->state[e] = part ? TAKES_PART : 0;
  }
  for (pw_idx e = 0; e < mesh->nelem; e++) {
    bool cut = g->filled[e] < enough;
    for (int k = 0; k < 4; k++) {
      const pw_idx other = beside(mesh, e, k / 2, k % 2 ? 1 : -1);
      cut = cut || (other >= 0 && !(g->state[other] & TAKES_PART));
    }
    g->state[e] |= cut ? CUT : 0;
  }
}

/* The jump at end 0 or 1 of an edge. */
static jump jump_at(const pw_quad_model *m, pw_idx edge, int end)
{
  const pw_mesh *mesh = &m->sim->mesh;
  const pw_idx e = edge / 2, a = edge % 2, other = beside(mesh, e, (int)a, 1);
  const pw_idx step = a == 0 ? 1 : mesh->nodes[0], across = a == 0 ? mesh->nodes[0] : 1;
  const pw_idx first = first_node(mesh, e) + end * across;
  pw_real h[2], k[2];
  pw_mesh_cell_size(mesh, e, h);
  pw_mesh_cell_size(mesh, other, k);
  const pw_real left = 1.0 / h[a], right = 1.0 / k[a];
  const pw_real volume = 0.5 * (cell_volume(m->sim, e) + cell_volume(m->sim, other));
  return (jump){.node = {first, first + step, first + 2 * step},
                .d = {left, -left - right, right},
                .weight = 0.5 * m->ghost.gamma * volume};
}

void pw_quad_ghost_begin(pw_quad_model *m)
{
  const pw_mesh *mesh = &m->sim->mesh;
  pw_quad_ghost *g = &m->ghost;
  g->nedge = 0;
  if (!(g->gamma > 0.0)) {
    return;
  }
  find_states(m);
  for (pw_idx l = 0; l < 2 * mesh->nelem; l++) {
    const pw_idx other = beside(mesh, l / 2, (int)(l % 2), 1);
    const uint8_t own = g->state[l / 2], its = other >= 0 ? g->state[other] : 0;
    if ((own & its & TAKES_PART) && ((own | its) & CUT)) {
      g->edge[g->nedge++] = l;
      for (int end = 0; end < 2; end++) {
        pw_quad_pattern_mark(&m->pattern, 3, jump_at(m, l, end).node);
      }
    }
  }
}

static void add_tangent(pw_quad_model *m, const jump *j)
{
  pw_real k[36] = {0.0};
  for (int ab = 0; ab < 9; ab++) {
    const int a = ab / 3, b = ab % 3;
    for (int c = 0; c < 2; c++) {
      const pw_off to = c * (pw_off)m->csr.nnode + j->node[a];
      const pw_off from = c * (pw_off)m->csr.nnode + j->node[b];
      const pw_real value = j->weight * j->d[a] * j->d[b];
      k[6 * (2 * a + c) + 2 * b + c] = value;
      m->lift[to] += m->fixed[from] ? value * m->prescribed[from] : 0.0;
    }
  }
  pw_quad_pattern_add(&m->pattern, &m->csr, 3, j->node, k);
}

void pw_quad_ghost_add(pw_quad_model *m, const pw_real *u, bool tangent)
{
  for (pw_idx l = 0; l < 2 * m->ghost.nedge; l++) {
    const jump j = jump_at(m, m->ghost.edge[l / 2], l % 2);
    for (pw_off c = 0; c < 2; c++) {
      const pw_off first = c * m->csr.nnode;
      const pw_real now = j.d[0] * u[first + j.node[0]] + j.d[1] * u[first + j.node[1]] +
                          j.d[2] * u[first + j.node[2]];
      for (int a = 0; a < 3; a++) {
        m->force[first + j.node[a]] += j.weight * now * j.d[a];
      }
    }
    if (tangent) {
      add_tangent(m, &j);
    }
  }
}
