/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is asked of a driven pile: penetration, set of each blow, settlement of the soil, stress at
 * its base, and how deep soil has leaked into the pile.
 *
 * Penetration counts from the original surface; below the settled surface it is less the mean
 * settlement of the top row of points in the far field. The tip is the lowest corner of the pile's
 * domains. Overlap is the depth of a soil point's centre inside the exact outline of the pile,
 * which moves with the tip; it is watched every WATCH steps. */
#include "engine/effects/common.h"
#include "engine/effects/load_curve.h"
#include "engine/effects/params.h"
#include "engine/effects/pile_shape.h"

#include <math.h>
#include <string.h>

#include "engine/core/mem.h"

#define AT(member) offsetof(pw_pile_record_param, member)

enum { WATCH = 20, REALS = 4, FLAGS = 3 };

/* clang-format off */
static const pw_key keys[] = {
  {"body", PW_KEY_BODY, AT(body), 0, 0, NULL, NULL, NULL, "the pile"},
  {"soil", PW_KEY_BODY, AT(soil), 0, 0, NULL, NULL, NULL, "the body it is driven into"},
  {"far_field_x_m", PW_KEY_REAL, AT(far_field_x_m), 0, 1e6, "0", NULL, NULL,
   "top points beyond it give the far-field settlement; 0: 0.8 of the soil's right end"},
  {"base_y_m", PW_KEY_REAL, AT(base_y_m), -1e300, 1e6, "-1e300", NULL, NULL,
   "where the base stress is taken; default: the soil's own bottom"},
  {0}};
/* clang-format on */

/** Points chosen at the start, by id. */
typedef struct chosen {
  pw_idx n;
  pw_idx *id;
} chosen;

typedef struct pile_record {
  const pw_pile_record_param *param;
  pw_pile_shape shape;
  pw_pulse pulse;        /* of the hammer on the pile; count 0 without one */
  pw_real gravity_s;     /* time at which the penetration after gravity is taken */
  pw_real surface;       /* original height of the soil's surface; m */
  pw_real far_x, base_y; /* m */
  pw_real tip_shift;     /* height of the tip over the lowest corner at the start; m */
  chosen tip, far, base;
  pw_real *far_y; /* [far.n] initial heights; m */
  /* State, in checkpoints. */
  pw_real real[REALS];                                    /* AFTER_GRAVITY .. BLOW_START; m */
  pw_idx flag[FLAGS];                                     /* GRAVITY_DONE .. BLOWS_DONE */
  pw_real set[PW_RECORD_ARRAY], overlap[PW_RECORD_ARRAY]; /* per blow; m */
  pw_real shown[PW_RECORD_ARRAY]; /* sets as reported, the last blow so far */
} pile_record;

enum { AFTER_GRAVITY, LARGEST_OVERLAP, DEEPEST, BLOW_START };
enum { GRAVITY_DONE, BLOWS, BLOWS_DONE };

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_pile_record_param *p = param;
  PW_REQUIRE(scene->body[p->body].shape == PW_SHAPE_PILE, PW_ERR_SCENE, "body '%s' is not a pile",
             scene->body[p->body].name);
  PW_REQUIRE(p->body != p->soil, PW_ERR_SCENE, "body and soil are the same");
  return PW_OK;
}

/* Lowest corner of a point's domain. */
static pw_real lowest(const pw_points *p, pw_idx i)
{
  pw_real y = p->x[p->ld + i];
  return p->half ? y - fabs(p->half[p->ld + i]) - fabs(p->half[3 * p->ld + i]) : y;
}

static pw_real tip_height(const pw_sim *sim, const pile_record *c)
{
  const pw_structure *s = sim->structure_of[c->param->body];
  pw_real y = s ? pw_structure_tip(s) : PW_HUGE;
  for (pw_idx k = 0; k < c->tip.n; k++) {
    y = pw_min(y, lowest(&sim->points, sim->points.slot[c->tip.id[k]]));
  }
  return y + c->tip_shift;
}

static pw_real penetration(const pw_sim *sim, const pile_record *c)
{
  return c->surface - tip_height(sim, c);
}

static pw_real settlement(const pw_sim *sim, const pile_record *c)
{
  const pw_points *p = &sim->points;
  pw_real mass = 0.0, sum = 0.0;
  for (pw_idx k = 0; k < c->far.n; k++) {
    pw_idx i = p->slot[c->far.id[k]];
    mass += p->mass[i];
    sum += p->mass[i] * (c->far_y[k] - p->x[p->ld + i]);
  }
  return mass > 0.0 ? sum / mass : 0.0;
}

/* Mean vertical stress at the base: that of the lowest points and of the ground between their
 * centres and the base; kPa, tension positive. */
static pw_real base_stress(const pw_sim *sim, const pile_record *c)
{
  const pw_points *p = &sim->points;
  const pw_gravity_param *g = pw_scene_find_effect(&sim->scene, "gravity");
  pw_real weight = g ? g->acceleration_m_s2 * sim->load_factor : 0.0;
  pw_real vol = 0.0, sum = 0.0;
  for (pw_idx k = 0; k < c->base.n; k++) {
    pw_idx i = p->slot[c->base.id[k]];
    vol += p->vol[i];
    sum += p->vol[i] * p->stress[p->ld + i] - p->mass[i] * weight * (p->x[p->ld + i] - c->base_y);
  }
  return vol > 0.0 ? 1e-3 * sum / vol : 0.0;
}

/* Mean vertical velocity of the pile; upwards positive. */
static pw_real pile_velocity(const pw_sim *sim, const pile_record *c)
{
  const pw_points *p = &sim->points;
  pw_real mass = 0.0, sum = 0.0;
  if (sim->structure_of[c->param->body]) {
    pw_real centre[6];
    pw_structure_centre(sim->structure_of[c->param->body], centre);
    return centre[3];
  }
  for (pw_idx i = 0; i < p->n; i++) {
    if (p->body[i] == c->param->body) {
      mass += p->mass[i];
      sum += p->mass[i] * p->v[p->ld + i];
    }
  }
  return sum / mass;
}

static pw_real overlap(const pw_sim *sim, const pile_record *c)
{
  const pw_points *p = &sim->points;
  const pw_real tip = tip_height(sim, c);
  pw_real deepest = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    pw_real z = p->x[p->ld + i] - tip;
    if (fabs(p->x[i]) < c->shape.radius && z > 0.0 && p->body[i] == c->param->soil) {
      deepest = pw_max(deepest, pw_pile_depth(&c->shape, p->x[i], z));
    }
  }
  return deepest;
}

/* Blows that have begun and are kept in the arrays. */
static int blows_kept(const pile_record *c)
{
  return c->flag[BLOWS] < PW_RECORD_ARRAY ? c->flag[BLOWS] : PW_RECORD_ARRAY;
}

/* The set of a blow is what the tip has gone down from its start to the start of the next. */
static void follow_blows(pw_sim *sim, pile_record *c)
{
  const pw_pulse *h = &c->pulse;
  pw_idx begun = pw_pulse_started(h, sim->time);
  bool last =
      begun == h->count && h->period > 0.0 && sim->time >= h->start + (pw_real)h->count * h->period;
  if (begun == c->flag[BLOWS] && last == (c->flag[BLOWS_DONE] != 0)) {
    return;
  }
  pw_real now = penetration(sim, c);
  if (c->flag[BLOWS] > 0 && c->flag[BLOWS] <= PW_RECORD_ARRAY) {
    c->set[c->flag[BLOWS] - 1] = now - c->real[BLOW_START];
  }
  c->real[BLOW_START] = now;
  c->flag[BLOWS] = begun;
  c->flag[BLOWS_DONE] = last;
}

static pw_status follow(pw_sim *sim, void *ctx)
{
  pile_record *c = ctx;
  if (!c->flag[GRAVITY_DONE] && sim->time >= c->gravity_s) {
    c->real[AFTER_GRAVITY] = penetration(sim, c);
    c->flag[GRAVITY_DONE] = 1;
  }
  if (c->pulse.count > 0) {
    follow_blows(sim, c);
  }
  if (sim->step % WATCH == 0) {
    pw_real depth = overlap(sim, c);
    c->real[LARGEST_OVERLAP] = pw_max(c->real[LARGEST_OVERLAP], depth);
    c->real[DEEPEST] = pw_max(c->real[DEEPEST], penetration(sim, c));
    if (c->flag[BLOWS] > 0 && c->flag[BLOWS] <= PW_RECORD_ARRAY && !c->flag[BLOWS_DONE]) {
      pw_real *blow = &c->overlap[c->flag[BLOWS] - 1];
      *blow = pw_max(*blow, depth);
    }
  }
  return PW_OK;
}

static void history(const pw_sim *sim, void *ctx, pw_record *row)
{
  const pile_record *c = ctx;
  pw_real depth = penetration(sim, c), far = settlement(sim, c);
  pw_record_put(row, "penetration_m", depth);
  pw_record_put(row, "penetration_below_settled_m", depth - far);
  pw_record_put(row, "pile_velocity_m_s", pile_velocity(sim, c));
  pw_record_put(row, "settlement_far_field_m", far);
  pw_record_put(row, "base_vertical_stress_kpa", base_stress(sim, c));
  pw_record_put(row, "overlap_m", overlap(sim, c));
}

static void results(const pw_sim *sim, void *ctx, pw_record *out)
{
  pile_record *c = ctx;
  pw_real depth = penetration(sim, c), far = settlement(sim, c);
  int kept = blows_kept(c);
  memcpy(c->shown, c->set, sizeof c->shown);
  if (kept > 0 && !c->flag[BLOWS_DONE] && c->flag[BLOWS] == kept) {
    c->shown[kept - 1] = depth - c->real[BLOW_START];
  }
  if (c->flag[GRAVITY_DONE]) {
    pw_record_put(out, "penetration_after_gravity_m", c->real[AFTER_GRAVITY]);
  }
  pw_record_put(out, "penetration_m", depth);
  pw_record_put(out, "penetration_below_settled_m", depth - far);
  pw_record_put(out, "settlement_far_field_m", far);
  pw_record_put(out, "rebound_m", pw_max(c->real[DEEPEST], depth) - depth);
  pw_record_put(out, "base_vertical_stress_kpa", base_stress(sim, c));
  pw_record_put(out, "largest_overlap_m", pw_max(c->real[LARGEST_OVERLAP], overlap(sim, c)));
  pw_record_put_array(out, "set_per_blow_m", c->shown, kept);
  pw_record_put_array(out, "overlap_per_blow_m", c->overlap, kept);
}

static pw_status archive(pw_sim *sim, void *ctx, pw_archive *ar)
{
  pile_record *c = ctx;
  (void)sim;
  PW_TRY(ar->real(ar, "pile_record/reals", c->real, REALS));
  PW_TRY(ar->index(ar, "pile_record/flags", c->flag, FLAGS));
  PW_TRY(ar->real(ar, "pile_record/set", c->set, PW_RECORD_ARRAY));
  return ar->real(ar, "pile_record/overlap", c->overlap, PW_RECORD_ARRAY);
}

static void destroy(void **ctx)
{
  pile_record *c = *ctx;
  if (c) {
    pw_mem_free(&c->tip.id);
    pw_mem_free(&c->far.id);
    pw_mem_free(&c->base.id);
    pw_mem_free(&c->far_y);
  }
  pw_mem_free(ctx);
}

typedef bool (*choose_fn)(const pw_sim *sim, const pile_record *c, pw_idx i);

static bool is_tip(const pw_sim *sim, const pile_record *c, pw_idx i)
{
  const pw_points *p = &sim->points;
  const pw_scene_body *b = &sim->scene.body[c->param->body];
  return p->body[i] == c->param->body &&
         lowest(p, i) < b->tip_y_m + c->shape.radius + c->shape.tip_length;
}

/* Of the cell that holds a point; m. */
static pw_real cell_height(const pw_sim *sim, pw_idx i)
{
  const pw_points *p = &sim->points;
  pw_real x[2] = {p->x[i], p->x[p->ld + i]}, size[2];
  pw_mesh_size_at(&sim->mesh, x, size);
  return size[1];
}

static bool is_far(const pw_sim *sim, const pile_record *c, pw_idx i)
{
  const pw_points *p = &sim->points;
  return p->body[i] == c->param->soil && p->x[i] > c->far_x &&
         p->x[p->ld + i] > c->surface - cell_height(sim, i);
}

static bool is_base(const pw_sim *sim, const pile_record *c, pw_idx i)
{
  const pw_points *p = &sim->points;
  pw_real over = p->x[p->ld + i] - c->base_y;
  pw_real size = pw_max(cell_height(sim, i), sim->scene.body[c->param->soil].point_size_m);
  return p->body[i] == c->param->soil && p->x[i] > 0.5 * c->far_x && over > 0.0 && over < size;
}

/* Ids of the points that `want` accepts, ascending. */
static pw_status choose(const pw_sim *sim, const pile_record *c, choose_fn want, chosen *out)
{
  const pw_points *p = &sim->points;
  pw_idx n = 0;
  for (pw_idx id = 0; id < p->n; id++) {
    n += want(sim, c, p->slot[id]);
  }
  PW_TRY(pw_mem_alloc("pile record: points", n, sizeof(pw_idx), &out->id));
  for (pw_idx id = 0; id < p->n; id++) {
    if (want(sim, c, p->slot[id])) {
      out->id[out->n++] = id;
    }
  }
  return PW_OK;
}

/* Soil surface, bottom and right end, from the scene's shape of the soil. */
static void soil_extent(const pw_sim *sim, pile_record *c)
{
  const pw_points *p = &sim->points;
  const pw_scene_body *soil = &sim->scene.body[c->param->soil];
  pw_real right = soil->x_m[1], bottom = soil->y_m[0];
  c->surface = soil->y_m[1];
  if (soil->shape != PW_SHAPE_RECTANGLE) {
    right = c->surface = -PW_HUGE;
    bottom = PW_HUGE;
    for (pw_idx i = 0; i < p->n; i++) {
      if (p->body[i] == c->param->soil) {
        right = pw_max(right, p->x[i]);
        bottom = pw_min(bottom, p->x[p->ld + i]);
        c->surface = pw_max(c->surface, p->x[p->ld + i]);
      }
    }
  }
  c->far_x = c->param->far_field_x_m > 0.0 ? c->param->far_field_x_m : 0.8 * right;
  c->base_y = c->param->base_y_m > -1e299 ? c->param->base_y_m : bottom;
}

/* When gravity is over, and the blows to follow. */
static void set_times(const pw_sim *sim, pile_record *c)
{
  const pw_hammer_param *h = pw_scene_find_effect(&sim->scene, "hammer");
  const pw_gravity_param *g = pw_scene_find_effect(&sim->scene, "gravity");
  c->gravity_s = g ? g->ramp_s : 0.0;
  if (h && h->body == c->param->body) {
    c->gravity_s = h->start_s;
    c->pulse = (pw_pulse){h->pulse, h->start_s, h->duration_s, h->rise_s, h->period_s, h->count};
  }
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  pile_record *c;
  PW_TRY(pw_mem_alloc("pile record", 1, sizeof *c, &c));
  *ctx = c;
  c->param = param;
  const pw_scene_body *pile = &sim->scene.body[c->param->body];
  c->shape = pw_pile_shape_of(pile);
  set_times(sim, c);
  soil_extent(sim, c);
  PW_TRY(choose(sim, c, is_tip, &c->tip));
  PW_TRY(choose(sim, c, is_far, &c->far));
  PW_TRY(choose(sim, c, is_base, &c->base));
  PW_REQUIRE(c->tip.n > 0 || sim->structure_of[c->param->body], PW_ERR_SCENE,
             "no point of body '%s' near its tip", pile->name);
  PW_REQUIRE(c->far.n > 0, PW_ERR_SCENE, "far_field_x_m = %g m: no soil point beyond it", c->far_x);
  PW_REQUIRE(c->base.n > 0, PW_ERR_SCENE, "base_y_m = %g m: no soil point above it", c->base_y);
  PW_TRY(pw_mem_alloc("pile record: heights", c->far.n, sizeof(pw_real), &c->far_y));
  for (pw_idx k = 0; k < c->far.n; k++) {
    c->far_y[k] = sim->points.x[sim->points.ld + sim->points.slot[c->far.id[k]]];
  }
  c->tip_shift = pile->tip_y_m - tip_height(sim, c);
  c->real[DEEPEST] = penetration(sim, c);
  return PW_OK;
}

static const pw_hook hooks[] = {
    {PW_STAGE_END, follow},
    {0, NULL},
};

const pw_effect pw_effect_pile_record = {
    .name = "pile_record",
    .brief = "penetration, set per blow, settlement, base stress and overlap of a pile",
    .structure_key = "body",
    .keys = keys,
    .hooks = hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
    .history = history,
    .results = results,
    .archive = archive,
};
