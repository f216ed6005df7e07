/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A wave crosses the contact of two bodies whose moduli differ by 1e2 to 1e6 (E20): a pressure pulse
 * in soil meets the tip of an elastic rod as wide as the soil, nu = 0. Exact (d'Alembert), with
 * Z = rho c: stress reflected (Z2 - Z1) / (Z2 + Z1) times the arriving one, velocity transmitted
 * 2 Z1 / (Z1 + Z2). No oscillation of the grid's scale above 10 %.
 * The rod is implicit: its wave speed does not limit the step. */
#include "tests/contact_helpers.h"

static const pw_real DENSITY = 2000.0, YOUNGS = 1e7, CELL = 0.1, DEPTH = 10.0;
static const pw_real SPEED = 0.01, WIDTH = 0.8; /* of the pulse: v exp(-(s / width)^2), m/s, m */

/* Soil below y = 0, the rod above. */
static pw_sim *bar(pw_real ratio, pw_real length)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  s.time.cfl = 0.5;
  test_grid(&s, (pw_real[]){-0.3, 0.3, -DEPTH, 2.0}, CELL);
  int soil = test_elastic(&s, YOUNGS, 0.0, DENSITY);
  int rod = test_elastic(&s, ratio * YOUNGS, 0.0, DENSITY);
  test_rectangle(&s, soil, (pw_real[]){-0.2, 0.2, -DEPTH, 0.0}, 0.5 * CELL);
  s.body[s.nbody++] = (pw_scene_body){.name = "rod",
                                      .material = rod,
                                      .kind = PW_BODY_ROD,
                                      .shape = PW_SHAPE_PILE,
                                      .radius_m = 0.2,
                                      .tip = PW_TIP_FLAT,
                                      .length_m = length,
                                      .surface_segment_m = CELL,
                                      .rod_elements = 400};
  test_add_contact(&s, TEST_CORNER, 1, 0, 0.0, 0.0, 0.0);
  pw_contact_corner_param *c = (void *)pw_scene_find_effect(&s, "contact_corner");
  c->rounding_m = 1e-6;
  c->stiffness_factor = 2.0;
  pw_sim *sim = test_sim(&s, 1);
  pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n; i++) {
    pw_real at = (p->x[p->ld + i] + 5.0) / WIDTH;
    p->v[p->ld + i] = SPEED * exp(-at * at);
    p->stress[p->ld + i] = -DENSITY * sqrt(YOUNGS / DENSITY) * p->v[p->ld + i];
  }
  return sim;
}

/* Largest second difference of the velocity along the points of the soil, and how fast it runs back
 * below -2 m; over the arriving speed. */
static void look_at_soil(const pw_sim *sim, pw_real *rough, pw_real *back)
{
  enum { ROWS = 200 };
  const pw_points *p = &sim->points;
  pw_real v[ROWS] = {0.0};
  for (pw_idx i = 0; i < p->n; i++) {
    int row = (int)((p->x[p->ld + i] + DEPTH) / (0.5 * CELL));
    if (p->x[i] > 0.0 && p->x[i] < 0.5 * CELL && row >= 0 && row < ROWS) {
      v[row] = p->v[p->ld + i] / SPEED;
    }
  }
  for (int k = 1; k < ROWS - 1; k++) {
    *rough = pw_max(*rough, fabs(v[k - 1] - 2.0 * v[k] + v[k + 1]));
    *back = k < 160 ? pw_max(*back, -v[k]) : *back;
  }
}

static void amplitudes_are_exact(void **state)
{
  (void)state;
  const pw_real c = sqrt(YOUNGS / DENSITY);
  for (int k = 2; k <= 6; k += 2) {
    const pw_real ratio = pow(10.0, k), z = sqrt(ratio), length = 2.2 * z;
    pw_sim *sim = bar(ratio, length);
    const pw_rod *rod = &sim->structure_of[1]->rod;
    pw_real through = 0.0, back = 0.0, rough = 0.0, unused = 0.0;
    while (sim->time < 9.0 / c) { /* the pulse is back at -4 m; before that its echo in the rod */
      assert_ok(pw_sim_step(sim, 0.0));
      for (pw_idx j = 0; sim->time < 7.0 / c && j < rod->n / 2; j++) {
        through = pw_max(through, rod->v[j]);
      }
      look_at_soil(sim, &rough, &unused);
    }
    look_at_soil(sim, &rough, &back);
    pw_real exact = (z - 1.0) / (z + 1.0), passed = 2.0 / (1.0 + z);
    print_message(
        "E ratio %.0e: reflected %.4f (exact %.4f), through %.5f (%.5f); second difference "
        "of the velocity %.3f; %lld steps\n",
        ratio, back, exact, through / SPEED, passed, rough, (long long)sim->step);
    assert_relative(back, exact, 0.03);
    assert_relative(through / SPEED, passed, 0.03);
    assert_true(rough < 0.1); /* of points 0.05 m apart; the pulse's own is 0.008 */
    pw_sim_destroy(&sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(amplitudes_are_exact),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
