/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/update.h
 * @brief The passes over blocks of points that make up a step (layer 3).
 *
 * Each pass runs one pw_block_fn over all blocks (engine/assemble.h). Points are visited body by
 * body, so that each body's points scatter to and gather from its own velocity field.
 */
#ifndef PW_ENGINE_UPDATE_H
#define PW_ENGINE_UPDATE_H

#include "engine/sim_state.h"

/** What the last pass of a step does with the gathered velocities. */
typedef struct pw_update_pass {
  pw_sim *sim;
  int slot;    /**< velocity slot to gather from */
  bool move;   /**< move the points */
  bool stress; /**< deform them and update their stress */
} pw_update_pass;

/** @brief Scatter mass, momentum and internal force. @p ctx is a pw_sim. */
void pw_block_p2g(void *ctx, pw_idx block);

/** @brief Scatter mass and momentum only. @p ctx is a pw_sim. */
void pw_block_p2g_momentum(void *ctx, pw_idx block);

/** @brief Gather velocity increments into the points. @p ctx is a pw_sim. */
void pw_block_velocity(void *ctx, pw_idx block);

/** @brief The same, then scatter the updated momentum (MUSL): coloured. @p ctx is a pw_sim. */
void pw_block_velocity_remap(void *ctx, pw_idx block);

/** @brief Gather gradients; move, deform and stress the points; renew domains and weights.
 *  @p ctx is a pw_update_pass. Failures go to sim->sums[block]. */
void pw_block_update(void *ctx, pw_idx block);

/** @brief Locate the vertices of a block's points. @p ctx is a pw_sim. */
void pw_block_weights(void *ctx, pw_idx block);

/** @brief Evaluate wave speeds with a zero increment, before the first step. @p ctx: pw_sim. */
void pw_block_wave_speed(void *ctx, pw_idx block);

/** @brief Add the blocks' sums up in block order and find the next stable step.
 *  @return PW_OK, or the status of the first failing point with its description. */
pw_status pw_update_collect(pw_sim *sim);

/** @brief Only look for failing or lost points, and for points that left their blocks.
 *  @return PW_OK, or the status of the first failing point with its description. */
pw_status pw_update_check(pw_sim *sim);

/**
 * @brief Close the books of a step, and stop a run whose energy balance shows more energy than
 *        was ever supplied at the end of two steps running: the mark of steps beyond the
 *        stability limit.
 * @return PW_OK; PW_RETRY_DIVERGED.
 */
pw_status pw_update_energy(pw_sim *sim);

/** @brief Sort points into their blocks and locate their vertices anew.
 *  @return PW_OK; PW_ERR_POINT_LOST. */
pw_status pw_update_sort(pw_sim *sim);

#endif /* PW_ENGINE_UPDATE_H */
