/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/umat.h
 * @brief Shared libraries with Abaqus UMATs: loading, guarded calls (layer 3).
 *
 * A library stays loaded to the end of the process. Beside the routine itself it may call what
 * Abaqus offers its user routines, as far as listed in pw_umat_utilities (engine/umat_utilities.c);
 * the program must export them (ENABLE_EXPORTS), as it does the exits of the Fortran runtime, so
 * that STOP ends the call and not the program.
 */
#ifndef PW_ENGINE_UMAT_H
#define PW_ENGINE_UMAT_H

#include "kernels/umat.h"

/**
 * @brief Load the routine that the parameters of a material `umat` name, once; to be called from
 *        one thread, while nothing steps.
 * @return PW_OK; PW_ERR_SCENE with the key in front when there is no such library or symbol.
 */
pw_status pw_umat_load(const pw_real *param);

/** @brief Call a routine; as pw_umat.call. */
const char *pw_umat_call_guarded(const pw_umat *u, pw_umat_call *c);

/** @brief Leave the call that this thread is in; its caller gets "the UMAT @p why: @p text" with
 *  the first @p length characters of @p text. Does not return. */
_Noreturn void pw_umat_give_up(const char *why, const char *text, size_t length);

/** @brief Locks of all calls and of the texts of failures; made with the first library. */
void pw_umat_locks_create(void);
void pw_umat_enter(void);
void pw_umat_leave(void);

/** Routines of Abaqus that a library may call, for messages. */
extern const char pw_umat_utilities[];

#endif /* PW_ENGINE_UMAT_H */
