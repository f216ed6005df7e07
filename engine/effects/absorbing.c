/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Absorbing sides of the grid: viscous dashpots (Lysmer and Kuhlemeyer, J. Engng Mech. Div. ASCE 95,
 * 1969) with springs against creep.
 *
 * Until start_s a side is held (roller or fixed). Then the reaction of each of its nodes is kept as
 * a force R, so that the stress at rest stays as it is, and the nodes are free under
 *
 *   F = R - c v - k u,   c_n = a rho c_p A, c_t = b rho c_s A, k_n = 2 G A / L, k_t = G A / (2 L),
 *
 * u the displacement since then, L the distance to the source. The dashpot is integrated exactly
 * over the step (with c dt / m near 1, backward Euler would return 3 % of a wave), the spring
 * implicitly: neither limits the step. rho c_p is the mass-weighted mean over the points of the cells along
 * the side, with the wave speed of their present stiffness; A is the part of the side that these
 * points cover. k_n is the static stiffness of a cylindrical cavity of radius L (Lame), k_t follows
 * from the outgoing cylindrical shear wave u ~ r^-1/2 f(r - c_s t), tau = -rho c_s v - G u / (2 r).
 */
#include "engine/effects/common.h"
#include "engine/effects/params.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"

#define AT(member) offsetof(pw_absorbing_param, member)

enum { SURVEY_EVERY = 16 }; /* steps after which areas and impedances are found anew */

/* clang-format off */
static const pw_key keys[] = {
  {"side", PW_KEY_CHOICE, AT(side), 0, 0, NULL, "bottom|top|left|right", NULL, "side of the grid"},
  {"normal_factor", PW_KEY_REAL, AT(normal_factor), 0, 100, "1", NULL, NULL,
   "a of the normal dashpot a rho c_p A"},
  {"shear_factor", PW_KEY_REAL, AT(shear_factor), 0, 100, "1", NULL, NULL,
   "b of the tangential dashpot b rho c_s A"},
  {"shear_ratio", PW_KEY_REAL, AT(shear_ratio), 0.01, 0.866, "0.5345", NULL, NULL,
   "c_s / c_p = sqrt((1 - 2 nu) / (2 - 2 nu)); the default is for nu = 0.3"},
  {"source_distance_m", PW_KEY_REAL, AT(source_distance_m), 0, 1e6, "0", NULL, NULL,
   "L of the springs against creep: distance to the source of the waves; 0: no springs"},
  {"before", PW_KEY_CHOICE, AT(before), 0, 0, "roller", "roller|fixed", NULL,
   "how the side is held until start_s; what is held then is carried on as a constant force"},
  {"start_s", PW_KEY_REAL, AT(start_s), 0, 1e12, "0", NULL, NULL,
   "time from which the side absorbs: not before the soil is at rest under its weight"},
  {"mean_over_s", PW_KEY_REAL, AT(mean_over_s), 0, 1e12, "0", NULL, NULL,
   "time before start_s over which the reactions are averaged; 0: those of one step"},
  {0}};
/* clang-format on */

/* One node of the side in one velocity field; only reals, so that it is archived as an array. */
typedef struct absorber {
  pw_real area;         /* covered by points; m2 per metre or radian */
  pw_real impedance;    /* rho c_p; Pa s/m */
  pw_real modulus;      /* rho c_p^2; Pa */
  pw_real stiffness[2]; /* of the springs, from the start on; N/m */
  pw_real held[2];      /* reaction; before the start its integral over the mean's time; N, N s */
  pw_real moved[2];     /* since the start; m */
  pw_real force[2];     /* of dashpot and spring in this step; N */
} absorber;

enum { ABSORBER = sizeof(absorber) / sizeof(pw_real) };

typedef struct absorbing {
  const pw_absorbing_param *param;
  int instance, normal; /* axis of the side's normal */
  bool active;
  pw_real held_time;   /* over which held has been summed; s */
  pw_real absorbed;    /* since the start, whole body; J */
  pw_real stored;      /* in the springs now, whole body; J */
  pw_real reaction[2]; /* on the bodies, in the last step, whole body; N */
  pw_idx n, nq;        /* nodes; nodes times velocity fields */
  pw_idx *node;        /* [n] of the grid, along the side */
  pw_idx inward;       /* from a node to its neighbour inside the grid */
  absorber *q;         /* [nfield * n] */
  pw_real *mass;       /* [nq] weights of the survey; kg */
  pw_real *cover;      /* [nq] volume of the points beside the edge that begins at the node; m3 */
} absorbing;

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_absorbing_param *p = param;
  const pw_gravity_param *g = pw_scene_find_effect(scene, "gravity");
  PW_REQUIRE(!g || p->start_s >= g->ramp_s, PW_ERR_SCENE,
             "start_s = %g s lies before the end of gravity.ramp_s = %g s: the side would give way",
             p->start_s, g->ramp_s);
  PW_REQUIRE(p->mean_over_s <= p->start_s, PW_ERR_SCENE,
             "mean_over_s = %g s is longer than the time before start_s = %g s", p->mean_over_s,
             p->start_s);
  PW_REQUIRE(scene->geometry != PW_AXI || p->side != PW_SIDE_LEFT || scene->grid.origin_m[0] > 0.0,
             PW_ERR_SCENE, "side: left is the axis of symmetry, which cannot absorb");
  for (int e = 0; e < scene->neffect; e++) {
    const char *name = scene->effect[e].type->name;
    const void *other = scene->effect[e].param;
    const pw_boundary_param *b = other;
    const pw_absorbing_param *a = other;
    PW_REQUIRE(strcmp(name, "boundary") != 0 || b->side != p->side, PW_ERR_SCENE,
               "side: a boundary section holds this side too; until start_s the absorbing side is "
               "held by itself");
    PW_REQUIRE(strcmp(name, "absorbing") != 0 || other == param || a->side != p->side, PW_ERR_SCENE,
               "side: two absorbing sections name this side");
  }
  return PW_OK;
}

/* Components held before the start. */
static bool holds(const absorbing *c, int a)
{
  return a == c->normal || c->param->before == PW_BEFORE_FIXED;
}

static pw_real coordinate(const pw_mesh *m, int axis, pw_idx node)
{
  return axis == 0 ? pw_mesh_node_x(m, node) : pw_mesh_node_y(m, node);
}

/* Index along the side of the cell with these corner nodes, or -1 when it does not touch it. */
static pw_idx edge_of(const absorbing *c, const pw_mesh *m, const pw_idx node[4])
{
  const pw_idx at[2] = {node[0] % m->nodes[0], node[0] / m->nodes[0]};
  const pw_idx layer = c->inward < 0 ? m->nodes[c->normal] - 2 : 0;
  return at[c->normal] == layer ? at[1 - c->normal] : -1;
}

/* Add point i of the cell at edge k. */
static void add_point(const pw_points *p, pw_idx i, const absorbing *c, pw_idx q, pw_real upper)
{
  const pw_real density = p->mass[i] / p->vol[i], speed = p->wave_speed[i];
  const pw_real share[2] = {(1.0 - upper) * p->mass[i], upper * p->mass[i]};
  c->cover[q] += p->vol[i];
  for (int k = 0; k < 2; k++) {
    c->mass[q + k] += share[k];
    c->q[q + k].impedance += share[k] * density * speed;
    c->q[q + k].modulus += share[k] * density * speed * speed;
  }
}

/* Sums over the points of the cells along the side. Serial, in the points' order, which does not
 * depend on threads. */
static void gather(const pw_sim *sim, absorbing *c)
{
  const pw_points *p = &sim->points;
  const pw_mesh *m = &sim->mesh;
  const pw_real wall[2] = {coordinate(m, c->normal, c->node[0]),
                           coordinate(m, c->normal, c->node[0] + c->inward)};
  const pw_real lo = pw_min(wall[0], wall[1]), hi = pw_max(wall[0], wall[1]);
  for (pw_idx i = 0; i < p->n; i++) {
    pw_real x[2] = {p->x[i], p->x[p->ld + i]}, w[4];
    if (x[c->normal] < lo || x[c->normal] > hi) {
      continue;
    }
    pw_idx node[4];
    pw_mesh_shape(m, x, node, w);
    pw_idx k = edge_of(c, m, node);
    if (k >= 0) {
      pw_real upper = c->normal == 0 ? w[2] + w[3] : w[1] + w[3];
      add_point(p, i, c, sim->body[p->body[i]].field * c->n + k, upper);
    }
  }
}

/* Integrals of the two shape functions over the edge from node k to node k + 1, per metre or
 * radian. Returns the volume of the cell beside it. */
static pw_real edge_areas(const pw_sim *sim, const absorbing *c, pw_idx k, pw_real area[2])
{
  const pw_mesh *m = &sim->mesh;
  const bool axi = sim->scene.geometry == PW_AXI;
  const int n = c->normal;
  pw_idx first = c->node[k], last = c->node[k + 1], inner = first + c->inward;
  pw_real length = coordinate(m, 1 - n, last) - coordinate(m, 1 - n, first);
  pw_real depth = fabs(coordinate(m, n, inner) - coordinate(m, n, first));
  pw_real r0 = axi ? pw_mesh_node_x(m, first) : 1.0, r1 = axi ? pw_mesh_node_x(m, last) : 1.0;
  pw_real r_in = axi && n == 0 ? pw_mesh_node_x(m, inner) : r1;
  area[0] = length * (2.0 * r0 + r1) / 6.0;
  area[1] = length * (r0 + 2.0 * r1) / 6.0;
  return length * depth * 0.5 * (r0 + r_in);
}

/* Areas and impedances of the nodes from the points along the side as they are now. */
static void survey(const pw_sim *sim, absorbing *c)
{
  for (pw_idx q = 0; q < c->nq; q++) {
    c->mass[q] = c->cover[q] = 0.0;
    c->q[q].area = c->q[q].impedance = c->q[q].modulus = 0.0;
  }
  gather(sim, c);
  for (pw_idx q = 0; q < c->nq; q++) {
    pw_real inv = c->mass[q] > 0.0 ? 1.0 / c->mass[q] : 0.0;
    c->q[q].impedance *= inv;
    c->q[q].modulus *= inv;
  }
  for (pw_idx q = 0; q < c->nq; q++) {
    if (q % c->n < c->n - 1) {
      pw_real area[2], volume = edge_areas(sim, c, q % c->n, area);
      pw_real part = pw_min(1.0, c->cover[q] / volume);
      c->q[q].area += part * area[0];
      c->q[q + 1].area += part * area[1];
    }
  }
}

static pw_real *record(const pw_sim *sim, const absorbing *c, pw_idx q)
{
  return pw_nodes_field(&sim->nodes, (int)(q / c->n)) + (pw_off)c->node[q % c->n] * PW_NODE;
}

/* Whether component a of a node, at a corner, is still held by an absorbing side before this one in
 * the scene: that one sums its reaction. Once it is let go, its reaction is among the loads. */
static bool held_before(const pw_sim *sim, const absorbing *c, pw_idx node, int a)
{
  const pw_idx *nodes = sim->mesh.nodes, at[2] = {node % nodes[0], node / nodes[0]};
  for (int e = 0; sim->ctx[e] != c; e++) {
    const absorbing *other = sim->ctx[e];
    if (strcmp(sim->scene.effect[e].type->name, "absorbing") == 0 && !other->active &&
        holds(other, a) &&
        at[other->normal] == (other->inward < 0 ? nodes[other->normal] - 1 : 0)) {
      return true;
    }
  }
  return false;
}

/* Towards the mean reaction; the force slots hold internal forces and loads, no damping yet. Nodes
 * without mass are not held, and what their slots say is no motion: here and in all loops below. */
static void sum_reactions(const pw_sim *sim, absorbing *c, pw_real weight)
{
  for (pw_idx q = 0; q < c->nq; q++) {
    const pw_real *r = record(sim, c, q);
    for (int a = 0; a < 2; a++) {
      if (r[PW_NODE_MASS] > 0.0 && holds(c, a) && !held_before(sim, c, c->node[q % c->n], a)) {
        c->q[q].held[a] -= weight * r[PW_NODE_FORCE + a];
      }
    }
  }
  c->held_time += weight;
}

/* The side is free from this step on. */
static void release(const pw_sim *sim, absorbing *c)
{
  const pw_absorbing_param *p = c->param;
  if (c->held_time == 0.0) {
    sum_reactions(sim, c, 1.0);
  }
  survey(sim, c);
  for (pw_idx q = 0; q < c->nq; q++) {
    absorber *b = &c->q[q];
    pw_real shear = b->modulus * p->shear_ratio * p->shear_ratio * b->area; /* G A */
    pw_real spring = p->source_distance_m > 0.0 ? shear / p->source_distance_m : 0.0;
    for (int a = 0; a < 2; a++) {
      b->held[a] /= c->held_time;
      b->stiffness[a] = (a == c->normal ? 2.0 : 0.5) * spring;
    }
  }
  c->active = true;
}

static pw_status add_held(pw_sim *sim, void *ctx)
{
  absorbing *c = ctx;
  if (!c->active) {
    const pw_real start = c->param->start_s;
    if (sim->time < start * (1.0 - 1e-12)) {
      if (sim->time >= start - c->param->mean_over_s) {
        sum_reactions(sim, c, sim->dt);
      }
      return PW_OK;
    }
    release(sim, c);
  } else if (sim->step % SURVEY_EVERY == 0) {
    survey(sim, c);
  }
  for (pw_idx q = 0; q < c->nq; q++) {
    pw_real *r = record(sim, c, q);
    for (int a = 0; r[PW_NODE_MASS] > 0.0 && a < 2; a++) {
      r[PW_NODE_FORCE + a] += c->q[q].held[a] - c->q[q].stiffness[a] * c->q[q].moved[a];
    }
  }
  return PW_OK;
}

/* Before the start: nothing moves, as with a boundary section. */
static void hold(pw_sim *sim, absorbing *c)
{
  pw_real gained[2] = {0.0, 0.0};
  for (pw_idx q = 0; q < c->nq; q++) {
    pw_real *r = record(sim, c, q);
    for (int a = 0; r[PW_NODE_MASS] > 0.0 && a < 2; a++) {
      if (holds(c, a)) {
        gained[a] += r[PW_NODE_MASS] * (r[PW_NODE_VEL + a] - r[PW_NODE_FORCE + a]);
        r[PW_NODE_VEL + a] = r[PW_NODE_FORCE + a] = 0.0;
      }
    }
  }
  for (int a = 0; a < 2; a++) {
    c->reaction[a] = -sim->measure * gained[a] / sim->dt;
  }
}

/* What a dashpot changes of the velocity v that a step without it would give, from v_n: exact for
 * m dv/dt = f - c v under the constant force f of the step, x = c dt / m. */
static pw_real settle(pw_real v_n, pw_real v, pw_real x)
{
  pw_real lost = -expm1(-x); /* 1 - e^-x */
  pw_real gain = x > 0.0 ? lost / x : 1.0;
  return (gain - 1.0) * (v - v_n) - lost * v_n;
}

/* Dashpots of c + dt k: with dt k the springs are implicit. */
static pw_status absorb(pw_sim *sim, void *ctx)
{
  absorbing *c = ctx;
  if (!c->active) {
    hold(sim, c);
    return PW_OK;
  }
  const pw_absorbing_param *p = c->param;
  pw_real sum[2] = {0.0, 0.0};
  for (pw_idx q = 0; q < c->nq; q++) {
    absorber *b = &c->q[q];
    pw_real *r = record(sim, c, q);
    b->force[0] = b->force[1] = 0.0;
    for (int a = 0; r[PW_NODE_MASS] > 0.0 && a < 2; a++) {
      pw_real factor = a == c->normal ? p->normal_factor : p->shear_factor * p->shear_ratio;
      pw_real rate = factor * b->impedance * b->area + sim->dt * b->stiffness[a];
      pw_real m = r[PW_NODE_ACTIVE] > 0.0 ? r[PW_NODE_MASS] : 1.0;
      pw_real change = settle(r[PW_NODE_FORCE + a], r[PW_NODE_VEL + a], sim->dt * rate / m);
      r[PW_NODE_VEL + a] += change;
      b->force[a] = m * change / sim->dt - b->stiffness[a] * b->moved[a];
      sum[a] += b->held[a] + b->force[a];
    }
  }
  for (int a = 0; a < 2; a++) {
    c->reaction[a] = sim->measure * sum[a];
  }
  return PW_OK;
}

static pw_status hold_remapped(pw_sim *sim, void *ctx)
{
  const absorbing *c = ctx;
  for (pw_idx q = 0; !c->active && q < c->nq; q++) {
    pw_real *r = record(sim, c, q), *v = r + sim->node_slot;
    for (int a = 0; r[PW_NODE_MASS] > 0.0 && a < 2; a++) {
      v[a] = holds(c, a) ? 0.0 : v[a];
    }
  }
  return PW_OK;
}

/* Books of the step: the constant reaction is a load; what dashpot and spring take is absorbed but
 * for what the springs hold. */
static pw_status close_step(pw_sim *sim, void *ctx)
{
  absorbing *c = ctx;
  pw_real load = 0.0, taken = 0.0, stored = 0.0;
  for (pw_idx q = 0; c->active && q < c->nq; q++) {
    absorber *b = &c->q[q];
    const pw_real *r = record(sim, c, q);
    for (int a = 0; a < 2; a++) {
      pw_real du = r[PW_NODE_MASS] > 0.0 ? sim->dt * pw_node_mean_velocity(sim, r, a) : 0.0;
      load += b->held[a] * du;
      taken -= b->force[a] * du;
      b->moved[a] += r[PW_NODE_MASS] > 0.0 ? sim->dt * r[sim->node_slot + a] : 0.0;
      stored += 0.5 * b->stiffness[a] * b->moved[a] * b->moved[a];
    }
  }
  stored *= sim->measure;
  pw_real absorbed = sim->measure * taken - (stored - c->stored);
  c->absorbed += absorbed;
  c->stored = stored;
  sim->energy.external += sim->measure * load;
  sim->energy.absorbed += absorbed;
  sim->energy.spring += stored;
  return PW_OK;
}

static void history(const pw_sim *sim, void *ctx, pw_record *row)
{
  const absorbing *c = ctx;
  char name[64];
  (void)sim;
  for (int a = 0; a < 2; a++) {
    snprintf(name, sizeof name, "absorbing_%d_force_%c_n", c->instance, a == 0 ? 'x' : 'y');
    pw_record_put(row, name, c->reaction[a]);
  }
  snprintf(name, sizeof name, "absorbing_%d_absorbed_j", c->instance);
  pw_record_put(row, name, c->absorbed);
}

static void results(const pw_sim *sim, void *ctx, pw_record *out)
{
  const absorbing *c = ctx;
  pw_real moved = 0.0, area = 0.0, impedance = 0.0;
  for (pw_idx q = 0; q < c->nq; q++) {
    const absorber *b = &c->q[q];
    moved = pw_max(moved, sqrt(b->moved[0] * b->moved[0] + b->moved[1] * b->moved[1]));
    area += b->area;
    impedance += b->area * b->impedance;
  }
  const struct {
    const char *name;
    pw_real value;
  } item[] = {{"absorbed_j", c->absorbed},
              {"spring_j", c->stored},
              {"moved_max_m", moved},
              {"area_m2", sim->measure * area},
              {"mean_impedance_pa_s_m", area > 0.0 ? impedance / area : 0.0}};
  for (size_t k = 0; k < sizeof item / sizeof item[0]; k++) {
    char name[64];
    snprintf(name, sizeof name, "absorbing_%d_%s", c->instance, item[k].name);
    pw_record_put(out, name, item[k].value);
  }
}

static pw_status archive(pw_sim *sim, void *ctx, pw_archive *ar)
{
  absorbing *c = ctx;
  char name[64];
  pw_real number[6] = {c->active, c->held_time,   c->absorbed,
                       c->stored, c->reaction[0], c->reaction[1]};
  (void)sim;
  snprintf(name, sizeof name, "absorbing_%d/numbers", c->instance);
  PW_TRY(ar->real(ar, name, number, 6));
  c->active = number[0] != 0.0;
  c->held_time = number[1];
  c->absorbed = number[2];
  c->stored = number[3];
  c->reaction[0] = number[4];
  c->reaction[1] = number[5];
  snprintf(name, sizeof name, "absorbing_%d/nodes", c->instance);
  return ar->real(ar, name, &c->q[0].area, (pw_off)c->nq * ABSORBER);
}

static void destroy(void **ctx)
{
  absorbing *c = *ctx;
  if (c) {
    pw_mem_free(&c->node);
    pw_mem_free(&c->q);
    pw_mem_free(&c->mass);
    pw_mem_free(&c->cover);
  }
  pw_mem_free(ctx);
}

/* First node of the side, and the way along it and inwards. */
static pw_idx first_node(const pw_mesh *m, int side, pw_idx *along, pw_idx *inward)
{
  const pw_idx row = m->nodes[0];
  const bool upright = side == PW_SIDE_LEFT || side == PW_SIDE_RIGHT;
  const bool far = side == PW_SIDE_RIGHT || side == PW_SIDE_TOP;
  *along = upright ? row : 1;
  *inward = (upright ? 1 : row) * (far ? -1 : 1);
  return side == PW_SIDE_RIGHT ? row - 1 : side == PW_SIDE_TOP ? m->nnode - row : 0;
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  absorbing *c;
  PW_TRY(pw_mem_alloc("absorbing side", 1, sizeof *c, &c));
  *ctx = c;
  c->param = param;
  c->instance = pw_effect_instance(sim, param);
  c->normal = c->param->side == PW_SIDE_BOTTOM || c->param->side == PW_SIDE_TOP;
  c->n = sim->mesh.nodes[1 - c->normal];
  c->nq = c->n * sim->nodes.nfield;
  PW_TRY(pw_mem_alloc("absorbing nodes", c->n, sizeof *c->node, &c->node));
  PW_TRY(pw_mem_alloc("absorbing dashpots", c->nq, sizeof *c->q, &c->q));
  PW_TRY(pw_mem_alloc("absorbing masses", c->nq, sizeof *c->mass, &c->mass));
  PW_TRY(pw_mem_alloc("absorbing volumes", c->nq, sizeof *c->cover, &c->cover));
  pw_idx along, node = first_node(&sim->mesh, c->param->side, &along, &c->inward);
  for (pw_idx k = 0; k < c->n; k++) {
    c->node[k] = node + k * along;
  }
  return PW_OK;
}

static const pw_hook hooks[] = {
    {PW_STAGE_NODE_TOTAL, add_held},
    {PW_STAGE_CONSTRAINT, absorb},
    {PW_STAGE_REMAP, hold_remapped},
    {PW_STAGE_END, close_step},
    {0, NULL},
};

const pw_effect pw_effect_absorbing = {
    .name = "absorbing",
    .brief = "sides of the grid that let waves out: dashpots and springs against creep",
    .many = true,
    .lumped_only = true,
    .point_fields = PW_FIELD_BIT(PW_FIELD_WAVE_SPEED),
    .keys = keys,
    .hooks = hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
    .history = history,
    .results = results,
    .archive = archive,
};
