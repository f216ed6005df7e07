/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frictional contact that looks at the gap (contact_frictional.detection: closed_gap), flat faces: a
 * block flies to a plate that does not move. Exact: nothing acts before the step in which the faces
 * meet, t = gap / speed; in that step they come together, and no closer; none of it depends on where
 * the faces lie in their cells. Pressed together by the weight, the faces stay together,
 * and the force is the weight but for the change of momentum. */
#include "tests/contact_helpers.h"

static const pw_real CELL = 0.25, SPEED = 0.5;

static void weigh_down(pw_scene *s, pw_real acceleration)
{
  pw_gravity_param *gravity = pw_scene_add_effect(s, "gravity");
  gravity->acceleration_m_s2 = acceleration;
  s->method.noise_damping_per_s = 20.0;
}

/* Top of the plate at `top`, the block `gap` above it; bodies of points of a third of a cell. */
static pw_sim *faces(int basis, int geometry, pw_real top, pw_real gap, pw_real weight)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = geometry;
  s.method.basis = basis;
  test_grid(&s, (pw_real[]){0.0, 2.0, 0.0, 2.5}, CELL);
  int material = test_elastic(&s, 1e6, 0.0, 1000.0);
  test_rectangle(&s, material, (pw_real[]){0.0, 2.0, top - 0.5, top}, CELL / 3.0);
  test_rectangle(&s, material, (pw_real[]){0.0, 1.0, top + gap, top + gap + 1.0}, CELL / 3.0);
  s.body[1].velocity_m_s[1] = weight > 0.0 ? 0.0 : -SPEED;
  test_hold(&s, 0);
  test_add_contact(&s, TEST_GAP, 0, 1, 0.3, 0.0, 0.0);
  if (weight > 0.0) {
    weigh_down(&s, weight);
  }
  return test_sim(&s, 1);
}

/* Least height of the block's domains. */
static pw_real bottom(const pw_sim *sim)
{
  const pw_points *p = &sim->points;
  pw_real low = PW_HUGE;
  for (pw_idx i = 0; i < p->n; i++) {
    pw_real half =
        p->half ? fabs(p->half[p->ld + i]) + fabs(p->half[3 * p->ld + i]) : 0.5 * sqrt(p->vol[i]);
    low = p->body[i] == 1 ? pw_min(low, p->x[p->ld + i] - half) : low;
  }
  return low;
}

static void comes_as_far_as_the_plate(void **state)
{
  (void)state;
  for (int run = 0; run < 16; run++) {
    const int basis = run % 2 == 0 ? PW_CPDI : PW_UGIMP, geometry = run / 2 % 2;
    const pw_real top = 0.75 + 0.08 * (run / 4), gap = 0.3;
    pw_sim *sim = faces(basis, geometry, top, gap, 0.0);
    const pw_contact_tally *t = pw_contact_tally_of(sim);
    pw_real before = 0.0;
    while (t->force[PW_REACTION_Y] == 0.0) {
      before = sim->time;
      assert_ok(pw_sim_step(sim, 0.0));
      assert_true(sim->time < 1.0);
    }
    print_message("basis %d, geometry %d, top %.2f m: first force in the step from %.5f to %.5f s, "
                  "exact %.5f s; gap then %.1e m\n",
                  basis, geometry, top, before, sim->time, gap / SPEED, bottom(sim) - top);
    assert_true(before <= gap / SPEED * (1.0 + 1e-9));
    assert_true(sim->time >= gap / SPEED * (1.0 - 1e-9));
    if (basis == PW_CPDI) { /* boxes of uGIMP keep their height when what is in them is braked */
      assert_true(fabs(bottom(sim) - top) < 0.02 * SPEED * (sim->time - before));
    }
    pw_sim_destroy(&sim);
  }
}

static void rests_on_the_plate(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    const pw_real top = 0.75 + 0.08 * k;
    pw_sim *sim = faces(PW_CPDI, PW_PLANE, top, 0.05 * k, 10.0);
    const pw_contact_tally *t = pw_contact_tally_of(sim);
    pw_real mean = 0.0, deepest = 0.0, start[5], end[5];
    test_run_to(sim, 2.0);
    pw_real from = sim->time;
    test_body_sums(sim, 1, start);
    while (sim->time < 3.0) {
      assert_ok(pw_sim_step(sim, 0.0));
      mean -= t->force[PW_REACTION_Y] * sim->dt;
      deepest = pw_min(deepest, bottom(sim) - top);
    }
    test_body_sums(sim, 1, end);
    mean = (mean - end[2] + start[2]) / (sim->time - from);
    print_message("top %.2f m: deepest %.1e m, gap at the end %.1e m, force %.6f of the weight\n",
                  top, deepest, bottom(sim) - top, mean / 1e4);
    assert_true(deepest > -0.01 * CELL && fabs(bottom(sim) - top) < 0.01 * CELL);
    assert_relative(mean, 1e4, 1e-9);
    pw_sim_destroy(&sim);
  }
}

/* A block two points wide rests on a wide plate: its corners lie in cells that its points are not
 * in, and they too come no closer than the plate, wherever block and plate lie in their cells. */
static void corners_of_a_narrow_block_rest_on_the_plate(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    static pw_scene s; /* large */
    pw_scene_default(&s);
    test_grid(&s, (pw_real[]){0.0, 3.0, 0.0, 3.0}, CELL);
    const pw_real top = 0.83 + 0.05 * k, left = 1.18 + 0.06 * k;
    int material = test_elastic(&s, 1e6, 0.3, 1000.0);
    test_rectangle(&s, material, (pw_real[]){0.0, 3.0, 0.0, top}, CELL);
    test_rectangle(&s, material, (pw_real[]){left, left + 2.0 * CELL, top + 0.01, top + 1.01},
                   CELL);
    test_hold(&s, 0);
    test_add_contact(&s, TEST_GAP, 0, 1, 0.3, 0.0, 0.0);
    weigh_down(&s, 10.0);
    pw_sim *sim = test_sim(&s, 1);
    pw_real deepest = 0.0;
    while (sim->time < 1.0) {
      assert_ok(pw_sim_step(sim, 0.0));
      deepest = pw_min(deepest, bottom(sim) - top);
    }
    print_message("top %.2f m, block from %.2f m on: deepest %.1e m\n", top, left, deepest);
    assert_true(deepest > -0.01 * CELL && fabs(bottom(sim) - top) < 0.01 * CELL);
    pw_sim_destroy(&sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(comes_as_far_as_the_plate),
      cmocka_unit_test(rests_on_the_plate),
      cmocka_unit_test(corners_of_a_narrow_block_rest_on_the_plate),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
