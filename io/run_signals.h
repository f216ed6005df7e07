/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/run_signals.h
 * @brief Asks a run to stop after its step when the process is told to end (layer 4).
 */
#ifndef PW_IO_RUN_SIGNALS_H
#define PW_IO_RUN_SIGNALS_H

#include "engine/core/types.h"

/**
 * @brief From now on SIGINT, SIGTERM and SIGHUP (unless ignored, as under nohup) are only noted, once
 *        each; the next one has its usual effect. SIGPIPE and SIGXFSZ are ignored, so that a
 *        closed pipe or a file size limit is seen as a failed write.
 */
void pw_run_signals_catch(void);

/** @brief True when the process was told to end. */
bool pw_run_signals_stop(void);

/** @brief Put the handlers found by pw_run_signals_catch() back. */
void pw_run_signals_restore(void);

#endif /* PW_IO_RUN_SIGNALS_H */
