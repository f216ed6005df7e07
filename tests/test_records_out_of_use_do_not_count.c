/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Records out of use say that they have no mass and nothing else: with NaN in all their other slots
 * after every step, a simulation goes through the same bits. Piles with each contact, hammered and
 * with a given motion, sides that absorb. */
#include "tests/absorbing_helpers.h"

#include <string.h>

enum { STEPS = 150 };

/* NaN into what no step clears. */
static void spoil(pw_sim *sim)
{
  for (pw_off k = 0; k < sim->nodes.count; k++) {
    if (!sim->nodes.in_use[k / PW_NODE_GROUP]) {
      pw_real *r = sim->nodes.rec + k * PW_NODE;
      assert_true(r[PW_NODE_MASS] == 0.0);
      for (int slot = PW_NODE_VEL; slot < PW_NODE; slot++) {
        r[slot] = NAN;
      }
    }
  }
}

static void assert_equal_points(const pw_sim *a, const pw_sim *b)
{
  const size_t n = (size_t)a->points.ld * sizeof(pw_real);
  assert_memory_equal(a->points.x, b->points.x, 2 * n);
  assert_memory_equal(a->points.v, b->points.v, 2 * n);
  assert_memory_equal(a->points.stress, b->points.stress, 6 * n);
  assert_memory_equal(&a->energy, &b->energy, sizeof a->energy);
  assert_true(isfinite(a->energy.external) && isfinite(a->energy.kinetic));
}

static void run_both(const pw_scene *s)
{
  pw_sim *clean = test_sim(s, 2), *spoilt = test_sim(s, 2);
  for (int k = 0; k < STEPS; k++) {
    spoil(spoilt);
    assert_ok(pw_sim_step(clean, 0.0));
    assert_ok(pw_sim_step(spoilt, 0.0));
  }
  assert_true(spoilt->nodes.nused < spoilt->nodes.ngroup);
  assert_equal_points(spoilt, clean);
  pw_sim_destroy(&clean);
  pw_sim_destroy(&spoilt);
}

static void hammered(void **state)
{
  (void)state;
  for (int contact = TEST_PENALTY; contact < TEST_CONTACTS; contact++) {
    static pw_scene s;
    test_hammered_pile(&s, contact, 0.125);
    s.method.block_elements = 8;
    run_both(&s);
  }
}

/* A pile of points with a given motion above soil that rests on an absorbing side. */
static void set_pile_above(pw_scene *s, test_contact contact, pw_real speed)
{
  pw_scene_default(s);
  s->geometry = PW_AXI;
  test_grid(s, (pw_real[]){0.0, 2.0, 0.0, 4.0}, 0.25);
  const int soil = test_soil(s);
  test_rectangle(s, soil, (pw_real[]){0.0, 2.0, 0.0, 1.0}, 0.125);
  s->body[s->nbody++] = (pw_scene_body){.name = "pile",
                                        .material = soil,
                                        .shape = PW_SHAPE_PILE,
                                        .radius_m = 0.3,
                                        .tip_y_m = 2.5,
                                        .length_m = 1.2,
                                        .tip = PW_TIP_FLAT,
                                        .point_size_m = 0.1};
  pw_prescribed_motion_param *m = pw_scene_add_effect(s, "prescribed_motion");
  m->body = 1;
  m->velocity_m_s[1] = -speed;
  test_add_contact(s, contact, 1, 0, 0.2, 1e8, 0.1);
  pw_absorbing_param *a = test_absorbing(s, PW_SIDE_BOTTOM);
  a->start_s = 0.01;
  a->mean_over_s = 0.005;
  test_roller(s, PW_SIDE_RIGHT);
}

static void given_motion_and_absorbing_sides(void **state)
{
  (void)state;
  for (int contact = TEST_PENALTY; contact < TEST_CONTACTS; contact++) {
    static pw_scene s;
    set_pile_above(&s, contact, 10.0);
    s.method.block_elements = 8;
    run_both(&s);
  }
}

/* Soil without weight that nothing touches: the absorbing side has nothing to hold, no way has been
 * gone, and no work was done. */
static void a_side_holds_soil_only(void **state)
{
  (void)state;
  static pw_scene s;
  set_pile_above(&s, TEST_FRICTIONAL, 10.0);
  pw_sim *sim = test_sim(&s, 1);
  while (sim->time < 0.03) {
    assert_ok(pw_sim_step(sim, 0.03));
  }
  static pw_record out;
  pw_sim_results(sim, &out);
  int found = 0;
  for (int k = 0; k < out.n; k++) {
    found += strcmp(out.item[k].name, "absorbing_0_moved_max_m") == 0 && out.item[k].value == 0.0;
  }
  assert_int_equal(found, 1);
  assert_true(fabs(sim->energy.external) < 1e-6);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(hammered),
      cmocka_unit_test(given_motion_and_absorbing_sides),
      cmocka_unit_test(a_side_holds_soil_only),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
