/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rules for points: volumes add up, monomials up to the stated degree are exact (on the unit
 * tetrahedron the integral of x^a y^b z^c is a! b! c! / (a + b + c + 3)!), owners are unique. */
#include "tests/tet_helpers.h"

static double factorial(int n)
{
  return n < 2 ? 1.0 : n * factorial(n - 1);
}

static void rules_integrate_polynomials(void **state)
{
  (void)state;
  const struct {
    const char *name;
    int points, degree;
  } rules[] = {{"one", 1, 1},
               {"four", 4, 2},
               {"eleven_equal", 11, 1},
               {"eleven_keast", 11, 4},
               {"twenty", 20, 2}};
  for (int r = 0; r < 5; r++) {
    double place[20][4], part[20];
    pw_tet_rule rule;
    assert_true(pw_tet_rule_find(rules[r].name, &rule));
    assert_int_equal(pw_tet_rule_points(rule, place, part), rules[r].points);
    for (int abc = 0; abc < 125; abc++) {
      int a = abc % 5, b = abc / 5 % 5, c = abc / 25;
      double sum = 0.0;
      for (int i = 0; i < rules[r].points; i++) {
        assert_near(place[i][0] + place[i][1] + place[i][2] + place[i][3], 1.0, 1e-15);
        sum += part[i] / 6.0 * pow(place[i][1], a) * pow(place[i][2], b) * pow(place[i][3], c);
      }
      double exact = factorial(a) * factorial(b) * factorial(c) / factorial(a + b + c + 3);
      if (a + b + c <= rules[r].degree) {
        assert_near(sum, exact, 1e-15);
      }
    }
  }
  pw_tet_rule none;
  assert_false(pw_tet_rule_find("five", &none));
}

static void points_fill_the_mesh(void **state)
{
  (void)state;
  const int per[5] = {1, 4, 11, 11, 20};
  pw_tet_box box = test_cube(2, 2.0, 5, 10);
  pw_tet_mesh mesh = test_box_mesh(&box);
  pw_tet_material vm = test_von_mises(1e3, 0.0, "yield_radius_pa", 400.0, 0.0);
  for (int whole = 0; whole < 2; whole++) {
    for (int rule = 0; rule < 5; rule++) {
      pw_tet_fill fill = {.rule = (pw_tet_rule)rule,
                          .per_patch = whole,
                          .allow_negative = true,
                          .nmaterial = 1,
                          .material = &vm};
      pw_tet_points p;
      assert_ok(pw_tet_points_create(&mesh, &fill, &p));
      assert_int_equal(p.n, per[rule] * 40 * (whole ? 1 : 8));
      double sum = 0.0;
      for (pw_idx i = 0; i < p.n; i++) {
        double x[3] = {p.x[i], p.x[p.ld + i], p.x[2 * p.ld + i]};
        sum += p.volume[i];
        assert_true(pw_tets_hold(&mesh.tets, p.elem[i], x));
        for (pw_idx e = p.elem[i] / 8 * 8; e < p.elem[i] && whole; e++) {
          assert_false(pw_tets_hold(&mesh.tets, e, x)); /* the lowest of its patch */
        }
      }
      assert_near(sum, 8.0, 1e-12);
      pw_tet_points_destroy(&p);
    }
  }
  pw_tet_mesh_destroy(&mesh);
}

static void expect(const pw_tet_mesh *mesh, const pw_tet_fill *fill, pw_status code,
                   const char *text)
{
  pw_tet_points p;
  assert_int_equal(pw_tet_points_create(mesh, fill, &p), code);
  if (!strstr(pw_error_text(), text)) {
    fail_msg("\"%s\" does not say \"%s\"", pw_error_text(), text);
  }
}

static void bad_fills_are_named(void **state)
{
  (void)state;
  pw_tet_box box = test_cube(1, 2.0, 5, 4);
  pw_tet_mesh mesh = test_box_mesh(&box);
  pw_tet_material vm = test_von_mises(1e3, 0.0, "yield_radius_pa", 400.0, 0.0), bad = vm;
  pw_idx body[5] = {0, 1, 0, 0, 0}, empty[5] = {-1, -1, -1, -1, -1};
  pw_tet_fill fill = {.rule = PW_TET_RULE_ELEVEN_KEAST, .nmaterial = 1, .material = &vm};
  expect(&mesh, &fill, PW_ERR_ARGUMENT, "negative volumes have to be asked for");
  fill.rule = PW_TET_RULE_FOUR;
  fill.per_patch = true;
  expect(&mesh, &fill, PW_ERR_ARGUMENT, "the mesh is of linear ones");
  fill.per_patch = false;
  fill.body = body;
  expect(&mesh, &fill, PW_ERR_ARGUMENT, "cell 1 is of material 1 of 1");
  fill.body = empty;
  expect(&mesh, &fill, PW_ERR_ARGUMENT, "0 points in a mesh");
  fill.body = NULL;
  bad.param[0] = -1.0;
  fill.material = &bad;
  expect(&mesh, &fill, PW_ERR_SCENE, "youngs_modulus_pa");
  pw_tet_mesh_destroy(&mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rules_integrate_polynomials),
      cmocka_unit_test(points_fill_the_mesh),
      cmocka_unit_test(bad_fills_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
