/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/contact_corner.h
 * @brief Inside of the corner contact: corners, and edges' middles, of the slave's CPDI domains
 *        against the surface of the master (layer 3).
 *
 * In a step: (1) find the sites inside the master, (2) measure overlap, area and stiffness of
 * each, (3) limit the stiffness to what the step resolves, (4) springs and friction, forces to
 * the slave's grid field, (5) forces to the master. (1), (2) and (4) run over blocks of points, in
 * (4) by colours; everything summed over blocks is summed in block order.
 *
 * Blocks that take several short steps at once (engine/rates.h) are looked at when theirs begins.
 * Their pairs and forces stay until it ends, as their stresses do; the master, which moves in
 * every short step, meets the same forces as long.
 */
#ifndef PW_EFFECTS_CONTACT_CORNER_H
#define PW_EFFECTS_CONTACT_CORNER_H

#include "engine/domain_sites.h"
#include "engine/effects/contact.h"
#include "engine/effects/contact_corner_surface.h"

/** Arc of a site that has been found, but not held yet; any other that is not in contact has -1. */
#define PW_CORNER_WAITING (-2.0)

/** A site in contact in this step. */
typedef struct pw_corner_pair {
  pw_idx point;
  int site;   /**< corner or edge's middle: engine/domain_sites.h */
  bool fresh; /**< was not in contact in the last step */
  bool waits; /**< new, and too stiff for this step: no force yet */
  pw_real dt; /**< step of its block; s */
  pw_round_place place;
  pw_real overlap;   /**< what of the gap makes force, >= 0; m */
  pw_real advance;   /**< way along the surface since the last step; m */
  pw_real area;      /**< m2 */
  pw_real share;     /**< part of the area that adheres; - */
  pw_real density;   /**< stiffness per area; Pa/m */
  pw_real stiffness; /**< N/m */
  pw_real relax;     /**< part of the stretch that a growth of the stiffness leaves; - */
  pw_real rate;      /**< square of its frequency, from above; 1/s2 */
  pw_real force[2];  /**< on the site; N */
  pw_real lost;      /**< energy left out with stiffness that the step cannot resolve; J */
} pw_corner_pair;

/** Sums and extremes of the sites of a block. */
typedef struct pw_corner_sums {
  pw_idx count; /**< sites found; their pairs begin at start, */
  pw_idx start;
  pw_idx kept;                /**< or, in a step that the block has begun before, did here */
  pw_real spring, dissipated; /**< J per radian or metre, this step */
  pw_real rate;               /**< largest square of a point's frequency, from above; 1/s2 */
  pw_real soon;               /**< until a pair has closed by what a step may leave unseen; s */
  pw_real touch;              /**< step that points let a block without pairs take; s */
  pw_real longest;            /**< step that pairs let their block take; s */
  pw_real deepest;            /**< of a site, >= 0; m */
  pw_real centre;             /**< of a point's centre, >= 0; m */
  pw_real softest, stiffest;  /**< stiffness per area; Pa/m */
  pw_real modulus;            /**< largest of the points found: density times squared speed; Pa */
  pw_real offset;             /**< largest part of a gap without force; m */
  char pad[PW_ALIGN];         /* neighbours in the array belong to other threads */
} pw_corner_sums;

/** A corner contact. */
typedef struct pw_corner {
  pw_contact_tally tally; /**< first: engine/effects/contact.h */
  const pw_contact_corner_param *param;
  pw_sim *sim;
  pw_structure *structure; /**< the master, when it has no points */
  pw_interface own;        /**< else: its surface */
  pw_round_line surface;
  pw_real master_modulus; /**< density times squared wave speed of the master; 0: rigid; Pa */
  pw_idx capacity;        /**< pairs */
  pw_corner_pair *pair;   /**< [capacity] */
  pw_corner_pair *last;   /**< [capacity] of the last short step; NULL without rates */
  pw_idx npair;
  pw_idx *found;        /**< [8 points] site + 8 * point of a block, from 8 * its first point */
  pw_idx *segment;      /**< [8 points] its segment */
  pw_corner_sums *sums; /**< [nblock] */
  pw_idx *near;         /**< [nblock] blocks whose points can reach the master in this step, */
  pw_idx nnear;         /**< so many */
  pw_idx *box;          /**< [4 nblock] first and last node of the elements of a block along x, y */
  pw_real *covered;     /**< [line.n] area of the sites at each segment, with adhesion_gap_m; m2 */
  pw_real *stiffness;   /**< [nnode] sums at nodes; zero but within pw_corner_limit */
  pw_real *begun;       /**< [nblock] time of the last look at the block; s; NULL without rates */
  /* Of the present step: */
  pw_real *slave_rec, *master_rec;
  bool given;            /**< the master's motion is prescribed */
  pw_real slave_modulus; /**< largest density times squared wave speed in contact; Pa */
  /* Of the run: */
  pw_real last_dt;           /**< the last step; s */
  pw_real centre_max;        /**< deepest centre of a point; m */
  pw_real softest, stiffest; /**< Pa/m */
  pw_off reduced;            /**< sites whose stiffness was reduced for a step */
  pw_real offset_max;        /**< largest part of a gap without force; m */
} pw_corner;

/** @brief Energy of a spring; J. @param[in] k N/m @param[in] stretch m */
static inline pw_real pw_spring_energy(pw_real k, pw_real stretch)
{
  return 0.5 * k * stretch * stretch;
}

/** @brief Step that resolves a spring of a squared frequency; s. @param[in] rate 1/s2 */
static inline pw_real pw_corner_resolved(const pw_corner *c, pw_real rate)
{
  return c->param->step_frequency_max / sqrt(rate);
}

/** Part of half a domain by which site and surface may close in a step of the site's block: its force
 *  stays meanwhile. */
#define PW_CORNER_UNSEEN 0.02

/** @brief Density times squared wave speed of point @p i; Pa. */
static inline pw_real pw_corner_modulus(const pw_points *p, pw_idx i)
{
  return p->mass[i] / p->vol[i] * p->wave_speed[i] * p->wave_speed[i];
}

/** @brief Stiffness per area by which sites of a domain are held; Pa/m. */
pw_real pw_corner_stiffness(const pw_corner *c, const pw_domain_now *d);

/**
 * @brief Bound the step of a block without pairs, sums->touch, by a point of it.
 *
 * The point may not come to the surface within it: half the time that it needs, as a step that is
 * chosen by this look may end as long again after the next. Or what touches is resolved, and closes by
 * no more than a step may leave unseen. Nothing in a scene without levels, or in a block with pairs.
 * @param[in] q   place of the surface
 * @param[in] way of the point's sites to it, >= 0; m
 */
void pw_corner_bound_touch(const pw_corner *c, const pw_domain_now *d, const pw_round_place *q,
                           pw_real way, pw_corner_sums *sums);

/** @brief (1), (2): fill c->pair, history of sites that have left. @return PW_OK;
 *  PW_ERR_MEMORY when more sites are in contact than there is room for. */
pw_status pw_corner_search(pw_corner *c);

/** @brief (3): limit stiffnesses. @return the largest step that resolves every pair; 0: none; s */
pw_real pw_corner_limit(pw_corner *c);

/** @brief (4), (5): forces, energies (J per radian or metre), tally. */
void pw_corner_forces(pw_corner *c, pw_real *spring, pw_real *dissipated);

/** @brief Present surface of the master, as pw_contact_outline(). */
int pw_corner_outline(const pw_sim *sim, int which, pw_real *xy, int max);

#endif /* PW_EFFECTS_CONTACT_CORNER_H */
