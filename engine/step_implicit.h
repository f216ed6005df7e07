/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/step_implicit.h
 * @brief Load steps, quasi-static or dynamic, of plane and axisymmetric scenes by Newton's method (layer 3).
 *
 * A scene whose method.update is implicit takes such steps in place of explicit ones: same points,
 * blocks, bases and materials, and of the effects those that have hooks for them. Without the effect
 * dynamics (engine/quad_inertia.h) time only says where ramps are: there is no inertia and points
 * keep a velocity of zero. The records of nodes tell displacement over time. Loads act with their
 * value at the end of a step; work done by them is that value times the displacement.
 */
#ifndef PW_ENGINE_STEP_IMPLICIT_H
#define PW_ENGINE_STEP_IMPLICIT_H

#include "engine/quad_model.h"
#include "engine/step_newton.h"

/** What implicit steps keep. */
typedef struct pw_quad_steps {
  pw_quad_model model;
  pw_newton *newton;
  pw_newton_report report; /**< of the last step */
  pw_off iterations, cuts, parts, equations;
  pw_real start, length; /**< of the step at hand; s */
  pw_real wanted;        /**< of the next one, adaptive; in load steps */
  pw_status status;      /**< what a hook gave where Newton's method cannot be told */
} pw_quad_steps;

/** @brief Where the scene asks for implicit steps, what they need in sim->quad. @return PW_OK;
 *  PW_ERR_MEMORY, PW_ERR_SOLVER, PW_ERR_UNSUPPORTED. */
pw_status pw_quad_steps_create(pw_sim *sim);

/** @brief Free; without them nothing is done. */
void pw_quad_steps_destroy(pw_sim *sim);

/**
 * @brief One load step of time.end_s over implicit.steps seconds, adaptive ones of their own length.
 * @return PW_OK; PW_RETRY_DIVERGED with the residuals in the error text, PW_ERR_POINT_LOST and the
 *         like: the state is then not to be continued.
 */
pw_status pw_step_implicit(pw_sim *sim);

/** @brief Iterations, cuts, residual and equations of the last step, for history.csv. */
void pw_quad_steps_history(const pw_sim *sim, pw_record *row);

/** @brief The same since the beginning, for summary.json. */
void pw_quad_steps_results(const pw_sim *sim, pw_record *out);

/** @brief Save or load what steps depend on; without them nothing is done. @return as the archive's
 *  calls. */
pw_status pw_quad_steps_archive(pw_sim *sim, pw_archive *ar);

#endif /* PW_ENGINE_STEP_IMPLICIT_H */
