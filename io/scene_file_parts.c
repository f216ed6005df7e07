/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effect.h"
#include "io/scene_file_reader.h"

#include <stdio.h>
#include <string.h>

enum { TITLE = 2 * PW_NAME };

static const pw_key no_keys[] = {{0}};

/* Names appear in file names, column names and paths of --set. */
static bool check_name(pw_reader *r, const pw_yaml_node *node, const char *what)
{
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  static const char others[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  const char *name = node->key;
  if (strlen(name) >= PW_NAME) {
    pw_yaml_error(r->m, &node->key_place, "the name of a %s may have %d characters, found %zu",
                  what, PW_NAME - 1, strlen(name));
    return false;
  }
  if (!*name || !strchr(letters, name[0]) || name[strspn(name, others)] != '\0') {
    char shown[PW_YAML_SHOWN];
    pw_yaml_shown(name, shown);
    pw_yaml_error(r->m, &node->key_place,
                  "the name '%s' of a %s must be of letters, digits, _ and -, with a letter first",
                  shown, what);
    return false;
  }
  return true;
}

/* The section `title:` of named entries, or NULL after an error. */
static const pw_yaml_node *named_section(pw_reader *r, const char *title)
{
  static const pw_yaml_place start = {-1, 1, 1};
  const pw_yaml_node *node = pw_yaml_find(r->root, title);
  if (!node) {
    pw_yaml_error(r->m, &start, "missing section '%s'", title);
    return NULL;
  }
  if (node->kind != PW_YAML_MAP || node->count == 0) {
    char found[PW_YAML_SHOWN + 8];
    pw_yaml_describe(node, found);
    pw_yaml_error(r->m, pw_yaml_is_null(node) ? &node->key_place : &node->place,
                  "%s must be a mapping of names, found %s%s", title,
                  node->kind == PW_YAML_MAP ? "an empty one: " : "", found);
    return NULL;
  }
  return node;
}

/* Whether there is room for one more of @p limit entries; reported once, at the first too many. */
static bool has_room(pw_reader *r, const pw_yaml_node *node, int count, int limit, const char *what)
{
  if (count < limit) {
    return true;
  }
  pw_yaml_error(r->m, pw_reader_place(node), "too many %s: %d at most", what, limit);
  return false;
}

/* The `model:` of a material, or NULL after an error. */
static const pw_material *read_model(pw_reader *r, const pw_yaml_node *entry, const char *title)
{
  const pw_yaml_node *node = pw_yaml_find(entry, "model");
  char found[PW_YAML_SHOWN + 8], hint[PW_YAML_HINT];
  if (entry->kind != PW_YAML_MAP && !pw_yaml_is_null(entry)) {
    pw_yaml_describe(entry, found);
    pw_yaml_error(r->m, &entry->place, "%s must be a mapping of keys, found %s", title, found);
    return NULL;
  }
  if (!node && pw_yaml_find(entry, "soil")) {
    return NULL; /* the soil gave none: reported there */
  }
  if (!node) {
    pw_yaml_error(r->m, pw_reader_place(entry), "missing key 'model' in %s", title);
    return NULL;
  }
  pw_yaml_describe(node, found);
  pw_yaml_nearest nearest = {.word = node->kind == PW_YAML_SCALAR ? node->text : ""};
  for (int i = 0; pw_material_at(i); i++) {
    if (strcmp(nearest.word, pw_material_at(i)->name) == 0) {
      return pw_material_at(i);
    }
    pw_yaml_nearest_offer(&nearest, pw_material_at(i)->name);
  }
  pw_yaml_nearest_hint(&nearest, hint);
  pw_yaml_error(r->m, &node->place, "'model': there is no material model %s%s", found, hint);
  return NULL;
}

static void read_material(pw_reader *r, int i)
{
  static const char *const extra[] = {"model", "soil"};
  pw_scene_material *m = &r->scene->material[i];
  const pw_yaml_node *node = r->material[i].node;
  char title[TITLE];
  snprintf(title, sizeof title, "materials.%s", m->name);
  m->model = read_model(r, node, title);
  if (m->model) {
    pw_reader_section s = {title, m->model->keys, m->param, 2, extra};
    pw_scene_defaults(m->model->keys, m->param);
    r->material[i].clean = pw_reader_keys(r, &s, node);
  }
}

void pw_reader_materials(pw_reader *r)
{
  pw_scene *scene = r->scene;
  const pw_yaml_node *section = named_section(r, "materials");
  for (const pw_yaml_node *node = section ? section->first : NULL; node; node = node->next) {
    if (pw_reader_repeated(r, node) || !check_name(r, node, "material")) {
      continue;
    }
    if (!has_room(r, node, scene->nmaterial, PW_MAX_MATERIALS, "materials")) {
      break;
    }
    int i = scene->nmaterial++;
    strcpy(scene->material[i].name, node->key);
    r->material[i].node = node;
    read_material(r, i);
  }
}

/* `refine:` of body @p b. */
static bool read_refine(pw_reader *r, const pw_yaml_node *node, const char *body, pw_scene_body *b)
{
  char title[TITLE + 32];
  bool clean = true;
  if (node->kind != PW_YAML_LIST) {
    char found[PW_YAML_SHOWN + 8];
    pw_yaml_describe(node, found);
    pw_yaml_error(r->m, &node->place, "'refine' must be a list of mappings, found %s", found);
    return false;
  }
  for (const pw_yaml_node *entry = node->first; entry; entry = entry->next) {
    if (!has_room(r, entry, b->nrefine, PW_MAX_REFINE, "entries of refine")) {
      return false;
    }
    snprintf(title, sizeof title, "%s.refine.%d", body, b->nrefine);
    pw_reader_section s = {title, pw_scene_keys_refine, &b->refine[b->nrefine++], 0, NULL};
    clean = pw_reader_keys(r, &s, entry) && clean;
  }
  return clean;
}

static void read_body(pw_reader *r, int i)
{
  static const char *const extra[] = {"refine"};
  pw_scene_body *b = &r->scene->body[i];
  const pw_yaml_node *node = r->body[i].node;
  const pw_yaml_node *refine = pw_yaml_find(node, "refine");
  char title[TITLE];
  snprintf(title, sizeof title, "bodies.%s", b->name);
  const bool solid = r->scene->geometry == PW_SOLID;
  const pw_key *keys = solid ? pw_scene_keys_solid_body : pw_scene_keys_body;
  pw_reader_section s = {title, keys, b, !solid, extra};
  pw_scene_defaults(keys, b);
  bool clean = pw_reader_keys(r, &s, node);
  if (refine && !solid) {
    clean = read_refine(r, refine, title, b) && clean;
  }
  if (b->shape == PW_SHAPE_PILE && b->tip != PW_TIP_FLAT && b->tip_length_m == 0) {
    b->tip_length_m = b->radius_m;
  }
  r->body[i].clean = clean;
}

void pw_reader_bodies(pw_reader *r)
{
  pw_scene *scene = r->scene;
  const pw_yaml_node *section = named_section(r, "bodies");
  for (const pw_yaml_node *node = section ? section->first : NULL; node; node = node->next) {
    if (pw_reader_repeated(r, node) || !check_name(r, node, "body")) {
      continue;
    }
    if (!has_room(r, node, scene->nbody, PW_MAX_BODIES, "bodies")) {
      break;
    }
    int i = scene->nbody++;
    strcpy(scene->body[i].name, node->key);
    r->body[i].node = node;
    read_body(r, i);
  }
}

/* The list inside an effect's section. */
static bool read_rows(pw_reader *r, const pw_effect_rows *rows, const pw_yaml_node *node,
                      const char *section, unsigned char *param)
{
  char title[TITLE + 32];
  bool clean = true;
  int count = 0;
  if (node->kind != PW_YAML_LIST) {
    char found[PW_YAML_SHOWN + 8];
    pw_yaml_describe(node, found);
    pw_yaml_error(r->m, &node->place, "'%s' must be a list of mappings, found %s", rows->name,
                  found);
    return false;
  }
  for (const pw_yaml_node *entry = node->first; entry; entry = entry->next) {
    if (!has_room(r, entry, count, rows->max, rows->name)) {
      return false;
    }
    snprintf(title, sizeof title, "%s.%s.%d", section, rows->name, count);
    unsigned char *row = param + rows->first + (size_t)count++ * rows->size;
    pw_scene_defaults(rows->keys, row);
    pw_reader_section s = {title, rows->keys, row, 0, NULL};
    clean = pw_reader_keys(r, &s, entry) && clean;
  }
  memcpy(param + rows->count, &count, sizeof count);
  return clean;
}

static bool read_instance(pw_reader *r, const pw_effect *type, const pw_yaml_node *node,
                          const char *title)
{
  int i = r->scene->neffect;
  if (!has_room(r, node, i, PW_MAX_EFFECTS, "entries of effects")) {
    return false;
  }
  const pw_effect_rows *rows = type->rows;
  const char *extra[] = {rows ? rows->name : NULL};
  unsigned char *param = pw_scene_add_effect(r->scene, type->name);
  pw_reader_section s = {title, type->keys ? type->keys : no_keys, param, rows != NULL, extra};
  r->effect[i].node = node;
  r->effect[i].clean = pw_reader_keys(r, &s, node);
  const pw_yaml_node *list = rows ? pw_yaml_find(node, rows->name) : NULL;
  if (list) {
    r->effect[i].clean = read_rows(r, rows, list, title, param) && r->effect[i].clean;
  }
  return true;
}

static bool read_effect(pw_reader *r, const pw_effect *type, const pw_yaml_node *node)
{
  if (!type->many) {
    return read_instance(r, type, node, type->name);
  }
  if (node->kind != PW_YAML_LIST) {
    char found[PW_YAML_SHOWN + 8];
    pw_yaml_describe(node, found);
    pw_yaml_error(r->m, pw_yaml_is_null(node) ? &node->key_place : &node->place,
                  "%s must be a list of mappings, each beginning with '- ', found %s", type->name,
                  found);
    return true;
  }
  int entry = 0;
  for (const pw_yaml_node *child = node->first; child; child = child->next) {
    char title[TITLE];
    snprintf(title, sizeof title, "%s.%d", type->name, entry++);
    if (!read_instance(r, type, child, title)) {
      return false;
    }
  }
  return true;
}

void pw_reader_effects(pw_reader *r)
{
  for (const pw_yaml_node *node = r->root->first; node; node = node->next) {
    const pw_effect *type = node->earlier ? NULL : pw_effect_of(r->scene, node->key);
    if (type && !read_effect(r, type, node)) {
      return;
    }
  }
}
