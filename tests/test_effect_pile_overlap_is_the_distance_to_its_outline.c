/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The depth of a place inside a pile is its distance to the outline, found here by brute force on
 * a fine polyline. */
#include "engine/effects/pile_shape.h"
#include "tests/harness.h"

enum { TIP = 4000, MAX = TIP + 3 };

/* Outline at x >= 0 from the lowest point to the middle of the head. */
static int outline(const pw_pile_shape *s, double *x, double *z)
{
  int n = 0;
  for (int k = 0; k <= TIP; k++) {
    double q = (double)k / TIP, angle = 1.5707963267948966 * q;
    if (s->tip == PW_TIP_ROUNDED) {
      x[n] = s->radius * sin(angle);
      z[n++] = s->tip_length * (1.0 - cos(angle));
    } else {
      x[n] = s->radius * q;
      z[n++] = s->tip_length * q; /* flat: no height */
    }
  }
  x[n] = s->radius;
  z[n++] = s->length;
  x[n] = 0.0;
  z[n++] = s->length;
  return n;
}

static double to_segment(double px, double pz, double ax, double az, double bx, double bz)
{
  double dx = bx - ax, dz = bz - az, q = ((px - ax) * dx + (pz - az) * dz) / (dx * dx + dz * dz);
  q = fmin(fmax(q, 0.0), 1.0);
  return hypot(px - ax - q * dx, pz - az - q * dz);
}

/* Inside: to the left of the outline all the way, because the shapes are convex. */
static double brute(const double *x, const double *z, int n, double px, double pz)
{
  double least = 1e30;
  for (int k = 0; k + 1 < n; k++) {
    double dx = x[k + 1] - x[k], dz = z[k + 1] - z[k];
    if (dx * (pz - z[k]) - dz * (px - x[k]) <= 0.0) {
      return 0.0;
    }
    least = fmin(least, to_segment(px, pz, x[k], z[k], x[k + 1], z[k + 1]));
  }
  return least;
}

static void depth_is_distance_to_outline(void **state)
{
  (void)state;
  const pw_pile_shape shape[] = {{PW_TIP_FLAT, 0.15, 0.0, 5.0},
                                 {PW_TIP_ROUNDED, 0.15, 0.15, 5.0},
                                 {PW_TIP_ROUNDED, 0.15, 0.30, 5.0},
                                 {PW_TIP_ROUNDED, 0.15, 0.05, 5.0},
                                 {PW_TIP_CONICAL, 0.15, 0.26, 5.0}};
  static double x[MAX], z[MAX];
  uint64_t seed = 17;
  for (size_t s = 0; s < sizeof shape / sizeof shape[0]; s++) {
    int n = outline(&shape[s], x, z), inside = 0;
    for (int k = 0; k < 1000; k++) {
      double px = 0.2 * test_random(&seed);
      double pz = (k % 4 ? 0.5 : 5.2) * test_random(&seed) - 0.05;
      double expect = brute(x, z, n, px, pz), got = pw_pile_depth(&shape[s], px, pz);
      assert_near(got, expect, 1e-7); /* sagitta of the polyline: (0.5 m / 4000)^2 / 8 R */
      assert_near(pw_pile_depth(&shape[s], -px, pz), got, 0.0);
      inside += expect > 0.0;
    }
    assert_true(inside > 300);
  }
}

static void scene_pile_gives_its_shape(void **state)
{
  (void)state;
  pw_scene_body b = {
      .shape = PW_SHAPE_PILE, .tip = PW_TIP_ROUNDED, .radius_m = 0.15, .length_m = 5};
  assert_near(pw_pile_shape_of(&b).tip_length, 0.15, 0.0); /* 0: the radius */
  b.tip_length_m = 0.2;
  assert_near(pw_pile_shape_of(&b).tip_length, 0.2, 0.0);
  b.tip = PW_TIP_FLAT;
  assert_near(pw_pile_shape_of(&b).tip_length, 0.0, 0.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(depth_is_distance_to_outline),
      cmocka_unit_test(scene_pile_gives_its_shape),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
