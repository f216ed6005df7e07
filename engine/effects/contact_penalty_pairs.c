/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pairs of the penalty contact, one after the other in the order of the slave's nodes: some
 * hundreds of nodes, so the loops are serial and sums always come in the same order. */
#include "engine/effects/contact_penalty.h"

#include <math.h>

/* Most that dt omega may be in a step chosen by others, and that in the longest of its own. */
static const pw_real LEAST_LIMIT = 0.5, LIMIT_TO_LONGEST = 2.0;
/* Overlap that was not made by motion is worked out by this part of the sliding, as by a wedge. */
static const pw_real WORK_OUT = 0.25;

static pw_real energy(pw_real k, pw_real g)
{
  return 0.5 * k * g * g;
}

/* Displacements of slave, node 1, node 2 in the last step. */
static void pair_motion(const pw_penalty *c, const pw_interface_node *s, pw_idx segment, pw_real *u)
{
  const pw_interface_node *a = &c->master.node[segment];
  const pw_interface_node *b = &c->master.node[pw_interface_next(&c->master, segment)];
  for (int i = 0; i < 2; i++) {
    u[i] = s->du[i];
    u[2 + i] = a->du[i];
    u[4 + i] = b->du[i];
  }
}

/* Contact is lost: the tangential spring lets go. */
static void release(pw_penalty *c, pw_touch *t)
{
  c->dissipated += energy(t->stiff_t, t->slip);
  *t = (pw_touch){.owner = -1};
}

/* Offset of a contact seen for the first time: what of the overlap the motion of the last step
 * (or, after a split, the neighbours' overlap) does not explain makes no force. */
static void begin_touch(pw_touch *t, pw_real gap, pw_real closing)
{
  pw_real known = t->fresh ? t->overlap : pw_max(closing, 0.0);
  known = pw_min(known * (1.0 + 1e-9), -gap);
  t->offset = gap + known;
  t->overlap = known;
  t->fresh = false;
}

/* Overlap of a contact that lasts. The offset follows a slave on its way out and is worked out in
 * proportion to the sliding, so that no energy comes from overlap at rest or from a rebound. */
static void follow_touch(pw_penalty *c, pw_touch *t, pw_real gap, pw_real slide)
{
  if (t->offset < 0.0) {
    pw_real less = pw_min(-t->offset, WORK_OUT * slide);
    t->offset += less;
    c->dissipated += energy(t->stiff_n, t->overlap) - energy(t->stiff_n, t->overlap + less);
    t->offset = pw_max(t->offset, gap);
  }
  t->overlap = pw_max(t->offset - gap, 0.0);
}

static void search_slave(pw_penalty *c, pw_real reach, pw_idx k)
{
  pw_interface_node *s = &c->slave.node[k];
  pw_touch *t = &s->touch;
  pw_pair place;
  bool had = t->owner >= 0;
  pw_idx owner = had ? pw_interface_track(&c->master, t->owner, s->x, &place)
                     : pw_bins_detect(&c->bins, &c->master, reach, s, &place);
  if (owner < 0 || place.gap >= 0.0) {
    if (had || t->fresh) {
      release(c, t);
    }
    return;
  }
  pw_real u[6], cn[6], ct[6];
  pair_motion(c, s, owner, u);
  pw_pair_vectors(&place, cn, ct);
  pw_real normal = pw_pair_dot(cn, u), slip = pw_pair_dot(ct, u), before = t->overlap;
  t->owner = owner;
  if (!had || t->fresh) {
    begin_touch(t, place.gap, -normal);
    slip = had ? slip : 0.0;
  } else {
    follow_touch(c, t, place.gap, fabs(slip));
  }
  c->tally.overlap = pw_max(c->tally.overlap, -place.gap);
  c->pair[c->npair++] = (pw_active_pair){.slave = k,
                                         .segment = owner,
                                         .place = place,
                                         .overlap_before = before,
                                         .slip_step = slip,
                                         .area = s->area};
}

void pw_penalty_search(pw_penalty *c, pw_real reach)
{
  c->npair = 0;
  for (pw_idx k = 0; k < c->slave.n; k++) {
    search_slave(c, reach, k);
  }
}

/* One of the three interface nodes of a pair, with its share of the pair's force. */
typedef struct handle {
  const pw_interface_node *node;
  pw_real share;
  int side; /* 0 slave, 1 master */
} handle;

static void handles(const pw_penalty *c, const pw_active_pair *p, handle *h)
{
  pw_idx next = pw_interface_next(&c->master, p->segment);
  h[0] = (handle){&c->slave.node[p->slave], 1.0, 0};
  h[1] = (handle){&c->master.node[p->segment], 1.0 - p->place.xi, 1};
  h[2] = (handle){&c->master.node[next], p->place.xi, 1};
}

static inline pw_idx grid_node(const pw_penalty *c, const pw_interface_node *a, int j)
{
  return a->node + (j & 1) + (j >> 1) * c->slave.row;
}

/* Add to, or clear, the stiffness at the grid nodes of all pairs. */
static void spread_stiffness(pw_penalty *c, pw_idx nnode, pw_real omega)
{
  for (pw_idx i = 0; i < c->npair; i++) {
    handle h[3];
    handles(c, &c->pair[i], h);
    for (int a = 0; a < 3; a++) {
      pw_real *sum = c->stiffness + (pw_off)h[a].side * nnode;
      for (int j = 0; j < 4; j++) {
        pw_real *at = &sum[grid_node(c, h[a].node, j)];
        *at = omega > 0.0 ? *at + omega * c->pair[i].area * h[a].share * h[a].node->weight[j] : 0.0;
      }
    }
  }
}

/* Square of the frequency of a pair, from above; -1 when one of its sides cannot take a force. */
static pw_real pair_rate(const pw_penalty *c, pw_idx nnode, const pw_active_pair *p)
{
  handle h[3];
  pw_real rate = 0.0;
  handles(c, p, h);
  for (int a = 0; a < 3; a++) {
    const pw_real *sum = c->stiffness + (pw_off)h[a].side * nnode;
    pw_real weight = 0.0;
    for (int j = 0; j < 4 && !c->given[h[a].side]; j++) {
      pw_idx node = grid_node(c, h[a].node, j);
      pw_real w = h[a].node->weight[j];
      weight += w;
      if (w > 0.0) {
        rate += h[a].share * w * sum[node] / c->rec[h[a].side][(pw_off)node * PW_NODE];
      }
    }
    if (weight <= 0.0 && !c->given[h[a].side]) {
      return -1.0;
    }
  }
  return rate;
}

pw_real pw_penalty_limit(pw_penalty *c, pw_idx nnode, pw_real dt)
{
  const pw_real longest = c->param->step_frequency_max;
  const pw_real limit = pw_max(LEAST_LIMIT, LIMIT_TO_LONGEST * longest), limit2 = limit * limit;
  pw_real omega = pw_max(c->omega_n, c->omega_t), largest = 0.0;
  spread_stiffness(c, nnode, omega);
  for (pw_idx i = 0; i < c->npair; i++) {
    pw_real rate = pair_rate(c, nnode, &c->pair[i]);
    largest = pw_max(largest, rate);
    if (rate < 0.0) {
      c->pair[i].area = 0.0;
      c->detached++;
    } else if (rate * dt * dt > limit2) {
      c->pair[i].area *= limit2 / (rate * dt * dt);
      c->reduced++;
    }
  }
  spread_stiffness(c, nnode, 0.0);
  return largest > 0.0 ? longest / sqrt(largest) : 0.0;
}

static void scatter(const pw_penalty *c, const pw_interface_node *a, int side, const pw_real *f)
{
  for (int j = 0; j < 4; j++) {
    pw_real *r = c->rec[side] + (pw_off)grid_node(c, a, j) * PW_NODE + PW_NODE_FORCE;
    r[0] += a->weight[j] * f[0];
    r[1] += a->weight[j] * f[1];
  }
}

/* Spring, friction and energies of a pair; its force on slave, node 1, node 2. */
static void pair_force(pw_penalty *c, const pw_active_pair *p, pw_real *f)
{
  pw_touch *t = &c->slave.node[p->slave].touch;
  pw_real cn[6], ct[6], kn = c->omega_n * p->area, kt = c->omega_t * p->area;
  pw_real pressure = pw_normal_pressure(c->omega_n, -t->overlap);
  /* A spring whose area or stiffness has changed since the last step has another energy without
   * any work. */
  c->dissipated += energy(t->stiff_n - kn, p->overlap_before) + energy(t->stiff_t - kt, t->slip);
  t->slip += p->slip_step;
  c->dissipated += p->area * pw_coulomb_return(c->omega_t, c->param->friction * pressure, &t->slip);
  t->stiff_n = kn;
  t->stiff_t = kt;
  c->spring += energy(kn, t->overlap) + energy(kt, t->slip);
  pw_pair_vectors(&p->place, cn, ct);
  pw_pair_force(cn, ct, pressure, c->omega_t * t->slip, p->area, f);
}

void pw_penalty_on_master(pw_penalty *c, pw_idx segment, const pw_real *f)
{
  const pw_interface_node *a = &c->master.node[segment];
  const pw_interface_node *b = &c->master.node[pw_interface_next(&c->master, segment)];
  scatter(c, a, 1, f);
  scatter(c, b, 1, f + 2);
  pw_real on_master[2] = {f[0] + f[2], f[1] + f[3]};
  pw_contact_tally_add(&c->tally, on_master, a->tip && b->tip);
}

void pw_penalty_forces(pw_penalty *c)
{
  for (pw_idx i = 0; i < c->npair; i++) {
    const pw_active_pair *p = &c->pair[i];
    pw_real f[6];
    pair_force(c, p, f);
    scatter(c, &c->slave.node[p->slave], 0, f);
    pw_penalty_on_master(c, p->segment, f + 2);
    c->tally.pairs += p->area > 0.0 && c->slave.node[p->slave].touch.overlap > 0.0 ? 1 : 0;
  }
}
