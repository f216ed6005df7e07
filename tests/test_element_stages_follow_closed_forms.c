/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stages of element tests on elastic soil: every kind of control against Hooke's law in rate form
 * (stress over logarithmic strain), by strain and by stress, drained and not. */
#include "engine/element_test.h"
#include "tests/material_helpers.h"

static const double young = 1e7, nu = 0.3;

/** The last row of a test. */
typedef struct last {
  pw_element el;
  double pore;
  int rows;
} last;

static pw_status keep(void *ctx, const pw_element_row *row)
{
  last *l = ctx;
  l->el = *row->el;
  l->pore = row->pore_pa;
  l->rows++;
  return PW_OK;
}

static last run(pw_element_stage stage, double pressure)
{
  test_material m = test_material_of("linear_elastic");
  test_set(&m, "youngs_modulus_pa", young);
  test_set(&m, "poisson_ratio", nu);
  test_set(&m, "density_kg_m3", 2000.0);
  static pw_element_test t;
  memset(&t, 0, sizeof t);
  t.material.model = m.model;
  memcpy(t.material.param, m.v, sizeof m.v);
  for (int c = 0; c < 3; c++) {
    t.stress_pa[c] = -pressure;
  }
  t.nstage = 1;
  t.stage[0] = stage;
  t.stage[0].cycles = t.stage[0].cycles > 0 ? t.stage[0].cycles : 1;
  t.stage[0].steps = 10;
  last l = {.rows = 0};
  assert_ok(pw_element_test_run(&t, keep, &l));
  return l;
}

static pw_element_stage by_strain(int kind, bool drained, double to)
{
  return (pw_element_stage){.kind = kind, .drained = drained, .to_strain = {1, {to}}};
}

static pw_element_stage by_stress(int kind, bool drained, double to)
{
  return (pw_element_stage){.kind = kind, .drained = drained, .to_stress_pa = {1, {to}}};
}

static void compression(void **unused)
{
  (void)unused;
  const double bulk = young / (3 * (1 - 2 * nu)), shear = young / (2 * (1 + nu));
  last l = run(by_strain(PW_STAGE_ISOTROPIC, true, -0.01), 1e5);
  assert_int_equal(l.rows, 11);
  assert_relative(l.el.stress[0], -1e5 - 3 * bulk * 0.01, 1e-9);
  l = run(by_stress(PW_STAGE_ISOTROPIC, true, -3e5), 1e5);
  assert_relative(l.el.strain[1], -2e5 / (3 * bulk), 1e-7);
  l = run(by_stress(PW_STAGE_OEDOMETRIC, true, -3e5), 1e5);
  assert_relative(l.el.strain[1], -2e5 / (bulk + 4 * shear / 3), 1e-7);
  assert_near(l.el.strain[0], 0.0, 0.0);
  l = run(by_strain(PW_STAGE_OEDOMETRIC, true, -0.02), 1e5);
  assert_relative(l.el.stress[0], -1e5 - 0.02 * (bulk - 2 * shear / 3), 1e-9);
}

static void triaxial(void **unused)
{
  (void)unused;
  const double shear = young / (2 * (1 + nu));
  last l = run(by_strain(PW_STAGE_TRIAXIAL, true, -0.02), 1e5);
  assert_relative(l.el.stress[1], -1e5 - 0.02 * young, 1e-7);
  assert_relative(l.el.strain[0], 0.02 * nu, 1e-6);
  l = run(by_stress(PW_STAGE_TRIAXIAL, true, -2e5), 1e5);
  assert_relative(l.el.strain[1], -1e5 / young, 1e-6);
  /* undrained: s_a - s_r = 3 G e; the mean effective stress rests, so u = change of s_r */
  l = run(by_strain(PW_STAGE_TRIAXIAL, false, -0.02), 1e5);
  assert_relative(l.el.stress[1] - l.el.stress[0], -0.02 * 3 * shear, 1e-9);
  assert_relative(l.pore, l.el.stress[0] + 1e5, 1e-12);
  assert_relative(l.pore, 0.02 * shear, 1e-9);
  l = run(by_stress(PW_STAGE_TRIAXIAL, false, -1.6e5), 1e5);
  assert_relative(l.el.strain[1], -6e4 / (3 * shear), 1e-6);
  assert_relative(l.el.stress[1] - l.pore, -1.6e5, 1e-8);
}

static void plane_strain(void **unused)
{
  (void)unused;
  const double shear = young / (2 * (1 + nu)), plane = young / (1 - nu * nu);
  last l = run(by_strain(PW_STAGE_BIAXIAL, true, -0.02), 1e5);
  assert_relative(l.el.stress[1], -1e5 - 0.02 * plane, 1e-7);
  assert_near(l.el.strain[2], 0.0, 0.0);
  l = run(by_stress(PW_STAGE_BIAXIAL, false, -1.6e5), 1e5);
  assert_relative(l.el.strain[1], -6e4 / (4 * shear), 1e-6);
}

/** Small strains: the Jaumann rate turns the stress by gamma/2, of second order here. */
static void simple_shear(void **unused)
{
  (void)unused;
  const double shear = young / (2 * (1 + nu));
  last l = run(by_stress(PW_STAGE_SIMPLE_SHEAR, false, 1e3), 1e5);
  assert_relative(l.el.stress[3], 1e3, 1e-8);
  assert_relative(2 * l.el.strain[3], 1e3 / shear, 1e-3);
  l = run(by_strain(PW_STAGE_SIMPLE_SHEAR, true, 1e-3), 1e5);
  assert_relative(l.el.stress[3], 1e-3 * shear, 1e-3);
  assert_relative(l.el.stress[1], -1e5, 1e-7);
}

static void mixed_there_and_back(void **unused)
{
  (void)unused;
  pw_element_stage stage = {.kind = PW_STAGE_MIXED,
                            .mixed_stress = {6, {1, 0, 1, 1, 0, 1}},
                            .mixed_target = {6, {-2e5, -0.01, -1e5, 3e4, 0.002, 0}}};
  last l = run(stage, 1e5);
  double yy = young * -0.01 + nu * -1e5; /* changes: xx by -1e5, zz none */
  assert_relative(l.el.stress[1], -1e5 + yy, 1e-7);
  assert_relative(l.el.strain[3], 3e4 * (1 + nu) / young, 1e-6);
  assert_relative(l.el.strain[0], (-1e5 - nu * yy) / young, 1e-6);
  assert_relative(l.el.stress[4], 0.002 * young / (1 + nu), 1e-9);
  stage.cycles = 2;
  l = run(stage, 1e5);
  assert_int_equal(l.rows, 41);
  for (int c = 0; c < 6; c++) {
    assert_near(l.el.stress[c], c < 3 ? -1e5 : 0.0, 1e-2);
    assert_near(l.el.strain[c], 0.0, 1e-9);
  }
}

static void cycles_repeat_turning_points(void **unused)
{
  (void)unused;
  pw_element_stage stage = {
      .kind = PW_STAGE_TRIAXIAL, .drained = true, .cycles = 3, .to_strain = {2, {-0.01, 0.01}}};
  last l = run(stage, 1e5);
  assert_int_equal(l.rows, 61);
  assert_near(l.el.strain[1], 0.01, 1e-12);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(compression),          cmocka_unit_test(triaxial),
      cmocka_unit_test(plane_strain),         cmocka_unit_test(simple_shear),
      cmocka_unit_test(mixed_there_and_back), cmocka_unit_test(cycles_repeat_turning_points)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
