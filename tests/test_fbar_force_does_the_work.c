/* SPDX-License-Identifier: GPL-3.0-or-later */
/* F-bar in explicit steps: the internal force is the one that does the work of the shared volume
 * change (engine/fbar.h).
 * - Points of a cell whose mean stresses differ, with no mean over the cell, push nothing: the
 *   block stays at rest. With each point's own mean stress in the force the same block flies apart,
 *   for no motion of a cell that keeps its volume changes these stresses.
 * - What stays of the mean stress is that of the cell: a uniform pressure pushes a free block's
 *   surface as it does without F-bar.
 * Both in plane strain and around the axis. */
#include "tests/engine_helpers.h"

enum { CELLS = 4 };

/* A free block of 4 x 4 cells of 2 x 2 points. */
static pw_sim *block(int geometry, bool fbar)
{
  static pw_scene s;
  pw_scene_default(&s);
  s.geometry = geometry;
  s.method.basis = PW_CPDI;
  test_grid(&s, (double[]){0.0, CELLS, 0.0, CELLS + 2.0}, 1.0);
  pw_scene_body *b = test_rectangle(&s, test_elastic(&s, 1e6, 0.49, 1e3),
                                    (double[]){0.0, CELLS, 1.0, CELLS + 1.0}, 0.5);
  b->velocity_m_s[1] = 1e-6; /* energy enough for the energy guard */
  if (fbar) {
    ((pw_fbar_param *)pw_scene_add_effect(&s, "fbar"))->body = -1;
  }
  return test_sim(&s, 1);
}

/* Mean stress of each point: its sign alternates with the rows of points, or does not. */
static void set_pressure(pw_sim *sim, double size, bool alternating)
{
  pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n; i++) {
    const bool upper = fmod(p->x[p->ld + i], 1.0) > 0.5;
    for (int c = 0; c < 3; c++) {
      p->stress[c * p->ld + i] = alternating && upper ? size : -size;
    }
  }
}

static double speed(const pw_sim *sim)
{
  const pw_points *p = &sim->points;
  double most = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    most = fmax(most, hypot(p->v[i], p->v[p->ld + i] - 1e-6));
  }
  return most;
}

static double speed_after(int geometry, bool fbar, bool alternating, int steps)
{
  pw_sim *sim = block(geometry, fbar);
  set_pressure(sim, 1e3, alternating);
  for (int k = 0; k < steps; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
  double v = speed(sim);
  pw_sim_destroy(&sim);
  return v;
}

static void differences_within_a_cell_push_nothing(void **state)
{
  (void)state;
  for (int geometry = 0; geometry < 2; geometry++) {
    assert_true(speed_after(geometry, false, true, 1) > 1e-3); /* each point's own push */
    assert_true(speed_after(geometry, true, true, 50) < 1e-9);
  }
}

static void pressure_of_a_cell_pushes_as_ever(void **state)
{
  (void)state;
  for (int geometry = 0; geometry < 2; geometry++) {
    double own = speed_after(geometry, false, false, 1);
    assert_true(own > 1e-3);
    assert_near(speed_after(geometry, true, false, 1), own, 1e-12 * own);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(differences_within_a_cell_push_nothing),
      cmocka_unit_test(pressure_of_a_cell_pushes_as_ever),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
