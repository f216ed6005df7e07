/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/assemble.h
 * @brief The one threaded loop over blocks, coloured for scatters (layer 3).
 */
#ifndef PW_ENGINE_ASSEMBLE_H
#define PW_ENGINE_ASSEMBLE_H

#include "partition/share.h"

/** Work on one block; must not fail: failures go into the block's own sums. */
typedef void (*pw_block_fn)(void *ctx, pw_idx block);

/** Work on part @p part of @p parts of something, by the thread of that number. */
typedef void (*pw_part_fn)(void *ctx, int part, int parts);

/** A loop over blocks with what its threads do before and after it, in one parallel region. */
typedef struct pw_pass {
  pw_part_fn before; /**< finished by all before the first block; or NULL */
  pw_block_fn block;
  pw_part_fn after; /**< begun when all blocks are done; or NULL */
  bool any_order;   /**< blocks write to points only: no colours */
} pw_pass;

/**
 * @brief Call @p fn for every block, colour after colour; blocks of a colour run at the same time.
 *
 * Once the blocks are divided (pw_share_balance), each thread runs its own, then what is left for
 * whoever is free, and blocks without points are left out; before that all are run, an equal number
 * by each thread.
 * Within a colour no two blocks share a node of their supports, so @p fn may add to the nodes of
 * its block's support without atomics, and additions at a node always come in the same order.
 */
void pw_assemble_coloured(const pw_blocks *b, int threads, pw_block_fn fn, void *ctx);

/** @brief One of the two loops with work before and after it; saves the start of further parallel regions. */
void pw_assemble_pass(const pw_blocks *b, int threads, const pw_pass *pass, void *ctx);

/** @brief Call @p fn for the same blocks in any order: for loops that write to points only. */
void pw_for_blocks(const pw_blocks *b, int threads, pw_block_fn fn, void *ctx);

/** @brief Call @p fn once on each thread with its part. */
void pw_for_parts(int threads, pw_part_fn fn, void *ctx);

/** @brief Call @p fn for the blocks of a list [n], each by whoever is free: for few of them, whose work
 *  is not that by which the blocks are divided, and that write to points or to the block's own. */
void pw_for_listed(const pw_idx *list, pw_idx n, int threads, pw_block_fn fn, void *ctx);

#endif /* PW_ENGINE_ASSEMBLE_H */
