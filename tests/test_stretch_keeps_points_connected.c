/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Extension (verification A10): a bar with two points per cell is stretched tenfold by nodal
 * velocities v = k x, so that every point gets the stretch lambda = (1 + k dt)^steps.
 * Neo-Hookean with nu = 0: sigma = mu (lambda - 1/lambda). CPDI domains stretch with the bar and
 * keep sharing nodes; uGIMP's do not: neighbours can lose each other from lambda = points per cell
 * + 1 = 3 on and have certainly done so at 2 x 2 + 1 = 5. */
#include "tests/engine_helpers.h"

#include "engine/assemble.h"
#include "engine/update.h"

enum { CELLS = 12, LAMBDA = 10 };

static const double cell = 0.25, mu = 5e5, rate = 1.0, dt = 0.005;

static pw_sim *bar_sim(int basis)
{
  static pw_scene s;
  pw_scene_default(&s);
  s.method.basis = basis;
  s.method.domain_limit_cells = 4.0; /* a domain is five cells long at the end */
  double length = CELLS * cell;
  test_grid(&s, (double[]){0.0, (LAMBDA * CELLS + 2) * cell, 0.0, 2.0 * cell}, cell);
  int m = test_neo_hookean(&s, 2.0 / 3.0 * mu, mu, 1e3);
  test_rectangle(&s, m, (double[]){0.0, length, 0.0, 2.0 * cell}, 0.5 * cell);
  return test_sim(&s, 1);
}

/* One step with the velocity of every node given. */
static void stretch(pw_sim *sim)
{
  for (pw_idx k = 0; k < sim->mesh.nnode; k++) {
    sim->nodes.rec[(pw_off)k * PW_NODE + PW_NODE_VEL] = rate * pw_mesh_node_x(&sim->mesh, k);
    sim->nodes.rec[(pw_off)k * PW_NODE + PW_NODE_VEL + 1] = 0.0;
  }
  pw_update_pass pass = {sim, PW_NODE_VEL, true, true};
  sim->dt = dt;
  pw_for_blocks(&sim->blocks, sim->threads, pw_block_update, &pass);
  assert_ok(pw_update_collect(sim));
  assert_ok(pw_update_sort(sim));
}

/* Force of the bar on the nodes at its fixed end, over its height: the stress there. */
static double end_stress(pw_sim *sim)
{
  double force = 0.0;
  pw_nodes_clear(&sim->nodes);
  pw_assemble_coloured(&sim->blocks, sim->threads, pw_block_p2g, sim);
  for (pw_idx j = 0; j < sim->mesh.nodes[1]; j++) {
    force += sim->nodes.rec[(pw_off)j * sim->mesh.nodes[0] * PW_NODE + PW_NODE_FORCE];
  }
  return force / (2.0 * cell);
}

/* The node at the middle of the bar: whether points on its left and on its right share a node. */
static bool connected(const pw_sim *sim)
{
  const pw_points *p = &sim->points;
  const double middle = 0.5 * CELLS * cell;
  double left = 0.0, right = 1e9, half = 0.25 * cell; /* uGIMP: half of a domain */
  for (pw_idx id = 0; id < p->n; id++) {
    double x0 = (id % (2 * CELLS) + 0.5) * 0.5 * cell, x = p->x[p->slot[id]];
    left = x0 < middle ? fmax(left, x) : left;
    right = x0 > middle ? fmin(right, x) : right;
  }
  /* last node reached by the left point, first one reached by the right point */
  double last = ceil((left + half) / cell - 1e-9), first = floor((right - half) / cell + 1e-9);
  return last >= first;
}

static double lambda_of(int steps)
{
  return pow(1.0 + rate * dt, steps);
}

static void cpdi_carries_the_force_to_ten(void **state)
{
  (void)state;
  pw_sim *sim = bar_sim(PW_CPDI);
  double worst = 0.0;
  for (int n = 1; lambda_of(n) <= LAMBDA; n++) {
    stretch(sim);
    double l = lambda_of(n);
    worst = fmax(worst, fabs(end_stress(sim) / (mu * (l - 1.0 / l)) - 1.0));
  }
  print_message("cpdi: end force within %.1e of the constitutive value\n", worst);
  assert_true(worst <= 0.01);
  assert_int_equal(sim->limited, 0);
  pw_sim_destroy(&sim);
}

static void ugimp_separates(void **state)
{
  (void)state;
  pw_sim *sim = bar_sim(PW_UGIMP);
  double apart = 0.0, off = 0.0, gone = 0.0;
  for (int n = 1; lambda_of(n) <= LAMBDA; n++) {
    stretch(sim);
    double l = lambda_of(n), ratio = end_stress(sim) / (mu * (l - 1.0 / l));
    apart = apart == 0.0 && !connected(sim) ? l : apart;
    off = off == 0.0 && fabs(ratio - 1.0) > 0.01 ? l : off;
    gone = gone == 0.0 && ratio < 1e-6 ? l : gone;
  }
  print_message("ugimp: end force off by 1 %% from lambda = %.3f on and gone at %.3f; the middle "
                "of the bar first comes apart at %.3f\n",
                off, gone, apart);
  assert_true(apart >= 3.0 - 0.01 && apart <= 5.0 + 0.01);
  assert_true(gone > 0.0 && gone <= 5.0 + 0.03);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cpdi_carries_the_force_to_ten),
      cmocka_unit_test(ugimp_separates),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
