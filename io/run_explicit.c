/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Explicit simulations for the run loop. */
#include "io/run_job.h"

#include "engine/sim.h"
#include "io/check_report.h"
#include "io/pictures.h"

const pw_job_kind *pw_job_kind_of(const pw_scene *scene)
{
  return scene->geometry == PW_SOLID ? &pw_job_implicit : &pw_job_explicit;
}

static pw_status create(const pw_scene *scene, int threads, void **out)
{
  pw_sim *sim = NULL;
  pw_status status = pw_sim_create(scene, threads, &sim);
  *out = sim;
  return status;
}

static void destroy(void **out)
{
  pw_sim *sim = *out;
  pw_sim_destroy(&sim);
  *out = NULL;
}

static pw_status step(void *sim, pw_real limit_s)
{
  return pw_sim_step(sim, limit_s);
}

static void state(const void *sim, pw_job_state *out)
{
  pw_report report;
  pw_sim_report(sim, &report);
  *out = (pw_job_state){report.time_s, report.steps, report.points, report.wall_s};
}

static void history(const void *sim, pw_record *row)
{
  pw_sim_history(sim, row);
}

static void results(const void *sim, pw_record *out)
{
  pw_sim_results(sim, out);
}

static pw_status archive(pw_archive *ar, void *sim)
{
  return pw_sim_archive(sim, ar);
}

static pw_status summary(const char *path, const void *sim, const pw_summary_info *info)
{
  return pw_summary_write(path, sim, info);
}

static void print_sizes(const void *sim, bool bound, FILE *out)
{
  pw_report report;
  const pw_mesh *mesh = pw_sim_mesh(sim);
  pw_sim_report(sim, &report);
  char sizes[64];
  int used = snprintf(sizes, sizeof sizes, "%g m", mesh->cell);
  if (mesh->graded) {
    snprintf(sizes + used, sizeof sizes - (size_t)used, " to %g m", pw_mesh_largest_cell(mesh));
  }
  fprintf(out, "%d points, %d elements of %s in %d blocks of %d colours, %d thread%s%s\n",
          report.points, report.elements, sizes, report.blocks, report.colours, report.threads,
          report.threads == 1 ? "" : "s", bound ? " bound to cores" : "");
}

static pw_status check(void *sim, FILE *out)
{
  pw_check_report(sim, out);
  return PW_OK;
}

static pw_status snapshot(pw_snapshots *s, const void *sim)
{
  return pw_snapshots_write(s, sim);
}

static pw_status last_snapshot(pw_snapshots *s, const void *sim)
{
  return pw_snapshots_grid(s, sim);
}

static pw_status pictures(const char *folder, const void *sim)
{
  return pw_pictures_fields(folder, sim);
}

const pw_job_kind pw_job_explicit = {
    .create = create,
    .destroy = destroy,
    .step = step,
    .state = state,
    .history = history,
    .results = results,
    .archive = archive,
    .summary = summary,
    .print_sizes = print_sizes,
    .check = check,
    .snapshot = snapshot,
    .last_snapshot = last_snapshot,
    .pictures = pictures,
};
