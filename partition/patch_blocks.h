/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file partition/patch_blocks.h
 * @brief Blocks of whole patches of tetrahedra, and their colours (layer 2).
 *
 * METIS divides the graph of patches that share a face, so that what couples the elements of a
 * patch never crosses a block. Blocks that share a node have different colours. In the pw_blocks
 * made here "elements" are patches, cells and reach have no meaning, and no points are sorted:
 * pw_assemble_coloured(), pw_for_blocks() and partition/share.h take them as they are.
 */
#ifndef PW_PARTITION_PATCH_BLOCKS_H
#define PW_PARTITION_PATCH_BLOCKS_H

#include "partition/blocks.h"
#include "partition/tets.h"

/**
 * @brief Divide and colour patches of @p per elements each: patch p holds elements per * p ...
 * @param[in] weight    [nelem / per] work of a patch, >= 0; NULL: all equal
 * @param[in] per_block patches a block should hold, >= 1
 * @return PW_OK; PW_ERR_ARGUMENT; PW_ERR_MEMORY; PW_ERR_SOLVER when METIS fails.
 */
pw_status pw_patch_blocks_create(const pw_tets *t, pw_idx per, const pw_idx *weight,
                                 pw_idx per_block, pw_blocks *out);

/**
 * @brief Verify by looking at every node that no two blocks of a colour share it.
 * @return PW_OK; PW_ERR_ARGUMENT naming node and blocks.
 */
pw_status pw_patch_blocks_check(const pw_tets *t, pw_idx per, const pw_blocks *b);

#endif /* PW_PARTITION_PATCH_BLOCKS_H */
