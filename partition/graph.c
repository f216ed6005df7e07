/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "partition/graph.h"

#include "engine/core/mem.h"

void pw_graph_destroy(pw_graph *g)
{
  pw_mem_free(&g->start);
  pw_mem_free(&g->adj);
  g->n = 0;
}

pw_status pw_graph_grid(const pw_idx *cells, pw_graph *out)
{
  pw_idx nx = cells[0], ny = cells[1], n = nx * ny, k = 0;
  pw_graph g = {.n = n};
  PW_TRY(pw_mem_alloc("element graph offsets", (pw_off)n + 1, sizeof *g.start, &g.start));
  pw_off ends = 2 * ((pw_off)(nx - 1) * ny + (pw_off)nx * (ny - 1));
  pw_status s = pw_mem_alloc("element graph", ends, sizeof *g.adj, &g.adj);
  if (s != PW_OK) {
    pw_graph_destroy(&g);
    return s;
  }
  for (pw_idx e = 0; e < n; e++) {
    pw_idx i = e % nx, j = e / nx;
    if (j > 0) {
      g.adj[k++] = e - nx;
    }
    if (i > 0) {
      g.adj[k++] = e - 1;
    }
    if (i < nx - 1) {
      g.adj[k++] = e + 1;
    }
    if (j < ny - 1) {
      g.adj[k++] = e + nx;
    }
    g.start[e + 1] = k;
  }
  *out = g;
  return PW_OK;
}

/* Work arrays of the conflict graph. */
typedef struct {
  pw_idx *node;       /* [nnode] nodes of the block at hand */
  pw_idx *mark;       /* [nnode] number of the walk that saw the node last */
  pw_idx *node_start; /* [nnode + 1] offsets into node_block */
  pw_idx *node_block; /* [sum of supports] blocks at each node, ascending */
  pw_idx *seen;       /* [nblock] number of the walk that saw the block last */
  pw_idx walk;
} conflict_work;

/* Lists the nodes of the support of block k once each in w->node; returns their number. */
static pw_idx support(const pw_blocks *b, pw_idx k, conflict_work *w)
{
  pw_idx n = 0, row = b->cells[0] + 1, r = b->reach;
  w->walk++;
  for (pw_idx e = b->elem_start[k]; e < b->elem_start[k + 1]; e++) {
    pw_idx i = b->elem[e] % b->cells[0], j = b->elem[e] / b->cells[0];
    pw_idx i0 = i > r ? i - r : 0, i1 = i + 1 < b->cells[0] - r ? i + 1 + r : b->cells[0];
    pw_idx j0 = j > r ? j - r : 0, j1 = j + 1 < b->cells[1] - r ? j + 1 + r : b->cells[1];
    for (pw_idx jj = j0; jj <= j1; jj++) {
      for (pw_idx a = jj * row + i0; a <= jj * row + i1; a++) {
        if (w->mark[a] != w->walk) {
          w->mark[a] = w->walk;
          w->node[n++] = a;
        }
      }
    }
  }
  return n;
}

/* Blocks in conflict with block k, written to adj unless it is NULL; returns their number. */
static pw_idx conflicts(const pw_blocks *b, pw_idx k, conflict_work *w, pw_idx *adj)
{
  pw_idx n = 0, nodes = support(b, k, w);
  w->seen[k] = w->walk;
  for (pw_idx a = 0; a < nodes; a++) {
    pw_idx node = w->node[a];
    for (pw_idx l = w->node_start[node]; l < w->node_start[node + 1]; l++) {
      pw_idx other = w->node_block[l];
      if (w->seen[other] != w->walk) {
        w->seen[other] = w->walk;
        if (adj) {
          adj[n] = other;
        }
        n++;
      }
    }
  }
  return n;
}

static pw_status list_blocks_at_nodes(const pw_blocks *b, pw_idx nnode, conflict_work *w)
{
  PW_TRY(pw_mem_alloc("block support", nnode, sizeof *w->node, &w->node));
  PW_TRY(pw_mem_alloc("block support marks", nnode, sizeof *w->mark, &w->mark));
  PW_TRY(pw_mem_alloc("blocks at nodes offsets", (pw_off)nnode + 1, sizeof *w->node_start,
                      &w->node_start));
  PW_TRY(pw_mem_alloc("block marks", b->nblock, sizeof *w->seen, &w->seen));
  pw_off total = 0;
  for (pw_idx k = 0; k < b->nblock; k++) {
    pw_idx n = support(b, k, w);
    for (pw_idx a = 0; a < n; a++) {
      w->node_start[w->node[a] + 1]++;
    }
    total += n;
  }
  PW_REQUIRE(total < INT32_MAX, PW_ERR_MEMORY, "supports of %d blocks hold %lld nodes",
             (int)b->nblock, (long long)total);
  PW_TRY(pw_mem_alloc("blocks at nodes", total, sizeof *w->node_block, &w->node_block));
  for (pw_idx a = 0; a < nnode; a++) {
    w->node_start[a + 1] += w->node_start[a];
  }
  for (pw_idx k = 0; k < b->nblock; k++) {
    pw_idx n = support(b, k, w);
    for (pw_idx a = 0; a < n; a++) {
      w->node_block[w->node_start[w->node[a]]++] = k;
    }
  }
  for (pw_idx a = nnode; a > 0; a--) {
    w->node_start[a] = w->node_start[a - 1];
  }
  w->node_start[0] = 0;
  return PW_OK;
}

static pw_status build_conflict(const pw_blocks *b, conflict_work *w, pw_graph *g)
{
  pw_idx nnode = (b->cells[0] + 1) * (b->cells[1] + 1);
  PW_TRY(list_blocks_at_nodes(b, nnode, w));
  PW_TRY(pw_mem_alloc("conflict offsets", (pw_off)b->nblock + 1, sizeof *g->start, &g->start));
  for (pw_idx k = 0; k < b->nblock; k++) {
    g->start[k + 1] = g->start[k] + conflicts(b, k, w, NULL);
  }
  PW_TRY(pw_mem_alloc("conflicts", g->start[b->nblock], sizeof *g->adj, &g->adj));
  for (pw_idx k = 0; g->adj && k < b->nblock; k++) {
    conflicts(b, k, w, g->adj + g->start[k]);
  }
  return PW_OK;
}

pw_status pw_graph_conflict(const pw_blocks *b, pw_graph *out)
{
  conflict_work w = {.walk = 0};
  pw_graph g = {.n = b->nblock};
  pw_status s = build_conflict(b, &w, &g);
  pw_mem_free(&w.node);
  pw_mem_free(&w.mark);
  pw_mem_free(&w.node_start);
  pw_mem_free(&w.node_block);
  pw_mem_free(&w.seen);
  if (s != PW_OK) {
    pw_graph_destroy(&g);
    return s;
  }
  *out = g;
  return PW_OK;
}
