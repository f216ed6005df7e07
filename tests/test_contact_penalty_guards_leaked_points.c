/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact_penalty.guard_depth_m: a point of the slave that is deeper in the master is pushed out by
 * a spring of the contact's stiffness on its own area. Alone in its cell it is a mass on a spring,
 * so its depth after n steps is d cos((n + 1/2) p) / cos(p / 2), sin(p / 2) = sqrt(k / m) dt / 2,
 * the solution of the difference equation of symplectic steps; k = stiffness times the side of the
 * point (plane strain). The master feels the spring's force. Where no point leaks the key changes
 * no bit. */
#include "engine/effects/contact_penalty.h"
#include "tests/contact_helpers.h"

static const pw_real CELL = 0.25, SIZE = 0.125, STIFFNESS = 2e7, DENSITY = 1500.0, DT = 1e-5,
                     ALLOWED = 0.0375;

static void guard(pw_scene *s)
{
  pw_contact_penalty_param *p = (void *)pw_scene_find_effect(s, "contact_penalty");
  p->guard_depth_m = ALLOWED;
}

/* A block without gravity, 1 m high. @return a stiff material for what touches it. */
static int block(pw_scene *s, int geometry)
{
  pw_scene_default(s);
  s->geometry = geometry;
  test_grid(s, (pw_real[]){0.0, 2.0, 0.0, 2.5}, CELL);
  int soft = test_neo_hookean(s, 1e5, 5e4, DENSITY);
  test_rectangle(s, soft, (pw_real[]){0.0, 2.0, 0.0, 1.0}, SIZE);
  return test_elastic(s, 1e7, 0.2, 2500.0);
}

/* The block under a punch that touches it and is held. */
static pw_sim *resting(bool guarded)
{
  static pw_scene s; /* large */
  const int stiff = block(&s, PW_PLANE);
  test_rectangle(&s, stiff, (pw_real[]){0.5, 1.0, 1.0, 1.75}, 0.125);
  test_hold(&s, 1);
  test_add_contact(&s, TEST_PENALTY, 1, 0, 0.4, STIFFNESS, SIZE);
  if (guarded) {
    guard(&s);
  }
  return test_sim(&s, 2);
}

/* A point is put into the punch, depth plus what is allowed from its left side and farther from the
 * others, alone in its cell and so that it stays there; it is followed until half of that is
 * left. */
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

/* A block under a free punch on the axis of symmetry, a point just below the punch's top: the
 * spring on r times the side of the point pushes it up and the punch down, and together they keep
 * the momentum of zero. */
static void a_free_master_takes_the_reaction(void **state)
{
  (void)state;
  static pw_scene s; /* large */
  const int stiff = block(&s, PW_AXI);
  test_rectangle(&s, stiff, (pw_real[]){0.0, 0.5, 1.0, 1.75}, SIZE);
  test_add_contact(&s, TEST_PENALTY, 1, 0, 0.4, STIFFNESS, SIZE);
  guard(&s);
  pw_contact_penalty_param *contact = (void *)pw_scene_find_effect(&s, "contact_penalty");
  contact->thickness_m = 0.0; /* points hold all momentum */
  pw_sim *sim = test_sim(&s, 2);
  pw_points *p = &sim->points;
  const pw_real depth = 0.1, stretch = depth - ALLOWED;
  p->x[p->slot[1]] = 0.1875;
  p->x[p->ld + p->slot[1]] = 1.75 - depth;
  sim->sort_needed = true;
  const pw_real k = STIFFNESS * sqrt(p->vol[p->slot[1]] * 0.1875);
  sim->energy.external += PW_PI * k * stretch * stretch; /* put there against the spring */
  for (int step = 0; step < 50; step++) {
    pw_real soil[5], punch[5];
    assert_ok(pw_sim_step(sim, DT));
    const pw_contact_tally *t = pw_contact_tally_of(sim);
    if (step == 0) {
      assert_relative(t->force[PW_REACTION_Y], -2.0 * PW_PI * k * stretch, 1e-9);
    }
    test_body_sums(sim, 0, soil);
    test_body_sums(sim, 1, punch);
    assert_true(punch[2] < 0.0);
    assert_near(soil[2] + punch[2], 0.0, 1e-12 * fabs(punch[2]));
  }
  pw_sim_destroy(&sim);
}

/* Beside the round tip of a pile, in the box around it: outside, and left alone. */
static void beside_the_tip_is_outside(void **state)
{
  (void)state;
  static pw_scene s; /* large */
  const int stiff = block(&s, PW_AXI);
  s.body[s.nbody++] = (pw_scene_body){.name = "pile",
                                      .material = stiff,
                                      .shape = PW_SHAPE_PILE,
                                      .radius_m = 0.4,
                                      .tip_y_m = 1.0,
                                      .length_m = 1.0,
                                      .tip = PW_TIP_ROUNDED,
                                      .tip_length_m = 0.4,
                                      .point_size_m = 0.1};
  test_hold(&s, 1);
  test_add_contact(&s, TEST_PENALTY, 1, 0, 0.4, STIFFNESS, 0.05);
  guard(&s);
  pw_sim *sim = test_sim(&s, 1);
  const pw_penalty *c = pw_sim_effect_ctx(sim, "contact_penalty");
  const pw_real places[][3] = {{0.375, 1.02, 0}, {0.3, 1.05, 0}, {0.06, 1.2, 1}};
  for (int k = 0; k < 3; k++) {
    const pw_off before = c->guarded;
    const pw_idx i = sim->points.slot[3];
    sim->points.x[i] = places[k][0];
    sim->points.x[sim->points.ld + i] = places[k][1];
    sim->points.v[i] = sim->points.v[sim->points.ld + i] = 0.0;
    sim->energy.external += 1e6; /* whatever the spring holds */
    sim->sort_needed = true;
    assert_ok(pw_sim_step(sim, 1e-7));
    assert_int_equal(c->guarded - before, (pw_off)places[k][2]);
  }
  pw_sim_destroy(&sim);
}

static void what_begins_deep_is_refused(void **state)
{
  (void)state;
  static pw_scene s; /* large */
  test_drop(&s, TEST_PENALTY, PW_PLANE, -0.125);
  guard(&s);
  pw_sim *sim = NULL;
  assert_int_equal(pw_sim_create(&s, 1, &sim), PW_ERR_SCENE);
  assert_non_null(strstr(pw_error_text(), "0.0625 m deep in 'body1' at the start"));
  s.method.step_ratio_max = 8;
  const pw_effect *type = pw_effect_find("contact_penalty");
  assert_int_equal(type->check(&s, pw_scene_find_effect(&s, "contact_penalty")), PW_ERR_SCENE);
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
      cmocka_unit_test(a_free_master_takes_the_reaction),
      cmocka_unit_test(beside_the_tip_is_outside),
      cmocka_unit_test(what_begins_deep_is_refused),
      cmocka_unit_test(no_leak_no_change),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
