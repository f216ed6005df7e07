/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Limit r -> infinity (verification A8 g): at a mean radius of 1e4 cells an axisymmetric block
 * moves as one in plane strain, to 1e-4 of velocity and stress in L2, and the difference is
 * inversely proportional to the radius. The block hits a rough floor and rebounds under its weight,
 * so that all components of stress take part. */
#include "tests/engine_helpers.h"

enum { WIDE = 2, HIGH = 4, POINTS = 4 * WIDE * HIGH };

static pw_sim *block_sim(int geometry, int basis, double left)
{
  static pw_scene s;
  pw_scene_default(&s);
  s.geometry = geometry;
  s.method.basis = basis;
  test_grid(&s, (double[]){left - 2.0, left + WIDE + 2.0, 0.0, HIGH + 2.0}, 1.0);
  int m = test_elastic(&s, 1e3, 0.3, 1.0);
  pw_scene_body *b = test_rectangle(&s, m, (double[]){left, left + WIDE, 0.0, HIGH}, 0.5);
  b->velocity_m_s[1] = -0.3;
  pw_boundary_param *floor = pw_scene_add_effect(&s, "boundary");
  floor->side = PW_SIDE_BOTTOM;
  floor->fix_x = floor->fix_y = true;
  pw_gravity_param *g = pw_scene_add_effect(&s, "gravity");
  g->acceleration_m_s2 = 1.0;
  s.time.dt_s = 0.01;
  /* The cut-off is a mass per radian: at a small one no node of one run is left out of the other. */
  s.method.mass_cut_off = 1e-12;
  return test_sim(&s, 1);
}

/* Add the squares of the differences of a field between two runs, by id, and of its values. */
static void compare(const pw_sim *a, const pw_sim *b, pw_field_id id, double *error, double *size)
{
  const pw_points *p = &a->points, *q = &b->points;
  const pw_real *x = pw_points_field(p, id).array, *y = pw_points_field(q, id).array;
  for (int c = 0; c < pw_points_field(p, id).ncomp; c++) {
    for (pw_idx k = 0; k < POINTS; k++) {
      pw_real v = y[c * q->ld + q->slot[k]];
      pw_real e = x[c * p->ld + p->slot[k]] - v;
      *error += e * e;
      *size += v * v;
    }
  }
}

/* Relative L2 differences of velocity and stress over points and steps. */
static void distance(int basis, double radius, double *out)
{
  pw_sim *ring = block_sim(PW_AXI, basis, radius - 0.5 * WIDE);
  pw_sim *plane = block_sim(PW_PLANE, basis, 2.0);
  double error[2] = {0.0, 0.0}, size[2] = {0.0, 0.0};
  for (int k = 0; k < 40; k++) {
    assert_ok(pw_sim_step(ring, 0.0));
    assert_ok(pw_sim_step(plane, 0.0));
    compare(ring, plane, PW_FIELD_VELOCITY, &error[0], &size[0]);
    compare(ring, plane, PW_FIELD_STRESS, &error[1], &size[1]);
  }
  for (int k = 0; k < 2; k++) {
    out[k] = sqrt(error[k] / size[k]);
  }
  pw_sim_destroy(&ring);
  pw_sim_destroy(&plane);
}

static void ring_of_large_radius_is_plane(void **state)
{
  (void)state;
  for (int basis = PW_LINEAR; basis <= PW_CPDI; basis++) {
    double near[2], far[2];
    distance(basis, 1e4, near);
    distance(basis, 1e5, far);
    for (int k = 0; k < 2; k++) {
      print_message("basis %d, %s: %.2e at 1e4 cells, %.2e at 1e5\n", basis,
                    k == 0 ? "velocity" : "stress", near[k], far[k]);
      assert_true(near[k] <= 1e-4);
      assert_relative(far[k], 0.1 * near[k], 0.01);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ring_of_large_radius_is_plane),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
