/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/hypoplastic_lanes.h
 * @brief Rates and substeps of several points at once (layer 1).
 *
 * Tensors of n lanes are stored as [6][n]; n, the switches and the loops are literals where these
 * functions are used, so that each use becomes straight vector code. Operations of a lane involve
 * that lane alone.
 */
#ifndef PW_KERNELS_HYPOPLASTIC_LANES_H
#define PW_KERNELS_HYPOPLASTIC_LANES_H

#include "kernels/hypoplastic_heun.h"

/** Arrays of one evaluation. */
typedef struct pw_hypo_stage {
  const pw_real *stress, *delta; /**< [6][n] sigma* and delta of the stage */
  const pw_real *void_ratio;     /**< [n] of the stage */
  const pw_real *de, *size;      /**< [6][n], [n] strain increment and its norm */
  pw_real *k, *d;                /**< [6][n] out: rates of stress and delta */
  pw_real *able;                 /**< [n] set to 0 where the stress is beyond its limits */
  pw_real *modulus;              /**< [n] out, at the last stage */
} pw_hypo_stage;

/** @brief Rates of @p n lanes. */
PW_INLINE void pw_hypo_stage_lanes(const pw_hypo *hp, const pw_hypo_stage *stage, int n, int form,
                                   bool last)
{
  const pw_hypo h = *hp;
  const pw_hypo_stage a = *stage;
  const size_t ld = (size_t)n;
#pragma omp simd
  for (int i = 0; i < n; i++) {
    pw_t6 stress = pw_t6_load(a.stress + i, ld);
    pw_hypo_slope s = pw_hypo_slope_of(&h, stress, pw_t6_load(a.delta + i, ld), a.void_ratio[i],
                                       pw_t6_load(a.de + i, ld), a.size[i], form);
    pw_t6_store(s.stress, a.k + i, ld);
    pw_t6_store(s.delta, a.d + i, ld);
    a.able[i] *= s.inside;
    if (last) {
      a.modulus[i] = pw_hypo_modulus(&h, s);
    }
  }
}

/** Arrays of one substep, from which the stages are made. */
typedef struct pw_hypo_substep {
  const pw_real *stress, *delta, *de, *size; /**< at its start */
  const pw_real *step;                       /**< [n] its size in time */
  const pw_real *void_ratio[3];              /**< [n] at its start, middle and end */
  pw_real *k[3], *d[3];                      /**< [6][n] rates of the stages */
  pw_real *at, *at_delta;                    /**< [6][n] a stage; out: the result */
  pw_real *able;                             /**< [n] as in a stage */
  pw_real *modulus, *error;                  /**< [n] out: of the last stage; of the result */
} pw_hypo_substep;

/** @brief One step of Heun's method in @p n lanes, to at, at_delta and modulus; @p good [n] is set
 *  to 0 where it does not stand. */
PW_INLINE void pw_hypo_heun_lanes(const pw_hypo *hp, const pw_hypo_substep *substep, pw_real *good,
                                  int n, int form)
{
  const pw_hypo h = *hp;
  const pw_hypo_substep s = *substep;
  const size_t ld = (size_t)n;
#pragma omp simd
  for (int i = 0; i < n; i++) {
    pw_hypo_increment whole = {pw_t6_load(s.de + i, ld), s.size[i], s.void_ratio[0][i],
                               s.void_ratio[2][i]};
    pw_hypo_heun y = pw_hypo_heun_step(&h, pw_t6_load(s.stress + i, ld),
                                       pw_t6_load(s.delta + i, ld), whole, form);
    good[i] *= y.good;
    s.modulus[i] = pw_hypo_modulus(&h, y.last);
    pw_t6_store(y.stress, s.at + i, ld);
    pw_t6_store(y.delta, s.at_delta + i, ld);
  }
}

/** @brief State of the middle (@p stage 1) or of the end (2) from the rates before it. */
PW_INLINE void pw_hypo_next_stage(const pw_hypo_substep *substep, int n, int stage)
{
  const pw_hypo_substep s = *substep;
  const size_t ld = (size_t)n;
#pragma omp simd
  for (int i = 0; i < n; i++) {
    pw_real c1 = (stage == 1 ? 0.5 : -1.0) * s.step[i], c2 = 2.0 * s.step[i];
    pw_t6 at = pw_t6_axpy(pw_t6_load(s.stress + i, ld), c1, pw_t6_load(s.k[0] + i, ld));
    pw_t6 delta = pw_t6_axpy(pw_t6_load(s.delta + i, ld), c1, pw_t6_load(s.d[0] + i, ld));
    if (stage == 2) {
      at = pw_t6_axpy(at, c2, pw_t6_load(s.k[1] + i, ld));
      delta = pw_t6_axpy(delta, c2, pw_t6_load(s.d[1] + i, ld));
    }
    pw_t6_store(at, s.at + i, ld);
    pw_t6_store(delta, s.at_delta + i, ld);
  }
}

/** @brief Result of the substep in at and at_delta, and its error. */
PW_INLINE void pw_hypo_combine(const pw_hypo *hp, const pw_hypo_substep *substep, int n)
{
  const pw_hypo h = *hp;
  const pw_hypo_substep s = *substep;
  const size_t ld = (size_t)n;
#pragma omp simd
  for (int i = 0; i < n; i++) {
    pw_real sixth = s.step[i] * (1.0 / 6.0);
    pw_t6 k1 = pw_t6_load(s.k[0] + i, ld), k2 = pw_t6_load(s.k[1] + i, ld);
    pw_t6 k3 = pw_t6_load(s.k[2] + i, ld);
    pw_t6 err = pw_t6_axpy(pw_t6_axpy(k1, -2.0, k2), 1.0, k3);
    pw_t6 sum = pw_t6_axpy(pw_t6_axpy(k1, 4.0, k2), 1.0, k3);
    pw_t6 stress = pw_t6_axpy(pw_t6_load(s.stress + i, ld), sixth, sum);
    pw_real on_stress = pw_t6_norm(err) / (pw_t6_norm(stress) + 1000.0);
    k1 = pw_t6_load(s.d[0] + i, ld);
    k2 = pw_t6_load(s.d[1] + i, ld);
    k3 = pw_t6_load(s.d[2] + i, ld);
    err = pw_t6_axpy(pw_t6_axpy(k1, -2.0, k2), 1.0, k3);
    sum = pw_t6_axpy(pw_t6_axpy(k1, 4.0, k2), 1.0, k3);
    pw_t6 delta = pw_t6_axpy(pw_t6_load(s.delta + i, ld), sixth, sum);
    pw_real on_delta = pw_t6_norm(err) * h.inv_r;
    s.able[i] *= pw_hypo_inside_stress(&h, stress);
    s.error[i] = sixth * (on_delta > on_stress ? on_delta : on_stress);
    pw_t6_store(stress, s.at + i, ld);
    pw_t6_store(pw_hypo_clip(&h, delta), s.at_delta + i, ld);
  }
}

/** Rates of the lanes of one stage; instances of pw_hypo_stage_lanes(), or those of another model
 *  whose constants begin with a pw_hypo. */
typedef void (*pw_hypo_stage_fn)(const pw_hypo *h, const pw_hypo_stage *stage);

/** Likewise of pw_hypo_heun_lanes(). */
typedef void (*pw_hypo_heun_fn)(const pw_hypo *h, const pw_hypo_substep *s, pw_real *good);

/** Lanes of the two passes over a batch. Many points need one substep: a multiple of any vector
 *  length, few enough to stay in cache. Few of them need more. */
enum { PW_HYPO_LANES = 16, PW_HYPO_REST_LANES = 4 };

/** @brief pw_hypo_advance_smooth() with the rates of a model.
 *  @param[in] rates of a stage that is not the last, and of the last; PW_HYPO_LANES lanes
 *  @param[in] heun  likewise; NULL where it is not tried */
void pw_hypo_smooth_with(const pw_hypo *h, const pw_hypo_stage_fn rates[2], pw_hypo_heun_fn heun,
                         bool plane, const pw_stress_args *a, pw_real *done);

/** @brief pw_hypo_advance_rest() likewise; PW_HYPO_REST_LANES lanes. */
void pw_hypo_rest_with(const pw_hypo *h, const pw_hypo_stage_fn rates[2], bool plane,
                       const pw_stress_args *a, pw_real *done);

/**
 * Define the table `name`[form][last] of the instances for @p n lanes, one for each pair of
 * literals, so that their loops hold no branches.
 */
#define PW_HYPO_STAGE(form, last, n)                                                               \
  static void stage_##form##_##last(const pw_hypo *h, const pw_hypo_stage *s)                      \
  {                                                                                                \
    pw_hypo_stage_lanes(h, s, n, form, last);                                                      \
  }
#define PW_HYPO_STAGES(name, n)                                                                    \
  PW_HYPO_STAGE(0, 0, n)                                                                           \
  PW_HYPO_STAGE(0, 1, n)                                                                           \
  PW_HYPO_STAGE(1, 0, n)                                                                           \
  PW_HYPO_STAGE(1, 1, n)                                                                           \
  PW_HYPO_STAGE(2, 0, n)                                                                           \
  PW_HYPO_STAGE(2, 1, n)                                                                           \
  PW_HYPO_STAGE(3, 0, n)                                                                           \
  PW_HYPO_STAGE(3, 1, n)                                                                           \
  static const pw_hypo_stage_fn name[PW_HYPO_FORMS][2] = {{stage_0_0, stage_0_1},                  \
                                                          {stage_1_0, stage_1_1},                  \
                                                          {stage_2_0, stage_2_1},                  \
                                                          {stage_3_0, stage_3_1}}

/** @brief One substep of @p n lanes.
 *  @param[in] rates row h->form of the table of instances */
PW_INLINE void pw_hypo_substep_lanes(const pw_hypo *h, const pw_hypo_substep *s, int n,
                                     const pw_hypo_stage_fn rates[2])
{
  pw_hypo_stage g = {s->stress, s->delta, s->void_ratio[0], s->de,     s->size,
                     s->k[0],   s->d[0],  s->able,          s->modulus};
  rates[0](h, &g);
  pw_hypo_next_stage(s, n, 1);
  g.stress = s->at;
  g.delta = s->at_delta;
  g.void_ratio = s->void_ratio[1];
  g.k = s->k[1];
  g.d = s->d[1];
  rates[0](h, &g);
  pw_hypo_next_stage(s, n, 2);
  g.void_ratio = s->void_ratio[2];
  g.k = s->k[2];
  g.d = s->d[2];
  rates[1](h, &g);
  pw_hypo_combine(h, s, n);
}

#endif /* PW_KERNELS_HYPOPLASTIC_LANES_H */
