/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/contact.h
 * @brief What the contact effects share: parameters, reaction on the master (layer 3).
 */
#ifndef PW_EFFECTS_CONTACT_H
#define PW_EFFECTS_CONTACT_H

#include "engine/sim_state.h"

/** contact_penalty. */
typedef struct pw_contact_penalty_param {
  int master; /**< stiff body whose segments push: pile, plane */
  int slave;  /**< body whose interface nodes must stay outside: soil, cylinder */
  pw_real friction;
  pw_real normal_stiffness_pa_m;
  pw_real tangential_stiffness_pa_m; /**< 0: the normal one */
  pw_real segment_m;                 /**< 0: half a cell */
  pw_real thickness_m;
  pw_real split_factor, thin_factor;
  pw_real step_frequency_max; /**< largest step times the frequency of the springs */
  pw_real guard_depth_m; /**< points that come deeper into the master get springs; 0: none do */
} pw_contact_penalty_param;

/** Whose surface gives the normal of the frictional contact. */
typedef enum pw_contact_normal {
  PW_NORMAL_AVERAGE,
  PW_NORMAL_MASTER,
  PW_NORMAL_SLAVE
} pw_contact_normal;

/** Where the bodies of the frictional contact may push each other. */
typedef enum pw_contact_detection {
  PW_DETECT_SHARED_NODES,
  PW_DETECT_CLOSED_GAP
} pw_contact_detection;

/** contact_frictional. */
typedef struct pw_contact_frictional_param {
  int master, slave;
  pw_real friction;
  int normal;               /**< pw_contact_normal */
  bool require_compression; /**< shared nodes: only where the traction is not tensile */
  int detection;            /**< pw_contact_detection */
} pw_contact_frictional_param;

/** contact_corner. */
typedef struct pw_contact_corner_param {
  int master; /**< body whose surface pushes: pile, plane */
  int slave;  /**< body of material points whose domains' corners stay outside: soil */
  pw_real friction;
  pw_real adhesion_pa;           /**< shear strength of the interface without pressure */
  pw_real adhesion_gap_m;        /**< adhesion acts up to this distance; 0: where it presses */
  pw_real shear_limit_pa;        /**< most shear stress; 0: no limit */
  pw_real stiffness_factor;      /**< of the slave's modulus over half a domain */
  pw_real step_frequency_max;    /**< largest step times the frequency of the springs */
  pw_real normal_stiffness_pa_m; /**< 0: by the factor */
  pw_real segment_m;             /**< 0: a quarter of a cell */
  pw_real rounding_m;            /**< of the master's convex edges; negative: half a segment */
} pw_contact_corner_param;

/** Parts of the reaction that are kept apart. */
enum { PW_REACTION_X, PW_REACTION_Y, PW_REACTION_SHAFT_Y, PW_REACTION_TIP_Y, PW_REACTIONS };

/** Reaction of the contact on the master, whole body; first member of every contact's context. */
typedef struct pw_contact_tally {
  pw_real force[PW_REACTIONS];   /**< of the last step; N */
  pw_real impulse[PW_REACTIONS]; /**< since the last row of the history; N s */
  pw_real mean[PW_REACTIONS];    /**< of the last row; N */
  pw_real elapsed;               /**< since the last row; s */
  pw_real overlap;               /**< largest of the last step; m */
  pw_real overlap_max;           /**< largest of the run; m */
  pw_idx pairs;                  /**< nodes in contact in the last step */
} pw_contact_tally;

/** @brief Begin the tally of a step: force, overlap and pairs become zero. */
void pw_contact_tally_begin(pw_contact_tally *t);

/** @brief Add a force on the master, per radian or metre; N. */
void pw_contact_tally_add(pw_contact_tally *t, const pw_real *force, bool tip);

/** @brief End it: to the whole body, and into the impulses. */
void pw_contact_tally_end(pw_contact_tally *t, pw_real measure, pw_real dt);

/** @brief The columns of history.csv; means over the time since the last call that saw any. */
void pw_contact_tally_history(pw_contact_tally *t, pw_record *row);

/** @brief Save or load under "<name>/". */
pw_status pw_contact_tally_archive(pw_contact_tally *t, const char *name, pw_archive *ar);

/** @brief Tally of the contact of a simulation, or NULL when it has none. */
const pw_contact_tally *pw_contact_tally_of(const pw_sim *sim);

/** @brief Rules for every contact. @return PW_OK or PW_ERR_SCENE. */
pw_status pw_contact_check(const pw_scene *scene, int master, int slave);

#endif /* PW_EFFECTS_CONTACT_H */
