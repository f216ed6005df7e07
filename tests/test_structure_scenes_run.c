/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes whose bodies have no points: free fall, a struck pile, a given motion, a spinning disc
 * beside points, restarts; balance of energy in each. */
#include "engine/core/mem.h"
#include "engine/sim_report.h"
#include "io/restart.h"
#include "tests/output_helpers.h"
#include "tests/structure_helpers.h"

static pw_scene scene;

/* kinetic + strain - initial - external. */
static double imbalance(const pw_sim *sim)
{
  const pw_energy *e = &sim->energy;
  return e->kinetic + e->strain_work - e->initial - e->external;
}

static double column(const pw_sim *sim, const char *name)
{
  static pw_record row;
  pw_sim_history(sim, &row);
  for (int k = 0; k < row.n; k++) {
    if (strcmp(row.item[k].name, name) == 0) {
      return row.item[k].value;
    }
  }
  fail_msg("no column %s", name);
  return 0.0;
}

/* Kick and drift with the weight from the start of the step: after k steps of dt the fall is
 * g t^2 / 2 (1 + 1 / k). */
static void a_pile_above_nothing_falls(void **state)
{
  (void)state;
  for (int kind = PW_BODY_RIGID; kind <= PW_BODY_ROD; kind++) {
    for (int geometry = PW_PLANE; geometry <= PW_AXI; geometry++) {
      test_structure(&scene, geometry, kind, PW_TIP_ROUNDED);
      scene.time.dt_s = 0.25 / 1024.0;
      pw_scene_add_effect(&scene, "gravity");
      pw_sim *sim = test_sim(&scene, 1);
      test_run_to(sim, 0.5);
      double fall = 0.5 * 9.81 * 0.25, exact = fall * (1.0 + 1.0 / 2048.0), com[6];
      pw_body_centre(sim, 0, com);
      assert_near(sim->body[0].start[1] - com[1], exact, 1e-12);
      assert_near(3.0 - pw_structure_tip(sim->structure_of[0]), exact, 1e-12);
      assert_near(com[3], -9.81 * 0.5, 1e-12);
      assert_near(column(sim, "pile_y_m"), com[1], 0.0);
      assert_near(imbalance(sim), 0.0, 1e-10 * sim->energy.external);
      assert_relative(sim->energy.external, sim->measure * com[5] * 9.81 * fall, 1e-12);
      pw_sim_destroy(&sim);
    }
  }
}

/* verification.md A2, structure only. */
static void a_struck_pile_flies_at_8_m_s(void **state)
{
  (void)state;
  for (int kind = PW_BODY_RIGID; kind <= PW_BODY_ROD; kind++) {
    test_structure(&scene, PW_AXI, kind, PW_TIP_FLAT);
    pw_hammer_param *h = pw_scene_add_effect(&scene, "hammer");
    h->body = 0;
    h->pressure_pa = 1e6;
    h->duration_s = 0.1;
    scene.time.dt_max_s = 1e-4;
    pw_sim *sim = test_sim(&scene, 1);
    test_run_to(sim, 0.05);
    assert_relative(column(sim, "hammer_force_n"), 1e6 * PI * 0.15 * 0.15, 1e-12);
    test_run_to(sim, 0.12);
    assert_near(column(sim, "pile_velocity_y_m_s"), -8.0, 1e-10);
    assert_near(column(sim, "hammer_force_n"), 0.0, 0.0);
    assert_near(imbalance(sim), 0.0, 1e-10 * sim->energy.external);
    pw_sim_destroy(&sim);
  }
}

/* Pushed at 1 m/s against its own weight: force and work are known. */
static void a_given_motion_needs_force_and_work(void **state)
{
  (void)state;
  for (int kind = PW_BODY_RIGID; kind <= PW_BODY_ROD; kind++) {
    test_structure(&scene, PW_AXI, kind, PW_TIP_CONICAL);
    pw_scene_add_effect(&scene, "gravity");
    pw_prescribed_motion_param *p = pw_scene_add_effect(&scene, "prescribed_motion");
    p->body = 0;
    p->velocity_m_s[1] = -1.0;
    scene.time.dt_s = 1.0 / 1024.0; /* times without rounding: so is the mean of the ramp */
    pw_sim *sim = test_sim(&scene, 1);
    test_run_to(sim, 0.5);
    double com[6], mass;
    pw_body_centre(sim, 0, com);
    mass = sim->measure * com[5];
    assert_near(imbalance(sim), 0.0, 1e-10 * sim->energy.initial);
    if (kind == PW_BODY_RIGID) {
      assert_near(com[1], sim->body[0].start[1] - 0.5, 1e-12);
      assert_relative(column(sim, "prescribed_motion_0_force_y_n"), mass * 9.81, 1e-12);
      assert_relative(column(sim, "prescribed_motion_0_work_j"), -mass * 9.81 * 0.5, 1e-12);
    } else { /* the hung rod swings below its head */
      const pw_rod *rod = &sim->structure_of[0]->rod;
      assert_near(rod->u[rod->n - 1], -0.5, 1e-12);
      assert_true(fabs(com[1] - sim->body[0].start[1] + 0.5) < 2500 * 9.81 * 25.0 / 1e8);
    }
    pw_sim_destroy(&sim);
  }
}

/* A rigid disc beside a block of points: both keep what they have. */
static void points_and_structures_share_a_scene(void **state)
{
  (void)state;
  pw_scene_default(&scene);
  test_grid(&scene, (pw_real[]){0.0, 4.0, 0.0, 4.0}, 0.25);
  test_rectangle(&scene, test_elastic(&scene, 1e6, 0.3, 1000.0), (pw_real[]){0.5, 1.5, 0.5, 1.5},
                 0.125);
  scene.body[0].velocity_m_s[0] = 1.0;
  scene.body[scene.nbody++] = (pw_scene_body){.name = "disc",
                                              .kind = PW_BODY_RIGID,
                                              .shape = PW_SHAPE_DISC,
                                              .centre_m = {3.0, 3.0},
                                              .radius_m = 0.5,
                                              .velocity_m_s = {-0.5, -0.25}};
  pw_sim *sim = test_sim(&scene, 2);
  assert_int_equal(sim->nodes.nfield, 1);
  assert_int_equal(sim->points.n, 64);
  sim->structure_of[1]->rigid.spin[2] = 4.0;
  test_run_to(sim, 1.0);
  const pw_interface_node *place = &sim->structure_of[1]->line.node[0]; /* was the lowest */
  assert_near(place->x[0], 2.5 + 0.5 * sin(4.0), 1e-10);
  assert_near(place->x[1], 2.75 - 0.5 * cos(4.0), 1e-10);
  assert_near(column(sim, "disc_spin_rad_s"), 4.0, 0.0);
  assert_near(column(sim, "body0_x_m"), 2.0, 1e-10);
  assert_relative(sim->energy.initial, 0.5 * 1000 + 0.5 * 250 * PI * (0.3125 + 0.125 * 16.0),
                  1e-11);
  assert_near(imbalance(sim), 0.0, 1e-9 * sim->energy.initial);
  pw_real xy[400];
  int n = pw_sim_outline(sim, 0, xy, 200);
  assert_int_equal(n, sim->structure_of[1]->line.n + 1);
  assert_near(xy[0], place->x[0], 0.0);
  assert_near(xy[2 * n - 1], xy[1], 0.0);
  assert_int_equal(pw_sim_outline(sim, 1, xy, 200), 0);
  pw_sim_destroy(&sim);
}

static void steps(pw_sim *sim, int n)
{
  for (int k = 0; k < n; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
}

static void a_restart_continues_bitwise(void **state)
{
  (void)state;
  for (int kind = PW_BODY_RIGID; kind <= PW_BODY_ROD; kind++) {
    test_structure(&scene, PW_PLANE, kind, PW_TIP_ROUNDED);
    pw_scene_add_effect(&scene, "gravity");
    pw_hammer_param *h = pw_scene_add_effect(&scene, "hammer");
    h->body = 0;
    h->pressure_pa = 1e6;
    h->duration_s = 0.01;
    scene.time.dt_max_s = 2e-4;
    const char *folder = test_folder();
    const char *half = test_path(folder, "half.h5"), *through = test_path(folder, "through.h5");
    const char *resumed = test_path(folder, "resumed.h5");
    pw_sim *sim = test_sim(&scene, 1);
    sim->structure_of[0]->rigid.spin[2] = kind == PW_BODY_RIGID ? 0.3 : 0.0;
    steps(sim, 30);
    assert_ok(pw_restart_write(half, sim));
    steps(sim, 40);
    assert_ok(pw_restart_write(through, sim));
    pw_sim_destroy(&sim);
    sim = test_sim(&scene, 1);
    steps(sim, 7);
    assert_ok(pw_restart_read(half, sim));
    steps(sim, 40);
    assert_ok(pw_restart_write(resumed, sim));
    test_same_files(through, resumed);
    pw_sim_destroy(&sim);
    scene.body[0].radius_m = 0.16; /* another body of as many nodes */
    sim = test_sim(&scene, 1);
    assert_int_equal(pw_restart_read(half, sim), PW_ERR_FILE);
    pw_sim_destroy(&sim);
    test_remove_folder(folder);
  }
}

static void steps_allocate_nothing(void **state)
{
  (void)state;
  for (int kind = PW_BODY_RIGID; kind <= PW_BODY_ROD; kind++) {
    test_structure(&scene, PW_AXI, kind, PW_TIP_FLAT);
    pw_scene_add_effect(&scene, "gravity");
    scene.time.dt_max_s = 1e-3;
    pw_sim *sim = test_sim(&scene, 1);
    pw_off before = pw_mem_count();
    steps(sim, 20);
    assert_int_equal(pw_mem_count(), before);
    pw_sim_destroy(&sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_pile_above_nothing_falls),
      cmocka_unit_test(a_struck_pile_flies_at_8_m_s),
      cmocka_unit_test(a_given_motion_needs_force_and_work),
      cmocka_unit_test(points_and_structures_share_a_scene),
      cmocka_unit_test(a_restart_continues_bitwise),
      cmocka_unit_test(steps_allocate_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
