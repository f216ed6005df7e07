/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact_penalty.step_frequency_max: a punch falls on a block and rebounds, with the default of
 * 0.2 and with 0.5. The springs set the steps, so that there are fewer of them. What of the energy
 * is not accounted for (the impact on so coarse a grid makes it, whatever the steps) grows by less
 * than 1 % of what the punch brings. */
#include "tests/contact_helpers.h"

/* Steps until the punch has rebounded; energy not accounted for over that of the punch. */
static pw_off rebound(pw_real step_frequency_max, pw_real *error)
{
  static pw_scene s; /* large */
  test_drop(&s, TEST_PENALTY, PW_PLANE, 0.02);
  pw_contact_penalty_param *p = (void *)pw_scene_find_effect(&s, "contact_penalty");
  p->step_frequency_max = step_frequency_max;
  pw_sim *sim = test_sim(&s, 1);
  pw_real sums[5], lowest = 0.0;
  test_body_sums(sim, 1, sums);
  const pw_real brought = 0.5 * sums[2] * sums[2] / sums[0];
  while (sim->time < 1.0 && sums[2] < 0.5 * sums[0]) { /* upwards at 0.5 m/s */
    assert_ok(pw_sim_step(sim, 0.0));
    test_body_sums(sim, 1, sums);
    lowest = pw_min(lowest, sums[2]);
  }
  assert_true(sim->time < 1.0 && lowest < -4.0 * sums[0]);
  const pw_energy *e = &sim->energy;
  *error = fabs(e->kinetic + e->strain_work + e->contact + e->spring - e->external - e->initial);
  *error /= brought;
  const pw_off steps = sim->step;
  print_message("%g: %lld steps to the rebound, energy off by %.2e\n", step_frequency_max,
                (long long)steps, *error);
  pw_sim_destroy(&sim);
  return steps;
}

static void longer_steps_keep_the_energy(void **state)
{
  (void)state;
  pw_real error[2];
  const pw_off fine = rebound(0.2, &error[0]), coarse = rebound(0.5, &error[1]);
  assert_true(3 * coarse < 2 * fine);
  assert_true(error[1] < error[0] + 0.01);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(longer_steps_keep_the_energy),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
