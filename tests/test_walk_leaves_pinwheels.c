/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pinwheels of tetrahedra in which walks with a fixed choice of faces go round for ever (from 18 of
 * the 27 elements of the smaller one): every walk must end at the parent, and soon. */
#include "tests/tet_helpers.h"

#include <jansson.h>

/* The reference does not care which way round the nodes of an element are. */
static void orient(pw_idx nnode, const double *x, pw_idx *n)
{
  double d[3][3];
  for (int i = 0; i < 3; i++) {
    for (int c = 0; c < 3; c++) {
      d[i][c] = x[c * nnode + n[i + 1]] - x[c * nnode + n[0]];
    }
  }
  double det = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
               d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
               d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
  if (det < 0.0) {
    pw_idx swap = n[2];
    n[2] = n[3];
    n[3] = swap;
  }
}

static void check_pinwheel(const char *path)
{
  json_error_t error;
  json_t *root = json_load_file(path, 0, &error);
  assert_non_null(root);
  json_t *points = json_object_get(root, "points"), *tets = json_object_get(root, "tets");
  pw_idx nnode = (pw_idx)json_array_size(points), nelem = (pw_idx)json_array_size(tets), *cell;
  double *x, query[3];
  assert_true(nnode > 0 && nelem > 0);
  assert_ok(pw_mem_alloc("x", 3 * nnode, sizeof *x, &x));
  assert_ok(pw_mem_alloc("cell", 4 * nelem, sizeof *cell, &cell));
  for (pw_idx i = 0; i < 3 * nnode; i++) {
    json_t *row = json_array_get(points, (size_t)(i % nnode));
    x[i] = json_number_value(json_array_get(row, (size_t)(i / nnode)));
  }
  for (pw_idx i = 0; i < 4 * nelem; i++) {
    json_t *row = json_array_get(tets, (size_t)(i / 4));
    cell[i] = (pw_idx)json_integer_value(json_array_get(row, (size_t)(i % 4)));
  }
  for (pw_idx e = 0; e < nelem; e++) {
    orient(nnode, x, cell + 4 * e);
  }
  for (size_t c = 0; c < 3; c++) {
    query[c] = json_number_value(json_array_get(json_object_get(root, "query"), c));
  }
  pw_tet_input in = {.nnode = nnode, .x = x, .ncell = nelem, .nodes = 4, .cell = cell};
  pw_tet_mesh m;
  pw_walk w;
  assert_ok(pw_tet_mesh_create(&in, &m));
  assert_ok(pw_walk_create(&m.tets, &w));
  pw_idx owner = pw_walk_search_all(&m.tets, query);
  assert_true(owner >= 0);
  pw_off longest = 0;
  for (pw_idx from = 0; from < nelem; from++) {
    pw_walk_counts c = {0};
    assert_int_equal(pw_walk_find(&w, query, from, &c), owner);
    assert_int_equal(c.binned, 0);
    longest = c.tests > longest ? c.tests : longest;
  }
  print_message("%s: longest walk %d elements\n", path, (int)longest);
  assert_true(longest <= 100);
  pw_walk_destroy(&w);
  pw_tet_mesh_destroy(&m);
  pw_mem_free(&x);
  pw_mem_free(&cell);
  json_decref(root);
}

static void every_start_reaches_the_parent(void **state)
{
  (void)state;
  check_pinwheel("reference/walk/pinwheel_3.json");
  check_pinwheel("reference/walk/pinwheel_6.json");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_start_reaches_the_parent),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
