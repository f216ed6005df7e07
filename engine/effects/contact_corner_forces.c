/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Corner contact: springs, friction, forces on slave and master, energies. */
#include "engine/effects/contact_corner.h"

#include <math.h>

#include "engine/assemble.h"
#include "engine/rates.h"

/* Most force along the surface. Domains lie against it as unevenly as they are large: a part of the
 * sites carries all of the pressure, the others are off it by a part of a domain. Friction does not
 * mind; adhesion is to act on the whole surface, so sites that far off it can be let have it. */
static pw_real shear_cap(const pw_contact_corner_param *p, const pw_corner_pair *q)
{
  if (!(q->overlap > 0.0) && !(p->adhesion_gap_m > 0.0)) {
    return 0.0;
  }
  pw_real cap = p->friction * q->stiffness * q->overlap + p->adhesion_pa * q->share * q->area;
  return p->shear_limit_pa > 0.0 ? pw_min(cap, p->shear_limit_pa * q->area) : cap;
}

/* Area of segment k of the master's surface; m2 per metre or radian. */
static pw_real segment_area(const pw_interface *line, pw_idx k)
{
  const pw_real *a = line->node[k].x, *b = line->node[pw_interface_next(line, k)].x;
  return hypot(b[0] - a[0], b[1] - a[1]) * (line->axi ? 0.5 * (a[0] + b[0]) : 1.0);
}

/*
 * Sites near the surface may have more area than it has, where domains lie there askew or one behind
 * the other. Together they adhere to what there is of it: over SIDE segments on either side.
 */
static void share_surface(pw_corner *c)
{
  enum { SIDE = 4 };
  const pw_interface *line = c->surface.line;
  const pw_idx n = pw_interface_segments(line);
  for (pw_idx k = 0; k < n; k++) {
    c->covered[k] = 0.0;
  }
  for (pw_idx i = 0; i < c->npair; i++) {
    c->covered[c->pair[i].place.segment] += c->pair[i].area;
  }
  for (pw_idx i = 0; i < c->npair; i++) {
    pw_real sites = 0.0, surface = 0.0;
    for (pw_idx side = -SIDE; side <= SIDE; side++) {
      pw_idx k = c->pair[i].place.segment + side;
      k = line->closed ? (k + n) % n : k;
      if (k >= 0 && k < n) {
        sites += c->covered[k];
        surface += segment_area(line, k);
      }
    }
    c->pair[i].share = sites > surface ? surface / sites : 1.0;
  }
}

/*
 * The tangential spring takes the way since the last step and returns to its cap; like the normal
 * one it keeps its force when the stiffness grows. Dissipated is what the spring of the last step
 * and the work against its force leave over; in a step that only stretches it, nothing but by a
 * change of the stiffness.
 */
static void pull_along(const pw_contact_corner_param *p, const pw_corner_pair *q, pw_real before,
                       pw_real *slip, pw_corner_sums *sums)
{
  const pw_real k = q->stiffness, old = *slip, cap = shear_cap(p, q), trial = old + q->advance;
  if (fabs(q->relax * trial) * k <= cap) {
    *slip = q->relax * trial;
    sums->dissipated += pw_spring_energy(before, trial) - pw_spring_energy(k, *slip);
  } else {
    *slip = k > 0.0 ? copysign(cap / k, trial) : 0.0;
    sums->dissipated +=
        pw_spring_energy(before, old) + before * old * q->advance - pw_spring_energy(k, *slip);
  }
}

static void push(pw_corner *c, pw_corner_pair *q, pw_real *held, pw_corner_sums *sums)
{
  pw_points *p = &c->sim->points;
  const pw_off at = (pw_off)q->site * p->ld + q->point;
  if (q->waits) {
    return;
  }
  const pw_real before = q->fresh ? q->stiffness : p->contact_stiffness[at] * q->area;
  pull_along(c->param, q, before, &p->contact_slip[at], sums);
  p->contact_arc[at] = q->place.arc;
  p->contact_stiffness[at] = q->density;
  const pw_real normal = q->stiffness * q->overlap, shear = -q->stiffness * p->contact_slip[at];
  for (int k = 0; k < 2; k++) {
    q->force[k] = normal * q->place.n[k] + shear * q->place.t[k];
  }
  sums->dissipated += q->lost;
  sums->spring += pw_spring_energy(q->stiffness, q->overlap) +
                  pw_spring_energy(q->stiffness, p->contact_slip[at]);
  pw_domain_now d = pw_domain_of(p, q->point, c->surface.line->axi);
  pw_site_scatter(p, &d, q->site, c->sim->mesh.nodes[0], q->force, c->slave_rec);
  if (held) { /* adds it again in the other short steps of the block's own */
    pw_site_scatter(p, &d, q->site, c->sim->mesh.nodes[0], q->force, held);
  }
}

static void push_block(void *ctx, pw_idx block)
{
  pw_corner *c = ctx;
  pw_corner_sums *sums = &c->sums[block];
  pw_real *own = pw_rates_records(c->sim, block, c->sim->body[c->param->slave].field);
  for (pw_idx k = 0; k < sums->count; k++) {
    push(c, &c->pair[sums->start + k], own == c->slave_rec ? NULL : own, sums);
  }
}

/* Force on the master's own grid field, at the two nodes of a segment of its line. */
static void push_field(pw_corner *c, const pw_round_place *q, const pw_real *f)
{
  const pw_interface *line = c->surface.line;
  const pw_idx node[2] = {q->segment, pw_interface_next(line, q->segment)};
  for (int e = 0; e < 2; e++) {
    const pw_interface_node *a = &line->node[node[e]];
    pw_real share = e == 0 ? 1.0 - q->xi : q->xi;
    for (int j = 0; j < 4; j++) {
      pw_off k = a->node + (j & 1) + (j >> 1) * line->row;
      pw_real *r = c->master_rec + k * PW_NODE + PW_NODE_FORCE, w = share * a->weight[j];
      r[0] += w * f[0];
      r[1] += w * f[1];
    }
  }
}

static void push_master(pw_corner *c)
{
  const pw_interface *line = c->surface.line;
  for (pw_idx k = 0; k < c->npair; k++) {
    const pw_corner_pair *q = &c->pair[k];
    const pw_real f[2] = {-q->force[0], -q->force[1]};
    if (c->structure) {
      pw_structure_add_force(c->structure, q->place.segment, q->place.xi, f);
    } else {
      push_field(c, &q->place, f);
    }
    const pw_interface_node *b = &line->node[pw_interface_next(line, q->place.segment)];
    pw_contact_tally_add(&c->tally, f, line->node[q->place.segment].tip && b->tip);
    c->tally.pairs += q->overlap > 0.0 ? 1 : 0;
  }
}

void pw_corner_forces(pw_corner *c, pw_real *spring, pw_real *dissipated)
{
  if (c->npair > 0) {
    if (c->param->adhesion_gap_m > 0.0) {
      share_surface(c);
    }
    pw_assemble_coloured(pw_rates_starting(c->sim), c->sim->threads, push_block, c);
    push_master(c);
  }
  *spring = *dissipated = 0.0;
  for (pw_idx k = 0; k < c->sim->blocks.nblock; k++) {
    const pw_corner_sums *s = &c->sums[k];
    *spring += s->spring;
    *dissipated += s->dissipated;
    c->tally.overlap = pw_max(c->tally.overlap, s->deepest);
    c->centre_max = pw_max(c->centre_max, s->centre);
    c->softest = s->count > 0 ? pw_min(c->softest, s->softest) : c->softest;
    c->stiffest = pw_max(c->stiffest, s->stiffest);
    c->offset_max = pw_max(c->offset_max, s->offset);
  }
}
