/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What more threads bring to a scene, and what they could bring: simulations of it with one thread,
 * with several, and as many with one thread each side by side are advanced in turns by short
 * windows of steps. All go through the same states to the last bit, which is checked at the end,
 * so a window of one and the same window of another are the same work a moment apart. Simulations
 * side by side share nothing but the machine: their speed together is the most that threads can
 * reach on it. Prints the ratios of neighbouring windows (quartiles), the time of each stage in the
 * middle and in the quickest tenth of the windows, and the bounds that the division of the blocks
 * sets.
 *   bench_threads SCENE.yaml [threads 2] [windows 40] [steps 25] [key.path=value]... */
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/core/mem.h"
#include "engine/pilewright.h"
#include "engine/ranges.h"
#include "partition/share.h"

enum { COLUMNS = PW_TIMER_COUNT + 1, ALL = PW_TIMER_COUNT, MAX_WINDOWS = 10000, MAX_SIMS = 256 };

/* One thread; several threads; several simulations of one thread. */
enum { ONE, MANY, BESIDE, RUNNERS };

static const char *const STAGE[COLUMNS] = {"sort",  "p2g",        "nodes", "effects",
                                           "remap", "g2p_stress", "all"};

/* Times of the windows of simulations that are advanced at the same time; ns per point and step of
 * all of them, so that speeds side by side add up. */
typedef struct {
  int sims;
  pw_sim *sim[MAX_SIMS];
  double ns[COLUMNS][MAX_WINDOWS];
} runner;

/* Time of each stage in a window of one simulation; ns per point and step. */
static pw_status advance(pw_sim *sim, int steps, double *ns)
{
  pw_report before, after;
  pw_sim_report(sim, &before);
  for (int k = 0; k < steps; k++) {
    PW_TRY(pw_sim_step(sim, 0.0));
  }
  pw_sim_report(sim, &after);
  const double unit = 1e9 / ((double)after.points * steps);
  for (int c = 0; c < PW_TIMER_COUNT; c++) {
    ns[c] = unit * (after.stage_wall_s[c] - before.stage_wall_s[c]);
  }
  ns[ALL] = unit * (after.wall_s - before.wall_s);
  return PW_OK;
}

/* Simulations side by side, each run by one member of a team; regions inside it have one thread.
 * Texts of errors belong to threads, so each member tells its own. */
static pw_status advance_beside(runner *r, int steps, double (*ns)[COLUMNS])
{
  int failed = 0;
#pragma omp parallel for num_threads(r->sims) schedule(static, 1) default(none)                    \
    shared(r, steps, ns, stderr) reduction(+ : failed)
  for (int i = 0; i < r->sims; i++) {
    if (advance(r->sim[i], steps, ns[i]) != PW_OK) {
      fprintf(stderr, "%s\n", pw_error_text());
      failed++;
    }
  }
  PW_REQUIRE(failed == 0, PW_ERR_ARGUMENT, "%d simulations side by side failed", failed);
  return PW_OK;
}

static pw_status run_window(runner *r, int window, int steps)
{
  static double ns[MAX_SIMS][COLUMNS];
  /* A team of one around it would make the inner regions nested ones, which start new threads. */
  PW_TRY(r->sims > 1 ? advance_beside(r, steps, ns) : advance(r->sim[0], steps, ns[0]));
  for (int c = 0; c < COLUMNS; c++) {
    double speed = 0.0;
    for (int i = 0; i < r->sims; i++) {
      speed += 1.0 / (ns[i][c] > 1e-3 ? ns[i][c] : 1e-3);
    }
    r->ns[c][window] = 1.0 / speed;
  }
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

/* How much faster b is than a in neighbouring windows. */
static void print_ratio(const char *what, const runner *a, const runner *b, int windows)
{
  static double ratio[MAX_WINDOWS];
  for (int w = 0; w < windows; w++) {
    ratio[w] = a->ns[ALL][w] / b->ns[ALL][w];
  }
  double low = quantile(ratio, windows, 0.25), middle = quantile(ratio, windows, 0.5);
  printf("  %-44s %.2f %.2f %.2f\n", what, low, middle, quantile(ratio, windows, 0.75));
}

static void print_ratios(const runner *run, int windows, int threads)
{
  char many[64], beside[64];
  snprintf(many, sizeof many, "%d threads to one", threads);
  snprintf(beside, sizeof beside, "%d simulations side by side to one", threads);
  printf("ratio of speeds in neighbouring windows: quartiles\n");
  print_ratio(many, &run[ONE], &run[MANY], windows);
  print_ratio(beside, &run[ONE], &run[BESIDE], windows);
  print_ratio("threads to simulations side by side", &run[BESIDE], &run[MANY], windows);
}

/* Three times and the ratios of the first to the others. */
static void print_part(runner *run, int c, int windows, double at)
{
  double t[RUNNERS];
  for (int k = 0; k < RUNNERS; k++) {
    t[k] = quantile(run[k].ns[c], windows, at);
  }
  printf(" | %8.1f %8.1f %8.1f %6.2f %6.2f", t[ONE], t[MANY], t[BESIDE], t[ONE] / t[MANY],
         t[ONE] / t[BESIDE]);
}

static void print_stages(runner *run, int windows, int threads)
{
  printf("ns per point and step with one thread, with %d, of %d simulations side by side; ratios\n",
         threads, threads);
  printf("%14s | %-41s | quickest tenth of the windows\n", "", "middle");
  for (int c = 0; c < COLUMNS; c++) {
    if (quantile(run[ONE].ns[c], windows, 0.5) > 0.05) {
      printf("  %-12s", STAGE[c]);
      print_part(run, c, windows, 0.5);
      print_part(run, c, windows, 0.1);
      printf("\n");
    }
  }
  printf("M point-steps/s:");
  for (int k = 0; k < RUNNERS; k++) {
    printf(" %.3f", 1e3 / quantile(run[k].ns[ALL], windows, 0.5));
  }
  printf("\n");
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

static bool same(const pw_points *a, const pw_points *b)
{
  const size_t x = 2 * (size_t)a->ld * sizeof(pw_real), s = 2 * x;
  return a->n == b->n && a->ld == b->ld && memcmp(a->x, b->x, x) == 0 &&
         memcmp(a->v, b->v, x) == 0 && memcmp(a->stress, b->stress, s) == 0;
}

/* Places, velocities and stresses of all simulations are the same bytes. */
static pw_status check_same(runner *run)
{
  const pw_points *first = pw_sim_points(run[ONE].sim[0]);
  for (int k = MANY; k < RUNNERS; k++) {
    for (int i = 0; i < run[k].sims; i++) {
      PW_REQUIRE(same(first, pw_sim_points(run[k].sim[i])), PW_ERR_ARGUMENT,
                 "simulations of the same scene differ");
    }
  }
  printf("%d simulations after %lld steps: the same bits\n", 2 + run[BESIDE].sims,
         (long long)pw_sim_steps(run[ONE].sim[0]));
  return PW_OK;
}

static pw_status create(const pw_scene *scene, int threads, runner *run)
{
  run[ONE].sims = run[MANY].sims = 1;
  run[BESIDE].sims = threads;
  for (int k = 0; k < RUNNERS; k++) {
    for (int i = 0; i < run[k].sims; i++) {
      PW_TRY(pw_sim_create(scene, k == MANY ? threads : 1, &run[k].sim[i]));
    }
  }
  return PW_OK;
}

static pw_status compare(const pw_scene *scene, int threads, int windows, int steps)
{
  static runner run[RUNNERS];
  pw_status s = create(scene, threads, run);
  for (int w = -1; w < windows && s == PW_OK; w++) { /* the first window warms up */
    for (int k = 0; k < RUNNERS && s == PW_OK; k++) {
      s = run_window(&run[(w + 1 + k) % RUNNERS], w < 0 ? 0 : w, steps);
    }
  }
  s = s == PW_OK ? check_same(run) : s;
  if (s == PW_OK) {
    print_bounds(run[MANY].sim[0], threads);
    print_ratios(run, windows, threads);
    print_stages(run, windows, threads);
  }
  for (int k = 0; k < RUNNERS; k++) {
    for (int i = 0; i < run[k].sims; i++) {
      pw_sim_destroy(&run[k].sim[i]);
    }
  }
  return s;
}

int main(int argc, char **argv)
{
  static pw_scene scene;
  char *messages = NULL;
  int threads = argc > 2 ? atoi(argv[2]) : 2, windows = argc > 3 ? atoi(argv[3]) : 40;
  int steps = argc > 4 ? atoi(argv[4]) : 25, nset = argc > 5 ? argc - 5 : 0;
  if (argc < 2 || threads < 1 || threads > MAX_SIMS || windows < 1 || windows > MAX_WINDOWS ||
      steps < 1) {
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
