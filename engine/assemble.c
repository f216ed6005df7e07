/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/assemble.h"

void pw_assemble_coloured(const pw_blocks *b, int threads, pw_block_fn fn, void *ctx)
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

void pw_for_blocks(const pw_blocks *b, int threads, pw_block_fn fn, void *ctx)
{
#pragma omp parallel for default(none) shared(b, fn, ctx) num_threads(threads) schedule(static)
  for (pw_idx k = 0; k < b->nblock; k++) {
    fn(ctx, k);
  }
}
