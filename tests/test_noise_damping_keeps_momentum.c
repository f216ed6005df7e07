/* SPDX-License-Identifier: GPL-3.0-or-later */
/* method.noise_damping_per_s moves points' velocities towards the grid's: noise that the grid does
 * not see dies out at that rate, momentum stays, and the energy taken out is in the books. */
#include "tests/engine_helpers.h"

static pw_sim *noisy_block(int basis, double rate)
{
  static pw_scene s;
  pw_scene_default(&s);
  test_grid(&s, (double[]){0.0, 4.0, 0.0, 4.0}, 0.25);
  int m = test_elastic(&s, 1e6, 0.3, 1000.0);
  test_rectangle(&s, m, (double[]){1.0, 3.0, 1.0, 3.0}, 0.125);
  s.method.basis = basis;
  s.method.noise_damping_per_s = rate;
  s.method.mass_cut_off = 0.0; /* nodes that take no part would keep their momentum */
  s.time.cfl = 0.3;
  pw_sim *sim = test_sim(&s, 1);
  uint64_t seed = 8;
  for (pw_idx i = 0; i < sim->points.n; i++) {
    sim->points.v[i] = 0.3 + 0.01 * (test_random(&seed) - 0.5);
    sim->points.v[sim->points.ld + i] = 0.01 * (test_random(&seed) - 0.5);
  }
  return sim;
}

static double momentum_x(const pw_sim *sim)
{
  double sum = 0.0;
  for (pw_idx i = 0; i < sim->points.n; i++) {
    sum += sim->points.mass[i] * sim->points.v[i];
  }
  return sum;
}

static void momentum_stays_and_energy_is_in_the_books(void **state)
{
  (void)state;
  for (int basis = PW_UGIMP; basis <= PW_CPDI; basis++) {
    pw_sim *sim = noisy_block(basis, 100.0), *free = noisy_block(basis, 0.0);
    double start = momentum_x(sim);
    test_run_to(sim, 0.05);
    test_run_to(free, 0.05);
    const pw_energy *e = &sim->energy;
    double noise = e->initial - 0.5 * 4000.0 * 0.3 * 0.3;
    print_message("basis %d: taken out %.5f J of %.5f J of noise\n", basis, e->damping, noise);
    assert_relative(momentum_x(sim), start, 1e-12);
    assert_true(e->damping > 0.0);
    assert_true(e->kinetic < free->energy.kinetic);
    /* Balance of the whole, against the noise; the mapping itself loses a little. */
    assert_near(e->kinetic + e->strain_work + e->damping - e->initial, 0.0, 0.05 * noise);
    pw_sim_destroy(&sim);
    pw_sim_destroy(&free);
  }
}

/* Off means off: not a bit changes and nothing is booked. */
static void off_takes_nothing(void **state)
{
  (void)state;
  pw_sim *sim = noisy_block(PW_CPDI, 0.0);
  test_run_to(sim, 0.02);
  assert_true(sim->energy.damping == 0.0);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(momentum_stays_and_energy_is_in_the_books),
      cmocka_unit_test(off_takes_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
