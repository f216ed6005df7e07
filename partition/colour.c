/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "partition/colour.h"

#include "engine/core/mem.h"

#include <string.h>

enum {
  PASSES = 64,       /* of iterated greedy at most, and */
  VISITS = 20000000, /* edges looked at in them at most: set-up of a large grid stays short */
  SWEEPS = 16        /* of balancing */
};

typedef struct {
  pw_idx *order; /* [n] vertices in the order they are coloured */
  pw_idx *place; /* [n] place of a vertex in order */
  pw_idx *value; /* [n] remaining degree; later the colour in the pass at hand */
  pw_idx *start; /* [n + 2] offsets of buckets */
  pw_idx *mark;  /* [n + 1] last vertex that met a colour, plus 1 */
  pw_idx *rank;  /* [n] place of a class in the next pass */
  pw_off *load;  /* [n] work of a colour */
} colour_work;

static void counting_sort(pw_idx n, const pw_idx *key, pw_idx nkey, pw_idx *start, pw_idx *order)
{
  memset(start, 0, ((size_t)nkey + 1) * sizeof *start);
  for (pw_idx v = 0; v < n; v++) {
    start[key[v] + 1]++;
  }
  for (pw_idx k = 0; k < nkey; k++) {
    start[k + 1] += start[k];
  }
  for (pw_idx v = 0; v < n; v++) {
    order[start[key[v]]++] = v;
  }
  memmove(start + 1, start, (size_t)nkey * sizeof *start);
  start[0] = 0;
}

/* Moves vertex u to the front of its bucket and the bucket's border past it. */
static void lower_degree(pw_idx u, colour_work *w)
{
  pw_idx first = w->start[w->value[u]]++, other = w->order[first];
  w->order[w->place[u]] = other;
  w->place[other] = w->place[u];
  w->order[first] = u;
  w->place[u] = first;
  w->value[u]--;
}

/* Takes the vertex of smallest remaining degree away until none is left (buckets of Batagelj &
 * Zaversnik 2003); the order of colouring is the reverse. */
static void smallest_last(const pw_graph *g, colour_work *w)
{
  pw_idx n = g->n;
  for (pw_idx v = 0; v < n; v++) {
    w->value[v] = g->start[v + 1] - g->start[v];
  }
  counting_sort(n, w->value, n, w->start, w->order);
  for (pw_idx k = 0; k < n; k++) {
    w->place[w->order[k]] = k;
  }
  for (pw_idx k = 0; k < n; k++) {
    pw_idx v = w->order[k];
    for (pw_idx l = g->start[v]; l < g->start[v + 1]; l++) {
      if (w->value[g->adj[l]] > w->value[v]) {
        lower_degree(g->adj[l], w);
      }
    }
  }
  for (pw_idx i = 0, j = n - 1; i < j; i++, j--) {
    pw_idx v = w->order[i];
    w->order[i] = w->order[j];
    w->order[j] = v;
  }
}

/* Marks the colours of v's neighbours with v + 1. */
static void mark_neighbours(const pw_graph *g, pw_idx v, const pw_idx *colour, pw_idx *mark)
{
  for (pw_idx l = g->start[v]; l < g->start[v + 1]; l++) {
    pw_idx c = colour[g->adj[l]];
    if (c >= 0) {
      mark[c] = v + 1;
    }
  }
}

/* Gives each vertex, in w->order, the first colour that no neighbour has; returns their number. */
static pw_idx first_fit(const pw_graph *g, colour_work *w, pw_idx *colour)
{
  pw_idx ncolour = 0;
  memset(w->mark, 0, ((size_t)g->n + 1) * sizeof *w->mark);
  for (pw_idx v = 0; v < g->n; v++) {
    colour[v] = -1;
  }
  for (pw_idx k = 0; k < g->n; k++) {
    pw_idx v = w->order[k], c = 0;
    mark_neighbours(g, v, colour, w->mark);
    while (w->mark[c] == v + 1) {
      c++;
    }
    colour[v] = c;
    ncolour = c + 1 > ncolour ? c + 1 : ncolour;
  }
  return ncolour;
}

/* Orders the classes for the next pass: largest first, or last first, or turned by the number of
 * the pass. Vertices of a class stay together, which is why no pass needs more colours. */
static void rank_classes(pw_idx pass, pw_idx ncolour, const pw_idx *size, pw_idx *rank)
{
  for (pw_idx c = 0; c < ncolour; c++) {
    rank[c] = 0;
    for (pw_idx d = 0; pass % 3 == 0 && d < ncolour; d++) {
      rank[c] += size[d] > size[c] || (size[d] == size[c] && d > c);
    }
    if (pass % 3 == 1) {
      rank[c] = ncolour - 1 - c;
    } else if (pass % 3 == 2) {
      rank[c] = (ncolour - 1 - c + pass) % ncolour;
    }
  }
}

static pw_idx iterate(const pw_graph *g, pw_idx ncolour, colour_work *w, pw_idx *colour)
{
  pw_off visits = 0;
  for (pw_idx pass = 0; pass < PASSES && ncolour > 2 && visits < VISITS; pass++) {
    memset(w->place, 0, (size_t)ncolour * sizeof *w->place);
    for (pw_idx v = 0; v < g->n; v++) {
      w->place[colour[v]]++;
    }
    rank_classes(pass, ncolour, w->place, w->rank);
    for (pw_idx v = 0; v < g->n; v++) {
      w->value[v] = w->rank[colour[v]];
    }
    counting_sort(g->n, w->value, ncolour, w->start, w->order);
    ncolour = first_fit(g, w, colour);
    visits += g->n + g->start[g->n];
  }
  return ncolour;
}

/* Moves vertices to lighter colours as long as the sum of squared loads falls. */
static void balance(const pw_graph *g, const pw_idx *work, pw_idx ncolour, colour_work *w,
                    pw_idx *colour)
{
  memset(w->load, 0, (size_t)ncolour * sizeof *w->load);
  for (pw_idx v = 0; v < g->n; v++) {
    w->load[colour[v]] += work ? work[v] : 1;
  }
  bool moved = true;
  for (int sweep = 0; sweep < SWEEPS && moved; sweep++) {
    moved = false;
    memset(w->mark, 0, ((size_t)g->n + 1) * sizeof *w->mark);
    for (pw_idx v = 0; v < g->n; v++) {
      pw_off load = work ? work[v] : 1;
      pw_idx best = colour[v];
      mark_neighbours(g, v, colour, w->mark);
      for (pw_idx c = 0; c < ncolour; c++) {
        pw_off now = best == colour[v] ? w->load[best] - load : w->load[best];
        if (c != colour[v] && w->mark[c] != v + 1 && w->load[c] < now) {
          best = c;
        }
      }
      if (best != colour[v]) {
        w->load[colour[v]] -= load;
        w->load[best] += load;
        colour[v] = best;
        moved = true;
      }
    }
  }
}

static pw_status allocate(pw_idx n, colour_work *w)
{
  PW_TRY(pw_mem_alloc("colouring order", n, sizeof *w->order, &w->order));
  PW_TRY(pw_mem_alloc("colouring places", n, sizeof *w->place, &w->place));
  PW_TRY(pw_mem_alloc("colouring degrees", n, sizeof *w->value, &w->value));
  PW_TRY(pw_mem_alloc("colouring buckets", (pw_off)n + 2, sizeof *w->start, &w->start));
  PW_TRY(pw_mem_alloc("colouring marks", (pw_off)n + 1, sizeof *w->mark, &w->mark));
  PW_TRY(pw_mem_alloc("colouring ranks", n, sizeof *w->rank, &w->rank));
  return pw_mem_alloc("colouring loads", n, sizeof *w->load, &w->load);
}

pw_status pw_colour_greedy(const pw_graph *g, const pw_idx *work, pw_idx *colour, pw_idx *ncolour)
{
  colour_work w = {.order = NULL};
  pw_status s = allocate(g->n, &w);
  if (s == PW_OK) {
    smallest_last(g, &w);
    *ncolour = iterate(g, first_fit(g, &w, colour), &w, colour);
    balance(g, work, *ncolour, &w, colour);
  }
  pw_mem_free(&w.order);
  pw_mem_free(&w.place);
  pw_mem_free(&w.value);
  pw_mem_free(&w.start);
  pw_mem_free(&w.mark);
  pw_mem_free(&w.rank);
  pw_mem_free(&w.load);
  return s;
}
