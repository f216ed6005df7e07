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
 * In axisymmetry only the axial motion of a rigid body is free, in the plane its three. The rod is
 * axial in both geometries and its radius does not change; a given motion is that of its head.
 * Masses, forces and energies are per radian or metre.
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
  pw_real load[2];     /**< part of force that is weight and head force; N */
  pw_real load_moment; /**< part of moment[2] likewise; N m */
} pw_rigid;

/** Axial elastic rod of two-node elements with lumped masses; node 0 at the tip, last at the head.
 */
typedef struct pw_rod {
  pw_idx n;           /**< nodes */
  pw_real y0;         /**< height of node 0 at the start; m */
  pw_real length;     /**< of an element; m */
  bool held;          /**< the head's velocity is given in this step */
  pw_real *stiffness; /**< [n - 1] E times mean section / length of an element; N/m */
  pw_real *u;         /**< [n] displacement; m */
  pw_real *stretch; /**< [n - 1] u[k + 1] - u[k], kept by itself: a long way does not round it; m */
  pw_real *v;       /**< [n] m/s */
  pw_real *mass;    /**< [n] row sums of the consistent mass: exact mass and centre; kg */
  pw_real *force;   /**< [n] of this step; N */
  pw_real *load;    /**< [n] part of force that is weight and head force; N */
  pw_real *scratch; /**< [3 n] */
} pw_rod;

typedef struct pw_structure {
  int body; /**< index of its body in the scene */
  int kind; /**< pw_body_kind: PW_BODY_RIGID or PW_BODY_ROD */
  bool axi;
  pw_interface line; /**< its surface: x, du and v of the nodes are kept by the structure */
  pw_real *line_x0;  /**< [2 line.n] places of the line's nodes at the start; m */
  pw_rigid rigid;
  pw_rod rod;
  pw_real centre0[2];  /**< centre of mass (rod: of its x only) at the start; m */
  pw_real head_y;      /**< height of its top at the start; m */
  pw_real head_area;   /**< section at the top, 0 when it has none (disc); m2 */
  pw_real work;        /**< of weight and head force in the last step; J */
  pw_real given_work;  /**< of the given motion in the last step; J */
  pw_real reaction[2]; /**< force that the given motion needed in the last step; N */
} pw_structure;

/**
 * @brief The structure of body @p body of a scene (its `kind` is rigid or rod).
 * @param[in] segment largest length of a piece of its surface; a rod's pieces are not longer than
 *                    its elements; m
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_SCENE when the shape has no such structure.
 */
pw_status pw_structure_create(const pw_scene *scene, int body, pw_real segment, pw_structure *out);
void pw_structure_destroy(pw_structure *s);

/** @brief Set all forces of the step to zero. */
void pw_structure_clear(pw_structure *s);

/** @brief Add the force @p f [2] at the place @p xi in [0, 1] of segment @p segment of its line. */
void pw_structure_add_force(pw_structure *s, pw_idx segment, pw_real xi, const pw_real *f);

/** @brief Add a force along y at the middle of the head (hammer), positive upwards; N. */
void pw_structure_add_head_force(pw_structure *s, pw_real f);

/** @brief Add mass times the acceleration @p a [2] (gravity). */
void pw_structure_add_weight(pw_structure *s, const pw_real *a);

/** @brief Give all of it the velocity @p v [2], no spin. */
void pw_structure_set_velocity(pw_structure *s, const pw_real *v);

/**
 * @brief Velocities of the step.
 * @param[in] given [2] velocity when the motion is prescribed (rod: of its head), else NULL
 */
void pw_structure_kick(pw_structure *s, pw_real dt, const pw_real *given);

/** @brief Move, and renew the line's x, du and v. Work and reaction of the step are then known. */
void pw_structure_drift(pw_structure *s, pw_real dt);

pw_real pw_structure_kinetic(const pw_structure *s); /**< J */
pw_real pw_structure_strain(const pw_structure *s);  /**< elastic energy stored; J */

/**
 * @brief Centre of mass and motion, as pw_body_centre().
 * @param[out] com [6] x, y (m), v_x, v_y (m/s), spin (rad/s), mass (kg)
 */
void pw_structure_centre(const pw_structure *s, pw_real *com);

/** @brief Height of the lowest place of the surface now; m. */
pw_real pw_structure_tip(const pw_structure *s);

/** @brief Present surface; a closed one repeats its first node.
 *  @param[out] xy [2 max] pairs; m
 *  @return nodes written; -1 when @p max is too small. */
int pw_structure_outline(const pw_structure *s, pw_real *xy, int max);

/** @brief Save or load under "structure_<body>/". @return as the archive's calls. */
pw_status pw_structure_archive(pw_structure *s, pw_archive *ar);

#endif /* PW_ENGINE_STRUCTURE_H */
