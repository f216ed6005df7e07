/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every wrong body is refused with PW_ERR_SCENE and a message that names it. */
#include "tests/harness.h"

#include "engine/bodies.h"

static pw_scene good(int geometry, int shape)
{
  pw_scene s;
  memset(&s, 0, sizeof s);
  s.geometry = geometry;
  s.grid.size_m[0] = s.grid.size_m[1] = 10;
  s.grid.cell_m = 0.5;
  s.nbody = 1;
  s.body[0] = (pw_scene_body){.name = "block",
                              .shape = shape,
                              .x_m = {1, 2},
                              .y_m = {1, 2},
                              .centre_m = {shape == PW_SHAPE_PILE && geometry == PW_AXI ? 0 : 5, 5},
                              .radius_m = 1,
                              .tip_y_m = 3,
                              .length_m = 4,
                              .tip = PW_TIP_CONICAL,
                              .point_size_m = 0.25};
  return s;
}

static void accepted(const pw_scene *s)
{
  pw_domains d = {0};
  assert_int_equal(pw_domains_create(s, &d), PW_OK);
  assert_true(d.n > 0);
  pw_domains_destroy(&d);
}

static void refused(const pw_scene *s, const char *text)
{
  pw_domains d = {0};
  assert_int_equal(pw_domains_create(s, &d), PW_ERR_SCENE);
  assert_null(d.x);
  assert_non_null(strstr(pw_error_text(), "body block"));
  assert_non_null(strstr(pw_error_text(), text));
}

static void bad_sizes_are_refused(void **state)
{
  (void)state;
  const double bad[4] = {0, -1, NAN, INFINITY};
  for (int k = 0; k < 4; k++) {
    for (int shape = 0; shape < 3; shape++) {
      pw_scene s = good(PW_PLANE, shape);
      accepted(&s);
      s.body[0].point_size_m = bad[k];
      refused(&s, "points of");
    }
    pw_scene s = good(PW_PLANE, PW_SHAPE_DISC);
    s.body[0].radius_m = bad[k];
    refused(&s, "a radius of");
    s = good(PW_PLANE, PW_SHAPE_PILE);
    s.body[0].length_m = bad[k];
    refused(&s, "a length of");
  }
  pw_scene s = good(PW_PLANE, PW_SHAPE_RECTANGLE);
  s.body[0].x_m[1] = 1;
  refused(&s, "is empty");
  s = good(PW_PLANE, PW_SHAPE_PILE);
  s.body[0].tip_length_m = 4.5;
  refused(&s, "a tip of 4.5 m on a pile of 4 m");
  s.body[0].tip_length_m = 4; /* all tip, no shaft */
  accepted(&s);
}

static void bodies_outside_the_grid_are_refused(void **state)
{
  (void)state;
  pw_scene s = good(PW_PLANE, PW_SHAPE_RECTANGLE);
  s.body[0].x_m[1] = 10.01;
  refused(&s, "leaves the grid");
  s.body[0].x_m[1] = 10;
  s.body[0].y_m[0] = 0;
  accepted(&s);
  s.body[0].y_m[0] = -1;
  refused(&s, "leaves the grid");
  s = good(PW_PLANE, PW_SHAPE_DISC);
  s.body[0].centre_m[1] = 0.9;
  refused(&s, "leaves the grid");
  s = good(PW_PLANE, PW_SHAPE_PILE);
  s.body[0].tip_y_m = 6.5;
  refused(&s, "leaves the grid");
}

static void nothing_crosses_the_axis(void **state)
{
  (void)state;
  pw_scene s = good(PW_AXI, PW_SHAPE_RECTANGLE);
  s.grid.origin_m[0] = -5;
  accepted(&s);
  s.body[0].x_m[0] = -0.5;
  refused(&s, "over the axis");
  s = good(PW_AXI, PW_SHAPE_DISC);
  accepted(&s);
  s.grid.origin_m[0] = -5;
  s.body[0].centre_m[0] = 0;
  refused(&s, "over the axis");
  s = good(PW_AXI, PW_SHAPE_PILE);
  accepted(&s);
  s.body[0].centre_m[0] = 1;
  refused(&s, "stands on the axis");
}

static void bad_refinement_is_refused(void **state)
{
  (void)state;
  pw_scene s = good(PW_PLANE, PW_SHAPE_RECTANGLE);
  s.body[0].nrefine = 1;
  s.body[0].refine[0] = (pw_scene_refine){{1, 2}, {1, 2}, 0.3, 0};
  refused(&s, "refine box 0 asks for points of 0.3 m");
  s.body[0].refine[0].point_size_m = 0;
  refused(&s, "refine box 0 asks for points of 0 m");
  s.body[0].refine[0].point_size_m = 1e-8;
  refused(&s, "more than 20 times");
  s.body[0].refine[0].point_size_m = 1e-6;
  refused(&s, "points are more than");
  s.body[0].point_size_m = 1e-7;
  s.body[0].nrefine = 0;
  refused(&s, "points are more than");
  s = good(PW_PLANE, PW_SHAPE_DISC);
  s.body[0].nrefine = 1;
  refused(&s, "only a rectangle");
  for (int shape = 0; shape < 3; shape++) {
    s = good(PW_PLANE, shape);
    s.body[0].point_size_m = 1e-250;
    refused(&s, "points are more than");
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bad_sizes_are_refused),
      cmocka_unit_test(bodies_outside_the_grid_are_refused),
      cmocka_unit_test(nothing_crosses_the_axis),
      cmocka_unit_test(bad_refinement_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
