/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/contact_penalty.h
 * @brief Inside of the penalty contact: from slaves in contact to forces on the grid (layer 3).
 */
#ifndef PW_EFFECTS_CONTACT_PENALTY_H
#define PW_EFFECTS_CONTACT_PENALTY_H

#include "engine/effects/contact.h"
#include "engine/interface_search.h"

/** A slave in contact in this step. */
typedef struct pw_active_pair {
  pw_idx slave, segment;
  pw_pair place;
  pw_real overlap_before; /**< effective overlap of the last step; m */
  pw_real slip_step;      /**< slip of the last step, C_t . du; m */
  pw_real area;           /**< tributary area times the reduction of stiffness; m2 */
} pw_active_pair;

/** Laws and counters of a penalty contact. */
typedef struct pw_penalty {
  pw_contact_tally tally; /**< first: engine/effects/contact.h */
  const pw_contact_penalty_param *param;
  pw_real omega_n, omega_t;
  pw_interface master, slave;
  pw_segment_bins bins;
  pw_refine_rule rule;
  pw_refine_counts counts;
  pw_off reduced;  /**< pairs whose stiffness was reduced for a step */
  pw_off detached; /**< pairs without force: a side had no active grid node */
  pw_off guarded;  /**< guarded points, summed over the steps */
  pw_idx npair;
  pw_active_pair *pair; /**< [slave.capacity] */
  pw_real *stiffness; /**< [2][nnode] sum of stiffnesses at a grid node: slave's, master's field */
  /* Of the present step: */
  pw_real *rec[2];    /**< records of the fields of slave and master */
  bool given[2];      /**< slave's, master's motion is prescribed: no mass, takes no force */
  pw_real spring;     /**< energy in the springs; J per radian or metre */
  pw_real dissipated; /**< likewise */
} pw_penalty;

/** @brief Find the slaves in contact and update their history; fills c->pair. */
void pw_penalty_search(pw_penalty *c, pw_real reach);

/**
 * @brief Limit the stiffness of pairs for the present step.
 *
 * The row sums of the pairs' stiffness over the masses of their grid nodes bound the square of
 * their highest frequency; for one pair alone it is k / m_eff, 1 / m_eff = sum N^2 / m.
 * @return the largest step that resolves every pair, step_frequency_max / frequency; 0 without
 *         pairs; s.
 */
pw_real pw_penalty_limit(pw_penalty *c, pw_idx nnode, pw_real dt);

/** @brief Springs, friction, forces on the grid (eq. 2.48, 2.52), tally. */
void pw_penalty_forces(pw_penalty *c);

/**
 * @brief Springs on points of the slave that leak through its line.
 *
 * Points and interface nodes move in different interpolations of one velocity field, so under a
 * tip single points come past the line, where nothing holds them: they fly through the master and
 * leave the grid. A point that is deeper in the master than guard_depth_m is pushed back by a
 * spring on the difference, of the contact's normal stiffness and the area of the point; without
 * friction. To be called after pw_penalty_forces(), whose tally and energies it adds to.
 * @return the largest step that resolves every spring, as pw_penalty_limit(). Where the present
 *         one is far longer the spring is weaker for it, and its energy is not accounted for.
 */
pw_real pw_penalty_guard(pw_sim *sim, pw_penalty *c);

/** @brief No point of the slave is deeper in the master at the start than guard_depth_m: the energy
 *         of its spring would come from nothing. @return PW_OK; PW_ERR_SCENE naming the deepest. */
pw_status pw_penalty_guard_check(const pw_sim *sim, const pw_penalty *c);

/** @brief Add the forces @p f [4] (node 1, node 2 of the segment; x and y each) to the master's
 *         grid nodes and to the tally. */
void pw_penalty_on_master(pw_penalty *c, pw_idx segment, const pw_real *f);

#endif /* PW_EFFECTS_CONTACT_PENALTY_H */
