/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

enum { LINE = 256, BAR_MIN = 8, BAR_MAX = 40, WIDTH_DEFAULT = 80 };

#define REDRAW_S   0.2  /* on a terminal */
#define PLAIN_S    10.0 /* between plain lines at most */
#define PLAIN_PART 0.05 /* of the whole run between plain lines at most */

pw_real pw_wall_clock(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (pw_real)now.tv_sec + 1e-9 * (pw_real)now.tv_nsec;
}

const char *pw_duration_text(pw_real seconds, char *text, size_t size)
{
  if (seconds < 9.95) {
    snprintf(text, size, "%.1f s", seconds);
  } else if (seconds < 99.5) {
    snprintf(text, size, "%.0f s", seconds);
  } else if (seconds < 3600.0) {
    long whole = lround(seconds);
    snprintf(text, size, "%ld min %02ld s", whole / 60, whole % 60);
  } else {
    long minutes = lround(pw_min(seconds, 3.6e9) / 60.0);
    snprintf(text, size, "%ld h %02ld min", minutes / 60, minutes % 60);
  }
  return text;
}

void pw_progress_start(pw_progress *p, FILE *file, pw_real end_s, pw_idx points, pw_real time_s,
                       pw_off step)
{
  const char *term = getenv("TERM");

  memset(p, 0, sizeof *p);
  p->file = file;
  p->terminal = file && isatty(fileno(file)) && !(term && strcmp(term, "dumb") == 0);
  p->points = points;
  p->end_s = end_s;
  p->first_s = p->shown_s = time_s;
  p->first_step = step;
  p->wall_first_s = p->wall_shown_s = pw_wall_clock();
}

pw_real pw_progress_speed(const pw_progress *p, pw_off step)
{
  pw_real wall = pw_max(pw_wall_clock() - p->wall_first_s, 1e-9);
  return (pw_real)p->points * (pw_real)(step - p->first_step) / wall;
}

/* Steps grow and shrink in a run, so the pace forgets slowly: over a third of the time so far. */
static void smooth_rate(pw_progress *p, pw_real time_s, pw_real wall_s)
{
  pw_real span = wall_s - p->wall_shown_s;
  pw_real now = (time_s - p->shown_s) / pw_max(span, 1e-9);
  pw_real keep = exp(-span / (5.0 + 0.3 * (wall_s - p->wall_first_s)));
  p->rate = p->rate > 0.0 ? keep * p->rate + (1.0 - keep) * now : now;
}

static int window_width(FILE *file)
{
  struct winsize size;
  if (ioctl(fileno(file), TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    return size.ws_col;
  }
  return WIDTH_DEFAULT;
}

/* "[=====>    ] " in `width` columns, or nothing where there is no room for it. */
static void bar_text(char *text, size_t size, int width, pw_real part)
{
  int inside = width - 3 > BAR_MAX ? BAR_MAX : width - 3;
  int filled = (int)(part * inside);

  text[0] = '\0';
  if (inside < BAR_MIN || (size_t)inside + 4 > size) {
    return;
  }
  text[0] = '[';
  for (int i = 0; i < inside; i++) {
    text[1 + i] = i < filled ? '=' : i == filled ? '>' : ' ';
  }
  memcpy(text + 1 + inside, "] ", 3);
}

static void show(pw_progress *p, pw_real time_s, pw_off step, pw_real dt_s)
{
  char left[32] = "?", figures[LINE], bar[LINE];
  pw_real part = p->end_s > 0.0 ? pw_min(time_s / p->end_s, 1.0) : 1.0;

  if (p->rate > 0.0) {
    pw_duration_text((p->end_s - time_s) / p->rate, left, sizeof left);
  }
  snprintf(figures, sizeof figures,
           "%3.0f %%  t %#.4g of %.4g s  step %lld  dt %.2e s  %.2f M point-steps/s  left %s",
           100.0 * part, time_s, p->end_s, (long long)step, dt_s, 1e-6 * pw_progress_speed(p, step),
           left);
  if (!p->terminal) {
    fprintf(p->file, "%s\n", figures);
  } else {
    int width = window_width(p->file) - 1; /* a full line would wrap */
    bar_text(bar, sizeof bar, width - (int)strlen(figures), part);
    fprintf(p->file, "\r%s%.*s\033[K", bar, width - (int)strlen(bar), figures);
    p->drawn = true;
  }
  fflush(p->file);
}

void pw_progress_step(pw_progress *p, pw_real time_s, pw_off step, pw_real dt_s)
{
  if (!p->file) {
    return;
  }
  pw_real wall = pw_wall_clock();
  pw_real span = wall - p->wall_shown_s;
  bool due = p->terminal ? span >= REDRAW_S
                         : span >= PLAIN_S || time_s - p->shown_s >= PLAIN_PART * p->end_s;
  if (!due) {
    return;
  }
  smooth_rate(p, time_s, wall);
  show(p, time_s, step, dt_s);
  p->shown_s = time_s;
  p->wall_shown_s = wall;
}

void pw_progress_clear(pw_progress *p)
{
  if (p->file && p->drawn) {
    fputs("\r\033[K", p->file);
    fflush(p->file);
    p->drawn = false;
  }
}
