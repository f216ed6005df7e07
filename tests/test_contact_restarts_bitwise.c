/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run with contact that is stopped, loaded and continued ends in the same checkpoint, byte for
 * byte: history of the slaves, interface lines after splits, means of the history. */
#include "tests/contact_helpers.h"

#include "engine/effects/contact_penalty.h"
#include "io/restart.h"
#include "tests/output_helpers.h"

static void steps(pw_sim *sim, int n)
{
  static pw_record row;
  for (int k = 0; k < n; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
    if (sim->step % 17 == 0) {
      pw_sim_history(sim, &row);
    }
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

static void check(test_contact kind, int geometry)
{
  static pw_scene s;
  const char *folder = test_folder(), *half = test_path(folder, "half.h5");
  const char *through = test_path(folder, "through.h5"), *resumed = test_path(folder, "resumed.h5");
  test_drop(&s, kind, geometry, 0.001);
  if (kind == TEST_PENALTY) { /* split early, so that the line has grown before the stop */
    pw_contact_penalty_param *p = (void *)pw_scene_find_effect(&s, "contact_penalty");
    p->split_factor = 1.1;
  }
  pw_sim *sim = test_sim(&s, 1);
  steps(sim, 60);
  assert_ok(pw_restart_write(half, sim));
  steps(sim, 40);
  assert_ok(pw_restart_write(through, sim));
  assert_true(pw_contact_tally_of(sim)->pairs > 0);
  if (kind == TEST_PENALTY) {
    const pw_penalty *c = pw_sim_effect_ctx(sim, "contact_penalty");
    assert_true(c->counts.splits > 0);
  }
  pw_sim_destroy(&sim);
  sim = test_sim(&s, 1);
  steps(sim, 7); /* nothing of what was there before may stay */
  assert_ok(pw_restart_read(half, sim));
  steps(sim, 40);
  assert_ok(pw_restart_write(resumed, sim));
  expect_same(through, resumed);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void both_contacts_in_both_geometries(void **state)
{
  (void)state;
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    for (int geometry = PW_PLANE; geometry <= PW_AXI; geometry++) {
      check(kind, geometry);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(both_contacts_in_both_geometries)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
