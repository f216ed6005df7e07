/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene file with a fine zone: its keys arrive, `check` says how large the cells are, the grid is
 * written with the places of its nodes. */
#include "io/check_report.h"
#include "io/scene_file.h"
#include "io/snapshot.h"
#include "io/vtk_files.h"
#include "tests/engine_helpers.h"
#include "tests/output_helpers.h"

static const char text[] =
    "geometry: axisymmetric\n"
    "grid: {size_m: [5, 8], cell_m: 0.1, fine_x_m: [0, 1], fine_y_m: [4, 7], growth: 1.1,\n"
    "       cell_max_m: 0.35}\n"
    "time: {end_s: 0.01}\n"
    "materials:\n"
    "  rock: {model: linear_elastic, youngs_modulus_pa: 1e7, poisson_ratio: 0.3,\n"
    "         density_kg_m3: 2000}\n"
    "bodies:\n"
    "  block:\n"
    "    {material: rock, shape: rectangle, x_m: [0, 5], y_m: [0, 6], points_per_cell: 1,\n"
    "     refine: [{x_m: [0, 1], y_m: [4, 6], points_per_cell: 2}]}\n"
    "boundary: [{side: bottom, fix_y: true}]\n";

static pw_sim *make(pw_scene *scene)
{
  char *messages = NULL;
  if (pw_scene_read_text(text, strlen(text), "graded.yaml", 0, NULL, scene, &messages) != PW_OK) {
    fail_msg("%s", messages ? messages : pw_error_text());
  }
  return test_sim(scene, 1);
}

static void the_keys_arrive(void **state)
{
  (void)state;
  static pw_scene s;
  pw_sim *sim = make(&s);
  const pw_grid want = {.size_m = {5.0, 8.0},
                        .cell_m = 0.1,
                        .fine_x_m = {0.0, 1.0},
                        .fine_y_m = {4.0, 7.0},
                        .growth = 1.1,
                        .cell_max_m = 0.35};
  assert_memory_equal(&s.grid, &want, sizeof want);
  assert_int_equal(s.body[0].points_per_cell, 1);
  assert_int_equal(s.body[0].refine[0].points_per_cell, 2);
  assert_true(s.body[0].point_size_m == 0.0 && s.body[0].refine[0].point_size_m == 0.0);
  const pw_mesh *m = pw_sim_mesh(sim);
  pw_idx row = 0; /* rows of cells below the surface, of which 20 are fine */
  while (m->axis[1].node[row] < 6.0 - 1e-9) {
    row++;
  }
  assert_int_equal(pw_sim_points(sim)->n, row * m->cells[0] + 3 * 10 * 20);
  pw_sim_destroy(&sim);
}

static void check_says_how_large_cells_are(void **state)
{
  (void)state;
  static pw_scene s;
  pw_sim *sim = make(&s);
  char *printed = NULL, want[80];
  size_t size = 0;
  FILE *out = open_memstream(&printed, &size);
  assert_non_null(out);
  pw_check_report(sim, out);
  fclose(out);
  const pw_mesh *m = pw_sim_mesh(sim);
  snprintf(want, sizeof want, "cells        %d x %d, graded from 0.1 m to 0.35 m\n", m->cells[0],
           m->cells[1]);
  assert_non_null(strstr(printed, want));
  free(printed);
  pw_sim_destroy(&sim);
}

static void the_grid_is_written(void **state)
{
  (void)state;
  if (!pw_vtk_available()) {
    skip();
  }
  static pw_scene s;
  pw_sim *sim = make(&s);
  const char *folder = test_folder(), *file = test_path(folder, "grid.vtr");
  pw_snapshots *series = NULL;
  assert_ok(pw_sim_step(sim, 0.0));
  assert_ok(pw_snapshots_open(folder, &series));
  assert_ok(pw_snapshots_grid(series, sim));
  const pw_idx n = pw_sim_mesh(sim)->nnode;
  float *mass = calloc((size_t)n, sizeof *mass);
  assert_non_null(mass);
  pw_vtk_shape shape;
  assert_ok(pw_vtk_read_array(file, "mass_kg", mass, n, &shape));
  double sum = 0.0;
  for (pw_idx k = 0; k < n; k++) {
    sum += mass[k];
  }
  assert_int_equal(shape.points, n);
  assert_int_equal(shape.cells, pw_sim_mesh(sim)->nelem);
  assert_relative(sum, 2000.0 * 12.5 * 6.0, 1e-5); /* per radian */
  free(mass);
  pw_snapshots_close(&series);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_keys_arrive),
      cmocka_unit_test(check_says_how_large_cells_are),
      cmocka_unit_test(the_grid_is_written),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
