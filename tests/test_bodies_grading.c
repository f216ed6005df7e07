/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refine boxes: tiles that overlap a box are halved until they are as small as it asks, tiles that
 * only touch it are not, tiles never overlap; and the point count of the hammered pile. */
#include "tests/harness.h"

#include <stdlib.h>

#include "engine/bodies.h"
#include "engine/core/mem.h"

static pw_scene soil_scene(void)
{
  pw_scene s;
  memset(&s, 0, sizeof s);
  s.geometry = PW_AXI;
  s.grid.size_m[0] = 5;
  s.grid.size_m[1] = 16;
  s.grid.cell_m = 0.125;
  s.nbody = 1;
  s.body[0] = (pw_scene_body){
      .shape = PW_SHAPE_RECTANGLE, .x_m = {0, 5}, .y_m = {0, 10}, .point_size_m = 0.25};
  return s;
}

static void refine(pw_scene *s, double x0, double x1, double y0, double y1, double size)
{
  pw_scene_body *b = &s->body[0];
  b->refine[b->nrefine++] = (pw_scene_refine){{x0, x1}, {y0, y1}, size, 0};
}

static pw_idx count(const pw_scene *s)
{
  pw_domains d = {0};
  assert_int_equal(pw_domains_create(s, &d), PW_OK);
  pw_idx n = d.n;
  pw_domains_destroy(&d);
  return n;
}

static void counts_follow_from_areas(void **state)
{
  (void)state;
  pw_scene s = soil_scene();
  assert_int_equal(count(&s), 800);
  refine(&s, 0, 1, 5, 10, 0.125); /* 5 m2 of 16 tiles per m2 become 64 */
  assert_int_equal(count(&s), 800 + 5 * 48);
  refine(&s, 0, 0.5, 6, 10, 0.0625); /* 2 m2 of 64 become 256 */
  assert_int_equal(count(&s), 800 + 5 * 48 + 2 * 192);
  refine(&s, 4.9, 4.95, 0.1, 0.15, 0.125); /* inside one tile: it is quartered */
  assert_int_equal(count(&s), 800 + 5 * 48 + 2 * 192 + 3);
  s.body[0].nrefine = 0;
  refine(&s, 1, 2, 10, 12, 0.01); /* touches the top edge only */
  refine(&s, 2, 2, 3, 4, 0.01);   /* has no width */
  assert_int_equal(count(&s), 800);
}

/* Every tile meets its boxes' sizes, and none was divided more than they ask for: its parent, of
 * twice the edge, is too large for some box that it overlaps. */
static void every_tile_is_as_small_as_asked_and_no_smaller(void **state)
{
  (void)state;
  srand(5);
  for (int trial = 0; trial < 20; trial++) {
    pw_scene s = soil_scene();
    for (int r = 0; r < 3; r++) {
      double x = rand() % 400 / 100.0, y = rand() % 900 / 100.0;
      refine(&s, x, x + rand() % 150 / 100.0, y, y + rand() % 300 / 100.0, 0.25 / (1 + rand() % 7));
    }
    pw_domains d = {0};
    assert_int_equal(pw_domains_create(&s, &d), PW_OK);
    double area = 0;
    for (pw_idx i = 0; i < d.n; i++) {
      double h = d.half[i], x = d.x[i], y = d.x[d.n + i], edge = 2 * h;
      double px = 4 * h * floor(x / (4 * h)), py = 4 * h * floor(y / (4 * h));
      bool parent_too_large = edge == 0.25;
      area += edge * edge;
      for (int r = 0; r < 3; r++) {
        const pw_scene_refine *b = &s.body[0].refine[r];
        bool empty = b->x_m[0] >= b->x_m[1] || b->y_m[0] >= b->y_m[1];
        bool overlaps = !empty && x - h < b->x_m[1] - 1e-8 && x + h > b->x_m[0] + 1e-8 &&
                        y - h < b->y_m[1] - 1e-8 && y + h > b->y_m[0] + 1e-8;
        assert_true(!overlaps || edge <= b->point_size_m * (1 + 1e-8));
        parent_too_large |= !empty && px < b->x_m[1] && px + 4 * h > b->x_m[0] && py < b->y_m[1] &&
                            py + 4 * h > b->y_m[0] && 2 * edge > b->point_size_m;
      }
      assert_true(parent_too_large);
    }
    assert_true(fabs(area / 50 - 1) < 1e-12);
    pw_domains_destroy(&d);
  }
}

/* Giridharan (2016) section 4.2.3: 10,432 points, the largest as wide as two cells of 0.125 m.
 * Two gradings reach that number with the pile's points of 0.05 m. */
static void the_hammered_pile_has_the_number_of_points_of_the_source(void **state)
{
  (void)state;
  pw_scene s = soil_scene();
  s.nbody = 2;
  s.body[1] = (pw_scene_body){.shape = PW_SHAPE_PILE,
                              .radius_m = 0.15,
                              .tip_y_m = 10,
                              .length_m = 5,
                              .tip = PW_TIP_ROUNDED,
                              .point_size_m = 0.05};
  refine(&s, 0, 5, 0.75, 10, 0.125);
  refine(&s, 0, 4, 0.75, 10, 0.0625);
  assert_true(abs(count(&s) - 10432) < 104);
  s.body[0].nrefine = 0;
  refine(&s, 0, 4, 0, 10, 0.125);
  refine(&s, 0, 3, 0.5, 10, 0.0625);
  refine(&s, 0, 0.5, 5, 10, 0.03125);
  assert_true(abs(count(&s) - 10432) < 104);
}

static void every_failed_allocation_is_reported_and_leaks_nothing(void **state)
{
  (void)state;
  pw_scene s = soil_scene();
  pw_domains d = {0};
  pw_off held = pw_mem_bytes(), nth = 0;
  pw_status status;
  do {
    pw_mem_fail_after(++nth);
    status = pw_domains_create(&s, &d);
    pw_mem_fail_after(0);
    assert_true(status == PW_OK || (status == PW_ERR_MEMORY && pw_mem_bytes() == held && !d.x));
  } while (status != PW_OK);
  assert_int_equal(nth, 4);
  pw_domains_destroy(&d);
  assert_int_equal(pw_mem_bytes(), held);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(counts_follow_from_areas),
      cmocka_unit_test(every_tile_is_as_small_as_asked_and_no_smaller),
      cmocka_unit_test(the_hammered_pile_has_the_number_of_points_of_the_source),
      cmocka_unit_test(every_failed_allocation_is_reported_and_leaks_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
