/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/element_path.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 64, LINE = 4096, ROWS_MAX = 10000000 };

/* A file being read: which of the nine values each column holds, or -1. */
typedef struct reader {
  const char *file;
  int line, columns;
  int value[COLUMNS];
} reader;

static pw_status read_header(reader *r, char *text)
{
  static const char *const names[9] = {"eps_xx", "eps_yy",  "eps_zz",  "eps_xy", "eps_yz",
                                       "eps_zx", "spin_xy", "spin_yz", "spin_zx"};
  char *rest = text, *word;
  int known = 0;
  while ((word = strtok_r(rest, ", \t\r\n", &rest)) != NULL) {
    PW_REQUIRE(r->columns < COLUMNS, PW_ERR_FILE, "%s:%d: more than %d columns", r->file, r->line,
               (int)COLUMNS);
    int *value = &r->value[r->columns++];
    *value = -1;
    for (int k = 0; k < 9; k++) {
      *value = strcmp(word, names[k]) == 0 ? k : *value;
    }
    known += *value >= 0;
  }
  PW_REQUIRE(known > 0, PW_ERR_FILE,
             "%s:%d: the header names none of eps_xx, eps_yy, eps_zz, eps_xy, eps_yz, eps_zx",
             r->file, r->line);
  return PW_OK;
}

static pw_status read_row(const reader *r, char *text, pw_real *row)
{
  char *at = text;
  memset(row, 0, 9 * sizeof *row);
  for (int c = 0; c < r->columns; c++) {
    char *end;
    pw_real value = strtod(at, &end);
    PW_REQUIRE(end != at && isfinite(value), PW_ERR_FILE, "%s:%d: column %d holds no number",
               r->file, r->line, c + 1);
    if (r->value[c] >= 0) {
      row[r->value[c]] = value;
    }
    at = end + strspn(end, " \t");
    at += *at == ',';
  }
  PW_REQUIRE(at[strspn(at, " \t\r\n")] == '\0', PW_ERR_FILE, "%s:%d: more values than columns",
             r->file, r->line);
  return PW_OK;
}

static pw_status read_rows(reader *r, FILE *file, pw_element_path *out)
{
  char text[LINE];
  int room = 0;
  while (fgets(text, sizeof text, file)) {
    r->line++;
    if (text[0] == '#' || text[strspn(text, " \t\r\n")] == '\0') {
      continue;
    }
    if (r->columns == 0) {
      PW_TRY(read_header(r, text));
      continue;
    }
    if (out->n == room) {
      room = room ? 2 * room : 256;
      void *more = room < ROWS_MAX ? realloc(out->row, (size_t)room * sizeof *out->row) : NULL;
      PW_REQUIRE(more, PW_ERR_MEMORY, "%s: too many rows", r->file);
      out->row = more;
    }
    PW_TRY(read_row(r, text, out->row[out->n++]));
  }
  PW_REQUIRE(out->n > 0, PW_ERR_FILE, "%s: no rows of numbers", r->file);
  return PW_OK;
}

pw_status pw_element_path_read(const char *file, pw_element_path *out)
{
  *out = (pw_element_path){0};
  FILE *in = fopen(file, "r");
  PW_REQUIRE(in, PW_ERR_FILE, "cannot read %s: %s", file, strerror(errno));
  reader r = {.file = file};
  pw_status status = read_rows(&r, in, out);
  fclose(in);
  if (status != PW_OK) {
    pw_element_path_free(out);
  }
  return status;
}

void pw_element_path_free(pw_element_path *path)
{
  free(path->row);
  *path = (pw_element_path){0};
}
