/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The named Hochstetten sand in an oedometer, against figures that the OpenSees documentation of its
 * UMAT material prints for the same constants, computed with another implementation (that of
 * soilmodels.com, tolerance 1e-3): from 100 kPa, e = 0.70, to 0.5 % in steps of 1e-4 294.3 kPa; the
 * last step's stiffness 29080 kPa, that of one step back 316559 kPa. */
#include "tests/material_helpers.h"

static double axial(const pw_element *el)
{
  return -el->stress[1];
}

static void oedometer_of_hochstetten_sand(void **unused)
{
  (void)unused;
  const struct {
    const char *key;
    double value;
  } given[] = {{"grain_density_kg_m3", 2650},
               {"void_ratio", 0.7},
               {"critical_friction_angle_deg", 33},
               {"granular_hardness_pa", 1e9},
               {"exponent_n", 0.25},
               {"void_ratio_d0", 0.55},
               {"void_ratio_c0", 0.95},
               {"void_ratio_i0", 1.05},
               {"exponent_alpha", 0.25},
               {"exponent_beta", 1.5},
               {"stiffness_ratio_m_r", 5},
               {"stiffness_ratio_m_t", 2},
               {"elastic_range_r", 1e-4},
               {"exponent_beta_r", 0.5},
               {"exponent_chi", 6}};
  test_material m = test_material_of("hypoplastic_sand");
  for (size_t k = 0; k < sizeof given / sizeof *given; k++) {
    test_set(&m, given[k].key, given[k].value);
  }
  pw_element el = test_start(&m, 1e5);
  const pw_real press[6] = {0, -1e-4, 0, 0, 0, 0}, back[6] = {0, 1e-4, 0, 0, 0, 0};
  double before = 0.0;
  for (int i = 0; i < 50; i++) {
    before = axial(&el);
    assert_ok(pw_element_move(&el, press, NULL, NULL));
  }
  const double top = axial(&el), load = (top - before) / 1e-4;
  assert_ok(pw_element_move(&el, back, NULL, NULL));
  const double unload = (top - axial(&el)) / 1e-4;
  print_message("%.1f kPa, %.0f and %.0f kPa\n", top / 1e3, load / 1e3, unload / 1e3);
  assert_relative(top, 294.3e3, 2e-4);
  assert_relative(load, 29080e3, 1e-4);
  assert_relative(unload, 316559e3, 1e-4);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(oedometer_of_hochstetten_sand)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
