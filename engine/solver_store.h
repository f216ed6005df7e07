/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/solver_store.h
 * @brief Large blocks of memory that SuiteSparse gives back are kept for its next call (layer 3, of
 *        the solver's files).
 *
 * A factorisation takes a few blocks of megabytes and returns them. The system would hand out new
 * pages each time and clear them, which takes a quarter of the time of a factorisation of 20,000
 * equations. SuiteSparse has one set of functions for the whole process: so has this. Like the
 * solvers it serves, it is to be used by one thread at a time.
 */
#ifndef PW_ENGINE_SOLVER_STORE_H
#define PW_ENGINE_SOLVER_STORE_H

/** @brief Begin to serve SuiteSparse; calls nest. */
void pw_solver_store_open(void);

/** @brief End the last pw_solver_store_open(); the last of all returns what is kept. */
void pw_solver_store_close(void);

#endif /* PW_ENGINE_SOLVER_STORE_H */
