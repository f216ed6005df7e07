/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/check_report.h"

#include <math.h>
#include <string.h>

#include "engine/assemble.h"
#include "engine/core/mem.h"
#include "engine/sim_state.h"
#include "engine/step_implicit.h"
#include "engine/update.h"
#include "io/check_equilibrium.h"
#include "io/output_times.h"
#include "io/progress.h"

enum {
  PASSES = 9,
  GRID_PER_WEIGHTS = 20 /* scatters, gather and nodes over finding the weights: 17 to 25 measured */
};

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

/* A body without points: mass of the whole body, pieces of its surface. */
static void print_structure(const pw_sim *sim, int b, FILE *out)
{
  const pw_structure *s = sim->structure_of[b];
  const pw_scene_material *m = &sim->scene.material[sim->scene.body[b].material];
  pw_real centre[6];
  pw_structure_centre(s, centre);
  fprintf(out, "  %-16s %s of %s, %.6g kg%s, %d pieces of surface", sim->scene.body[b].name,
          s->kind == PW_BODY_ROD ? "elastic rod" : "rigid", m->name, sim->measure * centre[5],
          sim->scene.geometry == PW_AXI ? "" : " per metre", pw_interface_segments(&s->line));
  if (s->kind == PW_BODY_ROD) {
    fprintf(out, ", %d elements", s->rod.n - 1);
  }
  fprintf(out, "\n");
}

static void print_bodies(const pw_sim *sim, const pw_points *points, FILE *out)
{
  const pw_scene *scene = &sim->scene;
  pw_idx count[PW_MAX_BODIES] = {0};

  for (pw_idx i = 0; i < points->n; i++) {
    count[points->body[i]]++;
  }
  fprintf(out, "bodies:\n");
  for (int b = 0; b < scene->nbody; b++) {
    if (sim->structure_of[b]) {
      print_structure(sim, b, out);
      continue;
    }
    const pw_scene_material *m = &scene->material[scene->body[b].material];
    fprintf(out, "  %-16s %7d points of %s (%s)\n", scene->body[b].name, count[b], m->name,
            m->model->name);
  }
}

static void print_grid(const pw_mesh *m, FILE *out)
{
  fprintf(out, "cells        %d x %d", m->cells[0], m->cells[1]);
  if (m->graded) {
    fprintf(out, ", graded from %g m to %g m", m->cell, pw_mesh_largest_cell(m));
    if (m->pair_column < m->cells[0]) {
      fprintf(out, ", rows in pairs from x = %g m on", m->axis[0].node[m->pair_column]);
    }
    fprintf(out, "\n");
  } else {
    fprintf(out, " of %g m\n", m->cell);
  }
}

static void print_sizes(const pw_report *r, FILE *out)
{
  fprintf(out, "points       %d\n", r->points);
  fprintf(out, "nodes        %d\n", r->nodes);
  fprintf(out, "elements     %d\n", r->elements);
  fprintf(out, "blocks       %d, %d colours\n", r->blocks, r->colours);
  fprintf(out, "threads      %d", r->threads);
  if (r->threads > 1) {
    fprintf(out,
            "; the division of the blocks allows %.2f times the speed of one in scatters, %.2f "
            "in gathers and stress",
            r->bound_scatter, r->bound_gather);
  }
  fputc('\n', out);
}

/* Wall clock of a step on an idle machine, without making one: evaluating the stress of all points
 * with a zero increment, and all that goes over the grid as a multiple of finding the weights. Both
 * passes give what is there already. */
static pw_real estimate_step(pw_sim *sim)
{
  pw_real weights = PW_HUGE, stress = PW_HUGE;

  for (int k = 0; k < PASSES; k++) {
    pw_real start = pw_wall_clock();
    pw_for_blocks(&sim->blocks, sim->threads, pw_block_weights, sim);
    pw_real middle = pw_wall_clock();
    pw_for_blocks(&sim->blocks, sim->threads, pw_block_wave_speed, sim);
    weights = pw_min(weights, middle - start);
    stress = pw_min(stress, pw_wall_clock() - middle);
  }
  return stress + GRID_PER_WEIGHTS * weights;
}

static void print_estimates(pw_sim *sim, pw_real first, FILE *out)
{
  char text[32];
  const pw_real end = pw_sim_scene(sim)->time.end_s, steps = ceil(end / first);
  const pw_real wall = estimate_step(sim);

  fprintf(out, "first step   %.4g s\n", first);
  fprintf(out,
          "steps        about %.3g, if all were as long as the first (end at %g s); soil that "
          "stiffens, fast points and a penalty contact shorten them: the shipped cases take 1.1 to "
          "5.3 times as many\n",
          steps, end);
  fprintf(out,
          "time         about %s for these steps without outputs, within a factor of 2 on an idle "
          "machine: %.3g ms each, from the time that stress and weights of the points take now\n",
          pw_duration_text(wall * steps, text, sizeof text), 1e3 * wall);
}

/* Of implicit steps: how many there are, and the system of the first one. */
static void print_load_steps(pw_sim *sim, FILE *out)
{
  const pw_scene_implicit *p = &pw_sim_scene(sim)->solid.implicit;
  const pw_quad_model *m = &sim->quad->model;
  fprintf(out, "load steps   %d of %g s each%s\n", p->steps, sim->dt_next,
          p->adaptive ? " to begin with, then as long as iterations allow" : "");
  if (pw_quad_model_begin(&sim->quad->model) == PW_OK) {
    fprintf(out, "equations    %d, %lld values in a matrix that is %s\n", m->csr.n,
            (long long)m->csr.start[m->csr.n],
            pw_quad_model_is_symmetric(m) ? "symmetric" : "not symmetric");
  }
}

void pw_check_report(pw_sim *sim, FILE *out)
{
  const pw_scene *scene = pw_sim_scene(sim);
  pw_report r;

  pw_sim_report(sim, &r);
  print_effects(scene, sim, out);
  print_fields(pw_sim_points(sim), out);
  print_bodies(sim, pw_sim_points(sim), out);
  print_grid(pw_sim_mesh(sim), out);
  print_sizes(&r, out);
  fprintf(out,
          "memory       %.1f MiB of arrays, beside some 40 MiB of program, libraries and "
          "outputs\n",
          (pw_real)pw_mem_bytes() / 1048576.0);
  if (sim->quad) {
    print_load_steps(sim, out);
  } else {
    print_estimates(sim, r.dt_s, out);
  }
  pw_status status = pw_check_equilibrium(sim, out);
  if (status != PW_OK) {
    fprintf(out, "start        not known: %s\n", pw_error_text());
  }
}
