/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A material of F in implicit steps: points keep b of F-bar. Tangent against central differences on
 * top of a committed step, and a stretch in two steps against the closed form. */
#include "tests/harness.h"
#include "tests/solid_helpers.h"

enum { NODES = 26 }; /* of a cube of five ten-node tetrahedra */

static void stay(const void *ctx, pw_real *x)
{
  (void)ctx, (void)x;
}

static void start(solid *s, double bulk, pw_fbar fbar)
{
  pw_tet_box box = {.bricks = {1, 1, 1}, .high = {2.0, 2.0, 2.0}, .per_brick = 5, .nodes = 10};
  memset(s, 0, sizeof *s);
  s->rule = PW_TET_RULE_FOUR;
  s->material.model = pw_material_find("neo_hookean");
  solid_set(&s->material, "bulk_modulus_pa", bulk);
  solid_set(&s->material, "shear_modulus_pa", 80.0);
  solid_set(&s->material, "density_kg_m3", 1.0);
  assert_ok(solid_mesh(&box, stay, NULL, &s->mesh));
  assert_ok(solid_start(s, fbar, 1, NULL));
  assert_int_equal(s->nnode, NODES);
}

/* Random displacements, none at all on two faces when @p inside. */
static void shake(const solid *s, bool inside, uint64_t *seed, double *u)
{
  for (pw_idx i = 0; i < 3 * NODES; i++) {
    const double x = s->x[i];
    u[i] = 0.05 * (2.0 * test_random(seed) - 1.0);
    u[i] = inside && (x == 0.0 || x == 2.0) ? 0.0 : u[i];
  }
}

static double tangent_error(solid *s, const double *u, uint64_t *seed)
{
  static double d[3 * NODES], moved[3 * NODES], slope[3 * NODES], product[3 * NODES];
  static double by_equation[3 * NODES];
  const double h = 2e-6;
  double error = 0.0, size = 0.0;
  shake(s, false, seed, d);
  for (int side = 1; side >= -1; side -= 2) {
    for (int i = 0; i < 3 * NODES; i++) {
      moved[i] = u[i] + side * h * d[i];
    }
    assert_ok(pw_tet_model_evaluate(&s->model, moved, false));
    for (int i = 0; i < 3 * NODES; i++) {
      slope[i] = side > 0 ? s->model.force[i] : (slope[i] - s->model.force[i]) / (2.0 * h);
    }
  }
  assert_ok(pw_tet_model_evaluate(&s->model, u, true));
  for (int i = 0; i < 3 * NODES; i++) {
    by_equation[s->model.equation[i]] = d[i];
  }
  pw_csr_multiply(&s->model.csr, by_equation, product);
  for (int i = 0; i < 3 * NODES; i++) {
    const double off = product[s->model.equation[i]] - slope[i];
    error += off * off;
    size += slope[i] * slope[i];
  }
  return sqrt(error / size);
}

static void tangent_is_that_of_the_force(void **state)
{
  (void)state;
  const double bulk[] = {170.0, 4e5}; /* nu = 0.3 and 0.4999 */
  for (int k = 0; k < 2; k++) {
    for (int f = PW_FBAR_NONE; f <= PW_FBAR_TOTAL; f++) {
      solid s;
      uint64_t seed = 23;
      double u[3 * NODES];
      start(&s, bulk[k], (pw_fbar)f);
      assert_ok(pw_tet_model_begin(&s.model));
      shake(&s, true, &seed, u);
      assert_ok(pw_tet_model_evaluate(&s.model, u, false));
      pw_tet_model_commit(&s.model, u);
      assert_ok(pw_tet_model_begin(&s.model));
      shake(&s, false, &seed, u);
      double error = tangent_error(&s, u, &seed);
      print_message("K %g, F-bar %d: error %.2g\n", bulk[k], f, error);
      assert_true(error <= 1e-8);
      solid_end(&s);
    }
  }
}

/* J sigma = lambda ln J 1 + mu (b - 1) after two steps of stretching, 1.2 and 1.25 along y. */
static void stretches_multiply(void **state)
{
  (void)state;
  solid s;
  start(&s, 170.0, PW_FBAR_INCREMENT);
  const double factor[] = {1.2, 1.25}, lambda = 170.0 - 2.0 / 3.0 * 80.0, stretch = 1.5;
  const pw_tet_points *p = &s.model.points;
  double u[3 * NODES];
  for (int k = 0; k < 2; k++) {
    const pw_real map[9] = {1, 0, 0, 0, k == 0 ? 1.2 : 1.5, 0, 0, 0, 1}, shift[3] = {0};
    assert_ok(pw_tet_model_begin(&s.model));
    for (pw_idx i = 0; i < 3 * NODES; i++) {
      u[i] = i / NODES == 1 ? (factor[k] - 1.0) * s.mesh.x[i] : 0.0;
    }
    assert_ok(pw_tet_model_evaluate(&s.model, u, false));
    pw_tet_model_commit(&s.model, u);
    assert_ok(pw_tet_mesh_move(&s.mesh, map, shift));
  }
  for (pw_idx i = 0; i < p->n; i++) {
    const double across = lambda * log(stretch) / stretch;
    assert_relative(p->stress[i], across, 1e-12);
    assert_relative(p->stress[p->ld + i], across + 80.0 * (stretch * stretch - 1.0) / stretch,
                    1e-12);
  }
  solid_end(&s);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tangent_is_that_of_the_force),
      cmocka_unit_test(stretches_multiply),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
