/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "partition/walk.h"

#include <math.h>
#include <string.h>

#include "engine/core/mem.h"

enum { MAX_BINS = 1024 }; /* along an axis */

void pw_walk_destroy(pw_walk *w)
{
  pw_mem_free(&w->bin_start);
  pw_mem_free(&w->bin_elem);
  memset(w, 0, sizeof *w);
}

/* About two elements for every bin of a mesh with equal elements. */
static void choose_bins(pw_walk *w)
{
  const pw_tets *t = w->tets;
  pw_real volume = 1.0;
  for (int c = 0; c < 3; c++) {
    volume *= t->high[c] - t->low[c];
  }
  pw_real cell = cbrt(2.0 * volume / t->nelem);
  for (int c = 0; c < 3; c++) {
    pw_real length = t->high[c] - t->low[c], n = ceil(length / cell);
    w->nbin[c] = n < 1.0 ? 1 : n > MAX_BINS ? MAX_BINS : (pw_idx)n;
    w->inverse_cell[c] = w->nbin[c] / length;
  }
}

static pw_idx bin_along(const pw_walk *w, int c, pw_real x)
{
  pw_real k = (x - w->tets->low[c]) * w->inverse_cell[c];
  return k <= 0.0 ? 0 : k >= w->nbin[c] - 1 ? w->nbin[c] - 1 : (pw_idx)k;
}

/* Bins that the bounding box of element e meets; the box is as wide as rounding may need. */
static void bins_of(const pw_walk *w, pw_idx e, pw_idx *first, pw_idx *last)
{
  const pw_tets *t = w->tets;
  for (int c = 0; c < 3; c++) {
    const pw_real *x = t->x + (size_t)c * (size_t)t->nnode;
    pw_real low = x[t->node[4 * e]], high = low;
    for (int i = 1; i < 4; i++) {
      low = pw_min(low, x[t->node[4 * e + i]]);
      high = pw_max(high, x[t->node[4 * e + i]]);
    }
    first[c] = bin_along(w, c, low - 2.0 * t->near);
    last[c] = bin_along(w, c, high + 2.0 * t->near);
  }
}

/* Counts element e in its bins, or lists it there when the offsets stand. */
static void visit_bins(pw_walk *w, pw_idx e, bool list)
{
  pw_idx first[3], last[3];
  bins_of(w, e, first, last);
  for (pw_idx k = first[2]; k <= last[2]; k++) {
    for (pw_idx j = first[1]; j <= last[1]; j++) {
      pw_idx *start = w->bin_start + ((pw_off)k * w->nbin[1] + j) * w->nbin[0];
      for (pw_idx i = first[0]; i <= last[0]; i++) {
        if (list) {
          w->bin_elem[start[i]++] = e;
        } else {
          start[i + 1]++;
        }
      }
    }
  }
}

static pw_status fill_bins(pw_walk *w)
{
  pw_off nbin = (pw_off)w->nbin[0] * w->nbin[1] * w->nbin[2], total = 0;
  PW_TRY(pw_mem_alloc("bins: offsets", nbin + 1, sizeof *w->bin_start, &w->bin_start));
  for (pw_idx e = 0; e < w->tets->nelem; e++) {
    visit_bins(w, e, false);
  }
  for (pw_off k = 0; k < nbin; k++) {
    total += w->bin_start[k + 1];
    PW_REQUIRE(total < INT32_MAX, PW_ERR_MEMORY, "bins hold more than %d elements", INT32_MAX);
    w->bin_start[k + 1] = (pw_idx)total;
  }
  PW_TRY(pw_mem_alloc("bins: elements", total, sizeof *w->bin_elem, &w->bin_elem));
  for (pw_idx e = 0; e < w->tets->nelem; e++) {
    visit_bins(w, e, true);
  }
  memmove(w->bin_start + 1, w->bin_start, (size_t)nbin * sizeof *w->bin_start);
  w->bin_start[0] = 0;
  return PW_OK;
}

pw_status pw_walk_create(const pw_tets *tets, pw_walk *out)
{
  pw_walk w = {.tets = tets, .limit = 64 + 8 * (pw_idx)cbrt((double)tets->nelem)};
  choose_bins(&w);
  pw_status s = fill_bins(&w);
  if (s != PW_OK) {
    pw_walk_destroy(&w);
    return s;
  }
  *out = w;
  return PW_OK;
}

static pw_idx search_bins(const pw_walk *w, const pw_real *x)
{
  const pw_tets *t = w->tets;
  for (int c = 0; c < 3; c++) {
    if (!(x[c] >= t->low[c] - t->near && x[c] <= t->high[c] + t->near)) {
      return PW_WALK_OUTSIDE;
    }
  }
  pw_off row = (pw_off)bin_along(w, 2, x[2]) * w->nbin[1] + bin_along(w, 1, x[1]);
  pw_off bin = row * w->nbin[0] + bin_along(w, 0, x[0]);
  for (pw_idx k = w->bin_start[bin]; k < w->bin_start[bin + 1]; k++) {
    if (pw_tets_hold(t, w->bin_elem[k], x)) {
      return w->bin_elem[k];
    }
  }
  return PW_WALK_OUTSIDE;
}

/* The lowest element at the nodes of e that holds x; e does. */
static pw_idx lowest_around(const pw_tets *t, pw_idx e, const pw_real *x)
{
  pw_idx best = e;
  for (int i = 0; i < 4; i++) {
    pw_idx a = t->node[4 * e + i];
    for (pw_idx k = t->node_start[a]; k < t->node_start[a + 1] && t->node_elem[k] < best; k++) {
      if (pw_tets_hold(t, t->node_elem[k], x)) {
        best = t->node_elem[k];
      }
    }
  }
  return best;
}

/* Two bits that differ between elements and between visits of the same one. */
static unsigned draw(pw_idx e, pw_idx step)
{
  uint32_t h = (uint32_t)e * 0x9e3779b9u + (uint32_t)step * 0x85ebca6bu;
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 12;
  return h >> 16 & 3u;
}

/* What testing an element has shown. */
typedef enum { INSIDE, NEAR_FACE, WALK_ON, BOUNDARY } outcome;

static outcome test_element(const pw_tets *t, pw_idx e, pw_idx step, const pw_real *x, pw_idx *next)
{
  pw_real shape[4];
  const pw_real *g = t->inverse + 16 * (size_t)e;
  pw_tets_shape(t, e, x, shape);
  bool out = false, near = false;
  for (int f = 0; f < 4; f++) {
    out |= !(shape[f] >= -t->tolerance * g[4 * f + 3]);
    near |= !(shape[f] >= t->near * g[4 * f + 3]);
  }
  if (!out) {
    return near ? NEAR_FACE : INSIDE;
  }
  for (unsigned k = 0, first = draw(e, step); k < 4; k++) {
    unsigned f = (first + k) & 3u;
    if (!(shape[f] >= -t->tolerance * g[4 * f + 3]) && t->beside[4 * (unsigned)e + f] >= 0) {
      *next = t->beside[4 * (unsigned)e + f];
      return WALK_ON;
    }
  }
  return BOUNDARY;
}

pw_idx pw_walk_find(const pw_walk *w, const pw_real *x, pw_idx from, pw_walk_counts *counts)
{
  pw_idx e = from;
  outcome now = e >= 0 ? WALK_ON : BOUNDARY;
  counts->points++;
  for (pw_idx step = 0; now == WALK_ON && step < w->limit; step++) {
    pw_idx next = e;
    now = test_element(w->tets, e, step, x, &next);
    counts->tests++;
    e = next;
  }
  if (now == NEAR_FACE) {
    counts->ties++;
    e = lowest_around(w->tets, e, x);
  } else if (now != INSIDE) {
    counts->binned++;
    e = search_bins(w, x);
    counts->outside += e == PW_WALK_OUTSIDE;
  }
  counts->moved += e != from;
  return e;
}

void pw_motion_back(const pw_motion *motion, const pw_real *x, pw_real *back)
{
  const pw_real *b = motion->back, *s = motion->shift;
  for (int c = 0; c < 3; c++) {
    back[c] = motion->moved ? b[3 * c] * (x[0] - s[0]) + b[3 * c + 1] * (x[1] - s[1]) +
                                  b[3 * c + 2] * (x[2] - s[2])
                            : x[c];
  }
}

void pw_walk_points(const pw_walk *w, const pw_motion *motion, pw_idx n, pw_idx ld,
                    const pw_real *x, pw_idx *parent, pw_walk_counts *counts)
{
  const size_t l = (size_t)ld;
  for (size_t p = 0; p < (size_t)n; p++) {
    pw_real now[3] = {x[p], x[l + p], x[2 * l + p]}, back[3];
    pw_motion_back(motion, now, back);
    parent[p] = pw_walk_find(w, back, parent[p], counts);
  }
}

pw_idx pw_walk_search_all(const pw_tets *tets, const pw_real *x)
{
  pw_idx e = 0;
  while (e < tets->nelem && !pw_tets_hold(tets, e, x)) {
    e++;
  }
  return e < tets->nelem ? e : PW_WALK_OUTSIDE;
}
