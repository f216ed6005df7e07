/* SPDX-License-Identifier: GPL-3.0-or-later */
/* F-bar over patches: one volume ratio for all elements of a patch, F itself where that is uniform
 * or where a patch has one element with points, and forces that keep balance. */
#include "tests/tet_helpers.h"

#include "engine/tet_patch.h"

enum { NODES = 26 };

static pw_tet_mesh cube(void)
{
  pw_tet_box box = test_cube(1, 2.0, 5, 10);
  return test_box_mesh(&box);
}

static void elements_of_a_patch_share_their_volume_ratio(void **state)
{
  (void)state;
  for (int f = PW_FBAR_INCREMENT; f <= PW_FBAR_TOTAL; f++) {
    pw_tet_mesh mesh = cube();
    pw_tet_material vm = test_von_mises(1e3, 0.3, "yield_radius_pa", 20.0, 0.0);
    pw_tet_model m = test_model(&mesh, &vm, PW_TET_RULE_FOUR, (pw_fbar)f);
    uint64_t seed = 3;
    double u[3 * NODES];
    assert_ok(pw_tet_model_begin(&m));
    test_displace(NODES, 0.08, &seed, u);
    assert_ok(pw_tet_model_evaluate(&m, u, false));
    for (pw_idx p = 0; p < mesh.npatch; p++) {
      pw_patch_motion t;
      assert_int_equal(pw_patch_move(&m, p, u, &t), -1);
      for (pw_idx k = m.elem_start[8 * p]; k < m.elem_start[8 * p + 8]; k++) {
        pw_idx i = m.elem_point[k];
        double bar = m.points.jac_bar_trial[i]; /* det F-bar */
        assert_relative(bar, t.ratio, 1e-14);
        /* The stress belongs to it: von Mises flow keeps volume, so tr sigma = 3 K ln J / J. */
        const double *s = m.points.stress_trial + i;
        double trace = s[0] + s[m.points.ld] + s[2 * m.points.ld];
        assert_relative(trace, 3.0 * 1e3 / (3.0 * 0.4) * log(bar) / bar, 1e-11);
      }
    }
    pw_tet_model_destroy(&m);
    pw_tet_mesh_destroy(&mesh);
  }
}

static void uniform_motion_is_left_alone(void **state)
{
  (void)state;
  double forces[3][3 * NODES];
  const double f[9] = {0.02, 0.1, -0.03, 0.05, -0.04, 0.01, 0.0, 0.02, 0.06};
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_TOTAL; fbar++) {
    pw_tet_mesh mesh = cube();
    pw_tet_material vm = test_von_mises(1e3, 0.3, "yield_radius_pa", 20.0, 0.0);
    pw_tet_model m = test_model(&mesh, &vm, PW_TET_RULE_FOUR, (pw_fbar)fbar);
    double u[3 * NODES];
    for (int i = 0; i < 3 * NODES; i++) {
      const double *row = f + 3 * (i / NODES), *x = mesh.x + i % NODES;
      u[i] = row[0] * x[0] + row[1] * x[NODES] + row[2] * x[2 * NODES];
    }
    assert_ok(pw_tet_model_begin(&m));
    assert_ok(pw_tet_model_evaluate(&m, u, false));
    memcpy(forces[fbar], m.force, sizeof forces[fbar]);
    for (int i = 0; i < 3 * NODES; i++) {
      assert_near(forces[fbar][i], forces[0][i], 1e-12);
    }
    pw_tet_model_destroy(&m);
    pw_tet_mesh_destroy(&mesh);
  }
}

static void check_balance(const pw_tet_model *m, const double *u)
{
  double sum[3] = {0}, moment[3] = {0}, size = 0.0;
  for (int a = 0; a < NODES; a++) {
    double x[3], f[3];
    for (int c = 0; c < 3; c++) {
      x[c] = m->mesh->x[c * NODES + a] + u[c * NODES + a]; /* where the node is now */
      f[c] = m->force[c * NODES + a];
      sum[c] += f[c];
      size = fmax(size, fabs(f[c]));
    }
    for (int c = 0; c < 3; c++) {
      moment[c] += x[(c + 1) % 3] * f[(c + 2) % 3] - x[(c + 2) % 3] * f[(c + 1) % 3];
    }
  }
  for (int c = 0; c < 3; c++) {
    assert_near(sum[c], 0.0, 1e-13 * size);
    assert_near(moment[c], 0.0, 1e-13 * size);
  }
}

static void forces_and_moments_vanish(void **state)
{
  (void)state;
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_TOTAL; fbar++) {
    pw_tet_mesh mesh = cube();
    pw_tet_material vm = test_von_mises(1e3, 0.49, "yield_radius_pa", 30.0, 10.0);
    pw_tet_model m = test_model(&mesh, &vm, PW_TET_RULE_ONE, (pw_fbar)fbar);
    uint64_t seed = 8;
    double u[3 * NODES];
    assert_ok(pw_tet_model_begin(&m));
    for (int k = 0; k < 5; k++) {
      test_displace(NODES, 0.08, &seed, u);
      assert_ok(pw_tet_model_evaluate(&m, u, false));
      check_balance(&m, u);
    }
    pw_tet_model_destroy(&m);
    pw_tet_mesh_destroy(&mesh);
  }
}

/* E10: patches with one populated element have F-bar = F, those with none no equations. */
static void sparse_patches_are_safe(void **state)
{
  (void)state;
  double u[3 * NODES], plain[3 * NODES];
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_TOTAL; fbar++) {
    pw_tet_mesh mesh = cube();
    pw_tet_material vm = test_von_mises(1e3, 0.3, "yield_radius_pa", 20.0, 0.0);
    pw_idx body[5] = {-1, 0, 0, -1, -1};
    pw_tet_fill fill = {.rule = PW_TET_RULE_ONE, .body = body, .nmaterial = 1, .material = &vm};
    pw_tet_setup setup = {.mesh = &mesh, .fill = &fill, .fbar = (pw_fbar)fbar, .threads = 1};
    pw_tet_model m;
    uint64_t seed = 4;
    assert_ok(pw_tet_model_create(&setup, &m));
    m.points.n = 9; /* all of patch 1 and one point of patch 2 */
    for (pw_idx i = 8; i < 9; i++) {
      m.points.elem[i] = 16;
    }
    assert_ok(pw_tet_model_begin(&m));
    test_displace(NODES, 0.05, &seed, u);
    assert_ok(pw_tet_model_evaluate(&m, u, true));
    assert_true(m.csr.n < 3 * 16); /* ten nodes and those of one element more */
    pw_idx alone = m.elem_point[m.elem_start[16]];
    double before = m.points.jac_bar_trial[alone];
    pw_tet_motion t;
    double start[12], nodal[12];
    pw_tet_mesh_gradients(&mesh, 16, start);
    for (int i = 0; i < 12; i++) {
      nodal[i] = u[(i % 3) * NODES + mesh.tets.node[64 + i / 3]];
    }
    pw_tet_motion_of(start, nodal, &t);
    assert_near(before, t.det, 1e-15);
    for (int i = 0; i < 3 * NODES; i++) {
      assert_true(isfinite(m.force[i]));
      plain[i] = m.force[i];
      assert_true(m.equation[i] >= 0 || plain[i] == 0.0);
    }
    pw_tet_model_destroy(&m);
    pw_tet_mesh_destroy(&mesh);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(elements_of_a_patch_share_their_volume_ratio),
      cmocka_unit_test(uniform_motion_is_left_alone),
      cmocka_unit_test(forces_and_moments_vanish),
      cmocka_unit_test(sparse_patches_are_safe),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
