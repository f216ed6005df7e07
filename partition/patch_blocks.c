/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "partition/patch_blocks.h"

#include <string.h>

#include "engine/core/mem.h"
#include "partition/colour.h"
#include "partition/graph.h"
#include "partition/order.h"

/* What both passes of building a graph need. */
typedef struct {
  const pw_tets *t;
  const pw_blocks *b;
  pw_idx per;
  pw_idx *seen; /* [vertices] last vertex, plus 1, that met this one */
} walk_work;

/* Lists vertex `other` as a neighbour of v unless it is known; returns how many that adds. */
static pw_idx add_neighbour(walk_work *w, pw_idx v, pw_idx other, pw_idx *adj)
{
  if (other == v || w->seen[other] == v + 1) {
    return 0;
  }
  w->seen[other] = v + 1;
  if (adj) {
    *adj = other;
  }
  return 1;
}

/* Patches that share a face with patch p; written to adj unless it is NULL. */
static pw_idx patches_beside(walk_work *w, pw_idx p, pw_idx *adj)
{
  pw_idx n = 0;
  for (pw_idx i = 4 * p * w->per; i < 4 * (p + 1) * w->per; i++) {
    if (w->t->beside[i] >= 0) {
      n += add_neighbour(w, p, w->t->beside[i] / w->per, adj ? adj + n : NULL);
    }
  }
  return n;
}

/* Blocks that share a node with block k. */
static pw_idx blocks_beside(walk_work *w, pw_idx k, pw_idx *adj)
{
  const pw_tets *t = w->t;
  pw_idx n = 0;
  for (pw_idx l = w->b->elem_start[k]; l < w->b->elem_start[k + 1]; l++) {
    pw_idx first = 4 * w->b->elem[l] * w->per;
    for (pw_idx i = first; i < first + 4 * w->per; i++) {
      pw_idx a = t->node[i];
      for (pw_idx m = t->node_start[a]; m < t->node_start[a + 1]; m++) {
        pw_idx other = w->b->elem_block[t->node_elem[m] / w->per];
        n += add_neighbour(w, k, other, adj ? adj + n : NULL);
      }
    }
  }
  return n;
}

typedef pw_idx (*beside_fn)(walk_work *w, pw_idx vertex, pw_idx *adj);

static pw_status build_graph(walk_work *w, pw_idx n, beside_fn beside, pw_graph *g)
{
  *g = (pw_graph){.n = n};
  PW_TRY(pw_mem_alloc("patch graph: offsets", (pw_off)n + 1, sizeof *g->start, &g->start));
  PW_TRY(pw_mem_alloc("patch graph: marks", n, sizeof *w->seen, &w->seen));
  pw_off total = 0;
  for (pw_idx v = 0; v < n; v++) {
    total += beside(w, v, NULL);
    PW_REQUIRE(total < INT32_MAX, PW_ERR_MEMORY, "a graph of more than %d edges", INT32_MAX);
    g->start[v + 1] = (pw_idx)total;
  }
  PW_TRY(pw_mem_alloc("patch graph", total, sizeof *g->adj, &g->adj));
  memset(w->seen, 0, (size_t)n * sizeof *w->seen);
  for (pw_idx v = 0; g->adj && v < n; v++) {
    beside(w, v, g->adj + g->start[v]);
  }
  return PW_OK;
}

/* Lists items by their group, ascending in each; start is [ngroup + 1]. */
static void list_by_group(pw_idx n, const pw_idx *group, pw_idx ngroup, pw_idx *start, pw_idx *list)
{
  for (pw_idx i = 0; i < n; i++) {
    start[group[i] + 1]++;
  }
  for (pw_idx k = 0; k < ngroup; k++) {
    start[k + 1] += start[k];
  }
  for (pw_idx i = 0; i < n; i++) {
    list[start[group[i]]++] = i;
  }
  memmove(start + 1, start, (size_t)ngroup * sizeof *start);
  start[0] = 0;
}

/* Parts in the order of their first patch; empty ones vanish. number is [nparts], zeroed. */
static void number_blocks(pw_blocks *b, pw_idx *number)
{
  for (pw_idx p = 0; p < b->nelem; p++) {
    pw_idx *k = &number[b->elem_block[p]];
    if (*k == 0) {
      *k = ++b->nblock;
    }
    b->elem_block[p] = *k - 1;
  }
}

static pw_status divide(walk_work *w, const pw_idx *work, pw_idx nparts, pw_blocks *b)
{
  pw_graph g = {.n = 0};
  pw_idx *number = NULL;
  PW_TRY(pw_mem_alloc("blocks of patches", b->nelem, sizeof *b->elem_block, &b->elem_block));
  PW_TRY(pw_mem_alloc("blocks: patches", b->nelem, sizeof *b->elem, &b->elem));
  pw_status s = build_graph(w, b->nelem, patches_beside, &g);
  if (s == PW_OK) {
    s = pw_order_blocks(&g, work, nparts, b->elem_block);
  }
  pw_graph_destroy(&g);
  pw_mem_free(&w->seen);
  PW_TRY(s);
  PW_TRY(pw_mem_alloc("block numbers", nparts, sizeof *number, &number));
  number_blocks(b, number);
  pw_mem_free(&number);
  PW_TRY(pw_mem_alloc("blocks: patch offsets", (pw_off)b->nblock + 1, sizeof *b->elem_start,
                      &b->elem_start));
  list_by_group(b->nelem, b->elem_block, b->nblock, b->elem_start, b->elem);
  return PW_OK;
}

static pw_status colour_blocks(walk_work *w, const pw_idx *work, pw_blocks *b)
{
  pw_graph g = {.n = 0};
  pw_idx *load = NULL;
  PW_TRY(pw_mem_alloc("blocks: colours", b->nblock, sizeof *b->colour, &b->colour));
  PW_TRY(pw_mem_alloc("blocks: by colour", b->nblock, sizeof *b->colour_block, &b->colour_block));
  pw_status s = pw_mem_alloc("block work", b->nblock, sizeof *load, &load);
  if (s == PW_OK) {
    for (pw_idx p = 0; p < b->nelem; p++) {
      load[b->elem_block[p]] += work[p];
    }
    s = build_graph(w, b->nblock, blocks_beside, &g);
  }
  if (s == PW_OK) {
    s = pw_colour_greedy(&g, load, b->colour, &b->ncolour);
  }
  pw_mem_free(&load);
  pw_mem_free(&w->seen);
  pw_graph_destroy(&g);
  PW_TRY(s);
  PW_TRY(pw_mem_alloc("blocks: colour offsets", (pw_off)b->ncolour + 1, sizeof *b->colour_start,
                      &b->colour_start));
  list_by_group(b->nblock, b->colour, b->ncolour, b->colour_start, b->colour_block);
  return PW_OK;
}

static pw_status create(walk_work *w, const pw_idx *weight, pw_idx per_block, pw_blocks *b)
{
  pw_idx *work = NULL, nparts = b->nelem / per_block > 1 ? b->nelem / per_block : 1;
  PW_TRY(pw_mem_alloc("patch work", b->nelem, sizeof *work, &work));
  for (pw_idx p = 0; p < b->nelem; p++) {
    work[p] = 1 + (weight ? weight[p] : 0);
  }
  pw_status s = divide(w, work, nparts, b);
  if (s == PW_OK) {
    s = colour_blocks(w, work, b);
  }
  pw_mem_free(&work);
  pw_mem_free(&w->seen);
  return s;
}

pw_status pw_patch_blocks_create(const pw_tets *t, pw_idx per, const pw_idx *weight,
                                 pw_idx per_block, pw_blocks *out)
{
  PW_REQUIRE(per >= 1 && t->nelem % per == 0, PW_ERR_ARGUMENT, "%d elements in patches of %d",
             (int)t->nelem, (int)per);
  PW_REQUIRE(per_block >= 1, PW_ERR_ARGUMENT, "%d patches per block", (int)per_block);
  pw_blocks b = {.nelem = t->nelem / per, .nbody = 1};
  pw_off total = b.nelem;
  for (pw_idx p = 0; weight && p < b.nelem; p++) {
    total += weight[p];
    PW_REQUIRE(weight[p] >= 0 && total < 1 << 30, PW_ERR_ARGUMENT,
               "patch %d has weight %d, which makes %lld in all", (int)p, (int)weight[p],
               (long long)total);
  }
  walk_work w = {.t = t, .b = &b, .per = per};
  pw_status s = create(&w, weight, per_block, &b);
  if (s != PW_OK) {
    pw_blocks_destroy(&b);
    return s;
  }
  *out = b;
  return PW_OK;
}

pw_status pw_patch_blocks_check(const pw_tets *t, pw_idx per, const pw_blocks *b)
{
  for (pw_idx a = 0; a < t->nnode; a++) {
    for (pw_idx l = t->node_start[a]; l < t->node_start[a + 1]; l++) {
      for (pw_idx m = t->node_start[a]; m < l; m++) {
        pw_idx k = b->elem_block[t->node_elem[l] / per], o = b->elem_block[t->node_elem[m] / per];
        PW_REQUIRE(k == o || b->colour[k] != b->colour[o], PW_ERR_ARGUMENT,
                   "blocks %d and %d of colour %d share node %d", (int)o, (int)k, (int)b->colour[k],
                   (int)a);
      }
    }
  }
  return PW_OK;
}
