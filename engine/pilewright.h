/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/pilewright.h
 * @brief The public interface of libpilewright in one header (layer 5).
 *
 * Load a scene (pw_scene_read_file, or fill a pw_scene by hand), create a simulation, step it and
 * read its fields:
 *
 *     pw_scene scene;
 *     pw_sim *sim = NULL;
 *     char *messages = NULL;
 *     pw_status s = pw_scene_read_file("pile.yaml", 0, NULL, &scene, &messages);
 *     if (s == PW_OK) { s = pw_sim_create(&scene, 0, &sim); }
 *     while (s == PW_OK && pw_sim_time(sim) < scene.time.end_s) { s = pw_sim_step(sim, 0.0); }
 *     const pw_real *stress = s == PW_OK ? pw_sim_points(sim)->stress : NULL;
 *     pw_sim_destroy(&sim);
 *     free(messages);
 *
 * or let pw_run() do what the command `pilewright run` does.
 */
#ifndef PW_ENGINE_PILEWRIGHT_H
#define PW_ENGINE_PILEWRIGHT_H

#include "engine/implicit.h"
#include "engine/scene.h"
#include "engine/sim.h"
#include "io/check_report.h"
#include "io/history.h"
#include "io/keys.h"
#include "io/pictures.h"
#include "io/restart.h"
#include "io/run.h"
#include "io/run_job.h"
#include "io/scene_file.h"
#include "io/snapshot.h"
#include "io/solid_check.h"
#include "io/solid_mesh.h"
#include "io/solid_pictures.h"
#include "io/solid_snapshot.h"
#include "io/summary.h"

#endif /* PW_ENGINE_PILEWRIGHT_H */
