/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Curves of element tests, drawn by gnuplot from the CSV file. */
#include "io/element_run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/pictures_plot.h"

enum { WIDTH = 1000, HEIGHT = 760, FIELDS = PW_ELEMENT_COLUMNS + PW_MAX_STATE };

/** A picture: two columns, their factors and labels. */
typedef struct curve {
  const char *file, *title;
  const char *x, *y; /* columns */
  pw_real x_scale, y_scale;
  const char *x_label, *y_label;
  bool log_x;
} curve;

static const curve curves[] = {
    {"q_p", "Stress path", "mean_pressure_pa", "deviator_q_pa", 1e-3, 1e-3, "p (kPa)", "q (kPa)",
     false},
    {"q_strain", "Deviator over strain", "eps_dev", "deviator_q_pa", 100, 1e-3,
     "deviatoric strain (%)", "q (kPa)", false},
    {"axial", "Axial stress over axial strain", "eps_yy", "sigma_yy_pa", -100, -1e-3,
     "axial strain, shortening (%)", "axial stress, compression (kPa)", false},
    {"volume", "Volume over strain", "eps_dev", "eps_vol", 100, 100, "deviatoric strain (%)",
     "volume strain, swelling (%)", false},
    {"e_log_p", "Compression", "mean_pressure_pa", "void_ratio", 1e-3, 1, "p (kPa)",
     "void ratio (-)", true},
    {"volume_log_p", "Compression", "mean_pressure_pa", "eps_vol", 1e-3, 100, "p (kPa)",
     "volume strain, swelling (%)", true},
    {"shear", "Simple shear", "gamma_xy", "sigma_xy_pa", 100, 1e-3, "shear strain (%)",
     "shear stress (kPa)", false},
    {"shear_path", "Simple shear", "sigma_yy_pa", "sigma_xy_pa", -1e-3, 1e-3,
     "normal stress, compression (kPa)", "shear stress (kPa)", false},
    {"pore_pressure", "Excess pore pressure", "eps_dev", "excess_pore_pressure_pa", 100, 1e-3,
     "deviatoric strain (%)", "excess pore pressure (kPa)", false},
};

/** Range of every column of the file. */
typedef struct ranges {
  pw_real lo[FIELDS], hi[FIELDS];
  int n;
} ranges;

static pw_status read_ranges(const char *csv, ranges *r)
{
  static const int line_bytes = 4096;
  char *line = malloc((size_t)line_bytes);
  FILE *file = line ? fopen(csv, "r") : NULL;
  bool first = true;
  if (!file) {
    free(line);
    return pw_error_set(PW_ERR_FILE, __FILE__, __LINE__, __func__, "cannot read %s", csv);
  }
  if (fgets(line, line_bytes, file)) { /* the header */
    while (fgets(line, line_bytes, file)) {
      char *at = line, *end = line;
      for (int k = 0; k < r->n; k++, at = *end == ',' ? end + 1 : end) {
        pw_real v = strtod(at, &end);
        r->lo[k] = first || v < r->lo[k] ? v : r->lo[k];
        r->hi[k] = first || v > r->hi[k] ? v : r->hi[k];
      }
      first = false;
    }
  }
  fclose(file);
  free(line);
  return PW_OK;
}

/** Column of that name, or -1. */
static int column_of(const pw_element_test *t, int nstate, const char *name)
{
  for (int k = 0; k < PW_ELEMENT_COLUMNS; k++) {
    if (strcmp(pw_element_column(k), name) == 0) {
      return k;
    }
  }
  for (int k = 0; k < nstate; k++) {
    if (strcmp(t->material.model->states[k].name, name) == 0) {
      return PW_ELEMENT_COLUMNS + k;
    }
  }
  return -1;
}

static void print_plot(pw_plot *plot, const curve *c, int x, int y, const char *csv)
{
  FILE *f = plot->script;
  fprintf(f, "set border 3 linewidth 0.8\nset tics out nomirror scale 0.6\nunset key\n");
  fprintf(f, "set grid linecolor rgb '#d0d0d0' linewidth 0.6 dashtype solid\n");
  fprintf(f, "set lmargin at screen 0.13\nset rmargin at screen 0.96\n");
  fprintf(f, "set tmargin at screen 0.87\nset bmargin at screen 0.13\n");
  fprintf(f, "set xlabel '%s'\nset ylabel '%s'\n", c->x_label, c->y_label);
  fprintf(f, "set datafile separator ','\n%s", c->log_x ? "set logscale x\n" : "");
  fprintf(f, "plot ");
  pw_plot_text(plot, csv);
  fprintf(f, " using ($%d*%g):($%d*%g) skip 1 with lines linewidth 1.6 linecolor rgb '#0072b2'\n",
          x + 1, c->x_scale, y + 1, c->y_scale);
}

static pw_status draw(const char *folder, const char *csv, const pw_element_test *t, const curve *c,
                      const int *column)
{
  static const char *const ending[] = {"png", "svg"};
  for (int k = 0; k < 2; k++) {
    char name[PW_NAME];
    pw_plot plot;
    snprintf(name, sizeof name, "%s.%s", c->file, ending[k]);
    PW_TRY(pw_plot_begin(folder, name, WIDTH, HEIGHT, &plot));
    fprintf(plot.script, "set label 1 '%s' at screen 0.13,0.955 left font ',20'\nset label 2 ",
            c->title);
    pw_plot_text(&plot, *t->title ? t->title : t->material.name);
    fprintf(plot.script, " at screen 0.13,0.908 left font ',13' textcolor '#606060' noenhanced\n");
    print_plot(&plot, c, column[0], column[1], csv);
    PW_TRY(pw_plot_end(&plot));
  }
  return PW_OK;
}

pw_status pw_element_curves(const char *folder, const char *csv, const pw_element_test *t)
{
  const int nstate = t->material.model->nstate(t->material.param);
  ranges r = {.n = PW_ELEMENT_COLUMNS + nstate};
  PW_TRY(read_ranges(csv, &r));
  PW_TRY(pw_make_folder(folder));
  for (size_t i = 0; i < sizeof curves / sizeof *curves; i++) {
    const curve *c = &curves[i];
    int column[2] = {column_of(t, nstate, c->x), column_of(t, nstate, c->y)};
    bool drawn = column[0] >= 0 && column[1] >= 0;
    for (int k = 0; drawn && k < 2; k++) { /* a constant is no curve */
      pw_real lo = r.lo[column[k]], hi = r.hi[column[k]];
      drawn = hi - lo > 1e-9 * (fabs(hi) + fabs(lo)) && (k == 1 || !c->log_x || lo > 0.0);
    }
    if (drawn && hypot(r.hi[column[0]], r.lo[column[0]]) > 0.0) {
      PW_TRY(draw(folder, csv, t, c, column));
    }
  }
  return PW_OK;
}
