/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elastic blocks: turned as a whole they stay free of stress, turned under stress on a mesh that
 * turns with them they keep it; pressed while nearly incompressible they do not lock with F-bar.
 * Reactions of the bonded block are those of an independent program. */
#include "engine/step_newton.h"
#include "tests/tet_helpers.h"

typedef struct {
  pw_tet_mesh mesh;
  pw_tet_material material;
  pw_tet_model model;
  pw_newton *newton;
  pw_newton_report report;
  double turn, angle; /* of the step, so far; rad */
  double squeeze;     /* strain of the core along x in the step */
  bool moving;        /* the mesh turns with the block */
} block;

/* Nodes of the core follow the motion given exactly; [3][nnode] of u. */
static void drive(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const block *b = ctx;
  const pw_idx n = m->mesh->tets.nnode;
  const double part = t1 - t0, s = sin(part * b->turn), half = sin(0.5 * part * b->turn);
  for (pw_idx a = 0; a < n; a++) {
    double x = m->mesh->x[a], y = m->mesh->x[n + a], c = -2.0 * half * half;
    m->prescribed[a] = c * x - s * y + part * b->squeeze * x;
    m->prescribed[n + a] = s * x + c * y;
  }
}

static pw_status follow(void *ctx, pw_tet_model *m, pw_real t1)
{
  const block *b = ctx;
  const pw_real axis[3] = {0, 0, 1}, shift[3] = {0};
  pw_real rot[9];
  pw_rotation_about(axis, b->moving ? b->angle + t1 * b->turn : 0.0, rot);
  return pw_tet_mesh_move(m->mesh, rot, shift);
}

/* A plate of edge 2 of 9 bricks around the origin; the middle brick is filled on a fixed mesh and
 * held at its lower face, all of them on a moving one and held on the core |x|, |y| < 0.5. */
static void start(pw_fbar fbar, bool moving, block *b)
{
  pw_tet_box box = {.bricks = {3, 3, 1}, .low = {-1, -1, -0.3}, .high = {1, 1, 0.3}};
  box.per_brick = 6;
  box.nodes = 10;
  memset(b, 0, sizeof *b);
  b->moving = moving;
  b->mesh = test_box_mesh(&box);
  b->material = test_von_mises(1e3, 0.3, "yield_radius_pa", 1e9, 0.0);
  pw_idx body[6 * 9];
  for (pw_idx p = 0; p < 6 * 9; p++) {
    body[p] = moving || p / 6 == 4 ? 0 : -1;
  }
  pw_tet_fill fill = {
      .rule = PW_TET_RULE_FOUR, .body = body, .nmaterial = 1, .material = &b->material};
  pw_tet_setup setup = {.mesh = &b->mesh, .fill = &fill, .fbar = fbar, .threads = 1};
  assert_ok(pw_tet_model_create(&setup, &b->model));
  const pw_idx n = b->mesh.tets.nnode;
  for (pw_idx a = 0; a < n; a++) {
    bool held = moving ? fabs(b->mesh.x[a]) < 0.5 && fabs(b->mesh.x[n + a]) < 0.5
                       : b->mesh.x[2 * n + a] == -0.3;
    for (int c = 0; c < 3; c++) {
      b->model.fixed[c * n + a] = held;
    }
  }
  pw_newton_options options = pw_newton_defaults();
  options.mechanisms = PW_MECHANISMS_ERROR;
  assert_ok(pw_newton_create(&b->model, &options, &b->newton));
}

static void end(block *b)
{
  pw_newton_destroy(&b->newton);
  pw_tet_model_destroy(&b->model);
  pw_tet_mesh_destroy(&b->mesh);
}

static void step(block *b)
{
  pw_newton_load load = {.ctx = b, .apply = drive, .move = follow};
  assert_ok(pw_newton_step(b->newton, &load, &b->report));
  b->angle += b->turn;
}

/* Root mean square of (stress - other turned by `angle` about z), all components. */
static double stress_distance(const block *b, const double *other, double angle)
{
  const pw_tet_points *p = &b->model.points;
  const double axis[3] = {0, 0, 1};
  double rot[9], sum = 0.0;
  pw_rotation_about(axis, angle, rot);
  pw_rot r = {rot[0], rot[1], rot[2], rot[3], rot[4], rot[5], rot[6], rot[7], rot[8]};
  for (pw_idx i = 0; i < p->n; i++) {
    pw_t6 now = pw_t6_load(p->stress + i, (size_t)p->ld), was = {0};
    if (other) {
      was = pw_t6_rotate(r, pw_t6_load(other + i, (size_t)p->ld));
    }
    pw_t6 d = pw_t6_axpy(now, -1.0, was);
    sum += pw_t6_dot(d, d);
  }
  return sqrt(sum / p->n);
}

static void turning_makes_no_stress(void **state)
{
  (void)state;
  const int steps[] = {12, 36}; /* of 30 and 10 degrees: a full turn */
  for (int moving = 0; moving < 2; moving++) {
    for (int k = 0; k < 2; k++) {
      block b;
      start(PW_FBAR_INCREMENT, moving, &b);
      b.turn = 2.0 * acos(-1.0) / steps[k];
      for (int i = 0; i < steps[k] + 1; i++) {
        step(&b);
        assert_true(stress_distance(&b, NULL, 0.0) <= 1e-12 * 1e3);
      }
      end(&b);
    }
  }
}

static void stress_turns_with_the_mesh(void **state)
{
  (void)state;
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_TOTAL; fbar++) {
    block b;
    static double first[6 * 8000];
    start((pw_fbar)fbar, true, &b);
    assert_true(6 * b.model.points.ld <= 6 * 8000);
    b.squeeze = -0.03; /* the core pulls the free outer part along */
    step(&b);
    b.squeeze = 0.0;
    b.turn = acos(-1.0) / 6.0;
    step(&b); /* back to balance after the mesh was put back */
    memcpy(first, b.model.points.stress, 6 * (size_t)b.model.points.ld * sizeof *first);
    double size = stress_distance(&b, NULL, 0.0);
    for (int i = 0; i < 12; i++) {
      step(&b);
    }
    double change = stress_distance(&b, first, 2.0 * acos(-1.0)) / size;
    print_message("F-bar %d: stress %.3g Pa rms, changed by %.1e of it in a turn\n", fbar, size,
                  change);
    assert_true(size > 1.0);
    assert_true(change < 1e-2);
    end(&b);
  }
}

static void press(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const pw_idx n = m->mesh->tets.nnode;
  (void)ctx;
  for (pw_idx a = 0; a < n; a++) {
    m->prescribed[n + a] = -0.05 * (t1 - t0) * m->mesh->tets.x[n + a];
  }
}

/* The unit cube between two faces that stick to it, pressed by 5 % in one step; N. */
static double bonded(pw_idx bricks, double poisson, pw_fbar fbar, int *iterations)
{
  pw_tet_box box = test_cube(bricks, 1.0, 6, 10);
  box.diagonal = PW_TET_DIAGONAL_ALONG_X;
  pw_tet_mesh mesh = test_box_mesh(&box);
  pw_tet_material m = test_von_mises(1e3, poisson, "yield_radius_pa", 1e9, 0.0);
  pw_tet_model model = test_model(&mesh, &m, PW_TET_RULE_ONE, fbar);
  pw_newton_options options = pw_newton_defaults();
  pw_newton_load load = {.apply = press};
  pw_newton_report report;
  pw_newton *newton;
  const pw_idx n = mesh.tets.nnode;
  double sum = 0.0;
  for (pw_idx i = 0; i < 3 * n; i++) {
    double y = mesh.tets.x[n + i % n];
    model.fixed[i] = y == 0.0 || y == 1.0;
  }
  assert_ok(pw_newton_create(&model, &options, &newton));
  assert_ok(pw_newton_step(newton, &load, &report));
  for (pw_idx a = 0; a < n; a++) {
    sum += mesh.tets.x[n + a] == 1.0 ? model.force[n + a] : 0.0;
  }
  *iterations = report.iterations;
  assert_int_equal(report.parts, 1);
  pw_newton_destroy(&newton);
  pw_tet_model_destroy(&model);
  pw_tet_mesh_destroy(&mesh);
  return sum;
}

/* The inner diagonals change the figures: -72.4 to -76.1 N for nu = 0.49 with F-bar, -118 to -124 N
 * without, -2258 to -3114 N for nu = 0.4999 without. Those here are of a division unknown in its
 * ties; diagonals along x come nearest in all six. */
static void bonded_block_does_not_lock_with_fbar(void **state)
{
  (void)state;
  const struct {
    double poisson, barred, plain;
  } figures[] = {{0.49, -72.9, -124.0}, {0.499, -74.4, -410.0}, {0.4999, -74.6, -2940.0}};
  int iterations[2];
  double coarse = 0.0, finer = 0.0;
  for (int i = 0; i < 3; i++) {
    double barred = bonded(2, figures[i].poisson, PW_FBAR_INCREMENT, &iterations[0]);
    double plain = bonded(2, figures[i].poisson, PW_FBAR_NONE, &iterations[1]);
    print_message("nu %g: F-bar %.2f N (%d iterations), F %.1f N (%d)\n", figures[i].poisson,
                  barred, iterations[0], plain, iterations[1]);
    assert_relative(barred, figures[i].barred, 0.01);
    assert_relative(plain, figures[i].plain, 0.04);
    assert_true(iterations[0] <= 5);
    coarse = i == 1 ? barred : coarse;
  }
  finer = bonded(4, 0.499, PW_FBAR_INCREMENT, &iterations[0]); /* towards -67.5 +- 0.5 */
  print_message("nu 0.499, twice as fine: %.2f N\n", finer);
  assert_true(finer < -67.0 && fabs(finer + 67.5) < 0.4 * fabs(coarse + 67.5));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(turning_makes_no_stress),
      cmocka_unit_test(stress_turns_with_the_mesh),
      cmocka_unit_test(bonded_block_does_not_lock_with_fbar),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
