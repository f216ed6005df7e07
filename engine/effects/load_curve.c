/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effects/load_curve.h"

#include <math.h>

#include "engine/effects/params.h"

static const pw_real pi = PW_PI;

pw_real pw_ramp(pw_real t, pw_real start, pw_real length)
{
  if (t < start) {
    return 0.0;
  }
  return t - start < length ? (t - start) / length : 1.0;
}

pw_real pw_ramp_mean(pw_real t, pw_real dt, pw_real start, pw_real length)
{
  pw_real end = t + dt, full = start + length;
  pw_real a = pw_max(t, start), b = pw_min(end, full), c = pw_max(t, full), sum = 0.0;
  if (b > a) {
    sum += (b - a) * (0.5 * (a + b) - start) / length;
  }
  if (end > c) {
    sum += end - c;
  }
  return sum / dt;
}

/* Mean over [t, t + dt] of one pulse that starts at s. */
static pw_real one_pulse(const pw_pulse *p, pw_real t, pw_real dt, pw_real s)
{
  if (p->shape == PW_PULSE_RECTANGULAR) {
    return pw_ramp_mean(t, dt, s, p->rise) - pw_ramp_mean(t, dt, s + p->duration, p->rise);
  }
  pw_real a = pw_max(t, s) - s, b = pw_min(t + dt, s + p->duration) - s;
  if (b <= a) {
    return 0.0;
  }
  pw_real w = pi / p->duration;
  return 2.0 / (w * dt) * sin(0.5 * w * (a + b)) * sin(0.5 * w * (b - a));
}

pw_real pw_pulse_mean(const pw_pulse *p, pw_real t, pw_real dt)
{
  pw_real length = p->duration + (p->shape == PW_PULSE_RECTANGULAR ? p->rise : 0.0);
  pw_real sum = 0.0;
  int last = pw_pulse_started(p, t + dt) - 1, first = 0;
  if (p->count > 1 && t - length > p->start) {
    first = (int)pw_min(floor((t - length - p->start) / p->period), (pw_real)p->count);
  }
  for (int k = first; k <= last; k++) {
    sum += one_pulse(p, t, dt, p->start + (pw_real)k * p->period);
  }
  return sum;
}

pw_real pw_pulse_impulse(const pw_pulse *p)
{
  return p->shape == PW_PULSE_RECTANGULAR ? p->duration : 2.0 / pi * p->duration;
}

int pw_pulse_started(const pw_pulse *p, pw_real t)
{
  if (p->count < 1 || t < p->start) {
    return 0;
  }
  if (p->count == 1) {
    return 1;
  }
  return (int)pw_min(floor((t - p->start) / p->period) + 1.0, (pw_real)p->count);
}
