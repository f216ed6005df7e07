/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/restart.h
 * @brief Checkpoints: the whole state in an HDF5 file, bit for bit (layer 4).
 *
 * The state's own walk (engine/core/archive.h) names the arrays; "points/stress" becomes dataset
 * `stress` of group `points`, contiguous, 64-bit IEEE reals or 32- and 64-bit integers, little
 * endian. Root attributes: format_version, program_version, title, time_s, step, datasets. The
 * file holds no clock time: equal states give equal bytes. It is built in memory and replaces the
 * old one at once (io/atomic_file.h), so that a failed or interrupted write leaves the previous
 * checkpoint whole; it needs as much memory as the file is long while it is written.
 */
#ifndef PW_IO_RESTART_H
#define PW_IO_RESTART_H

#include "engine/core/archive.h"
#include "engine/sim.h"

/** What a checkpoint says of itself. */
typedef struct pw_restart_stamp {
  char title[PW_NAME]; /**< of the scene */
  pw_real time_s;
  pw_off step;
} pw_restart_stamp;

/** Walks the state of @p ctx through the calls of @p ar. */
typedef pw_status (*pw_archive_walk)(pw_archive *ar, void *ctx);

/**
 * @brief Write the checkpoint @p path of @p sim.
 * @return PW_OK; PW_ERR_FILE with path and reason: the previous file is untouched; what the walk
 *         returns.
 */
pw_status pw_restart_write(const char *path, pw_sim *sim);

/**
 * @brief Load the checkpoint @p path into @p sim, which was created from the same scene.
 * @return PW_OK; PW_ERR_FILE when the file is missing, not a checkpoint, incomplete, of another
 *         format version, or does not hold exactly the arrays of this scene: @p sim is then not
 *         to be continued.
 */
pw_status pw_restart_read(const char *path, pw_sim *sim);

/** @brief Read only what the checkpoint says of itself. @return PW_OK; PW_ERR_FILE. */
pw_status pw_restart_peek(const char *path, pw_restart_stamp *out);

/** @brief Write any state that has a walk. @return as pw_restart_write. */
pw_status pw_archive_write(const char *path, const pw_restart_stamp *stamp, pw_archive_walk walk,
                           void *ctx);

/** @brief Load any state that has a walk. @return as pw_restart_read. */
pw_status pw_archive_read(const char *path, pw_archive_walk walk, void *ctx);

#endif /* PW_IO_RESTART_H */
