/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/step_newton.h
 * @brief Load steps by Newton's method, quasi-static or dynamic, halved where they do not converge
 *        (layer 3).
 *
 * A load step runs from t = 0 to t = 1. Every part of it from t0 to t1 is a step of its own: points
 * find their elements, u is solved for, points move, and the mesh is put back or moved. Points that
 * have changed elements leave forces R0 out of balance that no smaller step would reduce; where a
 * step is cut they are released in proportion, so that a part solves
 *
 *   f_int(u) - f_ext(t1) = (1 - alpha) R0,   R0 = f_int(0) - f_ext(t0),  alpha = (t1 - t0)/(1 - t0),
 *
 * and the last part, with alpha = 1, restores balance. In a dynamic step inertia takes R0 up.
 *
 * A part that does not converge is cut where the mesh moves along. Where the mesh is put back it is
 * first approached: the same equations are solved for s = 1/2, 1/4, ... of its load, each from the
 * solution before, until s = 1. Nothing is committed on the way, so the result is that of the part in
 * one piece. Only when that fails too is the part cut. A cut
 * puts the mesh back in between, which changes what a driven boundary is tied to unless the mesh
 * moves along: without load->move a part whose nodes are driven is not cut unless asked for.
 *
 * An iteration takes the whole of its correction where that takes a fifth off the slope of the potential
 * along it or half off the residual, else shorter parts (line_search). Tangents are exact: residuals
 * fall as their squares but for the forces of points that change between elastic and plastic over an
 * iteration (tests/test_implicit_cases_converge_quadratically.c).
 *
 * The residual is the norm of what is left at free components over the norm of reactions, external
 * forces and inertia together, as AMPLE does (Coombs, Augarde, Adv. Engng Software 142 (2020)
 * 102748). Strains smaller than about 1e-6 leave more than a small tolerance allows, by rounding
 * alone: an estimate of that (pw_tet_model.rounding) counts as converged too.
 */
#ifndef PW_ENGINE_STEP_NEWTON_H
#define PW_ENGINE_STEP_NEWTON_H

#include "engine/newton_system.h"
#include "engine/solver.h"
#include "engine/tet_inertia.h"
#include "engine/tet_mechanism.h"
#include "engine/tet_model.h"

enum { PW_NEWTON_HISTORY = 64 }; /**< residuals kept of a part */

/** How to iterate. */
typedef struct pw_newton_options {
  pw_real tolerance;    /**< of the residual; 1e-9 */
  int max_iterations;   /**< of a part, at most PW_NEWTON_HISTORY; 20 */
  int max_cuts;         /**< halvings of a part in a row; 10 */
  bool from_previous;   /**< start from the increment before, scaled and turned with the mesh, where
                                 that converged */
  int approach;         /**< halvings of the way to a part that fails; 0: cut at once; 4 */
  int line_search;      /**< parts of a correction to try, the whole one first, after which the
                                 step counts as failed; 0: the whole one, whatever it leaves; 4 */
  bool cut_driven;      /**< cut also where nodes are driven and the mesh is put back */
  pw_real volume_limit; /**< a part in which an element with points changes its volume by more
                                 than this factor counts as failed; 10 */
  pw_mechanisms mechanisms; /**< what to do about pieces that nothing holds; quasi-static; warn */
  pw_newmark newmark;       /**< dynamics; off */
  pw_solver_engine solver;  /**< of the linear systems; automatic */
} pw_newton_options;

/** @brief The values named above. */
pw_newton_options pw_newton_defaults(void);

struct pw_scene_implicit;

/** @brief Those that the section `implicit` of a scene gives. */
pw_newton_options pw_newton_options_of(const struct pw_scene_implicit *p);

/** Load of a step. @p model is that of pw_newton_create(), NULL for another system. */
typedef struct pw_newton_load {
  void *ctx;
  pw_real start_s; /**< time at t = 0; s */
  pw_real step_s;  /**< from there to t = 1, for materials that know time and for dynamics, which
                        must have it; 0: 1 s; s */
  /** @brief Fill model->prescribed for the part from t0 to t1, and model->external at t1. */
  void (*apply)(void *ctx, pw_tet_model *model, pw_real t0, pw_real t1);
  /** @brief Look at a part that has converged at t1, forces and points as they are then, the mesh not
   *  yet moved; may be NULL. */
  void (*converged)(void *ctx, pw_tet_model *model, pw_real t1);
  /** @brief Move the mesh to where it belongs at t1; NULL: it is put back. @return PW_OK or what
   *  ends the run. */
  pw_status (*move)(void *ctx, pw_tet_model *model, pw_real t1);
} pw_newton_load;

/** What a load step took. */
typedef struct pw_newton_report {
  int parts;      /**< converged parts: 1 without cuts */
  int cuts;       /**< failures that halved a part */
  int approaches; /**< parts that were approached */
  int searches;   /**< parts of corrections that have not helped */
  int iterations; /**< solutions of all parts, failed ones too */
  int count;      /**< residuals of the last part, those of a failed part after a failure */
  pw_real residual[PW_NEWTON_HISTORY];
  pw_status last;                 /**< why the last cut was made, or PW_OK */
  pw_mechanism_report mechanisms; /**< of the last part; zero when not looked for */
} pw_newton_report;

typedef struct pw_newton pw_newton;

/**
 * @brief A driver for @p model (borrowed). Nothing may be fixed or freed after the first step but
 *        between load steps.
 * @return PW_OK; PW_ERR_ARGUMENT for options out of range; PW_ERR_MEMORY.
 */
pw_status pw_newton_create(pw_tet_model *model, const pw_newton_options *options, pw_newton **out);

/**
 * @brief The same for another system, quasi-static and without a search for mechanisms.
 * @return likewise; PW_ERR_ARGUMENT where one of the two is asked for.
 */
pw_status pw_newton_create_for(const pw_newton_system *system, const pw_newton_options *options,
                               pw_newton **out);

/** @brief Free; NULL is accepted. */
void pw_newton_destroy(pw_newton **n);

/**
 * @brief One load step.
 * @param[out] report filled whatever happens
 * @return PW_OK; PW_RETRY_DIVERGED when a part fails max_cuts times in a row or may not be cut, with
 *         the residuals in the error record: the model stands at the end of its last converged part;
 *         PW_ERR_POINT_LOST, PW_ERR_SOLVER, PW_ERR_MEMORY, or what load->move gives; PW_ERR_SCENE
 *         for a free mechanism where those are errors, and for loads on nodes left out;
 *         PW_ERR_ARGUMENT for dynamics without step_s.
 */
pw_status pw_newton_step(pw_newton *n, const pw_newton_load *load, pw_newton_report *report);

/** A load over time, in steps whose size follows the work they make. */
typedef struct pw_newton_course {
  void *ctx;
  /** @brief As in pw_newton_load, between two times in s. */
  void (*apply)(void *ctx, pw_tet_model *model, pw_real from, pw_real to);
  pw_status (*move)(void *ctx, pw_tet_model *model, pw_real to); /**< or NULL */
  pw_real now, end;                                              /**< s; now is moved on */
  pw_real size;                                                  /**< of the next step; s */
  pw_real least, most;                                           /**< bounds of size; s */
  int easy, hard;       /**< iterations: up to easy the next step grows, from hard on it shrinks */
  pw_real grow, shrink; /**< factors; 1.5 and 0.5 */
} pw_newton_course;

/** @brief The rule of pw_newton_advance(): size after a step that took what @p report says. A step
 *  that was cut or approached is hard. */
pw_real pw_newton_next_size(const pw_newton_course *c, pw_real size,
                            const pw_newton_report *report);

/**
 * @brief One load step of c->size, or what is left to the end; then c->now and c->size are moved on.
 * @return as pw_newton_step(); after a failure c is as it was.
 */
pw_status pw_newton_advance(pw_newton *n, pw_newton_course *c, pw_newton_report *report);

/** Somebody who looks at every iterate. */
typedef struct pw_newton_watcher {
  void *ctx;
  /** @brief Look at the displacements @p u [dofs] over the part and what they leave, @p residual;
   *  forces of the system and trial states of its points are those of u. NULL: nobody. */
  void (*look)(void *ctx, const pw_real *u, pw_real residual);
} pw_newton_watcher;

/** @brief From now on show every iterate to @p watcher, those of failed parts and of approaches too. */
void pw_newton_watch(pw_newton *n, pw_newton_watcher watcher);

/** @brief Displacement of the nodes over the last part [dofs] of the system, [3][nnode]; m. */
const pw_real *pw_newton_displacement(const pw_newton *n);

/** @brief Rates of the nodes, or NULL when quasi-static. */
pw_tet_rates *pw_newton_rates(pw_newton *n);

/** @brief The solver, for its counts. */
const pw_solver *pw_newton_solver(const pw_newton *n);

#endif /* PW_ENGINE_STEP_NEWTON_H */
