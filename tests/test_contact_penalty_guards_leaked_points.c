/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact_penalty.guard_depth_m: a point of the slave that is deeper in the master is pushed out by a
 * spring of the contact's stiffness on its own area. Alone in its cell it is a mass on a spring, so
 * its depth after n steps is d cos((n + 1/2) p) / cos(p / 2), sin(p / 2) = sqrt(k / m) dt / 2, the
 * solution of the difference equation of symplectic steps; k = stiffness times the side of the
 * point (plane strain). The master feels the spring's force. Where no point leaks the key changes no bit. */
#include "engine/effects/contact_penalty.h"
#include "tests/contact_helpers.h"

static const pw_real CELL = 0.25, SIZE = 0.125, STIFFNESS = 2e7, DENSITY = 1500.0, DT = 1e-5,
                     ALLOWED = 0.0375;

static void guard(pw_scene *s)
{
  pw_contact_penalty_param *p = (void *)pw_scene_find_effect(s, "contact_penalty");
  p->guard_depth_m = ALLOWED;
}

/* A block at rest without gravity under a punch that touches it and is held. */
static pw_sim *resting(bool guarded)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  test_grid(&s, (pw_real[]){0.0, 2.0, 0.0, 2.5}, CELL);
  int soft = test_neo_hookean(&s, 1e5, 5e4, DENSITY), stiff = test_elastic(&s, 1e7, 0.2, 2500.0);
  test_rectangle(&s, soft, (pw_real[]){0.0, 2.0, 0.0, 1.0}, 0.125);
  test_rectangle(&s, stiff, (pw_real[]){0.5, 1.0, 1.0, 1.75}, 0.125);
  test_hold(&s, 1);
  test_add_contact(&s, TEST_PENALTY, 1, 0, 0.4, STIFFNESS, SIZE);
  if (guarded) {
    guard(&s);
  }
  return test_sim(&s, 2);
}

/* A point is put into the punch, depth plus what is allowed from its left side and farther from the others, alone in
 * its cell and so that it stays there; it is followed until half of that is left. */
static void leak(bool guarded)
{
  pw_sim *sim = resting(guarded);
  const pw_penalty *c = pw_sim_effect_ctx(sim, "contact_penalty");
  const pw_real depth = 0.1875 - ALLOWED, k = STIFFNESS * SIZE,
                omega = sqrt(k / (DENSITY * SIZE * SIZE));
  const pw_real y = 1.5, end = acos(0.5) / omega;
  pw_idx i = sim->points.slot[0];
  assert_int_equal(sim->points.body[i], 0);
  sim->points.x[i] = 0.5 + ALLOWED + depth;
  sim->points.x[sim->points.ld + i] = y;
  sim->sort_needed = true;
  sim->energy.external +=
      guarded ? 0.5 * k * depth * depth : 0.0; /* put there against the spring */
  const pw_real phase = 2.0 * asin(0.5 * omega * DT);
  pw_off steps = 0;
  for (; sim->time < end; steps++) {
    const pw_real before = sim->points.x[sim->points.slot[0]] - 0.5 - ALLOWED;
    assert_ok(pw_sim_step(sim, DT));
    i = sim->points.slot[0];
    const pw_real now = sim->points.x[i] - 0.5 - ALLOWED;
    const pw_real expected = depth * cos(((pw_real)steps + 1.5) * phase) / cos(0.5 * phase);
    assert_near(now, guarded ? expected : depth, guarded ? 1e-9 * depth : 0.0);
    assert_near(sim->points.x[sim->points.ld + i], y, 1e-12);
    assert_relative(c->tally.force[PW_REACTION_X], guarded ? k * before : 0.0, 1e-9);
  }
  assert_int_equal(c->guarded, guarded ? steps : 0);
  pw_sim_destroy(&sim);
}

static void a_leaked_point_is_pushed_out(void **state)
{
  (void)state;
  leak(true);
}

static void without_the_key_it_stays(void **state)
{
  (void)state;
  leak(false);
}

static void no_leak_no_change(void **state)
{
  (void)state;
  static pw_scene plain, held; /* large */
  test_drop(&plain, TEST_PENALTY, PW_PLANE, 0.0);
  test_drop(&held, TEST_PENALTY, PW_PLANE, 0.0);
  guard(&held);
  pw_sim *a = test_sim(&plain, 1), *b = test_sim(&held, 2);
  while (a->time < 0.05) {
    assert_ok(pw_sim_step(a, 0.0));
    assert_ok(pw_sim_step(b, 0.0));
  }
  const pw_penalty *c = pw_sim_effect_ctx(b, "contact_penalty");
  assert_true(c->tally.overlap_max > 1e-4); /* they did touch */
  assert_int_equal(c->guarded, 0);
  assert_memory_equal(a->points.x, b->points.x, 2 * (size_t)a->points.ld * sizeof(pw_real));
  assert_memory_equal(a->points.v, b->points.v, 2 * (size_t)a->points.ld * sizeof(pw_real));
  pw_sim_destroy(&a);
  pw_sim_destroy(&b);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_leaked_point_is_pushed_out),
      cmocka_unit_test(without_the_key_it_stays),
      cmocka_unit_test(no_leak_no_change),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
