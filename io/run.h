/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/run.h
 * @brief A whole run: scene file in, output folder out (layer 4).
 *
 * Interrupted by SIGINT, SIGTERM or SIGHUP the run finishes its step, writes a checkpoint and
 * ends; a second signal ends it at once, which the next resume survives as it does a kill.
 */
#ifndef PW_IO_RUN_H
#define PW_IO_RUN_H

#include <stdio.h>

#include "engine/core/types.h"

/** Exit status of the program. */
typedef enum pw_exit {
  PW_EXIT_FINISHED = 0,
  PW_EXIT_USAGE = 1,     /**< wrong command line, or an output folder that holds a run */
  PW_EXIT_SCENE = 2,     /**< bad scene or other input; nothing was written */
  PW_EXIT_FAILED = 3,    /**< the run failed; its last good checkpoint is kept */
  PW_EXIT_STOPPED = 130, /**< interrupted, checkpoint written */
} pw_exit;

/** What the command line asks for; all texts borrowed. */
typedef struct pw_run_options {
  const char *scene_file;
  const char *out; /**< output folder; NULL: out/NAME of the scene */
  int threads;     /**< 0: the runtime's choice */
  int nset;
  const char *const *set; /**< [nset] "key.path=value" */
  bool resume, force, quiet;
  bool bound; /**< threads are bound to cores: for the log line only */
} pw_run_options;

/**
 * @brief Run a scene.
 * @param[in] out progress and results; only the last line when options->quiet
 * @param[in] err messages of what went wrong
 */
pw_exit pw_run(const pw_run_options *options, FILE *out, FILE *err);

#endif /* PW_IO_RUN_H */
