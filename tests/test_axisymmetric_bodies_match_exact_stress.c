/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Axisymmetric elastic bodies brought to rest by local damping (verification A8 d, e):
 * - thick cylinder under internal pressure (Lame): a = 1, b = 2, p = 1, E = 1000, nu = 0.3, plane
 *   strain along the axis: sigma_rr, tt = A -+ B/r^2, A = p a^2/(b^2 - a^2), B = A b^2,
 *   u = (1 + nu)/E ((1 - 2 nu) A r + B/r);
 * - solid cylinders in uniform states: axial load with a free and with a confined rim, and radial
 *   pressure; the row of points at the axis is part of the body like any other.
 * Pressures are a thousandth of the figures above, so that displacements stay small. */
#include "tests/engine_helpers.h"

static const double young = 1e3, poisson = 0.3, scale = 1e-3;

static void load(pw_scene *s, int side, double pressure)
{
  pw_surcharge_param *p = pw_scene_add_effect(s, "surcharge");
  p->body = 0;
  p->side = side;
  p->pressure_pa = pressure;
  p->ramp_s = 5.0;
}

static void roller(pw_scene *s, int side)
{
  pw_boundary_param *b = pw_scene_add_effect(s, "boundary");
  b->side = side;
  b->fix_x = side == PW_SIDE_LEFT || side == PW_SIDE_RIGHT;
  b->fix_y = !b->fix_x;
}

/* A damped axisymmetric scene with one elastic body; the waves' speed is about 1 m/s. */
static void damped_scene(pw_scene *s, const double grid[4], const double body[4], double h)
{
  pw_scene_default(s);
  s->geometry = PW_AXI;
  test_grid(s, grid, h);
  int m = test_elastic(s, young, poisson, 1e3);
  test_rectangle(s, m, body, 0.5 * h);
  pw_damping_local_param *d = pw_scene_add_effect(s, "damping_local");
  d->coefficient = 0.5;
}

typedef struct {
  double displacement, stress; /* relative L2 errors */
  double worst;                /* largest relative error of a displacement */
} lame;

/* Errors against Lame's solution; r0: initial radii by id. */
static lame compare_lame(const pw_sim *sim, const double *r0)
{
  const pw_points *p = &sim->points;
  const double a = scale / 3.0, b = 4.0 * a;
  double eu = 0.0, u2 = 0.0, es = 0.0, s2 = 0.0;
  lame out = {0.0, 0.0, 0.0};
  for (pw_idx i = 0; i < p->n; i++) {
    double r = r0[p->id[i]], u = p->x[i] - r, rr = a - b / (r * r), tt = a + b / (r * r);
    double exact = (1.0 + poisson) / young * ((1.0 - 2.0 * poisson) * a * r + b / r);
    double e[2] = {p->stress[i] - rr, p->stress[2 * p->ld + i] - tt};
    eu += (u - exact) * (u - exact) * p->vol[i];
    u2 += exact * exact * p->vol[i];
    es += (e[0] * e[0] + e[1] * e[1]) * p->vol[i];
    s2 += (rr * rr + tt * tt) * p->vol[i];
    out.worst = fmax(out.worst, fabs(u / exact - 1.0));
  }
  out.displacement = sqrt(eu / u2);
  out.stress = sqrt(es / s2);
  return out;
}

static lame thick_cylinder(int n)
{
  static pw_scene s;
  double h = 1.0 / n, r0[1024];
  damped_scene(&s, (double[]){1.0 - 2.0 * h, 2.0 + 2.0 * h, 0.0, h}, (double[]){1.0, 2.0, 0.0, h},
               h);
  load(&s, PW_SIDE_LEFT, scale);
  roller(&s, PW_SIDE_BOTTOM);
  roller(&s, PW_SIDE_TOP);
  pw_sim *sim = test_sim(&s, 1);
  assert_true(sim->points.n <= 1024);
  for (pw_idx i = 0; i < sim->points.n; i++) {
    r0[sim->points.id[i]] = sim->points.x[i];
  }
  test_run_to(sim, 160.0);
  lame out = compare_lame(sim, r0);
  pw_sim_destroy(&sim);
  return out;
}

static void thick_cylinder_converges(void **state)
{
  (void)state;
  lame e[3];
  for (int k = 0; k < 3; k++) {
    e[k] = thick_cylinder(10 << k);
    print_message("%d cells: displacement %.2e (worst point %.2e), stress %.2e\n", 10 << k,
                  e[k].displacement, e[k].worst, e[k].stress);
  }
  assert_true(e[1].worst <= 0.01);
  assert_true(0.5 * log2(e[0].displacement / e[2].displacement) >= 1.5);
  assert_true(0.5 * log2(e[0].stress / e[2].stress) >= 0.9);
}

typedef enum { AXIAL_FREE, AXIAL_CONFINED, RADIAL } uniform_state;

/* Stress of every point over the pressure; lateral: xx and zz. */
static void check_uniform(uniform_state which, double axial, double lateral)
{
  static pw_scene s;
  double h = 0.125, room = which == AXIAL_CONFINED ? 0.0 : 2.0 * h, spread = 0.0;
  damped_scene(&s, (double[]){0.0, 1.0 + room, 0.0, 1.0 + 2.0 * h}, (double[]){0.0, 1.0, 0.0, 1.0},
               h);
  roller(&s, PW_SIDE_BOTTOM);
  if (which == AXIAL_CONFINED) {
    roller(&s, PW_SIDE_RIGHT);
  }
  load(&s, which == RADIAL ? PW_SIDE_RIGHT : PW_SIDE_TOP, scale);
  pw_sim *sim = test_sim(&s, 1);
  test_run_to(sim, 60.0);
  const pw_points *p = &sim->points;
  const double want[4] = {lateral, axial, lateral, 0.0};
  for (pw_idx i = 0; i < p->n; i++) {
    for (int c = 0; c < 4; c++) {
      spread = fmax(spread, fabs(p->stress[c * p->ld + i] / scale - want[c]));
    }
  }
  print_message("state %d: largest deviation of a stress %.1e of the pressure\n", which, spread);
  assert_true(spread <= 1e-3);
  pw_sim_destroy(&sim);
}

static void uniform_states_stay_uniform(void **state)
{
  (void)state;
  check_uniform(AXIAL_FREE, -1.0, 0.0);
  check_uniform(AXIAL_CONFINED, -1.0, -poisson / (1.0 - poisson));
  check_uniform(RADIAL, 0.0, -1.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(thick_cylinder_converges),
      cmocka_unit_test(uniform_states_stay_uniform),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
