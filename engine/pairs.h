/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/pairs.h
 * @brief Rows of the fine zone taken in pairs far from it (grid.paired_rows_x_m; layer 3).
 *
 * A grid that is a product of two axes carries its thin rows out to the far boundary, where nothing
 * needs them. Beyond a column the nodes between the two rows of a pair hang on those below and
 * above: their velocity is the mean, so the cells there are two rows high and the functions on the
 * whole grid a part of those of the fine one: linear fields are kept, no gaps open, and points may be
 * as large as those cells. Scatters and gathers do not know of it. What they gave to a hanging node
 * goes in halves to the nodes it hangs on, the transpose of the mean, which keeps mass, momentum and
 * the power of the forces. Constraints of this kind: e.g. Carey, Oden, Finite Elements: A Second Course
 * (1983), on hanging nodes.
 */
#ifndef PW_ENGINE_PAIRS_H
#define PW_ENGINE_PAIRS_H

#include "engine/sim_state.h"

/** @brief Whether the scene asks for pairs. */
static inline bool pw_pairs_on(const pw_sim *sim)
{
  return sim->mesh.pair_column < sim->mesh.cells[0];
}

/** @brief After a sort: the nodes of the pairs are in use. */
void pw_pairs_use(pw_sim *sim);

/** @brief Slots [@p slot, @p slot + @p n) of hanging nodes go in halves to the nodes they hang on. */
void pw_pairs_collect(pw_sim *sim, int slot, int n);

/** @brief Hanging nodes take the mean of the same slots of the nodes they hang on. */
void pw_pairs_spread(pw_sim *sim, int slot, int n);

#endif /* PW_ENGINE_PAIRS_H */
