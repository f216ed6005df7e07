/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of the fine zone in pairs (grid.paired_rows_x_m), beside a body with four points to a fine cell:
 *  - points fill the body's volume, those beyond the column are two rows high, and the element of
 *    both rows is the lower one;
 *  - uniform stress between rollers is at rest: the forces at the nodes of the fine side that hang
 *    are carried over (without that each would be pushed with the stress times a row);
 *  - a free body keeps its uniform velocity and no stress, across rows as it moves;
 *  - a column that swings up and down in pairs and rows side by side is a quarter of its period
 *    late by no more than on the fine grid: u = A sin(pi y / 2 H) at t = H / c;
 *  - nodes hang in the field of a master of points, too; none may be held alone;
 *  - sand with long steps of its blocks gives the same bits on 1 and 2 threads. */
#include "tests/engine_scenes.h"

#include <stdlib.h>
#include <string.h>

static const pw_grid grid = {.size_m = {3.0, 2.0},
                             .cell_m = 0.0625,
                             .fine_x_m = {0.0, 0.5},
                             .fine_y_m = {0.5, 1.5},
                             .growth = 1.3,
                             .paired_rows_x_m = 0.75};

static void set_scene(pw_scene *s, bool axi, pw_real poisson, const pw_real *body)
{
  pw_scene_default(s);
  s->geometry = axi ? PW_AXI : PW_PLANE;
  s->grid = grid;
  const int soil = test_elastic(s, 1e7, poisson, 1500.0);
  pw_scene_body *b = test_rectangle(s, soil, body, 0.0);
  b->points_per_cell = 1;
  b->nrefine = 1;
  b->refine[0] = (pw_scene_refine){.x_m = {0.0, 0.5}, .y_m = {0.0, 2.0}, .points_per_cell = 2};
}

static const pw_real whole[4] = {0.0, 3.0, 0.0, 2.0};

static void points_fill_the_pairs(void **state)
{
  (void)state;
  static pw_scene s;
  set_scene(&s, false, 0.3, whole);
  pw_sim *sim = test_sim(&s, 1);
  const pw_mesh *m = &sim->mesh;
  pw_real volume = 0.0;
  pw_idx high = 0;
  for (pw_idx i = 0; i < sim->points.n; i++) {
    const pw_real x[2] = {sim->points.x[i], sim->points.x[sim->points.ld + i]};
    pw_real size[2];
    volume += sim->points.vol[i];
    pw_mesh_size_at(m, x, size);
    if (x[0] > 0.8 && x[1] > 0.5 && x[1] < 1.5) {
      const pw_idx row = pw_mesh_locate(m, x) / m->cells[0];
      assert_near(size[1], 0.125, 1e-12);
      assert_near(2.0 * sim->points.half[3 * sim->points.ld + i], 0.125, 1e-12);
      assert_int_equal((row - m->pair_row[0]) % 2, 0);
      high++;
    }
  }
  assert_near(volume, 6.0, 1e-12);
  assert_int_equal(high, 8 * (m->cells[0] - m->pair_column));
  pw_sim_destroy(&sim);
}

static void check_uniform(bool axi)
{
  static pw_scene s;
  const pw_real pressure = 1e5;
  set_scene(&s, axi, 0.3, whole);
  for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_RIGHT; side++) {
    if (!axi || side != PW_SIDE_LEFT) {
      test_roller(&s, side);
    }
  }
  pw_sim *sim = test_sim(&s, 1);
  pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n; i++) {
    for (int c = 0; c < 3; c++) {
      p->stress[c * p->ld + i] = -pressure;
    }
  }
  pw_real v = 0.0, off = 0.0;
  for (int k = 0; k < 50; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
  for (pw_idx i = 0; i < p->n; i++) {
    v = fmax(v, hypot(p->v[i], p->v[p->ld + i]));
    off = fmax(off, fabs(p->stress[p->ld + i] + pressure) / pressure);
  }
  print_message("%s: largest velocity %.1e m/s, stress off by %.1e\n", axi ? "axi" : "plane", v,
                off);
  assert_true(v < 1e-10 && off < 1e-9);
  pw_sim_destroy(&sim);
}

static void uniform_stress_rests(void **state)
{
  (void)state;
  check_uniform(false);
  check_uniform(true);
}

static void a_free_body_moves_on(void **state)
{
  (void)state;
  static pw_scene s;
  const pw_real v[2] = {3.0, 2.0};
  set_scene(&s, false, 0.3, (pw_real[]){0.25, 2.0, 0.75, 1.25});
  memcpy(s.body[0].velocity_m_s, v, sizeof v);
  pw_sim *sim = test_sim(&s, 1);
  pw_points *p = &sim->points;
  test_run_to(sim, 0.06); /* 3 cells, 2 rows */
  pw_real off = 0.0, stress = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    off = fmax(off, hypot(p->v[i] - v[0], p->v[p->ld + i] - v[1]));
    stress = fmax(stress, fabs(p->stress[i]) + fabs(p->stress[p->ld + i]));
  }
  print_message("%d steps: velocity off by %.1e m/s, stress %.1e Pa\n", (int)sim->step, off,
                stress);
  assert_true(off < 1e-11 && stress < 1e-4);
  pw_sim_destroy(&sim);
}

/* Height of the top above where it was, over the exact one. */
static pw_real swing(pw_real pairs)
{
  static pw_scene s;
  const pw_real height = 1.5, top = 1e-4, c = sqrt(1e7 / 1500.0);
  set_scene(&s, false, 0.0, (pw_real[]){0.0, 3.0, 0.0, height});
  s.grid.paired_rows_x_m = pairs;
  test_roller(&s, PW_SIDE_BOTTOM);
  test_roller(&s, PW_SIDE_LEFT);
  test_roller(&s, PW_SIDE_RIGHT);
  pw_sim *sim = test_sim(&s, 1);
  pw_points *p = &sim->points;
  const pw_real wave = acos(0.0) / height;
  pw_real worst = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    p->v[p->ld + i] = top * c * wave * sin(wave * p->x[p->ld + i]);
  }
  pw_real *y0 = calloc((size_t)p->n, sizeof *y0);
  memcpy(y0, p->x + p->ld, (size_t)p->n * sizeof *y0);
  pw_idx *id = calloc((size_t)p->n, sizeof *id);
  memcpy(id, p->id, (size_t)p->n * sizeof *id);
  test_run_to(sim, height / c);
  for (pw_idx i = 0; i < p->n; i++) {
    assert_int_equal(id[i], p->id[i]); /* not sorted meanwhile */
    worst = fmax(worst, fabs(p->x[p->ld + i] - y0[i] - top * sin(wave * y0[i])) / top);
  }
  print_message("pairs from %g m: displacements off by %.4f of the largest\n", pairs, worst);
  free(y0);
  free(id);
  pw_sim_destroy(&sim);
  return worst;
}

static void a_column_swings(void **state)
{
  (void)state;
  const pw_real fine = swing(0.0), pairs = swing(0.75);
  assert_true(fine < 0.01);
  assert_true(pairs < 0.01);
}

/* A block of points on soil, both beyond the column. */
static void all_fields_hang(void **state)
{
  (void)state;
  static pw_scene s;
  set_scene(&s, false, 0.3, (pw_real[]){0.0, 3.0, 0.0, 1.0});
  const pw_real block[4] = {1.2, 1.8, 1.0, 1.4};
  test_rectangle(&s, test_elastic(&s, 1e8, 0.3, 2500.0), block, 0.05)->velocity_m_s[1] = -1.0;
  test_add_contact(&s, TEST_CORNER, 1, 0, 0.3, 0.0, 0.05);
  test_gravity(&s, 0.0);
  test_roller(&s, PW_SIDE_BOTTOM);
  pw_sim *sim = test_sim(&s, 1);
  const pw_mesh *m = &sim->mesh;
  pw_real off = 0.0, most[2] = {0.0, 0.0};
  test_run_to(sim, 0.01);
  assert_int_equal(sim->nodes.nfield, 2);
  for (int f = 0; f < 2; f++) {
    for (pw_idx k = 0; k < m->nnode; k++) {
      const pw_real *at = pw_nodes_field(&sim->nodes, f) + (pw_off)k * PW_NODE + PW_NODE_VEL + 1;
      const pw_off row = (pw_off)m->nodes[0] * PW_NODE;
      if (pw_mesh_hangs(m, k % m->nodes[0], k / m->nodes[0])) {
        off = fmax(off, fabs(at[0] - 0.5 * (at[-row] + at[row])));
        most[f] = fmax(most[f], fabs(at[0]));
      }
    }
  }
  print_message("hanging nodes off by %.1e of %.2f and %.2f m/s\n", off, most[0], most[1]);
  assert_true(off < 1e-14 && most[0] > 1e-3 && most[1] > 0.1);
  pw_sim_destroy(&sim);
}

static pw_status held(pw_real low, pw_real high)
{
  static pw_scene s;
  pw_sim *sim = NULL;
  set_scene(&s, false, 0.3, whole);
  pw_boundary_param *b = pw_scene_add_effect(&s, "boundary");
  *b = (pw_boundary_param){
      .side = PW_SIDE_BOX, .x_m = {1.0, 3.0}, .y_m = {low, high}, .fix_y = true, .body = -1};
  pw_error_clear();
  const pw_status status = pw_sim_create(&s, 1, &sim);
  pw_sim_destroy(&sim);
  return status;
}

static void none_is_held_alone(void **state)
{
  (void)state;
  assert_ok(held(0.625, 0.625)); /* rows of nodes from 0.5 m on, every second one hangs */
  assert_ok(held(0.625, 0.75));
  assert_int_equal(held(0.5625, 0.5625), PW_ERR_SCENE);
  assert_non_null(strstr(pw_error_text(), "hangs on those below and above"));
  assert_int_equal(held(0.625, 0.6875), PW_ERR_SCENE);
}

static pw_sim *sand(int threads)
{
  static pw_scene s;
  pw_scene_default(&s);
  s.geometry = PW_AXI;
  s.grid = grid;
  s.method.step_ratio_max = 4;
  s.method.block_elements = 24;
  pw_scene_body *b = test_rectangle(&s, test_sand(&s, true), (pw_real[]){0.0, 3.0, 0.0, 1.25}, 0.0);
  b->points_per_cell = 1;
  b->velocity_m_s[1] = 0.2;
  test_gravity(&s, 0.0);
  pw_initial_stress_param *i = pw_scene_add_effect(&s, "initial_stress");
  i->body = 0;
  i->top_y_m = 1.25;
  i->k0 = 0.45;
  test_roller(&s, PW_SIDE_BOTTOM);
  test_roller(&s, PW_SIDE_RIGHT);
  return test_sim(&s, threads);
}

static void threads_do_not_matter(void **state)
{
  (void)state;
  pw_sim *one = sand(1), *two = sand(2);
  test_run_to(one, 0.05);
  test_run_to(two, 0.05);
  const size_t row = (size_t)one->points.n * sizeof(pw_real);
  assert_int_equal(one->step, two->step);
  assert_true(one->step > 50);
  for (int c = 0; c < 2; c++) {
    assert_memory_equal(one->points.x + c * one->points.ld, two->points.x + c * two->points.ld,
                        row);
    assert_memory_equal(one->points.v + c * one->points.ld, two->points.v + c * two->points.ld,
                        row);
  }
  pw_sim_destroy(&one);
  pw_sim_destroy(&two);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_fill_the_pairs), cmocka_unit_test(uniform_stress_rests),
      cmocka_unit_test(a_free_body_moves_on),  cmocka_unit_test(a_column_swings),
      cmocka_unit_test(all_fields_hang),       cmocka_unit_test(none_is_held_alone),
      cmocka_unit_test(threads_do_not_matter),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
