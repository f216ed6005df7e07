/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/scene_check.h"

#include "engine/bodies.h"
#include "engine/effect.h"
#include "engine/mesh_grade.h"
#include "engine/structure_sim.h"
#include "engine/umat.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PATH_SIZE = PW_NAME + 16 };

/* Largest numbers of nodes and of points in a body: indices and sizes in bytes stay small. */
static const pw_real largest_count = 2.0e8;

/* Lengths that differ by less than this part of a cell are the same. */
static const pw_real same = 1e-9;

static pw_status check_grading(const pw_scene *s)
{
  const pw_grid *g = &s->grid;
  const bool graded = pw_grid_is_graded(g);
  PW_REQUIRE(graded || !(g->growth > 1), PW_ERR_SCENE,
             "growth = %g needs a fine zone: fine_x_m or fine_y_m", g->growth);
  PW_REQUIRE(graded || !(g->cell_max_m > 0), PW_ERR_SCENE,
             "cell_max_m = %g m needs a fine zone: fine_x_m or fine_y_m", g->cell_max_m);
  PW_REQUIRE(!graded || s->method.basis != PW_UGIMP, PW_ERR_SCENE,
             "%s: basis ugimp needs a uniform grid",
             g->fine_x_m[0] < g->fine_x_m[1] ? "fine_x_m" : "fine_y_m");
  return PW_OK;
}

/* Rows in pairs: where nodes hang, nothing but plain explicit steps knows of it. */
static pw_status check_pairs(const pw_scene *s)
{
  const pw_grid *g = &s->grid;
  if (g->paired_rows_x_m <= 0.0) {
    return PW_OK;
  }
  PW_REQUIRE(g->fine_y_m[0] < g->fine_y_m[1], PW_ERR_SCENE,
             "paired_rows_x_m = %g m needs the rows of a fine zone: fine_y_m", g->paired_rows_x_m);
  PW_REQUIRE(!(g->fine_x_m[0] < g->fine_x_m[1]) || g->paired_rows_x_m >= g->fine_x_m[1],
             PW_ERR_SCENE, "paired_rows_x_m = %g m lies within the fine zone, which ends at %g m",
             g->paired_rows_x_m, g->fine_x_m[1]);
  PW_REQUIRE(g->paired_rows_x_m < g->origin_m[0] + g->size_m[0], PW_ERR_SCENE,
             "paired_rows_x_m = %g m lies beyond the grid, which ends at %g m", g->paired_rows_x_m,
             g->origin_m[0] + g->size_m[0]);
  PW_REQUIRE(s->method.basis == PW_CPDI &&
                 (s->method.update == PW_MUSL || s->method.update == PW_USL),
             PW_ERR_SCENE, "paired_rows_x_m needs basis cpdi and update musl or usl");
  PW_REQUIRE(!pw_scene_find_effect(s, "absorbing") && !pw_scene_find_effect(s, "damping_local") &&
                 !pw_scene_find_effect(s, "contact_frictional") &&
                 !pw_scene_find_effect(s, "contact_penalty"),
             PW_ERR_SCENE,
             "paired_rows_x_m: not with absorbing, damping_local, contact_frictional or "
             "contact_penalty");
  return PW_OK;
}

pw_status pw_scene_check_grid(const pw_scene *s)
{
  pw_real nodes = 1;
  PW_TRY(check_grading(s));
  PW_TRY(check_pairs(s));
  for (int a = 0; a < 2; a++) {
    pw_axis_plan plan;
    PW_TRY(pw_mesh_plan(&s->grid, a, &plan));
    nodes *= (pw_real)plan.fine + (pw_real)plan.outer[0] + (pw_real)plan.outer[1] + 1;
  }
  PW_REQUIRE(s->method.basis != PW_UGIMP ||
                 pw_min(s->grid.size_m[0], s->grid.size_m[1]) > 1.5 * s->grid.cell_m,
             PW_ERR_SCENE, "size_m: ugimp needs at least two cells in each direction");
  PW_REQUIRE(nodes <= largest_count, PW_ERR_SCENE,
             "cell_m = %g m gives %.3g nodes, at most %.3g can be handled", s->grid.cell_m, nodes,
             largest_count);
  PW_REQUIRE(s->geometry != PW_AXI || s->grid.origin_m[0] >= 0, PW_ERR_SCENE,
             "origin_m: in axisymmetry x is the radius and the grid must start at x >= 0, not %g m",
             s->grid.origin_m[0]);
  return PW_OK;
}

pw_status pw_scene_check_time(const pw_scene *s)
{
  PW_REQUIRE(s->time.dt_s <= s->time.dt_max_s, PW_ERR_SCENE,
             "dt_s = %g s is larger than dt_max_s = %g s", s->time.dt_s, s->time.dt_max_s);
  PW_REQUIRE(s->method.update != PW_IMPLICIT || !(s->time.dt_s > 0), PW_ERR_SCENE,
             "dt_s: implicit steps (method.update) take end_s / implicit.steps = %g s",
             s->time.end_s / s->solid.implicit.steps);
  return PW_OK;
}

/* Who reads or changes nodal velocities in a way that the further terms would have to follow. */
static pw_status check_mass_terms(const pw_scene *s)
{
  const int terms = s->method.mass_terms;
  PW_REQUIRE(terms <= 1 || s->method.update != PW_IMPLICIT, PW_ERR_SCENE,
             "mass_terms = %d: implicit steps have the full mass matrix", terms);
  PW_REQUIRE(terms <= 1 || s->method.step_ratio_max <= 1, PW_ERR_SCENE,
             "mass_terms = %d: not with step_ratio_max = %d", terms, s->method.step_ratio_max);
  PW_REQUIRE(terms <= 1 || !(s->grid.paired_rows_x_m > 0.0), PW_ERR_SCENE,
             "mass_terms = %d: not with grid: paired_rows_x_m", terms);
  for (int e = 0; terms > 1 && e < s->neffect; e++) {
    PW_REQUIRE(!s->effect[e].type->lumped_only, PW_ERR_SCENE,
               "mass_terms = %d: %s knows lumped masses only", terms, s->effect[e].type->name);
  }
  return PW_OK;
}

pw_status pw_scene_check_method(const pw_scene *s)
{
  const int ratio = s->method.step_ratio_max;
  PW_REQUIRE(s->method.update != PW_IMPLICIT || !(s->method.noise_damping_per_s > 0), PW_ERR_SCENE,
             "noise_damping_per_s: implicit steps do not know it");
  const pw_real aspect = s->method.domain_aspect_max;
  PW_REQUIRE(!(aspect > 0) || aspect >= 1, PW_ERR_SCENE,
             "domain_aspect_max = %g: longest to shortest half-side, 1 at least, or 0: no limit",
             aspect);
  PW_REQUIRE(ratio <= 1 || s->method.update == PW_MUSL, PW_ERR_SCENE,
             "step_ratio_max = %d needs update: musl", ratio);
  for (int e = 0; ratio > 1 && e < s->neffect; e++) {
    PW_REQUIRE(strcmp(s->effect[e].type->name, "body_force") != 0, PW_ERR_SCENE,
               "step_ratio_max = %d: body_force needs all points to step together", ratio);
  }
  return check_mass_terms(s);
}

pw_status pw_scene_check_grid_implicit(const pw_scene *s)
{
  const pw_scene_implicit *p = &s->solid.implicit;
  PW_REQUIRE(p->steps >= 1, PW_ERR_SCENE, "steps: %d", p->steps);
  PW_REQUIRE(p->easy_iterations < p->hard_iterations, PW_ERR_SCENE,
             "easy_iterations: %d must be less than hard_iterations = %d", p->easy_iterations,
             p->hard_iterations);
  return PW_OK;
}

pw_status pw_scene_check_output(const pw_scene *s)
{
  PW_REQUIRE(s->output.picture_x_m[0] <= s->output.picture_x_m[1], PW_ERR_SCENE,
             "picture_x_m must be written [left, right]");
  PW_REQUIRE(s->output.picture_y_m[0] <= s->output.picture_y_m[1], PW_ERR_SCENE,
             "picture_y_m must be written [bottom, top]");
  return PW_OK;
}

pw_status pw_scene_check_material(const pw_scene *s, int i)
{
  const pw_scene_material *m = &s->material[i];
  for (int k = 0; k < i; k++) {
    PW_REQUIRE(strcmp(s->material[k].name, m->name) != 0, PW_ERR_SCENE,
               "two materials have the name '%s'", m->name);
  }
  PW_REQUIRE(m->model, PW_ERR_SCENE, "material '%s' has no model", m->name);
  if (m->model->check) {
    PW_TRY(m->model->check(m->param));
  }
  return m->model->needs_library ? pw_umat_load(m->param) : PW_OK;
}

/* Smallest box around a body: {left, right, bottom, top}; in axisymmetry half of a pile. */
static void body_box(const pw_scene *s, const pw_scene_body *b, pw_real box[4])
{
  switch ((pw_shape)b->shape) {
  case PW_SHAPE_RECTANGLE:
    memcpy(box, b->x_m, sizeof b->x_m);
    memcpy(box + 2, b->y_m, sizeof b->y_m);
    break;
  case PW_SHAPE_DISC:
    box[0] = b->centre_m[0] - b->radius_m;
    box[1] = b->centre_m[0] + b->radius_m;
    box[2] = b->centre_m[1] - b->radius_m;
    box[3] = b->centre_m[1] + b->radius_m;
    break;
  case PW_SHAPE_RING:
    pw_body_ring_box(b, box);
    break;
  case PW_SHAPE_PILE:
    box[0] = s->geometry == PW_AXI ? b->centre_m[0] : b->centre_m[0] - b->radius_m;
    box[1] = b->centre_m[0] + b->radius_m;
    box[2] = b->tip_y_m;
    box[3] = b->tip_y_m + b->length_m;
    break;
  }
}

static pw_status check_shape(const pw_scene_body *b)
{
  if (b->shape == PW_SHAPE_RECTANGLE) {
    PW_REQUIRE(b->x_m[0] < b->x_m[1], PW_ERR_SCENE, "x_m must be written [left, right]");
    PW_REQUIRE(b->y_m[0] < b->y_m[1], PW_ERR_SCENE, "y_m must be written [bottom, top]");
  }
  if (b->shape == PW_SHAPE_RING) {
    return pw_body_check_ring(b);
  }
  if (b->shape == PW_SHAPE_PILE && b->tip != PW_TIP_FLAT) {
    pw_real tip = b->tip_length_m > 0 ? b->tip_length_m : b->radius_m;
    PW_REQUIRE(tip <= b->length_m, PW_ERR_SCENE,
               "length_m = %g m is shorter than the pile's tip of %g m", b->length_m, tip);
  }
  return PW_OK;
}

/* Points stay in the grid; a structure needs none, but what is wholly outside meets nothing. */
static pw_status check_inside(const pw_scene *s, const pw_scene_body *b, const pw_real box[4])
{
  const bool points = b->kind == PW_BODY_POINTS;
  static const char *const side[] = {"left", "right", "bottom", "top"};
  pw_real slack = same * s->grid.cell_m;
  PW_REQUIRE(s->geometry != PW_AXI || box[0] >= -slack, PW_ERR_SCENE,
             "body '%s' crosses the axis x = 0 of the axisymmetric scene", b->name);
  for (int k = 0; k < 4; k++) {
    pw_real lower = s->grid.origin_m[k / 2], upper = lower + s->grid.size_m[k / 2];
    const bool over = box[k] > upper + slack, under = box[k] < lower - slack;
    PW_REQUIRE(points ? !over && !under : !(k % 2 == 0 ? over : under), PW_ERR_SCENE,
               "body '%s' %s the grid: its %s is at %g m, the grid reaches from %g m to %g m",
               b->name, points ? "leaves" : "is outside", side[k], box[k], lower, upper);
  }
  return PW_OK;
}

/* Each body and each of its boxes says in one of two ways how large its domains are. */
static pw_status check_ways(const pw_scene_body *b)
{
  const bool by_cells = b->points_per_cell > 0;
  PW_REQUIRE(by_cells || b->point_size_m > 0 || b->kind != PW_BODY_POINTS, PW_ERR_SCENE,
             "missing key 'point_size_m'%s",
             b->shape == PW_SHAPE_RECTANGLE ? " or 'points_per_cell'" : "");
  PW_REQUIRE(!by_cells || !(b->point_size_m > 0), PW_ERR_SCENE,
             "points_per_cell and point_size_m exclude each other");
  PW_REQUIRE(!by_cells || b->shape == PW_SHAPE_RECTANGLE, PW_ERR_SCENE,
             "points_per_cell is for rectangles");
  for (int r = 0; r < b->nrefine; r++) {
    PW_REQUIRE((b->refine[r].point_size_m > 0) == !by_cells &&
                   (b->refine[r].points_per_cell > 0) == by_cells,
               PW_ERR_SCENE, "refine: entry %d must give %s, as the body does", r,
               by_cells ? "points_per_cell" : "point_size_m");
    PW_REQUIRE(b->refine[r].points_per_cell >= b->points_per_cell, PW_ERR_SCENE,
               "refine: points_per_cell = %d of entry %d is less than the body's %d",
               b->refine[r].points_per_cell, r, b->points_per_cell);
  }
  return PW_OK;
}

/* Without bound when the grid has no plan, which is reported with the grid. */
static pw_real largest_cell(const pw_scene *s)
{
  pw_axis_plan plan[2] = {{.largest = s->grid.cell_m}, {.largest = s->grid.cell_m}};
  for (int a = 0; a < 2 && pw_grid_is_graded(&s->grid); a++) {
    if (pw_mesh_plan(&s->grid, a, &plan[a]) != PW_OK) {
      return PW_HUGE;
    }
  }
  return pw_max(plan[0].largest, plan[1].largest);
}

static pw_status check_sizes(const pw_scene *s, const pw_scene_body *b, const pw_real box[4])
{
  pw_real smallest = b->point_size_m, cell = largest_cell(s);
  PW_REQUIRE(b->nrefine == 0 || b->shape == PW_SHAPE_RECTANGLE, PW_ERR_SCENE,
             "refine: only a rectangle can be refined in boxes");
  PW_TRY(check_ways(b));
  PW_REQUIRE(b->point_size_m <= 4 * cell, PW_ERR_SCENE,
             "point_size_m = %g m is larger than 4 cells (%g m)", b->point_size_m, 4 * cell);
  for (int r = 0; r < b->nrefine; r++) {
    const pw_scene_refine *box_r = &b->refine[r];
    PW_REQUIRE(box_r->x_m[0] < box_r->x_m[1] && box_r->y_m[0] < box_r->y_m[1], PW_ERR_SCENE,
               "refine: x_m and y_m of entry %d must be written [smaller, larger]", r);
    PW_REQUIRE(box_r->point_size_m <= b->point_size_m, PW_ERR_SCENE,
               "refine: point_size_m = %g m of entry %d is larger than the body's %g m",
               box_r->point_size_m, r, b->point_size_m);
    smallest = pw_min(smallest, box_r->point_size_m);
  }
  pw_real points = (box[1] - box[0]) / smallest * ((box[3] - box[2]) / smallest);
  PW_REQUIRE(b->points_per_cell > 0 || points <= largest_count, PW_ERR_SCENE,
             "point_size_m: domains of %g m may give %.3g points, at most %.3g can be handled",
             smallest, points, largest_count);
  return PW_OK;
}

static bool is_implicit(const pw_scene *s)
{
  return s->geometry != PW_SOLID && s->method.update == PW_IMPLICIT;
}

pw_status pw_scene_check_body(const pw_scene *s, int i)
{
  const pw_scene_body *b = &s->body[i];
  if (s->geometry == PW_SOLID) {
    return pw_scene_check_solid_body(s, i);
  }
  for (int k = 0; k < i; k++) {
    PW_REQUIRE(strcmp(s->body[k].name, b->name) != 0, PW_ERR_SCENE, "two bodies have the name '%s'",
               b->name);
  }
  PW_REQUIRE(b->material >= 0 && b->material < s->nmaterial, PW_ERR_SCENE,
             "material: body '%s' has no material", b->name);
  PW_REQUIRE(b->nrefine >= 0 && b->nrefine <= PW_MAX_REFINE, PW_ERR_SCENE,
             "refine: at most %d entries", (int)PW_MAX_REFINE);
  pw_real box[4] = {0};
  body_box(s, b, box);
  PW_TRY(check_shape(b));
  PW_TRY(check_inside(s, b, box));
  PW_REQUIRE(!is_implicit(s) || b->kind == PW_BODY_POINTS, PW_ERR_SCENE,
             "kind: implicit steps (method.update) know no bodies without points");
  PW_REQUIRE(!is_implicit(s) || pw_scene_find_effect(s, "dynamics") ||
                 (b->velocity_m_s[0] == 0.0 && b->velocity_m_s[1] == 0.0),
             PW_ERR_SCENE,
             "velocity_m_s: implicit steps (method.update) without dynamics are quasi-static");
  return b->kind == PW_BODY_POINTS ? check_sizes(s, b, box) : pw_structure_check(s, i);
}

/* Value of a key that names a body, in the parameters of effect @p e. */
static int body_of(const pw_scene_effect *e, const pw_key *key)
{
  int b;
  memcpy(&b, e->param + key->offset, sizeof b);
  return b;
}

static pw_status check_bodies_of(const pw_scene *s, const pw_scene_effect *e)
{
  for (const pw_key *k = e->type->keys; k && k->name; k++) {
    if (k->type != PW_KEY_BODY) {
      continue;
    }
    int body = body_of(e, k);
    PW_REQUIRE(body < s->nbody && (body >= 0 || k->fallback || k->needs), PW_ERR_SCENE,
               "%s: no such body", k->name);
    bool without = e->type->structure_key && strcmp(e->type->structure_key, k->name) == 0;
    PW_REQUIRE(body < 0 || s->body[body].kind == PW_BODY_POINTS || without, PW_ERR_SCENE,
               "%s: '%s' has no points, which %s needs%s", k->name, s->body[body].name,
               e->type->name,
               e->type->own_velocity_fields && !e->type->structure_key
                   ? ": contact_corner takes it as the master"
                   : "");
  }
  return PW_OK;
}

pw_status pw_scene_check_effect(const pw_scene *s, int i)
{
  const pw_scene_effect *e = &s->effect[i];
  for (int k = 0; k < i; k++) {
    const pw_effect *other = s->effect[k].type;
    PW_REQUIRE(other != e->type || e->type->many, PW_ERR_SCENE, "%s is given twice", e->type->name);
    PW_REQUIRE(other == e->type || !other->own_velocity_fields || !e->type->own_velocity_fields,
               PW_ERR_SCENE, "%s and %s exclude each other: a scene has one kind of contact",
               e->type->name, other->name);
  }
  PW_REQUIRE(!is_implicit(s) || e->type->implicit, PW_ERR_SCENE,
             "%s: implicit steps (method.update) do not know this effect", e->type->name);
  PW_TRY(check_bodies_of(s, e));
  return e->type->check ? e->type->check(s, e->param) : PW_OK;
}

void pw_scene_effect_path(const pw_scene *s, int i, char *out)
{
  const pw_effect *type = s->effect[i].type;
  int entry = 0;
  for (int k = 0; k < i; k++) {
    entry += s->effect[k].type == type;
  }
  if (type->many) {
    snprintf(out, PATH_SIZE, "%s.%d", type->name, entry);
  } else {
    snprintf(out, PATH_SIZE, "%s", type->name);
  }
}

/* Puts the section's name in front of the message of a broken rule. */
static pw_status in_section(pw_status status, const char *group, const char *name)
{
  if (status != PW_OK) {
    char rule[512];
    snprintf(rule, sizeof rule, "%s", pw_error_text());
    pw_error_set(status, __FILE__, __LINE__, __func__, "%s%s: %s", group, name, rule);
  }
  return status;
}

static pw_status check_lists(const pw_scene *s)
{
  PW_REQUIRE(s->nmaterial >= 0 && s->nmaterial <= PW_MAX_MATERIALS, PW_ERR_SCENE,
             "materials: %d, at most %d", s->nmaterial, (int)PW_MAX_MATERIALS);
  PW_REQUIRE(s->nbody >= 1 && s->nbody <= PW_MAX_BODIES, PW_ERR_SCENE,
             "bodies: %d, from 1 to %d are needed", s->nbody, (int)PW_MAX_BODIES);
  PW_REQUIRE(s->neffect >= 0 && s->neffect <= PW_MAX_EFFECTS, PW_ERR_SCENE,
             "effects: %d entries, at most %d", s->neffect, (int)PW_MAX_EFFECTS);
  return PW_OK;
}

pw_status pw_scene_check(const pw_scene *s)
{
  PW_TRY(check_lists(s));
  if (s->geometry == PW_SOLID) {
    PW_TRY(in_section(pw_scene_check_mesh(s), "mesh", ""));
    PW_TRY(in_section(pw_scene_check_implicit(s), "implicit", ""));
  } else {
    PW_TRY(in_section(pw_scene_check_grid(s), "grid", ""));
    PW_TRY(in_section(pw_scene_check_time(s), "time", ""));
    PW_TRY(in_section(pw_scene_check_method(s), "method", ""));
    PW_TRY(is_implicit(s) ? in_section(pw_scene_check_grid_implicit(s), "implicit", "") : PW_OK);
    PW_TRY(in_section(pw_scene_check_output(s), "output", ""));
  }
  for (int i = 0; i < s->nmaterial; i++) {
    PW_TRY(in_section(pw_scene_check_material(s, i), "materials.", s->material[i].name));
  }
  for (int i = 0; i < s->nbody; i++) {
    PW_TRY(in_section(pw_scene_check_body(s, i), "bodies.", s->body[i].name));
  }
  for (int i = 0; i < s->neffect; i++) {
    char path[PATH_SIZE];
    pw_scene_effect_path(s, i, path);
    PW_TRY(in_section(pw_scene_check_effect(s, i), "", path));
  }
  return PW_OK;
}
