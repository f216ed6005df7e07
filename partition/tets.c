/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "partition/tets.h"

#include <math.h>
#include <string.h>

#include "engine/core/mem.h"

const int pw_tet_face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/* Room for rounding of a point placed on a face, moved with the mesh and turned back: some
 * thousand units in the last place of the largest coordinate. */
static const pw_real relative_tolerance = 1e-12;

void pw_tets_destroy(pw_tets *t)
{
  pw_mem_free(&t->x);
  pw_mem_free(&t->node);
  pw_mem_free(&t->beside);
  pw_mem_free(&t->node_start);
  pw_mem_free(&t->node_elem);
  pw_mem_free(&t->inverse);
  pw_mem_free(&t->volume);
  memset(t, 0, sizeof *t);
}

static pw_status check_input(pw_idx nnode, const pw_real *x, pw_idx nelem, const pw_idx *node)
{
  PW_REQUIRE(nnode >= 4 && nelem >= 1, PW_ERR_ARGUMENT, "a mesh of %d nodes and %d tetrahedra",
             (int)nnode, (int)nelem);
  PW_REQUIRE(nelem < 1 << 28, PW_ERR_ARGUMENT, "%d tetrahedra are too many", (int)nelem);
  for (pw_off i = 0; i < 3 * (pw_off)nnode; i++) {
    PW_REQUIRE(isfinite(x[i]), PW_ERR_ARGUMENT, "coordinate %c of node %d is no number",
               "xyz"[i / nnode], (int)(i % nnode));
  }
  for (pw_idx e = 0; e < nelem; e++) {
    for (int i = 0; i < 4; i++) {
      PW_REQUIRE(node[4 * e + i] >= 0 && node[4 * e + i] < nnode, PW_ERR_ARGUMENT,
                 "element %d names node %d of %d", (int)e, (int)node[4 * e + i], (int)nnode);
    }
  }
  return PW_OK;
}

static pw_status allocate(pw_tets *t)
{
  pw_off n = t->nelem;
  PW_TRY(pw_mem_alloc("tetrahedra: coordinates", 3 * (pw_off)t->nnode, sizeof *t->x, &t->x));
  PW_TRY(pw_mem_alloc("tetrahedra: nodes", 4 * n, sizeof *t->node, &t->node));
  PW_TRY(pw_mem_alloc("tetrahedra: neighbours", 4 * n, sizeof *t->beside, &t->beside));
  PW_TRY(pw_mem_alloc("tetrahedra: node offsets", (pw_off)t->nnode + 1, sizeof *t->node_start,
                      &t->node_start));
  PW_TRY(pw_mem_alloc("tetrahedra: of nodes", 4 * n, sizeof *t->node_elem, &t->node_elem));
  PW_TRY(pw_mem_alloc("tetrahedra: inverses", 16 * n, sizeof *t->inverse, &t->inverse));
  return pw_mem_alloc("tetrahedra: volumes", n, sizeof *t->volume, &t->volume);
}

static pw_status list_elements_at_nodes(pw_tets *t)
{
  for (pw_idx i = 0; i < 4 * t->nelem; i++) {
    t->node_start[t->node[i] + 1]++;
  }
  for (pw_idx a = 0; a < t->nnode; a++) {
    PW_REQUIRE(t->node_start[a + 1] > 0, PW_ERR_ARGUMENT, "node %d belongs to no element", (int)a);
    t->node_start[a + 1] += t->node_start[a];
  }
  for (pw_idx i = 0; i < 4 * t->nelem; i++) {
    t->node_elem[t->node_start[t->node[i]]++] = i / 4;
  }
  memmove(t->node_start + 1, t->node_start, (size_t)t->nnode * sizeof *t->node_start);
  t->node_start[0] = 0;
  return PW_OK;
}

static void bound(pw_tets *t)
{
  pw_real largest = 0.0, diagonal = 0.0;
  for (int c = 0; c < 3; c++) {
    const pw_real *x = t->x + (size_t)c * (size_t)t->nnode;
    t->low[c] = t->high[c] = x[0];
    for (pw_idx a = 0; a < t->nnode; a++) {
      t->low[c] = pw_min(t->low[c], x[a]);
      t->high[c] = pw_max(t->high[c], x[a]);
      largest = pw_max(largest, fabs(x[a]));
    }
    diagonal += (t->high[c] - t->low[c]) * (t->high[c] - t->low[c]);
  }
  t->tolerance = relative_tolerance * (sqrt(diagonal) + largest);
}

static void corner(const pw_tets *t, pw_idx a, pw_real *x)
{
  for (int c = 0; c < 3; c++) {
    x[c] = t->x[(size_t)c * (size_t)t->nnode + (size_t)a];
  }
}

static pw_real dot(const pw_real *a, const pw_real *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* (b - a) x (c - a): twice the area of the triangle along its normal. */
static void twice_area(const pw_real *a, const pw_real *b, const pw_real *c, pw_real *out)
{
  pw_real u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  pw_real v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  out[0] = u[1] * v[2] - u[2] * v[1];
  out[1] = u[2] * v[0] - u[0] * v[2];
  out[2] = u[0] * v[1] - u[1] * v[0];
}

static pw_real longest_edge(pw_real x[4][3])
{
  pw_real longest = 0.0;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < i; j++) {
      pw_real d[3] = {x[i][0] - x[j][0], x[i][1] - x[j][1], x[i][2] - x[j][2]};
      longest = pw_max(longest, dot(d, d));
    }
  }
  return sqrt(longest);
}

/* Fills inverse and volume; returns the longest edge over the radius of the inscribed sphere. */
static pw_status invert_element(pw_tets *t, pw_idx e, pw_real *shape)
{
  pw_real x[4][3], out[3], d[3], sum = 0.0;
  const pw_idx *node = t->node + 4 * (size_t)e;
  for (int i = 0; i < 4; i++) {
    corner(t, node[i], x[i]);
  }
  for (int c = 0; c < 3; c++) {
    d[c] = x[0][c] - x[1][c];
  }
  twice_area(x[1], x[2], x[3], out);
  pw_real det = -dot(d, out), edge = longest_edge(x);
  PW_REQUIRE(det > -PW_TETS_THINNEST * edge * edge * edge, PW_ERR_ARGUMENT,
             "element %d (nodes %d %d %d %d) is inverted: volume %g m3", (int)e, (int)node[0],
             (int)node[1], (int)node[2], (int)node[3], det / 6.0);
  PW_REQUIRE(det >= PW_TETS_THINNEST * edge * edge * edge && det > 0.0, PW_ERR_ARGUMENT,
             "element %d (nodes %d %d %d %d) is a sliver: volume %g m3 with edges up to %g m",
             (int)e, (int)node[0], (int)node[1], (int)node[2], (int)node[3], det / 6.0, edge);
  for (int f = 0; f < 4; f++) {
    pw_real *g = t->inverse + 16 * (size_t)e + 4 * f;
    twice_area(x[pw_tet_face[f][0]], x[pw_tet_face[f][1]], x[pw_tet_face[f][2]], out);
    for (int c = 0; c < 3; c++) {
      g[c] = -out[c] / det;
    }
    g[3] = sqrt(dot(g, g));
    sum += g[3];
  }
  t->volume[e] = det / 6.0;
  *shape = edge * sum;
  return PW_OK;
}

static pw_status invert(pw_tets *t)
{
  pw_real worst = 0.0, shape = 0.0;
  for (pw_idx e = 0; e < t->nelem; e++) {
    PW_TRY(invert_element(t, e, &shape));
    worst = pw_max(worst, shape);
  }
  /* Moving the faces out by the tolerance moves the corners by at most tolerance * edge / radius
   * of the inscribed sphere. */
  t->near = t->tolerance * (1.0 + worst);
  return PW_OK;
}

/* Face 4 e + f as a cycle of nodes that starts with the smallest. */
static void face_nodes(const pw_tets *t, pw_idx face, pw_idx *n)
{
  const pw_idx *node = t->node + 4 * (size_t)(face / 4);
  const int *corner_of = pw_tet_face[face % 4];
  pw_idx a = node[corner_of[0]], b = node[corner_of[1]], c = node[corner_of[2]];
  bool first = a < b && a < c, second = !first && b < c;
  n[0] = first ? a : second ? b : c;
  n[1] = first ? b : second ? c : a;
  n[2] = first ? c : second ? a : b;
}

/* Faces not yet matched hang in a list at their smallest node. */
static pw_status match_face(pw_tets *t, pw_idx face, pw_idx *head, pw_idx *next)
{
  pw_idx n[3], m[3], e = face / 4;
  face_nodes(t, face, n);
  for (pw_idx other = head[n[0]] - 1; other >= 0; other = next[other] - 1) {
    face_nodes(t, other, m);
    bool turned = m[1] == n[2] && m[2] == n[1], same = m[1] == n[1] && m[2] == n[2];
    PW_REQUIRE(!same, PW_ERR_ARGUMENT,
               "elements %d and %d lie on the same side of their face %d %d %d", (int)(other / 4),
               (int)e, (int)n[0], (int)n[1], (int)n[2]);
    if (turned) {
      PW_REQUIRE(t->beside[other] < 0, PW_ERR_ARGUMENT,
                 "face %d %d %d belongs to three elements: %d, %d and %d", (int)n[0], (int)n[1],
                 (int)n[2], (int)(other / 4), (int)t->beside[other], (int)e);
      t->beside[other] = e;
      t->beside[face] = other / 4;
    }
  }
  next[face] = head[n[0]];
  head[n[0]] = face + 1;
  return PW_OK;
}

static pw_status find_neighbours(pw_tets *t)
{
  pw_idx *head = NULL, *next = NULL;
  memset(t->beside, 0xff, 4 * (size_t)t->nelem * sizeof *t->beside);
  pw_status s = pw_mem_alloc("face lists", t->nnode, sizeof *head, &head);
  if (s == PW_OK) {
    s = pw_mem_alloc("faces", 4 * (pw_off)t->nelem, sizeof *next, &next);
  }
  for (pw_idx face = 0; s == PW_OK && face < 4 * t->nelem; face++) {
    s = match_face(t, face, head, next);
  }
  pw_mem_free(&head);
  pw_mem_free(&next);
  return s;
}

/* Walks from element 0 over the faces. */
static pw_status check_joined(const pw_tets *t)
{
  pw_idx *reached = NULL, *stack = NULL, n = 0, depth = 0;
  PW_TRY(pw_mem_alloc("elements reached", 2 * (pw_off)t->nelem, sizeof *reached, &reached));
  stack = reached + t->nelem;
  stack[depth++] = 0;
  reached[0] = 1;
  while (depth > 0) {
    pw_idx e = stack[--depth];
    n++;
    for (int f = 0; f < 4; f++) {
      pw_idx other = t->beside[4 * e + f];
      if (other >= 0 && !reached[other]) {
        reached[other] = 1;
        stack[depth++] = other;
      }
    }
  }
  pw_idx lost = 0;
  while (lost < t->nelem && reached[lost]) {
    lost++;
  }
  pw_mem_free(&reached);
  PW_REQUIRE(n == t->nelem, PW_ERR_ARGUMENT,
             "element %d and %d others are not joined to element 0 by faces", (int)lost,
             (int)(t->nelem - n - 1));
  return PW_OK;
}

/* Table of the nodes seen, by the cell of a fine grid that holds them. */
typedef struct {
  pw_real cell;
  uint64_t mask;
  pw_idx *head; /* [mask + 1] node + 1 */
  pw_idx *next; /* [nnode] */
} node_table;

static uint64_t cell_of(const node_table *h, const pw_real *x, const pw_real *low)
{
  uint64_t key = 0;
  for (int c = 0; c < 3; c++) {
    uint64_t q = (uint64_t)((x[c] - low[c]) / h->cell + 4.0);
    key = (key ^ q) * UINT64_C(0x9e3779b97f4a7c15);
    key ^= key >> 29;
  }
  return key & h->mask;
}

static pw_status compare_nodes(const pw_tets *t, const node_table *h, pw_idx a)
{
  pw_real x[3], y[3];
  corner(t, a, x);
  for (int side = 0; side < 8; side++) {
    for (int c = 0; c < 3; c++) {
      y[c] = x[c] + (side >> c & 1 ? 2.0 : -2.0) * t->tolerance;
    }
    for (pw_idx b = h->head[cell_of(h, y, t->low)] - 1; b >= 0; b = h->next[b] - 1) {
      corner(t, b, y);
      pw_real d[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
      PW_REQUIRE(!(dot(d, d) <= 4.0 * t->tolerance * t->tolerance), PW_ERR_ARGUMENT,
                 "nodes %d and %d are in one place: %g %g %g", (int)b, (int)a, x[0], x[1], x[2]);
    }
  }
  return PW_OK;
}

static pw_status check_nodes_apart(const pw_tets *t)
{
  node_table h = {.cell = 64.0 * t->tolerance, .mask = 1};
  while (h.mask < 2 * (uint64_t)t->nnode) {
    h.mask = 2 * h.mask + 1;
  }
  pw_status s = pw_mem_alloc("table of nodes", (pw_off)h.mask + 1, sizeof *h.head, &h.head);
  if (s == PW_OK) {
    s = pw_mem_alloc("list of nodes", t->nnode, sizeof *h.next, &h.next);
  }
  for (pw_idx a = 0; s == PW_OK && a < t->nnode; a++) {
    pw_real x[3];
    s = compare_nodes(t, &h, a);
    corner(t, a, x);
    pw_idx *head = &h.head[cell_of(&h, x, t->low)];
    h.next[a] = *head;
    *head = a + 1;
  }
  pw_mem_free(&h.head);
  pw_mem_free(&h.next);
  return s;
}

static pw_status build(const pw_real *x, const pw_idx *node, pw_tets *t)
{
  PW_TRY(allocate(t));
  memcpy(t->x, x, 3 * (size_t)t->nnode * sizeof *x);
  memcpy(t->node, node, 4 * (size_t)t->nelem * sizeof *node);
  bound(t);
  PW_TRY(list_elements_at_nodes(t));
  PW_TRY(check_nodes_apart(t));
  PW_TRY(invert(t));
  PW_TRY(find_neighbours(t));
  return check_joined(t);
}

pw_status pw_tets_create(pw_idx nnode, const pw_real *x, pw_idx nelem, const pw_idx *node,
                         pw_tets *out)
{
  PW_TRY(check_input(nnode, x, nelem, node));
  pw_tets t = {.nnode = nnode, .nelem = nelem};
  pw_status s = build(x, node, &t);
  if (s != PW_OK) {
    pw_tets_destroy(&t);
    return s;
  }
  *out = t;
  return PW_OK;
}

void pw_tets_shape(const pw_tets *t, pw_idx e, const pw_real *x, pw_real *shape)
{
  pw_real base[2][3];
  corner(t, t->node[4 * e + 1], base[0]);
  corner(t, t->node[4 * e], base[1]);
  for (int f = 0; f < 4; f++) {
    const pw_real *b = base[f > 0];
    pw_real d[3] = {x[0] - b[0], x[1] - b[1], x[2] - b[2]};
    shape[f] = dot(t->inverse + 16 * (size_t)e + 4 * f, d);
  }
}

bool pw_tets_hold(const pw_tets *t, pw_idx e, const pw_real *x)
{
  pw_real shape[4];
  const pw_real *g = t->inverse + 16 * (size_t)e;
  pw_tets_shape(t, e, x, shape);
  bool in = true;
  for (int f = 0; f < 4; f++) {
    in = in && shape[f] >= -t->tolerance * g[4 * f + 3];
  }
  return in;
}

pw_idx pw_tets_boundary(const pw_tets *t, pw_idx *face)
{
  pw_idx n = 0;
  for (pw_idx i = 0; i < 4 * t->nelem; i++) {
    if (t->beside[i] < 0) {
      if (face) {
        face[n] = i;
      }
      n++;
    }
  }
  return n;
}
