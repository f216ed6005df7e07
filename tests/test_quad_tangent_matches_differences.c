/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tangent of implicit steps on the grid times a direction against central differences of the
 * internal force: a block between free sides, displaced at random a second time on top of a first
 * committed part, so that points are under stress, turned, and no longer where they began. Plane
 * strain and axisymmetry, every basis, models of F and in rate form, elastic and plastic. */
#include "engine/effects/solid_params.h"
#include "engine/update.h"
#include "tests/quad_helpers.h"

enum { NODES = 64 };

typedef struct {
  int geometry, basis, material;
  pw_real ghost;
} variant;

static void random_displacement(pw_idx n, double size, uint64_t *seed, double *u)
{
  for (pw_idx i = 0; i < n; i++) {
    u[i] = size * (2.0 * test_random(seed) - 1.0);
  }
}

static void make_scene(const variant *v, pw_scene *s)
{
  const pw_real x = v->geometry == PW_AXI ? 0.0 : -1.0;
  int m = 0;
  test_quad_scene(s, v->geometry, v->basis, (pw_real[]){x, x + 3.0, 0.0, 3.0}, 0.5, 1);
  switch (v->material) {
  case 0:
    m = test_elastic(s, 1e3, 0.3, 1.0);
    break;
  case 1:
    m = test_neo_hookean(s, 2e3, 5e2, 1.0);
    break;
  default:
    m = test_hencky(s, 1e3, 0.4, 1.0, v->material == 2 ? 1e6 : 1.0);
    break;
  }
  test_rectangle(s, m, (pw_real[]){x + 0.55, x + 2.15, 0.6, 2.2}, 0.2);
  if (v->ghost > 0.0) {
    pw_ghost_param *g = pw_scene_add_effect(s, "ghost_stabilisation");
    g->stiffness_pa = v->ghost;
  }
}

static double worst_error(pw_quad_model *m, const double *u, uint64_t *seed)
{
  const pw_idx dofs = 2 * m->csr.nnode;
  static double d[2 * NODES], moved[2 * NODES], up[2 * NODES], x[2 * NODES], product[2 * NODES];
  double worst = 0.0;
  const double h = 2e-6;
  for (int trial = 0; trial < 3; trial++) {
    double error = 0.0, size = 0.0;
    random_displacement(dofs, 1.0, seed, d);
    for (pw_idx i = 0; i < dofs; i++) { /* components without equation stay put */
      d[i] = m->equation[i] >= 0 ? d[i] : 0.0;
    }
    for (int side = 1; side >= -1; side -= 2) {
      for (pw_idx i = 0; i < dofs; i++) {
        moved[i] = u[i] + side * h * d[i];
      }
      assert_ok(pw_quad_model_evaluate(m, moved, false));
      for (pw_idx i = 0; i < dofs; i++) {
        up[i] = side > 0 ? m->force[i] : (up[i] - m->force[i]) / (2.0 * h);
      }
    }
    assert_ok(pw_quad_model_evaluate(m, u, true));
    for (pw_idx i = 0; i < dofs; i++) {
      if (m->equation[i] >= 0) {
        x[m->equation[i]] = d[i];
      }
    }
    pw_csr_multiply(&m->csr, x, product);
    for (pw_idx i = 0; i < dofs; i++) {
      if (m->equation[i] >= 0) {
        const double e = product[m->equation[i]] - up[i];
        error += e * e;
        size += up[i] * up[i];
      }
    }
    worst = fmax(worst, sqrt(error / size));
  }
  return worst;
}

static double check(const variant *v)
{
  static pw_scene scene;
  static double u[2 * NODES];
  uint64_t seed = 23;
  make_scene(v, &scene);
  pw_sim *sim = test_sim(&scene, 1);
  pw_quad_model *m = &sim->quad->model;
  const pw_idx dofs = 2 * sim->mesh.nnode;
  assert_true(sim->mesh.nnode <= NODES);
  for (int part = 0; part < 2; part++) {
    assert_ok(pw_quad_model_begin(m));
    random_displacement(dofs, 0.03, &seed, u);
    for (pw_idx i = 0; i < dofs; i++) {
      u[i] = m->equation[i] >= 0 ? u[i] : 0.0;
    }
    assert_ok(pw_quad_model_evaluate(m, u, false));
    if (part == 0) {
      pw_quad_model_commit(m, u);
      assert_ok(pw_update_collect(sim));
    }
  }
  pw_idx plastic = 0;
  for (pw_idx i = 0; i < sim->points.n && v->material >= 2; i++) {
    plastic += m->state_trial[i] > sim->points.state[i];
  }
  assert_int_equal(plastic, v->material == 3 ? sim->points.n : 0);
  const double error = worst_error(m, u, &seed);
  pw_sim_destroy(&sim);
  return error;
}

static void tangent_is_that_of_the_force(void **state)
{
  (void)state;
  static const char *const material[] = {"linear elastic", "neo-Hookean", "Hencky", "plastic"};
  for (int geometry = PW_PLANE; geometry <= PW_AXI; geometry++) {
    for (int basis = PW_LINEAR; basis <= PW_CPDI; basis++) {
      for (int k = 0; k < 4; k++) {
        const variant v = {geometry, basis, k, k == 1 ? 50.0 : 0.0};
        const double error = check(&v);
        print_message("%s, %s, %s: %.2g\n", geometry == PW_AXI ? "axisymmetric" : "plane strain",
                      test_basis_name[basis], material[k], error);
        assert_true(error <= 1e-8);
      }
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
