/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/yaml_messages.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  MESSAGES_KEPT = 100,
  LINE_SHOWN = 100, /* characters of a source line */
  WORD = 64         /* longest word that is compared */
};

void pw_yaml_error(pw_yaml_messages *m, const pw_yaml_place *place, const char *fmt, ...)
{
  m->n++;
  if (m->kept == MESSAGES_KEPT) {
    return;
  }
  if (!m->item) {
    m->item = calloc(MESSAGES_KEPT, sizeof *m->item);
  }
  char what[1024];
  va_list args;
  va_start(args, fmt);
  vsnprintf(what, sizeof what, fmt, args);
  va_end(args);
  char *copy = m->item ? malloc(strlen(what) + 1) : NULL;
  if (!copy) {
    m->out_of_memory = true;
    return;
  }
  strcpy(copy, what);
  m->item[m->kept++] = (pw_yaml_message){*place, copy};
}

void pw_yaml_messages_free(pw_yaml_messages *m)
{
  for (int i = 0; i < m->kept; i++) {
    free(m->item[i].what);
  }
  for (int i = 0; i < m->nfile; i++) {
    free(m->file[i].name);
    free(m->file[i].text);
  }
  free(m->item);
  m->item = NULL;
  m->nfile = 0;
  m->n = m->kept = 0;
}

void pw_yaml_shown(const char *text, char *out)
{
  size_t n = 0;
  for (const char *c = text; *c && n < PW_YAML_SHOWN - 4; c++) {
    unsigned char u = (unsigned char)*c;
    out[n++] = u < 0x20 || u == 0x7f ? '?' : *c;
  }
  /* Not in the middle of a character of several bytes. */
  if (strlen(text) > n) {
    while (n > 0 && ((unsigned char)text[n] & 0xc0) == 0x80) {
      n--;
    }
    memcpy(out + n, "...", 3);
    n += 3;
  }
  out[n] = '\0';
}

/* Included files before the file before --set, then by place; equal places keep their order (insertion sort). */
static bool later(const pw_yaml_place *a, const pw_yaml_place *b)
{
  if (a->set != b->set) {
    return a->set > b->set;
  }
  return a->line != b->line ? a->line > b->line : a->column > b->column;
}

static void sort_items(pw_yaml_messages *m)
{
  for (int i = 1; i < m->kept; i++) {
    pw_yaml_message moved = m->item[i];
    int k = i;
    for (; k > 0 && later(&m->item[k - 1].place, &moved.place); k--) {
      m->item[k] = m->item[k - 1];
    }
    m->item[k] = moved;
  }
}

/* Bytes of the line break at @p c, those of YAML: CR LF, LF, CR, NEL, LS, PS; 0 for none. */
static size_t break_bytes(const char *c, const char *end)
{
  if (*c == '\n') {
    return 1;
  }
  if (*c == '\r') {
    return c + 1 < end && c[1] == '\n' ? 2 : 1;
  }
  if (c + 1 < end && memcmp(c, "\xc2\x85", 2) == 0) {
    return 2;
  }
  bool three =
      c + 2 < end && (memcmp(c, "\xe2\x80\xa8", 3) == 0 || memcmp(c, "\xe2\x80\xa9", 3) == 0);
  return three ? 3 : 0;
}

pw_yaml_place pw_yaml_place_at(const pw_yaml_messages *m, size_t offset)
{
  pw_yaml_place place = {-1, 1, 1};
  const char *end = m->text + m->length;
  const char *stop = m->text + (offset < m->length ? offset : m->length);
  for (const char *c = m->text; c < stop;) {
    size_t skip = break_bytes(c, end);
    if (skip > 0) {
      place.line++;
      place.column = 1;
      c += skip;
    } else {
      place.column += ((unsigned char)*c & 0xc0) != 0x80;
      c++;
    }
  }
  return place;
}

/* Start of line @p line (from 1), its bytes in @p length; NULL past the end. */
static const char *source_line(const char *text, size_t bytes, int line, size_t *length)
{
  const char *start = text, *end = text + bytes;
  const char *c = start;
  for (int at = 1; c < end; at += 1) {
    size_t skip = 0;
    while (c < end && (skip = break_bytes(c, end)) == 0) {
      c++;
    }
    if (at == line) {
      *length = (size_t)(c - start);
      return start;
    }
    c += skip;
    start = c;
  }
  return NULL;
}

/* The source line, from a bit before the column when it is long, and a caret under the column. */
static void print_line(FILE *out, const char *line, size_t length, int column)
{
  int first = column > LINE_SHOWN - 20 ? column - LINE_SHOWN / 2 : 1;
  char caret[2 * LINE_SHOWN];
  int n = 0, at = 0;
  fputs("  ", out);
  for (size_t i = 0; i < length; i++) {
    unsigned char u = (unsigned char)line[i];
    at += (u & 0xc0) != 0x80;
    if (at < first || at >= first + LINE_SHOWN) {
      continue;
    }
    fputc((u < 0x20 && u != '\t') || u == 0x7f ? '?' : u, out);
    if ((u & 0xc0) != 0x80 && at < column) {
      caret[n++] = u == '\t' ? '\t' : ' ';
    }
  }
  caret[n] = '\0';
  fprintf(out, "\n  %s^\n", caret);
}

static void print_message(FILE *out, const pw_yaml_messages *m, const pw_yaml_message *item)
{
  const pw_yaml_place *place = &item->place;
  if (place->set >= 0) {
    char shown[PW_YAML_SHOWN];
    pw_yaml_shown(m->set[place->set], shown);
    fprintf(out, "--set %s: error: %s\n", shown, item->what);
    return;
  }
  const pw_yaml_file *file = place->set < -1 ? &m->file[-2 - place->set] : NULL;
  const char *name = file ? file->name : m->name, *text = file ? file->text : m->text;
  size_t bytes = file ? file->length : m->length, length = 0;
  const char *line = source_line(text, bytes, place->line, &length);
  fprintf(out, "%s:%d:%d: error: %s\n", name, place->line, place->column, item->what);
  if (line && length > 0) {
    print_line(out, line, length, place->column);
  }
}

char *pw_yaml_messages_text(pw_yaml_messages *m)
{
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out) {
    return NULL;
  }
  sort_items(m);
  for (int i = 0; i < m->kept; i++) {
    print_message(out, m, &m->item[i]);
  }
  if (m->n > m->kept) {
    fprintf(out, "%s: %d further errors are not shown\n", m->name, m->n - m->kept);
  }
  if (fclose(out) != 0) {
    free(text);
    return NULL;
  }
  return text;
}

/* Optimal string alignment: insertions, deletions, substitutions and swaps of neighbours. */
static int edit_distance(const char *a, size_t na, const char *b, size_t nb)
{
  int row[3][WORD + 1];
  for (size_t j = 0; j <= nb; j++) {
    row[0][j] = (int)j;
  }
  for (size_t i = 1; i <= na; i++) {
    int *now = row[i % 3];
    const int *last = row[(i + 2) % 3], *before = row[(i + 1) % 3];
    now[0] = (int)i;
    for (size_t j = 1; j <= nb; j++) {
      int best = last[j - 1] + (a[i - 1] != b[j - 1]);
      best = last[j] + 1 < best ? last[j] + 1 : best;
      best = now[j - 1] + 1 < best ? now[j - 1] + 1 : best;
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        best = before[j - 2] + 1 < best ? before[j - 2] + 1 : best;
      }
      now[j] = best;
    }
  }
  return row[na % 3][nb];
}

/* Characters two words begin with alike. */
static size_t shared_start(const char *a, const char *b)
{
  size_t n = 0;
  while (a[n] && a[n] == b[n]) {
    n++;
  }
  return n;
}

void pw_yaml_nearest_offer(pw_yaml_nearest *nearest, const char *candidate)
{
  size_t n = strlen(nearest->word), nc = strlen(candidate);
  if (n == 0 || nc == 0 || n > WORD || nc > WORD) {
    return;
  }
  int distance = edit_distance(nearest->word, n, candidate, nc);
  int limit = n >= 6 ? 3 : (int)n / 2;
  size_t shared = shared_start(nearest->word, candidate);
  if (shared == n && candidate[n] == '_') {
    distance = 1;
    limit = 1;
  } else if (shared >= 5 && 4 * shared >= 3 * nc && distance > limit) {
    distance = limit; /* another ending of the same word */
  }
  if (distance <= limit && (!nearest->best || distance < nearest->distance)) {
    nearest->best = candidate;
    nearest->distance = distance;
  }
}

void pw_yaml_nearest_hint(const pw_yaml_nearest *nearest, char *out)
{
  out[0] = '\0';
  if (nearest->best) {
    snprintf(out, PW_YAML_HINT, "; did you mean '%.60s'?", nearest->best);
  }
}
