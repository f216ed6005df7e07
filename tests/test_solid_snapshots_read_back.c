/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ParaView files of a solid scene, read back by VTK's own readers: points with stress and state, the
 * mesh with displacement and reactions; and the collection that names them. */
#include "io/solid_snapshot.h"
#include "io/vtk_files.h"
#include "tests/implicit_helpers.h"
#include "tests/output_helpers.h"

enum { ROOM = 1 << 17 };

static pw_vtk_shape read_back(const char *folder, const char *file, const char *array, float *value)
{
  pw_vtk_shape shape;
  assert_ok(pw_vtk_read_array(test_path(folder, file), array, value, ROOM, &shape));
  assert_true(shape.count <= ROOM);
  return shape;
}

static void points_are_as_in_the_simulation(const char *folder, const pw_implicit *sim)
{
  static float value[ROOM];
  const pw_tet_points *p = &pw_implicit_model(sim)->points;
  pw_vtk_shape shape = read_back(folder, "points_0001.vtp", NULL, value);
  assert_int_equal(shape.points, p->n);
  for (pw_idx i = 0; i < 3 * p->n; i++) {
    assert_near(value[i], p->x[i % 3 * p->ld + i / 3], 1e-6);
  }
  shape = read_back(folder, "points_0001.vtp", "stress_pa", value);
  assert_int_equal(shape.ncomp, 6);
  assert_near(shape.time_s, 4.0, 0.0);
  for (pw_idx i = 0; i < 6 * p->n; i++) {
    const double stress = p->stress[i % 6 * p->ld + i / 6];
    assert_near(value[i], stress, 1e-6 * fabs(stress) + 1e-20);
  }
  read_back(folder, "points_0001.vtp", "volume_ratio", value);
  for (pw_idx i = 0; i < p->n; i++) {
    assert_near(value[i], p->jac[i], 1e-6);
  }
  shape = read_back(folder, "points_0001.vtp", "plastic_strain", value);
  assert_int_equal(shape.count, p->n);
  read_back(folder, "points_0001.vtp", "von_mises_stress_pa", value);
  assert_near(value[7], pw_tet_points_von_mises(p, 7), 1e-3);
}

static void mesh_is_as_in_the_simulation(const char *folder, const pw_implicit *sim)
{
  static float value[ROOM];
  const pw_tet_model *m = pw_implicit_model(sim);
  const pw_idx n = m->mesh->tets.nnode;
  double sum = 0.0;
  pw_vtk_shape shape = read_back(folder, "mesh_0001.vtu", "displacement_m", value);
  assert_int_equal(shape.points, n);
  assert_int_equal(shape.cells, m->mesh->tets.nelem);
  for (pw_idx i = 0; i < 3 * n; i++) {
    assert_near(value[i], pw_implicit_displacement(sim)[i % 3 * n + i / 3], 1e-8);
  }
  read_back(folder, "mesh_0001.vtu", NULL, value);
  for (pw_idx i = 0; i < 3 * n; i++) {
    assert_near(value[i], m->mesh->x[i % 3 * n + i / 3], 1e-6);
  }
  read_back(folder, "mesh_0001.vtu", "reaction_n", value);
  for (pw_idx i = 0; i < n; i++) {
    sum += value[3 * i + 1];
  }
  assert_relative(sum, -test_implicit_history(sim, "weight_y_n"), 1e-5);
}

static void snapshots_read_back(void **state)
{
  (void)state;
  if (!pw_vtk_available()) {
    skip();
  }
  const char *folder = test_folder();
  pw_snapshots *s = NULL;
  pw_implicit *sim = test_implicit("scenes/small_block.yaml", 0, NULL);
  assert_ok(pw_snapshots_open(folder, &s));
  assert_ok(pw_solid_snapshots_write(s, sim));
  for (int k = 0; k < 4; k++) {
    assert_ok(pw_implicit_step(sim));
  }
  assert_ok(pw_solid_snapshots_write(s, sim));
  pw_snapshots_close(&s);
  points_are_as_in_the_simulation(folder, sim);
  mesh_is_as_in_the_simulation(folder, sim);
  assert_ok(pw_snapshots_resume(folder, 4.0, &s)); /* takes up both parts of both times */
  pw_snapshots_close(&s);
  test_bytes pvd = test_read(test_path(folder, "run.pvd"));
  assert_non_null(strstr(pvd.data, "timestep=\"4\" part=\"0\" file=\"points_0001.vtp\""));
  assert_non_null(strstr(pvd.data, "timestep=\"4\" part=\"1\" file=\"mesh_0001.vtu\""));
  assert_non_null(strstr(pvd.data, "timestep=\"0\" part=\"1\" file=\"mesh_0000.vtu\""));
  free(pvd.data);
  pw_implicit_destroy(&sim);
  test_remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(snapshots_read_back),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
