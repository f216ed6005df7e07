/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A simulation that is stopped, written, loaded into a new one and continued ends in the same
 * checkpoint, byte for byte, as one that ran through. */
#include "io/restart.h"
#include "tests/output_helpers.h"
#include "tests/output_scenes.h"

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

static void check_scene(const pw_scene *scene)
{
  const char *folder = test_folder();
  const char *half = test_path(folder, "half.h5"), *again = test_path(folder, "again.h5");
  const char *through = test_path(folder, "through.h5"), *resumed = test_path(folder, "resumed.h5");
  pw_sim *sim = test_sim(scene, 2);
  steps(sim, 60);
  assert_ok(pw_restart_write(half, sim));
  steps(sim, 60);
  assert_ok(pw_restart_write(through, sim));
  pw_sim_destroy(&sim);
  sim = test_sim(scene, 1);
  steps(sim, 7); /* nothing of what was there before may stay */
  assert_ok(pw_restart_read(half, sim));
  assert_int_equal(pw_sim_steps(sim), 60);
  assert_ok(pw_restart_write(again, sim));
  expect_same(half, again);
  steps(sim, 60);
  assert_ok(pw_restart_write(resumed, sim));
  expect_same(through, resumed);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void sand_under_a_pile(void **unused)
{
  (void)unused;
  static pw_scene scene;
  test_pile_on_sand(&scene);
  scene.method.block_elements = 40; /* the same blocks on any number of threads */
  check_scene(&scene);
}

static void an_elastic_block_in_flight(void **unused)
{
  (void)unused;
  static pw_scene scene;
  const int basis[3] = {PW_LINEAR, PW_UGIMP, PW_CPDI};
  for (int k = 0; k < 3; k++) {
    test_flying_block(&scene, basis[k]);
    scene.method.block_elements = 20;
    scene.time.cfl = 0.2;
    check_scene(&scene);
    scene.method.mass_terms = 2;
    check_scene(&scene);
  }
}

static void another_scene_is_refused(void **unused)
{
  (void)unused;
  static pw_scene scene;
  const char *folder = test_folder(), *file = test_path(folder, "checkpoint.h5");
  test_flying_block(&scene, PW_CPDI);
  const int other = test_elastic(&scene, 2e6, 0.3, 500.0), own = scene.body[0].material;
  pw_sim *sim = test_sim(&scene, 1);
  assert_ok(pw_restart_write(file, sim));
  pw_sim_destroy(&sim);
  scene.body[0].material = other; /* as many points as before */
  sim = test_sim(&scene, 1);
  assert_int_equal(pw_restart_read(file, sim), PW_ERR_FILE);
  assert_error_says("scene with other parameters");
  pw_sim_destroy(&sim);
  scene.body[0].material = own;
  scene.body[0].point_size_m = 0.25;
  sim = test_sim(&scene, 1);
  assert_int_equal(pw_restart_read(file, sim), PW_ERR_FILE);
  assert_error_says("scene");
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sand_under_a_pile),
      cmocka_unit_test(an_elastic_block_in_flight),
      cmocka_unit_test(another_scene_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
