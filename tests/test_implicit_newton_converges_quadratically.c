/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Newton's method on plastic blocks pressed between rough faces by 1e-3 in a step, r_k the residual
 * over the reactions. Where the yield surface is smooth, from the third iteration on in every step
 * r_{k+1} <= 10 r_k^2, and below 1e-2, while yield no longer spreads, log r_{k+1} / log r_k >= 1.8;
 * rounding ends it between 1e-13 and 1e-11. Where the surface has edges, points change from a plane to an
 * edge on the way: the last iteration is quadratic, by the same measure or by the slope of log r_k,
 * log(r_{k+1}/r_k) / log(r_k/r_{k-1}) >= 1.8. Models in rate form give an unsymmetric matrix
 * without F-bar too. */
#include "engine/step_newton.h"
#include "tests/tet_helpers.h"

static const double rounding = 1e-11;

typedef struct {
  const char *name;
  pw_fbar fbar;
  bool symmetric; /* the tangent */
  bool edges;
} variant;

static pw_tet_material material_of(const char *name)
{
  if (strcmp(name, "hencky_von_mises") == 0) {
    return test_von_mises(1e3, 0.3, "yield_radius_pa", 1.0, 10.0);
  }
  test_material m = test_material_of(name);
  pw_tet_material out = {.model = m.model};
  if (strcmp(name, "tresca") == 0) {
    test_set(&m, "undrained_shear_strength_pa", 1.0);
    test_set(&m, "rigidity_index", 400.0);
    test_set(&m, "poisson_ratio", 0.45);
  } else {
    test_set(&m, "youngs_modulus_pa", 1e3);
    test_set(&m, "poisson_ratio", 0.3);
    test_set(&m, "friction_angle_deg", 30.0);
    test_set(&m, "dilation_angle_deg", 5.0);
    test_set(&m, "cohesion_pa", 1.0);
  }
  test_set(&m, "density_kg_m3", 1.0);
  memcpy(out.param, m.v, sizeof out.param);
  return out;
}

static void press(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const pw_idx n = m->mesh->tets.nnode;
  const double strain = *(const double *)ctx;
  for (pw_idx a = 0; a < n; a++) {
    m->prescribed[n + a] = -strain * (t1 - t0) * m->mesh->tets.x[n + a];
  }
}

static void check_history(const variant *v, const pw_newton_report *r, double *least)
{
  const int last = r->count - 1;
  for (int k = v->edges ? last - 1 : 2; k < last; k++) {
    const double now = r->residual[k], next = r->residual[k + 1];
    const double before = k > 0 ? r->residual[k - 1] : 1.0;
    const bool steep = v->edges && log(next / now) / log(now / before) >= 1.8;
    assert_true(next <= 10.0 * now * now || next < rounding || steep);
    if (!v->edges && now < 1e-2 && next > rounding) {
      *least = fmin(*least, log(next) / log(now));
    }
  }
}

/* Three steps; the least exponent and the most iterations of them. */
static double least_exponent(const variant *v, double strain, int *most)
{
  pw_tet_box box = test_cube(3, 1.0, 6, 10);
  pw_tet_mesh mesh = test_box_mesh(&box);
  pw_tet_material material = material_of(v->name);
  pw_tet_model model = test_model(&mesh, &material, PW_TET_RULE_ONE, v->fbar);
  pw_newton_options options = pw_newton_defaults();
  pw_newton_load load = {.ctx = &strain, .apply = press};
  pw_newton_report report;
  pw_newton *newton;
  double least = INFINITY;
  const pw_idx n = mesh.tets.nnode;
  for (pw_idx i = 0; i < 3 * n; i++) {
    double y = mesh.tets.x[n + i % n];
    model.fixed[i] = y == 0.0 || y == 1.0;
  }
  options.from_previous = false;
  assert_ok(pw_newton_create(&model, &options, &newton));
  assert_int_equal(pw_tet_model_is_symmetric(&model), v->symmetric);
  *most = 0;
  for (int k = 0; k < 3; k++) {
    assert_ok(pw_newton_step(newton, &load, &report));
    assert_int_equal(report.cuts + report.approaches, 0);
    *most = report.iterations > *most ? report.iterations : *most;
    print_message("%s, F-bar %d, step %d:", v->name, (int)v->fbar, k);
    for (int i = 0; i < report.count; i++) {
      print_message(" %.1e", report.residual[i]);
    }
    print_message("\n");
    check_history(v, &report, &least);
  }
  pw_newton_destroy(&newton);
  pw_tet_model_destroy(&model);
  pw_tet_mesh_destroy(&mesh);
  return least;
}

static void residuals_fall_as_squares(void **state)
{
  (void)state;
  const variant variants[] = {{"hencky_von_mises", PW_FBAR_NONE, true, false},
                              {"hencky_von_mises", PW_FBAR_INCREMENT, false, false},
                              {"hencky_von_mises", PW_FBAR_TOTAL, false, false},
                              {"tresca", PW_FBAR_NONE, false, true},
                              {"mohr_coulomb", PW_FBAR_NONE, false, true},
                              {"mohr_coulomb", PW_FBAR_INCREMENT, false, true}};
  for (int k = 0; k < 6; k++) {
    int most;
    double least = least_exponent(&variants[k], 1e-3, &most);
    print_message("%s, F-bar %d: exponent %.2f, at most %d iterations\n", variants[k].name,
                  (int)variants[k].fbar, least, most);
    assert_true(variants[k].edges || (least >= 1.8 && least < 10.0));
    assert_true(most <= 8);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(residuals_fall_as_squares),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
