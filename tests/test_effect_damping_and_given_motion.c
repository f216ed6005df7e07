/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Local damping changes accelerations by its coefficient; a given motion is followed exactly and
 * its driving force balances weight and inertia. The watch over the balance of energy lets a wall
 * move into soil at rest, and stress be let go, but not a step beyond the stability limit. */
#include "engine/effects/params.h"
#include "tests/engine_helpers.h"

static const double density = 1000.0, g = 10.0, dt = 1e-3;

static pw_real value_of(const pw_sim *sim, const char *name)
{
  pw_record row;
  pw_sim_history(sim, &row);
  for (int k = 0; k < row.n; k++) {
    if (strcmp(row.item[k].name, name) == 0) {
      return row.item[k].value;
    }
  }
  fail_msg("no column %s", name);
  return 0.0;
}

/* A block of 1 m2 and 1000 kg/m under gravity, with nothing else around. */
static void falling_block(pw_scene *scene, pw_real velocity_y)
{
  pw_scene_default(scene);
  test_grid(scene, (pw_real[4]){-2.0, 3.0, -2.0, 4.0}, 0.25);
  int m = test_elastic(scene, 1e6, 0.3, density);
  pw_scene_body *b = test_rectangle(scene, m, (pw_real[4]){0.1, 1.1, 0.1, 1.1}, 0.125);
  b->velocity_m_s[1] = velocity_y;
  scene->time.dt_s = dt;
  pw_gravity_param *p = pw_scene_add_effect(scene, "gravity");
  p->acceleration_m_s2 = g;
}

static void damped_fall_is_slower_and_damped_rise_shorter(void **state)
{
  (void)state;
  const pw_real alpha = 0.3;
  pw_scene scene;
  for (int up = 0; up < 2; up++) {
    falling_block(&scene, up ? 2.0 : -1.0);
    pw_damping_local_param *d = pw_scene_add_effect(&scene, "damping_local");
    d->coefficient = alpha;
    d->until_s = 0.1;
    pw_sim *sim = test_sim(&scene, 1);
    pw_real k0 = value_of(sim, "kinetic_j");
    test_run_to(sim, 0.1);
    /* Against the motion: the weight counts 1 + alpha upwards, 1 - alpha downwards. */
    pw_real v = up ? 2.0 - (1.0 + alpha) * g * 0.1 : -1.0 - (1.0 - alpha) * g * 0.1;
    assert_near(value_of(sim, "body0_velocity_y_m_s"), v, 1e-11);
    /* Mean velocity times time; its work and that of the weight make up the motion. */
    pw_real lost = alpha * density * g * fabs(0.5 * (v + (up ? 2.0 : -1.0))) * 0.1;
    assert_relative(sim->energy.damping, lost, 1e-10);
    assert_relative(sim->energy.external - lost, value_of(sim, "kinetic_j") - k0, 1e-9);
    test_run_to(sim, 0.2);
    assert_near(value_of(sim, "body0_velocity_y_m_s"), v - g * 0.1, 1e-11);
    assert_relative(sim->energy.damping, lost, 1e-10);
    pw_sim_destroy(&sim);
  }
}

static void damped_column_settles_with_its_energy_accounted_for(void **state)
{
  (void)state;
  pw_scene scene;
  pw_scene_default(&scene);
  test_grid(&scene, (pw_real[4]){0.0, 0.5, 0.0, 5.0}, 0.25);
  int m = test_elastic(&scene, 1e7, 0.0, density);
  test_rectangle(&scene, m, (pw_real[4]){0.0, 0.5, 0.0, 4.0}, 0.125);
  pw_gravity_param *p = pw_scene_add_effect(&scene, "gravity");
  p->acceleration_m_s2 = g;
  pw_boundary_param *b = pw_scene_add_effect(&scene, "boundary");
  b->side = PW_SIDE_BOTTOM;
  b->fix_x = b->fix_y = true;
  pw_damping_local_param *d = pw_scene_add_effect(&scene, "damping_local");
  d->coefficient = 0.5;
  pw_sim *sim = test_sim(&scene, 1);
  pw_real y0 = value_of(sim, "body0_y_m");
  test_run_to(sim, 4.0);
  /* Static: mean settlement rho g H^2 / 3 E, stored energy half of what the weight gave up. */
  pw_real drop = density * g * 16.0 / (3.0 * 1e7);
  assert_relative(y0 - value_of(sim, "body0_y_m"), drop, 0.005);
  assert_relative(sim->energy.external, density * g * 2.0 * drop, 0.005);
  assert_relative(sim->energy.damping, 0.5 * sim->energy.external, 0.01);
  pw_real rest = value_of(sim, "kinetic_j") + sim->energy.strain_work + sim->energy.damping;
  assert_relative(rest, sim->energy.external, 0.002);
  pw_sim_destroy(&sim);
}

static void given_motion_is_followed_and_balanced(void **state)
{
  (void)state;
  for (int update = PW_MUSL; update <= PW_USF; update++) {
    pw_scene scene;
    falling_block(&scene, 0.0);
    scene.method.update = update;
    pw_prescribed_motion_param *m = pw_scene_add_effect(&scene, "prescribed_motion");
    m->body = 0;
    m->velocity_m_s[0] = 1.0;
    m->velocity_m_s[1] = -0.5;
    m->start_s = 0.05;
    m->ramp_s = 0.1;
    pw_sim *sim = test_sim(&scene, 1);
    pw_real x0 = value_of(sim, "body0_x_m"), y0 = value_of(sim, "body0_y_m");
    test_run_to(sim, 0.05);
    assert_near(value_of(sim, "body0_y_m"), y0, 1e-13); /* held until it starts */
    assert_relative(value_of(sim, "prescribed_motion_0_force_y_n"), density * g, 1e-10);
    test_run_to(sim, 0.1);
    assert_relative(value_of(sim, "prescribed_motion_0_force_x_n"), density * 10.0, 1e-9);
    assert_relative(value_of(sim, "prescribed_motion_0_force_y_n"), density * (g - 5.0), 1e-9);
    test_run_to(sim, 0.25);
    assert_near(value_of(sim, "body0_x_m") - x0, 0.05 + 0.1, 1e-12);
    assert_near(value_of(sim, "body0_y_m") - y0, -0.075, 1e-12);
    assert_near(value_of(sim, "body0_velocity_x_m_s"), 1.0, 1e-14);
    assert_near(value_of(sim, "prescribed_motion_0_force_x_n"), 0.0, 1e-6 * density);
    /* All work is in the motion: no strain. */
    pw_real kinetic = 0.5 * density * 1.25;
    assert_relative(value_of(sim, "kinetic_j"), kinetic, 1e-12);
    assert_relative(sim->energy.external, kinetic, 1e-9);
    assert_near(sim->energy.strain_work, 0.0, 1e-9);
    pw_sim_destroy(&sim);
  }
}

/* The place of a body that vibrates is exact at the ends of the steps, v t + a sin(2 pi f t), also
 * when it starts within one. */
static void vibration_is_followed(void **state)
{
  (void)state;
  const pw_real v = -0.5, a = 0.01, f = 12.0, start = 0.0207;
  pw_scene scene;
  falling_block(&scene, 0.0);
  pw_prescribed_motion_param *m = pw_scene_add_effect(&scene, "prescribed_motion");
  *m = (pw_prescribed_motion_param){.velocity_m_s = {0.0, v},
                                    .start_s = start,
                                    .vibration_amplitude_m = a,
                                    .vibration_frequency_hz = f};
  pw_sim *sim = test_sim(&scene, 1);
  const pw_real y0 = value_of(sim, "body0_y_m");
  pw_real largest = 0.0;
  while (sim->time < 0.2) {
    assert_ok(pw_sim_step(sim, 0.0));
    const pw_real since = pw_max(sim->time - start, 0.0), swing = a * sin(2.0 * PW_PI * f * since);
    assert_near(value_of(sim, "body0_y_m") - y0, v * since + swing, 1e-12);
    largest = pw_max(largest, fabs(swing));
  }
  assert_true(largest > 0.99 * a);
  pw_sim_destroy(&sim);
}

static void given_motion_needs_its_own_field(void **state)
{
  (void)state;
  pw_scene scene;
  falling_block(&scene, 0.0);
  pw_prescribed_motion_param *m = pw_scene_add_effect(&scene, "prescribed_motion");
  const pw_effect *type = pw_effect_find("prescribed_motion");
  m->body = 0;
  m->vibration_frequency_hz = 20.0;
  assert_int_equal(type->check(&scene, m), PW_ERR_SCENE);
  m->vibration_frequency_hz = 0.0;
  assert_int_equal(type->check(&scene, m), PW_OK);
  test_rectangle(&scene, 0, (pw_real[4]){1.5, 2.0, 0.1, 0.6}, 0.125);
  assert_int_equal(type->check(&scene, m), PW_ERR_SCENE);
  scene.nbody = 1;
  scene.geometry = PW_AXI;
  m->velocity_m_s[0] = 1.0;
  assert_int_equal(type->check(&scene, m), PW_ERR_SCENE);
}

/* Elastic soil, 2 x 2 points in each cell of 0.1 m. */
static void elastic_soil(pw_scene *scene, int update, const pw_real *grid, const pw_real *box)
{
  pw_scene_default(scene);
  scene->time.cfl = 0.5;
  scene->method.update = update;
  test_grid(scene, grid, 0.1);
  test_rectangle(scene, test_elastic(scene, 1e7, 0.3, 2000.0), box, 0.05);
}

/* Between rollers, the right one of which moves into it from the start. */
static void moving_wall(pw_scene *scene, int update)
{
  elastic_soil(scene, update, (pw_real[4]){0.0, 1.0, 0.0, 1.5}, (pw_real[4]){0.0, 1.0, 0.0, 1.0});
  const int side[3] = {PW_SIDE_LEFT, PW_SIDE_BOTTOM, PW_SIDE_RIGHT};
  for (int k = 0; k < 3; k++) {
    pw_boundary_param *b = pw_scene_add_effect(scene, "boundary");
    b->side = side[k];
    b->fix_x = side[k] != PW_SIDE_BOTTOM;
    b->fix_y = !b->fix_x;
    b->velocity_x_m_s = side[k] == PW_SIDE_RIGHT ? -1.0 : 0.0;
  }
}

/* A free block under 100 kPa from all sides. */
static void stressed_block(pw_scene *scene, int update)
{
  elastic_soil(scene, update, (pw_real[4]){0.0, 2.0, 0.0, 2.0}, (pw_real[4]){0.5, 1.5, 0.5, 1.5});
  pw_initial_stress_param *i = pw_scene_add_effect(scene, "initial_stress");
  i->body = 0;
  i->kind = PW_STRESS_UNIFORM;
  i->stress_xx_pa = i->stress_yy_pa = i->stress_zz_pa = -1e5;
}

static void walls_may_move_and_stress_be_let_go(void **state)
{
  (void)state;
  static pw_scene scene;
  for (int update = PW_MUSL; update <= PW_USF; update++) {
    moving_wall(&scene, update);
    pw_sim *sim = test_sim(&scene, 1);
    test_run_to(sim, 0.02);
    pw_real taken = value_of(sim, "kinetic_j") + sim->energy.strain_work;
    print_message("update %d: the wall works %.4g J, the soil takes %.4g J\n", update,
                  sim->energy.external, taken);
    assert_relative(taken, sim->energy.external, 0.1);
    pw_sim_destroy(&sim);
    /* What plane strain under s stores, (1 + nu) (1 - 2 nu) s^2 / E per volume, moves the block,
     * but for what other parts of it hold at that time. */
    const pw_real stored = 1.3 * 0.4 * 1e5 * 1e5 / 1e7;
    stressed_block(&scene, update);
    sim = test_sim(&scene, 1);
    pw_real most = 0.0, kinetic = 0.0;
    while (sim->time < 0.02) {
      assert_ok(pw_sim_step(sim, 0.0));
      most = pw_max(most, -sim->energy.strain_work);
      kinetic = pw_max(kinetic, value_of(sim, "kinetic_j"));
    }
    print_message("update %d: stresses give up %.4g J of %.4g J, the block moves with %.4g J\n",
                  update, most, stored, kinetic);
    assert_true(most > 0.75 * stored && most < stored);
    assert_true(kinetic > 0.75 * stored && kinetic < stored);
    pw_sim_destroy(&sim);
  }
}

static void steps_beyond_the_limit_are_stopped(void **state)
{
  (void)state;
  static pw_scene scene;
  for (int k = 0; k < 6; k++) {
    (k % 2 == 0 ? moving_wall : stressed_block)(&scene, PW_MUSL + k / 2);
    scene.time.dt_s = 2.5e-3; /* a wave takes 1.2e-3 s through a cell */
    pw_sim *sim = test_sim(&scene, 1);
    pw_status status = PW_OK;
    while (status == PW_OK && sim->step < 1000) {
      status = pw_sim_step(sim, 0.0);
    }
    print_message("%s: stopped at step %lld with %s\n", k % 2 == 0 ? "wall" : "block",
                  (long long)sim->step, pw_error_text());
    assert_int_equal(status, PW_RETRY_DIVERGED);
    pw_sim_destroy(&sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(damped_fall_is_slower_and_damped_rise_shorter),
      cmocka_unit_test(damped_column_settles_with_its_energy_accounted_for),
      cmocka_unit_test(given_motion_is_followed_and_balanced),
      cmocka_unit_test(vibration_is_followed),
      cmocka_unit_test(given_motion_needs_its_own_field),
      cmocka_unit_test(walls_may_move_and_stress_be_let_go),
      cmocka_unit_test(steps_beyond_the_limit_are_stopped),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
