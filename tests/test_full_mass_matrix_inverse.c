/* SPDX-License-Identifier: GPL-3.0-or-later */
/* method.mass_terms: increments of velocity by two terms of the series for the inverse of the
 * full mass matrix (engine/full_mass.h), against that series with dense matrices; what it keeps; and
 * what it is for: a free body keeps its spin. */
#include "tests/contact_helpers.h"

#include "engine/update.h"

enum { NODES = 13 * 13, POINTS = 200 };

/* A block across the cells of a 12 x 12 grid, held at its lower end and pulled at its left one, with
 * random velocities and stresses. */
static pw_sim *random_block(int geometry, int update, int terms)
{
  static pw_scene s;
  pw_scene_default(&s);
  s.geometry = geometry;
  test_grid(&s, (double[]){0.0, 1.2, 0.0, 1.2}, 0.1);
  int m = test_elastic(&s, 1e6, 0.3, 1000.0);
  test_rectangle(&s, m, (double[]){0.05, 0.63, 0.02, 0.61}, 0.06);
  s.method.update = update;
  s.method.mass_terms = terms;
  s.time.dt_s = 1e-4;
  pw_boundary_param *b = pw_scene_add_effect(&s, "boundary");
  *b = (pw_boundary_param){.side = PW_SIDE_BOTTOM, .fix_y = true, .body = -1};
  b = pw_scene_add_effect(&s, "boundary");
  *b = (pw_boundary_param){.side = PW_SIDE_LEFT, .fix_x = true, .velocity_x_m_s = -0.7, .body = -1};
  pw_sim *sim = test_sim(&s, 1);
  uint64_t seed = 12;
  for (pw_idx i = 0; i < sim->points.n; i++) {
    for (int a = 0; a < 2; a++) {
      sim->points.v[a * sim->points.ld + i] = test_random(&seed) - 0.5;
    }
    for (int c = 0; c < 4; c++) {
      sim->points.stress[(pw_off)c * sim->points.ld + i] = 1e5 * (test_random(&seed) - 0.5);
    }
  }
  assert_ok(pw_update_sort(sim));
  return sim;
}

/* Weights of all points before the step. */
static void weights(const pw_sim *sim, double *s)
{
  memset(s, 0, sizeof(double) * POINTS * NODES);
  assert_true(sim->points.n <= POINTS && sim->mesh.nnode == NODES);
  for (pw_idx i = 0; i < sim->points.n; i++) {
    pw_support at;
    sim->kernels->support(&sim->transfer, i, &at);
    for (int k = 0; k < at.n; k++) {
      s[i * NODES + at.node[k]] += at.s[k];
    }
  }
}

/* y = M x, M_ij = sum m S_i S_j. */
static void times_mass(const pw_sim *sim, const double *s, const double *x, double *y)
{
  memset(y, 0, sizeof(double) * NODES);
  for (pw_idx i = 0; i < sim->points.n; i++) {
    double sum = 0.0;
    for (int k = 0; k < NODES; k++) {
      sum += s[i * NODES + k] * x[k];
    }
    for (int k = 0; k < NODES; k++) {
      y[k] += sim->points.mass[i] * s[i * NODES + k] * sum;
    }
  }
}

static bool held(const pw_sim *sim, int node, int a)
{
  return a == 1 ? node / 13 == 0
                : node % 13 == 0 || (sim->scene.geometry == PW_AXI && node % 13 == 0);
}

/* Increments of component a by two terms, from the first in dv; held nodes stay held. */
static void add_second_term(const pw_sim *sim, const double *s, int a, double *dv)
{
  static double image[NODES], mass[NODES];
  memset(mass, 0, sizeof mass);
  for (pw_idx i = 0; i < sim->points.n; i++) {
    for (int k = 0; k < NODES; k++) {
      mass[k] += sim->points.mass[i] * s[i * NODES + k];
    }
  }
  times_mass(sim, s, dv, image);
  for (int k = 0; k < NODES; k++) {
    const bool free = mass[k] > sim->mass_cut_off && !held(sim, k, a);
    dv[k] += free ? dv[k] - image[k] / mass[k] : 0.0;
  }
}

/* Largest difference of the velocities after a step from those of the dense matrices, and of the
 * second term from nothing; m/s. */
static void compare(int geometry, double *worst, double *change)
{
  static double s[POINTS * NODES], before[2 * POINTS], dv[NODES];
  pw_sim *one = random_block(geometry, PW_USL, 1), *two = random_block(geometry, PW_USL, 2);
  const pw_idx n = two->points.n, ld = two->points.ld;
  weights(two, s);
  for (int a = 0; a < 2; a++) {
    memcpy(before + a * n, two->points.v + a * ld, (size_t)n * sizeof(double));
  }
  assert_ok(pw_sim_step(one, 0.0));
  assert_ok(pw_sim_step(two, 0.0));
  for (int a = 0; a < 2; a++) {
    for (int k = 0; k < NODES; k++) { /* increments of the lumped step; zero without mass */
      dv[k] = one->nodes.rec[k * PW_NODE + PW_NODE_FORCE + a];
    }
    add_second_term(two, s, a, dv);
    for (pw_idx i = 0; i < n; i++) {
      double want = before[a * n + i];
      for (int k = 0; k < NODES; k++) {
        want += s[i * NODES + k] * dv[k];
      }
      *worst = fmax(*worst, fabs(two->points.v[a * ld + i] - want));
      *change = fmax(*change, fabs(two->points.v[a * ld + i] - one->points.v[a * ld + i]));
    }
  }
  pw_sim_destroy(&one);
  pw_sim_destroy(&two);
}

static void velocities_are_those_of_the_series(void **state)
{
  (void)state;
  for (int geometry = PW_PLANE; geometry <= PW_AXI; geometry++) {
    double worst = 0.0, change = 0.0;
    compare(geometry, &worst, &change);
    print_message("%s: off by %.1e m/s; the second term is worth %.3f m/s\n",
                  geometry == PW_AXI ? "axisymmetric" : "plane", worst, change);
    assert_true(worst < 1e-14 && change > 1e-3);
  }
}

static double momentum(const pw_sim *sim, int a)
{
  double sum = 0.0;
  for (pw_idx i = 0; i < sim->points.n; i++) {
    sum += sim->points.mass[i] * sim->points.v[a * sim->points.ld + i];
  }
  return sim->measure * sum;
}

static double value_of(const pw_sim *sim, const char *name)
{
  pw_record row = {0};
  pw_sim_history(sim, &row);
  for (int k = 0; k < row.n; k++) {
    if (strcmp(row.item[k].name, name) == 0) {
      return row.item[k].value;
    }
  }
  fail_msg("no column %s", name);
  return 0.0;
}

/* What the points gain along a held side's normal is its reaction, moving or not, by every update. */
static void reactions_are_what_the_points_gain(void **state)
{
  (void)state;
  for (int update = PW_MUSL; update <= PW_USF; update++) {
    for (int terms = 1; terms <= 2; terms++) {
      pw_sim *sim = random_block(PW_PLANE, update, terms);
      const double start[2] = {momentum(sim, 0), momentum(sim, 1)};
      double gained[2] = {0.0, 0.0};
      for (int k = 0; k < 10; k++) {
        assert_ok(pw_sim_step(sim, 0.0));
        gained[0] += sim->dt * value_of(sim, "boundary_1_force_x_n");
        gained[1] += sim->dt * value_of(sim, "boundary_0_force_y_n");
      }
      for (int a = 0; a < 2; a++) {
        print_message("update %d, %d terms: gained %.6f kg m/s, reaction's impulse %.6f\n", update,
                      terms, momentum(sim, a) - start[a], gained[a]);
        assert_near(momentum(sim, a) - start[a], gained[a], 1e-10);
      }
      pw_sim_destroy(&sim);
    }
  }
}

/* Two walls of different velocity meet at a node, and a wall holds nodes of a body whose motion is
 * given: nothing is booked for what the other holds. No force acts in the first step. */
static void walls_that_meet_are_booked_once(void **state)
{
  (void)state;
  for (int update = PW_MUSL; update <= PW_USL; update++) {
    static pw_scene s;
    pw_scene_default(&s);
    test_grid(&s, (double[]){0.0, 2.0, 0.0, 1.5}, 0.125);
    int m = test_elastic(&s, 1e6, 0.3, 1000.0);
    test_rectangle(&s, m, (double[]){0.0, 2.0, 0.0, 0.75}, 0.0625);
    test_rectangle(&s, m, (double[]){0.0, 2.0, 0.75, 1.0}, 0.0625);
    test_add_contact(&s, TEST_PENALTY, 1, 0, 0.3, 1e8, 0.0);
    s.method.update = update;
    s.method.mass_terms = 2;
    pw_prescribed_motion_param *motion = pw_scene_add_effect(&s, "prescribed_motion");
    motion->body = 1;
    motion->velocity_m_s[0] = 0.3;
    for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_RIGHT; side++) {
      pw_boundary_param *b = pw_scene_add_effect(&s, "boundary");
      *b = (pw_boundary_param){.side = side, .fix_x = true, .body = -1};
      b->velocity_x_m_s = side == PW_SIDE_BOTTOM ? 0.5 : 0.0;
    }
    pw_sim *sim = test_sim(&s, 1);
    assert_ok(pw_sim_step(sim, 0.0));
    for (int k = 0; k <= PW_SIDE_RIGHT - PW_SIDE_BOTTOM; k++) {
      char name[64];
      snprintf(name, sizeof name, "boundary_%d_force_x_n", k);
      assert_near(value_of(sim, name), 0.0, 1e-9);
    }
    pw_sim_destroy(&sim);
  }
}

/* A disc that turns and flies through the grid with nothing touching it; spin over that at the
 * start, by its points' moment of momentum about its centre. */
static double spin_left(int update, int terms, double h)
{
  static pw_scene s;
  pw_scene_default(&s);
  test_grid(&s, (double[]){0.0, 12.0, 0.0, 4.0}, h);
  int m = test_neo_hookean(&s, 6e6, 3e6, 1000.0);
  test_disc(&s, m, 2.0, 2.0, 1.6, 0.335 * h);
  s.method.update = update;
  s.method.mass_terms = terms;
  pw_sim *sim = test_sim(&s, 1);
  pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n; i++) {
    p->v[i] = 4.0 - (p->x[p->ld + i] - 2.0);
    p->v[p->ld + i] = p->x[i] - 2.0;
  }
  double start = value_of(sim, "body0_spin_rad_s"), p0 = momentum(sim, 0);
  test_run_to(sim, 2.0);
  double left = value_of(sim, "body0_spin_rad_s") / start;
  assert_relative(momentum(sim, 0), p0, 1e-12);
  pw_sim_destroy(&sim);
  return left;
}

static void a_free_disc_keeps_its_spin(void **state)
{
  (void)state;
  for (int update = PW_MUSL; update <= PW_USL; update++) {
    double lost[2];
    for (int terms = 1; terms <= 2; terms++) {
      lost[terms - 1] = 1.0 - spin_left(update, terms, 0.4);
      print_message("update %d, %d terms: %.4f of the spin lost in 2 s\n", update, terms,
                    lost[terms - 1]);
    }
    assert_true(lost[1] > 0.0 && lost[1] < 0.6 * lost[0]);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(velocities_are_those_of_the_series),
      cmocka_unit_test(reactions_are_what_the_points_gain),
      cmocka_unit_test(walls_that_meet_are_booked_once),
      cmocka_unit_test(a_free_disc_keeps_its_spin),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
