/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/check_equilibrium.h"

#include <math.h>
#include <string.h>

#include "engine/core/mem.h"

enum { DRIFT_STEPS = 50, KEPT = 6 /* x, y, and the stresses xx yy zz xy */ };

/* Largest changes of the points that started under stress. */
typedef struct drift {
  pw_real moved, speed, stress; /* m, m/s, Pa */
  pw_real largest;              /* stress component at the start; Pa */
} drift;

static pw_real value(const pw_points *p, pw_idx i, int c)
{
  return c < 2 ? p->x[c * p->ld + i] : p->stress[(c - 2) * p->ld + i];
}

/* Values by the points' numbers, [KEPT][n]. */
static void keep(const pw_points *p, pw_real *start)
{
  for (pw_idx i = 0; i < p->n; i++) {
    for (int c = 0; c < KEPT; c++) {
      start[(pw_off)c * p->n + p->id[i]] = value(p, i, c);
    }
  }
}

static drift compare(const pw_points *p, const pw_real *start)
{
  drift d = {0};
  for (pw_idx i = 0; i < p->n; i++) {
    const pw_real *s = start + p->id[i];
    pw_real stress = 0.0, change = 0.0;
    for (int c = 2; c < KEPT; c++) {
      stress = pw_max(stress, fabs(s[(pw_off)c * p->n]));
      change = pw_max(change, fabs(value(p, i, c) - s[(pw_off)c * p->n]));
    }
    if (stress > 0.0) {
      d.moved = pw_max(d.moved, hypot(p->x[i] - s[0], p->x[p->ld + i] - s[p->n]));
      d.speed = pw_max(d.speed, hypot(p->v[i], p->v[p->ld + i]));
      d.stress = pw_max(d.stress, change);
      d.largest = pw_max(d.largest, stress);
    }
  }
  return d;
}

static void print_residual(const pw_sim *sim, FILE *out)
{
  pw_record r;
  pw_sim_results(sim, &r);
  for (int i = 0; i < r.n; i++) {
    if (strcmp(r.item[i].name, "initial_residual_n") == 0) {
      fprintf(out, "residual     %.3g N at most at a free node in the first step", r.item[i].value);
    }
    if (strcmp(r.item[i].name, "initial_residual_relative") == 0) {
      fprintf(out, ", %.3g of the largest nodal weight", r.item[i].value);
    }
  }
  fprintf(out, "\n");
}

pw_status pw_check_equilibrium(pw_sim *sim, FILE *out)
{
  const pw_scene *scene = pw_sim_scene(sim);
  const pw_points *p = pw_sim_points(sim);
  pw_real *start;
  int made = 0;
  if (!pw_scene_find_effect(scene, "initial_stress")) {
    return PW_OK;
  }
  PW_TRY(pw_mem_alloc("points at the start", (pw_off)KEPT * p->n, sizeof(pw_real), &start));
  keep(p, start);
  const int most = scene->method.update == PW_IMPLICIT ? 1 : DRIFT_STEPS;
  while (made < most && pw_sim_time(sim) < scene->time.end_s &&
         pw_sim_step(sim, scene->time.end_s - pw_sim_time(sim)) == PW_OK) {
    made++;
  }
  if (made > 0) {
    drift d = compare(p, start);
    print_residual(sim, out);
    fprintf(out,
            "drift        %.3g m, %.3g m/s, stress by %.3g Pa (%.3g of the largest) at most, after "
            "%d steps under all loads\n",
            d.moved, d.speed, d.stress, d.largest > 0.0 ? d.stress / d.largest : 0.0, made);
  }
  pw_mem_free(&start);
  return PW_OK;
}
