/* SPDX-License-Identifier: GPL-3.0-or-later */
/* points_per_cell: every cell that a rectangle covers holds n x n domains of its own, cut cells
 * fewer; areas are exact, domains square to the axes and none lies across two cells. */
#include <stdlib.h>

#include "engine/bodies.h"
#include "engine/core/mem.h"
#include "engine/mesh.h"
#include "tests/harness.h"

static pw_scene scene_of(pw_geometry geometry, const pw_real x[2], const pw_real y[2], int n)
{
  pw_scene s;
  memset(&s, 0, sizeof s);
  s.geometry = geometry;
  s.grid = (pw_grid){.size_m = {5.0, 16.0},
                     .cell_m = 0.1,
                     .fine_x_m = {0.0, 1.0},
                     .fine_y_m = {6.0, 11.0},
                     .growth = 1.15,
                     .cell_max_m = 0.6};
  s.nbody = 1;
  s.body[0] = (pw_scene_body){
      .shape = PW_SHAPE_RECTANGLE, .x_m = {x[0], x[1]}, .y_m = {y[0], y[1]}, .points_per_cell = n};
  return s;
}

typedef struct {
  pw_mesh mesh;
  pw_domains d;
  int *count;       /* of each element */
  long double area; /* of many domains: summed without round-off of its own */
} filled;

/* Fill, and check what holds for every body: one cell for each domain, inside the body. */
static filled fill(const pw_scene *s)
{
  filled f = {.d = {0}};
  const pw_scene_body *b = &s->body[0];
  assert_ok(pw_mesh_create_grid(&s->grid, &f.mesh));
  assert_ok(pw_domains_create(s, &f.d));
  f.count = calloc((size_t)f.mesh.nelem, sizeof *f.count);
  for (pw_idx i = 0; i < f.d.n; i++) {
    const pw_idx n = f.d.n;
    double x[2] = {f.d.x[i], f.d.x[n + i]}, half[2] = {f.d.half[i], f.d.half[3 * n + i]};
    assert_true(f.d.half[n + i] == 0.0 && f.d.half[2 * n + i] == 0.0);
    assert_true(half[0] > 0.0 && half[1] > 0.0);
    pw_idx e = pw_mesh_locate(&f.mesh, x), k[2] = {e % f.mesh.cells[0], e / f.mesh.cells[0]};
    for (int a = 0; a < 2; a++) {
      const double *node = f.mesh.axis[a].node + k[a], *side = a == 0 ? b->x_m : b->y_m;
      assert_true(x[a] - half[a] >= fmax(node[0], side[0]) - 1e-12);
      assert_true(x[a] + half[a] <= fmin(node[1], side[1]) + 1e-12);
      assert_true(2.0 * half[a] * b->points_per_cell <= (node[1] - node[0]) * (1.0 + 1e-6));
    }
    f.count[e]++;
    f.area += 4.0L * half[0] * half[1];
  }
  return f;
}

static void drop(filled *f)
{
  pw_domains_destroy(&f->d);
  pw_mesh_destroy(&f->mesh);
  free(f->count);
}

static void whole_cells_hold_n_by_n(void **state)
{
  (void)state;
  for (int n = 1; n <= 4; n++) {
    pw_scene s = scene_of(PW_AXI, (pw_real[]){0.0, 5.0}, (pw_real[]){0.0, 11.0}, n);
    filled f = fill(&s);
    long double volume = 0.0;
    for (pw_idx e = 0; e < f.mesh.nelem; e++) {
      bool inside = f.mesh.axis[1].node[e / f.mesh.cells[0]] < 11.0 - 1e-9;
      assert_int_equal(f.count[e], inside ? n * n : 0);
    }
    for (pw_idx i = 0; i < f.d.n; i++) {
      volume += 4.0L * f.d.half[i] * f.d.half[3 * f.d.n + i] * f.d.x[i];
    }
    assert_relative((double)f.area, 55.0, 1e-13);
    assert_relative((double)volume, 12.5 * 11.0, 1e-13); /* per radian: r^2 / 2 times the height */
    assert_true(f.d.x[0] == f.d.half[0]);                /* on the axis */
    drop(&f);
  }
}

static void cut_cells_keep_the_area(void **state)
{
  (void)state;
  uint64_t seed = 12;
  for (int trial = 0; trial < 40; trial++) {
    pw_real x0 = 4.0 * test_random(&seed), y0 = 14.0 * test_random(&seed);
    pw_real x[2] = {x0, x0 + 0.01 + 0.9 * test_random(&seed)};
    pw_real y[2] = {y0, y0 + 0.01 + 1.9 * test_random(&seed)};
    pw_scene s = scene_of(PW_PLANE, x, y, 1 + trial % 4);
    filled f = fill(&s);
    assert_relative((double)f.area, (x[1] - x[0]) * (y[1] - y[0]), 1e-12);
    drop(&f);
  }
}

static void boxes_ask_for_more(void **state)
{
  (void)state;
  pw_scene s = scene_of(PW_PLANE, (pw_real[]){0.0, 5.0}, (pw_real[]){0.0, 16.0}, 1);
  s.body[0].nrefine = 1;
  s.body[0].refine[0] =
      (pw_scene_refine){.x_m = {0.0, 1.0}, .y_m = {6.0, 11.0}, .points_per_cell = 3};
  filled f = fill(&s);
  for (pw_idx e = 0; e < f.mesh.nelem; e++) {
    pw_real size[2], low[2] = {f.mesh.axis[0].node[e % f.mesh.cells[0]],
                               f.mesh.axis[1].node[e / f.mesh.cells[0]]};
    pw_mesh_cell_size(&f.mesh, e, size);
    bool fine = low[0] + 0.5 * size[0] < 1.0 && low[1] + 0.5 * size[1] > 6.0 &&
                low[1] + 0.5 * size[1] < 11.0;
    assert_int_equal(f.count[e], fine ? 9 : 1);
  }
  assert_relative((double)f.area, 80.0, 1e-13);
  drop(&f);
}

static void a_uniform_grid_is_filled_as_well(void **state)
{
  (void)state;
  pw_scene s = scene_of(PW_PLANE, (pw_real[]){0.5, 1.5}, (pw_real[]){0.0, 2.0}, 2);
  s.grid = (pw_grid){.size_m = {2.0, 2.0}, .cell_m = 0.25};
  pw_domains d = {0};
  assert_ok(pw_domains_create(&s, &d));
  assert_int_equal(d.n, 4 * 8 * 4);
  for (pw_idx i = 0; i < d.n; i++) {
    assert_near(d.half[i], 0.0625, 1e-15);
    assert_near(d.half[3 * d.n + i], 0.0625, 1e-15);
  }
  pw_domains_destroy(&d);
}

static void failed_allocations_leak_nothing(void **state)
{
  (void)state;
  pw_scene s = scene_of(PW_PLANE, (pw_real[]){0.0, 5.0}, (pw_real[]){0.0, 11.0}, 2);
  pw_domains d = {0};
  pw_off held = pw_mem_bytes(), nth = 0;
  pw_status status;
  do {
    pw_mem_fail_after(++nth);
    status = pw_domains_create(&s, &d);
    pw_mem_fail_after(0);
    assert_true(status == PW_OK || (status == PW_ERR_MEMORY && pw_mem_bytes() == held && !d.x));
  } while (status != PW_OK);
  assert_int_equal(nth, 14);
  pw_domains_destroy(&d);
  assert_int_equal(pw_mem_bytes(), held);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(whole_cells_hold_n_by_n),
      cmocka_unit_test(cut_cells_keep_the_area),
      cmocka_unit_test(boxes_ask_for_more),
      cmocka_unit_test(a_uniform_grid_is_filled_as_well),
      cmocka_unit_test(failed_allocations_leak_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
