/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/element_run.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/element_path.h"
#include "io/keys.h"
#include "io/run_folder.h"

static const char *const columns[PW_ELEMENT_COLUMNS] = {
    "stage",
    "step",
    "eps_xx",
    "eps_yy",
    "eps_zz",
    "eps_xy",
    "eps_yz",
    "eps_zx",
    "sigma_xx_pa",
    "sigma_yy_pa",
    "sigma_zz_pa",
    "sigma_xy_pa",
    "sigma_yz_pa",
    "sigma_zx_pa",
    "mean_pressure_pa",
    "deviator_q_pa",
    "eps_vol",
    "eps_dev",
    "gamma_xy",
    "lateral_minus_axial_pa",
    "excess_pore_pressure_pa",
    "friction_angle_deg",
    "wave_speed_m_s",
};

const char *pw_element_column(int i)
{
  return columns[i];
}

/** The CSV file under way. */
typedef struct writer {
  FILE *file;
  int nstate, rows;
} writer;

static pw_status write_row(void *ctx, const pw_element_row *row)
{
  writer *w = ctx;
  const pw_element *el = row->el;
  const pw_real *s = el->stress, *e = el->strain;
  pw_real p = -(s[0] + s[1] + s[2]) / 3.0, vol = e[0] + e[1] + e[2], q2 = 0.0, e2 = 0.0;
  for (int c = 0; c < 6; c++) { /* squares of the deviators, shears twice */
    pw_real dev = s[c] + (c < 3 ? p : 0.0), shape = e[c] - (c < 3 ? vol / 3.0 : 0.0);
    q2 += (c < 3 ? 1.0 : 2.0) * dev * dev;
    e2 += (c < 3 ? 1.0 : 2.0) * shape * shape;
  }
  fprintf(w->file, "%d,%d", row->stage, row->step);
  for (int c = 0; c < 6; c++) {
    fprintf(w->file, ",%.12g", el->strain[c]);
  }
  for (int c = 0; c < 6; c++) {
    fprintf(w->file, ",%.12g", el->stress[c]);
  }
  const pw_real rest[] = {p,
                          sqrt(1.5 * q2),
                          vol,
                          sqrt(e2 / 1.5),
                          2.0 * el->strain[3],
                          el->stress[0] - el->stress[1],
                          row->pore_pa,
                          pw_element_friction_angle(el->stress),
                          el->wave_speed};
  for (size_t k = 0; k < sizeof rest / sizeof *rest; k++) {
    fprintf(w->file, ",%.12g", rest[k]);
  }
  for (int k = 0; k < w->nstate; k++) {
    fprintf(w->file, ",%.12g", el->state[k]);
  }
  fputc('\n', w->file);
  w->rows++;
  PW_REQUIRE(!ferror(w->file), PW_ERR_FILE, "the output cannot be written: %s", strerror(errno));
  return PW_OK;
}

static void write_header(writer *w, const pw_material *m)
{
  for (int k = 0; k < PW_ELEMENT_COLUMNS; k++) {
    fprintf(w->file, "%s%s", k ? "," : "", columns[k]);
  }
  for (int k = 0; k < w->nstate; k++) {
    fprintf(w->file, ",%s", m->states[k].name);
  }
  fputc('\n', w->file);
}

/** Read the strain paths; relative names are beside the test's file. */
static pw_status read_paths(pw_element_test *t, pw_element_path *path)
{
  for (int i = 0; i < t->nstage; i++) {
    pw_element_stage *g = &t->stage[i];
    char file[PW_PATH];
    if (g->kind != PW_STAGE_PATH) {
      continue;
    }
    const char *slash = g->file[0] == '/' ? NULL : strrchr(t->file, '/');
    int folder = slash ? (int)(slash + 1 - t->file) : 0;
    snprintf(file, sizeof file, "%.*s%s", folder, t->file, g->file);
    PW_TRY(pw_element_path_read(file, &path[i]));
    g->npath = path[i].n;
    g->path = (const pw_real(*)[9])path[i].row;
  }
  return PW_OK;
}

static pw_exit complain(FILE *err, pw_exit code, pw_status status)
{
  fprintf(err, "error: %s\n", *pw_error_text() ? pw_error_text() : pw_status_text(status));
  return code;
}

/** Run the test into the file; rows before a failed step are kept. */
static pw_status write_csv(const pw_element_test *t, const char *path, int *rows)
{
  char temp[PW_PATH];
  writer w = {.nstate = t->material.model->nstate(t->material.param)};
  PW_TRY(pw_atomic_temp(path, temp));
  w.file = fopen(temp, "w");
  PW_REQUIRE(w.file, PW_ERR_FILE, "cannot write %s: %s", temp, strerror(errno));
  write_header(&w, t->material.model);
  pw_status status = pw_element_test_run(t, write_row, &w);
  bool whole = fclose(w.file) == 0;
  *rows = w.rows;
  if (!whole || w.rows == 0) {
    unlink(temp);
    PW_TRY(status);
    return pw_error_set(PW_ERR_FILE, __FILE__, __LINE__, __func__, "cannot write %s: %s", temp,
                        strerror(errno));
  }
  if (status != PW_OK) { /* the reason stays on record when the rows are safe */
    return rename(temp, path) == 0 ? status : PW_ERR_FILE;
  }
  return pw_atomic_commit(temp, path);
}

static pw_exit run_test(const pw_element_test *t, const pw_run_folder *folder, FILE *out, FILE *err)
{
  char csv[PW_PATH];
  int rows = 0;
  pw_status status = pw_path_join(folder->path, "element.csv", csv);
  status = status == PW_OK ? pw_make_folder(folder->path) : status;
  if (status != PW_OK) {
    return complain(err, PW_EXIT_FAILED, status);
  }
  status = write_csv(t, csv, &rows);
  if (status != PW_OK) {
    complain(err, PW_EXIT_FAILED, status);
    fprintf(err, "%s: %d rows before that are in %s\n", t->file, rows, csv);
    return PW_EXIT_FAILED;
  }
  fprintf(out, "%s: %d rows in %s\n", t->file, rows, csv);
  if (t->pictures && rows > 1) {
    status = pw_element_curves(folder->pictures, csv, t);
    if (status == PW_ERR_UNSUPPORTED) {
      fprintf(err, "warning: %s\n", pw_error_text());
    } else if (status != PW_OK) {
      return complain(err, PW_EXIT_FAILED, status);
    } else {
      fprintf(out, "curves in %s\n", folder->pictures);
    }
  }
  return PW_EXIT_FINISHED;
}

pw_exit pw_element_main(const pw_element_options *o, FILE *out, FILE *err)
{
  char *messages = NULL;
  pw_run_folder folder;
  pw_exit code = PW_EXIT_SCENE;
  pw_element_test *t = calloc(1, sizeof *t);
  pw_status status =
      t ? pw_element_read(o->test_file, o->nset, o->set, t, &messages) : PW_ERR_MEMORY;
  if (status != PW_OK && messages && *messages) {
    fputs(messages, err);
    fprintf(err, "%s: the test was not run, nothing was written\n", o->test_file);
  } else if (status != PW_OK) {
    code = complain(err, status == PW_ERR_MEMORY ? PW_EXIT_FAILED : PW_EXIT_SCENE, status);
  } else if ((status = pw_run_folder_name(o->out, o->test_file, &folder)) != PW_OK) {
    code = complain(err, PW_EXIT_USAGE, status);
  } else if (pw_run_folder_holds_run(&folder)) {
    fprintf(err, "error: %s holds a run; --out DIR writes elsewhere\n", folder.path);
    code = PW_EXIT_USAGE;
  } else {
    pw_element_path path[PW_MAX_STAGES] = {{0, NULL}};
    status = read_paths(t, path);
    code = status == PW_OK ? run_test(t, &folder, out, err) : complain(err, PW_EXIT_SCENE, status);
    for (int i = 0; i < PW_MAX_STAGES; i++) {
      pw_element_path_free(&path[i]);
    }
  }
  free(messages);
  free(t);
  return code;
}

void pw_element_keys_print(FILE *out)
{
  fprintf(out, "Keys of an element test. Numbers in SI units; materials: as in a scene "
               "(pilewright keys).\n");
  pw_keys_print_table(out, "top level", NULL, pw_element_keys_top);
  pw_keys_print_table(out, "element:", NULL, pw_element_keys);
  pw_keys_print_table(out, "stages: (a list)", "one after another", pw_element_keys_stage);
}
