/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/tet_helpers.h
 * @brief Tetrahedral meshes for tests.
 */
#ifndef PW_TESTS_TET_HELPERS_H
#define PW_TESTS_TET_HELPERS_H

#include "engine/core/mem.h"
#include "engine/tet_box.h"
#include "engine/tet_model.h"
#include "tests/harness.h"
#include "tests/material_helpers.h"

/** The cube [0, edge]^3 of n^3 bricks. */
static inline pw_tet_box test_cube(pw_idx n, double edge, int per_brick, int nodes)
{
  return (pw_tet_box){
      .bricks = {n, n, n}, .high = {edge, edge, edge}, .per_brick = per_brick, .nodes = nodes};
}

static inline pw_tet_mesh test_box_mesh(const pw_tet_box *box)
{
  pw_tet_input in;
  pw_tet_mesh m;
  assert_ok(pw_tet_box_create(box, &in));
  assert_ok(pw_tet_mesh_create(&in, &m));
  pw_tet_box_destroy(&in);
  return m;
}

/** A cube of linear tetrahedra whose inner corners are moved at random by up to `shake` bricks;
 *  edges of up to that size keep volumes positive while shake <= 0.2. */
static inline pw_tet_mesh test_shaken_mesh(pw_idx n, double shake, uint64_t seed)
{
  pw_tet_box box = test_cube(n, 1.0, 6, 4);
  pw_tet_input in;
  pw_tet_mesh m;
  assert_ok(pw_tet_box_create(&box, &in));
  pw_real *x = (pw_real *)in.x; /* the box is ours */
  for (pw_idx a = 0; a < in.nnode; a++) {
    bool inner = true;
    for (int c = 0; c < 3; c++) {
      pw_real v = x[c * in.nnode + a];
      inner = inner && v > 0.0 && v < 1.0;
    }
    for (int c = 0; inner && c < 3; c++) {
      x[c * in.nnode + a] += shake / n * (2.0 * test_random(&seed) - 1.0);
    }
  }
  assert_ok(pw_tet_mesh_create(&in, &m));
  pw_tet_box_destroy(&in);
  return m;
}

static inline double test_volume(const pw_tet_mesh *m)
{
  double sum = 0.0;
  for (pw_idx e = 0; e < m->tets.nelem; e++) {
    sum += m->tets.volume[e];
  }
  return sum;
}

/** Hencky elasticity with von Mises plasticity; the yield by the name of its key. */
static inline pw_tet_material test_von_mises(double young, double poisson, const char *yield,
                                             double value, double hardening)
{
  test_material m = test_material_of("hencky_von_mises");
  pw_tet_material out = {.model = m.model};
  test_set(&m, "youngs_modulus_pa", young);
  test_set(&m, "poisson_ratio", poisson);
  test_set(&m, "density_kg_m3", 1.0);
  test_set(&m, yield, value);
  test_set(&m, "hardening_modulus_pa", hardening);
  memcpy(out.param, m.v, sizeof out.param);
  return out;
}

/** A model that fills a mesh with points of one material. */
static inline pw_tet_model test_model(pw_tet_mesh *mesh, const pw_tet_material *material,
                                      pw_tet_rule rule, pw_fbar fbar)
{
  pw_tet_fill fill = {.rule = rule, .nmaterial = 1, .material = material};
  pw_tet_setup setup = {.mesh = mesh, .fill = &fill, .fbar = fbar, .threads = 1};
  pw_tet_model m;
  assert_ok(pw_tet_model_create(&setup, &m));
  return m;
}

/** Random displacements [3][nnode] of up to `size`. */
static inline void test_displace(pw_idx nnode, double size, uint64_t *seed, double *u)
{
  for (pw_idx i = 0; i < 3 * nnode; i++) {
    u[i] = size * (2.0 * test_random(seed) - 1.0);
  }
}

#endif /* PW_TESTS_TET_HELPERS_H */
