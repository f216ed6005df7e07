/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/solid_pictures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/core/mem.h"
#include "io/output_times.h"
#include "io/pictures_plot.h"
#include "io/pictures_series.h"

enum {
  CANVAS = 1200,
  NARROWEST = 700, /* room for the title */
  LEFT = 125,
  RIGHT = 190,
  TOP = 104,
  BOTTOM = 90, /* margins; pixels */
  BAR = 34,
  BAR_GAP = 24, /* colour bar: thickness, distance from the axes */
};

typedef struct quantity {
  const char *file, *title;
  pw_real (*value)(const pw_tet_points *p, pw_idx i);
} quantity;

typedef struct cut {
  const pw_implicit *sim;
  const pw_tet_model *m;
  const quantity *what;
  int axis, right, up; /* normal of the plane, axes of the picture */
  pw_real at;          /* place of the plane along the axis; m */
  pw_real low[2], high[2];
  int px, py, width, height; /* plot, canvas; pixels */
  pw_real *value;            /* [nelem] of what; NaN: no points */
  pw_real *work;             /* [nelem] values in the plane */
  pw_real range[2];
} cut;

static pw_real node_at(const cut *c, pw_idx node, int axis)
{
  const pw_tet_mesh *mesh = c->m->mesh;
  return mesh->x[(pw_off)axis * mesh->tets.nnode + node];
}

/* Corners of the polygon that the plane and an element have in common, in order around it; returns
 * their number: 0, 3 or 4. */
static int polygon(const cut *c, pw_idx e, pw_real (*xy)[2])
{
  static const int around[4][2] = {{0, 2}, {0, 3}, {1, 3}, {1, 2}}; /* of below, above */
  const pw_idx *node = c->m->mesh->tets.node + 4 * (size_t)e;
  int below[4], above[4], nbelow = 0, nabove = 0, n = 0;
  pw_real d[4];
  for (int i = 0; i < 4; i++) {
    d[i] = node_at(c, node[i], c->axis) - c->at;
    if (d[i] < 0.0) {
      below[nbelow++] = i;
    } else {
      above[nabove++] = i;
    }
  }
  const int total = nbelow * nabove;
  for (int k = 0; k < total; k++) {
    int b = below[k % nbelow], a = above[k / nbelow];
    if (total == 4) {
      b = below[around[k][0]];
      a = above[around[k][1] - 2];
    }
    const pw_real part = d[b] / (d[b] - d[a]);
    xy[n][0] = (1.0 - part) * node_at(c, node[b], c->right) + part * node_at(c, node[a], c->right);
    xy[n][1] = (1.0 - part) * node_at(c, node[b], c->up) + part * node_at(c, node[a], c->up);
    n++;
  }
  return n;
}

static void choose_plane(cut *c)
{
  const pw_scene *scene = pw_implicit_scene(c->sim);
  const pw_scene_solid_output *o = &scene->solid.output;
  const pw_idx n = c->m->mesh->tets.nnode;
  pw_real low[3], high[3];
  for (int k = 0; k < 3; k++) {
    low[k] = INFINITY;
    high[k] = -INFINITY;
    for (pw_idx a = 0; a < n; a++) {
      low[k] = pw_min(low[k], node_at(c, a, k));
      high[k] = pw_max(high[k], node_at(c, a, k));
    }
  }
  c->axis = o->slice_axis;
  c->right = c->axis == 0 ? 1 : 0;
  c->up = c->axis == 2 ? 1 : 2;
  /* Off the nodes of a regular mesh, so that it cuts elements and does not touch them. */
  const pw_real extent = high[c->axis] - low[c->axis];
  c->at = low[c->axis] + extent * pw_min(pw_max(o->slice_part, 1e-4), 1.0 - 1e-4) + 1e-6 * extent;
  c->low[0] = low[c->right];
  c->high[0] = high[c->right];
  c->low[1] = low[c->up];
  c->high[1] = high[c->up];
}

static void choose_size(cut *c)
{
  const pw_real aspect = (c->high[1] - c->low[1]) / (c->high[0] - c->low[0]);
  const pw_real room_x = CANVAS - LEFT - RIGHT, room_y = CANVAS - TOP - BOTTOM;
  const pw_real px = pw_min(room_x, room_y / aspect);
  c->px = (int)pw_max(px, 40.0);
  c->py = (int)pw_max(px * aspect, 40.0);
  c->width = c->px + LEFT + RIGHT < NARROWEST ? NARROWEST : c->px + LEFT + RIGHT;
  c->height = c->py + TOP + BOTTOM;
}

static int ascending(const void *a, const void *b)
{
  const pw_real x = *(const pw_real *)a, y = *(const pw_real *)b;
  return (x > y) - (x < y);
}

/* Means over the points of elements, by volume, and the range of those in the plane but for the
 * outermost hundredth on each side. */
static void find_values(cut *c)
{
  const pw_tet_points *p = &c->m->points;
  const pw_idx nelem = c->m->mesh->tets.nelem;
  pw_real xy[4][2];
  size_t n = 0;
  memset(c->value, 0, (size_t)nelem * sizeof *c->value);
  memset(c->work, 0, (size_t)nelem * sizeof *c->work);
  for (pw_idx i = 0; i < p->n; i++) {
    c->value[p->elem[i]] += p->volume[i] * c->what->value(p, i);
    c->work[p->elem[i]] += p->volume[i];
  }
  for (pw_idx e = 0; e < nelem; e++) {
    c->value[e] = c->work[e] > 0.0 ? c->value[e] / c->work[e] : NAN;
  }
  for (pw_idx e = 0; e < nelem; e++) {
    if (isfinite(c->value[e]) && polygon(c, e, xy) > 0) {
      c->work[n++] = c->value[e];
    }
  }
  c->range[0] = c->range[1] = 0.0;
  if (n > 0) {
    qsort(c->work, n, sizeof *c->work, ascending);
    c->range[0] = c->work[n / 100];
    c->range[1] = c->work[n - 1 - n / 100];
  }
}

static void print_frame(const cut *c, pw_plot *plot)
{
  static const char axis[] = "xyz";
  FILE *f = plot->script;
  const pw_real w = c->width, h = c->height;
  fprintf(f, "set lmargin at screen %g\nset rmargin at screen %g\n", LEFT / w, (LEFT + c->px) / w);
  fprintf(f, "set bmargin at screen %g\nset tmargin at screen %g\n", BOTTOM / h,
          (BOTTOM + c->py) / h);
  fprintf(f, "set xrange [%.9g:%.9g]\nset yrange [%.9g:%.9g]\n", c->low[0], c->high[0], c->low[1],
          c->high[1]);
  fprintf(f, "set xlabel '%c (m)'\nset ylabel '%c (m)'\n", axis[c->right], axis[c->up]);
  fprintf(f, "set border linewidth 0.8\nset tics out nomirror scale 0.6\nunset key\n");
  fprintf(f, "set label 1 '%s at %c = %.4g m, step %lld' at screen %g,%g left font ',20'\n",
          c->what->title, axis[c->axis], c->at, (long long)pw_implicit_steps(c->sim), LEFT / w,
          (h - 30.0) / h);
  fprintf(f, "set label 3 ");
  pw_plot_text(plot, pw_implicit_scene(c->sim)->title);
  fprintf(f, " at screen %g,%g left font ',13' textcolor '#606060' noenhanced\n", LEFT / w,
          (h - 62.0) / h);
  /* The viridis map of S. van der Walt and N. Smith (2015) at eight equal steps. */
  fprintf(f, "set palette defined (0 '#440154', 1 '#472d7b', 2 '#3b528b', 3 '#2c728e', "
             "4 '#21918c', 5 '#28ae80', 6 '#5ec962', 7 '#addc30', 8 '#fde725')\n");
  fprintf(f, "set colorbox vertical user origin %g,%g size %g,%g\n", (LEFT + c->px + BAR_GAP) / w,
          BOTTOM / h, BAR / w, c->py / h);
  fprintf(f, "set label 2 UNIT at screen %g,%g left\nset cbtics scale 0.5\n",
          (LEFT + c->px + BAR_GAP) / w, (h - TOP + 28.0) / h);
}

static void print_script(const cut *c, pw_plot *plot)
{
  FILE *f = plot->script;
  pw_real xy[4][2];
  print_frame(c, plot);
  fprintf(f, "$field << END\n");
  for (pw_idx e = 0; e < c->m->mesh->tets.nelem; e++) {
    const int n = isfinite(c->value[e]) ? polygon(c, e, xy) : 0;
    for (int k = 0; k < n; k++) {
      fprintf(f, "%.6g %.6g %.6g\n", xy[k][0], xy[k][1], c->value[e]);
    }
    fprintf(f, n > 0 ? "\n" : "");
  }
  fprintf(f, "END\nset style fill solid border\n");
  fprintf(f, "plot $field using 1:2:($3*SCALE) with filledcurves closed fillcolor palette, "
             "NaN notitle\n");
}

static pw_status draw(cut *c, const char *folder, const quantity *what)
{
  char name[128];
  pw_plot plot = {.script = NULL};
  c->what = what;
  find_values(c);
  const int decimals = pw_picture_decimals(pw_implicit_scene(c->sim));
  snprintf(name, sizeof name, "%s_t%0*.*fs.png", what->file, decimals + 3, decimals,
           pw_implicit_time(c->sim));
  pw_series_picture p = {.own = {c->range[0], c->range[1]}, .width = c->width, .height = c->height};
  snprintf(p.quantity, sizeof p.quantity, "%s", what->file);
  snprintf(p.unit, sizeof p.unit, "stress");
  PW_TRY(pw_series_open(folder, name, &p, &plot.script));
  print_script(c, &plot);
  return pw_series_draw(folder, name, plot.script);
}

pw_status pw_solid_pictures(const char *folder, const pw_implicit *sim)
{
  static const quantity mean = {"mean_stress", "Mean stress", pw_tet_points_mean_stress};
  static const quantity mises = {"von_mises_stress", "Von Mises stress", pw_tet_points_von_mises};
  cut c = {.sim = sim, .m = pw_implicit_model(sim)};
  const pw_idx nelem = c.m->mesh->tets.nelem;
  PW_TRY(pw_make_folder(folder));
  PW_TRY(pw_mem_alloc("pictures: values", nelem, sizeof *c.value, &c.value));
  pw_status s = pw_mem_alloc("pictures: order", nelem, sizeof *c.work, &c.work);
  if (s == PW_OK) {
    choose_plane(&c);
    choose_size(&c);
    s = draw(&c, folder, &mean);
  }
  if (s == PW_OK) {
    s = draw(&c, folder, &mises);
  }
  pw_mem_free(&c.work);
  pw_mem_free(&c.value);
  return s;
}
