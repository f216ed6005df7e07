/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Layered ground with ground water starts in equilibrium: effective stresses are those of the hand
 * formula, nothing is left at free nodes, and the soil sits still.
 *
 * Upper layer 6 to 10 m, elastic, dry density 1600 kg/m3, porosity 0.4, K0 0.5; lower layer 0 to
 * 6 m, sand of 2600 kg/m3 grains and e = 0.65, K0 0.42; water at 8 m, 1000 kg/m3; surcharge 5 kPa;
 * g = 10 m/s2. Below the water the upper layer weighs 16 - 0.6 * 10 = 10 kN/m3, the lower one
 * (2600 - 1000) / 1.65 * 10 = 9.697 kN/m3. */
#include "tests/case_helpers.h"
#include "tests/engine_scenes.h"

#include "io/restart.h"
#include "tests/output_helpers.h"

static const double table = 8.0, surcharge = 5e3;

static double by_hand(double y)
{
  double lower = 1600.0 / 1.65 * 10.0;
  if (y >= table) {
    return -(surcharge + 16e3 * (10.0 - y));
  }
  return y >= 6.0 ? -(surcharge + 32e3 + 10e3 * (table - y))
                  : -(surcharge + 52e3 + lower * (6.0 - y));
}

static pw_initial_stress_param *ground(pw_scene *s, int geometry, bool inertia)
{
  pw_scene_default(s);
  s->geometry = geometry;
  test_grid(s, (pw_real[]){0.0, 1.0, 0.0, 10.5}, 0.5);
  int soil = test_elastic(s, 5e7, 0.3, 1600.0), sand = test_sand(s, true);
  test_rectangle(s, sand, (pw_real[]){0.0, 1.0, 0.0, 6.0}, 0.25);
  test_rectangle(s, soil, (pw_real[]){0.0, 1.0, 6.0, 10.0}, 0.25);
  pw_initial_stress_param *p = pw_scene_add_effect(s, "initial_stress");
  p->kind = PW_STRESS_LAYERS;
  p->nlayer = 2;
  p->layer[0] = (pw_ground_layer){.body = 1, .k0 = 0.5, .porosity = 0.4};
  p->layer[1] = (pw_ground_layer){.body = 0, .k0 = 0.42};
  p->surcharge_pa = surcharge;
  p->water_table_y_m = table;
  p->water_inertia = inertia;
  test_gravity(s, 0.0)->acceleration_m_s2 = 10.0;
  pw_surcharge_param *load = pw_scene_add_effect(s, "surcharge");
  load->body = 1;
  load->side = PW_SIDE_TOP;
  load->pressure_pa = surcharge;
  test_roller(s, PW_SIDE_BOTTOM);
  test_roller(s, PW_SIDE_LEFT);
  test_roller(s, PW_SIDE_RIGHT);
  return p;
}

static double result(const pw_sim *sim, const char *name)
{
  static pw_record r;
  pw_sim_results(sim, &r);
  for (int k = 0; k < r.n; k++) {
    if (strcmp(r.item[k].name, name) == 0) {
      return r.item[k].value;
    }
  }
  fail_msg("no result %s", name);
  return 0.0;
}

/* The case layered_ground, read from its file: 2 m of sand above the water, 1 m below it, 2 m of silt
 * (1500 - 0.56 * 1000 kg/m3) and 5 m of dense sand but for half a row of points. */
static void the_case_rests(void **state)
{
  (void)state;
  pw_sim *sim = test_case("layered_ground/scene.yaml", 0, NULL);
  const pw_points *p = &sim->points;
  double base =
      2.0 * 2600.0 / 1.75 + 1600.0 / 1.75 + 2.0 * (1500.0 - 560.0) + (5.0 - 0.0625) * 1600.0 / 1.60;
  double lowest = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    lowest = fmin(lowest, p->stress[p->ld + i]);
  }
  assert_relative(lowest, -9.81 * base, 1e-12);
  for (int n = 0; n < 50; n++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
  assert_true(result(sim, "initial_residual_relative") < 1e-10);
  pw_sim_destroy(&sim);
}

static double profile_error(const pw_sim *sim, bool lateral)
{
  const pw_points *p = &sim->points;
  double most = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    double y = p->x[p->ld + i], yy = by_hand(y), k0 = y > 6.0 ? 0.5 : 0.42;
    most = fmax(most, fabs(p->stress[p->ld + i] / yy - 1.0));
    for (int c = 0; c <= 2 && lateral; c += 2) {
      most = fmax(most, fabs(p->stress[c * p->ld + i] / (k0 * yy) - 1.0));
    }
  }
  return most;
}

static void profile_is_exact_and_rests(void **state)
{
  (void)state;
  static pw_scene s;
  for (int k = 0; k < 4; k++) {
    ground(&s, k % 2 == 0 ? PW_PLANE : PW_AXI, k < 2);
    pw_sim *sim = test_sim(&s, 1);
    double start = profile_error(sim, true), speed = 0.0;
    for (int n = 0; n < 200; n++) {
      assert_ok(pw_sim_step(sim, 0.0));
    }
    for (pw_idx i = 0; i < sim->points.n; i++) {
      speed = fmax(speed, hypot(sim->points.v[i], sim->points.v[sim->points.ld + i]));
    }
    double residual = result(sim, "initial_residual_relative");
    double drift = profile_error(sim, false);
    print_message("%s, %s mass: profile within %.1e, residual %.1e of a node's weight; after 200 "
                  "steps profile within %.1e, speed %.1e m/s\n",
                  k % 2 == 0 ? "plane" : "axisymmetric", k < 2 ? "saturated" : "dry", start,
                  residual, drift, speed);
    assert_true(start < 1e-10);
    assert_true(residual < 1e-10);
    assert_true(drift < 1e-8);
    assert_true(speed < 1e-10);
    assert_true(fabs(sim->energy.external) < 1e-6);
    pw_sim_destroy(&sim);
  }
}

/* Mass of a point below the water: the dry one, or with n rho_w more. */
static void saturated_mass_is_a_choice(void **state)
{
  (void)state;
  static pw_scene s;
  for (int inertia = 0; inertia < 2; inertia++) {
    ground(&s, PW_PLANE, inertia);
    pw_sim *sim = test_sim(&s, 1);
    const pw_points *p = &sim->points;
    double n = 0.65 / 1.65, mass = 0.0;
    for (pw_idx i = 0; i < p->n; i++) {
      double y = p->x[p->ld + i], pores = y > table ? 0.0 : y > 6.0 ? 0.4 : n;
      double rho = (y > 6.0 ? 1600.0 : 2600.0 / 1.65) + inertia * 1000.0 * pores;
      assert_relative(p->mass[i], rho * p->vol[i], 1e-12);
      mass += p->mass[i];
    }
    assert_relative(sim->mass, mass, 1e-12);
    pw_sim_destroy(&sim);
  }
}

/* A table inside the domains of a row: the mean over the domain keeps the equilibrium. */
static void water_table_may_cut_domains(void **state)
{
  (void)state;
  static pw_scene s;
  ground(&s, PW_PLANE, true)->water_table_y_m = 7.55;
  pw_sim *sim = test_sim(&s, 1);
  assert_ok(pw_sim_step(sim, 0.0));
  double residual = result(sim, "initial_residual_relative");
  print_message("water table within a row of points: residual %.1e\n", residual);
  assert_true(residual < 0.02);
  pw_sim_destroy(&sim);
}

/* Let fall, wet soil accelerates by (rho_d - (1 - n) rho_w) g over the mass that moves. */
static void buoyancy_drives_what_falls(void **state)
{
  (void)state;
  static pw_scene s;
  for (int inertia = 0; inertia < 2; inertia++) {
    pw_initial_stress_param *p = ground(&s, PW_PLANE, inertia);
    p->surcharge_pa = 0.0;
    s.body[0].material = s.body[1].material;
    p->layer[0].porosity = p->layer[1].porosity = 0.4;
    p->water_table_y_m = 20.0;
    s.neffect = 2; /* no surcharge, no rollers */
    pw_sim *sim = test_sim(&s, 1);
    memset(sim->points.stress, 0, 6 * (size_t)sim->points.ld * sizeof(pw_real));
    test_run_to(sim, 0.01);
    double mass = 1600.0 + inertia * 400.0, fall = -10e3 / mass * 0.01, work = 0.0;
    for (pw_idx i = 0; i < sim->points.n; i++) {
      assert_relative(sim->points.v[sim->points.ld + i], fall, 1e-9);
      work += 0.5 * sim->points.mass[i] * fall * fall;
    }
    assert_relative(sim->energy.external, work, 1e-6);
    pw_sim_destroy(&sim);
  }
}

static void same_bits_and_restart(void **state)
{
  (void)state;
  static pw_scene s;
  const char *folder = test_folder(), *file = test_path(folder, "half.h5");
  ground(&s, PW_AXI, true);
  s.body[1].velocity_m_s[1] = -0.5; /* something to happen, and points to be sorted again */
  s.method.block_elements = 8;
  pw_sim *one = test_sim(&s, 1), *many = test_sim(&s, 3);
  for (int n = 0; n < 300; n++) {
    assert_ok(pw_sim_step(one, 0.0));
    assert_ok(pw_sim_step(many, 0.0));
    if (n == 200) {
      assert_ok(pw_restart_write(file, many));
    }
  }
  const size_t bytes = 6 * (size_t)one->points.ld * sizeof(pw_real);
  assert_memory_equal(one->points.stress, many->points.stress, bytes);
  pw_sim_destroy(&many);
  many = test_sim(&s, 2);
  assert_ok(pw_sim_step(many, 0.0));
  assert_ok(pw_restart_read(file, many));
  for (int n = 201; n < 300; n++) {
    assert_ok(pw_sim_step(many, 0.0));
  }
  assert_memory_equal(one->points.stress, many->points.stress, bytes);
  assert_memory_equal(&one->energy, &many->energy, sizeof one->energy);
  pw_sim_destroy(&one);
  pw_sim_destroy(&many);
  test_remove_folder(folder);
}

static void refuse(const pw_scene *s, const char *rule)
{
  assert_int_equal(pw_scene_check(s), PW_ERR_SCENE);
  if (!strstr(pw_error_text(), rule)) {
    fail_msg("'%s' instead of '%s'", pw_error_text(), rule);
  }
}

static void bad_layers_are_refused(void **state)
{
  (void)state;
  static pw_scene s;
  pw_initial_stress_param *p = ground(&s, PW_PLANE, true);
  assert_ok(pw_scene_check(&s));
  s.body[0].y_m[1] = 5.5;
  refuse(&s, "layers.1: 'body0' begins at 5.5 m and leaves a gap below 'body1'");
  s.body[0].y_m[1] = 6.5;
  refuse(&s, "layers.1: 'body0' reaches up to 6.5 m and overlaps 'body1'");
  s.body[0].y_m[1] = 6.0;
  s.body[0].x_m[1] = 0.5;
  refuse(&s, "layers.1: 'body0' reaches from x = 0 to 0.5 m");
  s.body[0].x_m[1] = 1.0;
  p->layer[1].k0 = -0.1;
  refuse(&s, "layers.1: k0");
  p->layer[1].k0 = 0.42;
  p->layer[0].porosity = 0.0;
  refuse(&s, "layers.0: porosity is needed below the water table");
  p->layer[0].porosity = 0.4;
  p->water_density_kg_m3 = 2700.0;
  refuse(&s, "layers.0: the grains of 'body1' are lighter than water");
  p->water_density_kg_m3 = 1000.0;
  p->layer[1] = p->layer[0];
  refuse(&s, "layers.1: body 'body1' is layer 0 already");
  p->layer[1] = (pw_ground_layer){.body = 0, .k0 = 0.42};
  p->nlayer = 1;
  refuse(&s, "layers: body 'body0' reaches below the surface but is no layer");
  p->nlayer = 0;
  refuse(&s, "kind layers needs layers");
  p->nlayer = 2;
  s.body[1].shape = PW_SHAPE_DISC;
  s.body[1].centre_m[0] = 0.5;
  s.body[1].centre_m[1] = 8.0;
  s.body[1].radius_m = 0.4;
  refuse(&s, "layers.0: body 'body1' is not a rectangle");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(profile_is_exact_and_rests),
      cmocka_unit_test(saturated_mass_is_a_choice),
      cmocka_unit_test(water_table_may_cut_domains),
      cmocka_unit_test(buoyancy_drives_what_falls),
      cmocka_unit_test(same_bits_and_restart),
      cmocka_unit_test(bad_layers_are_refused),
      cmocka_unit_test(the_case_rests),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
