/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The named Karlsruhe sand, without intergranular strain, in a biaxial test against the end of the
 * regression test hypo1 as the developer's manual of github.com/jtorreci/tochnog prints it for
 * Tochnog Professional: sigma_yy = -862.9291 kPa, e = 0.5980633. The start is not printed: 200 kPa
 * and e = 0.60, sheared to 4 %, is what leads to both (cases/soils/README.md). The two programs
 * update the void ratio by different measures of strain. */
#include "tests/material_helpers.h"

static void sheared_to_4_per_cent(double beta, double *stress, double *void_ratio)
{
  const struct {
    const char *key;
    double value;
  } given[] = {{"grain_density_kg_m3", 2650},
               {"void_ratio", 0.6},
               {"critical_friction_angle_deg", 30},
               {"granular_hardness_pa", 5.8e9},
               {"exponent_n", 0.28},
               {"void_ratio_d0", 0.53},
               {"void_ratio_c0", 0.84},
               {"void_ratio_i0", 1.0},
               {"exponent_alpha", 0.13},
               {"exponent_beta", beta},
               {"intergranular_strain", 0},
               {"substep_tolerance", 1e-6}};
  test_material m = test_material_of("hypoplastic_sand");
  for (size_t k = 0; k < sizeof given / sizeof *given; k++) {
    test_set(&m, given[k].key, given[k].value);
  }
  pw_element el = test_start(&m, 2e5);
  const pw_element_step step = {.control = {PW_CONTROL_STRESS}, .value = {-2e5, -1e-4}};
  for (int i = 0; i < 400; i++) {
    assert_ok(pw_element_drive(&el, &step));
  }
  *stress = el.stress[1];
  *void_ratio = el.state[0];
}

static void biaxial_test_of_karlsruhe_sand(void **unused)
{
  (void)unused;
  double stress, void_ratio, other, other_void_ratio;
  sheared_to_4_per_cent(1.05, &stress, &void_ratio);
  sheared_to_4_per_cent(1.0, &other, &other_void_ratio);
  print_message("%.2f kPa, e %.6f; beta = 1: %.2f kPa, %.6f\n", stress / 1e3, void_ratio,
                other / 1e3, other_void_ratio);
  assert_relative(stress, -862.9291e3, 2e-4);
  assert_relative(void_ratio, 0.5980633, 1e-4);
  assert_true(fabs(other + 862.9291e3) > 5.0 * fabs(stress + 862.9291e3));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(biaxial_test_of_karlsruhe_sand)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
