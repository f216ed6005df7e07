/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/implicit_helpers.h
 * @brief Solid scenes of cases/, read and run as the program does, for tests of their figures.
 */
#ifndef PW_TESTS_IMPLICIT_HELPERS_H
#define PW_TESTS_IMPLICIT_HELPERS_H

#include <stdlib.h>

#include "engine/implicit.h"
#include "io/scene_file.h"
#include "io/solid_mesh.h"
#include "tests/harness.h"

/** Simulation of a scene file, path from tests/, with changes as of --set, on one thread. */
static inline pw_implicit *test_implicit(const char *path, int nset, const char *const *set)
{
  static pw_scene scene;
  char *messages = NULL;
  pw_solid_mesh mesh = {.ngroup = 0};
  pw_implicit *sim = NULL;
  if (pw_scene_read_file(path, nset, set, &scene, &messages) != PW_OK) {
    fail_msg("%s", messages ? messages : pw_error_text());
  }
  free(messages);
  assert_ok(pw_solid_mesh_load(&scene, &mesh));
  assert_ok(pw_implicit_create(&scene, &mesh, 1, &sim));
  pw_solid_mesh_destroy(&mesh);
  return sim;
}

/** The same of a scene under cases/. */
static inline pw_implicit *test_implicit_case(const char *file, int nset, const char *const *set)
{
  char path[256];
  snprintf(path, sizeof path, "../cases/%s", file);
  return test_implicit(path, nset, set);
}

/** All load steps that are left. */
static inline void test_implicit_run(pw_implicit *sim)
{
  while (pw_implicit_time(sim) < (1.0 - 1e-12) * pw_implicit_scene(sim)->time.end_s) {
    assert_ok(pw_implicit_step(sim));
  }
}

/** Value of a column of the history now; fails when there is none. */
static inline double test_implicit_history(const pw_implicit *sim, const char *name)
{
  static pw_record row;
  pw_implicit_history(sim, &row);
  for (int k = 0; k < row.n; k++) {
    if (strcmp(row.item[k].name, name) == 0) {
      return row.item[k].value;
    }
  }
  fail_msg("no column %s", name);
  return 0.0;
}

#endif /* PW_TESTS_IMPLICIT_HELPERS_H */
