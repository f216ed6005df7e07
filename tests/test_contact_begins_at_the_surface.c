/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two discs closing in one cell (E35, A6): at which gap between their surfaces each contact begins
 * to push, and momentum. The frictional contact of the grid acts as soon as both bodies have mass at
 * a node, a cell or two too early, unless it looks at the gap: then in the step that would close it;
 * the interface line and the corners wait for the surfaces. */
#include "tests/contact_helpers.h"

static const pw_real CELL = 0.05, RADIUS = 0.2, SPEED = 0.1;

static pw_sim *discs(test_contact kind)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  s.time.cfl = 0.4;
  test_grid(&s, (pw_real[]){-0.5, 1.5, -0.5, 1.5}, CELL);
  int material = test_neo_hookean(&s, 833.333, 384.615, 1000.0);
  test_disc(&s, material, 0.2, 0.2, RADIUS, 0.5 * CELL);
  test_disc(&s, material, 0.8, 0.8, RADIUS, 0.5 * CELL);
  for (int b = 0; b < 2; b++) {
    s.body[b].velocity_m_s[0] = s.body[b].velocity_m_s[1] = b == 0 ? SPEED : -SPEED;
  }
  test_add_contact(&s, kind, 0, 1, 0.0, 2e5, 0.5 * CELL);
  return test_sim(&s, 1);
}

typedef struct meeting {
  pw_real gap;      /* of the circles when the first force comes; m */
  pw_real closing;  /* in the step before; m */
  pw_real momentum; /* largest, of both together, over that of one */
} meeting;

static meeting meet(test_contact kind)
{
  pw_sim *sim = discs(kind);
  const pw_contact_tally *t = pw_contact_tally_of(sim);
  meeting m = {.gap = PW_HUGE};
  pw_real a[5] = {0.0}, b[5] = {0.0};
  while (sim->time < 2.5) {
    assert_ok(pw_sim_step(sim, 0.0));
    test_body_sums(sim, 0, a);
    test_body_sums(sim, 1, b);
    if (m.gap == PW_HUGE && hypot(t->force[PW_REACTION_X], t->force[PW_REACTION_Y]) > 0.0) {
      m.closing = sqrt(8.0) * SPEED * sim->dt;
      m.gap = hypot(b[3] - a[3], b[4] - a[4]) - 2.0 * RADIUS + m.closing; /* at its start */
    }
    m.momentum = pw_max(m.momentum, hypot(a[1] + b[1], a[2] + b[2]) / (a[0] * SPEED * sqrt(2.0)));
  }
  assert_true(a[1] < 0.0 && b[1] > 0.0); /* they have parted */
  pw_sim_destroy(&sim);
  return m;
}

/* Chords of the lines, and the rectangles of the discs' outer ring, differ from the circles by up
 * to 0.4 mm and t / (5 m) = 0.7 mm; a gap is seen at the start of a step. */
static void distance_is_that_of_the_surfaces(void **state)
{
  (void)state;
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    meeting m = meet(kind);
    print_message(
        "%s: pushes from a gap of %.4f m on, %.2f cells (closing %.4f m a step); momentum "
        "%.1e\n",
        test_contact_name[kind], m.gap, m.gap / CELL, m.closing, m.momentum);
    assert_true(m.momentum <
                (kind == TEST_PENALTY ? 0.01 : 1e-12)); /* lines have mass of their own */
    if (kind == TEST_FRICTIONAL) {
      assert_true(m.gap > 0.0 && m.gap < 2.0 * sqrt(2.0) * CELL);
    } else {
      pw_real ahead = kind == TEST_GAP ? m.closing : 0.0;
      assert_true(m.gap < ahead + 0.0015 && m.gap > -0.003 - 2.0 * m.closing);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(distance_is_that_of_the_surfaces),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
