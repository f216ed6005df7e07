/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A pile is divided into columns of equal width. Its shaft is made of rectangles. In its tip part
 * a column between radii r0 and r1 has the height that gives it its exact volume: with the tip
 * surface at the depth d(r) below the shaft, height = int d r dr / (r_m w) in axisymmetry (a
 * parallelogram's volume per radian is its area times the radius r_m of its centre) and
 * int d dr / w in plane strain. Its lowest domain is sheared along the straight line that fits
 * d(r) best in the mean square; of n domains in the column, number k from below has (1 - k/n) of
 * that shear. So domains of a column overlap on one side and gape on the other by w/2 times the
 * shear over n, the overlap near the tip of Giridharan (2016) fig. 4.3, and the lowest domains'
 * corners leave the exact outline by the error of the straight line: nothing for a conical tip,
 * at most 0.15 w for a hemisphere, 0.3 w for a rounded tip twice as long as its radius. In
 * axisymmetry only the half at r >= 0 is made.
 */
#include "engine/bodies_shapes.h"

#include <math.h>

static const pw_real same = 1e-9;

pw_real pw_pile_tip_height(const pw_scene_body *b)
{
  if (b->tip == PW_TIP_FLAT) {
    return 0;
  }
  return b->tip_length_m > 0 ? b->tip_length_m : b->radius_m;
}

/* A tip of radius and height 1: int of d(s) ds and of s d(s) ds from 0 to s. */
static pw_real area_to(int tip, pw_real s)
{
  return tip == PW_TIP_CONICAL ? s - s * s / 2
                               : (s * sqrt(pw_max(0, 1 - s * s)) + asin(pw_min(s, 1))) / 2;
}

static pw_real moment_to(int tip, pw_real s)
{
  pw_real rest = pw_max(0, 1 - s * s);
  return tip == PW_TIP_CONICAL ? s * s / 2 - s * s * s / 3 : (1 - rest * sqrt(rest)) / 3;
}

typedef struct {
  const pw_scene_body *b;
  pw_domain_list *list;
  pw_real columns, width; /* of one half */
  pw_real top;            /* lower end of the shaft */
  bool axi;
} pile;

/* Adds one domain of column i, on one side or on both; shear is the rise outwards. */
static void add_domain(const pile *p, pw_real i, pw_real y, pw_real height, pw_real shear)
{
  pw_real half = p->width / 2, r = half * (2 * i + 1);
  if (p->axi) {
    pw_domain_add(p->list, (pw_real[]){r, y}, (pw_real[]){half, half * shear, 0, height / 2});
    return;
  }
  for (int side = -1; side <= 1; side += 2) {
    pw_domain_add(p->list, (pw_real[]){p->b->centre_m[0] + side * r, y},
                  (pw_real[]){half, side * half * shear, 0, height / 2});
  }
}

/* Height and shear of column i of the tip; lengths along r are in radii until the end. */
static pw_real tip_column(const pile *p, pw_real i, pw_real *shear)
{
  int tip = p->b->tip;
  pw_real w = 1 / p->columns, s0 = i * w, s1 = (i + 1) * w, mean = (i + 0.5) * w;
  pw_real area = area_to(tip, s1) - area_to(tip, s0);
  pw_real moment = moment_to(tip, s1) - moment_to(tip, s0);
  pw_real height = pw_pile_tip_height(p->b);
  *shear = -12 * (moment - mean * area) / (w * w * w) * height / p->b->radius_m;
  return (p->axi ? moment / mean : area) / w * height;
}

static void fill_tip(const pile *p)
{
  for (pw_real i = 0; i < p->columns; i++) {
    pw_real shear, height = tip_column(p, i, &shear);
    pw_real n = pw_body_pieces(height, p->b->point_size_m);
    for (pw_real k = 0; k < n; k++) {
      add_domain(p, i, p->top - height * (1 - (k + 0.5) / n), height / n, shear * (1 - k / n));
    }
  }
}

pw_status pw_body_fill_pile(const pw_scene_body *b, pw_geometry geometry, pw_domain_list *list)
{
  pw_real tip = pw_pile_tip_height(b), shaft = b->length_m - tip;
  pw_real columns = pw_body_pieces(b->radius_m, b->point_size_m);
  pw_real rows = pw_body_pieces(b->length_m, b->point_size_m);
  PW_TRY(pw_body_check_count(b, (geometry == PW_AXI ? 1 : 2) * columns * (rows + 1)));
  pile p = {.b = b,
            .list = list,
            .columns = columns,
            .width = b->radius_m / columns,
            .top = b->tip_y_m + tip,
            .axi = geometry == PW_AXI};
  if (tip > 0) {
    fill_tip(&p);
  }
  rows = shaft > same * b->length_m ? pw_body_pieces(shaft, b->point_size_m) : 0;
  for (pw_real j = 0; j < rows; j++) {
    for (pw_real i = 0; i < columns; i++) {
      add_domain(&p, i, p.top + shaft / (2 * rows) * (2 * j + 1), shaft / rows, 0);
    }
  }
  return PW_OK;
}
