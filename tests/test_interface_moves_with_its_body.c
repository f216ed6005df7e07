/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interface lines on the grid: mass and momentum, weights at empty nodes, motion, areas. */
#include "engine/core/mem.h"
#include "engine/interface.h"
#include "tests/harness.h"

enum { N = 41 };

typedef struct fixture {
  pw_mesh mesh;
  pw_nodes nodes;
  pw_interface line;
} fixture;

/* The upper half of a circle about the origin, from right to left: the body is below. */
static void set_up(fixture *f, bool axi)
{
  pw_real xy[2 * N];
  for (int k = 0; k < N; k++) {
    pw_real a = 3.14159265358979323846 * k / (N - 1) / (axi ? 2.0 : 1.0);
    xy[2 * k] = cos(a);
    xy[2 * k + 1] = sin(a);
  }
  const pw_real origin[2] = {axi ? 0.0 : -2.0, -2.0}, size[2] = {axi ? 2.0 : 4.0, 4.0};
  assert_ok(pw_mesh_create(origin, size, 0.25, &f->mesh));
  assert_ok(pw_nodes_create(f->mesh.nnode, 1, &f->nodes));
  assert_ok(pw_interface_create(xy, NULL, N, false, axi, 8 * N, &f->line));
  pw_interface_set_mass(&f->line, 3.0);
  pw_interface_locate(&f->line, &f->mesh);
}

static void tear_down(fixture *f)
{
  pw_interface_destroy(&f->line);
  pw_nodes_destroy(&f->nodes);
}

static void areas_are_those_of_the_surface(void **state)
{
  (void)state;
  for (int axi = 0; axi < 2; axi++) {
    fixture f;
    set_up(&f, axi);
    pw_real sum = 0.0, da = 3.14159265358979323846 / (N - 1) / (axi ? 2.0 : 1.0);
    for (pw_idx k = 0; k < N; k++) {
      sum += f.line.node[k].area;
      assert_true(f.line.node[k].area > 0.0);
    }
    /* Chords: plane sum 2 sin(da/2) n; on the sphere per radian (1 + cos) parts of it. */
    pw_real chord = 2.0 * sin(0.5 * da), expected = chord * (N - 1);
    if (axi) {
      expected = 0.0;
      for (int k = 0; k < N - 1; k++) {
        expected += chord * 0.5 * (cos(k * da) + cos((k + 1) * da));
      }
      assert_near(expected, 1.0, 1e-3); /* 2 pi R^2 over 2 pi */
      assert_true(f.line.node[N - 1].axis && f.line.node[N - 1].x[0] == 0.0);
    }
    assert_relative(sum, expected, 1e-12);
    tear_down(&f);
  }
}

static void momentum_reaches_the_grid(void **state)
{
  (void)state;
  fixture f;
  set_up(&f, false);
  pw_real mass = 0.0, p[2] = {0.0, 0.0}, sum[3] = {0.0, 0.0, 0.0};
  for (pw_idx k = 0; k < N; k++) {
    pw_interface_node *a = &f.line.node[k];
    a->v[0] = 1.0 + a->x[1];
    a->v[1] = -2.0 * a->x[0];
    mass += a->mass;
    p[0] += a->mass * a->v[0];
    p[1] += a->mass * a->v[1];
  }
  pw_interface_p2g(&f.line, f.nodes.rec);
  for (pw_idx k = 0; k < f.mesh.nnode; k++) {
    for (int i = 0; i < 3; i++) {
      sum[i] += f.nodes.rec[(pw_off)k * PW_NODE + i];
    }
  }
  assert_relative(sum[0], mass, 1e-13);
  assert_relative(sum[1], p[0], 1e-13);
  assert_near(sum[2], p[1], 1e-13);
  tear_down(&f);
}

/* Body mass below y = 0.5 only: nodes of the line above that row exchange nothing with the empty
 * nodes, and weights sum to one wherever an element has any mass. */
static void empty_nodes_take_no_part(void **state)
{
  (void)state;
  fixture f;
  set_up(&f, false);
  for (pw_idx k = 0; k < f.mesh.nnode; k++) {
    bool full = pw_mesh_node_y(&f.mesh, k) <= 0.5;
    f.nodes.rec[(pw_off)k * PW_NODE] = full ? 10.0 : 1e-4;
  }
  pw_interface_weights(&f.line, f.nodes.rec, 1e-8);
  for (pw_idx k = 0; k < N; k++) {
    const pw_interface_node *a = &f.line.node[k];
    pw_real sum = 0.0, rate = 0.0, top = pw_mesh_node_y(&f.mesh, a->node + 2 * f.line.row);
    for (int j = 0; j < 4; j++) {
      pw_idx node = a->node + (j & 1) + (j >> 1) * f.line.row;
      sum += a->weight[j];
      rate += a->weight[j] * a->weight[j] / f.nodes.rec[(pw_off)node * PW_NODE];
    }
    assert_near(sum, 1.0, 1e-14);
    /* One over the effective mass: at most a few over the mass of the heavy nodes. */
    assert_true(top - 0.5 > 0.5 || rate <= 1.0 / 10.0 * 2.0);
  }
  tear_down(&f);
}

/* A linear velocity field moves the nodes exactly; the end on the axis keeps to it. */
static void line_moves_with_a_linear_field(void **state)
{
  (void)state;
  for (int axi = 0; axi < 2; axi++) {
    fixture f;
    set_up(&f, axi);
    for (pw_idx k = 0; k < f.mesh.nnode; k++) {
      pw_real *r = f.nodes.rec + (pw_off)k * PW_NODE;
      pw_real x = pw_mesh_node_x(&f.mesh, k), y = pw_mesh_node_y(&f.mesh, k);
      r[PW_NODE_MASS] = 1.0;
      r[PW_NODE_REMAP] = 0.3 * x + (axi ? 0.0 : 0.2);
      r[PW_NODE_REMAP + 1] = -0.1 * x + 0.4 * y;
      r[PW_NODE_FORCE] = 0.5 * x;
      r[PW_NODE_FORCE + 1] = 1.0;
    }
    pw_interface_node before[N];
    memcpy(before, f.line.node, sizeof before);
    pw_interface_weights(&f.line, f.nodes.rec, 1e-8);
    pw_interface_velocity(&f.line, f.nodes.rec, true);
    pw_interface_move(&f.line, f.nodes.rec, PW_NODE_REMAP, 0.01);
    for (pw_idx k = 0; k < N; k++) {
      const pw_real *x = before[k].x;
      const pw_interface_node *a = &f.line.node[k];
      assert_near(a->du[0], 0.01 * (0.3 * x[0] + (axi ? 0.0 : 0.2)), 1e-15);
      assert_near(a->x[1], x[1] + 0.01 * (-0.1 * x[0] + 0.4 * x[1]), 1e-14);
      assert_near(a->v[0], 0.5 * x[0], 1e-14);
      assert_near(a->v[1], 1.0, 1e-14);
    }
    tear_down(&f);
  }
}

/* Body mass at low nodes only: nodes of the line in cells without any go with the nearest node of the
 * line that the body carries. */
static void nodes_off_the_body_go_along(void **state)
{
  (void)state;
  fixture f;
  set_up(&f, false);
  for (pw_idx k = 0; k < f.mesh.nnode; k++) {
    pw_real *r = f.nodes.rec + (pw_off)k * PW_NODE;
    r[PW_NODE_MASS] = pw_mesh_node_y(&f.mesh, k) <= 0.5 ? 1.0 : 0.0;
    r[PW_NODE_REMAP] = 0.3 + pw_mesh_node_x(&f.mesh, k);
    r[PW_NODE_REMAP + 1] = -1.0;
  }
  pw_interface_weights(&f.line, f.nodes.rec, 1e-8);
  pw_interface_move(&f.line, f.nodes.rec, PW_NODE_REMAP, 0.01);
  int along = 0;
  for (pw_idx k = 0; k < N; k++) {
    const pw_interface_node *a = &f.line.node[k];
    assert_near(a->du[1], -0.01, 1e-15); /* nobody stays behind */
    if (a->weight[0] + a->weight[1] + a->weight[2] + a->weight[3] > 0.0) {
      continue;
    }
    const pw_interface_node *other = NULL;
    for (pw_idx far = 1; far < N && !other; far++) {
      for (int way = -1; way <= 1 && !other; way += 2) {
        const pw_idx m = k + way * far;
        const pw_real *w = m >= 0 && m < N ? f.line.node[m].weight : NULL;
        other = w && w[0] + w[1] + w[2] + w[3] > 0.0 ? &f.line.node[m] : NULL;
      }
    }
    assert_non_null(other);
    assert_near(a->du[0], other->du[0], 0.0);
    along++;
  }
  assert_true(along > 0 && along < N);
  tear_down(&f);
}

/* Split and merge keep mass, momentum and length of the line; capacity ends the splits. */
static void refining_conserves(void **state)
{
  (void)state;
  fixture f;
  set_up(&f, false);
  pw_real p0[3] = {0.0, 0.0, 0.0}, p1[3] = {0.0, 0.0, 0.0};
  for (pw_idx k = 0; k < N; k++) {
    pw_interface_node *a = &f.line.node[k];
    a->v[0] = a->x[1] * a->x[1];
    a->v[1] = 1.0 - a->x[0];
    a->x[0] *= 4.0; /* dragged apart sideways, so nearly unchanged at the ends */
    p0[0] += a->mass;
    p0[1] += a->mass * a->v[0];
    p0[2] += a->mass * a->v[1];
  }
  pw_refine_rule rule = {0.15, 0.06};
  pw_refine_counts counts = {0};
  for (int pass = 0; pass < 6; pass++) {
    pw_interface_refine(&f.line, &rule, &counts);
  }
  assert_true(counts.splits > 20 && counts.refused == 0);
  for (pw_idx k = 0; k < pw_interface_segments(&f.line); k++) {
    const pw_real *a = f.line.node[k].x, *b = f.line.node[k + 1].x;
    assert_true(hypot(b[0] - a[0], b[1] - a[1]) <= rule.longest);
  }
  for (pw_idx k = 0; k < f.line.n; k++) {
    f.line.node[k].x[0] *= 0.2; /* and pushed together */
  }
  for (int pass = 0; pass < 6; pass++) {
    pw_interface_refine(&f.line, &rule, &counts);
  }
  assert_true(counts.merges > 10);
  for (pw_idx k = 0; k < f.line.n; k++) {
    const pw_interface_node *a = &f.line.node[k];
    p1[0] += a->mass;
    p1[1] += a->mass * a->v[0];
    p1[2] += a->mass * a->v[1];
  }
  for (int i = 0; i < 3; i++) {
    assert_relative(p1[i], p0[i], 1e-12);
  }
  rule.longest = 1e-3;
  rule.shortest = 1e-4;
  for (int pass = 0; pass < 12; pass++) {
    pw_interface_refine(&f.line, &rule, &counts);
  }
  assert_int_equal(f.line.n, f.line.capacity);
  assert_true(counts.refused > 0);
  tear_down(&f);
}

static void no_memory_is_reported(void **state)
{
  (void)state;
  const pw_real xy[6] = {0.0, 0.0, 1.0, 0.0, 0.5, 1.0};
  pw_interface line = {0};
  for (int nth = 1; nth <= 3; nth++) {
    pw_off held = pw_mem_bytes();
    pw_mem_fail_after(nth);
    assert_int_equal(pw_interface_create(xy, NULL, 3, true, false, 8, &line), PW_ERR_MEMORY);
    pw_mem_fail_after(0);
    assert_true(pw_mem_bytes() == held);
  }
  const pw_real twice[6] = {0.0, 0.0, 0.0, 0.0, 0.5, 1.0};
  assert_int_equal(pw_interface_create(twice, NULL, 3, true, false, 8, &line), PW_ERR_ARGUMENT);
  assert_int_equal(pw_interface_create(xy, NULL, 2, true, false, 8, &line), PW_ERR_ARGUMENT);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(areas_are_those_of_the_surface),
      cmocka_unit_test(momentum_reaches_the_grid),
      cmocka_unit_test(empty_nodes_take_no_part),
      cmocka_unit_test(line_moves_with_a_linear_field),
      cmocka_unit_test(nodes_off_the_body_go_along),
      cmocka_unit_test(refining_conserves),
      cmocka_unit_test(no_memory_is_reported),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
