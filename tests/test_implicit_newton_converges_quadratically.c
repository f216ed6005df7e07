/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Newton's method on plastic blocks pressed between rough faces by 1e-3 in a step, r_k the residual
 * over the reactions, after every iteration of five steps. A point is elastic, or returned to a
 * smooth face or to an edge of the yield surface; the forces are smooth only while no point changes
 * from one to another. Over an iteration from r_k to r_{k+1} that changes none
 *   - log r_{k+1} / log r_k >= 1.8 from the third residual down to rounding, on the smooth surface of
 *     von Mises, where r_{k+1} / r_k^2 is 4 at most;
 *   - on every surface the part s of the correction leaves (1 - s) r_k and a rest of the order of
 *     s^2: the tangent is exact. With edges r_{k+1} / r_k^2 reaches some 200, the curvature where
 *     two principal strains nearly coincide, and the same exponent needs smaller residuals.
 * Where it was less than 1.8 before (1.65 of von Mises with F-bar), points have changed. Models in
 * rate form give an unsymmetric matrix without F-bar too. */
#include "engine/step_newton.h"
#include "kernels/spectral.h"
#include "tests/tet_helpers.h"

static const double rounding = 1e-11;

enum { DOFS = 3 * 343, POINTS = 1296, MOST = 12 };
enum { ELASTIC, FACE, EDGE };

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

/* A block in a step: iterate k is that of a driver which stops there. */
typedef struct {
  pw_tet_mesh mesh;
  pw_tet_material material;
  pw_tet_model model;
  double strain;
  double plastic[POINTS]; /* before the step */
  int count;
  double residual[MOST], u[MOST][DOFS];
  uint8_t branch[MOST][POINTS];
} block;

static void start(const variant *v, double strain, block *b)
{
  pw_tet_box box = test_cube(3, 1.0, 6, 10);
  memset(b, 0, sizeof *b);
  b->mesh = test_box_mesh(&box);
  b->material = material_of(v->name);
  b->model = test_model(&b->mesh, &b->material, PW_TET_RULE_ONE, v->fbar);
  b->strain = strain;
  const pw_idx n = b->mesh.tets.nnode;
  assert_true(3 * n == DOFS && b->model.points.n == POINTS);
  for (pw_idx i = 0; i < 3 * n; i++) {
    double y = b->mesh.tets.x[n + i % n];
    b->model.fixed[i] = y == 0.0 || y == 1.0;
  }
  assert_int_equal(pw_tet_model_is_symmetric(&b->model), v->symmetric);
}

/* Every model has its plastic strain first among its states. */
static uint8_t branch_of(const block *b, pw_idx i)
{
  const pw_tet_points *q = &b->model.points;
  if (q->state_trial[i] == b->plastic[i]) {
    return ELASTIC;
  }
  pw_spectrum s = pw_t6_spectrum(pw_t6_load(q->stress_trial + i, (size_t)q->ld));
  double size = fabs(s.value[0]) + fabs(s.value[1]) + fabs(s.value[2]);
  bool equal = false;
  for (int k = 0; k < 3; k++) {
    equal = equal || fabs(s.value[k] - s.value[(k + 1) % 3]) < 1e-9 * size;
  }
  return equal ? EDGE : FACE;
}

/* The next iterate, from the start of the step; the last one is committed. */
static pw_status iterate(block *b)
{
  const int k = b->count++;
  pw_newton_options options = pw_newton_defaults();
  pw_newton_load load = {.ctx = &b->strain, .apply = press};
  pw_newton_report report;
  pw_newton *newton;
  options.max_iterations = b->count;
  options.max_cuts = options.approach = 0;
  options.from_previous = false;
  assert_true(b->count < MOST);
  assert_ok(pw_newton_create(&b->model, &options, &newton));
  pw_status s = pw_newton_step(newton, &load, &report);
  assert_int_equal(report.count, b->count);
  b->residual[k] = report.residual[k];
  memcpy(b->u[k], pw_newton_displacement(newton), sizeof b->u[k]);
  for (pw_idx i = 0; i < POINTS; i++) {
    b->branch[k][i] = branch_of(b, i);
  }
  pw_newton_destroy(&newton);
  return s;
}

/* Points that changed over the iteration to the last iterate. */
static int changed(const block *b)
{
  int sum = 0;
  for (pw_idx i = 0; i < POINTS; i++) {
    sum += b->branch[b->count - 1][i] != b->branch[b->count - 2][i];
  }
  return sum;
}

/* Norm of what the part s of the last correction leaves beyond 1 - s of the forces before. */
static double rest_of(block *b, double s)
{
  static double u[DOFS], before[DOFS];
  const double *from = b->u[b->count - 2], *to = b->u[b->count - 1];
  double sum = 0.0;
  assert_ok(pw_tet_model_evaluate(&b->model, from, false));
  memcpy(before, b->model.force, sizeof before);
  for (int i = 0; i < DOFS; i++) {
    u[i] = from[i] + s * (to[i] - from[i]);
  }
  assert_ok(pw_tet_model_evaluate(&b->model, u, false));
  for (int i = 0; i < DOFS; i++) {
    double rest = b->model.force[i] - (1.0 - s) * before[i];
    sum += b->model.equation[i] >= 0 ? rest * rest : 0.0;
  }
  return sqrt(sum);
}

typedef struct {
  double least, most; /* exponent on one branch; r_{k+1} / r_k^2 there */
  int exponents, rests, excused;
} findings;

static void check_iteration(const variant *v, block *b, bool committed, findings *f)
{
  const int k = b->count - 2;
  const double now = b->residual[k], next = b->residual[k + 1];
  const int moved = changed(b);
  const double exponent = log(next) / log(now);
  print_message(" %.1e (%d)", next, moved);
  assert_true(k == 0 || next < now);
  if (moved == 0 && next > rounding) {
    f->most = fmax(f->most, next / (now * now));
    if (!committed) {
      double half = rest_of(b, 0.5), quarter = rest_of(b, 0.25);
      assert_near(quarter / half, 0.25, 0.01);
      f->rests++;
    }
  }
  if (v->edges || k < 1 || next <= rounding) {
    return;
  }
  if (moved == 0) {
    f->least = fmin(f->least, exponent);
    assert_true(exponent >= 1.8);
    f->exponents++;
  } else {
    f->excused += exponent < 1.8;
  }
}

/* Five steps. */
static findings run(const variant *v, double strain)
{
  static block b;
  findings f = {.least = INFINITY};
  start(v, strain, &b);
  for (int step = 0; step < 5; step++) {
    pw_status s = PW_RETRY_DIVERGED;
    memcpy(b.plastic, b.model.points.state, sizeof b.plastic);
    print_message("%s, F-bar %d, step %d, residuals (points changed):", v->name, (int)v->fbar,
                  step);
    for (b.count = 0; s == PW_RETRY_DIVERGED;) {
      s = iterate(&b);
      if (b.count > 1) {
        check_iteration(v, &b, s == PW_OK, &f);
      } else {
        print_message(" %.1e", b.residual[0]);
      }
    }
    print_message("\n");
    assert_ok(s);
    assert_true(b.count <= 8);
  }
  pw_tet_model_destroy(&b.model);
  pw_tet_mesh_destroy(&b.mesh);
  return f;
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
    findings f = run(&variants[k], 1e-3);
    print_message(
        "%s, F-bar %d: least exponent %.2f of %d on one branch, %d below 1.8 where points "
        "changed; r_{k+1}/r_k^2 at most %.1f; %d rests of order 2\n",
        variants[k].name, (int)variants[k].fbar, f.least, f.exponents, f.excused, f.most, f.rests);
    assert_true(variants[k].edges || f.exponents >= 5);
    assert_true(f.rests >= 2);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(residuals_fall_as_squares),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
