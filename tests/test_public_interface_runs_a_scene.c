/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The library through its public header alone: load a scene, run steps, read fields; a block on
 * rollers falls freely at first and carries its own weight. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>

#include "engine/pilewright.h"

static pw_sim *load(int nset, const char *const *set)
{
  pw_scene *scene = malloc(sizeof *scene);
  pw_sim *sim = NULL;
  char *messages = NULL;
  assert_non_null(scene);
  assert_int_equal(pw_scene_read_file("scenes/small_elastic.yaml", nset, set, scene, &messages),
                   PW_OK);
  assert_null(messages);
  assert_int_equal(pw_sim_create(scene, 1, &sim), PW_OK);
  free(scene); /* the simulation has its own copy */
  return sim;
}

static void test_steps_and_fields(void **state)
{
  (void)state;
  pw_sim *sim = load(0, NULL);
  const pw_points *points = pw_sim_points(sim);
  pw_real mass = 0.0, base = 0.0, top = 0.0;

  assert_int_equal(points->n, 400);
  while (pw_sim_time(sim) < pw_sim_scene(sim)->time.end_s) {
    assert_int_equal(pw_sim_step(sim, 0.0), PW_OK);
  }
  assert_true(pw_sim_steps(sim) > 100);
  for (pw_idx i = 0; i < points->n; i++) {
    pw_real stress_yy = points->stress[points->ld + i];
    mass += points->mass[i];
    base += points->id[i] < 20 ? stress_yy / 20.0 : 0.0;
    top += points->id[i] >= 380 ? stress_yy / 20.0 : 0.0;
  }
  assert_true(fabs(mass - 1000.0) < 1e-9); /* 1 m2 of 1000 kg/m3 */
  assert_true(base < -1000.0);             /* compression is negative */
  assert_true(fabs(top) < 0.25 * fabs(base));
  pw_sim_destroy(&sim);
  assert_null(sim);
}

/* v = g t holds at the top until the wave from the rollers has come up: 1 m at 36.7 m/s. */
static void test_free_fall_before_the_wave(void **state)
{
  (void)state;
  const char *const set[] = {"time.end_s=0.01"};
  pw_sim *sim = load(1, set);
  const pw_points *points = pw_sim_points(sim);
  while (pw_sim_time(sim) < 0.01) {
    assert_int_equal(pw_sim_step(sim, 0.01 - pw_sim_time(sim)), PW_OK);
  }
  pw_idx top = points->slot[399];
  pw_real fallen = points->v[points->ld + top];
  assert_true(fabs(fallen + 9.81 * 0.01) < 1e-3 * 0.0981);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_steps_and_fields),
      cmocka_unit_test(test_free_fall_before_the_wave),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
