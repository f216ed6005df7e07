/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/ground.h
 * @brief Layered ground at rest, with ground water (layer 3): what initial_stress with
 *        `kind: layers` consists of.
 *
 * Stresses are effective. With the dry density rho_d of a layer's material (mass of the grains per
 * volume), its porosity n and the density rho_w of water, a layer weighs rho_d g above the water
 * table and (rho_d - (1 - n) rho_w) g below it. At depth
 *   sigma_v = -(surcharge + integral of these weights from the surface),  sigma_h = K0 sigma_v.
 * Pore pressures are hydrostatic and stay so: the soil is drained. Points keep the side of the
 * water table on which they start.
 */
#ifndef PW_EFFECTS_GROUND_H
#define PW_EFFECTS_GROUND_H

#include "engine/effects/params.h"
#include "engine/sim_state.h"

/** Default of water_table_y_m: below everything. */
#define PW_NO_WATER_Y_M (-1e6)

/** Ground water in a simulation: the water that points displace, at the nodes. */
typedef struct pw_ground_water {
  int body[PW_MAX_BODIES], nbody; /**< bodies with points below the water table */
  pw_real *by_id;                 /**< [n] water displaced by a point, by its number; kg */
  pw_real *mass;                  /**< [ld] the same in the points' present order */
  pw_real *rec;                   /**< [nnode][PW_NODE] scattered to the nodes */
  pw_off sorts;                   /**< of the simulation when @p mass was put in order */
} pw_ground_water;

/**
 * @brief Rules of the layers: rectangles from the surface down without gap or overlap, of equal
 *        width, materials that take an initial stress and are heavier than water, no other
 *        rectangle in or below them.
 * @return PW_OK; PW_ERR_SCENE with "layers.1: ..." in front.
 */
pw_status pw_ground_check(const pw_scene *scene, const pw_initial_stress_param *p);

/**
 * @brief Vertical effective stress in layer @p layer, mean over heights y - half to y + half.
 * @param[in] gravity weight per mass; m/s2
 * @return Pa, tension positive
 */
pw_real pw_ground_stress(const pw_scene *scene, const pw_initial_stress_param *p, pw_real gravity,
                         int layer, pw_real y, pw_real half);

/** @brief Layer of body @p b, or -1. */
int pw_ground_layer_of(const pw_initial_stress_param *p, int b);

/**
 * @brief Find the points below the water table, give them the mass of their pore water when the
 *        scene asks for it, and bind sim->buoyant. Without such points @p w stays empty.
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_SCENE when bodies below the table have different velocity
 *         fields.
 */
pw_status pw_ground_water_create(pw_sim *sim, const pw_initial_stress_param *p, pw_ground_water *w);
void pw_ground_water_destroy(pw_ground_water *w);

/** @brief Scatter the displaced water to the nodes (PW_STAGE_P2G). */
void pw_ground_water_scatter(pw_sim *sim, pw_ground_water *w);

#endif /* PW_EFFECTS_GROUND_H */
