/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/main.h
 * @brief Parts of the program `pilewright` (layer 5: may use everything).
 */
#ifndef PW_ENGINE_MAIN_H
#define PW_ENGINE_MAIN_H

#include "engine/core/types.h"

/**
 * @brief Bind the OpenMP threads of a run to cores.
 *
 * The OpenMP runtime reads its settings when the program is loaded, so the program starts itself
 * once more with OMP_PROC_BIND and OMP_PLACES set. It does not when the user has set one of them,
 * when there is one thread only, when the cores cannot be told apart, or when the run leaves half
 * of the processors or more to others: bound runs side by side would end up on the same cores.
 * @param[in] argv    of main()
 * @param[in] threads asked for; 0: the runtime's choice
 * @return true when threads are bound.
 */
bool pw_main_bind_threads(char **argv, int threads);

/** @brief The word that getopt_long() has just called unknown: a long option as it stands, or the
 *  letter with its dash. Overwritten by the next call. */
const char *pw_main_unknown(char *const *argv);

/** @brief The command `element`. @return its exit status. */
int pw_main_element(int argc, char **argv);

/** @brief Help of the program, or of @p command when it names one. @return NULL when it names
 *  none. */
const char *pw_main_help(const char *command);

#endif /* PW_ENGINE_MAIN_H */
