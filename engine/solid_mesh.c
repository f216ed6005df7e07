/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/solid_mesh.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"
#include "engine/tet_box.h"
#include "engine/tet_model.h"

/* Six volumes over the cube of the longest edge; 0.71 for a regular tetrahedron. */
static const pw_real flattest = 1e-5;

void pw_solid_mesh_destroy(pw_solid_mesh *m)
{
  for (int i = 0; i < m->ngroup; i++) {
    pw_mem_free(&m->group[i].node);
    pw_mem_free(&m->group[i].cell);
    pw_mem_free(&m->group[i].face);
  }
  pw_mem_free(&m->group);
  pw_mem_free(&m->input.x);
  pw_mem_free(&m->input.cell);
  pw_mem_free(&m->node_tag);
  pw_mem_free(&m->cell_tag);
  memset(m, 0, sizeof *m);
}

pw_off pw_solid_cell_tag(const pw_solid_mesh *m, pw_idx cell)
{
  return m->cell_tag ? m->cell_tag[cell] : (pw_off)cell + 1;
}

pw_status pw_solid_mesh_find(const pw_solid_mesh *m, int dim, const char *name, const char *path,
                             const pw_solid_group **group)
{
  static const char *const kind[] = {"point", "curve", "surface", "volume"};
  static const int order[] = {2, 3, 1, 0};
  char known[512] = "";
  size_t used = 0;
  for (int k = 0; k < 4; k++) {
    for (int i = 0; i < m->ngroup; i++) {
      const pw_solid_group *g = &m->group[i];
      if (g->dim != order[k] || (dim >= 0 && g->dim != dim)) {
        continue;
      }
      if (strcmp(g->name, name) == 0) {
        *group = g;
        return PW_OK;
      }
      if (used + PW_NAME + 4 < sizeof known) {
        used +=
            (size_t)snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", g->name);
      }
    }
  }
  return pw_error_set(PW_ERR_SCENE, __FILE__, __LINE__, __func__,
                      "%s: the mesh has no %s '%s'; it has %s", path,
                      dim >= 0 ? kind[dim] : "physical group", name, used ? known : "none");
}

/* ---- box ---- */

/* Linear triangles of the face opposite corner @p f of a cell; returns their number. */
static int face_triangles(const pw_tet_input *in, const pw_idx *cell, int f, pw_idx (*out)[3])
{
  static const int middle[4][4] = {{-1, 4, 6, 7}, {4, -1, 5, 8}, {6, 5, -1, 9}, {7, 8, 9, -1}};
  const int *i = pw_tet_face[f];
  for (int k = 0; k < 3; k++) {
    out[0][k] = cell[i[k]];
  }
  if (in->nodes == 4) {
    return 1;
  }
  for (int k = 0; k < 3; k++) { /* one at each corner, then the one between the middles */
    const int before = middle[i[k]][i[(k + 2) % 3]], after = middle[i[k]][i[(k + 1) % 3]];
    out[k][0] = cell[i[k]];
    out[k][1] = cell[after];
    out[k][2] = cell[before];
    out[3][k] = cell[after];
  }
  return 4;
}

/* Nodes and faces in the plane `at`; counted only where there is no room yet. */
static void collect_side(const pw_tet_input *in, const pw_real *x, pw_real at, pw_solid_group *g)
{
  g->nnode = g->nface = 0;
  for (pw_idx a = 0; a < in->nnode; a++) {
    if (x[a] == at) {
      if (g->node) {
        g->node[g->nnode] = a;
      }
      g->nnode++;
    }
  }
  for (pw_off k = 0; k < 4 * (pw_off)in->ncell; k++) {
    const pw_idx *cell = in->cell + k / 4 * in->nodes;
    const int f = (int)(k % 4), *i = pw_tet_face[f];
    pw_idx triangle[4][3];
    if (x[cell[i[0]]] == at && x[cell[i[1]]] == at && x[cell[i[2]]] == at) {
      const int n = face_triangles(in, cell, f, triangle);
      if (g->face) {
        memcpy(g->face + 3 * g->nface, triangle, (size_t)n * sizeof triangle[0]);
      }
      g->nface += n;
    }
  }
}

static pw_status add_side(pw_solid_mesh *m, const char *name, int axis, pw_real at)
{
  const pw_real *x = m->input.x + (pw_off)axis * m->input.nnode;
  pw_solid_group *g = &m->group[m->ngroup++];
  snprintf(g->name, sizeof g->name, "%s", name);
  g->dim = 2;
  collect_side(&m->input, x, at, g);
  PW_TRY(pw_mem_alloc("nodes of a side", g->nnode, sizeof *g->node, &g->node));
  PW_TRY(pw_mem_alloc("faces of a side", 3 * (pw_off)g->nface, sizeof *g->face, &g->face));
  collect_side(&m->input, x, at, g);
  return PW_OK;
}

/* All nodes and cells as the volume "all". */
static pw_status add_all(pw_solid_mesh *m)
{
  pw_solid_group *g = &m->group[m->ngroup++];
  snprintf(g->name, sizeof g->name, "all");
  g->dim = 3;
  g->nnode = m->input.nnode;
  g->ncell = m->input.ncell;
  PW_TRY(pw_mem_alloc("nodes of a box", g->nnode, sizeof *g->node, &g->node));
  PW_TRY(pw_mem_alloc("cells of a box", g->ncell, sizeof *g->cell, &g->cell));
  for (pw_idx i = 0; i < g->nnode; i++) {
    g->node[i] = i;
  }
  for (pw_idx i = 0; i < g->ncell; i++) {
    g->cell[i] = i;
  }
  return PW_OK;
}

pw_status pw_solid_mesh_box(const pw_scene *scene, pw_solid_mesh *out)
{
  static const char *const side[6] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  const pw_scene_mesh *s = &scene->solid.mesh;
  pw_tet_box box = {.per_brick = s->tets_per_brick,
                    .nodes = s->cells == PW_CELLS_TEN_NODE ? 10 : 4,
                    .diagonal = (pw_tet_diagonal)s->diagonal};
  pw_solid_mesh m = {.source = "box"};
  for (int c = 0; c < 3; c++) {
    box.bricks[c] = (pw_idx)s->bricks[c];
    box.low[c] = s->low_m[c];
    box.high[c] = s->high_m[c];
  }
  pw_status status = pw_tet_box_create(&box, &m.input);
  if (status == PW_OK) {
    status = pw_mem_alloc("groups of a box", 7, sizeof *m.group, &m.group);
  }
  for (int k = 0; k < 6 && status == PW_OK; k++) {
    status = add_side(&m, side[k], k / 2, k % 2 ? s->high_m[k / 2] : s->low_m[k / 2]);
  }
  if (status == PW_OK) {
    status = add_all(&m);
  }
  if (status != PW_OK) {
    pw_solid_mesh_destroy(&m);
    return status;
  }
  *out = m;
  return PW_OK;
}

/* ---- meshes that cannot be run ---- */

/* Name of the volume a cell is in, or "". */
static const char *group_of(const pw_solid_mesh *m, pw_idx cell)
{
  for (int i = 0; i < m->ngroup; i++) {
    const pw_solid_group *g = &m->group[i];
    for (pw_idx k = 0; g->dim == 3 && k < g->ncell; k++) {
      if (g->cell[k] == cell) {
        return g->name;
      }
    }
  }
  return "";
}

static pw_real six_volumes(const pw_solid_mesh *m, pw_idx cell, pw_real *longest)
{
  const pw_tet_input *in = &m->input;
  const pw_idx *node = in->cell + (pw_off)cell * in->nodes;
  pw_real p[4][3], d[3][3];
  *longest = 0.0;
  for (int i = 0; i < 4; i++) {
    for (int c = 0; c < 3; c++) {
      p[i][c] = in->x[(pw_off)c * in->nnode + node[i]];
      d[i > 0 ? i - 1 : 0][c] = p[i][c] - p[0][c];
    }
    for (int k = 0; k < i; k++) {
      pw_real sum = 0.0;
      for (int c = 0; c < 3; c++) {
        sum += (p[i][c] - p[k][c]) * (p[i][c] - p[k][c]);
      }
      *longest = pw_max(*longest, sqrt(sum));
    }
  }
  return d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
         d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
         d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
}

static pw_status check_cells(const pw_solid_mesh *m)
{
  pw_idx flat = 0, first = -1;
  for (pw_idx k = 0; k < m->input.ncell; k++) {
    pw_real longest, v = six_volumes(m, k, &longest);
    const bool bad = !(v > flattest * longest * longest * longest);
    first = bad && first < 0 ? k : first;
    flat += bad;
  }
  if (flat == 0) {
    return PW_OK;
  }
  pw_real longest, v = six_volumes(m, first, &longest);
  const pw_off tag = pw_solid_cell_tag(m, first);
  PW_REQUIRE(v >= 0.0, PW_ERR_SCENE,
             "mesh: cell %lld of volume '%s' is inside out: its volume is %g m3 (%d such or flat "
             "cells)",
             (long long)tag, group_of(m, first), v / 6.0, (int)flat);
  return pw_error_set(PW_ERR_SCENE, __FILE__, __LINE__, __func__,
                      "mesh: cell %lld of volume '%s' is flat: its volume is %g m3, its longest "
                      "edge %g m (%d such cells)",
                      (long long)tag, group_of(m, first), v / 6.0, longest, (int)flat);
}

static pw_idx root_of(pw_idx *parent, pw_idx a)
{
  while (parent[a] != a) {
    parent[a] = parent[parent[a]];
    a = parent[a];
  }
  return a;
}

/* Everything has to hang together by common nodes: there is no contact between parts. */
static pw_status check_joined(const pw_solid_mesh *m)
{
  const pw_tet_input *in = &m->input;
  pw_idx *parent = NULL, apart = 0, first = -1;
  PW_TRY(pw_mem_alloc("parts of the mesh", in->nnode, sizeof *parent, &parent));
  for (pw_idx a = 0; a < in->nnode; a++) {
    parent[a] = a;
  }
  for (pw_off k = 0; k < in->ncell; k++) {
    for (int i = 1; i < in->nodes; i++) {
      const pw_idx a = root_of(parent, in->cell[k * in->nodes]);
      const pw_idx b = root_of(parent, in->cell[k * in->nodes + i]);
      parent[a > b ? a : b] = a < b ? a : b;
    }
  }
  for (pw_idx k = 0; k < in->ncell; k++) {
    const bool other =
        root_of(parent, in->cell[(pw_off)k * in->nodes]) != root_of(parent, in->cell[0]);
    first = other && first < 0 ? k : first;
    apart += other;
  }
  pw_mem_free(&parent);
  PW_REQUIRE(apart == 0, PW_ERR_SCENE,
             "mesh: it is in parts that share no nodes: %d cells, such as %lld of volume '%s', are "
             "not joined to cell %lld of volume '%s'; in gmsh, make their common faces one "
             "(BooleanFragments, Coherence)",
             (int)apart, (long long)pw_solid_cell_tag(m, first), group_of(m, first),
             (long long)pw_solid_cell_tag(m, 0), group_of(m, 0));
  return PW_OK;
}

pw_status pw_solid_mesh_check(const pw_scene *scene, const pw_solid_mesh *m)
{
  const pw_scene_implicit *p = &scene->solid.implicit;
  PW_REQUIRE(m->input.nodes == 10 || p->fbar == PW_FBAR_NONE, PW_ERR_SCENE,
             "implicit.fbar: a patch is a ten-node tetrahedron, and the mesh (%s) is of linear "
             "ones; write fbar: none or make a mesh of second order",
             m->source);
  PW_REQUIRE(m->input.nodes == 10 || p->points_per == 0, PW_ERR_SCENE,
             "implicit.points_per: the mesh (%s) has no ten-node tetrahedra", m->source);
  PW_TRY(check_cells(m));
  return check_joined(m);
}
