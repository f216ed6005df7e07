/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file partition/share.h
 * @brief Which thread runs which block (layer 2).
 *
 * Sums at a node come in the order of colour, block and point whoever runs a block, so a division
 * changes times and never results. There are two: one of each colour, for scatters, and one of all
 * blocks, for loops over points without colours. Both keep a block with the thread of its
 * neighbours where they can, because nodes and points that stay with a thread stay in its cache.
 */
#ifndef PW_PARTITION_SHARE_H
#define PW_PARTITION_SHARE_H

#include "partition/blocks.h"

/**
 * @brief Memory for a division of @p b, whose elements and colours are set, among @p threads, freed
 *        by pw_blocks_destroy().
 *
 * Until pw_share_balance() is called there is no division (b->nthread is 0).
 * @return PW_OK; PW_ERR_MEMORY.
 */
pw_status pw_share_create(pw_blocks *b, int threads);

/** @brief The same blocks, their arrays borrowed, without a division and room for one. */
pw_blocks pw_share_undivided(const pw_blocks *b);

/** @brief Free it; blocks without it are accepted. */
void pw_share_destroy(pw_blocks *b);

/**
 * @brief Divide each colour by b->share_size and all blocks by b->share_work, which the caller has
 *        set; blocks of size 0 belong to nobody and are left out.
 *
 * The blocks in their order along the longer side of the grid, cut into parts of equal share_work,
 * give each a thread to begin with, the same for every colour and for all blocks; thread 0 gets the
 * last part, the top of the grid or its right, because it also runs what is not divided, which is
 * mostly at piles. So threads hold regions of the grid, and points and nodes stay in the cache of
 * one processor from pass to pass: a line that comes from another takes 40 ns where two share a
 * cache and 225 where they do not (measured). Then blocks are moved and exchanged as long as that
 * relieves the busiest thread, a block costing more the farther it lies from its thread's part
 * (share.c), which leaves none more than the mean and one block, the bound of any list schedule
 * (Graham 1969, "Bounds on multiprocessing timing anomalies"). With several threads small blocks
 * close to the borders, a tenth of a list's work at most, are left to whoever is free first: a
 * processor that is taken away for a while, or a block that costs more than counted, then holds up
 * the others less, and what changes hands lies at the border. Without a grid (cells 0) nothing is
 * far. Allocates nothing.
 */
void pw_share_balance(pw_blocks *b);

/**
 * @brief Bounds on the speed-up that a division leaves, on a quiet machine without overhead.
 * @param[in]  threads  taken as long as there is no division: bounds of equal numbers of blocks
 * @param[out] coloured sum of size / sum over colours of the largest share
 * @param[out] plain    sum of work / the largest share
 */
void pw_share_bound(const pw_blocks *b, int threads, pw_real *coloured, pw_real *plain);

/**
 * @brief The bound on coloured passes that @p threads would have if nothing were far: what the
 *        colours allow.
 * @param[in] size [nblock] work of each block; @p b may have a division, which is left alone
 * @return PW_OK; PW_ERR_MEMORY.
 */
pw_status pw_share_plan(const pw_blocks *b, int threads, const pw_off *size, pw_real *coloured);

#endif /* PW_PARTITION_SHARE_H */
