/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every allocation of setting up an implicit simulation fails once: the failure is reported and
 * nothing is left behind. */
#include "engine/step_newton.h"
#include "tests/tet_helpers.h"

static pw_status set_up(const pw_tet_box *box, const pw_tet_material *material, bool dynamic)
{
  pw_tet_input in = {.nnode = 0};
  pw_tet_mesh mesh = {.npatch = 0};
  pw_tet_model model = {.threads = 0};
  pw_newton *newton = NULL;
  pw_newton_options options = pw_newton_defaults();
  options.line_search = 3;
  options.newmark = dynamic ? pw_newmark_defaults() : options.newmark;
  pw_tet_fill fill = {.rule = PW_TET_RULE_FOUR, .nmaterial = 1, .material = material};
  pw_tet_setup setup = {.mesh = &mesh, .fill = &fill, .fbar = PW_FBAR_INCREMENT, .threads = 1};
  setup.ghost = 10.0;
  pw_status s = pw_tet_box_create(box, &in);
  s = s == PW_OK ? pw_tet_mesh_create(&in, &mesh) : s;
  s = s == PW_OK ? pw_tet_model_create(&setup, &model) : s;
  s = s == PW_OK ? pw_newton_create(&model, &options, &newton) : s;
  pw_newton_destroy(&newton);
  pw_tet_model_destroy(&model);
  pw_tet_mesh_destroy(&mesh);
  pw_tet_box_destroy(&in);
  return s;
}

static void every_failure_is_clean(void **state)
{
  (void)state;
  pw_tet_box box = test_cube(2, 1.0, 6, 10);
  pw_tet_material vm = test_von_mises(1e3, 0.3, "yield_radius_pa", 400.0, 0.0);
  for (int dynamic = 0; dynamic < 2; dynamic++) {
    const pw_off before = pw_mem_bytes();
    pw_off nth = 0;
    pw_status s;
    do {
      pw_mem_fail_after(++nth);
      s = set_up(&box, &vm, dynamic);
      pw_mem_fail_after(0);
      assert_true(s == PW_OK || s == PW_ERR_MEMORY);
      assert_true(pw_mem_bytes() == before);
    } while (s != PW_OK);
    print_message("%d allocations\n", (int)nth - 1);
    assert_true(nth > 60);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_failure_is_clean),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
