/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rigid bodies through undrained von Mises clay, F-bar, reshaped domains, corner contact
 * (cases/clay_penetration, shortened):
 * - a smooth cylinder deep in clay, plane strain: force 9.14 c_u times its diameter (Randolph and
 *   Houlsby, Geotechnique 34 (1984) 613-623; exact for Tresca, and for von Mises with the same
 *   strength in plane strain), within 10 % at 2.4 cells to the radius;
 * - rough, adhesion c_u on all that is nearer than half a domain: 11.94, likewise;
 * - domains that are reshaped at the surface do not work: without friction the contact gives and
 *   takes less than 1 % of the work of the driving force once the clay has closed;
 * - the balance of energy closes to 1 % of that work. */
#include "tests/case_helpers.h"

static void smooth_cylinder_meets_the_exact_resistance(void **state)
{
  (void)state;
  static const char *const set[] = {"grid.fine_y_m=[1.5,2.75]", "contact_corner.friction=0"};
  pw_sim *sim = test_case("clay_penetration/tbar.yaml", 2, set);
  const double c_u = 2e4, radius = 0.15;
  test_run_to(sim, 0.15); /* the clay closes around the cylinder, 0.5 radii of way */
  test_history(sim, "contact_force_y_n");
  const pw_energy before = sim->energy;
  test_run_to(sim, 0.45);                                      /* 1.5 radii */
  double force = 2.0 * test_history(sim, "contact_force_y_n"); /* mean since the last call */
  double factor = force / (c_u * 2.0 * radius), work = sim->energy.external - before.external;
  double given = before.contact - sim->energy.contact;
  double held = sim->energy.kinetic + sim->energy.strain_work + sim->energy.spring +
                sim->energy.contact + sim->energy.damping - before.kinetic - before.strain_work -
                before.spring - before.contact - before.damping;
  print_message("factor %.2f (exact 9.14), contact gives %.2f %% of the work, balance %.2f %%\n",
                factor, 100.0 * given / work, 100.0 * (held / work - 1.0));
  assert_relative(factor, 9.14, 0.1);
  assert_true(fabs(given) < 0.01 * work);
  assert_true(fabs(held - work) < 0.01 * work);
  pw_sim_destroy(&sim);
}

static void rough_cylinder_meets_the_exact_resistance(void **state)
{
  (void)state;
  static const char *const set[] = {"grid.fine_y_m=[1.5,2.75]", "contact_corner.adhesion_pa=2e4",
                                    "contact_corner.shear_limit_pa=2e4",
                                    "contact_corner.adhesion_gap_m=0.015625"};
  pw_sim *sim = test_case("clay_penetration/tbar.yaml", 4, set);
  test_run_to(sim, 0.15);
  test_history(sim, "contact_force_y_n");
  test_run_to(sim, 0.45);
  double factor = 2.0 * test_history(sim, "contact_force_y_n") / (2e4 * 2.0 * 0.15);
  print_message("rough: factor %.2f (exact 11.94)\n", factor);
  assert_relative(factor, 11.94, 0.1);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(smooth_cylinder_meets_the_exact_resistance),
      cmocka_unit_test(rough_cylinder_meets_the_exact_resistance),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
