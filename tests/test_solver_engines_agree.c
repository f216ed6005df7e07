/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every engine of the solver finds the same solution to the accuracy asked of it, keeps its factor as
 * promised, repeats to the bit, and tells failures apart. */
#include "engine/solver.h"
#include "tests/tet_helpers.h"

enum { MOST = 6000 };

typedef struct {
  pw_tet_mesh mesh;
  pw_tet_material material;
  pw_tet_model model;
  double u[MOST], b[MOST], x[MOST], y[MOST];
} elastic;

/* A cube on rollers at x = 0 and z = 0, held at y = 0, so that nodes have one to three equations. */
static void start(elastic *e, pw_fbar fbar, bool held)
{
  memset(e, 0, sizeof *e);
  pw_tet_box box = test_cube(4, 1.0, 6, 10);
  e->mesh = test_box_mesh(&box);
  e->material = test_von_mises(1e3, 0.3, "yield_radius_pa", 1e9, 0.0);
  e->model = test_model(&e->mesh, &e->material, PW_TET_RULE_ONE, fbar);
  const pw_idx n = e->mesh.tets.nnode;
  assert_true(3 * n <= MOST);
  for (pw_idx a = 0; held && a < n; a++) {
    for (pw_idx c = 0; c < 3; c++) {
      e->model.fixed[c * n + a] = e->mesh.x[c * n + a] == 0.0 || e->mesh.x[n + a] == 0.0;
    }
  }
  assert_ok(pw_tet_model_begin(&e->model));
  assert_ok(pw_tet_model_evaluate(&e->model, e->u, true));
  for (pw_idx i = 0; i < e->model.csr.n; i++) {
    e->b[i] = sin(1.0 + i);
  }
}

static void end(elastic *e)
{
  pw_tet_model_destroy(&e->model);
  pw_tet_mesh_destroy(&e->mesh);
}

/* The tangent after a smooth deformation of that size. */
static void deform(elastic *e, double size)
{
  const pw_idx n = e->mesh.tets.nnode;
  for (pw_idx i = 0; i < 3 * n; i++) {
    e->u[i] = e->model.fixed[i] ? 0.0 : size * sin(2.0 * e->mesh.x[i % n] + i / n);
  }
  assert_ok(pw_tet_model_evaluate(&e->model, e->u, true));
}

static double left_over(const elastic *e)
{
  static double r[MOST];
  double left = 0.0, all = 0.0;
  pw_csr_multiply(&e->model.csr, e->x, r);
  for (pw_idx i = 0; i < e->model.csr.n; i++) {
    left += (e->b[i] - r[i]) * (e->b[i] - r[i]);
    all += e->b[i] * e->b[i];
  }
  return sqrt(left / all);
}

static pw_solver *make(pw_solver_engine engine, bool symmetric, const elastic *e)
{
  pw_solver *s = NULL;
  pw_solver_options options = pw_solver_defaults(symmetric);
  options.engine = engine;
  options.x = e->mesh.x;
  pw_status status = pw_solver_create(&options, &s);
  if (status == PW_ERR_UNSUPPORTED) { /* only PETSc's can be missing, and then they say so */
    assert_true(engine == PW_SOLVER_PETSC_GAMG || engine == PW_SOLVER_PETSC_ILU);
    assert_non_null(strstr(pw_error_text(), "petsc-dev"));
    assert_false(pw_solver_has_petsc());
    return NULL;
  }
  assert_int_equal(status, PW_OK);
  return s;
}

static void solutions_agree(void **state)
{
  (void)state;
  static elastic e;
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_INCREMENT; fbar++) {
    start(&e, (pw_fbar)fbar, true);
    deform(&e, 0.05);
    for (int engine = PW_SOLVER_AUTO; engine < PW_SOLVER_ENGINES; engine++) {
      pw_solver *s = make((pw_solver_engine)engine, fbar == PW_FBAR_NONE, &e);
      for (int k = 0; s && k < 2; k++) {
        const double goal = k == 0 ? 1e-4 : 1e-11;
        pw_solver_aim(s, goal);
        assert_ok(pw_solver_factor(s, &e.model.csr));
        assert_ok(pw_solver_solve(s, &e.model.csr, e.b, e.x));
        assert_true(left_over(&e) <= 1.01 * goal);
      }
      for (pw_idx i = 0; i < e.model.csr.n && s; i++) {
        e.y[i] = engine == PW_SOLVER_AUTO ? e.x[i] : e.y[i];
        assert_near(e.x[i], e.y[i], 1e-9);
      }
      if (s) {
        print_message("%s: %d iterations\n", pw_solver_describe(s), (int)pw_solver_counted(s).last);
      }
      pw_solver_destroy(&s);
    }
    end(&e);
  }
}

static void factors_are_kept_while_they_serve(void **state)
{
  (void)state;
  static elastic e;
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_INCREMENT; fbar++) {
    start(&e, (pw_fbar)fbar, true);
    pw_solver *s = make(PW_SOLVER_KRYLOV, fbar == PW_FBAR_NONE, &e);
    pw_solver_aim(s, 1e-10);
    for (int k = 0; k < 8; k++) { /* strains grow by a part in a thousand */
      deform(&e, 0.001 * k);
      assert_ok(pw_solver_factor(s, &e.model.csr));
      assert_ok(pw_solver_solve(s, &e.model.csr, e.b, e.x));
      assert_true(left_over(&e) <= 1.01e-10);
      assert_true(pw_solver_counted(s).last <= 8);
    }
    assert_in_range(pw_solver_counted(s).factors, 1, 3);
    assert_int_equal(pw_solver_counted(s).solves, 8);
    const pw_off before = pw_solver_counted(s).factors;
    for (pw_off i = 0; i < e.model.csr.start[e.model.csr.n]; i++) { /* another matrix altogether */
      e.model.csr.value[i] *= e.model.csr.col[i] % 2 == 0 ? 1.0 : -0.01;
    }
    for (pw_idx i = 0; i < e.model.csr.n; i++) {
      for (pw_off l = e.model.csr.start[i]; l < e.model.csr.start[i + 1]; l++) {
        e.model.csr.value[l] = e.model.csr.col[l] == i ? -1e4 : e.model.csr.value[l];
      }
    }
    if (fbar != PW_FBAR_NONE) {
      assert_ok(pw_solver_factor(s, &e.model.csr));
      assert_ok(pw_solver_solve(s, &e.model.csr, e.b, e.x));
      assert_true(left_over(&e) <= 1.01e-10);
      assert_int_equal(pw_solver_counted(s).factors, before + 1);
    }
    pw_solver_forget(s); /* the next matrix gets its own */
    deform(&e, 0.001);
    assert_ok(pw_solver_factor(s, &e.model.csr));
    assert_ok(pw_solver_solve(s, &e.model.csr, e.b, e.x));
    assert_int_equal(pw_solver_counted(s).last, 0);
    pw_solver_destroy(&s);
    end(&e);
  }
}

/* Symmetric, and positive definite no more. */
static void indefinite_matrices_are_solved(void **state)
{
  (void)state;
  static elastic e;
  start(&e, PW_FBAR_NONE, true);
  pw_solver *s = make(PW_SOLVER_KRYLOV, true, &e);
  pw_csr *m = &e.model.csr;
  assert_ok(pw_solver_factor(s, m));
  assert_ok(pw_solver_solve(s, m, e.b, e.x));
  for (pw_idx i = 0; i < m->n; i += 3) {
    for (pw_off l = m->start[i]; l < m->start[i + 1]; l++) {
      m->value[l] = m->col[l] == i ? -m->value[l] : m->value[l];
    }
  }
  for (int k = 0; k < 2; k++) { /* factored, then kept */
    assert_ok(pw_solver_factor(s, m));
    assert_ok(pw_solver_solve(s, m, e.b, e.x));
    assert_true(left_over(&e) <= 1.01e-10);
    assert_int_equal(pw_solver_counted(s).indefinite, 1);
  }
  pw_solver_destroy(&s);
  end(&e);
}

static void failures_are_told_apart(void **state)
{
  (void)state;
  static elastic e;
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_INCREMENT; fbar++) {
    for (int engine = PW_SOLVER_DIRECT; engine < PW_SOLVER_ENGINES; engine++) {
      const bool factors = engine == PW_SOLVER_DIRECT || engine == PW_SOLVER_KRYLOV;
      start(&e, (pw_fbar)fbar, false); /* free to move as a rigid body */
      pw_solver *s = make((pw_solver_engine)engine, fbar == PW_FBAR_NONE, &e);
      if (s) {
        if (factors) {
          assert_int_equal(pw_solver_factor(s, &e.model.csr), PW_RETRY_DIVERGED);
          assert_non_null(strstr(pw_error_text(), "singular: at node "));
        }
        pw_csr_clear(&e.model.csr, 0, 1);
        assert_int_equal(pw_solver_factor(s, &e.model.csr), PW_RETRY_DIVERGED);
        assert_non_null(strstr(pw_error_text(), "singular"));
        assert_ok(pw_tet_model_evaluate(&e.model, e.u, true));
        e.model.csr.value[17] = NAN;
        assert_true(pw_solver_factor(s, &e.model.csr) > 0);
      }
      pw_solver_destroy(&s);
      end(&e);
    }
  }
}

static void memory_is_looked_at_first(void **state)
{
  (void)state;
  static elastic e;
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_INCREMENT; fbar++) {
    start(&e, (pw_fbar)fbar, true);
    pw_solver_options options = pw_solver_defaults(fbar == PW_FBAR_NONE);
    pw_solver *s = NULL;
    options.most_bytes = 1000000;
    assert_ok(pw_solver_create(&options, &s));
    for (int k = 0; k < 2; k++) { /* and looked at again */
      assert_int_equal(pw_solver_factor(s, &e.model.csr), PW_ERR_MEMORY);
      assert_non_null(strstr(pw_error_text(), "0.001 GB"));
      assert_non_null(strstr(pw_error_text(), "petsc_gamg"));
    }
    pw_solver_destroy(&s);
    end(&e);
  }
}

static void engines_have_names(void **state)
{
  (void)state;
  static elastic e;
  pw_solver_engine found;
  for (int engine = 0; engine < PW_SOLVER_ENGINES; engine++) {
    assert_true(pw_solver_find(pw_solver_name((pw_solver_engine)engine), &found));
    assert_int_equal(found, engine);
  }
  assert_false(pw_solver_find("abacus", &found));
  pw_solver *s = NULL;
  pw_solver_options options = pw_solver_defaults(true);
  options.engine = PW_SOLVER_ENGINES;
  assert_int_equal(pw_solver_create(&options, &s), PW_ERR_ARGUMENT);
  options = pw_solver_defaults(true);
  options.threads = 0;
  assert_int_equal(pw_solver_create(&options, &s), PW_ERR_ARGUMENT);
  start(&e, PW_FBAR_NONE, true);
  s = make(PW_SOLVER_AUTO, true, &e);
  assert_string_equal(pw_solver_describe(s), "no matrix yet");
  assert_ok(pw_solver_factor(s, &e.model.csr));
  assert_non_null(strstr(pw_solver_describe(s), "CHOLMOD"));
  assert_non_null(strstr(pw_solver_describe(s), "direct up to 100000"));
  pw_solver_destroy(&s);
  end(&e);
}

/* What "automatic" takes for a large system, and falls back on when that does not converge. */
static void large_systems_are_iterated(void **state)
{
  (void)state;
  static elastic e;
  start(&e, PW_FBAR_NONE, true);
  pw_solver_options options = pw_solver_defaults(true);
  pw_solver *s = NULL;
  pw_csr *m = &e.model.csr;
  options.x = e.mesh.x;
  options.most_direct = m->n - 1;
  assert_ok(pw_solver_create(&options, &s));
  assert_ok(pw_solver_factor(s, m));
  assert_ok(pw_solver_solve(s, m, e.b, e.x));
  assert_true(left_over(&e) <= 1.01e-10);
  assert_non_null(strstr(pw_solver_describe(s), pw_solver_has_petsc() ? "petsc_gamg" : "krylov"));
  for (pw_idx i = 0; i < m->n; i += 3) { /* no longer definite */
    for (pw_off l = m->start[i]; l < m->start[i + 1]; l++) {
      m->value[l] = m->col[l] == i ? -m->value[l] : m->value[l];
    }
  }
  assert_ok(pw_solver_factor(s, m));
  assert_ok(pw_solver_solve(s, m, e.b, e.x));
  assert_true(left_over(&e) <= 1.01e-10);
  assert_non_null(strstr(pw_solver_describe(s), "krylov"));
  pw_solver_destroy(&s);
  end(&e);
}

/* From one load step to the next nodes gain and lose their equations. */
static void patterns_may_change(void **state)
{
  (void)state;
  static elastic e;
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_INCREMENT; fbar++) {
    for (int engine = PW_SOLVER_AUTO; engine < PW_SOLVER_ENGINES; engine++) {
      start(&e, (pw_fbar)fbar, true);
      const pw_idx n = e.mesh.tets.nnode, all = e.model.csr.n;
      pw_solver *s = make((pw_solver_engine)engine, fbar == PW_FBAR_NONE, &e);
      for (int step = 0; s && step < 4; step++) {
        for (pw_idx a = 0; a < n; a++) { /* a plane of nodes more, on and off */
          e.model.fixed[2 * n + a] = e.mesh.x[a] == 0.0 || e.mesh.x[n + a] == 0.0 ||
                                     (step % 2 == 1 && e.mesh.x[2 * n + a] == 0.0);
        }
        assert_ok(pw_tet_model_begin(&e.model));
        deform(&e, 0.01 * step);
        assert_true(step % 2 == 1 ? e.model.csr.n < all : e.model.csr.n == all);
        pw_solver_forget(s);
        pw_solver_aim(s, 1e-10);
        assert_ok(pw_solver_factor(s, &e.model.csr));
        assert_ok(pw_solver_solve(s, &e.model.csr, e.b, e.x));
        assert_true(left_over(&e) <= 1.01e-10);
      }
      pw_solver_destroy(&s);
      end(&e);
    }
  }
}

/* The same matrices in the same order: the same bits. */
static void runs_repeat(void **state)
{
  (void)state;
  static elastic e;
  for (int engine = PW_SOLVER_DIRECT; engine < PW_SOLVER_ENGINES; engine++) {
    for (int run = 0; run < 2; run++) {
      start(&e, PW_FBAR_INCREMENT, true);
      pw_solver *s = make((pw_solver_engine)engine, false, &e);
      static double first[3][MOST];
      for (int k = 0; s && k < 3; k++) {
        deform(&e, 0.01 * k);
        assert_ok(pw_solver_factor(s, &e.model.csr));
        assert_ok(pw_solver_solve(s, &e.model.csr, e.b, e.x));
        if (run == 0) {
          memcpy(first[k], e.x, sizeof e.x);
        }
        assert_memory_equal(first[k], e.x, (size_t)e.model.csr.n * sizeof *e.x);
      }
      pw_solver_destroy(&s);
      end(&e);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solutions_agree),
      cmocka_unit_test(factors_are_kept_while_they_serve),
      cmocka_unit_test(indefinite_matrices_are_solved),
      cmocka_unit_test(failures_are_told_apart),
      cmocka_unit_test(memory_is_looked_at_first),
      cmocka_unit_test(engines_have_names),
      cmocka_unit_test(large_systems_are_iterated),
      cmocka_unit_test(patterns_may_change),
      cmocka_unit_test(runs_repeat),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
