/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/hypoplastic_clay.h
 * @brief Hypoplastic clay with intergranular strain: rates and their integration (layer 1).
 *
 * The model of 2005: Masin, Int. J. Numer. Anal. Meth. Geomech. 29 (2005) 311-336, with the
 * intergranular strain of Niemunis, Herle, Mech. Cohes.-Frict. Mater. 2 (1997) 279-299. With
 * s = sigma/tr sigma, s' = s - 1/3, F as for sand (kernels/hypoplastic_rates.h), p = -tr sigma/3:
 *
 *     sigma_dot = f_s (L:D + f_d N |D|),   L = 3 (c1 I + c2 a^2 s s),   N = -L:(Y m/|m|)
 *     m = -a/F [s + s' - s/3 (6 s:s - 1)/((F/a)^2 + s:s)]
 *     Y = (y - 1) (I1 I2 + 9 I3)(1 - sin^2 phi)/(8 I3 sin^2 phi) + y,   y = sqrt3 a/(3 + a^2)
 *     f_s = 3 p/lambda* (3 + a^2 - 2^alpha a sqrt3)^-1,   f_d = (2 p/p_e)^alpha
 *     p_e = p_r exp((N - ln(1 + e))/lambda*),   p_r = 1 kPa
 *     alpha = log2[(lambda* - kappa*)/(lambda* + kappa*) / y]
 *     c1 = 2 (3 + a^2 - 2^alpha a sqrt3)/(9 r),   c2 = 1 + (1 - c1) 3/a^2
 *
 * where I2 = (sigma:sigma - (tr sigma)^2)/2. Isotropic virgin compression follows ln(1 + e) = N -
 * lambda* ln(p/p_r) and starts to swell with kappa*; f_d = 1 on the critical state line, where flow
 * keeps the volume and the stress is on the Matsuoka-Nakai cone: tests check these.
 */
#ifndef PW_KERNELS_HYPOPLASTIC_CLAY_H
#define PW_KERNELS_HYPOPLASTIC_CLAY_H

#include "kernels/hypoplastic.h"

/** Parameters in the order of the model's keys. */
enum {
  PW_CLAY_PHI_C,
  PW_CLAY_LAMBDA,
  PW_CLAY_KAPPA,
  PW_CLAY_N,
  PW_CLAY_RATIO,
  PW_CLAY_VOID_RATIO,
  PW_CLAY_OCR,
  PW_CLAY_DENSITY,
  PW_CLAY_INTERGRANULAR,
  PW_CLAY_M_R,
  PW_CLAY_M_T,
  PW_CLAY_R,
  PW_CLAY_BETA_R,
  PW_CLAY_CHI,
  PW_CLAY_INITIAL_DELTA,
  PW_CLAY_TOLERANCE,
  PW_CLAY_P_MIN,
  PW_CLAY_PHI_LIMIT,
  PW_CLAY_MAX_SUBSTEPS,
  PW_CLAY_PARAMS
};

/** Reference pressure of N; Pa. */
#define PW_CLAY_P_R 1000.0

/** Largest f_d Y. It is 2^alpha y < 1 on the virgin line, 1 at critical states and on the bounding
 *  surface; far outside of it, where soil has come apart, N would let the stress grow without
 *  bound whatever the direction of strain. */
#define PW_CLAY_N_MAX 1.2

/** What follows from a parameter set alone. */
typedef struct pw_clay {
  pw_hypo limits; /**< what integrations share with the sand: least pressure, limiting stress ratio,
                       tolerance, substeps, R; the first member, so that a pointer to it is one to
                       the whole */
  pw_real inv_lambda, n, inv_a, y, alpha, y_slope; /**< y_slope: of Y over (I1 I2 + 9 I3)/I3 */
  pw_real c1, c2a, stiff;                          /**< c2a: c2 a^2; stiff: f_s/p */
  pw_real m_r, m_t, r, inv_r2, beta_r, chi, tolerance;
  bool intergranular;
  int max_substeps;
} pw_clay;

/** Rates of one state. */
typedef struct pw_clay_rates {
  pw_t6 stress, delta; /**< Pa, - per unit of strain time */
  pw_t6 n;             /**< f_s f_d N; Pa */
  pw_real f_s, f_d, y; /**< f_s in Pa; y: Y */
  pw_real modulus;     /**< of the largest wave speed; Pa */
} pw_clay_rates;

/** @brief Constants of a parameter set that passed the model's check. */
void pw_clay_derive(const pw_real *param, pw_clay *c);

/** @brief Rates for the strain rate @p d; no limits applied to the state. */
pw_clay_rates pw_clay_evaluate(const pw_clay *c, const pw_hypo_point *p, pw_t6 d);

/** @brief Advance a point; arguments and return as of pw_hypo_integrate(). */
pw_status pw_clay_integrate(const pw_clay *c, pw_t6 de, pw_real dvol, pw_hypo_point *p,
                            pw_hypo_path *path, pw_material_counts *counts);

/** @brief The same with the substeps of @p path and no error control. */
pw_status pw_clay_repeat(const pw_clay *c, pw_t6 de, pw_real dvol, pw_hypo_point *p,
                         const pw_hypo_path *path);

/** @brief Advance the points of a batch that one substep or a few do for, several at once in vector
 *  registers; as pw_hypo_advance_smooth() and pw_hypo_advance_rest() do for sand.
 *  @param[out] done [a->n] 1 for a point advanced, 0 for one left as it was */
void pw_clay_advance(const pw_clay *c, bool plane, const pw_stress_args *a, pw_real *done);

/** @brief d stress(end)/d strain increment by central differences on the substeps of @p path; for
 *  no increment the linear part at the start. @param[out] tangent as of pw_hypo_tangent(). */
void pw_clay_tangent(const pw_clay *c, pw_t6 de, pw_real dvol, const pw_hypo_point *start,
                     const pw_hypo_path *path, pw_real *tangent);

#endif /* PW_KERNELS_HYPOPLASTIC_CLAY_H */
