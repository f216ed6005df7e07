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
 * A domain that has become degenerate is replaced by the square of its material's area, within
 * the limit, and its initial half-sides by F^-1 r, so that it deforms on from there.
 * @param[in,out] sums counts of limited and rebuilt domains are added
 */
void pw_domain_convect(pw_sim *sim, pw_idx first, pw_idx n, pw_block_sums *sums);

#endif /* PW_ENGINE_DOMAIN_H */
