/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An elastic rod without points: its modes, its energy over 1e5 steps, d'Alembert's waves of a
 * struck pile (free toe: v_head 2, 2, 6, 6 and v_toe 0, 4, 4, 8 m/s at 0.01, 0.03, 0.06, 0.09 s,
 * then 8 m/s), steps far beyond its own stable step, a head whose velocity is given. */
#include "tests/structure_helpers.h"

static pw_scene scene;

static void create(int elements, pw_structure *s)
{
  pw_scene_body *b = test_structure(&scene, PW_AXI, PW_BODY_ROD, PW_TIP_FLAT);
  b->rod_elements = elements;
  *s = (pw_structure){0};
  assert_ok(pw_structure_create(&scene, 0, 0.1, s));
}

/* Free ends: mode k of the chain of equal masses, halves at the ends, is cos(k pi i / n) with
 * omega = 2 c / h sin(k pi / 2 n); the midpoint rule turns it by 2 atan(omega dt / 2) a step. */
static void a_free_rod_vibrates_in_its_modes(void **state)
{
  (void)state;
  enum { N = 40, STEPS = 1000 };
  const double h = 5.0 / N, dt = 3e-4;
  for (int mode = 1; mode <= 3; mode++) {
    pw_structure s;
    create(N, &s);
    for (int i = 0; i <= N; i++) {
      s.rod.u[i] = 1e-3 * cos(mode * PI * i / N);
    }
    for (int i = 0; i < N; i++) {
      s.rod.stretch[i] = s.rod.u[i + 1] - s.rod.u[i];
    }
    double omega = 2 * 200.0 / h * sin(mode * PI / (2 * N)), turn = 2 * atan(omega * dt / 2);
    assert_relative(omega, mode * PI * 200.0 / 5.0, 0.003); /* the bar's own: k pi c / L */
    for (int k = 1; k <= STEPS; k++) {
      test_structure_step(&s, dt, 0.0, NULL);
      if (k % 100 == 0) {
        for (int i = 0; i <= N; i += 5) {
          assert_near(s.rod.u[i], 1e-3 * cos(mode * PI * i / N) * cos(k * turn), 1e-13);
        }
      }
    }
    pw_structure_destroy(&s);
  }
}

static void energy_is_kept_for_1e5_steps(void **state)
{
  (void)state;
  const double step[2] = {1e-4, 6.25e-3}; /* 0.16 and 10 times h / c */
  for (int c = 0; c < 2; c++) {
    pw_structure s;
    uint64_t seed = 7;
    create(40, &s);
    for (int i = 0; i <= 40; i++) {
      s.rod.v[i] = test_random(&seed) - 0.5;
    }
    double momentum = 0.0, start = pw_structure_kinetic(&s), worst = 0.0;
    double com[6], largest = 0.0;
    pw_structure_centre(&s, com);
    momentum = com[3];
    for (int k = 0; k < 100000; k++) {
      test_structure_step(&s, step[c], 0.0, NULL);
      double now = pw_structure_kinetic(&s) + pw_structure_strain(&s);
      worst = pw_max(worst, fabs(now / start - 1.0));
      largest = pw_max(largest, fabs(s.rod.v[20]));
    }
    pw_structure_centre(&s, com);
    print_message("dt %g s: energy off by %.2g, velocity of the centre by %.2g m/s\n", step[c],
                  worst, com[3] - momentum);
    assert_true(worst < 1e-10);
    assert_near(com[3], momentum, 1e-12);
    assert_true(largest < 10.0);
    pw_structure_destroy(&s);
  }
}

/* Pressure 1 MPa on the head for 0.1 s = 4 L / c. */
static void a_struck_pile_follows_dalembert(void **state)
{
  (void)state;
  enum { N = 200 };
  const double dt = 5e-5, time[5] = {0.01, 0.03, 0.06, 0.09, 0.12};
  const double head[5] = {2, 2, 6, 6, 8}, toe[5] = {0, 4, 4, 8, 8}, mid[5] = {0, 1e6, 0, 0, 0};
  pw_structure s;
  create(N, &s);
  double area = s.head_area, work = 0.0, arrival = 0.0;
  assert_relative(area, 0.5 * 0.15 * 0.15, 1e-14);
  for (int k = 0, c = 0; c < 5; k++) {
    test_structure_step(&s, dt, k * dt < 0.1 - 1e-9 ? -1e6 * area : 0.0, NULL);
    work += s.work;
    double toe_now = -s.rod.v[0];
    if (arrival == 0.0 && toe_now >= 2.0) {
      arrival = (k + 1) * dt;
    }
    if ((k + 1) * dt > time[c] - 1e-9) {
      double p = 0.0, vh = 0.0, vt = 0.0; /* means over 0.25 m: grid waves ride on the steps */
      for (int i = 0; i < 10; i++) {
        p -= 0.1 * 1e8 * s.rod.stretch[N / 2 + i - 5] / s.rod.length;
        vh -= 0.1 * s.rod.v[N - i];
        vt -= 0.1 * s.rod.v[i];
      }
      if (mid[c] > 0.0 || c == 0) {
        assert_near(p, mid[c], 0.05 * 1e6);
      }
      assert_near(vh, head[c], 0.1);
      assert_near(vt, toe[c], 0.1);
      c++;
    }
  }
  double com[6];
  pw_structure_centre(&s, com);
  print_message("toe reaches half its jump at %.5f s; centre %.12f m/s after the pulse\n", arrival,
                com[3]);
  assert_near(arrival, 0.025, 0.01 * 0.025);
  assert_near(com[3], -8.0, 1e-10);
  assert_relative(pw_structure_kinetic(&s) + pw_structure_strain(&s), work, 1e-11);
  pw_structure_destroy(&s);
}

/* The same with a step of 20 h / c: quieter ends, the same momentum. */
static void a_large_step_keeps_the_impulse(void **state)
{
  (void)state;
  pw_structure s;
  create(200, &s);
  for (int k = 0; k < 80; k++) {
    test_structure_step(&s, 2.5e-3, k < 40 ? -1e6 * s.head_area : 0.0, NULL);
    for (int i = 0; i <= 200; i++) {
      assert_true(fabs(s.rod.v[i]) < 2500.0);
    }
  }
  double com[6];
  pw_structure_centre(&s, com);
  assert_near(com[3], -8.0, 1e-10);
  pw_structure_destroy(&s);
}

/* A head pushed at 2 m/s needs rho c v = 1 MPa until the echo of the free toe returns after
 * 2 L / c, and the work it does is the rod's energy. */
static void a_given_head_pushes_with_the_impedance(void **state)
{
  (void)state;
  pw_structure s;
  const double dt = 5e-5, given[2] = {0.0, -2.0};
  double work = 0.0, impulse = 0.0, com[6];
  create(200, &s);
  for (int k = 0; k < 900; k++) {
    test_structure_step(&s, dt, 0.0, given);
    work += s.given_work;
    impulse += dt * s.reaction[1];
    assert_near(s.rod.v[200], -2.0, 1e-12);
    assert_near(s.line.node[s.line.n - 1].v[1], -2.0, 1e-12);
  }
  assert_relative(impulse / (900 * dt), -1e6 * s.head_area, 0.01);
  pw_structure_centre(&s, com);
  assert_relative(impulse, com[3] * com[5], 1e-11);
  assert_relative(pw_structure_kinetic(&s) + pw_structure_strain(&s), work, 1e-11);
  pw_structure_destroy(&s);
}

/* A force on the surface is that on the rod: same power. */
static void forces_on_the_surface_reach_the_rod(void **state)
{
  (void)state;
  pw_structure s;
  uint64_t seed = 3;
  pw_scene_body *b = test_structure(&scene, PW_AXI, PW_BODY_ROD, PW_TIP_ROUNDED);
  b->rod_elements = 37;
  s = (pw_structure){0};
  assert_ok(pw_structure_create(&scene, 0, 0.01, &s));
  for (int i = 0; i <= 37; i++) {
    s.rod.v[i] = test_random(&seed) - 0.5;
  }
  pw_structure_drift(&s, 0.0);
  double power = 0.0, on_rod = 0.0, sum = 0.0, total = 0.0;
  for (int k = 0; k < pw_interface_segments(&s.line); k++) {
    double xi = test_random(&seed), f[2] = {test_random(&seed), test_random(&seed) - 0.5};
    pw_structure_add_force(&s, k, xi, f);
    power += f[1] * ((1 - xi) * s.line.node[k].v[1] + xi * s.line.node[k + 1].v[1]);
    total += f[1];
  }
  for (int i = 0; i <= 37; i++) {
    on_rod += s.rod.force[i] * s.rod.v[i];
    sum += s.rod.force[i];
  }
  assert_near(on_rod, power, 1e-12);
  assert_near(sum, total, 1e-12);
  pw_structure_destroy(&s);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_free_rod_vibrates_in_its_modes),
      cmocka_unit_test(energy_is_kept_for_1e5_steps),
      cmocka_unit_test(a_struck_pile_follows_dalembert),
      cmocka_unit_test(a_large_step_keeps_the_impulse),
      cmocka_unit_test(a_given_head_pushes_with_the_impedance),
      cmocka_unit_test(forces_on_the_surface_reach_the_rod),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
