/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Domains on a graded grid: the halo holds every domain its limit allows, wherever it is; limits
 * are in cells of the place where the domain is; and a body flies from coarse to fine cells and
 * back out without leaving its blocks' halo. Aspects of points of one size are not those of cells. */
#include <stdlib.h>

#include "tests/engine_scenes.h"

#include "engine/domain.h"
#include "engine/sim_report.h"

static const pw_grid grid = {.size_m = {6.0, 4.0},
                             .cell_m = 0.1,
                             .fine_x_m = {2.5, 3.5},
                             .fine_y_m = {1.6, 2.4},
                             .growth = 1.3,
                             .cell_max_m = 0.4};

/* A domain that was limited in a cell or in a neighbour of it, with its centre anywhere in it. */
static void the_halo_holds_every_domain(void **state)
{
  (void)state;
  uint64_t seed = 1;
  for (int trial = 0; trial < 60; trial++) {
    pw_grid g = grid;
    pw_mesh m;
    g.growth = 1.05 + 0.45 * test_random(&seed);
    if (trial % 2) {
      g.cell_max_m = 0.0;
    }
    assert_ok(pw_mesh_create_grid(&g, &m));
    pw_real limit = 0.5 + 2.4 * test_random(&seed);
    pw_idx reach = pw_domain_reach(&m, limit), most = 0;
    for (int a = 0; a < 2; a++) {
      const pw_grid_axis *axis = &m.axis[a];
      for (pw_idx k = 0; k < axis->cells; k++) {
        for (int s = 0; s < 30; s++) {
          pw_idx other = k + s % 3 - 1;
          other = other < 0 || other >= axis->cells ? k : other;
          pw_real x = axis->node[k] + axis->size[k] * (s < 3 ? 0.0 : test_random(&seed));
          pw_real way = (s % 2 ? 1.0 : -1.0) * limit * axis->size[other] * (1.0 - 1e-8);
          pw_idx at = pw_grid_axis_cell(axis, pw_grid_axis_clamp(axis, x + way));
          most = abs(at - k) > most ? abs(at - k) : most;
        }
      }
    }
    assert_true(most <= reach);
    assert_true(reach == 2 || most >= reach - 1); /* and it is not much wider than needed */
    pw_mesh_destroy(&m);
  }
}

static pw_sim *block(const double box[4], double vx)
{
  static pw_scene s;
  pw_scene_default(&s);
  s.grid = grid;
  int m = test_neo_hookean(&s, 1e5, 5e4, 1e3);
  pw_scene_body *b = test_rectangle(&s, m, box, 0.0);
  b->points_per_cell = 2;
  b->velocity_m_s[0] = vx;
  return test_sim(&s, 1);
}

/* Longer half diagonal in cells at the point. */
static double in_cells(const pw_sim *sim, pw_idx i)
{
  const pw_points *p = &sim->points;
  const pw_real *h = p->half + i;
  double x[2] = {p->x[i], p->x[p->ld + i]}, size[2];
  pw_mesh_size_at(&sim->mesh, x, size);
  double ax = (h[0] + h[2 * p->ld]) / size[0], ay = (h[p->ld] + h[3 * p->ld]) / size[1];
  double bx = (h[0] - h[2 * p->ld]) / size[0], by = (h[p->ld] - h[3 * p->ld]) / size[1];
  return fmax(hypot(ax, ay), hypot(bx, by));
}

static void limits_follow_the_cells(void **state)
{
  (void)state;
  pw_sim *sim = block((double[]){1.0, 5.0, 0.5, 3.5}, 0.0);
  pw_points *p = &sim->points;
  pw_block_sums sums = {0};
  pw_domain_convect(sim, NULL, 0, p->n, &sums);
  assert_int_equal(sums.limited, 0); /* nothing is limited at the start */
  for (pw_idx i = 0; i < p->n; i++) {
    assert_true(in_cells(sim, i) <= sqrt(0.125) * (1.0 + 1e-9));
    p->def_grad[i] = 7.0; /* stretched to 1.77 cells and more along x */
    p->def_grad[3 * p->ld + i] = 0.5;
  }
  pw_domain_convect(sim, NULL, 0, p->n, &sums);
  assert_true(sums.limited > p->n / 2);
  for (pw_idx i = 0; i < p->n; i++) {
    assert_true(in_cells(sim, i) <= 1.0 + 1e-12);
    assert_true(p->half[i] > 0.0 && p->half[3 * p->ld + i] > 0.0);
  }
  pw_sim_destroy(&sim);
}

static void a_body_flies_through_the_fine_zone(void **state)
{
  (void)state;
  pw_sim *sim = block((double[]){0.6, 1.6, 1.5, 2.5}, 4.0);
  double mass = sim->mass, com[6];
  test_run_to(sim, 0.9); /* 3.6 m */
  pw_body_centre(sim, 0, com);
  pw_report r;
  pw_sim_report(sim, &r);
  print_message("%d steps, sorted %d times, %d domains limited; place %.12g m\n", (int)r.steps,
                (int)r.sorts, (int)r.domains_limited, com[0]);
  assert_true(r.sorts > 3 && r.domains_limited > 0);
  assert_relative(com[5], mass, 1e-12);
  assert_near(com[0], 1.1 + 3.6, 1e-9);
  assert_near(com[2], 4.0, 1e-10);
  assert_near(com[3], 0.0, 1e-10);
  for (pw_idx i = 0; i < sim->points.n; i++) { /* rigid flight: no strain, no stress */
    assert_near(sim->points.def_grad[i], 1.0, 1e-9);
    assert_near(sim->points.stress[i], 0.0, 1e-4);
  }
  pw_sim_destroy(&sim);
}

/* Domains much larger than the cells they are in are refused, not squeezed. */
static void coarse_points_in_fine_cells_are_refused(void **state)
{
  (void)state;
  static pw_scene s;
  pw_sim *sim = NULL;
  pw_scene_default(&s);
  s.grid = grid;
  int m = test_elastic(&s, 1e6, 0.3, 1e3);
  test_rectangle(&s, m, (double[]){1.0, 5.0, 0.5, 3.5}, 0.5);
  assert_int_equal(pw_sim_create(&s, 1, &sim), PW_ERR_SCENE);
  assert_non_null(strstr(pw_error_text(), "give points_per_cell, or refine it there"));
}

/* Square points in cells five times as wide as high: with points_per_cell they would be reshaped to
 * the aspect of the cells, and a load on them would act on another area. */
static void points_of_one_size_stay_square(void **state)
{
  (void)state;
  static pw_scene s;
  pw_scene_default(&s);
  s.grid = (pw_grid){.size_m = {4.0, 2.0},
                     .cell_m = 0.1,
                     .fine_x_m = {0.0, 0.5},
                     .growth = 1.5,
                     .cell_max_m = 0.5};
  s.method.domain_aspect_max = 2.0;
  const int m = test_elastic(&s, 1e6, 0.3, 1000.0);
  test_rectangle(&s, m, (double[]){2.0, 3.0, 0.5, 1.0}, 0.05);
  pw_sim *sim = test_sim(&s, 1);
  for (int k = 0; k < 5; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
  const pw_points *p = &sim->points;
  assert_int_equal(sim->reshaped, 0);
  for (pw_idx i = 0; i < p->n; i++) {
    assert_near(p->half[i], 0.025, 1e-15);
    assert_near(p->half[3 * p->ld + i], 0.025, 1e-15);
  }
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_halo_holds_every_domain),
      cmocka_unit_test(limits_follow_the_cells),
      cmocka_unit_test(a_body_flies_through_the_fine_zone),
      cmocka_unit_test(coarse_points_in_fine_cells_are_refused),
      cmocka_unit_test(points_of_one_size_stay_square),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
