/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/points.h"

#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"

typedef struct {
  const char *name, *type, *unit, *meaning;
  size_t offset;
  int ncomp;
  bool restart, always;
} field_row;

static const field_row rows[PW_FIELD_COUNT] = {
#define PW_FIELD(ID, member, type, ncomp, unit, restart, always, meaning)                          \
  {#member, #type, unit, meaning, offsetof(pw_points, member), ncomp, restart, always},
#include "engine/fields.def"
#undef PW_FIELD
};

static int components(const pw_points *p, pw_field_id id)
{
  switch (id) {
  case PW_FIELD_STATE:
    return p->nstate;
  case PW_FIELD_CORNER:
    return p->vertices;
  case PW_FIELD_LOCAL:
    return 2 * p->vertices;
  default:
    return rows[id].ncomp;
  }
}

static bool row_is_real(pw_field_id id)
{
  return strcmp(rows[id].type, "real") == 0;
}

static void **member_of(pw_points *p, pw_field_id id)
{
  return (void **)((char *)p + rows[id].offset);
}

pw_field_info pw_points_field(const pw_points *p, pw_field_id id)
{
  void *array = NULL;
  memcpy(&array, (const char *)p + rows[id].offset, sizeof array);
  return (pw_field_info){.name = rows[id].name,
                         .unit = rows[id].unit,
                         .meaning = rows[id].meaning,
                         .ncomp = components(p, id),
                         .is_real = row_is_real(id),
                         .restart = rows[id].restart,
                         .array = array};
}

pw_status pw_points_create(pw_idx n, uint64_t fields, int nstate, int vertices, pw_points *out)
{
  PW_REQUIRE(n >= 0 && nstate >= 0 && vertices >= 1, PW_ERR_ARGUMENT,
             "%d points with %d state variables and %d vertices", n, nstate, vertices);
  pw_points p = {.n = n, .ld = pw_pad(n), .nstate = nstate, .vertices = vertices};
  pw_status status = pw_mem_alloc("points.slot", n, sizeof(pw_idx), &p.slot);
  for (int id = 0; id < PW_FIELD_COUNT && status == PW_OK; id++) {
    if (!rows[id].always && !(fields & PW_FIELD_BIT(id))) {
      continue;
    }
    size_t size = row_is_real((pw_field_id)id) ? sizeof(pw_real) : sizeof(pw_idx);
    pw_off count = (pw_off)p.ld * components(&p, (pw_field_id)id);
    p.fields |= PW_FIELD_BIT(id);
    status = pw_mem_alloc(rows[id].name, count, size, member_of(&p, (pw_field_id)id));
  }
  if (status != PW_OK) {
    pw_points_destroy(&p);
    return status;
  }
  for (pw_idx i = 0; i < n; i++) {
    p.id[i] = p.slot[i] = i;
  }
  *out = p;
  return PW_OK;
}

void pw_points_destroy(pw_points *p)
{
  for (int id = 0; id < PW_FIELD_COUNT; id++) {
    pw_mem_free(member_of(p, (pw_field_id)id));
  }
  pw_mem_free(&p->slot);
  *p = (pw_points){0};
}

pw_off pw_points_bytes_per_point(const pw_points *p)
{
  pw_off bytes = (pw_off)sizeof(pw_idx); /* slot */
  for (int id = 0; id < PW_FIELD_COUNT; id++) {
    pw_field_info f = pw_points_field(p, (pw_field_id)id);
    bytes += f.array ? (pw_off)f.ncomp * (f.is_real ? (pw_off)sizeof(pw_real) : 4) : 0;
  }
  return bytes;
}

void pw_points_permute(pw_points *p, const pw_idx *from, pw_real *scratch)
{
  for (int id = 0; id < PW_FIELD_COUNT; id++) {
    pw_field_info f = pw_points_field(p, (pw_field_id)id);
    if (!f.array || !f.restart) { /* the others are rewritten every step */
      continue;
    }
    for (int c = 0; c < f.ncomp; c++) {
      if (f.is_real) {
        pw_real *a = (pw_real *)f.array + (pw_off)c * p->ld;
        memcpy(scratch, a, (size_t)p->n * sizeof *a);
        for (pw_idx i = 0; i < p->n; i++) {
          a[i] = scratch[from[i]];
        }
      } else {
        pw_idx *a = (pw_idx *)f.array + (pw_off)c * p->ld, *old = (pw_idx *)(void *)scratch;
        memcpy(old, a, (size_t)p->n * sizeof *a);
        for (pw_idx i = 0; i < p->n; i++) {
          a[i] = old[from[i]];
        }
      }
    }
  }
  for (pw_idx i = 0; i < p->n; i++) {
    p->slot[p->id[i]] = i;
  }
}

/* Numbers read from a file must be a permutation: slot is its inverse. */
static pw_status check_ids(pw_points *p)
{
  for (pw_idx i = 0; i < p->n; i++) {
    p->slot[i] = -1;
  }
  for (pw_idx i = 0; i < p->n; i++) {
    bool valid = p->id[i] >= 0 && p->id[i] < p->n && p->slot[p->id[i]] < 0;
    PW_REQUIRE(valid, PW_ERR_FILE, "point number %d is not one of %d, or stands twice", p->id[i],
               p->n);
    p->slot[p->id[i]] = i;
  }
  return PW_OK;
}

pw_status pw_points_archive(pw_points *p, pw_archive *ar)
{
  for (int id = 0; id < PW_FIELD_COUNT; id++) {
    pw_field_info f = pw_points_field(p, (pw_field_id)id);
    if (!f.array || !f.restart) {
      continue;
    }
    char name[64];
    snprintf(name, sizeof name, "points/%s", f.name);
    pw_off count = (pw_off)f.ncomp * p->ld;
    PW_TRY(f.is_real ? ar->real(ar, name, f.array, count) : ar->index(ar, name, f.array, count));
  }
  return ar->loading ? check_ids(p) : PW_OK;
}
