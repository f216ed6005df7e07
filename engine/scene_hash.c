/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/scene_hash.h"

#include <string.h>

#include "engine/effect.h"

void pw_hash_bytes(uint64_t *hash, const void *data, size_t size)
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
  pw_hash_bytes(hash, size, sizeof size);
  pw_hash_bytes(hash, choice, sizeof choice);
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
  pw_hash_bytes(hash, m->model->name, strlen(m->model->name));
  pw_hash_bytes(hash, param, count * sizeof *param);
}

static void hash_grid(uint64_t *hash, const pw_scene *s)
{
  const pw_real time[3] = {s->time.cfl, s->time.dt_max_s, s->time.dt_s};
  pw_hash_bytes(hash, &s->grid, offsetof(pw_grid, paired_rows_x_m));
  if (s->grid.paired_rows_x_m > 0.0) {
    pw_hash_bytes(hash, &s->grid.paired_rows_x_m, sizeof(pw_real));
  }
  pw_hash_bytes(hash, time, sizeof time);
  pw_hash_bytes(hash, &s->method.basis, sizeof s->method.basis);
  pw_hash_bytes(hash, &s->method.update, sizeof s->method.update);
  pw_hash_bytes(hash, &s->method.domain_limit_cells, sizeof(pw_real));
  pw_hash_bytes(hash, &s->method.domain_aspect_max, sizeof(pw_real));
  pw_hash_bytes(hash, &s->method.mass_cut_off, sizeof(pw_real));
  pw_hash_bytes(hash, &s->method.noise_damping_per_s, sizeof(pw_real));
  if (s->method.mass_terms > 1) {
    const int terms[2] = {'m', s->method.mass_terms}; /* not to be taken for the next key */
    pw_hash_bytes(hash, terms, sizeof terms);
  }
  if (s->method.step_ratio_max > 1) { /* only scenes that use it have to agree on it */
    pw_hash_bytes(hash, &s->method.step_ratio_max, sizeof s->method.step_ratio_max);
  }
}

/* Steps too: loads may grow to the end of the run. */
static void hash_implicit(uint64_t *hash, const pw_scene_implicit *p)
{
  const int choice[] = {
      p->steps,          p->fbar,     p->point_rule,    p->points_per,      p->negative_volumes,
      p->max_iterations, p->max_cuts, p->from_previous, p->approach,        p->line_search,
      p->mechanisms,     p->solver,   p->adaptive,      p->easy_iterations, p->hard_iterations,
      p->cut_driven};
  const pw_real number[] = {p->step_s, p->tolerance, p->step_least, p->step_most};
  pw_hash_bytes(hash, choice, sizeof choice);
  pw_hash_bytes(hash, number, sizeof number);
}

static void hash_sections(uint64_t *hash, const pw_scene *s)
{
  if (s->geometry != PW_SOLID) {
    hash_grid(hash, s);
  }
  if (s->geometry == PW_SOLID || s->method.update == PW_IMPLICIT) {
    hash_implicit(hash, &s->solid.implicit);
  }
}

static void hash_solid_body(uint64_t *hash, const pw_scene_body *b)
{
  pw_hash_bytes(hash, &b->material, sizeof b->material);
  pw_hash_bytes(hash, b->volume, strlen(b->volume));
  pw_hash_bytes(hash, b->low_m, sizeof b->low_m);
  pw_hash_bytes(hash, b->high_m, sizeof b->high_m);
}

uint64_t pw_scene_hash(const pw_scene *s)
{
  uint64_t hash = UINT64_C(0xcbf29ce484222325);
  pw_hash_bytes(&hash, &s->geometry, sizeof s->geometry);
  hash_sections(&hash, s);
  for (int m = 0; m < s->nmaterial; m++) {
    hash_material(&hash, &s->material[m]);
  }
  for (int b = 0; b < s->nbody; b++) {
    if (s->geometry == PW_SOLID) {
      hash_solid_body(&hash, &s->body[b]);
    } else {
      hash_body(&hash, &s->body[b]);
    }
  }
  for (int e = 0; e < s->neffect; e++) {
    pw_hash_bytes(&hash, s->effect[e].type->name, strlen(s->effect[e].type->name));
    pw_hash_bytes(&hash, s->effect[e].param, sizeof s->effect[e].param);
  }
  return hash;
}
