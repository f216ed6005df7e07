/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/assemble.h"

#include <omp.h>

/* Without a division: equal numbers of blocks. */
static void run_equal(const pw_blocks *b, pw_idx first, pw_idx last, const pw_pass *pass, void *ctx)
{
  for (pw_idx c = first; c < last; c++) {
    const bool all = c == b->ncolour;
    const pw_idx start = all ? 0 : b->colour_start[c];
    const pw_idx end = all ? b->nblock : b->colour_start[c + 1];
    /* The implicit barrier at the end of the loop separates the colours. */
#pragma omp for schedule(static)
    for (pw_idx k = start; k < end; k++) {
      pass->block(ctx, all ? k : b->colour_block[k]);
    }
  }
}

/* Lists [first, last) of the division: the thread's own blocks, then those for whoever is free.
 * The barrier at the end of the loop separates the colours. */
static void run_shared(const pw_blocks *b, pw_idx first, pw_idx last, const pw_pass *pass,
                       void *ctx)
{
  /* The runtime may give fewer threads than asked for: then some run several shares. */
  const int own = omp_get_thread_num(), step = omp_get_num_threads(), nt = b->nthread;
  for (pw_idx c = first; c < last; c++) {
    const pw_idx *start = b->share_start + (pw_off)c * (nt + 1);
    for (int t = own; t < nt; t += step) {
      for (pw_idx k = start[t]; k < start[t + 1]; k++) {
        pass->block(ctx, b->share_block[k]);
      }
    }
    const pw_idx tail = start[nt], end = start[nt + 1];
#pragma omp for schedule(dynamic, 1)
    for (pw_idx k = tail; k < end; k++) {
      pass->block(ctx, b->share_block[k]);
    }
  }
}

void pw_assemble_pass(const pw_blocks *b, int threads, const pw_pass *pass, void *ctx)
{
  const pw_idx first = pass->any_order ? b->ncolour : 0;
  const pw_idx last = pass->any_order ? b->ncolour + 1 : b->ncolour;
#pragma omp parallel default(none) shared(b, first, last, pass, ctx) num_threads(threads)
  {
    const int part = omp_get_thread_num(), parts = omp_get_num_threads();
    if (pass->before) {
      pass->before(ctx, part, parts);
#pragma omp barrier
    }
    if (b->nthread > 0) {
      run_shared(b, first, last, pass, ctx);
    } else {
      run_equal(b, first, last, pass, ctx);
    }
    if (pass->after) {
      pass->after(ctx, part, parts);
    }
  }
}

void pw_assemble_coloured(const pw_blocks *b, int threads, pw_block_fn fn, void *ctx)
{
  pw_assemble_pass(b, threads, &(pw_pass){.block = fn}, ctx);
}

void pw_for_blocks(const pw_blocks *b, int threads, pw_block_fn fn, void *ctx)
{
  pw_assemble_pass(b, threads, &(pw_pass){.block = fn, .any_order = true}, ctx);
}

void pw_for_parts(int threads, pw_part_fn fn, void *ctx)
{
#pragma omp parallel default(none) shared(fn, ctx) num_threads(threads)
  fn(ctx, omp_get_thread_num(), omp_get_num_threads());
}

void pw_for_listed(const pw_idx *list, pw_idx n, int threads, pw_block_fn fn, void *ctx)
{
#pragma omp parallel for default(none) shared(list, n, fn, ctx) num_threads(threads)               \
    schedule(dynamic, 1)
  for (pw_idx k = 0; k < n; k++) {
    fn(ctx, list[k]);
  }
}
