/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/solid_params.h
 * @brief Parameter structs of the effects of solid scenes (layer 3).
 *
 * Groups are physical groups of the mesh: surfaces first where several have the name.
 */
#ifndef PW_EFFECTS_SOLID_PARAMS_H
#define PW_EFFECTS_SOLID_PARAMS_H

#include "engine/implicit_state.h"

/** Nodes that an effect is about: those of a group, or those in a box. */
typedef struct pw_solid_nodes {
  char group[PW_NAME];         /**< "": the nodes in the box */
  pw_real low_m[3], high_m[3]; /**< box, edges included */
} pw_solid_nodes;

/** Rows of a key table for a pw_solid_nodes at the offset @p at. */
#define PW_SOLID_NODES_KEYS(at)                                                                    \
  {"group",                                                                                        \
   PW_KEY_TEXT,                                                                                    \
   (at) + offsetof(pw_solid_nodes, group),                                                         \
   0,                                                                                              \
   0,                                                                                              \
   "",                                                                                             \
   NULL,                                                                                           \
   NULL,                                                                                           \
   "physical group of the mesh, or side of a box; absent: the nodes in the box low_m, high_m"},    \
      {"low_m", PW_KEY_TRIPLE, (at) + offsetof(pw_solid_nodes, low_m),                             \
       -1e6,    1e6,           "[0, 0, 0]",                                                        \
       NULL,    NULL,          "box of nodes instead of a group: least coordinates, included"},    \
  {                                                                                                \
    "high_m", PW_KEY_TRIPLE, (at) + offsetof(pw_solid_nodes, high_m), -1e6, 1e6, "[0, 0, 0]",      \
        NULL, NULL, "largest coordinates of that box, included"                                    \
  }

/** @brief One of the two ways is used. @return PW_OK or PW_ERR_SCENE. */
pw_status pw_solid_nodes_check(const pw_solid_nodes *p);

/**
 * @brief The nodes themselves, ascending.
 * @param[in]  path of the effect's section, "boundary.2"
 * @param[out] node [*count] to be freed
 * @return PW_OK; PW_ERR_SCENE, beginning with the path of the key; PW_ERR_MEMORY.
 */
pw_status pw_solid_nodes_find(const pw_implicit *sim, const pw_solid_mesh *mesh,
                              const pw_solid_nodes *p, const char *path, pw_idx **node,
                              pw_idx *count);

/** boundary (many): held components of displacement. */
typedef struct pw_solid_boundary_param {
  pw_solid_nodes nodes;
  bool fix[3];
  pw_real displacement_m[3]; /**< in the end */
  pw_solid_ramp ramp;
} pw_solid_boundary_param;

/** driven_boundary: nodes that move as a rigid body. */
typedef struct pw_driven_boundary_param {
  pw_solid_nodes nodes;
  pw_real axis[3], centre_m[3];
  pw_real angle_deg, advance_m; /**< in the end */
  pw_solid_ramp ramp;
} pw_driven_boundary_param;

typedef enum pw_mesh_motion { PW_MOTION_DRIVEN, PW_MOTION_STRETCH } pw_mesh_motion;

/** moving_mesh. */
typedef struct pw_moving_mesh_param {
  int with; /**< pw_mesh_motion */
  pw_real stretch_end[3], centre_m[3];
  pw_solid_ramp ramp;
} pw_moving_mesh_param;

typedef enum pw_traction_kind {
  PW_LOAD_PRESSURE,
  PW_LOAD_TRACTION,
  PW_LOAD_FORCE
} pw_traction_kind;

/** traction (many): load on a surface of the mesh. */
typedef struct pw_traction_param {
  char group[PW_NAME];
  int kind;      /**< pw_traction_kind */
  bool follower; /**< the pressure follows the surface */
  pw_real pressure_pa, traction_pa[3], force_n[3];
  pw_solid_ramp ramp;
} pw_traction_param;

/** gravity. */
typedef struct pw_solid_gravity_param {
  pw_real acceleration_m_s2[3];
  pw_solid_ramp ramp;
} pw_solid_gravity_param;

typedef enum pw_solid_stress_kind { PW_SOLID_K0, PW_SOLID_UNIFORM } pw_solid_stress_kind;

/** initial_stress. */
typedef struct pw_solid_stress_param {
  int body;     /**< -1: every body */
  int kind;     /**< pw_solid_stress_kind */
  int vertical; /**< axis that points up: 0, 1, 2 */
  pw_real top_m, unit_weight_n_m3, k0, surcharge_pa;
  pw_real normal_pa[3], shear_pa[3]; /**< uniform: xx yy zz and xy yz zx */
} pw_solid_stress_param;

/** ghost_stabilisation. */
typedef struct pw_ghost_param {
  pw_real stiffness_pa;
} pw_ghost_param;

/** dynamics. */
typedef struct pw_dynamics_param {
  int mass;  /**< 0: lumped, 1: consistent */
  int rates; /**< 0: mapped from the points, 1: kept by the nodes */
  pw_real beta, gamma, damping_per_s;
} pw_dynamics_param;

/** @brief What ghost_stabilisation, dynamics and tractions ask for, when the scene has them. */
void pw_solid_model_options(const pw_scene *scene, pw_tet_setup *setup, pw_newton_options *options);

/** tracer (many). */
typedef struct pw_tracer_param {
  pw_real at_m[3];
} pw_tracer_param;

typedef enum pw_stress_measure { PW_STRESS_CAUCHY, PW_STRESS_KIRCHHOFF } pw_stress_measure;

/** stress_record (many). */
typedef struct pw_stress_record_param {
  int body;
  int component; /**< 0 .. 5: xx yy zz xy yz zx; 6: mean; 7: von Mises */
  int measure;   /**< pw_stress_measure */
} pw_stress_record_param;

extern const pw_effect pw_effect_solid_initial_stress, pw_effect_ghost, pw_effect_dynamics;
extern const pw_effect pw_effect_traction;

/** @brief The entry of driven_boundary of a scene, or NULL. */
const pw_driven_boundary_param *pw_solid_driven_param(const pw_scene *scene);

/** @brief Where a driven boundary takes what stood at X at the start: x = map X + shift.
 *  @param[in] part of its whole motion */
void pw_solid_driven_motion(const pw_driven_boundary_param *p, pw_real part, pw_real *map,
                            pw_real *shift);

#endif /* PW_EFFECTS_SOLID_PARAMS_H */
