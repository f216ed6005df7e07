/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a UMAT is told, as it tells it back, and what it may do to its arguments: order of the
 * components, engineering shears, rotation, deformation gradients, times, names, Abaqus' own
 * routines, stiffness. */
#include "kernels/tensor.h"
#include "tests/engine_helpers.h"
#include "tests/umat_helpers.h"

static const double pi = 3.14159265358979323846;

static pw_scene_material spy(int nstatv)
{
  pw_scene_material m = umat_material("umat_spy_", 0.0, 0.0);
  umat_number(&m, "nstatv", nstatv);
  umat_word(&m, "cmname", "SPY");
  return m;
}

static const pw_real *statev(const pw_element *el)
{
  return el->state + PW_UMAT_OWN;
}

static void strains_come_in_order_with_engineering_shears(void **state)
{
  (void)state;
  pw_scene_material m = spy(24);
  pw_element el = umat_element(&m, 0.0);
  const pw_real de[6] = {1e-4, 2e-4, 3e-4, 4e-4, 5e-4, 6e-4}, none[6] = {0};
  assert_ok(pw_element_move(&el, de, NULL, NULL));
  for (int c = 0; c < 6; c++) {
    assert_true(statev(&el)[c] == 0.0); /* STRAN is that of the start */
  }
  assert_ok(pw_element_move(&el, none, NULL, NULL));
  const double want[6] = {1e-4, 2e-4, 3e-4, 8e-4, 12e-4, 10e-4}; /* 11 22 33 12 13 23 */
  const double lambda = 1e7 * 0.3 / (1.3 * 0.4), shear = 1e7 / 2.6;
  for (int c = 0; c < 6; c++) {
    assert_near(statev(&el)[c], want[c], 1e-18);
    assert_relative(el.stress[c], 2.0 * shear * de[c] + (c < 3 ? lambda * 6e-4 : 0.0), 1e-14);
  }
  assert_near(statev(&el)[6], 1.0, 0.0); /* times, length, increment, step */
  assert_near(statev(&el)[7], 1.0, 0.0);
  assert_near(statev(&el)[8], 1.0, 0.0);
  assert_near(statev(&el)[9], 2.0, 0.0);
  assert_near(statev(&el)[10], 1.0, 0.0);
  assert_near(statev(&el)[23], 80.5, 0.0); /* length of CMNAME, its text and blanks */
}

/* Points that take long steps are told when those begin, whether they end with a cycle or are
 * ended early, because points change blocks. */
static void long_steps_begin_at_their_time(void **state)
{
  (void)state;
  static pw_scene s;
  pw_scene_default(&s);
  s.method.block_elements = 8;
  s.method.step_ratio_max = 4;
  s.time.cfl = 0.5;
  test_grid(&s, (pw_real[]){0.0, 2.0, 0.0, 0.1}, 0.025);
  s.material[s.nmaterial++] = spy(24);
  const int stiff = test_elastic(&s, 4e8, 0.3, 1800.0);
  test_rectangle(&s, stiff, (pw_real[]){0.4, 1.0, 0.0, 0.1}, 0.0125)->velocity_m_s[0] = -30.0;
  test_rectangle(&s, 0, (pw_real[]){1.0, 1.8, 0.0, 0.1}, 0.0125);
  pw_sim *sim = test_sim(&s, 1);
  const pw_points *p = &sim->points;
  int stretched = 0, joined = 0;
  for (int k = 0; k < 90; k++) {
    const pw_off before = sim->step;
    assert_ok(pw_sim_step(sim, 0.0));
    const bool early = sim->sort_needed && sim->step - before < 4;
    for (pw_idx i = 0; i < p->n; i++) {
      const pw_real *told = p->state + (pw_off)PW_UMAT_OWN * p->ld + i;
      const pw_real dt = told[8 * p->ld];
      if (p->body[i] == 1) {
        assert_near(told[6 * p->ld] + dt, sim->time, 1e-14);
        assert_near(told[7 * p->ld] + dt, sim->time, 1e-14);
        stretched += dt > 3.5 * sim->dt;
        joined += early && dt > 1.5 * sim->dt;
      }
    }
  }
  assert_true(stretched > 0 && joined > 0);
  pw_sim_destroy(&sim);
}

static void rotation_and_gradients_belong_together(void **state)
{
  (void)state;
  pw_scene_material m = spy(24);
  pw_element el = umat_element(&m, 0.0);
  const pw_real de[6] = {0.1, -0.05, 0, 0.02, 0, 0}, none[6] = {0}, spin[3] = {0.3, 0, 0};
  assert_ok(pw_element_move(&el, de, NULL, NULL));
  const pw_element before = el;
  assert_ok(pw_element_move(&el, none, spin, NULL));
  /* W_xy = (dvx/dy - dvy/dx)/2 = 0.3: clockwise by 2 atan(0.15), x' = R x */
  const double c = cos(2.0 * atan(0.15)), s = sin(2.0 * atan(0.15));
  const double drot[4] = {c, -s, s, c}; /* 11, 21, 12, 22 */
  for (int k = 0; k < 4; k++) {
    const int at[4] = {0, 3, 1, 4}; /* of F in rows */
    assert_near(statev(&el)[11 + k], drot[k], 1e-15);
    assert_near(statev(&el)[15 + k], before.f[at[k]], 1e-14);
    assert_near(statev(&el)[19 + k], el.f[at[k]], 1e-14);
  }
  /* total strain turned with the material, as a tensor */
  pw_rot r = pw_rot_hughes_winget(0.3, 0.0, 0.0);
  pw_t6 e = pw_t6_rotate(r, pw_t6_load(de, 1));
  assert_near(statev(&el)[0], e.xx, 1e-15);
  assert_near(statev(&el)[1], e.yy, 1e-15);
  assert_near(statev(&el)[3], 2.0 * e.xy, 1e-15);
}

/* Ten turns about an inclined axis leave the stress as the material sees it. */
static void turning_leaves_stress_and_listed_tensors(void **state)
{
  (void)state;
  const double first[1] = {1}, second[1] = {7};
  const double initial[12] = {1, 2, 3, 4, 5, 6, 1, 2, 3, 8, 10, 12};
  pw_scene_material m = umat_material("umat_elastic_", 0.0, 0.0);
  umat_number(&m, "nstatv", 12);
  umat_list(&m, "statev_initial", 12, initial);
  umat_list(&m, "statev_stress_tensors", 1, first);
  umat_list(&m, "statev_strain_tensors", 1, second);
  const pw_real stress[6] = {1, 2, 3, 4, 6, 5}, none[6] = {0}; /* the same tensor: yz, zx */
  pw_element el;
  assert_ok(pw_element_start(&el, m.model, m.param, stress));
  const int steps = 500;
  const double angle = 20.0 * pi / steps;
  const pw_real spin[3] = {0.48 * angle, -0.64 * angle, 0.6 * angle};
  const int same[6] = {0, 1, 2, 3, 5, 4};
  for (int i = 0; i < steps; i++) {
    assert_ok(pw_element_move(&el, none, spin, NULL));
    for (int c = 0; c < 6; c++) {
      assert_near(statev(&el)[c], el.stress[same[c]], 1e-11);
      assert_near(statev(&el)[6 + c] / (c < 3 ? 1.0 : 2.0), el.stress[same[c]], 1e-11);
    }
  }
  assert_near(el.stress[0] + el.stress[1] + el.stress[2], 6.0, 1e-10);
  pw_t6 t = pw_t6_load(el.stress, 1);
  assert_relative(pw_t6_norm(t), sqrt(14.0 + 2.0 * 77.0), 1e-10);
}

static void routines_may_spoil_their_arguments(void **state)
{
  (void)state;
  pw_scene_material good = umat_material("umat_", 5e4, 5e5);
  pw_scene_material bad = umat_material("umat_careless_", 5e4, 5e5);
  pw_element a = umat_element(&good, 1e5), b = umat_element(&bad, 1e5);
  uint64_t seed = 5;
  for (int i = 0; i < 200; i++) {
    pw_real de[6], spin[3] = {1e-2, 2e-2, -1e-2};
    for (int c = 0; c < 6; c++) {
      de[c] = 2e-3 * (test_random(&seed) - 0.5);
    }
    assert_ok(pw_element_move(&a, de, spin, NULL));
    assert_ok(pw_element_move(&b, de, spin, NULL));
    assert_memory_equal(a.stress, b.stress, sizeof a.stress);
    assert_memory_equal(a.state, b.state, sizeof a.state);
  }
}

static void abaqus_routines_are_there(void **state)
{
  (void)state;
  pw_scene_material m = umat_material("umat_utilities_", 0.0, 0.0);
  umat_number(&m, "nstatv", 20);
  pw_element el = umat_element(&m, 0.0);
  const pw_real none[6] = {0};
  assert_ok(pw_element_move(&el, none, NULL, NULL));
  const pw_real *v = statev(&el);
  assert_near(v[0], 2.0, 1e-15); /* mean; q of (-1, 0, 1) and shears 4, 5, 6 */
  assert_relative(v[1], sqrt(1.5 * (2.0 + 2.0 * 77.0)), 1e-14);
  /* principal values: trace, sum of squares, determinant 1 (6 - 36) - 4 (12 - 30) + 5 (24 - 10) */
  assert_near(v[2] + v[3] + v[4], 6.0, 1e-12);
  assert_relative(v[2] * v[2] + v[3] * v[3] + v[4] * v[4], 14.0 + 2.0 * 77.0, 1e-12);
  assert_relative(v[2] * v[3] * v[4], 112.0, 1e-12);
  assert_near(v[5], 1.0, 1e-14);
  /* a quarter turn about 3 takes e1 to e2: 22 -> 11, 12 -> -12, 13 -> 23, 23 -> -13 */
  const double turned[6] = {2, 1, 3, -4, -6, 5};
  for (int c = 0; c < 6; c++) {
    assert_near(v[6 + c], turned[c], 1e-14);
    assert_near(v[12 + c], turned[c], 1e-14);
  }
}

/* The tangent's order, and the speed of waves: exact for an isotropic stiffness. */
static void stiffness_gives_tangent_and_wave_speed(void **state)
{
  (void)state;
  pw_scene_material m = umat_material("umat_", 5e4, 5e5);
  pw_element el = umat_element(&m, 1e5);
  const pw_real small[6] = {1e-7, 0, 0, 0, 0, 0};
  assert_ok(pw_element_move(&el, small, NULL, NULL));
  const double modulus = 1e7 * 0.7 / (1.3 * 0.4);
  assert_relative(el.wave_speed, sqrt(modulus / el.density), 1e-13);
  const pw_real de[6] = {3e-3, -1e-3, 2e-3, 4e-3, -2e-3, 1e-3};
  pw_element base = el, plus, minus;
  pw_real tangent[36];
  assert_ok(pw_element_move(&base, de, NULL, tangent));
  assert_true(base.state[PW_UMAT_OWN] > 1e-3);
  assert_true(base.wave_speed > 0.99 * sqrt(modulus / base.density)); /* softer, but may unload */
  for (int j = 0; j < 6; j++) {
    pw_real d[6];
    const double h = 1e-7;
    memcpy(d, de, sizeof d);
    d[j] = de[j] + h;
    plus = minus = el;
    assert_ok(pw_element_move(&plus, d, NULL, NULL));
    d[j] = de[j] - h;
    assert_ok(pw_element_move(&minus, d, NULL, NULL));
    for (int i = 0; i < 6; i++) {
      double slope = (plus.stress[i] - minus.stress[i]) / (2.0 * h * (j < 3 ? 1.0 : 2.0));
      assert_near(tangent[6 * i + j], slope, 1e-6 * modulus);
    }
  }
  umat_number(&m, "stiffness_bound_pa", 9e7);
  el = umat_element(&m, 0.0);
  assert_ok(pw_element_move(&el, small, NULL, NULL));
  assert_relative(el.wave_speed, sqrt(9e7 / el.density), 1e-14);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(strains_come_in_order_with_engineering_shears),
      cmocka_unit_test(long_steps_begin_at_their_time),
      cmocka_unit_test(rotation_and_gradients_belong_together),
      cmocka_unit_test(turning_leaves_stress_and_listed_tensors),
      cmocka_unit_test(routines_may_spoil_their_arguments),
      cmocka_unit_test(abaqus_routines_are_there),
      cmocka_unit_test(stiffness_gives_tangent_and_wave_speed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
