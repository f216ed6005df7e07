/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Limits of the corner contact: no friction, no tangential force (C13); overlap in equilibrium as
 * the stated stiffness says, error ~ 1 / stiffness (C9); an overlap at the start is harmless
 * (E21); adhesion and shear limit; energy through an impact (C8); master as points and as a rigid
 * structure. */
#include "engine/effects/contact_corner.h"
#include "tests/contact_helpers.h"

static const pw_real G = 10.0, WIDTH = 1.0, HEIGHT = 0.5, DENSITY = 1000.0, YOUNGS = 2e6;

/* A block with its lower face at `bottom` over a plate that is held: of points, or rigid. */
static pw_scene *block(bool rigid, pw_real bottom, pw_real speed)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  test_grid(&s, (pw_real[]){-1.0, 2.0, -0.5, 1.5}, 0.25);
  int material = test_elastic(&s, YOUNGS, 0.0, DENSITY);
  test_rectangle(&s, material, (pw_real[]){-1.0, 2.0, -0.5, 0.0}, 0.125);
  test_rectangle(&s, material, (pw_real[]){0.0, WIDTH, bottom, bottom + HEIGHT}, 0.125);
  s.body[0].kind = rigid ? PW_BODY_RIGID : PW_BODY_POINTS;
  s.body[1].velocity_m_s[1] = -speed;
  test_add_contact(&s, TEST_CORNER, 0, 1, 0.3, 0.0, 0.0);
  test_hold(&s, 0);
  return &s;
}

static pw_contact_corner_param *contact_of(pw_scene *s)
{
  return (pw_contact_corner_param *)pw_scene_find_effect(s, "contact_corner");
}

static void settle(pw_scene *s, pw_real acceleration, pw_real tilt)
{
  pw_gravity_param *gravity = pw_scene_add_effect(s, "gravity");
  gravity->acceleration_m_s2 = acceleration;
  gravity->ramp_s = 0.3;
  gravity->tilt_deg = tilt;
  pw_damping_local_param *d = pw_scene_add_effect(s, "damping_local");
  d->body = 1;
  d->coefficient = 0.5;
}

static void without_friction_nothing_pulls_along(void **state)
{
  (void)state;
  pw_scene *s = block(false, 0.0, 0.0);
  contact_of(s)->friction = 0.0;
  settle(s, G, 20.0);
  pw_sim *sim = test_sim(s, 1);
  test_run_to(sim, 0.5);
  const pw_contact_tally *t = pw_contact_tally_of(sim);
  assert_true(t->pairs > 0 && t->force[PW_REACTION_Y] < -1000.0);
  assert_near(t->force[PW_REACTION_X], 0.0, 1e-12 * fabs(t->force[PW_REACTION_Y]));
  pw_sim_destroy(&sim);
}

/* Weight per area over stiffness per area; the default states factor x E / half a domain. */
static void overlap_is_pressure_over_stiffness(void **state)
{
  (void)state;
  const pw_real pressure = DENSITY * G * HEIGHT;
  pw_real last = 0.0;
  for (int rigid = 0; rigid < 2; rigid++) {
    for (int k = 0; k < 4; k++) {
      pw_scene *s = block(rigid == 1, 0.0, 0.0);
      contact_of(s)->normal_stiffness_pa_m = k == 0 ? 0.0 : 2e5 * pow(10.0, k);
      settle(s, G, 0.0);
      pw_sim *sim = test_sim(s, 1);
      test_run_to(sim, 1.5);
      const pw_corner *c = pw_sim_effect_ctx(sim, "contact_corner");
      pw_real stiffness = k == 0 ? 0.2 * YOUNGS / 0.0625 : 2e5 * pow(10.0, k);
      pw_real mean = 0.0, area = 0.0;
      for (pw_idx q = 0; q < c->npair; q++) {
        mean += c->pair[q].area * c->pair[q].overlap;
        area += c->pair[q].area;
      }
      print_message("%s, %.1e Pa/m: overlap %.5g m, expected %.5g m\n", rigid ? "rigid" : "points",
                    stiffness, mean / area, pressure / stiffness);
      assert_relative(mean / area, pressure / stiffness, 0.01);
      assert_near(area, WIDTH, 0.01);
      if (k > 1) { /* rate -1 */
        assert_near(log10(last / (mean / area)), 1.0, 0.02);
      }
      last = mean / area;
      pw_sim_destroy(&sim);
    }
  }
}

static pw_real result_of(const pw_sim *sim, const char *name)
{
  static pw_record r;
  pw_sim_results(sim, &r);
  for (int k = 0; k < r.n; k++) {
    if (strcmp(r.item[k].name, name) == 0) {
      return r.item[k].value;
    }
  }
  fail_msg("no %s among the results", name);
  return 0.0;
}

/* The factor's default is relative to the present modulus: for a linear elastic block constant. */
static void stiffness_is_stated(void **state)
{
  (void)state;
  pw_scene *s = block(false, 0.0, 0.5);
  pw_sim *sim = test_sim(s, 1);
  test_run_to(sim, 0.02);
  assert_relative(result_of(sim, "contact_stiffness_max_pa_m"), 0.2 * YOUNGS / 0.0625, 0.05);
  pw_sim_destroy(&sim);
}

/* Clay 440 times as soft in its upper half as at its foot meets a wall: the soft part is held by a
 * fiftieth of the stiffness at the foot, as the key says, not by a 440th. */
static void soft_soil_is_held_by_a_fiftieth_of_the_stiffest(void **state)
{
  (void)state;
  const pw_real strength = 100.0, gradient = 1e5, rigidity = 100.0;
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  test_grid(&s, (pw_real[]){-0.5, 1.0, 0.0, 1.0}, 0.25);
  int clay = test_material(&s, "tresca");
  test_param(&s, clay, "undrained_shear_strength_pa", strength);
  test_param(&s, clay, "undrained_shear_strength_gradient_pa_m", gradient);
  test_param(&s, clay, "rigidity_index", rigidity);
  test_param(&s, clay, "poisson_ratio", 0.25);
  test_param(&s, clay, "density_kg_m3", DENSITY);
  test_param(&s, clay, "reference_y_m", 0.5);
  test_rectangle(&s, clay, (pw_real[]){-0.5, 0.0, 0.0, 1.0}, 0.125);
  test_rectangle(&s, clay, (pw_real[]){0.0, 0.5, 0.0, 1.0}, 0.125);
  s.body[0].kind = PW_BODY_RIGID;
  s.body[1].velocity_m_s[0] = -0.001;
  test_add_contact(&s, TEST_CORNER, 0, 1, 0.0, 0.0, 0.0);
  test_hold(&s, 0);
  pw_sim *sim = test_sim(&s, 1);
  test_run_to(sim, 0.01);
  const pw_real shear =
      rigidity * (strength + gradient * (0.5 - 0.0625)); /* at the lowest points */
  const pw_real modulus = 3.0 * shear;                   /* K + 4 G / 3 with a ratio of 0.25 */
  assert_relative(result_of(sim, "contact_stiffness_max_pa_m"), 0.2 * modulus / 0.0625, 1e-3);
  assert_relative(result_of(sim, "contact_stiffness_min_pa_m"), 0.004 * modulus / 0.0625, 1e-3);
  pw_sim_destroy(&sim);
}

/* As the test of the same name for interface lines; 1.6 and 3.2 segments, up to 1.6 domains. */
static void overlap_at_rest_stays_at_rest(void **state)
{
  (void)state;
  for (int k = 1; k <= 2; k++) {
    pw_sim *sim = test_sim(block(false, -0.1 * k, 0.0), 1);
    const pw_corner *c = pw_sim_effect_ctx(sim, "contact_corner");
    pw_real sum[5];
    test_run_to(sim, 0.1);
    test_body_sums(sim, 1, sum);
    assert_near(hypot(sum[1], sum[2]), 0.0, 0.0);
    assert_near(c->tally.overlap_max, 0.1 * k, 1e-12); /* but it is reported */
    assert_near(c->offset_max, 0.1 * k, 1e-12);
    pw_sim_destroy(&sim);
  }
}

/* A sunk block leaves on the side it came in by, not faster than it came. */
static void leaves_no_faster_than_it_came(void **state)
{
  (void)state;
  const pw_real speed = 0.5;
  for (int k = 1; k <= 2; k++) {
    pw_sim *sim = test_sim(block(false, -0.1 * k, speed), 1);
    pw_real sum[5] = {0.0}, fastest = 0.0, sideways = 0.0;
    while (sim->time < 0.5) {
      assert_ok(pw_sim_step(sim, 0.0));
      test_body_sums(sim, 1, sum);
      fastest = pw_max(fastest, sum[2] / sum[0]);
      sideways = pw_max(sideways, fabs(sum[1] / sum[0]));
    }
    print_message("%.1f m deep, came with %.2f m/s, left with %.3f m/s, sideways %.1e m/s\n",
                  0.1 * k, speed, fastest, sideways);
    assert_true(fastest > 0.5 * speed && fastest <= 1.01 * speed);
    assert_true(sideways < 0.01 * speed);
    pw_sim_destroy(&sim);
  }
}

/* On an incline of 30 degrees without friction but with adhesion a: a = g sin - adhesion / (rho h);
 * a limit of shear stress caps friction likewise. */
static void strength_limits_the_shear(void **state)
{
  (void)state;
  for (int kind = 0; kind < 2; kind++) {
    pw_scene *s = block(false, 0.0, 0.0);
    pw_contact_corner_param *p = contact_of(s);
    p->friction = kind == 0 ? 0.0 : 0.5;
    p->adhesion_pa = kind == 0 ? 1000.0 : 0.0;
    p->shear_limit_pa = kind == 0 ? 0.0 : 1000.0;
    pw_gravity_param *gravity = pw_scene_add_effect(s, "gravity");
    gravity->acceleration_m_s2 = G;
    gravity->tilt_deg = 30.0;
    gravity->ramp_s = 0.3;
    pw_sim *sim = test_sim(s, 1);
    pw_real a[5], b[5];
    test_run_to(sim, 0.35);
    test_body_sums(sim, 1, a);
    test_run_to(sim, 0.6);
    test_body_sums(sim, 1, b);
    pw_real exact = 0.5 * G - 1000.0 / (DENSITY * HEIGHT);
    print_message("%s: a = %.4f, exact %.4f m/s2\n", kind == 0 ? "adhesion" : "shear limit",
                  (b[1] - a[1]) / a[0] / 0.25, exact);
    assert_relative((b[1] - a[1]) / a[0] / 0.25, exact, 0.01);
    pw_sim_destroy(&sim);
  }
}

/* A block that slides 1 cm above the plate, within the reach of adhesion or beyond it: it is held back
 * by its strength, and by nothing along the normal; or not at all. What it loses is dissipated. */
static void adhesion_reaches_as_far_as_it_is_told(void **state)
{
  (void)state;
  for (int kind = 0; kind < 2; kind++) {
    pw_scene *s = block(false, 0.01, 0.0);
    pw_contact_corner_param *p = contact_of(s);
    p->friction = 0.3;
    p->adhesion_pa = 1000.0;
    p->adhesion_gap_m = kind == 0 ? 0.02 : 0.005;
    s->body[1].velocity_m_s[0] = 1.0;
    pw_sim *sim = test_sim(s, 1);
    pw_real a[5], b[5];
    test_run_to(sim, 0.02);
    test_body_sums(sim, 1, a);
    pw_real lost = sim->energy.contact;
    test_run_to(sim, 0.06); /* before it has tilted much */
    test_body_sums(sim, 1, b);
    pw_real exact = kind == 0 ? -1000.0 / (DENSITY * HEIGHT) : 0.0, way = b[3] - a[3];
    print_message("reach %.3f m: a = %.4f, exact %.4f m/s2, normal %.1e m/s\n", p->adhesion_gap_m,
                  (b[1] - a[1]) / a[0] / 0.04, exact, b[2] / b[0]);
    assert_near((b[1] - a[1]) / a[0] / 0.04, exact, 0.02);
    assert_near(b[2] / b[0], 0.0, 0.01);
    /* Tilting, its lower face falls behind its centre by up to 5 % of the way. */
    assert_near(sim->energy.contact - lost, kind == 0 ? 1000.0 * WIDTH * way : 0.0,
                0.05 * 1000.0 * way);
    pw_sim_destroy(&sim);
  }
}

/* Error of the energy of a block that falls on the plate and rebounds, relative. */
static pw_real impact_error(bool rigid, int phase, pw_real cfl)
{
  pw_scene *s = block(rigid, 0.02 + 0.0005 * phase, 1.0);
  s->time.cfl = cfl;
  pw_sim *sim = test_sim(s, 1);
  const pw_energy *e = &sim->energy;
  const pw_contact_tally *t = pw_contact_tally_of(sim);
  do {
    assert_ok(pw_sim_step(sim, 0.0));
  } while (sim->time < 0.03 || t->pairs > 0);
  pw_real sum[5], error = (e->kinetic + e->strain_work + e->contact) / e->initial - 1.0;
  test_body_sums(sim, 1, sum);
  assert_true(sum[2] > 0.9 * sum[0]);
  pw_sim_destroy(&sim);
  return error;
}

/* All corners of a flat face meet the plate in the same step: the worst case for the step's error,
 * whose sign depends on the phase at which the overlap is first seen. With a quarter of the step
 * it is below 1 % at each phase (C8), with the default step in the mean. */
static void impact_keeps_energy(void **state)
{
  (void)state;
  enum { PHASES = 8 };
  for (int rigid = 0; rigid < 2; rigid++) {
    pw_real mean = 0.0, worst = 0.0, fine = 0.0;
    for (int phase = 0; phase < PHASES; phase++) {
      pw_real error = impact_error(rigid == 1, phase, 0.4);
      mean += error / PHASES;
      worst = pw_max(worst, fabs(error));
      fine = pw_max(fine, fabs(impact_error(rigid == 1, phase, 0.1)));
    }
    print_message("%s: error of energy %.2f %% in the mean, %.2f %% at most; quarter "
                  "step %.2f %%\n",
                  rigid ? "rigid" : "points", 100.0 * mean, 100.0 * worst, 100.0 * fine);
    assert_true(fabs(mean) < 0.01 && worst < 0.03 && fine < 0.01);
  }
}

/* A rod of 1/100 of the block's density, pushed into it by its head: all its other nodes are free,
 * and the springs on them need shorter steps. */
static void a_driven_rod_is_resolved(void **state)
{
  (void)state;
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  test_grid(&s, (pw_real[]){-1.0, 1.0, -1.0, 1.0}, 0.125);
  test_rectangle(&s, test_elastic(&s, 1e6, 0.3, DENSITY), (pw_real[]){-1.0, 1.0, -1.0, 0.0},
                 0.0625);
  s.body[s.nbody++] = (pw_scene_body){.name = "rod",
                                      .material = test_elastic(&s, 1e6, 0.3, 0.01 * DENSITY),
                                      .kind = PW_BODY_ROD,
                                      .shape = PW_SHAPE_PILE,
                                      .radius_m = 0.2,
                                      .length_m = 0.5,
                                      .tip = PW_TIP_ROUNDED,
                                      .rod_elements = 40};
  test_add_contact(&s, TEST_CORNER, 1, 0, 0.0, 0.0, 0.0);
  pw_prescribed_motion_param *motion = pw_scene_add_effect(&s, "prescribed_motion");
  motion->body = 1;
  motion->velocity_m_s[1] = -1.0;
  pw_boundary_param *bottom = pw_scene_add_effect(&s, "boundary");
  bottom->side = PW_SIDE_BOTTOM;
  bottom->fix_y = true;
  pw_sim *sim = test_sim(&s, 1);
  test_run_to(sim, 0.03);
  const pw_energy *e = &sim->energy;
  pw_real error = e->kinetic + e->strain_work + e->spring + e->contact - e->initial - e->external;
  const pw_contact_tally *t = pw_contact_tally_of(sim);
  print_message("%lld steps, force %.0f N, error of energy %.2f J of %.0f J\n",
                (long long)sim->step, t->force[PW_REACTION_Y], error, e->external);
  assert_true(t->pairs > 0 && t->force[PW_REACTION_Y] > 1000.0);
  assert_near(error, 0.0, 0.02 * (e->initial + e->external));
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(without_friction_nothing_pulls_along),
      cmocka_unit_test(overlap_is_pressure_over_stiffness),
      cmocka_unit_test(stiffness_is_stated),
      cmocka_unit_test(soft_soil_is_held_by_a_fiftieth_of_the_stiffest),
      cmocka_unit_test(overlap_at_rest_stays_at_rest),
      cmocka_unit_test(leaves_no_faster_than_it_came),
      cmocka_unit_test(strength_limits_the_shear),
      cmocka_unit_test(adhesion_reaches_as_far_as_it_is_told),
      cmocka_unit_test(impact_keeps_energy),
      cmocka_unit_test(a_driven_rod_is_resolved),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
