/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/scene.h"

#include "engine/effect.h"
#include "engine/scene_keys.h"

#include <stdlib.h>
#include <string.h>

#define AT(member)        offsetof(pw_scene, member)
#define AT_BODY(member)   offsetof(pw_scene_body, member)
#define AT_REFINE(member) offsetof(pw_scene_refine, member)

/* Limits that keep products of input values far from overflow: 1000 km, a micrometre. */
#define FAR_M   1e6
#define SMALL_M 1e-6

/* Columns: name, type, offset, smallest, largest, default, choices, needs, meaning. */
/* clang-format off */
const pw_key pw_scene_keys_top[] = {
  {"title", PW_KEY_TEXT, AT(title), 0, 0, "", NULL, NULL,
   "name of the run in reports and pictures"},
  {"geometry", PW_KEY_CHOICE, AT(geometry), 0, 0, NULL, "plane_strain|axisymmetric|solid", NULL,
   "plane strain per metre of depth, axisymmetric with x the radius and y the axis, or solid: "
   "tetrahedra and implicit steps"},
  {0}};

const pw_key pw_scene_keys_grid[] = {
  {"origin_m", PW_KEY_PAIR, AT(grid.origin_m), -FAR_M, FAR_M, "[0, 0]", NULL, NULL,
   "lower left corner of the grid"},
  {"size_m", PW_KEY_PAIR, AT(grid.size_m), SMALL_M, FAR_M, NULL, NULL, NULL,
   "width and height: whole numbers of cells, or met exactly by the growth beside a fine zone"},
  {"cell_m", PW_KEY_REAL, AT(grid.cell_m), SMALL_M, FAR_M, NULL, NULL, NULL,
   "edge of the square cells; with a fine zone: of the cells in it"},
  {"fine_x_m", PW_KEY_PAIR, AT(grid.fine_x_m), -FAR_M, FAR_M, "[0, 0]", NULL, NULL,
   "fine zone along x, a whole number of cells; equal: the whole grid, uniform along x"},
  {"fine_y_m", PW_KEY_PAIR, AT(grid.fine_y_m), -FAR_M, FAR_M, "[0, 0]", NULL, NULL,
   "fine zone along y, a whole number of cells; equal: the whole grid, uniform along y"},
  {"growth", PW_KEY_REAL, AT(grid.growth), 1, 1.5, "1", NULL, NULL,
   "largest ratio of neighbouring cells beside the fine zone; the ratio used is the one with which "
   "the fewest cells it allows fill the side exactly"},
  {"cell_max_m", PW_KEY_REAL, AT(grid.cell_max_m), 0, FAR_M, "0", NULL, NULL,
   "largest cell beside the fine zone; 0: no limit"},
  {"paired_rows_x_m", PW_KEY_REAL, AT(grid.paired_rows_x_m), 0, FAR_M, "0", NULL, NULL,
   "from the first line of nodes beyond it on, rows of the fine zone are taken in pairs: cells and "
   "points twice as high; 0: nowhere"},
  {0}};

const pw_key pw_scene_keys_time[] = {
  {"end_s", PW_KEY_REAL, AT(time.end_s), PW_TINY, 1e12, NULL, NULL, NULL,
   "time at which the run ends; it starts at 0"},
  {"cfl", PW_KEY_REAL, AT(time.cfl), PW_TINY, 0.95, "0.5", NULL, NULL,
   "step as a fraction of cell / (wave speed + point speed)"},
  {"dt_max_s", PW_KEY_REAL, AT(time.dt_max_s), PW_TINY, 1e12, "1", NULL, NULL,
   "largest step"},
  {"dt_s", PW_KEY_REAL, AT(time.dt_s), 0, 1e12, "0", NULL, NULL,
   "fixed step; 0: the stable step, found anew every step"},
  {0}};

const pw_key pw_scene_keys_method[] = {
  {"basis", PW_KEY_CHOICE, AT(method.basis), 0, 0, "cpdi", "linear|ugimp|cpdi", NULL,
   "shape functions of the points: standard MPM, uGIMP or CPDI parallelograms"},
  {"update", PW_KEY_CHOICE, AT(method.update), 0, 0, "musl", "musl|usl|usf|implicit", NULL,
   "explicit steps with the stress update last and remapped velocities, last, or first; or "
   "quasi-static steps by Newton's method (section implicit)"},
  {"domain_limit_cells", PW_KEY_REAL, AT(method.domain_limit_cells), 0, 100, "1", NULL, NULL,
   "largest half diagonal of a point's domain; 0: no limit"},
  {"domain_aspect_max", PW_KEY_REAL, AT(method.domain_aspect_max), 0, 1e6, "0", NULL, NULL,
   "largest ratio of a domain's half-sides (in cells for points_per_cell) above which it is "
   "reshaped; 0: no limit"},
  {"mass_cut_off", PW_KEY_REAL, AT(method.mass_cut_off), 0, 0.1, "1e-9", NULL, NULL,
   "nodes with less than this part of a full cell's mass stay at rest"},
  {"noise_damping_per_s", PW_KEY_REAL, AT(method.noise_damping_per_s), 0, 1e6, "0", NULL, NULL,
   "rate at which velocities of points that the grid does not see die out (a share of PIC)"},
  {"mass_terms", PW_KEY_INT, AT(method.mass_terms), 1, 2, "1", NULL, NULL,
   "terms of the full mass matrix's inverse for the points' accelerations; 1: lumped masses; 2: less "
   "error, best with usl"},
  {"step_ratio_max", PW_KEY_INT, AT(method.step_ratio_max), 1, 16, "1", NULL, NULL,
   "most short steps that blocks of slow points take at once; 1: all step together"},
  {"block_elements", PW_KEY_INT, AT(method.block_elements), 0, 1e6, "0", NULL, NULL,
   "elements in a block of the coloured scatter; 0: chosen from the grid"},
  {0}};

const pw_key pw_scene_keys_output[] = {
  {"history_every_s", PW_KEY_REAL, AT(output.history_every_s), 0, 1e12, "0.01", NULL, NULL,
   "time between rows of history.csv; 0: every step"},
  {"snapshot_every_s", PW_KEY_REAL, AT(output.snapshot_every_s), 0, 1e12, "0", NULL, NULL,
   "time between ParaView files; 0: only at the start and the end"},
  {"checkpoint_every_s", PW_KEY_REAL, AT(output.checkpoint_every_s), 0, 1e12, "0", NULL, NULL,
   "simulated time between checkpoints besides those at the start, the end and every 30 s of waiting"},
  {"paraview", PW_KEY_BOOL, AT(output.paraview), 0, 0, "true", NULL, NULL,
   "write ParaView files"},
  {"pictures", PW_KEY_BOOL, AT(output.pictures), 0, 0, "true", NULL, NULL,
   "draw pictures"},
  {"picture_cell_mean", PW_KEY_BOOL, AT(output.picture_cell_mean), 0, 0, "false", NULL, NULL,
   "colour points by the mean of their cell: leaves out what alternates within cells"},
  {"picture_times_s", PW_KEY_REALS, AT(output.picture_times_s), 0, 1e12, "[]", NULL, NULL,
   "times of pictures besides the end"},
  {"picture_x_m", PW_KEY_PAIR, AT(output.picture_x_m), -FAR_M, FAR_M, "[0, 0]", NULL, NULL,
   "window of the pictures, left and right; equal: the whole grid"},
  {"picture_y_m", PW_KEY_PAIR, AT(output.picture_y_m), -FAR_M, FAR_M, "[0, 0]", NULL, NULL,
   "window of the pictures, bottom and top; equal: the whole grid"},
  {0}};

const pw_key pw_scene_keys_body[] = {
  {"material", PW_KEY_MATERIAL, AT_BODY(material), 0, 0, NULL, NULL, NULL,
   "one of the names under materials"},
  {"kind", PW_KEY_CHOICE, AT_BODY(kind), 0, 0, "points", "points|rigid|rod", NULL,
   "material points, or without points: a rigid body, an elastic rod (a pile, axial motion)"},
  {"shape", PW_KEY_CHOICE, AT_BODY(shape), 0, 0, NULL, "rectangle|disc|pile|ring", NULL,
   "a pile is upright with its axis at x = 0"},
  {"x_m", PW_KEY_PAIR, AT_BODY(x_m), -FAR_M, FAR_M, NULL, NULL, "shape=rectangle",
   "left and right edge"},
  {"y_m", PW_KEY_PAIR, AT_BODY(y_m), -FAR_M, FAR_M, NULL, NULL, "shape=rectangle",
   "lower and upper edge"},
  {"centre_m", PW_KEY_PAIR, AT_BODY(centre_m), -FAR_M, FAR_M, NULL, NULL, "shape=disc|ring",
   "centre of the disc or ring"},
  {"radius_m", PW_KEY_REAL, AT_BODY(radius_m), SMALL_M, FAR_M, NULL, NULL,
   "shape=disc|pile|ring", "radius of the disc, of the pile's shaft, outer radius of the ring"},
  {"inner_radius_m", PW_KEY_REAL, AT_BODY(inner_radius_m), SMALL_M, FAR_M, NULL, NULL, "shape=ring",
   "inner radius of the ring"},
  {"angle_deg", PW_KEY_PAIR, AT_BODY(angle_deg), -720, 720, "[0, 360]", NULL, "shape=ring",
   "part of the ring, from and to, anticlockwise from the x axis"},
  {"tip_y_m", PW_KEY_REAL, AT_BODY(tip_y_m), -FAR_M, FAR_M, NULL, NULL, "shape=pile",
   "height of the pile's lowest point"},
  {"length_m", PW_KEY_REAL, AT_BODY(length_m), SMALL_M, FAR_M, NULL, NULL, "shape=pile",
   "whole length of the pile, tip included"},
  {"tip", PW_KEY_CHOICE, AT_BODY(tip), 0, 0, "flat", "flat|rounded|conical", "shape=pile",
   "form of the pile's lower end"},
  {"tip_length_m", PW_KEY_REAL, AT_BODY(tip_length_m), 0, FAR_M, "0", NULL, "shape=pile",
   "height of a rounded or conical tip; 0: the radius"},
  {"point_size_m", PW_KEY_REAL, AT_BODY(point_size_m), 0, FAR_M, "0", NULL, "kind=points",
   "edge of the largest point domains; 0: points_per_cell says how many there are"},
  {"points_per_cell", PW_KEY_INT, AT_BODY(points_per_cell), 0, 4, "0", NULL, "shape=rectangle",
   "point domains in each cell of the grid, in each direction; instead of point_size_m"},
  {"hole_centre_m", PW_KEY_PAIR, AT_BODY(hole_centre_m), -FAR_M, FAR_M, "[0, 0]", NULL,
   "shape=rectangle", "centre of a round hole"},
  {"hole_radius_m", PW_KEY_REAL, AT_BODY(hole_radius_m), 0, FAR_M, "0", NULL, "shape=rectangle",
   "domains whose centres lie in it are left out, for a body that stands there; 0: no hole"},
  {"mass_kg", PW_KEY_REAL, AT_BODY(mass_kg), 0, 1e15, "0", NULL, "kind=rigid",
   "of the whole body, per metre of depth in plane strain; 0: density times volume"},
  {"rod_elements", PW_KEY_INT, AT_BODY(rod_elements), 1, 100000, "40", NULL, "kind=rod",
   "equal elements along the rod"},
  {"surface_segment_m", PW_KEY_REAL, AT_BODY(surface_segment_m), 0, FAR_M, "0", NULL,
   "kind=rigid|rod",
   "largest pieces of its surface, at most a cell; 0: a quarter of a cell, finer on round parts"},
  {"velocity_m_s", PW_KEY_PAIR, AT_BODY(velocity_m_s), -1e6, 1e6, "[0, 0]", NULL, NULL,
   "velocity at the start"},
  {0}};

const pw_key pw_scene_keys_refine[] = {
  {"x_m", PW_KEY_PAIR, AT_REFINE(x_m), -FAR_M, FAR_M, NULL, NULL, NULL,
   "left and right edge of the refined box"},
  {"y_m", PW_KEY_PAIR, AT_REFINE(y_m), -FAR_M, FAR_M, NULL, NULL, NULL,
   "lower and upper edge of the refined box"},
  {"point_size_m", PW_KEY_REAL, AT_REFINE(point_size_m), 0, FAR_M, "0", NULL, NULL,
   "edge of the point domains in the box, at most that of the body"},
  {"points_per_cell", PW_KEY_INT, AT_REFINE(points_per_cell), 0, 4, "0", NULL, NULL,
   "point domains in each cell that overlaps the box, of a body with points_per_cell"},
  {0}};
/* clang-format on */

/* Numbers of a fallback such as "0.5" or "[0, 0]". */
static void fallback_numbers(const char *text, pw_key_value *out)
{
  const char *c = text + (*text == '[');
  while (out->n < PW_LIST) {
    char *end;
    pw_real v = strtod(c, &end);
    if (end == c) {
      return;
    }
    out->v[out->n++] = v;
    c = end + strspn(end, ", ");
  }
}

static void parse_fallback(const pw_key *key, pw_key_value *out)
{
  *out = (pw_key_value){0};
  switch (key->type) {
  case PW_KEY_REAL:
  case PW_KEY_PAIR:
  case PW_KEY_TRIPLE:
  case PW_KEY_REALS:
  case PW_KEY_INT:
    fallback_numbers(key->fallback, out);
    break;
  case PW_KEY_BOOL:
    out->v[0] = strcmp(key->fallback, "true") == 0;
    break;
  case PW_KEY_CHOICE:
    out->v[0] = pw_key_choice(key->choices, key->fallback);
    break;
  case PW_KEY_TEXT:
    strncpy(out->text, key->fallback, PW_NAME - 1);
    break;
  case PW_KEY_FILE:
    strncpy(out->text, key->fallback, PW_FILE_NAME - 1);
    break;
  case PW_KEY_BODY:
  case PW_KEY_MATERIAL:
    out->v[0] = -1;
    break;
  }
}

void pw_scene_defaults(const pw_key *keys, void *base)
{
  for (const pw_key *k = keys; k->name; k++) {
    bool reference = k->type == PW_KEY_BODY || k->type == PW_KEY_MATERIAL;
    if (k->fallback || reference) {
      pw_key_value value;
      parse_fallback(k, &value);
      pw_key_store(keys, k, &value, base);
    }
  }
}

void pw_scene_default(pw_scene *out)
{
  memset(out, 0, sizeof *out);
  pw_scene_defaults(pw_scene_keys_top, out);
  pw_scene_defaults(pw_scene_keys_grid, out);
  pw_scene_defaults(pw_scene_keys_time, out);
  pw_scene_defaults(pw_scene_keys_method, out);
  pw_scene_defaults(pw_scene_keys_output, out);
  pw_scene_defaults(pw_scene_keys_mesh, out);
  pw_scene_defaults(pw_scene_keys_grid_implicit, out);
  pw_scene_defaults(pw_scene_keys_implicit, out);
  pw_scene_defaults(pw_scene_keys_solid_output, out);
}

void *pw_scene_add_effect(pw_scene *scene, const char *name)
{
  const pw_effect *type = pw_effect_of(scene, name);
  if (!type || scene->neffect >= PW_MAX_EFFECTS) {
    return NULL;
  }
  pw_scene_effect *e = &scene->effect[scene->neffect++];
  e->type = type;
  memset(e->param, 0, sizeof e->param);
  pw_scene_defaults(type->keys, e->param);
  return e->param;
}

const void *pw_scene_find_effect(const pw_scene *scene, const char *name)
{
  for (int i = 0; i < scene->neffect; i++) {
    if (strcmp(scene->effect[i].type->name, name) == 0) {
      return scene->effect[i].param;
    }
  }
  return NULL;
}

int pw_scene_find_body(const pw_scene *scene, const char *name)
{
  for (int i = 0; i < scene->nbody; i++) {
    if (strcmp(scene->body[i].name, name) == 0) {
      return i;
    }
  }
  return -1;
}

pw_real pw_scene_density(const pw_scene *scene, int b)
{
  const pw_scene_material *m = &scene->material[scene->body[b].material];
  return m->model->density(m->param);
}
