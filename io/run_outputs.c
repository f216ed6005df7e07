/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/run_outputs.h"

#include <stdio.h>
#include <string.h>

#include "io/pictures.h"
#include "io/progress.h"
#include "io/restart.h"

#define CHECKPOINT_WALL_S 30.0

void pw_run_outputs_warn(pw_run_outputs *o, const char *text)
{
  char *slot = o->text[o->nwarning < PW_WARNINGS ? o->nwarning : 0];

  for (int i = 0; i < o->nwarning; i++) {
    if (strncmp(o->text[i], text, PW_WARNING_TEXT - 1) == 0) {
      return;
    }
  }
  if (o->nwarning < PW_WARNINGS) {
    snprintf(slot, PW_WARNING_TEXT, "%s", text);
    o->warning[o->nwarning++] = slot;
  }
}

void pw_run_outputs_collect(pw_run_outputs *o)
{
  const char *text;
  for (int i = 0; o->job->kind->warning && (text = o->job->kind->warning(o->job->sim, i)); i++) {
    pw_run_outputs_warn(o, text);
  }
}

/* What could not be drawn is worth a warning, not the run. */
static pw_status warn_of(pw_run_outputs *o, pw_status s)
{
  if (s == PW_ERR_UNSUPPORTED || s == PW_ERR_FILE) {
    pw_run_outputs_warn(o, pw_error_text());
    return PW_OK;
  }
  return s;
}

static pw_status write_row(pw_run_outputs *o)
{
  o->row.n = 0;
  o->job->kind->history(o->job->sim, &o->row);
  return pw_history_append(o->history, &o->row);
}

static pw_job_state state_of(const pw_run_outputs *o)
{
  pw_job_state state;
  o->job->kind->state(o->job->sim, &state);
  return state;
}

static pw_status write_due(pw_run_outputs *o, pw_due due)
{
  const pw_job_kind *kind = o->job->kind;
  if (due.history) {
    PW_TRY(write_row(o));
  }
  if (due.snapshot && o->snapshots) {
    PW_TRY(kind->snapshot(o->snapshots, o->job->sim));
  }
  if (due.end && o->snapshots && kind->last_snapshot) {
    PW_TRY(kind->last_snapshot(o->snapshots, o->job->sim));
  }
  if (due.picture) {
    PW_TRY(warn_of(o, kind->pictures(o->folder->pictures, o->job->sim)));
  }
  return PW_OK;
}

pw_status pw_run_outputs_checkpoint(pw_run_outputs *o)
{
  const pw_job_state now = state_of(o);
  if (o->checkpoint_step == now.steps) {
    return PW_OK;
  }
  pw_restart_stamp stamp = {.time_s = now.time_s, .step = now.steps};
  snprintf(stamp.title, sizeof stamp.title, "%s", o->scene->title);
  PW_TRY(pw_history_sync(o->history));
  PW_TRY(pw_archive_write(o->folder->checkpoint, &stamp, o->job->kind->archive, o->job->sim));
  o->checkpoint_step = now.steps;
  o->checkpoint_wall_s = pw_wall_clock();
  return PW_OK;
}

static pw_status open_files(pw_run_outputs *o, bool resumed)
{
  const pw_run_folder *f = o->folder;
  pw_status status = PW_OK;

  if (resumed) {
    PW_TRY(pw_history_resume(f->history, &o->header, state_of(o).steps, &o->history));
  } else {
    PW_TRY(pw_history_open(f->history, &o->header, &o->history));
  }
  if (o->scene->output.paraview) {
    status = resumed ? pw_snapshots_resume(f->paraview, state_of(o).time_s, &o->snapshots)
                     : pw_snapshots_open(f->paraview, &o->snapshots);
    if (status == PW_ERR_UNSUPPORTED) {
      status = warn_of(o, status);
    }
  }
  return status;
}

pw_status pw_run_outputs_prepare(pw_run_outputs *o, const pw_job *job, const pw_scene *scene)
{
  o->job = job;
  o->scene = scene;
  o->header.n = 0;
  job->kind->history(job->sim, &o->header);
  PW_REQUIRE(o->header.asked <= PW_RECORD_MAX, PW_ERR_SCENE,
             "history.csv would have %d columns, at most %d can be written: fewer bodies, boundary "
             "or other sections are needed",
             o->header.asked, PW_RECORD_MAX);
  job->kind->results(job->sim, &o->row);
  PW_REQUIRE(o->row.asked <= PW_RECORD_MAX, PW_ERR_SCENE,
             "summary.json would have %d results, at most %d can be written: fewer bodies or other "
             "sections are needed",
             o->row.asked, PW_RECORD_MAX);
  return PW_OK;
}

static void warn_of_pictures(pw_run_outputs *o)
{
  const pw_reals *times = &o->scene->output.picture_times_s;
  for (int i = 0; i < times->n && o->scene->output.pictures; i++) {
    char text[PW_WARNING_TEXT];
    if (times->v[i] > (1.0 + 1e-9) * o->scene->time.end_s) {
      snprintf(text, sizeof text, "no picture at %g s: the run ends at %g s", times->v[i],
               o->scene->time.end_s);
      pw_run_outputs_warn(o, text);
    }
  }
}

pw_status pw_run_outputs_open(pw_run_outputs *o, const pw_run_folder *folder, bool resumed)
{
  o->folder = folder;
  o->checkpoint_step = resumed ? state_of(o).steps : -1;
  o->checkpoint_wall_s = pw_wall_clock();
  PW_TRY(open_files(o, resumed));
  warn_of_pictures(o);
  if (resumed) {
    return PW_OK;
  }
  PW_TRY(write_due(o, pw_output_due(o->scene, -1.0, state_of(o).time_s)));
  return pw_run_outputs_checkpoint(o);
}

pw_status pw_run_outputs_step(pw_run_outputs *o, pw_real old_s)
{
  pw_due due = pw_output_due(o->scene, old_s, state_of(o).time_s);

  pw_run_outputs_collect(o);
  PW_TRY(write_due(o, due));
  if (due.checkpoint || due.end || pw_wall_clock() - o->checkpoint_wall_s > CHECKPOINT_WALL_S) {
    return pw_run_outputs_checkpoint(o);
  }
  return PW_OK;
}

pw_status pw_run_outputs_finish(pw_run_outputs *o)
{
  const pw_scene *scene = o->scene;

  if (scene->output.pictures) {
    PW_TRY(warn_of(o, pw_pictures_finish(o->folder->pictures)));
    PW_TRY(warn_of(o, pw_pictures_curves(o->folder->pictures, o->folder->history, scene->title)));
  }
  return pw_run_outputs_checkpoint(o);
}

pw_status pw_run_outputs_close(pw_run_outputs *o)
{
  pw_snapshots_close(&o->snapshots);
  return pw_history_close(&o->history);
}
