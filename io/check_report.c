/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/check_report.h"

#include <math.h>
#include <string.h>

#include "engine/core/mem.h"
#include "engine/effect.h"
#include "io/output_times.h"
#include "io/progress.h"

enum { BURST_STEPS = 200, WARM_UP_STEPS = 3 };

#define BURST_S 1.0

/* Lines of `text`, repeated ones once with their number. */
static void print_lines(char *text, FILE *out)
{
  const char *last = NULL;
  int times = 0;

  for (char *line = strtok(text, "\n");; line = strtok(NULL, "\n")) {
    if (last && line && strcmp(last, line) == 0) {
      times++;
      continue;
    }
    if (last && times > 1) {
      fprintf(out, "  %s, %d times\n", last, times);
    } else if (last) {
      fprintf(out, "  %s\n", last);
    }
    if (!line) {
      return;
    }
    last = line;
    times = 1;
  }
}

static void print_effects(const pw_scene *scene, const pw_sim *sim, FILE *out)
{
  char text[4096] = "";
  size_t used = 0;

  for (int i = 0; i < scene->neffect && used < sizeof text; i++) {
    used += (size_t)snprintf(text + used, sizeof text - used, "%s\n", scene->effect[i].type->name);
  }
  fprintf(out, "effects:%s\n", scene->neffect == 0 ? " none" : "");
  print_lines(text, out);
  pw_sim_schedule_text(sim, text, sizeof text);
  fprintf(out, "hooks, stage by stage, in the order they run in a step:\n");
  print_lines(text, out);
}

static void print_fields(const pw_points *points, FILE *out)
{
  fprintf(out, "fields of a point (%lld bytes):\n", (long long)pw_points_bytes_per_point(points));
  for (int id = 0; id < PW_FIELD_COUNT; id++) {
    pw_field_info f = pw_points_field(points, (pw_field_id)id);
    if (f.array) {
      fprintf(out, "  %-10s %2d x %-4s %-6s %s\n", f.name, f.ncomp, f.is_real ? "real" : "int",
              f.unit, f.meaning);
    }
  }
}

static void print_bodies(const pw_scene *scene, const pw_points *points, FILE *out)
{
  pw_idx count[PW_MAX_BODIES] = {0};

  for (pw_idx i = 0; i < points->n; i++) {
    count[points->body[i]]++;
  }
  fprintf(out, "bodies:\n");
  for (int b = 0; b < scene->nbody; b++) {
    const pw_scene_material *m = &scene->material[scene->body[b].material];
    fprintf(out, "  %-16s %7d points of %s (%s)\n", scene->body[b].name, count[b], m->name,
            m->model->name);
  }
}

static void print_sizes(const pw_report *r, FILE *out)
{
  fprintf(out, "points       %d\n", r->points);
  fprintf(out, "nodes        %d\n", r->nodes);
  fprintf(out, "elements     %d\n", r->elements);
  fprintf(out, "blocks       %d, %d colours\n", r->blocks, r->colours);
  fprintf(out, "threads      %d\n", r->threads);
}

/* Wall clock of a step after a few to warm up, or a negative number when a step failed. */
static pw_real measure_step(pw_sim *sim)
{
  const pw_scene *scene = pw_sim_scene(sim);
  pw_real start = 0.0;
  int made = -WARM_UP_STEPS;

  while (made < BURST_STEPS && (made <= 0 || pw_wall_clock() - start < BURST_S)) {
    pw_real left = scene->time.end_s - pw_sim_time(sim);
    if (left <= 0.0) {
      break;
    }
    if (made == 0) {
      start = pw_wall_clock();
    }
    if (pw_sim_step(sim, left) != PW_OK) {
      return -1.0;
    }
    made++;
  }
  return made > 0 ? (pw_wall_clock() - start) / made : 0.0;
}

void pw_check_report(pw_sim *sim, FILE *out)
{
  const pw_scene *scene = pw_sim_scene(sim);
  char text[32];
  pw_report r;

  pw_sim_report(sim, &r);
  print_effects(scene, sim, out);
  print_fields(pw_sim_points(sim), out);
  print_bodies(scene, pw_sim_points(sim), out);
  print_sizes(&r, out);
  fprintf(out, "memory       %.1f MiB\n", (pw_real)pw_mem_bytes() / 1048576.0);
  pw_real steps = ceil(scene->time.end_s / r.dt_s);
  fprintf(out, "first step   %.4g s\n", r.dt_s);
  fprintf(out, "steps        about %.3g, if all were as long as the first (end at %g s)\n", steps,
          scene->time.end_s);
  pw_real wall = measure_step(sim);
  if (wall < 0.0) {
    fprintf(out, "time         not known, a trial step failed: %s\n", pw_error_text());
  } else {
    fprintf(out,
            "time         about %s without outputs: an estimate from %.3g ms per step, "
            "measured at the start\n",
            pw_duration_text(wall * steps, text, sizeof text), 1e3 * wall);
  }
}
