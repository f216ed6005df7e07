/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An absorbing side carries the soil at rest; without springs a pulse moves it by its impulse over
 * the impedance for good, with springs it comes back, and a lasting load moves it by load over
 * stiffness. Same bits on any number of threads and after a restart. */
#include "tests/absorbing_helpers.h"

#include "io/restart.h"
#include "tests/output_helpers.h"

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

static void steps(pw_sim *sim, int n)
{
  for (int k = 0; k < n; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
}

/* Largest change of a stress component against the profile at rest. */
static double stress_change(const pw_sim *sim, double k0)
{
  const pw_points *p = &sim->points;
  double most = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    double yy = -test_rho * 10.0 * (10.0 - p->x[p->ld + i]);
    most = fmax(most, fabs(p->stress[p->ld + i] - yy));
    most = fmax(most, fabs(p->stress[i] - k0 * yy));
  }
  return most;
}

static void soil_at_rest_stays(void **state)
{
  (void)state;
  static pw_scene s;
  const double base = test_rho * 10.0 * 10.0;
  for (int basis = PW_LINEAR; basis <= PW_CPDI; basis += PW_CPDI - PW_LINEAR) {
    test_column_at_rest(&s)->source_distance_m = basis == PW_CPDI ? 0.0 : 10.0;
    s.method.basis = basis;
    pw_sim *sim = test_sim(&s, 1);
    steps(sim, 3000);
    double change = stress_change(sim, 0.5) / base, moved = result(sim, "absorbing_0_moved_max_m");
    print_message(
        "at rest, basis %d, after 3000 steps: stress changed by %.1e of that at the base, "
        "side moved %.1e m, speed %.1e m/s\n",
        basis, change, moved, test_fastest(sim));
    assert_true(change < 1e-9);
    assert_true(moved < 1e-12);
    pw_sim_destroy(&sim);
  }
}

/* Both sides of a box and its bottom absorb, the corners twice; cells all alike, or growing. */
static void box_at_rest_stays(void **state)
{
  (void)state;
  static pw_scene s;
  for (int k = 0; k < 4; k++) {
    const int geometry = k % 2 == 0 ? PW_PLANE : PW_AXI;
    pw_scene_default(&s);
    s.geometry = geometry;
    test_grid(&s, (pw_real[]){0.0, 2.0, 0.0, 2.5}, 0.25);
    test_rectangle(&s, test_soil(&s), (pw_real[]){0.0, 2.0, 0.0, 2.0}, 0.125);
    if (k >= 2) { /* 0.1 m beside the axis and below the surface, growing by up to 1.3 */
      s.grid.cell_m = 0.1;
      s.grid.fine_x_m[1] = 0.5;
      s.grid.fine_y_m[0] = 1.5;
      s.grid.fine_y_m[1] = 2.5;
      s.grid.growth = 1.3;
      s.body[0].point_size_m = 0.0;
      s.body[0].points_per_cell = 2;
    }
    pw_initial_stress_param *i = pw_scene_add_effect(&s, "initial_stress");
    i->body = 0;
    i->top_y_m = 2.0;
    i->k0 = 0.5;
    test_gravity(&s, 0.0)->acceleration_m_s2 = 10.0;
    test_absorbing(&s, PW_SIDE_BOTTOM);
    test_absorbing(&s, PW_SIDE_RIGHT)->source_distance_m = 2.0;
    if (geometry == PW_PLANE) {
      test_absorbing(&s, PW_SIDE_LEFT);
    }
    pw_sim *sim = test_sim(&s, 1);
    steps(sim, 1000);
    print_message("%s box%s: initial residual %.1e of a node's weight, fastest %.1e m/s\n",
                  geometry == PW_PLANE ? "plane" : "axisymmetric", k < 2 ? "" : ", graded cells",
                  result(sim, "initial_residual_relative"), test_fastest(sim));
    assert_true(result(sim, "initial_residual_relative") < 1e-9);
    assert_true(test_fastest(sim) < 1e-9);
    double right = geometry == PW_PLANE ? 2.0 : 2.0 * 2.0 * acos(-1.0) * 2.0;
    assert_relative(result(sim, "absorbing_1_area_m2"), right, 1e-6);
    double bottom = geometry == PW_PLANE ? 2.0 : acos(-1.0) * 4.0;
    assert_relative(result(sim, "absorbing_0_area_m2"), bottom, 1e-6);
    pw_sim_destroy(&sim);
  }
}

/* The corner node of two sides belongs to both, whichever way they are held before their start,
 * and over whatever time each takes its mean: its reaction is carried on once. */
static void corners_are_carried_once(void **state)
{
  (void)state;
  static pw_scene s;
  for (int k = 0; k < 16; k++) {
    pw_scene_default(&s);
    test_grid(&s, (pw_real[]){0.0, 2.0, 0.0, 2.5}, 0.25);
    test_rectangle(&s, test_soil(&s), (pw_real[]){0.0, 2.0, 0.0, 2.0}, 0.125);
    pw_initial_stress_param *i = pw_scene_add_effect(&s, "initial_stress");
    i->body = 0;
    i->top_y_m = 2.0;
    i->k0 = 0.5;
    test_gravity(&s, 0.0)->acceleration_m_s2 = 10.0;
    test_roller(&s, PW_SIDE_LEFT);
    for (int side = 0; side < 2; side++) { /* let go together, or the first one later */
      pw_absorbing_param *a = test_absorbing(&s, side == 0 ? PW_SIDE_RIGHT : PW_SIDE_BOTTOM);
      a->start_s = side == 0 && k & 8 ? 0.03 : 0.02;
      a->before = side == 1 || k & 1 ? PW_BEFORE_FIXED : PW_BEFORE_ROLLER;
      a->mean_over_s = k & (side == 0 ? 2 : 4) ? 0.01 : 0.0;
    }
    pw_sim *sim = test_sim(&s, 1);
    test_run_to(sim, 0.1);
    assert_true(result(sim, "absorbing_0_moved_max_m") < 1e-12);
    assert_true(result(sim, "absorbing_1_moved_max_m") < 1e-12);
    assert_true(test_fastest(sim) < 1e-9);
    pw_sim_destroy(&sim);
  }
}

/* Gravity grows under local damping while the side is held, then it is let go. */
static void held_until_its_start(void **state)
{
  (void)state;
  static pw_scene s;
  pw_absorbing_param *a = test_column(&s);
  test_gravity(&s, 0.5)->acceleration_m_s2 = 10.0;
  pw_damping_local_param *d = pw_scene_add_effect(&s, "damping_local");
  d->coefficient = 0.2;
  a->start_s = 2.0;
  a->mean_over_s = 0.32; /* two periods 4 H / c_p */
  a->source_distance_m = 10.0;
  pw_sim *sim = test_sim(&s, 1);
  test_run_to(sim, 1.99);
  double before = sim->points.stress[sim->points.ld + sim->points.slot[0]];
  assert_near(result(sim, "absorbing_0_moved_max_m"), 0.0, 0.0);
  test_run_to(sim, 4.0);
  double moved = result(sim, "absorbing_0_moved_max_m");
  print_message("held for 2 s, free for 2 s: moved %.2e m\n", moved);
  assert_relative(sim->points.stress[sim->points.ld + sim->points.slot[0]], before, 2e-3);
  assert_true(moved < 1e-5); /* the weight compresses the column by 8e-3 m */
  pw_sim_destroy(&sim);
}

/* What summary.json measures the open books by. */
static double turnover(const pw_energy *e)
{
  return 0.5 * (fabs(e->initial) + fabs(e->external) + fabs(e->kinetic) + fabs(e->strain_work) +
                fabs(e->spring) + fabs(e->absorbed));
}

static void pulse_moves_it_by_its_impulse(void **state)
{
  (void)state;
  static pw_scene s;
  for (int spring = 0; spring < 2; spring++) {
    test_column_at_rest(&s)->source_distance_m = spring ? 2.0 : 0.0;
    pw_hammer_param *h = pw_scene_add_effect(&s, "hammer");
    h->body = 0;
    h->pressure_pa = 1e4;
    h->duration_s = 0.02;
    h->pulse = PW_PULSE_HALF_SINE;
    pw_sim *sim = test_sim(&s, 1);
    test_run_to(sim, spring ? 2.0 : 0.5);
    double moved = result(sim, "absorbing_0_moved_max_m");
    double impulse = 1e4 * 0.02 * 2.0 / acos(-1.0), expected = impulse / (test_rho * test_cp);
    double books = fabs(test_open_books(sim)) / turnover(&sim->energy);
    print_message("pulse%s: moved %.3e m, impulse over impedance %.3e m, books open by %.1e\n",
                  spring ? ", springs" : "", moved, expected, books);
    if (spring) { /* the column swings on them and comes to rest */
      assert_true(moved < 1e-2 * expected);
    } else {
      assert_relative(moved, expected, 1e-3);
    }
    assert_true(books < 0.01);
    pw_sim_destroy(&sim);
  }
}

static void lasting_load_rests_on_the_springs(void **state)
{
  (void)state;
  static pw_scene s;
  test_column_at_rest(&s)->source_distance_m = 2.0;
  pw_surcharge_param *p = pw_scene_add_effect(&s, "surcharge");
  p->body = 0;
  p->side = PW_SIDE_TOP;
  p->pressure_pa = 2e3;
  p->ramp_s = 0.5;
  pw_sim *sim = test_sim(&s, 1);
  test_run_to(sim, 3.0);
  double stiffness = 2.0 * test_modulus() / 3.0 / 2.0; /* 2 G / L */
  double moved = result(sim, "absorbing_0_moved_max_m");
  assert_relative(moved, 2e3 / stiffness, 1e-3);
  assert_relative(sim->energy.spring, 0.5 * 0.2 * stiffness * moved * moved, 1e-6);
  assert_true(fabs(test_open_books(sim)) < 0.01 * turnover(&sim->energy));
  pw_sim_destroy(&sim);
}

static void disturbed_box(pw_scene *s)
{
  test_column_at_rest(s)->source_distance_m = 3.0;
  test_grid(s, (pw_real[]){0.0, 3.0, 0.0, 4.0}, 0.25);
  s->body[0].x_m[1] = 3.0;
  s->body[0].y_m[1] = 3.0;
  s->body[0].point_size_m = 0.125;
  s->geometry = PW_AXI;
  ((pw_initial_stress_param *)(void *)pw_scene_find_effect(s, "initial_stress"))->top_y_m = 3.0;
  s->method.block_elements = 16;
  s->effect[1] = s->effect[2]; /* the bottom instead of the right roller */
  s->effect[2] = s->effect[s->neffect - 1];
  s->neffect--;
  pw_hammer_param *h = pw_scene_add_effect(s, "hammer");
  h->body = 0;
  h->pressure_pa = 1e5;
  h->duration_s = 0.005;
  pw_absorbing_param *a = test_absorbing(s, PW_SIDE_RIGHT);
  a->start_s = 0.01;
  a->mean_over_s = 0.003;
}

static void same_bits_on_any_threads(void **state)
{
  (void)state;
  static pw_scene s;
  disturbed_box(&s);
  pw_sim *one = test_sim(&s, 1);
  steps(one, 150);
  assert_true(result(one, "absorbing_0_absorbed_j") > 0.0);
  assert_true(result(one, "absorbing_1_absorbed_j") > 0.0);
  for (int threads = 2; threads <= 4; threads++) {
    pw_sim *many = test_sim(&s, threads);
    steps(many, 150);
    assert_memory_equal(&one->energy, &many->energy, sizeof one->energy);
    assert_memory_equal(one->points.x, many->points.x,
                        2 * (size_t)one->points.ld * sizeof(pw_real));
    assert_memory_equal(one->points.stress, many->points.stress,
                        6 * (size_t)one->points.ld * sizeof(pw_real));
    pw_sim_destroy(&many);
  }
  pw_sim_destroy(&one);
}

static void expect_same(const char *a, const char *b)
{
  test_bytes one = test_read(a), two = test_read(b);
  assert_int_equal(one.size, two.size);
  assert_memory_equal(one.data, two.data, one.size);
  free(one.data);
  free(two.data);
}

/* Stopped while the right side sums its reactions, and after it has been let go. */
static void restarts_bitwise(void **state)
{
  (void)state;
  static pw_scene s;
  const char *folder = test_folder(), *half = test_path(folder, "half.h5");
  const char *through = test_path(folder, "through.h5"), *resumed = test_path(folder, "resumed.h5");
  disturbed_box(&s);
  for (int at = 0; at < 2; at++) {
    pw_sim *sim = test_sim(&s, 1);
    test_run_to(sim, at == 0 ? 0.0085 : 0.02);
    assert_ok(pw_restart_write(half, sim));
    steps(sim, 41);
    assert_ok(pw_restart_write(through, sim));
    pw_sim_destroy(&sim);
    sim = test_sim(&s, 1);
    steps(sim, 7); /* nothing of what was there before may stay */
    assert_ok(pw_restart_read(half, sim));
    steps(sim, 41);
    assert_ok(pw_restart_write(resumed, sim));
    expect_same(through, resumed);
    pw_sim_destroy(&sim);
  }
  test_remove_folder(folder);
}

static void refuse(const pw_scene *s, const char *rule)
{
  assert_int_equal(pw_scene_check(s), PW_ERR_SCENE);
  if (!strstr(pw_error_text(), rule)) {
    fail_msg("'%s' instead of '%s'", pw_error_text(), rule);
  }
}

static void contradictions_are_refused(void **state)
{
  (void)state;
  static pw_scene s;
  pw_absorbing_param *a = test_column_at_rest(&s);
  assert_ok(pw_scene_check(&s));
  ((pw_gravity_param *)(void *)pw_scene_find_effect(&s, "gravity"))->ramp_s = 0.5;
  refuse(&s, "absorbing.0: start_s");
  a->start_s = 1.0;
  assert_ok(pw_scene_check(&s));
  a->mean_over_s = 2.0;
  refuse(&s, "absorbing.0: mean_over_s");
  a->mean_over_s = 0.0;
  a->side = PW_SIDE_LEFT;
  refuse(&s, "absorbing.0: side: a boundary section holds this side too");
  s.geometry = PW_AXI;
  refuse(&s, "absorbing.0: side: left is the axis");
  s.geometry = PW_PLANE;
  a->side = PW_SIDE_BOTTOM;
  test_absorbing(&s, PW_SIDE_BOTTOM)->start_s = 1.0;
  refuse(&s, "absorbing.0: side: two absorbing sections");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(soil_at_rest_stays),
      cmocka_unit_test(box_at_rest_stays),
      cmocka_unit_test(corners_are_carried_once),
      cmocka_unit_test(held_until_its_start),
      cmocka_unit_test(pulse_moves_it_by_its_impulse),
      cmocka_unit_test(lasting_load_rests_on_the_springs),
      cmocka_unit_test(same_bits_on_any_threads),
      cmocka_unit_test(restarts_bitwise),
      cmocka_unit_test(contradictions_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
