/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every allocation of making a simulation of a solid scene fails once: the failure is reported and
 * nothing is left behind; and a load step allocates nothing. */
#include "engine/core/mem.h"
#include "tests/implicit_helpers.h"

static void read_scene(const char *path, pw_scene *scene)
{
  static const char *const set[] = {"mesh.bricks=[2, 4, 1]",
                                    "traction=[{group: x_max, pressure_pa: 10}]",
                                    "initial_stress=[{kind: uniform, normal_pa: [0, -5, 0]}]",
                                    "stress_record=[{component: mean}]"};
  char *messages = NULL;
  if (pw_scene_read_file(path, 4, set, scene, &messages) != PW_OK) {
    fail_msg("%s", messages);
  }
}

static pw_status set_up(const pw_scene *scene)
{
  pw_solid_mesh mesh = {.ngroup = 0};
  pw_implicit *sim = NULL;
  pw_status s = pw_solid_mesh_load(scene, &mesh);
  s = s == PW_OK ? pw_implicit_create(scene, &mesh, 1, &sim) : s;
  pw_solid_mesh_destroy(&mesh);
  pw_implicit_destroy(&sim);
  return s;
}

static void every_failure_is_clean(void **state)
{
  (void)state;
  static pw_scene scene;
  read_scene("scenes/small_block.yaml", &scene);
  const pw_off before = pw_mem_bytes();
  pw_off nth = 0;
  pw_status s;
  do {
    pw_mem_fail_after(++nth);
    s = set_up(&scene);
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
  pw_implicit *sim = test_implicit("scenes/small_block.yaml", 0, NULL);
  assert_ok(pw_implicit_step(sim)); /* the solver learns the pattern */
  const pw_off count = pw_mem_count();
  assert_ok(pw_implicit_step(sim));
  assert_true(pw_mem_count() == count);
  pw_implicit_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_failure_is_clean),
      cmocka_unit_test(steps_allocate_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
