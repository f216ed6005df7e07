/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the passes over points report: failures, sums, the next step, the order of points. */
#include "engine/update.h"

#include <math.h>
#include <stdio.h>

#include "engine/assemble.h"
#include "engine/ranges.h"
#include "engine/rates.h"
#include "engine/sim_report.h"
#include "engine/structure_sim.h"

static pw_status fail_at(const pw_sim *sim, pw_idx i, pw_status status, const char *what)
{
  const pw_points *p = &sim->points;
  const pw_scene_body *body = &sim->scene.body[p->body[i]];
  return pw_error_set(status, __FILE__, __LINE__, __func__,
                      "%s: point %d at (%.6g, %.6g) m, velocity (%.4g, %.4g) m/s, body %s, "
                      "material %s, step %lld, time %.9g s",
                      what, p->id[i], p->x[i], p->x[p->ld + i], p->v[i], p->v[p->ld + i],
                      body->name, sim->scene.material[body->material].name, (long long)sim->step,
                      sim->time);
}

static void add_counts(pw_material_counts *sum, const pw_material_counts *c)
{
  sum->substeps += c->substeps;
  sum->rhs += c->rhs;
  sum->rejected += c->rejected;
  sum->forced += c->forced;
  sum->cut_off += c->cut_off;
}

pw_status pw_update_check(pw_sim *sim)
{
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
    const pw_block_sums *s = &sim->sums[k];
    if (s->bad >= 0) {
      return fail_at(sim, s->bad, s->bad_status, s->why ? s->why : pw_status_text(s->bad_status));
    }
    if (s->weights.lost >= 0) {
      return fail_at(sim, s->weights.lost, PW_ERR_POINT_LOST, "a point left the grid");
    }
    if (s->weights.inverted >= 0) {
      return fail_at(sim, s->weights.inverted, PW_RETRY_DOMAIN_INVERTED, "a domain is inverted");
    }
    sim->sort_needed = sim->sort_needed || s->weights.overrun >= 0;
  }
  return PW_OK;
}

pw_status pw_update_collect(pw_sim *sim)
{
  pw_real speed = 0.0, rate = 0.0;
  sim->energy.kinetic = 0.0;
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
    const pw_block_sums *s = &sim->sums[k];
    sim->energy.kinetic += sim->measure * s->kinetic;
    speed = pw_max(speed, s->speed_max);
    rate = pw_max(rate, s->rate_max);
    if (!pw_rates_ends(sim, k)) {
      continue;
    }
    sim->energy.strain_work += sim->measure * s->strain_work;
    sim->updates += sim->blocks.share_size[k];
    sim->limited += s->limited;
    sim->rebuilt += s->rebuilt;
    sim->reshaped += s->reshaped;
    add_counts(&sim->material, &s->material);
  }
  PW_TRY(pw_update_check(sim));
  sim->energy.kinetic += pw_structures_kinetic(sim);
  const pw_real swift = pw_structures_speed(sim);
  speed = swift <= speed ? speed : swift;
  rate = pw_max(rate, swift / sim->mesh.cell);
  const pw_scene *scene = &sim->scene;
  sim->signal_speed = speed;
  const pw_real cfl = scene->time.cfl;
  pw_real stable = sim->mesh.graded ? cfl / rate : cfl * sim->mesh.cell / speed;
  sim->dt_next = pw_min(scene->time.dt_max_s, stable);
  if (scene->time.dt_s > 0.0) {
    sim->dt_next = scene->time.dt_s;
  }
  PW_REQUIRE(sim->dt_next > 0.0 && isfinite(speed), PW_RETRY_NAN,
             "the stable step is not a positive number (signal speed %g m/s) at step %lld, time "
             "%.9g s",
             speed, (long long)sim->step, sim->time);
  return PW_OK;
}

pw_status pw_update_sort(pw_sim *sim)
{
  pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n; i++) {
    pw_real x[2] = {p->x[i], p->x[p->ld + i]};
    p->home[i] = pw_mesh_locate(&sim->mesh, x);
    if (p->home[i] < 0) {
      return fail_at(sim, i, PW_ERR_POINT_LOST, "a point is outside the grid");
    }
  }
  if (pw_blocks_sort(&sim->blocks, p->n, p->home, p->body, sim->from)) {
    pw_points_permute(p, sim->from, sim->scratch);
  }
  pw_ranges_renew(sim);
  pw_for_blocks(&sim->blocks, sim->threads, pw_block_weights, sim);
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
    pw_idx far = sim->sums[k].weights.overrun;
    if (far >= 0) { /* its scatter would touch nodes of other blocks of the colour */
      return fail_at(sim, far, PW_RETRY_DOMAIN_INVERTED,
                     "a domain reaches beyond the halo of its block (method.domain_limit_cells)");
    }
  }
  sim->sort_needed = false;
  sim->sorts++;
  return PW_OK;
}

/* Point of the largest speed, for the message of a run that blows up. */
static pw_idx fastest_point(const pw_sim *sim)
{
  const pw_points *p = &sim->points;
  pw_real most = -1.0;
  pw_idx fastest = 0;
  for (pw_idx i = 0; i < p->n; i++) {
    pw_real v2 = p->v[i] * p->v[i] + p->v[p->ld + i] * p->v[p->ld + i];
    if (v2 > most) {
      most = v2;
      fastest = i;
    }
  }
  return fastest;
}

pw_status pw_update_energy(pw_sim *sim)
{
  pw_energy *e = &sim->energy;
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
    e->damping += pw_rates_ends(sim, k) ? sim->measure * sim->sums[k].settled : 0.0;
    sim->clamped += pw_rates_ends(sim, k) ? sim->sums[k].weights.clamped : 0;
  }
  if (!pw_rates_together(sim)) {
    return PW_OK;
  }
  if (sim->scene.method.update == PW_USF) { /* stress came before the velocities */
    e->kinetic = pw_kinetic_energy(sim);
  }
  pw_real change = e->external - sim->external_last;
  sim->external_last = e->external;
  sim->external_gross += change < 0.0 ? -change : change;
  /* Stresses that were there at the start may give up their energy, too. */
  sim->released = pw_max(sim->released, -e->strain_work);
  pw_real supplied = e->initial + sim->external_gross + sim->released;
  pw_real surplus = e->kinetic + e->strain_work + e->contact + e->spring + e->damping +
                    e->absorbed - e->initial - e->external;
  /* A body at rest is supplied with nothing but round-off: allow it a speed of 1e-4 c. */
  pw_real floor = 0.5e-8 * sim->measure * sim->mass * sim->signal_speed * sim->signal_speed;
  /* Work of given motions is booked with the force at the start of a step, that of stresses with
   * their mean: when a wall begins to move, the first step shows a surplus. */
  const bool over = !(surplus <= supplied + floor), again = over && sim->surplus > 0.0;
  sim->surplus = over ? surplus - supplied : 0.0;
  if (!again && isfinite(surplus)) {
    return PW_OK;
  }
  PW_REQUIRE(sim->points.n > 0, PW_RETRY_DIVERGED,
             "unstable: %.4g J of energy appeared from nothing, %.4g J were supplied", surplus,
             supplied);
  char what[160];
  snprintf(what, sizeof what,
           "unstable, a smaller time.cfl may help: %.4g J of energy appeared from nothing, %.4g J "
           "were supplied; fastest",
           surplus, supplied);
  return fail_at(sim, fastest_point(sim), PW_RETRY_DIVERGED, what);
}
