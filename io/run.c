/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/run.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/progress.h"
#include "io/run_job.h"
#include "io/run_outputs.h"
#include "io/run_signals.h"
#include "io/scene_file.h"
#include "io/solid_mesh.h"
#include "io/summary.h"

/* One run from reading its scene to closing its files. */
typedef struct run {
  const pw_run_options *options;
  FILE *out, *err;
  pw_scene scene;
  pw_job job;
  pw_run_folder folder;
  int lock; /* file descriptor that keeps other runs out of the folder, or -1 */
  pw_run_outputs outputs;
  pw_progress progress;
  bool resumed;
  pw_real wall_first_s; /* wall clock at the start */
  pw_off first_step;    /* made by the run that is gone on with */
} run;

/* Print the last recorded error under a heading and return `code`. */
static pw_exit complain(run *r, pw_exit code, pw_status status)
{
  const char *text = pw_error_text();
  pw_progress_clear(&r->progress);
  fprintf(r->err, "error: %s\n", *text ? text : pw_status_text(status));
  return code;
}

static pw_exit read_scene(run *r)
{
  const pw_run_options *o = r->options;
  char *messages = NULL;
  pw_status status = pw_scene_read_file(o->scene_file, o->nset, o->set, &r->scene, &messages);
  if (status != PW_OK) {
    if (messages && *messages) {
      fputs(messages, r->err);
    } else {
      complain(r, PW_EXIT_SCENE, status);
    }
    fprintf(r->err, "%s: the scene was not run, nothing was written\n", o->scene_file);
  }
  free(messages);
  return status == PW_OK           ? PW_EXIT_FINISHED
         : status == PW_ERR_MEMORY ? PW_EXIT_FAILED
                                   : PW_EXIT_SCENE;
}

/* Decide between starting, starting over and going on, before anything is written. */
static pw_exit choose_folder(run *r)
{
  const pw_run_options *o = r->options;
  pw_status status = pw_run_folder_name(o->out, o->scene_file, &r->folder);
  if (status != PW_OK) {
    return complain(r, PW_EXIT_USAGE, status);
  }
  if (pw_run_folder_holds_run(&r->folder) && !o->force && !o->resume) {
    fprintf(r->err,
            "error: %s holds a run already: --resume goes on with it, --force starts over and "
            "removes it, --out DIR writes elsewhere\n",
            r->folder.path);
    return PW_EXIT_USAGE;
  }
  r->resumed = o->resume && pw_run_folder_holds_checkpoint(&r->folder);
  return PW_EXIT_FINISHED;
}

static pw_job_state state_of(const run *r)
{
  pw_job_state state;
  r->job.kind->state(r->job.sim, &state);
  return state;
}

/* An error of the engine's that begins with the path of a key is shown at its place. */
static pw_exit blame_scene(run *r, pw_status status)
{
  const pw_run_options *o = r->options;
  char *messages = pw_scene_locate(o->scene_file, o->nset, o->set, pw_error_text());
  if (!messages) {
    return complain(r, PW_EXIT_SCENE, status);
  }
  fputs(messages, r->err);
  fprintf(r->err, "%s: the scene was not run, nothing was written\n", o->scene_file);
  free(messages);
  return PW_EXIT_SCENE;
}

static pw_exit create(run *r)
{
  const char *geometry = pw_solid_mesh_geometry(&r->scene);
  if (geometry && !r->options->quiet) {
    fprintf(r->err, "meshing %s ...\n", geometry);
  }
  r->job.kind = pw_job_kind_of(&r->scene);
  pw_status status = r->job.kind->create(&r->scene, r->options->threads, &r->job.sim);
  if (status != PW_OK) {
    bool bad_scene =
        status == PW_ERR_SCENE || status == PW_ERR_ARGUMENT || status == PW_ERR_UNSUPPORTED;
    return bad_scene ? blame_scene(r, status) : complain(r, PW_EXIT_FAILED, status);
  }
  status = pw_run_outputs_prepare(&r->outputs, &r->job, &r->scene);
  if (status != PW_OK) {
    return blame_scene(r, status);
  }
  if (r->resumed) {
    status = pw_archive_read(r->folder.checkpoint, r->job.kind->archive, r->job.sim);
    if (status != PW_OK) {
      complain(r, PW_EXIT_SCENE, status);
      fprintf(r->err, "the run in %s cannot go on from its checkpoint; nothing was changed\n",
              r->folder.path);
      return PW_EXIT_SCENE;
    }
    r->first_step = state_of(r).steps;
  }
  return PW_EXIT_FINISHED;
}

static void print_start(run *r)
{
  const pw_run_options *o = r->options;

  if (o->quiet) {
    return;
  }
  fprintf(r->out, "pilewright %s (%s): %s\n", pw_version(), pw_git_revision(), o->scene_file);
  r->job.kind->print_sizes(r->job.sim, o->bound, r->out);
  if (r->resumed) {
    const pw_job_state state = state_of(r);
    fprintf(r->out, "going on from t = %.6g s, step %lld\n", state.time_s, (long long)state.steps);
  } else if (o->resume) {
    fprintf(r->out, "%s holds no checkpoint: starting from the beginning\n", r->folder.path);
  }
  fflush(r->out);
}

static pw_status open_outputs(run *r)
{
  if (!r->resumed) {
    PW_TRY(pw_run_folder_clear(&r->folder));
  }
  return pw_run_outputs_open(&r->outputs, &r->folder, r->resumed);
}

static bool at_end(const run *r)
{
  pw_real now = state_of(r).time_s;
  return pw_output_due(&r->scene, now, now).end;
}

/* Step until the end, a signal or a failure. */
static pw_status loop(run *r)
{
  pw_job_state now = state_of(r);

  pw_progress_start(&r->progress, r->options->quiet ? NULL : r->out, r->scene.time.end_s,
                    now.points, now.time_s, now.steps);
  while (!at_end(r) && !pw_run_signals_stop()) {
    pw_real old = now.time_s;
    PW_TRY(r->job.kind->step(r->job.sim, pw_output_next(&r->scene, old) - old));
    now = state_of(r);
    PW_TRY(pw_run_outputs_step(&r->outputs, old));
    pw_progress_step(&r->progress, now.time_s, now.steps, now.time_s - old);
  }
  return PW_OK;
}

static void print_warnings(const run *r, FILE *to)
{
  for (int i = 0; i < r->outputs.nwarning; i++) {
    fprintf(to, "warning: %s\n", r->outputs.warning[i]);
  }
}

static void print_results(run *r)
{
  pw_record *results = &r->outputs.row;

  results->n = 0;
  r->job.kind->results(r->job.sim, results);
  for (int i = 0; i < results->n; i++) {
    const pw_record_item *item = &results->item[i];
    fprintf(r->out, "  %-32s", item->name);
    for (int k = 0; item->array && k < item->count; k++) {
      fprintf(r->out, " %.4g", item->array[k]);
    }
    if (!item->array) {
      fprintf(r->out, " %.6g", item->value);
    } else if (item->count == 0) {
      fputs(" none", r->out);
    }
    fputc('\n', r->out);
  }
  print_warnings(r, r->out);
}

static void print_end(run *r, const char *word, bool with_results)
{
  char wall[32];
  const pw_job_state report = state_of(r);
  pw_real made = (pw_real)(report.steps - r->first_step);
  pw_real speed = report.wall_s > 0.0 ? (pw_real)report.points * made / report.wall_s : 0.0;
  pw_progress_clear(&r->progress);
  if (with_results && !r->options->quiet) {
    print_results(r);
  }
  pw_duration_text(pw_wall_clock() - r->wall_first_s, wall, sizeof wall);
  fprintf(r->out, "%s at t = %.6g s, step %lld, after %s, %.2f million point-steps/s: %s\n", word,
          report.time_s, (long long)report.steps, wall, 1e-6 * speed, r->folder.path);
  fflush(r->out);
}

static pw_status write_summary(run *r, const char *word, const char *error)
{
  pw_summary_info info = {
      .status = word,
      .error = error,
      .scene_file = r->options->scene_file,
      .first_step = r->first_step,
      .nwarning = r->outputs.nwarning,
      .warning = r->outputs.warning,
  };
  return r->job.kind->summary(r->folder.summary, r->job.sim, &info);
}

/* The failed state is not saved: the checkpoint on the disk is the last good one. */
static pw_exit fail(run *r, pw_status status)
{
  char text[2 * PW_WARNING_TEXT];
  const char *code = pw_status_text(status), *detail = pw_error_text();
  bool said = strstr(detail, code) != NULL;

  snprintf(text, sizeof text, "%s%s%s", said ? "" : code, said ? "" : ": ", detail);
  pw_progress_clear(&r->progress);
  fprintf(r->err, "error: %s\n", text);
  pw_run_outputs_collect(&r->outputs);
  print_warnings(r, r->err);
  if (write_summary(r, "failed", text) != PW_OK) {
    fprintf(r->err, "no summary: %s\n", pw_error_text());
  }
  if (pw_run_folder_holds_checkpoint(&r->folder)) {
    fprintf(r->err, "the last good checkpoint is %s\n", r->folder.checkpoint);
  }
  print_end(r, "failed", false);
  return PW_EXIT_FAILED;
}

static pw_status finish(run *r, bool stopped)
{
  PW_TRY(stopped ? pw_run_outputs_checkpoint(&r->outputs) : pw_run_outputs_finish(&r->outputs));
  PW_TRY(pw_run_outputs_close(&r->outputs));
  return write_summary(r, stopped ? "stopped" : "finished", NULL);
}

static pw_exit execute(run *r)
{
  if (r->resumed && at_end(r) && pw_run_folder_finished(&r->folder)) {
    print_end(r, "finished before", true);
    return PW_EXIT_FINISHED;
  }
  pw_status status = pw_run_folder_lock(&r->folder, &r->lock);
  if (status == PW_ERR_INTERRUPTED) {
    return complain(r, PW_EXIT_USAGE, status);
  }
  if (status == PW_OK) {
    status = open_outputs(r);
  }
  if (status == PW_OK) {
    status = loop(r);
  }
  bool stopped = !at_end(r);
  if (status == PW_OK) {
    status = finish(r, stopped);
  }
  if (status != PW_OK) {
    return fail(r, status);
  }
  print_end(r, stopped ? "stopped" : "finished", true);
  return stopped ? PW_EXIT_STOPPED : PW_EXIT_FINISHED;
}

pw_exit pw_run(const pw_run_options *options, FILE *out, FILE *err)
{
  run *r = calloc(1, sizeof *r);
  if (!r) {
    fputs("error: out of memory\n", err);
    return PW_EXIT_FAILED;
  }
  r->options = options;
  r->out = out;
  r->err = err;
  r->lock = -1;
  r->wall_first_s = pw_wall_clock();
  pw_exit code = read_scene(r);
  if (code == PW_EXIT_FINISHED) {
    code = choose_folder(r);
  }
  if (code == PW_EXIT_FINISHED) {
    code = create(r);
  }
  if (code == PW_EXIT_FINISHED) {
    print_start(r);
    pw_run_signals_catch();
    code = execute(r);
    pw_run_signals_restore();
  }
  if (r->lock >= 0) {
    close(r->lock);
  }
  pw_run_outputs_close(&r->outputs);
  if (r->job.kind) {
    r->job.kind->destroy(&r->job.sim);
  }
  free(r);
  return code;
}
