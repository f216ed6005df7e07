/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implicit simulations of solid scenes for the run loop. */
#include "io/run_job.h"

#include "engine/implicit.h"
#include "io/solid_check.h"
#include "io/solid_mesh.h"
#include "io/solid_pictures.h"
#include "io/solid_snapshot.h"

static pw_status create(const pw_scene *scene, int threads, void **out)
{
  pw_solid_mesh mesh = {.ngroup = 0};
  pw_implicit *sim = NULL;
  pw_status status = pw_solid_mesh_load(scene, &mesh);
  if (status == PW_OK) {
    status = pw_implicit_create(scene, &mesh, threads, &sim);
  }
  pw_solid_mesh_destroy(&mesh);
  *out = sim;
  return status;
}

static void destroy(void **out)
{
  pw_implicit *sim = *out;
  pw_implicit_destroy(&sim);
  *out = NULL;
}

/* Outputs fall between load steps; adaptive steps are cut short for them. */
static pw_status step(void *sim, pw_real limit_s)
{
  return pw_implicit_advance(sim, limit_s);
}

static void state(const void *sim, pw_job_state *out)
{
  pw_implicit_report report;
  pw_implicit_report_now(sim, &report);
  *out = (pw_job_state){report.time_s, report.steps, report.points, report.wall_s};
}

static void history(const void *sim, pw_record *row)
{
  pw_implicit_history(sim, row);
}

static void results(const void *sim, pw_record *out)
{
  pw_implicit_results(sim, out);
}

static pw_status archive(pw_archive *ar, void *sim)
{
  return pw_implicit_archive(sim, ar);
}

static pw_status summary(const char *path, const void *sim, const pw_summary_info *info)
{
  return pw_summary_write_implicit(path, sim, info);
}

static const char *warning(const void *sim, int i)
{
  return pw_implicit_warning(sim, i);
}

static void print_sizes(const void *sim, bool bound, FILE *out)
{
  pw_implicit_report r;
  pw_implicit_report_now(sim, &r);
  fprintf(out,
          "%d points, %d elements in %d cells, %d nodes, %d blocks of %d colours, %d thread%s%s\n",
          r.points, r.elements, r.cells, r.nodes, r.blocks, r.colours, r.threads,
          r.threads == 1 ? "" : "s", bound ? " bound to cores" : "");
}

static pw_status check(void *sim, FILE *out)
{
  return pw_solid_check_report(sim, out);
}

static pw_status snapshot(pw_snapshots *s, const void *sim)
{
  return pw_solid_snapshots_write(s, sim);
}

static pw_status pictures(const char *folder, const void *sim)
{
  return pw_solid_pictures(folder, sim);
}

const pw_job_kind pw_job_implicit = {
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
    .pictures = pictures,
    .warning = warning,
};
