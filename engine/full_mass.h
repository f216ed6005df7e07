/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/full_mass.h
 * @brief Increments of velocity by the full mass matrix in place of the lumped one
 *        (method.mass_terms: 2; layer 3).
 *
 * Masses that are lumped at the nodes, M_L = diag(sum_p m_p S_ip), act on points through the gather
 * and the scatter, which multiplies accelerations by A = M_L^-1 M, M_ij = sum_p m_p S_ip S_jp: they
 * are smeared over two cells, and what the nodes take as moment of momentum is not what their points
 * get. With the full matrix, M dv = dt f, both are gone. Its inverse is a series whose first term is
 * the lumped step:
 *
 *   dv = (I + B + B^2 + ...) M_L^-1 dt f,   B = I - A, eigenvalues in [0, 1),
 *
 * and a second term is had for a gather and a scatter of the first: dv = dv_1 + (dv_1 - A dv_1).
 * Held components stay held; the reaction counts what holding them takes of the second term, too.
 * Momentum is kept as before. Accelerations are then multiplied by A (I + B) = I - B^2, which never
 * exceeds 1: frequencies stay below those of the elements with lumped masses and without points. Of a
 * bar's lowest mode, two points to a cell, nearly all that is left is the dispersion of those elements.
 *
 * Only the points' increments are corrected, and by one term. Points move and strain with the
 * velocities of lumped masses, remapped or not: then the stable step is that of lumped masses, while
 * with the second term in the velocities of USL it is 0.72 of it (one dimension, one to four points to
 * a cell, any offset). Remapped velocities (MUSL) corrected as well make manufactured solutions up to
 * three times more accurate yet; but with those, or with three terms, noise grows sooner. The balance
 * of energies, kept with the nodes' velocities, is off by a bounded part of the kinetic energy: some
 * tenths of a per cent to 1 % in the small scenes of the tests with MUSL, less than before with USL.
 *
 * Source: Burgess, Sulsky, Brackbill, J. Comput. Phys. 103 (1992), the full matrix; Nairn, Hammerquist,
 * Comput. Methods Appl. Mech. Engrg 377 (2021) 113667, its inverse as a series, of velocities there.
 */
#ifndef PW_ENGINE_FULL_MASS_H
#define PW_ENGINE_FULL_MASS_H

#include "engine/sim_state.h"

/** Context; sim->full_mass points to it. */
typedef struct pw_full_mass {
  bool adding;  /**< REMAP hooks run on v(n+1), to which the second term has just been added */
  pw_real *rec; /**< [nfield][nnode][PW_NODE] slot FORCE: the first term; REMAP: M times it; kg m/s,
                     zero between steps */
  pw_real *v;   /**< [2][ld] the first term at the points; m/s */
} pw_full_mass;

/** @brief Memory, if the scene has method.mass_terms > 1. @return PW_OK; PW_ERR_MEMORY. */
pw_status pw_full_mass_create(pw_sim *sim);
void pw_full_mass_destroy(pw_sim *sim);

/** @brief Scratch records of field @p f: what hooks of PW_STAGE_MASS read and add to. */
static inline pw_real *pw_full_mass_field(const pw_full_mass *m, int f, pw_idx nnode)
{
  return m->rec + (pw_off)f * nnode * PW_NODE;
}

/** @brief Whether constraints now hold v(n+1) against the second term: what is held stays as it was. */
static inline bool pw_full_mass_adding(const pw_sim *sim)
{
  return sim->full_mass && sim->full_mass->adding;
}

/** @brief The first term, v(n+1) - v(n); without remapped velocities slot REMAP keeps v(n+1) as it is.
 *  One of @p parts of the records in use. */
void pw_full_mass_first_part(pw_sim *sim, int part, int parts);

/** @brief Add the points' part of M times it: gather, scatter. Coloured. @p ctx is a pw_sim. */
void pw_block_full_mass(void *ctx, pw_idx block);

/** @brief Add the second term to v(n+1), not yet constrained; one of @p parts of the records in use. */
void pw_full_mass_second_part(pw_sim *sim, int part, int parts);

#endif /* PW_ENGINE_FULL_MASS_H */
