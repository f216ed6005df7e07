/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An implicit run that goes on from a checkpoint has the bits of one that never stopped, whatever
 * the solver keeps between steps; a checkpoint of another scene is refused. */
#include "io/restart.h"
#include "tests/implicit_helpers.h"
#include "tests/output_helpers.h"

static pw_status walk(pw_archive *ar, void *sim)
{
  return pw_implicit_archive(sim, ar);
}

static void steps(pw_implicit *sim, int n)
{
  for (int k = 0; k < n; k++) {
    assert_ok(pw_implicit_step(sim));
  }
}

static void check_same(const pw_implicit *a, const pw_implicit *b)
{
  const pw_tet_points *p = &pw_implicit_model(a)->points, *q = &pw_implicit_model(b)->points;
  static pw_record left, right;
  const size_t n = (size_t)p->ld;
  assert_memory_equal(p->x, q->x, 3 * n * sizeof *p->x);
  assert_memory_equal(p->stress, q->stress, 6 * n * sizeof *p->stress);
  assert_memory_equal(p->jac_bar, q->jac_bar, n * sizeof *p->jac_bar);
  pw_implicit_history(a, &left);
  pw_implicit_history(b, &right);
  assert_int_equal(left.n, right.n);
  for (int k = 0; k < left.n; k++) {
    assert_string_equal(left.item[k].name, right.item[k].name);
    assert_memory_equal(&left.item[k].value, &right.item[k].value, sizeof left.item[k].value);
  }
}

/* Half the steps, a checkpoint, the other half in two simulations. */
static void check_restart(const char *scene, int nset, const char *const *set)
{
  const char *folder = test_folder(), *file = test_path(folder, "implicit.h5");
  pw_restart_stamp stamp = {.step = 3};
  pw_implicit *whole = test_implicit(scene, nset, set), *again = test_implicit(scene, nset, set);
  steps(whole, 3);
  assert_ok(pw_archive_write(file, &stamp, walk, whole));
  assert_ok(pw_archive_read(file, walk, again));
  assert_int_equal(pw_implicit_steps(again), 3);
  check_same(whole, again);
  steps(whole, 3);
  steps(again, 3);
  check_same(whole, again);
  pw_implicit_destroy(&whole);
  pw_implicit_destroy(&again);
  test_remove_folder(folder);
}

static void weight_and_footing_go_on(void **state)
{
  (void)state;
  const char *const krylov[] = {"implicit.solver=krylov"};
  const char *const adaptive[] = {"implicit.adaptive=true", "implicit.easy_iterations=2",
                                  "implicit.hard_iterations=3"};
  check_restart("scenes/small_block.yaml", 0, NULL);
  check_restart("scenes/small_block.yaml", 1, krylov);
  check_restart("scenes/small_block.yaml", 3, adaptive);
}

static void dynamics_go_on(void **state)
{
  (void)state;
  const char *const points[] = {"dynamics.damping_per_s=1", "implicit.step_s=0.01",
                                "ghost_stabilisation.stiffness_pa=1e4"};
  const char *const nodes[] = {"dynamics.rates=nodes", "implicit.step_s=0.01",
                               "implicit.fbar=increment"};
  check_restart("scenes/small_block.yaml", 3, points);
  check_restart("scenes/small_block.yaml", 3, nodes);
  check_restart("scenes/small_loads.yaml", 0, NULL);
}

static void moving_meshes_go_on(void **state)
{
  (void)state;
  check_restart("../cases/simple_stretch/scene.yaml", 0, NULL);
  check_restart("../cases/rotating_block/scene.yaml", 0, NULL);
}

static void other_scenes_are_refused(void **state)
{
  (void)state;
  const char *folder = test_folder(), *file = test_path(folder, "implicit.h5");
  const char *const mesh[] = {"mesh.diagonal=49"}, *const more[] = {"mesh.bricks=[4, 4, 3]"};
  const char *const load[] = {"gravity.ramp_steps=3"};
  const char *const *const set[] = {mesh, more, load};
  const char *const why[] = {"another mesh", "another scene", "other parameters"};
  pw_restart_stamp stamp = {.step = 0};
  pw_implicit *sim = test_implicit("scenes/small_block.yaml", 0, NULL);
  assert_ok(pw_archive_write(file, &stamp, walk, sim));
  pw_implicit_destroy(&sim);
  for (int k = 0; k < 3; k++) {
    sim = test_implicit("scenes/small_block.yaml", 1, set[k]);
    assert_int_equal(pw_archive_read(file, walk, sim), PW_ERR_FILE);
    assert_non_null(strstr(pw_error_text(), why[k]));
    pw_implicit_destroy(&sim);
  }
  test_remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(weight_and_footing_go_on),
      cmocka_unit_test(dynamics_go_on),
      cmocka_unit_test(moving_meshes_go_on),
      cmocka_unit_test(other_scenes_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
