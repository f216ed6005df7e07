/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What more threads bring to a scene: two simulations of it, with one thread and with several, are
 * advanced in turns by short windows of steps. Both go through the same states to the last bit, so
 * a window of one and the same window of the other are the same work a moment apart. Prints the
 * ratio of neighbouring windows (quartiles), the time of each stage in the middle and in the
 * quickest tenth of the windows, and the bounds that the division of the blocks sets.
 *   bench_threads SCENE.yaml [threads 2] [windows 40] [steps 25] [key.path=value]... */
#include <stdio.h>
#include <stdlib.h>

#include "engine/core/mem.h"
#include "engine/pilewright.h"
#include "engine/ranges.h"
#include "partition/share.h"

enum { COLUMNS = PW_TIMER_COUNT + 1, MAX_WINDOWS = 10000 };

static const char *const STAGE[COLUMNS] = {"sort",  "p2g",        "nodes", "effects",
                                           "remap", "g2p_stress", "all"};

/* Times of the windows of one simulation; ns per point and step. */
typedef struct {
  pw_sim *sim;
  double ns[COLUMNS][MAX_WINDOWS];
} runner;

static pw_status run_window(runner *r, int window, int steps)
{
  pw_report before, after;
  pw_sim_report(r->sim, &before);
  for (int k = 0; k < steps; k++) {
    PW_TRY(pw_sim_step(r->sim, 0.0));
  }
  pw_sim_report(r->sim, &after);
  const double unit = 1e9 / ((double)after.points * steps);
  for (int c = 0; c < PW_TIMER_COUNT; c++) {
    r->ns[c][window] = unit * (after.stage_wall_s[c] - before.stage_wall_s[c]);
  }
  r->ns[COLUMNS - 1][window] = unit * (after.wall_s - before.wall_s);
  return PW_OK;
}

static int ascending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Value below which the part `at` of n values lies; sorts them. */
static double quantile(double *value, int n, double at)
{
  qsort(value, (size_t)n, sizeof *value, ascending);
  return value[(int)(at * (n - 1) + 0.5)];
}

static void print_ratios(const runner *one, const runner *many, int windows)
{
  static double ratio[MAX_WINDOWS];
  for (int w = 0; w < windows; w++) {
    ratio[w] = one->ns[COLUMNS - 1][w] / many->ns[COLUMNS - 1][w];
  }
  double low = quantile(ratio, windows, 0.25), middle = quantile(ratio, windows, 0.5);
  printf("ratio of neighbouring windows: quartiles %.2f %.2f %.2f\n", low, middle,
         quantile(ratio, windows, 0.75));
}

static void print_stages(runner *one, runner *many, int threads, int windows)
{
  printf("ns per point and step  %8s %10s %7s | quickest tenth: 1 and %d threads\n", "1 thread",
         "threads", "ratio", threads);
  for (int c = 0; c < COLUMNS; c++) {
    double a = quantile(one->ns[c], windows, 0.5), b = quantile(many->ns[c], windows, 0.5);
    double p = quantile(one->ns[c], windows, 0.1), q = quantile(many->ns[c], windows, 0.1);
    if (a > 0.05) {
      printf("  %-20s %8.1f %10.1f %7.2f | %8.1f %8.1f %6.2f\n", STAGE[c], a, b, a / b, p, q,
             p / q);
    }
  }
  double a = 1e3 / quantile(one->ns[COLUMNS - 1], windows, 0.5);
  printf("M point-steps/s: %.3f with one thread, %.3f with %d\n", a,
         1e3 / quantile(many->ns[COLUMNS - 1], windows, 0.5), threads);
}

static void print_bounds(pw_sim *sim, int threads)
{
  pw_blocks *b = &sim->blocks;
  pw_real coloured[2], plain[2];
  pw_ranges_balance(sim);
  pw_share_bound(b, threads, &coloured[1], &plain[1]);
  b->nthread = 0;
  pw_share_bound(b, threads, &coloured[0], &plain[0]);
  printf("%d blocks, %d colours, %d of %d groups of nodes in use\n", b->nblock, b->ncolour,
         sim->nodes.nused, sim->nodes.ngroup);
  printf("bounds on the speed-up: coloured scatters %.3f (equal numbers of blocks: %.3f), gather "
         "and stress %.3f (%.3f)\n",
         coloured[1], coloured[0], plain[1], plain[0]);
}

static pw_status compare(const pw_scene *scene, int threads, int windows, int steps)
{
  static runner run[2];
  pw_status s = pw_sim_create(scene, 1, &run[0].sim);
  if (s == PW_OK) {
    s = pw_sim_create(scene, threads, &run[1].sim);
  }
  for (int w = -1; w < windows && s == PW_OK; w++) { /* the first window warms up */
    for (int k = 0; k < 2 && s == PW_OK; k++) {
      s = run_window(&run[(w + 1 + k) % 2], w < 0 ? 0 : w, steps);
    }
  }
  if (s == PW_OK) {
    print_bounds(run[1].sim, threads);
    print_ratios(&run[0], &run[1], windows);
    print_stages(&run[0], &run[1], threads, windows);
  }
  pw_sim_destroy(&run[0].sim);
  pw_sim_destroy(&run[1].sim);
  return s;
}

int main(int argc, char **argv)
{
  static pw_scene scene;
  char *messages = NULL;
  int threads = argc > 2 ? atoi(argv[2]) : 2, windows = argc > 3 ? atoi(argv[3]) : 40;
  int steps = argc > 4 ? atoi(argv[4]) : 25, nset = argc > 5 ? argc - 5 : 0;
  if (argc < 2 || threads < 1 || windows < 1 || windows > MAX_WINDOWS || steps < 1) {
    fprintf(stderr, "usage: bench_threads SCENE.yaml [threads] [windows] [steps] [key=value]...\n");
    return 2;
  }
  pw_status s = pw_scene_read_file(argv[1], nset, (const char *const *)argv + 5, &scene, &messages);
  if (s == PW_OK) {
    s = compare(&scene, threads, windows, steps);
  }
  if (s != PW_OK) {
    fprintf(stderr, "%s\n", messages ? messages : pw_error_text());
  }
  free(messages);
  return s == PW_OK ? 0 : 1;
}
