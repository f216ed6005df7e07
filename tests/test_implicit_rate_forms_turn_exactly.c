/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Models in rate form in implicit steps of any size: a rigid rotation turns the stress, a stretch is
 * a logarithmic strain, and the tangent is the derivative of the force. */
#include "kernels/log_increment.h"
#include "kernels/spectral.h"
#include "tests/tet_helpers.h"

static test_material soil(const char *name)
{
  test_material m = test_material_of(name);
  test_set(&m, "density_kg_m3", 1800.0);
  if (strcmp(name, "modified_cam_clay") == 0) {
    test_set(&m, "compression_index_lambda", 0.2);
    test_set(&m, "swelling_index_kappa", 0.04);
    test_set(&m, "critical_stress_ratio", 1.0);
    test_set(&m, "poisson_ratio", 0.3);
    test_set(&m, "void_ratio", 1.1);
    test_set(&m, "preconsolidation_pressure_pa", 1.2e5);
  } else {
    test_set(&m, "youngs_modulus_pa", 1e7);
    test_set(&m, "poisson_ratio", 0.3);
  }
  if (strcmp(name, "drucker_prager") == 0) {
    test_set(&m, "friction_angle_deg", 25.0);
    test_set(&m, "cohesion_pa", 1e4);
  }
  return m;
}

/* Two bricks' cube under a pressure. */
static void start(const test_material *m, pw_fbar fbar, double pressure, pw_tet_mesh *mesh,
                  pw_tet_material *material, pw_tet_model *model)
{
  pw_tet_box box = test_cube(1, 2.0, 5, 10);
  *mesh = test_box_mesh(&box);
  material->model = m->model;
  memcpy(material->param, m->v, sizeof material->param);
  *model = test_model(mesh, material, PW_TET_RULE_FOUR, fbar);
  pw_tet_points *q = &model->points;
  for (pw_idx i = 0; i < 3 * q->n; i++) {
    q->stress[i / q->n * q->ld + i % q->n] = -pressure;
  }
  m->model->init(m->v, q->n, q->ld, q->stress, q->state);
  assert_ok(pw_tet_model_begin(model));
}

/* u = (F - 1) x of all nodes. */
static void displace(const pw_tet_mesh *mesh, const double *f, double *u)
{
  const size_t n = (size_t)mesh->tets.nnode;
  for (size_t a = 0; a < n; a++) {
    for (size_t i = 0; i < 3; i++) {
      u[i * n + a] = -mesh->tets.x[i * n + a];
      for (size_t j = 0; j < 3; j++) {
        u[i * n + a] += f[3 * i + j] * mesh->tets.x[j * n + a];
      }
    }
  }
}

/* Stretched in one step, then turned by 100 degrees in another: the stress turns along. */
static void stretch_is_logarithmic_and_rotation_free(void **state)
{
  (void)state;
  const char *const name[] = {"linear_elastic", "drucker_prager", "modified_cam_clay"};
  for (int k = 0; k < 3; k++) {
    test_material m = soil(name[k]);
    pw_tet_mesh mesh;
    pw_tet_material material;
    pw_tet_model model;
    double u[3 * 26], stretched[9] = {1.04, 0, 0, 0, 0.96, 0, 0, 0, 1.01};
    start(&m, PW_FBAR_INCREMENT, 6e4, &mesh, &material, &model);
    pw_tet_points *q = &model.points;
    displace(&mesh, stretched, u);
    assert_ok(pw_tet_model_evaluate(&model, u, false));
    pw_element el = test_start(&m, 6e4);
    const pw_real log_f[6] = {log(1.04), log(0.96), log(1.01)};
    assert_ok(pw_element_move(&el, log_f, NULL, NULL));
    for (pw_idx i = 0; i < q->n; i++) {
      for (pw_idx c = 0; c < 6; c++) {
        assert_near(q->stress_trial[c * q->ld + i], el.stress[c], 1e-9 * 6e4);
        q->stress[c * q->ld + i] = q->stress_trial[c * q->ld + i];
      }
    }
    const double angle = 100.0 * 3.14159265358979323846 / 180.0, c = cos(angle), s = sin(angle);
    const double turned[9] = {c, -s, 0, s, c, 0, 0, 0, 1};
    displace(&mesh, turned, u);
    assert_ok(pw_tet_model_evaluate(&model, u, false));
    for (pw_idx i = 0; i < q->n; i++) {
      const pw_real *now = q->stress_trial + i, *old = q->stress + i;
      const pw_rot r = {c, -s, 0, s, c, 0, 0, 0, 1};
      pw_t6 want = pw_t6_rotate(r, pw_t6_load(old, (size_t)q->ld));
      pw_t6 off = pw_t6_axpy(pw_t6_load(now, (size_t)q->ld), -1.0, want);
      assert_true(pw_t6_norm(off) < 1e-11 * 6e4 * 100.0);
    }
    pw_tet_model_destroy(&model);
    pw_tet_mesh_destroy(&mesh);
  }
}

static double tangent_error(pw_tet_model *m, const double *u, uint64_t *seed)
{
  double d[3 * 26], moved[3 * 26], up[3 * 26], x[3 * 26], product[3 * 26], error = 0.0, size = 0.0;
  const double h = 1e-6;
  test_displace(26, 1.0, seed, d);
  for (int side = 1; side >= -1; side -= 2) {
    for (int i = 0; i < 3 * 26; i++) {
      moved[i] = u[i] + side * h * d[i];
    }
    assert_ok(pw_tet_model_evaluate(m, moved, false));
    for (int i = 0; i < 3 * 26; i++) {
      up[i] = side > 0 ? m->force[i] : (up[i] - m->force[i]) / (2.0 * h);
    }
  }
  assert_ok(pw_tet_model_evaluate(m, u, true));
  for (int i = 0; i < 3 * 26; i++) {
    x[m->equation[i]] = d[i];
  }
  pw_csr_multiply(&m->csr, x, product);
  for (int i = 0; i < 3 * 26; i++) {
    error += pow(product[m->equation[i]] - up[i], 2.0);
    size += up[i] * up[i];
  }
  return sqrt(error / size);
}

/* Displacements of up to 5 % of the edge in one step, with rotation, from an isotropic pressure. */
static void tangent_is_that_of_the_force(void **state)
{
  (void)state;
  const char *const name[] = {"linear_elastic", "drucker_prager", "modified_cam_clay"};
  uint64_t seed = 3;
  for (int k = 0; k < 9; k++) {
    test_material m = soil(name[k % 3]);
    pw_tet_mesh mesh;
    pw_tet_material material;
    pw_tet_model model;
    double u[3 * 26], noise[3 * 26];
    const double turned[9] = {0.99, -0.15, 0.02, 0.15, 0.99, -0.1, 0.01, 0.1, 0.97};
    start(&m, (pw_fbar)(k / 3), 6e4, &mesh, &material, &model);
    displace(&mesh, turned, u);
    test_displace(26, 0.02, &seed, noise);
    for (int i = 0; i < 3 * 26; i++) {
      u[i] += noise[i];
    }
    double error = tangent_error(&model, u, &seed);
    print_message("%s F-bar %d: %.1e\n", name[k % 3], k / 3, error);
    assert_true(error < 1e-7);
    assert_false(pw_tet_model_is_symmetric(&model));
    pw_tet_model_destroy(&model);
    pw_tet_mesh_destroy(&mesh);
  }
}

/* ln V and R of a given V R, from tiny to large. */
static void increment_splits_into_stretch_and_rotation(void **state)
{
  (void)state;
  uint64_t seed = 7;
  for (int k = 0; k < 200; k++) {
    const double size = pow(10.0, -9.0 + 9.0 * test_random(&seed));
    pw_real e[6];
    for (int c = 0; c < 6; c++) {
      e[c] = 0.3 * size * (test_random(&seed) - 0.5);
    }
    const pw_real w[3] = {size * (test_random(&seed) - 0.5), size * (test_random(&seed) - 0.5),
                          size};
    const pw_rot r = pw_rot_hughes_winget(w[0], w[1], w[2]);
    const pw_t6 v = pw_t6_exp_twice(pw_t6_scale(0.5, pw_t6_load(e, 1)));
    const pw_real f[9] = {
        v.xx * r.xx + v.xy * r.yx + v.zx * r.zx, v.xx * r.xy + v.xy * r.yy + v.zx * r.zy,
        v.xx * r.xz + v.xy * r.yz + v.zx * r.zz, v.xy * r.xx + v.yy * r.yx + v.yz * r.zx,
        v.xy * r.xy + v.yy * r.yy + v.yz * r.zy, v.xy * r.xz + v.yy * r.yz + v.yz * r.zz,
        v.zx * r.xx + v.yz * r.yx + v.zz * r.zx, v.zx * r.xy + v.yz * r.yy + v.zz * r.zy,
        v.zx * r.xz + v.yz * r.yz + v.zz * r.zz};
    pw_log_increment inc;
    pw_log_increment_of(f, &inc);
    for (int c = 0; c < 6; c++) {
      assert_near(inc.strain[c], e[c], 4e-15);
      assert_near(inc.spin[c % 3], w[c % 3], 4e-15);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stretch_is_logarithmic_and_rotation_free),
      cmocka_unit_test(tangent_is_that_of_the_force),
      cmocka_unit_test(increment_splits_into_stretch_and_rotation),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
