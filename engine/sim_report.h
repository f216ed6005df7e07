/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/sim_report.h
 * @brief Sums over points that reports need (layer 3).
 */
#ifndef PW_ENGINE_SIM_REPORT_H
#define PW_ENGINE_SIM_REPORT_H

#include "engine/sim_state.h"

/**
 * @brief Centre of mass and motion of a body.
 * @param[out] out [6] x, y (m), their velocities (m/s), angular velocity (rad/s, of the plane
 *                 motion about the centre), mass (kg per metre or radian)
 */
void pw_body_centre(const pw_sim *sim, int body, pw_real *out);

/** @brief Kinetic energy of all points, whole body; J. Steps keep it in sim->energy. */
pw_real pw_kinetic_energy(const pw_sim *sim);

#endif /* PW_ENGINE_SIM_REPORT_H */
