/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The column of test_step_elastic_column_rests.c on a grid that is fine at the top and grows
 * downwards: at rest the stress of each cell is that of its middle, -rho g (H - y), because nodes
 * get half the weight of the cells beside them whatever their sizes. The same tolerances. */
#include "tests/engine_scenes.h"

static const double gamma_soil = 1500.0 * 10.0, height = 10.0, end = 6.0;

static pw_sim *column(const pw_grid *grid, int basis)
{
  static pw_scene s;
  pw_scene_default(&s);
  s.grid = *grid;
  s.method.basis = basis;
  int soil = test_elastic(&s, 1e7, 0.3, 1500.0);
  test_rectangle(&s, soil, (double[]){0.0, 1.0, 0.0, height}, 0.0)->points_per_cell = 2;
  test_gravity(&s, 4.0)->acceleration_m_s2 = 10.0;
  pw_damping_local_param *d = pw_scene_add_effect(&s, "damping_local");
  d->coefficient = 0.3;
  test_roller(&s, PW_SIDE_BOTTOM);
  test_roller(&s, PW_SIDE_LEFT);
  test_roller(&s, PW_SIDE_RIGHT);
  return test_sim(&s, 1);
}

typedef struct {
  double point, pair, lateral; /* largest errors; point in quarters of its cell's gamma h */
} errors;

/* Domains of a cell follow one another, two rows of two; cells along x first. */
static errors measure(const pw_sim *sim)
{
  const pw_points *p = &sim->points;
  const pw_idx across = sim->mesh.cells[0];
  errors e = {0.0, 0.0, 0.0};
  for (pw_idx j = 0; 4 * across * j < p->n; j++) {
    double row[2] = {0.0, 0.0}, low = pw_mesh_node_y(&sim->mesh, j * sim->mesh.nodes[0]);
    double high = pw_mesh_node_y(&sim->mesh, (j + 1) * sim->mesh.nodes[0]);
    double middle = -gamma_soil * (height - 0.5 * (low + high));
    for (pw_idx k = 0; k < 4 * across; k++) {
      pw_idx i = p->slot[4 * across * j + k];
      double yy = p->stress[p->ld + i];
      row[k % 4 / 2] += yy / (2.0 * across);
      e.lateral = fmax(e.lateral, fabs(p->stress[i] - yy * 0.3 / 0.7));
    }
    e.pair = fmax(e.pair, fabs(0.5 * (row[0] + row[1]) - middle));
    for (int l = 0; l < 2; l++) {
      double off = row[l] - middle + (1 - 2 * l) * 0.25 * gamma_soil * (high - low);
      e.point = fmax(e.point, fabs(off) / (0.25 * gamma_soil * (high - low)));
    }
  }
  return e;
}

static errors run(const pw_grid *grid, const char *what)
{
  pw_sim *sim = column(grid, PW_CPDI);
  test_run_to(sim, end);
  errors e = measure(sim);
  print_message("%s: %d points, %d steps: point off by %.3f of its cell's gamma h/4, pairs %.2e "
                "gamma H, horizontal %.2e gamma H\n",
                what, sim->points.n, (int)sim->step, e.point, e.pair / (gamma_soil * height),
                e.lateral / (gamma_soil * height));
  pw_sim_destroy(&sim);
  return e;
}

static const pw_grid graded = {
    .size_m = {1.0, 10.5}, .cell_m = 0.25, .fine_y_m = {8.0, 10.5}, .growth = 1.2};

static void stress_is_linear_in_depth(void **state)
{
  (void)state;
  const pw_grid even = {.size_m = {1.0, 10.5}, .cell_m = 0.25};
  errors one = run(&even, "uniform"), two = run(&graded, "graded");
  assert_true(two.point <= 1.1 && one.point <= 1.1);
  assert_true(two.pair <= 2e-3 * gamma_soil * height);
  assert_true(two.lateral <= 1e-9 * gamma_soil * height);
  assert_true(two.pair <= 2.0 * one.pair);
}

/* Linear MPM: one point in the middle of each cell has its stress. */
static void linear_points_carry_the_weight(void **state)
{
  (void)state;
  pw_sim *sim = column(&graded, PW_LINEAR);
  const pw_points *p = &sim->points;
  double worst = 0.0, sum = 0.0;
  test_run_to(sim, end);
  for (pw_idx i = 0; i < p->n; i++) {
    double x[2] = {p->x[i], p->x[p->ld + i]}, size[2];
    pw_mesh_size_at(&sim->mesh, x, size);
    pw_idx e = pw_mesh_locate(&sim->mesh, x), row = e / sim->mesh.cells[0];
    double middle = pw_mesh_node_y(&sim->mesh, row * sim->mesh.nodes[0]) + 0.5 * size[1];
    sum += p->stress[p->ld + i] * p->vol[i];
    worst = fmax(worst, fabs(p->stress[p->ld + i] + gamma_soil * (height - middle)) / size[1]);
  }
  print_message("linear: mean stress %.5f of gamma H/2, worst point %.3f gamma h\n",
                sum / (-0.5 * gamma_soil * height * height), worst / gamma_soil);
  assert_relative(sum, -0.5 * gamma_soil * height * height, 0.02);
  assert_true(worst <= 1.0 * gamma_soil);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stress_is_linear_in_depth),
      cmocka_unit_test(linear_points_carry_the_weight),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
