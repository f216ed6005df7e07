/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effects/ground.h"

#include <math.h>
#include <string.h>

#include "engine/assemble.h"
#include "engine/core/mem.h"

static const pw_scene_body *layer_body(const pw_scene *s, const pw_initial_stress_param *p, int k)
{
  return &s->body[p->layer[k].body];
}

static bool has_water(const pw_scene *s, const pw_initial_stress_param *p, int k)
{
  return layer_body(s, p, k)->y_m[0] < p->water_table_y_m;
}

/* Porosity of a layer, or -1 when neither the layer nor its material gives it. */
static pw_real porosity(const pw_scene *s, const pw_initial_stress_param *p, int k)
{
  const pw_scene_material *m = &s->material[layer_body(s, p, k)->material];
  if (p->layer[k].porosity > 0.0) {
    return p->layer[k].porosity;
  }
  for (int i = 0; m->model->keys[i].name; i++) {
    if (strcmp(m->model->keys[i].name, "void_ratio") == 0) {
      return m->param[i] / (1.0 + m->param[i]);
    }
  }
  return -1.0;
}

/* Density whose weight counts below the water table. */
static pw_real buoyant_density(const pw_scene *s, const pw_initial_stress_param *p, int k)
{
  return pw_scene_density(s, p->layer[k].body) - (1.0 - porosity(s, p, k)) * p->water_density_kg_m3;
}

static pw_status check_layer(const pw_scene *s, const pw_initial_stress_param *p, int k)
{
  const int body = p->layer[k].body;
  PW_REQUIRE(body >= 0 && body < s->nbody, PW_ERR_SCENE, "layers.%d: body: no such body", k);
  const pw_scene_body *b = &s->body[body];
  const pw_material *model = s->material[b->material].model;
  PW_REQUIRE(b->shape == PW_SHAPE_RECTANGLE, PW_ERR_SCENE,
             "layers.%d: body '%s' is not a rectangle", k, b->name);
  PW_REQUIRE(b->kind == PW_BODY_POINTS, PW_ERR_SCENE, "layers.%d: body '%s' has no points", k,
             b->name);
  PW_REQUIRE(model->takes_initial_stress, PW_ERR_SCENE,
             "layers.%d: body '%s' is of %s, which cannot start from a prescribed stress", k,
             b->name, model->name);
  PW_REQUIRE(p->layer[k].k0 >= 0.0, PW_ERR_SCENE, "layers.%d: k0 = %g is negative", k,
             p->layer[k].k0);
  PW_REQUIRE(!has_water(s, p, k) || porosity(s, p, k) >= 0.0, PW_ERR_SCENE,
             "layers.%d: porosity is needed below the water table: %s has no void_ratio", k,
             model->name);
  PW_REQUIRE(!has_water(s, p, k) || buoyant_density(s, p, k) > 0.0, PW_ERR_SCENE,
             "layers.%d: the grains of '%s' are lighter than water", k, b->name);
  return PW_OK;
}

/* Layer k lies on the one below it, k + 1, edge on edge. */
static pw_status check_joint(const pw_scene *s, const pw_initial_stress_param *p, int k)
{
  const pw_scene_body *b = layer_body(s, p, k), *c = layer_body(s, p, k + 1);
  const pw_real same = 1e-6 * s->grid.cell_m, step = b->y_m[0] - c->y_m[1];
  PW_REQUIRE(step >= -same, PW_ERR_SCENE,
             "layers.%d: '%s' reaches up to %g m and overlaps '%s', which ends at %g m", k + 1,
             c->name, c->y_m[1], b->name, b->y_m[0]);
  PW_REQUIRE(step <= same, PW_ERR_SCENE,
             "layers.%d: '%s' begins at %g m and leaves a gap below '%s', which ends at %g m",
             k + 1, c->name, c->y_m[1], b->name, b->y_m[0]);
  PW_REQUIRE(fabs(b->x_m[0] - c->x_m[0]) <= same && fabs(b->x_m[1] - c->x_m[1]) <= same,
             PW_ERR_SCENE,
             "layers.%d: '%s' reaches from x = %g to %g m, '%s' above it from %g to %g m", k + 1,
             c->name, c->x_m[0], c->x_m[1], b->name, b->x_m[0], b->x_m[1]);
  return PW_OK;
}

/* Soil that no layer names: a rectangle within the layers' width that reaches below their top. */
static pw_status check_cover(const pw_scene *s, const pw_initial_stress_param *p)
{
  const pw_real same = 1e-6 * s->grid.cell_m;
  const pw_scene_body *top = layer_body(s, p, 0);
  for (int i = 0; i < s->nbody; i++) {
    const pw_scene_body *b = &s->body[i];
    bool beside = b->x_m[1] <= top->x_m[0] + same || b->x_m[0] >= top->x_m[1] - same;
    PW_REQUIRE(b->shape != PW_SHAPE_RECTANGLE || b->kind != PW_BODY_POINTS ||
                   pw_ground_layer_of(p, i) >= 0 || beside || b->y_m[0] >= top->y_m[1] - same,
               PW_ERR_SCENE, "layers: body '%s' reaches below the surface but is no layer",
               b->name);
  }
  return PW_OK;
}

pw_status pw_ground_check(const pw_scene *scene, const pw_initial_stress_param *p)
{
  const pw_gravity_param *g = pw_scene_find_effect(scene, "gravity");
  PW_REQUIRE(p->nlayer > 0, PW_ERR_SCENE, "kind layers needs layers: a list of {body, k0}");
  bool water = false;
  for (int k = 0; k < p->nlayer; k++) {
    PW_TRY(check_layer(scene, p, k));
    for (int i = 0; i < k; i++) {
      PW_REQUIRE(p->layer[i].body != p->layer[k].body, PW_ERR_SCENE,
                 "layers.%d: body '%s' is layer %d already", k, layer_body(scene, p, k)->name, i);
    }
    water = water || has_water(scene, p, k);
  }
  for (int k = 0; k + 1 < p->nlayer; k++) {
    PW_TRY(check_joint(scene, p, k));
  }
  PW_REQUIRE(!water || (g && g->tilt_deg == 0.0), PW_ERR_SCENE,
             "water_table_y_m: ground water needs a gravity section that does not turn");
  return check_cover(scene, p);
}

int pw_ground_layer_of(const pw_initial_stress_param *p, int b)
{
  for (int k = 0; k < p->nlayer; k++) {
    if (p->layer[k].body == b) {
      return k;
    }
  }
  return -1;
}

/* Mass per area that layer k lays on height y. */
static pw_real mass_above(const pw_scene *s, const pw_initial_stress_param *p, int k, pw_real y)
{
  const pw_real top = layer_body(s, p, k)->y_m[1], water = pw_min(p->water_table_y_m, top);
  pw_real dry = top - pw_max(y, water), wet = pw_max(water - y, 0.0);
  pw_real mass = dry * pw_scene_density(s, p->layer[k].body);
  return wet > 0.0 ? mass + wet * buoyant_density(s, p, k) : mass;
}

static pw_real stress_at(const pw_scene *s, const pw_initial_stress_param *p, pw_real gravity,
                         int layer, pw_real y)
{
  pw_real mass = mass_above(s, p, layer, y);
  for (int k = layer - 1; k >= 0; k--) {
    mass += mass_above(s, p, k, layer_body(s, p, k)->y_m[0]);
  }
  return -(p->surcharge_pa + gravity * mass);
}

pw_real pw_ground_stress(const pw_scene *scene, const pw_initial_stress_param *p, pw_real gravity,
                         int layer, pw_real y, pw_real half)
{
  const pw_real lower = y - half, upper = y + half, water = p->water_table_y_m;
  if (!(water > lower && water < upper)) {
    return stress_at(scene, p, gravity, layer, y);
  }
  /* Linear on both sides of the water table: the trapezoidal rule is exact. */
  pw_real at = stress_at(scene, p, gravity, layer, water);
  pw_real below = (water - lower) * (at + stress_at(scene, p, gravity, layer, lower));
  pw_real above = (upper - water) * (at + stress_at(scene, p, gravity, layer, upper));
  return (below + above) / (4.0 * half);
}

/* Part of the domain of point i that is below the water table. */
static pw_real wet_part(const pw_points *pt, pw_idx i, pw_real water)
{
  pw_real y = pt->x[pt->ld + i];
  pw_real half = pt->half ? fabs(pt->half[pt->ld + i]) + fabs(pt->half[3 * pt->ld + i]) : 0.0;
  if (half == 0.0) {
    return y < water ? 1.0 : 0.0;
  }
  return pw_min(1.0, pw_max(0.0, (water - (y - half)) / (2.0 * half)));
}

/* The grains displace (1 - n) V of water. Points that carry their pore water too displace V. */
static void find_displaced(pw_sim *sim, const pw_initial_stress_param *p, pw_ground_water *w)
{
  pw_points *pt = &sim->points;
  for (pw_idx i = 0; i < pt->n; i++) {
    int layer = pw_ground_layer_of(p, pt->body[i]);
    if (layer < 0 || !has_water(&sim->scene, p, layer)) {
      continue;
    }
    pw_real water = p->water_density_kg_m3 * wet_part(pt, i, p->water_table_y_m) * pt->vol[i];
    pw_real pores = porosity(&sim->scene, p, layer);
    w->by_id[pt->id[i]] = p->water_inertia ? water : (1.0 - pores) * water;
    pt->mass[i] += p->water_inertia ? pores * water : 0.0;
  }
}

pw_status pw_ground_water_create(pw_sim *sim, const pw_initial_stress_param *p, pw_ground_water *w)
{
  for (int k = 0; k < p->nlayer; k++) {
    if (has_water(&sim->scene, p, k)) {
      w->body[w->nbody++] = p->layer[k].body;
    }
  }
  if (w->nbody == 0) {
    return PW_OK;
  }
  for (int k = 0; k < w->nbody; k++) {
    PW_REQUIRE(sim->body[w->body[k]].field == sim->body[w->body[0]].field, PW_ERR_SCENE,
               "layers: a layer below the water table is the master of a contact");
  }
  PW_TRY(pw_mem_alloc("water by point", sim->points.n, sizeof(pw_real), &w->by_id));
  PW_TRY(pw_mem_alloc("water of points", sim->points.ld, sizeof(pw_real), &w->mass));
  PW_TRY(
      pw_mem_alloc("water at nodes", (pw_off)sim->nodes.nnode * PW_NODE, sizeof(pw_real), &w->rec));
  w->sorts = -1;
  find_displaced(sim, p, w);
  sim->buoyant = w->rec;
  sim->buoyant_field = sim->body[w->body[0]].field;
  return PW_OK;
}

void pw_ground_water_destroy(pw_ground_water *w)
{
  pw_mem_free(&w->by_id);
  pw_mem_free(&w->mass);
  pw_mem_free(&w->rec);
}

/* What the scatter of a block needs. */
typedef struct scatter {
  const pw_sim *sim;
  const pw_ground_water *w;
  pw_transfer transfer; /* the simulation's, with the water as mass */
} scatter;

static void scatter_block(void *ctx, pw_idx block)
{
  const scatter *s = ctx;
  for (int k = 0; k < s->w->nbody; k++) {
    const pw_idx *start =
        s->sim->blocks.point_start + (pw_off)block * s->sim->nbody + s->w->body[k];
    if (start[0] < start[1]) {
      s->sim->kernels->p2g_momentum(&s->transfer, s->w->rec, start[0], start[1]);
    }
  }
}

void pw_ground_water_scatter(pw_sim *sim, pw_ground_water *w)
{
  const pw_points *pt = &sim->points;
  if (w->sorts != sim->sorts) {
    for (pw_idx i = 0; i < pt->n; i++) {
      w->mass[i] = w->by_id[pt->id[i]];
    }
    w->sorts = sim->sorts;
  }
  memset(w->rec, 0, (size_t)sim->nodes.nnode * PW_NODE * sizeof *w->rec);
  scatter s = {sim, w, sim->transfer};
  s.transfer.mass = w->mass;
  pw_assemble_coloured(&sim->blocks, sim->threads, scatter_block, &s);
}
