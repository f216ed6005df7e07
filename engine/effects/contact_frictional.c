/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frictional contact of two velocity fields at the nodes of the grid.
 *
 * Source: Giridharan 2016, section 2.6.2 (after Bardenhagen and others), eq. 2.34-2.39, 2.49. With
 * A the slave and B the master, the correction of eq. 2.36 is an impulse: m_A (v_A - v_AB) . n is
 * the reduced mass times the velocity of approach. Written so, it is equal and opposite on both
 * bodies to the last bit, and a body of prescribed motion is the limit of infinite mass. */
#include <math.h>
#include <string.h>

#include "engine/assemble.h"
#include "engine/core/mem.h"
#include "engine/effects/contact.h"

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
   "contact only where the normal stress of the bodies is not tensile"},
  {0}};
/* clang-format on */

/* Up to so many points a colour, and so many nodes, one thread is enough. */
enum { FEW_POINTS = 100, FEW_NODES = 256 };

/* Lowest and highest node along x and y, inclusive. */
typedef struct window {
  pw_idx low[2], high[2];
} window;

/* A node with mass of both bodies. */
typedef struct contact_node {
  pw_idx node;
  bool touching;      /* in this step */
  bool stuck;         /* friction holds it */
  pw_real impulse[2]; /* on the master; N s (per metre or radian) */
  pw_real loss;       /* energy lost, when slot FORCE holds v(n); J (likewise) */
} contact_node;

typedef struct frictional {
  pw_contact_tally tally; /* first: engine/effects/contact.h */
  const pw_contact_frictional_param *param;
  window *support;  /* [nblock] nodes that a block may scatter to */
  bool *near;       /* [nblock] its support holds nodes of both bodies */
  window meeting;   /* what these nodes span, in this step */
  pw_real *surface; /* [2][nnode][PW_NODE] surface normals and stresses of slave and master */
  pw_idx count;
  contact_node *list; /* [nnode] */
  pw_idx lowest;      /* id of the lowest point of the master */
  pw_real below;      /* the master's lowest place below the centre of that point; m */
  pw_real tip;        /* height of the tip part above that place; m */
  pw_sim *sim;
} frictional;

static window window_empty(void)
{
  return (window){{INT32_MAX, INT32_MAX}, {-1, -1}};
}

static void window_add(window *w, const window *other)
{
  for (int a = 0; a < 2; a++) {
    w->low[a] = other->low[a] < w->low[a] ? other->low[a] : w->low[a];
    w->high[a] = other->high[a] > w->high[a] ? other->high[a] : w->high[a];
  }
}

static bool window_meets(const window *a, const window *b)
{
  return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1] &&
         b->low[1] <= a->high[1];
}

/* Nodes within reach of an element, to which its points may scatter until they are sorted anew. */
static window window_of(const pw_blocks *b, pw_idx elem)
{
  const pw_idx i = elem % b->cells[0], j = elem / b->cells[0];
  return (window){{i - b->reach, j - b->reach}, {i + 1 + b->reach, j + 1 + b->reach}};
}

/* Nodes within reach of the elements of each block. */
static void set_supports(const pw_sim *sim, window *support)
{
  const pw_blocks *b = &sim->blocks;
  for (pw_idx k = 0; k < b->nblock; k++) {
    window w = window_empty();
    for (pw_idx e = b->elem_start[k]; e < b->elem_start[k + 1]; e++) {
      const window reach = window_of(b, b->elem[e]);
      window_add(&w, &reach);
    }
    for (int a = 0; a < 2; a++) {
      w.low[a] = w.low[a] > 0 ? w.low[a] : 0;
      w.high[a] = w.high[a] < b->cells[a] ? w.high[a] : b->cells[a];
    }
    support[k] = w;
  }
}

/* List the nodes with mass of both bodies, in their order; returns what they span. */
static window list_nodes(const pw_sim *sim, frictional *c)
{
  const pw_nodes *nodes = &sim->nodes;
  const int slave = sim->body[c->param->slave].field, master = sim->body[c->param->master].field;
  const pw_real *a = pw_nodes_field(nodes, slave), *b = pw_nodes_field(nodes, master);
  window w = window_empty();
  c->count = 0;
  for (pw_idx k = 0; k < nodes->nnode; k++) {
    const pw_off at = (pw_off)k * PW_NODE + PW_NODE_MASS;
    if (!pw_nodes_in_use(nodes, master, k)) {
      k = pw_nodes_group_end(nodes, master, k) - 1;
    } else if (!pw_nodes_in_use(nodes, slave, k)) {
      k = pw_nodes_group_end(nodes, slave, k) - 1;
    } else if (b[at] > sim->mass_cut_off && a[at] > sim->mass_cut_off) {
      const pw_idx i = k % sim->mesh.nodes[0], j = k / sim->mesh.nodes[0];
      c->list[c->count++] = (contact_node){.node = k};
      window_add(&w, &(window){{i, j}, {i, j}});
    }
  }
  return w;
}

static pw_real *surface_of(const pw_sim *sim, const frictional *c, int field)
{
  return c->surface + (pw_off)field * sim->nodes.nnode * PW_NODE;
}

/* Those of the points [first, end) that can reach a node with both bodies, run by run. */
static void scatter_runs(const pw_sim *sim, const frictional *c, pw_real *surface, pw_idx first,
                         pw_idx end)
{
  for (pw_idx k = first; k < end;) {
    pw_idx from = k;
    for (bool near = true; near && k < end; k += near) {
      const window reach = window_of(&sim->blocks, sim->points.home[k]);
      near = window_meets(&reach, &c->meeting);
    }
    if (k > from) {
      sim->kernels->p2g_surface(&sim->transfer, surface, from, k);
    }
    k += k < end; /* that one is too far */
  }
}

static void scatter_surface(void *ctx, pw_idx block)
{
  frictional *c = ctx;
  const pw_sim *sim = c->sim;
  const pw_blocks *b = &sim->blocks;
  for (int body = 0; c->near[block] && body < b->nbody; body++) {
    const pw_idx *start = b->point_start + (pw_off)block * b->nbody + body;
    scatter_runs(sim, c, surface_of(sim, c, sim->body[body].field), start[0], start[1]);
  }
}

/* Mark the blocks that can reach a node with both bodies; returns how many points they hold. */
static pw_idx mark_near(const pw_sim *sim, frictional *c)
{
  const pw_blocks *b = &sim->blocks;
  pw_idx points = 0;
  for (pw_idx k = 0; k < b->nblock; k++) {
    const pw_idx *start = b->point_start + (pw_off)k * b->nbody;
    c->near[k] = window_meets(&c->support[k], &c->meeting);
    points += c->near[k] ? start[b->nbody] - start[0] : 0;
  }
  return points;
}

/* At the nodes with both bodies. The others go on adding up what nobody reads. */
static void clear_surfaces(const pw_sim *sim, const frictional *c)
{
  for (int f = 0; f < 2; f++) {
    pw_real *surface = surface_of(sim, c, f);
    for (pw_idx i = 0; i < c->count; i++) {
      memset(surface + (pw_off)c->list[i].node * PW_NODE, 0, PW_NODE * sizeof *surface);
    }
  }
}

/* Surface normals and stresses, only from blocks that can reach a node with both bodies. Few points
 * are sooner scattered by one thread, in the order of the colours, than the colours' barriers
 * passed. */
static pw_status add_surfaces(pw_sim *sim, void *ctx)
{
  frictional *c = ctx;
  const pw_blocks *b = &sim->blocks;
  c->meeting = list_nodes(sim, c);
  if (c->count == 0) {
    return PW_OK;
  }
  const pw_idx points = mark_near(sim, c);
  clear_surfaces(sim, c);
  if (points > FEW_POINTS * b->ncolour) {
    pw_assemble_coloured(b, sim->threads, scatter_surface, c);
    return PW_OK;
  }
  for (pw_idx k = 0; k < b->nblock; k++) {
    scatter_surface(c, b->colour_block[k]);
  }
  return PW_OK;
}

/* What the correction of a node needs to know of one body. */
typedef struct side {
  pw_real *rec; /* its velocity field */
  const pw_real *surface;
  bool given;   /* prescribed motion */
  pw_real v[2]; /* then its velocity; m/s */
} side;

static side side_of(const pw_sim *sim, const frictional *c, int body)
{
  const pw_body *b = &sim->body[body];
  return (side){.rec = pw_nodes_field(&sim->nodes, b->field),
                .surface = surface_of(sim, c, b->field),
                .given = b->prescribed,
                .v = {b->prescribed_v[0], b->prescribed_v[1]}};
}

/* Unit normal out of A; false where the surfaces give none or the bodies are pulled there. */
static bool contact_normal(const pw_sim *sim, const frictional *c, const side *s, pw_idx node,
                           pw_real *n)
{
  const pw_real *a = s[0].surface + (pw_off)node * PW_NODE;
  const pw_real *b = s[1].surface + (pw_off)node * PW_NODE;
  const bool axi = sim->scene.geometry == PW_AXI;
  pw_real r = pw_mesh_node_x(&sim->mesh, node), size = sim->mesh.cell;
  pw_real fa = c->param->normal != PW_NORMAL_MASTER ? 1.0 : 0.0;
  pw_real fb = c->param->normal != PW_NORMAL_SLAVE ? 1.0 : 0.0;
  pw_real nx = fa * a[0] - fb * b[0], ny = fa * a[1] - fb * b[1];
  if (axi && r <= 1e-9 * size) {
    nx = 0.0; /* on the axis of symmetry */
  }
  size *= axi ? pw_max(r, size) : 1.0;
  pw_real length = sqrt(nx * nx + ny * ny);
  if (length <= 1e-9 * size) {
    return false;
  }
  n[0] = nx / length;
  n[1] = ny / length;
  pw_real stress =
      (a[2] + b[2]) * n[0] * n[0] + (a[3] + b[3]) * n[1] * n[1] + 2.0 * (a[4] + b[4]) * n[0] * n[1];
  return !c->param->require_compression || stress <= 0.0;
}

/* Normal impulse that ends the approach, and the tangential one that friction can give.
 *
 * Remapped velocities (MUSL) move the points and strain them, but their correction reaches no
 * momentum. Were it one-sided, as for the velocities themselves, each wave through a body at rest
 * would lift its surface in one half and hold it in the other: the body climbs and the wave grows.
 * So nodes that touch in the step keep together, and stuck ones stuck, in the remapped field. */
static void correct_node(const pw_sim *sim, const frictional *c, const side *s, contact_node *at)
{
  const int slot = sim->node_slot;
  pw_real *a = s[0].rec + (pw_off)at->node * PW_NODE, *b = s[1].rec + (pw_off)at->node * PW_NODE;
  pw_real n[2], d[2], wa = s[0].given ? 0.0 : 1.0 / a[PW_NODE_MASS];
  pw_real wb = s[1].given ? 0.0 : 1.0 / b[PW_NODE_MASS];
  const bool held = slot == PW_NODE_REMAP && at->touching, stuck = held && at->stuck;
  at->touching = held;
  at->impulse[0] = at->impulse[1] = at->loss = 0.0;
  if (wa + wb <= 0.0 || !contact_normal(sim, c, s, at->node, n)) {
    return;
  }
  for (int i = 0; i < 2; i++) {
    d[i] = (s[0].given ? s[0].v[i] : a[slot + i]) - (s[1].given ? s[1].v[i] : b[slot + i]);
  }
  pw_real approach = d[0] * n[0] + d[1] * n[1], along = -d[0] * n[1] + d[1] * n[0];
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
  const side s[2] = {side_of(sim, c, c->param->slave), side_of(sim, c, c->param->master)};
  contact_node *list = c->list;
  const pw_idx count = c->count;
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
  for (pw_idx i = 0; i < c->count; i++) {
    const contact_node *at = &c->list[i];
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
    pw_mem_free(&c->support);
    pw_mem_free(&c->near);
    pw_mem_free(&c->surface);
    pw_mem_free(&c->list);
  }
  pw_mem_free(ctx);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  const pw_idx nblock = sim->blocks.nblock, nnode = sim->nodes.nnode;
  frictional *c;
  PW_TRY(pw_mem_alloc("contact_frictional", 1, sizeof *c, &c));
  *ctx = c;
  c->param = param;
  c->sim = sim;
  PW_TRY(pw_mem_alloc("block supports", nblock, sizeof *c->support, &c->support));
  PW_TRY(pw_mem_alloc("blocks in contact", nblock, sizeof *c->near, &c->near));
  PW_TRY(pw_mem_alloc("surfaces", 2 * (pw_off)nnode * PW_NODE, sizeof(pw_real), &c->surface));
  PW_TRY(pw_mem_alloc("contact nodes", nnode, sizeof *c->list, &c->list));
  set_supports(sim, c->support);
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
    {PW_STAGE_P2G, add_surfaces},
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
