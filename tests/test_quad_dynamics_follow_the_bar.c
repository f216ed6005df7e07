/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implicit dynamics on the grid: free fall, which Newmark's method has exactly; an elastic bar, fixed
 * at x = 0 and free at x = L, in its first mode, v = v0 cos(omega t) sin(beta x), beta = pi/(2L),
 * omega = beta c; the tangent with inertia.
 *
 * What the method must give: linear elements with lumped mass have omega_h^2 / omega^2 =
 * (sin(beta h/2) / (beta h/2))^2; going from nodes to points and back multiplies changes of velocity
 * and accelerations by R = 1 - (3/8) (1 - cos beta h) (tests/test_bar_vibrates_at_exact_frequency.c).
 * One mode of amplitude D at the nodes then follows, in a step with u = dt v + dt2/4 (a + a'),
 *   a' = -omega_h^2 (D + u),  D <- D + u,  v <- v + R dt/2 (a + a'),  a <- R a'. */
#include "engine/effects/solid_params.h"
#include "tests/quad_helpers.h"

static const double pi = 3.141592653589793;

static void add_dynamics(pw_scene *s)
{
  assert_non_null(pw_scene_add_effect(s, "dynamics"));
}

static void free_fall_is_exact(void **state)
{
  (void)state;
  static pw_scene s;
  static double start[2][256];
  for (int basis = PW_LINEAR; basis <= PW_CPDI; basis++) {
    test_quad_scene(&s, PW_PLANE, basis, (pw_real[]){0.0, 3.0, 0.0, 3.0}, 0.25, 7);
    s.time.end_s = 0.5;
    const int m = test_neo_hookean(&s, 2e5, 1e5, 1000.0);
    test_rectangle(&s, m, (pw_real[]){0.55, 1.55, 1.8, 2.8}, 0.125);
    s.body[0].velocity_m_s[0] = 2.0;
    test_gravity(&s, 0.0)->acceleration_m_s2 = 10.0;
    add_dynamics(&s);
    pw_sim *sim = test_sim(&s, 1);
    const pw_points *p = &sim->points;
    for (pw_idx i = 0; i < p->n; i++) {
      start[0][p->id[i]] = p->x[i];
      start[1][p->id[i]] = p->x[p->ld + i];
    }
    test_quad_run(sim);
    for (pw_idx i = 0; i < p->n; i++) {
      assert_near(p->x[i] - start[0][p->id[i]], 1.0, 1e-9);
      assert_near(p->x[p->ld + i] - start[1][p->id[i]], -1.25, 1e-9);
      assert_near(p->v[i], 2.0, 1e-9);
      assert_near(p->v[p->ld + i], -5.0, 1e-9);
      assert_near(p->acceleration[p->ld + i], -10.0, 1e-7);
      assert_near(p->stress[i], 0.0, 1e-3);
    }
    /* the energy of the fall is the work of the weight: 1000 kg, 1.25 m */
    assert_relative(sim->energy.kinetic, 0.5 * 1000.0 * (4.0 + 25.0), 1e-9);
    assert_relative(sim->energy.external, 1000.0 * 10.0 * 1.25, 1e-9);
    pw_sim_destroy(&sim);
  }
}

static pw_sim *bar_sim(int n, int basis, int steps_per_period, double periods)
{
  static pw_scene s;
  const double h = 1.0 / n;
  test_quad_scene(&s, PW_PLANE, basis, (double[]){0.0, 1.0 + 2.0 * h, 0.0, 2.0 * h}, h,
                  (int)(steps_per_period * periods));
  s.time.end_s = 4.0 * periods;
  const int m = test_elastic(&s, 1.0, 0.0, 1.0);
  test_rectangle(&s, m, (double[]){0.0, 1.0, 0.0, 2.0 * h}, 0.5 * h);
  test_roller(&s, PW_SIDE_LEFT);
  pw_boundary_param *all = pw_scene_add_effect(&s, "boundary");
  all->side = PW_SIDE_BOX;
  all->x_m[0] = all->y_m[0] = -1.0;
  all->x_m[1] = all->y_m[1] = 3.0;
  all->fix_y = true;
  add_dynamics(&s);
  pw_sim *sim = test_sim(&s, 1);
  for (pw_idx i = 0; i < sim->points.n; i++) {
    sim->points.v[i] = 1e-4 * sin(0.5 * pi * sim->points.x[i]);
  }
  return sim;
}

static double modal_velocity(const pw_sim *sim)
{
  double sum = 0.0;
  for (pw_idx i = 0; i < sim->points.n; i++) {
    sum += sim->points.mass[i] * sim->points.v[i] * sin(0.5 * pi * sim->points.x[i]);
  }
  return sum;
}

/* Frequency over the exact one, from the zero crossings of the modal velocity; energy at the end
 * over that of the start. */
static double frequency_ratio(pw_sim *sim, double *kept)
{
  double old = modal_velocity(sim), old_t = 0.0, first = 0.0, last = 0.0;
  int crossings = 0;
  while (sim->time < sim->scene.time.end_s) {
    assert_ok(pw_sim_step(sim, 0.0));
    const double now = modal_velocity(sim);
    if ((old > 0.0) != (now > 0.0)) {
      last = old_t + (sim->time - old_t) * old / (old - now);
      first = crossings++ == 0 ? last : first;
    }
    old = now;
    old_t = sim->time;
  }
  const pw_points *p = &sim->points;
  double sum = 0.0, start = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    const double v0 = 1e-4 * sin(0.5 * pi * p->x[i]);
    sum += 0.5 * p->mass[i] * p->v[i] * p->v[i] + 0.5 * p->vol[i] * p->stress[i] * p->stress[i];
    start += 0.5 * p->mass[i] * v0 * v0;
  }
  *kept = sum / start;
  pw_sim_destroy(&sim);
  return 2.0 * (crossings - 1) / (last - first);
}

/* The same of the one mode. */
static double expected_ratio(int n, int steps_per_period, double periods)
{
  const double bh = 0.5 * pi / n, r = 1.0 - 0.375 * (1.0 - cos(bh)), dt = 4.0 / steps_per_period;
  const double w2 = 0.25 * pi * pi * 2.0 * (1.0 - cos(bh)) / (bh * bh);
  double moved = 0.0, v = 1.0, a = 0.0, t = 0.0, first = 0.0, last = 0.0;
  int crossings = 0;
  for (int k = 0; k < (int)(steps_per_period * periods); k++) {
    const double still = moved + dt * v + 0.25 * dt * dt * a;
    const double next = -w2 * still / (1.0 + 0.25 * dt * dt * w2);
    const double now = v + 0.5 * r * dt * (a + next);
    moved = still + 0.25 * dt * dt * next;
    if ((v > 0.0) != (now > 0.0)) {
      last = t + dt * v / (v - now);
      first = crossings++ == 0 ? last : first;
    }
    v = now;
    a = r * next;
    t += dt;
  }
  return 2.0 * (crossings - 1) / (last - first);
}

static void bar_vibrates_at_its_frequency(void **state)
{
  (void)state;
  static const int cells[] = {10, 20}, steps[] = {40, 80};
  for (int basis = PW_LINEAR; basis <= PW_CPDI; basis++) {
    double error[2], kept[2];
    for (int k = 0; k < 2; k++) {
      error[k] = 1.0 - frequency_ratio(bar_sim(cells[k], basis, steps[k], 5.0), &kept[k]);
      const double expected = 1.0 - expected_ratio(cells[k], steps[k], 5.0);
      print_message("%s, %d cells, %d steps in a period: frequency low by %.3e, expected %.3e; "
                    "energy after 5 periods %.4f\n",
                    test_basis_name[basis], cells[k], steps[k], error[k], expected, kept[k]);
      assert_relative(error[k], expected, 0.05);
      assert_true(kept[k] < 1.0 && kept[k] > 0.975);
    }
    assert_true(log2(error[0] / error[1]) >= 1.9);
    assert_true(kept[1] >
                0.997); /* what the way to the points and back takes: of the third order */
  }
}

/* K d against central differences of force and inertia. */
static void tangent_has_the_mass(void **state)
{
  (void)state;
  static pw_scene s;
  static double u[2][128], d[128], up[128], x[128], product[128];
  uint64_t seed = 5;
  double error = 0.0, size = 0.0;
  test_quad_scene(&s, PW_AXI, PW_CPDI, (pw_real[]){0.0, 3.0, 0.0, 3.0}, 0.5, 1);
  test_rectangle(&s, test_neo_hookean(&s, 2e3, 5e2, 1000.0), (pw_real[]){0.5, 2.1, 0.6, 2.2}, 0.2);
  pw_dynamics_param *p = pw_scene_add_effect(&s, "dynamics");
  p->damping_per_s = 3.0;
  pw_sim *sim = test_sim(&s, 1);
  pw_quad_model *m = &sim->quad->model;
  const pw_idx dofs = 2 * m->csr.nnode;
  m->dt = 0.1;
  assert_true(dofs <= 128);
  assert_ok(pw_quad_model_begin(m));
  for (pw_idx i = 0; i < dofs; i++) {
    const bool free = m->equation[i] >= 0;
    u[0][i] = free ? 0.05 * test_random(&seed) : 0.0;
    d[i] = free ? test_random(&seed) - 0.5 : 0.0;
  }
  for (int side = 1; side >= -1; side -= 2) {
    for (pw_idx i = 0; i < dofs; i++) {
      u[1][i] = u[0][i] + side * 1e-6 * d[i];
    }
    assert_ok(pw_quad_model_evaluate(m, u[1], false));
    for (pw_idx i = 0; i < dofs; i++) {
      const double now = m->force[i] + m->inertia.force[i];
      up[i] = side > 0 ? now : (up[i] - now) / 2e-6;
    }
  }
  assert_ok(pw_quad_model_evaluate(m, u[0], true));
  for (pw_idx i = 0; i < dofs; i++) {
    if (m->equation[i] >= 0) {
      x[m->equation[i]] = d[i];
    }
  }
  pw_csr_multiply(&m->csr, x, product);
  for (pw_idx i = 0; i < dofs; i++) {
    const pw_idx eq = m->equation[i];
    error += eq >= 0 ? pow(product[eq] - up[i], 2) : 0.0;
    size += eq >= 0 ? up[i] * up[i] : 0.0;
  }
  print_message("tangent with mass: %.2g\n", sqrt(error / size));
  assert_true(sqrt(error / size) <= 1e-8);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(free_fall_is_exact),
      cmocka_unit_test(bar_vibrates_at_its_frequency),
      cmocka_unit_test(tangent_has_the_mass),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
