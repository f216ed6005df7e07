/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/implicit.h
 * @brief The implicit half: create a simulation of a solid scene, step it, read it (layer 3).
 *
 *     pw_scene scene;                                  // of geometry solid: pw_scene_read_file()
 *     pw_solid_mesh mesh = {0};                        // pw_solid_mesh_load() of io/solid_mesh.h
 *     pw_implicit *sim = NULL;
 *     pw_status s = pw_implicit_create(&scene, &mesh, 0, &sim);
 *     while (s == PW_OK && pw_implicit_time(sim) < pw_implicit_scene(sim)->time.end_s) {
 *       s = pw_implicit_step(sim);
 *     }
 *
 * A load step is a Newton iteration, halved where it does not converge (engine/step_newton.h). What
 * holds, drives and loads the body are effects of the scene (engine/solid_effects.def).
 */
#ifndef PW_ENGINE_IMPLICIT_H
#define PW_ENGINE_IMPLICIT_H

#include "engine/core/archive.h"
#include "engine/core/record.h"
#include "engine/solid_mesh.h"
#include "engine/step_newton.h"

typedef struct pw_implicit pw_implicit; /**< opaque to its users; engine/implicit_state.h */

/** What a run can be asked at any time. */
typedef struct pw_implicit_report {
  int threads;
  pw_idx points, nodes, cells, elements, blocks, colours;
  pw_off steps;
  pw_real time_s;
  pw_off iterations, cuts, parts; /**< since the beginning of the run */
  pw_walk_counts walked;          /**< likewise */
  pw_idx equations;               /**< of the last step */
  pw_off nonzeros;                /**< of its matrix */
  pw_solver_counts solver;        /**< since this simulation was created */
  const char *solver_text;        /**< libraries in use */
  pw_real residual;               /**< at the end of the last step */
  pw_real wall_s;                 /**< spent in pw_implicit_step */
  pw_off bytes_per_point;
} pw_implicit_report;

/**
 * @brief Build everything a run needs; allocates all memory of the run but that of the solver.
 * @param[in] scene   copied
 * @param[in] mesh    copied
 * @param[in] threads OpenMP threads, 0: the runtime's choice
 * @return PW_OK; PW_ERR_SCENE, the text beginning with the path of the key at fault where there is
 *         one; PW_ERR_MEMORY, PW_ERR_SOLVER, PW_ERR_UNSUPPORTED.
 */
pw_status pw_implicit_create(const pw_scene *scene, const pw_solid_mesh *mesh, int threads,
                             pw_implicit **out);

/** @brief Free and null; NULL is accepted. */
void pw_implicit_destroy(pw_implicit **sim);

/**
 * @brief One load step; of an adaptive scene a step of its own length, which ends @p limit_s (0: the
 *        end of the run) from now at the latest.
 * @return PW_OK; PW_RETRY_DIVERGED with the residuals in the error text, PW_ERR_POINT_LOST and the
 *         like: the state is then not that of the end of a step and not to be continued.
 */
pw_status pw_implicit_advance(pw_implicit *sim, pw_real limit_s);

/** @brief The same without a limit. @return likewise. */
pw_status pw_implicit_step(pw_implicit *sim);

pw_real pw_implicit_time(const pw_implicit *sim);
pw_off pw_implicit_steps(const pw_implicit *sim);
const pw_scene *pw_implicit_scene(const pw_implicit *sim);
const pw_tet_model *pw_implicit_model(const pw_implicit *sim);

/** @brief What the last load step took. */
const pw_newton_report *pw_implicit_newton(const pw_implicit *sim);

/** @brief Displacement of the nodes over the last part of the last load step [3][nnode]; m. */
const pw_real *pw_implicit_displacement(const pw_implicit *sim);

/** @brief Fill @p out. */
void pw_implicit_report_now(const pw_implicit *sim, pw_implicit_report *out);

/** @brief Columns of history.csv: time, step, the iteration, then effects'. */
void pw_implicit_history(const pw_implicit *sim, pw_record *row);

/** @brief Items of summary.json's `results`. */
void pw_implicit_results(const pw_implicit *sim, pw_record *out);

/** @brief Mean of the normal Cauchy stresses of a point; Pa. */
pw_real pw_tet_points_mean_stress(const pw_tet_points *p, pw_idx point);

/** @brief Von Mises stress sqrt(3 J2) of a point, of its Cauchy stress; Pa. */
pw_real pw_tet_points_von_mises(const pw_tet_points *p, pw_idx point);

/** @brief Things noticed so far that a person should know. @return the @p i-th, NULL past the last;
 *  owned by the simulation. */
const char *pw_implicit_warning(const pw_implicit *sim, int i);

/** @brief Save or load the whole state; after loading the run goes on bitwise as if never
 *  interrupted. @return as the archive's calls; PW_ERR_FILE when it belongs to another scene. */
pw_status pw_implicit_archive(pw_implicit *sim, pw_archive *ar);

#endif /* PW_ENGINE_IMPLICIT_H */
