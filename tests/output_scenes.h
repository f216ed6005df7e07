/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/output_scenes.h
 * @brief Small scenes for tests of what the program writes.
 */
#ifndef PW_TESTS_OUTPUT_SCENES_H
#define PW_TESTS_OUTPUT_SCENES_H

#include "tests/engine_helpers.h"

/** Hochstetten sand (Niemunis & Herle 1997, table 1) of void ratio 0.7. */
static inline int test_sand(pw_scene *scene)
{
  static const struct {
    const char *key;
    pw_real value;
  } sand[] = {
      {"grain_density_kg_m3", 2650.0},
      {"void_ratio", 0.7},
      {"critical_friction_angle_deg", 33.0},
      {"granular_hardness_pa", 1e9},
      {"exponent_n", 0.25},
      {"void_ratio_d0", 0.55},
      {"void_ratio_c0", 0.95},
      {"void_ratio_i0", 1.05},
      {"exponent_alpha", 0.25},
      {"exponent_beta", 1.0},
  };
  int m = test_material(scene, "hypoplastic_sand");
  for (size_t k = 0; k < sizeof sand / sizeof *sand; k++) {
    test_param(scene, m, sand[k].key, sand[k].value);
  }
  return m;
}

/** Axisymmetric: sand 4 m wide and 3 m high under K0 stress, an elastic pile standing on it. */
static inline void test_pile_on_sand(pw_scene *scene)
{
  const pw_real box[4] = {0.0, 4.0, 0.0, 6.0}, soil[4] = {0.0, 4.0, 0.0, 3.0};
  pw_scene_default(scene);
  snprintf(scene->title, sizeof scene->title, "Pile on sand, a 'quoted' test");
  scene->geometry = PW_AXI;
  scene->method.basis = PW_CPDI;
  test_grid(scene, box, 0.25);
  int sand = test_sand(scene), steel = test_elastic(scene, 1e8, 0.3, 2000.0);
  test_rectangle(scene, sand, soil, 0.125);
  pw_scene_body *pile = &scene->body[scene->nbody];
  *pile = (pw_scene_body){.material = steel,
                          .shape = PW_SHAPE_PILE,
                          .radius_m = 0.5,
                          .tip_y_m = 3.0,
                          .length_m = 2.0,
                          .tip = PW_TIP_FLAT,
                          .point_size_m = 0.125};
  snprintf(pile->name, sizeof pile->name, "pile");
  scene->nbody++;
  pw_initial_stress_param *initial = pw_scene_add_effect(scene, "initial_stress");
  initial->body = 0;
  initial->top_y_m = 3.0;
  initial->k0 = 0.46;
  pw_gravity_param *gravity = pw_scene_add_effect(scene, "gravity");
  gravity->acceleration_m_s2 = 9.81;
  for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_RIGHT; side++) {
    pw_boundary_param *fixed = side == PW_SIDE_TOP ? NULL : pw_scene_add_effect(scene, "boundary");
    if (fixed) {
      fixed->side = side;
      fixed->fix_x = side != PW_SIDE_BOTTOM;
      fixed->fix_y = side == PW_SIDE_BOTTOM;
    }
  }
}

/** Plane strain: an elastic block 2 m x 1 m that flies across its grid. */
static inline void test_flying_block(pw_scene *scene, int basis)
{
  const pw_real box[4] = {-1.0, 5.0, 0.0, 2.0}, block[4] = {0.0, 2.0, 0.5, 1.5};
  pw_scene_default(scene);
  snprintf(scene->title, sizeof scene->title, "Flying block");
  scene->method.basis = basis;
  test_grid(scene, box, 0.25);
  pw_scene_body *b = test_rectangle(scene, test_elastic(scene, 1e6, 0.3, 1000.0), block, 0.125);
  b->velocity_m_s[0] = 3.0;
  b->velocity_m_s[1] = -1.0;
}

#endif /* PW_TESTS_OUTPUT_SCENES_H */
