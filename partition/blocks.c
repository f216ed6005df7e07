/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * From cells to colours: face-neighbour graph of the elements -> METIS parts -> blocks numbered by
 * their first element -> graph of blocks that share a node -> colours -> lists by colour.
 *
 * How many blocks. With equal work the bound on the speed-up of one coloured loop is blocks /
 * sum over colours of ceil(blocks of the colour / threads); about six blocks per colour and thread
 * keep it near 92 % of the threads. Blocks must not depend on the threads of the run, because the
 * order of additions at a node follows from them, so the number of threads is a nominal one.
 * Blocks of 35 to 60 elements with a halo of one cell get 5 or 6 colours; smaller ones need more
 * (7 at 24, 9 at 8 elements), which takes back what their number gives.
 */
#include "partition/blocks.h"

#include "engine/core/mem.h"
#include "partition/colour.h"
#include "partition/graph.h"
#include "partition/order.h"
#include "partition/share.h"

#include <string.h>

enum {
  NOMINAL_THREADS = 4,
  NOMINAL_COLOURS = 4, /* the least a division of the plane can have */
  BLOCKS_PER_COLOUR_AND_THREAD = 6,
  SMALLEST = 8,
  LARGEST = 256,
  MAX_ELEMENTS = 1 << 28,
  MAX_WEIGHT = 1 << 30
};

void pw_blocks_destroy(pw_blocks *b)
{
  pw_mem_free(&b->elem_block);
  pw_mem_free(&b->elem_start);
  pw_mem_free(&b->elem);
  pw_mem_free(&b->colour);
  pw_mem_free(&b->colour_start);
  pw_mem_free(&b->colour_block);
  pw_mem_free(&b->point_start);
  pw_share_destroy(b);
  memset(b, 0, sizeof *b);
}

pw_idx pw_blocks_choose_size(pw_idx nelem, int threads)
{
  (void)threads;
  pw_idx blocks = BLOCKS_PER_COLOUR_AND_THREAD * NOMINAL_COLOURS * NOMINAL_THREADS;
  pw_idx size = nelem / blocks;
  return size < SMALLEST ? SMALLEST : size > LARGEST ? LARGEST : size;
}

static pw_status check_input(const pw_idx *cells, const pw_idx *weight, pw_idx per_block,
                             pw_idx reach, int nbody)
{
  PW_REQUIRE(cells[0] >= 1 && cells[1] >= 1, PW_ERR_ARGUMENT, "a grid of %d x %d cells",
             (int)cells[0], (int)cells[1]);
  pw_off nelem = (pw_off)cells[0] * cells[1];
  PW_REQUIRE(nelem <= MAX_ELEMENTS, PW_ERR_ARGUMENT, "%lld elements are more than %d",
             (long long)nelem, (int)MAX_ELEMENTS);
  PW_REQUIRE(per_block >= 1, PW_ERR_ARGUMENT, "%d elements per block", (int)per_block);
  PW_REQUIRE(reach >= 0, PW_ERR_ARGUMENT, "a halo of %d cells", (int)reach);
  PW_REQUIRE(nbody >= 1, PW_ERR_ARGUMENT, "%d bodies", nbody);
  pw_off total = nelem;
  for (pw_off e = 0; weight && e < nelem; e++) {
    PW_REQUIRE(weight[e] >= 0, PW_ERR_ARGUMENT, "element %lld has weight %d", (long long)e,
               (int)weight[e]);
    total += weight[e];
  }
  PW_REQUIRE(total <= MAX_WEIGHT, PW_ERR_ARGUMENT, "weights add up to %lld, more than %d",
             (long long)total, (int)MAX_WEIGHT);
  return PW_OK;
}

/* Blocks from METIS parts: empty parts vanish, the others are numbered by their first element. */
static pw_status number_blocks(pw_idx nparts, pw_blocks *b)
{
  pw_idx *number = NULL;
  PW_TRY(pw_mem_alloc("block numbers", nparts, sizeof *number, &number));
  b->nblock = 0;
  for (pw_idx e = 0; e < b->nelem; e++) {
    pw_idx *k = &number[b->elem_block[e]];
    if (*k == 0) {
      *k = ++b->nblock;
    }
    b->elem_block[e] = *k - 1;
  }
  pw_mem_free(&number);
  PW_TRY(pw_mem_alloc("blocks: element offsets", (pw_off)b->nblock + 1, sizeof *b->elem_start,
                      &b->elem_start));
  PW_TRY(pw_mem_alloc("blocks: elements", b->nelem, sizeof *b->elem, &b->elem));
  return PW_OK;
}

/* Lists items 0..n-1 by their group, ascending in each; start is [ngroup + 1], zeroed. */
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

/* The work of an element is its points, and one for being visited at all. What is heavier than an
 * even part cannot be divided, and METIS would leave parts empty for it: it counts as one. */
static void element_work(const pw_blocks *b, const pw_idx *weight, pw_idx nparts, pw_idx *work)
{
  pw_off all = 0;
  for (pw_idx e = 0; e < b->nelem; e++) {
    work[e] = 1 + (weight ? weight[e] : 0);
    all += work[e];
  }
  const pw_idx most = (pw_idx)(all / nparts) + 1;
  for (pw_idx e = 0; e < b->nelem; e++) {
    work[e] = work[e] < most ? work[e] : most;
  }
}

static pw_status divide(const pw_idx *weight, pw_idx nparts, pw_blocks *b)
{
  pw_graph g = {.n = 0};
  pw_idx *work = NULL;
  pw_status s = pw_mem_alloc("element work", b->nelem, sizeof *work, &work);
  if (s == PW_OK) {
    s = pw_graph_grid(b->cells, &g);
  }
  if (s == PW_OK) {
    element_work(b, weight, nparts, work);
    s = pw_order_blocks(&g, work, nparts, b->elem_block);
  }
  pw_mem_free(&work);
  pw_graph_destroy(&g);
  PW_TRY(s);
  PW_TRY(number_blocks(nparts, b));
  list_by_group(b->nelem, b->elem_block, b->nblock, b->elem_start, b->elem);
  return PW_OK;
}

static pw_status colour_blocks(const pw_idx *weight, pw_blocks *b)
{
  pw_graph g = {.n = 0};
  pw_idx *work = NULL;
  PW_TRY(pw_mem_alloc("blocks: colours", b->nblock, sizeof *b->colour, &b->colour));
  PW_TRY(pw_mem_alloc("blocks: by colour", b->nblock, sizeof *b->colour_block, &b->colour_block));
  pw_status s = pw_mem_alloc("block work", b->nblock, sizeof *work, &work);
  if (s == PW_OK) {
    for (pw_idx e = 0; e < b->nelem; e++) {
      work[b->elem_block[e]] += 1 + (weight ? weight[e] : 0);
    }
    s = pw_graph_conflict(b, &g);
  }
  if (s == PW_OK) {
    s = pw_colour_greedy(&g, work, b->colour, &b->ncolour);
  }
  pw_mem_free(&work);
  pw_graph_destroy(&g);
  PW_TRY(s);
  PW_TRY(pw_mem_alloc("blocks: colour offsets", (pw_off)b->ncolour + 1, sizeof *b->colour_start,
                      &b->colour_start));
  list_by_group(b->nblock, b->colour, b->ncolour, b->colour_start, b->colour_block);
  return PW_OK;
}

static pw_status create(const pw_idx *weight, pw_idx per_block, pw_blocks *b)
{
  PW_TRY(pw_mem_alloc("blocks of elements", b->nelem, sizeof *b->elem_block, &b->elem_block));
  pw_idx nparts = b->nelem / per_block > 1 ? b->nelem / per_block : 1;
  PW_TRY(divide(weight, nparts, b));
  PW_TRY(colour_blocks(weight, b));
  return pw_mem_alloc("blocks: points", (pw_off)b->nblock * b->nbody + 1, sizeof *b->point_start,
                      &b->point_start);
}

pw_status pw_blocks_create(const pw_idx *cells, const pw_idx *weight, pw_idx per_block,
                           pw_idx reach, int nbody, pw_blocks *out)
{
  PW_TRY(check_input(cells, weight, per_block, reach, nbody));
  pw_idx widest = cells[0] > cells[1] ? cells[0] : cells[1];
  pw_blocks b = {.nelem = cells[0] * cells[1],
                 .cells = {cells[0], cells[1]},
                 .reach = reach < widest ? reach : widest,
                 .nbody = nbody};
  pw_status s = create(weight, per_block, &b);
  if (s != PW_OK) {
    pw_blocks_destroy(&b);
    return s;
  }
  *out = b;
  return PW_OK;
}

bool pw_blocks_sort(pw_blocks *b, pw_idx n, const pw_idx *elem, const pw_idx *body, pw_idx *from)
{
  pw_idx *start = b->point_start, nkey = b->nblock * b->nbody, nbody = b->nbody;
  memset(start, 0, ((size_t)nkey + 1) * sizeof *start);
  for (pw_idx i = 0; i < n; i++) {
    start[b->elem_block[elem[i]] * nbody + body[i] + 1]++;
  }
  for (pw_idx k = 0; k < nkey; k++) {
    start[k + 1] += start[k];
  }
  bool moved = false;
  for (pw_idx i = 0; i < n; i++) {
    pw_idx to = start[b->elem_block[elem[i]] * nbody + body[i]]++;
    from[to] = i;
    moved |= to != i;
  }
  memmove(start + 1, start, (size_t)nkey * sizeof *start);
  start[0] = 0;
  return moved;
}

/* Claims the nodes around element e for block k; returns another block of k's colour that holds
 * one of them, or -1. owner is [nnode]; claims of earlier colours do not count. */
static pw_idx claim_nodes(const pw_blocks *b, pw_idx e, pw_idx k, pw_idx *owner)
{
  pw_idx row = b->cells[0] + 1, i = e % b->cells[0], j = e / b->cells[0];
  for (pw_idx y = j - b->reach; y <= j + 1 + b->reach; y++) {
    for (pw_idx x = i - b->reach; x <= i + 1 + b->reach; x++) {
      if (x < 0 || y < 0 || x > b->cells[0] || y > b->cells[1]) {
        continue;
      }
      pw_idx *o = &owner[y * row + x];
      if (*o >= 0 && *o != k && b->colour[*o] == b->colour[k]) {
        return *o;
      }
      *o = k;
    }
  }
  return -1;
}

static pw_status check_colour(const pw_blocks *b, pw_idx c, pw_idx *owner)
{
  for (pw_idx l = b->colour_start[c]; l < b->colour_start[c + 1]; l++) {
    pw_idx k = b->colour_block[l];
    PW_REQUIRE(b->colour[k] == c, PW_ERR_ARGUMENT, "block %d of colour %d is listed in colour %d",
               (int)k, (int)b->colour[k], (int)c);
    for (pw_idx m = b->elem_start[k]; m < b->elem_start[k + 1]; m++) {
      pw_idx other = claim_nodes(b, b->elem[m], k, owner);
      PW_REQUIRE(other < 0, PW_ERR_ARGUMENT, "blocks %d and %d of colour %d share a node",
                 (int)other, (int)k, (int)c);
    }
  }
  return PW_OK;
}

pw_status pw_blocks_check(const pw_blocks *b)
{
  pw_idx *owner = NULL, nnode = (b->cells[0] + 1) * (b->cells[1] + 1);
  pw_status s = PW_OK;
  PW_TRY(pw_mem_alloc("block of a node", nnode, sizeof *owner, &owner));
  memset(owner, 0xff, (size_t)nnode * sizeof *owner);
  for (pw_idx c = 0; c < b->ncolour && s == PW_OK; c++) {
    s = check_colour(b, c, owner);
  }
  pw_mem_free(&owner);
  return s;
}
