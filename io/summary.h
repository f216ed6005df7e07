/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/summary.h
 * @brief What a run was and gave: summary.json (layer 4).
 */
#ifndef PW_IO_SUMMARY_H
#define PW_IO_SUMMARY_H

#include "engine/implicit.h"
#include "engine/sim.h"

/** What the run loop knows and the engine does not; all texts borrowed. */
typedef struct pw_summary_info {
  const char *status;     /**< "finished", "stopped" or "failed" */
  const char *error;      /**< message of a failed run, or NULL */
  const char *scene_file; /**< as given to the program; NULL: that of the scene */
  pw_off first_step;      /**< step this process started from: 0, or the checkpoint's; wall
                                    times count from there */
  int nwarning;
  const char *const *warning; /**< [nwarning] */
} pw_summary_info;

/**
 * @brief Write summary.json for @p sim to @p path, replacing an old one at once. Numbers that are
 *        not finite become null.
 * @return PW_OK; PW_ERR_FILE with path and reason; PW_ERR_MEMORY.
 */
pw_status pw_summary_write(const char *path, const pw_sim *sim, const pw_summary_info *info);

/** @brief The same from its parts, for callers that keep them. @return as pw_summary_write. */
pw_status pw_summary_write_parts(const char *path, const pw_scene *scene, const pw_report *report,
                                 const pw_record *results, const pw_summary_info *info);

/** @brief The same of an implicit simulation. @return likewise. */
pw_status pw_summary_write_implicit(const char *path, const pw_implicit *sim,
                                    const pw_summary_info *info);

/** @brief Version of the program, "0.1.0". */
const char *pw_version(void);

/** @brief Revision of the source the program was built from, "unknown" outside a repository. */
const char *pw_git_revision(void);

#endif /* PW_IO_SUMMARY_H */
