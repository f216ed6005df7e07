/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/tet_points.h
 * @brief Material points of an implicit simulation and the rules that place them (layer 3).
 *
 * Component c of point i of a field is at [c * ld + i]. Stress is Cauchy stress, six components in
 * the order xx yy zz xy yz zx. A point carries its true volume ratio and the one of F-bar, which
 * the stress belongs to; without F-bar both are the same.
 */
#ifndef PW_ENGINE_TET_POINTS_H
#define PW_ENGINE_TET_POINTS_H

#include "engine/tet_mesh.h"
#include "kernels/material.h"

/** Where points stand in a tetrahedron and what part of its volume each gets. */
typedef enum pw_tet_rule {
  PW_TET_RULE_ONE,          /**< the centroid */
  PW_TET_RULE_FOUR,         /**< four equal parts, exact for quadratic functions */
  PW_TET_RULE_ELEVEN_EQUAL, /**< the places of Keast's rule, eleven equal parts */
  PW_TET_RULE_ELEVEN_KEAST, /**< Keast's eleven points, exact for quartic functions: the part of the
                                 centroid is negative */
  PW_TET_RULE_TWENTY /**< an even lattice of twenty equal parts, exact for quadratic functions */
} pw_tet_rule;

/** A material with its parameters. */
typedef struct pw_tet_material {
  const pw_material *model;
  pw_real param[PW_MAX_PARAMS];
} pw_tet_material;

/** How a mesh is filled with points. */
typedef struct pw_tet_fill {
  pw_tet_rule rule;
  bool per_patch;      /**< once per ten-node tetrahedron, else once per element */
  bool allow_negative; /**< accept a rule with negative volumes */
  const pw_idx *body;  /**< [npatch] material of a patch, or -1 for an empty one; NULL: all 0 */
  pw_idx nmaterial;
  const pw_tet_material *material; /**< [nmaterial] borrowed */
} pw_tet_fill;

typedef struct pw_tet_points {
  pw_idx n, ld;
  int nstate;              /**< components of state: the most a material needs */
  pw_real *x;              /**< [3][ld] m */
  pw_real *volume;         /**< [ld] true volume now; m3 */
  pw_real *jac;            /**< [ld] true volume over that at the start */
  pw_real *jac_bar;        /**< [ld] the same of F-bar */
  pw_real *def_grad;       /**< [9][ld] deformation gradient of F-bar since the start, row-major;
                               NULL unless a material needs it */
  pw_real *stress;         /**< [6][ld] Pa */
  pw_real *state;          /**< [nstate][ld] of the material */
  pw_real *left_cg;        /**< [6][ld] b = F F^T of F-bar, or NULL: no material needs it */
  pw_real *stress_trial;   /**< [6][ld] at the end of the step as the last iteration sees it; Pa */
  pw_real *state_trial;    /**< [nstate][ld] likewise */
  pw_real *jac_bar_trial;  /**< [ld] likewise */
  pw_real *def_grad_trial; /**< [9][ld] likewise, or NULL */
  pw_real *left_cg_trial;  /**< [6][ld] likewise, or NULL */
  pw_real *mass;           /**< [ld] kg; never changes */
  pw_real *velocity;       /**< [3][ld] m/s, or NULL: quasi-static (pw_tet_points_let_move()) */
  pw_real *acceleration;   /**< [3][ld] m/s2, likewise */
  pw_idx *body;            /**< [ld] material */
  pw_idx *elem;            /**< [ld] parent element */
} pw_tet_points;

/**
 * @brief Place points in a mesh at its start and set up their materials, free of stress.
 *
 * A point on a face between elements of its patch belongs to the lowest of them.
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_ARGUMENT for a rule with negative volumes that is not asked
 *         for, a rule per patch on linear cells, a body without material, a mesh left empty;
 *         PW_ERR_SCENE from the material's check.
 */
pw_status pw_tet_points_create(const pw_tet_mesh *mesh, const pw_tet_fill *fill,
                               pw_tet_points *out);

/** @brief Give all points a velocity and an acceleration, zero at first; done by a driver of
 *  dynamics, once. @return PW_OK; PW_ERR_MEMORY. */
pw_status pw_tet_points_let_move(pw_tet_points *p);

/** @brief Free; a zeroed struct is accepted. */
void pw_tet_points_destroy(pw_tet_points *p);

/** @brief The rule of that name ("one", "four", "eleven_equal", "eleven_keast", "twenty").
 *  @return false: there is none. */
bool pw_tet_rule_find(const char *name, pw_tet_rule *rule);

/**
 * @brief Points of a rule.
 * @param[out] place [20][4] volume coordinates
 * @param[out] part  [20] parts of the volume, adding up to 1
 * @return their number; 0 for an unknown rule.
 */
int pw_tet_rule_points(pw_tet_rule rule, pw_real (*place)[4], pw_real *part);

#endif /* PW_ENGINE_TET_POINTS_H */
