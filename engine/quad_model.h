/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/quad_model.h
 * @brief Equations, residual and tangent of implicit steps on the grid of a simulation (layer 3).
 *
 * The points, blocks, colours and bases are those of explicit steps (engine/sim.h): plane strain and
 * axisymmetry; linear, uGIMP and CPDI. Updated Lagrangian on a grid put back after every part of a
 * step: the unknown is the displacement u of the nodes over the part. With the weights of a point's
 * nodes at its start, gradients g0, r0 the radius and m the weights that move the point,
 *
 *   F = 1 + sum u_i g0_i,   F_zz = 1 + sum m_i u_xi / r0 (axisymmetry),   v = V det F,
 *   f_i = sum_p v sigma : G_i,   K = sum_p v G_i : a : G_j,
 *
 * G_i the gradient that a displacement of node i makes where the points are now: g0 F^-1, and
 * m_i / (r0 F_zz) in the hoop direction. F is linear in u, so with the modulus a of
 * kernels/tet_element.h this is the exact derivative of f (Charlton, Coombs, Augarde, Computers and
 * Structures 190 (2017) 108-125, for GIMP). Domains of points keep the shape they have at the start
 * of the part until its end.
 *
 * Nodes take part in which points have more than method.mass_cut_off of a full cell's weight,
 * measured by sum V |g0| h: the others stay where they are, which holds nothing. Nodes with little
 * more are not held by anything but the points at their far end; the effect ghost_stabilisation
 * (engine/quad_ghost.h) lets them follow their neighbours.
 *
 * All loops over points run over the blocks, those that add to nodes and to the matrix in colours:
 * results are bitwise the same on any number of threads.
 */
#ifndef PW_ENGINE_QUAD_MODEL_H
#define PW_ENGINE_QUAD_MODEL_H

#include "engine/newton_guide.h"
#include "engine/quad_ghost.h"
#include "engine/quad_inertia.h"
#include "engine/sim_state.h"

/** Who holds a component of a node, in pw_quad_model.fixed. */
enum { PW_HELD_FREE = 0, PW_HELD_AXIS = 255 };

/** Work arrays of one iteration; component c of node a at [c * nnode + a]. */
typedef struct pw_quad_model {
  pw_sim *sim; /**< borrowed */
  pw_csr csr;  /**< tangent of the last evaluation */
  pw_quad_pattern pattern;
  pw_quad_ghost ghost;
  pw_quad_inertia inertia;
  pw_real time, dt;      /**< start and length of the part at hand; s */
  uint8_t *fixed;        /**< [2][nnode] 0: free; else who holds it */
  pw_real *prescribed;   /**< [2][nnode] displacement over the part where held; m */
  pw_real *external;     /**< [2][nnode] force at the end of the part; N (per radian) */
  pw_idx *equation;      /**< [3][nnode] row, or -1; the third components have none */
  pw_idx *numbered;      /**< [3][nnode] scratch of the numbering */
  pw_real *force;        /**< [2][nnode] internal force of the last evaluation; N */
  pw_real *lift;         /**< [2][nnode] tangent times prescribed where held; N */
  pw_real *weight;       /**< [nnode] sum V |g0| h; m3 */
  pw_real *x;            /**< [3][nnode] where nodes are; m */
  pw_real *stiff;        /**< [nblock] squares of forces that a strain of 1 makes; N2 */
  pw_real *range;        /**< [nblock][2] least and largest det F */
  pw_real rounding;      /**< norm of the forces that rounding of strains may leave; N */
  pw_real *stress_trial; /**< [6][ld] at the end of the part as the last evaluation sees it; Pa */
  pw_real *state_trial;  /**< [nstate][ld] likewise, or NULL */
  pw_newton_guide guide; /**< where a material takes substeps */
  pw_real *increment;    /**< [5][ld] F of the part: xx xy yx yy zz; - */
} pw_quad_model;

/** @brief Everything but the solver. @return PW_OK; PW_ERR_MEMORY. */
pw_status pw_quad_model_create(pw_sim *sim, pw_quad_model *out);

/** @brief Free; a zeroed struct is accepted. */
void pw_quad_model_destroy(pw_quad_model *m);

/** @brief Whether the tangent is symmetric: that of all materials is. */
bool pw_quad_model_is_symmetric(const pw_quad_model *m);

/**
 * @brief Begin a part: points in their blocks, masses of nodes, held components, equations. Hooks of
 *        PW_STAGE_BEGIN, _P2G and _CONSTRAINT run.
 * @return PW_OK; PW_ERR_POINT_LOST, PW_ERR_MEMORY, what hooks give.
 */
pw_status pw_quad_model_begin(pw_quad_model *m);

/** @brief Held components and loads for sim->time and sim->dt. @return what hooks give. */
pw_status pw_quad_model_load(pw_quad_model *m);

/**
 * @brief Internal force, trial stress and, when asked for, tangent and lift.
 * @param[in] u [2][nnode] displacements over the part; m
 * @return PW_OK; PW_RETRY_DOMAIN_INVERTED or PW_RETRY_STRESS naming the first point that fails.
 */
pw_status pw_quad_model_evaluate(pw_quad_model *m, const pw_real *u, bool tangent);

/** @brief Least and largest det F of the last evaluation. */
void pw_quad_model_volumes(const pw_quad_model *m, pw_real *ratio);

/** @brief End a part: points move with @p u, the last one evaluated, and keep their trial state;
 *  domains and weights are renewed as after an explicit step. */
void pw_quad_model_commit(pw_quad_model *m, const pw_real *u);

/** @brief Hold component @p axis of a node by effect instance @p by (1 .. 254) unless it is held;
 *  for hooks of PW_STAGE_CONSTRAINT. */
void pw_quad_model_hold(pw_quad_model *m, pw_idx node, int axis, int by, pw_real displacement);

/** @brief What holds component @p axis of @p node by @p by exerts on the bodies; 0 where another
 *  does; N (per radian). */
static inline pw_real pw_quad_model_reaction(const pw_quad_model *m, pw_idx node, int axis, int by)
{
  const pw_off at = (pw_off)axis * m->csr.nnode + node;
  const pw_real inertia = m->inertia.on ? m->inertia.force[at] : 0.0;
  return m->fixed[at] == by ? m->force[at] + inertia - m->external[at] : 0.0;
}

/* ---- engine/quad_points.c, for quad_model.c ---- */

/** One evaluation, shared by all blocks. */
typedef struct pw_quad_evaluation {
  pw_quad_model *m;
  const pw_real *u;
  bool tangent;
} pw_quad_evaluation;

/** @brief Evaluate, or commit, the points of a block; @p ctx is a pw_quad_evaluation. */
void pw_quad_block_evaluate(void *ctx, pw_idx block);
void pw_quad_block_commit(void *ctx, pw_idx block);

#endif /* PW_ENGINE_QUAD_MODEL_H */
