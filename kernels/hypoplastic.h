/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/hypoplastic.h
 * @brief Hypoplastic sand with intergranular strain: rates, integration, tangent (layer 1).
 *
 * Rates: von Wolffersdorff, Mech. Cohes.-Frict. Mater. 1 (1996) 251-271; intergranular strain:
 * Niemunis, Herle, Mech. Cohes.-Frict. Mater. 2 (1997) 279-299. With sigma* = sigma - p_t 1,
 * s = sigma* / tr sigma*, s' = s - 1/3 and d = delta / |delta|, rho = |delta| / R:
 *
 *     L = f_b f_e / (s:s) (F^2 I + a^2 s s),   N = f_b f_e f_d a F / (s:s) (s + s')
 *     without intergranular strain:  sigma_dot = L:D + N |D|
 *     with it:  sigma_dot = M:D,  delta_dot = D - rho^beta_r d (d:D) if d:D > 0, else D
 *
 * Stress is integrated in the time of the increment, t in [0, 1], by an embedded Runge-Kutta pair
 * of orders 3(2) with error control, in two parts where delta:D changes sign. An
 * increment for which Heun's method is within the tolerance is one step of that. States below the
 * least pressure or beyond the limiting stress ratio are moved back to it.
 */
#ifndef PW_KERNELS_HYPOPLASTIC_H
#define PW_KERNELS_HYPOPLASTIC_H

#include "kernels/material.h"
#include "kernels/tensor.h"

/** Parameters in the order of the model's keys. */
enum {
  PW_HYPO_GRAIN_DENSITY,
  PW_HYPO_VOID_RATIO,
  PW_HYPO_VOID_RATIO_RULE,
  PW_HYPO_PHI_C,
  PW_HYPO_P_T,
  PW_HYPO_H_S,
  PW_HYPO_N,
  PW_HYPO_E_D0,
  PW_HYPO_E_C0,
  PW_HYPO_E_I0,
  PW_HYPO_ALPHA,
  PW_HYPO_BETA,
  PW_HYPO_INTERGRANULAR,
  PW_HYPO_M_R,
  PW_HYPO_M_T,
  PW_HYPO_R,
  PW_HYPO_BETA_R,
  PW_HYPO_CHI,
  PW_HYPO_INITIAL_DELTA,
  PW_HYPO_TOLERANCE,
  PW_HYPO_P_MIN,
  PW_HYPO_PHI_LIMIT,
  PW_HYPO_MAX_SUBSTEPS,
  PW_HYPO_STEP_RATIO,
  PW_HYPO_PARAMS
};

/** Choices of void_ratio_rule and of initial_intergranular. */
enum { PW_HYPO_RULE_CURRENT, PW_HYPO_RULE_BAUER };
enum { PW_HYPO_DELTA_ZERO, PW_HYPO_DELTA_ISOTROPIC, PW_HYPO_DELTA_OEDOMETRIC };

/** Rows of the state array; a point without intergranular strain carries the first only. */
enum { PW_HYPO_STATE_VOID_RATIO, PW_HYPO_STATE_DELTA, PW_HYPO_STATE_SUBSTEP = 7 };

/** Largest max_substeps a scene may ask for. */
enum { PW_HYPO_SUBSTEP_LIMIT = 1000, PW_HYPO_PATH_STEPS = PW_HYPO_SUBSTEP_LIMIT + 8 };

/** Forms of the rates: with intergranular strain; with beta = chi = 1, which saves two powers. */
enum { PW_HYPO_WITH = 1, PW_HYPO_UNIT = 2, PW_HYPO_FORMS = 4 };

/** What follows from a parameter set alone; made once per batch. */
typedef struct pw_hypo {
  pw_real p_t, inv_h_s, n, alpha, beta;
  pw_real e_d0, e_i0, e_c0, log_e_c0, inv_e_i0, inv_e_range; /**< 1/(e_c0 - e_d0) */
  pw_real a, a2, k_b; /**< k_b: f_b without its pressure and void ratio terms; Pa */
  pw_real m_r, m_t, r, inv_r2, beta_r, chi;
  pw_real inv_r; /**< 0 without intergranular strain */
  pw_real near;  /**< largest relative change of a base over which powers follow by series */
  pw_real tolerance, p_min, x_limit; /**< x_limit: largest I1 I2 / I3 */
  pw_real speed_linear, speed_n;     /**< parts of L and N in the modulus of the wave speed */
  int max_substeps;
  int form; /**< of the rates: PW_HYPO_WITH + PW_HYPO_UNIT */
  bool intergranular;
} pw_hypo;

/** One point: Cauchy stress (Pa), intergranular strain, void ratio, first substep to try. */
typedef struct pw_hypo_point {
  pw_t6 stress, delta;
  pw_real void_ratio;
  pw_real substep; /**< fraction of the increment, in (0, 1] */
} pw_hypo_point;

/** Rates and their factors at one state, for tests and reports. */
typedef struct pw_hypo_rates {
  pw_t6 stress, delta; /**< Pa, - per unit of strain time */
  pw_real void_ratio;
  pw_real f_b, f_e, f_d, f; /**< f_b in Pa; f is F of Matsuoka-Nakai */
  pw_real cos_3theta, tan_psi;
  pw_real modulus; /**< of the largest wave speed; Pa */
} pw_hypo_rates;

/** How a substep was made: by the Runge-Kutta pair; by it, and delta then fully mobilised in the
 *  direction of the increment; as a whole, for a point that stays stress-free; by Heun's method. */
enum { PW_HYPO_RUNGE_KUTTA, PW_HYPO_SWEPT, PW_HYPO_SEPARATED, PW_HYPO_HEUN };

/** The accepted substeps of an integration, to repeat it with another increment. */
typedef struct pw_hypo_path {
  int n;
  pw_real split;                   /**< time at which delta:D changes sign, 0 if it does not */
  pw_real end[PW_HYPO_PATH_STEPS]; /**< time at the end of each */
  unsigned char kind[PW_HYPO_PATH_STEPS]; /**< PW_HYPO_RUNGE_KUTTA ... */
} pw_hypo_path;

/** @brief Constants of a parameter set that passed the model's check.
 *  @param[in] param [PW_HYPO_PARAMS] in the units of the keys */
void pw_hypo_derive(const pw_real *param, pw_hypo *h);

/** @brief Rates for the strain rate @p d; no limits applied to the state.
 *  @param[in] d strain rate, tensor shears; 1 per unit of time */
void pw_hypo_evaluate(const pw_hypo *h, const pw_hypo_point *p, pw_t6 d, pw_hypo_rates *out);

/** @brief True when a stress keeps the least pressure and the limiting stress ratio.
 *  @param[in] shifted sigma* = sigma - p_t 1; Pa */
bool pw_hypo_inside(const pw_hypo *h, pw_t6 shifted);

/** @brief The nearest stress with the same mean and a smaller deviator (and, below the least
 *  pressure, that pressure) which pw_hypo_inside() accepts. @param[in] shifted sigma*; Pa */
pw_t6 pw_hypo_limit(const pw_hypo *h, pw_t6 shifted);

/**
 * @brief Advance one point over an increment of strain; the caller has rotated it already.
 * @param[in]     de     strain increment, tensor shears; -
 * @param[in]     dvol   volume ratio of the step, J(n+1)/J(n); 1 + e is multiplied by it
 * @param[in,out] p      the point; unchanged on failure
 * @param[out]    path   the accepted substeps, or NULL
 * @param[in,out] counts added to, or NULL
 * @param[out]    modulus of the largest wave speed at the end, or NULL; Pa
 * @return PW_OK; PW_RETRY_STRESS when a number is not finite or the void ratio would fall to zero.
 */
pw_status pw_hypo_integrate(const pw_hypo *h, pw_t6 de, pw_real dvol, pw_hypo_point *p,
                            pw_hypo_path *path, pw_material_counts *counts, pw_real *modulus);

/**
 * @brief Advance the points of a batch that are done with one substep, several at once.
 *
 * One substep of pw_hypo_integrate() in vector registers for every point; its result is kept
 * where the error is within the tolerance, delta:D does not change sign and no limit is met. A
 * point's result does not depend on the others nor on its place in the batch.
 * @param[in]     plane the spins yz and zx are zero
 * @param[in,out] a     stress, state, wave_speed and counts of the points done are written
 * @param[out]    done  [a->n] 1 for a point advanced, 0 for one left as it was
 */
void pw_hypo_advance_smooth(const pw_hypo *h, bool plane, const pw_stress_args *a, pw_real *done);

/**
 * @brief Advance the points that need several substeps, a few at once.
 *
 * The substeps of pw_hypo_integrate() in vector registers; points that meet a limit of stress or
 * of the number of substeps are left for it. Independent of the other points as above.
 * @param[in,out] done  points with 1 are skipped; set to 1 for a point advanced here
 */
void pw_hypo_advance_rest(const pw_hypo *h, bool plane, const pw_stress_args *a, pw_real *done);

/** @brief Point @p i of a batch, rotated by its spin; @p plane: its spins yz and zx are zero. */
pw_hypo_point pw_hypo_read(const pw_hypo *h, const pw_stress_args *a, bool plane, pw_idx i);

/** @brief Write stress and state of point @p i of a batch. */
void pw_hypo_write(const pw_hypo *h, const pw_stress_args *a, const pw_hypo_point *p, pw_idx i);

/** @brief As pw_hypo_integrate() with the substeps of @p path and no error control. They are
 *  stretched in both parts so that delta:D changes sign between the same two of them. */
pw_status pw_hypo_repeat(const pw_hypo *h, pw_t6 de, pw_real dvol, pw_hypo_point *p,
                         const pw_hypo_path *path);

/**
 * @brief d stress(end) / d strain increment by six one-sided differences on the same substeps.
 *
 * Where no direction is known (no increment) or the point is separated it is m_R L.
 * @param[in]  start   the rotated point at the start of the increment
 * @param[in]  end     its stress at the end; Pa
 * @param[in]  path    the substeps that led there
 * @param[out] tangent [36] row-major, engineering shear columns; Pa
 */
void pw_hypo_tangent(const pw_hypo *h, pw_t6 de, pw_real dvol, const pw_hypo_point *start,
                     pw_t6 end, const pw_hypo_path *path, pw_real *tangent);

/** @brief Matsuoka-Nakai friction angle: sin^2 = (X - 9)/(X - 1), X = I1 I2 / I3 of -sigma*; rad.
 *  pi/2 for a stress with a tensile principal value. @param[in] shifted sigma*; Pa */
pw_real pw_hypo_friction_angle(pw_t6 shifted);

#endif /* PW_KERNELS_HYPOPLASTIC_H */
