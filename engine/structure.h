/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/structure.h
 * @brief Bodies without material points: a rigid body or an elastic rod, with a surface (layer 3).
 *
 * A structure carries an interface line as its surface; whatever touches it adds forces at places
 * of that line. Its motion is kick and drift, one symplectic step with that of the points:
 *
 *   kick   v += dt M^-1 (contact + loads),  before the points move
 *   drift  x += dt v (rigid), or the implicit midpoint rule of M v' = -K u (rod): unconditionally
 *          stable and energy-exact, so that the wave speed of a steel pile does not limit the step
 *
 * In axisymmetry only the axial motion is free; the rod is axial in both geometries and its
 * radius does not change. Masses, forces and energies are per radian or metre.
 */
#ifndef PW_ENGINE_STRUCTURE_H
#define PW_ENGINE_STRUCTURE_H

#include "engine/interface.h"

/** Motion of a rigid body; three dimensions, of which plane and axisymmetric scenes free some. */
typedef struct pw_rigid {
  pw_real mass;        /**< kg */
  pw_real inertia[3];  /**< principal moments about the centre; kg m2 */
  pw_real x[3];        /**< centre of mass; m */
  pw_real v[3];        /**< m/s */
  pw_real rotation[4]; /**< unit quaternion w x y z from the start */
  pw_real spin[3];     /**< angular velocity; rad/s */
  pw_real force[3];    /**< of this step; N */
  pw_real moment[3];   /**< of this step, about the centre; N m */
} pw_rigid;

/** Axial elastic rod of two-node elements with lumped masses; node 0 at the tip, last at the head.
 */
typedef struct pw_rod {
  pw_idx n;          /**< nodes */
  pw_real stiffness; /**< E A / length of an element; N/m */
  pw_real *y0;       /**< [n] heights at the start; m */
  pw_real *u;        /**< [n] displacement; m */
  pw_real *v;        /**< [n] m/s */
  pw_real *mass;     /**< [n] kg */
  pw_real *force;    /**< [n] of this step; N */
  pw_real *scratch;  /**< [4 n] */
} pw_rod;

typedef struct pw_structure {
  int body; /**< index of its body in the scene */
  int kind; /**< pw_body_kind: PW_BODY_RIGID or PW_BODY_ROD */
  bool axi;
  pw_interface line; /**< its surface: x, du and v of the nodes are kept by the structure */
  pw_real *line_x0;  /**< [2 line.n] places of the line's nodes at the start; m */
  pw_rigid rigid;
  pw_rod rod;
  pw_real work;        /**< of contact and loads in the last kick and of the given motion; J */
  pw_real reaction[2]; /**< force that a given motion needed in the last kick; N */
} pw_structure;

/**
 * @brief The structure of body @p body of a scene (its `kind` is rigid or rod).
 * @param[in] segment largest length of a piece of its surface; m
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_SCENE when the shape has no such structure.
 */
pw_status pw_structure_create(const pw_scene *scene, int body, pw_real segment, pw_structure *out);
void pw_structure_destroy(pw_structure *s);

/** @brief Set all forces of the step to zero. */
void pw_structure_clear(pw_structure *s);

/** @brief Add the force @p f [2] at the place @p xi in [0, 1] of segment @p segment of its line. */
void pw_structure_add_force(pw_structure *s, pw_idx segment, pw_real xi, const pw_real *f);

/** @brief Add an axial force at the head (hammer), positive upwards; N. */
void pw_structure_add_head_force(pw_structure *s, pw_real f);

/** @brief Add mass times the acceleration @p a [2] (gravity). */
void pw_structure_add_weight(pw_structure *s, const pw_real *a);

/**
 * @brief Velocities of the step.
 * @param[in] given [2] velocity when the motion is prescribed, else NULL
 */
void pw_structure_kick(pw_structure *s, pw_real dt, const pw_real *given);

/** @brief Move, and renew the line's x, du and v. */
void pw_structure_drift(pw_structure *s, pw_real dt);

pw_real pw_structure_kinetic(const pw_structure *s); /**< J */
pw_real pw_structure_strain(const pw_structure *s);  /**< elastic energy stored; J */

/** @brief Centre of mass and its velocity. @param[out] com [4] x, y (m), v_x, v_y (m/s) */
void pw_structure_centre(const pw_structure *s, pw_real *com);

/** @brief Height of the tip now; m. */
pw_real pw_structure_tip(const pw_structure *s);

/** @brief Save or load under "structure_<body>/". @return as the archive's calls. */
pw_status pw_structure_archive(pw_structure *s, pw_archive *ar);

#endif /* PW_ENGINE_STRUCTURE_H */
