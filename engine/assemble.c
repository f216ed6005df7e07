/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/assemble.h"

#include <omp.h>

/* Without a division: equal numbers of blocks. */
static void run_equal(const pw_blocks *b, int threads, pw_block_fn fn, void *ctx)
{
#pragma omp parallel default(none) shared(b, fn, ctx) num_threads(threads)
  {
    for (pw_idx c = 0; c < b->ncolour; c++) {
      /* The implicit barrier at the end of the loop separates the colours. */
#pragma omp for schedule(static)
      for (pw_idx k = b->colour_start[c]; k < b->colour_start[c + 1]; k++) {
        fn(ctx, b->colour_block[k]);
      }
    }
  }
}

/* Lists [first, last) of the division, with a barrier between them. */
static void run_shared(const pw_blocks *b, int threads, const pw_idx *list, pw_block_fn fn,
                       void *ctx)
{
#pragma omp parallel default(none) shared(b, list, fn, ctx) num_threads(threads)
  {
    /* The runtime may give fewer threads than asked for: then some run several shares. */
    const int own = omp_get_thread_num(), step = omp_get_num_threads();
    for (pw_idx c = list[0]; c < list[1]; c++) {
      for (int t = own; t < b->nthread; t += step) {
        const pw_idx *start = b->share_start + (pw_off)c * b->nthread + t;
        for (pw_idx k = start[0]; k < start[1]; k++) {
          fn(ctx, b->share_block[k]);
        }
      }
      if (c + 1 < list[1]) {
#pragma omp barrier
      }
    }
  }
}

void pw_assemble_coloured(const pw_blocks *b, int threads, pw_block_fn fn, void *ctx)
{
  if (b->nthread > 0) {
    run_shared(b, threads, (const pw_idx[]){0, b->ncolour}, fn, ctx);
  } else {
    run_equal(b, threads, fn, ctx);
  }
}

void pw_for_blocks(const pw_blocks *b, int threads, pw_block_fn fn, void *ctx)
{
  if (b->nthread > 0) {
    run_shared(b, threads, (const pw_idx[]){b->ncolour, b->ncolour + 1}, fn, ctx);
  } else {
    run_equal(b, threads, fn, ctx);
  }
}
