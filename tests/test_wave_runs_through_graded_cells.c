/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bar under a step load on its head (as test_wave_crosses_the_static_displacement.c) with cells
 * that are fine in the middle and grow to both ends: the head crosses its static place at 1, 3, 5
 * L/c, and energy is kept. The stable step is that of the cells that hold points. */
#include "engine/sim_report.h"
#include "tests/engine_scenes.h"

static const double length = 5.0, young = 1e8, density = 2500.0, c0 = 200.0, load = 1e3;

static pw_sim *bar(const pw_grid *grid)
{
  static pw_scene s;
  pw_scene_default(&s);
  s.grid = *grid;
  int m = test_elastic(&s, young, 0.0, density);
  test_rectangle(&s, m, (double[]){0.0, grid->size_m[0], 0.0, length}, 0.0)->points_per_cell = 2;
  test_roller(&s, PW_SIDE_BOTTOM);
  test_roller(&s, PW_SIDE_LEFT);
  test_roller(&s, PW_SIDE_RIGHT);
  pw_surcharge_param *p = pw_scene_add_effect(&s, "surcharge");
  p->body = 0;
  p->side = PW_SIDE_TOP;
  p->pressure_pa = load;
  return test_sim(&s, 1);
}

/* Height of the middle of the topmost cell's points. */
static double head(const pw_sim *sim)
{
  const pw_points *p = &sim->points;
  return 0.5 * (p->x[p->ld + p->slot[p->n - 1]] + p->x[p->ld + p->slot[p->n - 3]]);
}

static void crossings(const char *what, const pw_grid *grid)
{
  pw_sim *sim = bar(grid);
  double start = head(sim), place = start * (1.0 - load / young), old = 0.0, old_t = 0.0, t[3];
  double surplus = 0.0;
  for (int k = 0; k < 3;) {
    assert_ok(pw_sim_step(sim, 0.0));
    double now = place - head(sim);
    if (now * old < 0.0) {
      t[k++] = (old_t + (sim->time - old_t) * old / (old - now)) * c0 / length;
    }
    old = now;
    old_t = sim->time;
    assert_true(sim->time < 7.0 * length / c0);
    surplus = fmax(surplus, sim->energy.kinetic + sim->energy.strain_work - sim->energy.external);
  }
  double supplied = load * load / young * length * grid->size_m[0]; /* to the static place */
  print_message("%s: %d cells, %d steps: %.4f %.4f %.4f L/c, energy from nothing %.2e of the "
                "static work\n",
                what, sim->mesh.cells[1], (int)sim->step, t[0], t[1], t[2], surplus / supplied);
  for (int k = 0; k < 3; k++) {
    assert_near(t[k], 2.0 * k + 1.0, 0.03);
  }
  assert_true(surplus <= 0.02 * supplied);
  pw_sim_destroy(&sim);
}

static const pw_grid graded = {
    .size_m = {0.0625, 5.25}, .cell_m = 0.0625, .fine_y_m = {2.0, 3.0}, .growth = 1.1};

static void the_head_swings_as_on_equal_cells(void **state)
{
  (void)state;
  const pw_grid even = {.size_m = {0.125, 5.25}, .cell_m = 0.125};
  crossings("uniform", &even);
  crossings("graded", &graded);
}

/* cfl h / c with the smallest cell at or beside a point; then the same with points that move. */
static void the_step_is_that_of_occupied_cells(void **state)
{
  (void)state;
  for (int fine = 0; fine < 2; fine++) {
    static pw_scene s;
    pw_scene_default(&s);
    s.grid = graded;
    s.grid.size_m[0] = 1.0;
    int m = test_elastic(&s, young, 0.0, density);
    pw_scene_body *b =
        test_rectangle(&s, m, (double[]){0.25, 0.75, fine ? 2.5 : 4.0, fine ? 2.75 : 5.0}, 0.0);
    b->points_per_cell = 2;
    b->velocity_m_s[1] = -5.0;
    pw_sim *sim = test_sim(&s, 1);
    double expected = PW_HUGE;
    const pw_points *p = &sim->points;
    for (pw_idx i = 0; i < p->n; i++) {
      for (pw_idx j = 0; j < sim->mesh.cells[1]; j++) {
        const double *node = sim->mesh.axis[1].node;
        double y = p->x[p->ld + i];
        bool beside =
            y >= node[j > 0 ? j - 1 : j] && y < node[j + 2 > sim->mesh.cells[1] ? j + 1 : j + 2];
        double h = fmin(node[j + 1] - node[j], sim->mesh.axis[0].size[0]);
        expected = beside ? fmin(expected, 0.5 * h / (c0 + 5.0)) : expected;
      }
    }
    assert_relative(sim->dt_next, expected, 1e-12);
    pw_sim_destroy(&sim);
  }
  /* Along x the cells are all fine above; with an axis that grows as well, the step does too. */
  static pw_scene s;
  pw_scene_default(&s);
  s.grid = graded;
  s.grid.size_m[0] = 5.0;
  s.grid.fine_x_m[1] = 0.5;
  int m = test_elastic(&s, young, 0.0, density);
  test_rectangle(&s, m, (double[]){4.0, 5.0, 4.0, 5.0}, 0.0)->points_per_cell = 2;
  pw_sim *sim = test_sim(&s, 1);
  print_message("step in the coarse corner: %.2f times that of the smallest cell\n",
                sim->dt_next / (0.5 * 0.0625 / c0));
  assert_true(sim->dt_next > 1.5 * 0.5 * 0.0625 / c0);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_head_swings_as_on_equal_cells),
      cmocka_unit_test(the_step_is_that_of_occupied_cells),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
