/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/keys.h"
#include "io/scene_file_reader.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { CHOICES = 16, DESCRIBED = PW_YAML_SHOWN + 8 };

/* The value is not what the key holds. */
static bool wrong_type(pw_reader *r, const pw_key *key, const pw_yaml_node *node,
                       const char *wanted)
{
  char found[DESCRIBED];
  pw_yaml_describe(node, found);
  bool quoted = node->kind == PW_YAML_SCALAR && !node->plain;
  pw_yaml_error(r->m, &node->place, "'%s' must be %s, found %s%s", key->name, wanted,
                quoted ? "the text " : "", found);
  return false;
}

static bool is_scalar(const pw_yaml_node *node)
{
  return node->kind == PW_YAML_SCALAR && !node->has_zero;
}

/* .nan, nan, .inf, -inf, infinity, ... */
static bool is_not_finite(const char *text)
{
  static const char *const words[] = {"nan", "inf", "infinity"};
  text += *text == '+' || *text == '-';
  text += *text == '.';
  for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
    if (strcasecmp(text, words[i]) == 0) {
      return true;
    }
  }
  return false;
}

/* Whether the text is a decimal number followed by something, as in "5 m". */
static bool starts_as_number(const char *text)
{
  static const char digits[] = "0123456789";
  size_t sign = strspn(text, "+-");
  size_t n = strspn(text + sign, "0123456789.");
  return sign < 2 && n > 0 && strpbrk(text, digits) && text[sign + n] != '\0' &&
         !strpbrk(text, "xX,");
}

static bool not_a_number(pw_reader *r, const pw_key *key, const pw_yaml_node *node)
{
  char found[DESCRIBED];
  pw_yaml_describe(node, found);
  if (is_scalar(node) && is_not_finite(node->text)) {
    pw_yaml_error(r->m, &node->place, "'%s' must be a finite number, found %s", key->name, found);
    return false;
  }
  if (is_scalar(node) && node->plain && starts_as_number(node->text)) {
    pw_yaml_error(r->m, &node->place, "'%s' must be a number alone (its unit is %s), found %s",
                  key->name, pw_key_unit(key), found);
    return false;
  }
  return wrong_type(r, key, node, "a number");
}

static bool read_number(pw_reader *r, const pw_key *key, const pw_yaml_node *node, pw_real *out)
{
  if (!is_scalar(node) || !node->plain || !pw_key_number(node->text, out)) {
    return not_a_number(r, key, node);
  }
  if (!isfinite(*out) || fabs(*out) > PW_HUGE) {
    pw_yaml_error(r->m, &node->place, "'%s' must be a finite number, found '%.40s'", key->name,
                  node->text);
    return false;
  }
  if (*out < key->lo || *out > key->hi) {
    char range[PW_KEY_RANGE];
    const char *unit = pw_key_unit(key);
    pw_key_range(key, range);
    pw_yaml_error(r->m, &node->place, "'%s' = %.40s is out of range: it must be %s%s%s", key->name,
                  node->text, range, *unit == '-' ? "" : " ", *unit == '-' ? "" : unit);
    return false;
  }
  return true;
}

static bool read_int(pw_reader *r, const pw_key *key, const pw_yaml_node *node, pw_real *out)
{
  pw_real v;
  if (is_scalar(node) && node->plain && pw_key_number(node->text, &v) &&
      (v != floor(v) || fabs(v) > INT_MAX)) {
    return wrong_type(r, key, node, "a whole number");
  }
  return read_number(r, key, node, out);
}

/* Numbers of a list, each at its own place. */
static bool read_list(pw_reader *r, const pw_key *key, const pw_yaml_node *node, int lo, int hi,
                      pw_key_value *out)
{
  const char *wanted = hi == 2   ? "two numbers [a, b]"
                       : hi == 3 ? "three numbers [x, y, z]"
                                 : "a list of numbers [a, b, ...]";
  if (node->kind != PW_YAML_LIST) {
    return wrong_type(r, key, node, wanted);
  }
  if (node->count < lo || node->count > hi) {
    if (lo == hi) {
      pw_yaml_error(r->m, &node->place, "'%s' must be %s, found %d", key->name, wanted,
                    node->count);
    } else {
      pw_yaml_error(r->m, &node->place, "'%s' may hold %d numbers at most, found %d", key->name, hi,
                    node->count);
    }
    return false;
  }
  bool fine = true;
  for (const pw_yaml_node *child = node->first; child; child = child->next) {
    fine = read_number(r, key, child, &out->v[out->n++]) && fine;
  }
  return fine;
}

static bool read_bool(pw_reader *r, const pw_key *key, const pw_yaml_node *node, pw_real *out)
{
  static const char *const also[] = {"yes", "on", "no", "off"};
  int i = is_scalar(node) && node->plain ? pw_key_choice("false|true", node->text) : -1;
  if (i >= 0) {
    *out = i;
    return true;
  }
  if (!is_scalar(node)) {
    return wrong_type(r, key, node, "true or false");
  }
  char found[DESCRIBED], hint[PW_YAML_HINT];
  pw_yaml_nearest nearest = {.word = node->text};
  pw_yaml_nearest_offer(&nearest, "true");
  pw_yaml_nearest_offer(&nearest, "false");
  for (int k = 0; k < 4; k++) {
    if (strcasecmp(node->text, also[k]) == 0) {
      nearest.best = k < 2 ? "true" : "false";
    }
  }
  pw_yaml_describe(node, found);
  pw_yaml_nearest_hint(&nearest, hint);
  pw_yaml_error(r->m, &node->place, "'%s' must be true or false, found %s%s", key->name, found,
                hint);
  return false;
}

static bool read_choice(pw_reader *r, const pw_key *key, const pw_yaml_node *node, pw_real *out)
{
  if (!is_scalar(node)) {
    return wrong_type(r, key, node, "one word");
  }
  int i = pw_key_choice(key->choices, node->text);
  if (i >= 0) {
    *out = i;
    return true;
  }
  char choice[CHOICES][PW_NAME], shown[PW_YAML_SHOWN], hint[PW_YAML_HINT];
  pw_yaml_nearest nearest = {.word = node->text};
  for (int k = 0; k < CHOICES && pw_key_choice_at(key->choices, k, choice[k]); k++) {
    pw_yaml_nearest_offer(&nearest, choice[k]);
  }
  pw_yaml_shown(node->text, shown);
  pw_yaml_nearest_hint(&nearest, hint);
  pw_yaml_error(r->m, &node->place, "'%s' must be one of %s, found '%s'%s", key->name, key->choices,
                shown, hint);
  return false;
}

static bool read_text(pw_reader *r, const pw_key *key, const pw_yaml_node *node, char *out)
{
  if (node->kind != PW_YAML_SCALAR) {
    return wrong_type(r, key, node, "text");
  }
  for (const char *c = node->text; *c || node->has_zero; c++) {
    if ((unsigned char)*c < 0x20 || *c == 0x7f) {
      pw_yaml_error(r->m, &node->place, "'%s' must be one line without control characters",
                    key->name);
      return false;
    }
  }
  if (strlen(node->text) >= PW_NAME && key->type == PW_KEY_TEXT) {
    pw_yaml_error(r->m, &node->place, "'%s' is too long: %d bytes at most, found %zu", key->name,
                  PW_NAME - 1, strlen(node->text));
    return false;
  }
  snprintf(out, PW_FILE_NAME, "%s", node->text);
  return true;
}

/* A path; what is written in a file is relative to that file's folder. */
static bool read_file(pw_reader *r, const pw_key *key, const pw_yaml_node *node, char *out)
{
  if (!read_text(r, key, node, out)) {
    return false;
  }
  const int file = -2 - node->place.set;
  const char *home = node->place.set >= 0 ? "" : file >= 0 ? r->m->file[file].name : r->m->name;
  const char *slash = node->text[0] == '/' ? NULL : strrchr(home, '/');
  int folder = slash ? (int)(slash + 1 - home) : 0;
  int length = snprintf(out, PW_FILE_NAME, "%.*s%s", folder, home, node->text);
  if (!node->text[0] || length < 0 || length >= PW_FILE_NAME) {
    pw_yaml_error(r->m, &node->place, "'%s' must name a file, with at most %d bytes", key->name,
                  PW_FILE_NAME - 1 - folder);
    return false;
  }
  return true;
}

/* Index of a named body or material of the scene. */
static bool read_reference(pw_reader *r, const pw_key *key, const pw_yaml_node *node, pw_real *out)
{
  bool body = key->type == PW_KEY_BODY;
  int count = body ? r->scene->nbody : r->scene->nmaterial;
  if (!is_scalar(node)) {
    return wrong_type(r, key, node, body ? "the name of a body" : "the name of a material");
  }
  pw_yaml_nearest nearest = {.word = node->text};
  for (int i = 0; i < count; i++) {
    const char *name = body ? r->scene->body[i].name : r->scene->material[i].name;
    if (strcmp(name, node->text) == 0) {
      *out = i;
      return true;
    }
    pw_yaml_nearest_offer(&nearest, name);
  }
  char shown[PW_YAML_SHOWN], hint[PW_YAML_HINT];
  pw_yaml_shown(node->text, shown);
  pw_yaml_nearest_hint(&nearest, hint);
  pw_yaml_error(r->m, &node->place, "'%s': there is no %s '%s'%s", key->name,
                body ? "body" : "material", shown, hint);
  return false;
}

bool pw_reader_value(pw_reader *r, const pw_key *key, const pw_yaml_node *node, pw_key_value *out)
{
  *out = (pw_key_value){0};
  if (pw_yaml_is_null(node) && key->type != PW_KEY_TEXT) {
    pw_yaml_error(r->m, &node->key_place, "'%s' has no value", key->name);
    return false;
  }
  switch (key->type) {
  case PW_KEY_REAL:
    return read_number(r, key, node, out->v);
  case PW_KEY_PAIR:
    return read_list(r, key, node, 2, 2, out);
  case PW_KEY_TRIPLE:
    return read_list(r, key, node, 3, 3, out);
  case PW_KEY_REALS:
    return read_list(r, key, node, 0, PW_LIST, out);
  case PW_KEY_INT:
    return read_int(r, key, node, out->v);
  case PW_KEY_BOOL:
    return read_bool(r, key, node, out->v);
  case PW_KEY_CHOICE:
    return read_choice(r, key, node, out->v);
  case PW_KEY_TEXT:
    return read_text(r, key, node, out->text);
  case PW_KEY_FILE:
    return read_file(r, key, node, out->text);
  case PW_KEY_BODY:
  case PW_KEY_MATERIAL:
    return read_reference(r, key, node, out->v);
  }
  return false;
}
