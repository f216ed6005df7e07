/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/modified_cam_clay.h
 * @brief The equation of a plastic step of modified Cam clay and the search for its root (layer 1).
 *
 * Free of branches, for several points at once; the equation is derived in
 * kernels/material_modified_cam_clay.c. Compression is positive.
 */
#ifndef PW_KERNELS_MODIFIED_CAM_CLAY_H
#define PW_KERNELS_MODIFIED_CAM_CLAY_H

#include "kernels/explog.h"

#include <math.h>

/** A step of one point; compression positive. */
typedef struct pw_mcc_step {
  pw_real lambda, soft, slope; /* lambda, lambda - kappa, M */
  pw_real stiff;               /* M^2/(6 G) */
  pw_real mean_volume;         /* v that times the volume strain gives v - v_n */
  pw_real base;                /* lambda ln p of an isotropic virgin state with this v */
  pw_real log_pc0;
  pw_real q_trial;
} pw_mcc_step;

/** The equation at n = q/p, and what belongs to n. */
typedef struct pw_mcc_residual {
  pw_real n, p, pc, plastic; /* plastic: volume strain */
  pw_real log_p_n;           /* d ln p/d n */
  pw_real value, slope;
} pw_mcc_residual;

PW_INLINE pw_mcc_residual pw_mcc_evaluate(const pw_mcc_step *t, pw_real n)
{
  const pw_real r2 = n * n / (t->slope * t->slope), size = pw_log(1.0 + r2);
  const pw_real size_n = 2.0 * n / (t->slope * t->slope + n * n);
  pw_mcc_residual r = {.n = n, .log_p_n = -t->soft / t->lambda * size_n};
  pw_real log_p = (t->base - t->soft * size) / t->lambda;
  r.p = pw_exp(log_p);
  r.pc = r.p * (1.0 + r2);
  r.plastic = t->soft * (log_p + size - t->log_pc0) / t->mean_volume;
  pw_real plastic_n = t->soft * (r.log_p_n + size_n) / t->mean_volume;
  pw_real rest = t->q_trial - n * r.p; /* 3 G times the plastic shear strain */
  r.value = n * r.plastic - t->stiff * rest * (1.0 - r2);
  pw_real rest_n = -r.p * (1.0 + n * r.log_p_n);
  pw_real way_n = -2.0 * n / (t->slope * t->slope);
  r.slope = r.plastic + n * plastic_n - t->stiff * (rest_n * (1.0 - r2) + rest * way_n);
  return r;
}

/** Where a search for the root is: between low of negative and high of positive residual. */
typedef struct pw_mcc_search {
  pw_real low, high, x, value, slope;
  pw_real busy; /* 1 until x rests */
} pw_mcc_search;

/** The next step of a search; one that rests stays as it is. */
PW_INLINE pw_mcc_search pw_mcc_seek(const pw_mcc_step *t, pw_mcc_search s)
{
  const bool under = s.value < 0.0;
  pw_real low = under ? s.x : s.low, high = under ? s.high : s.x;
  pw_real next = s.x - s.value / s.slope;
  next = (next - low) * (next - high) <= 0.0 ? next : 0.5 * (low + high);
  const pw_mcc_residual r = pw_mcc_evaluate(t, next);
  const pw_real still = fabs(next - s.x) > 1e-14 * fabs(next) ? 1.0 : 0.0;
  const bool busy = s.busy > 0.0;
  return (pw_mcc_search){.low = busy ? low : s.low,
                         .high = busy ? high : s.high,
                         .x = busy ? next : s.x,
                         .value = busy ? r.value : s.value,
                         .slope = busy ? r.slope : s.slope,
                         .busy = busy ? still : 0.0};
}

/** A search on the wet (n < M) or dry side, from where the root is near in small steps. */
PW_INLINE pw_mcc_search pw_mcc_begin(const pw_mcc_step *t, pw_real p, pw_real pc)
{
  const pw_real excess = pc / p - 1.0, end = t->slope * sqrt(excess > 1.0 ? excess : 1.0);
  const bool dry = 2.0 * p < pc;
  const pw_real low = dry ? t->slope : 0.0, high = dry ? end : t->slope, near = t->q_trial / p;
  const pw_real x = (near - low) * (near - high) < 0.0 ? near : 0.5 * (low + high);
  const pw_mcc_residual r = pw_mcc_evaluate(t, x);
  return (pw_mcc_search){low, high, x, r.value, r.slope, 1.0};
}

#endif /* PW_KERNELS_MODIFIED_CAM_CLAY_H */
