/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two free discs that collide off centre with friction: momentum to round-off, first touch not
 * before the discs meet (A6, penalty), no pull when they part (E33). */
#include "tests/contact_helpers.h"

/* The discs of A6 (Sulsky, Chen, Schreyer 1994), the upper one shifted by `shift` along x. */
static pw_sim *discs(test_contact kind, pw_real friction, pw_real shift)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  s.time.cfl = 0.4;
  test_grid(&s, (pw_real[]){-0.5, 1.5, -0.5, 1.5}, 0.05);
  int material = test_neo_hookean(&s, 833.333, 384.615, 1000.0);
  test_disc(&s, material, 0.2, 0.2, 0.2, 0.025);
  test_disc(&s, material, 0.8 + shift, 0.8, 0.2, 0.025);
  for (int b = 0; b < 2; b++) {
    s.body[b].velocity_m_s[0] = s.body[b].velocity_m_s[1] = b == 0 ? 0.1 : -0.1;
  }
  test_add_contact(&s, kind, 0, 1, friction, 2e5, 0.025);
  return test_sim(&s, 1);
}

/* Momentum of the points and, with the penalty contact, of the interface lines: what the grid
 * holds, by the masses and velocities of its nodes. */
static void grid_momentum(const pw_sim *sim, pw_real *p, pw_real *gross)
{
  p[0] = p[1] = *gross = 0.0;
  for (pw_off k = 0; k < (pw_off)sim->nodes.nfield * sim->nodes.nnode; k++) {
    const pw_real *r = sim->nodes.rec + k * PW_NODE;
    p[0] += r[PW_NODE_MASS] * r[PW_NODE_VEL];
    p[1] += r[PW_NODE_MASS] * r[PW_NODE_VEL + 1];
    *gross += r[PW_NODE_MASS] * (fabs(r[PW_NODE_VEL]) + fabs(r[PW_NODE_VEL + 1]));
  }
}

static void momentum_is_conserved(void **state)
{
  (void)state;
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    pw_sim *sim = discs(kind, 0.3, 0.1);
    const pw_contact_tally *t = pw_contact_tally_of(sim);
    pw_real start[5], end[5], p[2], gross, worst = 0.0, force = 0.0;
    test_body_sums(sim, 0, start);
    while (sim->time < 2.6) {
      assert_ok(pw_sim_step(sim, 0.0));
      grid_momentum(sim, p, &gross);
      worst = pw_max(worst, (fabs(p[0]) + fabs(p[1])) / gross);
      force = pw_max(force, fabs(t->force[PW_REACTION_X]));
    }
    test_body_sums(sim, 0, end);
    print_message("%s: defect %.1e of the momentum, largest force %.1f N, vx %.4f to %.4f\n",
                  test_contact_name[kind], worst, force, start[1] / start[0], end[1] / end[0]);
    assert_true(worst < 1e-12);
    assert_true(force > 20.0 && end[1] < 0.0); /* they did collide */
    pw_sim_destroy(&sim);
  }
}

/* Gap 0.448528 m closing with 0.282843 m/s: contact at 1.585786 s. Chords of 0.025 m lie 0.39 mm
 * inside the circles, worth 2.8 ms; a step ends before it can see the overlap it made. */
static void penalty_waits_for_the_surfaces(void **state)
{
  (void)state;
  pw_sim *sim = discs(TEST_PENALTY, 0.3, 0.0);
  const pw_contact_tally *t = pw_contact_tally_of(sim);
  while (t->pairs == 0) {
    assert_ok(pw_sim_step(sim, 0.0));
    assert_true(sim->time < 1.7);
  }
  print_message("first contact at %.6f s, surfaces meet at 1.585786 s\n", sim->time);
  assert_true(sim->time - sim->dt > 1.585786 - 1e-3);
  assert_true(sim->time - 2.0 * sim->dt < 1.585786 + 2.8e-3);
  pw_sim_destroy(&sim);
}

/* The line between the centres is the diagonal: along it the upper disc is only ever pushed. */
static void nothing_pulls(void **state)
{
  (void)state;
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    pw_sim *sim = discs(kind, 0.0, 0.0);
    const pw_contact_tally *t = pw_contact_tally_of(sim);
    pw_real push = 0.0, pull = 0.0, a[5], b[5];
    while (sim->time < 3.0) {
      assert_ok(pw_sim_step(sim, 0.0));
      pw_real along = t->force[PW_REACTION_X] + t->force[PW_REACTION_Y];
      push = pw_max(push, -along); /* the master is the lower disc */
      pull = pw_max(pull, along);
    }
    test_body_sums(sim, 0, a);
    test_body_sums(sim, 1, b);
    pw_real gap = hypot(b[3] - a[3], b[4] - a[4]) - 0.4;
    print_message("%s: push %.1f N, pull %.1e N, gap at 3 s %.3f m, speed %.4f m/s, %d pairs\n",
                  test_contact_name[kind], push, pull, gap, -a[1] / a[0], t->pairs);
    assert_true(push > 50.0);
    assert_near(pull, 0.0, 0.0);
    assert_true(gap > 0.05 && t->pairs == 0);
    pw_sim_destroy(&sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(momentum_is_conserved),
      cmocka_unit_test(penalty_waits_for_the_surfaces),
      cmocka_unit_test(nothing_pulls),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
