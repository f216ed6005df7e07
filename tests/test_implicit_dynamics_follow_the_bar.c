/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Newmark's method. A bar of length L, held at x = 0 and free at the other end, swings at
 * omega = pi c/(2 L), c = sqrt(E/rho), when it starts with the velocity sin(pi x/(2 L)) (nu = 0 and
 * rollers on its sides). With the mean acceleration a frequency omega becomes (2/dt) atan(omega dt/2)
 * and the energy is kept; lumped masses of elements of length h lower it by (omega h/c)^2/24,
 * consistent ones raise it by as much. Bodies in free fall and damped ones have exact solutions too. */
#include "engine/step_newton.h"
#include "engine/tet_loads.h"
#include "kernels/tensor.h"
#include "tests/tet_helpers.h"

enum { BRICKS = 16 };

static const double young = 1e3, density = 1.0, size = 1e-6; /* strain */

typedef struct {
  pw_tet_mesh mesh;
  pw_tet_material material;
  pw_tet_model model;
  pw_newton *newton;
  pw_newton_report report;
  double gravity, omega;
} body;

static void apply(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const body *b = ctx;
  const pw_real g[3] = {0.0, -b->gravity, 0.0};
  (void)t0, (void)t1;
  memset(m->external, 0, 3 * (size_t)m->mesh->tets.nnode * sizeof *m->external);
  pw_tet_model_gravity(m, g);
}

static void start_limited(const pw_newmark *method, pw_tet_rule rule, double volume_limit, body *b)
{
  const double side = 1.0 / BRICKS;
  pw_tet_box box = {.bricks = {BRICKS, 1, 1}, .high = {1, side, side}, .per_brick = 6, .nodes = 4};
  memset(b, 0, sizeof *b);
  b->mesh = test_box_mesh(&box);
  b->material = test_von_mises(young, 0.0, "yield_radius_pa", 1e9, 0.0);
  b->model = test_model(&b->mesh, &b->material, rule, PW_FBAR_NONE);
  const pw_idx n = b->mesh.tets.nnode;
  for (pw_idx i = 0; i < 3 * n; i++) {
    b->model.fixed[i] = i >= n || b->mesh.tets.x[i] == 0.0;
  }
  pw_newton_options options = pw_newton_defaults();
  options.newmark = *method;
  options.volume_limit = volume_limit;
  assert_ok(pw_newton_create(&b->model, &options, &b->newton));
  b->omega = 0.5 * acos(-1.0) * sqrt(young / density);
  pw_tet_rates *r = pw_newton_rates(b->newton);
  for (pw_idx a = 0; a < n; a++) {
    r->v[a] = size * sqrt(young / density) * sin(0.5 * acos(-1.0) * b->mesh.x[a]);
  }
  r->given = method->keep;
  for (pw_idx i = 0; i < b->model.points.n; i++) {
    double x = b->model.points.x[i];
    b->model.points.velocity[i] = size * sqrt(young / density) * sin(0.5 * acos(-1.0) * x);
  }
}

static void start(const pw_newmark *method, pw_tet_rule rule, body *b)
{
  start_limited(method, rule, 10.0, b);
}

static void end(body *b)
{
  pw_newton_destroy(&b->newton);
  pw_tet_model_destroy(&b->model);
  pw_tet_mesh_destroy(&b->mesh);
}

static void step(body *b, double dt)
{
  pw_newton_load load = {.ctx = b, .step_s = dt, .apply = apply};
  assert_ok(pw_newton_step(b->newton, &load, &b->report));
  assert_int_equal(b->report.cuts, 0);
}

/* Strain energy of the points: tau:tau/(2 E) by volume at the start, as nu = 0. */
static double strain_energy(const body *b)
{
  const pw_tet_points *q = &b->model.points;
  double sum = 0.0;
  for (pw_idx i = 0; i < q->n; i++) {
    pw_t6 tau = pw_t6_scale(q->jac[i], pw_t6_load(q->stress + i, (size_t)q->ld));
    sum += 0.5 * q->volume[i] / q->jac[i] * pw_t6_dot(tau, tau) / young;
  }
  return sum;
}

static double nodal_energy(const body *b, const pw_real *v)
{
  double sum = 0.0;
  for (pw_idx a = 0; a < b->mesh.tets.nnode; a++) {
    sum += 0.5 * b->model.mass[a] * v[a] * v[a];
  }
  return sum;
}

/* Angle of the swing in the first mode: from the points' displacements and the nodes' velocities. */
static double phase(body *b, const double *x0)
{
  const pw_tet_points *q = &b->model.points;
  const pw_tet_rates *r = pw_newton_rates(b->newton);
  double at = 0.0, speed = 0.0, one = 0.0, other = 0.0;
  for (pw_idx i = 0; i < q->n; i++) {
    double mode = sin(0.5 * acos(-1.0) * x0[i]);
    at += q->mass[i] * mode * (q->x[i] - x0[i]);
    one += q->mass[i] * mode * mode;
  }
  for (pw_idx a = 0; a < b->mesh.tets.nnode; a++) {
    double mode = sin(0.5 * acos(-1.0) * b->mesh.x[a]);
    speed += b->model.mass[a] * mode * r->v[a];
    other += b->model.mass[a] * mode * mode;
  }
  return atan2(b->omega * at / one, speed / other);
}

/* Frequency over `periods` of `steps` steps each. */
static double frequency(const pw_newmark *method, int steps, int periods)
{
  static double x0[16 * BRICKS * 6];
  const double pi = acos(-1.0);
  body b;
  start(method, PW_TET_RULE_FOUR, &b);
  memcpy(x0, b.model.points.x, (size_t)b.model.points.n * sizeof *x0);
  const double dt = 2.0 * pi / b.omega / steps;
  for (int k = 0; k < steps * periods; k++) {
    step(&b, dt);
  }
  double out = (2.0 * pi * periods + phase(&b, x0)) / (dt * steps * periods);
  out /= b.omega;
  end(&b);
  return out;
}

static void frequencies_are_those_of_theory(void **state)
{
  (void)state;
  const double pi = acos(-1.0), shift = pow(0.5 * pi / BRICKS, 2) / 24.0;
  pw_newmark method = pw_newmark_defaults();
  method.keep = true;
  for (int consistent = 0; consistent < 2; consistent++) {
    method.consistent = consistent;
    double ratio[3];
    for (int k = 0; k < 3; k++) {
      const int steps = 20 << k;
      double a = pi / steps; /* omega dt/2 */
      ratio[k] = frequency(&method, steps, 2);
      print_message(
          "%s masses, %d steps in a period: frequency %.6f of the exact one, %.6f by theory\n",
          consistent ? "consistent" : "lumped", steps, ratio[k],
          atan(a) / a * (1.0 + (consistent ? shift : -shift)));
      assert_near(ratio[k], atan(a) / a * (1.0 + (consistent ? shift : -shift)), 5e-5);
    }
    double rate = log2((ratio[1] - ratio[0]) / (ratio[2] - ratio[1]));
    print_message("order in dt: %.3f\n", rate);
    assert_near(rate, 2.0, 0.03);
    assert_near(ratio[2], 1.0, 1e-3);
  }
}

/* Ten periods of 40 steps. Nodes that keep their rates keep the energy; mapping it to the points and
 * back loses some in every step: the smooth part of the swing little, the rest at once. */
static void energy_is_kept(void **state)
{
  (void)state;
  pw_newmark method = pw_newmark_defaults();
  for (int keep = 1; keep >= 0; keep--) {
    for (int rule = PW_TET_RULE_ONE; rule <= PW_TET_RULE_FOUR; rule++) {
      body b;
      method.keep = keep;
      start(&method, (pw_tet_rule)rule, &b);
      const double dt = 2.0 * acos(-1.0) / b.omega / 40.0;
      const pw_tet_rates *r = pw_newton_rates(b.newton);
      double first = 0.0, low = INFINITY, high = 0.0, last = 0.0;
      for (int k = 0; k < 400; k++) {
        step(&b, dt);
        first = k == 0 ? nodal_energy(&b, r->v0) : first;
        last = strain_energy(&b) +
               (keep ? nodal_energy(&b, r->v) : pw_tet_points_kinetic(&b.model.points));
        low = fmin(low, last);
        high = fmax(high, last);
      }
      print_message(
          "%s, rule %d: energy between %.8f and %.8f of that at the start, at the end %.5f\n",
          keep ? "kept" : "mapped", rule, low / first, high / first, last / first);
      if (keep) {
        assert_true(low > (1.0 - 2e-6) * first && high < (1.0 + 2e-6) * first);
      } else {
        assert_true(last < first);
      }
      end(&b);
    }
  }
}

/* exp(-alpha t/2) */
static void damping_is_exponential(void **state)
{
  (void)state;
  body b;
  pw_newmark method = pw_newmark_defaults();
  method.keep = true;
  start(&method, PW_TET_RULE_FOUR, &b);
  method.damping = 0.04 * b.omega;
  end(&b);
  start(&method, PW_TET_RULE_FOUR, &b);
  const double period = 2.0 * acos(-1.0) / b.omega, dt = period / 80.0;
  const pw_tet_rates *r = pw_newton_rates(b.newton);
  double first = 0.0;
  for (int k = 0; k < 240; k++) {
    step(&b, dt);
    first = k == 0 ? nodal_energy(&b, r->v0) : first;
  }
  double left = (strain_energy(&b) + nodal_energy(&b, r->v)) / first;
  assert_near(log(left) / (3.0 * period), -method.damping, 0.02 * method.damping);
  end(&b);
}

/* Steps cut in halves, here because volumes may change by no more than most of what a whole step
 * does, are two steps of half the size: what a failed part has tried is forgotten. */
static void cut_steps_are_two_halves(void **state)
{
  (void)state;
  pw_newmark method = pw_newmark_defaults();
  for (int keep = 0; keep < 2; keep++) {
    body cut, half;
    method.keep = keep;
    start(&method, PW_TET_RULE_FOUR, &half);
    const double dt = 2.0 * acos(-1.0) / half.omega / 40.0;
    start_limited(&method, PW_TET_RULE_FOUR, 1.0 + 0.7 * size * half.omega * dt, &cut);
    for (int k = 0; k < 3; k++) {
      pw_newton_load load = {.ctx = &cut, .step_s = dt, .apply = apply};
      assert_ok(pw_newton_step(cut.newton, &load, &cut.report));
      assert_int_equal(cut.report.parts, 2);
      step(&half, 0.5 * dt);
      step(&half, 0.5 * dt);
      for (pw_idx i = 0; i < cut.model.points.n; i++) {
        assert_near(cut.model.points.velocity[i], half.model.points.velocity[i], 1e-14);
        assert_near(cut.model.points.x[i], half.model.points.x[i], 1e-14);
      }
    }
    end(&cut);
    end(&half);
  }
}

/* Points in free fall through the mesh: g t and g t^2/2 to rounding, whatever the mapping. */
static void free_fall_is_exact(void **state)
{
  (void)state;
  pw_tet_box box = {.bricks = {2, 6, 2}, .high = {1, 3, 1}, .per_brick = 6, .nodes = 10};
  pw_tet_mesh mesh = test_box_mesh(&box);
  pw_tet_material m = test_von_mises(young, 0.3, "yield_radius_pa", 1e9, 0.0);
  pw_idx filled[6 * 24];
  for (pw_idx p = 0; p < 6 * 24; p++) { /* two upper layers of bricks */
    filled[p] = p / 12 % 6 >= 4 ? 0 : -1;
  }
  pw_tet_fill fill = {.rule = PW_TET_RULE_FOUR, .body = filled, .nmaterial = 1, .material = &m};
  pw_tet_setup setup = {.mesh = &mesh, .fill = &fill, .fbar = PW_FBAR_INCREMENT, .threads = 1};
  body b = {.gravity = 10.0};
  pw_newton_options options = pw_newton_defaults();
  options.newmark = pw_newmark_defaults();
  assert_ok(pw_tet_model_create(&setup, &b.model));
  assert_ok(pw_newton_create(&b.model, &options, &b.newton));
  const pw_tet_points *q = &b.model.points;
  const double first = q->x[q->ld], dt = 0.04;
  for (int k = 1; k <= 12; k++) {
    step(&b, dt);
    for (pw_idx i = 0; i < q->n; i++) {
      assert_near(q->velocity[q->ld + i], -10.0 * k * dt, 1e-9);
      assert_near(q->velocity[i], 0.0, 1e-9);
      assert_near(q->stress[i], 0.0, 1e-6);
    }
  }
  assert_near(q->x[q->ld] - first, -5.0 * 0.48 * 0.48, 1e-9);
  pw_newton_destroy(&b.newton);
  pw_tet_model_destroy(&b.model);
  pw_tet_mesh_destroy(&mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frequencies_are_those_of_theory),
      cmocka_unit_test(energy_is_kept),
      cmocka_unit_test(damping_is_exponential),
      cmocka_unit_test(cut_steps_are_two_halves),
      cmocka_unit_test(free_fall_is_exact),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
