/* SPDX-License-Identifier: GPL-3.0-or-later */
/* UMATs in implicit steps: a block is pressed and twisted between rough plates until most of it
 * flows. A routine in rate form gives what a built-in model of the same equations gives (von Mises
 * without hardening: drucker_prager without friction), one that takes the deformation gradient what
 * hencky_von_mises gives, with and without F-bar, on 1 and 2 threads; Newton's method converges
 * quadratically; PNEWDT < 1 makes pieces of the step, failures halve it or tell why; times, numbers
 * and gradients. */
#include "engine/step_newton.h"
#include "tests/tet_helpers.h"
#include "tests/umat_helpers.h"

typedef struct block {
  pw_tet_mesh mesh;
  pw_tet_material material;
  pw_tet_model model;
  pw_newton *newton;
  pw_newton_report report;
  double angle, down; /* of the upper plate in a load step; rad, m */
} block;

/* The plate turns about the middle axis and comes down; nodes are where they began. */
static void press(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const block *b = ctx;
  const size_t n = (size_t)m->mesh->tets.nnode;
  for (size_t a = 0; a < n; a++) {
    const pw_real *x = m->mesh->tets.x + a, r[2] = {x[0] - 0.5, x[2 * n] - 0.5};
    const bool plate = x[n] == 1.0;
    const pw_real turn = plate ? b->angle * (t1 - t0) : 0.0, c = cos(turn), s = sin(turn);
    m->prescribed[a] = c * r[0] + s * r[1] - r[0];
    m->prescribed[n + a] = plate ? -b->down * (t1 - t0) : 0.0;
    m->prescribed[2 * n + a] = c * r[1] - s * r[0] - r[1];
  }
}

static void start_block(const pw_material *model, const pw_real *param, pw_fbar fbar, int threads,
                        block *b)
{
  pw_tet_box box = test_cube(2, 1.0, 6, 10);
  memset(b, 0, sizeof *b);
  b->mesh = test_box_mesh(&box);
  b->material.model = model;
  memcpy(b->material.param, param, sizeof b->material.param);
  b->angle = 0.02;
  b->down = 0.01;
  pw_tet_fill fill = {.rule = PW_TET_RULE_FOUR, .nmaterial = 1, .material = &b->material};
  pw_tet_setup setup = {.mesh = &b->mesh, .fill = &fill, .fbar = fbar, .threads = threads};
  assert_ok(pw_tet_model_create(&setup, &b->model));
  const pw_idx n = b->mesh.tets.nnode;
  for (pw_idx i = 0; i < 3 * n; i++) {
    const pw_real y = b->mesh.tets.x[n + i % n];
    b->model.fixed[i] = y == 0.0 || y == 1.0;
  }
  pw_newton_options options = pw_newton_defaults();
  options.tolerance = 1e-12;
  options.cut_driven = true;
  assert_ok(pw_newton_create(&b->model, &options, &b->newton));
}

static pw_status step_block(block *b, int k, int n)
{
  const pw_newton_load load = {
      .ctx = b, .start_s = 10.0 + 4.0 * k / n, .step_s = 4.0 / n, .apply = press};
  return pw_newton_step(b->newton, &load, &b->report);
}

static void end_block(block *b)
{
  pw_newton_destroy(&b->newton);
  pw_tet_model_destroy(&b->model);
  pw_tet_mesh_destroy(&b->mesh);
}

static pw_scene_material hencky_umat(double yield, double hardening)
{
  pw_scene_material m = umat_material("umat_hencky_", yield, hardening);
  umat_number(&m, "nstatv", 7);
  umat_number(&m, "ddsdde_measure", 1);
  umat_number(&m, "thread_safe", 1);
  return m;
}

static test_material built_in(const char *name, const char *key, double strength, double hardening)
{
  test_material m = test_material_of(name);
  test_set(&m, "youngs_modulus_pa", 1e7);
  test_set(&m, "poisson_ratio", 0.3);
  test_set(&m, "density_kg_m3", 1800.0);
  test_set(&m, key, strength);
  if (hardening > 0.0) {
    test_set(&m, "hardening_modulus_pa", hardening);
  }
  return m;
}

/* Stress over the yield stress, places, plastic strain of all points; @p plastic: its place among
 * the state of the second. */
static void assert_same(const block *a, const block *b, double yield, int plastic)
{
  const pw_tet_points *p = &a->model.points, *q = &b->model.points;
  double worst = 0.0, flow = 0.0;
  int flowing = 0;
  assert_int_equal(p->n, q->n);
  for (pw_idx i = 0; i < p->n; i++) {
    for (pw_idx c = 0; c < 6; c++) {
      worst = fmax(worst, fabs(p->stress[c * p->ld + i] - q->stress[c * q->ld + i]) / yield);
    }
    for (pw_idx c = 0; c < 3; c++) {
      worst = fmax(worst, fabs(p->x[c * p->ld + i] - q->x[c * q->ld + i]));
    }
    double one = p->state[PW_UMAT_OWN * p->ld + i], other = q->state[plastic * q->ld + i];
    worst = fmax(worst, fabs(one - other));
    flow = fmax(flow, one);
    flowing += one > 0.0;
  }
  print_message("largest difference %.1e, plastic strain up to %.3g at %d of %d points\n", worst,
                flow, flowing, (int)p->n);
  assert_true(worst <= 1e-10);
  assert_true(flow > 5e-3 && flowing > p->n / 2);
}

static void compare(const pw_scene_material *user, const test_material *own, pw_fbar fbar,
                    double yield, int plastic)
{
  for (int threads = 1; threads <= 2; threads++) {
    block a, b;
    start_block(user->model, user->param, fbar, threads, &a);
    start_block(own->model, own->v, fbar, threads, &b);
    for (int k = 0; k < 3; k++) {
      assert_ok(step_block(&a, k, 3));
      assert_ok(step_block(&b, k, 3));
      assert_int_equal(a.report.iterations, b.report.iterations);
    }
    assert_same(&a, &b, yield, plastic);
    end_block(&a);
    end_block(&b);
  }
}

static void rate_form_is_that_of_drucker_prager(void **state)
{
  (void)state;
  pw_scene_material user = umat_material("umat_", 5e4, 0.0);
  test_material own = built_in("drucker_prager", "cohesion_pa", 2.5e4, 0.0);
  test_set(&own, "friction_angle_deg", 0.0);
  compare(&user, &own, PW_FBAR_INCREMENT, 5e4, 0);
  compare(&user, &own, PW_FBAR_NONE, 5e4, 0);
}

static void finite_strain_is_that_of_hencky_von_mises(void **state)
{
  (void)state;
  pw_scene_material user = hencky_umat(5e4, 5e5);
  test_material own = built_in("hencky_von_mises", "yield_uniaxial_pa", 5e4, 5e5);
  compare(&user, &own, PW_FBAR_NONE, 5e4, 0);
  compare(&user, &own, PW_FBAR_INCREMENT, 5e4, 0);
  compare(&user, &own, PW_FBAR_TOTAL, 5e4, 0);
}

/* Residuals of the last iterations: each at most a multiple of the square of the one before. */
static void convergence_is_quadratic(void **state)
{
  (void)state;
  const pw_scene_material user[2] = {umat_material("umat_", 5e4, 5e5), hencky_umat(5e4, 5e5)};
  for (int k = 0; k < 2; k++) {
    block b;
    start_block(user[k].model, user[k].param, PW_FBAR_INCREMENT, 1, &b);
    assert_ok(step_block(&b, 0, 1));
    assert_int_equal(b.report.cuts, 0);
    const double *r = b.report.residual;
    int n = b.report.count, last = n - 1;
    for (int i = 0; i < n; i++) {
      print_message("%.1e ", r[i]);
    }
    print_message("\n");
    while (last > 1 && r[last - 1] < 1e-9) { /* those at the end are rounding */
      last--;
    }
    assert_true(n >= 4 && n <= 12);
    assert_true(r[last - 1] < 1e-2 && r[last] < 10.0 * r[last - 1] * r[last - 1] + 1e-12);
    end_block(&b);
  }
}

/* A routine that wants strains of at most 1e-4 in a call gets the step in pieces: the tangent of the
 * step is then found by differences, so that Newton's method still converges fast, and no strain is
 * lost: the same increments in steps that need no pieces end near the same stress. */
static void steps_are_made_in_pieces(void **state)
{
  (void)state;
  pw_scene_material cut = umat_material("umat_small_steps_", 5e4, 5e5);
  pw_scene_material whole = umat_material("umat_", 5e4, 5e5);
  block a, b;
  start_block(cut.model, cut.param, PW_FBAR_INCREMENT, 1, &a);
  start_block(whole.model, whole.param, PW_FBAR_INCREMENT, 1, &b);
  a.angle = b.angle = 0.0;
  a.down = b.down = 4e-3;
  assert_ok(step_block(&a, 0, 1));
  assert_ok(step_block(&b, 0, 1));
  for (int i = 0; i < a.report.count; i++) {
    print_message("%.1e ", a.report.residual[i]);
  }
  print_message("\n");
  assert_int_equal(a.report.cuts, 0);
  assert_true(a.report.count <= b.report.count + 2);
  const pw_tet_points *p = &a.model.points, *q = &b.model.points;
  double apart = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    apart = fmax(apart, fabs(p->stress[p->ld + i] - q->stress[q->ld + i]) / 5e4);
    assert_near(p->x[p->ld + i], q->x[q->ld + i], 2e-4);
  }
  print_message("one call or many of them: %.2g of the yield stress apart\n", apart);
  assert_true(apart > 1e-6 && apart < 0.1);
  end_block(&a);
  end_block(&b);
}

/* A routine that stops at large increments: Newton's method halves its step. */
static void failures_halve_the_load_step(void **state)
{
  (void)state;
  pw_scene_material user = umat_material("umat_fragile_", 5e4, 5e5);
  block a;
  start_block(user.model, user.param, PW_FBAR_NONE, 1, &a);
  a.angle = 0.0;
  a.down = 4e-3;
  assert_ok(step_block(&a, 0, 1));
  print_message("%d parts, %d cuts\n", a.report.parts, a.report.cuts);
  assert_true(a.report.cuts >= 1 && a.report.parts >= 2);
  const pw_tet_points *p = &a.model.points;
  double work = 0.0, volume = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    work += p->volume[i] * p->state[p->ld + i];
    volume += p->volume[i];
  }
  assert_relative(work / volume, -4e-3, 2e-2); /* STRAN yy: the mean is the plates' */
  end_block(&a);
}

static void failures_tell_why(void **state)
{
  (void)state;
  const char *const symbol[] = {"umat_stop_", "umat_nan_", "umat_never_content_", "umat_lazy_"};
  const char *const words[] = {"ended with STOP: no convergence", "not a finite number", "PNEWDT",
                               "a lost increment"};
  for (int k = 0; k < 4; k++) {
    pw_scene_material m = umat_material(symbol[k], 0.0, 0.0);
    block b;
    start_block(m.model, m.param, PW_FBAR_NONE, 1, &b);
    const pw_real before = b.model.points.x[0];
    assert_int_equal(step_block(&b, 0, 1), PW_RETRY_DIVERGED);
    if (!strstr(pw_error_text(), words[k]) || !strstr(pw_error_text(), "in element")) {
      fail_msg("'%s' does not say '%s'", pw_error_text(), words[k]);
    }
    assert_near(b.model.points.x[0], before, 0.0);
    assert_near(b.model.points.stress[0], 0.0, 0.0);
    end_block(&b);
  }
}

/* What the routine is told: TIME, DTIME, KINC, DROT, DFGRD0, DFGRD1 of the second of two steps. */
static void routines_are_told(void **state)
{
  (void)state;
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_TOTAL; fbar++) {
    pw_scene_material m = umat_material("umat_spy_", 0.0, 0.0);
    umat_number(&m, "nstatv", 28);
    umat_word(&m, "cmname", "SPY");
    block b;
    start_block(m.model, m.param, (pw_fbar)fbar, 1, &b);
    const pw_tet_points *p = &b.model.points;
    assert_ok(step_block(&b, 0, 2));
    static pw_real f[9][4000], x[3][4000];
    assert_true(p->n <= 4000);
    for (pw_idx k = 0; k < 9 * p->n; k++) {
      f[k / p->n][k % p->n] = p->def_grad[k / p->n * p->ld + k % p->n];
      x[k / p->n % 3][k % p->n] = p->x[k / p->n % 3 * p->ld + k % p->n];
    }
    assert_ok(step_block(&b, 1, 2));
    for (pw_idx i = 0; i < p->n; i++) {
      const pw_real *s = p->state + (pw_off)PW_UMAT_OWN * p->ld + i, *g = p->def_grad + i;
      const pw_idx l = p->ld;
      assert_near(s[6 * l], 12.0, 1e-12);
      assert_near(s[8 * l], 2.0, 1e-12);
      assert_near(s[9 * l], 2.0, 0.0);
      assert_near(s[11 * l] * s[14 * l] - s[12 * l] * s[13 * l], 1.0, 1e-2);
      assert_near(s[15 * l], f[0][i], 1e-13);
      assert_near(s[17 * l], f[1][i], 1e-13); /* 12 */
      assert_near(s[19 * l], g[0], 1e-13);
      assert_near(s[20 * l], g[3 * l], 1e-13); /* 21 */
      assert_near(s[24 * l], i + 1.0, 0.0);
      for (pw_idx c = 0; c < 3; c++) {
        assert_near(s[(25 + c) * l], x[c][i], 0.0);
      }
      const pw_real det = g[0] * (g[4 * l] * g[8 * l] - g[5 * l] * g[7 * l]) -
                          g[l] * (g[3 * l] * g[8 * l] - g[5 * l] * g[6 * l]) +
                          g[2 * l] * (g[3 * l] * g[7 * l] - g[4 * l] * g[6 * l]);
      assert_relative(det, p->jac_bar[i], 1e-13);
    }
    end_block(&b);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rate_form_is_that_of_drucker_prager),
      cmocka_unit_test(finite_strain_is_that_of_hencky_von_mises),
      cmocka_unit_test(convergence_is_quadratic),
      cmocka_unit_test(steps_are_made_in_pieces),
      cmocka_unit_test(failures_halve_the_load_step),
      cmocka_unit_test(failures_tell_why),
      cmocka_unit_test(routines_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
