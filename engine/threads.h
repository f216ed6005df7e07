/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/threads.h
 * @brief How many threads OpenMP takes unless it is told (layer 3).
 *
 * Libraries may change it behind the program's back; the one who calls them puts it back.
 */
#ifndef PW_ENGINE_THREADS_H
#define PW_ENGINE_THREADS_H

/** @brief Threads of a parallel region without a number of its own. */
int pw_threads_default(void);

/** @brief Change it to @p threads >= 1. */
void pw_threads_set_default(int threads);

#endif /* PW_ENGINE_THREADS_H */
