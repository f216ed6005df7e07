/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/tet_loads.h
 * @brief Masses, gravity and initial stress of an implicit simulation (layer 3).
 *
 * A point keeps its mass m = rho0 V0. The weight at node a is sum m g N_a(x), N_a the shape
 * function at the point where the step starts: in an updated Lagrangian step points and nodes move
 * together, so that it does not change within the step.
 */
#ifndef PW_ENGINE_TET_LOADS_H
#define PW_ENGINE_TET_LOADS_H

#include "engine/tet_model.h"

/** Stress of a point at the start. @param[in] x [3] m @param[in] body its material
 *  @param[out] stress [6] Cauchy stress, xx yy zz xy yz zx; Pa */
typedef void (*pw_tet_stress_fn)(void *ctx, const pw_real *x, pw_idx body, pw_real *stress);

/** @brief Shape functions [4] of a point in its parent, where the mesh is now. */
void pw_tet_model_shape(const pw_tet_model *m, pw_idx point, pw_real *shape);

/** @brief Lumped masses of the nodes in m->mass for the step begun; found once in a step. */
void pw_tet_model_masses(pw_tet_model *m);

/**
 * @brief Add the weight of all points to m->external; for pw_newton_load.apply.
 * @param[in] g [3] m/s2, already multiplied with what part of it acts
 */
void pw_tet_model_gravity(pw_tet_model *m, const pw_real *g);

/**
 * @brief Give every point a stress, and set the state of its material for it; before the first
 *        step. Points stay at J = 1: volumes and masses are those of the stressed ground.
 * @return PW_OK; PW_ERR_UNSUPPORTED naming a material that cannot start under stress.
 */
pw_status pw_tet_model_prestress(pw_tet_model *m, pw_tet_stress_fn fn, void *ctx);

#endif /* PW_ENGINE_TET_LOADS_H */
