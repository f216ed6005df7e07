/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Corner contact: which sites are inside the master, and how stiff each is held. */
#include "engine/effects/contact_corner.h"

#include <math.h>

#include "engine/assemble.h"
#include "engine/rates.h"

/* A new contact may be this many times as deep as its closing motion explains. */
static const pw_real EXPLAINED = 1.1;
/* Overlap without force is worked out by this part of the sliding, as by a wedge. */
static const pw_real WORK_OUT = 0.25;
/* Part of half a domain that may stay overlapped without force. */
static const pw_real LEFT = 0.02;
/* Rounding of a gap, in cells. */
static const pw_real CLEAR = 1e-6;
/* Error of a normal beside a vertex, where the search stays with the segment it came from as long as
 * the other is nearer by 1e-9 of the square only (pw_interface_track). */
static const pw_real ASKEW = 1e-4;
/* Jumps of a site that is held are taken up to this part of half a domain. */
static const pw_real ABSORBED = 0.15;

static void slave_range(const pw_corner *c, pw_idx block, pw_idx *first, pw_idx *last)
{
  const pw_blocks *b = &c->sim->blocks;
  const pw_idx *start = b->point_start + (pw_off)block * c->sim->nbody + c->param->slave;
  *first = start[0];
  *last = start[1];
}

static pw_idx clamp(pw_idx k, pw_idx last)
{
  return k < 0 ? 0 : (k > last ? last : k);
}

/* Whether sites of a block's points, in its elements and the halo, a cell more, can reach the box around
 * the master. */
static bool block_near(const pw_corner *c, pw_idx block)
{
  const pw_mesh *m = &c->sim->mesh;
  const pw_idx *k = c->box + 4 * (pw_off)block, halo = c->sim->blocks.reach + 1;
  const pw_real *box = c->surface.box;
  return pw_mesh_node_x(m, clamp(k[0] - halo, m->cells[0])) <= box[1] &&
         pw_mesh_node_x(m, clamp(k[1] + halo, m->cells[0])) >= box[0] &&
         pw_mesh_node_y(m, clamp(k[2] - halo, m->cells[1]) * m->nodes[0]) <= box[3] &&
         pw_mesh_node_y(m, clamp(k[3] + halo, m->cells[1]) * m->nodes[0]) >= box[2];
}

/* The contact of a site has ended: its tangential spring lets go. */
static void release(pw_corner *c, pw_off at, pw_real area, pw_corner_sums *sums)
{
  pw_points *p = &c->sim->points;
  sums->dissipated += pw_spring_energy(p->contact_stiffness[at] * area, p->contact_slip[at]);
  p->contact_arc[at] = -1.0;
  p->contact_slip[at] = p->contact_offset[at] = p->contact_stiffness[at] = 0.0;
}

/* Lower left node of the cell that holds a site near the surface; -1: it is far from it. */
static pw_idx near_cell(const pw_corner *c, pw_idx i, int site, const pw_real *x)
{
  const pw_points *p = &c->sim->points;
  const pw_segment_bins *bins = &c->surface.bins;
  pw_idx cell = p->corner[(pw_off)(site % 4) * p->ld + i];
  if (site < 4) {
    return pw_bins_near(bins, cell) ? cell : -1;
  }
  pw_idx other = p->corner[(pw_off)((site + 1) % 4) * p->ld + i], node[4];
  pw_real weight[4];
  if (!pw_bins_near(bins, cell) && !pw_bins_near(bins, other)) {
    return -1;
  }
  pw_mesh_shape(&c->sim->mesh, x, node, weight);
  return node[0];
}

/* @param[in] alone nothing was learnt from the point's centre */
static void find_site(pw_corner *c, pw_idx i, const pw_domain_now *d, int site, bool alone,
                      pw_idx from, pw_corner_sums *sums)
{
  const pw_points *p = &c->sim->points;
  const pw_off at = (pw_off)site * p->ld + i;
  pw_real x[2];
  pw_round_place place;
  pw_site_place(d, site, x);
  if (p->contact_arc[at] >= 0.0) {
    pw_round_line_follow(&c->surface, p->contact_arc[at], x, &place);
    if (place.gap >= c->param->adhesion_gap_m) {
      release(c, at, pw_site_area(d, site, place.n), sums);
      return;
    }
  } else {
    pw_idx cell = near_cell(c, i, site, x);
    bool near = cell >= 0 && pw_round_line_near(&c->surface, x, cell, c->sim->mesh.cell, &place);
    if (near && alone) {
      pw_corner_bound_touch(c, d, &place, pw_max(place.gap, 0.0), sums);
    }
    if (!near || place.gap >= c->param->adhesion_gap_m) {
      p->contact_arc[at] = -1.0; /* one that waited has gone */
      return;
    }
  }
  c->found[from + sums->count] = PW_SITES * i + site;
  c->segment[from + sums->count] = place.segment;
  sums->count++;
}

/* Whether any site of a point is held, or waits to be. */
static bool any_held(const pw_points *p, pw_idx i)
{
  bool held = false;
  for (int site = 0; site < PW_SITES; site++) {
    held = held || p->contact_arc[(pw_off)site * p->ld + i] != -1.0;
  }
  return held;
}

/* Where a point's centre is, and how far its sites are from it. */
typedef struct {
  pw_round_place place;
  pw_real radius;
  bool found; /**< its centre is near the surface */
} centre;

/* *last: segment at the point before, or -1; points of a block are neighbours. */
static centre look_from_centre(const pw_corner *c, const pw_domain_now *d, pw_idx *last)
{
  const pw_mesh *mesh = &c->sim->mesh;
  centre at = {.radius = 0.0};
  pw_real radius2 = 0.0, x[2], weight[4];
  pw_idx node[4];
  for (int k = 0; k < 4; k++) { /* the middles of edges are nearer */
    pw_site_place(d, k, x);
    const pw_real dx = x[0] - d->x[0], dy = x[1] - d->x[1];
    radius2 = pw_max(radius2, dx * dx + dy * dy);
  }
  at.found = *last >= 0 && pw_round_line_seek(&c->surface, *last, d->x, &at.place);
  if (!at.found) {
    pw_mesh_shape(mesh, d->x, node, weight);
    at.found = pw_round_line_near(&c->surface, d->x, node[0], mesh->cell, &at.place);
  }
  *last = at.found ? at.place.segment : *last;
  at.radius = sqrt(radius2);
  return at;
}

/* Whether no site of a point that holds none can be inside: the gap changes by no more than the
 * distance. */
static bool all_clear(const pw_corner *c, pw_idx i, const centre *at)
{
  const pw_real margin = c->param->adhesion_gap_m + CLEAR * c->sim->mesh.cell;
  if (!at->found || any_held(&c->sim->points, i)) {
    return false;
  }
  return at->place.gap > at->radius + margin;
}

/* Whether a site is clear of a convex surface, beyond its tangent at the centre. */
static bool site_clear(const pw_corner *c, pw_idx i, const pw_domain_now *d, int site,
                       const centre *at)
{
  const pw_points *p = &c->sim->points;
  const pw_real margin = c->param->adhesion_gap_m + CLEAR * c->sim->mesh.cell + ASKEW * at->radius;
  if (!at->found || p->contact_arc[(pw_off)site * p->ld + i] != -1.0 || !c->surface.convex) {
    return false;
  }
  pw_real x[2];
  pw_site_place(d, site, x);
  const pw_real *n = at->place.n;
  return at->place.gap + n[0] * (x[0] - d->x[0]) + n[1] * (x[1] - d->x[1]) > margin;
}

/* Whether the cell of a corner has a part of the surface beside it. */
static bool point_near(const pw_corner *c, pw_idx i)
{
  const pw_points *p = &c->sim->points;
  bool near = false;
  for (int k = 0; k < 4; k++) {
    near = near || pw_bins_near(&c->surface.bins, p->corner[(pw_off)k * p->ld + i]);
  }
  return near;
}

static void find_at_point(pw_corner *c, pw_idx i, pw_idx from, pw_idx *segment,
                          pw_corner_sums *sums)
{
  if (!point_near(c, i) && !any_held(&c->sim->points, i)) {
    return;
  }
  const pw_domain_now d = pw_domain_of(&c->sim->points, i, c->surface.line->axi);
  const centre at = look_from_centre(c, &d, segment);
  const pw_idx before = sums->count;
  if (at.found) {
    pw_corner_bound_touch(c, &d, &at.place, pw_max(at.place.gap - at.radius, 0.0), sums);
  }
  if (all_clear(c, i, &at)) {
    return;
  }
  for (int site = 0; site < PW_SITES; site++) {
    if (!site_clear(c, i, &d, site, &at)) {
      find_site(c, i, &d, site, !at.found, from, sums);
    }
  }
  if (sums->count > before) {
    sums->modulus = pw_max(sums->modulus, pw_corner_modulus(&c->sim->points, i));
  }
}

static void find_in_block(void *ctx, pw_idx block)
{
  pw_corner *c = ctx;
  pw_corner_sums *sums = &c->sums[block];
  pw_idx first, last, segment = -1;
  if (!pw_rates_starts(c->sim, block)) {
    return;
  }
  slave_range(c, block, &first, &last);
  for (pw_idx i = first; i < last; i++) {
    find_at_point(c, i, PW_SITES * first, &segment, sums);
  }
}

/* Short steps since a block was looked at. */
static pw_real steps_since(const pw_corner *c, pw_idx block)
{
  const pw_sim *sim = c->sim;
  return sim->rates && c->last_dt > 0.0 ? (sim->time - c->begun[block]) / c->last_dt : 1.0;
}

/* How far site and surface have closed in so many short steps, by the velocities at the start of this
 * one. The surface's way is that of the last; a site that waited was found in a longer one, which
 * must not count. */
static pw_real closing(const pw_corner *c, const pw_corner_pair *q, const pw_domain_now *d,
                       pw_real steps)
{
  const pw_sim *sim = c->sim;
  const pw_interface *line = c->surface.line;
  const pw_interface_node *a = &line->node[q->place.segment];
  const pw_interface_node *b = &line->node[pw_interface_next(line, q->place.segment)];
  const pw_off at = (pw_off)q->site * sim->points.ld + q->point;
  const bool waited = sim->points.contact_arc[at] == PW_CORNER_WAITING;
  const pw_real part = waited ? pw_min(sim->dt / c->last_dt, 1.0) : 1.0;
  pw_real v[2], sum = 0.0;
  pw_site_velocity(&sim->points, d, q->site, sim->mesh.nodes[0], sim->mass_cut_off, c->slave_rec,
                   v);
  for (int k = 0; k < 2; k++) {
    pw_real master = (1.0 - q->place.xi) * a->du[k] + q->place.xi * b->du[k];
    sum += q->place.n[k] * steps * (part * master - sim->dt * v[k]);
  }
  return pw_max(sum, 0.0);
}

/* Offset of a new contact: what of its overlap the motion of a step does not explain makes no force
 * until it is worked out by sliding, so that no energy comes from overlap at rest. */
static pw_real first_offset(const pw_corner *c, const pw_corner_pair *q, const pw_domain_now *d,
                            pw_real steps)
{
  return pw_min(q->place.gap + EXPLAINED * closing(c, q, d, steps), 0.0);
}

/* Offset of one that lasts: follows the site on its way out; where it is more than can be left,
 * it is worked out. */
static pw_real next_offset(const pw_corner_pair *q, pw_real old, pw_real slack)
{
  pw_real less = pw_max(pw_min(-old - slack, WORK_OUT * fabs(q->advance)), 0.0);
  return pw_max(old + less, q->place.gap);
}

/* Way along the normal that a site has made without motion of the soil: its domain was limited or
 * reshaped. */
static pw_real jump_of(const pw_points *p, const pw_corner_pair *q)
{
  const pw_idx ld = p->ld, i = q->point;
  const pw_real *j = p->contact_jump + i, s = pw_site_s[q->site], t = pw_site_t[q->site];
  return q->place.n[0] * (j[4 * ld] + s * j[0] + t * j[2 * ld]) +
         q->place.n[1] * (j[5 * ld] + s * j[ld] + t * j[3 * ld]);
}

/*
 * Stiffness and overlap. The soil's modulus changes by an order of magnitude between loading and
 * unloading: a spring that followed it at constant overlap would push the harder the moment the
 * load turns and give more than it took. So while a contact lasts its stiffness only grows, and
 * it grows at constant force: the overlap that is stretched becomes less, the offset more, and the
 * spring's energy falls by what is booked as dissipated. A jump of the site that is no motion of
 * the soil changes the offset, not the force.
 */
static void set_springs(const pw_corner *c, pw_corner_pair *q, const pw_domain_now *d,
                        pw_real modulus, pw_corner_sums *sums)
{
  const pw_points *p = &c->sim->points;
  const pw_off at = (pw_off)q->site * p->ld + q->point;
  const pw_real gap = q->place.gap, old = p->contact_stiffness[at];
  pw_real offset, slack = LEFT * pw_domain_half_size(p, d);
  q->density = q->fresh ? modulus : pw_max(old, modulus);
  q->stiffness = q->density * q->area;
  if (q->fresh) {
    offset = first_offset(c, q, d, steps_since(c, (pw_idx)(sums - c->sums)));
    q->overlap = pw_max(offset - gap, 0.0);
  } else {
    const pw_real held = p->contact_offset[at], jump = jump_of(p, q);
    const pw_real before = pw_max(held - (gap - jump), 0.0);
    q->relax = q->density > 0.0 ? old / q->density : 1.0;
    const pw_real kept = pw_min(pw_max(held + jump, pw_min(held, -ABSORBED * slack / LEFT)), 0.0);
    q->overlap = q->relax * (next_offset(q, kept, slack) - gap);
    offset = pw_min(gap + q->overlap, 0.0); /* positive: not on the surface, adhesion only */
    sums->dissipated +=
        pw_spring_energy(old * q->area, before) - pw_spring_energy(q->stiffness, q->overlap);
  }
  p->contact_offset[at] = offset;
  sums->offset = pw_max(sums->offset, -offset);
}

static pw_corner_pair measure_site(const pw_corner *c, pw_idx at, const pw_domain_now *d,
                                   pw_real modulus, pw_corner_sums *sums)
{
  const pw_points *p = &c->sim->points;
  pw_corner_pair q = {.point = c->found[at] / PW_SITES,
                      .site = c->found[at] % PW_SITES,
                      .share = 1.0,
                      .relax = 1.0,
                      .dt = pw_rates_ahead(c->sim, (pw_idx)(sums - c->sums))};
  pw_real x[2], arc = p->contact_arc[(pw_off)q.site * p->ld + q.point];
  pw_site_place(d, q.site, x);
  pw_round_line_place(&c->surface, c->segment[at], x, &q.place);
  q.fresh = arc < 0.0;
  q.advance = q.fresh ? 0.0 : pw_round_line_way(&c->surface, arc, q.place.arc);
  q.area = pw_site_area(d, q.site, q.place.n);
  set_springs(c, &q, d, modulus, sums);
  sums->softest = pw_min(sums->softest, q.density);
  sums->stiffest = pw_max(sums->stiffest, q.density);
  sums->deepest = pw_max(sums->deepest, -q.place.gap);
  return q;
}

/* Depth of a point's centre below the surface at a site of it. */
static pw_real centre_depth(const pw_corner *c, const pw_corner_pair *q, const pw_domain_now *d)
{
  pw_real x[2];
  pw_site_place(d, q->site, x);
  pw_real gap = q->place.gap + q->place.n[0] * (d->x[0] - x[0]) + q->place.n[1] * (d->x[1] - x[1]);
  if (gap < 0.0) {
    pw_round_place place;
    pw_round_line_follow(&c->surface, q->place.arc, d->x, &place);
    gap = place.gap;
  }
  return pw_max(-gap, 0.0);
}

/* Time in which a pair closes by what a step may leave unseen; s. */
static pw_real time_to_close(const pw_corner *c, const pw_corner_pair *q, const pw_domain_now *d)
{
  const pw_real way = closing(c, q, d, 1.0),
                most = PW_CORNER_UNSEEN * pw_domain_half_size(&c->sim->points, d);
  return way > 0.0 ? c->sim->dt * most / way : PW_HUGE;
}

/* Square of the frequency of pairs [k, next), all of one point, from above. */
static pw_real point_rate(const pw_corner *c, pw_idx k, pw_idx next, const pw_domain_now *d)
{
  pw_real rate = 0.0;
  for (; k < next; k++) {
    const pw_corner_pair *q = &c->pair[k];
    rate += q->stiffness * pw_site_inverse_mass(d, q->site, c->sim->points.mass[q->point]);
  }
  return rate;
}

/* The pairs of a step that goes on. */
static void keep_pairs(pw_corner *c, const pw_corner_sums *sums)
{
  for (pw_idx k = 0; k < sums->count; k++) {
    c->pair[sums->start + k] = c->last[sums->kept + k];
    c->pair[sums->start + k].rate = 0.0;
  }
}

static void measure_block(void *ctx, pw_idx block)
{
  pw_corner *c = ctx;
  pw_corner_sums *sums = &c->sums[block];
  pw_idx first, last;
  slave_range(c, block, &first, &last);
  if (!pw_rates_starts(c->sim, block)) {
    keep_pairs(c, sums);
    return;
  }
  for (pw_idx k = 0; k < sums->count;) {
    const pw_idx i = c->found[PW_SITES * first + k] / PW_SITES, start = sums->start + k;
    pw_domain_now d = pw_domain_of(&c->sim->points, i, c->surface.line->axi);
    pw_real stiffness = pw_corner_stiffness(c, &d);
    for (; k < sums->count && c->found[PW_SITES * first + k] / PW_SITES == i; k++) {
      c->pair[sums->start + k] = measure_site(c, PW_SITES * first + k, &d, stiffness, sums);
      const pw_corner_pair *q = &c->pair[sums->start + k];
      sums->centre = pw_max(sums->centre, centre_depth(c, q, &d));
      sums->soon = c->sim->rates ? pw_min(sums->soon, time_to_close(c, q, &d)) : sums->soon;
    }
    sums->rate = pw_max(sums->rate, point_rate(c, start, sums->start + k, &d));
  }
}

/* Blocks that start a step and can reach the master, and those that hold pairs since theirs began;
 * all others have none. */
static void list_blocks(pw_corner *c)
{
  const pw_sim *sim = c->sim;
  c->nnear = 0;
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
    pw_corner_sums *sums = &c->sums[k];
    if (pw_rates_starts(sim, k)) {
      pw_idx first, last;
      *sums = (pw_corner_sums){.softest = PW_HUGE, .soon = PW_HUGE, .touch = PW_HUGE};
      slave_range(c, k, &first, &last);
      if (first < last && block_near(c, k)) {
        c->near[c->nnear++] = k;
      }
      continue;
    }
    sums->dissipated = 0.0; /* booked when the step began */
    if (sums->count > 0) {
      sums->kept = sums->start;
      c->near[c->nnear++] = k;
    }
  }
  if (sim->rates) {
    pw_corner_pair *swap = c->last;
    c->last = c->pair;
    c->pair = swap;
  }
}

pw_status pw_corner_search(pw_corner *c)
{
  const pw_sim *sim = c->sim;
  list_blocks(c);
  pw_for_listed(c->near, c->nnear, sim->threads, find_in_block, c);
  c->npair = 0;
  c->slave_modulus = 0.0;
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
    c->sums[k].start = c->npair;
    c->npair += c->sums[k].count;
    c->slave_modulus = pw_max(c->slave_modulus, c->sums[k].modulus);
  }
  PW_REQUIRE(c->npair <= c->capacity, PW_ERR_MEMORY,
             "%d corners and edges of the slave's domains are inside the master, at most %d can be",
             c->npair, c->capacity);
  if (c->npair > 0) {
    pw_for_listed(c->near, c->nnear, sim->threads, measure_block, c);
  }
  return PW_OK;
}
