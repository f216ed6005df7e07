/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/progress.h
 * @brief How far a run is and how long it still takes, for a person to read (layer 4).
 *
 * On a terminal: one line with a bar, redrawn at most five times a second and cut to the width of
 * the window. Otherwise: a plain line every 5 % of simulated time or every 10 s, what is sooner.
 */
#ifndef PW_IO_PROGRESS_H
#define PW_IO_PROGRESS_H

#include <stdio.h>

#include "engine/core/types.h"

typedef struct pw_progress {
  FILE *file;    /**< NULL: show nothing */
  bool terminal; /**< a bar, else plain lines */
  bool drawn;    /**< a bar stands on the last line */
  pw_idx points;
  pw_real end_s, first_s, shown_s; /**< simulated time: end, at the start, when last shown */
  pw_off first_step;
  pw_real wall_first_s, wall_shown_s; /**< wall clock: at the start, when last shown */
  pw_real rate; /**< smoothed simulated seconds per second of wall clock; 0: not known */
} pw_progress;

/** @brief Wall clock that never goes back; s */
pw_real pw_wall_clock(void);

/** @brief Write @p seconds as "42 s", "3 min 08 s" or "2 h 05 min". @return @p text */
const char *pw_duration_text(pw_real seconds, char *text, size_t size);

/** @brief Start at simulated time @p time_s and step @p step; @p file may be NULL. */
void pw_progress_start(pw_progress *p, FILE *file, pw_real end_s, pw_idx points, pw_real time_s,
                       pw_off step);

/** @brief After a step; cheap when nothing is to be shown yet. @param[in] dt_s of that step */
void pw_progress_step(pw_progress *p, pw_real time_s, pw_off step, pw_real dt_s);

/** @brief Take the bar away, so that other lines can be printed. */
void pw_progress_clear(pw_progress *p);

/** @brief Point-steps per second of wall clock since the start; 1/s */
pw_real pw_progress_speed(const pw_progress *p, pw_off step);

#endif /* PW_IO_PROGRESS_H */
