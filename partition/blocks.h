/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file partition/blocks.h
 * @brief Blocks of elements, their colours, and the ranges of points each block owns (layer 2).
 *
 * Elements of a structured grid are grouped into compact blocks by METIS (k-way, fixed seed) on
 * the face-neighbour graph, weighted by the points they hold at set-up. The support of a block is
 * every node within `reach` cells of its elements. Two blocks whose supports share a node
 * conflict; conflicting blocks have different colours, so blocks of one colour may scatter at the
 * same time, and the order of additions at a node (colour, block, point) never depends on threads.
 */
#ifndef PW_PARTITION_BLOCKS_H
#define PW_PARTITION_BLOCKS_H

#include "engine/core/status.h"

typedef struct pw_blocks {
  pw_idx nblock, nelem;
  pw_idx cells[2];    /**< cells of the grid along x and y */
  pw_idx reach;       /**< cells of halo in the support */
  pw_idx *elem_block; /**< [nelem] block of an element */
  pw_idx *elem_start; /**< [nblock + 1] offsets into elem */
  pw_idx *elem;       /**< [nelem] elements by block, ascending in each */
  pw_idx ncolour;
  pw_idx *colour;       /**< [nblock] */
  pw_idx *colour_start; /**< [ncolour + 1] offsets into colour_block */
  pw_idx *colour_block; /**< [nblock] blocks by colour, ascending in each */
  int nbody;
  pw_idx *point_start; /**< [nblock * nbody + 1] points of (block, body): set by pw_blocks_sort */
  int nthread;         /**< threads the blocks are divided among (partition/share.h); 0: none yet */
  int share_room;      /**< threads there is room for */
  pw_idx *share_start; /**< [(ncolour + 1) * (nthread + 1) + 1] offsets into share_block, by colour
                          and thread, last those for whoever is free; those of list ncolour divide
                          all blocks without colours */
  pw_idx *share_block; /**< [2 nblock] */
  pw_off *share_size;  /**< [nblock] work of a block in a coloured pass, >= 0: its points */
  pw_off *share_work;  /**< [nblock] work of a block in the passes without colours, >= 0 */
  pw_idx *share_line;  /**< [nblock] blocks along the longer side of the grid */
  pw_real *share_place, *share_border; /**< [nblock] scratch of the division, like the next three */
  pw_idx *share_owner, *share_order;   /**< [nblock] */
  pw_real *share_sum;                  /**< [share_room] */
} pw_blocks;

/**
 * @brief Partition and colour a grid of cells[0] x cells[1] elements.
 * @param[in] weight  [nelem] work of an element (its points), >= 0; NULL: all equal
 * @param[in] per_block elements a block should hold, >= 1
 * @param[in] reach   cells of halo, >= 0
 * @param[in] nbody   bodies (>= 1) among which a block's points are divided
 * @return PW_OK; PW_ERR_ARGUMENT; PW_ERR_MEMORY; PW_ERR_SOLVER when METIS fails.
 */
pw_status pw_blocks_create(const pw_idx *cells, const pw_idx *weight, pw_idx per_block,
                           pw_idx reach, int nbody, pw_blocks *out);

/**
 * @brief The same with blocks of a size that can be divided evenly: of a few sizes from
 *        pw_blocks_choose_size() on the one whose coloured passes lose least on 2 and 4 threads
 *        (pw_share_plan()), barriers counted; a larger one has to be better by 2 %.
 *
 * Counted from @p weight, never timed: the same on every machine and for any number of threads.
 */
pw_status pw_blocks_create_even(const pw_idx *cells, const pw_idx *weight, pw_idx reach, int nbody,
                                pw_blocks *out);

/** @brief Free; a zeroed struct is accepted. */
void pw_blocks_destroy(pw_blocks *b);

/**
 * @brief Elements per block that give enough blocks to keep a few threads busy: see blocks.c.
 *
 * Chosen from @p nelem alone, for a nominal machine of 4 threads; @p threads is not used, so that
 * blocks, order of additions and results are bitwise the same on any number of threads.
 * @return between 8 and 256.
 */
pw_idx pw_blocks_choose_size(pw_idx nelem, int threads);

/**
 * @brief Counting sort of points by (block of their element, body), stable in their present order.
 * @param[in]  elem [n] element of each point, each in [0, nelem)
 * @param[in]  body [n] in [0, nbody)
 * @param[out] from [n] new point i is old point from[i]; point_start is renewed
 *
 * Allocates nothing; serial, in a time proportional to n + nblock * nbody.
 * @return true when from is not the identity.
 */
bool pw_blocks_sort(pw_blocks *b, pw_idx n, const pw_idx *elem, const pw_idx *body, pw_idx *from);

/**
 * @brief Verify the colouring against a brute-force walk over supports.
 * @return PW_OK; PW_ERR_ARGUMENT naming two blocks of one colour that share a node, or a block
 *         listed under another colour than its own; PW_ERR_MEMORY.
 */
pw_status pw_blocks_check(const pw_blocks *b);

#endif /* PW_PARTITION_BLOCKS_H */
