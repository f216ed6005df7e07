/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/engine_helpers.h
 * @brief Scenes built by hand for tests of the engine.
 */
#ifndef PW_TESTS_ENGINE_HELPERS_H
#define PW_TESTS_ENGINE_HELPERS_H

#include "engine/effects/params.h"
#include "engine/sim_state.h"
#include "tests/harness.h"

/** A material of the scene; parameters are set by key name afterwards. */
static inline int test_material(pw_scene *scene, const char *model)
{
  pw_scene_material *m = &scene->material[scene->nmaterial];
  m->model = pw_material_find(model);
  snprintf(m->name, sizeof m->name, "m%d", scene->nmaterial);
  pw_scene_defaults(m->model->keys, m->param);
  return scene->nmaterial++;
}

static inline void test_param(pw_scene *scene, int material, const char *key, pw_real value)
{
  const pw_material *model = scene->material[material].model;
  for (int k = 0; model->keys[k].name; k++) {
    if (strcmp(model->keys[k].name, key) == 0) {
      scene->material[material].param[k] = value;
      return;
    }
  }
  fail_msg("no parameter %s", key);
}

static inline int test_elastic(pw_scene *scene, pw_real youngs, pw_real poisson, pw_real density)
{
  int m = test_material(scene, "linear_elastic");
  test_param(scene, m, "youngs_modulus_pa", youngs);
  test_param(scene, m, "poisson_ratio", poisson);
  test_param(scene, m, "density_kg_m3", density);
  return m;
}

static inline int test_neo_hookean(pw_scene *scene, pw_real bulk, pw_real shear, pw_real density)
{
  int m = test_material(scene, "neo_hookean");
  test_param(scene, m, "bulk_modulus_pa", bulk);
  test_param(scene, m, "shear_modulus_pa", shear);
  test_param(scene, m, "density_kg_m3", density);
  return m;
}

static inline pw_scene_body *test_rectangle(pw_scene *scene, int material, const pw_real box[4],
                                            pw_real size)
{
  pw_scene_body *b = &scene->body[scene->nbody];
  *b = (pw_scene_body){.material = material,
                       .shape = PW_SHAPE_RECTANGLE,
                       .x_m = {box[0], box[1]},
                       .y_m = {box[2], box[3]},
                       .point_size_m = size};
  snprintf(b->name, sizeof b->name, "body%d", scene->nbody++);
  return b;
}

static inline void test_grid(pw_scene *scene, const pw_real box[4], pw_real cell)
{
  scene->grid.origin_m[0] = box[0];
  scene->grid.origin_m[1] = box[2];
  scene->grid.size_m[0] = box[1] - box[0];
  scene->grid.size_m[1] = box[3] - box[2];
  scene->grid.cell_m = cell;
}

static inline pw_sim *test_sim(const pw_scene *scene, int threads)
{
  pw_sim *sim = NULL;
  assert_ok(pw_sim_create(scene, threads, &sim));
  return sim;
}

/** Steps until @p end, the last one cut to hit it. */
static inline void test_run_to(pw_sim *sim, pw_real end)
{
  while (sim->time < end * (1.0 - 1e-12)) {
    assert_ok(pw_sim_step(sim, end - sim->time));
  }
}

#endif /* PW_TESTS_ENGINE_HELPERS_H */
