/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/pictures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/core/mem.h"
#include "io/output_times.h"
#include "io/pictures_plot.h"
#include "io/pictures_series.h"
#include "io/point_values.h"

enum {
  CANVAS = 1200,   /* longest side of a picture; pixels */
  NARROWEST = 800, /* room for the title */
  LEFT = 125,
  RIGHT = 190,
  TOP = 104,
  BOTTOM = 90, /* margins; pixels */
  BAR = 34,
  BAR_GAP = 24, /* colour bar: thickness, distance from the axes */
  LOW = 240,    /* a plot less high has its colour bar below */
  NARROW = 120, /* a plot less wide has one number below */
  BELOW = 110,  /* room for it */
  OUTLINE_POINTS = 16384,
  OUTLINES = 16
};

typedef struct picture picture;

/* One quantity to draw. */
typedef struct quantity {
  const char *file;  /* start of the file's name */
  const char *title; /* with a capital */
  const char *unit;  /* NULL: a stress, whose unit follows from its size */
  pw_real (*value)(const picture *c, pw_idx i);
} quantity;

struct picture {
  const pw_sim *sim;
  const pw_scene *scene;
  const pw_points *p;
  const quantity *what;
  bool soil_only; /* other bodies are grey */
  int decimals;   /* of times */
  pw_state_column void_ratio;
  pw_real x[2], y[2];        /* window; m */
  int width, height, px, py; /* canvas and plot area; pixels */
  pw_real range[2];          /* colour range of these data; SI */
  pw_real *value;            /* [n] of the points */
  pw_real *work;             /* [n] values, then outlines */
};

/* ---- quantities ---- */

static pw_real stress_yy(const picture *c, pw_idx i)
{
  return c->p->stress[c->p->ld + i];
}

static pw_real stress_xx(const picture *c, pw_idx i)
{
  return c->p->stress[i];
}

static pw_real mean_stress(const picture *c, pw_idx i)
{
  const pw_points *p = c->p;
  return (p->stress[i] + p->stress[p->ld + i] + p->stress[2 * (pw_off)p->ld + i]) / 3.0;
}

static pw_real speed(const picture *c, pw_idx i)
{
  return hypot(c->p->v[i], c->p->v[c->p->ld + i]);
}

static pw_real void_ratio(const picture *c, pw_idx i)
{
  return pw_point_state(c->p, &c->void_ratio, i);
}

static pw_real friction_angle(const picture *c, pw_idx i)
{
  return pw_point_angle_deg(c->scene, c->p, i);
}

static bool has_void_ratio(picture *c)
{
  pw_state_column column[PW_MAX_STATE_COLUMNS];
  int n = pw_state_columns(c->scene, column);
  for (int k = 0; k < n; k++) {
    if (strcmp(column[k].name, "void_ratio") == 0) {
      c->void_ratio = column[k];
      return true;
    }
  }
  return false;
}

static bool has_soil(const pw_scene *scene)
{
  bool found = false;
  for (int b = 0; b < scene->nbody; b++) {
    found = found || pw_body_has_angle(scene, b);
  }
  return found;
}

/* ---- window, sizes ---- */

static bool coloured(const picture *c, pw_idx i)
{
  return !c->soil_only || pw_body_has_angle(c->scene, c->p->body[i]);
}

/* Domain of a point; without one a square of its volume. */
static void corners(const picture *c, pw_idx i, pw_real *xy)
{
  static const pw_real s[8] = {-1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0};
  const pw_points *p = c->p;
  if (pw_points_have_domains(p)) {
    pw_point_corners(p, i, xy);
    return;
  }
  pw_real area = c->scene->geometry == PW_AXI ? p->vol[i] / p->x[i] : p->vol[i];
  for (int k = 0; k < 8; k++) {
    xy[k] = p->x[(pw_off)(k % 2) * p->ld + i] + 0.5 * s[k] * sqrt(area);
  }
}

static bool in_window(const picture *c, const pw_real *xy)
{
  pw_real lo[2] = {xy[0], xy[1]}, hi[2] = {xy[0], xy[1]};
  for (int k = 2; k < 8; k++) {
    lo[k % 2] = pw_min(lo[k % 2], xy[k]);
    hi[k % 2] = pw_max(hi[k % 2], xy[k]);
  }
  return hi[0] >= c->x[0] && lo[0] <= c->x[1] && hi[1] >= c->y[0] && lo[1] <= c->y[1];
}

static void choose_window(picture *c)
{
  const pw_mesh *m = pw_sim_mesh(c->sim);
  const pw_real *x = c->scene->output.picture_x_m, *y = c->scene->output.picture_y_m;
  const bool own_x = x[1] > x[0], own_y = y[1] > y[0];
  for (int k = 0; k < 2; k++) {
    c->x[k] = own_x ? x[k] : k == 0 ? m->origin[0] : pw_mesh_end(m, 0);
    c->y[k] = own_y ? y[k] : k == 0 ? m->origin[1] : pw_mesh_end(m, 1);
  }
}

static bool bar_below(const picture *c)
{
  return c->py < LOW;
}

/* The largest plot with equal axes that fits the canvas. */
static void choose_size(picture *c)
{
  const pw_real aspect = (c->y[1] - c->y[0]) / (c->x[1] - c->x[0]);
  const pw_real room_x = CANVAS - LEFT - RIGHT, room_y = CANVAS - TOP - BOTTOM;
  const pw_real px = pw_min(room_x, room_y / aspect);
  c->px = (int)pw_max(px, 20.0);
  c->py = (int)pw_max(px * aspect, 20.0);
  c->width = c->px + LEFT + RIGHT < NARROWEST ? NARROWEST : c->px + LEFT + RIGHT;
  c->height = c->py + TOP + BOTTOM + (bar_below(c) ? BELOW : 0);
}

/* ---- values ---- */

/* Every point gets the mean, by volume, of the coloured points of its cell. */
static pw_status share_in_cells(picture *c)
{
  const pw_mesh *m = pw_sim_mesh(c->sim);
  pw_real *sum = NULL; /* [2 nelem] */
  PW_TRY(pw_mem_alloc("pictures: cells", 2 * (pw_off)m->nelem, sizeof *sum, &sum));
  for (int pass = 0; pass < 2; pass++) {
    for (pw_idx i = 0; i < c->p->n; i++) {
      const pw_real x[2] = {c->p->x[i], c->p->x[c->p->ld + i]};
      const pw_idx cell = pw_mesh_locate(m, x);
      if (cell < 0 || !coloured(c, i) || !isfinite(c->value[i])) {
        continue;
      }
      pw_real *at = sum + 2 * (pw_off)cell;
      if (pass == 0) {
        at[0] += c->p->vol[i] * c->value[i];
        at[1] += c->p->vol[i];
      } else {
        c->value[i] = at[0] / at[1];
      }
    }
  }
  pw_mem_free(&sum);
  return PW_OK;
}

static pw_status find_values(picture *c)
{
  for (pw_idx i = 0; i < c->p->n; i++) {
    c->value[i] = c->what->value(c, i);
  }
  return c->scene->output.picture_cell_mean ? share_in_cells(c) : PW_OK;
}

/* ---- colour range ---- */

static int ascending(const void *a, const void *b)
{
  const pw_real x = *(const pw_real *)a, y = *(const pw_real *)b;
  return (x > y) - (x < y);
}

/* The range covers all but the outermost hundredth of the values on each side, so that a few
 * points at a corner do not take the colours from the rest. */
static void choose_range(picture *c)
{
  pw_real xy[8];
  size_t n = 0;
  for (pw_idx i = 0; i < c->p->n; i++) {
    corners(c, i, xy);
    const pw_real v = c->value[i];
    if (coloured(c, i) && isfinite(v) && in_window(c, xy)) {
      c->work[n++] = v;
    }
  }
  c->range[0] = c->range[1] = 0.0;
  if (n > 0) {
    qsort(c->work, n, sizeof *c->work, ascending);
    c->range[0] = c->work[n / 100];
    c->range[1] = c->work[n - 1 - n / 100];
  }
}

/* ---- script ---- */

static void print_data(const picture *c, FILE *f, bool colour)
{
  pw_real xy[8];
  fprintf(f, "$%s << END\n", colour ? "field" : "other");
  for (pw_idx i = 0; i < c->p->n; i++) {
    const pw_real v = colour ? c->value[i] : 0.0;
    corners(c, i, xy);
    if (coloured(c, i) != colour || !isfinite(v) || !in_window(c, xy)) {
      continue;
    }
    for (int k = 0; k < 4; k++) {
      fprintf(f, "%.6g %.6g %.6g\n", xy[2 * k], xy[2 * k + 1], v);
    }
    fprintf(f, "\n");
  }
  fprintf(f, "END\n");
}

static void print_line(const picture *c, FILE *f, int count)
{
  for (int k = 0; k < count; k++) {
    fprintf(f, "%.6g %.6g\n", c->work[2 * k], c->work[2 * k + 1]);
  }
  fprintf(f, "\n");
}

static int print_structures(const picture *c, FILE *f)
{
  int n = 0;
  fprintf(f, "$structure << END\n");
  for (int b = 0; b < c->scene->nbody; b++) {
    int count = pw_sim_structure_outline(c->sim, b, c->work, OUTLINE_POINTS);
    n += count > 0;
    print_line(c, f, count);
  }
  fprintf(f, "END\n");
  return n;
}

static int print_outlines(const picture *c, FILE *f)
{
  int n = 0;
  fprintf(f, "$outline << END\n");
  for (; n < OUTLINES; n++) {
    int count = pw_sim_outline(c->sim, n, c->work, OUTLINE_POINTS);
    if (count <= 0) {
      break;
    }
    print_line(c, f, count);
  }
  fprintf(f, "END\n");
  return n;
}

/* The viridis map of S. van der Walt and N. Smith (2015) at eight equal steps. */
static void print_palette(FILE *f)
{
  fprintf(f, "set palette defined (0 '#440154', 1 '#472d7b', 2 '#3b528b', 3 '#2c728e', "
             "4 '#21918c', 5 '#28ae80', 6 '#5ec962', 7 '#addc30', 8 '#fde725')\n");
}

static void print_bar(const picture *c, FILE *f)
{
  const pw_real w = c->width, h = c->height;
  if (bar_below(c)) {
    fprintf(f, "set colorbox horizontal user origin %g,%g size %g,%g\n", LEFT / w, 75.0 / h,
            c->px / w, BAR / h);
    fprintf(f, "set cblabel UNIT\n");
  } else {
    fprintf(f, "set colorbox vertical user origin %g,%g size %g,%g\n", (LEFT + c->px + BAR_GAP) / w,
            BOTTOM / h, BAR / w, c->py / h);
    fprintf(f, "set label 2 UNIT at screen %g,%g left\n", (LEFT + c->px + BAR_GAP) / w,
            (h - TOP + 28.0) / h);
  }
  fprintf(f, "set cbtics scale 0.5\n");
}

static void print_frame(const picture *c, pw_plot *plot)
{
  FILE *f = plot->script;
  const pw_real w = c->width, h = c->height, base = BOTTOM + (bar_below(c) ? BELOW : 0);
  const bool axi = c->scene->geometry == PW_AXI;
  fprintf(f, "set lmargin at screen %g\nset rmargin at screen %g\n", LEFT / w, (LEFT + c->px) / w);
  fprintf(f, "set bmargin at screen %g\nset tmargin at screen %g\n", base / h, (base + c->py) / h);
  fprintf(f, "set xrange [%.9g:%.9g]\nset yrange [%.9g:%.9g]\n", c->x[0], c->x[1], c->y[0],
          c->y[1]);
  fprintf(f, "set xlabel '%s'\nset ylabel '%s'\n", axi ? "radius (m)" : "x (m)",
          axi ? "height (m)" : "y (m)");
  fprintf(f, "set border linewidth 0.8\nset tics out nomirror scale 0.6\nunset key\n");
  if (c->px < NARROW) {
    fprintf(f, "set xtics (%.9g)\n", c->x[1]); /* there is no room for more numbers */
  }
  fprintf(f, "set label 1 '%s, t = %.*f s' at screen %g,%g left font ',20'\n", c->what->title,
          c->decimals, pw_sim_time(c->sim), LEFT / w, (h - 30.0) / h);
  fprintf(f, "set label 3 ");
  pw_plot_text(plot, c->scene->title);
  fprintf(f, " at screen %g,%g left font ',13' textcolor '#606060' noenhanced\n", LEFT / w,
          (h - 62.0) / h);
  if (c->scene->output.picture_cell_mean) {
    fprintf(f,
            "set label 4 'means of cells' at screen %g,%g right font ',13' textcolor '#606060'\n",
            (w - 12.0) / w, 14.0 / h);
  }
}

static void print_script(const picture *c, pw_plot *plot)
{
  FILE *f = plot->script;
  print_frame(c, plot);
  print_palette(f);
  print_bar(c, f);
  print_data(c, f, true);
  print_data(c, f, false);
  int structures = print_structures(c, f), outlines = print_outlines(c, f);
  fprintf(f, "set style fill solid noborder\n");
  fprintf(f, "plot $field using 1:2:($3*SCALE) with filledcurves closed fillcolor palette, "
             "$other using 1:2 with filledcurves closed fillcolor rgb '#b8b8b8', ");
  if (structures > 0) {
    fprintf(f, "$structure using 1:2 with filledcurves closed fillcolor rgb '#b8b8b8', ");
  }
  if (outlines > 0) {
    fprintf(f, "$outline using 1:2 with lines linecolor rgb 'black' linewidth 1.4, ");
  }
  fprintf(f, "NaN notitle\n");
}

static pw_status draw(picture *c, const char *folder, const quantity *what)
{
  char name[128];
  pw_plot plot = {.script = NULL};
  c->what = what;
  PW_TRY(find_values(c));
  choose_range(c);
  snprintf(name, sizeof name, "%s_t%0*.*fs.png", what->file, c->decimals + 3, c->decimals,
           pw_sim_time(c->sim));
  pw_series_picture p = {.own = {c->range[0], c->range[1]}, .width = c->width, .height = c->height};
  snprintf(p.quantity, sizeof p.quantity, "%s", what->file);
  snprintf(p.unit, sizeof p.unit, "%s", !what->unit ? "stress" : *what->unit ? what->unit : "-");
  PW_TRY(pw_series_open(folder, name, &p, &plot.script));
  print_script(c, &plot);
  return pw_series_draw(folder, name, plot.script);
}

static pw_status draw_all(picture *c, const char *folder)
{
  static const quantity vertical = {"vertical_stress", "Vertical stress", NULL, stress_yy};
  static const quantity radial = {"radial_stress", "Radial stress", NULL, stress_xx};
  static const quantity horizontal = {"horizontal_stress", "Horizontal stress", NULL, stress_xx};
  static const quantity mean = {"mean_stress", "Mean stress", NULL, mean_stress};
  static const quantity velocity = {"speed", "Speed", "m/s", speed};
  static const quantity ratio = {"void_ratio", "Void ratio", "", void_ratio};
  static const quantity angle = {"mobilised_friction_angle", "Mobilised friction angle", "degrees",
                                 friction_angle};
  PW_TRY(draw(c, folder, &vertical));
  PW_TRY(draw(c, folder, c->scene->geometry == PW_AXI ? &radial : &horizontal));
  if (has_void_ratio(c)) {
    PW_TRY(draw(c, folder, &ratio));
  }
  if (c->soil_only) {
    return draw(c, folder, &angle);
  }
  PW_TRY(draw(c, folder, &mean));
  return draw(c, folder, &velocity);
}

pw_status pw_pictures_finish(const char *folder)
{
  return pw_series_finish(folder);
}

pw_status pw_pictures_fields(const char *folder, const pw_sim *sim)
{
  picture c = {.sim = sim, .scene = pw_sim_scene(sim), .p = pw_sim_points(sim)};
  pw_off room = c.p->n > 2 * OUTLINE_POINTS ? c.p->n : 2 * OUTLINE_POINTS;
  PW_TRY(pw_make_folder(folder));
  PW_TRY(pw_mem_alloc("pictures", room, sizeof *c.work, &c.work));
  pw_status status = pw_mem_alloc("pictures: values", c.p->n, sizeof *c.value, &c.value);
  c.soil_only = has_soil(c.scene);
  c.decimals = pw_picture_decimals(c.scene);
  choose_window(&c);
  choose_size(&c);
  status = status == PW_OK ? draw_all(&c, folder) : status;
  pw_mem_free(&c.value);
  pw_mem_free(&c.work);
  return status;
}
