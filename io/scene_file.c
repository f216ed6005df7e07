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
  TOP_WORDS = 64        /* sections and effects */
};

static const pw_yaml_place file_start = {-1, 1, 1};

/* Keys of the top level itself; its sections are only recognised here. */
static void read_top(pw_reader *r)
{
  const char *word[TOP_WORDS] = {"grid", "time", "method", "output", "materials", "bodies"};
  int n = 6;
  for (int i = 0; n < TOP_WORDS && pw_effect_at(i); i++) {
    word[n++] = pw_effect_at(i)->name;
  }
  pw_reader_section s = {"the scene", pw_scene_keys_top, r->scene, n, word};
  pw_reader_keys(r, &s, r->root);
  const pw_key *key = pw_key_find(pw_scene_keys_top, "geometry");
  const pw_yaml_node *node = pw_yaml_find(r->root, "geometry");
  r->geometry_known = node && node->kind == PW_YAML_SCALAR &&
                      pw_key_choice(key->choices, node->text) == r->scene->geometry;
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
  read_part(r, "grid", pw_scene_keys_grid, &r->grid);
  read_part(r, "time", pw_scene_keys_time, &r->time);
  read_part(r, "method", pw_scene_keys_method, &r->method);
  read_part(r, "output", pw_scene_keys_output, &r->output);
  pw_reader_soils(r);
  pw_reader_materials(r);
  pw_reader_bodies(r);
  pw_reader_effects(r);
  pw_reader_check(r);
  snprintf(r->scene->file, sizeof r->scene->file, "%s", r->m->name);
}

/* The tree of the file with the --set entries applied, or NULL after an error. */
static pw_yaml_node *make_tree(int nset, pw_yaml_messages *m)
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
      pw_yaml_error(m, &file_start,
                    "the file is empty: a scene needs at least geometry, grid, "
                    "time, materials and bodies");
    } else {
      pw_yaml_error(m, &root->place, "a scene must be a mapping of sections");
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
  pw_yaml_node *root = scene ? make_tree(from->nset, &m) : NULL;
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
  const pw_reader_use use = {read_scene, NULL, out};
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
  const pw_reader_use use = {read_scene, NULL, out};
  return pw_reader_file(&from, &use, messages);
}
