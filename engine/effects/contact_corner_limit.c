/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Corner contact: the step that resolves its springs, and how stiff they may be in this one. Some
 * hundreds of pairs, so the loops are serial. */
#include "engine/effects/contact_corner.h"

#include <math.h>

#include "engine/rates.h"

/*
 * Steps resolve the highest frequency of the contact, as bounded from above, by step_frequency_max.
 * By 0.8, with the grid's own, resolved by at most 1.5, the step stays stable (limit 2), up to 1.3 if
 * the two are highest at the same place. The bound is exact for a site alone, and about twice the
 * frequency of a face that meets the master at once; the error of such an impact is, by 0.8, 1 % of its
 * energy in the mean over the phase at which it is seen.
 */

/* The most that the step may be times the frequency in a step chosen by others, over what it is in a
 * step that the contact has chosen. */
static const pw_real MARGIN = 1.875;
/* And this at most, below the 2 at which a site alone becomes unstable. */
static const pw_real LIMIT = 1.9;

enum { NODES = 16 /* grid nodes that a site, or two nodes of a line, reach */ };

/* Grid nodes of one side of a pair and the sizes of their shares in its motion. */
typedef struct handle {
  pw_idx node[NODES];
  pw_real share[NODES];
  int n;
} handle;

static void slave_handle(const pw_corner *c, const pw_corner_pair *q, handle *h)
{
  const pw_points *p = &c->sim->points;
  const pw_idx row = c->sim->mesh.nodes[0];
  pw_domain_now d = pw_domain_of(p, q->point, c->surface.line->axi);
  pw_real w[4];
  pw_site_weights(&d, q->site, w);
  h->n = 0;
  for (int k = 0; k < 4; k++) {
    pw_corner_nodes g = pw_corner_grid(p, q->point, k);
    for (int j = 0; j < 4; j++) {
      h->node[h->n] = (pw_idx)(g.record / PW_NODE) + (j & 1) + (j >> 1) * row;
      h->share[h->n++] = fabs(w[k]) * g.n[j];
    }
  }
}

static void master_handle(const pw_corner *c, const pw_corner_pair *q, handle *h)
{
  const pw_interface *line = c->surface.line;
  const pw_idx end[2] = {q->place.segment, pw_interface_next(line, q->place.segment)};
  h->n = 0;
  for (int e = 0; e < 2; e++) {
    const pw_interface_node *a = &line->node[end[e]];
    for (int j = 0; j < 4; j++) {
      h->node[h->n] = a->node + (j & 1) + (j >> 1) * line->row;
      h->share[h->n++] = a->weight[j] * (e == 0 ? 1.0 - q->place.xi : q->place.xi);
    }
  }
}

/* Sum of the pairs' stiffness at the grid nodes of one side, or clear it. */
static void spread(const pw_corner *c, int side, bool clear)
{
  handle h = {.n = 0};
  for (pw_idx k = 0; k < c->npair; k++) {
    (side == 0 ? slave_handle : master_handle)(c, &c->pair[k], &h);
    for (int j = 0; j < h.n; j++) {
      pw_real *at = &c->stiffness[h.node[j]];
      *at = clear ? 0.0 : *at + c->pair[k].stiffness * h.share[j];
    }
  }
}

/* Add to each pair's rate the square of its frequency on the grid of one side, from above: sums of
 * stiffness over masses (Gershgorin). The largest that was added. */
static pw_real rates_on_grid(pw_corner *c, int side, const pw_real *rec)
{
  handle h = {.n = 0};
  pw_real most = 0.0;
  spread(c, side, false);
  for (pw_idx k = 0; k < c->npair; k++) {
    pw_real rate = 0.0;
    (side == 0 ? slave_handle : master_handle)(c, &c->pair[k], &h);
    for (int j = 0; j < h.n; j++) {
      pw_real mass = rec[(pw_off)h.node[j] * PW_NODE + PW_NODE_MASS];
      rate += mass > c->sim->mass_cut_off ? h.share[j] * c->stiffness[h.node[j]] / mass : 0.0;
    }
    c->pair[k].rate += rate;
    most = pw_max(most, rate);
  }
  spread(c, side, true);
  return most;
}

/* Node of a rod below a place of its surface; @p part: of the way to the next. */
static pw_idx rod_node(const pw_structure *s, const pw_round_place *q, pw_real *part)
{
  const pw_rod *rod = &s->rod;
  const pw_real y0 = s->line_x0[2 * q->segment + 1];
  const pw_real y1 = s->line_x0[2 * pw_interface_next(&s->line, q->segment) + 1];
  pw_real at = ((1.0 - q->xi) * y0 + q->xi * y1 - rod->y0) / rod->length;
  at = pw_min(pw_max(at, 0.0), (pw_real)(rod->n - 1));
  const pw_idx j = (pw_idx)at < rod->n - 1 ? (pw_idx)at : rod->n - 2;
  *part = at - (pw_real)j;
  return j;
}

/* Add the same of the nodes of a rod; the largest that was added. */
static pw_real add_rod_rates(pw_corner *c)
{
  const pw_structure *s = c->structure;
  const pw_rod *rod = &s->rod;
  pw_real *sum = rod->scratch, part, most = 0.0;
  for (pw_idx k = 0; k < rod->n; k++) {
    sum[k] = 0.0;
  }
  for (pw_idx k = 0; k < c->npair; k++) {
    const pw_idx j = rod_node(s, &c->pair[k].place, &part);
    sum[j] += c->pair[k].stiffness * (1.0 - part);
    sum[j + 1] += c->pair[k].stiffness * part;
  }
  for (pw_idx k = 0; k < c->npair; k++) {
    const pw_idx j = rod_node(s, &c->pair[k].place, &part);
    const pw_real rate =
        (1.0 - part) * sum[j] / rod->mass[j] + part * sum[j + 1] / rod->mass[j + 1];
    c->pair[k].rate += rate;
    most = pw_max(most, rate);
  }
  return most;
}

/* The same of a rigid body, that shifts and turns under all springs. */
static pw_real add_rigid_rate(pw_corner *c)
{
  const pw_structure *s = c->structure;
  pw_real sum = 0.0, turn = 0.0;
  for (pw_idx k = 0; k < c->npair; k++) {
    const pw_round_place *q = &c->pair[k].place;
    const pw_real *x = s->line.node[q->segment].x;
    pw_real dx = x[0] - s->rigid.x[0], dy = x[1] - s->rigid.x[1];
    sum += c->pair[k].stiffness;
    turn += c->pair[k].stiffness * (dx * dx + dy * dy);
  }
  bool turns = !s->axi && s->rigid.inertia[2] > 0.0;
  const pw_real rate = sum / s->rigid.mass + (turns ? turn / s->rigid.inertia[2] : 0.0);
  for (pw_idx k = 0; k < c->npair; k++) {
    c->pair[k].rate += rate;
  }
  return rate;
}

/* The same of what the master yields; the largest that was added. */
static pw_real add_master_rates(pw_corner *c)
{
  if (c->structure && c->structure->kind == PW_BODY_ROD) { /* yields although it is driven */
    return add_rod_rates(c);
  }
  if (c->given) {
    return 0.0;
  }
  return c->structure ? add_rigid_rate(c) : rates_on_grid(c, 1, c->master_rec);
}

/*
 * Squares of the pairs' frequencies, from above; the largest. With springs k_p between sums a_p of the
 * velocities of nodes with masses m_j, the highest is below the largest row of A M^-1 A^T K: its parts
 * of slave and master add up at each pair. The slave's alone is also below that of its points by
 * themselves.
 */
static pw_real find_rates(pw_corner *c)
{
  pw_real by_points = 0.0, rate = 0.0;
  for (pw_idx k = 0; k < c->sim->blocks.nblock; k++) {
    by_points = pw_max(by_points, c->sums[k].rate);
  }
  rates_on_grid(c, 0, c->slave_rec);
  const pw_real most = by_points + add_master_rates(c);
  for (pw_idx k = 0; k < c->npair; k++) {
    c->pair[k].rate = pw_min(c->pair[k].rate, most);
    rate = pw_max(rate, c->pair[k].rate);
  }
  return rate;
}

/*
 * A pair too stiff for this step. Its overlap, when it is new, was found too late: a spring over it
 * would hold more energy than the motion that made it. It waits for the next step, which resolves
 * it, and counts as new there, so that what this step has overlapped makes no force. When that step
 * is no shorter, being fixed, or the pair lasts, it is held by a part of its stiffness.
 */
static void soften(pw_corner *c, pw_corner_pair *q, pw_real part)
{
  pw_points *p = &c->sim->points;
  const pw_off at = (pw_off)q->site * p->ld + q->point;
  c->reduced++;
  if (q->fresh && p->contact_arc[at] != PW_CORNER_WAITING) {
    q->waits = true;
    p->contact_arc[at] = PW_CORNER_WAITING;
    return;
  }
  q->lost = q->fresh ? 0.0 : (1.0 - part) * pw_spring_energy(q->stiffness, q->overlap);
  q->stiffness *= part;
  q->density *= part;
}

/* Whether points of the master lie in a block. */
static bool holds_master(const pw_corner *c, pw_idx block)
{
  const pw_blocks *b = &c->sim->blocks;
  const pw_idx *start = b->point_start + (pw_off)block * b->nbody + c->param->master;
  return start[1] > start[0];
}

/* Step that a block with pairs may take: one that resolves them and lets sites close by little. */
static pw_real longest_step(const pw_corner *c, const pw_corner_sums *s)
{
  pw_real rate = 0.0;
  for (pw_idx k = s->start; k < s->start + s->count; k++) {
    rate = pw_max(rate, c->pair[k].rate);
  }
  return pw_min(pw_corner_resolved(c, rate), s->soon);
}

/* Whether two blocks share nodes, or domains of the one those of the other's elements. */
static bool beside(const pw_corner *c, pw_idx one, pw_idx other)
{
  const pw_idx *a = c->box + 4 * (pw_off)one, *b = c->box + 4 * (pw_off)other;
  return a[0] <= b[1] + 1 && b[0] <= a[1] + 1 && a[2] <= b[3] + 1 && b[2] <= a[3] + 1;
}

/* Step that a block in reach without pairs may take. Its sites may come to the surface; and what swings
 * at the pairs of a block beside it swings in it, too: with longer steps than those pairs' it would take
 * that energy (measured: 3 to 8 % of an impact's). */
static pw_real longest_beside(const pw_corner *c, pw_idx block)
{
  pw_real longest = c->sums[block].touch;
  for (pw_idx i = 0; i < c->nnear; i++) {
    const pw_corner_sums *s = &c->sums[c->near[i]];
    if (s->count > 0 && beside(c, block, c->near[i])) {
      longest = pw_min(longest, s->longest);
    }
  }
  return longest;
}

/* Blocks in reach; those with points of the master take short steps. */
static void limit_blocks(pw_corner *c)
{
  for (pw_idx i = 0; c->sim->rates && i < c->nnear; i++) {
    pw_corner_sums *s = &c->sums[c->near[i]];
    s->longest = s->count > 0 ? longest_step(c, s) : PW_HUGE;
  }
  for (pw_idx i = 0; c->sim->rates && i < c->nnear; i++) {
    const pw_idx block = c->near[i];
    const pw_corner_sums *s = &c->sums[block];
    pw_rates_limit(c->sim, block, s->count > 0 ? s->longest : longest_beside(c, block));
  }
  for (pw_idx k = 0; c->sim->rates && !c->structure && k < c->sim->blocks.nblock; k++) {
    if (holds_master(c, k)) {
      pw_rates_limit(c->sim, k, 0.0);
    }
  }
}

/* What pairs that begin a step have too much. */
static void soften_pairs(pw_corner *c, pw_real limit2)
{
  for (pw_idx i = 0; i < c->nnear; i++) {
    const pw_corner_sums *s = &c->sums[c->near[i]];
    for (pw_idx k = s->start; k < s->start + s->count; k++) {
      pw_corner_pair *q = &c->pair[k];
      const pw_real step2 = q->rate * q->dt * q->dt;
      if (pw_rates_starts(c->sim, c->near[i]) && step2 > limit2) {
        soften(c, q, limit2 / step2);
      }
    }
  }
}

pw_real pw_corner_limit(pw_corner *c)
{
  const pw_real resolve = c->param->step_frequency_max, limit = pw_min(MARGIN * resolve, LIMIT);
  const pw_real rate = c->npair > 0 ? find_rates(c) : 0.0;
  limit_blocks(c);
  soften_pairs(c, limit * limit);
  return rate > 0.0 ? resolve / sqrt(rate) : 0.0;
}
