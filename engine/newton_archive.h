/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/newton_archive.h
 * @brief What a Newton driver keeps from step to step, for checkpoints (layer 3).
 */
#ifndef PW_ENGINE_NEWTON_ARCHIVE_H
#define PW_ENGINE_NEWTON_ARCHIVE_H

#include "engine/core/archive.h"
#include "engine/step_newton.h"

/** @brief Save or load it between load steps. @return as the archive's calls. */
pw_status pw_newton_archive(pw_newton *n, pw_archive *ar);

/** @brief Keep no factor of an earlier step: a step then depends on what is archived alone. */
void pw_newton_forget(pw_newton *n);

#endif /* PW_ENGINE_NEWTON_ARCHIVE_H */
