/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/tet_follow.h
 * @brief Pressure that follows the surface of the material (layer 3).
 *
 * The loaded surface is made of points that move with the material as material points do, each with
 * the outward area vector a of its piece of the surface. A step with the increment F of the element
 * it is in takes it to cof(F) a (Nanson), so that a pressure p acts on node b of that element with
 *
 *   f_b = - p N_b cof(F) a,   df_b,i / du_c,j = - p N_b (a_i g_cj - g_ci a_j),
 *
 * with g the gradients and a the area vector where the nodes are now; the load's stiffness is not
 * symmetric (Bonet, Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, section 8.5).
 * It all happens in one element, wherever the surface has gone in the mesh. A point that has come to
 * an element without material points acts on the nearest one with some that shares a node with it;
 * outside the mesh it stays with the element it was in.
 */
#ifndef PW_ENGINE_TET_FOLLOW_H
#define PW_ENGINE_TET_FOLLOW_H

#include "engine/tet_model.h"

/** One loaded surface; those of a model are linked. */
typedef struct pw_tet_follow {
  pw_idx n;         /**< points of the surface */
  pw_real *x;       /**< [3][n] m */
  pw_real *area;    /**< [3][n] outward; m2 */
  pw_idx *elem;     /**< [n] element a point is in, or was in last */
  pw_idx *acts;     /**< [n] element it acts on in this step */
  pw_real pressure; /**< onto the material at the end of the part at hand; set by the caller; Pa */
  struct pw_tet_follow *next;
} pw_tet_follow;

/**
 * @brief A surface of @p n points, to be filled by the caller, as one of those of @p m.
 * @param[in] m a model created with pw_tet_setup.follower; it borrows the surface
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_ARGUMENT for another model.
 */
pw_status pw_tet_follow_create(pw_tet_model *m, pw_idx n, pw_tet_follow **out);

/** @brief Free and null; NULL is accepted. */
void pw_tet_follow_destroy(pw_tet_follow **surface);

/** @brief Find the elements of all points for the step begun. @return PW_OK; PW_ERR_POINT_LOST for one
 *  that no material is near. */
pw_status pw_tet_follow_begin(pw_tet_model *m);

/** @brief Forces for the displacements @p u [3][nnode] in m->follow. */
void pw_tet_follow_forces(pw_tet_model *m, const pw_real *u);

/** @brief Add the stiffness for @p u to m->csr and m->lift. */
void pw_tet_follow_tangent(pw_tet_model *m, const pw_real *u);

/** @brief End a step: points and area vectors go along with @p u. */
void pw_tet_follow_commit(pw_tet_model *m, const pw_real *u);

/** @brief Force [3] of a surface at its pressure; N. */
void pw_tet_follow_sum(const pw_tet_follow *f, pw_real *sum);

#endif /* PW_ENGINE_TET_FOLLOW_H */
