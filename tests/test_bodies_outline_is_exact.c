/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Outlines lie on the exact shape, run counter-clockwise in pieces no longer than asked, and mark
 * the pile's tip. */
#include "tests/harness.h"

#include "engine/bodies.h"

static const double PI = 3.14159265358979323846;

enum { MAX = 4000 };

typedef struct {
  int n;
  double xy[2 * MAX];
  bool tip[MAX];
} outline;

static pw_scene pile_scene(int geometry, int tip, double tip_length)
{
  pw_scene s;
  memset(&s, 0, sizeof s);
  s.geometry = geometry;
  s.nbody = 1;
  s.body[0] = (pw_scene_body){.shape = PW_SHAPE_PILE,
                              .radius_m = 0.15,
                              .centre_m = {geometry == PW_AXI ? 0 : 2, 0},
                              .tip_y_m = 10,
                              .length_m = 5,
                              .tip = tip,
                              .tip_length_m = tip_length};
  return s;
}

/* Fills o; checks counting, room and lengths; returns the signed area of the closed line. */
static double draw(const pw_scene *s, double segment, bool closed, outline *o)
{
  o->n = pw_body_outline(s, 0, segment, NULL, NULL, 0);
  assert_in_range(o->n, 3, MAX);
  assert_int_equal(pw_body_outline(s, 0, segment, o->xy, o->tip, o->n - 1), -1);
  assert_int_equal(pw_body_outline(s, 0, segment, o->xy, NULL, o->n), o->n);
  assert_int_equal(pw_body_outline(s, 0, segment, o->xy, o->tip, MAX), o->n);
  double area = 0;
  for (int i = 0; i < o->n; i++) {
    const double *a = o->xy + 2 * i, *b = o->xy + 2 * ((i + 1) % o->n);
    area += (a[0] * b[1] - a[1] * b[0]) / 2;
    double length = hypot(b[0] - a[0], b[1] - a[1]);
    if (closed || i < o->n - 1) {
      assert_true(length > 0 && length <= segment * (1 + 1e-8));
    }
  }
  return area;
}

static void a_rectangle_has_four_straight_sides(void **state)
{
  (void)state;
  outline o;
  pw_scene s = pile_scene(PW_PLANE, PW_TIP_FLAT, 0);
  s.body[0].shape = PW_SHAPE_RECTANGLE;
  memcpy(s.body[0].x_m, (double[]){1, 4}, sizeof s.body[0].x_m);
  memcpy(s.body[0].y_m, (double[]){-1, 1}, sizeof s.body[0].y_m);
  assert_near(draw(&s, 0.5, true, &o), 6, 1e-12);
  assert_int_equal(o.n, 2 * (6 + 4));
  for (int i = 0; i < o.n; i++) {
    assert_true(o.xy[2 * i] == 1 || o.xy[2 * i] == 4 || fabs(o.xy[2 * i + 1]) == 1);
    assert_false(o.tip[i]);
  }
  assert_int_equal(pw_body_outline(&s, 0, 0, NULL, NULL, 0), -1);
  assert_int_equal(pw_body_outline(&s, 0, NAN, NULL, NULL, 0), -1);
  assert_int_equal(pw_body_outline(&s, 0, 1e-12, NULL, NULL, 0), -1);
}

static void a_disc_has_its_vertices_on_the_circle(void **state)
{
  (void)state;
  outline o;
  pw_scene s = pile_scene(PW_PLANE, PW_TIP_FLAT, 0);
  s.body[0].shape = PW_SHAPE_DISC;
  s.body[0].centre_m[1] = 3;
  s.body[0].radius_m = 1.6;
  double area = draw(&s, 0.1, true, &o); /* a regular polygon: n R^2 sin(2 pi / n) / 2 */
  assert_near(area, o.n * 1.28 * sin(2 * PI / o.n), 1e-12);
  assert_near(o.xy[0], 2, 1e-15);
  assert_near(o.xy[1], 1.4, 1e-15);
  for (int i = 0; i < o.n; i++) {
    assert_near(hypot(o.xy[2 * i] - 2, o.xy[2 * i + 1] - 3), 1.6, 1e-14);
  }
}

/* Value that is 0 on the tip's surface and 1 at its centre. */
static double tip_surface(int tip, double r, double depth)
{
  return tip == PW_TIP_FLAT ? depth : tip == PW_TIP_ROUNDED ? 1 - hypot(r, depth) : 1 - r - depth;
}

static void a_pile_follows_its_tip(void **state)
{
  (void)state;
  static const double height[3] = {0, 0.15, 0.3};
  for (int kind = 0; kind < 6; kind++) {
    int tip = kind % 3;
    bool axi = kind >= 3;
    double h = height[tip];
    outline o;
    pw_scene s = pile_scene(axi ? PW_AXI : PW_PLANE, tip, h);
    double area = draw(&s, 0.01, !axi, &o) * (axi ? 2 : 1);
    double tip_area = tip == PW_TIP_ROUNDED ? PI * 0.15 * h / 2 : 0.15 * h;
    assert_near(area, 0.3 * (5 - h) + tip_area, tip == PW_TIP_ROUNDED ? 3e-5 : 1e-12);
    double centre = s.body[0].centre_m[0];
    assert_near(o.xy[0], centre, 0);
    assert_near(o.xy[1], 10, 1e-15);
    if (axi) {
      assert_near(o.xy[2 * o.n - 2], 0, 0);
      assert_near(o.xy[2 * o.n - 1], 15, 0);
    }
    for (int i = 0; i < o.n; i++) {
      double r = fabs(o.xy[2 * i] - centre), y = o.xy[2 * i + 1];
      assert_int_equal(o.tip[i], y <= 10 + h + 1e-12);
      if (o.tip[i]) {
        double depth = h > 0 ? (10 + h - y) / h : y - 10;
        assert_near(tip_surface(tip, r / 0.15, depth), 0, 1e-12);
      } else {
        assert_true(fabs(r - 0.15) < 1e-12 || y == 15);
      }
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_rectangle_has_four_straight_sides),
      cmocka_unit_test(a_disc_has_its_vertices_on_the_circle),
      cmocka_unit_test(a_pile_follows_its_tip),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
