/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bodies that overlap from the start (E21, E36): no energy comes from an overlap that no motion
 * has made, the slave leaves by the side it is nearest to, not faster than it came. */
#include "engine/effects/contact_penalty.h"
#include "tests/contact_helpers.h"

/* A block sunk two segments deep into a rigid plate, closing with `speed`. */
static pw_sim *sunk(pw_real depth, pw_real speed)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  test_grid(&s, (pw_real[]){-1.0, 2.0, -1.0, 1.5}, 0.25);
  int material = test_elastic(&s, 2e7, 0.2, 1000.0);
  test_rectangle(&s, material, (pw_real[]){-1.0, 2.0, -1.0, 0.0}, 0.125);
  test_rectangle(&s, material, (pw_real[]){0.0, 1.0, -depth, 1.0 - depth}, 0.125);
  s.body[1].velocity_m_s[1] = -speed;
  test_add_contact(&s, TEST_PENALTY, 0, 1, 0.3, 1e8, 0.1);
  test_hold(&s, 0);
  return test_sim(&s, 1);
}

static void leaves_no_faster_than_it_came(void **state)
{
  (void)state;
  const pw_real speed = 0.5;
  pw_sim *sim = sunk(0.2, speed);
  pw_real sum[5] = {0.0}, fastest = 0.0, sideways = 0.0;
  while (sim->time < 0.3) {
    assert_ok(pw_sim_step(sim, 0.0));
    test_body_sums(sim, 1, sum);
    fastest = pw_max(fastest, sum[2] / sum[0]);
    sideways = pw_max(sideways, fabs(sum[1] / sum[0]));
  }
  print_message("came with %.2f m/s, left with %.3f m/s, sideways %.1e m/s, bottom at %.3f m\n",
                speed, fastest, sideways, sum[4] - 0.5);
  assert_true(fastest > 0.5 * speed && fastest <= 1.01 * speed);
  assert_true(sideways < 0.01 * speed);
  pw_sim_destroy(&sim);
}

static void overlap_at_rest_stays_at_rest(void **state)
{
  (void)state;
  pw_sim *sim = sunk(0.2, 0.0);
  pw_real sum[5];
  test_run_to(sim, 0.1);
  test_body_sums(sim, 1, sum);
  assert_near(hypot(sum[1], sum[2]), 0.0, 0.0);
  const pw_contact_tally *t = pw_contact_tally_of(sim);
  assert_near(t->overlap_max, 0.2, 1e-12); /* but it is reported */
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(leaves_no_faster_than_it_came),
      cmocka_unit_test(overlap_at_rest_stays_at_rest),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
