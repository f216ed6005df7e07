/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mass, centre and inertia of rigid bodies against closed forms, and their motion: free, turning,
 * under forces, given. */
#include "tests/structure_helpers.h"

static pw_scene scene;

static pw_structure create(void)
{
  pw_structure s = {0};
  assert_ok(pw_structure_create(&scene, 0, 0.01, &s));
  return s;
}

/* Solids of revolution: cylinder, half spheroid 2/3 V (centre 5/8 of its height from its pole),
 * cone 1/3 V (3/4). */
static void masses_of_piles_are_exact(void **state)
{
  (void)state;
  const double part[3] = {0.0, 2.0 / 3.0, 1.0 / 3.0}, centre[3] = {0.0, 0.625, 0.75};
  const double plane[3] = {0.0, PI / 4.0, 0.5},
               plane_centre[3] = {0.0, 1.0 - 4.0 / (3.0 * PI), 2.0 / 3.0};
  const double R = 0.15, L = 5.0;
  for (int tip = 0; tip < 3; tip++) {
    double h = tip == PW_TIP_FLAT ? 0.0 : 0.25;
    for (int kind = PW_BODY_RIGID; kind <= PW_BODY_ROD; kind++) {
      for (int axi = 0; axi < 2; axi++) {
        pw_scene_body *b = test_structure(&scene, axi ? PW_AXI : PW_PLANE, kind, tip);
        b->tip_length_m = h;
        pw_structure s = create();
        double com[6], section = axi ? 0.5 * R * R : 2.0 * R;
        double vt = (axi ? part : plane)[tip] * section * h, vs = section * (L - h);
        double yt = (axi ? centre : plane_centre)[tip] * h, ys = 0.5 * (L + h);
        pw_structure_centre(&s, com);
        assert_relative(com[5], 2500.0 * (vt + vs), 1e-13);
        assert_relative(com[1], 3.0 + (vt * yt + vs * ys) / (vt + vs), 1e-13);
        assert_near(com[0], 0.0, 1e-15);
        assert_near(pw_structure_tip(&s), 3.0, 1e-14);
        pw_structure_destroy(&s);
      }
    }
  }
}

static void inertia_is_that_of_the_shape(void **state)
{
  (void)state;
  const double R = 0.15, L = 5.0;
  test_structure(&scene, PW_AXI, PW_BODY_RIGID, PW_TIP_FLAT);
  pw_structure s = create();
  double m = s.rigid.mass;
  assert_relative(s.rigid.inertia[0], m * (3 * R * R + L * L) / 12, 1e-13);
  assert_relative(s.rigid.inertia[1], m * R * R / 2, 1e-13);
  pw_structure_destroy(&s);
  pw_scene_body *b = test_structure(&scene, PW_PLANE, PW_BODY_RIGID, PW_TIP_FLAT);
  s = create();
  assert_relative(s.rigid.inertia[2], s.rigid.mass * (4 * R * R + L * L) / 12, 1e-13);
  pw_structure_destroy(&s);
  b->shape = PW_SHAPE_DISC;
  b->centre_m[0] = 0.3;
  b->centre_m[1] = 4.0;
  s = create();
  assert_relative(s.rigid.mass, 2500 * PI * R * R, 1e-13);
  assert_relative(s.rigid.inertia[2], s.rigid.mass * R * R / 2, 1e-11);
  assert_near(s.rigid.x[0], 0.3, 0.0);
  assert_near(s.rigid.x[1], 4.0, 1e-14);
  pw_structure_destroy(&s);
  b->mass_kg = 7.0;
  s = create();
  assert_relative(s.rigid.mass, 7.0, 1e-14);
  assert_relative(s.rigid.inertia[2], 7.0 * R * R / 2, 1e-11);
  pw_structure_destroy(&s);
  b = test_structure(&scene, PW_AXI, PW_BODY_RIGID, PW_TIP_FLAT);
  b->shape = PW_SHAPE_RECTANGLE;
  memcpy(b->x_m, (pw_real[]){0.2, 0.5}, sizeof b->x_m);
  memcpy(b->y_m, (pw_real[]){1.0, 3.0}, sizeof b->y_m);
  b->mass_kg = 2 * PI * 11.0;
  s = create();
  assert_relative(s.rigid.mass, 11.0, 1e-14);
  assert_relative(s.rigid.inertia[1], 11.0 * (0.25 + 0.04) / 2, 1e-13); /* of a tube */
  assert_relative(s.head_area, (0.25 - 0.04) / 2, 1e-14);
  pw_structure_destroy(&s);
}

/* Without forces: the centre on a line, every place of the surface on its circle, no change of
 * energy, however long. */
static void a_free_body_turns_and_flies(void **state)
{
  (void)state;
  pw_scene_body *b = test_structure(&scene, PW_PLANE, PW_BODY_RIGID, PW_TIP_CONICAL);
  memcpy(b->velocity_m_s, (pw_real[]){0.25, -0.5}, sizeof b->velocity_m_s);
  pw_structure s = create();
  const double y0 = s.rigid.x[1], spin = 3.0, dt = 1.0 / 128.0;
  s.rigid.spin[2] = spin;
  double before = pw_structure_kinetic(&s), worst = 0.0;
  for (int k = 1; k <= 100000; k++) {
    test_structure_step(&s, dt, 0.0, NULL);
    if (k % 1000 == 0) {
      double t = k * dt, c = cos(spin * t), w = sin(spin * t);
      for (int i = 0; i < s.line.n; i += 50) {
        double x = s.line_x0[2 * i], y = s.line_x0[2 * i + 1] - y0;
        worst = pw_max(worst, fabs(s.line.node[i].x[0] - (0.25 * t + c * x - w * y)));
        worst = pw_max(worst, fabs(s.line.node[i].x[1] - (y0 - 0.5 * t + w * x + c * y)));
        assert_near(s.line.node[i].v[0], 0.25 - spin * (w * x + c * y), 1e-9);
      }
    }
  }
  print_message("places after 1e5 steps off by %.2g m\n", worst);
  assert_true(worst < 1e-9);
  assert_near(pw_structure_kinetic(&s), before, 0.0);
  pw_structure_destroy(&s);
}

/* A force at a place of the surface changes momentum by F dt and spin by its moment; axisymmetric
 * bodies feel its axial part only. */
static void forces_push_and_turn(void **state)
{
  (void)state;
  const double f[2] = {30.0, -20.0}, dt = 0.01;
  for (int axi = 0; axi < 2; axi++) {
    test_structure(&scene, axi ? PW_AXI : PW_PLANE, PW_BODY_RIGID, PW_TIP_ROUNDED);
    pw_structure s = create();
    const pw_real *a = s.line.node[9].x, *b = s.line.node[10].x;
    double x = 0.7 * a[0] + 0.3 * b[0], y = 0.7 * a[1] + 0.3 * b[1] - s.rigid.x[1];
    double m = s.rigid.mass, inertia = s.rigid.inertia[2];
    pw_structure_clear(&s);
    pw_structure_add_force(&s, 9, 0.3, f);
    pw_structure_kick(&s, dt, NULL);
    pw_structure_drift(&s, dt);
    assert_near(s.rigid.v[0], axi ? 0.0 : dt * f[0] / m, 1e-15);
    assert_near(s.rigid.v[1], dt * f[1] / m, 1e-15);
    assert_near(s.rigid.spin[2], axi ? 0.0 : dt * (x * f[1] - y * f[0]) / inertia, 1e-15);
    assert_near(s.work, 0.0, 0.0);
    pw_structure_destroy(&s);
  }
}

static void a_given_motion_tells_force_and_work(void **state)
{
  (void)state;
  test_structure(&scene, PW_PLANE, PW_BODY_RIGID, PW_TIP_FLAT);
  pw_structure s = create();
  const double given[2] = {1.0, -2.0}, dt = 0.01, f[2] = {500.0, 4000.0}, m = s.rigid.mass;
  for (int k = 0; k < 2; k++) {
    pw_structure_clear(&s);
    pw_structure_add_force(&s, 0, 0.5, f);
    pw_structure_kick(&s, dt, given);
    pw_structure_drift(&s, dt);
    for (int a = 0; a < 2; a++) { /* first it must also gain its momentum */
      assert_relative(s.reaction[a], (k == 0 ? m * given[a] / dt : 0.0) - f[a], 1e-13);
    }
    double work = -dt * (f[0] * given[0] + f[1] * given[1]) * (k == 0 ? 0.5 : 1.0);
    assert_relative(s.given_work, work + (k == 0 ? pw_structure_kinetic(&s) : 0.0), 1e-12);
    assert_near(s.rigid.spin[2], 0.0, 0.0);
  }
  pw_structure_destroy(&s);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(masses_of_piles_are_exact),
      cmocka_unit_test(inertia_is_that_of_the_shape),
      cmocka_unit_test(a_free_body_turns_and_flies),
      cmocka_unit_test(forces_push_and_turn),
      cmocka_unit_test(a_given_motion_tells_force_and_work),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
