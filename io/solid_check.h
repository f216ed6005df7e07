/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/solid_check.h
 * @brief What `pilewright check` says of a solid scene before it is run (layer 4).
 */
#ifndef PW_IO_SOLID_CHECK_H
#define PW_IO_SOLID_CHECK_H

#include <stdio.h>

#include "engine/implicit.h"

/**
 * @brief Print effects, bodies, sizes of mesh and matrix, the solver, memory, and an estimate of
 *        the time, for which one assembly, factorisation and solution at the start are timed; then
 *        warnings. No step is made.
 * @return PW_OK; PW_RETRY_DIVERGED where the tangent cannot be factored, PW_ERR_SCENE for pieces
 *         that nothing holds where those are errors, or what else would end the first step.
 */
pw_status pw_solid_check_report(pw_implicit *sim, FILE *out);

#endif /* PW_IO_SOLID_CHECK_H */
