/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/structure_sim.h
 * @brief The structures of a simulation: made from its scene, stepped with its points (layer 3).
 */
#ifndef PW_ENGINE_STRUCTURE_SIM_H
#define PW_ENGINE_STRUCTURE_SIM_H

#include "engine/sim_state.h"

/** @brief Structures of the scene's bodies that have no points. @return PW_OK; PW_ERR_MEMORY;
 *  PW_ERR_SCENE. */
pw_status pw_structures_create(pw_sim *sim);
void pw_structures_destroy(pw_sim *sim);

/** @brief Start of a step: no forces. */
void pw_structures_clear(pw_sim *sim);

/** @brief New velocities, of prescribed bodies the given ones. */
void pw_structures_kick(pw_sim *sim);

/** @brief Move; work of loads and given motions goes to energy.external, that of the rods' stress
 *  to energy.strain_work. */
void pw_structures_drift(pw_sim *sim);

/** @brief Kinetic energy of all structures, whole body; J. */
pw_real pw_structures_kinetic(const pw_sim *sim);

/** @brief Largest speed of the surface of a structure; m/s. */
pw_real pw_structures_speed(const pw_sim *sim);

pw_status pw_structures_archive(pw_sim *sim, pw_archive *ar);

/** @brief Rules for body @p body of a scene when it is a structure. @return PW_OK; PW_ERR_SCENE. */
pw_status pw_structure_check(const pw_scene *scene, int body);

#endif /* PW_ENGINE_STRUCTURE_SIM_H */
