/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/check_equilibrium.h
 * @brief How near to rest a scene with initial stresses starts, for `pilewright check` (layer 4).
 */
#ifndef PW_IO_CHECK_EQUILIBRIUM_H
#define PW_IO_CHECK_EQUILIBRIUM_H

#include <stdio.h>

#include "engine/sim.h"

/**
 * @brief Make up to 50 steps and print the largest force left at a free node in the first of them,
 *        and how far points that started under stress have drifted: displacement, speed, stress.
 *
 * All loads of the scene act, so a scene that strikes or pushes at once drifts by that. Does
 * nothing for a scene without initial_stress, and stops quietly where a step fails.
 * @return PW_OK; PW_ERR_MEMORY.
 */
pw_status pw_check_equilibrium(pw_sim *sim, FILE *out);

#endif /* PW_IO_CHECK_EQUILIBRIUM_H */
