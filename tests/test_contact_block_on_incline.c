/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A block of 2 m x 0.5 m on an incline (C4) with both contacts, and the energy audit of its slide (C12).
 * Reference: a = g (sin 30 - mu cos 30), g = 10 m/s2; sticks for mu > tan 30 = 0.57735. */
#include "tests/contact_helpers.h"

static const pw_real G = 10.0, SINE = 0.5, COSINE = 0.86602540378443864676;

/* A stiff block on a rigid plane; gravity grows over 0.5 s in its tilted direction, slowly against
 * the period of the block on its springs, 0.03 s. */
static pw_sim *incline(test_contact kind, pw_real friction, pw_real damping)
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
  gravity->ramp_s = 0.5;
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

static pw_real place(const pw_sim *sim)
{
  pw_real sum[5];
  test_body_sums(sim, 1, sum);
  return sum[3];
}

/* Mean acceleration between 0.6 s and 1 s. */
static pw_real acceleration(test_contact kind, pw_real friction)
{
  pw_sim *sim = incline(kind, friction, 0.0);
  test_run_to(sim, 0.6);
  pw_real v = speed(sim);
  test_run_to(sim, 1.0);
  pw_real a = (speed(sim) - v) / 0.4;
  pw_sim_destroy(&sim);
  return a;
}

static void slides_as_coulomb_says(void **state)
{
  (void)state;
  const pw_real friction[2] = {0.0, 0.3};
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    for (int i = 0; i < 2; i++) {
      pw_real exact = G * (SINE - friction[i] * COSINE), a = acceleration(kind, friction[i]);
      print_message("%s, mu = %.2f: a = %.5f, exact %.5f\n", test_contact_name[kind], friction[i],
                    a, exact);
      assert_relative(a, exact, 0.005);
    }
  }
}

/* Mean speed of the block between 1 s and 2 s, by its displacement. Local damping is of no use
 * with the frictional contact: it sees the nodes' forces without those of the contact. */
static pw_real creep(test_contact kind, pw_real friction)
{
  pw_sim *sim = incline(kind, friction, test_acts_on_nodes(kind) ? 0.0 : 0.3);
  test_run_to(sim, 1.0);
  pw_real x = place(sim);
  test_run_to(sim, 2.0);
  pw_real v = place(sim) - x;
  pw_sim_destroy(&sim);
  return v;
}

static void sticks_above_the_friction_angle(void **state)
{
  (void)state;
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    pw_real v = creep(kind, 0.6);
    print_message("%s, mu = 0.60: creep %.2e m/s\n", test_contact_name[kind], v);
    assert_true(fabs(v) < 1e-6 * G * 1.0);
  }
}

/* tan 30 = 0.5774: at 0.57 the block keeps sliding, at 0.58 it comes to rest. Both are damped
 * alike: without damping, sliding this close to the friction angle excites the elastic block. */
static void transition_lies_at_the_friction_angle(void **state)
{
  (void)state;
  pw_real slides = creep(TEST_PENALTY, 0.57), sticks = creep(TEST_PENALTY, 0.58);
  print_message("mu = 0.57: %.2e m/s, mu = 0.58: %.2e m/s\n", slides, sticks);
  assert_true(slides > 1e-3);
  assert_true(fabs(sticks) < 1e-6 * G * 1.5); /* C4: 1e-6 g t, at 1.5 s */
}

/* External work = kinetic + strain + spring + friction (C12), and friction = mu N s. */
static void energy_is_accounted_for(void **state)
{
  (void)state;
  for (int kind = 0; kind < TEST_CONTACTS; kind++) {
    pw_report r;
    pw_sim *sim = incline(kind, 0.3, 0.0);
    test_run_to(sim, 0.6);
    pw_real x = place(sim), lost = sim->energy.contact;
    test_run_to(sim, 1.1);
    pw_sim_report(sim, &r);
    const pw_energy *e = &r.energy;
    pw_real balance = e->external - e->kinetic - e->strain_work - e->spring - e->contact;
    print_message("%s: external %.1f kinetic %.1f strain %.2f spring %.2f contact %.1f J, "
                  "balance %.3f %%\n",
                  test_contact_name[kind], e->external, e->kinetic, e->strain_work, e->spring,
                  e->contact, 100.0 * balance / e->external);
    assert_true(fabs(balance) < 0.01 * e->external);
    pw_real friction = 0.3 * 1000.0 * G * COSINE * (place(sim) - x);
    assert_relative(e->contact - lost, friction, 0.01);
    pw_sim_destroy(&sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(slides_as_coulomb_says),
      cmocka_unit_test(sticks_above_the_friction_angle),
      cmocka_unit_test(transition_lies_at_the_friction_angle),
      cmocka_unit_test(energy_is_accounted_for),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
