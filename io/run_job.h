/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/run_job.h
 * @brief What a run does with a simulation, whichever half of the engine it belongs to (layer 4).
 *
 * The run loop and its outputs (io/run.c, io/run_outputs.c) speak to explicit simulations of plane
 * and axisymmetric scenes and to implicit ones of solid scenes through these functions alone.
 */
#ifndef PW_IO_RUN_JOB_H
#define PW_IO_RUN_JOB_H

#include <stdio.h>

#include "engine/core/record.h"
#include "engine/scene.h"
#include "io/restart.h"
#include "io/snapshot.h"
#include "io/summary.h"

/** How far a simulation is. */
typedef struct pw_job_state {
  pw_real time_s;
  pw_off steps;
  pw_idx points;
  pw_real wall_s; /**< spent in steps */
} pw_job_state;

/** A half of the engine; constant. @p sim is what create() gave. */
typedef struct pw_job_kind {
  /** @brief @return PW_OK; PW_ERR_SCENE and PW_ERR_ARGUMENT blame the scene, others the run. */
  pw_status (*create)(const pw_scene *scene, int threads, void **sim);
  void (*destroy)(void **sim);
  pw_status (*step)(void *sim, pw_real limit_s);
  void (*state)(const void *sim, pw_job_state *out);
  void (*history)(const void *sim, pw_record *row);
  void (*results)(const void *sim, pw_record *out);
  pw_archive_walk archive;
  pw_status (*summary)(const char *path, const void *sim, const pw_summary_info *info);
  /** @brief A line of sizes: points, elements, blocks, threads. */
  void (*print_sizes)(const void *sim, bool bound, FILE *out);
  /** @brief What `pilewright check` says. @return PW_OK, or what would end the first step. */
  pw_status (*check)(void *sim, FILE *out);
  pw_status (*snapshot)(pw_snapshots *s, const void *sim);
  pw_status (*last_snapshot)(pw_snapshots *s, const void *sim); /**< besides that; or NULL */
  pw_status (*pictures)(const char *folder, const void *sim);
  /** @brief Things noticed so far that a person should know; or NULL.
   *  @return the @p i-th, NULL past the last. */
  const char *(*warning)(const void *sim, int i);
} pw_job_kind;

typedef struct pw_job {
  const pw_job_kind *kind;
  void *sim;
} pw_job;

/** @brief The half that runs scenes of this geometry. */
const pw_job_kind *pw_job_kind_of(const pw_scene *scene);

extern const pw_job_kind pw_job_explicit; /**< io/run_explicit.c */
extern const pw_job_kind pw_job_implicit; /**< io/run_implicit.c */

#endif /* PW_IO_RUN_JOB_H */
