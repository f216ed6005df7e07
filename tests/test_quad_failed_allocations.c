/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every allocation of making a simulation of implicit steps on the grid, and of its first step,
 * fails once: the failure is reported and nothing is left behind; a step on the pattern of the one
 * before allocates nothing. */
#include "engine/core/mem.h"
#include "engine/effects/solid_params.h"
#include "tests/quad_helpers.h"

static void make_scene(pw_scene *s)
{
  test_quad_scene(s, PW_PLANE, PW_CPDI, (pw_real[]){0.0, 2.0, 0.0, 1.5}, 0.25, 1000);
  const int m = test_hencky(s, 1e6, 0.3, 1000.0, 1e9);
  test_rectangle(s, m, (pw_real[]){0.0, 1.0, 0.0, 1.1}, 0.125);
  test_gravity(s, 0.0);
  test_roller(s, PW_SIDE_BOTTOM);
  test_roller(s, PW_SIDE_LEFT);
  pw_ghost_param *ghost = pw_scene_add_effect(s, "ghost_stabilisation");
  ghost->stiffness_pa = 1e4;
}

static pw_status set_up_and_step(const pw_scene *scene)
{
  pw_sim *sim = NULL;
  pw_status s = pw_sim_create(scene, 1, &sim);
  s = s == PW_OK ? pw_sim_step(sim, 0.0) : s;
  pw_sim_destroy(&sim);
  return s;
}

static void every_failure_is_clean(void **state)
{
  (void)state;
  static pw_scene scene;
  make_scene(&scene);
  const pw_off before = pw_mem_bytes();
  pw_off nth = 0;
  pw_status s;
  do {
    pw_mem_fail_after(++nth);
    s = set_up_and_step(&scene);
    pw_mem_fail_after(0);
    assert_true(s == PW_OK || s == PW_ERR_MEMORY);
    assert_true(pw_mem_bytes() == before);
  } while (s != PW_OK);
  print_message("%d allocations\n", (int)nth - 1);
  assert_true(nth > 60);
}

static void steps_allocate_nothing(void **state)
{
  (void)state;
  static pw_scene scene;
  make_scene(&scene);
  pw_sim *sim = test_sim(&scene, 1);
  assert_ok(pw_sim_step(sim, 0.0));
  assert_ok(pw_sim_step(sim, 0.0));
  const pw_off count = pw_mem_count(), pattern = sim->quad->model.csr.revision;
  assert_ok(pw_sim_step(sim, 0.0)); /* nothing moves any more */
  assert_true(sim->quad->model.csr.revision == pattern);
  assert_true(pw_mem_count() == count);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_failure_is_clean),
      cmocka_unit_test(steps_allocate_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
