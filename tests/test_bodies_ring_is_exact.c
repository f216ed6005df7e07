/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A ring and parts of it: domains have the exact area, first moment and, about the axis, volume;
 * they stay inside the cuts; the outline lies on the exact curve; wrong rings are refused. */
#include "tests/harness.h"

#include "engine/bodies.h"

static const double PI = 3.14159265358979323846;

enum { MAX = 4000 };

static pw_scene ring_scene(int geometry, double from, double to)
{
  pw_scene s;
  memset(&s, 0, sizeof s);
  s.geometry = geometry;
  s.grid.size_m[0] = s.grid.size_m[1] = 10;
  s.grid.cell_m = 0.25;
  s.nbody = 1;
  s.body[0] = (pw_scene_body){.name = "shell",
                              .shape = PW_SHAPE_RING,
                              .centre_m = {geometry == PW_AXI ? 0 : 4, 5},
                              .radius_m = 2,
                              .inner_radius_m = 1.2,
                              .angle_deg = {from, to},
                              .point_size_m = 0.1};
  return s;
}

/* Sums of area and of area times x and y from the centre; the smallest offset of a corner from
 * the line through the centre at angle `cut` (degrees), to its left. */
static void sums(const pw_scene *s, double cut, double *out)
{
  pw_domains d = {0};
  assert_ok(pw_domains_create(s, &d));
  out[0] = out[1] = out[2] = 0;
  out[3] = 10;
  double c = cos(cut * PI / 180), n = sin(cut * PI / 180);
  for (pw_idx i = 0; i < d.n; i++) {
    double h[4], x = d.x[i] - s->body[0].centre_m[0], y = d.x[d.n + i] - s->body[0].centre_m[1];
    for (int k = 0; k < 4; k++) {
      h[k] = d.half[k * d.n + i];
    }
    assert_true(h[0] * h[3] - h[1] * h[2] > 0);
    assert_true(hypot(2 * h[0], 2 * h[1]) < 0.102 && hypot(2 * h[2], 2 * h[3]) < 0.102);
    double area = pw_domain_area(h);
    out[0] += area;
    out[1] += area * x;
    out[2] += area * y;
    for (int k = 0; k < 4; k++) {
      double p = k % 2 ? 1 : -1, q = k / 2 ? 1 : -1;
      double cx = x + p * h[0] + q * h[2], cy = y + p * h[1] + q * h[3];
      out[3] = fmin(out[3], c * cy - n * cx);
    }
  }
  pw_domains_destroy(&d);
}

static void areas_and_moments_are_exact(void **state)
{
  (void)state;
  const double part[4][2] = {{0, 360}, {-90, 90}, {0, 90}, {30, 75}};
  const double square = 2 * 2 - 1.2 * 1.2, cube = (8 - 1.2 * 1.2 * 1.2) / 3;
  for (int k = 0; k < 4; k++) {
    double from = part[k][0] * PI / 180, to = part[k][1] * PI / 180, got[4];
    pw_scene s = ring_scene(k == 0 ? PW_PLANE : PW_AXI, part[k][0], part[k][1]);
    sums(&s, part[k][0], got);
    assert_relative(got[0], 0.5 * (to - from) * square, 1e-12);
    assert_near(got[1], cube * (sin(to) - sin(from)), 1e-12); /* volume per radian */
    assert_near(got[2], cube * (cos(from) - cos(to)), 1e-12);
    assert_true(k < 2 || got[3] >= -1e-12); /* nothing crosses the first cut */
    if (k >= 2) {
      sums(&s, part[k][1] - 180, got); /* nor the second */
      assert_true(got[3] >= -1e-12);
    }
  }
}

/* Lies on one of the circles or on one of the cuts. */
static bool on_outline(const pw_scene_body *b, double x, double y)
{
  double r = hypot(x, y), angle = atan2(y, x) * 180 / PI;
  return fabs(r - b->radius_m) < 1e-12 || fabs(r - b->inner_radius_m) < 1e-12 ||
         fabs(angle - b->angle_deg[0]) < 1e-10 || fabs(angle - b->angle_deg[1]) < 1e-10;
}

static void outline_lies_on_the_ring(void **state)
{
  (void)state;
  const double part[2][2] = {{0, 360}, {30, 75}};
  for (int k = 0; k < 2; k++) {
    pw_scene s = ring_scene(PW_PLANE, part[k][0], part[k][1]);
    static double xy[2 * MAX];
    int n = pw_body_outline(&s, 0, 0.01, xy, NULL, MAX);
    double area = 0, box[4];
    pw_body_ring_box(&s.body[0], box);
    assert_in_range(n, 100, MAX);
    for (int i = 0; i < n; i++) {
      const double *a = xy + 2 * i, *b = xy + 2 * ((i + 1) % n);
      area += (a[0] * b[1] - a[1] * b[0]) / 2;
      assert_true(hypot(b[0] - a[0], b[1] - a[1]) <= 0.01 * (1 + 1e-9));
      assert_true(on_outline(&s.body[0], a[0] - 4, a[1] - 5));
      assert_true(a[0] >= box[0] - 1e-12 && a[0] <= box[1] + 1e-12);
      assert_true(a[1] >= box[2] - 1e-12 && a[1] <= box[3] + 1e-12);
    }
    /* the whole ring's line is its outer circle; chords cut (length / R)^2 / 6 off a circle */
    assert_relative(area, k == 0 ? 4 * PI : PI / 8 * (4 - 1.44), 1e-4);
  }
}

static void boxes_are_tight(void **state)
{
  (void)state;
  const double rad = PI / 180;
  double box[4];
  pw_scene s = ring_scene(PW_PLANE, 30, 100);
  pw_body_ring_box(&s.body[0], box);
  assert_near(box[0], 4 + 2 * cos(100 * rad), 1e-12);
  assert_near(box[1], 4 + 2 * cos(30 * rad), 1e-12);
  assert_near(box[2], 5 + 1.2 * sin(30 * rad), 1e-12);
  assert_near(box[3], 7, 1e-12);
  s = ring_scene(PW_PLANE, 0, 360);
  pw_body_ring_box(&s.body[0], box);
  for (int k = 0; k < 4; k++) {
    assert_near(box[k], (k < 2 ? 4 : 5) + (k % 2 ? 2 : -2), 1e-12);
  }
}

static void refused(const pw_scene *s, const char *text)
{
  pw_domains d = {0};
  assert_int_equal(pw_domains_create(s, &d), PW_ERR_SCENE);
  assert_non_null(strstr(pw_error_text(), text));
}

static void wrong_rings_are_refused(void **state)
{
  (void)state;
  const double bad[4] = {0, -1, 2, NAN};
  for (int k = 0; k < 4; k++) {
    pw_scene s = ring_scene(PW_PLANE, 0, 360);
    s.body[0].inner_radius_m = bad[k];
    refused(&s, "inner_radius_m");
  }
  pw_scene s = ring_scene(PW_PLANE, 0, 361);
  refused(&s, "angle_deg");
  s = ring_scene(PW_PLANE, 10, 10);
  refused(&s, "angle_deg");
  s = ring_scene(PW_AXI, 0, 180);
  refused(&s, "over the axis");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(areas_and_moments_are_exact),
      cmocka_unit_test(outline_lies_on_the_ring),
      cmocka_unit_test(boxes_are_tight),
      cmocka_unit_test(wrong_rings_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
