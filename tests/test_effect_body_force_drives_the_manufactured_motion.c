/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Verification A3: unit square, A = 0.05 m, one period; CPDI with 2 points per direction, USL,
 * CFL 0.4. Relative displacement errors of an independent program: 3.850e-2 (16 cells),
 * 9.707e-3 (32 cells). */
#include "engine/effects/params.h"
#include "tests/engine_helpers.h"

static pw_real displacement_error(int cells, int basis, pw_energy *energy)
{
  const pw_real young = 1e7, nu = 0.3;
  pw_scene scene;
  pw_scene_default(&scene);
  scene.method.basis = basis;
  scene.method.update = PW_USL;
  pw_real h = 1.0 / cells;
  test_grid(&scene, (pw_real[4]){0.0, 1.0, 0.0, 1.0}, h);
  int m = test_neo_hookean(&scene, young / (3.0 * (1.0 - 2.0 * nu)), 0.5 * young / (1.0 + nu), 1e3);
  test_rectangle(&scene, m, (pw_real[4]){0.0, 1.0, 0.0, 1.0}, 0.5 * h);
  pw_body_force_param *f = pw_scene_add_effect(&scene, "body_force");
  f->body = 0;
  f->kind = PW_MMS_AXIS_ALIGNED;
  f->amplitude_m = 0.05;
  for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_RIGHT; side++) {
    pw_boundary_param *b = pw_scene_add_effect(&scene, "boundary");
    b->side = side;
    b->fix_x = side > PW_SIDE_TOP;
    b->fix_y = !b->fix_x;
  }
  /* c_p = sqrt(M / rho), M = 1.346 E */
  scene.time.dt_s = 0.4 * h / sqrt(young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) / 1e3);
  pw_sim *sim = test_sim(&scene, 1);
  test_run_to(sim, 0.02);
  pw_record out;
  pw_sim_results(sim, &out);
  pw_real error = -1.0;
  for (int k = 0; k < out.n; k++) {
    error = strcmp(out.item[k].name, "mms_displacement_error") == 0 ? out.item[k].value : error;
  }
  pw_report report;
  pw_sim_report(sim, &report);
  *energy = report.energy;
  pw_sim_destroy(&sim);
  return error;
}

static void errors_are_those_of_the_catalogue(void **state)
{
  (void)state;
  pw_energy e;
  pw_real coarse = displacement_error(16, PW_CPDI, &e);
  pw_real fine = displacement_error(32, PW_CPDI, &e);
  print_message("A3 CPDI: %.4e (16), %.4e (32), rate %.3f\n", coarse, fine, log2(coarse / fine));
  assert_relative(fine, 9.707e-3, 0.05);
  assert_relative(coarse, 3.850e-2, 0.05);
  assert_true(log2(coarse / fine) >= 1.9);
  /* Work of the body force, kinetic energy and work of the stresses. */
  assert_near(e.kinetic - e.initial + e.strain_work - e.external, 0.0, 0.01 * e.initial);
}

static void other_materials_are_refused(void **state)
{
  (void)state;
  pw_scene scene;
  pw_scene_default(&scene);
  int m = test_elastic(&scene, 1e7, 0.3, 1e3);
  test_rectangle(&scene, m, (pw_real[4]){0.0, 1.0, 0.0, 1.0}, 0.5);
  pw_body_force_param *f = pw_scene_add_effect(&scene, "body_force");
  f->body = 0;
  const pw_effect *type = pw_effect_find("body_force");
  assert_int_equal(type->check(&scene, f), PW_ERR_SCENE);
  scene.body[0].material = test_neo_hookean(&scene, 1e7, 4e6, 1e3);
  assert_int_equal(type->check(&scene, f), PW_OK);
  scene.geometry = PW_AXI;
  assert_int_equal(type->check(&scene, f), PW_ERR_SCENE);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(errors_are_those_of_the_catalogue),
      cmocka_unit_test(other_materials_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
