/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/material_batch.h
 * @brief Batches of points of a material: no point's result depends on its place or neighbours.
 */
#ifndef PW_TESTS_MATERIAL_BATCH_H
#define PW_TESTS_MATERIAL_BATCH_H

#include "tests/material_helpers.h"

/** Arrays of several points, component-major. */
enum { TEST_POINTS = 150 };
typedef struct test_batch {
  pw_real de[6][TEST_POINTS], spin[3][TEST_POINTS], dvol[TEST_POINTS], density[TEST_POINTS];
  pw_real stress[6][TEST_POINTS], state[PW_MAX_STATE][TEST_POINTS], speed[TEST_POINTS];
} test_batch;

static inline void test_advance(const test_material *m, test_batch *b, pw_idx first, pw_idx n)
{
  pw_stress_args a = {.n = n,
                      .ld = TEST_POINTS,
                      .ldi = TEST_POINTS,
                      .dt = 1.0,
                      .dstrain = b->de[0] + first,
                      .spin = b->spin[0] + first,
                      .dvol = b->dvol + first,
                      .density = b->density + first,
                      .stress = b->stress[0] + first,
                      .state = b->state[0] + first,
                      .wave_speed = b->speed + first};
  assert_ok(m->model->update(m->v, &a));
}

/** Points of a batch get bitwise the same values alone, in pieces and together, whether their
 *  neighbours move in the plane or not. Starts from an isotropic pressure. */
static inline void test_place_does_not_matter(const test_material *m, double pressure, double size,
                                              bool plane)
{
  static test_batch all, alone, pieces;
  uint64_t seed = 77;
  memset(&all, 0, sizeof all);
  for (int i = 0; i < TEST_POINTS; i++) {
    all.density[i] = m->model->density(m->v);
    for (int c = 0; c < 3; c++) {
      all.stress[c][i] = -pressure;
    }
  }
  m->model->init(m->v, TEST_POINTS, TEST_POINTS, all.stress[0], all.state[0]);
  alone = pieces = all;
  for (int step = 0; step < 5; step++) {
    for (int i = 0; i < TEST_POINTS; i++) {
      bool out = !plane && i % 3 == 0;
      pw_real de[6], trace;
      test_random_strain(&seed, size, de);
      trace = de[0] + de[1] + de[2];
      for (int c = 0; c < 6; c++) {
        pw_real value = c < 4 || out ? de[c] : 0.0;
        all.de[c][i] = alone.de[c][i] = pieces.de[c][i] = value;
      }
      all.spin[0][i] = alone.spin[0][i] = pieces.spin[0][i] = size * (test_random(&seed) - 0.5);
      pw_real other = out ? size * test_random(&seed) : 0.0;
      all.spin[1][i] = alone.spin[1][i] = pieces.spin[1][i] = other;
      all.dvol[i] = alone.dvol[i] = pieces.dvol[i] = exp(trace);
    }
    test_advance(m, &all, 0, TEST_POINTS);
    for (int i = 0; i < TEST_POINTS; i++) {
      test_advance(m, &alone, i, 1);
    }
    for (int i = 0; i < TEST_POINTS; i += 13) {
      test_advance(m, &pieces, i, i + 13 < TEST_POINTS ? 13 : TEST_POINTS - i);
    }
  }
  assert_memory_equal(all.stress, alone.stress, sizeof all.stress);
  assert_memory_equal(all.state, alone.state, sizeof all.state);
  assert_memory_equal(all.speed, alone.speed, sizeof all.speed);
  assert_memory_equal(all.stress, pieces.stress, sizeof all.stress);
  assert_memory_equal(all.state, pieces.state, sizeof all.state);
  assert_memory_equal(all.speed, pieces.speed, sizeof all.speed);
}

#endif /* PW_TESTS_MATERIAL_BATCH_H */
