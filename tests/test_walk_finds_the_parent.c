/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Owners found by walking are those of a search through all elements, wherever the walk starts. */
#include "tests/tet_helpers.h"

static pw_walk walk_on(const pw_tet_mesh *m)
{
  pw_walk w;
  assert_ok(pw_walk_create(&m->tets, &w));
  return w;
}

static pw_tet_mesh mesh_of(pw_idx nnode, const double *x, pw_idx ncell, const pw_idx *cell)
{
  pw_tet_input in = {.nnode = nnode, .x = x, .ncell = ncell, .nodes = 4, .cell = cell};
  pw_tet_mesh m;
  assert_ok(pw_tet_mesh_create(&in, &m));
  return m;
}

static void random_points_have_the_same_parent(void **state)
{
  (void)state;
  pw_tet_mesh m = test_shaken_mesh(8, 0.2, 1);
  pw_walk w = walk_on(&m);
  pw_walk_counts c = {0};
  uint64_t seed = 7;
  for (int i = 0; i < 20000; i++) {
    double x[3] = {test_random(&seed), test_random(&seed), test_random(&seed)};
    pw_idx from = (pw_idx)(test_random(&seed) * m.tets.nelem);
    assert_int_equal(pw_walk_find(&w, x, from, &c), pw_walk_search_all(&m.tets, x));
  }
  assert_int_equal(c.binned, 0); /* a convex mesh: no walk ends at its boundary */
  assert_int_equal(c.outside, 0);
  assert_true(c.tests < c.points * 3 * 8); /* of the order of the bricks along an edge */
  pw_walk_destroy(&w);
  pw_tet_mesh_destroy(&m);
}

/* Weights of a random point of a face (3 nodes), an edge (2) or a node (1) of an element. */
static void point_on(const pw_tets *t, pw_idx e, int nodes, uint64_t *seed, double *x)
{
  double weight[4], sum = 0.0;
  int first = (int)(4.0 * test_random(seed));
  for (int i = 0; i < nodes; i++) {
    sum += weight[i] = 0.01 + test_random(seed);
  }
  for (int c = 0; c < 3; c++) {
    x[c] = 0.0;
    for (int i = 0; i < nodes; i++) {
      x[c] += weight[i] / sum * t->x[c * t->nnode + t->node[4 * e + (first + i) % 4]];
    }
  }
}

static void ties_go_to_the_lowest_element(void **state)
{
  (void)state;
  pw_tet_mesh m = test_shaken_mesh(5, 0.2, 3);
  pw_walk w = walk_on(&m);
  pw_walk_counts c = {0};
  uint64_t seed = 11;
  for (int i = 0; i < 30000; i++) {
    pw_idx e = (pw_idx)(test_random(&seed) * m.tets.nelem), owner;
    double x[3];
    point_on(&m.tets, e, 1 + i % 3, &seed, x);
    owner = pw_walk_search_all(&m.tets, x);
    assert_in_range(owner, 0, e); /* e holds the point, so the owner is not above it */
    for (int k = 0; k < 3; k++) { /* from anywhere */
      pw_idx from = (pw_idx)(test_random(&seed) * m.tets.nelem);
      assert_int_equal(pw_walk_find(&w, x, from, &c), owner);
    }
  }
  assert_true(c.ties > 80000);
  assert_int_equal(c.outside, 0);
  pw_walk_destroy(&w);
  pw_tet_mesh_destroy(&m);
}

/* E13: a cube with a slot; a walk from one side of the slot to the other ends at its wall. */
static void points_outside_are_named(void **state)
{
  (void)state;
  pw_tet_box box = test_cube(6, 1.0, 6, 4);
  pw_tet_input in;
  assert_ok(pw_tet_box_create(&box, &in));
  pw_idx *cell = (pw_idx *)in.cell, kept = 0, *number = NULL, nnode = 0;
  double *x = NULL;
  assert_ok(pw_mem_alloc("nodes", in.nnode, sizeof *number, &number));
  for (pw_idx k = 0; k < in.ncell; k++) { /* bricks with 1/3 < x < 2/3 and y > 1/3 go */
    pw_idx i = k / 6 % 6, j = k / 36 % 6;
    if (i < 2 || i >= 4 || j < 2) {
      memmove(cell + 4 * kept++, cell + 4 * k, 4 * sizeof *cell);
    }
  }
  for (pw_idx i = 0; i < 4 * kept; i++) {
    number[cell[i]] = 1;
  }
  for (pw_idx a = 0; a < in.nnode; a++) {
    number[a] = number[a] ? ++nnode : 0;
  }
  assert_ok(pw_mem_alloc("coordinates", 3 * nnode, sizeof *x, &x));
  for (pw_idx a = 0; a < in.nnode; a++) {
    for (int c = 0; c < 3 && number[a]; c++) {
      x[c * nnode + number[a] - 1] = in.x[c * in.nnode + a];
    }
  }
  for (pw_idx i = 0; i < 4 * kept; i++) {
    cell[i] = number[cell[i]] - 1;
  }
  pw_tet_mesh m = mesh_of(nnode, x, kept, cell);
  pw_walk w = walk_on(&m);
  pw_walk_counts c = {0};
  uint64_t seed = 5;
  pw_off outside = 0;
  for (int i = 0; i < 20000; i++) {
    double p[3];
    for (int k = 0; k < 3; k++) {
      p[k] = 1.2 * test_random(&seed) - 0.1;
    }
    bool in_box = p[0] >= 0 && p[0] <= 1 && p[1] >= 0 && p[1] <= 1 && p[2] >= 0 && p[2] <= 1;
    bool inside = in_box && (p[0] <= 1.0 / 3 || p[0] >= 2.0 / 3 || p[1] <= 1.0 / 3);
    pw_idx from = (pw_idx)(test_random(&seed) * m.tets.nelem);
    pw_idx owner = pw_walk_find(&w, p, from, &c);
    assert_int_equal(owner != PW_WALK_OUTSIDE, inside);
    assert_int_equal(owner, pw_walk_search_all(&m.tets, p));
    outside += !inside;
  }
  assert_int_equal(c.outside, outside);
  assert_true(c.binned > c.outside); /* across the slot */
  double lost[3] = {NAN, 0, 0}, far[3] = {1e300, 0, 0};
  assert_int_equal(pw_walk_find(&w, lost, 3, &c), PW_WALK_OUTSIDE);
  assert_int_equal(pw_walk_find(&w, far, 3, &c), PW_WALK_OUTSIDE);
  assert_int_equal(pw_walk_find(&w, far, PW_WALK_OUTSIDE, &c), PW_WALK_OUTSIDE);
  pw_walk_destroy(&w);
  pw_tet_mesh_destroy(&m);
  pw_mem_free(&number);
  pw_mem_free(&x);
  pw_tet_box_destroy(&in);
}

/* E14, E15: owners on a mesh that has turned are those of the points turned back. */
static void owners_turn_with_the_mesh(void **state)
{
  (void)state;
  pw_tet_mesh m = test_shaken_mesh(5, 0.2, 9);
  pw_walk w = walk_on(&m);
  enum { N = 2000 };
  static double x0[3 * N], x[3 * N];
  static pw_idx first[N], now[N];
  uint64_t seed = 21;
  double axis[3] = {0.3, 0.2, 1}, centre[3] = {0.5, 0.5, 0.5}, rot[9], shift[3];
  pw_walk_counts c = {0};
  for (int i = 0; i < 3 * N; i++) {
    x0[i] = test_random(&seed);
  }
  pw_walk_points(&w, &m.motion, N, N, x0, first, &c); /* from element 0 */
  memcpy(now, first, sizeof now);
  memset(&c, 0, sizeof c);
  for (int step = 1; step <= 80; step++) { /* 400 degrees, 5 a step */
    pw_rotation_about(axis, step * 0.087266462599716477, rot);
    for (int k = 0; k < 3; k++) {
      shift[k] = centre[k] - rot[3 * k] * centre[0] - rot[3 * k + 1] * centre[1] -
                 rot[3 * k + 2] * centre[2];
    }
    assert_ok(pw_tet_mesh_move(&m, rot, shift));
    for (int i = 0; i < N; i++) {
      for (int k = 0; k < 3; k++) {
        x[k * N + i] = rot[3 * k] * x0[i] + rot[3 * k + 1] * x0[N + i] +
                       rot[3 * k + 2] * x0[2 * N + i] + shift[k];
      }
    }
    pw_walk_points(&w, &m.motion, N, N, x, now, &c);
    assert_memory_equal(now, first, sizeof now);
  }
  assert_int_equal(c.tests, c.points); /* nothing leaves its element */
  pw_walk_destroy(&w);
  pw_tet_mesh_destroy(&m);
}

/* E9: bricks squeezed to slivers of aspect 1e-3 to 1e-6. */
static void slivers_are_located(void **state)
{
  (void)state;
  for (double thin = 1e-3; thin > 5e-7; thin /= 10) {
    pw_tet_box box = test_cube(4, 1.0, 6, 4);
    pw_tet_input in;
    assert_ok(pw_tet_box_create(&box, &in));
    pw_real *z = (pw_real *)in.x + 2 * in.nnode;
    for (pw_idx a = 0; a < in.nnode; a++) { /* the second layer becomes `thin` as thick */
      z[a] = z[a] > 0.25 ? z[a] - 0.25 + 0.25 * thin : z[a];
    }
    pw_tet_mesh m;
    assert_ok(pw_tet_mesh_create(&in, &m));
    pw_walk w = walk_on(&m);
    pw_walk_counts c = {0};
    uint64_t seed = 2;
    for (int i = 0; i < 5000; i++) {
      double x[3] = {test_random(&seed), test_random(&seed), 0.7 * test_random(&seed)};
      x[2] = i % 2 ? 0.25 + 0.25 * thin * test_random(&seed) : x[2]; /* half in the thin layer */
      pw_idx from = (pw_idx)(test_random(&seed) * m.tets.nelem);
      assert_int_equal(pw_walk_find(&w, x, from, &c), pw_walk_search_all(&m.tets, x));
    }
    assert_int_equal(c.outside, 0);
    pw_walk_destroy(&w);
    pw_tet_mesh_destroy(&m);
    pw_tet_box_destroy(&in);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_points_have_the_same_parent),
      cmocka_unit_test(ties_go_to_the_lowest_element),
      cmocka_unit_test(points_outside_are_named),
      cmocka_unit_test(owners_turn_with_the_mesh),
      cmocka_unit_test(slivers_are_located),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
