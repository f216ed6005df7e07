/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/schedule.h
 * @brief The flat list of hooks a scene's effects put into a step (layer 3).
 */
#ifndef PW_ENGINE_SCHEDULE_H
#define PW_ENGINE_SCHEDULE_H

#include "engine/sim_state.h"

/** @brief Sort the hooks of the scene's effects by stage, then by engine/effects.def, then by
 *  their place in the scene. Contexts must have been created. */
void pw_schedule_build(pw_sim *sim);

#endif /* PW_ENGINE_SCHEDULE_H */
