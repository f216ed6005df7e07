/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Unit checks of the F-bar patch: det Fbar is the same in all elements of a patch and the ratio of
 * its volumes, shape changes are left alone, homogeneous ones altogether; forces balance; elements
 * without points count for nothing; what F-bar couples stays in the patch. And the patch test: free
 * nodes follow a linear displacement of the boundary on meshes of random shape. */
#include "engine/step_newton.h"
#include "engine/tet_patch.h"
#include "kernels/tensor.h"
#include "tests/tet_helpers.h"

enum { MOST = 3 * 200 };

static double displaced[MOST];

/* One brick of five ten-node tetrahedra, points in all elements or in `filled` of the patch 0. */
static pw_tet_model start(pw_tet_mesh *mesh, const pw_tet_material *m, pw_fbar fbar)
{
  pw_tet_box box = test_cube(1, 2.0, 5, 10);
  *mesh = test_box_mesh(&box);
  return test_model(mesh, m, PW_TET_RULE_FOUR, fbar);
}

static double det_bar(const pw_tet_points *q, pw_idx i)
{
  return q->jac_bar_trial[i] / q->jac_bar[i];
}

/* Random motion of one step: det Fbar of a point against the patch's own volumes. */
static void volumes_are_those_of_the_patch(void **state)
{
  (void)state;
  pw_tet_material vm = test_von_mises(1e3, 0.3, "yield_radius_pa", 1e9, 0.0);
  for (int fbar = PW_FBAR_INCREMENT; fbar <= PW_FBAR_TOTAL; fbar++) {
    pw_tet_mesh mesh;
    pw_tet_model barred = start(&mesh, &vm, (pw_fbar)fbar);
    pw_tet_mesh other;
    pw_tet_model plain = start(&other, &vm, PW_FBAR_NONE);
    uint64_t seed = 11;
    test_displace(mesh.tets.nnode, 0.08, &seed, displaced);
    assert_ok(pw_tet_model_begin(&barred));
    assert_ok(pw_tet_model_begin(&plain));
    assert_ok(pw_tet_model_evaluate(&barred, displaced, false));
    assert_ok(pw_tet_model_evaluate(&plain, displaced, false));
    const pw_tet_points *q = &barred.points, *p = &plain.points;
    double before[5] = {0}, now[5] = {0}, spread = 0.0;
    for (pw_idx i = 0; i < q->n; i++) {
      before[q->elem[i] / 8] += q->volume[i];
      now[q->elem[i] / 8] += q->volume[i] * det_bar(p, i); /* det F itself */
    }
    for (pw_idx i = 0; i < q->n; i++) {
      const size_t l = (size_t)q->ld;
      const double wanted = now[q->elem[i] / 8] / before[q->elem[i] / 8];
      assert_relative(det_bar(q, i), wanted, 1e-14);
      spread = fmax(spread, fabs(det_bar(p, i) - wanted));
      pw_t6 a = pw_t6_load(q->stress_trial + i, l), b = pw_t6_load(p->stress_trial + i, l);
      a = pw_t6_scale(det_bar(q, i), pw_t6_shift(a, -pw_t6_trace(a) / 3.0));
      b = pw_t6_scale(det_bar(p, i), pw_t6_shift(b, -pw_t6_trace(b) / 3.0));
      pw_t6 off = pw_t6_axpy(a, -1.0, b); /* deviators of the Kirchhoff stress */
      assert_true(pw_t6_norm(off) < 1e-12 * 1e3);
    }
    assert_true(spread > 0.01);
    pw_tet_model_destroy(&barred);
    pw_tet_mesh_destroy(&mesh);
    pw_tet_model_destroy(&plain);
    pw_tet_mesh_destroy(&other);
  }
}

/* Sum of forces, and of moments about where the nodes are. */
static void check_balance(const pw_tet_model *m, const double *u)
{
  const pw_idx n = m->mesh->tets.nnode;
  double sum[6] = {0}, size = 0.0;
  for (pw_idx a = 0; a < n; a++) {
    double f[3], x[3];
    for (int c = 0; c < 3; c++) {
      f[c] = m->force[c * n + a];
      x[c] = m->mesh->x[c * n + a] + u[c * n + a];
      sum[c] += f[c];
      size += fabs(f[c]);
    }
    for (int c = 0; c < 3; c++) {
      sum[3 + c] += x[(c + 1) % 3] * f[(c + 2) % 3] - x[(c + 2) % 3] * f[(c + 1) % 3];
    }
  }
  for (int c = 0; c < 6; c++) {
    assert_true(fabs(sum[c]) < 1e-13 * size);
  }
}

static void forces_and_moments_balance(void **state)
{
  (void)state;
  pw_tet_material vm = test_von_mises(1e3, 0.49, "yield_radius_pa", 20.0, 0.0);
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_TOTAL; fbar++) {
    pw_tet_mesh mesh;
    pw_tet_model m = start(&mesh, &vm, (pw_fbar)fbar);
    uint64_t seed = 5;
    test_displace(mesh.tets.nnode, 0.08, &seed, displaced);
    assert_ok(pw_tet_model_begin(&m));
    assert_ok(pw_tet_model_evaluate(&m, displaced, false));
    check_balance(&m, displaced);
    pw_tet_model_destroy(&m);
    pw_tet_mesh_destroy(&mesh);
  }
}

static void homogeneous_motions_are_left_alone(void **state)
{
  (void)state;
  static const double grad[9] = {0.05, 0.1, -0.02, 0.03, -0.08, 0.04, 0.0, 0.06, 0.02};
  pw_tet_material vm = test_von_mises(1e3, 0.3, "yield_radius_pa", 1e9, 0.0);
  static double stress[6 * 1000];
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_TOTAL; fbar++) {
    pw_tet_mesh mesh;
    pw_tet_model m = start(&mesh, &vm, (pw_fbar)fbar);
    const pw_idx n = mesh.tets.nnode;
    for (pw_idx i = 0; i < 3 * n; i++) {
      const double *g = grad + 3 * (i / n), *x = mesh.x + i % n;
      displaced[i] = g[0] * x[0] + g[1] * x[n] + g[2] * x[2 * n];
    }
    assert_ok(pw_tet_model_begin(&m));
    assert_ok(pw_tet_model_evaluate(&m, displaced, false));
    for (pw_idx i = 0; i < 6 * m.points.ld; i++) {
      stress[i] = fbar == PW_FBAR_NONE ? m.points.stress_trial[i] : stress[i];
      assert_near(m.points.stress_trial[i], stress[i], 1e-12 * 1e3);
    }
    pw_tet_model_destroy(&m);
    pw_tet_mesh_destroy(&mesh);
  }
}

/* Patch 0 keeps the points of one element, patch 1 of none: its nodes get no force from it. */
static void empty_elements_count_for_nothing(void **state)
{
  (void)state;
  pw_tet_material vm = test_von_mises(1e3, 0.3, "yield_radius_pa", 1e9, 0.0);
  pw_tet_mesh mesh;
  pw_tet_model m = start(&mesh, &vm, PW_FBAR_INCREMENT);
  pw_tet_points *q = &m.points;
  uint64_t seed = 3;
  pw_idx kept = 0;
  for (pw_idx i = 0; i < q->n; i++) { /* element 3 of patch 0 and all of patches 2 .. 4 */
    if (q->elem[i] == 3 || q->elem[i] / 8 > 1) {
      q->elem[kept] = q->elem[i];
      q->volume[kept] = q->volume[i];
      for (int c = 0; c < 3; c++) {
        q->x[c * q->ld + kept] = q->x[c * q->ld + i];
      }
      kept++;
    }
  }
  q->n = kept;
  test_displace(mesh.tets.nnode, 0.08, &seed, displaced);
  assert_ok(pw_tet_model_begin(&m));
  assert_ok(pw_tet_model_evaluate(&m, displaced, true));
  double start_gradient[12], nodal[12];
  pw_tet_motion motion;
  pw_tet_mesh_gradients(&mesh, 3, start_gradient);
  for (int i = 0; i < 12; i++) {
    nodal[i] = displaced[i % 3 * mesh.tets.nnode + mesh.tets.node[12 + i / 3]];
  }
  pw_tet_motion_of(start_gradient, nodal, &motion);
  pw_patch_motion patch;
  assert_int_equal(pw_patch_move(&m, 0, displaced, &patch), -1);
  assert_int_equal(patch.nactive, 1);
  for (pw_idx i = 0; i < 4; i++) {
    assert_int_equal(q->elem[i], 3);
    assert_relative(det_bar(q, i), motion.det, 1e-14);
  }
  assert_int_equal(pw_patch_move(&m, 1, displaced, &patch), -1);
  assert_int_equal(patch.nactive, 0);
  check_balance(&m, displaced);
  pw_tet_model_destroy(&m);
  pw_tet_mesh_destroy(&mesh);
}

/* A row of bricks: nodes that share no patch have no value, nodes of one patch that share no element
 * have one with F-bar alone. */
static void coupling_stays_in_the_patch(void **state)
{
  (void)state;
  pw_tet_material vm = test_von_mises(1e3, 0.3, "yield_radius_pa", 1e9, 0.0);
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_INCREMENT; fbar++) {
    pw_tet_box box = {.bricks = {3, 1, 1}, .high = {3, 1, 1}, .per_brick = 6, .nodes = 10};
    pw_tet_mesh mesh = test_box_mesh(&box);
    pw_tet_model m = test_model(&mesh, &vm, PW_TET_RULE_ONE, (pw_fbar)fbar);
    static bool in_patch[200][200], in_element[200][200];
    const pw_idx n = mesh.tets.nnode;
    uint64_t seed = 9;
    pw_idx beyond = 0;
    assert_true(n <= 200);
    memset(in_patch, 0, sizeof in_patch);
    memset(in_element, 0, sizeof in_element);
    for (pw_idx p = 0; p < mesh.npatch; p++) {
      for (int i = 0; i < 100; i++) {
        in_patch[mesh.patch_node[10 * p + i / 10]][mesh.patch_node[10 * p + i % 10]] = true;
      }
    }
    for (pw_idx e = 0; e < mesh.tets.nelem; e++) {
      for (int i = 0; i < 16; i++) {
        in_element[mesh.tets.node[4 * e + i / 4]][mesh.tets.node[4 * e + i % 4]] = true;
      }
    }
    test_displace(n, 0.04, &seed, displaced);
    assert_ok(pw_tet_model_begin(&m));
    assert_ok(pw_tet_model_evaluate(&m, displaced, true));
    for (pw_idx i = 0; i < m.csr.n; i++) { /* no component is fixed: row 3 a + c */
      for (pw_off k = m.csr.start[i]; k < m.csr.start[i + 1]; k++) {
        pw_idx a = i / 3, b = m.csr.col[k] / 3;
        assert_true(in_patch[a][b] || m.csr.value[k] == 0.0);
        beyond += !in_element[a][b] && m.csr.value[k] != 0.0;
      }
    }
    assert_true((beyond > 0) == (fbar == PW_FBAR_INCREMENT));
    pw_tet_model_destroy(&m);
    pw_tet_mesh_destroy(&mesh);
  }
}

static void stretch(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  static const double grad[9] = {0.05, 0.1, -0.02, 0.03, -0.08, 0.04, 0.0, 0.06, 0.02};
  const pw_idx n = m->mesh->tets.nnode;
  (void)ctx;
  for (pw_idx i = 0; i < 3 * n; i++) {
    const double *g = grad + 3 * (i / n), *x = m->mesh->x + i % n;
    m->prescribed[i] = (t1 - t0) * (g[0] * x[0] + g[1] * x[n] + g[2] * x[2 * n]);
  }
}

/* Inner nodes shaken by up to a fifth of a cell, or by so much that slivers arise. */
static void free_nodes_follow_linear_motions(void **state)
{
  (void)state;
  const double shake[] = {0.1, 0.2, 0.24};
  for (int k = 0; k < 3; k++) {
    pw_tet_mesh mesh = test_shaken_mesh(4, shake[k], 21);
    pw_tet_material vm = test_von_mises(1e3, 0.3, "yield_radius_pa", 1e9, 0.0);
    pw_tet_model m = test_model(&mesh, &vm, PW_TET_RULE_ONE, PW_FBAR_NONE);
    pw_newton_options options = pw_newton_defaults();
    pw_newton_load load = {.apply = stretch};
    pw_newton_report report;
    pw_newton *newton;
    const pw_idx n = mesh.tets.nnode;
    for (pw_idx i = 0; i < 3 * n; i++) {
      bool outside = false;
      for (int c = 0; c < 3; c++) {
        double x = mesh.x[c * n + i % n];
        outside = outside || x == 0.0 || x == 1.0;
      }
      m.fixed[i] = outside;
    }
    options.tolerance = 1e-14;
    assert_ok(pw_newton_create(&m, &options, &newton));
    assert_ok(pw_newton_step(newton, &load, &report));
    const pw_real *u = pw_newton_displacement(newton);
    for (pw_idx i = 0; i < 3 * n; i++) {
      assert_near(u[i], m.prescribed[i], 1e-12);
    }
    pw_newton_destroy(&newton);
    pw_tet_model_destroy(&m);
    pw_tet_mesh_destroy(&mesh);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(volumes_are_those_of_the_patch),
      cmocka_unit_test(forces_and_moments_balance),
      cmocka_unit_test(homogeneous_motions_are_left_alone),
      cmocka_unit_test(empty_elements_count_for_nothing),
      cmocka_unit_test(coupling_stays_in_the_patch),
      cmocka_unit_test(free_nodes_follow_linear_motions),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
