/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/hypoplastic_reference.h
 * @brief Reading of the reference curves in reference/hypoplastic (see the README there).
 *
 * The files are in kPa and in the order xx yy zz xy xz yz; everything here is in Pa and in the
 * order xx yy zz xy yz zx.
 */
#ifndef PW_TESTS_HYPOPLASTIC_REFERENCE_H
#define PW_TESTS_HYPOPLASTIC_REFERENCE_H

#include "kernels/hypoplastic.h"
#include "tests/harness.h"

#include <dirent.h>
#include <stdlib.h>

#define REFERENCE_FOLDER "reference/hypoplastic"

enum { TABLE_COLUMNS = 80, TABLE_LINE = 4096 };

/** A CSV file: numbers, row by row; column 0 of the words "doc" and "NH97igs" reads 0 and 1. */
typedef struct table {
  char header[TABLE_LINE];
  char *name[TABLE_COLUMNS];
  int rows, columns;
  double *value;
} table;

static inline int table_split(char *line, char **word)
{
  int n = 0;
  for (char *w = strtok(line, ",\r\n"); w && n < TABLE_COLUMNS; w = strtok(NULL, ",\r\n")) {
    word[n++] = w;
  }
  return n;
}

/** Read a file of the reference folder; rows = 0 when it cannot be read. */
static inline void table_read(const char *file, table *t)
{
  char path[1024], line[TABLE_LINE], *word[TABLE_COLUMNS];
  int room = 0;
  memset(t, 0, sizeof *t);
  snprintf(path, sizeof path, "%s/%s", REFERENCE_FOLDER, file);
  FILE *f = fopen(path, "r");
  if (!f || !fgets(t->header, sizeof t->header, f)) {
    return;
  }
  t->columns = table_split(t->header, t->name);
  while (fgets(line, sizeof line, f)) {
    if (t->rows == room) {
      room = room ? 2 * room : 256;
      double *grown = realloc(t->value, (size_t)room * (size_t)t->columns * sizeof *grown);
      if (!grown) {
        break;
      }
      t->value = grown;
    }
    int n = table_split(line, word);
    for (int c = 0; c < t->columns; c++) {
      double v = c < n ? (strcmp(word[c], "NH97igs") == 0 ? 1.0 : strtod(word[c], NULL)) : 0.0;
      t->value[t->rows * t->columns + c] = v;
    }
    t->rows++;
  }
  fclose(f);
}

static inline void table_free(table *t)
{
  free(t->value);
  t->value = NULL;
}

static inline int table_column(const table *t, const char *name)
{
  for (int c = 0; c < t->columns; c++) {
    if (strcmp(t->name[c], name) == 0) {
      return c;
    }
  }
  return -1;
}

static inline double table_get(const table *t, int row, const char *name)
{
  int c = table_column(t, name);
  return c < 0 ? (double)NAN : t->value[row * t->columns + c];
}

/** The tensor whose first column is @p first, times @p unit. */
static inline pw_t6 table_tensor(const table *t, int row, const char *first, double unit)
{
  int c = table_column(t, first);
  const double *v = t->value + row * t->columns + c;
  return (pw_t6){unit * v[0], unit * v[1], unit * v[2], unit * v[3], unit * v[5], unit * v[4]};
}

/** Call @p visit for every file of the folder whose name starts with @p prefix; how many. */
static inline int reference_each(const char *prefix, void (*visit)(const char *file, void *ctx),
                                 void *ctx)
{
  int n = 0;
  DIR *dir = opendir(REFERENCE_FOLDER);
  for (struct dirent *d = dir ? readdir(dir) : NULL; d; d = readdir(dir)) {
    size_t len = strlen(d->d_name);
    if (strncmp(d->d_name, prefix, strlen(prefix)) == 0 && len > 4 &&
        strcmp(d->d_name + len - 4, ".csv") == 0) {
      visit(d->d_name, ctx);
      n++;
    }
  }
  if (dir) {
    closedir(dir);
  }
  return n;
}

/** The two parameter sets of the README: 0 is "doc", 1 is "NH97igs". No cut-off is in the
 *  reference: the least pressure here is far below any of its states. */
static inline void reference_set(int which, double tolerance, pw_real *v)
{
  memset(v, 0, PW_HYPO_PARAMS * sizeof *v);
  v[PW_HYPO_GRAIN_DENSITY] = 2600.0;
  v[PW_HYPO_VOID_RATIO] = 0.65;
  v[PW_HYPO_PHI_C] = 30.0;
  v[PW_HYPO_P_T] = 1600.0;
  v[PW_HYPO_H_S] = 5.8e9;
  v[PW_HYPO_N] = 0.28;
  v[PW_HYPO_E_D0] = 0.53;
  v[PW_HYPO_E_C0] = 0.84;
  v[PW_HYPO_E_I0] = 1.00;
  v[PW_HYPO_ALPHA] = 0.13;
  v[PW_HYPO_BETA] = 1.0;
  v[PW_HYPO_INTERGRANULAR] = 1.0;
  v[PW_HYPO_M_R] = which == 0 ? 10.0 : 5.0;
  v[PW_HYPO_M_T] = 2.0;
  v[PW_HYPO_R] = which == 0 ? 5e-5 : 1e-4;
  v[PW_HYPO_BETA_R] = which == 0 ? 0.3 : 0.5;
  v[PW_HYPO_CHI] = which == 0 ? 1.0 : 6.0;
  v[PW_HYPO_TOLERANCE] = tolerance;
  v[PW_HYPO_P_MIN] = 1.0;
  v[PW_HYPO_PHI_LIMIT] = 60.0;
  v[PW_HYPO_MAX_SUBSTEPS] = 400.0;
}

/** Set and switches that a file's name asks for. */
static inline void reference_set_of(const char *file, double tolerance, pw_real *v)
{
  reference_set(strstr(file, "NH97igs") != NULL, tolerance, v);
  if (strstr(file, "noIGS")) {
    v[PW_HYPO_INTERGRANULAR] = 0.0;
  }
  if (strstr(file, "_pt0")) {
    v[PW_HYPO_P_T] = 0.0;
  }
}

static inline pw_hypo_point reference_point(const table *t, int row)
{
  return (pw_hypo_point){.stress = table_tensor(t, row, "sig_xx", 1e3),
                         .delta = table_tensor(t, row, "del_xx", 1.0),
                         .void_ratio = table_get(t, row, "e"),
                         .substep = 1.0};
}

/** |a - b| / |b| of two stresses, each with p_t subtracted. */
static inline double stress_error(pw_t6 a, pw_t6 b, double p_t)
{
  return pw_t6_norm(pw_t6_axpy(a, -1.0, b)) / pw_t6_norm(pw_t6_shift(b, -p_t));
}

#endif /* PW_TESTS_HYPOPLASTIC_REFERENCE_H */
