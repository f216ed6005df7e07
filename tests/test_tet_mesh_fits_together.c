/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Neighbours, boundary, division of ten-node tetrahedra and refusal of bad meshes. Expected numbers
 * follow from counting: a box of volume V in n bricks of 6 k cells has a surface of 2 k' triangles
 * per brick side, and area vectors of a closed surface add up to zero. */
#include "tests/tet_helpers.h"

/* Neighbours by comparing all pairs of elements. */
static pw_idx beside_by_pairs(const pw_tets *t, pw_idx e, int f)
{
  const pw_idx *n = t->node + 4 * e;
  for (pw_idx other = 0; other < t->nelem; other++) {
    int shared = 0;
    for (int i = 0; i < 4; i++) {
      for (int j = 0; j < 4; j++) {
        shared += i != f && n[i] == t->node[4 * other + j];
      }
    }
    if (other != e && shared == 3) {
      return other;
    }
  }
  return -1;
}

static void check_tables(const pw_tet_mesh *m, pw_idx surface_faces)
{
  const pw_tets *t = &m->tets;
  pw_idx inner = 0;
  double area[3] = {0};
  for (pw_idx i = 0; i < 4 * t->nelem; i++) {
    pw_idx e = i / 4, other = t->beside[i];
    const double *g = t->inverse + 4 * (size_t)i;
    bool back = other < 0;
    for (int f = 0; f < 4 && !back; f++) {
      back = t->beside[4 * other + f] == e;
    }
    assert_true(back);
    inner += other >= 0;
    for (int c = 0; c < 3 && other < 0; c++) {
      area[c] -= 3.0 * t->volume[e] * g[c]; /* area = 3 V / height */
    }
  }
  assert_int_equal(4 * t->nelem - inner, surface_faces);
  assert_int_equal(m->nface, surface_faces);
  assert_near(fabs(area[0]) + fabs(area[1]) + fabs(area[2]), 0.0, 1e-13);
}

static void neighbours_are_those_of_all_pairs(void **state)
{
  (void)state;
  pw_tet_box box = test_cube(2, 1.0, 5, 10);
  pw_tet_mesh m = test_box_mesh(&box);
  for (pw_idx i = 0; i < 4 * m.tets.nelem; i++) {
    assert_int_equal(m.tets.beside[i], beside_by_pairs(&m.tets, i / 4, i % 4));
  }
  pw_tet_mesh_destroy(&m);
}

static void divisions_fill_the_box(void **state)
{
  (void)state;
  for (int per = 5; per <= 6; per++) {
    for (int nodes = 4; nodes <= 10; nodes += 6) {
      for (int d = PW_TET_DIAGONAL_SHORTEST; d <= PW_TET_DIAGONAL_ALONG_Z; d++) {
        pw_tet_box box = test_cube(3, 2.0, per, nodes);
        box.diagonal = (pw_tet_diagonal)d;
        pw_tet_mesh m = test_box_mesh(&box);
        pw_idx cells = 27 * per;
        assert_int_equal(m.npatch, cells);
        assert_int_equal(m.tets.nelem, nodes == 10 ? 8 * cells : cells);
        assert_near(test_volume(&m), 8.0, 1e-12);
        check_tables(&m, 6 * 9 * 2 * (nodes == 10 ? 4 : 1));
        for (pw_idx e = 1; e < m.tets.nelem; e++) { /* eight equal parts */
          assert_true(e % m.per == 0 || fabs(m.tets.volume[e] - m.tets.volume[e - 1]) < 1e-14);
        }
        pw_tet_mesh_destroy(&m);
      }
    }
  }
}

static void the_shortest_diagonal_is_taken(void **state)
{
  (void)state;
  double x[30] = {0, 4, 0, 0, 2, 2, 0, 0, 2, 0, 0, 0, 3, 0, 0, 1.5, 1.5, 0, 0, 1.5, 0, 0, 0, 1};
  const int ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  double corner[4][3] = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 1}};
  pw_idx cell[10] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  for (int a = 0; a < 10; a++) {
    for (int c = 0; c < 3; c++) {
      x[10 * c + a] =
          a < 4 ? corner[a][c] : 0.5 * (corner[ends[a - 4][0]][c] + corner[ends[a - 4][1]][c]);
    }
  }
  /* (4-9): |(2,-1.5,-.5)|^2 = 6.5; (5-7): |(2,1.5,-.5)|^2 = 6.5; (6-8): |(-2,1.5,-.5)|^2 = 6.5:
   * equal for a right-angled corner, so the first. */
  pw_tet_input in = {.nnode = 10, .x = x, .ncell = 1, .nodes = 10, .cell = cell};
  pw_tet_mesh m;
  assert_ok(pw_tet_mesh_create(&in, &m));
  assert_int_equal(m.tets.node[16], 4);
  assert_int_equal(m.tets.node[17], 9);
  pw_tet_mesh_destroy(&m);
  x[2] = 1.5, x[5] = 2.75, x[6] = 0.75; /* corners 2 and 3 to (1.5, 3, 0) and (-1, 0, 1) */
  x[3] = -1.0, x[7] = -0.5, x[8] = 1.5, x[9] = 0.25;
  assert_ok(pw_tet_mesh_create(&in, &m)); /* 4-9: 5.56, 5-7: 13.06, 6-8: 3.06 */
  assert_int_equal(m.tets.node[16], 6);
  assert_int_equal(m.tets.node[17], 8);
  pw_tet_mesh_destroy(&m);
}

static void a_moved_mesh_turns_its_gradients(void **state)
{
  (void)state;
  pw_tet_mesh m = test_shaken_mesh(3, 0.2, 5);
  double axis[3] = {1, -2, 0.5}, rot[9], shift[3] = {0.3, 5, -2}, g[12];
  pw_rotation_about(axis, 2.3, rot);
  for (int c = 0; c < 3; c++) {
    rot[3 * c + 1] *= 1.7; /* stretched as well */
  }
  assert_ok(pw_tet_mesh_move(&m, rot, shift));
  for (pw_idx e = 0; e < m.tets.nelem; e++) {
    pw_tet_mesh_gradients(&m, e, g);
    for (int i = 0; i < 4; i++) { /* sum_j grad N_i . (x_j - x_0) must be N_i(x_j) - N_i(x_0) */
      for (int j = 1; j < 4; j++) {
        double sum = 0.0;
        for (int c = 0; c < 3; c++) {
          const double *x = m.x + c * m.tets.nnode;
          sum += g[3 * i + c] * (x[m.tets.node[4 * e + j]] - x[m.tets.node[4 * e]]);
        }
        assert_near(sum, (i == j) - (i == 0), 1e-13);
      }
    }
  }
  rot[0] = -rot[0], rot[3] = -rot[3], rot[6] = -rot[6]; /* a mirror */
  assert_int_equal(pw_tet_mesh_move(&m, rot, shift), PW_ERR_ARGUMENT);
  pw_tet_mesh_destroy(&m);
}

static void expect_refusal(const pw_tet_input *in, const char *text)
{
  pw_tet_mesh m;
  pw_off before = pw_mem_bytes();
  assert_int_equal(pw_tet_mesh_create(in, &m), PW_ERR_ARGUMENT);
  if (!strstr(pw_error_text(), text)) {
    fail_msg("\"%s\" does not say \"%s\"", pw_error_text(), text);
  }
  assert_true(pw_mem_bytes() == before);
}

static void bad_meshes_are_named(void **state)
{
  (void)state;
  double x[21] = {0, 1, 0, 0, 1, 0, 5, 0, 0, 1, 0, 1, 0, 5, 0, 0, 0, 1, 1, 0, 5};
  pw_idx good[4] = {0, 1, 2, 3}, inverted[4] = {0, 2, 1, 3}, range[4] = {0, 1, 2, 7};
  pw_idx twice[8] = {0, 1, 2, 3, 0, 1, 2, 3};
  pw_tet_input in = {.nnode = 4, .ncell = 1, .nodes = 4};
  double y[12];
  in.x = y;
  for (int i = 0; i < 12; i++) {
    y[i] = x[7 * (i / 4) + i % 4];
  }
  in.cell = inverted;
  expect_refusal(&in, "element 0 (nodes 0 2 1 3) is inverted");
  in.cell = range;
  expect_refusal(&in, "names node 7 of 4");
  in.cell = good;
  y[3] = 0.3, y[7] = 0.3, y[11] = 1e-13; /* node 3 */
  expect_refusal(&in, "element 0 (nodes 0 1 2 3) is a sliver");
  y[3] = y[1], y[7] = y[5], y[11] = y[9];
  expect_refusal(&in, "nodes 1 and 3 are in one place");
  y[3] = NAN;
  expect_refusal(&in, "coordinate x of node 3 is no number");
  in.x = x;
  in.nnode = 7;
  expect_refusal(&in, "node 4 belongs to no element");
  in.nnode = 4;
  for (int i = 0; i < 12; i++) {
    y[i] = x[7 * (i / 4) + i % 4];
  }
  in.x = y;
  in.cell = twice;
  in.ncell = 2;
  expect_refusal(&in, "elements 0 and 1 lie on the same side of their face 1 2 3");
  pw_idx three[12] = {1, 4, 2, 3, 0, 1, 2, 3, 1, 5, 2, 3}; /* 5 overlaps 4 behind face 1 2 3 */
  double w[18] = {0, 1, 0, 0, 1, 2, 0, 0, 1, 0, 1, 2, 0, 0, 0, 1, 1, 2};
  in = (pw_tet_input){.nnode = 6, .x = w, .ncell = 3, .nodes = 4, .cell = three};
  expect_refusal(&in, "belongs to three elements: 1, 0 and 2");
  pw_idx apart[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  double v[24] = {0, 1, 0, 0, 3, 4, 3, 3, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1};
  in = (pw_tet_input){.nnode = 8, .x = v, .ncell = 2, .nodes = 4, .cell = apart};
  expect_refusal(&in, "not joined to element 0");
  in.nodes = 5;
  expect_refusal(&in, "a tetrahedron of 5 nodes");
}

static void bent_cells_are_named(void **state)
{
  (void)state;
  pw_tet_box box = test_cube(1, 1.0, 5, 10);
  pw_tet_input in;
  assert_ok(pw_tet_box_create(&box, &in));
  ((pw_real *)in.x)[in.cell[6]] += 1e-3;
  expect_refusal(&in, "from the middle of the edge");
  pw_tet_box_destroy(&in);
}

static void failed_allocations_leave_nothing(void **state)
{
  (void)state;
  pw_tet_box box = test_cube(1, 1.0, 5, 10);
  pw_tet_input in;
  pw_tet_mesh m;
  assert_ok(pw_tet_box_create(&box, &in));
  pw_off before = pw_mem_bytes();
  for (pw_off nth = 1; nth < 100; nth++) {
    pw_mem_fail_after(nth);
    pw_status s = pw_tet_mesh_create(&in, &m);
    pw_mem_fail_after(0);
    if (s == PW_OK) {
      assert_true(nth > 10);
      pw_tet_mesh_destroy(&m);
      break;
    }
    assert_int_equal(s, PW_ERR_MEMORY);
    assert_true(pw_mem_bytes() == before);
  }
  pw_tet_box_destroy(&in);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(neighbours_are_those_of_all_pairs),
      cmocka_unit_test(divisions_fill_the_box),
      cmocka_unit_test(the_shortest_diagonal_is_taken),
      cmocka_unit_test(a_moved_mesh_turns_its_gradients),
      cmocka_unit_test(bad_meshes_are_named),
      cmocka_unit_test(bent_cells_are_named),
      cmocka_unit_test(failed_allocations_leave_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
