/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact patch test (C11): a block pressed on another, or on a rigid plate, by a uniform pressure on
 * its top, nu = 0; the domains of the two blocks match or do not. Exact: sigma_yy = -pressure
 * everywhere. On the plate nothing differs along the contact, to rounding (1e-10). Between blocks,
 * away from their edges, a contact of one side's nodes on the other's segments may be 5 % off: the
 * corner contact is not; the other two are reported, and held to what they reach. */
#include "tests/contact_helpers.h"

static const pw_real PRESSURE = 1e4, YOUNGS = 1e7;

/* Block with domains of `size` on one with domains of 0.125 m, or on a wide plate; comes to rest. */
static pw_sim *blocks(test_contact kind, pw_real size, bool plate)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  s.method.noise_damping_per_s = 50.0;
  test_grid(&s, (pw_real[]){-0.25, 2.25, 0.0, 2.25}, 0.25);
  int material = test_elastic(&s, YOUNGS, 0.0, 1000.0);
  const pw_real beyond = plate ? 0.25 : 0.0;
  test_rectangle(&s, material, (pw_real[]){-beyond, 2.0 + beyond, 0.0, 1.0}, 0.125);
  s.body[0].kind = plate ? PW_BODY_RIGID : PW_BODY_POINTS;
  test_rectangle(&s, material, (pw_real[]){0.0, 2.0, 1.0, 2.0}, size);
  test_add_contact(&s, kind, 0, 1, 0.0, 2e8, 0.125);
  if (kind == TEST_CORNER) {
    pw_contact_corner_param *c = (void *)pw_scene_find_effect(&s, "contact_corner");
    c->rounding_m = 1e-6;
  }
  pw_surcharge_param *p = pw_scene_add_effect(&s, "surcharge");
  p->body = 1;
  p->side = PW_SIDE_TOP;
  p->pressure_pa = PRESSURE;
  p->ramp_s = 0.2;
  pw_damping_local_param *d = pw_scene_add_effect(&s, "damping_local");
  d->coefficient = 0.5;
  d->body = -1;
  if (plate) {
    test_hold(&s, 0);
  }
  pw_boundary_param *b = pw_scene_add_effect(&s, "boundary");
  b->side = PW_SIDE_BOTTOM;
  b->fix_y = true;
  b->body = -1;
  pw_sim *sim = test_sim(&s, 1);
  test_run_to(sim, 1.5);
  return sim;
}

/* Points in the layers on either side of the contact, in the middle half of the width. */
static bool looked_at(const pw_sim *sim, pw_idx i)
{
  const pw_points *p = &sim->points;
  return fabs(p->x[i] - 1.0) < 0.5 && fabs(p->x[p->ld + i] - 1.0) < 0.25;
}

/* Largest deviation of sigma_yy there from the exact one; its mean over the exact one. */
static pw_real deviation(const pw_sim *sim, pw_real *mean)
{
  const pw_points *p = &sim->points;
  pw_real worst = 0.0, sum = 0.0, count = 0.0;
  for (pw_idx id = 0; id < p->n; id++) {
    pw_idx i = p->slot[id];
    if (looked_at(sim, i)) {
      pw_real ratio = p->stress[p->ld + i] / -PRESSURE;
      worst = pw_max(worst, fabs(ratio - 1.0));
      sum += ratio;
      count += 1.0;
    }
  }
  *mean = sum / count;
  return worst;
}

static void pressure_is_uniform(void **state)
{
  (void)state;
  const pw_real size[3] = {0.125, 2.0 / 13.0, 2.0 / 19.0};
  const pw_real most[TEST_CONTACTS] = {
      [TEST_PENALTY] = 0.1, [TEST_FRICTIONAL] = 0.15, [TEST_CORNER] = 0.05, [TEST_GAP] = 0.15};
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    for (int k = 0; k < 3; k++) {
      pw_sim *sim = blocks(kind, size[k], false);
      pw_real mean, worst = deviation(sim, &mean);
      print_message("%s, domains %.4f m on 0.125 m: mean %.5f of the pressure, deviation %.2e\n",
                    test_contact_name[kind], size[k], mean, worst);
      assert_true(worst < most[kind]);
      pw_sim_destroy(&sim);
    }
  }
}

/* Largest difference between points of equal height, over the pressure. */
static void plate_presses_evenly(void **state)
{
  (void)state;
  pw_sim *sim = blocks(TEST_CORNER, 0.125, true);
  const pw_points *p = &sim->points;
  pw_real worst = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    for (pw_idx k = 0; k < i; k++) {
      if (fabs(p->x[p->ld + i] - p->x[p->ld + k]) < 0.01) {
        worst = pw_max(worst, fabs(p->stress[p->ld + i] - p->stress[p->ld + k]) / PRESSURE);
      }
    }
  }
  print_message("on a rigid plate: along the contact by %.1e of the pressure\n", worst);
  assert_true(worst < 1e-10);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(plate_presses_evenly),
      cmocka_unit_test(pressure_is_uniform),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
