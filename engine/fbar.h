/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/fbar.h
 * @brief F-bar: points of a cell share one volume change, against volumetric locking (layer 3).
 *
 * Bilinear cells with several points cannot deform without changing the volume of some of them;
 * a material that resists it answers with stress that alternates from point to point and with
 * forces that are too large. With F-bar the material sees, in place of the point's own increment
 * dF of the deformation gradient,
 *
 *   dFbar = (dJbar / det dF)^(1/3) dF,   dJbar = sum V det dF / sum V over the points of the cell
 *
 * (exponent 1/2 on the components in the plane in plane strain). Positions and domains keep the
 * point's own gradient.
 *
 * The internal force is the one that does the work of these strains: in it the mean stress of a
 * point is replaced by that of its cell, sum V p / sum V (in plane strain the mean of the components
 * in the plane). Points that come from different cells bring different mean stresses, which no
 * shared volume change can level; with their own mean stress in the force that difference would work
 * against a motion that the material does not resist, without end. The points keep their stress.
 *
 * Source: de Souza Neto, Peric, Dutko, Owen,
 * Int. J. Solids Struct. 33 (1996); for material points Coombs et al., Comput. Methods Appl. Mech.
 * Engrg 333 (2018); incremental form with volumes of points as in the implicit half.
 */
#ifndef PW_ENGINE_FBAR_H
#define PW_ENGINE_FBAR_H

#include "engine/update.h"

/** Context of the effect `fbar`; sim->fbar points to it. */
typedef struct pw_fbar_cells {
  bool body[PW_MAX_BODIES]; /**< bodies that take part */
  pw_real *du;              /**< [5][ld] gradients of the step, as pw_gradients */
  pw_idx *element;          /**< [ld] cell of each point before it moves, -1: outside */
  pw_real *sum;             /**< [nbody][nelem][2] V and V det dF, or V p; m3 per metre or radian */
  pw_real *stress;          /**< [6][ld] stress of the internal force; Pa */
} pw_fbar_cells;

/** @brief Gather gradients (and move the points) and add up the cells' volumes: coloured.
 *  @p ctx is a pw_update_pass. */
void pw_block_fbar_gather(void *ctx, pw_idx block);

/** @brief Add up volumes and mean stresses of the cells: coloured. @p ctx is a pw_sim. */
void pw_block_fbar_sum(void *ctx, pw_idx block);

/** @brief Stress of the internal force, all bodies. @p ctx is a pw_sim. */
void pw_block_fbar_stress(void *ctx, pw_idx block);

/** @brief Forget the sums of the last step. */
void pw_fbar_clear(pw_sim *sim);

/** @brief Copy the stored gradients of points [first, first + n) into @p grad. */
void pw_fbar_gradients(const pw_fbar_cells *c, pw_idx ld, pw_idx first, pw_idx n,
                       pw_gradients *grad);

/**
 * @brief Increments that the material sees.
 * @param[in,out] dstrain [6][PW_CHUNK] of the points' own gradients, then of dFbar
 * @param[in,out] dvol    [PW_CHUNK] det dF, then dJbar
 */
void pw_fbar_apply(pw_sim *sim, int body, pw_idx first, pw_idx n, pw_real *dstrain, pw_real *dvol);

#endif /* PW_ENGINE_FBAR_H */
