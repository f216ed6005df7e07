/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/engine_scenes.h
 * @brief Small versions of the cases, built by hand: sand, and a pile hammered into it.
 */
#ifndef PW_TESTS_ENGINE_SCENES_H
#define PW_TESTS_ENGINE_SCENES_H

#include "bench/sand.h"
#include "tests/contact_helpers.h"

/** Sand of the thesis' pile, e = 0.65. */
static inline int test_sand(pw_scene *scene, bool intergranular)
{
  int m = test_material(scene, "hypoplastic_sand");
  bench_sand(&scene->material[m], intergranular);
  return m;
}

static inline void test_roller(pw_scene *scene, int side)
{
  pw_boundary_param *b = pw_scene_add_effect(scene, "boundary");
  assert_non_null(b);
  b->side = side;
  b->fix_x = side == PW_SIDE_LEFT || side == PW_SIDE_RIGHT;
  b->fix_y = !b->fix_x;
}

static inline pw_gravity_param *test_gravity(pw_scene *scene, pw_real ramp)
{
  pw_gravity_param *g = pw_scene_add_effect(scene, "gravity");
  assert_non_null(g);
  g->ramp_s = ramp;
  return g;
}

/** Axisymmetric pile of radius 0.15 m on sand 1.5 m wide and 1.5 m deep, hammered from the start. */
static inline void test_hammered_pile(pw_scene *s, test_contact contact, pw_real cell)
{
  pw_scene_default(s);
  s->geometry = PW_AXI;
  test_grid(s, (pw_real[]){0.0, 1.5, 0.0, 3.0}, cell);
  int sand = test_sand(s, true), steel = test_elastic(s, 1e8, 0.28, 2500.0);
  test_rectangle(s, sand, (pw_real[]){0.0, 1.5, 0.0, 1.5}, 0.5 * cell);
  s->body[s->nbody] = (pw_scene_body){.name = "pile",
                                      .material = steel,
                                      .shape = PW_SHAPE_PILE,
                                      .radius_m = 0.15,
                                      .tip_y_m = 1.5,
                                      .length_m = 1.0,
                                      .tip = PW_TIP_FLAT,
                                      .point_size_m = 0.5 * cell,
                                      .velocity_m_s = {0.0, -1.0}};
  s->nbody++;
  test_gravity(s, 0.0);
  pw_initial_stress_param *i = pw_scene_add_effect(s, "initial_stress");
  i->body = 0;
  i->top_y_m = 1.5;
  i->k0 = 0.45;
  test_add_contact(s, contact, 1, 0, 0.3, 1e8, 0.0);
  pw_hammer_param *h = pw_scene_add_effect(s, "hammer");
  h->body = 1;
  h->pressure_pa = 1e6;
  h->duration_s = 0.1;
  pw_pile_record_param *r = pw_scene_add_effect(s, "pile_record");
  r->body = 1;
  r->soil = 0;
  test_roller(s, PW_SIDE_RIGHT);
  test_roller(s, PW_SIDE_BOTTOM);
}

#endif /* PW_TESTS_ENGINE_SCENES_H */
