/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/structure_helpers.h
 * @brief Scenes with a body that has no points.
 */
#ifndef PW_TESTS_STRUCTURE_HELPERS_H
#define PW_TESTS_STRUCTURE_HELPERS_H

#include "engine/structure_sim.h"
#include "tests/engine_helpers.h"

static const double PI = 3.14159265358979323846;

/** A pile of radius 0.15 m and length 5 m whose tip is at 3 m, alone in a grid of 1 m x 10 m (plane
 *  strain: 2 m x 10 m); E = 100 MPa, 2500 kg/m3: a wave speed of 200 m/s. */
static inline pw_scene_body *test_structure(pw_scene *s, int geometry, int kind, int tip)
{
  pw_scene_default(s);
  s->geometry = geometry;
  s->time.end_s = 1.0;
  test_grid(s, (pw_real[]){geometry == PW_AXI ? 0.0 : -1.0, 1.0, 0.0, 10.0}, 0.1);
  pw_scene_body *b = &s->body[s->nbody++];
  *b = (pw_scene_body){.name = "pile",
                       .material = test_elastic(s, 1e8, 0.0, 2500.0),
                       .kind = kind,
                       .shape = PW_SHAPE_PILE,
                       .radius_m = 0.15,
                       .tip_y_m = 3.0,
                       .length_m = 5.0,
                       .tip = tip,
                       .rod_elements = 40};
  return b;
}

static inline void test_structure_step(pw_structure *s, pw_real dt, pw_real head_force,
                                       const pw_real *given)
{
  pw_structure_clear(s);
  pw_structure_add_head_force(s, head_force);
  pw_structure_kick(s, dt, given);
  pw_structure_drift(s, dt);
}

#endif /* PW_TESTS_STRUCTURE_HELPERS_H */
