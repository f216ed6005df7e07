/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VTK's own readers find in the ParaView files what the simulation holds. */
#include <signal.h>
#include <sys/resource.h>

#include "io/snapshot.h"
#include "io/vtk_files.h"
#include "tests/output_helpers.h"
#include "tests/output_scenes.h"

enum { MAX = 40000 };

static float value[MAX];
static pw_vtk_shape shape;

/* Component c of the value of cell k. */
static float at(pw_idx k, int c)
{
  return value[(pw_off)k * shape.ncomp + c];
}

static void load(const char *file, const char *array, int ncomp)
{
  assert_ok(pw_vtk_read_array(file, array, value, MAX, &shape));
  assert_int_equal(shape.ncomp, ncomp);
  assert_true(shape.count <= MAX);
}

static void expect_text(const char *file, const char *text)
{
  test_bytes b = test_read(file);
  assert_string_equal(b.data, text);
  free(b.data);
}

static pw_sim *make(void (*scene_of)(pw_scene *), int steps)
{
  static pw_scene scene;
  scene_of(&scene);
  pw_sim *sim = test_sim(&scene, 2);
  for (int k = 0; k < steps; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
  return sim;
}

static void flying_cpdi(pw_scene *scene)
{
  test_flying_block(scene, PW_CPDI);
}

static void flying_linear(pw_scene *scene)
{
  test_flying_block(scene, PW_LINEAR);
}

static void fields_of_the_points(void **unused)
{
  (void)unused;
  const char *folder = test_folder(), *file = test_path(folder, "points_0000.vtp");
  pw_snapshots *s = NULL;
  pw_sim *sim = make(test_pile_on_sand, 5);
  const pw_points *p = pw_sim_points(sim);
  const pw_off ld = p->ld;
  assert_ok(pw_snapshots_open(folder, &s));
  assert_ok(pw_snapshots_write(s, sim));
  load(file, "position_m", 3);
  assert_int_equal(shape.cells, p->n);
  assert_int_equal(shape.points, 4 * p->n);
  assert_true(shape.time_s == pw_sim_time(sim));
  /* 10 fields, 7 states of the sand, friction angle, id, body */
  assert_int_equal(shape.narray, 10 + 7 + 1 + 2);
  for (pw_idx id = 0; id < p->n; id++) {
    pw_idx i = p->slot[id];
    assert_true(at(id, 0) == (float)p->x[i] && at(id, 1) == (float)p->x[ld + i]);
  }
  load(file, "velocity_m_s", 3);
  for (pw_idx id = 0; id < p->n; id++) {
    pw_idx i = p->slot[id];
    assert_true(at(id, 0) == (float)p->v[i] && at(id, 1) == (float)p->v[ld + i]);
  }
  static const char *const stress[6] = {"stress_xx_pa", "stress_yy_pa", "stress_zz_pa",
                                        "stress_xy_pa", "stress_yz_pa", "stress_zx_pa"};
  for (int c = 0; c < 6; c++) {
    load(file, stress[c], 1);
    for (pw_idx id = 0; id < p->n; id++) {
      assert_true(at(id, 0) == (float)p->stress[c * ld + p->slot[id]]);
    }
  }
  load(file, "id", 1);
  for (pw_idx id = 0; id < p->n; id++) {
    assert_true(at(id, 0) == (float)id);
  }
  pw_snapshots_close(&s);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void states_only_where_a_material_has_them(void **unused)
{
  (void)unused;
  const char *folder = test_folder(), *file = test_path(folder, "points_0000.vtp");
  pw_snapshots *s = NULL;
  pw_sim *sim = make(test_pile_on_sand, 0);
  const pw_points *p = pw_sim_points(sim);
  const pw_real k0 = 0.46;
  assert_ok(pw_snapshots_open(folder, &s));
  assert_ok(pw_snapshots_write(s, sim));
  load(file, "void_ratio", 1);
  for (pw_idx id = 0; id < p->n; id++) {
    bool sand = p->body[p->slot[id]] == 0;
    assert_true(sand ? at(id, 0) == 0.7f : isnan(at(id, 0)));
  }
  /* Matsuoka-Nakai angle of a K0 state: I1 I2 / I3 = 9 + 8 tan^2 phi (Matsuoka & Nakai 1974) */
  const pw_real i1 = 1.0 + 2.0 * k0, i2 = 2.0 * k0 + k0 * k0, i3 = k0 * k0;
  const pw_real expected = atan(sqrt((i1 * i2 / i3 - 9.0) / 8.0)) * 180.0 / acos(-1.0);
  load(file, "mobilised_friction_angle_deg", 1);
  for (pw_idx id = 0; id < p->n; id++) {
    if (p->body[p->slot[id]] == 0) {
      assert_near(at(id, 0), expected, 1e-3);
    } else {
      assert_true(isnan(at(id, 0)));
    }
  }
  load(file, "body", 1);
  for (pw_idx id = 0; id < p->n; id++) {
    assert_true(at(id, 0) == (float)p->body[p->slot[id]]);
  }
  pw_snapshots_close(&s);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void cells_are_the_domains(void **unused)
{
  (void)unused;
  const char *folder = test_folder(), *file = test_path(folder, "points_0000.vtp");
  pw_snapshots *s = NULL;
  pw_sim *sim = make(flying_cpdi, 3);
  const pw_points *p = pw_sim_points(sim);
  const pw_off ld = p->ld;
  assert_ok(pw_snapshots_open(folder, &s));
  assert_ok(pw_snapshots_write(s, sim));
  load(file, NULL, 3);
  assert_int_equal(shape.points, 4 * p->n);
  for (pw_idx id = 0; id < p->n; id++) {
    pw_idx i = p->slot[id];
    /* first corner x - r1 - r2, third corner x + r1 + r2; round numbers to float */
    for (int d = 0; d < 2; d++) {
      pw_real sum = p->half[d * ld + i] + p->half[(2 + d) * ld + i], x = p->x[d * ld + i];
      assert_near(at(4 * id, d), x - sum, 1e-6);
      assert_near(at(4 * id + 2, d), x + sum, 1e-6);
    }
    pw_real turn = 0.0; /* twice the area, positive when the corners go round counter-clockwise */
    for (int k = 0; k < 4; k++) {
      pw_idx a = 4 * id + k, b = 4 * id + (k + 1) % 4;
      turn += (pw_real)at(a, 0) * at(b, 1) - (pw_real)at(b, 0) * at(a, 1);
    }
    assert_near(0.5 * turn, p->vol[i], 1e-5 * p->vol[i] + 1e-6);
  }
  pw_snapshots_close(&s);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void a_basis_without_domains_gives_vertices(void **unused)
{
  (void)unused;
  const char *folder = test_folder(), *file = test_path(folder, "points_0000.vtp");
  pw_snapshots *s = NULL;
  pw_sim *sim = make(flying_linear, 3);
  assert_ok(pw_snapshots_open(folder, &s));
  assert_ok(pw_snapshots_write(s, sim));
  load(file, "volume_m3", 1);
  assert_int_equal(shape.cells, pw_sim_points(sim)->n);
  assert_int_equal(shape.points, shape.cells);
  assert_int_equal(shape.narray, 10 + 2);
  pw_snapshots_close(&s);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void the_grid_holds_the_nodes(void **unused)
{
  (void)unused;
  const char *folder = test_folder(), *file = test_path(folder, "grid.vti");
  pw_snapshots *s = NULL;
  pw_sim *sim = make(flying_cpdi, 3);
  const pw_mesh *m = pw_sim_mesh(sim);
  assert_ok(pw_snapshots_open(folder, &s));
  assert_ok(pw_snapshots_grid(s, sim));
  load(file, "mass_kg", 1);
  assert_int_equal(shape.points, m->nnode);
  pw_real total = 0.0;
  for (pw_idx k = 0; k < m->nnode; k++) {
    total += at(k, 0);
  }
  assert_relative(total, 2000.0, 1e-5); /* 2 m x 1 m x 1000 kg/m3 */
  pw_real momentum[2] = {0.0, 0.0};
  static float mass[MAX];
  memcpy(mass, value, sizeof mass);
  load(file, "velocity_m_s", 3);
  for (pw_idx k = 0; k < m->nnode; k++) {
    momentum[0] += mass[k] * at(k, 0);
    momentum[1] += mass[k] * at(k, 1);
  }
  assert_relative(momentum[0], 6000.0, 1e-5); /* nothing acts on the block */
  assert_relative(momentum[1], -2000.0, 1e-5);
  pw_snapshots_close(&s);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void the_outline_is_a_line(void **unused)
{
  (void)unused;
  static pw_real xy[2000];
  const char *folder = test_folder(), *file = test_path(folder, "outline_0000.vtp");
  pw_snapshots *s = NULL;
  pw_sim *sim = make(test_pile_on_sand, 2);
  int n = pw_sim_outline(sim, 0, xy, 1000);
  assert_true(n > 3);
  assert_ok(pw_snapshots_open(folder, &s));
  assert_ok(pw_snapshots_write(s, sim));
  load(file, NULL, 3);
  assert_int_equal(shape.points, n);
  assert_int_equal(shape.cells, 1);
  for (int k = 0; k < n; k++) {
    assert_true(at(k, 0) == (float)xy[2 * k] && at(k, 1) == (float)xy[2 * k + 1]);
  }
  pw_snapshots_close(&s);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void the_collection_goes_on_after_a_restart(void **unused)
{
  (void)unused;
  const char *folder = test_folder(), *file = test_path(folder, "run.pvd");
  pw_snapshots *s = NULL;
  pw_sim *sim = make(flying_linear, 0);
  assert_ok(pw_snapshots_open(folder, &s));
  for (int k = 0; k < 3; k++) {
    assert_ok(pw_snapshots_write(s, sim));
    sim->time += 0.1;
  }
  pw_snapshots_close(&s);
#define HEAD                                                                                       \
  "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "                         \
  "byte_order=\"LittleEndian\">\n  <Collection>\n"
#define DATA(time, number)                                                                         \
  "    <DataSet timestep=\"" time "\" part=\"0\" file=\"points_000" number ".vtp\"/>\n"
#define TAIL "  </Collection>\n</VTKFile>\n"
  const char *two = HEAD DATA("0", "0") DATA("0.10000000000000001", "1");
  char text[1000];
  snprintf(text, sizeof text, "%s%s", two, DATA("0.20000000000000001", "2") TAIL);
  expect_text(file, text);
  assert_ok(pw_snapshots_resume(folder, 0.1, &s));
  snprintf(text, sizeof text, "%s%s", two, TAIL);
  expect_text(file, text);
  sim->time = 0.15;
  assert_ok(pw_snapshots_write(s, sim));
  snprintf(text, sizeof text, "%s%s", two, DATA("0.14999999999999999", "2") TAIL);
  expect_text(file, text);
  load(test_path(folder, "points_0002.vtp"), "mass_kg", 1);
  assert_true(shape.time_s == 0.15);
  pw_snapshots_close(&s);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void no_room_keeps_what_is_there(void **unused)
{
  (void)unused;
  struct rlimit limit;
  const char *folder = test_folder();
  pw_snapshots *s = NULL;
  pw_sim *sim = make(flying_cpdi, 1);
  assert_ok(pw_snapshots_open(folder, &s));
  assert_ok(pw_snapshots_write(s, sim));
  test_bytes before = test_read(test_path(folder, "run.pvd"));
  signal(SIGXFSZ, SIG_IGN);
  getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = 2000;
  setrlimit(RLIMIT_FSIZE, &limit);
  pw_status status = pw_snapshots_write(s, sim);
  limit.rlim_cur = RLIM_INFINITY;
  setrlimit(RLIMIT_FSIZE, &limit);
  assert_int_equal(status, PW_ERR_FILE);
  assert_error_says("points_0001.vtp");
  assert_error_says("File too large");
  assert_false(test_exists(test_path(folder, "points_0001.vtp")));
  assert_false(test_exists(test_path(folder, "points_0001.vtp.part")));
  expect_text(test_path(folder, "run.pvd"), before.data);
  load(test_path(folder, "points_0000.vtp"), "id", 1);
  free(before.data);
  pw_snapshots_close(&s);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void other_files_are_refused(void **unused)
{
  (void)unused;
  const char *folder = test_folder(), *file = test_path(folder, "points_0000.vtp");
  test_write(file, "not XML", 7);
  assert_int_equal(pw_vtk_read_array(file, "id", value, MAX, &shape), PW_ERR_FILE);
  assert_error_says(file);
  test_remove_folder(folder);
}

static void without_vtk_the_package_is_named(void **unused)
{
  (void)unused;
  pw_snapshots *s = NULL;
  assert_int_equal(pw_snapshots_open("/nowhere", &s), PW_ERR_UNSUPPORTED);
  assert_error_says("libvtk9-dev");
  assert_null(s);
  pw_snapshots_close(&s);
}

int main(void)
{
  const struct CMUnitTest with_vtk[] = {
      cmocka_unit_test(fields_of_the_points),
      cmocka_unit_test(states_only_where_a_material_has_them),
      cmocka_unit_test(cells_are_the_domains),
      cmocka_unit_test(a_basis_without_domains_gives_vertices),
      cmocka_unit_test(the_grid_holds_the_nodes),
      cmocka_unit_test(the_outline_is_a_line),
      cmocka_unit_test(the_collection_goes_on_after_a_restart),
      cmocka_unit_test(no_room_keeps_what_is_there),
      cmocka_unit_test(other_files_are_refused),
  };
  const struct CMUnitTest without_vtk[] = {cmocka_unit_test(without_vtk_the_package_is_named)};
  return pw_vtk_available() ? cmocka_run_group_tests(with_vtk, NULL, NULL)
                            : cmocka_run_group_tests(without_vtk, NULL, NULL);
}
