/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stress at the start: of one body at rest under its own weight (K0), of layered ground with ground
 * water (engine/effects/ground.h), or uniform. The first step measures how far from equilibrium
 * the nodes of the body are that nothing holds. */
#include "engine/effects/common.h"
#include "engine/effects/ground.h"

#include <math.h>

#include "engine/core/mem.h"
#include "engine/full_mass.h"

#define AT(member)     offsetof(pw_initial_stress_param, member)
#define AT_ROW(member) offsetof(pw_ground_layer, member)

/* clang-format off */
static const pw_key keys[] = {
  {"kind", PW_KEY_CHOICE, AT(kind), 0, 0, "k0", "k0|uniform|layers", NULL,
   "stress at rest under a body's own weight, the same everywhere, or at rest in layered ground"},
  {"body", PW_KEY_BODY, AT(body), 0, 0, NULL, NULL, "kind=k0|uniform",
   "body that starts with this stress"},
  {"top_y_m", PW_KEY_REAL, AT(top_y_m), -1e6, 1e6, NULL, NULL, "kind=k0",
   "height of the free surface, where the vertical stress is -surcharge_pa"},
  {"k0", PW_KEY_REAL, AT(k0), 0, 100, NULL, NULL, "kind=k0",
   "horizontal over vertical stress"},
  {"surcharge_pa", PW_KEY_REAL, AT(surcharge_pa), 0, 1e12, "0", NULL, "kind=k0|layers",
   "pressure on the free surface"},
  {"acceleration_m_s2", PW_KEY_REAL, AT(acceleration_m_s2), 0, 1e6, "0", NULL, "kind=k0|layers",
   "weight per mass; 0: that of the gravity section"},
  {"stress_xx_pa", PW_KEY_REAL, AT(stress_xx_pa), -1e15, 1e15, NULL, NULL, "kind=uniform",
   "horizontal (axisymmetric: radial) stress, tension positive"},
  {"stress_yy_pa", PW_KEY_REAL, AT(stress_yy_pa), -1e15, 1e15, NULL, NULL, "kind=uniform",
   "vertical stress"},
  {"stress_zz_pa", PW_KEY_REAL, AT(stress_zz_pa), -1e15, 1e15, NULL, NULL, "kind=uniform",
   "out-of-plane (axisymmetric: hoop) stress"},
  {"water_table_y_m", PW_KEY_REAL, AT(water_table_y_m), -1e6, 1e6, "-1e6", NULL, "kind=layers",
   "height of the ground water; stresses are effective, below it soil weighs less by its buoyancy"},
  {"water_density_kg_m3", PW_KEY_REAL, AT(water_density_kg_m3), 1, 1e5, "1000", NULL, "kind=layers",
   "density of the ground water"},
  {"water_inertia", PW_KEY_BOOL, AT(water_inertia), 0, 0, "true", NULL, "kind=layers",
   "pore water moves with the grains: points below the table have the saturated mass"},
  {0}};

static const pw_key layer_keys[] = {
  {"body", PW_KEY_BODY, AT_ROW(body), 0, 0, NULL, NULL, NULL,
   "a rectangle, its lower edge the upper edge of the next layer"},
  {"k0", PW_KEY_REAL, AT_ROW(k0), 0, 100, NULL, NULL, NULL,
   "horizontal over vertical effective stress"},
  {"porosity", PW_KEY_REAL, AT_ROW(porosity), 0, 0.99, "0", NULL, NULL,
   "volume of pores over that of the soil; 0: from the material's void_ratio"},
  {0}};
/* clang-format on */

static const pw_effect_rows rows = {
    .name = "layers",
    .meaning = "kind layers: soil layers from the surface down",
    .keys = layer_keys,
    .count = AT(nlayer),
    .first = AT(layer),
    .size = sizeof(pw_ground_layer),
    .max = PW_MAX_BODIES,
};

_Static_assert(sizeof(pw_initial_stress_param) <= PW_EFFECT_BYTES, "parameters fit a scene");

/* What the first step finds. */
typedef struct initial {
  const pw_initial_stress_param *param;
  int body;         /* one of those with this stress */
  pw_real gravity;  /* weight per mass; m/s2 */
  pw_real residual; /* largest force that moves a node, whole body; N */
  pw_real weight;   /* largest weight of a node, whole body; N */
  bool measured;
  pw_ground_water water;
} initial;

static pw_real weight_per_mass(const pw_scene *scene, const pw_initial_stress_param *p)
{
  const pw_gravity_param *g = pw_scene_find_effect(scene, "gravity");
  return p->acceleration_m_s2 > 0.0 || !g ? p->acceleration_m_s2 : g->acceleration_m_s2;
}

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_initial_stress_param *p = param;
  PW_REQUIRE(p->kind == PW_STRESS_UNIFORM || weight_per_mass(scene, p) > 0.0, PW_ERR_SCENE,
             "kind %s needs acceleration_m_s2 or a gravity section",
             p->kind == PW_STRESS_K0 ? "k0" : "layers");
  if (p->kind == PW_STRESS_LAYERS) {
    return pw_ground_check(scene, p);
  }
  const pw_scene_body *b = &scene->body[p->body];
  const pw_material *model = scene->material[b->material].model;
  PW_REQUIRE(p->nlayer == 0, PW_ERR_SCENE, "layers: needs kind=layers");
  PW_REQUIRE(model->takes_initial_stress, PW_ERR_SCENE,
             "body: '%s' is of %s, which cannot start from a prescribed stress", b->name,
             model->name);
  return PW_OK;
}

/* Vertical stress and, through @p k0, the horizontal ones of point i. */
static pw_real vertical(const pw_sim *sim, const initial *c, pw_idx i, pw_real *k0)
{
  const pw_initial_stress_param *p = c->param;
  const pw_points *pt = &sim->points;
  pw_real y = pt->x[pt->ld + i];
  if (p->kind == PW_STRESS_K0) {
    *k0 = p->k0;
    pw_real depth = pw_max(p->top_y_m - y, 0.0);
    return -(p->surcharge_pa + pw_scene_density(&sim->scene, p->body) * c->gravity * depth);
  }
  int layer = pw_ground_layer_of(p, pt->body[i]);
  pw_real half = pt->half ? fabs(pt->half[pt->ld + i]) + fabs(pt->half[3 * pt->ld + i]) : 0.0;
  *k0 = p->layer[layer].k0;
  return pw_ground_stress(&sim->scene, p, c->gravity, layer, y, half);
}

static void set_stress(pw_sim *sim, const initial *c)
{
  const pw_initial_stress_param *p = c->param;
  pw_points *pt = &sim->points;
  for (pw_idx i = 0; i < pt->n; i++) {
    const pw_body *b = &sim->body[pt->body[i]];
    if (p->kind == PW_STRESS_LAYERS ? pw_ground_layer_of(p, pt->body[i]) < 0
                                    : pt->body[i] != p->body) {
      continue;
    }
    pw_real s[3] = {p->stress_xx_pa, p->stress_yy_pa, p->stress_zz_pa}, k0 = 0.0;
    if (p->kind != PW_STRESS_UNIFORM) {
      s[1] = vertical(sim, c, i, &k0);
      s[0] = s[2] = k0 * s[1];
    }
    for (int a = 0; a < 6; a++) {
      pt->stress[a * pt->ld + i] = a < 3 ? s[a] : 0.0;
    }
    if (b->model->init) {
      b->model->init(b->param, 1, pt->ld, pt->stress + i, pt->state ? pt->state + i : NULL);
    }
  }
}

static pw_status displace(pw_sim *sim, void *ctx)
{
  initial *c = ctx;
  if (c->water.nbody > 0) {
    pw_ground_water_scatter(sim, &c->water);
  }
  return PW_OK;
}

/* Force that is left at a node of the body after every constraint: m dv / dt, of lumped masses. */
static pw_status measure(pw_sim *sim, void *ctx)
{
  initial *c = ctx;
  if (c->measured) {
    return PW_OK;
  }
  const int field = sim->body[c->body].field;
  const pw_real *rec = pw_nodes_field(&sim->nodes, field);
  const pw_real *first =
      sim->full_mass ? pw_full_mass_field(sim->full_mass, field, sim->nodes.nnode) : rec;
  for (pw_idx k = 0; k < sim->nodes.nnode; k++) {
    const pw_real *r = rec + (pw_off)k * PW_NODE, *dv = first + (pw_off)k * PW_NODE + PW_NODE_FORCE;
    pw_real ax = dv[0] / sim->dt, ay = dv[1] / sim->dt;
    pw_real mass = sim->measure * r[PW_NODE_MASS] * r[PW_NODE_ACTIVE];
    c->residual = pw_max(c->residual, mass * sqrt(ax * ax + ay * ay));
    c->weight = pw_max(c->weight, mass * c->gravity);
  }
  c->measured = true;
  return PW_OK;
}

/* The same in implicit steps, where the records hold the forces. */
static pw_status measure_start(pw_sim *sim, void *ctx)
{
  initial *c = ctx;
  const pw_real *rec = pw_nodes_field(&sim->nodes, sim->body[c->body].field);
  for (pw_idx k = 0; k < sim->nodes.nnode; k++) {
    const pw_real *r = rec + (pw_off)k * PW_NODE, *f = r + PW_NODE_FORCE;
    c->residual = pw_max(c->residual, sim->measure * sqrt(f[0] * f[0] + f[1] * f[1]));
    c->weight = pw_max(c->weight, sim->measure * r[PW_NODE_MASS] * c->gravity);
  }
  c->measured = true;
  return PW_OK;
}

static void results(const pw_sim *sim, void *ctx, pw_record *out)
{
  const initial *c = ctx;
  (void)sim;
  pw_record_put(out, "initial_residual_n", c->residual);
  if (c->gravity > 0.0) {
    pw_record_put(out, "initial_residual_relative",
                  c->weight > 0.0 ? c->residual / c->weight : 0.0);
  }
}

static pw_status archive(pw_sim *sim, void *ctx, pw_archive *ar)
{
  initial *c = ctx;
  pw_real number[3] = {c->residual, c->weight, c->measured};
  (void)sim;
  PW_TRY(ar->real(ar, "initial_stress/residual", number, 3));
  c->residual = number[0];
  c->weight = number[1];
  c->measured = number[2] != 0.0;
  c->water.sorts = -1; /* after loading, points may stand in another order */
  return PW_OK;
}

static void destroy(void **ctx)
{
  initial *c = *ctx;
  if (c) {
    pw_ground_water_destroy(&c->water);
  }
  pw_mem_free(ctx);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  initial *c;
  PW_TRY(pw_mem_alloc("initial stress", 1, sizeof *c, &c));
  *ctx = c;
  c->param = param;
  c->body = c->param->kind == PW_STRESS_LAYERS ? c->param->layer[0].body : c->param->body;
  c->gravity = weight_per_mass(&sim->scene, c->param);
  set_stress(sim, c);
  return c->param->kind == PW_STRESS_LAYERS ? pw_ground_water_create(sim, c->param, &c->water)
                                            : PW_OK;
}

static const pw_hook hooks[] = {
    {PW_STAGE_P2G, displace},
    {PW_STAGE_END, measure},
    {0, NULL},
};

static const pw_hook implicit_hooks[] = {
    {PW_STAGE_START, measure_start},
    {PW_STAGE_P2G, displace},
    {0, NULL},
};

const pw_effect pw_effect_initial_stress = {
    .name = "initial_stress",
    .brief = "stress at the start: at rest (K0), in layered ground with water, or uniform",
    .keys = keys,
    .rows = &rows,
    .hooks = hooks,
    .implicit = implicit_hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
    .results = results,
    .archive = archive,
};
