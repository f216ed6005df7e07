/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stiffness of the contact from 1/100 to 10 000 times that of the slave's cells, k h / E (E19): the
 * overlap that makes force is pressure / stiffness, and the step that the contact asks for closes
 * the books of energy to 1 %. Explicit steps: there is no Newton iteration to count. */
#include "engine/effects/contact_corner.h"
#include "tests/contact_helpers.h"

static const pw_real G = 10.0, DENSITY = 1000.0, HEIGHT = 0.5, YOUNGS = 2e6, CELL = 0.25,
                     PI = 3.14159265358979323846;
enum { RATIOS = 4 };
static const pw_real ratio[RATIOS] = {1e-2, 1.0, 1e2, 1e4};

static pw_scene *block(pw_real stiffness, pw_real bottom)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  test_grid(&s, (pw_real[]){-0.5, 1.5, -1.5, 1.5}, CELL);
  int material = test_elastic(&s, YOUNGS, 0.0, DENSITY);
  test_rectangle(&s, material, (pw_real[]){-0.5, 1.5, -0.25, 0.0}, 0.5 * CELL);
  s.body[0].kind = PW_BODY_RIGID;
  test_rectangle(&s, material, (pw_real[]){0.0, 1.0, bottom, bottom + HEIGHT}, 0.5 * CELL);
  test_add_contact(&s, TEST_CORNER, 0, 1, 0.0, 0.0, 0.0);
  pw_contact_corner_param *c = (void *)pw_scene_find_effect(&s, "contact_corner");
  c->normal_stiffness_pa_m = stiffness;
  test_hold(&s, 0);
  return &s;
}

/* Of the block on the springs, which hold the stiffness of a third of its height as well; s */
static pw_real period(pw_real stiffness)
{
  return 2.0 * PI * sqrt(DENSITY * HEIGHT * (1.0 / stiffness + HEIGHT / (3.0 * YOUNGS)));
}

/* The weight grows over whole periods and slowly for the block's own vibration; mean of a period. */
static void overlap_is_inverse(void **state)
{
  (void)state;
  for (int k = 0; k < RATIOS; k++) {
    const pw_real stiffness = ratio[k] * YOUNGS / CELL, exact = DENSITY * G * HEIGHT / stiffness;
    const pw_real ramp = 8.0 * period(stiffness);
    pw_scene *s = block(stiffness, 0.0);
    pw_gravity_param *gravity = pw_scene_add_effect(s, "gravity");
    gravity->acceleration_m_s2 = G;
    gravity->ramp_s = ramp;
    pw_sim *sim = test_sim(s, 1);
    const pw_corner *c = pw_sim_effect_ctx(sim, "contact_corner");
    pw_real mean = 0.0;
    test_run_to(sim, ramp);
    for (int i = 1; i <= 100; i++) {
      test_run_to(sim, ramp + 0.01 * i * period(stiffness));
      for (pw_idx q = 0; q < c->npair; q++) {
        mean += 0.01 * c->pair[q].area * c->pair[q].overlap;
      }
    }
    print_message("k h / E = %.0e: overlap %.4e m, exact %.4e m; without force %.1e m\n", ratio[k],
                  mean, exact, c->offset_max);
    assert_relative(mean, exact, 0.01);
    pw_sim_destroy(&sim);
  }
}

/* Gap in the books of energy over the most that the weight has done, when a block whose weight comes
 * at once has sunk and risen again (in between force and overlap are a step apart). */
static pw_real books(pw_real stiffness)
{
  pw_scene *s = block(stiffness, 0.0);
  pw_gravity_param *gravity = pw_scene_add_effect(s, "gravity");
  gravity->acceleration_m_s2 = G;
  pw_sim *sim = test_sim(s, 1);
  const pw_energy *e = &sim->energy;
  pw_real most = 0.0, sum[5];
  do {
    assert_ok(pw_sim_step(sim, 0.0));
    most = pw_max(most, e->external);
    test_body_sums(sim, 1, sum);
  } while (sim->time < 0.6 * period(stiffness) || sum[2] > 0.0);
  pw_real open = e->kinetic + e->strain_work + e->spring + e->contact - e->external;
  pw_sim_destroy(&sim);
  return fabs(open) / most;
}

static void energy_is_kept(void **state)
{
  (void)state;
  for (int k = 0; k < RATIOS; k++) {
    pw_real error = books(ratio[k] * YOUNGS / CELL);
    print_message("k h / E = %.0e: books of energy open by %.3f %%\n", ratio[k], 100.0 * error);
    assert_true(error < 0.01);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(overlap_is_inverse),
      cmocka_unit_test(energy_is_kept),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
