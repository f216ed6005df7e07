/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/sim_report.h"

#include <stdio.h>
#include <string.h>

#include "engine/bodies.h"
#include "engine/effects/contact_corner.h"
#include "engine/interface.h"
#include "engine/ranges.h"
#include "engine/rates.h"
#include "engine/scene_hash.h"
#include "engine/step_implicit.h"
#include "engine/structure_sim.h"
#include "engine/update.h"
#include "partition/share.h"

void pw_body_centre(const pw_sim *sim, int body, pw_real *out)
{
  const pw_points *p = &sim->points;
  if (sim->structure_of[body]) {
    pw_structure_centre(sim->structure_of[body], out);
    return;
  }
  pw_real m = 0.0, s[6] = {0.0};
  for (pw_idx i = 0; i < p->n; i++) {
    if (p->body[i] == body) {
      m += p->mass[i];
      for (int a = 0; a < 2; a++) {
        s[a] += p->mass[i] * p->x[a * p->ld + i];
        s[2 + a] += p->mass[i] * p->v[a * p->ld + i];
      }
    }
  }
  for (int k = 0; k < 4; k++) {
    out[k] = s[k] / m;
  }
  pw_real spin = 0.0, inertia = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    if (p->body[i] == body) {
      pw_real x = p->x[i] - out[0], y = p->x[p->ld + i] - out[1];
      spin += p->mass[i] * (x * (p->v[p->ld + i] - out[3]) - y * (p->v[i] - out[2]));
      inertia += p->mass[i] * (x * x + y * y);
    }
  }
  out[4] = inertia > 0.0 ? spin / inertia : 0.0;
  out[5] = m;
}

pw_real pw_kinetic_energy(const pw_sim *sim)
{
  const pw_points *p = &sim->points;
  pw_real sum = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    sum += p->mass[i] * (p->v[i] * p->v[i] + p->v[p->ld + i] * p->v[p->ld + i]);
  }
  return 0.5 * sim->measure * sum + pw_structures_kinetic(sim);
}

void pw_sim_report(const pw_sim *sim, pw_report *out)
{
  *out = (pw_report){.threads = sim->threads,
                     .points = sim->points.n,
                     .nodes = sim->mesh.nnode,
                     .elements = sim->mesh.nelem,
                     .blocks = sim->blocks.nblock,
                     .colours = sim->blocks.ncolour,
                     .steps = sim->step,
                     .time_s = sim->time,
                     .dt_s = sim->dt_next,
                     .dt_min_s = sim->dt_min,
                     .dt_max_s = sim->dt_max,
                     .wall_s = sim->wall,
                     .bytes_per_point = pw_points_bytes_per_point(&sim->points),
                     .energy = sim->energy,
                     .point_updates = sim->updates,
                     .sorts = sim->sorts,
                     .domains_limited = sim->limited,
                     .domains_rebuilt = sim->rebuilt,
                     .domains_reshaped = sim->reshaped,
                     .vertices_clamped = sim->clamped,
                     .material = sim->material};
  memcpy(out->stage_wall_s, sim->stage_wall, sizeof out->stage_wall_s);
  pw_share_bound(&sim->blocks, sim->threads, &out->bound_scatter, &out->bound_gather);
}

static void put_body(const pw_sim *sim, int b, pw_record *row)
{
  static const char *const what[5] = {"x_m", "y_m", "velocity_x_m_s", "velocity_y_m_s",
                                      "spin_rad_s"};
  pw_real centre[6];
  pw_body_centre(sim, b, centre);
  for (int k = 0; k < 5; k++) {
    char name[64];
    snprintf(name, sizeof name, "%.32s_%s", sim->body[b].name, what[k]);
    pw_record_put(row, name, centre[k]);
  }
}

void pw_sim_history(const pw_sim *sim, pw_record *row)
{
  const pw_energy *e = &sim->energy;
  row->n = 0;
  pw_record_put(row, "time_s", sim->time);
  pw_record_put(row, "step", (pw_real)sim->step);
  pw_record_put(row, "dt_s", sim->dt);
  pw_record_put(row, "kinetic_j", e->kinetic);
  pw_record_put(row, "strain_work_j", e->strain_work);
  pw_record_put(row, "external_work_j", e->external);
  pw_record_put(row, "contact_dissipated_j", e->contact);
  pw_record_put(row, "contact_spring_j", e->spring);
  pw_record_put(row, "damping_dissipated_j", e->damping);
  pw_quad_steps_history(sim, row);
  for (int b = 0; b < sim->nbody; b++) {
    put_body(sim, b, row);
  }
  for (int k = 0; k < sim->scene.neffect; k++) {
    if (sim->scene.effect[k].type->history) {
      sim->scene.effect[k].type->history(sim, sim->ctx[k], row);
    }
  }
}

void pw_sim_results(const pw_sim *sim, pw_record *out)
{
  out->n = 0;
  pw_quad_steps_results(sim, out);
  for (int b = 0; b < sim->nbody; b++) {
    put_body(sim, b, out);
  }
  for (int k = 0; k < sim->scene.neffect; k++) {
    if (sim->scene.effect[k].type->results) {
      sim->scene.effect[k].type->results(sim, sim->ctx[k], out);
    }
  }
}

/* What tells one scene's checkpoint from another's: sizes, and a hash of the parameters. */
static pw_status archive_identity(pw_sim *sim, pw_archive *ar)
{
  enum { SIZES = 8 };
  static const char *const name[SIZES] = {"points", "nodes",           "elements", "bodies",
                                          "blocks", "state variables", "as basis", "effects"};
  const uint64_t hash = pw_scene_hash(&sim->scene);
  const pw_idx want[SIZES + 2] = {sim->points.n,
                                  sim->mesh.nnode,
                                  sim->mesh.nelem,
                                  sim->nbody,
                                  sim->blocks.nblock,
                                  sim->points.nstate,
                                  sim->scene.method.basis,
                                  sim->scene.neffect,
                                  (pw_idx)(hash & INT32_MAX),
                                  (pw_idx)(hash >> 33)};
  pw_idx have[SIZES + 2];
  memcpy(have, want, sizeof have);
  PW_TRY(ar->index(ar, "sim/identity", have, SIZES + 2));
  for (int k = 0; k < SIZES; k++) {
    PW_REQUIRE(have[k] == want[k], PW_ERR_FILE,
               "the checkpoint belongs to another scene, or to another version of the program: it "
               "has %d %s, the scene %d",
               have[k], name[k], want[k]);
  }
  PW_REQUIRE(memcmp(have, want, sizeof have) == 0, PW_ERR_FILE,
             "the checkpoint belongs to a scene with other parameters; only time.end_s and outputs "
             "may differ");
  return PW_OK;
}

static pw_status archive_numbers(pw_sim *sim, pw_archive *ar)
{
  pw_energy *e = &sim->energy;
  pw_material_counts *m = &sim->material;
  pw_real *const real[] = {
      &sim->time,           &sim->dt,         &sim->dt_next,     &sim->dt_min,
      &sim->dt_max,         &sim->dt_contact, &sim->load_factor, &e->strain_work,
      &e->external,         &e->contact,      &e->spring,        &e->damping,
      &e->absorbed,         &e->initial,      &e->kinetic,       &sim->external_last,
      &sim->external_gross, &sim->released,   &sim->surplus};
  pw_off *const count[] = {&sim->step,     &sim->sorts,   &sim->limited, &sim->rebuilt,
                           &sim->reshaped, &sim->clamped, &m->substeps,  &m->rhs,
                           &m->rejected,   &m->forced,    &m->cut_off,   &sim->updates};
  enum { NREAL = sizeof real / sizeof real[0], NCOUNT = sizeof count / sizeof count[0] };
  pw_real r[NREAL];
  pw_off c[NCOUNT];
  for (int k = 0; k < NREAL; k++) {
    r[k] = *real[k];
  }
  for (int k = 0; k < NCOUNT; k++) {
    c[k] = *count[k];
  }
  PW_TRY(ar->real(ar, "sim/numbers", r, NREAL));
  PW_TRY(ar->offset(ar, "sim/counts", c, NCOUNT));
  for (int k = 0; k < NREAL; k++) {
    *real[k] = r[k];
  }
  for (int k = 0; k < NCOUNT; k++) {
    *count[k] = c[k];
  }
  return PW_OK;
}

/* Ranges and elements read from a file must fit the arrays they index. */
static pw_status check_ranges(const pw_sim *sim)
{
  const pw_points *p = &sim->points;
  const pw_off ranges = (pw_off)sim->blocks.nblock * sim->nbody;
  const pw_idx *start = sim->blocks.point_start;
  bool valid = start[0] == 0 && start[ranges] == p->n;
  for (pw_off k = 0; k < ranges; k++) {
    valid = valid && start[k] <= start[k + 1];
  }
  for (pw_idx i = 0; i < p->n; i++) {
    valid = valid && p->body[i] >= 0 && p->body[i] < sim->nbody && p->home[i] >= 0 &&
            p->home[i] < sim->mesh.nelem;
  }
  PW_REQUIRE(valid, PW_ERR_FILE, "the checkpoint's blocks of points are damaged");
  for (pw_off k = 0; k < ranges; k++) {
    for (pw_idx i = start[k]; i < start[k + 1]; i++) {
      valid = valid && p->body[i] == k % sim->nbody &&
              sim->blocks.elem_block[p->home[i]] == k / sim->nbody;
    }
  }
  PW_REQUIRE(valid, PW_ERR_FILE,
             "the checkpoint's points do not lie in the blocks of this program: it was written "
             "with another METIS, or is damaged");
  return PW_OK;
}

pw_status pw_sim_archive(pw_sim *sim, pw_archive *ar)
{
  PW_TRY(archive_identity(sim, ar));
  PW_TRY(archive_numbers(sim, ar));
  pw_idx sort_needed = sim->sort_needed;
  PW_TRY(ar->index(ar, "sim/sort_needed", &sort_needed, 1));
  sim->sort_needed = sort_needed != 0;
  PW_TRY(ar->index(ar, "sim/point_start", sim->blocks.point_start,
                   (pw_off)sim->blocks.nblock * sim->nbody + 1));
  PW_TRY(pw_points_archive(&sim->points, ar));
  PW_TRY(ar->loading ? check_ranges(sim) : PW_OK);
  PW_TRY(pw_structures_archive(sim, ar));
  PW_TRY(pw_rates_archive(sim, ar));
  PW_TRY(pw_quad_steps_archive(sim, ar));
  for (int k = 0; k < sim->scene.neffect; k++) {
    if (sim->scene.effect[k].type->archive) {
      PW_TRY(sim->scene.effect[k].type->archive(sim, sim->ctx[k], ar));
    }
  }
  if (ar->loading) {
    pw_ranges_renew(sim);
  }
  for (pw_idx k = 0; ar->loading && k < sim->blocks.nblock; k++) {
    pw_block_weights(sim, k); /* corners and local coordinates are not stored */
  }
  return PW_OK;
}

int pw_sim_structure_outline(const pw_sim *sim, int b, pw_real *xy, int max)
{
  return sim->structure_of[b] ? pw_structure_outline(sim->structure_of[b], xy, max) : 0;
}

int pw_sim_outline(const pw_sim *sim, int i, pw_real *xy, int max)
{
  if (pw_sim_effect_ctx(sim, "contact_penalty")) {
    return i < 2 ? pw_contact_outline(sim, i, xy, max) : 0;
  }
  if (pw_sim_effect_ctx(sim, "contact_corner")) {
    return pw_corner_outline(sim, i, xy, max);
  }
  for (int b = 0; b < sim->nbody; b++) {
    const pw_structure *structure = sim->structure_of[b];
    if ((sim->scene.body[b].shape == PW_SHAPE_RECTANGLE && !structure) || i-- > 0) {
      continue;
    }
    if (structure) {
      return pw_structure_outline(structure, xy, max);
    }
    pw_real centre[6];
    pw_body_centre(sim, b, centre);
    int n = pw_body_outline(&sim->scene, b, sim->mesh.cell, xy, NULL, max);
    for (int k = 0; k < n; k++) {
      xy[2 * k] += sim->scene.geometry == PW_AXI ? 0.0 : centre[0] - sim->body[b].start[0];
      xy[2 * k + 1] += centre[1] - sim->body[b].start[1];
    }
    return n > 0 ? n : 0;
  }
  return 0;
}
