/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Weight, its ramp and its turn; held nodes and their reactions; stress at rest. */
#include "engine/effects/params.h"
#include "tests/engine_helpers.h"

static const double density = 1600.0;
static const double pi = 3.14159265358979323846;

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

/* A 1 m x 1 m elastic block in a grid with room around it. */
static void free_block(pw_scene *scene)
{
  pw_scene_default(scene);
  test_grid(scene, (pw_real[4]){-2.0, 3.0, -2.0, 3.0}, 0.25);
  int m = test_elastic(scene, 1e6, 0.3, density);
  test_rectangle(scene, m, (pw_real[4]){0.1, 1.1, 0.1, 1.1}, 0.125);
  scene->time.dt_s = 1e-3;
}

static void free_fall_follows_ramp_and_turn(void **state)
{
  (void)state;
  pw_scene scene;
  free_block(&scene);
  pw_gravity_param *g = pw_scene_add_effect(&scene, "gravity");
  g->acceleration_m_s2 = 10.0;
  g->ramp_s = 0.1;
  g->tilt_deg = 30.0;
  g->tilt_at_s = 0.1505; /* in the middle of a step */
  pw_sim *sim = test_sim(&scene, 1);
  test_run_to(sim, 0.05);
  assert_near(sim->load_factor, 0.495, 1e-12); /* mean over the last step of the ramp */
  test_run_to(sim, 0.3);
  /* Impulses: ramp 0.05 s, then 0.0505 s down, then 0.1495 s along the turned direction. */
  pw_real turned = 10.0 * 0.1495;
  assert_near(value_of(sim, "body0_velocity_x_m_s"), turned * sin(pi / 6.0), 1e-11);
  assert_near(value_of(sim, "body0_velocity_y_m_s"), -1.005 - turned * cos(pi / 6.0), 1e-11);
  pw_sim_destroy(&sim);
}

/* Bessel's function J0(x) = sum (-x^2 / 4)^k / k!^2, for small x. */
static pw_real bessel_j0(pw_real x)
{
  pw_real sum = 0.0, term = 1.0;
  for (int k = 1; k < 20; k++) {
    sum += term;
    term *= -0.25 * x * x / (k * k);
  }
  return sum;
}

/* A turn by alpha in the time T, the angle alpha (1 - cos(pi t / T)) / 2: the mean of its sine over
 * T is sin(alpha / 2) J0(alpha / 2), that of its cosine cos(alpha / 2) J0(alpha / 2) (Bessel's
 * integral). Steps take the angle in their middle, so to 1e-6 with 300 of them. */
static void free_fall_follows_a_smooth_turn(void **state)
{
  (void)state;
  const pw_real length = 0.3, alpha = pi / 3.0;
  pw_scene scene;
  free_block(&scene);
  pw_gravity_param *g = pw_scene_add_effect(&scene, "gravity");
  g->acceleration_m_s2 = 10.0;
  g->tilt_deg = 60.0;
  g->tilt_at_s = 0.05;
  g->tilt_over_s = length;
  pw_sim *sim = test_sim(&scene, 1);
  test_run_to(sim, 0.4);
  const pw_real turning = 10.0 * length * bessel_j0(0.5 * alpha), after = 10.0 * 0.05;
  const pw_real x = turning * sin(0.5 * alpha) + after * sin(alpha);
  const pw_real y = -(10.0 * 0.05 + turning * cos(0.5 * alpha) + after * cos(alpha));
  assert_relative(value_of(sim, "body0_velocity_x_m_s"), x, 1e-6);
  assert_relative(value_of(sim, "body0_velocity_y_m_s"), y, 1e-6);
  pw_sim_destroy(&sim);
}

static void work_of_weight_is_the_motion_it_gives(void **state)
{
  (void)state;
  for (int update = PW_MUSL; update <= PW_USF; update++) {
    pw_scene scene;
    free_block(&scene);
    scene.method.update = update;
    pw_gravity_param *g = pw_scene_add_effect(&scene, "gravity");
    g->acceleration_m_s2 = 10.0;
    pw_sim *sim = test_sim(&scene, 1);
    pw_real y0 = value_of(sim, "body0_y_m");
    test_run_to(sim, 0.2);
    pw_real drop = y0 - value_of(sim, "body0_y_m");
    assert_relative(drop, 0.5 * 10.0 * 0.2 * (0.2 + 1e-3), 1e-10); /* x(n+1) = x + dt v(n+1) */
    assert_relative(sim->energy.external, 0.5 * density * 2.0 * 2.0, 1e-10);
    pw_sim_destroy(&sim);
  }
}

/* Soil 2 m wide and 3 m high on a fixed base between rollers, stress at rest with K0 = 0.4. */
static void resting_soil(pw_scene *scene, int geometry, int basis)
{
  pw_scene_default(scene);
  scene->geometry = geometry;
  scene->method.basis = basis;
  test_grid(scene, (pw_real[4]){0.0, 2.0, 0.0, 4.0}, 0.5);
  int m = test_elastic(scene, 1e7, 0.2, density);
  test_rectangle(scene, m, (pw_real[4]){0.0, 2.0, 0.0, 3.0}, 0.25);
  pw_initial_stress_param *s = pw_scene_add_effect(scene, "initial_stress");
  s->body = 0;
  s->top_y_m = 3.0;
  s->k0 = 0.4;
  pw_gravity_param *g = pw_scene_add_effect(scene, "gravity");
  g->acceleration_m_s2 = 10.0;
  const int side[3] = {PW_SIDE_BOTTOM, PW_SIDE_LEFT, PW_SIDE_RIGHT};
  for (int k = 0; k < 3; k++) {
    pw_boundary_param *b = pw_scene_add_effect(scene, "boundary");
    b->side = side[k];
    b->fix_x = true;
    b->fix_y = side[k] == PW_SIDE_BOTTOM;
  }
}

static pw_real fastest_point(const pw_sim *sim)
{
  pw_real v = 0.0;
  for (pw_idx i = 0; i < sim->points.n; i++) {
    v = fmax(v, hypot(sim->points.v[i], sim->points.v[sim->points.ld + i]));
  }
  return v;
}

static void soil_at_rest_stays_at_rest(void **state)
{
  (void)state;
  for (int basis = PW_LINEAR; basis <= PW_CPDI; basis++) {
    for (int geometry = PW_PLANE; geometry <= PW_AXI; geometry++) {
      pw_scene scene;
      resting_soil(&scene, geometry, basis);
      pw_sim *sim = test_sim(&scene, 1);
      test_run_to(sim, 0.1);
      pw_real weight = density * 10.0 * 3.0 * (geometry == PW_AXI ? pi * 4.0 : 2.0);
      pw_real base = value_of(sim, "boundary_0_force_y_n");
      if (geometry == PW_PLANE || basis == PW_CPDI) {
        /* In the plane form the points of linear MPM and uGIMP miss r within a domain. */
        assert_true(fastest_point(sim) < 1e-10);
        assert_relative(base, weight, 1e-9);
      }
      pw_sim_destroy(&sim);
    }
  }
}

static void rollers_carry_the_pressure_at_rest(void **state)
{
  (void)state;
  pw_scene scene;
  resting_soil(&scene, PW_PLANE, PW_CPDI);
  pw_sim *sim = test_sim(&scene, 1);
  assert_ok(pw_sim_step(sim, 0.0));
  /* K0 gamma z over 3 m; the corner nodes are held, and counted, by the base, which comes first:
   * their share is the part of the wall's pressure that the lowest element gives them. */
  pw_real gamma = density * 10.0, cell = 0.5, wall = 0.4 * gamma * 3.0 * 3.0 / 2.0;
  /* Stress is constant in each of the two rows of domains of the lowest cell. */
  pw_real corner = 0.4 * gamma * 0.5 * cell * (0.75 * 2.875 + 0.25 * 2.625);
  assert_relative(value_of(sim, "boundary_2_force_x_n"), -(wall - corner), 1e-9);
  assert_relative(value_of(sim, "boundary_1_force_x_n"), wall - corner, 1e-9);
  assert_near(value_of(sim, "boundary_0_force_x_n"), 0.0, 1e-6);
  assert_near(value_of(sim, "boundary_1_force_y_n"), 0.0, 0.0);
  pw_sim_destroy(&sim);
}

static void moving_walls_do_work(void **state)
{
  (void)state;
  pw_scene scene;
  pw_scene_default(&scene);
  test_grid(&scene, (pw_real[4]){0.0, 1.0, 0.0, 3.0}, 0.5);
  int m = test_elastic(&scene, 1e6, 0.0, 1000.0);
  test_rectangle(&scene, m, (pw_real[4]){0.0, 1.0, 0.0, 2.0}, 0.25);
  pw_boundary_param *base = pw_scene_add_effect(&scene, "boundary");
  base->side = PW_SIDE_BOTTOM;
  base->fix_y = true;
  pw_boundary_param *top = pw_scene_add_effect(&scene, "boundary");
  *top = (pw_boundary_param){.side = PW_SIDE_BOX,
                             .x_m = {0.0, 1.0},
                             .y_m = {2.0, 2.0},
                             .fix_y = true,
                             .velocity_y_m_s = -0.001,
                             .body = -1};
  scene.time.cfl = 0.2;
  pw_sim *sim = test_sim(&scene, 1);
  test_run_to(sim, 4.0); /* 32 passages of the wave: 4 mm over 2 m, strain 0.002 */
  pw_energy *e = &sim->energy;
  /* Static: E/2 strain^2 V = 4 J; the sudden start leaves waves of relative size v/(c strain). */
  assert_relative(e->external, 4.0, 0.05);
  pw_real kinetic = value_of(sim, "kinetic_j");
  assert_relative(e->strain_work + kinetic, e->external, 0.02);
  pw_sim_destroy(&sim);
}

static void unusable_boundaries_are_refused(void **state)
{
  (void)state;
  pw_scene scene;
  free_block(&scene);
  pw_boundary_param *b = pw_scene_add_effect(&scene, "boundary");
  const pw_effect *type = pw_effect_find("boundary");
  b->side = PW_SIDE_BOTTOM;
  assert_int_equal(type->check(&scene, b), PW_ERR_SCENE); /* nothing is held */
  b->fix_x = true;
  assert_int_equal(type->check(&scene, b), PW_OK);
  b->velocity_y_m_s = 1.0;
  assert_int_equal(type->check(&scene, b), PW_ERR_SCENE);
  b->velocity_y_m_s = 0.0;
  b->side = PW_SIDE_BOX;
  b->x_m[0] = 1.0;
  b->x_m[1] = 0.0;
  assert_int_equal(type->check(&scene, b), PW_ERR_SCENE);
  b->x_m[0] = b->x_m[1] = b->y_m[0] = b->y_m[1] = 50.0; /* outside the grid */
  pw_sim *sim = NULL;
  assert_int_equal(pw_sim_create(&scene, 1, &sim), PW_ERR_SCENE);
  assert_null(sim);
}

static void initial_stress_is_set_and_checked(void **state)
{
  (void)state;
  pw_scene scene;
  free_block(&scene);
  pw_initial_stress_param *s = pw_scene_add_effect(&scene, "initial_stress");
  s->body = 0;
  s->top_y_m = 1.1;
  s->k0 = 0.5;
  s->surcharge_pa = 100.0;
  assert_int_equal(pw_effect_find("initial_stress")->check(&scene, s),
                   PW_ERR_SCENE); /* no weight */
  s->acceleration_m_s2 = 10.0;
  pw_sim *sim = test_sim(&scene, 1);
  const pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n; i++) {
    pw_real yy = -(100.0 + density * 10.0 * (1.1 - p->x[p->ld + i]));
    assert_relative(p->stress[p->ld + i], yy, 1e-14);
    assert_relative(p->stress[i], 0.5 * yy, 1e-14);
    assert_relative(p->stress[2 * p->ld + i], 0.5 * yy, 1e-14);
  }
  pw_sim_destroy(&sim);
  *s = (pw_initial_stress_param){
      .kind = PW_STRESS_UNIFORM, .stress_xx_pa = -1.0, .stress_yy_pa = -2.0, .stress_zz_pa = 3.0};
  sim = test_sim(&scene, 1);
  for (pw_idx i = 0; i < sim->points.n; i++) {
    assert_near(sim->points.stress[i], -1.0, 0.0);
    assert_near(sim->points.stress[sim->points.ld + i], -2.0, 0.0);
    assert_near(sim->points.stress[2 * sim->points.ld + i], 3.0, 0.0);
  }
  pw_sim_destroy(&sim);
  scene.body[0].material = test_neo_hookean(&scene, 1e6, 5e5, density);
  assert_int_equal(pw_effect_find("initial_stress")->check(&scene, s), PW_ERR_SCENE);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(free_fall_follows_ramp_and_turn),
      cmocka_unit_test(free_fall_follows_a_smooth_turn),
      cmocka_unit_test(work_of_weight_is_the_motion_it_gives),
      cmocka_unit_test(soil_at_rest_stays_at_rest),
      cmocka_unit_test(rollers_carry_the_pressure_at_rest),
      cmocka_unit_test(moving_walls_do_work),
      cmocka_unit_test(unusable_boundaries_are_refused),
      cmocka_unit_test(initial_stress_is_set_and_checked),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
