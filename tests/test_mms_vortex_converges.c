/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Generalised vortex (verification A4; Kamojjala et al. 2015): the ring 0.75 <= R <= 1.25 turns by
 * alpha(R, t) = sin(c pi t) H(R), c = 1 m/s, to 1 rad and back; E = 1000, nu = 0.3, rho = 1000,
 * neo-Hookean, plane strain, its rims free. Grid of 3 m in n cells, polar domains of half a cell,
 * steps of 0.05 h / c_p, no limit on domains. Error: largest L2 norm over the steps of the
 * difference of displacements, over the largest L2 norm of the exact one; references: an
 * independent program, CPDI, USL. */
#include "tests/engine_helpers.h"

static const double young = 1e3, poisson = 0.3, density = 1e3;

static void vortex_scene(pw_scene *s, int n)
{
  double h = 3.0 / n, c_p;
  pw_scene_default(s);
  s->method.update = PW_USL;
  s->method.domain_limit_cells = 0.0;
  test_grid(s, (double[]){-1.5, 1.5, -1.5, 1.5}, h);
  int m = test_neo_hookean(s, young / (3.0 * (1.0 - 2.0 * poisson)), 0.5 * young / (1.0 + poisson),
                           density);
  s->body[0] = (pw_scene_body){.name = "ring",
                               .material = m,
                               .shape = PW_SHAPE_RING,
                               .radius_m = 1.25,
                               .inner_radius_m = 0.75,
                               .angle_deg = {0.0, 360.0},
                               .point_size_m = 0.5 * h};
  s->nbody = 1;
  pw_body_force_param *force = pw_scene_add_effect(s, "body_force");
  force->body = 0;
  force->kind = PW_MMS_VORTEX;
  force->rotation_rad = 1.0;
  c_p = sqrt(young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson)) / density);
  s->time.dt_s = 0.05 * h / c_p;
}

static double vortex_error(int n)
{
  static pw_scene s;
  pw_record out;
  vortex_scene(&s, n);
  pw_sim *sim = test_sim(&s, 1);
  test_run_to(sim, 1.0);
  pw_sim_results(sim, &out);
  double error = -1.0;
  for (int k = 0; k < out.n; k++) {
    error = strcmp(out.item[k].name, "mms_displacement_error") == 0 ? out.item[k].value : error;
  }
  pw_sim_destroy(&sim);
  return error;
}

static void cpdi_is_of_second_order(void **state)
{
  (void)state;
  const double want[3] = {4.20e-1, 9.28e-2, 2.26e-2};
  double error[3];
  for (int k = 0; k < 3; k++) {
    error[k] = vortex_error(24 << k);
    print_message("n %d: %.3e, independent program %.3e\n", 24 << k, error[k], want[k]);
    assert_true(error[k] <= 1.05 * want[k]);
  }
  double rate = log2(error[1] / error[2]);
  print_message("rate from n = 48 to 96: %.2f\n", rate);
  assert_true(rate >= 1.8);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cpdi_is_of_second_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
