/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/common.h
 * @brief Small things several effects need (layer 3).
 */
#ifndef PW_EFFECTS_COMMON_H
#define PW_EFFECTS_COMMON_H

#include "engine/sim_state.h"

/** Sums one reduction carries. */
enum { PW_SUMS = 3 };

/** Adds what the items [first, last) contribute to sum[PW_SUMS]; called from several threads. */
typedef void (*pw_sum_fn)(const void *ctx, pw_off first, pw_off last, pw_real *sum);

/** @brief Reals that a reduction over @p n items needs as scratch. */
pw_off pw_sum_scratch(pw_off n);

/**
 * @brief Sum over items 0 .. n - 1 in chunks of fixed size, so that the result is bitwise the same
 *        on any number of threads.
 * @param[out] part  scratch, [pw_sum_scratch(n)]
 * @param[out] out   [PW_SUMS]
 */
void pw_sum_items(pw_sum_fn fn, const void *ctx, pw_off n, int threads, pw_real *part,
                  pw_real *out);

/**
 * @brief The same over the records of fields [field[0], field[1]), but those not in
 *        use. Items are numbered from the first record of field 0. Which records are in use does
 *        not change the sum as long as @p fn adds zero where there is no mass.
 * @param[out] part  scratch, [pw_sum_scratch(sim->nodes.count)]
 */
void pw_sum_nodes(pw_sum_fn fn, const void *ctx, const pw_sim *sim, const int field[2],
                  pw_real *part, pw_real *out);

/** @brief What one of @p threads adds to such a sum, into @p part; the same for all of them, and
 *  then pw_sum_nodes_end(), give it. For hooks of PW_STAGE_MOTION. */
void pw_sum_nodes_part(pw_sum_fn fn, const void *ctx, const pw_sim *sim, const int field[2],
                       pw_real *part, int thread, int threads);
void pw_sum_nodes_end(const pw_sim *sim, const int field[2], const pw_real *part, pw_real *out);

/** @brief Which instance of its effect, from 0, has the parameters @p param of @p sim's scene. */
int pw_effect_instance(const pw_sim *sim, const void *param);

/** @brief First and one past the last velocity field of body @p b; all fields when b < 0. */
void pw_effect_fields(const pw_sim *sim, int b, int *first, int *last);

/**
 * @brief Velocity through which the forces on a node work in this step, component @p a, at
 *        PW_STAGE_MOTION and PW_STAGE_END.
 *
 * The kinetic energy of the points changes by dt sum f_i . (v_i(n) + v_i) / 2, v_i the remapped
 * velocity (MUSL) or v_i(n+1). With the new velocity alone the balance of energies would drift in
 * proportion to the step. Slots then: VEL v(n+1), FORCE its increment, node_slot v_i. With two terms
 * of the mass matrix the points take their energy through another velocity, (2 I - A) v_i: the balance
 * is off by a part of the kinetic energy that nodes do not see, which does not grow.
 */
static inline pw_real pw_node_mean_velocity(const pw_sim *sim, const pw_real *rec, int a)
{
  return 0.5 * (rec[PW_NODE_VEL + a] - rec[PW_NODE_FORCE + a] + rec[sim->node_slot + a]);
}

/** @brief Part of a load that acts in this step: the mean of the ramp over an explicit step, its
 *  value at the end of an implicit one. */
pw_real pw_effect_ramp(const pw_sim *sim, pw_real start, pw_real length);

/** @brief Number of entries of the scene that want one velocity field per body. */
int pw_scene_contacts(const pw_scene *scene);

#endif /* PW_EFFECTS_COMMON_H */
