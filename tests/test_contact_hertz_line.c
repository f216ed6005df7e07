/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hertz' line contact (C6): a rigid cylinder on an elastic half space, plane strain, corner contact.
 * Half width a = sqrt(4 W R / (pi E*)), pressure p0 sqrt(1 - x^2 / a^2), p0 = 2 W / (pi a); with
 * R = 1.6 m, E* = 7.636 MPa and W = 80 425 N/m, the weight of the rolling cylinder (A11):
 * a = 0.1465 m, p0 = 349.5 kPa. Cells of 0.04 m, 3.7 to the half width. */
#include "engine/effects/contact_corner.h"
#include "tests/contact_helpers.h"

static const pw_real PI = 3.14159265358979323846, R = 1.6, POISSON = 2.0 / 7.0, MODULUS = 7.636e6;
static const pw_real CELL = 0.04, LOAD = 80425.0;

static pw_sim *cylinder(void)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  test_grid(&s, (pw_real[]){-2.4, 2.4, -2.4, 0.4}, CELL);
  s.grid.fine_x_m[0] = -0.28;
  s.grid.fine_x_m[1] = 0.28;
  s.grid.fine_y_m[0] = -0.24;
  s.grid.fine_y_m[1] = 0.04;
  s.grid.growth = 1.3;
  s.grid.cell_max_m = 0.4;
  int rubber = test_elastic(&s, MODULUS * (1.0 - POISSON * POISSON), POISSON, 1000.0);
  test_rectangle(&s, rubber, (pw_real[]){-2.4, 2.4, -2.4, 0.0}, 0.0)->points_per_cell = 2;
  test_disc(&s, rubber, 0.0, R, R, 0.0)->kind = PW_BODY_RIGID;
  test_add_contact(&s, TEST_CORNER, 1, 0, 0.0, 0.0, 0.0);
  pw_damping_local_param *d = pw_scene_add_effect(&s, "damping_local");
  d->coefficient = 0.3;
  d->body = 0;
  pw_prescribed_motion_param *p = pw_scene_add_effect(&s, "prescribed_motion");
  p->body = 1;
  p->velocity_m_s[1] = -0.03; /* rho c v is 1 % of p0 */
  p->ramp_s = 0.2;
  for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_RIGHT; side++) {
    if (side != PW_SIDE_TOP) {
      pw_boundary_param *b = pw_scene_add_effect(&s, "boundary");
      b->side = side;
      b->fix_x = b->fix_y = true;
      b->body = -1;
    }
  }
  return test_sim(&s, 1);
}

typedef struct contact {
  pw_real force, width, peak; /* N/m; m, by the second moment of the force; Pa, of the middle */
  pw_real far;                /* outermost site that pushes; m */
} contact;

/* Of a pressure p0 sqrt(1 - x^2 / a^2) the mean of x^2 is a^2 / 4, and on |x| < a / 4 its own mean
 * is 0.9894 p0. */
static contact measure(const pw_sim *sim)
{
  const pw_corner *c = pw_sim_effect_ctx(sim, "contact_corner");
  contact m = {0};
  pw_real moment = 0.0, middle = 0.0, area = 0.0;
  for (int pass = 0; pass < 2; pass++) {
    for (pw_idx k = 0; k < c->npair; k++) {
      const pw_corner_pair *q = &c->pair[k];
      pw_domain_now d = pw_domain_of(&sim->points, q->point, false);
      pw_real x[2];
      pw_site_place(&d, q->site, x);
      if (pass == 0) {
        m.force -= q->force[1]; /* on the half space */
        moment -= q->force[1] * x[0] * x[0];
        m.far = q->force[1] < 0.0 ? pw_max(m.far, fabs(x[0])) : m.far;
      } else if (fabs(x[0]) < 0.25 * m.width) {
        middle -= q->force[1];
        area += q->area;
      }
    }
    m.width = 2.0 * sqrt(moment / m.force);
  }
  m.peak = middle / area / 0.9894;
  return m;
}

static void pressure_is_hertz(void **state)
{
  (void)state;
  const pw_real a = sqrt(4.0 * LOAD * R / (PI * MODULUS)), p0 = 2.0 * LOAD / (PI * a);
  assert_near(a, 0.1465, 1e-4);
  assert_near(p0, 349.5e3, 100.0);
  pw_sim *sim = cylinder();
  contact m = {0};
  while (m.force < LOAD) {
    test_run_to(sim, sim->time + 0.002);
    m = measure(sim);
    assert_true(sim->time < 3.0);
  }
  print_message(
      "%.3f s, W = %.0f N/m: a = %.4f m by the moment, outermost site at %.4f m, exact %.4f m; "
      "p0 = %.1f kPa, exact %.1f kPa\n",
      sim->time, m.force, m.width, m.far, a, 1e-3 * m.peak, 1e-3 * p0);
  assert_relative(m.peak, p0, 0.1);
  assert_near(m.width, a, CELL);
  assert_near(m.far, a, CELL);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pressure_is_hertz),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
