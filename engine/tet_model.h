/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/tet_model.h
 * @brief Mesh, points, equations, residual and tangent of an implicit simulation (layer 3).
 *
 * Updated Lagrangian: the unknown is the displacement u of the nodes over one step, and every step
 * starts from nodes where the mesh is. Formulation: kernels/tet_element.h. With F-bar the increment
 * F of an element is scaled to (theta)^(1/3) F, where
 *
 *   increment: theta = v_patch / (V_patch det F), volumes of the points now and at the start of the
 *              step (Wang et al., equation 1, with F the increment);
 *   total:     theta = J_patch / (J_bar det F), J_patch = sum v / sum V0 over the points of the
 *              patch since the beginning, so that nothing drifts.
 *
 * Only elements that hold points count in a patch; a patch with one such element has F-bar = F.
 *
 * All loops run over the blocks of patches, those that add to nodes in colours: results are
 * bitwise the same on any number of threads.
 */
#ifndef PW_ENGINE_TET_MODEL_H
#define PW_ENGINE_TET_MODEL_H

#include "engine/csr.h"
#include "engine/newton_guide.h"
#include "engine/tet_points.h"
#include "partition/patch_blocks.h"

typedef enum pw_fbar { PW_FBAR_NONE, PW_FBAR_INCREMENT, PW_FBAR_TOTAL } pw_fbar;

/** What a model is made of. */
typedef struct pw_tet_setup {
  pw_tet_mesh *mesh;       /**< borrowed; the model's callers may move it between steps */
  const pw_tet_fill *fill; /**< its materials are borrowed, the rest is used at once */
  pw_fbar fbar;
  int threads;   /**< >= 1 */
  pw_real ghost; /**< stiffness gamma of ghost stabilisation (engine/tet_ghost.h); 0: none; Pa */
  bool follower; /**< loads may follow the surface (engine/tet_follow.h): an unsymmetric tangent */
} pw_tet_setup;

/** Inertia of a part, set by engine/tet_inertia.h; NULL and zero when quasi-static. */
typedef struct pw_tet_inertia {
  bool on;
  bool consistent; /**< mass matrix sum m N_a N_b; false: lumped */
  pw_real factor;  /**< of the mass in the tangent; 1/s2 */
  pw_real *rate;  /**< [3][nnode] acceleration and damping that the mass is multiplied with; m/s2 */
  pw_real *force; /**< [3][nnode] mass times rate at the last evaluation; N */
} pw_tet_inertia;

/** Ghost stabilisation of a model: what engine/tet_ghost.h works on. */
typedef struct pw_tet_ghost {
  pw_real gamma; /**< Pa */
  pw_idx nface;  /**< faces of the step */
  pw_idx *face;  /**< [2 nelem] 4 e + f, ascending */
  uint8_t *cut;  /**< [nelem] 1: the element is cut */
} pw_tet_ghost;

typedef struct pw_tet_model {
  pw_tet_mesh *mesh;
  const pw_tet_material *material;
  pw_idx nmaterial;
  pw_fbar fbar;
  int threads;
  pw_real time, dt; /**< at the start of the part of a step at hand, its length; s. Set by the
                         caller before an evaluation; 0 and 1 at first */
  pw_off step;      /**< parts of steps committed */
  pw_walk walk;
  pw_blocks blocks; /**< of patches */
  pw_csr csr;       /**< tangent of the last evaluation */
  pw_tet_points points;
  pw_idx *elem_start;  /**< [nelem + 1] offsets into elem_point */
  pw_idx *elem_point;  /**< points by element, ascending in each */
  pw_idx *elem_order;  /**< [nelem] scratch of the sort */
  uint8_t *fixed;      /**< [3][nnode] 1: displacement prescribed. Set by the caller */
  pw_real *prescribed; /**< [3][nnode] displacement over the step where fixed; m. Likewise */
  pw_real *external;   /**< [3][nnode] force at the end of the step; N. Likewise */
  pw_real *follow;  /**< [3][nnode] force of loads that follow the surface, of the last evaluation;
                            NULL: the model is not made for them; N */
  pw_idx *equation; /**< [3][nnode] row, or -1: fixed, or no point near the node */
  pw_idx *numbered; /**< [3][nnode] scratch of the numbering */
  uint8_t *active;  /**< [nnode] 1: an element with points has the node */
  pw_real *force;   /**< [3][nnode] internal force of the last evaluation; N */
  pw_real *lift;    /**< [3][nnode] tangent times prescribed where fixed; N */
  pw_real *stiff;   /**< [nblock] squares of forces that a strain of 1 makes in a block; N2 */
  pw_real rounding; /**< norm of the forces that rounding of strains may leave, known from the
                              last evaluation with a tangent; N */
  pw_idx *bad;      /**< [nblock] first failing element of a block, or -1 */
  const char **why; /**< [nblock] what its material says, or NULL */
  pw_real *mass;    /**< [nnode] lumped masses of the step, known while has_mass; kg */
  bool has_mass;    /**< see engine/tet_loads.h */
  pw_tet_inertia inertia;
  pw_tet_ghost ghost;
  pw_newton_guide guide;         /**< where a material takes substeps */
  struct pw_tet_follow *surface; /**< surfaces under such loads, borrowed; or NULL */
  pw_walk_counts walked;         /**< searches of the last pw_tet_model_begin() */
  pw_walk_counts *chunk;         /**< counts of a chunk of points */
} pw_tet_model;

/**
 * @brief Points, blocks and matrix of a mesh at its start; nothing is fixed, no force acts.
 * @return PW_OK; PW_ERR_ARGUMENT, PW_ERR_MEMORY, PW_ERR_SCENE, PW_ERR_SOLVER, PW_ERR_UNSUPPORTED
 *         from what it calls.
 */
pw_status pw_tet_model_create(const pw_tet_setup *setup, pw_tet_model *out);

/** @brief Free all but the mesh; a zeroed struct is accepted. */
void pw_tet_model_destroy(pw_tet_model *m);

/**
 * @brief Begin a step: find the parents of all points, and number the equations of the nodes near
 *        points that are not fixed. csr.revision changes when the equations do.
 * @return PW_OK; PW_ERR_POINT_LOST naming a point outside the mesh.
 */
pw_status pw_tet_model_begin(pw_tet_model *m);

/**
 * @brief Internal force (with that of ghost stabilisation), inertia, loads that follow, trial stress
 *        and, when asked for, tangent and lift.
 * @param[in] u       [3][nnode] displacements of the nodes since the start of the step; m
 * @param[in] tangent fill csr and lift
 * @return PW_OK; PW_RETRY_DOMAIN_INVERTED or PW_RETRY_STRESS naming the first element that fails.
 */
pw_status pw_tet_model_evaluate(pw_tet_model *m, const pw_real *u, bool tangent);

/** @brief Whether the tangent is symmetric: without F-bar and loads that follow, of materials whose
 *  tangent is. */
bool pw_tet_model_is_symmetric(const pw_tet_model *m);

/** @brief Least and largest volume ratio over the step of an element with points, for @p u. */
void pw_tet_model_volumes(const pw_tet_model *m, const pw_real *u, pw_real *ratio);

/** @brief End a step: points move with @p u [3][nnode], the last one evaluated, and keep their trial
 *  state. */
void pw_tet_model_commit(pw_tet_model *m, const pw_real *u);

/** @brief Reaction at component @p at of [3][nnode] after an evaluation, inertia and damping
 *  included; N. */
static inline pw_real pw_tet_model_reaction(const pw_tet_model *m, size_t at)
{
  return m->force[at] + (m->inertia.on ? m->inertia.force[at] : 0.0) - m->external[at] -
         (m->follow ? m->follow[at] : 0.0);
}

#endif /* PW_ENGINE_TET_MODEL_H */
