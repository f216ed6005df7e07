/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frictional contact of two velocity fields at the nodes of the grid.
 *
 * Source: Giridharan 2016, section 2.6.2 (after Bardenhagen and others), eq. 2.34-2.39, 2.49. With
 * A the slave and B the master, the correction of eq. 2.36 is an impulse: m_A (v_A - v_AB) . n is
 * the reduced mass times the velocity of approach. Written so, it is equal and opposite on both
 * bodies to the last bit, and a body of prescribed motion is the limit of infinite mass. */
#include "engine/effects/contact_frictional.h"

#include <math.h>

#include "engine/core/mem.h"

#define AT(member) offsetof(pw_contact_frictional_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"master", PW_KEY_BODY, AT(master), 0, 0, NULL, NULL, NULL,
   "one body: pile, plane; the reaction on it is reported"},
  {"slave", PW_KEY_BODY, AT(slave), 0, 0, NULL, NULL, NULL,
   "the other body: soil, cylinder; further bodies share its velocity field"},
  {"friction", PW_KEY_REAL, AT(friction), 0, 1e6, NULL, NULL, NULL, "Coulomb's coefficient"},
  {"normal", PW_KEY_CHOICE, AT(normal), 0, 0, "master", "average|master|slave", NULL,
   "whose surface gives the direction of contact; average: both, weighted by area"},
  {"require_compression", PW_KEY_BOOL, AT(require_compression), 0, 0, "true", NULL, NULL,
   "shared_nodes: contact only where the normal stress of the bodies is not tensile"},
  {"detection", PW_KEY_CHOICE, AT(detection), 0, 0, "shared_nodes", "shared_nodes|closed_gap", NULL,
   "where bodies may push: as soon as they share a node, a cell or two apart, as in the thesis; or "
   "where the gap between their points' domains closes in the step; in soil that flows it wants "
   "method.noise_damping_per_s, contact_corner does not"},
  {0}};
/* clang-format on */

/* With up to so many nodes one thread is enough. */
enum { FEW_NODES = 256 };

typedef struct frictional {
  pw_contact_tally tally; /* first: engine/effects/contact.h */
  const pw_contact_frictional_param *param;
  pw_contact_surfaces surfaces;
  pw_idx lowest; /* id of the lowest point of the master */
  pw_real below; /* the master's lowest place below the centre of that point; m */
  pw_real tip;   /* height of the tip part above that place; m */
} frictional;

static pw_status update_surfaces(pw_sim *sim, void *ctx)
{
  (void)sim;
  frictional *c = ctx;
  pw_contact_surfaces_update(&c->surfaces);
  return PW_OK;
}

/* What the correction of a node needs to know of one body. */
typedef struct side {
  pw_real *rec; /* its velocity field */
  bool given;   /* prescribed motion */
  pw_real v[2]; /* then its velocity; m/s */
} side;

static side side_of(const pw_sim *sim, int body)
{
  const pw_body *b = &sim->body[body];
  return (side){.rec = pw_nodes_field(&sim->nodes, b->field),
                .given = b->prescribed,
                .v = {b->prescribed_v[0], b->prescribed_v[1]}};
}

/* Normal impulse that ends the approach once the gap is closed, and the tangential one that friction
 * can give.
 *
 * Remapped velocities (MUSL) move the points and strain them, but their correction reaches no
 * momentum. Were it one-sided, as for the velocities themselves, each wave through a body at rest
 * would lift its surface in one half and hold it in the other: the body climbs and the wave grows.
 * So nodes that touch in the step keep together, and stuck ones stuck, in the remapped field. */
static void correct_node(const pw_sim *sim, const frictional *c, const side *s, pw_contact_node *at)
{
  const int slot = sim->node_slot;
  pw_real *a = s[0].rec + (pw_off)at->node * PW_NODE, *b = s[1].rec + (pw_off)at->node * PW_NODE;
  const pw_real *n = at->normal;
  pw_real d[2], wa = s[0].given ? 0.0 : 1.0 / a[PW_NODE_MASS];
  pw_real wb = s[1].given ? 0.0 : 1.0 / b[PW_NODE_MASS];
  const bool held = slot == PW_NODE_REMAP && at->touching, stuck = held && at->stuck;
  at->touching = held;
  at->impulse[0] = at->impulse[1] = at->loss = 0.0;
  if (wa + wb <= 0.0 || !at->facing) {
    return;
  }
  for (int i = 0; i < 2; i++) {
    d[i] = (s[0].given ? s[0].v[i] : a[slot + i]) - (s[1].given ? s[1].v[i] : b[slot + i]);
  }
  pw_real approach = d[0] * n[0] + d[1] * n[1] - at->gap / sim->dt,
          along = -d[0] * n[1] + d[1] * n[0];
  if (approach <= 0.0 && !held) {
    return;
  }
  pw_real reduced = 1.0 / (wa + wb), normal = reduced * approach, stick = reduced * fabs(along);
  pw_real cap = stuck ? stick : c->param->friction * pw_max(normal, 0.0);
  pw_real tangential = copysign(pw_min(cap, stick), along);
  for (int i = 0; i < 2; i++) {
    pw_real j = normal * n[i] + tangential * (i == 0 ? -n[1] : n[0]);
    a[slot + i] -= j / a[PW_NODE_MASS];
    b[slot + i] += j / b[PW_NODE_MASS];
    at->impulse[i] = j;
    /* Work of the impulse over the step: its mean relative velocity, from t(n) to after it. */
    pw_real start = (s[0].given ? s[0].v[i] : a[PW_NODE_FORCE + i]) -
                    (s[1].given ? s[1].v[i] : b[PW_NODE_FORCE + i]);
    at->loss += j * 0.5 * (start + d[i] - (wa + wb) * j);
  }
  at->touching = true;
  at->stuck = cap >= stick;
}

static void correct(const pw_sim *sim, const frictional *c)
{
  const side s[2] = {side_of(sim, c->param->slave), side_of(sim, c->param->master)};
  pw_contact_node *list = c->surfaces.list;
  const pw_idx count = c->surfaces.count;
#pragma omp parallel for default(none) shared(sim, c, s, list, count)                              \
    num_threads(sim->threads) if (count > FEW_NODES) schedule(static)
  for (pw_idx i = 0; i < count; i++) {
    correct_node(sim, c, s, &list[i]);
  }
}

/* Height below which a node of the grid belongs to the master's tip. */
static pw_real tip_height(const pw_sim *sim, const frictional *c)
{
  pw_idx i = sim->points.slot[c->lowest];
  return sim->points.x[sim->points.ld + i] - c->below + pw_max(c->tip, 0.5 * sim->mesh.cell);
}

static pw_status constrain(pw_sim *sim, void *ctx)
{
  frictional *c = ctx;
  correct(sim, c);
  pw_contact_tally_begin(&c->tally);
  pw_real height = tip_height(sim, c), loss = 0.0;
  for (pw_idx i = 0; i < c->surfaces.count; i++) {
    const pw_contact_node *at = &c->surfaces.list[i];
    pw_real force[2] = {at->impulse[0] / sim->dt, at->impulse[1] / sim->dt};
    pw_contact_tally_add(&c->tally, force, pw_mesh_node_y(&sim->mesh, at->node) < height);
    c->tally.pairs += at->touching ? 1 : 0;
    loss += at->loss;
  }
  pw_contact_tally_end(&c->tally, sim->measure, sim->dt);
  sim->energy.contact += sim->measure * loss;
  return PW_OK;
}

static pw_status constrain_remap(pw_sim *sim, void *ctx)
{
  correct(sim, ctx);
  return PW_OK;
}

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_contact_frictional_param *p = param;
  return pw_contact_check(scene, p->master, p->slave);
}

/* Point whose domain reaches lowest, and by how much. */
static void find_lowest(const pw_sim *sim, frictional *c)
{
  const pw_points *p = &sim->points;
  const pw_scene_body *body = &sim->scene.body[c->param->master];
  pw_real lowest = PW_HUGE;
  c->lowest = 0;
  for (pw_idx id = 0; id < p->n; id++) {
    pw_idx i = p->slot[id];
    pw_real y = p->x[p->ld + i];
    pw_real half = p->half ? fabs(p->half[p->ld + i]) + fabs(p->half[3 * p->ld + i]) : 0.0;
    if (p->body[i] == c->param->master && y - half < lowest) {
      lowest = y - half;
      c->lowest = id;
      c->below = body->shape == PW_SHAPE_PILE ? y - body->tip_y_m : half;
    }
  }
  c->tip = body->shape == PW_SHAPE_PILE && body->tip != PW_TIP_FLAT ? body->tip_length_m : 0.0;
}

static void destroy(void **ctx)
{
  frictional *c = *ctx;
  if (c) {
    pw_contact_surfaces_destroy(&c->surfaces);
  }
  pw_mem_free(ctx);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  frictional *c;
  PW_TRY(pw_mem_alloc("contact_frictional", 1, sizeof *c, &c));
  *ctx = c;
  c->param = param;
  PW_TRY(pw_contact_surfaces_create(sim, param, &c->surfaces));
  find_lowest(sim, c);
  return PW_OK;
}

static void history(const pw_sim *sim, void *ctx, pw_record *row)
{
  (void)sim;
  frictional *c = ctx;
  pw_contact_tally_history(&c->tally, row);
}

static pw_status archive(pw_sim *sim, void *ctx, pw_archive *ar)
{
  (void)sim;
  frictional *c = ctx;
  return pw_contact_tally_archive(&c->tally, "contact_frictional/reaction", ar);
}

static const pw_hook hooks[] = {
    {PW_STAGE_P2G, update_surfaces},
    {PW_STAGE_CONSTRAINT, constrain},
    {PW_STAGE_REMAP, constrain_remap},
    {0, NULL},
};

const pw_effect pw_effect_contact_frictional = {
    .name = "contact_frictional",
    .brief = "two velocity fields, Coulomb friction at nodes (Giridharan 2016, 2.6.2)",
    .own_velocity_fields = true,
    .lumped_only = true,
    .keys = keys,
    .hooks = hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
    .history = history,
    .archive = archive,
};
