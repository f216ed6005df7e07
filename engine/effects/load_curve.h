/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/load_curve.h
 * @brief Ramps and pulses in time, integrated exactly over a step (layer 3).
 *
 * A step takes the mean of a curve over [t, t + dt], so that the impulse given to a body is that
 * of the curve whatever the steps. All values are fractions of the curve's peak.
 */
#ifndef PW_EFFECTS_LOAD_CURVE_H
#define PW_EFFECTS_LOAD_CURVE_H

#include "engine/core/types.h"

/** A train of equal pulses. */
typedef struct pw_pulse {
  int shape;        /**< pw_pulse_shape */
  pw_real start;    /**< of the first pulse; s */
  pw_real duration; /**< s, > 0 */
  pw_real rise;     /**< rectangular: length of the linear rise from the start and of the linear
                         fall from start + duration, <= duration; s. The impulse is that of the
                         pulse without ramps. */
  pw_real period;   /**< between starts; s, > 0 when count > 1 */
  int count;
} pw_pulse;

/** @brief Ramp at @p t: 0 before @p start, 1 from start + length; length 0 is a step. */
pw_real pw_ramp(pw_real t, pw_real start, pw_real length);

/** @brief Mean of the ramp over [t, t + dt]; dt > 0. */
pw_real pw_ramp_mean(pw_real t, pw_real dt, pw_real start, pw_real length);

/** @brief Mean of the pulse train over [t, t + dt]; dt > 0. */
pw_real pw_pulse_mean(const pw_pulse *p, pw_real t, pw_real dt);

/** @brief Integral of one pulse: duration (rectangular, with or without ramps) or
 *  2 duration / pi (half sine of the same peak); s. */
pw_real pw_pulse_impulse(const pw_pulse *p);

/** @brief Pulses that have started at time @p t: 0 .. count; one starts at its start itself. */
int pw_pulse_started(const pw_pulse *p, pw_real t);

#endif /* PW_EFFECTS_LOAD_CURVE_H */
