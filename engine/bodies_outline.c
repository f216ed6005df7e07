/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Outlines. A closed line is not ended by its first vertex again. A rectangle starts at its lower
 * left corner, a ring at its first angle, a disc and a pile at their lowest point; so the half pile
 * of axisymmetry runs from the tip's centre along the tip, up the shaft and back to the axis along
 * the head. Vertices lie on the exact curve. A piece of a pile belongs to the tip when both its ends
 * do; the vertex between tip and shaft does.
 */
#include "engine/bodies_shapes.h"

#include <math.h>

static const pw_real pi = PW_PI;
static const pw_real most_vertices = 1e8;

typedef struct {
  pw_real *xy;
  bool *tip;
  pw_real max, n; /* n is real: an absurd count does not overflow */
  pw_real segment;
} line;

static void add_vertex(line *l, pw_real x, pw_real y, bool tip)
{
  if (l->xy && l->n < l->max) {
    int i = (int)l->n;
    l->xy[2 * i] = x;
    l->xy[2 * i + 1] = y;
    if (l->tip) {
      l->tip[i] = tip;
    }
  }
  l->n++;
}

/* Vertices from a to b without b; tip is for those behind a. */
static void add_straight(line *l, const pw_real *a, const pw_real *b, bool first_tip, bool tip)
{
  pw_real dx = b[0] - a[0], dy = b[1] - a[1];
  pw_real pieces = pw_body_pieces(hypot(dx, dy), l->segment);
  if (!(pieces < most_vertices)) {
    l->n = INFINITY;
    return;
  }
  for (pw_real k = 0; k < pieces; k++) {
    add_vertex(l, a[0] + dx * k / pieces, a[1] + dy * k / pieces, k == 0 ? first_tip : tip);
  }
}

static void rectangle(line *l, const pw_scene_body *b)
{
  for (int k = 0; k < 4; k++) {
    int i0 = k == 1 || k == 2, i1 = k == 0 || k == 1, j0 = k >= 2, j1 = k == 1 || k == 2;
    add_straight(l, (pw_real[]){b->x_m[i0], b->y_m[j0]}, (pw_real[]){b->x_m[i1], b->y_m[j1]}, false,
                 false);
  }
}

static void disc(line *l, const pw_scene_body *b)
{
  pw_real quarter = pw_max(2, pw_body_pieces(pi / 2 * b->radius_m, l->segment));
  if (!(quarter < most_vertices)) {
    l->n = INFINITY;
    return;
  }
  for (pw_real k = 0; k < 4 * quarter; k++) {
    pw_real angle = pi / 2 * k / quarter;
    add_vertex(l, b->centre_m[0] + b->radius_m * sin(angle),
               b->centre_m[1] - b->radius_m * cos(angle), false);
  }
}

/* A whole ring: its outer circle. Part of one: along the first cut, the outer arc, the second cut
 * and back along the inner arc. */
static void ring(line *l, const pw_scene_body *b)
{
  pw_real from = b->angle_deg[0] * pi / 180, angle = b->angle_deg[1] * pi / 180 - from;
  bool part = angle < 2 * pi * (1 - 1e-9);
  for (int side = 0; side < (part ? 2 : 1); side++) {
    const pw_real r[2] = {side == 0 ? b->inner_radius_m : b->radius_m,
                          side == 0 ? b->radius_m : b->inner_radius_m};
    pw_real start = side == 0 ? from : from + angle, turn = side == 0 ? angle : -angle;
    pw_real pieces = pw_max(ceil(4 * angle / pi - 1e-9), pw_body_pieces(angle * r[1], l->segment));
    if (!(pieces < most_vertices)) {
      l->n = INFINITY;
      return;
    }
    const pw_real c = cos(start), s = sin(start), *o = b->centre_m;
    if (part) {
      add_straight(l, (pw_real[]){o[0] + r[0] * c, o[1] + r[0] * s},
                   (pw_real[]){o[0] + r[1] * c, o[1] + r[1] * s}, false, false);
    }
    for (pw_real k = 0; k < pieces; k++) {
      pw_real at = start + turn * k / pieces;
      add_vertex(l, o[0] + r[1] * cos(at), o[1] + r[1] * sin(at), false);
    }
  }
}

/* The tip from its lowest point to the shaft (side 1) or back (side -1), without the last vertex.
 * Equal steps of the ellipse's angle: no piece is longer than the longer half axis times a step. */
static void tip_part(line *l, const pw_scene_body *b, pw_real x, int side)
{
  pw_real height = pw_pile_tip_height(b), corner[2] = {x + side * b->radius_m, b->tip_y_m + height};
  pw_real apex[2] = {x, b->tip_y_m};
  if (b->tip != PW_TIP_ROUNDED) {
    add_straight(l, side > 0 ? apex : corner, side > 0 ? corner : apex, true, true);
    return;
  }
  pw_real pieces = pw_body_pieces(pi / 2 * pw_max(height, b->radius_m), l->segment);
  if (!(pieces < most_vertices)) {
    l->n = INFINITY;
    return;
  }
  for (pw_real k = 0; k < pieces; k++) {
    pw_real angle = pi / 2 * (side > 0 ? k : pieces - k) / pieces;
    add_vertex(l, x + side * b->radius_m * sin(angle), corner[1] - height * cos(angle), true);
  }
}

static void pile(line *l, const pw_scene_body *b, bool axi)
{
  pw_real x = axi ? 0 : b->centre_m[0], r = b->radius_m, head = b->tip_y_m + b->length_m;
  pw_real shoulder = b->tip_y_m + pw_pile_tip_height(b);
  bool shaft = head - shoulder > 1e-9 * b->length_m;
  tip_part(l, b, x, 1);
  if (shaft) {
    add_straight(l, (pw_real[]){x + r, shoulder}, (pw_real[]){x + r, head}, true, false);
  }
  add_straight(l, (pw_real[]){x + r, head}, (pw_real[]){x, head}, !shaft, false);
  if (axi) {
    add_vertex(l, x, head, false);
    return;
  }
  add_straight(l, (pw_real[]){x, head}, (pw_real[]){x - r, head}, false, false);
  if (shaft) {
    add_straight(l, (pw_real[]){x - r, head}, (pw_real[]){x - r, shoulder}, false, false);
  }
  tip_part(l, b, x, -1);
}

int pw_body_outline(const pw_scene *scene, int body, pw_real segment, pw_real *xy, bool *tip,
                    int max)
{
  const pw_scene_body *b = &scene->body[body];
  if (!(segment > 0)) {
    return -1;
  }
  line l = {.xy = xy, .tip = tip, .max = xy ? max : most_vertices, .segment = segment};
  if (b->shape == PW_SHAPE_RECTANGLE) {
    rectangle(&l, b);
  } else if (b->shape == PW_SHAPE_DISC) {
    disc(&l, b);
  } else if (b->shape == PW_SHAPE_RING) {
    ring(&l, b);
  } else {
    pile(&l, b, scene->geometry == PW_AXI);
  }
  return l.n <= l.max ? (int)l.n : -1;
}
