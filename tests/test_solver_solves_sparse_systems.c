/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linear systems on the pattern of a mesh: known solutions are found, the analysis is kept while the
 * pattern stands, matrices that are indefinite or singular are treated as promised. */
#include "engine/solver.h"
#include "tests/tet_helpers.h"

enum { MOST = 2000 };

static pw_idx equation[3 * MOST];

/* Equations of all components but those of every `skip`-th node. */
static pw_idx number(pw_csr *m, pw_idx skip)
{
  pw_idx n = 0;
  for (pw_idx a = 0; a < m->nnode; a++) {
    for (pw_idx c = 0; c < 3; c++) {
      equation[c * m->nnode + a] = skip > 0 && a % skip == 0 ? -1 : n++;
    }
  }
  pw_csr_number(m, equation, n);
  return n;
}

/* Random values, with a diagonal that dominates by `weight`; symmetric or not. */
static void fill(pw_csr *m, bool symmetric, double weight)
{
  for (pw_idx i = 0; i < m->n; i++) {
    double sum = 0.0, *diagonal = NULL;
    for (pw_off k = m->start[i]; k < m->start[i + 1]; k++) {
      pw_idx j = m->col[k], low = i < j ? i : j, high = i < j ? j : i;
      uint64_t seed = (uint64_t)(symmetric ? low : i) * 7919 + (uint64_t)(symmetric ? high : j);
      m->value[k] = test_random(&seed) - 0.5;
      sum += fabs(m->value[k]);
      diagonal = i == j ? &m->value[k] : diagonal;
    }
    *diagonal = weight * sum;
  }
}

static void check_solution(pw_solver *s, const pw_csr *m)
{
  static double x[3 * MOST], b[3 * MOST], y[3 * MOST];
  for (pw_idx i = 0; i < m->n; i++) {
    x[i] = sin(1.0 + i);
  }
  pw_csr_multiply(m, x, b);
  assert_ok(pw_solver_factor(s, m));
  assert_ok(pw_solver_solve(s, m, b, y));
  for (pw_idx i = 0; i < m->n; i++) {
    assert_near(y[i], x[i], 1e-11);
  }
}

static void solutions_are_found(void **state)
{
  (void)state;
  pw_tet_box box = test_cube(3, 1.0, 6, 10);
  pw_tet_mesh mesh = test_box_mesh(&box);
  for (int symmetric = 0; symmetric < 2; symmetric++) {
    pw_solver *s;
    pw_csr m;
    assert_ok(pw_csr_create(&mesh, !symmetric, &m));
    pw_solver_options options = pw_solver_defaults(symmetric);
    assert_ok(pw_solver_create(&options, &s));
    number(&m, 0);
    fill(&m, symmetric, 1.1);
    check_solution(s, &m);
    fill(&m, symmetric, 1.5);
    check_solution(s, &m);
    assert_int_equal(pw_solver_counted(s).analyses, 1);
    assert_int_equal(pw_solver_counted(s).factors, 2);
    number(&m, 5); /* another pattern */
    fill(&m, symmetric, 1.1);
    check_solution(s, &m);
    assert_int_equal(pw_solver_counted(s).analyses, 2);
    assert_int_equal(pw_solver_counted(s).indefinite, 0);
    if (symmetric) { /* half of the diagonal negative: neither positive nor negative definite */
      fill(&m, true, 1.1);
      for (pw_idx i = 0; i < m.n; i += 2) {
        for (pw_off k = m.start[i]; k < m.start[i + 1]; k++) {
          m.value[k] = m.col[k] == i ? -m.value[k] : m.value[k];
        }
      }
      check_solution(s, &m);
      assert_int_equal(pw_solver_counted(s).indefinite, 1);
    }
    pw_csr_clear(&m, 0, 1);
    assert_int_equal(pw_solver_factor(s, &m), PW_RETRY_DIVERGED);
    assert_non_null(strstr(pw_error_text(), "singular"));
    pw_solver_destroy(&s);
    pw_csr_destroy(&m);
  }
  pw_tet_mesh_destroy(&mesh);
}

/* What pw_csr_add() gathers is the sum of the matrices of the patches. */
static void patches_add_up(void **state)
{
  (void)state;
  pw_tet_box box = test_cube(2, 1.0, 5, 10);
  pw_tet_mesh mesh = test_box_mesh(&box);
  static double k[PW_PATCH_DOFS * PW_PATCH_DOFS], x[3 * MOST], y[3 * MOST], sum[3 * MOST];
  pw_csr m;
  assert_ok(pw_csr_create(&mesh, true, &m));
  number(&m, 4);
  pw_csr_clear(&m, 0, 1);
  memset(sum, 0, sizeof sum);
  for (pw_idx i = 0; i < m.n; i++) {
    x[i] = cos(i);
  }
  for (pw_idx p = 0; p < mesh.npatch; p++) {
    uint64_t seed = (uint64_t)p;
    for (int i = 0; i < PW_PATCH_DOFS * PW_PATCH_DOFS; i++) {
      k[i] = test_random(&seed);
    }
    pw_csr_add(&m, p, k);
    for (int i = 0; i < 30; i++) {
      pw_idx row = equation[(i % 3) * m.nnode + mesh.patch_node[10 * p + i / 3]];
      for (int j = 0; j < 30 && row >= 0; j++) {
        pw_idx col = equation[(j % 3) * m.nnode + mesh.patch_node[10 * p + j / 3]];
        sum[row] += col >= 0 ? k[PW_PATCH_DOFS * i + j] * x[col] : 0.0;
      }
    }
  }
  pw_csr_multiply(&m, x, y);
  for (pw_idx i = 0; i < m.n; i++) {
    assert_near(y[i], sum[i], 1e-12);
    for (pw_off l = m.start[i] + 1; l < m.start[i + 1]; l++) {
      assert_true(m.col[l] > m.col[l - 1]);
    }
  }
  pw_csr_destroy(&m);
  pw_tet_mesh_destroy(&mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solutions_are_found),
      cmocka_unit_test(patches_add_up),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
