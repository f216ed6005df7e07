/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mass integrals of the shapes. At each height a shape is a span [a, b] of x. Rounded parts are
 * integrated over the angle of their ellipse, where the integrand is smooth, by Gauss' rule of five
 * points on equal pieces; straight parts are polynomials that one piece integrates exactly. */
#include "engine/structure_parts.h"

#include <math.h>

#include "engine/bodies_shapes.h"

enum { GAUSS = 5, PIECES = 16 };

/* One part of a shape, of heights y = low + rise: straight (the half width goes from w0 to w1) or
 * an ellipse whose lower vertex is at the height low. */
typedef struct part {
  bool ellipse;
  pw_real low, high;
  pw_real w0, w1;         /* straight */
  pw_real radius, height; /* ellipse: half axes along x and y */
} part;

typedef struct shape {
  bool axi;
  pw_real middle; /* of the span, from the axis or from x = 0; m */
  bool from_axis; /* axisymmetric span [0, half width] */
} shape;

/* Add weight dy times the integrals over the span of half width w at the height y. */
static void add_span(const shape *s, pw_real y, pw_real w, pw_real weight, pw_slice *sum)
{
  pw_real a = s->from_axis ? 0.0 : -w, b = w, area, wide2;
  if (s->axi) {
    a = s->from_axis ? 0.0 : s->middle - w;
    b = s->from_axis ? w : s->middle + w;
    area = 0.5 * (b * b - a * a);
    wide2 = 0.25 * (b * b * b * b - a * a * a * a);
  } else {
    area = b - a;
    wide2 = (b * b * b - a * a * a) / 3.0;
  }
  sum->vol += weight * area;
  sum->y += weight * area * y;
  sum->yy += weight * area * y * y;
  sum->wide2 += weight * wide2;
}

static pw_real angle_at(const part *p, pw_real y)
{
  return acos(pw_max(-1.0, pw_min(1.0, 1.0 - (y - p->low) / p->height)));
}

static void add_part(const shape *s, const part *p, pw_real y0, pw_real y1, pw_slice *sum)
{
  static const pw_real place[GAUSS] = {-0.906179845938663992797627, -0.538469310105683091036314,
                                       0.0, 0.538469310105683091036314, 0.906179845938663992797627};
  static const pw_real weight[GAUSS] = {0.236926885056189087514264, 0.478628670499366468041292,
                                        0.568888888888888888888889, 0.478628670499366468041292,
                                        0.236926885056189087514264};
  pw_real lo = pw_max(y0, p->low), hi = pw_min(y1, p->high);
  if (!(hi > lo)) {
    return;
  }
  const int pieces = p->ellipse ? PIECES : 1;
  pw_real from = p->ellipse ? angle_at(p, lo) : lo, to = p->ellipse ? angle_at(p, hi) : hi;
  for (int k = 0; k < pieces; k++) {
    pw_real half = 0.5 * (to - from) / pieces, mid = from + (2 * k + 1) * half;
    for (int g = 0; g < GAUSS; g++) {
      pw_real at = mid + half * place[g];
      if (p->ellipse) {
        add_span(s, p->low + p->height * (1.0 - cos(at)), p->radius * sin(at),
                 half * weight[g] * p->height * sin(at), sum);
      } else {
        pw_real share = (at - p->low) / (p->high - p->low);
        add_span(s, at, p->w0 + (p->w1 - p->w0) * share, half * weight[g], sum);
      }
    }
  }
}

pw_real pw_shape_extent(const pw_scene *scene, int body, pw_real *y)
{
  const pw_scene_body *b = &scene->body[body];
  if (b->shape == PW_SHAPE_RECTANGLE) {
    y[0] = b->y_m[0];
    y[1] = b->y_m[1];
    return scene->geometry == PW_AXI ? 0.0 : 0.5 * (b->x_m[0] + b->x_m[1]);
  }
  bool pile = b->shape == PW_SHAPE_PILE;
  y[0] = pile ? b->tip_y_m : b->centre_m[1] - b->radius_m;
  y[1] = pile ? b->tip_y_m + b->length_m : b->centre_m[1] + b->radius_m;
  return scene->geometry == PW_AXI ? 0.0 : b->centre_m[0];
}

pw_slice pw_shape_slice(const pw_scene *scene, int body, pw_real y0, pw_real y1)
{
  const pw_scene_body *b = &scene->body[body];
  shape s = {.axi = scene->geometry == PW_AXI, .middle = b->centre_m[0]};
  pw_real y[2];
  pw_slice sum = {0.0, 0.0, 0.0, 0.0};
  pw_shape_extent(scene, body, y);
  part p = {.low = y[0], .high = y[1], .w0 = b->radius_m, .w1 = b->radius_m};
  if (b->shape == PW_SHAPE_RECTANGLE) {
    s.middle = 0.5 * (b->x_m[0] + b->x_m[1]);
    p.w0 = p.w1 = 0.5 * (b->x_m[1] - b->x_m[0]);
  } else if (b->shape == PW_SHAPE_DISC) {
    p.ellipse = true;
    p.radius = p.height = b->radius_m;
  } else {
    pw_real tip = pw_pile_tip_height(b);
    s.from_axis = s.axi;
    p.low += tip;
    part end = {.ellipse = b->tip == PW_TIP_ROUNDED,
                .low = y[0],
                .high = p.low,
                .w1 = b->radius_m,
                .radius = b->radius_m,
                .height = tip};
    add_part(&s, &end, y0, y1, &sum);
  }
  add_part(&s, &p, y0, y1, &sum);
  return sum;
}
