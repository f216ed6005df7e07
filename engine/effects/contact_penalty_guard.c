/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points that leak through the interface line of the penalty contact are held by springs of their
 * own. They are few, so they are taken one after the other in the order of the points. */
#include "engine/effects/contact_penalty.h"

#include <math.h>

/* Square of the most that the step times the frequency of a point on its spring may be. */
static const pw_real LIMIT2 = 1.0;

/* Box around a line, in which a point can be inside its body: x from, to, y from, to. */
static void line_box(const pw_interface *line, pw_real *box)
{
  box[0] = box[2] = PW_HUGE;
  box[1] = box[3] = -PW_HUGE;
  for (pw_idx k = 0; k < line->n; k++) {
    const pw_real *x = line->node[k].x;
    box[0] = pw_min(box[0], x[0]);
    box[1] = pw_max(box[1], x[0]);
    box[2] = pw_min(box[2], x[1]);
    box[3] = pw_max(box[3], x[1]);
  }
}

static bool in_box(const pw_sim *sim, const pw_penalty *c, const pw_real *box, pw_idx i)
{
  const pw_points *p = &sim->points;
  const pw_real x = p->x[i], y = p->x[p->ld + i];
  return p->body[i] == c->slave.body && x > box[0] && x < box[1] && y > box[2] && y < box[3];
}

/* The master's segment nearest to a point among all. */
static pw_idx nearest_of_all(const pw_penalty *c, const pw_real *x)
{
  pw_real best = PW_HUGE;
  pw_idx owner = 0;
  for (pw_idx s = 0; s < pw_interface_segments(&c->master); s++) {
    pw_pair place;
    pw_interface_closest(&c->master, s, x, &place);
    if (fabs(place.gap) < best) {
      best = fabs(place.gap);
      owner = s;
    }
  }
  return owner;
}

/* The master's segment nearest to a point, however deep it is. */
static pw_idx nearest(const pw_penalty *c, const pw_mesh *mesh, const pw_real *x)
{
  pw_real shape[4];
  pw_idx node[4];
  pw_mesh_shape(mesh, x, node, shape);
  const pw_idx owner = pw_bins_nearest(&c->bins, &c->master, mesh->cell, node[0], x);
  return owner >= 0 ? owner : nearest_of_all(c, x);
}

/* Whether the ends of a segment of the master can take a force. */
static bool takes_force(const pw_penalty *c, pw_idx segment)
{
  const pw_real *a = c->master.node[segment].weight;
  const pw_real *b = c->master.node[pw_interface_next(&c->master, segment)].weight;
  return c->given[1] || (a[0] + a[1] + a[2] + a[3] > 0.0 && b[0] + b[1] + b[2] + b[3] > 0.0);
}

/* Force on point i over the nodes by which it moves, so that the force's work is the grid's. */
static void force_on_point(const pw_sim *sim, const pw_penalty *c, pw_idx i, const pw_real *f)
{
  pw_support to;
  sim->kernels->support(&sim->transfer, i, &to);
  for (int k = 0; k < to.n; k++) {
    pw_real *r = c->rec[0] + (pw_off)to.node[k] * PW_NODE + PW_NODE_FORCE;
    r[0] += to.move[k] * f[0];
    r[1] += to.move[k] * f[1];
  }
}

/* Push point i back when it is too deep. @return the square of its frequency on the spring; 0 when
 * it has none. */
static pw_real guard(const pw_sim *sim, pw_penalty *c, pw_idx i)
{
  const pw_points *p = &sim->points;
  const pw_real x[2] = {p->x[i], p->x[p->ld + i]};
  const pw_idx owner = nearest(c, &sim->mesh, x);
  pw_pair place;
  pw_interface_closest(&c->master, owner, x, &place);
  const pw_real stretch = -place.gap - c->param->guard_depth_m;
  if (stretch <= 0.0 || !takes_force(c, owner)) {
    return 0.0;
  }
  const pw_real side = sqrt(p->vol[i] * (c->master.axi ? x[0] : 1.0)); /* of the point, times r */
  const pw_real stable = LIMIT2 * p->mass[i] / (c->omega_n * sim->dt * sim->dt);
  const pw_real area = pw_min(side, stable), pressure = pw_normal_pressure(c->omega_n, -stretch);
  pw_real cn[6], ct[6], f[6];
  pw_pair_vectors(&place, cn, ct);
  pw_pair_force(cn, ct, pressure, 0.0, area, f);
  force_on_point(sim, c, i, f);
  pw_penalty_on_master(c, owner, f + 2);
  c->spring += 0.5 * c->omega_n * area * stretch * stretch;
  c->guarded++;
  return c->omega_n * side / p->mass[i];
}

pw_real pw_penalty_guard(pw_sim *sim, pw_penalty *c)
{
  pw_real box[4], rate = 0.0;
  line_box(&c->master, box);
  for (pw_idx i = 0; i < sim->points.n; i++) {
    rate = in_box(sim, c, box, i) ? pw_max(rate, guard(sim, c, i)) : rate;
  }
  return rate > 0.0 ? c->param->step_frequency_max / sqrt(rate) : 0.0;
}

pw_status pw_penalty_guard_check(const pw_sim *sim, const pw_penalty *c)
{
  const pw_points *p = &sim->points;
  pw_real box[4], deepest = 0.0;
  line_box(&c->master, box);
  for (pw_idx i = 0; c->param->guard_depth_m > 0.0 && i < p->n; i++) {
    if (in_box(sim, c, box, i)) {
      const pw_real x[2] = {p->x[i], p->x[p->ld + i]};
      pw_pair place;
      pw_interface_closest(&c->master, nearest_of_all(c, x), x, &place);
      deepest = pw_max(deepest, -place.gap);
    }
  }
  PW_REQUIRE(deepest <= pw_max(c->param->guard_depth_m, 0.0), PW_ERR_SCENE,
             "a point of '%s' is %g m deep in '%s' at the start, more than guard_depth_m = %g",
             sim->scene.body[c->slave.body].name, deepest, sim->scene.body[c->master.body].name,
             c->param->guard_depth_m);
  return PW_OK;
}
