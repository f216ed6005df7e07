/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file bench/sand.h
 * @brief The sand of the thesis' pile (table 4.1) as a material of a scene, for benchmarks and
 *        tests.
 */
#ifndef PW_BENCH_SAND_H
#define PW_BENCH_SAND_H

#include <string.h>

#include "engine/effects/params.h"
#include "engine/sim.h"

static inline void bench_set_param(pw_scene_material *m, const char *key, pw_real value)
{
  for (int k = 0; m->model->keys[k].name; k++) {
    if (strcmp(m->model->keys[k].name, key) == 0) {
      m->param[k] = value;
    }
  }
}

/** Thesis table 4.1; e = 0.65. A material without a name is called sand. */
static inline void bench_sand(pw_scene_material *m, bool intergranular)
{
  static const struct {
    const char *key;
    pw_real value;
  } p[] = {{"grain_density_kg_m3", 2600.0},
           {"void_ratio", 0.65},
           {"critical_friction_angle_deg", 30.0},
           {"cohesion_shift_pa", 1600.0},
           {"granular_hardness_pa", 5.8e9},
           {"exponent_n", 0.28},
           {"void_ratio_d0", 0.53},
           {"void_ratio_c0", 0.84},
           {"void_ratio_i0", 1.0},
           {"exponent_alpha", 0.13},
           {"exponent_beta", 1.0}};
  if (!m->name[0]) {
    strcpy(m->name, "sand");
  }
  m->model = pw_material_find("hypoplastic_sand");
  pw_scene_defaults(m->model->keys, m->param);
  for (size_t k = 0; k < sizeof p / sizeof p[0]; k++) {
    bench_set_param(m, p[k].key, p[k].value);
  }
  bench_set_param(m, "intergranular_strain", intergranular ? 1.0 : 0.0);
}

#endif /* PW_BENCH_SAND_H */
