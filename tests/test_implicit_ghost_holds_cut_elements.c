/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ghost stabilisation: a bar of two bricks, the second one all but empty. Its far nodes have next to
 * no stiffness, so that a force on them tears the mesh; with the effect they follow the first brick,
 * linear displacements cost nothing, and force, tangent and energy belong together. */
#include "engine/step_newton.h"
#include "engine/tet_ghost.h"
#include "tests/tet_helpers.h"

enum { MOST = 3 * 64 };

static const double shear = 1e3 / 2.6; /* E = 1e3, nu = 0.3; Pa */

typedef struct {
  pw_tet_mesh mesh;
  pw_tet_material material;
  pw_tet_model model;
} bar;

/* Points of the second brick keep the part `left` of their volume. */
static void start(double gamma, double left, pw_fbar fbar, bar *b)
{
  pw_tet_box box = {.bricks = {2, 1, 1}, .high = {2, 1, 1}, .per_brick = 6, .nodes = 10};
  memset(b, 0, sizeof *b);
  b->mesh = test_box_mesh(&box);
  b->material = test_von_mises(1e3, 0.3, "yield_radius_pa", 1e9, 0.0);
  pw_tet_fill fill = {.rule = PW_TET_RULE_FOUR, .nmaterial = 1, .material = &b->material};
  pw_tet_setup setup = {
      .mesh = &b->mesh, .fill = &fill, .fbar = fbar, .threads = 1, .ghost = gamma};
  assert_ok(pw_tet_model_create(&setup, &b->model));
  for (pw_idx i = 0; i < b->model.points.n; i++) {
    b->model.points.volume[i] *= b->model.points.x[i] > 1.0 ? left : 1.0;
  }
  for (pw_idx i = 0; i < 3 * b->mesh.tets.nnode; i++) {
    b->model.fixed[i] = b->mesh.tets.x[i % b->mesh.tets.nnode] == 0.0;
  }
}

static void end(bar *b)
{
  pw_tet_model_destroy(&b->model);
  pw_tet_mesh_destroy(&b->mesh);
}

/* Ratio of the largest to the least eigenvalue, by power iterations forwards and backwards. */
static double condition(bar *b)
{
  static double zero[MOST], v[MOST], w[MOST];
  double most = 0.0, least = 0.0;
  pw_solver *s;
  pw_solver_options options = pw_solver_defaults(false);
  options.engine = PW_SOLVER_DIRECT;
  assert_ok(pw_tet_model_begin(&b->model));
  assert_ok(pw_tet_model_evaluate(&b->model, zero, true));
  assert_true(b->model.csr.n <= MOST);
  assert_ok(pw_solver_create(&options, &s));
  assert_ok(pw_solver_factor(s, &b->model.csr));
  for (int backwards = 0; backwards < 2; backwards++) {
    uint64_t seed = 3;
    double norm = 0.0;
    test_displace(b->model.csr.n / 3, 1.0, &seed, v);
    for (int k = 0; k < 200; k++) {
      norm = 0.0;
      if (backwards) {
        assert_ok(pw_solver_solve(s, &b->model.csr, v, w));
      } else {
        pw_csr_multiply(&b->model.csr, v, w);
      }
      for (pw_idx i = 0; i < b->model.csr.n; i++) {
        norm += w[i] * w[i];
      }
      for (pw_idx i = 0; i < b->model.csr.n; i++) {
        v[i] = w[i] / sqrt(norm);
      }
    }
    *(backwards ? &least : &most) = backwards ? 1.0 / sqrt(norm) : sqrt(norm);
  }
  pw_solver_destroy(&s);
  return most / least;
}

static void the_condition_no_longer_depends_on_the_cut(void **state)
{
  (void)state;
  const double left[] = {1e-5, 1e-7, 1e-9};
  double first = 0.0;
  for (int k = 0; k < 3; k++) {
    bar plain, held;
    start(0.0, left[k], PW_FBAR_NONE, &plain);
    start(0.1 * shear, left[k], PW_FBAR_NONE, &held);
    double without = condition(&plain), with = condition(&held);
    print_message("filled to %g: condition %.2e without, %.2e with\n", left[k], without, with);
    first = k == 0 ? with : first;
    assert_true(without > 1.0 / left[k]);
    assert_relative(with, first, 0.01);
    assert_null(plain.model.ghost.face);
    assert_true(plain.model.csr.start[plain.model.csr.n] < held.model.csr.start[held.model.csr.n]);
    end(&plain);
    end(&held);
  }
}

static void force_and_tangent_belong_together(void **state)
{
  (void)state;
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_INCREMENT; fbar++) {
    static double u[MOST], d[MOST], moved[MOST], up[MOST], x[MOST], product[MOST];
    double error = 0.0, size = 0.0, energy[2];
    const double h = 1e-6;
    uint64_t seed = 5;
    bar b;
    start(0.1 * shear, 1e-6, (pw_fbar)fbar, &b);
    pw_tet_model *m = &b.model;
    const pw_idx n = b.mesh.tets.nnode;
    assert_ok(pw_tet_model_begin(m));
    test_displace(n, 0.02, &seed, u);
    test_displace(n, 1.0, &seed, d);
    for (int side = 1; side >= -1; side -= 2) {
      for (pw_idx i = 0; i < 3 * n; i++) {
        moved[i] = u[i] + side * h * (m->fixed[i] ? 0.0 : d[i]);
      }
      assert_ok(pw_tet_model_evaluate(m, moved, false));
      energy[side > 0] = pw_tet_ghost_energy(m, moved);
      for (pw_idx i = 0; i < 3 * n; i++) {
        up[i] = side > 0 ? m->force[i] : (up[i] - m->force[i]) / (2.0 * h);
      }
    }
    assert_ok(pw_tet_model_evaluate(m, u, true));
    for (pw_idx i = 0; i < 3 * n; i++) {
      if (m->equation[i] >= 0) {
        x[m->equation[i]] = d[i];
      }
    }
    pw_csr_multiply(&m->csr, x, product);
    for (pw_idx i = 0; i < 3 * n; i++) {
      if (m->equation[i] >= 0) {
        double off = product[m->equation[i]] - up[i];
        error += off * off;
        size += up[i] * up[i];
      }
    }
    assert_true(sqrt(error / size) < 1e-8);
    /* Its own part of the force is the slope of the energy. */
    memset(m->force, 0, 3 * (size_t)n * sizeof *m->force);
    pw_tet_ghost_add(m, u, false);
    double work = 0.0, sum[3] = {0}, level = 0.0;
    for (pw_idx i = 0; i < 3 * n; i++) {
      work += m->fixed[i] ? 0.0 : m->force[i] * d[i];
      sum[i / n] += m->force[i];
      level += fabs(m->force[i]);
    }
    assert_relative(work, (energy[1] - energy[0]) / (2.0 * h), 1e-6);
    assert_true(fabs(sum[0]) + fabs(sum[1]) + fabs(sum[2]) < 1e-13 * level);
    for (pw_idx i = 0; i < 3 * n; i++) { /* u = A x + b */
      const double *at = b.mesh.x + i % n;
      u[i] = 0.03 * at[0] - 0.02 * at[n] + 0.01 * at[2 * n] * (double)(1 + i / n) - 0.5;
    }
    assert_true(pw_tet_ghost_energy(m, u) < 1e-25);
    end(&b);
  }
}

static void pull(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const pw_tets *t = &m->mesh->tets;
  const double at = *(const double *)ctx;
  (void)t0;
  for (pw_idx a = 0; a < t->nnode; a++) { /* 1 N over the nine nodes of a face */
    m->external[a] = t->x[a] == at ? 1.0 / 9.0 * t1 : 0.0;
  }
}

/* Mean displacement of x = 1 under a force on the nodes at `at`; what the solution has given. */
static pw_status pulled(double gamma, double at, double *mean, double *part)
{
  bar b;
  pw_newton *newton;
  pw_newton_report report;
  pw_newton_options options = pw_newton_defaults();
  pw_newton_load load = {.ctx = &at, .apply = pull};
  options.max_cuts = 3;
  start(gamma, 1e-9, PW_FBAR_NONE, &b);
  assert_ok(pw_newton_create(&b.model, &options, &newton));
  pw_status s = pw_newton_step(newton, &load, &report);
  const pw_real *u = pw_newton_displacement(newton);
  double work = 0.0;
  *mean = 0.0;
  for (pw_idx a = 0; a < b.mesh.tets.nnode && s == PW_OK; a++) {
    *mean += b.mesh.tets.x[a] == 1.0 ? u[a] / 9.0 : 0.0;
    work += 0.5 * b.model.external[a] * u[a];
  }
  *part = s == PW_OK ? pw_tet_ghost_energy(&b.model, u) / work : 0.0;
  pw_newton_destroy(&newton);
  end(&b);
  return s;
}

/* A force of 1 N on the far nodes acts on the linear extension of the displacements of the first
 * brick: as 1 N at its end, which stretches the brick by F L/(E A) = 1 mm, and as a moment of 1 N at
 * the arm of 1 m on the gradient in the layer of elements at its end, by 1 mm more; gamma has no part
 * in it. Where the material ends a force leaves the effect almost no work. */
static void forces_on_cut_elements_are_carried(void **state)
{
  (void)state;
  double mean, held, softer, part[3], none;
  assert_int_equal(pulled(0.0, 2.0, &mean, &none), PW_RETRY_DIVERGED);
  assert_ok(pulled(shear, 2.0, &held, &part[0]));
  assert_ok(pulled(0.1 * shear, 2.0, &softer, &part[1]));
  print_message("force at the far end: x = 1 moves by %.3f mm, a tenth of gamma: %.3f mm\n",
                1e3 * held, 1e3 * softer);
  assert_near(held, 2e-3, 0.1e-3);
  assert_near(softer, 2e-3, 0.1e-3);
  assert_ok(pulled(0.0, 1.0, &mean, &none));
  assert_ok(pulled(0.1 * shear, 1.0, &held, &part[2]));
  print_message(
      "force at x = 1: %.4f mm, %.4f mm with the effect, which takes %.2f %% of the work\n",
      1e3 * mean, 1e3 * held, 100.0 * part[2]);
  assert_relative(held, mean, 0.02);
  assert_true(part[2] < 0.02);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_condition_no_longer_depends_on_the_cut),
      cmocka_unit_test(force_and_tangent_belong_together),
      cmocka_unit_test(forces_on_cut_elements_are_carried),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
