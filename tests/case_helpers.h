/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/case_helpers.h
 * @brief Scenes of cases/, read as the program reads them, for tests that check their figures.
 */
#ifndef PW_TESTS_CASE_HELPERS_H
#define PW_TESTS_CASE_HELPERS_H

#include <stdlib.h>

#include "io/scene_file.h"
#include "tests/engine_helpers.h"

/** Simulation of a scene file under cases/ with changes as of --set. */
static inline pw_sim *test_case(const char *file, int nset, const char *const *set)
{
  static pw_scene scene;
  char *messages = NULL;
  char path[256];
  snprintf(path, sizeof path, "../cases/%s", file);
  if (pw_scene_read_file(path, nset, set, &scene, &messages) != PW_OK) {
    fail_msg("%s", messages ? messages : pw_error_text());
  }
  free(messages);
  return test_sim(&scene, 1);
}

/** Value of a column of the history now; fails when there is none. */
static inline pw_real test_history(const pw_sim *sim, const char *name)
{
  static pw_record row;
  pw_sim_history(sim, &row);
  for (int k = 0; k < row.n; k++) {
    if (strcmp(row.item[k].name, name) == 0) {
      return row.item[k].value;
    }
  }
  fail_msg("no column %s", name);
  return 0.0;
}

#endif /* PW_TESTS_CASE_HELPERS_H */
