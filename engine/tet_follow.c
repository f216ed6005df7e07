/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/tet_follow.h"

#include <math.h>
#include <string.h>

#include "engine/core/mem.h"
#include "kernels/tet_element.h"

pw_status pw_tet_follow_create(pw_tet_model *m, pw_idx n, pw_tet_follow **out)
{
  pw_tet_follow *f = NULL;
  PW_REQUIRE(m->follow, PW_ERR_ARGUMENT, "the model is not made for pressures that follow");
  PW_TRY(pw_mem_alloc("surface", 1, sizeof *f, &f));
  *out = f;
  f->n = n;
  PW_TRY(pw_mem_alloc("surface: points", 3 * (pw_off)n, sizeof *f->x, &f->x));
  PW_TRY(pw_mem_alloc("surface: areas", 3 * (pw_off)n, sizeof *f->area, &f->area));
  PW_TRY(pw_mem_alloc("surface: elements", n, sizeof *f->elem, &f->elem));
  PW_TRY(pw_mem_alloc("surface: loaded elements", n, sizeof *f->acts, &f->acts));
  f->next = m->surface;
  m->surface = f;
  return PW_OK;
}

void pw_tet_follow_destroy(pw_tet_follow **surface)
{
  pw_tet_follow *f = *surface;
  if (f) {
    pw_mem_free(&f->x);
    pw_mem_free(&f->area);
    pw_mem_free(&f->elem);
    pw_mem_free(&f->acts);
  }
  pw_mem_free(surface);
}

static bool has_points(const pw_tet_model *m, pw_idx e)
{
  return m->elem_start[e + 1] > m->elem_start[e];
}

/* Where point i is, in the coordinates of the start. */
static void place_of(const pw_tet_model *m, const pw_tet_follow *f, pw_idx i, pw_real *back)
{
  const size_t n = (size_t)f->n, k = (size_t)i;
  const pw_real now[3] = {f->x[k], f->x[n + k], f->x[2 * n + k]};
  pw_motion_back(&m->mesh->motion, now, back);
}

/* The element with points that shares a node with e and whose least shape function at the place is
 * largest, the lowest of several; -1: there is none. */
static pw_idx nearest_filled(const pw_tet_model *m, pw_idx e, const pw_real *back)
{
  const pw_tets *t = &m->mesh->tets;
  pw_idx best = -1;
  pw_real most = -INFINITY;
  for (int a = 0; a < 4; a++) {
    const pw_idx node = t->node[4 * (size_t)e + (size_t)a];
    for (pw_idx k = t->node_start[node]; k < t->node_start[node + 1]; k++) {
      const pw_idx other = t->node_elem[k];
      if (!has_points(m, other)) {
        continue;
      }
      pw_real shape[4];
      pw_tets_shape(t, other, back, shape);
      const pw_real least = pw_min(pw_min(shape[0], shape[1]), pw_min(shape[2], shape[3]));
      if (least > most || (least == most && other < best)) {
        best = other;
        most = least;
      }
    }
  }
  return best;
}

pw_status pw_tet_follow_begin(pw_tet_model *m)
{
  for (pw_tet_follow *f = m->surface; f; f = f->next) {
    for (pw_idx i = 0; i < f->n; i++) {
      pw_walk_counts counts = {0};
      pw_real back[3];
      place_of(m, f, i, back);
      const pw_idx found = pw_walk_find(&m->walk, back, f->elem[i], &counts);
      f->elem[i] = found == PW_WALK_OUTSIDE ? f->elem[i] : found;
      const bool filled = has_points(m, f->elem[i]);
      f->acts[i] = filled ? f->elem[i] : nearest_filled(m, f->elem[i], back);
      PW_REQUIRE(f->acts[i] >= 0, PW_ERR_POINT_LOST,
                 "no material is near point %d of a loaded surface, at (%g, %g, %g) m", (int)i,
                 f->x[i], f->x[f->n + i], f->x[2 * f->n + i]);
    }
  }
  return PW_OK;
}

/* A point of a surface in an iteration. */
typedef struct {
  const pw_idx *node; /* [4] of its element */
  pw_real shape[4], area[3];
  pw_tet_motion motion;
} loaded;

static void move(const pw_tet_model *m, const pw_tet_follow *f, pw_idx i, const pw_real *u,
                 loaded *out)
{
  const size_t nnode = (size_t)m->mesh->tets.nnode, n = (size_t)f->n, k = (size_t)i;
  const pw_real before[3] = {f->area[k], f->area[n + k], f->area[2 * n + k]};
  pw_real start[12], nodal[12], back[3];
  out->node = m->mesh->tets.node + 4 * (size_t)f->acts[i];
  place_of(m, f, i, back);
  pw_tets_shape(&m->mesh->tets, f->acts[i], back, out->shape);
  pw_tet_mesh_gradients(m->mesh, f->acts[i], start);
  for (size_t b = 0; b < 12; b++) {
    nodal[b] = u[b % 3 * nnode + (size_t)out->node[b / 3]];
  }
  pw_tet_motion_of(start, nodal, &out->motion);
  for (int r = 0; r < 3; r++) { /* rows of the cofactors of F */
    const pw_real *p = out->motion.increment + 3 * ((r + 1) % 3);
    const pw_real *q = out->motion.increment + 3 * ((r + 2) % 3);
    out->area[r] = 0.0;
    for (int c = 0; c < 3; c++) {
      const int c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      out->area[r] += (p[c1] * q[c2] - p[c2] * q[c1]) * before[c];
    }
  }
}

void pw_tet_follow_forces(pw_tet_model *m, const pw_real *u)
{
  const size_t nnode = (size_t)m->mesh->tets.nnode;
  memset(m->follow, 0, 3 * nnode * sizeof *m->follow);
  for (const pw_tet_follow *f = m->surface; f; f = f->next) {
    for (pw_idx i = 0; i < f->n && f->pressure != 0.0; i++) {
      loaded l;
      move(m, f, i, u, &l);
      for (size_t b = 0; b < 12; b++) {
        m->follow[b % 3 * nnode + (size_t)l.node[b / 3]] -=
            f->pressure * l.shape[b / 3] * l.area[b % 3];
      }
    }
  }
}

/* Add the matrix [12][12] of an element, its place in the patch of the matrix being zero before. */
static void add(pw_tet_model *m, pw_idx e, const pw_real *own)
{
  const size_t nnode = (size_t)m->mesh->tets.nnode;
  const int8_t *local = m->mesh->local + 4 * (size_t)e;
  const pw_idx *node = m->mesh->tets.node + 4 * (size_t)e;
  pw_real k[PW_PATCH_DOFS * PW_PATCH_DOFS] = {0};
  for (size_t r = 0; r < 12; r++) {
    for (size_t c = 0; c < 12; c++) {
      const size_t from = c % 3 * nnode + (size_t)node[c / 3];
      k[PW_PATCH_DOFS * (3 * local[r / 3] + (int)(r % 3)) + 3 * local[c / 3] + (int)(c % 3)] =
          own[12 * r + c];
      if (m->fixed[from]) {
        m->lift[r % 3 * nnode + (size_t)node[r / 3]] += own[12 * r + c] * m->prescribed[from];
      }
    }
  }
  pw_csr_add(&m->csr, e / m->mesh->per, k);
}

void pw_tet_follow_tangent(pw_tet_model *m, const pw_real *u)
{
  for (const pw_tet_follow *f = m->surface; f; f = f->next) {
    for (pw_idx i = 0; i < f->n && f->pressure != 0.0; i++) {
      pw_real own[144];
      loaded l;
      move(m, f, i, u, &l);
      if (!(l.motion.det > 0.0)) { /* the evaluation has failed for it */
        continue;
      }
      for (int r = 0; r < 12; r++) {
        for (int c = 0; c < 12; c++) {
          const pw_real *g = l.motion.g + 3 * (c / 3);
          own[12 * r + c] =
              f->pressure * l.shape[r / 3] * (l.area[r % 3] * g[c % 3] - g[r % 3] * l.area[c % 3]);
        }
      }
      add(m, f->acts[i], own);
    }
  }
}

void pw_tet_follow_commit(pw_tet_model *m, const pw_real *u)
{
  const size_t nnode = (size_t)m->mesh->tets.nnode;
  for (pw_tet_follow *f = m->surface; f; f = f->next) {
    for (pw_idx i = 0; i < f->n; i++) {
      loaded l;
      move(m, f, i, u, &l);
      for (size_t c = 0; c < 3; c++) {
        const size_t at = c * (size_t)f->n + (size_t)i;
        f->area[at] = l.area[c];
        for (size_t b = 0; b < 4; b++) {
          f->x[at] += l.shape[b] * u[c * nnode + (size_t)l.node[b]];
        }
      }
    }
  }
}

void pw_tet_follow_sum(const pw_tet_follow *f, pw_real *sum)
{
  for (pw_idx c = 0; c < 3; c++) {
    sum[c] = 0.0;
    for (pw_idx i = 0; i < f->n; i++) {
      sum[c] -= f->pressure * f->area[c * f->n + i];
    }
  }
}
