/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/step_explicit.h
 * @brief One explicit step: MUSL (thesis section 2.5), USL or USF (layer 3).
 *
 * MUSL: S. Giridharan, master thesis, University of Stuttgart 2016, eq. 2.13-2.19; USL and USF:
 * Bardenhagen, J. Comput. Phys. 180 (2002).
 */
#ifndef PW_ENGINE_STEP_EXPLICIT_H
#define PW_ENGINE_STEP_EXPLICIT_H

#include "engine/sim_state.h"

/** @brief Advance @p sim by sim->dt. @return the first status that is not PW_OK. */
pw_status pw_step_explicit(pw_sim *sim);

#endif /* PW_ENGINE_STEP_EXPLICIT_H */
