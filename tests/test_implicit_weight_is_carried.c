/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Weight, initial stress and steps of adaptive size on columns between rollers. Self-weight
 * compaction of a Hencky column with nu = 0: sigma = -rho0 g (H - Y) whatever the material, stretch
 * lambda = exp(-W0(rho0 g (H - Y)/E)); for H = 0.8 m, rho0 = 50, E = 1e3, g = 9.81 the base carries
 * -392.40 Pa, is stretched by 0.746173, and the column ends 0.684329 m high (Lambert's W evaluated
 * independently). */
#include "engine/step_newton.h"
#include "engine/tet_loads.h"
#include "tests/tet_helpers.h"

typedef struct {
  pw_tet_mesh mesh;
  pw_tet_material material;
  pw_tet_model model;
  pw_newton *newton;
  pw_newton_report report;
  double gravity;
} column;

static void start(pw_idx bricks, double height, double poisson, double density, column *b)
{
  pw_tet_box box = {
      .bricks = {1, bricks, 1}, .high = {0.1, height, 0.1}, .per_brick = 6, .nodes = 10};
  memset(b, 0, sizeof *b);
  b->mesh = test_box_mesh(&box);
  b->material = test_von_mises(1e3, poisson, "yield_radius_pa", 1e9, 0.0);
  test_material names = test_material_of("hencky_von_mises");
  memcpy(names.v, b->material.param, sizeof b->material.param);
  test_set(&names, "density_kg_m3", density);
  memcpy(b->material.param, names.v, sizeof b->material.param);
  b->model = test_model(&b->mesh, &b->material, PW_TET_RULE_FOUR, PW_FBAR_NONE);
  const pw_idx n = b->mesh.tets.nnode;
  for (pw_idx i = 0; i < 3 * n; i++) {
    b->model.fixed[i] = i / n != 1 || b->mesh.tets.x[i] == 0.0;
  }
  pw_newton_options options = pw_newton_defaults();
  options.mechanisms = PW_MECHANISMS_ERROR;
  assert_ok(pw_newton_create(&b->model, &options, &b->newton));
}

static void end(column *b)
{
  pw_newton_destroy(&b->newton);
  pw_tet_model_destroy(&b->model);
  pw_tet_mesh_destroy(&b->mesh);
}

static double base_force(const column *b)
{
  double sum = 0.0;
  for (pw_idx a = 0; a < b->mesh.tets.nnode; a++) {
    const pw_idx i = b->mesh.tets.nnode + a;
    sum += b->mesh.tets.x[i] == 0.0 ? b->model.force[i] - b->model.external[i] : 0.0;
  }
  return sum;
}

static void weigh(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const column *b = ctx;
  const pw_real g[3] = {0.0, -b->gravity * t1, 0.0};
  (void)t0;
  memset(m->external, 0, 3 * (size_t)m->mesh->tets.nnode * sizeof *m->external);
  pw_tet_model_gravity(m, g);
}

static void columns_settle_under_their_weight(void **state)
{
  (void)state;
  double error[2];
  for (int k = 0; k < 2; k++) {
    column b;
    start(4 << k, 0.8, 0.0, 50.0, &b);
    const double height = 0.8;
    b.gravity = 9.81;
    pw_newton_load load = {.ctx = &b, .apply = weigh};
    assert_ok(pw_newton_step(b.newton, &load, &b.report));
    assert_relative(base_force(&b), 50.0 * 9.81 * height * 0.01, 1e-8);
    const pw_real *u = pw_newton_displacement(b.newton) + b.mesh.tets.nnode;
    double top = 0.0, sum = 0.0, mass = 0.0;
    for (pw_idx a = 0; a < b.mesh.tets.nnode; a++) {
      top += b.mesh.tets.x[b.mesh.tets.nnode + a] == height ? (height + u[a]) / 9.0 : 0.0;
      mass += b.model.mass[a];
    }
    assert_relative(mass, 50.0 * height * 0.01, 1e-13);
    const pw_tet_points *q = &b.model.points;
    for (pw_idx i = 0; i < q->n; i++) { /* mean over the mass of sigma = rho0 g H / 2 */
      sum += q->mass[i] / mass * q->stress[q->ld + i];
    }
    error[k] = fabs(top - 0.684329);
    print_message("%d bricks: height %.6f m, mean stress %.3f Pa, %d iterations\n", 4 << k, top,
                  sum, b.report.iterations);
    assert_relative(sum, -0.5 * 50.0 * 9.81 * height, 1e-2);
    end(&b);
  }
  assert_true(error[1] < 1e-4 && error[1] < 0.3 * error[0]); /* of the second order in h */
}

static void at_rest(void *ctx, const pw_real *x, pw_idx body, pw_real *stress)
{
  const column *b = ctx;
  const double down = -50.0 * b->gravity * (0.8 - x[1]);
  (void)body;
  stress[0] = stress[2] = 0.5 * down;
  stress[1] = down;
  stress[3] = stress[4] = stress[5] = 0.0;
}

static void stand(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  (void)t0, (void)t1;
  weigh(ctx, m, 0.0, 1.0);
}

/* A weight that grows over 40 periods of the column, so small that no point leaves its element: the
 * swing of the start, 1/(omega T) of the end, is damped away, and damping lags by alpha u/(g T), 6e-4
 * of the weight. */
static void slow_dynamics_are_quasi_static(void **state)
{
  (void)state;
  column still, moving;
  start(2, 0.8, 0.0, 50.0, &still);
  start(2, 0.8, 0.0, 50.0, &moving);
  pw_newton_options options = pw_newton_defaults();
  options.newmark = pw_newmark_defaults();
  options.newmark.damping = 1.0; /* 1/s; omega = 8.8 1/s */
  pw_newton_destroy(&moving.newton);
  assert_ok(pw_newton_create(&moving.model, &options, &moving.newton));
  for (int k = 1; k <= 200; k++) {
    still.gravity = moving.gravity = 1e-5 * k;
    pw_newton_load a = {.ctx = &still, .apply = stand};
    pw_newton_load b = {.ctx = &moving, .step_s = 0.14, .apply = stand};
    assert_ok(pw_newton_step(still.newton, &a, &still.report));
    assert_ok(pw_newton_step(moving.newton, &b, &moving.report));
  }
  const pw_tet_points *p = &still.model.points, *q = &moving.model.points;
  double off = 0.0, size = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    off = fmax(off, fabs(p->stress[p->ld + i] - q->stress[q->ld + i]));
    size = fmax(size, fabs(p->stress[p->ld + i]));
  }
  print_message("slow weight: stress differs by %.1e of %.4f Pa\n", off / size, size);
  assert_true(off < 1e-3 * size);
  end(&still);
  end(&moving);
}

/* Ground that starts under its own weight, K0 = 0.5, stays where it is: four points integrate the
 * weight and the stress of linear elements alike. */
static void prestressed_columns_rest(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    column b;
    double moved = 0.0;
    start(4 << k, 0.8, 0.3, 50.0, &b);
    b.gravity = 1.0;
    assert_ok(pw_tet_model_prestress(&b.model, at_rest, &b));
    pw_newton_load load = {.ctx = &b, .apply = stand};
    assert_ok(pw_newton_step(b.newton, &load, &b.report));
    const pw_real *u = pw_newton_displacement(b.newton);
    for (pw_idx i = 0; i < 3 * b.mesh.tets.nnode; i++) {
      moved = fmax(moved, fabs(u[i]));
    }
    assert_relative(base_force(&b), 50.0 * 0.8 * 0.01, 1e-8);
    print_message("%d bricks: moved by %.2e m, %.2e without initial stress\n", 4 << k, moved,
                  0.5 * 50.0 * 0.64 / 1.35e3);
    assert_true(moved < 1e-12);
    end(&b);
  }
}

static void grow_weight(void *ctx, pw_tet_model *m, pw_real from, pw_real to)
{
  (void)from;
  weigh(ctx, m, 0.0, to / 10.0);
}

/* Ten seconds of growing weight: steps grow while they are easy, end exactly at the end, and shrink
 * after one that needed an approach. */
static void steps_grow_while_easy(void **state)
{
  (void)state;
  column b;
  start(4, 0.8, 0.0, 50.0, &b);
  b.gravity = 9.81;
  pw_newton_course c = {.ctx = &b,
                        .apply = grow_weight,
                        .end = 10.0,
                        .size = 0.5,
                        .least = 0.1,
                        .most = 3.0,
                        .easy = 4,
                        .hard = 9,
                        .grow = 1.5,
                        .shrink = 0.5};
  double before = 0.0;
  int steps = 0;
  while (c.now < c.end) {
    assert_ok(pw_newton_advance(b.newton, &c, &b.report));
    assert_true(c.now > before && c.size >= c.least && c.size <= c.most);
    before = c.now;
    steps++;
  }
  assert_true(c.now == 10.0);
  assert_int_equal(steps, 7); /* 0.5 0.75 1.125 1.6875 2.53 3.0 and what is left */
  assert_relative(base_force(&b), 50.0 * 9.81 * 0.8 * 0.01, 1e-8);
  pw_newton_report hard = {.iterations = 9}, cut = {.cuts = 1}, fair = {.iterations = 6};
  assert_true(pw_newton_next_size(&c, 2.0, &hard) == 1.0);
  assert_true(pw_newton_next_size(&c, 0.15, &cut) == 0.1);
  assert_true(pw_newton_next_size(&c, 2.0, &fair) == 2.0);
  assert_int_equal(pw_newton_advance(b.newton, &c, &b.report), PW_ERR_ARGUMENT);
  end(&b);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(columns_settle_under_their_weight),
      cmocka_unit_test(slow_dynamics_are_quasi_static),
      cmocka_unit_test(prestressed_columns_rest),
      cmocka_unit_test(steps_grow_while_easy),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
