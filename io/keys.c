/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/keys.h"

#include "engine/scene_keys.h"
#include "engine/sim_state.h"

#include <stdlib.h>
#include <string.h>

/* Suffixes of names and their units; the longest that fits is taken. */
static const struct {
  const char *suffix, *unit;
} units[] = {
    {"_m", "m"},       {"_m2", "m2"},       {"_m3", "m3"},         {"_s", "s"},
    {"_m_s", "m/s"},   {"_m_s2", "m/s2"},   {"_kg_m3", "kg/m3"},   {"_kg", "kg"},
    {"_pa", "Pa"},     {"_pa_m", "Pa/m"},   {"_force_n", "N"},     {"_n_m3", "N/m3"},
    {"_per_s", "1/s"}, {"_pa_s", "Pa s"},   {"_pa_s_m", "Pa s/m"}, {"_deg", "deg"},
    {"_rad", "rad"},   {"_rad_s", "rad/s"}, {"_hz", "Hz"},         {"_cells", "cells"},
};

const char *pw_key_unit(const pw_key *key)
{
  size_t n = strlen(key->name), longest = 0;
  const char *unit = "-";
  for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
    size_t ns = strlen(units[i].suffix);
    if (ns < n && ns > longest && strcmp(key->name + n - ns, units[i].suffix) == 0) {
      unit = units[i].unit;
      longest = ns;
    }
  }
  return unit;
}

enum { DIGITS = 26 /* of a number with 17 digits, sign, point and exponent */ };

/* As few digits as tell the number from every other. */
static const char *digits(pw_real value, char text[DIGITS])
{
  for (int n = 6; n <= 17; n++) {
    snprintf(text, DIGITS, "%.*g", n, value);
    if (strtod(text, NULL) == value) {
      break;
    }
  }
  return text;
}

void pw_key_range(const pw_key *key, char *out)
{
  char low[DIGITS], high[DIGITS];
  bool below = key->lo <= -PW_HUGE, above = key->hi >= PW_HUGE, positive = key->lo == PW_TINY;
  out[0] = '\0';
  if (key->type != PW_KEY_REAL && key->type != PW_KEY_PAIR && key->type != PW_KEY_TRIPLE &&
      key->type != PW_KEY_REALS && key->type != PW_KEY_INT) {
    return;
  }
  if (below && above) {
    snprintf(out, PW_KEY_RANGE, "any");
  } else if (positive && above) {
    snprintf(out, PW_KEY_RANGE, "> 0");
  } else if (positive) {
    snprintf(out, PW_KEY_RANGE, "> 0 and <= %s", digits(key->hi, high));
  } else if (above) {
    snprintf(out, PW_KEY_RANGE, ">= %s", digits(key->lo, low));
  } else if (below) {
    snprintf(out, PW_KEY_RANGE, "<= %s", digits(key->hi, high));
  } else {
    snprintf(out, PW_KEY_RANGE, "%s to %s", digits(key->lo, low), digits(key->hi, high));
  }
}

const char *pw_key_type_text(pw_key_type type)
{
  switch (type) {
  case PW_KEY_REAL:
    return "number";
  case PW_KEY_PAIR:
    return "[a, b]";
  case PW_KEY_TRIPLE:
    return "[x, y, z]";
  case PW_KEY_REALS:
    return "[a, b, ...]";
  case PW_KEY_INT:
    return "whole number";
  case PW_KEY_BOOL:
    return "true | false";
  case PW_KEY_CHOICE:
    return "word";
  case PW_KEY_TEXT:
    return "text";
  case PW_KEY_FILE:
    return "file";
  case PW_KEY_BODY:
    return "body";
  case PW_KEY_MATERIAL:
    return "material";
  }
  return "";
}

enum { COLUMNS = 6 };

/* The columns before the meaning: name, unit, type, range or choices, default, needs. */
static void cells_of(const pw_key *key, char range[PW_KEY_RANGE], const char *cell[COLUMNS])
{
  pw_key_range(key, range);
  cell[0] = key->name;
  cell[1] = pw_key_unit(key);
  cell[2] = pw_key_type_text(key->type);
  cell[3] = key->type == PW_KEY_CHOICE ? key->choices : range[0] ? range : "-";
  cell[4] = key->fallback ? key->fallback : "required";
  cell[5] = key->needs ? key->needs : "-";
  if (key->fallback && (key->type == PW_KEY_BODY || key->fallback[0] == '\0')) {
    cell[4] = key->type == PW_KEY_BODY ? "none" : "\"\"";
  }
}

static void print_table(FILE *out, const char *title, const char *brief, const pw_key *keys)
{
  static const char *const head[COLUMNS] = {"key", "unit", "type", "range", "default", "needs"};
  int width[COLUMNS];
  char range[PW_KEY_RANGE];
  const char *cell[COLUMNS];
  for (int c = 0; c < COLUMNS; c++) {
    width[c] = (int)strlen(head[c]);
  }
  for (const pw_key *k = keys; k && k->name; k++) {
    cells_of(k, range, cell);
    for (int c = 0; c < COLUMNS; c++) {
      int n = (int)strlen(cell[c]);
      width[c] = n > width[c] ? n : width[c];
    }
  }
  fprintf(out, "\n%s\n", title);
  if (brief && brief[0]) {
    fprintf(out, "  %s\n", brief);
  }
  for (int c = 0; keys && keys->name && c < COLUMNS; c++) {
    fprintf(out, "  %-*s", width[c], head[c]);
  }
  fprintf(out, keys && keys->name ? "  meaning\n" : "  (no keys)\n");
  for (const pw_key *k = keys; k && k->name; k++) {
    cells_of(k, range, cell);
    for (int c = 0; c < COLUMNS; c++) {
      fprintf(out, "  %-*s", width[c], cell[c]);
    }
    fprintf(out, "  %s\n", k->meaning ? k->meaning : "");
  }
}

void pw_keys_print_table(FILE *out, const char *title, const char *brief, const pw_key *keys)
{
  print_table(out, title, brief, keys);
}

static void print_effect(FILE *out, const pw_effect *e, const char *where)
{
  char title[3 * PW_NAME];
  snprintf(title, sizeof title, "%s%s: (effect%s)", where, e->name, e->many ? ", a list" : "");
  print_table(out, title, e->brief, e->keys);
  if (e->rows) {
    snprintf(title, sizeof title, "%s%s: %s: (a list)", where, e->name, e->rows->name);
    print_table(out, title, e->rows->meaning, e->rows->keys);
  }
}

/* Sections of scenes that the implicit half runs. */
static void print_solid(FILE *out)
{
  print_table(out, "geometry solid, mesh:", NULL, pw_scene_keys_mesh);
  print_table(out, "geometry solid, implicit:", NULL, pw_scene_keys_implicit);
  print_table(out, "geometry solid, output:", NULL, pw_scene_keys_solid_output);
  print_table(out, "geometry solid, bodies: NAME:", NULL, pw_scene_keys_solid_body);
  for (int i = 0; pw_solid_effect_at(i); i++) {
    print_effect(out, pw_solid_effect_at(i), "geometry solid, ");
  }
}

void pw_keys_print(FILE *out)
{
  char title[3 * PW_NAME];
  fprintf(out, "Keys of a scene file. Numbers in SI units; `needs` names an effect that must be in "
               "the scene,\nor the value of another key of the same section.\n");
  print_table(out, "top level", NULL, pw_scene_keys_top);
  print_table(out, "grid:", NULL, pw_scene_keys_grid);
  print_table(out, "time:", NULL, pw_scene_keys_time);
  print_table(out, "method:", NULL, pw_scene_keys_method);
  print_table(out, "output:", NULL, pw_scene_keys_output);
  print_table(out, "implicit:", "with method.update: implicit", pw_scene_keys_grid_implicit);
  for (int i = 0; pw_material_at(i); i++) {
    snprintf(title, sizeof title, "materials: NAME: with model: %s", pw_material_at(i)->name);
    print_table(out, title, pw_material_at(i)->brief, pw_material_at(i)->keys);
  }
  fprintf(out, "\nmaterials: NAME: with soil: SET\n  model and keys from the file SET.yaml in a "
               "folder soils or cases/soils here or above; keys\n  beside soil: replace its own\n");
  print_table(out, "bodies: NAME:", NULL, pw_scene_keys_body);
  print_table(out, "bodies: NAME: refine: (a list)", "points in a box get this size or smaller",
              pw_scene_keys_refine);
  for (int i = 0; pw_effect_at(i); i++) {
    print_effect(out, pw_effect_at(i), "");
  }
  print_solid(out);
}

static void print_choices(FILE *out, const char *title, const pw_key *keys, const char *name)
{
  const pw_key *key = pw_key_find(keys, name);
  char word[PW_NAME];
  fprintf(out, "\n%s (%s)\n", title, key->meaning);
  for (int i = 0; pw_key_choice_at(key->choices, i, word); i++) {
    fprintf(out, "  %s\n", word);
  }
}

/* Bases with the rows of kernels compiled for them. */
static void print_bases(FILE *out)
{
  const pw_key *basis = pw_key_find(pw_scene_keys_method, "basis");
  const pw_key *geometry = pw_key_find(pw_scene_keys_top, "geometry");
  char word[PW_NAME], place[PW_NAME];
  fprintf(out, "\nbases (%s)\n", basis->meaning);
  for (int i = 0; pw_kernels_at(i); i++) {
    const pw_kernels *k = pw_kernels_at(i);
    if (pw_key_choice_at(basis->choices, k->basis, word) &&
        pw_key_choice_at(geometry->choices, k->geometry, place)) {
      fprintf(out, "  %-22s  %s, %s\n", k->name, word, place);
    }
  }
}

void pw_list_print(FILE *out)
{
  print_choices(out, "geometries", pw_scene_keys_top, "geometry");
  print_bases(out);
  print_choices(out, "updates", pw_scene_keys_method, "update");
  print_choices(out, "shapes", pw_scene_keys_body, "shape");
  fprintf(out, "\nmaterials\n");
  for (int i = 0; pw_material_at(i); i++) {
    fprintf(out, "  %-22s  %s\n", pw_material_at(i)->name, pw_material_at(i)->brief);
  }
  fprintf(out, "\neffects\n");
  for (int i = 0; pw_effect_at(i); i++) {
    fprintf(out, "  %-22s  %s\n", pw_effect_at(i)->name, pw_effect_at(i)->brief);
  }
  fprintf(out, "\neffects of solid scenes\n");
  for (int i = 0; pw_solid_effect_at(i); i++) {
    fprintf(out, "  %-22s  %s\n", pw_solid_effect_at(i)->name, pw_solid_effect_at(i)->brief);
  }
}
