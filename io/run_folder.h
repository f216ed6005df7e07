/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/run_folder.h
 * @brief The output folder of a run: its name, what it holds, clearing it (layer 4).
 */
#ifndef PW_IO_RUN_FOLDER_H
#define PW_IO_RUN_FOLDER_H

#include "io/atomic_file.h"

/** Paths of what a run writes. */
typedef struct pw_run_folder {
  char path[PW_PATH];
  char summary[PW_PATH], history[PW_PATH], checkpoint[PW_PATH];
  char pictures[PW_PATH], paraview[PW_PATH]; /**< folders */
} pw_run_folder;

/**
 * @brief Fill the paths; nothing is touched on the disk.
 * @param[in] path  the folder, or NULL: out/NAME, where NAME is the scene file's name without its
 *                  ending, and its folder's name when that is "scene"
 * @param[in] scene_file used when @p path is NULL
 * @return PW_OK; PW_ERR_FILE when a path is too long.
 */
pw_status pw_run_folder_name(const char *path, const char *scene_file, pw_run_folder *out);

/** @brief True when the folder holds a summary or a checkpoint. */
bool pw_run_folder_holds_run(const pw_run_folder *f);

/** @brief True when the folder holds a checkpoint. */
bool pw_run_folder_holds_checkpoint(const pw_run_folder *f);

/** @brief True when the folder's summary tells of a finished run. */
bool pw_run_folder_finished(const pw_run_folder *f);

/**
 * @brief Make the folder and keep other runs out of it as long as @p lock is open. The lock goes
 *        with the process, however it ends.
 * @param[out] lock file descriptor to close at the end; -1 when the file system knows no locks
 * @return PW_OK; PW_ERR_INTERRUPTED when another run is at work there; PW_ERR_FILE.
 */
pw_status pw_run_folder_lock(const pw_run_folder *f, int *lock);

/**
 * @brief Remove what an earlier run wrote: summary, history, checkpoint, pictures, ParaView files.
 *        Other files stay.
 * @return PW_OK; PW_ERR_FILE with path and reason.
 */
pw_status pw_run_folder_clear(const pw_run_folder *f);

#endif /* PW_IO_RUN_FOLDER_H */
