/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/quad_inertia.h
 * @brief Newmark's method on the grid, for implicit steps with the effect dynamics (layer 3).
 *
 * As engine/tet_inertia.h, with lumped masses and rates that go with the points: with v0 and a0 the
 * means of the points' velocities and accelerations at a node, weighted by mass and shape function,
 *
 *   a = (u - dt v0) / (beta dt2) - (1 / (2 beta) - 1) a0,   v = v0 + dt ((1 - gamma) a0 + gamma a);
 *
 * the force of inertia is M (a + alpha v), and afterwards a point adds the mean of v - v0 at its
 * place to its velocity and takes its acceleration from there. Components that are held move evenly:
 * points get no change of velocity from them, as in explicit steps.
 */
#ifndef PW_ENGINE_QUAD_INERTIA_H
#define PW_ENGINE_QUAD_INERTIA_H

#include "engine/core/status.h"
#include "kernels/transfer.h"

typedef struct pw_quad_model pw_quad_model;

typedef struct pw_quad_inertia {
  bool on;
  bool still; /**< set while forces without inertia are asked for */
  pw_real beta, gamma, damping;
  pw_real *v0, *a0; /**< [2][nnode] at the start of the part; m/s, m/s2 */
  pw_real *v, *a;   /**< [2][nnode] at its end, for the displacement last asked for */
  pw_real *force;   /**< [2][nnode] inertia and damping; N (per radian) */
  pw_real *rec;     /**< [nnode][PW_NODE] masses and accelerations of points, scattered */
} pw_quad_inertia;

/** @brief Memory where the scene has the effect. @return PW_OK; PW_ERR_MEMORY. */
pw_status pw_quad_inertia_create(pw_quad_model *m);
void pw_quad_inertia_destroy(pw_quad_inertia *q);

/** @brief Scatter the accelerations of a block's points. */
void pw_quad_inertia_scatter(pw_quad_model *m, pw_idx block);

/** @brief v0 and a0 from what has been scattered. */
void pw_quad_inertia_begin(pw_quad_model *m);

/** @brief Accelerations of the points before the first part, from the balance of m->external and
 *  m->force. */
void pw_quad_inertia_start(pw_quad_model *m);

/** @brief Inertia for @p u [2][nnode] and, when asked for, its part of the tangent. */
void pw_quad_inertia_add(pw_quad_model *m, const pw_real *u, bool tangent);

/** @brief Point @p i with its weights @p s takes over. @return its kinetic energy; J (per radian) */
pw_real pw_quad_inertia_commit(pw_quad_model *m, const pw_support *s, pw_idx i);

#endif /* PW_ENGINE_QUAD_INERTIA_H */
