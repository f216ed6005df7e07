/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/ranges.h
 * @brief What follows from the points each block holds: which thread runs it, and which nodal
 *        records are in use (layer 3).
 */
#ifndef PW_ENGINE_RANGES_H
#define PW_ENGINE_RANGES_H

#include "engine/sim_state.h"

/**
 * @brief After a change of blocks.point_start, so after a sort and after loading a checkpoint.
 *
 * Clears the sums of blocks without points, which no pass visits; puts in use the records within
 * reach of the points of each field; divides the blocks among the threads. Between steps, or before
 * nodes are cleared.
 */
void pw_ranges_renew(pw_sim *sim);

/**
 * @brief Divide the blocks anew by their points and by the evaluations of the material in the last
 *        step: counts, not times, so that a run is the same each time it is made.
 */
void pw_ranges_balance(pw_sim *sim);

/** @brief Put in use, in @p nodes, the records within reach of the points of a block. */
void pw_ranges_use(const pw_sim *sim, pw_idx block, pw_nodes *nodes);

#endif /* PW_ENGINE_RANGES_H */
