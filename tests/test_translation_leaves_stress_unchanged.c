/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rigid translation of a uniformly stressed block through ten cells (verification A9): the stress
 * must not change, and nodes inside the block must be free of force wherever its points stand in
 * their cells. The cells hold two or three points along an edge by turns (a whole number of points
 * would hide the error of linear MPM, a force of the order of sigma h). */
#include "tests/engine_helpers.h"

#include "engine/assemble.h"
#include "engine/update.h"

enum { SIDE = 6 }; /* cells along an edge of the block */

static const double cell = 0.5, stress0[4] = {-3e3, -2e3, -1e3, 0.0};

static void block_scene(pw_scene *s, int basis)
{
  pw_scene_default(s);
  s->method.basis = basis;
  test_grid(s, (double[]){0.0, 20.0 * cell, 0.0, 20.0 * cell}, cell);
  int m = test_elastic(s, 1e6, 0.3, 2e3);
  test_rectangle(s, m, (double[]){2.0 * cell, (2.0 + SIDE) * cell, 2.0 * cell, (2.0 + SIDE) * cell},
                 0.4 * cell);
  pw_initial_stress_param *i = pw_scene_add_effect(s, "initial_stress");
  i->body = 0;
  i->kind = PW_STRESS_UNIFORM;
  i->stress_xx_pa = stress0[0];
  i->stress_yy_pa = stress0[1];
  i->stress_zz_pa = stress0[2];
}

static double stress_change(const pw_sim *sim, const double *want)
{
  const pw_points *p = &sim->points;
  double worst = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    for (int c = 0; c < 4; c++) {
      worst = fmax(worst, fabs(p->stress[c * p->ld + i] - want[c]));
    }
  }
  return worst / fabs(want[0]);
}

/* Largest force of points on a node whose cells, and theirs, are full, over sigma h. */
static double interior_residual(pw_sim *sim)
{
  const pw_points *p = &sim->points;
  double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9}, worst = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    for (int a = 0; a < 2; a++) {
      low[a] = fmin(low[a], p->x[a * p->ld + i]);
      high[a] = fmax(high[a], p->x[a * p->ld + i]);
    }
  }
  pw_nodes_clear(&sim->nodes);
  pw_assemble_coloured(&sim->blocks, sim->threads, pw_block_p2g, sim);
  for (pw_idx k = 0; k < sim->mesh.nnode; k++) {
    double x[2] = {pw_mesh_node_x(&sim->mesh, k), pw_mesh_node_y(&sim->mesh, k)};
    bool inside = true;
    for (int a = 0; a < 2; a++) {
      inside = inside && x[a] - low[a] >= 1.5 * cell && high[a] - x[a] >= 1.5 * cell;
    }
    for (int a = 0; a < 2 && inside; a++) {
      worst = fmax(worst, fabs(sim->nodes.rec[(pw_off)k * PW_NODE + PW_NODE_FORCE + a]));
    }
  }
  return worst / (fabs(stress0[0]) * cell);
}

/* The block moves as given, with both velocity components. */
static void moved_block(void **state)
{
  (void)state;
  for (int basis = PW_LINEAR; basis <= PW_CPDI; basis++) {
    static pw_scene s;
    block_scene(&s, basis);
    pw_prescribed_motion_param *m = pw_scene_add_effect(&s, "prescribed_motion");
    m->body = 0;
    m->velocity_m_s[0] = 1.0;
    m->velocity_m_s[1] = 0.63;
    s.time.dt_s = 0.0371 * cell;
    pw_sim *sim = test_sim(&s, 1);
    double residual = 0.0, least = 1e9, change = 0.0;
    while (sim->time < 10.0 * cell) {
      assert_ok(pw_sim_step(sim, 0.0));
      double r = interior_residual(sim);
      residual = fmax(residual, r);
      least = fmin(least, r);
      change = fmax(change, stress_change(sim, stress0));
    }
    print_message("basis %d: stress changed by %.1e, residual at most %.1e sigma h\n", basis,
                  change, residual);
    assert_true(change <= 1e-12);
    if (basis == PW_LINEAR) {
      assert_true(residual >= 0.1);
    } else {
      assert_true(residual <= 1e-12);
    }
    pw_sim_destroy(&sim);
  }
}

/* A free block under the same pressure on its four sides flies through the cells: the pressure on
 * the edges of CPDI domains balances their stress at every node, so that nothing changes. */
static void flying_block(void **state)
{
  (void)state;
  static pw_scene s;
  const double pressure[4] = {-3e3, -3e3, -3e3, 0.0};
  block_scene(&s, PW_CPDI);
  pw_initial_stress_param *i = (pw_initial_stress_param *)(void *)s.effect[0].param;
  i->stress_xx_pa = i->stress_yy_pa = i->stress_zz_pa = pressure[0];
  for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_RIGHT; side++) {
    pw_surcharge_param *p = pw_scene_add_effect(&s, "surcharge");
    p->body = 0;
    p->side = side;
    p->pressure_pa = -pressure[0];
  }
  s.body[0].velocity_m_s[0] = 10.0;
  s.body[0].velocity_m_s[1] = 6.3;
  pw_sim *sim = test_sim(&s, 1);
  double change = 0.0;
  while (sim->time < cell) {
    assert_ok(pw_sim_step(sim, 0.0));
    change = fmax(change, stress_change(sim, pressure));
  }
  print_message("free block: %d steps, stress changed by %.1e\n", (int)sim->step, change);
  assert_true(change <= 1e-9);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(moved_block),
      cmocka_unit_test(flying_block),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
