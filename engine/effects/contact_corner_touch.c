/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Corner contact: how stiff sites are held, and how soon those that touch nothing may come to. */
#include "engine/effects/contact_corner.h"

#include <math.h>

#include "engine/sim_state.h"

/* Soil softer than this part of the stiffest in contact is held as if it were that stiff. Soil that
 * has lost its stress for a moment, under a tip say, would let the master in as far as it is soft,
 * and come back stiff: overlap that no force explains. The step resolves the stiffest anyway. */
static const pw_real SOFTEST = 0.02;

pw_real pw_corner_stiffness(const pw_corner *c, const pw_domain_now *d)
{
  const pw_points *p = &c->sim->points;
  const pw_idx i = d->point;
  if (c->param->normal_stiffness_pa_m > 0.0) {
    return c->param->normal_stiffness_pa_m;
  }
  pw_real modulus = pw_max(pw_corner_modulus(p, i), SOFTEST * c->slave_modulus);
  if (c->master_modulus > 0.0) { /* two springs in series */
    modulus *= c->master_modulus / (modulus + c->master_modulus);
  }
  return c->param->stiffness_factor * modulus / pw_domain_half_size(p, d);
}

/* Square of the frequency that sites of a point would have, as far as two of them touch. */
static pw_real touching_rate(const pw_corner *c, const pw_domain_now *d, const pw_real *n)
{
  const pw_real mass = c->sim->points.mass[d->point];
  pw_real most = 0.0;
  for (int k = 0; k < 4; k++) {
    most = pw_max(most, pw_site_area(d, k, n) * pw_site_inverse_mass(d, k, mass));
  }
  return 2.0 * pw_corner_stiffness(c, d) * most;
}

void pw_corner_bound_touch(const pw_corner *c, const pw_domain_now *d, const pw_round_place *q,
                           pw_real way, pw_corner_sums *sums)
{
  const pw_points *p = &c->sim->points;
  const pw_interface *line = c->surface.line;
  const pw_interface_node *a = &line->node[q->segment];
  const pw_interface_node *b = &line->node[pw_interface_next(line, q->segment)];
  pw_real speed = 0.0;
  if (!c->sim->rates || sums->count > 0) {
    return;
  }
  for (int k = 0; k < 2; k++) {
    const pw_real master = (1.0 - q->xi) * a->v[k] + q->xi * b->v[k];
    speed += q->n[k] * (master - p->v[k * p->ld + d->point]);
  }
  speed = pw_max(fabs(speed), PW_TINY);
  if (0.5 * way < sums->touch * speed) {
    const pw_real resolved = pw_corner_resolved(c, touching_rate(c, d, q->n));
    const pw_real seen = PW_CORNER_UNSEEN * pw_domain_half_size(p, d) / speed;
    sums->touch = pw_min(sums->touch, pw_max(0.5 * way / speed, pw_min(resolved, seen)));
  }
}
