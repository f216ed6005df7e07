/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The size of blocks for which colours can be divided evenly and are few. With a few dozen blocks
 * and five to ten colours the last block of a colour decides how long the others wait, and a size a
 * little smaller or larger may give colours that fit; larger ones need fewer colours and have fewer
 * nodes on their borders, whose records go from processor to processor. So some sizes are tried.
 * The nominal one comes first: where it does, no other is.
 */
#include "partition/blocks.h"

#include "engine/core/mem.h"
#include "partition/share.h"

static const pw_real ENOUGH_FOR_2 = 1.95, ENOUGH_FOR_4 = 3.6;

/* Sizes to try, in eighths of the nominal one. */
static const pw_idx EIGHTHS[] = {8, 10, 12, 13, 14, 15, 16, 17, 18, 20, 24, 32};

enum {
  MAX_TRIED = 40000, /* elements; beyond, blocks are numerous enough for any size */
  /* Points scattered by one thread in the time that a colour costs beside its work. Measured on two
   * threads with 40 to 111 blocks in 5 to 8 colours: 2.5 to 4 microseconds, 70 to 110 points, where
   * the processors share a cache, and 9 to 13 where they do not. */
  BARRIER = 60
};

/* How a division does: bounds on 2 and 4 threads, and on 2 with the barriers counted. */
typedef struct merit {
  pw_real on_2, on_4, with_barriers;
} merit;

static pw_status rate(pw_blocks *b, const pw_idx *weight, merit *m)
{
  pw_off *size = NULL, all = 0;
  PW_TRY(pw_mem_alloc("block sizes", b->nblock, sizeof *size, &size));
  for (pw_idx e = 0; e < b->nelem; e++) {
    size[b->elem_block[e]] += weight ? weight[e] : 1;
    all += weight ? weight[e] : 1;
  }
  pw_status s = pw_share_plan(b, 2, size, &m->on_2);
  if (s == PW_OK) {
    s = pw_share_plan(b, 4, size, &m->on_4);
    m->with_barriers = (pw_real)all / ((pw_real)all / m->on_2 + (pw_real)(BARRIER * b->ncolour));
  }
  pw_mem_free(&size);
  return s;
}

static bool is_even(const merit *m)
{
  return m->on_2 >= ENOUGH_FOR_2 && m->on_4 >= ENOUGH_FOR_4;
}

static bool is_enough(const merit *m)
{
  return is_even(m) && m->with_barriers >= 0.97 * m->on_2;
}

static bool is_better(const merit *m, const merit *best)
{
  return is_even(m) != is_even(best) ? is_even(m) : m->with_barriers > best->with_barriers;
}

pw_status pw_blocks_create_even(const pw_idx *cells, const pw_idx *weight, pw_idx reach, int nbody,
                                pw_blocks *out)
{
  const pw_idx nominal = pw_blocks_choose_size(cells[0] * cells[1], 0);
  const int tries = cells[0] * cells[1] > MAX_TRIED ? 1 : (int)(sizeof EIGHTHS / sizeof *EIGHTHS);
  pw_blocks best = {0};
  merit best_merit = {0.0, 0.0, -1.0};
  pw_status s = PW_OK;
  bool enough = false;
  for (int k = 0; k < tries && s == PW_OK && !enough; k++) {
    pw_blocks b = {0};
    merit m = {0.0, 0.0, 0.0};
    s = pw_blocks_create(cells, weight, (nominal * EIGHTHS[k] + 4) / 8, reach, nbody, &b);
    if (s == PW_OK) {
      s = rate(&b, weight, &m);
    }
    enough = s == PW_OK && is_enough(&m);
    if (s == PW_OK && (enough || is_better(&m, &best_merit))) {
      pw_blocks last = best;
      best = b;
      b = last;
      best_merit = m;
    }
    pw_blocks_destroy(&b);
  }
  if (s != PW_OK) {
    pw_blocks_destroy(&best);
    return s;
  }
  *out = best;
  return PW_OK;
}
