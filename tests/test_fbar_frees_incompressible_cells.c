/* SPDX-License-Identifier: GPL-3.0-or-later */
/* F-bar in explicit steps (engine/fbar.h).
 * - A homogeneous deformation is the same with and without it (verification G): one cell whose
 *   four nodes have given velocities, plane and axisymmetric, a law of rates and one of F.
 * - A thick cylinder of nu = 0.4999 under internal pressure (Lame, as in
 *   test_axisymmetric_bodies_match_exact_stress): each cell has one degree of freedom and two
 *   points that want to keep their volume, so it locks; with F-bar one volume is kept and the
 *   exact displacement u = (1 + nu)/E ((1 - 2 nu) A r + B/r) and stress come back. */
#include "tests/engine_helpers.h"

static void side(pw_scene *s, int which, double velocity)
{
  pw_boundary_param *b = pw_scene_add_effect(s, "boundary");
  b->side = which;
  b->fix_x = which == PW_SIDE_LEFT || which == PW_SIDE_RIGHT;
  b->fix_y = !b->fix_x;
  *(b->fix_x ? &b->velocity_x_m_s : &b->velocity_y_m_s) = velocity;
}

/* Stress of the points of one cell after 200 steps of stretching. */
static void stretch(int geometry, bool hyperelastic, bool fbar, double stress[4][4])
{
  static pw_scene s;
  pw_scene_default(&s);
  s.geometry = geometry;
  s.time.dt_s = 1e-3;
  test_grid(&s, (double[]){0.0, 1.0, 0.0, 1.0}, 1.0);
  int m = hyperelastic ? test_neo_hookean(&s, 2e3, 1e3, 1.0) : test_elastic(&s, 1e3, 0.3, 1.0);
  pw_scene_body *b = test_rectangle(&s, m, (double[]){0.0, 1.0, 0.0, 1.0}, 0.5);
  b->velocity_m_s[1] = -1.0; /* no part of the motion, but energy enough for the energy guard */
  side(&s, PW_SIDE_LEFT, 0.0);
  side(&s, PW_SIDE_BOTTOM, 0.0);
  side(&s, PW_SIDE_RIGHT, -0.1);
  side(&s, PW_SIDE_TOP, -0.2);
  if (fbar) {
    ((pw_fbar_param *)pw_scene_add_effect(&s, "fbar"))->body = -1;
  }
  pw_sim *sim = test_sim(&s, 1);
  for (int k = 0; k < 200; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
  const pw_points *p = &sim->points;
  assert_int_equal(p->n, 4);
  for (int i = 0; i < 4; i++) {
    for (int c = 0; c < 4; c++) {
      stress[i][c] = p->stress[c * p->ld + i];
    }
  }
  pw_sim_destroy(&sim);
}

static void homogeneous_deformation_is_untouched(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    double own[4][4], shared[4][4];
    stretch(k % 2, k / 2, false, own);
    stretch(k % 2, k / 2, true, shared);
    assert_true(fabs(own[0][1]) > 30.0);
    for (int i = 0; i < 16; i++) {
      assert_near(shared[i / 4][i % 4], own[i / 4][i % 4], 1e-10);
    }
  }
}

typedef struct {
  double displacement, stress; /* largest relative error, and L2 over the exact */
} errors;

/* 10 cells through the wall. */
static errors thick_cylinder(bool fbar)
{
  static pw_scene s;
  const double h = 0.1, young = 1e3, poisson = 0.4999, pressure = 1e-3;
  const double a = pressure / 3.0, b = 4.0 * a;
  double r0[64], es = 0.0, s2 = 0.0;
  errors out = {0.0, 0.0};
  pw_scene_default(&s);
  s.geometry = PW_AXI;
  test_grid(&s, (double[]){1.0 - 2.0 * h, 2.0 + 2.0 * h, 0.0, h}, h);
  test_rectangle(&s, test_elastic(&s, young, poisson, 1e3), (double[]){1.0, 2.0, 0.0, h}, 0.5 * h);
  side(&s, PW_SIDE_BOTTOM, 0.0);
  side(&s, PW_SIDE_TOP, 0.0);
  pw_surcharge_param *load = pw_scene_add_effect(&s, "surcharge");
  load->body = 0;
  load->side = PW_SIDE_LEFT;
  load->pressure_pa = pressure;
  load->ramp_s = 5.0;
  ((pw_damping_local_param *)pw_scene_add_effect(&s, "damping_local"))->coefficient = 0.5;
  if (fbar) {
    ((pw_fbar_param *)pw_scene_add_effect(&s, "fbar"))->body = 0;
  }
  pw_sim *sim = test_sim(&s, 1);
  const pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n; i++) {
    r0[p->id[i]] = p->x[i];
  }
  test_run_to(sim, 60.0);
  for (pw_idx i = 0; i < p->n; i++) {
    double r = r0[p->id[i]], u = p->x[i] - r, rr = a - b / (r * r), tt = a + b / (r * r);
    double exact = (1.0 + poisson) / young * ((1.0 - 2.0 * poisson) * a * r + b / r);
    double e[2] = {p->stress[i] - rr, p->stress[2 * p->ld + i] - tt};
    es += (e[0] * e[0] + e[1] * e[1]) * p->vol[i];
    s2 += (rr * rr + tt * tt) * p->vol[i];
    out.displacement = fmax(out.displacement, fabs(u / exact - 1.0));
  }
  out.stress = sqrt(es / s2);
  pw_sim_destroy(&sim);
  return out;
}

static void incompressible_cylinder_moves_as_lame_says(void **state)
{
  (void)state;
  errors own = thick_cylinder(false), shared = thick_cylinder(true);
  print_message("own gradients: worst displacement %.2e, stress %.2e; F-bar: %.2e, %.2e\n",
                own.displacement, own.stress, shared.displacement, shared.stress);
  assert_true(shared.displacement <= 0.02);
  assert_true(shared.stress <= 0.05);
  assert_true(own.displacement >= 10.0 * shared.displacement);
  assert_true(own.stress >= 10.0 * shared.stress);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(homogeneous_deformation_is_untouched),
      cmocka_unit_test(incompressible_cylinder_moves_as_lame_says),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
