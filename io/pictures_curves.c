/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/pictures.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/core/mem.h"
#include "engine/core/record.h"
#include "io/pictures_plot.h"

enum {
  WIDTH = 1200,
  HEIGHT = 720,
  LINE_BYTES = PW_RECORD_MAX * 72,
  MAX_CURVES = 8 /* in one picture */
};

/* One column of a history and what its numbers span. */
typedef struct series {
  char name[64];
  pw_real first, lo, hi;
} series;

typedef struct history_file {
  const char *path;
  int n;
  pw_off rows;
  bool solid; /* of a solid scene */
  series column[PW_RECORD_MAX];
  char line[LINE_BYTES];
} history_file;

/* A picture takes the columns whose names end in one of its endings, or begin with its start; those
 * that stay zero are left out. */
typedef struct curve_picture {
  const char *file, *title, *quantity, *unit;
  const char *ending[2], *start;
  bool from_start;  /* draw the change since the first row */
  bool engineering; /* unit with the prefix the size asks for */
  bool over_motion; /* drawn over what drives a solid scene, else over time */
} curve_picture;

static const curve_picture pictures[] = {
    {.file = "penetration.png",
     .title = "Penetration",
     .quantity = "penetration",
     .unit = "m",
     .ending = {"penetration_m"}},
    {.file = "energy.png",
     .title = "Energies",
     .quantity = "energy",
     .unit = "J",
     .ending = {"_j"},
     .engineering = true},
    {.file = "position.png",
     .title = "Displacement of the centres of the bodies",
     .quantity = "displacement",
     .unit = "m",
     .ending = {"_y_m", "_x_m"},
     .from_start = true},
    {.file = "force.png",
     .title = "Forces",
     .quantity = "force",
     .unit = "N",
     .ending = {"_n"},
     .engineering = true},
};

/* Of solid scenes, whose histories have the column "iterations". */
static const curve_picture solid_pictures[] = {
    {.file = "torque.png",
     .title = "Torques",
     .quantity = "torque",
     .unit = "N m",
     .ending = {"_torque_n_m"},
     .engineering = true,
     .over_motion = true},
    {.file = "force.png",
     .title = "Forces of supports and loads",
     .quantity = "force",
     .unit = "N",
     .ending = {"_n"},
     .engineering = true,
     .over_motion = true},
    {.file = "stress.png",
     .title = "Stress",
     .quantity = "stress",
     .unit = "Pa",
     .ending = {"_pa"},
     .engineering = true,
     .over_motion = true},
    {.file = "tracer.png",
     .title = "Displacement of tracers",
     .quantity = "displacement",
     .unit = "m",
     .start = "tracer_",
     .over_motion = true},
    {.file = "iterations.png",
     .title = "Newton iterations",
     .quantity = "in a load step",
     .unit = "-",
     .ending = {"iterations", "cuts"}},
};

/* ---- reading ---- */

static void read_names(history_file *h)
{
  char *rest = h->line, *word;
  while (h->n < PW_RECORD_MAX && (word = strtok_r(rest, ",\n", &rest)) != NULL) {
    series *s = &h->column[h->n++];
    *s = (series){.first = 0.0};
    snprintf(s->name, sizeof s->name, "%.63s", word);
    h->solid = h->solid || strcmp(word, "iterations") == 0;
  }
}

static void read_row(history_file *h)
{
  char *at = h->line;
  for (int k = 0; k < h->n; k++) {
    char *end;
    const pw_real v = strtod(at, &end);
    if (end == at) {
      return;
    }
    series *s = &h->column[k];
    if (h->rows == 0) {
      s->first = s->lo = s->hi = v;
    }
    s->lo = fmin(s->lo, v); /* NaN is passed over */
    s->hi = fmax(s->hi, v);
    at = *end == ',' ? end + 1 : end;
  }
  h->rows++;
}

static pw_status read_history(history_file *h)
{
  FILE *file = fopen(h->path, "r");
  PW_REQUIRE(file, PW_ERR_FILE, "cannot read %s: %s", h->path, strerror(errno));
  if (fgets(h->line, sizeof h->line, file)) {
    read_names(h);
  }
  while (fgets(h->line, sizeof h->line, file)) {
    read_row(h);
  }
  fclose(file);
  PW_REQUIRE(h->n >= 2 && strcmp(h->column[0].name, "time_s") == 0, PW_ERR_FILE,
             "%s: not a history of a run", h->path);
  return PW_OK;
}

/* ---- choosing ---- */

static bool ends_with(const char *name, const char *ending)
{
  size_t a = strlen(name), b = ending ? strlen(ending) : 0;
  return b > 0 && a >= b && strcmp(name + a - b, ending) == 0;
}

static bool named(const curve_picture *what, const char *name)
{
  return ends_with(name, what->ending[0]) || ends_with(name, what->ending[1]) ||
         (what->start && strncmp(name, what->start, strlen(what->start)) == 0);
}

static bool wanted(const curve_picture *what, const series *s)
{
  if (!named(what, s->name)) {
    return false;
  }
  return what->from_start ? s->hi - s->lo > 1e-9 * (fabs(s->hi) + 1.0) : s->hi > 0.0 || s->lo < 0.0;
}

static pw_real size_of(const series *s)
{
  return pw_max(fabs(s->lo), fabs(s->hi));
}

/* Beside large forces those of rounding are left out. */
static int choose(const history_file *h, const curve_picture *what, int *column)
{
  pw_real largest = 0.0;
  int n = 0;
  for (int k = 2; k < h->n; k++) {
    largest = wanted(what, &h->column[k]) ? pw_max(largest, size_of(&h->column[k])) : largest;
  }
  for (int k = 2; k < h->n && n < MAX_CURVES; k++) {
    if (wanted(what, &h->column[k]) && (!h->solid || size_of(&h->column[k]) > 1e-9 * largest)) {
      column[n++] = k;
    }
  }
  return n;
}

/* The column that a picture is drawn over: the angle of a driven boundary, its advance, the first
 * displacement given, or time. */
static int choose_motion(const history_file *h, const curve_picture *what)
{
  static const char *const ending[] = {"driven_angle_deg", "driven_advance_m", "_displacement_x_m",
                                       "_displacement_y_m", "_displacement_z_m"};
  for (size_t i = 0; what->over_motion && i < sizeof ending / sizeof *ending; i++) {
    for (int k = 2; k < h->n; k++) {
      if (ends_with(h->column[k].name, ending[i]) && h->column[k].hi > h->column[k].lo) {
        return k;
      }
    }
  }
  return 0;
}

static pw_real prefix_of(const history_file *h, const int *column, int n, const char **prefix)
{
  pw_real largest = 0.0;
  for (int k = 0; k < n; k++) {
    const series *s = &h->column[column[k]];
    largest = pw_max(largest, size_of(s));
  }
  *prefix = largest >= 1e6 ? "M" : largest >= 1e3 ? "k" : "";
  return largest >= 1e6 ? 1e-6 : largest >= 1e3 ? 1e-3 : 1.0;
}

/* ---- drawing ---- */

/* "strain_work_j" is shown as "strain work", "pile_y_m" as "pile y". */
static void print_label(pw_plot *plot, const char *name)
{
  char text[64];
  snprintf(text, sizeof text, "%s", name);
  char *unit = ends_with(text, "_n_m") ? text + strlen(text) - 4 : strrchr(text, '_');
  if (unit) {
    *unit = '\0';
  }
  for (char *c = text; *c; c++) {
    *c = (char)(*c == '_' ? ' ' : *c);
  }
  pw_plot_text(plot, text);
}

/* "time (s)", "driven angle (deg)", "boundary 3 displacement y (m)". */
static void print_motion(pw_plot *plot, const char *name)
{
  char text[64];
  snprintf(text, sizeof text, "%s", name);
  char *unit = strrchr(text, '_');
  fprintf(plot->script, "set xlabel '");
  for (char *c = text; *c && c != unit; c++) {
    fputc(*c == '_' ? ' ' : *c, plot->script);
  }
  fprintf(plot->script, " (%s)'\n", unit ? unit + 1 : "");
}

static void print_frame(pw_plot *plot, const curve_picture *what, const char *prefix,
                        const char *title)
{
  FILE *f = plot->script;
  fprintf(f,
          "set lmargin at screen 0.11\nset tmargin at screen 0.87\nset bmargin at screen 0.12\n");
  fprintf(f, "set border 3 linewidth 0.8\nset tics out nomirror scale 0.6\n");
  fprintf(f, "set grid linecolor rgb '#d0d0d0' linewidth 0.6 dashtype solid\n");
  fprintf(f, "set ylabel '%s (%s%s)'\n", what->quantity, prefix, what->unit);
  fprintf(f, "set label 1 '%s' at screen 0.11,0.955 left font ',20'\n", what->title);
  fprintf(f, "set label 2 ");
  pw_plot_text(plot, title);
  fprintf(f, " at screen 0.11,0.908 left font ',13' textcolor '#606060' noenhanced\n");
}

/* Colours of Okabe and Ito (2008), told apart by colour-blind readers too. */
static void print_curves(pw_plot *plot, const history_file *h, const curve_picture *what,
                         const int *column, int n, pw_real scale, int motion)
{
  static const char *const colour[MAX_CURVES] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#e69f00", "#56b4e9", "#000000", "#999999"};
  FILE *f = plot->script;
  if (n == 1) {
    fprintf(f, "set rmargin at screen 0.965\nunset key\n");
  } else {
    size_t longest = 20; /* characters of a label, of about 10 pixels, beside 60 for its line */
    for (int k = 0; k < n; k++) {
      const size_t length = strlen(h->column[column[k]].name);
      longest = length > longest ? length : longest;
    }
    fprintf(f, "set rmargin at screen %.3f\n", 1.0 - (60.0 + 10.0 * (pw_real)longest) / WIDTH);
    fprintf(f, "set key outside right top Left reverse noenhanced "
               "samplen 2 spacing 1.3\n");
  }
  fprintf(f, "set datafile separator ','\nset datafile missing 'nan'\nplot ");
  for (int k = 0; k < n; k++) {
    const series *s = &h->column[column[k]];
    if (k == 0) {
      pw_plot_text(plot, h->path);
    } else {
      fprintf(f, ", ''");
    }
    fprintf(
        f, " using %d:(($%d-(%.17g))*%g) skip 1 with lines linewidth 1.4 linecolor rgb '%s' title ",
        motion + 1, column[k] + 1, what->from_start ? s->first : 0.0, scale, colour[k]);
    print_label(plot, s->name);
  }
  fprintf(f, "\n");
}

static pw_status draw(const char *folder, const history_file *h, const curve_picture *what,
                      const char *title)
{
  int column[MAX_CURVES];
  pw_plot plot;
  const char *prefix = "";
  int n = choose(h, what, column);
  if (n == 0) {
    return PW_OK;
  }
  pw_real scale = what->engineering ? prefix_of(h, column, n, &prefix) : 1.0;
  PW_TRY(pw_plot_begin(folder, what->file, WIDTH, HEIGHT, &plot));
  const int motion = choose_motion(h, what);
  print_frame(&plot, what, prefix, title);
  print_motion(&plot, h->column[motion].name);
  print_curves(&plot, h, what, column, n, scale, motion);
  return pw_plot_end(&plot);
}

static pw_status draw_all(const char *folder, history_file *h, const char *title)
{
  PW_TRY(read_history(h));
  const curve_picture *list = h->solid ? solid_pictures : pictures;
  const size_t n = h->solid ? sizeof solid_pictures / sizeof *solid_pictures
                            : sizeof pictures / sizeof *pictures;
  for (size_t k = 0; h->rows > 1 && k < n; k++) {
    PW_TRY(draw(folder, h, &list[k], title));
  }
  return PW_OK;
}

pw_status pw_pictures_curves(const char *folder, const char *history, const char *title)
{
  history_file *h = NULL;
  PW_TRY(pw_make_folder(folder));
  PW_TRY(pw_mem_alloc("history to draw", 1, sizeof *h, &h));
  h->path = history;
  pw_status status = draw_all(folder, h, title);
  pw_mem_free(&h);
  return status;
}
