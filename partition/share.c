/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "partition/share.h"

#include <string.h>

#include "engine/core/mem.h"

/* The smallest blocks of a list, up to this part of its work, belong to nobody beforehand. */
static const pw_real TAIL = 0.1;

pw_status pw_share_create(pw_blocks *b, int threads)
{
  b->nthread = 0;
  b->share_room = threads > 1 ? threads : 1;
  const pw_off lists = (pw_off)b->ncolour + 1;
  PW_TRY(pw_mem_alloc("shares: offsets", lists * (b->share_room + 1) + 1, sizeof *b->share_start,
                      &b->share_start));
  PW_TRY(pw_mem_alloc("shares: blocks", 2 * (pw_off)b->nblock, sizeof *b->share_block,
                      &b->share_block));
  PW_TRY(pw_mem_alloc("shares: sizes", b->nblock, sizeof *b->share_size, &b->share_size));
  PW_TRY(pw_mem_alloc("shares: work", b->nblock, sizeof *b->share_work, &b->share_work));
  PW_TRY(pw_mem_alloc("shares: homes", b->nblock, sizeof *b->share_home, &b->share_home));
  PW_TRY(pw_mem_alloc("shares: owners", b->nblock, sizeof *b->share_owner, &b->share_owner));
  PW_TRY(pw_mem_alloc("shares: order", b->nblock, sizeof *b->share_order, &b->share_order));
  return pw_mem_alloc("shares: loads", b->share_room, sizeof *b->share_load, &b->share_load);
}

void pw_share_destroy(pw_blocks *b)
{
  pw_mem_free(&b->share_start);
  pw_mem_free(&b->share_block);
  pw_mem_free(&b->share_size);
  pw_mem_free(&b->share_work);
  pw_mem_free(&b->share_home);
  pw_mem_free(&b->share_owner);
  pw_mem_free(&b->share_order);
  pw_mem_free(&b->share_load);
  b->nthread = b->share_room = 0;
}

/* Blocks of a list in its order (rows of the grid, upwards) cut into parts of equal size. */
static void set_homes(pw_blocks *b, const pw_idx *list, pw_idx n)
{
  pw_off all = 0, before = 0;
  for (pw_idx l = 0; l < n; l++) {
    all += b->share_size[list[l]];
  }
  for (pw_idx l = 0; l < n; l++) {
    const pw_idx k = list[l];
    pw_off middle = 2 * before + b->share_size[k];
    pw_idx t = all > 0 ? (pw_idx)((pw_real)middle / (pw_real)(2 * all) * b->share_room) : 0;
    b->share_home[k] = t < b->share_room ? t : b->share_room - 1;
    before += b->share_size[k];
  }
}

/* Blocks of a list that hold something, by falling load; equal ones in their order. */
static pw_idx order_list(pw_blocks *b, const pw_idx *list, pw_idx n, const pw_off *load)
{
  pw_idx *order = b->share_order, held = 0;
  for (pw_idx l = 0; l < n; l++) {
    pw_idx k = list ? list[l] : l, at = held;
    b->share_owner[k] = -1;
    if (b->share_size[k] <= 0) {
      continue;
    }
    for (; at > 0 && load[order[at - 1]] < load[k]; at--) {
      order[at] = order[at - 1];
    }
    order[at] = k;
    held++;
  }
  return held;
}

static pw_idx least(const pw_off *sum, pw_idx n)
{
  pw_idx best = 0;
  for (pw_idx t = 1; t < n; t++) {
    best = sum[t] < sum[best] ? t : best;
  }
  return best;
}

static pw_idx most(const pw_off *sum, pw_idx n)
{
  pw_idx best = 0;
  for (pw_idx t = 1; t < n; t++) {
    best = sum[t] > sum[best] ? t : best;
  }
  return best;
}

/* The block of thread t whose move to another, by `gap` less busy, evens them out best; or -1. */
static pw_idx best_move(const pw_blocks *b, pw_idx given, const pw_off *load, pw_idx t, pw_off gap)
{
  pw_idx best = -1;
  pw_off gain = 0;
  for (pw_idx i = 0; i < given; i++) {
    const pw_idx k = b->share_order[i];
    const pw_off rest = gap - load[k], less = rest < load[k] ? rest : load[k];
    if (b->share_owner[k] == t && less > gain) {
      best = k;
      gain = less;
    }
  }
  return best;
}

/* Moves from the busiest thread to the least busy one, while they differ by more than the tail can
 * even out: a block among those of another thread has all its nodes in the wrong cache. Every move
 * lessens the sum of squares. */
static void even_out(pw_blocks *b, pw_idx given, const pw_off *load, pw_off tail)
{
  const pw_idx nt = b->share_room;
  pw_off *sum = b->share_load;
  for (pw_idx k = 0; k >= 0;) {
    const pw_idx from = most(sum, nt), to = least(sum, nt);
    const pw_off gap = sum[from] - sum[to];
    k = gap * (nt - 1) > tail ? best_move(b, given, load, from, gap) : -1;
    if (k >= 0) {
      b->share_owner[k] = to;
      sum[from] -= load[k];
      sum[to] += load[k];
    }
  }
}

/* Owner of each of the first blocks in falling order; returns how many. */
static pw_idx give_out(pw_blocks *b, pw_idx held, const pw_off *load)
{
  const pw_idx nt = b->share_room;
  pw_off *sum = b->share_load, all = 0, given = 0;
  pw_idx i = 0;
  memset(sum, 0, (size_t)nt * sizeof *sum);
  for (pw_idx l = 0; l < held; l++) {
    all += load[b->share_order[l]];
  }
  const pw_off enough = nt > 1 ? all - (pw_off)(TAIL * (pw_real)all) : all;
  for (; i < held && given < enough; i++) {
    pw_idx k = b->share_order[i];
    b->share_owner[k] = b->share_home[k];
    sum[b->share_home[k]] += load[k];
    given += load[k];
  }
  even_out(b, i, load, all - given);
  return i;
}

/* Shares of a list of blocks (NULL: all), each in the order of the list, then its tail in falling
 * order, appended to share_block; start is [share_room + 1]. Returns the end of the tail. */
static pw_idx divide(pw_blocks *b, const pw_idx *list, pw_idx n, const pw_off *load, pw_idx *start,
                     pw_idx at)
{
  const pw_idx nt = b->share_room, held = order_list(b, list, n, load);
  const pw_idx given = give_out(b, held, load);
  for (pw_idx t = 0; t < nt; t++) {
    start[t] = at;
    for (pw_idx l = 0; l < n; l++) {
      pw_idx k = list ? list[l] : l;
      if (b->share_owner[k] == t) {
        b->share_block[at++] = k;
      }
    }
  }
  start[nt] = at;
  for (pw_idx i = given; i < held; i++) {
    b->share_block[at++] = b->share_order[i];
  }
  return at;
}

void pw_share_balance(pw_blocks *b)
{
  const pw_idx row = b->share_room + 1;
  pw_idx at = 0;
  for (pw_idx c = 0; c < b->ncolour; c++) {
    const pw_idx first = b->colour_start[c], n = b->colour_start[c + 1] - first;
    const pw_idx *list = b->colour_block + first;
    set_homes(b, list, n);
    at = divide(b, list, n, b->share_size, b->share_start + (pw_off)c * row, at);
    for (pw_idx l = 0; l < n; l++) { /* its points stay with the thread when all blocks are run */
      const pw_idx k = list[l];
      b->share_home[k] = b->share_owner[k] >= 0 ? b->share_owner[k] : b->share_home[k];
    }
  }
  at = divide(b, NULL, b->nblock, b->share_work, b->share_start + (pw_off)b->ncolour * row, at);
  b->share_start[((pw_off)b->ncolour + 1) * row] = at;
  b->nthread = b->share_room;
}

/* Longest and sum of what the threads run of list c, a colour or all blocks (c = ncolour), when
 * each block of the tail goes to the thread that is free first. */
static pw_off share_loads(const pw_blocks *b, pw_idx c, const pw_off *load, pw_off *all)
{
  const pw_idx nt = b->nthread, *start = b->share_start + (pw_off)c * (nt + 1);
  pw_off *sum = b->share_load, longest = 0;
  for (pw_idx t = 0; t < nt; t++) {
    sum[t] = 0;
    for (pw_idx k = start[t]; k < start[t + 1]; k++) {
      sum[t] += load[b->share_block[k]];
    }
  }
  for (pw_idx k = start[nt]; k < start[nt + 1]; k++) {
    sum[least(sum, nt)] += load[b->share_block[k]];
  }
  for (pw_idx t = 0; t < nt; t++) {
    *all += sum[t];
    longest = sum[t] > longest ? sum[t] : longest;
  }
  return longest;
}

/* The same when every thread gets an equal number of blocks. */
static pw_off equal_load(const pw_blocks *b, pw_idx c, const pw_off *load, int t, int threads)
{
  const bool all = c == b->ncolour;
  const pw_idx first = all ? 0 : b->colour_start[c];
  const pw_idx n = all ? b->nblock : b->colour_start[c + 1] - first;
  const pw_idx each = n / threads, more = n % threads, own = each + (t < more ? 1 : 0);
  const pw_idx from = first + t * each + (t < more ? t : more);
  pw_off sum = 0;
  for (pw_idx k = from; k < from + own; k++) {
    sum += load[all ? k : b->colour_block[k]];
  }
  return sum;
}

static pw_off equal_loads(const pw_blocks *b, pw_idx c, const pw_off *load, int threads,
                          pw_off *all)
{
  pw_off longest = 0;
  for (int t = 0; t < threads; t++) {
    pw_off own = equal_load(b, c, load, t, threads);
    *all += own;
    longest = own > longest ? own : longest;
  }
  return longest;
}

void pw_share_bound(const pw_blocks *b, int threads, pw_real *coloured, pw_real *plain)
{
  pw_off size = 0, work = 0, longest = 0, part = 0;
  for (pw_idx c = 0; c <= b->ncolour; c++) {
    const pw_off *load = c < b->ncolour ? b->share_size : b->share_work;
    pw_off *all = c < b->ncolour ? &size : &work;
    part = b->nthread > 0 ? share_loads(b, c, load, all) : equal_loads(b, c, load, threads, all);
    longest += c < b->ncolour ? part : 0;
  }
  *coloured = longest > 0 ? (pw_real)size / (pw_real)longest : 1.0;
  *plain = part > 0 ? (pw_real)work / (pw_real)part : 1.0;
}

pw_status pw_share_plan(pw_blocks *b, int threads, const pw_off *size, pw_real *coloured)
{
  pw_real plain;
  pw_status s = pw_share_create(b, threads);
  if (s == PW_OK) {
    memcpy(b->share_size, size, (size_t)b->nblock * sizeof *size);
    memcpy(b->share_work, size, (size_t)b->nblock * sizeof *size);
    pw_share_balance(b);
    pw_share_bound(b, threads, coloured, &plain);
  }
  pw_share_destroy(b);
  return s;
}
