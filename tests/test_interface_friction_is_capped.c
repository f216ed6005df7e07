/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Coulomb return map of the tangential spring (C13): no shear without friction, no slip with
 * endless friction, cap and dissipation between. Reference: closed form. */
#include "kernels/interface_law.h"
#include "tests/harness.h"

static const pw_real OMEGA = 2e6; /* Pa/m */

static void no_friction_gives_no_shear(void **state)
{
  (void)state;
  const pw_real trial[3] = {1e-3, -2e-7, 0.0};
  for (int i = 0; i < 3; i++) {
    pw_real slip = trial[i];
    assert_near(pw_coulomb_return(OMEGA, 0.0, &slip), 0.0, 0.0);
    assert_near(fabs(OMEGA * slip), 0.0, 0.0);
  }
}

static void endless_friction_never_slips(void **state)
{
  (void)state;
  pw_real slip = 0.0, cap = 1e6 * pw_normal_pressure(OMEGA, -1e-3), lost = 0.0;
  for (int i = 0; i < 1000; i++) {
    slip += 1e-5;
    lost += pw_coulomb_return(OMEGA, cap, &slip);
  }
  assert_near(slip, 1e-2, 1e-15);
  assert_near(lost, 0.0, 0.0);
}

static void shear_stays_at_the_cap_both_ways(void **state)
{
  (void)state;
  const pw_real cap = 400.0, elastic = cap / OMEGA, path = 1e-3;
  pw_real slip = 0.0, lost = 0.0;
  for (int i = 0; i < 100; i++) {
    slip += 0.01 * path;
    lost += pw_coulomb_return(OMEGA, cap, &slip);
  }
  assert_near(slip, elastic, 1e-18);
  assert_near(lost, cap * (path - elastic), 1e-12);
  slip -= 1.5 * elastic; /* unloads without loss past zero */
  assert_near(pw_coulomb_return(OMEGA, cap, &slip), 0.0, 0.0);
  assert_near(OMEGA * slip, -0.5 * cap, 1e-9);
  slip -= elastic;
  assert_near(pw_coulomb_return(OMEGA, cap, &slip), 0.5 * cap * elastic, 1e-12);
  assert_near(slip, -elastic, 1e-18);
}

/* A block on a belt through spring and slider: energy put in = stored + lost, to round-off, for a
 * stress at the end of each increment that is lost at the cap. */
static void energy_is_stored_or_lost(void **state)
{
  (void)state;
  const pw_real cap = 400.0, elastic = cap / OMEGA, step = elastic / 512.0;
  pw_real slip = 0.0, lost = 0.0, work = 0.0;
  for (int i = 0; i < 4096; i++) {
    pw_real direction = i % 2048 < 1024 ? step : -step, before = OMEGA * slip;
    slip += direction;
    lost += pw_coulomb_return(OMEGA, cap, &slip);
    work += 0.5 * (before + OMEGA * slip) * direction;
  }
  assert_near(work, lost + 0.5 * OMEGA * slip * slip, 1e-10 * work);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_friction_gives_no_shear),
      cmocka_unit_test(endless_friction_never_slips),
      cmocka_unit_test(shear_stays_at_the_cap_both_ways),
      cmocka_unit_test(energy_is_stored_or_lost),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
