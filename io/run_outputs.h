/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/run_outputs.h
 * @brief The files a run keeps writing: history, ParaView, pictures, checkpoint (layer 4).
 *
 * What cannot be had or drawn (VTK, gnuplot) becomes a warning and the run goes on; what cannot
 * be written fails the run. A checkpoint is written after everything else of its step, so that a
 * run that goes on from it repeats nothing and misses nothing.
 */
#ifndef PW_IO_RUN_OUTPUTS_H
#define PW_IO_RUN_OUTPUTS_H

#include "io/history.h"
#include "io/output_times.h"
#include "io/run_folder.h"
#include "io/run_job.h"

enum { PW_WARNINGS = 16, PW_WARNING_TEXT = 512 };

typedef struct pw_run_outputs {
  const pw_run_folder *folder;
  const pw_job *job;
  const pw_scene *scene; /**< as read: times of outputs */
  pw_history *history;
  pw_snapshots *snapshots;   /**< NULL: none wanted, or built without VTK */
  pw_real checkpoint_wall_s; /**< wall clock of the last checkpoint */
  pw_off checkpoint_step;    /**< step of the last checkpoint; -1: none yet */
  pw_record header;          /**< names of the history's columns */
  pw_record row;             /**< scratch */
  int nwarning;
  const char *warning[PW_WARNINGS]; /**< into text */
  char text[PW_WARNINGS][PW_WARNING_TEXT];
} pw_run_outputs;

/**
 * @brief Ask a new simulation for the names of its history, before a checkpoint is loaded: asking
 *        for a row ends the interval over which effects take means.
 * @return PW_OK; PW_ERR_SCENE: more columns or results than there is room for.
 */
pw_status pw_run_outputs_prepare(pw_run_outputs *o, const pw_job *job, const pw_scene *scene);

/**
 * @brief Open the files of a run at its start, or, when @p resumed, those of the run whose
 *        checkpoint was loaded into its simulation. At the start the state at t = 0 is written.
 * @return PW_OK; PW_ERR_FILE; PW_ERR_MEMORY.
 */
pw_status pw_run_outputs_open(pw_run_outputs *o, const pw_run_folder *folder, bool resumed);

/** @brief Write what is due after a step that began at @p old_s; also a checkpoint when the last
 *  one is older than half a minute of wall clock. @return PW_OK; PW_ERR_FILE; PW_ERR_MEMORY. */
pw_status pw_run_outputs_step(pw_run_outputs *o, pw_real old_s);

/** @brief Write a checkpoint of the present step, unless there is one.
 *  @return PW_OK; PW_ERR_FILE. */
pw_status pw_run_outputs_checkpoint(pw_run_outputs *o);

/** @brief At the end of a finished run: pictures of the curves. @return as above. */
pw_status pw_run_outputs_finish(pw_run_outputs *o);

/** @brief Note a warning (once) for the summary and the person; ignored when there are too many. */
void pw_run_outputs_warn(pw_run_outputs *o, const char *text);

/** @brief Note what the simulation warns of. */
void pw_run_outputs_collect(pw_run_outputs *o);

/** @brief Close all files; a zeroed struct is accepted. @return PW_OK; PW_ERR_FILE. */
pw_status pw_run_outputs_close(pw_run_outputs *o);

#endif /* PW_IO_RUN_OUTPUTS_H */
