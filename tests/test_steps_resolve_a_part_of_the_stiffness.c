/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hypoplastic_sand's step_stiffness_ratio: steps that resolve the stiffness of turned loading, m_T = 2
 * and more, in place of that of reversals, m_R = 10, which lasts for strains of R = 5e-5 only.
 *  - the first stable step is sqrt(m_R / ratio) times as long, exactly;
 *  - sand that falls, stops and swings settles by the same way, and no energy is lost or won;
 *  - a ratio outside of m_T to m_R is refused. */
#include "engine/sim.h"
#include "kernels/hypoplastic.h"
#include "tests/engine_scenes.h"

/* Sand at rest under 10 m/s2 between rollers, 2 m high; then gravity is four times as much. */
static void shaken(pw_scene *s, pw_real ratio)
{
  pw_scene_default(s);
  s->geometry = PW_PLANE;
  s->time.cfl = 0.9;
  test_grid(s, (pw_real[]){0.0, 1.0, 0.0, 2.5}, 0.125);
  const int sand = test_sand(s, true);
  s->material[sand].param[PW_HYPO_STEP_RATIO] = ratio;
  test_rectangle(s, sand, (pw_real[]){0.0, 1.0, 0.0, 2.0}, 0.0625);
  test_gravity(s, 0.0)->acceleration_m_s2 = 40.0;
  pw_initial_stress_param *i = pw_scene_add_effect(s, "initial_stress");
  i->body = 0;
  i->top_y_m = 2.0;
  i->k0 = 0.45;
  i->acceleration_m_s2 = 10.0;
  test_roller(s, PW_SIDE_LEFT);
  test_roller(s, PW_SIDE_RIGHT);
  test_roller(s, PW_SIDE_BOTTOM);
}

static pw_real mean_height(const pw_sim *sim)
{
  pw_real sum = 0.0;
  for (pw_idx i = 0; i < sim->points.n; i++) {
    sum += sim->points.x[sim->points.ld + i];
  }
  return sum / sim->points.n;
}

typedef struct {
  pw_real first_step, way, error;
  pw_off steps;
} outcome;

static outcome run(pw_real ratio, pw_real time)
{
  static pw_scene s;
  pw_sim *sim = NULL;
  pw_report report;
  shaken(&s, ratio);
  assert_ok(pw_sim_create(&s, 1, &sim));
  outcome out = {.first_step = sim->dt_next, .way = mean_height(sim)};
  while (sim->time < time) {
    assert_ok(pw_sim_step(sim, time - sim->time));
  }
  pw_sim_report(sim, &report);
  out.way -= mean_height(sim);
  out.steps = sim->step;
  out.error = (report.energy.kinetic + report.energy.strain_work - report.energy.external) /
              report.energy.external;
  pw_sim_destroy(&sim);
  return out;
}

static void settles_by_the_same_way(void **state)
{
  (void)state;
  const outcome all = run(0.0, 0.4), reversal = run(10.0, 0.0), part = run(2.5, 0.4);
  print_message("way %.5g and %.5g m, energy %.2g and %.2g of the work, %lld and %lld steps\n",
                all.way, part.way, all.error, part.error, (long long)all.steps,
                (long long)part.steps);
  assert_relative(reversal.first_step, all.first_step, 1e-15);
  assert_relative(part.first_step, 2.0 * all.first_step, 1e-12);
  assert_true(part.steps < 0.6 * (double)all.steps);
  assert_relative(part.way, all.way, 0.01);
  assert_true(fabs(all.error) < 0.01 && fabs(part.error) < 0.01);
}

static void ratio_is_checked(void **state)
{
  (void)state;
  static pw_scene s;
  pw_sim *sim = NULL;
  const pw_real wrong[2] = {1.9, 10.1};
  for (int k = 0; k < 2; k++) {
    shaken(&s, wrong[k]);
    assert_int_equal(s.material[0].model->check(s.material[0].param), PW_ERR_SCENE);
    assert_non_null(strstr(pw_error_text(), "step_stiffness_ratio"));
  }
  shaken(&s, 2.0);
  assert_ok(pw_sim_create(&s, 1, &sim));
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(settles_by_the_same_way),
                                     cmocka_unit_test(ratio_is_checked)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
