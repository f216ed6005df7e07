/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/run.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/progress.h"
#include "io/restart.h"
#include "io/run_outputs.h"
#include "io/run_signals.h"
#include "io/scene_file.h"
#include "io/summary.h"

/* One run from reading its scene to closing its files. */
typedef struct run {
  const pw_run_options *options;
  FILE *out, *err;
  pw_scene scene;
  pw_sim *sim;
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

static pw_exit create(run *r)
{
  pw_status status = pw_sim_create(&r->scene, r->options->threads, &r->sim);
  if (status != PW_OK) {
    bool bad_scene = status == PW_ERR_SCENE || status == PW_ERR_ARGUMENT;
    return complain(r, bad_scene ? PW_EXIT_SCENE : PW_EXIT_FAILED, status);
  }
  pw_run_outputs_prepare(&r->outputs, r->sim);
  if (r->resumed) {
    status = pw_restart_read(r->folder.checkpoint, r->sim);
    if (status != PW_OK) {
      complain(r, PW_EXIT_SCENE, status);
      fprintf(r->err, "the run in %s cannot go on from its checkpoint; nothing was changed\n",
              r->folder.path);
      return PW_EXIT_SCENE;
    }
    r->first_step = pw_sim_steps(r->sim);
  }
  return PW_EXIT_FINISHED;
}

static void print_start(run *r)
{
  const pw_run_options *o = r->options;
  pw_report report;

  if (o->quiet) {
    return;
  }
  pw_sim_report(r->sim, &report);
  fprintf(r->out, "pilewright %s (%s): %s\n", pw_version(), pw_git_revision(), o->scene_file);
  const pw_mesh *mesh = pw_sim_mesh(r->sim);
  char sizes[64];
  int used = snprintf(sizes, sizeof sizes, "%g m", mesh->cell);
  if (mesh->graded) {
    snprintf(sizes + used, sizeof sizes - (size_t)used, " to %g m", pw_mesh_largest_cell(mesh));
  }
  fprintf(r->out, "%d points, %d elements of %s in %d blocks of %d colours, %d thread%s%s\n",
          report.points, report.elements, sizes, report.blocks, report.colours, report.threads,
          report.threads == 1 ? "" : "s", o->bound ? " bound to cores" : "");
  if (r->resumed) {
    fprintf(r->out, "going on from t = %.6g s, step %lld\n", report.time_s,
            (long long)report.steps);
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
  pw_real now = pw_sim_time(r->sim);
  return pw_output_due(&r->scene, now, now).end;
}

/* Step until the end, a signal or a failure. */
static pw_status loop(run *r)
{
  pw_real now = pw_sim_time(r->sim);

  pw_progress_start(&r->progress, r->options->quiet ? NULL : r->out, r->scene.time.end_s,
                    pw_sim_points(r->sim)->n, now, pw_sim_steps(r->sim));
  while (!at_end(r) && !pw_run_signals_stop()) {
    pw_real old = now;
    PW_TRY(pw_sim_step(r->sim, pw_output_next(&r->scene, old) - old));
    now = pw_sim_time(r->sim);
    PW_TRY(pw_run_outputs_step(&r->outputs, old));
    pw_progress_step(&r->progress, now, pw_sim_steps(r->sim), now - old);
  }
  return PW_OK;
}

static void print_results(run *r)
{
  pw_record *results = &r->outputs.row;

  results->n = 0;
  pw_sim_results(r->sim, results);
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
  for (int i = 0; i < r->outputs.nwarning; i++) {
    fprintf(r->out, "warning: %s\n", r->outputs.warning[i]);
  }
}

static void print_end(run *r, const char *word, bool with_results)
{
  char wall[32];
  pw_report report;

  pw_sim_report(r->sim, &report);
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
  return pw_summary_write(r->folder.summary, r->sim, &info);
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
  pw_sim_destroy(&r->sim);
  free(r);
  return code;
}
