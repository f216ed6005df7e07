/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Newton's method in the scenes of cases/: r_k the residual over the reactions and loads after k
 * iterations, from the third residual until 1e-9 or ten times what rounding leaves.
 *
 * Forces are smooth functions of the displacements as long as every point stays elastic or stays
 * plastic. A point of von Mises material without hardening that changes over an iteration ends on the
 * other branch than the one whose tangent was used, and its stress is off the smooth continuation of
 * that branch by a difference known in closed form:
 *
 *   elastic before, plastic now:  -s 2 G c / R,       c the plastic multiplier of the radial return;
 *   plastic before, elastic now:   s (1 - R / |J s|), s the deviator, R the radius of the surface.
 *
 * With j the forces of these differences, over the same loads, what is left is r_{k+1} = j + rest.
 *   - log r_{k+1} / log r_k >= 1.8 in every iteration of the stretched cube and of the column under
 *     its weight, where no point changes; r_{k+1} <= 10 r_k^2 at least in the bonded block (B8).
 *   - log rest / log r_k >= 1.8 in every iteration of the vane and of the thick cylinder, whatever
 *     points change. Where none does that is the exponent of r itself; where it is less than 1.8 for
 *     r, j is the larger part: one point in thousands may change last of all.
 *   - In those, under the footing and in the notched bar the part s of the correction leaves
 *     (1 - s) r_k + j(s) and a rest of the order of s^2, in every iteration from a residual of 1e-2 on.
 *     There rest / r_k^2 is up to some hundred, as few points at an edge carry what is left while all of
 *     the strip scales it, and an exponent of 1.8 needs residuals below rounding. */
#include "engine/implicit_state.h"
#include "engine/tet_patch.h"
#include "io/gmsh_mesh.h"
#include "tests/implicit_helpers.h"

static const double goal = 1e-9;
static const double near =
    1e-2; /* residual from which on an iteration is one of small corrections */

enum { MOST_POINTS = 20000, MOST_DOFS = 50000 };

/* What the iterates of a load step tell. */
typedef struct {
  pw_implicit *sim;
  double shear, radius; /* of the material */
  int count, searches;  /* iterates of this part so far; searches of the step */
  double residual;
  uint8_t plastic[MOST_POINTS];
  double u[MOST_DOFS], before[MOST_DOFS], part[MOST_DOFS], jump[MOST_DOFS];
  /* findings */
  double least[2],
      most[2];     /* exponent and next / r^2: of r itself where no point changes, of rest */
  double ratio[2]; /* of rests, 1/4 */
  double over;     /* largest jump over the yield stress */
  int exponents, changes, below, rests;
} watch;

static double value_of(const pw_tet_material *m, const char *name)
{
  for (const pw_key *k = m->model->keys; k->name; k++) {
    if (strcmp(k->name, name) == 0) {
      return m->param[k->offset / sizeof(pw_real)];
    }
  }
  return 0.0;
}

/* The plastic strain is the first of the states. */
static uint8_t is_plastic(const pw_tet_points *q, pw_idx i)
{
  return q->state_trial[i] != q->state[i];
}

/* Stress of point i beyond the continuation of the branch it was on; over the stress: */
static double beyond(const watch *w, size_t i, double *stress)
{
  const pw_tet_points *q = &w->sim->model.points;
  const size_t l = (size_t)q->ld;
  double norm = 0.0, mean = 0.0;
  for (size_t c = 0; c < 6; c++) {
    stress[c] = q->stress_trial[c * l + i];
    mean += c < 3 ? stress[c] / 3.0 : 0.0;
  }
  for (size_t c = 0; c < 6; c++) {
    stress[c] -= c < 3 ? mean : 0.0;
    norm += (c < 3 ? 1.0 : 2.0) * stress[c] * stress[c];
  }
  const double size = sqrt(norm) * exp(q->state_trial[l + i]); /* of the Kirchhoff stress */
  const double multiplier = sqrt(1.5) * (q->state_trial[i] - q->state[i]);
  const double part =
      multiplier > 0.0 ? -2.0 * w->shear * multiplier / w->radius : 1.0 - w->radius / size;
  for (size_t c = 0; c < 6; c++) {
    stress[c] *= part;
  }
  return fabs(part);
}

/* Forces of the points of element e that have changed; false: none has. */
static bool element_jump(watch *w, pw_idx e, const pw_patch_motion *t, double *force)
{
  const pw_tet_model *m = &w->sim->model;
  const pw_idx s = e % m->mesh->per;
  pw_tet_sums sums;
  bool found = false;
  memset(&sums, 0, sizeof sums);
  for (pw_idx k = m->elem_start[e]; k < m->elem_start[e + 1]; k++) {
    const pw_idx i = m->elem_point[k];
    double stress[6];
    if (is_plastic(&m->points, i) != w->plastic[i]) {
      w->over = fmax(w->over, beyond(w, (size_t)i, stress));
      pw_tet_add_point(m->points.volume[i] * t->motion[s].det, stress, NULL, 1, &sums);
      found = true;
    }
  }
  if (found) {
    pw_tet_force(&sums, t->motion[s].g, force);
  }
  return found;
}

/* w->jump of the u last evaluated; how many elements have points that have changed. */
static int find_jump(watch *w, const double *u)
{
  const pw_tet_model *m = &w->sim->model;
  const size_t nnode = (size_t)m->mesh->tets.nnode;
  int sum = 0;
  memset(w->jump, 0, 3 * nnode * sizeof *w->jump);
  for (pw_idx p = 0; p < m->mesh->npatch; p++) {
    pw_patch_motion t;
    assert_int_equal(pw_patch_move(m, p, u, &t), -1);
    for (pw_idx e = p * m->mesh->per; e < (p + 1) * m->mesh->per; e++) {
      double force[12];
      const bool found = element_jump(w, e, &t, force);
      sum += found;
      for (size_t k = 0; found && k < 12; k++) {
        w->jump[(k % 3) * nnode + (size_t)m->mesh->tets.node[4 * (size_t)e + k / 3]] += force[k];
      }
    }
  }
  return sum;
}

/* Norm of what scales the residual. */
static double load_of(const pw_tet_model *m)
{
  double load = 0.0;
  for (pw_idx i = 0; i < 3 * m->mesh->tets.nnode; i++) {
    const double at = m->equation[i] >= 0 ? m->external[i] : m->fixed[i] ? m->force[i] : 0.0;
    load += at * at;
  }
  return sqrt(load);
}

/* Norm over the loads of what is left at u but for part of the forces before and the jumps. */
static double rest_of(watch *w, const double *u, double part)
{
  const pw_tet_model *m = &w->sim->model;
  double sum = 0.0;
  find_jump(w, u);
  for (pw_idx i = 0; i < 3 * m->mesh->tets.nnode; i++) {
    const double rest = m->force[i] - m->external[i] - part * w->before[i] - w->jump[i];
    sum += m->equation[i] >= 0 ? rest * rest : 0.0;
  }
  return sqrt(sum) / load_of(m);
}

/* The same after the part s of the correction to u. */
static double rest_at(watch *w, const double *u, double s)
{
  pw_tet_model *m = &w->sim->model;
  for (pw_idx i = 0; i < 3 * m->mesh->tets.nnode; i++) {
    w->part[i] = w->u[i] + s * (u[i] - w->u[i]);
  }
  assert_ok(pw_tet_model_evaluate(m, w->part, false));
  return rest_of(w, w->part, 1.0 - s);
}

static void check_order(watch *w, const double *u)
{
  const double half = rest_at(w, u, 0.5), ratio = rest_at(w, u, 0.25) / half;
  assert_ok(pw_tet_model_evaluate(&w->sim->model, u, true)); /* as it was */
  w->ratio[0] = fmin(w->ratio[0], ratio);
  w->ratio[1] = fmax(w->ratio[1], ratio);
  w->rests++;
}

/* The iteration from the residual `was` to r, in which a whole correction has led to u. */
static void check_iteration(watch *w, const double *u, double was, double r)
{
  const double floor = w->sim->model.rounding / load_of(&w->sim->model);
  const double rest = rest_of(w, u, 0.0), exponent = log(r) / log(was);
  const int changed = find_jump(w, u);
  if (was > goal && r > 10.0 * floor) {
    w->exponents++;
    w->changes += changed > 0;
    w->below += exponent < 1.8;
    if (changed == 0) {
      w->least[0] = fmin(w->least[0], exponent);
      w->most[0] = fmax(w->most[0], r / (was * was));
    }
    w->least[1] = fmin(w->least[1], log(rest) / log(was));
    w->most[1] = fmax(w->most[1], rest / (was * was));
  }
  if (was <= near && rest > 1e3 * floor) {
    check_order(w, u);
  }
}

static void look(void *ctx, const pw_real *u, pw_real r)
{
  watch *w = ctx;
  const pw_newton_report *report = &w->sim->report;
  const pw_tet_model *m = &w->sim->model;
  const bool whole =
      report->searches == w->searches && report->cuts == 0 && report->approaches == 0;
  w->searches = report->searches;
  w->count = report->count == 1 ? 0 : w->count + 1;
  if (w->count >= 2 && whole) {
    check_iteration(w, u, w->residual, r);
  }
  for (pw_idx i = 0; i < m->points.n; i++) {
    w->plastic[i] = is_plastic(&m->points, i);
  }
  for (pw_idx i = 0; i < 3 * m->mesh->tets.nnode; i++) {
    w->u[i] = u[i];
    w->before[i] = m->force[i] - m->external[i];
  }
  w->residual = r;
}

/* The first load steps of a scene. */
static watch *run(const char *file, int steps, int nset, const char *const *set)
{
  static watch w;
  pw_implicit *sim = test_implicit_case(file, nset, set);
  const pw_tet_material *m = &sim->material[0];
  w = (watch){.sim = sim, .least = {INFINITY, INFINITY}, .ratio = {INFINITY, 0.0}};
  w.shear = 0.5 * value_of(m, "youngs_modulus_pa") / (1.0 + value_of(m, "poisson_ratio"));
  w.radius = value_of(m, "yield_radius_pa") + sqrt(2.0 / 3.0) * value_of(m, "yield_uniaxial_pa") +
             sqrt(2.0) * value_of(m, "undrained_shear_strength_pa");
  assert_true(sim->model.points.n <= MOST_POINTS && 3 * sim->mesh.tets.nnode <= MOST_DOFS);
  pw_newton_watch(sim->newton, (pw_newton_watcher){.ctx = &w, .look = look});
  for (int k = 0; k < steps; k++) {
    assert_ok(pw_implicit_step(sim));
  }
  print_message(
      "%s: %d iterations, %d looked at, points change in %d, exponent below 1.8 in %d; where none "
      "changes %.2f at least, r_{k+1}/r_k^2 %.3g at most; of rests %.2f, %.3g; jumps up to %.1e of "
      "the yield stress; %d rests, a quarter leaves %.4f to %.4f of a half\n",
      file, (int)sim->iterations, w.exponents, w.changes, w.below, w.least[0], w.most[0],
      w.least[1], w.most[1], w.over, w.rests, w.ratio[0], w.ratio[1]);
  pw_implicit_destroy(&sim);
  return &w;
}

/* The rests at a quarter of the corrections are a quarter of those at a half; of order 1: a half. */
static void check_rests(const watch *w, int count, double tolerance)
{
  assert_true(w->rests >= count);
  assert_near(w->ratio[0], 0.25, tolerance);
  assert_near(w->ratio[1], 0.25, tolerance);
}

static void without_changes_in_every_iteration(void **state)
{
  (void)state;
  const watch *w = run("simple_stretch/scene.yaml", 20, 0, NULL);
  assert_int_equal(w->changes, 0);
  assert_true(w->exponents >= 20 && w->least[0] >= 1.8);
  check_rests(w, 20, 0.003);
  w = run("self_weight_column/scene.yaml", 40, 0, NULL);
  assert_int_equal(w->changes, 0);
  assert_true(w->exponents >= 40 && w->least[0] >= 1.8);
  check_rests(w, 20, 0.003);
  w = run("bonded_block/scene.yaml", 1, 0, NULL);
  assert_true(w->exponents >= 2 && w->most[0] <= 10.0);
}

/* Half the height and 9 steps, in which yield spreads and the torque nearly reaches its plateau. */
static void vane_but_for_points_that_change(void **state)
{
  (void)state;
  const char *const set[] = {"mesh.numbers=l=0.24 far=1.2 height=0.025", "implicit.solver=direct"};
  if (!pw_gmsh_available()) {
    skip();
  }
  const watch *w = run("vane_shear/scene.yaml", 9, 2, set);
  assert_true(w->changes >= 6 && w->exponents - w->changes >= 6);
  assert_true(w->least[0] >= 1.8 && w->least[1] >= 1.8);
  check_rests(w, 6, 0.003);
}

static void cylinder_but_for_points_that_change(void **state)
{
  (void)state;
  if (!pw_gmsh_available()) {
    skip();
  }
  const watch *w = run("thick_cylinder/scene.yaml", 20, 0, NULL);
  assert_true(w->changes >= 4 && w->exponents - w->changes >= 8);
  assert_true(w->least[0] >= 1.8 && w->least[1] >= 1.8);
  check_rests(w, 6, 0.003);
}

static void limit_loads_leave_squares(void **state)
{
  (void)state;
  if (!pw_gmsh_available()) {
    skip();
  }
  const watch *w = run("footing/scene.yaml", 6, 0, NULL);
  assert_true(w->changes >= 8);
  check_rests(w, 8, 0.03);
  w = run("double_notch/scene.yaml", 4, 0, NULL);
  assert_true(w->changes >= 8);
  check_rests(w, 5, 0.03);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(without_changes_in_every_iteration),
      cmocka_unit_test(vane_but_for_points_that_change),
      cmocka_unit_test(cylinder_but_for_points_that_change),
      cmocka_unit_test(limit_loads_leave_squares),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
