/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A soft block that slumps under its own weight on a rough base, its sides crossing cells, in
 * implicit steps: Newton's method converges quadratically, results have the same bits on any number
 * of threads and after a restart, and the equations balance in total. */
#include "engine/effects/solid_params.h"
#include "io/restart.h"
#include "tests/output_helpers.h"
#include "tests/quad_helpers.h"

enum { STEPS = 6 };

static pw_boundary_param *hold(pw_scene *s, const pw_real box[4])
{
  pw_boundary_param *b = pw_scene_add_effect(s, "boundary");
  b->side = PW_SIDE_BOX;
  memcpy(b->x_m, box, sizeof b->x_m);
  memcpy(b->y_m, box + 2, sizeof b->y_m);
  b->fix_x = true;
  return b;
}

static void make_scene(pw_scene *s, int geometry, int basis)
{
  const pw_real left =
      geometry == PW_AXI ? 0.0 : -0.25; /* uGIMP domains need room for themselves */
  test_quad_scene(s, geometry, basis, (pw_real[]){left, 2.0, -0.25, 1.5}, 0.125, STEPS);
  s->method.block_elements = 12;
  const int m = test_neo_hookean(s, 3e4, 1e4, 1000.0);
  test_rectangle(s, m, (pw_real[]){0.0, 1.0, 0.0, 1.0}, 0.0625);
  test_gravity(s, 1.0);
  hold(s, (pw_real[]){left, 2.0, -0.25, 0.0})->fix_y = true;
  if (geometry == PW_PLANE) {
    hold(s, (pw_real[]){left, 0.0, -0.25, 1.5});
  }
  pw_ghost_param *ghost = pw_scene_add_effect(s, "ghost_stabilisation");
  ghost->stiffness_pa = 1e3;
}

static void steps(pw_sim *sim, int n)
{
  for (int k = 0; k < n; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
}

static double reaction(const pw_sim *sim)
{
  pw_record row;
  pw_sim_history(sim, &row);
  for (int i = 0; i < row.n; i++) {
    if (strcmp(row.item[i].name, "boundary_0_force_y_n") == 0) {
      return row.item[i].value;
    }
  }
  return 0.0;
}

/* From the third residual on, each is the one before to the power 1.8 at least. */
static void check_quadratic(const pw_newton_report *r)
{
  for (int k = 0; k < r->count; k++) {
    print_message(" %.2e", r->residual[k]);
  }
  print_message("\n");
  for (int k = 2; k + 1 < r->count && r->residual[k] > 1e-9; k++) {
    const double rate = log(fmax(r->residual[k + 1], 1e-11) / r->residual[k]) /
                        log(r->residual[k] / r->residual[k - 1]);
    assert_true(rate >= 1.8 || r->residual[k + 1] <= 1e-9);
  }
}

static void newton_is_quadratic(void **state)
{
  (void)state;
  static pw_scene s;
  for (int geometry = PW_PLANE; geometry <= PW_AXI; geometry++) {
    for (int basis = PW_UGIMP; basis <= PW_CPDI; basis++) {
      make_scene(&s, geometry, basis);
      s.solid.implicit.steps = 2;
      s.solid.implicit.from_previous = false;
      pw_sim *sim = test_sim(&s, 1);
      for (int k = 0; k < 2; k++) {
        steps(sim, 1);
        assert_int_equal(sim->quad->report.cuts, 0);
        assert_true(sim->quad->report.count >= 4);
        check_quadratic(&sim->quad->report);
      }
      const double area = geometry == PW_AXI ? 3.14159265358979 : 1.0;
      assert_relative(reaction(sim), 9.81 * 1000.0 * area, 1e-9); /* the weight */
      const pw_points *p = &sim->points;
      double right = 0.0, top = 0.0;
      for (pw_idx i = 0; i < p->n; i++) {
        right = fmax(right, p->x[i]);
        top = fmax(top, p->x[p->ld + i]);
      }
      print_message("%s: width %.3f, height %.3f m\n", sim->kernels->name, right, top);
      assert_true(right > 1.0 && top < 0.9); /* sides have crossed into the next cell */
      pw_sim_destroy(&sim);
    }
  }
}

static void expect_same(const char *a, const char *b)
{
  test_bytes one = test_read(a), two = test_read(b);
  assert_int_equal(one.size, two.size);
  assert_memory_equal(one.data, two.data, one.size);
  free(one.data);
  free(two.data);
}

/* One run on two threads; half of it on one, and the rest from a checkpoint. */
static void check_bits(const pw_scene *s)
{
  const char *folder = test_folder(), *half = test_path(folder, "half.h5");
  const char *through = test_path(folder, "through.h5"), *resumed = test_path(folder, "resumed.h5");
  pw_sim *sim = test_sim(s, 2);
  steps(sim, STEPS);
  assert_ok(pw_restart_write(through, sim));
  pw_sim_destroy(&sim);
  sim = test_sim(s, 1);
  steps(sim, STEPS / 2);
  assert_ok(pw_restart_write(half, sim));
  pw_sim_destroy(&sim);
  sim = test_sim(s, 1);
  steps(sim, 1); /* nothing of what was there before may stay */
  assert_ok(pw_restart_read(half, sim));
  steps(sim, STEPS - STEPS / 2);
  assert_ok(pw_restart_write(resumed, sim));
  pw_sim_destroy(&sim);
  expect_same(through, resumed);
  test_remove_folder(folder);
}

static void threads_and_restarts_keep_every_bit(void **state)
{
  (void)state;
  static pw_scene s;
  for (int basis = PW_LINEAR; basis <= PW_CPDI; basis++) {
    make_scene(&s, basis == PW_UGIMP ? PW_PLANE : PW_AXI, basis);
    s.solid.implicit.adaptive = basis == PW_CPDI;
    s.solid.implicit.step_least = 0.1;
    s.solid.implicit.step_most = 1.0;
    s.solid.implicit.easy_iterations = 2;
    s.solid.implicit.hard_iterations = 4;
    check_bits(&s);
  }
}

/* Patterns change from step to step: every solver must take that. */
static void solvers_agree(void **state)
{
  (void)state;
  static const pw_solver_engine engine[] = {PW_SOLVER_DIRECT, PW_SOLVER_KRYLOV,
                                            PW_SOLVER_PETSC_GAMG, PW_SOLVER_PETSC_ILU};
  static pw_scene s;
  double height[4] = {0.0};
  for (int k = 0; k < (pw_solver_has_petsc() ? 4 : 2); k++) {
    make_scene(&s, PW_PLANE, PW_CPDI);
    s.solid.implicit.solver = (int)engine[k];
    pw_sim *sim = test_sim(&s, 1);
    steps(sim, STEPS);
    assert_true(sim->quad->model.csr.revision > 2);
    for (pw_idx i = 0; i < sim->points.n; i++) {
      height[k] += sim->points.x[sim->points.ld + i] / sim->points.n;
    }
    print_message("%s: mean height %.12f m\n", pw_solver_name(engine[k]), height[k]);
    assert_relative(height[k], height[0], 1e-9);
    pw_sim_destroy(&sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(newton_is_quadratic),
      cmocka_unit_test(threads_and_restarts_keep_every_bit),
      cmocka_unit_test(solvers_agree),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
