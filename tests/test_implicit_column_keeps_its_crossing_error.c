/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Self-weight column (tests/test_self_weight_column_converges.c) of linear tetrahedra with four points
 * each, which is standard MPM: points that cross elements leave an error of stress that no refinement
 * takes away, while the weight that the base carries is exact. In one dimension with two points in an
 * element it is 8 to 10 %; here 10.5, 12.1 and 12.7 % with 16, 32 and 64 bricks. */
#include "engine/tet_loads.h"
#include "tests/harness.h"
#include "tests/solid_helpers.h"

static const double height = 50.0, weight = 800.0;

static void stay(const void *ctx, pw_real *x)
{
  (void)ctx, (void)x;
}

static void weigh(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const solid *s = ctx;
  const pw_real g[3] = {0.0, -10.0 * (s->part[0] + t1 * (s->part[1] - s->part[0])), 0.0};
  (void)t0;
  memset(m->external, 0, 3 * (size_t)s->nnode * sizeof *m->external);
  pw_tet_model_gravity(m, g);
}

static pw_status put_back(void *ctx, pw_tet_model *m, pw_real t1)
{
  (void)ctx, (void)m, (void)t1;
  return PW_OK;
}

/* Sum |sigma_yy - exact| V0 / (rho0 g H sum V0) after 40 steps. */
static double settle(pw_idx bricks)
{
  static solid s;
  static double begin[6 * 4 * 64];
  const double h = height / bricks;
  pw_tet_box box = {.bricks = {1, bricks, 1}, .high = {h, height, h}, .per_brick = 6, .nodes = 4};
  memset(&s, 0, sizeof s);
  s.rule = PW_TET_RULE_FOUR;
  s.material = solid_von_mises(1e4, 0.0, 1e9);
  solid_set(&s.material, "density_kg_m3", 80.0);
  assert_ok(solid_mesh(&box, stay, NULL, &s.mesh));
  assert_ok(solid_start(&s, PW_FBAR_NONE, 1, NULL));
  for (pw_idx i = 0; i < 3 * s.nnode; i++) { /* u_y alone, nothing at the base */
    s.model.fixed[i] = i / s.nnode != 1 || s.x[i] == 0.0;
  }
  const pw_tet_points *p = &s.model.points;
  memcpy(begin, p->x + p->ld, (size_t)p->n * sizeof *begin);
  for (int k = 1; k <= 40; k++) {
    pw_newton_load load = {.ctx = &s, .apply = weigh, .move = put_back};
    s.part[1] = k / 40.0;
    assert_ok(pw_newton_step(s.newton, &load, &s.report));
    s.part[0] = s.part[1];
  }
  double sum = 0.0, volume = 0.0, base = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    const double volume0 = p->volume[i] / p->jac[i];
    sum += volume0 * fabs(p->stress[p->ld + i] + weight * (height - begin[i]));
    volume += volume0;
  }
  for (pw_idx a = 0; a < s.nnode; a++) {
    const pw_idx i = s.nnode + a;
    base += s.x[i] == 0.0 ? s.model.force[i] - s.model.external[i] : 0.0;
  }
  assert_relative(base, weight * height * h * h, 1e-7);
  print_message("%d bricks: error %.4f\n", (int)bricks, sum / volume / (weight * height));
  solid_end(&s);
  return sum / volume / (weight * height);
}

static void refinement_does_not_help(void **state)
{
  (void)state;
  const double coarse = settle(16), middle = settle(32), fine = settle(64);
  assert_true(coarse > 0.07 && middle > 0.07 && fine > 0.07);
  assert_true(middle > 0.8 * coarse && fine > 0.8 * middle && fine < 0.2);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(refinement_does_not_help),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
