/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/check_report.h
 * @brief What `pilewright check` says of a scene before it is run (layer 4).
 */
#ifndef PW_IO_CHECK_REPORT_H
#define PW_IO_CHECK_REPORT_H

#include <stdio.h>

#include "engine/sim.h"

/**
 * @brief Print effects with their hooks, fields and bytes per point, sizes, blocks, the first
 *        stable step, and estimates of steps, memory and time.
 *
 * The time is estimated without a step: the two passes over the points that change nothing (weights,
 * stress for a zero increment) are timed, and what a whole step takes more is known as a multiple
 * of them. Scenes with initial stresses then show how near to rest they start
 * (io/check_equilibrium.h), for which @p sim makes steps: it is not to be used for anything else
 * afterwards.
 */
void pw_check_report(pw_sim *sim, FILE *out);

#endif /* PW_IO_CHECK_REPORT_H */
