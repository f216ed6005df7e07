/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/solid_snapshot.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"
#include "io/atomic_file.h"
#include "io/vtk_files.h"

enum { MAX_COLUMNS = 16 + PW_MAX_STATE };

/* Values of a snapshot on their way: columns one after the other. */
typedef struct table {
  float *value;
  pw_idx *index;
  pw_off used, room;
  int narray;
  pw_vtk_array array[MAX_COLUMNS];
} table;

static float *add_column(table *t, const char *name, int ncomp, pw_idx n)
{
  if (t->narray >= MAX_COLUMNS || t->used + (pw_off)ncomp * n > t->room) {
    return NULL;
  }
  float *values = t->value + t->used;
  pw_vtk_array *array = &t->array[t->narray++];
  *array = (pw_vtk_array){.ncomp = ncomp, .real = values};
  snprintf(array->name, sizeof array->name, "%s", name);
  t->used += (pw_off)ncomp * n;
  return values;
}

/* Components of a field that stand apart in memory, together. */
static void add_field(table *t, const char *name, const pw_real *field, int ncomp, pw_idx ld,
                      pw_idx n)
{
  float *values = field ? add_column(t, name, ncomp, n) : NULL;
  for (pw_off i = 0; values && i < n; i++) {
    for (int c = 0; c < ncomp; c++) {
      values[i * ncomp + c] = (float)field[(pw_off)c * ld + i];
    }
  }
}

static void add_invariants(table *t, const pw_tet_points *p)
{
  float *mean = add_column(t, "mean_stress_pa", 1, p->n);
  float *mises = add_column(t, "von_mises_stress_pa", 1, p->n);
  for (pw_idx i = 0; mean && mises && i < p->n; i++) {
    mean[i] = (float)pw_tet_points_mean_stress(p, i);
    mises[i] = (float)pw_tet_points_von_mises(p, i);
  }
}

/* State variables by name; where bodies differ, a name that a point's material lacks is nan. */
static void add_states(table *t, const pw_tet_model *m)
{
  const pw_tet_points *p = &m->points;
  for (int b = 0; b < m->nmaterial; b++) {
    const pw_state_def *def = m->material[b].model->states;
    const int count = m->material[b].model->nstate(m->material[b].param);
    for (int k = 0; def && k < count && def[k].name; k++) {
      bool known = !def[k].output;
      for (int c = 0; c < t->narray; c++) {
        known = known || strcmp(t->array[c].name, def[k].name) == 0;
      }
      float *values = known ? NULL : add_column(t, def[k].name, 1, p->n);
      for (pw_idx i = 0; values && i < p->n; i++) {
        const pw_tet_material *own = &m->material[p->body[i]];
        values[i] = NAN;
        for (int j = 0; own->model->states && j < own->model->nstate(own->param); j++) {
          if (own->model->states[j].name && strcmp(own->model->states[j].name, def[k].name) == 0) {
            values[i] = (float)p->state[(pw_off)j * p->ld + i];
          }
        }
      }
    }
  }
}

static void add_index(table *t, const char *name, const pw_idx *values)
{
  if (t->narray < MAX_COLUMNS) {
    pw_vtk_array *array = &t->array[t->narray++];
    *array = (pw_vtk_array){.ncomp = 1, .index = values};
    snprintf(array->name, sizeof array->name, "%s", name);
  }
}

static pw_status write_points(const char *path, const pw_implicit *sim)
{
  const pw_tet_model *m = pw_implicit_model(sim);
  const pw_tet_points *p = &m->points;
  table t = {.narray = 0};
  t.room = (pw_off)p->n * (3 + 16 + (pw_off)m->nmaterial * (p->nstate + 1));
  pw_status s = pw_mem_alloc("values of a snapshot", t.room, sizeof *t.value, &t.value);
  if (s == PW_OK) {
    s = pw_mem_alloc("cells of a snapshot", (pw_off)p->n + 1, sizeof *t.index, &t.index);
  }
  if (s == PW_OK) {
    for (pw_idx i = 0; i <= p->n; i++) {
      t.index[i] = i;
    }
    add_field(&t, "position_m", p->x, 3, p->ld, p->n);
    const float *xyz = t.value;
    add_field(&t, "stress_pa", p->stress, 6, p->ld, p->n);
    add_invariants(&t, p);
    add_field(&t, "volume_m3", p->volume, 1, p->ld, p->n);
    add_field(&t, "volume_ratio", p->jac, 1, p->ld, p->n);
    add_field(&t, "volume_ratio_bar", p->jac_bar, 1, p->ld, p->n);
    add_field(&t, "velocity_m_s", p->velocity, 3, p->ld, p->n);
    add_states(&t, m);
    add_index(&t, "body", p->body);
    add_index(&t, "element", p->elem);
    pw_vtk_cells cells = {.kind = PW_VTK_VERTICES,
                          .ncell = p->n,
                          .start = t.index,
                          .xyz = xyz,
                          .narray = t.narray,
                          .array = t.array,
                          .time_s = pw_implicit_time(sim)};
    s = pw_vtk_write_cells(path, &cells);
  }
  pw_mem_free(&t.index);
  pw_mem_free(&t.value);
  return s;
}

/* Forces at held components are reactions; where nothing is held they are shown as zero. */
static void add_reactions(table *t, const pw_tet_model *m, pw_idx n)
{
  float *values = add_column(t, "reaction_n", 3, n);
  for (pw_off i = 0; values && i < n; i++) {
    for (int c = 0; c < 3; c++) {
      const pw_off at = (pw_off)c * n + i;
      values[3 * i + c] = m->fixed[at] ? (float)pw_tet_model_reaction(m, (size_t)at) : 0.0f;
    }
  }
}

static pw_status write_mesh(const char *path, const pw_implicit *sim)
{
  const pw_tet_model *m = pw_implicit_model(sim);
  const pw_tets *tets = &m->mesh->tets;
  const pw_idx n = tets->nnode;
  table t = {.room = 9 * (pw_off)n};
  pw_status s = pw_mem_alloc("values of the mesh", t.room, sizeof *t.value, &t.value);
  if (s == PW_OK) {
    s = pw_mem_alloc("points of elements", tets->nelem, sizeof *t.index, &t.index);
  }
  if (s == PW_OK) {
    add_field(&t, "position_m", m->mesh->x, 3, n, n);
    const float *xyz = t.value;
    add_field(&t, "displacement_m", pw_implicit_displacement(sim), 3, n, n);
    add_reactions(&t, m, n);
    for (pw_idx i = 0; i < m->points.n; i++) {
      t.index[m->points.elem[i]]++;
    }
    const pw_vtk_array count = {.name = "points", .ncomp = 1, .index = t.index};
    pw_vtk_tets mesh = {.nnode = n,
                        .nelem = tets->nelem,
                        .xyz = xyz,
                        .node = tets->node,
                        .nnode_array = t.narray - 1,
                        .nelem_array = 1,
                        .node_array = t.array + 1,
                        .elem_array = &count,
                        .time_s = pw_implicit_time(sim)};
    s = pw_vtk_write_tets(path, &mesh);
  }
  pw_mem_free(&t.index);
  pw_mem_free(&t.value);
  return s;
}

pw_status pw_solid_snapshots_write(pw_snapshots *s, const pw_implicit *sim)
{
  char path[PW_PATH];
  PW_TRY(pw_snapshots_path(s, PW_SNAPSHOT_POINTS, path));
  PW_TRY(write_points(path, sim));
  PW_TRY(pw_snapshots_path(s, PW_SNAPSHOT_MESH, path));
  PW_TRY(write_mesh(path, sim));
  return pw_snapshots_add(s, pw_implicit_time(sim), PW_SNAPSHOT_MESH);
}
