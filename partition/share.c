/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "partition/share.h"

#include <string.h>

#include "engine/core/mem.h"

pw_status pw_share_create(pw_blocks *b, int threads)
{
  b->nthread = 0;
  b->share_room = threads > 1 ? threads : 1;
  const pw_off lists = (pw_off)b->ncolour + 1;
  PW_TRY(pw_mem_alloc("shares: offsets", lists * b->share_room + 1, sizeof *b->share_start,
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

/* Blocks in their order (rows of the grid, upwards) cut into parts of equal work. */
static void set_homes(pw_blocks *b)
{
  pw_off all = 0, before = 0;
  for (pw_idx k = 0; k < b->nblock; k++) {
    all += b->share_work[k];
  }
  for (pw_idx k = 0; k < b->nblock; k++) {
    pw_off middle = 2 * before + b->share_work[k];
    pw_idx t = all > 0 ? (pw_idx)((pw_real)middle / (pw_real)(2 * all) * b->share_room) : 0;
    b->share_home[k] = t < b->share_room ? t : b->share_room - 1;
    before += b->share_work[k];
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

/* Owners of a list of blocks (NULL: all), then the shares, each in the order of the list, appended
 * to share_block; start is [share_room]. Returns the end of the last share. */
static pw_idx divide(pw_blocks *b, const pw_idx *list, pw_idx n, const pw_off *load, pw_idx *start,
                     pw_idx at)
{
  const pw_idx nt = b->share_room, held = order_list(b, list, n, load);
  pw_off *sum = b->share_load, all = 0;
  memset(sum, 0, (size_t)nt * sizeof *sum);
  for (pw_idx i = 0; i < held; i++) {
    all += load[b->share_order[i]];
  }
  for (pw_idx i = 0; i < held; i++) {
    pw_idx k = b->share_order[i], t = b->share_home[k];
    t = (sum[t] + load[k]) * nt <= all ? t : least(sum, nt);
    b->share_owner[k] = t;
    sum[t] += load[k];
  }
  for (pw_idx t = 0; t < nt; t++) {
    start[t] = at;
    for (pw_idx l = 0; l < n; l++) {
      pw_idx k = list ? list[l] : l;
      if (b->share_owner[k] == t) {
        b->share_block[at++] = k;
      }
    }
  }
  return at;
}

void pw_share_balance(pw_blocks *b)
{
  const pw_idx nt = b->share_room;
  pw_idx at = 0;
  set_homes(b);
  for (pw_idx c = 0; c < b->ncolour; c++) {
    const pw_idx first = b->colour_start[c], n = b->colour_start[c + 1] - first;
    at = divide(b, b->colour_block + first, n, b->share_size, b->share_start + (pw_off)c * nt, at);
  }
  at = divide(b, NULL, b->nblock, b->share_work, b->share_start + (pw_off)b->ncolour * nt, at);
  b->share_start[((pw_off)b->ncolour + 1) * nt] = at;
  b->nthread = b->share_room;
}

/* What thread t runs of list c: a colour, or all blocks (c = ncolour). */
static pw_off share_load(const pw_blocks *b, pw_idx c, const pw_off *load, int t)
{
  const pw_idx *start = b->share_start + (pw_off)c * b->nthread + t;
  pw_off sum = 0;
  for (pw_idx k = start[0]; k < start[1]; k++) {
    sum += load[b->share_block[k]];
  }
  return sum;
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

void pw_share_bound(const pw_blocks *b, int threads, pw_real *coloured, pw_real *plain)
{
  pw_off size = 0, work = 0, longest = 0, part = 0;
  const int nt = b->nthread > 0 ? b->nthread : threads;
  for (pw_idx c = 0; c <= b->ncolour; c++) {
    const pw_off *load = c < b->ncolour ? b->share_size : b->share_work;
    pw_off *all = c < b->ncolour ? &size : &work;
    part = 0;
    for (int t = 0; t < nt; t++) {
      pw_off own = b->nthread > 0 ? share_load(b, c, load, t) : equal_load(b, c, load, t, nt);
      *all += own;
      part = own > part ? own : part;
    }
    longest += c < b->ncolour ? part : 0;
  }
  *coloured = longest > 0 ? (pw_real)size / (pw_real)longest : 1.0;
  *plain = part > 0 ? (pw_real)work / (pw_real)part : 1.0;
}
