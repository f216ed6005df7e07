/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/tet_mechanism.h"

#include <math.h>
#include <string.h>

#include "engine/core/mem.h"

/* A constraint counts when it takes more than this part from what a unit motion may do. */
static const pw_real independent = 1e-6;

pw_status pw_mechanism_create(const pw_tet_model *m, pw_mechanism *out)
{
  const pw_off n = m->mesh->tets.nelem;
  pw_mechanism k = {.piece = NULL};
  pw_status s = pw_mem_alloc("mechanisms: pieces", n, sizeof *k.piece, &k.piece);
  s = s != PW_OK ? s : pw_mem_alloc("mechanisms: chains", n, sizeof *k.next, &k.next);
  s = s != PW_OK ? s : pw_mem_alloc("mechanisms: starts", n, sizeof *k.first, &k.first);
  s = s != PW_OK ? s : pw_mem_alloc("mechanisms: held", n, sizeof *k.held, &k.held);
  s = s != PW_OK ? s
                 : pw_mem_alloc("mechanisms: held nodes", m->mesh->tets.nnode, sizeof *k.held_node,
                                &k.held_node);
  if (s != PW_OK) {
    pw_mechanism_destroy(&k);
    return s;
  }
  *out = k;
  return PW_OK;
}

void pw_mechanism_destroy(pw_mechanism *k)
{
  pw_mem_free(&k->piece);
  pw_mem_free(&k->next);
  pw_mem_free(&k->held_node);
  pw_mem_free(&k->first);
  pw_mem_free(&k->held);
  memset(k, 0, sizeof *k);
}

static bool has_points(const pw_tet_model *m, pw_idx e)
{
  return m->elem_start[e + 1] > m->elem_start[e];
}

/* All elements joined to `start` by faces become piece `id`, in a chain through next that begins
 * with `start` and ends with -1. */
static void grow_piece(const pw_tet_model *m, pw_mechanism *k, pw_idx start, pw_idx id)
{
  pw_idx last = start;
  k->piece[start] = id;
  k->first[id] = start;
  k->next[start] = -1;
  for (pw_idx e = start; e >= 0; e = k->next[e]) {
    for (int f = 0; f < 4; f++) {
      const pw_idx other = m->mesh->tets.beside[4 * (size_t)e + (size_t)f];
      if (other >= 0 && k->piece[other] < 0 && has_points(m, other)) {
        k->piece[other] = id;
        k->next[last] = other;
        k->next[other] = -1;
        last = other;
      }
    }
  }
}

/* Constraints on the six motions of a piece, kept orthonormal. */
typedef struct {
  int rank;
  pw_real row[6][6];
} motions;

/* Add the row of component c of the velocity at r: v + w x r. */
static void add_row(motions *g, const pw_real *r, int c)
{
  pw_real row[6] = {0}, left = 0.0;
  row[c] = 1.0;
  row[3 + (c + 1) % 3] = r[(c + 2) % 3];
  row[3 + (c + 2) % 3] = -r[(c + 1) % 3];
  for (int pass = 0; pass < 2; pass++) {
    for (int i = 0; i < g->rank; i++) {
      pw_real along = 0.0;
      for (int j = 0; j < 6; j++) {
        along += row[j] * g->row[i][j];
      }
      for (int j = 0; j < 6; j++) {
        row[j] -= along * g->row[i][j];
      }
    }
  }
  for (int j = 0; j < 6; j++) {
    left += row[j] * row[j];
  }
  if (left > independent * independent) {
    for (int j = 0; j < 6; j++) {
      g->row[g->rank][j] = row[j] / sqrt(left);
    }
    g->rank++;
  }
}

/* Centre and size of a piece: lengths are measured in the latter. */
static pw_real measure(const pw_tet_model *m, const pw_mechanism *k, pw_idx id, pw_real *centre)
{
  const pw_tets *t = &m->mesh->tets;
  pw_real low[3], high[3], size = 0.0;
  for (int c = 0; c < 3; c++) {
    low[c] = INFINITY;
    high[c] = -INFINITY;
  }
  for (pw_idx e = k->first[id]; e >= 0; e = k->next[e]) {
    for (size_t i = 0; i < 12; i++) {
      const pw_real x = m->mesh->x[i / 4 * (size_t)t->nnode + (size_t)t->node[4 * e + i % 4]];
      low[i / 4] = pw_min(low[i / 4], x);
      high[i / 4] = pw_max(high[i / 4], x);
    }
  }
  for (int c = 0; c < 3; c++) {
    centre[c] = 0.5 * (low[c] + high[c]);
    size = pw_max(size, 0.5 * (high[c] - low[c]));
  }
  return size;
}

/* Number of the six motions of a piece that fixed components and held pieces leave. */
static int motions_left(const pw_tet_model *m, const pw_mechanism *k, pw_idx id)
{
  const pw_tets *t = &m->mesh->tets;
  const size_t n = (size_t)t->nnode;
  motions g = {.rank = 0};
  pw_real centre[3], size = measure(m, k, id, centre);
  for (pw_idx e = k->first[id]; e >= 0 && g.rank < 6; e = k->next[e]) {
    for (size_t i = 0; i < 4; i++) {
      const size_t a = (size_t)t->node[4 * (size_t)e + i];
      const pw_real *x = m->mesh->x + a;
      pw_real r[3] = {(x[0] - centre[0]) / size, (x[n] - centre[1]) / size,
                      (x[2 * n] - centre[2]) / size};
      for (int c = 0; c < 3 && g.rank < 6; c++) {
        if (m->fixed[(size_t)c * n + a] || k->held_node[a]) {
          add_row(&g, r, c);
        }
      }
    }
  }
  return 6 - g.rank;
}

static void hold(const pw_tet_model *m, pw_mechanism *k, pw_idx id)
{
  k->held[id] = 1;
  for (pw_idx e = k->first[id]; e >= 0; e = k->next[e]) {
    for (int i = 0; i < 4; i++) {
      k->held_node[m->mesh->tets.node[4 * (size_t)e + (size_t)i]] = 1;
    }
  }
}

/* What is left over, and the first of it. */
static void describe(const pw_tet_model *m, const pw_mechanism *k, pw_mechanism_report *out)
{
  for (pw_idx id = 0; id < out->pieces; id++) {
    out->free += !k->held[id];
    for (pw_idx e = k->first[id]; e >= 0 && !k->held[id]; e = k->next[e]) {
      out->elements++;
    }
    if (!k->held[id] && out->first < 0) { /* pieces are numbered by their lowest element */
      out->first = k->first[id];
      out->motions = motions_left(m, k, id);
    }
  }
}

void pw_mechanism_find(const pw_tet_model *m, pw_mechanism *k, pw_mechanism_report *out)
{
  const pw_tets *t = &m->mesh->tets;
  *out = (pw_mechanism_report){.first = -1};
  for (pw_idx e = 0; e < t->nelem; e++) {
    k->piece[e] = -1;
  }
  for (pw_idx e = 0; e < t->nelem; e++) {
    if (k->piece[e] < 0 && has_points(m, e)) {
      k->held[out->pieces] = 0;
      grow_piece(m, k, e, out->pieces++);
    }
  }
  memset(k->held_node, 0, (size_t)t->nnode * sizeof *k->held_node);
  for (bool more = true; more;) {
    more = false;
    for (pw_idx id = 0; id < out->pieces; id++) {
      if (!k->held[id] && motions_left(m, k, id) == 0) {
        hold(m, k, id);
        more = true;
      }
    }
  }
  describe(m, k, out);
}
