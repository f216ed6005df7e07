/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/absorbing_helpers.h
 * @brief A column of elastic soil on an absorbing bottom, for tests of that effect.
 */
#ifndef PW_TESTS_ABSORBING_HELPERS_H
#define PW_TESTS_ABSORBING_HELPERS_H

#include "tests/engine_scenes.h"

/** Density 1800 kg/m3, c_p 250 m/s, nu 0.25: c_s = c_p / sqrt 3. */
static const double test_rho = 1800.0, test_cp = 250.0, test_nu = 0.25;

static inline double test_modulus(void)
{
  return test_rho * test_cp * test_cp;
}

static inline int test_soil(pw_scene *s)
{
  double shear = test_modulus() / 3.0;
  return test_elastic(s, 2.0 * shear * (1.0 + test_nu), test_nu, test_rho);
}

static inline pw_absorbing_param *test_absorbing(pw_scene *s, int side)
{
  pw_absorbing_param *p = pw_scene_add_effect(s, "absorbing");
  assert_non_null(p);
  p->side = side;
  p->shear_ratio = sqrt(1.0 / 3.0);
  return p;
}

/** Column 0.2 m wide and 10 m high of 0.2 m cells with rollers beside it, absorbing below. */
static inline pw_absorbing_param *test_column(pw_scene *s)
{
  pw_scene_default(s);
  s->geometry = PW_PLANE;
  test_grid(s, (pw_real[]){0.0, 0.2, 0.0, 10.2}, 0.2);
  test_rectangle(s, test_soil(s), (pw_real[]){0.0, 0.2, 0.0, 10.0}, 0.1);
  test_roller(s, PW_SIDE_LEFT);
  test_roller(s, PW_SIDE_RIGHT);
  return test_absorbing(s, PW_SIDE_BOTTOM);
}

/** The same at rest under its weight, K0 = 0.5. */
static inline pw_absorbing_param *test_column_at_rest(pw_scene *s)
{
  pw_absorbing_param *p = test_column(s);
  pw_initial_stress_param *i = pw_scene_add_effect(s, "initial_stress");
  i->body = 0;
  i->top_y_m = 10.0;
  i->k0 = 0.5;
  test_gravity(s, 0.0)->acceleration_m_s2 = 10.0;
  return p;
}

/** Largest speed of a point. */
static inline double test_fastest(const pw_sim *sim)
{
  const pw_points *p = &sim->points;
  double v = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    v = fmax(v, hypot(p->v[i], p->v[p->ld + i]));
  }
  return v;
}

/** What the books of energy leave open; J. */
static inline double test_open_books(const pw_sim *sim)
{
  const pw_energy *e = &sim->energy;
  return e->initial + e->external - e->kinetic - e->strain_work - e->contact - e->spring -
         e->damping - e->absorbed;
}

#endif /* PW_TESTS_ABSORBING_HELPERS_H */
