/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The blocks of a list are jobs, the threads machines on which a job costs more the farther it lies
 * from the part of the grid that the thread holds. From the blocks of its part, each thread gives
 * away or exchanges one at a time as long as the busiest one gains (local search by moves and
 * exchanges): the block that evens out at the least cost is then one close to a border.
 */
#include "partition/share.h"

#include <string.h>

#include "engine/core/mem.h"

/* Blocks close to a border, up to this part of a list's work, belong to nobody beforehand. */
static const pw_real TAIL = 0.1;

/* Close to a border: in parts of a thread. */
static const pw_real CLOSE = 0.25;

/* What a block costs at most on a thread that does not hold its part, beside its work, and how far
 * off that is, as a part of all blocks. The lines of its points and nodes then come from another
 * processor's cache: measured on two threads, half to once the work of a scatter. */
static const pw_real FAR_COST = 0.5, FAR = 0.25;

/* A block for whoever is free is no larger than this part of what a thread does. */
static const pw_real PIECE = 0.25;

/* Pairs of blocks looked at for an exchange; longer lists are evened out by moves alone. */
enum { EXCHANGES = 16384 };

/* Position of a block along the longer side of the grid, in elements; without a grid its number. */
static pw_real position(const pw_blocks *b, pw_idx k)
{
  const pw_idx nx = b->cells[0], first = b->elem_start[k], n = b->elem_start[k + 1] - first;
  pw_real sum = 0.0;
  if (nx <= 0) {
    return k;
  }
  for (pw_idx l = first; l < first + n; l++) {
    sum += nx > b->cells[1] ? b->elem[l] % nx : b->elem[l] / nx;
  }
  return sum / (pw_real)n;
}

/* Lines the blocks up along the grid; share_place serves as scratch. */
static void line_up(pw_blocks *b)
{
  for (pw_idx k = 0; k < b->nblock; k++) {
    pw_idx at = k;
    b->share_place[k] = b->elem_start ? position(b, k) : k;
    for (; at > 0 && b->share_place[b->share_line[at - 1]] > b->share_place[k]; at--) {
      b->share_line[at] = b->share_line[at - 1];
    }
    b->share_line[at] = k;
  }
}

pw_blocks pw_share_undivided(const pw_blocks *b)
{
  pw_blocks out = *b;
  out.share_start = out.share_block = out.share_line = out.share_owner = out.share_order = NULL;
  out.share_size = out.share_work = NULL;
  out.share_place = out.share_border = out.share_sum = NULL;
  out.nthread = out.share_room = 0;
  return out;
}

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
  PW_TRY(pw_mem_alloc("shares: line", b->nblock, sizeof *b->share_line, &b->share_line));
  PW_TRY(pw_mem_alloc("shares: places", b->nblock, sizeof *b->share_place, &b->share_place));
  PW_TRY(pw_mem_alloc("shares: borders", b->nblock, sizeof *b->share_border, &b->share_border));
  PW_TRY(pw_mem_alloc("shares: owners", b->nblock, sizeof *b->share_owner, &b->share_owner));
  PW_TRY(pw_mem_alloc("shares: order", b->nblock, sizeof *b->share_order, &b->share_order));
  PW_TRY(pw_mem_alloc("shares: sums", b->share_room, sizeof *b->share_sum, &b->share_sum));
  line_up(b);
  return PW_OK;
}

void pw_share_destroy(pw_blocks *b)
{
  pw_mem_free(&b->share_start);
  pw_mem_free(&b->share_block);
  pw_mem_free(&b->share_size);
  pw_mem_free(&b->share_work);
  pw_mem_free(&b->share_line);
  pw_mem_free(&b->share_place);
  pw_mem_free(&b->share_border);
  pw_mem_free(&b->share_owner);
  pw_mem_free(&b->share_order);
  pw_mem_free(&b->share_sum);
  b->nthread = b->share_room = 0;
}

/* How far a block lies from the nearest border between two threads, in parts. */
static pw_real from_border(const pw_blocks *b, pw_idx k)
{
  const pw_real place = b->share_place[k];
  pw_idx border = (pw_idx)(place + 0.5);
  border = border < 1 ? 1 : border < b->share_room ? border : b->share_room - 1;
  return place > border ? place - border : border - place;
}

/* Where each block lies among the threads, from the end of the line: those between t and t + 1, a
 * part of the grid with an even part of the work, are thread t's to begin with, in all passes. */
static void set_places(pw_blocks *b)
{
  pw_off all = 0, before = 0;
  for (pw_idx k = 0; k < b->nblock; k++) {
    all += b->share_work[k];
  }
  const pw_real each = all > 0 ? (pw_real)all / b->share_room : 1.0;
  for (pw_idx l = b->nblock - 1; l >= 0; l--) {
    const pw_idx k = b->share_line[l];
    b->share_place[k] = ((pw_real)before + 0.5 * (pw_real)b->share_work[k]) / each;
    b->share_border[k] = from_border(b, k);
    before += b->share_work[k];
  }
}

static pw_idx home(const pw_blocks *b, pw_idx k)
{
  const pw_idx t = (pw_idx)b->share_place[k];
  return t < b->share_room ? t : b->share_room - 1;
}

/* What a block costs thread t. */
static pw_real cost(const pw_blocks *b, pw_idx k, pw_off load, pw_idx t, pw_real far_cost)
{
  const pw_real place = b->share_place[k];
  const pw_real outside = place < t ? t - place : place > t + 1 ? place - (t + 1) : 0.0;
  const pw_real far = outside / (FAR * b->share_room);
  return (pw_real)load * (1.0 + far_cost * (far < 1.0 ? far : 1.0));
}

/* Blocks of a list that hold something, the closest to a border last. */
static pw_idx order_list(pw_blocks *b, const pw_idx *list, pw_idx n)
{
  pw_idx *order = b->share_order, held = 0;
  for (pw_idx l = 0; l < n; l++) {
    pw_idx k = list ? list[l] : l, at = held;
    b->share_owner[k] = -1;
    if (b->share_size[k] <= 0) {
      continue;
    }
    for (; at > 0 && b->share_border[order[at - 1]] < b->share_border[k]; at--) {
      order[at] = order[at - 1];
    }
    order[at] = k;
    held++;
  }
  return held;
}

static pw_idx least(const pw_real *sum, pw_idx n)
{
  pw_idx best = 0;
  for (pw_idx t = 1; t < n; t++) {
    best = sum[t] < sum[best] ? t : best;
  }
  return best;
}

static pw_idx most(const pw_real *sum, pw_idx n)
{
  pw_idx best = 0;
  for (pw_idx t = 1; t < n; t++) {
    best = sum[t] > sum[best] ? t : best;
  }
  return best;
}

/* A list whose first `held` blocks of share_order have owners. */
typedef struct jobs {
  pw_idx held;
  const pw_off *load;
  pw_real far_cost;
} jobs;

/* Block `give` goes to thread `to`, `take` (or none, -1) comes back; what both then have to do. */
typedef struct deal {
  pw_idx give, take, to;
  pw_real from_sum, to_sum;
} deal;

static pw_real longer(const deal *d)
{
  return d->from_sum > d->to_sum ? d->from_sum : d->to_sum;
}

static void consider(const pw_blocks *b, const jobs *j, pw_idx give, pw_idx take, pw_idx to,
                     deal *best)
{
  const pw_idx from = b->share_owner[give];
  const pw_off *load = j->load;
  deal d = {give, take, to, b->share_sum[from], b->share_sum[to]};
  d.from_sum -= cost(b, give, load[give], from, j->far_cost);
  d.to_sum += cost(b, give, load[give], to, j->far_cost);
  if (take >= 0) {
    d.from_sum += cost(b, take, load[take], from, j->far_cost);
    d.to_sum -= cost(b, take, load[take], to, j->far_cost);
  }
  if (longer(&d) < longer(best) * (1.0 - 1e-9)) {
    *best = d;
  }
}

/* The move or exchange from the busiest thread that leaves the shorter of two; give is -1 when none
 * is shorter than now. */
static deal best_deal(const pw_blocks *b, const jobs *j, pw_idx busiest)
{
  const bool exchange = (pw_off)j->held * j->held <= (pw_off)EXCHANGES * b->share_room;
  deal best = {-1, -1, -1, b->share_sum[busiest], 0.0};
  for (pw_idx i = 0; i < j->held; i++) {
    const pw_idx k = b->share_order[i];
    if (b->share_owner[k] != busiest) {
      continue;
    }
    for (pw_idx t = 0; t < b->share_room; t++) {
      if (t != busiest) {
        consider(b, j, k, -1, t, &best);
      }
    }
    for (pw_idx o = 0; o < j->held && exchange; o++) {
      const pw_idx other = b->share_order[o];
      if (b->share_owner[other] != busiest) {
        consider(b, j, k, other, b->share_owner[other], &best);
      }
    }
  }
  return best;
}

/* Every deal makes the busiest thread less busy, or one of several equally busy ones, so the search
 * ends; it stops early once no thread has more than an even part of `all`. */
static void even_out(pw_blocks *b, const jobs *j, pw_off all)
{
  pw_real *sum = b->share_sum;
  memset(sum, 0, (size_t)b->share_room * sizeof *sum);
  for (pw_idx i = 0; i < j->held; i++) {
    const pw_idx k = b->share_order[i], t = b->share_owner[k];
    sum[t] += cost(b, k, j->load[k], t, j->far_cost);
  }
  for (;;) {
    const pw_idx from = most(sum, b->share_room);
    const deal d = best_deal(b, j, from);
    if (d.give < 0 || sum[from] * b->share_room <= (pw_real)all) {
      return;
    }
    b->share_owner[d.give] = d.to;
    if (d.take >= 0) {
      b->share_owner[d.take] = from;
    }
    sum[from] = d.from_sum;
    sum[d.to] = d.to_sum;
  }
}

/* Puts block i of the order into the tail, which begins at `tail`, behind larger ones. */
static void put_in_tail(pw_blocks *b, pw_idx i, pw_idx tail, pw_idx held, const pw_off *load)
{
  pw_idx *order = b->share_order, at = i;
  const pw_idx k = order[i];
  for (; at + 1 < held && (at + 1 < tail || load[order[at + 1]] > load[k]); at++) {
    order[at] = order[at + 1];
  }
  order[at] = k;
}

/* What the busiest thread has to do, however far off. */
static pw_real longest(pw_blocks *b, pw_idx held, const pw_off *load)
{
  memset(b->share_sum, 0, (size_t)b->share_room * sizeof *b->share_sum);
  for (pw_idx i = 0; i < held; i++) {
    const pw_idx k = b->share_order[i];
    b->share_sum[b->share_owner[k]] += (pw_real)load[k];
  }
  return b->share_sum[most(b->share_sum, b->share_room)];
}

/* Owners of all blocks of a list. */
static void give_out(pw_blocks *b, pw_idx held, const pw_off *load, pw_off all)
{
  const pw_real far_cost = b->cells[0] > 0 ? FAR_COST : 0.0; /* without a grid nothing is far */
  pw_off largest = 0;
  for (pw_idx i = 0; i < held; i++) {
    const pw_idx k = b->share_order[i];
    largest = load[k] > largest ? load[k] : largest;
    b->share_owner[k] = home(b, k);
  }
  even_out(b, &(jobs){held, load, far_cost}, all);
  if (longest(b, held, load) > (pw_real)all / b->share_room + (pw_real)largest) {
    even_out(b, &(jobs){held, load, 0.0}, all); /* however far the ways, not more than that */
  }
}

/* Takes the tail from its owners; how many blocks keep theirs. */
static pw_idx set_free(pw_blocks *b, pw_idx held, const pw_off *load, pw_off all)
{
  const pw_off room = b->share_room > 1 ? (pw_off)(TAIL * (pw_real)all) : -1;
  const pw_real piece = PIECE * (pw_real)all / b->share_room;
  pw_idx owned = held;
  pw_off tail = 0;
  for (pw_idx i = held - 1; i >= 0; i--) {
    const pw_idx k = b->share_order[i];
    if (tail + load[k] <= room && (pw_real)load[k] <= piece && b->share_border[k] < CLOSE) {
      tail += load[k];
      b->share_owner[k] = -1;
      put_in_tail(b, i, owned--, held, load);
    }
  }
  return owned;
}

/* Shares of a list of blocks (NULL: all), each in the order of the list, then its tail in falling
 * order, appended to share_block; start is [share_room + 1]. Returns the end of the tail. */
static pw_idx divide(pw_blocks *b, const pw_idx *list, pw_idx n, const pw_off *load, pw_idx *start,
                     pw_idx at)
{
  const pw_idx nt = b->share_room, held = order_list(b, list, n);
  pw_off all = 0;
  for (pw_idx i = 0; i < held; i++) {
    all += load[b->share_order[i]];
  }
  /* The few blocks of a colour are evened out knowing that its tail will do the rest, so that none
   * is taken from far away for that; among all blocks the tail is taken from an even division. */
  pw_idx given = list ? set_free(b, held, load, all) : held;
  give_out(b, given, load, all);
  given = list ? given : set_free(b, held, load, all);
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
  set_places(b);
  for (pw_idx c = 0; c < b->ncolour; c++) {
    const pw_idx first = b->colour_start[c], n = b->colour_start[c + 1] - first;
    at = divide(b, b->colour_block + first, n, b->share_size, b->share_start + (pw_off)c * row, at);
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
  pw_real *sum = b->share_sum; /* whole numbers */
  for (pw_idx t = 0; t < nt; t++) {
    sum[t] = 0.0;
    for (pw_idx k = start[t]; k < start[t + 1]; k++) {
      sum[t] += (pw_real)load[b->share_block[k]];
    }
  }
  for (pw_idx k = start[nt]; k < start[nt + 1]; k++) {
    sum[least(sum, nt)] += (pw_real)load[b->share_block[k]];
  }
  for (pw_idx t = 0; t < nt; t++) {
    *all += (pw_off)sum[t];
  }
  return (pw_off)sum[most(sum, nt)];
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

pw_status pw_share_plan(const pw_blocks *b, int threads, const pw_off *size, pw_real *coloured)
{
  pw_blocks plan = pw_share_undivided(b);
  pw_real plain;
  plan.cells[0] = plan.cells[1] = 0;
  pw_status s = pw_share_create(&plan, threads);
  if (s == PW_OK) {
    memcpy(plan.share_size, size, (size_t)b->nblock * sizeof *size);
    memcpy(plan.share_work, size, (size_t)b->nblock * sizeof *size);
    pw_share_balance(&plan);
    pw_share_bound(&plan, threads, coloured, &plain);
  }
  pw_share_destroy(&plan);
  return s;
}
