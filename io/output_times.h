/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/output_times.h
 * @brief When a run writes what, as pure functions of simulated time (layer 4).
 *
 * The times of a series are k * every, k = 0, 1, ...; which ones are past follows from the time
 * alone, so an interrupted run that goes on meets the same times with the same step lengths.
 * Histories, snapshots and pictures are met exactly (a step is cut short for them); checkpoints
 * are written at the first step past their time and never change the steps. Steps are cut short
 * for snapshots and pictures that are switched off too, so that switching them changes no result.
 */
#ifndef PW_IO_OUTPUT_TIMES_H
#define PW_IO_OUTPUT_TIMES_H

#include "engine/scene.h"

/** What falls due at the end of a step. */
typedef struct pw_due {
  bool history, snapshot, picture, checkpoint;
  bool end; /**< the run has reached time.end_s */
} pw_due;

/** @brief Which time of a series was met last: the largest whole k with k * every_s <= time_s, to
 *  1e-9 of a period. every_s > 0. */
pw_real pw_series_index(pw_real every_s, pw_real time_s);

/** @brief The next time after @p time_s that a step must meet exactly, at most time.end_s; s. */
pw_real pw_output_next(const pw_scene *scene, pw_real time_s);

/** @brief What is due after a step from @p old_s to @p new_s; old_s < 0 asks for what is due at
 *  the start. The end makes a history row, a snapshot and pictures due in any case. A
 *  period of 0 stands for every step (history), the start and the end (snapshots) and none
 *  (checkpoints). */
pw_due pw_output_due(const pw_scene *scene, pw_real old_s, pw_real new_s);

/** @brief Decimals that tell the times of all pictures of a run apart, in seconds: 3 at least. */
int pw_picture_decimals(const pw_scene *scene);

#endif /* PW_IO_OUTPUT_TIMES_H */
