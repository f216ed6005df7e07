/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A block of 2 m x 0.5 m on an incline (C4) with both contacts, and the energy audit of its slide (C12).
 * Reference: a = g (sin 30 - mu cos 30), g = 10 m/s2; sticks for mu > tan 30 = 0.57735. */
#include "tests/contact_helpers.h"

static const pw_real G = 10.0, SINE = 0.5, COSINE = 0.86602540378443864676;

/* A stiff block on a rigid plane; gravity grows over 0.1 s in its tilted direction. */
static pw_sim *incline(test_contact kind, pw_real friction, pw_real damping, pw_real ramp)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  test_grid(&s, (pw_real[]){-1.0, 4.0, -0.5, 1.0}, 0.25);
  int material = test_elastic(&s, 2e6, 0.0, 1000.0);
  test_rectangle(&s, material, (pw_real[]){-1.0, 4.0, -0.5, 0.0}, 0.125);
  test_rectangle(&s, material, (pw_real[]){-0.5, 1.5, 0.0, 0.5}, 0.125);
  pw_gravity_param *gravity = pw_scene_add_effect(&s, "gravity");
  gravity->acceleration_m_s2 = G;
  gravity->ramp_s = ramp;
  gravity->tilt_deg = 30.0;
  test_add_contact(&s, kind, 0, 1, friction, 2e7, 0.125);
  if (damping > 0.0) {
    pw_damping_local_param *d = pw_scene_add_effect(&s, "damping_local");
    d->body = 1;
    d->coefficient = damping;
  }
  test_hold(&s, 0);
  return test_sim(&s, 1);
}

static pw_real speed(const pw_sim *sim)
{
  pw_real sum[5];
  test_body_sums(sim, 1, sum);
  return sum[1] / sum[0];
}

/* Mean acceleration between 0.3 s and 0.9 s. */
static pw_real acceleration(test_contact kind, pw_real friction)
{
  pw_sim *sim = incline(kind, friction, 0.0, 0.1);
  test_run_to(sim, 0.3);
  pw_real v = speed(sim);
  test_run_to(sim, 0.9);
  pw_real a = (speed(sim) - v) / 0.6;
  pw_sim_destroy(&sim);
  return a;
}

static void slides_as_coulomb_says(void **state)
{
  (void)state;
  const pw_real friction[3] = {0.0, 0.3, 0.57};
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    for (int i = 0; i < 3; i++) {
      pw_real exact = G * (SINE - friction[i] * COSINE), a = acceleration(kind, friction[i]);
      print_message("%s, mu = %.2f: a = %.5f, exact %.5f\n", test_contact_name[kind], friction[i],
                    a, exact);
      assert_near(a, exact, 0.005 * G * (SINE - 0.3 * COSINE));
    }
  }
}

static void sticks_above_the_friction_angle(void **state)
{
  (void)state;
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    pw_sim *sim = incline(kind, 0.58, 0.5, 0.5);
    test_run_to(sim, 1.0);
    pw_real v = speed(sim);
    print_message("%s, mu = 0.58: v = %.3e m/s at 1 s\n", test_contact_name[kind], v);
    assert_true(fabs(v) < 1e-6 * G * 1.0);
    pw_sim_destroy(&sim);
  }
}

/* External work = kinetic + strain + spring + friction, friction = mu N s. */
static void energy_is_accounted_for(void **state)
{
  (void)state;
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    pw_report r;
    pw_real from[5], to[5];
    pw_sim *sim = incline(kind, 0.3, 0.0, 0.1);
    test_body_sums(sim, 1, from);
    test_run_to(sim, 0.9);
    test_body_sums(sim, 1, to);
    pw_sim_report(sim, &r);
    const pw_energy *e = &r.energy;
    pw_real balance = e->external - e->kinetic - e->strain_work - e->spring - e->contact;
    print_message("%s: external %.2f kinetic %.2f strain %.3f spring %.3f contact %.2f J, "
                  "balance %.3f %%\n",
                  test_contact_name[kind], e->external, e->kinetic, e->strain_work, e->spring,
                  e->contact, 100.0 * balance / e->external);
    assert_true(fabs(balance) < 0.01 * e->external);
    pw_real friction = 0.3 * 1000.0 * G * COSINE * (to[3] - from[3]);
    assert_relative(e->contact, friction, 0.02);
    pw_sim_destroy(&sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(slides_as_coulomb_says),
      cmocka_unit_test(sticks_above_the_friction_angle),
      cmocka_unit_test(energy_is_accounted_for),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
