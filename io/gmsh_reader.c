/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/gmsh_mesh.h"

#ifdef PW_GMSH_LIBRARY

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/core/mem.h"
#include "io/gmsh_library.h"

/* gmsh's types of elements */
enum { LINEAR = 4, TEN_NODES = 11, TWENTY_NODES = 29, TRIANGLE = 2, SIX_NODES = 9 };
enum { MAX_TAG = 1 << 28 };

static const pw_gmsh_library *gmsh;

bool pw_gmsh_available(void)
{
  return true;
}

/* What the library hands over: freed by it. */
typedef struct {
  const char *path;
  int type;          /* of all tetrahedra */
  size_t *node;      /* [nnode] tags */
  double *x;         /* [nnode][3] */
  size_t *cell;      /* [ncell] tags */
  size_t *cell_node; /* [ncell][4 or 10] tags */
  size_t nnode, ncell;
  pw_idx *node_of; /* [largest tag + 1] node, or -1: nodes ascend with their tags */
  pw_idx *cell_of; /* [largest tag + 1] cell, or -1: likewise */
  pw_idx *node_at; /* [nnode] place of a node in the library's list */
  pw_idx *cell_at; /* [ncell] place of a cell */
  size_t node_tags, cell_tags;
} reading;

static pw_status choose_type(reading *r)
{
  int *types = NULL, failed = 0;
  size_t n = 0;
  gmsh->gmshModelMeshGetElementTypes(&types, &n, 3, -1, &failed);
  int other = 0, linear = 0, ten = 0;
  for (size_t i = 0; i < n; i++) {
    linear |= types[i] == LINEAR;
    ten |= types[i] == TEN_NODES;
    other = types[i] != LINEAR && types[i] != TEN_NODES ? types[i] : other;
  }
  gmsh->gmshFree(types);
  PW_REQUIRE(!failed && (n > 0), PW_ERR_SCENE, "%s: no tetrahedra in the file", r->path);
  PW_REQUIRE(other != TWENTY_NODES, PW_ERR_SCENE,
             "%s: tetrahedra of third order: first and second order are known", r->path);
  PW_REQUIRE(other == 0, PW_ERR_SCENE, "%s: elements of gmsh's type %d are no tetrahedra", r->path,
             other);
  PW_REQUIRE(!(linear && ten), PW_ERR_SCENE, "%s: linear and ten-node tetrahedra are mixed",
             r->path);
  r->type = ten ? TEN_NODES : LINEAR;
  return PW_OK;
}

static pw_status fetch(reading *r)
{
  int failed = 0;
  size_t n = 0, coordinates = 0, none = 0;
  double *parameter = NULL;
  gmsh->gmshModelMeshGetElementsByType(r->type, &r->cell, &r->ncell, &r->cell_node, &n, -1, 0, 1,
                                       &failed);
  PW_REQUIRE(!failed && r->ncell > 0 && r->ncell < 1 << 25, PW_ERR_SCENE,
             "%s: %zu tetrahedra in the file", r->path, r->ncell);
  gmsh->gmshModelMeshGetNodes(&r->node, &r->nnode, &r->x, &coordinates, &parameter, &none, -1, -1,
                              0, 0, &failed);
  gmsh->gmshFree(parameter);
  PW_REQUIRE(!failed && r->nnode > 0 && r->nnode < 1 << 28 && coordinates == 3 * r->nnode,
             PW_ERR_SCENE, "%s: %zu nodes in the file", r->path, r->nnode);
  return PW_OK;
}

static int ascending(const void *a, const void *b)
{
  const pw_idx x = *(const pw_idx *)a, y = *(const pw_idx *)b;
  return (x > y) - (x < y);
}

/* Numbers tags in ascending order: table gives the number of a tag, -1 where there is none, and at
 * the place of a number in the list of tags. */
static pw_status tabulate(const reading *r, const size_t *tag, size_t n, pw_idx **table,
                          size_t *length, pw_idx **at)
{
  pw_idx count = 0;
  size_t largest = 0;
  for (size_t i = 0; i < n; i++) {
    largest = tag[i] > largest ? tag[i] : largest;
  }
  PW_REQUIRE(largest < MAX_TAG, PW_ERR_SCENE, "%s: a tag of %zu", r->path, largest);
  PW_TRY(pw_mem_alloc("mesh file: tags", (pw_off)largest + 1, sizeof **table, table));
  memset(*table, 0xff, (largest + 1) * sizeof **table);
  *length = largest + 1;
  for (size_t i = 0; i < n; i++) {
    (*table)[tag[i]] = (pw_idx)i;
  }
  PW_TRY(pw_mem_alloc("mesh file: places", (pw_off)n, sizeof **at, at));
  for (size_t i = 0; i <= largest; i++) {
    if ((*table)[i] >= 0) {
      (*at)[count] = (*table)[i];
      (*table)[i] = count++;
    }
  }
  PW_REQUIRE((size_t)count == n, PW_ERR_SCENE, "%s: %zu tags stand for %d items", r->path, n,
             (int)count);
  return PW_OK;
}

/* Cells with the library's last two middle nodes swapped, and every node used. */
static pw_status copy_cells(const reading *r, pw_gmsh_mesh *m, pw_idx *cell)
{
  const size_t per = (size_t)m->mesh.nodes;
  size_t absent = 0; /* nodes of cells that have fewer of them */
  pw_idx *used = NULL;
  PW_TRY(pw_mem_alloc("mesh file: nodes used", (pw_off)r->nnode, sizeof *used, &used));
  for (size_t i = 0; i < per * r->ncell; i++) {
    const size_t k = i % per, corner = per == 10 && k >= 8 ? 17 - k : k;
    const size_t tag = r->cell_node[per * (size_t)r->cell_at[i / per] + corner];
    cell[i] = tag < r->node_tags ? r->node_of[tag] : -1;
    if (cell[i] >= 0) {
      used[cell[i]] = 1;
    }
    absent += cell[i] < 0;
  }
  size_t lost = 0;
  while (lost < r->nnode && used[lost]) {
    lost++;
  }
  pw_mem_free(&used);
  PW_REQUIRE(absent == 0, PW_ERR_SCENE, "%s: linear and ten-node tetrahedra are mixed", r->path);
  const double *x = r->x + 3 * (size_t)r->node_at[lost < r->nnode ? lost : 0];
  PW_REQUIRE(lost == r->nnode, PW_ERR_SCENE,
             "%s: node %lld at (%g, %g, %g) belongs to no tetrahedron", r->path,
             (long long)m->node_tag[lost], x[0], x[1], x[2]);
  return PW_OK;
}

/* Middles of edges to the middles of their chords; returns the largest distance. */
static pw_real straighten(const pw_gmsh_mesh *m, const pw_idx *cell, pw_real *x)
{
  static const int end[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  const size_t n = (size_t)m->mesh.nnode;
  pw_real most = 0.0;
  for (pw_off k = 0; m->mesh.nodes == 10 && k < m->mesh.ncell; k++) {
    for (int i = 0; i < 6; i++) {
      const size_t a = (size_t)cell[10 * k + end[i][0]], b = (size_t)cell[10 * k + end[i][1]];
      const size_t middle = (size_t)cell[10 * k + 4 + i];
      pw_real off = 0.0;
      for (size_t c = 0; c < 3; c++) {
        pw_real to = 0.5 * (x[c * n + a] + x[c * n + b]), *now = &x[c * n + middle];
        off += (to - *now) * (to - *now);
        *now = to;
      }
      most = pw_max(most, sqrt(off));
    }
  }
  return most;
}

static pw_status copy_mesh(reading *r, pw_gmsh_mesh *m)
{
  pw_idx *cell = NULL;
  pw_real *x = NULL;
  m->mesh.nodes = r->type == TEN_NODES ? 10 : 4;
  m->mesh.nnode = (pw_idx)r->nnode;
  m->mesh.ncell = (pw_idx)r->ncell;
  PW_TRY(tabulate(r, r->node, r->nnode, &r->node_of, &r->node_tags, &r->node_at));
  PW_TRY(tabulate(r, r->cell, r->ncell, &r->cell_of, &r->cell_tags, &r->cell_at));
  PW_TRY(pw_mem_alloc("mesh file: coordinates", 3 * (pw_off)r->nnode, sizeof *x, &x));
  m->mesh.x = x;
  PW_TRY(pw_mem_alloc("mesh file: cells", (pw_off)r->ncell * m->mesh.nodes, sizeof *cell, &cell));
  m->mesh.cell = cell;
  PW_TRY(pw_mem_alloc("mesh file: node tags", (pw_off)r->nnode, sizeof *m->node_tag, &m->node_tag));
  PW_TRY(pw_mem_alloc("mesh file: cell tags", (pw_off)r->ncell, sizeof *m->cell_tag, &m->cell_tag));
  for (size_t a = 0; a < r->nnode; a++) {
    const size_t at = (size_t)r->node_at[a];
    m->node_tag[a] = (pw_off)r->node[at];
    for (size_t c = 0; c < 3; c++) {
      x[c * r->nnode + a] = r->x[3 * at + c];
    }
  }
  for (size_t k = 0; k < r->ncell; k++) {
    m->cell_tag[k] = (pw_off)r->cell[r->cell_at[k]];
  }
  PW_TRY(copy_cells(r, m, cell));
  m->straightened = straighten(m, cell, x);
  return PW_OK;
}

/* Sorted places of tags; tags that the mesh does not have are left out, doubles too. */
static pw_status copy_items(const size_t *tag, size_t n, const pw_idx *table, size_t length,
                            pw_idx **item, pw_idx *count)
{
  pw_idx *list = NULL, kept = 0;
  PW_TRY(pw_mem_alloc("mesh file: group", (pw_off)n, sizeof *list, &list));
  for (size_t i = 0; i < n; i++) {
    if (tag[i] < length && table[tag[i]] >= 0) {
      list[kept++] = table[tag[i]];
    }
  }
  if (kept > 1) {
    qsort(list, (size_t)kept, sizeof *list, ascending);
  }
  *count = 0;
  for (pw_idx i = 0; i < kept; i++) {
    if (i == 0 || list[i] != list[i - 1]) {
      list[(*count)++] = list[i];
    }
  }
  *item = list;
  return PW_OK;
}

/* Tetrahedra of all volumes of a group. */
static pw_status copy_group_cells(const reading *r, pw_gmsh_group *g)
{
  int *entity = NULL, failed = 0;
  size_t nentity = 0, total = 0, *all = NULL;
  pw_status s = pw_mem_alloc("mesh file: cells of a group", (pw_off)r->ncell, sizeof *all, &all);
  PW_TRY(s);
  gmsh->gmshModelGetEntitiesForPhysicalGroup(g->dim, g->tag, &entity, &nentity, &failed);
  for (size_t i = 0; i < nentity && !failed; i++) {
    size_t *tag = NULL, *node = NULL, n = 0, nodes = 0;
    gmsh->gmshModelMeshGetElementsByType(r->type, &tag, &n, &node, &nodes, entity[i], 0, 1,
                                         &failed);
    for (size_t k = 0; k < n && total < r->ncell; k++) {
      all[total++] = tag[k];
    }
    gmsh->gmshFree(tag);
    gmsh->gmshFree(node);
  }
  gmsh->gmshFree(entity);
  s = copy_items(all, total, r->cell_of, r->cell_tags, &g->cell, &g->ncell);
  pw_mem_free(&all);
  PW_REQUIRE(!failed, PW_ERR_FILE, "%s: the volumes of group %d cannot be read", r->path, g->tag);
  return s;
}

/* Linear triangles in one of the library's: itself, or four with the middles of its edges, which
 * are those of 0-1, 1-2 and 2-0. Triangles with a node that the mesh does not have are left out. */
static void add_triangles(const reading *r, const size_t *node, pw_idx nodes, pw_gmsh_group *g)
{
  static const int part[4][3] = {{0, 3, 5}, {1, 4, 3}, {2, 5, 4}, {3, 4, 5}};
  pw_idx index[6];
  for (int i = 0; i < nodes; i++) {
    index[i] = node[i] < r->node_tags ? r->node_of[node[i]] : -1;
    if (index[i] < 0) {
      return;
    }
  }
  for (int t = 0; t < (nodes == 6 ? 4 : 1); t++, g->nface++) {
    for (int i = 0; g->face && i < 3; i++) {
      g->face[3 * g->nface + i] = index[nodes == 6 ? part[t][i] : i];
    }
  }
}

/* Triangles of a surface; counted only where there is no room yet. */
static int collect_faces(const reading *r, const int *entity, size_t nentity, pw_gmsh_group *g)
{
  int failed = 0;
  const pw_idx nodes = r->type == TEN_NODES ? 6 : 3;
  g->nface = 0;
  for (size_t i = 0; i < nentity && !failed; i++) {
    size_t *tag = NULL, *node = NULL, n = 0, total = 0;
    gmsh->gmshModelMeshGetElementsByType(nodes == 6 ? SIX_NODES : TRIANGLE, &tag, &n, &node, &total,
                                         entity[i], 0, 1, &failed);
    for (size_t k = 0; k < n && total == n * (size_t)nodes; k++) {
      add_triangles(r, node + k * (size_t)nodes, nodes, g);
    }
    gmsh->gmshFree(tag);
    gmsh->gmshFree(node);
  }
  return failed;
}

static pw_status copy_group_faces(const reading *r, pw_gmsh_group *g)
{
  int *entity = NULL, failed = 0;
  size_t n = 0;
  gmsh->gmshModelGetEntitiesForPhysicalGroup(g->dim, g->tag, &entity, &n, &failed);
  failed = failed || collect_faces(r, entity, n, g);
  pw_status s = pw_mem_alloc("mesh file: faces", 3 * (pw_off)g->nface, sizeof *g->face, &g->face);
  if (s == PW_OK && !failed) {
    failed = collect_faces(r, entity, n, g);
  }
  gmsh->gmshFree(entity);
  PW_REQUIRE(!failed, PW_ERR_FILE, "%s: the faces of group %d cannot be read", r->path, g->tag);
  return s;
}

static pw_status copy_group(const reading *r, pw_gmsh_group *g)
{
  char *name = NULL;
  size_t *tag = NULL, n = 0, coordinates = 0;
  double *x = NULL;
  int failed = 0;
  gmsh->gmshModelGetPhysicalName(g->dim, g->tag, &name, &failed);
  if (!failed && name && name[0]) {
    snprintf(g->name, sizeof g->name, "%s", name);
  } else {
    snprintf(g->name, sizeof g->name, "%d", g->tag);
  }
  gmsh->gmshFree(name);
  gmsh->gmshModelMeshGetNodesForPhysicalGroup(g->dim, g->tag, &tag, &n, &x, &coordinates, &failed);
  pw_status s = copy_items(tag, n, r->node_of, r->node_tags, &g->node, &g->nnode);
  gmsh->gmshFree(tag);
  gmsh->gmshFree(x);
  PW_TRY(s);
  return g->dim == 3 ? copy_group_cells(r, g) : g->dim == 2 ? copy_group_faces(r, g) : PW_OK;
}

static pw_status copy_groups(const reading *r, pw_gmsh_mesh *m)
{
  int *pair = NULL, failed = 0;
  size_t n = 0;
  gmsh->gmshModelGetPhysicalGroups(&pair, &n, -1, &failed);
  pw_status s = pw_mem_alloc("mesh file: groups", (pw_off)(n / 2), sizeof *m->group, &m->group);
  for (size_t i = 0; i + 1 < n && s == PW_OK && !failed; i += 2) {
    pw_gmsh_group *g = &m->group[m->ngroup++];
    g->dim = pair[i];
    g->tag = pair[i + 1];
    s = copy_group(r, g);
  }
  gmsh->gmshFree(pair);
  return s;
}

static pw_status read_open_file(reading *r, pw_gmsh_mesh *m)
{
  PW_TRY(choose_type(r));
  PW_TRY(fetch(r));
  PW_TRY(copy_mesh(r, m));
  return copy_groups(r, m);
}

/* Read what the library has open. */
static pw_status take(const char *path, pw_gmsh_mesh *out)
{
  reading r = {.path = path};
  pw_gmsh_mesh m = {.ngroup = 0};
  pw_status s = read_open_file(&r, &m);
  gmsh->gmshFree(r.node);
  gmsh->gmshFree(r.x);
  gmsh->gmshFree(r.cell);
  gmsh->gmshFree(r.cell_node);
  pw_mem_free(&r.node_of);
  pw_mem_free(&r.cell_of);
  pw_mem_free(&r.node_at);
  pw_mem_free(&r.cell_at);
  if (s != PW_OK) {
    pw_gmsh_destroy(&m);
    return s;
  }
  *out = m;
  return PW_OK;
}

pw_status pw_gmsh_read(const char *path, pw_gmsh_mesh *out)
{
  PW_TRY(pw_gmsh_open(path, NULL, &gmsh));
  pw_status s = take(path, out);
  pw_gmsh_close(gmsh);
  return s;
}

pw_status pw_gmsh_make(const pw_gmsh_recipe *recipe, pw_gmsh_mesh *out)
{
  PW_TRY(pw_gmsh_open(recipe->path, recipe, &gmsh));
  pw_status s = take(recipe->path, out);
  pw_gmsh_close(gmsh);
  return s;
}

#else
typedef int pw_gmsh_reader_is_left_out; /* a translation unit declares something */
#endif
