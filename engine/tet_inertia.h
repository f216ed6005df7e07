/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/tet_inertia.h
 * @brief Newmark's method on the nodes of a model, and what points and nodes tell each other
 *        (layer 3).
 *
 * With u the displacement of a node over a part of length dt that starts with v0 and a0:
 *
 *   a = (u - dt v0) / (beta dt2) - (1 / (2 beta) - 1) a0,   v = v0 + dt ((1 - gamma) a0 + gamma a)
 *
 * (Newmark, J. Engng Mech. Div. ASCE 85 (1959) 67-94). The force of inertia is M (a + alpha v),
 * alpha a damping by the mass. beta = 1/4, gamma = 1/2 keeps the energy of linear systems and is
 * of second order in dt.
 *
 * Every part starts on a mesh put back: v0 and a0 are means over the points, weighted by mass and
 * shape function, and afterwards a point adds the change v - v0 at its place to its velocity and
 * takes its acceleration from there (Guilkey, Weiss, Int. J. Numer. Meth. Engng 57 (2003)
 * 1323-1338). The mean loses what neighbouring points do against each other. Where the mesh goes
 * with the material, or stands still under motions far smaller than its elements, nodes may keep
 * their v and a instead: then nothing is lost.
 */
#ifndef PW_ENGINE_TET_INERTIA_H
#define PW_ENGINE_TET_INERTIA_H

#include "engine/tet_model.h"

/** Dynamics by name; all zero: quasi-static. */
typedef struct pw_newmark {
  bool on;
  pw_real beta, gamma; /**< 1/4 and 1/2: the mean acceleration acts over the part */
  pw_real damping;     /**< alpha; 1/s */
  bool consistent;     /**< mass matrix sum m N_a N_b over the points; false: lumped */
  bool keep;           /**< nodes keep velocity and acceleration from part to part */
} pw_newmark;

/** @brief Mean acceleration, lumped masses, no damping, values mapped from the points. */
pw_newmark pw_newmark_defaults(void);

/** Motion of the nodes over a part; all [3][nnode]. */
typedef struct pw_tet_rates {
  pw_newmark method;
  pw_real *v0, *a0; /**< at its start; m/s, m/s2 */
  pw_real *v, *a;   /**< at its end, for the displacement last asked for */
  bool open;        /**< a part has been started and not committed */
  bool begun;       /**< a0 has been found */
  bool given; /**< set by the caller beside v: nodes that keep their rates start with that v */
} pw_tet_rates;

/**
 * @brief Rates of the nodes, velocities of the points, and inertia in the model.
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_ARGUMENT unless beta > 0, 0.5 <= gamma <= 2 beta + 0.5 and
 *         damping >= 0.
 */
pw_status pw_tet_rates_create(pw_tet_model *m, const pw_newmark *method, pw_tet_rates *out);

/** @brief Free, and take the inertia out of @p m; a zeroed struct is accepted. */
void pw_tet_rates_destroy(pw_tet_model *m, pw_tet_rates *r);

/** @brief v0 and a0 of a part that pw_tet_model_begin() has begun. */
void pw_tet_rates_start(pw_tet_model *m, pw_tet_rates *r);

/** @brief a0 from the balance of m->external and m->force at the start, by the lumped masses. */
void pw_tet_rates_balance(const pw_tet_model *m, pw_tet_rates *r);

/** @brief v, a and the inertia of the model for @p u [3][nnode] over @p dt. */
void pw_tet_rates_update(pw_tet_model *m, pw_tet_rates *r, const pw_real *u, pw_real dt);

/** @brief Points take over; before pw_tet_model_commit() of the same displacement. */
void pw_tet_rates_commit(pw_tet_model *m, pw_tet_rates *r);

/** @brief Add the mass of patch @p p: its force [PW_PATCH_DOFS] and, unless NULL, its part of
 *  @p k as in pw_patch_evaluate(). */
void pw_patch_inertia(const pw_tet_model *m, pw_idx p, pw_real *force, pw_real *k);

/** @brief Kinetic energy of the points; J. */
pw_real pw_tet_points_kinetic(const pw_tet_points *q);

#endif /* PW_ENGINE_TET_INERTIA_H */
