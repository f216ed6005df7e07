/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/scene_file.h"

#include "engine/effect.h"
#include "engine/scene_check.h"
#include "io/scene_file_reader.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  FILE_BYTES = 1 << 20, /* largest scene file */
  TOP_WORDS = 64        /* sections and effects of both halves */
};

static const pw_yaml_place file_start = {-1, 1, 1};

static const char *const plane_sections[] = {"grid",   "time",      "method", "implicit",
                                             "output", "materials", "bodies"};
static const char *const solid_sections[] = {"mesh", "implicit", "output", "materials", "bodies"};

/* Sections and effects that scenes of a geometry may have. */
static int words_of(bool solid, const char **word)
{
  const char *const *section = solid ? solid_sections : plane_sections;
  const pw_effect *(*effect_at)(int) = solid ? pw_solid_effect_at : pw_effect_at;
  int n = solid ? (int)(sizeof solid_sections / sizeof *solid_sections)
                : (int)(sizeof plane_sections / sizeof *plane_sections);
  memcpy(word, section, (size_t)n * sizeof *word);
  for (int i = 0; n < TOP_WORDS / 2 && effect_at(i); i++) {
    word[n++] = effect_at(i)->name;
  }
  return n;
}

static bool among(const char *key, const char *const *word, int n)
{
  for (int i = 0; i < n; i++) {
    if (strcmp(key, word[i]) == 0) {
      return true;
    }
  }
  return false;
}

/* Sections of the other half are told apart from misspelt ones; *n words grow by those. */
static void refuse_foreign(pw_reader *r, bool solid, const char **word, int *n)
{
  const char *other[TOP_WORDS / 2];
  const int nother = words_of(!solid, other), own = *n;
  for (const pw_yaml_node *node = r->root->first; node; node = node->next) {
    if (among(node->key, other, nother) && !among(node->key, word, own)) {
      pw_yaml_error(r->m, &node->key_place, "'%s' is for scenes of geometry %s, this one is %s",
                    node->key, solid ? "plane_strain or axisymmetric" : "solid",
                    solid ? "solid" : "not");
      word[*n] = node->key;
      *n += *n < TOP_WORDS;
    }
  }
}

/* Whether the scene is for the implicit half: as it says, or else by the sections it has. */
static bool is_solid(const pw_reader *r)
{
  const pw_yaml_node *node = pw_yaml_find(r->root, "geometry");
  const char *choices = pw_key_find(pw_scene_keys_top, "geometry")->choices;
  const int given = node && node->kind == PW_YAML_SCALAR ? pw_key_choice(choices, node->text) : -1;
  return given >= 0 ? given == PW_SOLID
                    : pw_yaml_find(r->root, "mesh") ||
                          (pw_yaml_find(r->root, "implicit") && !pw_yaml_find(r->root, "grid"));
}

/* Keys of the top level itself; its sections are only recognised here. */
static void read_top(pw_reader *r)
{
  const char *word[TOP_WORDS + 1];
  const bool solid = is_solid(r);
  int n = words_of(solid, word);
  refuse_foreign(r, solid, word, &n);
  pw_reader_section s = {"the scene", pw_scene_keys_top, r->scene, n, word};
  pw_reader_keys(r, &s, r->root);
  const pw_key *key = pw_key_find(pw_scene_keys_top, "geometry");
  const pw_yaml_node *node = pw_yaml_find(r->root, "geometry");
  r->geometry_known = node && node->kind == PW_YAML_SCALAR &&
                      pw_key_choice(key->choices, node->text) == r->scene->geometry;
  r->scene->geometry = solid ? PW_SOLID : r->scene->geometry;
}

static bool has_required(const pw_key *keys)
{
  for (const pw_key *k = keys; k->name; k++) {
    if (!k->fallback && !k->needs) {
      return true;
    }
  }
  return false;
}

static void read_part(pw_reader *r, const char *name, const pw_key *keys, pw_reader_part *part)
{
  pw_reader_section s = {name, keys, r->scene, 0, NULL};
  part->node = pw_yaml_find(r->root, name);
  if (part->node) {
    part->clean = pw_reader_keys(r, &s, part->node);
  } else if (has_required(keys)) {
    pw_yaml_error(r->m, &file_start, "missing section '%s'", name);
  }
}

static void read_scene(pw_reader *r, void *unused)
{
  (void)unused;
  pw_scene_default(r->scene);
  read_top(r);
  if (r->scene->geometry == PW_SOLID) {
    read_part(r, "mesh", pw_scene_keys_mesh, &r->mesh);
    read_part(r, "implicit", pw_scene_keys_implicit, &r->implicit);
    read_part(r, "output", pw_scene_keys_solid_output, &r->output);
  } else {
    read_part(r, "grid", pw_scene_keys_grid, &r->grid);
    read_part(r, "time", pw_scene_keys_time, &r->time);
    read_part(r, "method", pw_scene_keys_method, &r->method);
    read_part(r, "output", pw_scene_keys_output, &r->output);
    read_part(r, "implicit", pw_scene_keys_grid_implicit, &r->implicit);
  }
  pw_reader_soils(r);
  pw_reader_materials(r);
  pw_reader_bodies(r);
  pw_reader_effects(r);
  pw_reader_check(r);
  snprintf(r->scene->file, sizeof r->scene->file, "%s", r->m->name);
  if (r->scene->geometry == PW_SOLID) {
    pw_scene_solid_times(r->scene);
  }
}

static const char scene_needs[] =
    "geometry, materials, bodies, and grid and time or mesh and implicit";

/* The tree of the file with the --set entries applied, or NULL after an error. */
static pw_yaml_node *make_tree(int nset, const pw_reader_use *use, pw_yaml_messages *m)
{
  static const unsigned char mark[] = {0xef, 0xbb, 0xbf}; /* some editors begin UTF-8 with it */
  if (m->length >= sizeof mark && memcmp(m->text, mark, sizeof mark) == 0) {
    m->text += sizeof mark;
    m->length -= sizeof mark;
  }
  if (m->length > FILE_BYTES) {
    pw_yaml_error(m, &file_start, "the file is too large: %zu bytes, at most %d", m->length,
                  (int)FILE_BYTES);
    return NULL;
  }
  pw_yaml_node *root = pw_yaml_parse(m->text, m->length, -1, m);
  if (root && root->kind != PW_YAML_MAP) {
    if (pw_yaml_is_null(root)) {
      pw_yaml_error(m, &file_start, "the file is empty: %s needs at least %s", use->what,
                    use->needs);
    } else {
      pw_yaml_error(m, &root->place, "%s must be a mapping of sections", use->what);
    }
    pw_yaml_free(&root);
  }
  for (int i = 0; root && i < nset; i++) {
    pw_yaml_set(root, i, m);
  }
  return root;
}

static pw_status finish(pw_yaml_messages *m, char **messages)
{
  pw_status status = PW_OK;
  if (m->n > 0) {
    *messages = pw_yaml_messages_text(m);
    m->out_of_memory = m->out_of_memory || !*messages;
    status = pw_error_set(PW_ERR_SCENE, __FILE__, __LINE__, __func__, "%s: %d errors in the scene",
                          m->name, m->n);
  }
  if (m->out_of_memory) {
    free(*messages);
    *messages = NULL;
    status = pw_error_set(PW_ERR_MEMORY, __FILE__, __LINE__, __func__, "%s: no memory to read it",
                          m->name);
  }
  return status;
}

static pw_status read_text(const char *text, size_t length, const pw_reader_source *from,
                           const pw_reader_use *use, char **messages)
{
  pw_yaml_messages m = {.name = from->name, .text = text, .length = length, .set = from->set};
  *messages = NULL;
  pw_scene *scene = calloc(1, sizeof *scene);
  m.out_of_memory = !scene;
  pw_yaml_node *root = scene ? make_tree(from->nset, use, &m) : NULL;
  if (root) {
    pw_reader reader = {.m = &m, .root = root, .scene = scene};
    use->read(&reader, use->ctx);
  }
  pw_status status = finish(&m, messages);
  if (status == PW_OK) {
    *use->out = *scene;
  }
  pw_yaml_free(&root);
  pw_yaml_messages_free(&m);
  free(scene);
  return status;
}

pw_status pw_scene_read_text(const char *text, size_t length, const char *name, int nset,
                             const char *const *set, pw_scene *out, char **messages)
{
  const pw_reader_source from = {name, nset, set};
  const pw_reader_use use = {read_scene, NULL, out, "a scene", scene_needs};
  return read_text(text, length, &from, &use, messages);
}

/* "path: error: why" as the messages of a file that cannot be read. */
static pw_status unreadable(const char *path, const char *why, char **messages)
{
  size_t size = strlen(path) + strlen(why) + 32;
  *messages = malloc(size);
  if (*messages) {
    snprintf(*messages, size, "%s: error: cannot read it: %s\n", path, why);
  }
  return pw_error_set(*messages ? PW_ERR_FILE : PW_ERR_MEMORY, __FILE__, __LINE__, __func__,
                      "%s: cannot read it: %s", path, why);
}

pw_status pw_reader_file(const pw_reader_source *from, const pw_reader_use *use, char **messages)
{
  const char *path = from->name;
  *messages = NULL;
  FILE *file = fopen(path, "rb");
  if (!file) {
    return unreadable(path, strerror(errno), messages);
  }
  char *text = malloc(FILE_BYTES + 1);
  errno = 0;
  size_t length = text ? fread(text, 1, FILE_BYTES + 1, file) : 0;
  bool failed = !text || ferror(file);
  const char *why = strerror(text ? errno : ENOMEM);
  fclose(file);
  pw_status status =
      failed ? unreadable(path, why, messages) : read_text(text, length, from, use, messages);
  free(text);
  return status;
}

pw_status pw_scene_read_file(const char *path, int nset, const char *const *set, pw_scene *out,
                             char **messages)
{
  const pw_reader_source from = {path, nset, set};
  const pw_reader_use use = {read_scene, NULL, out, "a scene", scene_needs};
  return pw_reader_file(&from, &use, messages);
}

/* The node that "boundary.2.group: ..." speaks of: the deepest one on the way that there is. */
static const pw_yaml_node *find_path(const pw_yaml_node *root, const char *message)
{
  const pw_yaml_node *node = root;
  const char *at = message;
  while (node) {
    char word[PW_NAME];
    const size_t n = strcspn(at, ".: ");
    snprintf(word, sizeof word, "%.*s", (int)(n < sizeof word ? n : 0), at);
    const pw_yaml_node *child = node->kind == PW_YAML_MAP ? pw_yaml_find(node, word) : NULL;
    if (node->kind == PW_YAML_LIST && word[0] >= '0' && word[0] <= '9') {
      child = pw_yaml_at(node, (int)strtol(word, NULL, 10));
    }
    if (!child) {
      break;
    }
    node = child;
    at += n;
    if (*at != '.') {
      break;
    }
    at++;
  }
  return node == root ? NULL : node;
}

typedef struct locating {
  const char *message;
  bool found;
} locating;

static void locate(pw_reader *r, void *ctx)
{
  locating *l = ctx;
  const pw_yaml_node *node = find_path(r->root, l->message);
  l->found = node != NULL;
  if (node) {
    const bool scalar = node->kind == PW_YAML_SCALAR && !pw_yaml_is_null(node);
    pw_yaml_error(r->m, scalar ? &node->place : pw_reader_place(node), "%s", l->message);
  }
}

char *pw_scene_locate(const char *path, int nset, const char *const *set, const char *message)
{
  char copy[1024], *messages = NULL;
  snprintf(copy, sizeof copy, "%s", message);
  locating l = {.message = copy};
  pw_scene *scene = calloc(1, sizeof *scene);
  const pw_reader_source from = {path, nset, set};
  const pw_reader_use use = {locate, &l, scene, "a scene", scene_needs};
  if (scene) {
    pw_reader_file(&from, &use, &messages);
  }
  free(scene);
  if (!l.found) {
    free(messages);
    messages = NULL;
  }
  return messages;
}
