/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each contact gives the same bits on one to four threads; bodies apart give the bits of a scene
 * without contact (verification catalogue G). */
#include "tests/contact_helpers.h"

static bool same_points(const pw_sim *a, const pw_sim *b)
{
  for (int id = 0; id < PW_FIELD_COUNT; id++) {
    pw_field_info fa = pw_points_field(&a->points, id), fb = pw_points_field(&b->points, id);
    size_t each = fa.is_real ? sizeof(pw_real) : sizeof(pw_idx);
    if (!fa.restart || !fa.array || !fb.array) {
      continue;
    }
    for (int c = 0; c < fa.ncomp; c++) {
      for (pw_idx k = 0; k < a->points.n; k++) { /* blocks, so places, differ with the threads */
        size_t ia = (size_t)(c * a->points.ld + a->points.slot[k]) * each;
        size_t ib = (size_t)(c * b->points.ld + b->points.slot[k]) * each;
        if (memcmp((char *)fa.array + ia, (char *)fb.array + ib, each) != 0) {
          return false;
        }
      }
    }
  }
  return a->time == b->time && a->energy.contact == b->energy.contact;
}

static pw_sim *run(const pw_scene *s, int threads, int steps)
{
  pw_sim *sim = test_sim(s, threads);
  for (int k = 0; k < steps; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
  return sim;
}

static void threads_do_not_matter(void **state)
{
  (void)state;
  static pw_scene s;
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    for (int geometry = PW_PLANE; geometry <= PW_AXI; geometry++) {
      test_drop(&s, kind, geometry, 0.001);
      pw_sim *one = run(&s, 1, 100);
      const pw_contact_tally *t = pw_contact_tally_of(one);
      assert_true(t->impulse[PW_REACTION_Y] > 50.0);
      for (int threads = 2; threads <= 4; threads++) {
        pw_sim *many = run(&s, threads, 100);
        assert_true(same_points(one, many));
        assert_memory_equal(t, pw_contact_tally_of(many), sizeof *t);
        pw_sim_destroy(&many);
      }
      pw_sim_destroy(&one);
    }
  }
}

static void bodies_apart_do_not_notice(void **state)
{
  (void)state;
  static pw_scene with, without;
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    test_drop(&with, kind, PW_PLANE, 0.5);
    test_drop(&without, TEST_CONTACTS, PW_PLANE, 0.5);
    pw_sim *a = run(&with, 2, 15), *b = run(&without, 2, 15);
    assert_true(same_points(a, b));
    assert_int_equal(pw_contact_tally_of(a)->pairs, 0);
    pw_sim_destroy(&a);
    pw_sim_destroy(&b);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(bodies_apart_do_not_notice),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
