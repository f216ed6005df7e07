/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/summary.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "engine/effect.h"
#include "io/atomic_file.h"

const char *pw_version(void)
{
  return PW_VERSION;
}

const char *pw_git_revision(void)
{
  return PW_GIT_REVISION;
}

/* json_*_set_new accept NULL as a failed value and report it; the first failure is kept in *bad
 * so that the lines below read as the file does. */
static void put(json_t *object, const char *key, json_t *value, bool *bad)
{
  *bad |= json_object_set_new(object, key, value) != 0;
}

static json_t *number(pw_real value)
{
  return isfinite(value) ? json_real(value) : json_null();
}

/* Texts come from scene files: what is not UTF-8 is shown byte by byte. */
static json_t *text(const char *value)
{
  json_t *as_is = json_string(value ? value : "");
  if (as_is) {
    return as_is;
  }
  char plain[1024];
  size_t n = 0;
  for (; value[n] && n + 1 < sizeof plain; n++) {
    plain[n] = (char)((unsigned char)value[n] < 128 ? value[n] : '?');
  }
  plain[n] = '\0';
  return json_string(plain);
}

/* The longest resident set of the process; the kernel counts in kibibytes. */
static json_int_t peak_rss_bytes(void)
{
  struct rusage usage;
  return getrusage(RUSAGE_SELF, &usage) == 0 ? (json_int_t)usage.ru_maxrss * 1024 : 0;
}

static json_t *effects_json(const pw_scene *scene, bool *bad)
{
  json_t *list = json_array();
  for (int i = 0; i < scene->neffect; i++) {
    const char *name = scene->effect[i].type->name;
    bool repeated = i > 0 && strcmp(scene->effect[i - 1].type->name, name) == 0;
    if (!repeated) {
      *bad |= json_array_append_new(list, text(name)) != 0;
    }
  }
  return list;
}

static json_t *stages_json(const pw_report *r, bool *bad)
{
  static const char *const name[PW_TIMER_COUNT] = {
      [PW_TIMER_SORT] = "sort",   [PW_TIMER_P2G] = "p2g",
      [PW_TIMER_NODES] = "nodes", [PW_TIMER_EFFECTS] = "effects",
      [PW_TIMER_REMAP] = "remap", [PW_TIMER_G2P_STRESS] = "g2p_stress",
  };
  json_t *object = json_object();
  for (int i = 0; i < PW_TIMER_COUNT; i++) {
    put(object, name[i], number(r->stage_wall_s[i]), bad);
  }
  return object;
}

/* What came in must be found again: kinetic at the start + work of the loads = kinetic now + work
 * of the stresses + everything dissipated, absorbed or kept in springs. */
static json_t *energy_json(const pw_energy *e, bool *bad)
{
  const pw_real out =
      e->kinetic + e->strain_work + e->contact + e->spring + e->damping + e->absorbed;
  const pw_real error = e->initial + e->external - out;
  const pw_real turnover =
      0.5 * (fabs(e->initial) + fabs(e->external) + fabs(e->kinetic) + fabs(e->strain_work) +
             fabs(e->contact) + fabs(e->spring) + fabs(e->damping) + fabs(e->absorbed));
  json_t *object = json_object();
  put(object, "initial_kinetic_j", number(e->initial), bad);
  put(object, "kinetic_j", number(e->kinetic), bad);
  put(object, "strain_work_j", number(e->strain_work), bad);
  put(object, "external_work_j", number(e->external), bad);
  put(object, "contact_dissipated_j", number(e->contact), bad);
  put(object, "contact_spring_j", number(e->spring), bad);
  put(object, "damping_dissipated_j", number(e->damping), bad);
  put(object, "absorbed_j", number(e->absorbed), bad);
  put(object, "balance_error_j", number(error), bad);
  put(object, "balance_error_relative", number(turnover > 0.0 ? fabs(error) / turnover : 0.0), bad);
  return object;
}

static json_t *counters_json(const pw_report *r, bool *bad)
{
  json_t *object = json_object();
  put(object, "point_updates", json_integer(r->point_updates), bad);
  put(object, "sorts", json_integer(r->sorts), bad);
  put(object, "domains_limited", json_integer(r->domains_limited), bad);
  put(object, "domains_rebuilt", json_integer(r->domains_rebuilt), bad);
  put(object, "domains_reshaped", json_integer(r->domains_reshaped), bad);
  put(object, "vertices_clamped", json_integer(r->vertices_clamped), bad);
  put(object, "material_substeps", json_integer(r->material.substeps), bad);
  put(object, "material_rhs", json_integer(r->material.rhs), bad);
  put(object, "material_rejected", json_integer(r->material.rejected), bad);
  put(object, "material_forced", json_integer(r->material.forced), bad);
  put(object, "material_cut_off", json_integer(r->material.cut_off), bad);
  return object;
}

static json_t *results_json(const pw_record *results, bool *bad)
{
  json_t *object = json_object();
  for (int i = 0; i < results->n; i++) {
    const pw_record_item *item = &results->item[i];
    json_t *value = item->array ? json_array() : number(item->value);
    for (int k = 0; item->array && k < item->count; k++) {
      *bad |= json_array_append_new(value, number(item->array[k])) != 0;
    }
    put(object, item->name, value, bad);
  }
  return object;
}

static json_t *warnings_json(const pw_summary_info *info, bool *bad)
{
  json_t *list = json_array();
  for (int i = 0; i < info->nwarning; i++) {
    *bad |= json_array_append_new(list, text(info->warning[i])) != 0;
  }
  return list;
}

static void put_head(json_t *root, const pw_scene *scene, const pw_summary_info *info, bool *bad)
{
  put(root, "program", text("pilewright"), bad);
  put(root, "version", text(PW_VERSION), bad);
  put(root, "git_revision", text(PW_GIT_REVISION), bad);
  put(root, "scene", text(info->scene_file ? info->scene_file : scene->file), bad);
  put(root, "title", text(scene->title), bad);
  put(root, "status", text(info->status), bad);
  put(root, "error", info->error ? text(info->error) : json_null(), bad);
  put(root, "effects", effects_json(scene, bad), bad);
}

static void put_size_and_time(json_t *root, const pw_report *r, pw_off first_step, bool *bad)
{
  const pw_real work = (pw_real)r->points * (pw_real)(r->steps - first_step);
  put(root, "threads", json_integer(r->threads), bad);
  put(root, "points", json_integer(r->points), bad);
  put(root, "nodes", json_integer(r->nodes), bad);
  put(root, "elements", json_integer(r->elements), bad);
  put(root, "blocks", json_integer(r->blocks), bad);
  put(root, "colours", json_integer(r->colours), bad);
  put(root, "steps", json_integer(r->steps), bad);
  put(root, "first_step", json_integer(first_step), bad);
  put(root, "sim_time_s", number(r->time_s), bad);
  put(root, "wall_s", number(r->wall_s), bad);
  put(root, "point_steps_per_s", number(r->wall_s > 0.0 ? work / r->wall_s : 0.0), bad);
  put(root, "dt_min_s", number(r->dt_min_s), bad);
  put(root, "dt_max_s", number(r->dt_max_s), bad);
  put(root, "peak_rss_bytes", json_integer(peak_rss_bytes()), bad);
  put(root, "bytes_per_point", json_integer(r->bytes_per_point), bad);
}

static void put_implicit_sizes(json_t *root, const pw_implicit_report *r, pw_off first_step,
                               bool *bad)
{
  const pw_real work = (pw_real)r->points * (pw_real)(r->steps - first_step);
  put(root, "threads", json_integer(r->threads), bad);
  put(root, "points", json_integer(r->points), bad);
  put(root, "nodes", json_integer(r->nodes), bad);
  put(root, "cells", json_integer(r->cells), bad);
  put(root, "elements", json_integer(r->elements), bad);
  put(root, "blocks", json_integer(r->blocks), bad);
  put(root, "colours", json_integer(r->colours), bad);
  put(root, "equations", json_integer(r->equations), bad);
  put(root, "matrix_nonzeros", json_integer(r->nonzeros), bad);
  put(root, "steps", json_integer(r->steps), bad);
  put(root, "first_step", json_integer(first_step), bad);
  put(root, "sim_time_s", number(r->time_s), bad);
  put(root, "wall_s", number(r->wall_s), bad);
  put(root, "point_steps_per_s", number(r->wall_s > 0.0 ? work / r->wall_s : 0.0), bad);
  put(root, "peak_rss_bytes", json_integer(peak_rss_bytes()), bad);
  put(root, "bytes_per_point", json_integer(r->bytes_per_point), bad);
}

static json_t *solver_json(const pw_implicit_report *r, bool *bad)
{
  json_t *object = json_object();
  put(object, "description", text(r->solver_text), bad);
  put(object, "iterations", json_integer(r->iterations), bad);
  put(object, "cuts", json_integer(r->cuts), bad);
  put(object, "parts", json_integer(r->parts), bad);
  put(object, "analyses", json_integer(r->solver.analyses), bad);
  put(object, "factorisations", json_integer(r->solver.factors), bad);
  put(object, "indefinite", json_integer(r->solver.indefinite), bad);
  put(object, "factor_nonzeros", json_integer(r->solver.factor_nonzeros), bad);
  return object;
}

static json_t *walk_json(const pw_walk_counts *w, bool *bad)
{
  json_t *object = json_object();
  put(object, "searches", json_integer(w->points), bad);
  put(object, "tests", json_integer(w->tests), bad);
  put(object, "changed_element", json_integer(w->moved), bad);
  put(object, "ties", json_integer(w->ties), bad);
  put(object, "by_bins", json_integer(w->binned), bad);
  return object;
}

static pw_status save(const char *path, const json_t *root)
{
  char *dump = json_dumps(root, JSON_INDENT(2) | JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(15));
  PW_REQUIRE(dump, PW_ERR_MEMORY, "cannot allocate the text of %s", path);
  size_t length = strlen(dump);
  dump[length] = '\n'; /* in place of the closing zero, which is not written */
  pw_status status = pw_atomic_write(path, dump, length + 1);
  free(dump);
  return status;
}

/* Write what was put together, or tell that memory ran out. */
static pw_status finish(const char *path, json_t *root, bool bad)
{
  pw_status status;
  if (root && !bad) {
    status = save(path, root);
  } else {
    status = pw_error_set(PW_ERR_MEMORY, __FILE__, __LINE__, __func__,
                          "cannot allocate the contents of %s", path);
  }
  json_decref(root);
  return status;
}

pw_status pw_summary_write_parts(const char *path, const pw_scene *scene, const pw_report *report,
                                 const pw_record *results, const pw_summary_info *info)
{
  bool bad = false;
  json_t *root = json_object();
  put_head(root, scene, info, &bad);
  put_size_and_time(root, report, info->first_step, &bad);
  put(root, "stage_wall_s", stages_json(report, &bad), &bad);
  put(root, "energy", energy_json(&report->energy, &bad), &bad);
  put(root, "counters", counters_json(report, &bad), &bad);
  put(root, "results", results_json(results, &bad), &bad);
  put(root, "warnings", warnings_json(info, &bad), &bad);
  return finish(path, root, bad);
}

pw_status pw_summary_write(const char *path, const pw_sim *sim, const pw_summary_info *info)
{
  pw_report report;
  pw_record results = {.n = 0};
  pw_sim_report(sim, &report);
  pw_sim_results(sim, &results);
  return pw_summary_write_parts(path, pw_sim_scene(sim), &report, &results, info);
}

pw_status pw_summary_write_implicit(const char *path, const pw_implicit *sim,
                                    const pw_summary_info *info)
{
  bool bad = false;
  pw_implicit_report report;
  pw_record results = {.n = 0};
  json_t *root = json_object();
  pw_implicit_report_now(sim, &report);
  pw_implicit_results(sim, &results);
  put_head(root, pw_implicit_scene(sim), info, &bad);
  put_implicit_sizes(root, &report, info->first_step, &bad);
  put(root, "solver", solver_json(&report, &bad), &bad);
  put(root, "walk", walk_json(&report.walked, &bad), &bad);
  put(root, "results", results_json(&results, &bad), &bad);
  put(root, "warnings", warnings_json(info, &bad), &bad);
  return finish(path, root, bad);
}
