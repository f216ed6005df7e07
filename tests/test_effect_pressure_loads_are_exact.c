/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Surcharge and hammer: total force, direction, balance with a uniform stress, impulse, work. */
#include "engine/effects/params.h"
#include "tests/engine_helpers.h"

static const double pi = 3.14159265358979323846;

static pw_real item(const pw_record *r, const char *name)
{
  for (int k = 0; k < r->n; k++) {
    if (strcmp(r->item[k].name, name) == 0) {
      return r->item[k].value;
    }
  }
  fail_msg("no item %s", name);
  return 0.0;
}

static void momentum_of(const pw_sim *sim, pw_real *out)
{
  const pw_points *p = &sim->points;
  out[0] = out[1] = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    out[0] += sim->measure * p->mass[i] * p->v[i];
    out[1] += sim->measure * p->mass[i] * p->v[p->ld + i];
  }
}

/* A block from (0.35, 0.15) to (1.15, 1.35) with nodes all around it. */
static void block(pw_scene *scene, int geometry, int basis)
{
  pw_scene_default(scene);
  scene->geometry = geometry;
  scene->method.basis = basis;
  test_grid(scene, (pw_real[4]){0.0, 2.0, -1.0, 2.0}, 0.25);
  int m = test_elastic(scene, 1e6, 0.25, 1000.0);
  test_rectangle(scene, m, (pw_real[4]){0.35, 1.15, 0.15, 1.35}, 0.1);
  scene->time.dt_s = 1e-4;
}

static void total_force_is_pressure_times_face(void **state)
{
  (void)state;
  const pw_real p = 1000.0, dt = 1e-4;
  for (int geometry = PW_PLANE; geometry <= PW_AXI; geometry++) {
    for (int basis = PW_LINEAR; basis <= PW_CPDI; basis++) {
      for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_RIGHT; side++) {
        pw_scene scene;
        block(&scene, geometry, basis);
        pw_surcharge_param *s = pw_scene_add_effect(&scene, "surcharge");
        s->body = 0;
        s->side = side;
        s->pressure_pa = p;
        pw_sim *sim = test_sim(&scene, 1);
        assert_ok(pw_sim_step(sim, 0.0));
        pw_real mv[2], ring = pi * (1.15 * 1.15 - 0.35 * 0.35);
        momentum_of(sim, mv);
        pw_real face = side <= PW_SIDE_TOP ? 0.8 : 1.2;
        if (geometry == PW_AXI) {
          face = side <= PW_SIDE_TOP ? ring : 2.0 * pi * 1.2 * (side == PW_SIDE_LEFT ? 0.35 : 1.15);
          /* Without domains the radius is that of the points next to the face. */
          bool vertical = side > PW_SIDE_TOP && basis == PW_LINEAR;
          face *= vertical ? (side == PW_SIDE_LEFT ? 0.40 / 0.35 : 1.10 / 1.15) : 1.0;
        }
        pw_real along = side <= PW_SIDE_TOP ? mv[1] : mv[0];
        pw_real sign = side == PW_SIDE_TOP || side == PW_SIDE_RIGHT ? -1.0 : 1.0;
        assert_relative(along, sign * p * face * dt, 1e-11);
        assert_near(side <= PW_SIDE_TOP ? mv[0] : mv[1], 0.0, 1e-12 * p * face * dt);
        pw_sim_destroy(&sim);
      }
    }
  }
}

/* A uniform stress -p under a pressure p on every free side is in equilibrium to rounding: loads
 * of edges and internal forces of CPDI domains are the same boundary integrals. */
static void uniform_stress_balances_pressure(void **state)
{
  (void)state;
  for (int geometry = PW_PLANE; geometry <= PW_AXI; geometry++) {
    pw_scene scene;
    block(&scene, geometry, PW_CPDI);
    pw_initial_stress_param *u = pw_scene_add_effect(&scene, "initial_stress");
    *u = (pw_initial_stress_param){.kind = PW_STRESS_UNIFORM,
                                   .stress_xx_pa = -5e3,
                                   .stress_yy_pa = -5e3,
                                   .stress_zz_pa = -5e3};
    for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_RIGHT; side++) {
      pw_surcharge_param *s = pw_scene_add_effect(&scene, "surcharge");
      s->body = 0;
      s->side = side;
      s->pressure_pa = 5e3;
    }
    pw_sim *sim = test_sim(&scene, 1);
    for (int k = 0; k < 50; k++) {
      assert_ok(pw_sim_step(sim, 0.0));
    }
    for (pw_idx i = 0; i < sim->points.n; i++) {
      /* p A dt / m of one point is 5e-3 m/s a step. */
      assert_near(hypot(sim->points.v[i], sim->points.v[sim->points.ld + i]), 0.0, 1e-12);
    }
    pw_sim_destroy(&sim);
  }
}

static void surcharge_ramps_and_starts(void **state)
{
  (void)state;
  pw_scene scene;
  block(&scene, PW_PLANE, PW_CPDI);
  pw_surcharge_param *s = pw_scene_add_effect(&scene, "surcharge");
  s->body = 0;
  s->pressure_pa = 100.0;
  s->start_s = 0.01;
  s->ramp_s = 0.02;
  pw_sim *sim = test_sim(&scene, 1);
  pw_real mv[2];
  test_run_to(sim, 0.01);
  momentum_of(sim, mv);
  assert_near(mv[1], 0.0, 0.0);
  test_run_to(sim, 0.04);
  momentum_of(sim, mv);
  assert_relative(mv[1], -100.0 * 0.8 * 0.02, 1e-5); /* the face widens a little */
  pw_sim_destroy(&sim);
}

/* Verification A2, free toe: the pulse of the thesis, q = 1 MPa for 4 L/c, leaves a column of
 * 2500 kg/m3 and 5 m at exactly 8 m/s in the mean. */
static void column(pw_scene *scene, int geometry)
{
  pw_scene_default(scene);
  scene->geometry = geometry;
  test_grid(scene, (pw_real[4]){0.0, 0.25, -1.0, 5.25}, 0.125);
  int m = test_elastic(scene, 1e8, 0.0, 2500.0);
  pw_real radius = geometry == PW_AXI ? 0.15 : 0.25;
  test_rectangle(scene, m, (pw_real[4]){0.0, radius, 0.0, 5.0}, 0.0625);
  pw_hammer_param *h = pw_scene_add_effect(scene, "hammer");
  h->body = 0;
  h->pressure_pa = 1e6;
  h->duration_s = 0.1;
  for (int side = PW_SIDE_LEFT; side <= PW_SIDE_RIGHT && geometry == PW_PLANE; side++) {
    pw_boundary_param *b = pw_scene_add_effect(scene, "boundary");
    b->side = side;
    b->fix_x = true;
  }
}

static void blow_gives_the_exact_momentum(void **state)
{
  (void)state;
  pw_scene scene;
  column(&scene, PW_PLANE);
  pw_sim *sim = test_sim(&scene, 1);
  test_run_to(sim, 0.05);
  pw_record row;
  pw_sim_history(sim, &row);
  assert_relative(item(&row, "hammer_force_n"), 1e6 * 0.25, 1e-11);
  test_run_to(sim, 0.11);
  pw_sim_history(sim, &row);
  assert_near(item(&row, "hammer_force_n"), 0.0, 0.0);
  assert_relative(item(&row, "body0_velocity_y_m_s"), -8.0, 1e-10);
  pw_sim_results(sim, &row);
  assert_relative(item(&row, "hammer_impulse_n_s"), 1e6 * 0.25 * 0.1, 1e-11);
  assert_near(item(&row, "blows"), 1.0, 0.0);
  /* Free body: the work is all in motion and strain; the exact solution is a rigid 8 m/s. */
  pw_real mass = 2500.0 * 1.25, kinetic = 0.5 * mass * 64.0;
  assert_relative(sim->energy.external, kinetic, 0.02);
  pw_report report;
  pw_sim_report(sim, &report);
  assert_relative(report.energy.kinetic + report.energy.strain_work, report.energy.external, 0.01);
  pw_sim_destroy(&sim);
}

static void axisymmetric_head_carries_the_force_of_the_thesis(void **state)
{
  (void)state;
  pw_scene scene;
  column(&scene, PW_AXI);
  pw_hammer_param *h = (void *)scene.effect[0].param;
  h->pulse = PW_PULSE_HALF_SINE;
  pw_sim *sim = test_sim(&scene, 1);
  test_run_to(sim, 0.105);
  pw_record row;
  pw_sim_results(sim, &row);
  /* Verification A2: the rectangular pulse gives 7068.6 N s; a half sine 2/pi of it. The head's
   * area changes with the strain of the column, nu = 0: not at all. */
  assert_relative(item(&row, "hammer_impulse_n_s"), 2.0 / pi * 1e5 * pi * 0.15 * 0.15, 1e-4);
  pw_sim_destroy(&sim);
}

static void unusable_hammers_are_refused(void **state)
{
  (void)state;
  pw_scene scene;
  column(&scene, PW_PLANE);
  pw_hammer_param *h = (void *)scene.effect[0].param;
  const pw_effect *type = pw_effect_find("hammer");
  assert_int_equal(type->check(&scene, h), PW_OK);
  h->count = 2; /* no period */
  assert_int_equal(type->check(&scene, h), PW_ERR_SCENE);
  h->period_s = 0.1;
  assert_int_equal(type->check(&scene, h), PW_OK);
  h->rise_s = 0.01; /* pulses now overlap */
  assert_int_equal(type->check(&scene, h), PW_ERR_SCENE);
  h->count = 1;
  h->rise_s = 0.2;
  assert_int_equal(type->check(&scene, h), PW_ERR_SCENE);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(total_force_is_pressure_times_face),
      cmocka_unit_test(uniform_stress_balances_pressure),
      cmocka_unit_test(surcharge_ramps_and_starts),
      cmocka_unit_test(blow_gives_the_exact_momentum),
      cmocka_unit_test(axisymmetric_head_carries_the_force_of_the_thesis),
      cmocka_unit_test(unusable_hammers_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
