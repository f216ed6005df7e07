/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/output_times.h"

#include <math.h>

/* Rounding of time += dt stays far below both; real output times lie far above. */
#define SERIES_SLACK 1e-9  /* of a period */
#define SINGLE_SLACK 1e-12 /* of the end time */

pw_real pw_series_index(pw_real every_s, pw_real time_s)
{
  return floor(time_s / every_s + SERIES_SLACK);
}

static bool series_due(pw_real every_s, pw_real old_s, pw_real new_s)
{
  return every_s > 0.0 && pw_series_index(every_s, new_s) > pw_series_index(every_s, old_s);
}

/* Smaller of `next` and the series' next time after now. */
static pw_real earlier(pw_real next, pw_real every_s, pw_real now_s)
{
  if (every_s <= 0.0) {
    return next;
  }
  pw_real at = (pw_series_index(every_s, now_s) + 1.0) * every_s;
  return at > now_s && at < next ? at : next;
}

pw_real pw_output_next(const pw_scene *scene, pw_real time_s)
{
  pw_real slack = SINGLE_SLACK * scene->time.end_s;
  pw_real next = scene->time.end_s;

  next = earlier(next, scene->output.history_every_s, time_s);
  next = earlier(next, scene->output.snapshot_every_s, time_s);
  for (int i = 0; i < scene->output.picture_times_s.n; i++) {
    pw_real at = scene->output.picture_times_s.v[i];
    if (at > time_s + slack && at < next) {
      next = at;
    }
  }
  return next;
}

pw_due pw_output_due(const pw_scene *scene, pw_real old_s, pw_real new_s)
{
  pw_real slack = SINGLE_SLACK * scene->time.end_s;
  bool start = old_s < 0.0;
  bool end = new_s >= scene->time.end_s - slack;
  pw_real history_s = scene->output.history_every_s;
  pw_due due = {
      .history = start || end || history_s <= 0.0 || series_due(history_s, old_s, new_s),
      .snapshot = start || end || series_due(scene->output.snapshot_every_s, old_s, new_s),
      .checkpoint = start || series_due(scene->output.checkpoint_every_s, old_s, new_s),
      .picture = false,
      .end = end,
  };

  for (int i = 0; i < scene->output.picture_times_s.n; i++) {
    pw_real at = scene->output.picture_times_s.v[i];
    if (at <= new_s + slack && (start || at > old_s + slack)) {
      due.picture = true;
    }
  }
  due.picture = scene->output.pictures && (due.picture || end);
  return due;
}

/* When picture i is drawn, the last one at the end: implicit steps on a grid are not cut for it. */
static pw_real picture_time(const pw_scene *scene, int i)
{
  const pw_reals *times = &scene->output.picture_times_s;
  const pw_real end = scene->time.end_s, at = i < times->n ? pw_min(times->v[i], end) : end;
  const int steps = scene->solid.implicit.steps;
  if (scene->method.update != PW_IMPLICIT || scene->geometry == PW_SOLID || steps < 1) {
    return at;
  }
  return ceil(at / end * steps * (1.0 - SINGLE_SLACK)) * end / steps;
}

/* Whether two times are one, or differ in so many decimals, however the last of them is rounded. */
static bool told_apart(const pw_scene *scene, pw_real a, pw_real b, int decimals)
{
  const pw_real scale = pow(10.0, decimals), early = pw_min(a, b), late = pw_max(a, b);
  return late - early <= SINGLE_SLACK * scene->time.end_s ||
         floor(late * scale + 0.5 - 1e-6) > floor(early * scale + 0.5 + 1e-6);
}

int pw_picture_decimals(const pw_scene *scene)
{
  const int n = scene->output.picture_times_s.n;
  int decimals = 3;
  for (int i = 0; i <= n; i++) {
    for (int j = 0; j < i; j++) {
      const pw_real a = picture_time(scene, i), b = picture_time(scene, j);
      while (decimals < 12 && !told_apart(scene, a, b, decimals)) {
        decimals++;
      }
    }
  }
  return decimals;
}
