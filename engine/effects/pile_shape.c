/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effects/pile_shape.h"

#include <math.h>

enum { SAMPLES = 16, HALVINGS = 50 };

pw_pile_shape pw_pile_shape_of(const pw_scene_body *body)
{
  pw_real tip = body->tip_length_m > 0.0 ? body->tip_length_m : body->radius_m;
  return (pw_pile_shape){.tip = body->tip,
                         .radius = body->radius_m,
                         .tip_length = body->tip == PW_TIP_FLAT ? 0.0 : tip,
                         .length = body->length_m};
}

/* Half the derivative, by the angle, of the squared distance from (x, up), up from the ellipse's
 * centre, to (a cos, -b sin). */
static pw_real slope(pw_real a, pw_real b, pw_real x, pw_real up, pw_real angle)
{
  pw_real c = cos(angle), s = sin(angle);
  return a * s * (x - a * c) + b * c * (up + b * s);
}

static pw_real distance(pw_real a, pw_real b, pw_real x, pw_real up, pw_real angle)
{
  return hypot(x - a * cos(angle), up + b * sin(angle));
}

/* Distance to the lower right quarter of an ellipse: the best of a few places, then the zero of
 * the slope around it. */
static pw_real to_quarter(pw_real a, pw_real b, pw_real x, pw_real up)
{
  const pw_real step = 1.57079632679489662 / SAMPLES;
  pw_real least = distance(a, b, x, up, 0.0);
  int best = 0;
  for (int k = 1; k <= SAMPLES; k++) {
    pw_real d = distance(a, b, x, up, k * step);
    best = d < least ? k : best;
    least = pw_min(least, d);
  }
  pw_real lo = step * (best > 0 ? best - 1 : 0), hi = step * (best < SAMPLES ? best + 1 : SAMPLES);
  for (int k = 0; k < HALVINGS; k++) {
    pw_real mid = 0.5 * (lo + hi);
    if (slope(a, b, x, up, mid) > 0.0) {
      hi = mid;
    } else {
      lo = mid;
    }
  }
  return pw_min(least, distance(a, b, x, up, 0.5 * (lo + hi)));
}

pw_real pw_pile_depth(const pw_pile_shape *s, pw_real x, pw_real z)
{
  const pw_real a = s->radius, b = s->tip_length;
  x = fabs(x);
  pw_real depth = pw_min(pw_min(a - x, s->length - z), z);
  if (depth <= 0.0 || s->tip == PW_TIP_FLAT) {
    return pw_max(depth, 0.0);
  }
  if (s->tip == PW_TIP_CONICAL) {
    return pw_max(pw_min(depth, (a * z - b * x) / hypot(a, b)), 0.0);
  }
  pw_real up = z - b;
  if (up < 0.0 && x * x / (a * a) + up * up / (b * b) >= 1.0) {
    return 0.0;
  }
  return pw_min(depth, to_quarter(a, b, x, up));
}
