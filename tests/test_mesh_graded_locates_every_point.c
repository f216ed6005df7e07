/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Graded grids: the rule of their sizes, the cell of any point against a search through all cells,
 * bilinear shape functions, and what is refused. */
#include <math.h>

#include "engine/core/mem.h"
#include "engine/mesh_grade.h"
#include "tests/harness.h"

static const pw_grid grids[] = {
    {.origin_m = {0.0, -1.0},
     .size_m = {5.0, 16.0},
     .cell_m = 0.05,
     .fine_x_m = {0.0, 1.0},
     .fine_y_m = {6.0, 12.0},
     .growth = 1.1},
    {.origin_m = {-3.0, 2.0},
     .size_m = {10.3, 4.0},
     .cell_m = 0.1,
     .fine_x_m = {-0.5, 0.5},
     .growth = 1.25,
     .cell_max_m = 0.4},
    {.size_m = {7.0, 100.0},
     .cell_m = 0.02,
     .fine_x_m = {3.0, 3.02},
     .fine_y_m = {0.0, 0.1},
     .growth = 1.5},
    {.origin_m = {1.0, 1.0},
     .size_m = {2.0, 2.0},
     .cell_m = 0.125,
     .fine_x_m = {1.5, 2.0},
     .growth = 1.0},
};

enum { GRIDS = sizeof grids / sizeof grids[0] };

static pw_mesh make(const pw_grid *g)
{
  pw_mesh m;
  assert_ok(pw_mesh_create_grid(g, &m));
  assert_true(m.graded);
  return m;
}

/* The cell that holds x by the rule of the header, from the nodes alone. */
static pw_idx search(const pw_mesh *m, const pw_real *x)
{
  pw_idx k[2];
  for (int a = 0; a < 2; a++) {
    const pw_real *node = m->axis[a].node;
    k[a] = -1;
    if (!(x[a] >= node[0] && x[a] <= node[m->cells[a]])) {
      return -1;
    }
    for (pw_idx i = 0; i < m->cells[a]; i++) {
      k[a] = x[a] >= node[i] ? i : k[a];
    }
  }
  return k[1] * m->cells[0] + k[0];
}

static void the_search_agrees(void **state)
{
  (void)state;
  uint64_t seed = 3;
  for (int g = 0; g < GRIDS; g++) {
    pw_mesh m = make(&grids[g]);
    for (int trial = 0; trial < 100000 / GRIDS; trial++) {
      pw_real x[2];
      for (int a = 0; a < 2; a++) {
        const pw_real *node = m.axis[a].node;
        pw_real length = node[m.cells[a]] - node[0];
        x[a] = node[0] + length * (1.02 * test_random(&seed) - 0.01);
        if (trial % 4 == 0) { /* at a node and one number beside it */
          pw_idx k = (pw_idx)(test_random(&seed) * m.nodes[a]);
          x[a] = node[k < m.nodes[a] ? k : m.nodes[a] - 1];
          x[a] = trial % 12 == 4 ? nextafter(x[a], 1e9) : x[a];
          x[a] = trial % 12 == 8 ? nextafter(x[a], -1e9) : x[a];
        }
      }
      assert_int_equal(pw_mesh_locate(&m, x), search(&m, x));
    }
    assert_int_equal(pw_mesh_locate(&m, (pw_real[]){NAN, 2.0}), -1);
    pw_mesh_destroy(&m);
  }
}

/* Sizes are positive, grow outwards by one ratio of at most `growth`, and stop at the largest. */
static void sizes_follow_the_rule(void **state)
{
  (void)state;
  for (int g = 0; g < GRIDS; g++) {
    pw_mesh m = make(&grids[g]);
    for (int a = 0; a < 2; a++) {
      const pw_grid_axis *axis = &m.axis[a];
      const pw_real *zone = a == 0 ? grids[g].fine_x_m : grids[g].fine_y_m;
      const pw_real cell = grids[g].cell_m, limit = grids[g].cell_max_m;
      const bool whole = zone[0] == zone[1];
      assert_true(axis->node[0] == grids[g].origin_m[a]);
      assert_true(axis->node[axis->cells] == grids[g].origin_m[a] + grids[g].size_m[a]);
      for (pw_idx k = 0; k < axis->cells; k++) {
        pw_real middle = 0.5 * (axis->node[k] + axis->node[k + 1]), size = axis->size[k];
        bool fine = whole || (middle > zone[0] && middle < zone[1]), right = middle > zone[1];
        pw_real inner = fine ? cell : axis->size[right ? k - 1 : k + 1];
        assert_true(size == axis->node[k + 1] - axis->node[k]);
        assert_true(size >= inner * (1.0 - 1e-9) && size <= inner * grids[g].growth * (1.0 + 1e-9));
        assert_true(!fine || fabs(size - cell) <= 1e-12);
        assert_true(limit == 0.0 || size <= limit * (1.0 + 1e-9));
      }
      print_message("grid %d axis %d: %d cells, last %.4g m\n", g, a, axis->cells,
                    axis->size[axis->cells - 1]);
    }
    assert_true(pw_mesh_largest_cell(&m) >= m.cell);
    pw_mesh_destroy(&m);
  }
}

/* On the right of grid 0, 4 m are left to cells of 0.05 q^k: by the sum of the geometric series the
 * fewest cells with q <= 1.1 are 23 (22 with q = 1.1 are 3.93 m long). */
static void the_count_is_the_fewest(void **state)
{
  (void)state;
  pw_axis_plan plan;
  assert_ok(pw_mesh_plan(&grids[0], 0, &plan));
  pw_real length = 0.05 * 1.1 * (pow(1.1, 22) - 1.0) / 0.1;
  assert_true(length < 4.0);
  assert_int_equal(plan.fine, 20);
  assert_int_equal(plan.outer[0], 0);
  assert_int_equal(plan.outer[1], 23);
  pw_real q = plan.ratio[1];
  assert_relative(0.05 * q * (pow(q, 23) - 1.0) / (q - 1.0), 4.0, 1e-12);
}

static void shape_functions_are_exact_for_linear_fields(void **state)
{
  (void)state;
  uint64_t seed = 8;
  for (int g = 0; g < GRIDS; g++) {
    pw_mesh m = make(&grids[g]);
    for (int trial = 0; trial < 5000; trial++) {
      pw_real x[2], w[4], sum = 0.0, got = 0.0, most = 0.0;
      pw_idx node[4];
      for (int a = 0; a < 2; a++) {
        x[a] = m.origin[a] + grids[g].size_m[a] * test_random(&seed);
      }
      pw_mesh_shape(&m, x, node, w);
      for (int k = 0; k < 4; k++) {
        pw_real value = 0.3 + 1.3 * pw_mesh_node_x(&m, node[k]) - 0.7 * pw_mesh_node_y(&m, node[k]);
        assert_true(w[k] >= -1e-15);
        sum += w[k];
        got += w[k] * value;
        most = fmax(most, fabs(value));
      }
      assert_near(sum, 1.0, 1e-15);
      assert_near(got, 0.3 + 1.3 * x[0] - 0.7 * x[1], 1e-13 * fmax(1.0, most));
    }
    pw_mesh_destroy(&m);
  }
}

/* Sizes at a point, by the search; a grid with growth 1 has the nodes of the uniform one. */
static void sizes_are_local(void **state)
{
  (void)state;
  uint64_t seed = 5;
  for (int g = 0; g < GRIDS; g++) {
    pw_mesh m = make(&grids[g]);
    for (int trial = 0; trial < 2000; trial++) {
      pw_real x[2], size[2], here[2], near = 1e300;
      for (int a = 0; a < 2; a++) {
        x[a] = m.origin[a] + grids[g].size_m[a] * test_random(&seed);
      }
      pw_idx e = search(&m, x);
      pw_mesh_cell_size(&m, e, size);
      pw_mesh_size_at(&m, x, here);
      for (int a = 0; a < 2; a++) {
        pw_idx k = a == 0 ? e % m.cells[0] : e / m.cells[0];
        for (pw_idx l = k > 0 ? k - 1 : k; l <= k + 1 && l < m.cells[a]; l++) {
          near = fmin(near, m.axis[a].node[l + 1] - m.axis[a].node[l]);
        }
        assert_true(here[a] == size[a] && size[a] == m.axis[a].size[k]);
      }
      assert_true(pw_mesh_near_size(&m, x) == near);
    }
    pw_mesh_destroy(&m);
  }
  pw_mesh graded = make(&grids[3]), even;
  assert_ok(pw_mesh_create(grids[3].origin_m, grids[3].size_m, grids[3].cell_m, &even));
  assert_true(!even.graded && even.nnode == graded.nnode);
  for (pw_idx n = 0; n < even.nnode; n++) {
    assert_near(pw_mesh_node_x(&graded, n), pw_mesh_node_x(&even, n), 1e-15);
    assert_near(pw_mesh_node_y(&graded, n), pw_mesh_node_y(&even, n), 1e-15);
  }
  pw_mesh_destroy(&graded);
}

static void refused(pw_grid g, const char *says)
{
  pw_mesh m = {.nelem = 0};
  assert_int_equal(pw_mesh_create_grid(&g, &m), PW_ERR_SCENE);
  if (!strstr(pw_error_text(), says)) {
    fail_msg("the error says '%s', not '%s'", pw_error_text(), says);
  }
}

static void bad_grids_are_refused(void **state)
{
  (void)state;
  pw_grid g = grids[0];
  g.fine_x_m[1] = 5.5;
  refused(g, "fine_x_m = [0, 5.5] leaves the grid");
  g = grids[0];
  g.fine_y_m[0] = -1.5;
  refused(g, "fine_y_m = [-1.5, 12] leaves the grid");
  g = grids[0];
  g.fine_x_m[1] = 1.02;
  refused(g, "fine_x_m: 1.02 m are not a whole number of cells of 0.05 m");
  g = grids[0];
  g.fine_x_m[1] = 4.92;
  g.fine_x_m[0] = 0.02;
  refused(g, "fine_x_m leaves 0.02 m beside it");
  g = grids[0];
  g.fine_y_m[0] = 13.0;
  refused(g, "fine_y_m must be written");
  g = grids[0];
  g.cell_max_m = 0.04;
  refused(g, "cell_max_m = 0.04 m is below cell_m = 0.05 m");
  g = grids[0];
  g.growth = 1.0;
  g.size_m[0] = 5.02;
  refused(g, "fine_x_m leaves 4.02 m beside it");
  g = grids[1];
  g.size_m[1] = 4.05;
  refused(g, "size_m: the height 4.05 m is not a whole number of cells of 0.1 m");
  g = grids[1];
  g.size_m[0] = 1e7;
  refused(g, "size_m: 1e+07 m are more than");
}

static void failed_allocations_leak_nothing(void **state)
{
  (void)state;
  pw_off held = pw_mem_bytes(), nth = 0;
  pw_mesh m = {.nelem = 0};
  pw_status status;
  do {
    pw_mem_fail_after(++nth);
    status = pw_mesh_create_grid(&grids[0], &m);
    pw_mem_fail_after(0);
    assert_true(status == PW_OK || (status == PW_ERR_MEMORY && pw_mem_bytes() == held));
  } while (status != PW_OK);
  assert_int_equal(nth, 11);
  pw_mesh_destroy(&m);
  assert_int_equal(pw_mem_bytes(), held);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_search_agrees),
      cmocka_unit_test(sizes_follow_the_rule),
      cmocka_unit_test(the_count_is_the_fewest),
      cmocka_unit_test(shape_functions_are_exact_for_linear_fields),
      cmocka_unit_test(sizes_are_local),
      cmocka_unit_test(bad_grids_are_refused),
      cmocka_unit_test(failed_allocations_leak_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
