/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solid scenes with known answers: tractions, weight, initial stress, driven and moving boundaries,
 * and the records of them. */
#include "tests/implicit_helpers.h"

/* A box of 1 x 2 x 3 m, E = 1e6 Pa, nu = 0.25, in small strains; rollers on three sides. */
static const char text[] =
    "geometry: solid\n"
    "mesh: {low_m: [0, 0, 0], high_m: [1, 2, 3], bricks: [1, 2, 2]}\n"
    "implicit: {steps: 2, point_rule: four}\n"
    "materials: {clay: {model: hencky_von_mises, density_kg_m3: 2000, youngs_modulus_pa: 1e6,\n"
    "  poisson_ratio: 0.25, yield_radius_pa: 1e9}}\n"
    "bodies: {box: {material: clay}}\n"
    "boundary:\n"
    "  - {group: x_min, fix_x: true}\n"
    "  - {group: y_min, fix_y: true}\n"
    "  - {group: z_min, fix_z: true}\n"
    "stress_record: [{component: yy}, {component: xy}]\n"
    "tracer: [{at_m: [1, 2, 3]}]\n";

static pw_implicit *start(int nset, const char *const *set)
{
  static pw_scene scene;
  char *messages = NULL;
  pw_solid_mesh mesh = {.ngroup = 0};
  pw_implicit *sim = NULL;
  if (pw_scene_read_text(text, strlen(text), "text", nset, set, &scene, &messages) != PW_OK) {
    fail_msg("%s", messages);
  }
  assert_ok(pw_solid_mesh_load(&scene, &mesh));
  assert_ok(pw_implicit_create(&scene, &mesh, 1, &sim));
  pw_solid_mesh_destroy(&mesh);
  return sim;
}

/* Stress everywhere, by its mean, least and largest. */
static void assert_stress(const pw_implicit *sim, const char *record, double stress, double tol)
{
  static const char *const which[] = {"mean", "least", "largest"};
  for (int k = 0; k < 3; k++) {
    char name[64];
    snprintf(name, sizeof name, "%s_%s_pa", record, which[k]);
    assert_near(test_implicit_history(sim, name), stress, tol);
  }
}

/* Pressure, traction and force of 100 Pa on the top of 1 x 3 m: uniaxial stress, half of it after the
 * first of two steps; displacement of the corner by the strains tau/E (logarithmic). */
static void loads_make_uniaxial_stress(void **state)
{
  (void)state;
  const char *const set[][1] = {
      {"traction=[{group: y_max, pressure_pa: 100}]"},
      {"traction=[{group: y_max, kind: traction, traction_pa: [0, -100, 0]}]"},
      {"traction=[{group: y_max, kind: force, total_force_n: [0, -300, 0]}]"},
  };
  for (int k = 0; k < 3; k++) {
    pw_implicit *sim = start(1, set[k]);
    assert_ok(pw_implicit_step(sim));
    assert_near(test_implicit_history(sim, "traction_0_force_y_n"), -150.0, 1e-9);
    assert_stress(sim, "stress_record_0", -50.0, 0.01);
    assert_ok(pw_implicit_step(sim));
    assert_near(test_implicit_history(sim, "traction_0_force_y_n"), -300.0, 1e-9);
    assert_near(test_implicit_history(sim, "boundary_1_force_y_n"), 300.0, 1e-6);
    /* The mesh is put back between the steps, the area grows by 5e-5: it counts in part. */
    assert_stress(sim, "stress_record_0", -100.0, 0.006);
    assert_near(test_implicit_history(sim, "tracer_0_y_m"), -2.0 * 1e-4, 2e-8);
    assert_near(test_implicit_history(sim, "tracer_0_x_m"), 0.25 * 1e-4, 5e-9);
    assert_near(test_implicit_history(sim, "tracer_0_z_m"), 3.0 * 0.25 * 1e-4, 1e-8);
    pw_implicit_destroy(&sim);
  }
}

/* The support carries the weight m g = 2000 * 6 * 9.81 N; halved by a ramp over both steps. */
static void weight_is_carried(void **state)
{
  (void)state;
  const char *const set[] = {"gravity.acceleration_m_s2=[0, -9.81, 0]", "tracer.0.at_m=[1, 0, 0]"};
  pw_implicit *sim = start(2, set);
  test_implicit_run(sim);
  assert_relative(test_implicit_history(sim, "weight_y_n"), -117720.0, 1e-12);
  assert_relative(test_implicit_history(sim, "boundary_1_force_y_n"), 117720.0, 1e-8);
  assert_near(test_implicit_history(sim, "tracer_0_y_m"), 0.0, 1e-15);
  pw_implicit_destroy(&sim);
}

/* A stress that the tractions balance stays as it is. */
static void initial_stress_rests(void **state)
{
  (void)state;
  const char *const set[] = {
      "initial_stress=[{kind: uniform, normal_pa: [0, -500, 0]}]",
      "traction=[{group: y_max, pressure_pa: 500, ramp_steps: 1}]",
  };
  pw_implicit *sim = start(2, set);
  assert_stress(sim, "stress_record_0", -500.0, 0.0);
  test_implicit_run(sim);
  assert_stress(sim, "stress_record_0", -500.0, 1e-9);
  assert_near(test_implicit_history(sim, "tracer_0_y_m"), 0.0, 1e-14);
  pw_implicit_destroy(&sim);
}

/* K0: vertical stress is what lies above, here along z; the other two are half of it. */
static void initial_stress_grows_with_depth(void **state)
{
  (void)state;
  const char *const set[] = {
      "initial_stress=[{vertical: z, top_m: 3, unit_weight_n_m3: 2e4, k0: 0.5, surcharge_pa: 1e3}]",
  };
  pw_implicit *sim = start(1, set);
  const pw_tet_points *p = &pw_implicit_model(sim)->points;
  for (pw_idx i = 0; i < p->n; i++) {
    double vertical = -(1e3 + 2e4 * (3.0 - p->x[2 * p->ld + i]));
    assert_relative(p->stress[2 * p->ld + i], vertical, 1e-14);
    assert_relative(p->stress[i], 0.5 * vertical, 1e-14);
    assert_near(p->stress[3 * p->ld + i], 0.0, 0.0);
  }
  pw_implicit_destroy(&sim);
}

/* All sides driven by a turn of 90 degrees about an axis through a point and an advance along it:
 * no stress, and the corner is where the rigid motion takes it. */
static void driven_boundaries_move_rigidly(void **state)
{
  (void)state;
  const char *const set[] = {
      "boundary=[{group: x_min, fix_x: true}]", /* the driven nodes come first */
      "driven_boundary={group: all, axis: [0, 0, 2], centre_m: [1, 0, 0], angle_deg: 90, "
      "advance_m: 0.5}",
      "moving_mesh={with: driven}",
      "implicit.steps=4",
  };
  pw_implicit *sim = start(4, set);
  test_implicit_run(sim);
  assert_near(test_implicit_history(sim, "driven_angle_deg"), 90.0, 1e-12);
  assert_near(test_implicit_history(sim, "driven_torque_n_m"), 0.0, 1e-6);
  assert_stress(sim, "stress_record_0", 0.0, 1e-7);
  /* From (1, 2, 3): r = (0, 2) turns to (-2, 0). */
  assert_near(test_implicit_history(sim, "tracer_0_x_m"), -2.0, 1e-12);
  assert_near(test_implicit_history(sim, "tracer_0_y_m"), -2.0, 1e-12);
  assert_near(test_implicit_history(sim, "tracer_0_z_m"), 0.5, 1e-12);
  pw_implicit_destroy(&sim);
}

/* Displacements grow evenly between start_step and the end of their ramp, and stay. */
static void ramps_begin_and_end(void **state)
{
  (void)state;
  const char *const set[] = {
      "boundary.3={group: y_max, fix_y: true, displacement_m: [0, 0.002, 0], start_step: 1, "
      "ramp_steps: 2}",
      "implicit.steps=4",
  };
  const double expected[] = {0.0, 0.001, 0.002, 0.002};
  pw_implicit *sim = start(2, set);
  for (int k = 0; k < 4; k++) {
    assert_ok(pw_implicit_step(sim));
    assert_near(test_implicit_history(sim, "boundary_3_displacement_y_m"), expected[k], 1e-15);
    /* Outside the mesh, which is put back, it goes on with the last element: 1.001 times too far. */
    assert_near(test_implicit_history(sim, "tracer_0_y_m"), expected[k], 6e-7);
    assert_near(test_implicit_history(sim, "boundary_3_force_y_n"), 1e6 * 3.0 * expected[k] / 2.0,
                3.0 * expected[k] * 1e3);
  }
  pw_implicit_destroy(&sim);
}

/* Easy steps grow by half: an elastic load in 8 load steps takes 1 + 1.5 + 2.25 and what is left of
 * 3, and ends where fixed steps do; a limit is met. */
static void adaptive_steps_end_where_whole_ones_do(void **state)
{
  (void)state;
  const char *const set[] = {
      "boundary.3={group: y_max, fix_y: true, displacement_m: [0, -0.002, 0]}",
      "implicit.steps=8",
      "implicit.adaptive=true",
  };
  pw_implicit *sim = start(3, set);
  assert_ok(pw_implicit_step(sim));
  assert_near(pw_implicit_time(sim), 1.0, 0.0);
  assert_ok(pw_implicit_step(sim));
  assert_near(pw_implicit_time(sim), 2.5, 0.0);
  assert_ok(pw_implicit_advance(sim, 0.25));
  assert_near(pw_implicit_time(sim), 2.75, 0.0);
  test_implicit_run(sim);
  assert_near(pw_implicit_time(sim), 8.0, 0.0);
  assert_int_equal(pw_implicit_steps(sim), 5); /* then 2.25 and the 3 that are left */
  assert_near(test_implicit_history(sim, "boundary_3_displacement_y_m"), -0.002, 0.0);
  assert_near(test_implicit_history(sim, "boundary_3_force_y_n"), -3000.0, 3.0);
  pw_implicit_destroy(&sim);
}

/* Free vibration of a bar along z with its end held: the lowest frequency of an elastic bar is
 * sqrt(E/rho)/(4 L) = 1.8634 Hz for nu = 0 and L = 3 m (its mode is a quarter of a wave). */
static void dynamics_swing(void **state)
{
  (void)state;
  const char *const set[] = {
      "materials.clay.poisson_ratio=0",
      "mesh.bricks=[1, 1, 12]",
      "dynamics={rates: nodes, mass: consistent}",
      "gravity={acceleration_m_s2: [0, 0, 0.01], ramp_steps: 1}",
      "implicit.steps=300",
      "implicit.step_s=0.002",
      "implicit.fbar=none",
  };
  pw_implicit *sim = start(7, set);
  double before = 0.0, speed = 0.0, turned = 0.0;
  for (int k = 1; k <= 300 && turned == 0.0; k++) {
    assert_ok(pw_implicit_step(sim));
    double now = test_implicit_history(sim, "tracer_0_z_m"), next = now - before;
    if (next < 0.0 && speed > 0.0) { /* the largest displacement lies between the two middles */
      turned = 0.002 * (k - 1.5 + speed / (speed - next));
    }
    before = now;
    speed = next;
  }
  /* Half a period after the start of a load that then stays. */
  assert_relative(turned, 0.5 / 1.8634, 0.02);
  pw_implicit_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(loads_make_uniaxial_stress),
      cmocka_unit_test(weight_is_carried),
      cmocka_unit_test(initial_stress_rests),
      cmocka_unit_test(initial_stress_grows_with_depth),
      cmocka_unit_test(driven_boundaries_move_rigidly),
      cmocka_unit_test(ramps_begin_and_end),
      cmocka_unit_test(adaptive_steps_end_where_whole_ones_do),
      cmocka_unit_test(dynamics_swing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
