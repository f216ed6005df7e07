/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/scene_file_reader.h"

#include <stdio.h>
#include <string.h>

/* What became of a row of the table. */
typedef enum { ABSENT, MISSPELT, WRONG, STORED } row_state;

const pw_yaml_place *pw_reader_place(const pw_yaml_node *node)
{
  return node->key ? &node->key_place : &node->place;
}

bool pw_reader_repeated(pw_reader *r, const pw_yaml_node *child)
{
  if (!child->earlier) {
    return false;
  }
  char shown[PW_YAML_SHOWN], where[32] = "";
  pw_yaml_shown(child->key, shown);
  if (child->earlier->key_place.set < 0) {
    snprintf(where, sizeof where, "; it stands in line %d", child->earlier->key_place.line);
  }
  pw_yaml_error(r->m, &child->key_place, "repeated key '%s'%s", shown, where);
  return true;
}

static bool is_extra(const pw_reader_section *s, const char *key)
{
  for (int i = 0; i < s->nextra; i++) {
    if (strcmp(s->extra[i], key) == 0) {
      return true;
    }
  }
  return false;
}

/* A row that the unknown key seems to mean is not reported as missing as well. */
static void unknown_key(pw_reader *r, const pw_reader_section *s, const pw_yaml_node *child,
                        row_state *state)
{
  char shown[PW_YAML_SHOWN], hint[PW_YAML_HINT];
  pw_yaml_nearest nearest = {.word = child->key};
  for (const pw_key *k = s->keys; k->name; k++) {
    pw_yaml_nearest_offer(&nearest, k->name);
  }
  for (int i = 0; i < s->nextra; i++) {
    pw_yaml_nearest_offer(&nearest, s->extra[i]);
  }
  pw_yaml_shown(child->key, shown);
  pw_yaml_nearest_hint(&nearest, hint);
  pw_yaml_error(r->m, &child->key_place, "unknown key '%s' in %s%s", shown, s->title, hint);
  const pw_key *meant = nearest.best ? pw_key_find(s->keys, nearest.best) : NULL;
  if (meant && state[meant - s->keys] == ABSENT) {
    state[meant - s->keys] = MISSPELT;
  }
}

static void read_child(pw_reader *r, const pw_reader_section *s, const pw_yaml_node *child,
                       row_state *state)
{
  const pw_key *key = pw_key_find(s->keys, child->key);
  if (pw_reader_repeated(r, child)) {
    return;
  }
  if (!key) {
    if (!is_extra(s, child->key)) {
      unknown_key(r, s, child, state);
    }
    return;
  }
  pw_key_value value;
  if (pw_reader_value(r, key, child, &value)) {
    pw_key_store(s->keys, key, &value, s->base);
    state[key - s->keys] = STORED;
  } else {
    state[key - s->keys] = WRONG;
  }
}

/* Whether the condition of a row holds: 1 yes, 0 no, -1 unknown because its sibling is wrong. */
static int condition(const pw_reader *r, const pw_reader_section *s, const pw_key *key,
                     const row_state *state)
{
  const char *effect = pw_key_needs_effect(key);
  if (effect) {
    return pw_yaml_find(r->root, effect) != NULL;
  }
  const pw_key *sibling = pw_key_needs_sibling(s->keys, key);
  row_state known = sibling ? state[sibling - s->keys] : STORED;
  if (known == WRONG || known == MISSPELT || (known == ABSENT && !sibling->fallback)) {
    return -1;
  }
  return pw_key_needs_met(s->keys, key, s->base);
}

static void check_row(pw_reader *r, const pw_reader_section *s, const pw_yaml_node *node,
                      const pw_key *key, const row_state *state)
{
  bool given = state[key - s->keys] >= WRONG, absent = state[key - s->keys] == ABSENT;
  int met = condition(r, s, key, state);
  if (given && met == 0) {
    const pw_yaml_node *child = pw_yaml_find(node, key->name);
    const char *effect = pw_key_needs_effect(key);
    pw_yaml_error(r->m, &child->key_place, "'%s' needs %s%s", key->name, key->needs,
                  effect ? ", which is not in the scene" : "");
  }
  if (absent && met == 1 && !key->fallback) {
    pw_yaml_error(r->m, pw_reader_place(node), "missing key '%s' in %s: %s", key->name, s->title,
                  key->meaning ? key->meaning : "required");
  }
}

bool pw_reader_keys(pw_reader *r, const pw_reader_section *s, const pw_yaml_node *node)
{
  int before = r->m->n;
  row_state state[PW_READER_ROWS] = {ABSENT};
  if (node->kind != PW_YAML_MAP && !pw_yaml_is_null(node)) {
    char found[PW_YAML_SHOWN + 8];
    pw_yaml_describe(node, found);
    pw_yaml_error(r->m, &node->place, "%s must be a mapping of keys, found %s", s->title, found);
    return false;
  }
  for (const pw_yaml_node *child = node->first; child; child = child->next) {
    read_child(r, s, child, state);
  }
  for (const pw_key *key = s->keys; key->name; key++) {
    check_row(r, s, node, key, state);
  }
  return r->m->n == before;
}
