/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effect.h"
#include "engine/scene_check.h"
#include "io/scene_file_reader.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The entry that "layers.1: ..." speaks of, or the list itself. */
static const pw_yaml_node *entry_of(const pw_yaml_node *list, const char *rest)
{
  const pw_yaml_node *entry = list->first;
  if (list->kind != PW_YAML_LIST || rest[0] != '.' || !isdigit((unsigned char)rest[1])) {
    return list;
  }
  for (long k = strtol(rest + 1, NULL, 10); entry && k > 0; k--) {
    entry = entry->next;
  }
  return entry ? entry : list;
}

/* Report a broken rule at the key its message begins with, else at its section. */
static bool report(pw_reader *r, pw_status status, const pw_yaml_node *node)
{
  static const char letters[] = "abcdefghijklmnopqrstuvwxyz0123456789_";
  static const pw_yaml_place start = {-1, 1, 1};
  if (status == PW_OK) {
    return true;
  }
  char key[PW_NAME];
  const char *rule = pw_error_text();
  snprintf(key, sizeof key, "%.*s", (int)strspn(rule, letters), rule);
  const pw_yaml_node *child = node ? pw_yaml_find(node, key) : NULL;
  child = child ? entry_of(child, rule + strlen(key)) : NULL;
  const pw_yaml_place *place = node ? pw_reader_place(node) : &start;
  pw_yaml_error(r->m, child ? &child->place : place, "%s", rule);
  return false;
}

static bool all_clean(const pw_reader_part *part, int n)
{
  for (int i = 0; i < n; i++) {
    if (!part[i].clean) {
      return false;
    }
  }
  return true;
}

/* `implicit:` of a scene with a grid. */
static void check_grid_implicit(pw_reader *r)
{
  const bool asked = r->scene->method.update == PW_IMPLICIT;
  if (r->implicit.node && (r->method.clean || !r->method.node) && !asked) {
    pw_yaml_error(r->m, pw_reader_place(r->implicit.node),
                  "implicit: explicit steps have no use for it (method.update: implicit)");
  } else if (r->implicit.clean || (asked && !r->implicit.node)) {
    report(r, pw_scene_check_grid_implicit(r->scene), r->implicit.node);
  }
}

static void check_plane(pw_reader *r)
{
  const pw_scene *s = r->scene;
  r->grid.clean = r->grid.clean && r->geometry_known;
  if (r->grid.clean) {
    report(r, pw_scene_check_grid(s), r->grid.node);
  }
  if (r->time.clean) {
    report(r, pw_scene_check_time(s), r->time.node);
  }
  if (r->method.clean) {
    report(r, pw_scene_check_method(s), r->method.node);
  }
  if (r->output.clean) {
    report(r, pw_scene_check_output(s), r->output.node);
  }
  check_grid_implicit(r);
}

static bool all_bodies_clean(const pw_reader *r)
{
  return all_clean(r->material, r->scene->nmaterial) && all_clean(r->body, r->scene->nbody);
}

/* Whether body b and its material are clean. */
static bool body_clean(const pw_reader *r, int b)
{
  const int m = r->scene->body[b].material;
  return r->body[b].clean && m >= 0 && m < r->scene->nmaterial && r->material[m].clean;
}

/* Whether what effect i needs has been read: itself, the bodies it names, else all. Those it names in
 * another way (layers) it sees lie against each other: by_place. */
static bool effect_read(const pw_reader *r, int i, bool *by_place)
{
  const pw_scene *s = r->scene;
  const pw_scene_effect *e = &s->effect[i];
  const bool method = r->method.clean || !r->method.node; /* implicit steps know other effects */
  bool good = r->effect[i].clean && r->grid.clean && method;
  for (const pw_key *k = e->type->keys; k && k->name; k++) {
    if (k->type != PW_KEY_BODY) {
      continue;
    }
    int b;
    memcpy(&b, e->param + k->offset, sizeof b);
    const bool named = b >= 0 && b < s->nbody;
    good = good && (named ? body_clean(r, b) : all_bodies_clean(r));
    *by_place = *by_place || (!named && k->needs);
  }
  return good;
}

/* Materials, bodies, effects. What the rules of effects look at has to be read, but for places not to
 * be right: a body outside the grid does not hide that two contacts exclude each other. */
static void check_parts(pw_reader *r)
{
  const pw_scene *s = r->scene;
  bool read[PW_MAX_EFFECTS], by_place[PW_MAX_EFFECTS] = {false};
  for (int i = 0; i < s->neffect; i++) {
    read[i] = effect_read(r, i, &by_place[i]);
  }
  for (int i = 0; i < s->nmaterial; i++) {
    r->material[i].clean =
        r->material[i].clean && report(r, pw_scene_check_material(s, i), r->material[i].node);
  }
  for (int i = 0; i < s->nbody; i++) {
    r->body[i].clean =
        r->body[i].clean && r->grid.clean && report(r, pw_scene_check_body(s, i), r->body[i].node);
  }
  for (int i = 0; i < s->neffect; i++) {
    if (read[i] && (!by_place[i] || all_bodies_clean(r))) {
      report(r, pw_scene_check_effect(s, i), r->effect[i].node);
    }
  }
}

/* Rules are applied only where all they look at is clean: no errors that follow from errors. */
void pw_reader_check(pw_reader *r)
{
  const pw_scene *s = r->scene;
  if (s->geometry == PW_SOLID) {
    r->grid.clean = true; /* no rule of bodies and effects looks at the mesh */
    if (r->mesh.clean) {
      report(r, pw_scene_check_mesh(s), r->mesh.node);
    }
    if (r->implicit.clean) {
      report(r, pw_scene_check_implicit(s), r->implicit.node);
    }
  } else {
    check_plane(r);
  }
  check_parts(r);
}
