/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a scene wants to know: displacement of the material at a place, stress in a body. */
#include "engine/effects/solid_params.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"

/* clang-format off */
static const pw_key tracer_keys[] = {
  {"at_m", PW_KEY_TRIPLE, offsetof(pw_tracer_param, at_m), -1e6, 1e6, NULL, NULL, NULL,
   "where it starts, in the mesh"},
  {0}};

static const pw_key stress_keys[] = {
  {"body", PW_KEY_BODY, offsetof(pw_stress_record_param, body), 0, 0, "", NULL, NULL,
   "body whose points are looked at; absent: all points"},
  {"component", PW_KEY_CHOICE, offsetof(pw_stress_record_param, component), 0, 0, "von_mises",
   "xx|yy|zz|xy|yz|zx|mean|von_mises", NULL, "component of stress, its mean or sqrt(3 J2)"},
  {"measure", PW_KEY_CHOICE, offsetof(pw_stress_record_param, measure), 0, 0, "cauchy",
   "cauchy|kirchhoff", NULL, "force per area now, or times the volume ratio"},
  {0}};
/* clang-format on */

/* A tracer has no mass and no volume: it moves as the nodes of its element say. */
typedef struct tracer {
  const pw_tracer_param *param;
  int number;
  pw_idx elem;
  pw_real x[3]; /* m */
} tracer;

static pw_status create_tracer(pw_implicit *sim, const pw_solid_mesh *mesh, const void *param,
                               void **ctx)
{
  tracer *t;
  pw_walk_counts counts = {0};
  (void)mesh;
  PW_TRY(pw_mem_alloc("tracer", 1, sizeof *t, &t));
  *ctx = t;
  t->param = param;
  t->number = pw_solid_instance_of(sim, param);
  memcpy(t->x, t->param->at_m, sizeof t->x);
  t->elem = pw_walk_find(&sim->model.walk, t->x, PW_WALK_OUTSIDE, &counts);
  PW_REQUIRE(t->elem != PW_WALK_OUTSIDE, PW_ERR_SCENE,
             "tracer.%d.at_m: (%g, %g, %g) m is outside the mesh", t->number, t->x[0], t->x[1],
             t->x[2]);
  return PW_OK;
}

static void destroy(void **ctx)
{
  pw_mem_free(ctx);
}

/* Outside the mesh a tracer goes on with the last element it was in. */
static void move_tracer(pw_implicit *sim, void *ctx, pw_real to)
{
  tracer *t = ctx;
  const pw_tets *tets = &sim->mesh.tets;
  const pw_real *u = pw_newton_displacement(sim->newton);
  pw_walk_counts counts = {0};
  pw_real back[3], shape[4];
  (void)to;
  pw_motion_back(&sim->mesh.motion, t->x, back);
  const pw_idx found = pw_walk_find(&sim->model.walk, back, t->elem, &counts);
  t->elem = found == PW_WALK_OUTSIDE ? t->elem : found;
  pw_tets_shape(tets, t->elem, back, shape);
  for (size_t a = 0; a < 4; a++) {
    const size_t node = (size_t)tets->node[4 * (size_t)t->elem + a];
    for (size_t c = 0; c < 3; c++) {
      t->x[c] += shape[a] * u[c * (size_t)tets->nnode + node];
    }
  }
}

static void history_tracer(const pw_implicit *sim, void *ctx, pw_record *row)
{
  const tracer *t = ctx;
  char name[64];
  (void)sim;
  for (int c = 0; c < 3; c++) {
    snprintf(name, sizeof name, "tracer_%d_%c_m", t->number, "xyz"[c]);
    pw_record_put(row, name, t->x[c] - t->param->at_m[c]);
  }
}

static pw_status archive_tracer(pw_implicit *sim, void *ctx, pw_archive *ar)
{
  tracer *t = ctx;
  char name[64];
  (void)sim;
  snprintf(name, sizeof name, "tracer_%d/x", t->number);
  PW_TRY(ar->real(ar, name, t->x, 3));
  snprintf(name, sizeof name, "tracer_%d/element", t->number);
  PW_TRY(ar->index(ar, name, &t->elem, 1));
  PW_REQUIRE(t->elem >= 0 && t->elem < sim->mesh.tets.nelem, PW_ERR_FILE,
             "the checkpoint's tracer is damaged");
  return PW_OK;
}

typedef struct record {
  const pw_stress_record_param *param;
  int number;
} record;

static pw_status create_record(pw_implicit *sim, const pw_solid_mesh *mesh, const void *param,
                               void **ctx)
{
  record *r;
  (void)mesh;
  PW_TRY(pw_mem_alloc("stress record", 1, sizeof *r, &r));
  *ctx = r;
  r->param = param;
  r->number = pw_solid_instance_of(sim, param);
  return PW_OK;
}

static pw_real value_of(const pw_stress_record_param *p, const pw_tet_points *q, pw_idx i)
{
  const size_t ld = (size_t)q->ld;
  const pw_real *s = q->stress + i;
  const pw_real factor = p->measure == PW_STRESS_KIRCHHOFF ? q->jac_bar[i] : 1.0;
  if (p->component < 6) {
    return factor * s[(size_t)p->component * ld];
  }
  return factor *
         (p->component == 6 ? pw_tet_points_mean_stress(q, i) : pw_tet_points_von_mises(q, i));
}

static void history_record(const pw_implicit *sim, void *ctx, pw_record *row)
{
  const record *r = ctx;
  const pw_tet_points *q = &sim->model.points;
  pw_real sum = 0.0, volume = 0.0, least = INFINITY, largest = -INFINITY;
  char name[64];
  for (pw_idx i = 0; i < q->n; i++) {
    if (r->param->body >= 0 && q->body[i] != r->param->body) {
      continue;
    }
    const pw_real value = value_of(r->param, q, i), v = q->volume[i] / q->jac[i];
    sum += v * value;
    volume += v;
    least = pw_min(least, value);
    largest = pw_max(largest, value);
  }
  snprintf(name, sizeof name, "stress_record_%d_mean_pa", r->number);
  pw_record_put(row, name, sum / volume);
  snprintf(name, sizeof name, "stress_record_%d_least_pa", r->number);
  pw_record_put(row, name, least);
  snprintf(name, sizeof name, "stress_record_%d_largest_pa", r->number);
  pw_record_put(row, name, largest);
}

static const pw_solid_hooks tracer_hooks = {
    .create = create_tracer,
    .destroy = destroy,
    .moved = move_tracer,
    .history = history_tracer,
    .archive = archive_tracer,
};

static const pw_solid_hooks record_hooks = {
    .create = create_record,
    .destroy = destroy,
    .history = history_record,
};

const pw_effect pw_effect_tracer = {
    .name = "tracer",
    .brief = "displacement of the material that is at a place at the start",
    .many = true,
    .keys = tracer_keys,
    .solid = &tracer_hooks,
};

const pw_effect pw_effect_stress_record = {
    .name = "stress_record",
    .brief = "mean (by volume at the start), least and largest stress of the points of a body",
    .many = true,
    .keys = stress_keys,
    .solid = &record_hooks,
};
