/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/quad_helpers.h
 * @brief Scenes for implicit steps on the grid.
 */
#ifndef PW_TESTS_QUAD_HELPERS_H
#define PW_TESTS_QUAD_HELPERS_H

#include "engine/step_implicit.h"
#include "tests/engine_scenes.h"

static const char *const test_basis_name[] = {"linear", "ugimp", "cpdi"};

/** An empty scene of implicit steps: geometry, basis, grid, steps in one second. */
static inline void test_quad_scene(pw_scene *s, int geometry, int basis, const pw_real box[4],
                                   pw_real cell, int steps)
{
  pw_scene_default(s);
  s->geometry = geometry;
  s->method.basis = basis;
  s->method.update = PW_IMPLICIT;
  s->time.end_s = 1.0;
  s->solid.implicit.steps = steps;
  test_grid(s, box, cell);
}

/** A side of the grid that moves along its normal; m/s. */
static inline void test_moving_side(pw_scene *s, int side, pw_real velocity)
{
  pw_boundary_param *b = pw_scene_add_effect(s, "boundary");
  assert_non_null(b);
  b->side = side;
  b->fix_x = side == PW_SIDE_LEFT || side == PW_SIDE_RIGHT;
  b->fix_y = !b->fix_x;
  *(b->fix_x ? &b->velocity_x_m_s : &b->velocity_y_m_s) = velocity;
}

static inline int test_hencky(pw_scene *s, pw_real youngs, pw_real poisson, pw_real density,
                              pw_real yield)
{
  const int m = test_material(s, "hencky_von_mises");
  test_param(s, m, "youngs_modulus_pa", youngs);
  test_param(s, m, "poisson_ratio", poisson);
  test_param(s, m, "density_kg_m3", density);
  test_param(s, m, "yield_uniaxial_pa", yield);
  return m;
}

static inline void test_quad_run(pw_sim *sim)
{
  while (sim->time < sim->scene.time.end_s) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
}

#endif /* PW_TESTS_QUAD_HELPERS_H */
