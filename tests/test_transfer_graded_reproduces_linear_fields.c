/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The checks of test_transfer_reproduces_linear_fields.c on a graded grid: partition of unity,
 * linear completeness and gradients of CPDI and linear MPM (verification A0), uniform stress in
 * equilibrium, the mass of nodes, bad points named; and a grid of equal cells, looked up, gives
 * what the uniform kernel computes. */
#include <string.h>

#include "engine/mesh.h"
#include "kernels/transfer.h"
#include "tests/harness.h"

enum { LD = 64, NODE = 8, AXI = 1, CPDI = 2, MAX_NODES = 2048 };

typedef struct {
  pw_mesh mesh;
  pw_real x[2 * LD], v[2 * LD], mass[LD], vol[LD], stress[6 * LD], half[4 * LD];
  pw_idx home[LD], corner[4 * LD];
  pw_real local[8 * LD];
  _Alignas(PW_ALIGN) pw_real rec[MAX_NODES * NODE];
  pw_transfer t;
} world;

static void world_init(world *w, const pw_grid *g)
{
  memset(w, 0, sizeof *w);
  assert_ok(pw_mesh_create_grid(g, &w->mesh));
  assert_true(w->mesh.nnode <= MAX_NODES);
  w->t = (pw_transfer){.origin = {w->mesh.origin[0], w->mesh.origin[1]},
                       .cell = w->mesh.cell,
                       .cells = {w->mesh.cells[0], w->mesh.cells[1]},
                       .axis = w->mesh.graded ? w->mesh.axis : NULL,
                       .row = w->mesh.nodes[0],
                       .reach = 4,
                       .ld = LD,
                       .x = w->x,
                       .v = w->v,
                       .mass = w->mass,
                       .vol = w->vol,
                       .stress = w->stress,
                       .half = w->half,
                       .home = w->home,
                       .corner = w->corner,
                       .local = w->local};
}

static const pw_grid graded = {.origin_m = {2.0, -1.0},
                               .size_m = {6.0, 5.0},
                               .cell_m = 0.1,
                               .fine_x_m = {2.0, 2.8},
                               .fine_y_m = {1.0, 1.6},
                               .growth = 1.2};

/* Parallelograms of about the size of the cells they are in. */
static void random_points(world *w, uint64_t seed)
{
  for (pw_idx i = 0; i < LD; i++) {
    pw_real size[2], x[2] = {2.4 + 4.6 * test_random(&seed), -0.2 + 3.6 * test_random(&seed)};
    w->x[i] = x[0];
    w->x[LD + i] = x[1];
    w->home[i] = pw_mesh_locate(&w->mesh, x);
    pw_mesh_size_at(&w->mesh, x, size);
    w->mass[i] = 0.5 + test_random(&seed);
    w->vol[i] = 0.5 + test_random(&seed);
    for (int c = 0; c < 6; c++) {
      w->stress[c * LD + i] = test_random(&seed) - 0.5;
    }
    w->half[i] = size[0] * (0.2 + 0.3 * test_random(&seed));
    w->half[LD + i] = size[1] * 0.1 * test_random(&seed);
    w->half[2 * LD + i] = -size[0] * 0.1 * test_random(&seed);
    w->half[3 * LD + i] = size[1] * (0.2 + 0.3 * test_random(&seed));
  }
}

static void weights(world *w, const pw_kernels *k)
{
  pw_weights_report r;
  k->weights(&w->t, 0, LD, &r);
  assert_int_equal(r.lost, -1);
  assert_int_equal(r.overrun, -1);
  assert_int_equal(r.inverted, -1);
  assert_int_equal(r.clamped, 0);
}

static const pw_kernels *row(int i)
{
  static const int basis[2] = {0, CPDI};
  return pw_kernels_find_graded(i / 2, basis[i % 2]);
}

static void only_ugimp_has_no_graded_kernel(void **state)
{
  (void)state;
  for (int i = 0; i < 4; i++) {
    assert_non_null(row(i));
    assert_int_equal(row(i)->geometry, i / 2);
  }
  assert_null(pw_kernels_find_graded(0, 1));
  assert_null(pw_kernels_find_graded(1, 1));
}

static void linear_field_has_exact_gradient(void **state)
{
  (void)state;
  static world w;
  static pw_gradients g;
  for (int i = 0; i < 4; i++) {
    const pw_kernels *k = row(i);
    world_init(&w, &graded);
    random_points(&w, 11);
    weights(&w, k);
    const pw_real a[6] = {0.3, -0.7, 1.3, 0.4, 2.0, -0.9};
    for (pw_idx n = 0; n < w.mesh.nnode; n++) {
      pw_real x = pw_mesh_node_x(&w.mesh, n), y = pw_mesh_node_y(&w.mesh, n);
      w.rec[n * NODE + 1] = a[0] + a[1] * x + a[2] * y;
      w.rec[n * NODE + 2] = a[3] + a[4] * x + a[5] * y;
    }
    pw_real old[2 * LD];
    memcpy(old, w.x, sizeof old);
    k->g2p_gradient(&w.t, w.rec, 1, 1e-3, true, 0, LD, &g);
    for (pw_idx p = 0; p < LD; p++) {
      const pw_real want[4] = {a[1], a[2], a[4], a[5]};
      for (int c = 0; c < 4; c++) {
        assert_near(g.du[c][p] / 1e-3, want[c], 1e-12);
      }
      pw_real vx = a[0] + a[1] * old[p] + a[2] * old[LD + p];
      assert_near((w.x[p] - old[p]) / 1e-3, vx, 1e-11);
      assert_near(g.du[4][p] / 1e-3, k->geometry == AXI ? vx / old[p] : 0.0, 1e-12);
    }
    pw_mesh_destroy(&w.mesh);
  }
}

/* Mass, momentum and force of the nodes have the sums of the points', and the mass its first
 * moment (plane strain). */
static void scatter_conserves(void **state)
{
  (void)state;
  static world w;
  for (int i = 0; i < 4; i++) {
    const pw_kernels *k = row(i);
    world_init(&w, &graded);
    random_points(&w, 5);
    weights(&w, k);
    pw_real mass = 0.0, momentum = 0.0, hoop = 0.0, moment = 0.0, got = 0.0, sum[NODE] = {0.0};
    for (pw_idx p = 0; p < LD; p++) {
      w.v[p] = 0.1 * p;
      mass += w.mass[p];
      momentum += w.mass[p] * w.v[p];
      moment += w.mass[p] * w.x[p];
      hoop += k->geometry == AXI ? w.vol[p] * w.stress[2 * LD + p] / w.x[p] : 0.0;
    }
    k->p2g(&w.t, w.rec, 0, LD);
    for (pw_idx n = 0; n < w.mesh.nnode; n++) {
      got += w.rec[n * NODE] * pw_mesh_node_x(&w.mesh, n);
      for (int c = 0; c < NODE; c++) {
        sum[c] += w.rec[n * NODE + c];
      }
    }
    assert_relative(sum[0], mass, 1e-13);
    assert_relative(sum[1], momentum, 1e-13);
    assert_near(sum[3], -hoop, 1e-11);
    assert_near(sum[4], 0.0, 1e-11);
    if (k->geometry != AXI) {
      assert_relative(got, moment, 1e-13);
    }
    pw_mesh_destroy(&w.mesh);
  }
}

/* Two by two domains in each of 4 x 4 cells, whose sizes differ: nodes between them get their share
 * of area exactly, and uniform stress leaves no force on them. */
static void tiling_is_exact(void **state)
{
  (void)state;
  static world w;
  const pw_kernels *k = pw_kernels_find_graded(0, CPDI);
  world_init(&w, &graded);
  const pw_real *nx = w.mesh.axis[0].node, *ny = w.mesh.axis[1].node;
  const pw_idx i0 = w.mesh.cells[0] - 5, j0 = 2, r = w.mesh.nodes[0];
  for (pw_idx p = 0; p < LD; p++) {
    pw_idx i = i0 + p % 8 / 2, j = j0 + p / 16;
    w.half[p] = 0.25 * (nx[i + 1] - nx[i]);
    w.half[3 * LD + p] = 0.25 * (ny[j + 1] - ny[j]);
    w.x[p] = nx[i] + w.half[p] * (p % 2 ? 3.0 : 1.0);
    w.x[LD + p] = ny[j] + w.half[3 * LD + p] * (p / 8 % 2 ? 3.0 : 1.0);
    w.mass[p] = w.vol[p] = 4.0 * w.half[p] * w.half[3 * LD + p];
    w.home[p] = j * w.mesh.cells[0] + i;
    w.stress[p] = w.stress[LD + p] = w.stress[2 * LD + p] = 1.0;
  }
  weights(&w, k);
  k->p2g(&w.t, w.rec, 0, LD);
  for (pw_idx j = j0 + 1; j < j0 + 4; j++) {
    for (pw_idx i = i0 + 1; i < i0 + 4; i++) {
      const pw_real *rec = w.rec + (j * r + i) * NODE;
      pw_real area = 0.25 * (nx[i + 1] - nx[i - 1]) * (ny[j + 1] - ny[j - 1]);
      assert_true(fabs(nx[i + 1] - 2.0 * nx[i] + nx[i - 1]) > 0.01);
      assert_relative(rec[0], area, 1e-13);
      assert_near(rec[3], 0.0, 1e-14);
      assert_near(rec[4], 0.0, 1e-14);
    }
  }
  pw_mesh_destroy(&w.mesh);
}

static void equal_cells_give_the_uniform_result(void **state)
{
  (void)state;
  static world one, two;
  pw_grid even = {.origin_m = {2.0, -1.0}, .size_m = {6.0, 5.0}, .cell_m = 0.25};
  pw_grid looked_up = even;
  looked_up.fine_x_m[0] = 4.0;
  looked_up.fine_x_m[1] = 5.0;
  looked_up.growth = 1.0;
  for (int i = 0; i < 4; i++) {
    const pw_kernels *k = row(i);
    world_init(&one, &even);
    world_init(&two, &looked_up);
    assert_true(!one.mesh.graded && two.mesh.graded && one.mesh.nnode == two.mesh.nnode);
    random_points(&one, 4);
    random_points(&two, 4);
    weights(&one, pw_kernels_find(k->geometry, k->basis));
    weights(&two, k);
    pw_kernels_find(k->geometry, k->basis)->p2g(&one.t, one.rec, 0, LD);
    k->p2g(&two.t, two.rec, 0, LD);
    for (pw_idx n = 0; n < one.mesh.nnode * NODE; n++) {
      assert_near(two.rec[n], one.rec[n], 1e-12);
    }
    pw_mesh_destroy(&two.mesh);
  }
}

/* Bad points are named, never skipped: outside, not a number, inverted, beyond the reach. */
static void weights_report_bad_points(void **state)
{
  (void)state;
  static world w;
  pw_weights_report r;
  const pw_kernels *k = pw_kernels_find_graded(0, CPDI);
  world_init(&w, &graded);
  random_points(&w, 2);
  w.x[7] = NAN;
  w.x[LD + 9] = 1e9;
  w.half[12] = -w.half[12];
  w.home[5] = 0;
  w.t.reach = 1;
  k->weights(&w.t, 0, LD, &r);
  assert_int_equal(r.lost, 7);
  assert_int_equal(r.inverted, 12);
  assert_true(r.overrun >= 0 && r.overrun <= 5);
  for (pw_idx c = 0; c < 4 * LD; c++) {
    assert_true(w.corner[c] >= 0 && w.corner[c] + w.t.row + 1 < w.mesh.nnode);
  }
  k = pw_kernels_find_graded(0, 0);
  k->weights(&w.t, 0, LD, &r);
  assert_int_equal(r.lost, 7);
  assert_true(r.overrun >= 0 && r.overrun <= 5);
  pw_mesh_destroy(&w.mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(only_ugimp_has_no_graded_kernel),
      cmocka_unit_test(linear_field_has_exact_gradient),
      cmocka_unit_test(scatter_conserves),
      cmocka_unit_test(tiling_is_exact),
      cmocka_unit_test(equal_cells_give_the_uniform_result),
      cmocka_unit_test(weights_report_bad_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
