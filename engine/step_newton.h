/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/step_newton.h
 * @brief Quasi-static load steps by Newton's method, halved where they do not converge (layer 3).
 *
 * A load step runs from t = 0 to t = 1. Every part of it from t0 to t1 is a step of its own: points
 * find their elements, u is solved for, points move, and the mesh is put back or moved. Points that
 * have changed elements leave forces R0 out of balance that no smaller step would reduce; where a
 * step is cut they are released in proportion, so that a part solves
 *
 *   f_int(u) - f_ext(t1) = (1 - alpha) R0,   R0 = f_int(0) - f_ext(t0),  alpha = (t1 - t0)/(1 - t0),
 *
 * and the last part, with alpha = 1, restores balance.
 *
 * The residual is the norm of what is left at free components over the norm of reactions and
 * external forces together, as AMPLE does (Coombs, Augarde, Adv. Engng Software 142 (2020) 102748).
 * Strains smaller than about 1e-6 leave more than a small tolerance allows, by rounding alone: an
 * estimate of that (pw_tet_model.rounding) counts as converged too.
 */
#ifndef PW_ENGINE_STEP_NEWTON_H
#define PW_ENGINE_STEP_NEWTON_H

#include "engine/solver.h"
#include "engine/tet_model.h"

enum { PW_NEWTON_HISTORY = 64 }; /**< residuals kept of a part */

/** How to iterate. */
typedef struct pw_newton_options {
  pw_real tolerance;  /**< of the residual; 1e-9 */
  int max_iterations; /**< of a part, at most PW_NEWTON_HISTORY; 20 */
  int max_cuts;       /**< halvings of a part in a row; 10 */
  bool from_previous; /**< start from the increment before, scaled, where that converged */
} pw_newton_options;

/** @brief The values named above. */
pw_newton_options pw_newton_defaults(void);

/** Load of a step. */
typedef struct pw_newton_load {
  void *ctx;
  /** @brief Fill model->prescribed for the part from t0 to t1, and model->external at t1. */
  void (*apply)(void *ctx, pw_tet_model *model, pw_real t0, pw_real t1);
  /** @brief Move the mesh to where it belongs at t1; NULL: it is put back. @return PW_OK or what
   *  ends the run. */
  pw_status (*move)(void *ctx, pw_tet_model *model, pw_real t1);
} pw_newton_load;

/** What a load step took. */
typedef struct pw_newton_report {
  int parts;      /**< converged parts: 1 without cuts */
  int cuts;       /**< failures that halved a part */
  int iterations; /**< solutions of all parts, failed ones too */
  int count;      /**< residuals of the last part, those of a failed part after a failure */
  pw_real residual[PW_NEWTON_HISTORY];
  pw_status last; /**< why the last cut was made, or PW_OK */
} pw_newton_report;

typedef struct pw_newton pw_newton;

/**
 * @brief A driver for @p model (borrowed). Nothing may be fixed or freed after the first step but
 *        between load steps.
 * @return PW_OK; PW_ERR_ARGUMENT for options out of range; PW_ERR_MEMORY.
 */
pw_status pw_newton_create(pw_tet_model *model, const pw_newton_options *options, pw_newton **out);

/** @brief Free; NULL is accepted. */
void pw_newton_destroy(pw_newton **n);

/**
 * @brief One load step.
 * @param[out] report filled whatever happens
 * @return PW_OK; PW_RETRY_DIVERGED when a part fails max_cuts times in a row, with the residuals in
 *         the error record: the model stands at the end of its last converged part;
 *         PW_ERR_POINT_LOST, PW_ERR_SOLVER, PW_ERR_MEMORY, or what load->move gives.
 */
pw_status pw_newton_step(pw_newton *n, const pw_newton_load *load, pw_newton_report *report);

/** @brief Displacement of the nodes over the last part [3][nnode]; m. */
const pw_real *pw_newton_displacement(const pw_newton *n);

/** @brief The solver, for its counts. */
const pw_solver *pw_newton_solver(const pw_newton *n);

#endif /* PW_ENGINE_STEP_NEWTON_H */
