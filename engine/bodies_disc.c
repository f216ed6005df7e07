/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A disc is a central square and rings k = 1..m of 6 k equal sectors. With rings of thickness t
 * and R = (m + 1/2) t the central circle has the radius t/2 and every sector the area pi t^2 / 3,
 * whatever its ring: all points but the central one are of one size. A sector's domain is a
 * rectangle centred at the sector's centroid, of length t along the radius and of width pi t / 3,
 * which makes its area the sector's; the square has the area pi t^2 / 4. So the areas add up to
 * pi R^2. Rectangles of a ring overlap towards the centre and gape outwards; corners of the outer
 * ring lie up to t / (5 m) outside the circle.
 */
#include "engine/bodies_shapes.h"

#include <math.h>

static const pw_real pi = PW_PI;

/* Sector j of ring k: half angle a, between the radii (k -+ 1/2) t. */
static void add_sector(const pw_scene_body *b, pw_real t, pw_real k, pw_real j,
                       pw_domain_list *list)
{
  pw_real a = pi / (6 * k), angle = (2 * j + 1) * a;
  /* Centroid: 2/3 (sin a / a) (r2^3 - r1^3) / (r2^2 - r1^2). */
  pw_real radius = sin(a) / a * t * (k + 1 / (12 * k));
  pw_real c = cos(angle), s = sin(angle), along = t / 2, across = pi * t / 6;
  pw_domain_add(list, (pw_real[]){b->centre_m[0] + radius * c, b->centre_m[1] + radius * s},
                (pw_real[]){along * c, along * s, -across * s, across * c});
}

pw_status pw_body_fill_disc(const pw_scene_body *b, pw_domain_list *list)
{
  /* The width of a sector, pi t / 3, is its longer edge. */
  pw_real rings = pw_max(1, ceil(pi * b->radius_m / (3 * b->point_size_m) - 0.5 - 1e-9));
  pw_real t = b->radius_m / (rings + 0.5), half = sqrt(pi) * t / 4;
  PW_TRY(pw_body_check_count(b, 1 + 3 * rings * (rings + 1)));
  pw_domain_add(list, b->centre_m, (pw_real[]){half, 0, 0, half});
  for (pw_real k = 1; k <= rings; k++) {
    for (pw_real j = 0; j < 6 * k; j++) {
      add_sector(b, t, k, j, list);
    }
  }
  return PW_OK;
}
