/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/yaml_tree.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

enum {
  DEPTH = 16,     /* levels of nesting; a scene needs 5 */
  CHILDREN = 1000 /* entries of one mapping or list */
};

/* The tree under construction: open mappings and lists, and a key that waits for its value. */
typedef struct {
  pw_yaml_messages *m;
  int set;
  pw_yaml_node *root;
  pw_yaml_node *open[DEPTH];
  int depth;
  char *key;
  pw_yaml_place key_place;
  int documents;
} builder;

pw_yaml_node *pw_yaml_node_new(pw_yaml_kind kind, pw_yaml_place place)
{
  pw_yaml_node *node = calloc(1, sizeof *node);
  if (node) {
    node->kind = kind;
    node->place = node->key_place = place;
  }
  return node;
}

void pw_yaml_append(pw_yaml_node *parent, pw_yaml_node *child)
{
  if (parent->kind == PW_YAML_MAP) {
    child->earlier = pw_yaml_find(parent, child->key);
  }
  if (parent->last) {
    parent->last->next = child;
  } else {
    parent->first = child;
  }
  parent->last = child;
  parent->count++;
}

void pw_yaml_free(pw_yaml_node **root)
{
  if (!*root) {
    return;
  }
  for (pw_yaml_node *child = (*root)->first; child;) {
    pw_yaml_node *next = child->next;
    pw_yaml_free(&child);
    child = next;
  }
  free((*root)->text);
  free((*root)->key);
  free(*root);
  *root = NULL;
}

pw_yaml_node *pw_yaml_find(const pw_yaml_node *map, const char *key)
{
  for (pw_yaml_node *child = map->first; map->kind == PW_YAML_MAP && child; child = child->next) {
    if (strcmp(child->key, key) == 0) {
      return child;
    }
  }
  return NULL;
}

pw_yaml_node *pw_yaml_at(const pw_yaml_node *parent, int i)
{
  pw_yaml_node *child = i >= 0 ? parent->first : NULL;
  while (child && i-- > 0) {
    child = child->next;
  }
  return child;
}

bool pw_yaml_is_null(const pw_yaml_node *node)
{
  return node->kind == PW_YAML_SCALAR && node->plain &&
         (node->text[0] == '\0' || strcmp(node->text, "~") == 0 || strcmp(node->text, "null") == 0);
}

void pw_yaml_describe(const pw_yaml_node *node, char *out)
{
  char shown[PW_YAML_SHOWN] = "";
  if (pw_yaml_is_null(node)) {
    strcpy(out, "nothing");
  } else if (node->kind != PW_YAML_SCALAR) {
    strcpy(out, node->kind == PW_YAML_MAP ? "a mapping" : "a list");
  } else {
    pw_yaml_shown(node->text, shown);
    snprintf(out, PW_YAML_SHOWN + 8, "'%s'", shown);
  }
}

static pw_yaml_place place_of(const builder *b, const yaml_mark_t *mark)
{
  return (pw_yaml_place){b->set, (int)mark->line + 1, (int)mark->column + 1};
}

static bool refuse(builder *b, const yaml_mark_t *mark, const char *what)
{
  pw_yaml_place place = place_of(b, mark);
  pw_yaml_error(b->m, &place, "%s", what);
  return false;
}

static char *copy_text(builder *b, const void *text, size_t length)
{
  char *copy = malloc(length + 1);
  if (!copy) {
    b->m->out_of_memory = true;
    return NULL;
  }
  memcpy(copy, text, length);
  copy[length] = '\0';
  return copy;
}

/* Attach a finished scalar, or a mapping or list that begins, where the builder stands. */
static bool attach(builder *b, const yaml_event_t *e, pw_yaml_node *node)
{
  if (!node) {
    b->m->out_of_memory = true;
    return false;
  }
  if (b->depth > 0 && b->open[b->depth - 1]->count == CHILDREN) {
    pw_yaml_free(&node);
    return refuse(b, &e->start_mark, "too many entries");
  }
  if (b->depth == 0) {
    b->root = node;
    return true;
  }
  pw_yaml_node *parent = b->open[b->depth - 1];
  if (parent->kind == PW_YAML_MAP) {
    node->key = b->key;
    node->key_place = b->key_place;
    b->key = NULL;
  }
  pw_yaml_append(parent, node);
  return true;
}

static bool wants_key(const builder *b)
{
  return b->depth > 0 && b->open[b->depth - 1]->kind == PW_YAML_MAP && !b->key;
}

static bool on_scalar(builder *b, const yaml_event_t *e)
{
  const char *text = (const char *)e->data.scalar.value;
  size_t length = e->data.scalar.length;
  char *copy = copy_text(b, text, length);
  if (!copy) {
    return false;
  }
  if (wants_key(b)) {
    b->key = copy;
    b->key_place = place_of(b, &e->start_mark);
    return strlen(copy) == length || refuse(b, &e->start_mark, "a key with a zero character");
  }
  pw_yaml_node *node = pw_yaml_node_new(PW_YAML_SCALAR, place_of(b, &e->start_mark));
  if (!node) {
    free(copy);
    return attach(b, e, NULL);
  }
  node->text = copy;
  node->plain = e->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
  node->has_zero = strlen(copy) != length;
  return attach(b, e, node);
}

static bool on_start(builder *b, const yaml_event_t *e, pw_yaml_kind kind)
{
  if (wants_key(b)) {
    return refuse(b, &e->start_mark, "a key must be a word, not a mapping or list");
  }
  if (b->depth == DEPTH) {
    return refuse(b, &e->start_mark, "nested too deeply");
  }
  pw_yaml_node *node = pw_yaml_node_new(kind, place_of(b, &e->start_mark));
  if (!attach(b, e, node)) {
    return false;
  }
  b->open[b->depth++] = node;
  return true;
}

/* Anchors and tags would only hide what a scene says. */
static bool is_bare(builder *b, const yaml_event_t *e)
{
  const void *anchor = NULL, *tag = NULL;
  if (e->type == YAML_SCALAR_EVENT) {
    anchor = e->data.scalar.anchor;
    tag = e->data.scalar.tag;
  } else if (e->type == YAML_SEQUENCE_START_EVENT) {
    anchor = e->data.sequence_start.anchor;
    tag = e->data.sequence_start.tag;
  } else if (e->type == YAML_MAPPING_START_EVENT) {
    anchor = e->data.mapping_start.anchor;
    tag = e->data.mapping_start.tag;
  }
  if (anchor) {
    return refuse(b, &e->start_mark, "anchors (&name) cannot be used in a scene");
  }
  return !tag || refuse(b, &e->start_mark, "tags (!name) cannot be used in a scene");
}

static bool on_event(builder *b, const yaml_event_t *e)
{
  if (!is_bare(b, e)) {
    return false;
  }
  switch (e->type) {
  case YAML_SCALAR_EVENT:
    return on_scalar(b, e);
  case YAML_MAPPING_START_EVENT:
    return on_start(b, e, PW_YAML_MAP);
  case YAML_SEQUENCE_START_EVENT:
    return on_start(b, e, PW_YAML_LIST);
  case YAML_MAPPING_END_EVENT:
  case YAML_SEQUENCE_END_EVENT:
    b->depth--;
    return true;
  case YAML_ALIAS_EVENT:
    return refuse(b, &e->start_mark, "aliases (*name) cannot be used in a scene");
  case YAML_DOCUMENT_START_EVENT:
    return b->documents++ == 0 || refuse(b, &e->start_mark,
                                         "a second document begins here; a "
                                         "scene file holds one");
  default:
    return true;
  }
}

/* What the parser objects to, at the place that helps most. */
static void syntax_error(builder *b, const yaml_parser_t *p)
{
  if (p->error == YAML_MEMORY_ERROR) {
    b->m->out_of_memory = true;
    return;
  }
  pw_yaml_place place = place_of(b, &p->problem_mark);
  const char *problem = p->problem ? p->problem : "not valid";
  if (p->error == YAML_READER_ERROR) {
    if (b->set == -1) {
      place = pw_yaml_place_at(b->m, p->problem_offset);
    }
    pw_yaml_error(b->m, &place, "not a text file in UTF-8: %s", problem);
  } else if (p->buffer.pointer < p->buffer.last && *p->buffer.pointer == '\t') {
    pw_yaml_error(b->m, &place, "a tab cannot be used here; indent with spaces");
  } else if (strcmp(problem, "could not find expected ':'") == 0) {
    place = place_of(b, &p->context_mark);
    pw_yaml_error(b->m, &place, "not valid YAML: a key without ':' after it");
  } else {
    bool key = strcmp(problem, "did not find expected key") == 0;
    pw_yaml_error(b->m, &place, "not valid YAML: %s%s%s%s", problem, p->context ? " " : "",
                  p->context ? p->context : "", key ? "; check the indentation" : "");
  }
}

static bool build(builder *b, yaml_parser_t *p)
{
  for (bool more = true; more;) {
    yaml_event_t event;
    if (!yaml_parser_parse(p, &event)) {
      syntax_error(b, p);
      return false;
    }
    more = event.type != YAML_STREAM_END_EVENT;
    bool fine = on_event(b, &event);
    yaml_event_delete(&event);
    if (!fine) {
      return false;
    }
  }
  return true;
}

static pw_yaml_node *empty_scalar(builder *b)
{
  pw_yaml_node *node = pw_yaml_node_new(PW_YAML_SCALAR, (pw_yaml_place){b->set, 1, 1});
  if (node) {
    node->plain = true;
    node->text = copy_text(b, "", 0);
  }
  if (!node || !node->text) {
    b->m->out_of_memory = true;
    pw_yaml_free(&node);
  }
  return node;
}

pw_yaml_node *pw_yaml_parse(const char *text, size_t length, int set, pw_yaml_messages *m)
{
  yaml_parser_t parser;
  if (!yaml_parser_initialize(&parser)) {
    m->out_of_memory = true;
    return NULL;
  }
  builder b = {.m = m, .set = set};
  yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, length);
  bool fine = build(&b, &parser);
  yaml_parser_delete(&parser);
  free(b.key);
  if (!fine) {
    pw_yaml_free(&b.root);
    return NULL;
  }
  return b.root ? b.root : empty_scalar(&b);
}
