/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/pictures_series.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "io/pictures_plot.h"

static const char ending[] = ".field";

static pw_status data_path(const char *folder, const char *name, char *path)
{
  PW_TRY(pw_path_join(folder, name, path));
  size_t length = strlen(path);
  PW_REQUIRE(length + sizeof ending <= PW_PATH, PW_ERR_FILE, "%s: the path is too long", path);
  memcpy(path + length, ending, sizeof ending);
  return PW_OK;
}

/* ---- first line of a data file ---- */

static void print_head(const pw_series_picture *p, FILE *f)
{
  fprintf(f, "# %s %s %.17g %.17g %.17g %.17g %d %d\n", p->quantity, p->unit, p->own[0], p->own[1],
          p->drawn[0], p->drawn[1], p->width, p->height);
}

static bool read_head(const char *path, pw_series_picture *p)
{
  char line[512];
  FILE *f = fopen(path, "r");
  bool good = f && fgets(line, sizeof line, f) &&
              sscanf(line, "# %47s %47s %lf %lf %lf %lf %d %d", p->quantity, p->unit, &p->own[0],
                     &p->own[1], &p->drawn[0], &p->drawn[1], &p->width, &p->height) == 8;
  if (f) {
    fclose(f);
  }
  return good;
}

static bool is_data(const char *name)
{
  size_t length = strlen(name);
  return length >= sizeof ending && strcmp(name + length - (sizeof ending - 1), ending) == 0;
}

/* Widen the range by that of every picture of the quantity in the folder. */
static void widen(const char *folder, const char *quantity, pw_real *range)
{
  DIR *dir = opendir(folder);
  for (struct dirent *e = dir ? readdir(dir) : NULL; e; e = readdir(dir)) {
    pw_series_picture other;
    char path[PW_PATH];
    if (is_data(e->d_name) && pw_path_join(folder, e->d_name, path) == PW_OK &&
        read_head(path, &other) && strcmp(other.quantity, quantity) == 0) {
      range[0] = pw_min(range[0], other.own[0]);
      range[1] = pw_max(range[1], other.own[1]);
    }
  }
  if (dir) {
    closedir(dir);
  }
}

/* ---- drawing ---- */

/* Ends of the colour bar on round numbers: a 1-2-5 step that divides the range about ten times. */
static void round_range(pw_real *range)
{
  const pw_real middle = 0.5 * (range[0] + range[1]);
  const pw_real least = pw_max(1e-6 * fabs(middle), 1e-12);
  if (range[1] - range[0] < least) {
    range[0] = middle - pw_max(0.1 * fabs(middle), least);
    range[1] = middle + pw_max(0.1 * fabs(middle), least);
  }
  const pw_real rough = (range[1] - range[0]) / 10.0, decade = pow(10.0, floor(log10(rough)));
  const pw_real lead = rough / decade;
  const pw_real step = decade * (lead < 1.5 ? 1.0 : lead < 3.5 ? 2.0 : lead < 7.5 ? 5.0 : 10.0);
  range[0] = step * floor(range[0] / step + 1e-9);
  range[1] = step * ceil(range[1] / step - 1e-9);
}

static void print_range(const pw_series_picture *p, FILE *f)
{
  const pw_real largest = pw_max(fabs(p->drawn[0]), fabs(p->drawn[1]));
  const char *unit = strcmp(p->unit, "-") == 0 ? "" : p->unit;
  pw_real scale = 1.0;
  if (strcmp(unit, "stress") == 0) {
    const bool small = largest < 200.0, big = largest >= 2e7;
    unit = small ? "Pa" : big ? "MPa" : "kPa";
    scale = small ? 1.0 : big ? 1e-6 : 1e-3;
  }
  pw_real range[2] = {p->drawn[0] * scale, p->drawn[1] * scale};
  round_range(range);
  fprintf(f, "SCALE = %g\nUNIT = '%s'\nset cbrange [%.9g:%.9g]\n", scale, unit, range[0], range[1]);
}

/* Draw the picture from its data file, which is closed. */
static pw_status draw(const char *folder, const char *name, const pw_series_picture *p)
{
  char data[PW_PATH];
  pw_plot plot;
  PW_TRY(data_path(folder, name, data));
  PW_TRY(pw_plot_begin(folder, name, p->width, p->height, &plot));
  print_range(p, plot.script);
  fprintf(plot.script, "load ");
  pw_plot_text(&plot, data);
  return pw_plot_end(&plot);
}

pw_status pw_series_open(const char *folder, const char *name, pw_series_picture *p, FILE **data)
{
  char path[PW_PATH];
  PW_TRY(data_path(folder, name, path));
  unlink(path); /* of an earlier run up to here: its range counts no more */
  p->drawn[0] = p->own[0];
  p->drawn[1] = p->own[1];
  widen(folder, p->quantity, p->drawn);
  *data = fopen(path, "w");
  PW_REQUIRE(*data, PW_ERR_FILE, "cannot write %s: %s", path, strerror(errno));
  print_head(p, *data);
  return PW_OK;
}

pw_status pw_series_draw(const char *folder, const char *name, FILE *data)
{
  char path[PW_PATH];
  pw_series_picture p;
  bool whole = !ferror(data);
  whole = fclose(data) == 0 && whole;
  PW_TRY(data_path(folder, name, path));
  whole = whole && read_head(path, &p);
  pw_status status = whole ? draw(folder, name, &p)
                           : pw_error_set(PW_ERR_FILE, __FILE__, __LINE__, __func__,
                                          "cannot write %s (no room on the disk?)", path);
  if (status != PW_OK) {
    unlink(path);
  }
  return status;
}

/* ---- end of the run ---- */

/* Name of the picture of a data file. */
static void picture_name(const char *data, char *name)
{
  snprintf(name, PW_PATH, "%s", data);
  name[strlen(name) - (sizeof ending - 1)] = '\0';
}

static pw_status renew(const char *folder, const char *data)
{
  char path[PW_PATH], name[PW_PATH];
  pw_series_picture p;
  PW_TRY(pw_path_join(folder, data, path));
  if (!read_head(path, &p)) {
    return PW_OK;
  }
  const pw_real before[2] = {p.drawn[0], p.drawn[1]};
  p.drawn[0] = p.own[0];
  p.drawn[1] = p.own[1];
  widen(folder, p.quantity, p.drawn);
  if (p.drawn[0] == before[0] && p.drawn[1] == before[1]) {
    return PW_OK;
  }
  picture_name(data, name);
  return draw(folder, name, &p);
}

/* Renew the pictures of all data files, or remove the files. */
static pw_status for_all(const char *folder, bool renewing)
{
  pw_status status = PW_OK;
  DIR *dir = opendir(folder);
  for (struct dirent *e = dir ? readdir(dir) : NULL; e; e = readdir(dir)) {
    char path[PW_PATH];
    if (!is_data(e->d_name) || status != PW_OK) {
      continue;
    }
    if (renewing) {
      status = renew(folder, e->d_name);
    } else if (pw_path_join(folder, e->d_name, path) == PW_OK) {
      unlink(path);
    }
  }
  if (dir) {
    closedir(dir);
  }
  return status;
}

pw_status pw_series_finish(const char *folder)
{
  pw_status status = for_all(folder, true);
  for_all(folder, false);
  return status;
}
