/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tangent times a direction against central differences of the internal force: 40 elements in
 * five patches of a cube, displaced at random, a second time on top of a first committed step, so
 * that the points are prestressed and, on the mesh put back, no longer where they began. */
#include "tests/tet_helpers.h"

enum { NODES = 26 }; /* of the cube: 8 corners, 12 edges and 6 faces; the centre has none */

typedef struct {
  double poisson, yield, hardening;
  pw_fbar fbar;
  pw_tet_rule rule;
} variant;

/* Displacement vectors by node and the vectors of equations by number. */
static void to_equations(const pw_tet_model *m, const double *nodal, double *out)
{
  for (pw_idx i = 0; i < 3 * NODES; i++) {
    if (m->equation[i] >= 0) {
      out[m->equation[i]] = nodal[i];
    }
  }
}

static double worst_error(pw_tet_model *m, const double *u, uint64_t *seed)
{
  double d[3 * NODES], moved[3 * NODES], up[3 * NODES], x[3 * NODES], product[3 * NODES];
  double difference[3 * NODES], worst = 0.0;
  const double h = 2e-6;
  for (int trial = 0; trial < 3; trial++) {
    double error = 0.0, size = 0.0;
    test_displace(NODES, 1.0, seed, d);
    for (int side = 1; side >= -1; side -= 2) {
      for (int i = 0; i < 3 * NODES; i++) {
        moved[i] = u[i] + side * h * d[i];
      }
      assert_ok(pw_tet_model_evaluate(m, moved, false));
      for (int i = 0; i < 3 * NODES; i++) {
        up[i] = side > 0 ? m->force[i] : (up[i] - m->force[i]) / (2.0 * h);
      }
    }
    assert_ok(pw_tet_model_evaluate(m, u, true));
    to_equations(m, d, x);
    to_equations(m, up, difference);
    pw_csr_multiply(&m->csr, x, product);
    for (int i = 0; i < m->csr.n; i++) {
      error += (product[i] - difference[i]) * (product[i] - difference[i]);
      size += difference[i] * difference[i];
    }
    worst = fmax(worst, sqrt(error / size));
  }
  return worst;
}

/* Largest difference between K and its transpose, over the largest value. */
static double asymmetry(const pw_csr *k)
{
  static double full[3 * NODES][3 * NODES];
  double most = 0.0, size = 0.0;
  memset(full, 0, sizeof full);
  for (pw_idx i = 0; i < k->n; i++) {
    for (pw_off l = k->start[i]; l < k->start[i + 1]; l++) {
      full[i][k->col[l]] = k->value[l];
    }
  }
  for (int i = 0; i < k->n; i++) {
    for (int j = 0; j < k->n; j++) {
      most = fmax(most, fabs(full[i][j] - full[j][i]));
      size = fmax(size, fabs(full[i][j]));
    }
  }
  return most / size;
}

static void check(const variant *v)
{
  pw_tet_box box = test_cube(1, 2.0, 5, 10);
  pw_tet_mesh mesh = test_box_mesh(&box);
  pw_tet_material vm = test_von_mises(1e3, v->poisson, "yield_radius_pa", v->yield, v->hardening);
  pw_tet_model m = test_model(&mesh, &vm, v->rule, v->fbar);
  uint64_t seed = 17;
  double u[3 * NODES];
  assert_int_equal(mesh.tets.nnode, NODES);
  assert_int_equal(mesh.tets.nelem, 40);
  assert_ok(pw_tet_model_begin(&m));
  test_displace(NODES, 0.05, &seed, u);
  for (int i = 0; i < 3 * NODES; i++) {
    double x = mesh.x[i];
    u[i] = x == 0.0 || x == 2.0 ? 0.0 : u[i]; /* along the faces only: points stay inside */
  }
  assert_ok(pw_tet_model_evaluate(&m, u, false));
  pw_tet_model_commit(&m, u);
  assert_ok(pw_tet_model_begin(&m));
  test_displace(NODES, 0.05, &seed, u);
  assert_ok(pw_tet_model_evaluate(&m, u, false));
  int plastic = 0;
  for (pw_idx i = 0; i < m.points.n; i++) {
    plastic += m.points.state_trial[i] > m.points.state[i];
  }
  double error = worst_error(&m, u, &seed), skew = asymmetry(&m.csr);
  print_message("nu %g yield %g H %g F-bar %d rule %d: %d of %d points plastic, error %.2g, "
                "asymmetry %.2g\n",
                v->poisson, v->yield, v->hardening, (int)v->fbar, (int)v->rule, plastic,
                (int)m.points.n, error, skew);
  assert_true(error <= 1e-8);
  assert_true(v->fbar != PW_FBAR_NONE || skew < 1e-13);
  assert_true(v->fbar == PW_FBAR_NONE || skew > 1e-8);
  assert_int_equal(plastic, v->yield > 1e3 ? 0 : m.points.n);
  pw_tet_model_destroy(&m);
  pw_tet_mesh_destroy(&mesh);
}

static void tangent_is_that_of_the_force(void **state)
{
  (void)state;
  const double poisson[] = {0.3, 0.4999};
  for (int p = 0; p < 2; p++) {
    for (int f = PW_FBAR_NONE; f <= PW_FBAR_TOTAL; f++) {
      variant v = {.poisson = poisson[p], .fbar = (pw_fbar)f, .rule = PW_TET_RULE_FOUR};
      v.yield = 1e6; /* elastic */
      check(&v);
      v.yield = 0.5; /* every point yields */
      check(&v);
      v.hardening = 50.0;
      check(&v);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tangent_is_that_of_the_force),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
