/* SPDX-License-Identifier: GPL-3.0-or-later */
/* On a graded grid the whole state is the same bytes for 1 to 4 threads, and for a run that was
 * stopped, written and continued: blocks that fly and collide by every update and basis, and a pile
 * hammered into sand by every contact. */
#include "io/restart.h"
#include "tests/engine_scenes.h"
#include "tests/output_helpers.h"

static void steps(pw_sim *sim, int n)
{
  for (int k = 0; k < n; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
}

static void expect_same(const char *a, const char *b)
{
  test_bytes one = test_read(a), two = test_read(b);
  assert_int_equal(one.size, two.size);
  assert_memory_equal(one.data, two.data, one.size);
  free(one.data);
  free(two.data);
}

static void check(const pw_scene *s, const char *what, pw_off least_sorts)
{
  const char *folder = test_folder();
  const char *half = test_path(folder, "half.h5"), *one = test_path(folder, "one.h5");
  const char *more = test_path(folder, "more.h5");
  pw_report r;
  for (int threads = 1; threads <= 4; threads++) {
    pw_sim *sim = test_sim(s, threads);
    assert_true(sim->mesh.graded);
    steps(sim, 30);
    assert_ok(threads == 1 ? pw_restart_write(half, sim) : PW_OK);
    steps(sim, 30);
    assert_ok(pw_restart_write(threads == 1 ? one : more, sim));
    pw_sim_report(sim, &r);
    if (threads > 1) {
      expect_same(one, more);
    }
    pw_sim_destroy(&sim);
  }
  print_message("%s: %d points in %d blocks of %d colours, sorted %d times\n", what, r.points,
                r.blocks, r.colours, (int)r.sorts);
  assert_true(r.blocks > 4 && r.sorts >= least_sorts);
  pw_sim *sim = test_sim(s, 2);
  steps(sim, 7); /* nothing of what was there before may stay */
  assert_ok(pw_restart_read(half, sim));
  steps(sim, 30);
  assert_ok(pw_restart_write(more, sim));
  expect_same(one, more);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void blocks_that_collide(void **state)
{
  (void)state;
  static const char *const name[4] = {"musl", "usl", "usf", "musl, linear"};
  for (int k = 0; k < 4; k++) {
    static pw_scene s;
    pw_scene_default(&s);
    s.grid = (pw_grid){.size_m = {3.0, 1.5},
                       .cell_m = 0.06,
                       .fine_x_m = {1.2, 1.8},
                       .fine_y_m = {0.6, 0.9},
                       .growth = 1.15};
    int m = test_neo_hookean(&s, 1e4, 5e3, 1e3);
    pw_scene_body *a = test_rectangle(&s, m, (pw_real[]){0.4, 1.0, 0.4, 1.0}, 0.0);
    pw_scene_body *b = test_rectangle(&s, m, (pw_real[]){1.9, 2.4, 0.55, 1.1}, 0.0);
    a->points_per_cell = b->points_per_cell = 2;
    a->velocity_m_s[0] = 2.0;
    b->velocity_m_s[0] = -1.0;
    s.method.update = k % 3;
    s.method.basis = k == 3 ? PW_LINEAR : PW_CPDI;
    s.method.block_elements = 16;
    test_gravity(&s, 0.1);
    test_roller(&s, PW_SIDE_BOTTOM);
    check(&s, name[k], 2);
  }
}

static void pile_in_sand(void **state)
{
  (void)state;
  for (int contact = TEST_PENALTY; contact < TEST_CONTACTS; contact++) {
    static pw_scene s;
    test_hammered_pile(&s, contact, 0.125);
    s.grid.fine_x_m[1] = 0.5;
    s.grid.fine_y_m[0] = 1.0;
    s.grid.fine_y_m[1] = 2.5;
    s.grid.growth = 1.2;
    s.body[0].point_size_m = 0.0;
    s.body[0].points_per_cell = 2;
    s.method.block_elements = 16;
    check(&s, test_contact_name[contact], 1);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blocks_that_collide),
      cmocka_unit_test(pile_in_sand),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
