/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/sim_report.h"

#include <stdio.h>
#include <string.h>

#include "engine/bodies.h"
#include "engine/effects/contact_corner.h"
#include "engine/interface.h"
#include "engine/ranges.h"
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
  for (int b = 0; b < sim->nbody; b++) {
    put_body(sim, b, out);
  }
  for (int k = 0; k < sim->scene.neffect; k++) {
    if (sim->scene.effect[k].type->results) {
      sim->scene.effect[k].type->results(sim, sim->ctx[k], out);
    }
  }
}

static void hash_bytes(uint64_t *hash, const void *data, size_t size)
{
  const unsigned char *byte = data;
  for (size_t k = 0; k < size; k++) {
    *hash = (*hash ^ byte[k]) * UINT64_C(0x100000001b3); /* FNV-1a */
  }
}

static void hash_body(uint64_t *hash, const pw_scene_body *b)
{
  const pw_real size[] = {b->x_m[0],   b->x_m[1],  b->y_m[0],       b->y_m[1],
                          b->radius_m, b->tip_y_m, b->centre_m[0],  b->centre_m[1],
                          b->length_m, b->mass_kg, b->tip_length_m, b->surface_segment_m};
  const int choice[] = {b->kind, b->shape, b->tip, b->rod_elements, b->material};
  hash_bytes(hash, size, sizeof size);
  hash_bytes(hash, choice, sizeof choice);
}

/* Parameters as numbers and texts; of a file its name alone, wherever it lies. As many places as
 * checkpoints have always known, and all of them for models with more. */
static void hash_material(uint64_t *hash, const pw_scene_material *m)
{
  enum { PLACES = 32 };
  pw_real param[PW_MAX_PARAMS];
  size_t count = PLACES;
  memcpy(param, m->param, sizeof param);
  for (const pw_key *key = m->model->keys; key->name; key++) {
    count = key->offset >= PLACES * sizeof *param ? PW_MAX_PARAMS : count;
    if (key->type == PW_KEY_FILE) {
      char *path = (char *)param + key->offset, *slash = strrchr(path, '/');
      const size_t length = slash ? strlen(slash + 1) : strlen(path);
      memmove(path, slash ? slash + 1 : path, length);
      memset(path + length, 0, PW_FILE_NAME - length);
    }
  }
  hash_bytes(hash, m->model->name, strlen(m->model->name));
  hash_bytes(hash, param, count * sizeof *param);
}

/* Everything of a scene that results depend on, so not its end, outputs, title and file. */
static uint64_t scene_hash(const pw_scene *s)
{
  uint64_t hash = UINT64_C(0xcbf29ce484222325);
  const pw_real time[3] = {s->time.cfl, s->time.dt_max_s, s->time.dt_s};
  hash_bytes(&hash, &s->geometry, sizeof s->geometry);
  hash_bytes(&hash, &s->grid, sizeof s->grid);
  hash_bytes(&hash, time, sizeof time);
  hash_bytes(&hash, &s->method.basis, sizeof s->method.basis);
  hash_bytes(&hash, &s->method.update, sizeof s->method.update);
  hash_bytes(&hash, &s->method.domain_limit_cells, sizeof(pw_real));
  hash_bytes(&hash, &s->method.domain_aspect_max, sizeof(pw_real));
  hash_bytes(&hash, &s->method.mass_cut_off, sizeof(pw_real));
  hash_bytes(&hash, &s->method.noise_damping_per_s, sizeof(pw_real));
  for (int m = 0; m < s->nmaterial; m++) {
    hash_material(&hash, &s->material[m]);
  }
  for (int b = 0; b < s->nbody; b++) {
    hash_body(&hash, &s->body[b]);
  }
  for (int e = 0; e < s->neffect; e++) {
    hash_bytes(&hash, s->effect[e].type->name, strlen(s->effect[e].type->name));
    hash_bytes(&hash, s->effect[e].param, sizeof s->effect[e].param);
  }
  return hash;
}

/* What tells one scene's checkpoint from another's: sizes, and a hash of the parameters. */
static pw_status archive_identity(pw_sim *sim, pw_archive *ar)
{
  const uint64_t hash = scene_hash(&sim->scene);
  const pw_idx want[10] = {sim->points.n,
                           sim->mesh.nnode,
                           sim->mesh.nelem,
                           sim->nbody,
                           sim->blocks.nblock,
                           sim->points.nstate,
                           sim->scene.method.basis,
                           sim->scene.neffect,
                           (pw_idx)(hash & INT32_MAX),
                           (pw_idx)(hash >> 33)};
  pw_idx have[10];
  memcpy(have, want, sizeof have);
  PW_TRY(ar->index(ar, "sim/identity", have, 10));
  PW_REQUIRE(memcmp(have, want, 8 * sizeof have[0]) == 0, PW_ERR_FILE,
             "the checkpoint belongs to another scene: it has %d points, %d nodes and %d effects, "
             "the scene %d, %d and %d",
             have[0], have[1], have[7], want[0], want[1], want[7]);
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
      &sim->time,          &sim->dt,         &sim->dt_next,     &sim->dt_min,
      &sim->dt_max,        &sim->dt_contact, &sim->load_factor, &e->strain_work,
      &e->external,        &e->contact,      &e->spring,        &e->damping,
      &e->absorbed,        &e->initial,      &e->kinetic,       &sim->external_last,
      &sim->external_gross};
  pw_off *const count[] = {&sim->step,     &sim->sorts,   &sim->limited, &sim->rebuilt,
                           &sim->reshaped, &sim->clamped, &m->substeps,  &m->rhs,
                           &m->rejected,   &m->forced,    &m->cut_off};
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
