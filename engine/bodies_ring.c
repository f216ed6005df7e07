/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A ring, or the part of one between two angles, is divided into layers of equal thickness t and
 * each layer into equal sectors. A sector's domain is a parallelogram centred at the sector's
 * centroid with the sector's area, so that areas, and in axisymmetry volumes (Pappus), add up
 * exactly: a rectangle along and across the radius, but beside a cut, where its edge lies on the
 * cut. Neighbours overlap towards the centre and gape outwards by up to t / 2 R of their width.
 */
#include "engine/bodies_shapes.h"

#include <math.h>

static const pw_real pi = PW_PI;

typedef struct {
  pw_real r[2];   /* radii; m */
  pw_real a;      /* half the angle; rad */
  pw_real middle; /* angle of its middle; rad */
  int cut;        /* -1: beside the cut at the smaller angle, 1: at the larger one, 0: none */
} sector;

static void add_sector(const pw_scene_body *b, const sector *s, pw_domain_list *list)
{
  pw_real t = s->r[1] - s->r[0], mean = 0.5 * (s->r[0] + s->r[1]);
  pw_real centroid = sin(s->a) / s->a * (mean + t * t / (12.0 * mean));
  pw_real area = 2.0 * s->a * mean * t, c = cos(s->middle), d = sin(s->middle);
  pw_real across = 0.5 * area / t, along[2] = {0.5 * t * c, 0.5 * t * d};
  if (s->cut != 0) {
    pw_real angle = s->middle + s->cut * s->a, to_cut = centroid * sin(s->a);
    along[0] = 0.25 * area / to_cut * cos(angle);
    along[1] = 0.25 * area / to_cut * sin(angle);
    across = to_cut / cos(s->a);
  }
  pw_domain_add(list, (pw_real[]){b->centre_m[0] + centroid * c, b->centre_m[1] + centroid * d},
                (pw_real[]){along[0], along[1], -across * d, across * c});
}

static bool whole_circle(const pw_scene_body *b)
{
  return b->angle_deg[1] - b->angle_deg[0] > 360.0 * (1.0 - 1e-9);
}

/* Sectors of a layer of mean radius r: at least 2, so that none is beside both cuts. */
static pw_real sectors(const pw_scene_body *b, pw_real r)
{
  pw_real angle = (b->angle_deg[1] - b->angle_deg[0]) * pi / 180.0;
  pw_real least = ceil(4.0 * angle / pi - 1e-9); /* an eighth of a circle at most */
  return pw_max(pw_max(2.0, least), pw_body_pieces(angle * r, b->point_size_m));
}

pw_status pw_body_fill_ring(const pw_scene_body *b, pw_domain_list *list)
{
  pw_real layers = pw_body_pieces(b->radius_m - b->inner_radius_m, b->point_size_m);
  pw_real t = (b->radius_m - b->inner_radius_m) / layers;
  pw_real from = b->angle_deg[0] * pi / 180.0, to = b->angle_deg[1] * pi / 180.0;
  PW_TRY(pw_body_check_count(b, layers * sectors(b, b->radius_m)));
  for (pw_real k = 0; k < layers; k++) {
    pw_real r = b->inner_radius_m + k * t, n = sectors(b, r + 0.5 * t);
    sector s = {.r = {r, r + t}, .a = 0.5 * (to - from) / n};
    for (pw_real j = 0; j < n; j++) {
      s.middle = from + (2.0 * j + 1.0) * s.a;
      s.cut = whole_circle(b) ? 0 : j == 0 ? -1 : j == n - 1 ? 1 : 0;
      add_sector(b, &s, list);
    }
  }
  return PW_OK;
}

pw_status pw_body_check_ring(const pw_scene_body *b)
{
  pw_real angle = b->angle_deg[1] - b->angle_deg[0];
  PW_REQUIRE(b->inner_radius_m > 0 && b->inner_radius_m < b->radius_m, PW_ERR_SCENE,
             "body %s: inner_radius_m = %g m must be positive and smaller than radius_m = %g m",
             b->name, b->inner_radius_m, b->radius_m);
  PW_REQUIRE(angle > 0 && angle <= 360.0, PW_ERR_SCENE,
             "body %s: angle_deg must be written [from, to], 360 degrees apart at most", b->name);
  return PW_OK;
}

/* Along an axis the farthest place is one of the four corners, or the rim where it crosses the
 * axis, at a multiple of 90 degrees inside the range. */
void pw_body_ring_box(const pw_scene_body *b, pw_real box[4])
{
  box[0] = box[2] = PW_HUGE;
  box[1] = box[3] = -PW_HUGE;
  pw_real first = 90.0 * ceil(b->angle_deg[0] / 90.0 - 1e-12);
  for (pw_real angle = b->angle_deg[0];;) {
    for (int k = 0; k < 2; k++) {
      pw_real r = k == 0 ? b->inner_radius_m : b->radius_m;
      pw_real x = b->centre_m[0] + r * cos(angle * pi / 180.0);
      pw_real y = b->centre_m[1] + r * sin(angle * pi / 180.0);
      box[0] = pw_min(box[0], x);
      box[1] = pw_max(box[1], x);
      box[2] = pw_min(box[2], y);
      box[3] = pw_max(box[3], y);
    }
    if (angle >= b->angle_deg[1]) {
      return;
    }
    angle = pw_min(angle < first ? first : angle + 90.0, b->angle_deg[1]);
  }
}
