/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Named parameter sets: `soil: NAME` in a material takes model and keys from the file NAME.yaml. */
#include "io/atomic_file.h"
#include "io/scene_file_reader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LEVELS = 10, SOIL_BYTES = 1 << 16 };

/** Cut the last part of a path, or add one ".." to what cannot be cut; false at the root. */
static bool parent_of(char *folder)
{
  char *slash = strrchr(folder, '/');
  const char *last = slash ? slash + 1 : folder;
  if (strcmp(folder, "/") == 0) {
    return false;
  }
  if (strcmp(last, "..") == 0 || strcmp(last, ".") == 0 || *last == '\0') {
    if (strlen(folder) + 4 > PW_PATH) {
      return false;
    }
    strcpy(strcmp(folder, ".") == 0 ? folder : folder + strlen(folder),
           strcmp(folder, ".") == 0 ? ".." : "/..");
  } else if (slash == folder) {
    strcpy(folder, "/");
  } else if (slash) {
    *slash = '\0';
  } else {
    strcpy(folder, ".");
  }
  return true;
}

/** Look for the file in the folders soils and cases/soils of @p folder and of those above it. */
static bool find_above(char *folder, const char *name, char *path)
{
  for (int level = 0; level < LEVELS; level++) {
    const char *const place[] = {"soils", "cases/soils"};
    for (int k = 0; k < 2; k++) {
      bool here = strcmp(folder, ".") == 0;
      int n = snprintf(path, PW_PATH, "%s%s%s/%s.yaml", here ? "" : folder, here ? "" : "/",
                       place[k], name);
      if (n > 0 && n < PW_PATH && access(path, R_OK) == 0) {
        return true;
      }
    }
    if (!parent_of(folder)) {
      break;
    }
  }
  return false;
}

static bool find_file(const char *scene, const char *name, char *path)
{
  char folder[PW_PATH];
  snprintf(folder, sizeof folder, "%s", scene);
  parent_of(folder); /* from the file to its folder */
  if (find_above(folder, name, path)) {
    return true;
  }
  strcpy(folder, ".");
  if (find_above(folder, name, path)) {
    return true;
  }
  ssize_t n = readlink("/proc/self/exe", folder, sizeof folder - 1);
  folder[n > 0 ? n : 0] = '\0';
  return n > 0 && parent_of(folder) && find_above(folder, name, path);
}

/** Text of a file as a further file of the messages; its index, or -1. */
static int load(pw_yaml_messages *m, const char *path)
{
  FILE *file = m->nfile < PW_YAML_FILES ? fopen(path, "rb") : NULL;
  if (!file) {
    return -1;
  }
  pw_yaml_file f = {.name = malloc(strlen(path) + 1), .text = malloc(SOIL_BYTES)};
  bool good = f.name && f.text;
  if (good) {
    strcpy(f.name, path);
    f.length = fread(f.text, 1, SOIL_BYTES, file);
    good = !ferror(file) && f.length < SOIL_BYTES;
  }
  fclose(file);
  if (!good) {
    free(f.name);
    free(f.text);
    return -1;
  }
  m->file[m->nfile] = f;
  return m->nfile++;
}

/** Move the keys of a soil into an entry that lacks them. */
static void merge(pw_reader *r, pw_yaml_node *entry, pw_yaml_node *soil)
{
  const pw_yaml_node *own = pw_yaml_find(entry, "model"), *model = pw_yaml_find(soil, "model");
  const pw_yaml_node *source = pw_yaml_find(soil, "source");
  if (!source || source->kind != PW_YAML_SCALAR || pw_yaml_is_null(source)) {
    pw_yaml_error(r->m, &soil->place,
                  "a soil needs a text 'source': where its parameters are from");
  }
  if (!model) {
    pw_yaml_error(r->m, &soil->place, "missing key 'model' in a soil");
  }
  if (own && model && own->kind == PW_YAML_SCALAR && model->kind == PW_YAML_SCALAR &&
      strcmp(own->text, model->text) != 0) {
    pw_yaml_error(r->m, &own->place, "'model' is '%s', but the soil is for '%s'", own->text,
                  model->text);
  }
  pw_yaml_node *child = soil->first, *left = NULL;
  soil->first = soil->last = NULL;
  while (child) {
    pw_yaml_node *next = child->next;
    child->next = NULL;
    if (strcmp(child->key, "source") == 0 || (pw_yaml_find(entry, child->key) && !child->earlier)) {
      child->next = left;
      left = child;
    } else {
      pw_yaml_append(entry, child);
    }
    child = next;
  }
  soil->first = left; /* freed with the rest of the soil's tree */
}

static void include(pw_reader *r, pw_yaml_node *entry, const pw_yaml_node *node)
{
  char path[PW_PATH] = "", shown[PW_YAML_SHOWN + 8];
  const char *others = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  pw_yaml_describe(node, shown);
  if (node->kind != PW_YAML_SCALAR || !*node->text || node->text[strspn(node->text, others)]) {
    pw_yaml_error(r->m, &node->place, "'soil' must be the name of a soil, found %s", shown);
    return;
  }
  if (!find_file(r->m->name, node->text, path)) {
    pw_yaml_error(r->m, &node->place,
                  "'soil': there is no file %.60s.yaml in a folder soils or cases/soils here or "
                  "above",
                  node->text);
    return;
  }
  int index = load(r->m, path);
  if (index < 0) {
    pw_yaml_error(r->m, &node->place, "'soil': cannot read %.200s (at most %d soils of %d bytes)",
                  path, (int)PW_YAML_FILES, (int)SOIL_BYTES);
    return;
  }
  const pw_yaml_file *f = &r->m->file[index];
  pw_yaml_node *soil = pw_yaml_parse(f->text, f->length, -2 - index, r->m);
  if (soil && soil->kind == PW_YAML_MAP) {
    merge(r, entry, soil);
  } else if (soil) {
    pw_yaml_error(r->m, &soil->place, "a soil must be a mapping of keys");
  }
  pw_yaml_free(&soil);
}

void pw_reader_soils(pw_reader *r)
{
  const pw_yaml_node *section = pw_yaml_find(r->root, "materials");
  if (!section || section->kind != PW_YAML_MAP) {
    return;
  }
  for (pw_yaml_node *entry = section->first; entry; entry = entry->next) {
    const pw_yaml_node *soil = pw_yaml_find(entry, "soil");
    if (soil) {
      include(r, entry, soil);
    }
  }
}
