/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Newton's method in the scenes of cases/: r_k the residual over the reactions after k iterations.
 * Forces are smooth functions of the displacements while no point changes between elastic and
 * plastic, so that over an iteration that changes none
 *   - the part s of the correction leaves (1 - s) r_k and a rest of the order of s^2;
 *   - log r_{k+1} / log r_k >= 1.8 from the third residual until 1e-9 or ten times what rounding
 *     leaves, where the loads that scale r are of the size of the forces at the points that still
 *     yield: in the stretched cube, where it holds in every iteration, and in the vane. Under the
 *     footing a few points at its edge carry what is left, r_{k+1} / r_k^2 is 140 at most, and only
 *     the first statement is to be seen above rounding.
 * Every exponent below 1.8 in the vane belongs to an iteration in which points changed. */
#include "engine/implicit_state.h"
#include "io/gmsh_mesh.h"
#include "tests/implicit_helpers.h"

static const double goal = 1e-9;

enum { MOST_POINTS = 20000, MOST_DOFS = 30000 };

/* What the iterates of a load step tell. */
typedef struct {
  pw_implicit *sim;
  int count; /* iterates of this part so far */
  double residual;
  uint8_t plastic[MOST_POINTS];
  double u[MOST_DOFS], before[MOST_DOFS], part[MOST_DOFS];
  /* findings */
  double least, most, ratio[2]; /* on one branch: exponent; r_{k+1} / r_k^2; of rests, 1/4 */
  int exponents, excused, rests;
} watch;

/* Points that are not as they were in the iterate before, elastic or plastic; the plastic strain is
 * the first of their states. */
static int changed(watch *w)
{
  const pw_tet_points *q = &w->sim->model.points;
  int sum = 0;
  for (pw_idx i = 0; i < q->n; i++) {
    const uint8_t now = q->state_trial[i] != q->state[i];
    sum += now != w->plastic[i];
    w->plastic[i] = now;
  }
  return sum;
}

/* What rounding may leave, over the loads. */
static double floor_of(const pw_tet_model *m)
{
  double load = 0.0;
  for (pw_idx i = 0; i < 3 * m->mesh->tets.nnode; i++) {
    load += m->equation[i] < 0 && m->fixed[i] ? m->force[i] * m->force[i] : 0.0;
  }
  return m->rounding / sqrt(load);
}

/* Norm of what the part s of the correction to u leaves beyond 1 - s of the forces before. */
static double rest_of(watch *w, const double *u, double s)
{
  pw_tet_model *m = &w->sim->model;
  const pw_idx n = 3 * m->mesh->tets.nnode;
  double sum = 0.0;
  for (pw_idx i = 0; i < n; i++) {
    w->part[i] = w->u[i] + s * (u[i] - w->u[i]);
  }
  assert_ok(pw_tet_model_evaluate(m, w->part, false));
  for (pw_idx i = 0; i < n; i++) {
    const double rest = m->force[i] - (1.0 - s) * w->before[i];
    sum += m->equation[i] >= 0 ? rest * rest : 0.0;
  }
  return sqrt(sum);
}

static void check_rest(watch *w, const double *u)
{
  const double half = rest_of(w, u, 0.5), ratio = rest_of(w, u, 0.25) / half;
  assert_ok(pw_tet_model_evaluate(&w->sim->model, u, true)); /* as it was */
  assert_near(ratio, 0.25, 0.01);
  w->ratio[0] = fmin(w->ratio[0], ratio);
  w->ratio[1] = fmax(w->ratio[1], ratio);
  w->rests++;
}

static void look(void *ctx, const pw_real *u, pw_real r)
{
  watch *w = ctx;
  const pw_tet_model *m = &w->sim->model;
  const size_t bytes = 3 * (size_t)m->mesh->tets.nnode * sizeof *u;
  const double floor = floor_of(m), was = w->residual;
  w->count = w->sim->report.count == 1 ? 0 : w->count + 1;
  const int moved = changed(w);
  if (w->count >= 2 && was > goal && r > 10.0 * floor) {
    const double exponent = log(r) / log(was);
    w->exponents += moved == 0;
    w->excused += moved > 0 && exponent < 1.8;
    w->least = moved == 0 ? fmin(w->least, exponent) : w->least;
    w->most = moved == 0 ? fmax(w->most, r / (was * was)) : w->most;
  }
  const pw_newton_report *report = &w->sim->report;
  const bool whole =
      report->cuts == 0 && report->approaches == 0; /* no forces are left on purpose */
  if (w->count >= 2 && moved == 0 && r > 1e3 * floor && whole) {
    check_rest(w, u);
  }
  w->residual = r;
  memcpy(w->u, u, bytes);
  memcpy(w->before, m->force, bytes);
}

static watch *run(const char *file, int nset, const char *const *set)
{
  static watch w;
  pw_implicit *sim = test_implicit_case(file, nset, set);
  w = (watch){.sim = sim, .least = INFINITY, .ratio = {INFINITY, 0.0}};
  assert_true(sim->model.points.n <= MOST_POINTS && 3 * sim->mesh.tets.nnode <= MOST_DOFS);
  pw_newton_watch(sim->newton, (pw_newton_watcher){.ctx = &w, .look = look});
  test_implicit_run(sim);
  print_message(
      "%s: %d iterations; on one branch %d exponents, %.2f at least, r_{k+1}/r_k^2 at most "
      "%.1f, %d rests, a quarter leaves %.4f to %.4f of a half; %d exponents below 1.8 where "
      "points changed\n",
      file, (int)sim->iterations, w.exponents, w.least, w.most, w.rests, w.ratio[0], w.ratio[1],
      w.excused);
  pw_implicit_destroy(&sim);
  return &w;
}

static void stretch_in_every_iteration(void **state)
{
  (void)state;
  const watch *w = run("simple_stretch/scene.yaml", 0, NULL);
  assert_true(w->exponents >= 20 && w->least >= 1.8);
  assert_int_equal(w->excused, 0);
  assert_true(w->rests >= 20);
}

/* Half the height and 12 steps, in which yield spreads and the torque reaches its plateau. */
static void vane_while_no_point_changes(void **state)
{
  (void)state;
  const char *const set[] = {"mesh.numbers=l=0.24 far=1.2 height=0.025", "implicit.steps=12",
                             "driven_boundary.angle_deg=0.034377"};
  if (!pw_gmsh_available()) {
    skip();
  }
  const watch *w = run("vane_shear/scene.yaml", 3, set);
  assert_true(w->exponents >= 8 && w->least >= 1.8);
  assert_true(w->rests >= 4);
}

static void footing_leaves_squares(void **state)
{
  (void)state;
  if (!pw_gmsh_available()) {
    skip();
  }
  const char *const set[] = {"implicit.line_search=0"};
  const watch *w = run("footing/scene.yaml", 1, set);
  assert_true(w->rests >= 3);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stretch_in_every_iteration),
      cmocka_unit_test(vane_while_no_point_changes),
      cmocka_unit_test(footing_leaves_squares),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
