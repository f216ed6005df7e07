/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/tet_ghost.h"

#include <math.h>
#include <string.h>

static const pw_real filled = 0.5; /* of an element: below it the element is cut */

/* A face between two elements: its five nodes, and the jump sum u_a d_a of the gradient. */
typedef struct {
  pw_idx node[5];
  pw_real d[5][3];
  pw_real weight; /* gamma (V1 + V2)/2; N m */
} jump;

static bool has_points(const pw_tet_model *m, pw_idx e)
{
  return m->elem_start[e + 1] > m->elem_start[e];
}

/* Volume of element e where the mesh is; m3. */
static pw_real volume_now(const pw_tet_model *m, pw_idx e)
{
  const pw_motion *motion = &m->mesh->motion;
  const pw_real *a = motion->map;
  pw_real det = a[0] * (a[4] * a[8] - a[5] * a[7]) + a[1] * (a[5] * a[6] - a[3] * a[8]) +
                a[2] * (a[3] * a[7] - a[4] * a[6]);
  return m->mesh->tets.volume[e] * (motion->moved ? det : 1.0);
}

static bool is_cut(const pw_tet_model *m, pw_idx e)
{
  pw_real sum = 0.0;
  for (int f = 0; f < 4; f++) {
    const pw_idx other = m->mesh->tets.beside[4 * (size_t)e + (size_t)f];
    if (other >= 0 && !has_points(m, other)) {
      return true;
    }
  }
  for (pw_idx k = m->elem_start[e]; k < m->elem_start[e + 1]; k++) {
    sum += m->points.volume[m->elem_point[k]];
  }
  return sum < filled * volume_now(m, e);
}

void pw_tet_ghost_begin(pw_tet_model *m)
{
  const pw_tets *t = &m->mesh->tets;
  m->ghost.nface = 0;
  if (!(m->ghost.gamma > 0.0)) {
    return;
  }
  for (pw_idx e = 0; e < t->nelem; e++) {
    m->ghost.cut[e] = has_points(m, e) && is_cut(m, e);
  }
  for (pw_idx i = 0; i < 4 * t->nelem; i++) {
    const pw_idx e = i / 4, other = t->beside[i];
    if (other > e && has_points(m, e) && has_points(m, other) &&
        (m->ghost.cut[e] || m->ghost.cut[other])) {
      m->ghost.face[m->ghost.nface++] = i;
    }
  }
}

static jump jump_of(const pw_tet_model *m, pw_idx face)
{
  const pw_tets *t = &m->mesh->tets;
  const pw_idx e[2] = {face / 4, t->beside[face]};
  jump j = {.weight = 0.5 * m->ghost.gamma * (volume_now(m, e[0]) + volume_now(m, e[1]))};
  int n = 0;
  for (int side = 0; side < 2; side++) {
    pw_real g[12];
    pw_tet_mesh_gradients(m->mesh, e[side], g);
    for (int i = 0; i < 4; i++) {
      const pw_idx a = t->node[4 * (size_t)e[side] + (size_t)i];
      int at = 0;
      while (at < n && j.node[at] != a) {
        at++;
      }
      if (at == n) {
        j.node[n++] = a;
      }
      for (int c = 0; c < 3; c++) {
        j.d[at][c] += (side == 0 ? 1.0 : -1.0) * g[3 * i + c];
      }
    }
  }
  return j;
}

/* Jump [3][3] of the gradient for displacements u. */
static void jump_for(const pw_tet_model *m, const jump *j, const pw_real *u, pw_real *out)
{
  const size_t n = (size_t)m->mesh->tets.nnode;
  memset(out, 0, 9 * sizeof *out);
  for (int a = 0; a < 5; a++) {
    for (size_t ic = 0; ic < 9; ic++) {
      out[ic] += u[ic / 3 * n + (size_t)j->node[a]] * j->d[a][ic % 3];
    }
  }
}

static void add_tangent(pw_tet_model *m, const jump *j)
{
  const size_t n = (size_t)m->mesh->tets.nnode;
  pw_real k[25];
  for (int ab = 0; ab < 25; ab++) {
    const int a = ab / 5, b = ab % 5;
    k[ab] =
        j->weight * (j->d[a][0] * j->d[b][0] + j->d[a][1] * j->d[b][1] + j->d[a][2] * j->d[b][2]);
    for (size_t c = 0; c < 3; c++) {
      const size_t from = c * n + (size_t)j->node[b];
      if (m->fixed[from]) {
        m->lift[c * n + (size_t)j->node[a]] += k[ab] * m->prescribed[from];
      }
    }
  }
  pw_csr_add_nodes(&m->csr, 5, j->node, k);
}

void pw_tet_ghost_add(pw_tet_model *m, const pw_real *u, bool tangent)
{
  const size_t n = (size_t)m->mesh->tets.nnode;
  for (pw_idx i = 0; i < m->ghost.nface; i++) {
    const jump j = jump_of(m, m->ghost.face[i]);
    pw_real now[9];
    jump_for(m, &j, u, now);
    for (int a = 0; a < 5; a++) {
      for (size_t c = 0; c < 3; c++) {
        const pw_real *row = now + 3 * c;
        m->force[c * n + (size_t)j.node[a]] +=
            j.weight * (row[0] * j.d[a][0] + row[1] * j.d[a][1] + row[2] * j.d[a][2]);
      }
    }
    if (tangent) {
      add_tangent(m, &j);
    }
  }
}

pw_real pw_tet_ghost_energy(const pw_tet_model *m, const pw_real *u)
{
  pw_real sum = 0.0;
  for (pw_idx i = 0; i < m->ghost.nface; i++) {
    const jump j = jump_of(m, m->ghost.face[i]);
    pw_real now[9];
    jump_for(m, &j, u, now);
    for (int k = 0; k < 9; k++) {
      sum += 0.5 * j.weight * now[k] * now[k];
    }
  }
  return sum;
}
