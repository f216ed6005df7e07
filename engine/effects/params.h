/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/params.h
 * @brief Parameter structs of the effects of this folder that are not contacts (layer 3).
 *
 * The scene reader fills them through the effects' key tables; tests and programs fill what
 * pw_scene_add_effect() returns. Every default stands in the key table of the effect.
 */
#ifndef PW_EFFECTS_PARAMS_H
#define PW_EFFECTS_PARAMS_H

#include "engine/core/key.h"

/** A side of a body or of the grid; PW_SIDE_BOX only where a box is possible. */
typedef enum pw_side {
  PW_SIDE_BOTTOM,
  PW_SIDE_TOP,
  PW_SIDE_LEFT,
  PW_SIDE_RIGHT,
  PW_SIDE_BOX
} pw_side;

typedef enum pw_stress_kind { PW_STRESS_K0, PW_STRESS_UNIFORM, PW_STRESS_LAYERS } pw_stress_kind;

/** One soil layer: a rectangular body. */
typedef struct pw_ground_layer {
  int body;
  pw_real k0;       /**< horizontal over vertical effective stress */
  pw_real porosity; /**< 0: from the material's void_ratio */
} pw_ground_layer;

/** initial_stress: at-rest stress of one body or of layered ground, or uniform stress of one body,
 *  at the start. */
typedef struct pw_initial_stress_param {
  int body;
  int kind;                                         /**< pw_stress_kind */
  pw_real top_y_m;                                  /**< height of the free surface */
  pw_real k0;                                       /**< horizontal over vertical stress */
  pw_real surcharge_pa;                             /**< pressure on the free surface */
  pw_real acceleration_m_s2;                        /**< 0: that of the gravity section */
  pw_real stress_xx_pa, stress_yy_pa, stress_zz_pa; /**< uniform */
  int nlayer;
  pw_ground_layer layer[PW_MAX_BODIES]; /**< from the surface down */
  pw_real water_table_y_m, water_density_kg_m3;
  bool water_inertia; /**< points below the water table carry the mass of their pore water */
} pw_initial_stress_param;

/** gravity. */
typedef struct pw_gravity_param {
  pw_real acceleration_m_s2;
  pw_real ramp_s;
  pw_real tilt_deg, tilt_at_s, tilt_over_s;
} pw_gravity_param;

/** surcharge (many): pressure on one side of a body. */
typedef struct pw_surcharge_param {
  int body;
  int side; /**< pw_side */
  pw_real pressure_pa;
  pw_real ramp_s, start_s;
} pw_surcharge_param;

typedef enum pw_pulse_shape { PW_PULSE_RECTANGULAR, PW_PULSE_HALF_SINE } pw_pulse_shape;

/** hammer: pulses of pressure on the top of a body. */
typedef struct pw_hammer_param {
  int body;
  int pulse; /**< pw_pulse_shape */
  pw_real pressure_pa;
  pw_real duration_s, rise_s, period_s, start_s;
  int count;
} pw_hammer_param;

typedef enum pw_body_force_kind {
  PW_MMS_AXIS_ALIGNED,
  PW_MMS_VORTEX,
  PW_MMS_RING
} pw_body_force_kind;
typedef enum pw_mms_course { PW_MMS_SINE, PW_MMS_ONE_MINUS_COSINE } pw_mms_course;

/** body_force: the body force of a manufactured motion of a neo-Hookean body. */
typedef struct pw_body_force_param {
  int body;
  int kind;                          /**< pw_body_force_kind */
  pw_real amplitude_m, rotation_rad; /**< axis aligned and ring; vortex */
  int course;                        /**< pw_mms_course of the vortex */
  pw_real origin_m[2]; /**< lower left corner of the unit square; centre of the ring */
} pw_body_force_param;

/** damping_local (many). */
typedef struct pw_damping_local_param {
  int body; /**< -1: every velocity field */
  pw_real coefficient;
  pw_real until_s; /**< 0: the whole run */
} pw_damping_local_param;

/** prescribed_motion (many): a body whose velocity is given. */
typedef struct pw_prescribed_motion_param {
  int body;
  pw_real velocity_m_s[2];
  pw_real start_s, ramp_s;
  pw_real vibration_amplitude_m, vibration_frequency_hz; /**< along y, from start_s on */
} pw_prescribed_motion_param;

/** boundary (many): given velocity components at nodes of the grid. */
typedef struct pw_boundary_param {
  int side;               /**< pw_side */
  pw_real x_m[2], y_m[2]; /**< box */
  bool fix_x, fix_y;
  pw_real velocity_x_m_s, velocity_y_m_s;
  int body; /**< -1: every velocity field */
} pw_boundary_param;

/** How an absorbing side is held until it starts. */
typedef enum pw_before { PW_BEFORE_ROLLER, PW_BEFORE_FIXED } pw_before;

/** absorbing (many): a side of the grid that lets waves out. */
typedef struct pw_absorbing_param {
  int side; /**< pw_side */
  pw_real normal_factor, shear_factor;
  pw_real shear_ratio;       /**< c_s / c_p */
  pw_real source_distance_m; /**< of the springs; 0: none */
  int before;                /**< pw_before */
  pw_real start_s, mean_over_s;
} pw_absorbing_param;

/** pile_record: penetration, set per blow, settlement, base stress, overlap. */
typedef struct pw_pile_record_param {
  int body; /**< the pile */
  int soil;
  pw_real far_field_x_m; /**< 0: 0.8 of the way from the pile's axis to the soil's right end */
  pw_real base_y_m;      /**< -1e300: the soil's own bottom */
} pw_pile_record_param;

/** fbar. */
typedef struct pw_fbar_param {
  int body; /**< -1: every body */
} pw_fbar_param;

#endif /* PW_EFFECTS_PARAMS_H */
