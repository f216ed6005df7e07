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
  pw_sim_history(o->sim, &o->row);
  return pw_history_append(o->history, &o->row);
}

static pw_status write_due(pw_run_outputs *o, pw_due due)
{
  if (due.history) {
    PW_TRY(write_row(o));
  }
  if (due.snapshot && o->snapshots) {
    PW_TRY(pw_snapshots_write(o->snapshots, o->sim));
  }
  if (due.end && o->snapshots) {
    PW_TRY(pw_snapshots_grid(o->snapshots, o->sim));
  }
  if (due.picture) {
    PW_TRY(warn_of(o, pw_pictures_fields(o->folder->pictures, o->sim)));
  }
  return PW_OK;
}

pw_status pw_run_outputs_checkpoint(pw_run_outputs *o)
{
  if (o->checkpoint_step == pw_sim_steps(o->sim)) {
    return PW_OK;
  }
  PW_TRY(pw_history_sync(o->history));
  PW_TRY(pw_restart_write(o->folder->checkpoint, o->sim));
  o->checkpoint_step = pw_sim_steps(o->sim);
  o->checkpoint_wall_s = pw_wall_clock();
  return PW_OK;
}

static pw_status open_files(pw_run_outputs *o, bool resumed)
{
  const pw_run_folder *f = o->folder;
  pw_status status = PW_OK;

  if (resumed) {
    PW_TRY(pw_history_resume(f->history, &o->header, pw_sim_steps(o->sim), &o->history));
  } else {
    PW_TRY(pw_history_open(f->history, &o->header, &o->history));
  }
  if (pw_sim_scene(o->sim)->output.paraview) {
    status = resumed ? pw_snapshots_resume(f->paraview, pw_sim_time(o->sim), &o->snapshots)
                     : pw_snapshots_open(f->paraview, &o->snapshots);
    if (status == PW_ERR_UNSUPPORTED) {
      status = warn_of(o, status);
    }
  }
  return status;
}

void pw_run_outputs_prepare(pw_run_outputs *o, pw_sim *sim)
{
  o->sim = sim;
  o->header.n = 0;
  pw_sim_history(sim, &o->header);
}

pw_status pw_run_outputs_open(pw_run_outputs *o, const pw_run_folder *folder, bool resumed)
{
  o->folder = folder;
  o->checkpoint_step = resumed ? pw_sim_steps(o->sim) : -1;
  o->checkpoint_wall_s = pw_wall_clock();
  PW_TRY(open_files(o, resumed));
  if (resumed) {
    return PW_OK;
  }
  PW_TRY(write_due(o, pw_output_due(pw_sim_scene(o->sim), -1.0, pw_sim_time(o->sim))));
  return pw_run_outputs_checkpoint(o);
}

pw_status pw_run_outputs_step(pw_run_outputs *o, pw_real old_s)
{
  pw_due due = pw_output_due(pw_sim_scene(o->sim), old_s, pw_sim_time(o->sim));

  PW_TRY(write_due(o, due));
  if (due.checkpoint || due.end || pw_wall_clock() - o->checkpoint_wall_s > CHECKPOINT_WALL_S) {
    return pw_run_outputs_checkpoint(o);
  }
  return PW_OK;
}

pw_status pw_run_outputs_finish(pw_run_outputs *o)
{
  const pw_scene *scene = pw_sim_scene(o->sim);

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
