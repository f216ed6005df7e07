/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/yaml_tree.h"

#include <stdlib.h>
#include <string.h>

enum { SEGMENT = 128, SEGMENTS = 8, LARGEST_INDEX = 999 };

/* One `--set` entry taken apart: a.b.0.c=value. */
typedef struct {
  pw_yaml_place place;
  char segment[SEGMENTS][SEGMENT];
  int n;
  const char *value; /* in the entry */
} assignment;

static bool split_path(const char *entry, assignment *a, pw_yaml_messages *m)
{
  const char *equals = strchr(entry, '=');
  if (!equals || equals == entry) {
    pw_yaml_error(m, &a->place, "expected key.path=value");
    return false;
  }
  for (const char *c = entry; c <= equals; a->n++) {
    size_t n = strcspn(c, ".=");
    if (n == 0 || n >= SEGMENT || a->n == SEGMENTS) {
      pw_yaml_error(m, &a->place, "expected names and list indices separated by points before '='");
      return false;
    }
    memcpy(a->segment[a->n], c, n);
    a->segment[a->n][n] = '\0';
    c += n + 1;
  }
  a->value = equals + 1;
  return true;
}

/* Index written as a segment, or -1 when the segment is a name. */
static int index_of(const char *segment)
{
  int value = 0;
  for (const char *c = segment; *c; c++) {
    if (*c < '0' || *c > '9' || value > LARGEST_INDEX) {
      return -1;
    }
    value = 10 * value + (*c - '0');
  }
  return value;
}

static char *duplicate(const char *text, pw_yaml_messages *m)
{
  char *copy = malloc(strlen(text) + 1);
  if (!copy) {
    m->out_of_memory = true;
    return NULL;
  }
  return strcpy(copy, text);
}

/* A value in brackets, braces or quotes is YAML; anything else is taken literally. */
static pw_yaml_node *value_node(const assignment *a, pw_yaml_messages *m)
{
  char first = a->value[0];
  if (first == '[' || first == '{' || first == '"' || first == '\'') {
    return pw_yaml_parse(a->value, strlen(a->value), a->place.set, m);
  }
  pw_yaml_node *node = pw_yaml_node_new(PW_YAML_SCALAR, a->place);
  if (node) {
    node->plain = true;
    node->text = duplicate(a->value, m);
  }
  if (!node || !node->text) {
    m->out_of_memory = true;
    pw_yaml_free(&node);
  }
  return node;
}

/* Put @p node in the place of @p old, under the same key; the old content is freed. */
static void replace(pw_yaml_node *old, pw_yaml_node *node)
{
  pw_yaml_node content = *old;
  old->kind = node->kind;
  old->place = node->place;
  old->text = node->text;
  old->plain = node->plain;
  old->has_zero = node->has_zero;
  old->count = node->count;
  old->first = node->first;
  old->last = node->last;
  old->key_place = node->place;
  node->text = content.text;
  node->first = content.first;
  node->last = content.last;
  pw_yaml_free(&node);
}

/* A new child under a segment; takes ownership of @p node, frees it on failure. */
static pw_yaml_node *add_child(pw_yaml_node *parent, const char *segment, pw_yaml_node *node,
                               pw_yaml_messages *m)
{
  if (node && parent->kind == PW_YAML_MAP) {
    node->key = duplicate(segment, m);
    node->key_place = node->place;
  }
  if (!node || (parent->kind == PW_YAML_MAP && !node->key)) {
    m->out_of_memory = true;
    pw_yaml_free(&node);
    return NULL;
  }
  pw_yaml_append(parent, node);
  return node;
}

/* The child a segment names; NULL when there is none yet. False after an error. */
static bool find_child(const pw_yaml_node *parent, const assignment *a, int i, pw_yaml_messages *m,
                       pw_yaml_node **child)
{
  const char *segment = a->segment[i];
  *child = NULL;
  if (parent->kind == PW_YAML_MAP) {
    *child = pw_yaml_find(parent, segment);
    return true;
  }
  int index = index_of(segment);
  if (index < 0 || index > parent->count) {
    char shown[PW_YAML_SHOWN];
    pw_yaml_shown(segment, shown);
    pw_yaml_error(m, &a->place, "'%s' must be the index of one of %d list entries, or %d to append",
                  shown, parent->count, parent->count);
    return false;
  }
  *child = pw_yaml_at(parent, index);
  return true;
}

/* Make a mapping or list, as segment @p i asks, of a child that is missing or empty. */
static pw_yaml_node *open_child(pw_yaml_node *parent, pw_yaml_node *child, const assignment *a,
                                int i, pw_yaml_messages *m)
{
  if (child && child->kind != PW_YAML_SCALAR) {
    return child;
  }
  if (child && !pw_yaml_is_null(child)) {
    pw_yaml_error(m, &a->place, "'%.60s' is a value, it has no '%.60s'", a->segment[i - 1],
                  a->segment[i]);
    return NULL;
  }
  pw_yaml_kind kind = index_of(a->segment[i]) >= 0 ? PW_YAML_LIST : PW_YAML_MAP;
  pw_yaml_node *node = pw_yaml_node_new(kind, a->place);
  if (child && node) {
    replace(child, node);
    return child;
  }
  return add_child(parent, a->segment[i - 1], node, m);
}

static void assign(pw_yaml_node *root, const assignment *a, pw_yaml_messages *m)
{
  pw_yaml_node *parent = root, *child = NULL;
  for (int i = 0; i < a->n; i++) {
    if (!find_child(parent, a, i, m, &child)) {
      return;
    }
    if (i + 1 < a->n) {
      parent = open_child(parent, child, a, i + 1, m);
      if (!parent) {
        return;
      }
    }
  }
  pw_yaml_node *node = value_node(a, m);
  if (node && child) {
    replace(child, node);
  } else if (node) {
    add_child(parent, a->segment[a->n - 1], node, m);
  }
}

void pw_yaml_set(pw_yaml_node *root, int set, pw_yaml_messages *m)
{
  assignment a = {.place = {set, 1, 1}};
  if (split_path(m->set[set], &a, m)) {
    assign(root, &a, m);
  }
}
