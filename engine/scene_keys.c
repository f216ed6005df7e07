/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/scene_keys.h"

#include "engine/scene.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* A material keeps every number as a pw_real. */
static bool stores_reals(const pw_key *keys)
{
  for (int i = 0; pw_material_at(i); i++) {
    if (pw_material_at(i)->keys == keys) {
      return true;
    }
  }
  return false;
}

static const char *skip_digits(const char *c)
{
  while (isdigit((unsigned char)*c)) {
    c++;
  }
  return c;
}

bool pw_key_number(const char *text, pw_real *out)
{
  const char *c = text;
  if (*c == '+' || *c == '-') {
    c++;
  }
  const char *whole = c;
  c = skip_digits(c);
  bool digits = c > whole;
  if (*c == '.') {
    const char *fraction = ++c;
    c = skip_digits(c);
    digits = digits || c > fraction;
  }
  if (!digits) {
    return false;
  }
  if (*c == 'e' || *c == 'E') {
    c += c[1] == '+' || c[1] == '-' ? 2 : 1;
    const char *exponent = c;
    c = skip_digits(c);
    if (c == exponent) {
      return false;
    }
  }
  if (*c != '\0') {
    return false;
  }
  *out = strtod(text, NULL);
  return true;
}

/* Length of the first part of a list "a|b|c". */
static size_t part_length(const char *list)
{
  return strcspn(list, "|");
}

int pw_key_choice(const char *choices, const char *word)
{
  int i = 0;
  for (const char *c = choices; *c; i++) {
    size_t n = part_length(c);
    if (strlen(word) == n && strncmp(c, word, n) == 0) {
      return i;
    }
    c += n + (c[n] == '|');
  }
  return -1;
}

bool pw_key_choice_at(const char *choices, int i, char *out)
{
  const char *c = choices;
  for (int k = 0; *c; k++) {
    size_t n = part_length(c);
    if (k == i && n < PW_NAME) {
      memcpy(out, c, n);
      out[n] = '\0';
      return true;
    }
    c += n + (c[n] == '|');
  }
  return false;
}

static void store_index(const pw_key *key, pw_real value, unsigned char *at)
{
  if (key->type == PW_KEY_BOOL) {
    bool b = value != 0;
    memcpy(at, &b, sizeof b);
  } else {
    int i = (int)value;
    memcpy(at, &i, sizeof i);
  }
}

/* Of a material: the number, or the count of a list before its numbers. */
static void store_reals(const pw_key *key, const pw_key_value *value, unsigned char *at)
{
  if (key->type == PW_KEY_REALS) {
    const pw_real count = value->n;
    memcpy(at, &count, sizeof count);
    memcpy(at + sizeof count, value->v, (size_t)value->n * sizeof(pw_real));
  } else {
    memcpy(at, value->v, sizeof(pw_real));
  }
}

void pw_key_store(const pw_key *keys, const pw_key *key, const pw_key_value *value, void *base)
{
  unsigned char *at = (unsigned char *)base + key->offset;
  const bool is_text = key->type == PW_KEY_TEXT || key->type == PW_KEY_FILE;
  if (stores_reals(keys) && !is_text) {
    store_reals(key, value, at);
    return;
  }
  switch (key->type) {
  case PW_KEY_REAL:
    memcpy(at, value->v, sizeof(pw_real));
    break;
  case PW_KEY_PAIR:
    memcpy(at, value->v, 2 * sizeof(pw_real));
    break;
  case PW_KEY_TRIPLE:
    memcpy(at, value->v, 3 * sizeof(pw_real));
    break;
  case PW_KEY_REALS: {
    pw_reals list = {.n = value->n};
    memcpy(list.v, value->v, (size_t)value->n * sizeof(pw_real));
    memcpy(at, &list, sizeof list);
    break;
  }
  case PW_KEY_TEXT:
    memcpy(at, value->text, PW_NAME);
    break;
  case PW_KEY_FILE:
    memcpy(at, value->text, PW_FILE_NAME);
    break;
  case PW_KEY_INT:
  case PW_KEY_BOOL:
  case PW_KEY_CHOICE:
  case PW_KEY_BODY:
  case PW_KEY_MATERIAL:
    store_index(key, value->v[0], at);
    break;
  }
}

const pw_key *pw_key_find(const pw_key *keys, const char *name)
{
  for (const pw_key *k = keys; k->name; k++) {
    if (strcmp(k->name, name) == 0) {
      return k;
    }
  }
  return NULL;
}

const char *pw_key_needs_effect(const pw_key *key)
{
  return key->needs && !strchr(key->needs, '=') ? key->needs : NULL;
}

const pw_key *pw_key_needs_sibling(const pw_key *keys, const pw_key *key)
{
  size_t n = key->needs ? strcspn(key->needs, "=") : 0;
  for (const pw_key *k = keys; n && key->needs[n] && k->name; k++) {
    if (strlen(k->name) == n && strncmp(k->name, key->needs, n) == 0) {
      return k;
    }
  }
  return NULL;
}

static int load_index(const pw_key *keys, const pw_key *key, const void *base)
{
  const unsigned char *at = (const unsigned char *)base + key->offset;
  if (stores_reals(keys)) {
    pw_real r;
    memcpy(&r, at, sizeof r);
    return (int)r;
  }
  if (key->type == PW_KEY_BOOL) {
    return *at != 0;
  }
  int i;
  memcpy(&i, at, sizeof i);
  return i;
}

bool pw_key_needs_met(const pw_key *keys, const pw_key *key, const void *base)
{
  const pw_key *sibling = pw_key_needs_sibling(keys, key);
  if (!sibling) {
    return true;
  }
  char word[PW_NAME];
  const char *choices = sibling->type == PW_KEY_BOOL ? "false|true" : sibling->choices;
  return choices && pw_key_choice_at(choices, load_index(keys, sibling, base), word) &&
         pw_key_choice(strchr(key->needs, '=') + 1, word) >= 0;
}
