/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Waves leave through absorbing sides: at normal incidence a dashpot of the impedance rho c returns
 * nothing (Lysmer and Kuhlemeyer 1969), a free or fixed side everything; a dashpot of alpha rho c
 * returns (1 - alpha) / (1 + alpha). Less than 5 % is asked for. */
#include "tests/absorbing_helpers.h"

static const double v0 = 0.01, width = 1.2; /* pulse v0 exp(-(s / width)^2): 20 cells long */

/* A pulse that runs down from y = 5 m, of pressure (axis 1) or shear (axis 0), one way:
 * v = f(y + c t), stress rho c v. */
static void send_down(pw_sim *sim, int axis)
{
  pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n; i++) {
    double s = (p->x[p->ld + i] - 5.0) / width, v = -v0 * exp(-s * s);
    p->v[axis * p->ld + i] = v;
    if (axis == 1) {
      double yy = test_rho * test_cp * v;
      p->stress[p->ld + i] = yy;
      p->stress[i] = p->stress[2 * p->ld + i] = yy * test_nu / (1.0 - test_nu);
    } else {
      p->stress[3 * p->ld + i] = test_rho * test_cp / sqrt(3.0) * v;
    }
  }
}

/* Part of the pulse that is there when its reflection has come back to the middle. */
static double returned(const pw_scene *s, int axis, double *books)
{
  pw_sim *sim = test_sim(s, 1);
  send_down(sim, axis);
  double c = axis == 1 ? test_cp : test_cp / sqrt(3.0);
  test_run_to(sim, 10.0 / c);
  double back = test_fastest(sim) / v0;
  *books = fabs(test_open_books(sim)) / sim->energy.initial;
  if (back < 0.05) { /* half of the energy was kinetic at the start, but for half a step */
    assert_relative(sim->energy.absorbed, 2.0 * sim->energy.initial, 0.02);
  }
  pw_sim_destroy(&sim);
  return back;
}

/* Factors of the impedance: 1, 0, 1/2 and 3. */
static void check_pulse(int axis, int basis, int update)
{
  static pw_scene s;
  double books, open = 1.0, factor[4] = {1.0, 0.0, 0.5, 3.0}, back[4];
  for (int k = 0; k < 4; k++) {
    pw_absorbing_param *a = test_column(&s);
    s.method.basis = basis;
    s.method.update = update;
    a->normal_factor = a->shear_factor = factor[k];
    if (axis == 0) { /* a shear beam: nothing moves up or down, everything to the side */
      for (int e = 0; e < 2; e++) {
        pw_boundary_param *b = (void *)s.effect[e].param;
        b->fix_x = false;
        b->fix_y = true;
      }
    }
    back[k] = returned(&s, axis, &books);
    open = k == 0 ? books : open;
  }
  print_message("%s, basis %d, update %d: returned %.4f; free %.3f; half %.3f, three times %.3f "
                "the impedance; books open by %.2e\n",
                axis == 1 ? "pressure" : "shear", basis, update, back[0], back[1], back[2], back[3],
                open);
  assert_true(back[0] < 0.05);
  /* USL and USF stagger velocity and stress, which the pulse starts with at one time. */
  assert_true(open < (update == PW_MUSL ? 0.01 : 0.03));
  assert_near(back[1], 1.0, 0.05);
  assert_near(back[2], 1.0 / 3.0, 0.03);
  assert_near(back[3], 0.5, 0.03);
}

static void pressure(void **state)
{
  (void)state;
  check_pulse(1, PW_CPDI, PW_MUSL);
  check_pulse(1, PW_CPDI, PW_USL);
  check_pulse(1, PW_CPDI, PW_USF);
  check_pulse(1, PW_LINEAR, PW_MUSL);
}

static void shear(void **state)
{
  (void)state;
  check_pulse(0, PW_CPDI, PW_MUSL);
}

/* Axisymmetric strip from r = 5 m to `end` between rollers; the pulse starts at 10 m outwards. */
static pw_sim *radial(double end, double factor)
{
  static pw_scene s;
  pw_scene_default(&s);
  s.geometry = PW_AXI;
  test_grid(&s, (pw_real[]){5.0, end, 0.0, 0.2}, 0.2);
  test_rectangle(&s, test_soil(&s), (pw_real[]){5.0, end, 0.0, 0.2}, 0.1);
  test_roller(&s, PW_SIDE_BOTTOM);
  test_roller(&s, PW_SIDE_TOP);
  test_roller(&s, PW_SIDE_LEFT);
  test_absorbing(&s, PW_SIDE_RIGHT)->normal_factor = factor;
  pw_sim *sim = test_sim(&s, 1);
  pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n; i++) {
    double q = (p->x[i] - 10.0) / width;
    p->v[i] = v0 * exp(-q * q);
    p->stress[i] = -test_rho * test_cp * p->v[i];
    p->stress[p->ld + i] = p->stress[2 * p->ld + i] = p->stress[i] / 3.0;
  }
  test_run_to(sim, 8.0 / test_cp); /* 3 m past the side at 15 m */
  return sim;
}

/* Largest difference in speed of the points they share. */
static double difference(const pw_sim *a, const pw_sim *b)
{
  const pw_points *p = &a->points, *q = &b->points;
  double most = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    double nearest = 1.0, dv = 0.0;
    for (pw_idx k = 0; k < q->n; k++) {
      double d = hypot(p->x[i] - q->x[k], p->x[p->ld + i] - q->x[q->ld + k]);
      if (d < nearest) {
        nearest = d;
        dv = fabs(p->v[i] - q->v[k]);
      }
    }
    assert_true(nearest < 0.01);
    most = fmax(most, dv);
  }
  return most;
}

static void radial_wave(void **state)
{
  (void)state;
  double arriving = v0 * sqrt(10.0 / 15.0); /* a cylindrical wave decays as r^-1/2 */
  pw_sim *far = radial(30.0, 1.0), *near = radial(15.0, 1.0), *open = radial(15.0, 0.0);
  double back = difference(near, far) / arriving, control = difference(open, far) / arriving;
  print_message("radial: returned %.4f, free side %.3f\n", back, control);
  assert_true(back < 0.05);
  assert_near(control, 1.0, 0.15);
  pw_sim_destroy(&far);
  pw_sim_destroy(&near);
  pw_sim_destroy(&open);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pressure),
      cmocka_unit_test(shear),
      cmocka_unit_test(radial_wave),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
