/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The size of blocks for which colours can be divided evenly and are few. With a few dozen blocks
 * and five to ten colours the last block of a colour decides how long the others wait, and a size a
 * little smaller or larger may give colours that fit; larger ones need fewer colours and have fewer
 * nodes on their borders, whose records go from processor to processor. So some sizes are tried.
 * The nominal one comes first: where it does, no other is.
 */
#include "partition/blocks.h"

#include <math.h>

#include "engine/core/mem.h"
#include "partition/share.h"

/* Part of 2 and 4 threads, barriers counted, that is enough for not looking further. */
static const pw_real ENOUGH = 0.95;

/* By what a larger size has to be better: smaller blocks can be divided among more threads, and
 * take longer steps where the method has several. */
static const pw_real BETTER = 1.02;

/* Sizes to try, in eighths of the nominal one. */
static const pw_idx EIGHTHS[] = {8, 10, 12, 13, 14, 15, 16, 17, 18, 20, 24, 32};

enum {
  MAX_TRIED = 40000, /* elements; beyond, blocks are numerous enough for any size */
  /* Points scattered by one thread in the time that a colour costs beside its work. Measured on two
   * threads with 40 to 111 blocks in 5 to 8 colours: 2.5 to 4 microseconds, 70 to 110 points, where
   * the processors share a cache, and 9 to 13 where they do not. */
  BARRIER = 80
};

/* Mean part of their number that 2 and 4 threads reach in the scatters, barriers counted. */
static pw_status rate(const pw_blocks *b, const pw_idx *weight, pw_real *merit)
{
  pw_off *size = NULL, all = 0;
  PW_TRY(pw_mem_alloc("block sizes", b->nblock, sizeof *size, &size));
  for (pw_idx e = 0; e < b->nelem; e++) {
    size[b->elem_block[e]] += weight ? weight[e] : 1;
    all += weight ? weight[e] : 1;
  }
  pw_status s = PW_OK;
  *merit = 1.0;
  for (int threads = 2; threads <= 4 && s == PW_OK && all > 0; threads += 2) {
    pw_real bound = 1.0;
    s = pw_share_plan(b, threads, size, &bound);
    const pw_real time = (pw_real)all / bound + (pw_real)(BARRIER * b->ncolour);
    *merit *= (pw_real)all / time / threads;
  }
  *merit = sqrt(*merit);
  pw_mem_free(&size);
  return s;
}

pw_status pw_blocks_create_even(const pw_idx *cells, const pw_idx *weight, pw_idx reach, int nbody,
                                pw_blocks *out)
{
  const pw_idx nominal = pw_blocks_choose_size(cells[0] * cells[1], 0);
  const int tries = cells[0] * cells[1] > MAX_TRIED ? 1 : (int)(sizeof EIGHTHS / sizeof *EIGHTHS);
  pw_blocks best = {0};
  pw_real best_merit = -1.0;
  pw_status s = PW_OK;
  for (int k = 0; k < tries && s == PW_OK && best_merit < ENOUGH; k++) {
    pw_blocks b = {0};
    pw_real merit = 0.0;
    s = pw_blocks_create(cells, weight, (nominal * EIGHTHS[k] + 4) / 8, reach, nbody, &b);
    if (s == PW_OK) {
      s = rate(&b, weight, &merit);
    }
    if (s == PW_OK && merit > BETTER * best_merit) {
      pw_blocks last = best;
      best = b;
      b = last;
      best_merit = merit;
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
