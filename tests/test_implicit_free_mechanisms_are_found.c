/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pieces of elements joined by faces that hang on the rest by a vertex, an edge, or nothing: hand-made
 * meshes, whose rigid motions are counted by hand. */
#include "engine/step_newton.h"
#include "tests/tet_helpers.h"

typedef struct {
  pw_tet_mesh mesh;
  pw_tet_material material;
  pw_tet_model model;
  pw_mechanism scratch;
} body;

/* Linear bricks of six elements in a row along x; `filled` says which hold points. */
static void start(pw_idx bx, pw_idx by, const char *filled, body *b)
{
  pw_tet_box box = {.bricks = {bx, by, 1}, .high = {bx, by, 1}, .per_brick = 6, .nodes = 4};
  pw_idx fill_of[600];
  memset(b, 0, sizeof *b);
  b->mesh = test_box_mesh(&box);
  b->material = test_von_mises(1e3, 0.3, "yield_radius_pa", 1e9, 0.0);
  for (pw_idx p = 0; p < b->mesh.npatch; p++) {
    fill_of[p] = filled[p / 6] == 'x' ? 0 : -1;
  }
  pw_tet_fill fill = {
      .rule = PW_TET_RULE_ONE, .body = fill_of, .nmaterial = 1, .material = &b->material};
  pw_tet_setup setup = {.mesh = &b->mesh, .fill = &fill, .threads = 1};
  assert_ok(pw_tet_model_create(&setup, &b->model));
  assert_ok(pw_mechanism_create(&b->model, &b->scratch));
}

static void end(body *b)
{
  pw_mechanism_destroy(&b->scratch);
  pw_tet_model_destroy(&b->model);
  pw_tet_mesh_destroy(&b->mesh);
}

static void fix(body *b, double x, double y, double z, int c)
{
  const pw_tets *t = &b->mesh.tets;
  for (pw_idx a = 0; a < t->nnode; a++) {
    if (t->x[a] == x && t->x[t->nnode + a] == y && t->x[2 * t->nnode + a] == z) {
      b->model.fixed[c * t->nnode + a] = 1;
    }
  }
}

static pw_mechanism_report find(body *b)
{
  pw_mechanism_report r;
  assert_ok(pw_tet_model_begin(&b->model));
  pw_mechanism_find(&b->model, &b->scratch, &r);
  return r;
}

/* One brick held at a vertex turns in three ways, at an edge in one; any six components that hold a
 * rigid body are enough, six that do not are not. */
static void fixed_components_are_counted(void **state)
{
  (void)state;
  body b;
  start(1, 1, "x", &b);
  pw_mechanism_report r = find(&b);
  assert_true(r.pieces == 1 && r.free == 1 && r.elements == 6 && r.first == 0 && r.motions == 6);
  for (int c = 0; c < 3; c++) {
    fix(&b, 0, 0, 0, c);
  }
  assert_int_equal(find(&b).motions, 3);
  for (int c = 0; c < 3; c++) {
    fix(&b, 1, 0, 0, c);
  }
  assert_int_equal(find(&b).motions, 1);
  fix(&b, 0, 1, 0, 1); /* towards the axis: no help */
  assert_int_equal(find(&b).motions, 1);
  fix(&b, 0, 1, 0, 2);
  assert_int_equal(find(&b).free, 0);
  end(&b);
}

/* Two bricks of a square of four that touch at an edge: the diagonal from (1, 1, 0) to (1, 1, 1). */
static void an_edge_leaves_one_turn(void **state)
{
  (void)state;
  body b;
  start(2, 2, "x..x", &b);
  for (int c = 0; c < 3; c++) {
    fix(&b, 0, 0, 0, c);
    fix(&b, 1, 0, 0, c);
    fix(&b, 0, 1, 0, c);
  }
  pw_mechanism_report r = find(&b);
  assert_true(r.pieces == 2 && r.free == 1 && r.elements == 6 && r.motions == 1);
  assert_int_equal(r.first, 18);
  fix(&b, 2, 2, 0, 2); /* along the edge: no help */
  assert_int_equal(find(&b).free, 1);
  fix(&b, 2, 2, 0, 0);
  assert_int_equal(find(&b).free, 0);
  end(&b);
}

/* Bricks in a chain: the far one hangs on the middle one, which hangs on the held one; and a brick on
 * its own. */
static void chains_are_followed(void **state)
{
  (void)state;
  body b;
  start(3, 3, "x...x...x", &b);
  for (int c = 0; c < 3; c++) {
    fix(&b, 0, 0, 0, c);
    fix(&b, 1, 0, 0, c);
    fix(&b, 0, 1, 0, c);
  }
  pw_mechanism_report r = find(&b);
  assert_true(r.pieces == 3 && r.free == 2 && r.elements == 12 && r.first == 24);
  fix(&b, 2, 1, 0, 0); /* holds the middle one; the last stays free */
  fix(&b, 2, 1, 0, 1);
  r = find(&b);
  assert_true(r.free == 1 && r.first == 48 && r.motions == 1);
  end(&b);
  start(3, 1, "x.x", &b);
  for (int c = 0; c < 3; c++) {
    fix(&b, 0, 0, 0, c);
    fix(&b, 1, 0, 0, c);
    fix(&b, 0, 1, 0, c);
  }
  r = find(&b);
  assert_true(r.pieces == 2 && r.free == 1 && r.first == 12 && r.motions == 6);
  end(&b);
}

static void pull(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const pw_tets *t = &m->mesh->tets;
  (void)ctx, (void)t0;
  for (pw_idx a = 0; a < t->nnode; a++) {
    m->external[2 * t->nnode + a] = t->x[a] == 2.0 && t->x[t->nnode + a] == 2.0 ? 1e-3 * t1 : 0.0;
  }
}

/* A step counts them, or stops for them. */
static void steps_tell_them(void **state)
{
  (void)state;
  body b;
  pw_newton *newton;
  pw_newton_report report;
  pw_newton_options options = pw_newton_defaults();
  pw_newton_load load = {.apply = pull};
  start(2, 2, "x..x", &b);
  for (int c = 0; c < 3; c++) {
    fix(&b, 0, 0, 0, c);
    fix(&b, 1, 0, 0, c);
    fix(&b, 0, 1, 0, c);
  }
  options.mechanisms = PW_MECHANISMS_ERROR;
  assert_ok(pw_newton_create(&b.model, &options, &newton));
  assert_int_equal(pw_newton_step(newton, &load, &report), PW_ERR_SCENE);
  assert_int_equal(report.mechanisms.free, 1);
  assert_non_null(strstr(pw_error_text(), "of element 18, can move in 1 ways without strain"));
  pw_newton_destroy(&newton);
  fix(&b, 2, 2, 0, 0);
  assert_ok(pw_newton_create(&b.model, &options, &newton));
  assert_ok(pw_newton_step(newton, &load, &report));
  assert_int_equal(report.mechanisms.pieces, 2);
  pw_newton_destroy(&newton);
  end(&b);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fixed_components_are_counted),
      cmocka_unit_test(an_edge_leaves_one_turn),
      cmocka_unit_test(chains_are_followed),
      cmocka_unit_test(steps_tell_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
