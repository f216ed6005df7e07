/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/domain.h
 * @brief CPDI domains that follow their points, limited and rebuilt where they degenerate
 *        (layer 3).
 */
#ifndef PW_ENGINE_DOMAIN_H
#define PW_ENGINE_DOMAIN_H

#include "engine/sim_state.h"

/** A domain whose area is less than this share of its material's area is rebuilt as a square. */
#define PW_DOMAIN_DEGENERATE 1e-4

/**
 * @brief Renew the half-sides of points [first, first + n): r = F r0, diagonals limited.
 *
 * Homel, Brannon and Guilkey (Int. J. Numer. Meth. Engng 107, 2016): a half diagonal longer than
 * sim->limit of its point is shortened to it, the deformation gradient is kept for the material.
 * On a graded grid half diagonals are measured in cells, x in widths and y in heights of the cell
 * that holds the point now, so a domain shrinks with the cells it moves into and its corners stay
 * within the halo (pw_domain_reach).
 * A domain that has become degenerate is replaced by the square of its material's area, within
 * the limit, and its initial half-sides by F^-1 r, so that it deforms on from there.
 * With domain_aspect_max a domain whose principal half-sides, measured in the cell where it is
 * (points of one size, without points_per_cell: in metres; all points of a call are of one body),
 * differ by more than that ratio is reshaped at the area of its material, as little as is needed.
 * A domain held by the corner contact keeps its place at the surface when it is limited or reshaped:
 * its centre takes back the mean jump of the sites that are held.
 * @param[in] grad gradients of the step, from which jumps are told from deformation; may be NULL
 *             when the points have no contact_jump
 * @param[in,out] sums counts of limited and rebuilt domains are added
 */
void pw_domain_convect(pw_sim *sim, const pw_gradients *grad, pw_idx first, pw_idx n,
                       pw_block_sums *sums);

/**
 * @brief Cells of halo that hold every domain of at most @p limit cells, wherever its centre lies
 *        in its cell or in a neighbour of it (a point may move on before it is sorted again).
 * @return at least 2, so that points with small domains may drift
 */
pw_idx pw_domain_reach(const pw_mesh *mesh, pw_real limit);

#endif /* PW_ENGINE_DOMAIN_H */
