/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/sim.h
 * @brief The public interface of the engine: create a simulation, step it, read it (layer 3).
 */
#ifndef PW_ENGINE_SIM_H
#define PW_ENGINE_SIM_H

#include "engine/core/archive.h"
#include "engine/core/record.h"
#include "engine/mesh.h"
#include "engine/points.h"
#include "engine/scene.h"

typedef struct pw_sim pw_sim; /**< opaque to its users; engine/sim_state.h for effects */

/** Stages whose wall time is kept, in the order of the step. */
typedef enum pw_timer {
  PW_TIMER_SORT,
  PW_TIMER_P2G,
  PW_TIMER_NODES,
  PW_TIMER_EFFECTS,
  PW_TIMER_REMAP,
  PW_TIMER_G2P_STRESS,
  PW_TIMER_COUNT
} pw_timer;

/** Energies since the start, whole body (per metre in plane strain); J. */
typedef struct pw_energy {
  pw_real kinetic;     /**< now */
  pw_real strain_work; /**< work of stresses, stored and dissipated in the soil */
  pw_real external;    /**< work of gravity, loads, hammer, prescribed motion */
  pw_real contact;     /**< dissipated by friction and by grid contact */
  pw_real spring;      /**< stored in penalty springs now */
  pw_real damping;     /**< dissipated by local damping */
  pw_real absorbed;    /**< by absorbing boundaries */
  pw_real initial;     /**< kinetic at the start */
} pw_energy;

/** What a run can be asked at any time. */
typedef struct pw_report {
  int threads;
  pw_idx points, nodes, elements, blocks, colours;
  pw_off steps;
  pw_real time_s, dt_s;       /**< dt_s: the next step */
  pw_real dt_min_s, dt_max_s; /**< over the steps made; 0 before the first */
  pw_real stage_wall_s[PW_TIMER_COUNT];
  pw_real wall_s; /**< spent in pw_sim_step */
  pw_off bytes_per_point;
  pw_real bound_scatter, bound_gather; /**< most that the threads can be faster than one, by the
                                            division of the blocks (partition/share.h) */
  pw_energy energy;
  pw_off point_updates; /**< steps times points, less what method.step_ratio_max leaves out */
  pw_off sorts, domains_limited, domains_rebuilt, domains_reshaped, vertices_clamped;
  pw_material_counts material;
} pw_report;

/**
 * @brief Build everything a run needs; allocates all memory of the run.
 * @param[in] scene   copied
 * @param[in] threads OpenMP threads, 0: the runtime's choice
 * @return PW_OK; PW_ERR_SCENE, PW_ERR_MEMORY, PW_ERR_SOLVER, PW_ERR_UNSUPPORTED.
 */
pw_status pw_sim_create(const pw_scene *scene, int threads, pw_sim **out);

/** @brief Free and null; NULL is accepted. */
void pw_sim_destroy(pw_sim **sim);

/**
 * @brief One step of at most @p dt_limit seconds (0: no limit besides the stable step); what is left
 *        to the limit is divided evenly when less than two steps remain. An implicit step
 *        (engine/step_implicit.h) has its own length, whatever the limit.
 * @return PW_OK; PW_RETRY_* or PW_ERR_POINT_LOST with point, position, material, step and time in
 *         the error text: the state is then that of a failed step and not to be continued.
 */
pw_status pw_sim_step(pw_sim *sim, pw_real dt_limit);

pw_real pw_sim_time(const pw_sim *sim);
pw_off pw_sim_steps(const pw_sim *sim);
const pw_scene *pw_sim_scene(const pw_sim *sim);
const pw_mesh *pw_sim_mesh(const pw_sim *sim);
const pw_points *pw_sim_points(const pw_sim *sim);

/** @brief Fill @p out. */
void pw_sim_report(const pw_sim *sim, pw_report *out);

/** @brief Columns of history.csv: time, step, energies, each body's centre of mass, effects'.
 *  Contact forces are means since the last call, so a call between those of the run loop changes
 *  the next row. */
void pw_sim_history(const pw_sim *sim, pw_record *row);

/** @brief Items of summary.json's `results`. */
void pw_sim_results(const pw_sim *sim, pw_record *out);

/** @brief Save or load the whole state; after loading the run goes on bitwise as if never
 *  interrupted. @return as the archive's calls; PW_ERR_FILE when it belongs to another scene. */
pw_status pw_sim_archive(pw_sim *sim, pw_archive *ar);

/** @brief Names of the hooks in the order they run, one per line, into @p text. */
void pw_sim_schedule_text(const pw_sim *sim, char *text, size_t size);

/** @brief Outline of the pile or interface for pictures: up to @p max points of polyline @p i.
 *  @param[out] xy [2 * max] x, y pairs; m
 *  @return points written; 0 when there is no such polyline. */
int pw_sim_outline(const pw_sim *sim, int i, pw_real *xy, int max);

/** @brief As pw_sim_outline(), of body @p b where it is a structure; 0 for a body of points. */
int pw_sim_structure_outline(const pw_sim *sim, int b, pw_real *xy, int max);

#endif /* PW_ENGINE_SIM_H */
