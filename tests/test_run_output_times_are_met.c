/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steps of uneven length meet every output time once, and what comes next follows from the time
 * alone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "io/output_times.h"

static pw_scene scene_with(pw_real end, pw_real history, pw_real snapshot)
{
  pw_scene scene;
  memset(&scene, 0, sizeof scene);
  scene.time.end_s = end;
  scene.output.history_every_s = history;
  scene.output.snapshot_every_s = snapshot;
  scene.output.pictures = true;
  return scene;
}

/* A step of 0.3 to 1.3 times the mean, from a fixed sequence. */
static pw_real step_length(pw_real mean, unsigned *seed)
{
  *seed = *seed * 1664525u + 1013904223u;
  return mean * (0.3 + (pw_real)(*seed >> 8) / (pw_real)(1u << 24));
}

typedef struct counts {
  int history, snapshot, picture, steps;
} counts;

/* Walk through a scene's time; asserts that rows fall on whole multiples. */
static counts walk(const pw_scene *scene, pw_real mean)
{
  counts n = {0};
  unsigned seed = 7;
  pw_real now = 0.0;
  pw_due due = pw_output_due(scene, -1.0, now);
  for (;;) {
    n.history += due.history;
    n.snapshot += due.snapshot;
    n.picture += due.picture;
    if (due.end) {
      return n;
    }
    if (due.history && scene->output.history_every_s > 0.0) {
      pw_real k = now / scene->output.history_every_s;
      assert_true(fabs(k - round(k)) < 1e-9 * fmax(k, 1.0));
    }
    pw_real left = pw_output_next(scene, now) - now;
    assert_true(left > 0.0);
    pw_real old = now;
    now += pw_min(left, step_length(mean, &seed));
    n.steps++;
    assert_true(n.steps < 1000000);
    due = pw_output_due(scene, old, now);
  }
}

static void test_every_time_is_met_once(void **state)
{
  (void)state;
  const pw_real every[] = {0.01, 0.1, 0.3, 1.0 / 3.0, 0.0123456789};
  for (int i = 0; i < 5; i++) {
    pw_scene scene = scene_with(12.0, every[i], 1.0);
    scene.output.picture_times_s = (pw_reals){4, {0.0, 0.3, 2.0, 12.0}};
    counts n = walk(&scene, 3e-3);
    int rows = (int)floor(12.0 / every[i] + 1e-9) + 1;
    bool end_between = fabs(12.0 / every[i] - round(12.0 / every[i])) > 1e-6;
    assert_int_equal(n.history, rows + end_between);
    assert_int_equal(n.snapshot, 13);
    assert_int_equal(n.picture, 4);
  }
}

static void test_period_zero(void **state)
{
  (void)state;
  pw_scene scene = scene_with(1.0, 0.0, 0.0);
  counts n = walk(&scene, 0.01);
  assert_int_equal(n.history, n.steps + 1);
  assert_int_equal(n.snapshot, 2);
  assert_int_equal(n.picture, 1);
}

/* Steps that divide the period are not cut into slivers by rounding. */
static void test_fixed_steps_are_not_cut(void **state)
{
  (void)state;
  pw_scene scene = scene_with(2.0, 0.01, 0.25);
  pw_real now = 0.0;
  int steps = 0;
  while (!pw_output_due(&scene, now, now).end) {
    pw_real left = pw_output_next(&scene, now) - now;
    assert_true(left > 1e-6);
    now += pw_min(left, 1e-3);
    steps++;
  }
  assert_int_equal(steps, 2000);
}

static void test_switching_pictures_off_keeps_the_steps(void **state)
{
  (void)state;
  pw_scene on = scene_with(1.0, 0.1, 0.0), off = on;
  on.output.picture_times_s = (pw_reals){1, {0.123}};
  off.output.picture_times_s = on.output.picture_times_s;
  off.output.pictures = false;
  assert_true(pw_output_next(&on, 0.11) == pw_output_next(&off, 0.11));
  assert_true(pw_output_due(&on, 0.11, 0.123).picture);
  assert_false(pw_output_due(&off, 0.11, 0.123).picture);
}

static void test_picture_names_differ(void **state)
{
  (void)state;
  const struct {
    pw_real end;
    pw_reals times;
    int steps, decimals;
  } with[] = {
      {2.0, {2, {0.5, 1.0}}, 0, 3},
      {0.004, {3, {0.001, 0.002, 0.003}}, 0, 3},
      {2.0, {2, {1.0, 2.0}}, 0, 3}, /* the end once more */
      {0.001, {3, {0.0, 0.0005, 0.00075}}, 0, 4},
      {0.02, {2, {0.0035, 0.0045}}, 0, 4}, /* 0.004 both, by the binary numbers */
      {1.0, {2, {2e-7, 5e-7}}, 0, 7},
      {0.001, {0}, 10, 3},
      {0.01, {2, {0.0014, 0.0016}}, 5, 3}, /* drawn at the ends of steps of 2 ms */
      {0.001, {2, {0.0002, 0.0004}}, 10, 4},
  };
  for (size_t k = 0; k < sizeof with / sizeof with[0]; k++) {
    pw_scene scene = scene_with(with[k].end, 0.0, 0.0);
    scene.output.picture_times_s = with[k].times;
    scene.solid.implicit.steps = with[k].steps;
    scene.method.update = with[k].steps > 0 ? PW_IMPLICIT : PW_MUSL;
    assert_int_equal(pw_picture_decimals(&scene), with[k].decimals);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_every_time_is_met_once),
      cmocka_unit_test(test_period_zero),
      cmocka_unit_test(test_fixed_steps_are_not_cut),
      cmocka_unit_test(test_switching_pictures_off_keeps_the_steps),
      cmocka_unit_test(test_picture_names_differ),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
