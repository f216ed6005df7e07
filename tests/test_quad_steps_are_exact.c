/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implicit steps on the grid against closed forms: uniform stretch of a block by its sides, and a
 * thick cylinder under pressure from inside. */
#include "tests/quad_helpers.h"

/* Stresses of a stretch along the axes: neo-Hookean J sigma = lambda ln J 1 + mu (b - 1), Hencky
 * tau = lambda ln J 1 + 2 mu ln V. */
static void exact_stress(int material, const double stretch[3], double lambda, double mu, double *s)
{
  const double j = stretch[0] * stretch[1] * stretch[2];
  for (int c = 0; c < 3; c++) {
    const double part =
        material == 0 ? mu * (stretch[c] * stretch[c] - 1.0) : 2.0 * mu * log(stretch[c]);
    s[c] = (lambda * log(j) + part) / j;
  }
}

static double value_of(const pw_record *row, const char *name)
{
  for (int i = 0; i < row->n; i++) {
    if (strcmp(row->item[i].name, name) == 0) {
      return row->item[i].value;
    }
  }
  fail_msg("no column %s", name);
  return 0.0;
}

static double stretch_block(int geometry, int basis, int material)
{
  static pw_scene s;
  const double youngs = 1e4, poisson = 0.3, width = 0.8, rise = 0.9;
  const double mu = 0.5 * youngs / (1.0 + poisson),
               lambda = 2.0 * mu * poisson / (1.0 - 2.0 * poisson);
  const bool axi = geometry == PW_AXI;
  double expected[3], worst = 0.0;
  test_quad_scene(&s, geometry, basis, (pw_real[]){0.0, 2.0, 0.0, 2.0}, 0.5, 1);
  const int m = material == 0 ? test_neo_hookean(&s, lambda + 2.0 / 3.0 * mu, mu, 1.0)
                              : test_hencky(&s, youngs, poisson, 1.0, 1e12);
  test_rectangle(&s, m, (pw_real[]){0.0, 2.0, 0.0, 2.0}, 0.25);
  if (!axi) {
    test_roller(&s, PW_SIDE_LEFT);
  }
  test_roller(&s, PW_SIDE_BOTTOM);
  test_moving_side(&s, PW_SIDE_RIGHT, 2.0 * (width - 1.0));
  test_moving_side(&s, PW_SIDE_TOP, 2.0 * (rise - 1.0));
  exact_stress(material, (const double[]){width, rise, axi ? width : 1.0}, lambda, mu, expected);
  pw_sim *sim = test_sim(&s, 1);
  test_quad_run(sim);
  const pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n; i++) {
    for (int c = 0; c < 6; c++) {
      const double e = p->stress[c * p->ld + i] - (c < 3 ? expected[c] : 0.0);
      worst = fmax(worst, fabs(e) / youngs);
    }
  }
  /* what the moving top (the fourth entry, the third without the left one) exerts: stress times
   * its area after the step */
  pw_record row;
  pw_sim_history(sim, &row);
  const double area = axi ? 3.14159265358979 * 4.0 * width * width : 2.0 * width;
  assert_relative(value_of(&row, axi ? "boundary_2_force_y_n" : "boundary_3_force_y_n"),
                  expected[1] * area, 1e-9);
  pw_sim_destroy(&sim);
  return worst;
}

static void uniform_stretch_is_exact(void **state)
{
  (void)state;
  for (int geometry = PW_PLANE; geometry <= PW_AXI; geometry++) {
    for (int basis = PW_LINEAR; basis <= PW_CPDI; basis++) {
      for (int material = 0; material < 2; material++) {
        const double error = stretch_block(geometry, basis, material);
        print_message("%s, %s, %s: %.2g of E\n", geometry == PW_AXI ? "axisymmetric" : "plane",
                      test_basis_name[basis], material == 0 ? "neo-Hookean" : "Hencky", error);
        assert_true(error <= 1e-10);
      }
    }
  }
}

/* Largest error of the radial displacements of the points, over that of the inner wall. Lame: u =
 * (1 + nu) p a2 / (E (b2 - a2)) ((1 - 2 nu) r + b2 / r). */
static double thick_cylinder(int basis, int cells)
{
  static pw_scene s;
  static double start[4096];
  const double a = 1.0, b = 2.0, youngs = 1e3, poisson = 0.3, pressure = 1e-4, h = 1.0 / cells;
  const double k = (1.0 + poisson) * pressure * a * a / (youngs * (b * b - a * a));
  const double wall = k * ((1.0 - 2.0 * poisson) * a + b * b / a);
  double worst = 0.0;
  test_quad_scene(&s, PW_AXI, basis, (pw_real[]){a - h, b + 2.0 * h, 0.0, 2.0 * h}, h, 1);
  const int m = test_elastic(&s, youngs, poisson, 1.0);
  test_rectangle(&s, m, (pw_real[]){a, b, 0.0, 2.0 * h}, 0.5 * h);
  test_roller(&s, PW_SIDE_BOTTOM);
  test_roller(&s, PW_SIDE_TOP);
  pw_surcharge_param *load = pw_scene_add_effect(&s, "surcharge");
  load->body = 0;
  load->side = PW_SIDE_LEFT;
  load->pressure_pa = pressure;
  pw_sim *sim = test_sim(&s, 1);
  const pw_points *p = &sim->points;
  assert_true(p->n <= 4096);
  for (pw_idx i = 0; i < p->n; i++) {
    start[p->id[i]] = p->x[i];
  }
  test_quad_run(sim);
  for (pw_idx i = 0; i < p->n; i++) {
    const double r = start[p->id[i]], u = k * ((1.0 - 2.0 * poisson) * r + b * b / r);
    worst = fmax(worst, fabs(p->x[i] - r - u) / wall);
  }
  pw_sim_destroy(&sim);
  return worst;
}

static void thick_cylinder_widens_as_lame_says(void **state)
{
  (void)state;
  for (int basis = PW_LINEAR; basis <= PW_CPDI; basis++) {
    const double coarse = thick_cylinder(basis, 10), fine = thick_cylinder(basis, 20);
    print_message("%s: error %.3g with 10 cells, %.3g with 20, rate %.2f\n", test_basis_name[basis],
                  coarse, fine, log2(coarse / fine));
    assert_true(fine <= (basis == PW_LINEAR ? 0.01 : 2e-4)); /* linear: loads act at the points */
    assert_true(basis == PW_LINEAR || log2(coarse / fine) >= 1.5);
  }
}

/* Two layers of elastic soil and of hypoplastic sand with ground water, at rest under their weight
 * and a surcharge: nothing is out of balance, and nothing moves. */
static void ground_stays_at_rest(void **state)
{
  (void)state;
  static pw_scene s;
  static double start[2][512];
  test_quad_scene(&s, PW_PLANE, PW_CPDI, (pw_real[]){0.0, 1.0, 0.0, 10.5}, 0.5, 3);
  const int soil = test_elastic(&s, 5e7, 0.3, 1600.0), sand = test_sand(&s, true);
  test_rectangle(&s, sand, (pw_real[]){0.0, 1.0, 0.0, 6.0}, 0.25);
  test_rectangle(&s, soil, (pw_real[]){0.0, 1.0, 6.0, 10.0}, 0.25);
  pw_initial_stress_param *p = pw_scene_add_effect(&s, "initial_stress");
  p->kind = PW_STRESS_LAYERS;
  p->nlayer = 2;
  p->layer[0] = (pw_ground_layer){.body = 1, .k0 = 0.5, .porosity = 0.4};
  p->layer[1] = (pw_ground_layer){.body = 0, .k0 = 0.42};
  p->surcharge_pa = 5e3;
  p->water_table_y_m = 8.0;
  p->water_inertia = true;
  test_gravity(&s, 0.0);
  pw_surcharge_param *load = pw_scene_add_effect(&s, "surcharge");
  load->body = 1;
  load->side = PW_SIDE_TOP;
  load->pressure_pa = 5e3;
  test_roller(&s, PW_SIDE_BOTTOM);
  test_roller(&s, PW_SIDE_LEFT);
  test_roller(&s, PW_SIDE_RIGHT);
  pw_sim *sim = test_sim(&s, 1);
  const pw_points *q = &sim->points;
  pw_record row;
  assert_true(q->n <= 512);
  for (pw_idx i = 0; i < q->n; i++) {
    start[0][q->id[i]] = q->x[q->ld + i];
    start[1][q->id[i]] = q->stress[q->ld + i];
  }
  test_quad_run(sim);
  for (pw_idx i = 0; i < q->n; i++) {
    assert_near(q->x[q->ld + i], start[0][q->id[i]], 1e-12);
    assert_relative(q->stress[q->ld + i], start[1][q->id[i]], 1e-9);
  }
  pw_sim_results(sim, &row);
  assert_true(value_of(&row, "initial_residual_relative") < 1e-12);
  assert_true(value_of(&row, "initial_residual_n") >= 0.0);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(uniform_stretch_is_exact),
      cmocka_unit_test(thick_cylinder_widens_as_lame_says),
      cmocka_unit_test(ground_stays_at_rest),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
