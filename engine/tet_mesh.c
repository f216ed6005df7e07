/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/tet_mesh.h"

#include <math.h>
#include <string.h>

#include "engine/core/mem.h"

enum { EDGES = 6, AXES = 3 };

static const pw_real straight = 1e-6; /* of the edge: a middle further away bends it */
static const pw_real tie = 1e-9;      /* diagonals as long as this, relatively, count as equal */

static const int edge_ends[EDGES][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
static const int diagonal_ends[AXES][2] = {{4, 9}, {5, 7}, {6, 8}};
static const int corners[4][4] = {{0, 4, 6, 7}, {1, 5, 4, 8}, {2, 6, 5, 9}, {3, 8, 7, 9}};

/* The other four nodes of the octahedron in the order that gives (first end, second end, ring k,
 * ring k + 1) a positive volume. */
static const int ring[AXES][4] = {{5, 6, 7, 8}, {8, 9, 6, 4}, {5, 9, 7, 4}};

static const int whole[1][4] = {{0, 1, 2, 3}};

void pw_tet_mesh_destroy(pw_tet_mesh *m)
{
  pw_tets_destroy(&m->tets);
  pw_mem_free(&m->patch_node);
  pw_mem_free(&m->local);
  pw_mem_free(&m->face);
  pw_mem_free(&m->x);
  memset(m, 0, sizeof *m);
}

static pw_status check_input(const pw_tet_input *in)
{
  PW_REQUIRE(in->nodes == 4 || in->nodes == 10, PW_ERR_ARGUMENT,
             "a tetrahedron of %d nodes: 4 or 10 are known", in->nodes);
  PW_REQUIRE(in->ncell >= 1 && in->ncell < 1 << 25, PW_ERR_ARGUMENT, "a mesh of %d tetrahedra",
             (int)in->ncell);
  PW_REQUIRE(in->diagonal <= PW_TET_DIAGONAL_ALONG_Z, PW_ERR_ARGUMENT,
             "%d is no rule for the inner diagonal", (int)in->diagonal);
  for (pw_off i = 0; i < (pw_off)in->ncell * in->nodes; i++) {
    PW_REQUIRE(in->cell[i] >= 0 && in->cell[i] < in->nnode, PW_ERR_ARGUMENT,
               "cell %lld names node %d of %d", (long long)(i / in->nodes), (int)in->cell[i],
               (int)in->nnode);
  }
  return PW_OK;
}

static pw_real coordinate(const pw_tet_input *in, pw_idx a, int c)
{
  return in->x[(size_t)c * (size_t)in->nnode + (size_t)a];
}

static pw_status check_straight(const pw_tet_input *in, pw_idx k)
{
  const pw_idx *n = in->cell + 10 * (size_t)k;
  for (int i = 0; i < EDGES; i++) {
    pw_real off = 0.0, length = 0.0;
    for (int c = 0; c < 3; c++) {
      pw_real a = coordinate(in, n[edge_ends[i][0]], c), b = coordinate(in, n[edge_ends[i][1]], c);
      pw_real d = coordinate(in, n[4 + i], c) - 0.5 * (a + b);
      off += d * d;
      length += (b - a) * (b - a);
    }
    PW_REQUIRE(off <= straight * straight * length, PW_ERR_ARGUMENT,
               "cell %d: node %d is %g m from the middle of the edge from node %d to node %d",
               (int)k, (int)n[4 + i], sqrt(off), (int)n[edge_ends[i][0]], (int)n[edge_ends[i][1]]);
  }
  return PW_OK;
}

/* 0, 1 or 2: the shortest diagonal, or the one that leans least from an axis (-1: shortest). */
static int choose_diagonal(const pw_tet_input *in, const pw_idx *n, int axis)
{
  int best = 0;
  pw_real least = 0.0;
  for (int k = 0; k < AXES; k++) {
    pw_real length = 0.0, along = 0.0;
    for (int c = 0; c < 3; c++) {
      pw_real d =
          coordinate(in, n[diagonal_ends[k][1]], c) - coordinate(in, n[diagonal_ends[k][0]], c);
      length += d * d;
      along += c == axis ? d * d : 0.0;
    }
    pw_real value = axis < 0 ? length : 1.0 - along / length;
    if (k == 0 || value < least - tie * (axis < 0 ? least : 1.0)) {
      best = k;
      least = value;
    }
  }
  return best;
}

static int diagonal_of(const pw_tet_input *in, const pw_idx *n)
{
  switch (in->diagonal) {
  case PW_TET_DIAGONAL_49:
  case PW_TET_DIAGONAL_57:
  case PW_TET_DIAGONAL_68:
    return (int)in->diagonal - (int)PW_TET_DIAGONAL_49;
  case PW_TET_DIAGONAL_ALONG_X:
  case PW_TET_DIAGONAL_ALONG_Y:
  case PW_TET_DIAGONAL_ALONG_Z:
    return choose_diagonal(in, n, (int)in->diagonal - (int)PW_TET_DIAGONAL_ALONG_X);
  case PW_TET_DIAGONAL_SHORTEST:
    break;
  }
  return choose_diagonal(in, n, -1);
}

/* The eight elements of a ten-node cell as places in the cell. */
static void divide_cell(int diagonal, int (*part)[4])
{
  memcpy(part, corners, sizeof corners);
  for (int k = 0; k < 4; k++) {
    part[4 + k][0] = diagonal_ends[diagonal][0];
    part[4 + k][1] = diagonal_ends[diagonal][1];
    part[4 + k][2] = ring[diagonal][k];
    part[4 + k][3] = ring[diagonal][(k + 1) % 4];
  }
}

static pw_status divide(const pw_tet_input *in, pw_tet_mesh *m, pw_idx *node)
{
  int part[8][4];
  memcpy(part, whole, sizeof whole);
  for (pw_idx k = 0; k < in->ncell; k++) {
    const pw_idx *n = in->cell + (pw_off)k * in->nodes;
    if (m->per == 8) {
      PW_TRY(check_straight(in, k));
      divide_cell(diagonal_of(in, n), part);
    }
    for (pw_idx e = 0; e < m->per; e++) {
      for (int i = 0; i < 4; i++) {
        size_t at = 4 * ((size_t)k * (size_t)m->per + (size_t)e) + (size_t)i;
        node[at] = n[part[e][i]];
        m->local[at] = (int8_t)part[e][i];
      }
    }
  }
  return PW_OK;
}

static pw_status build(const pw_tet_input *in, pw_idx *node, pw_tet_mesh *m)
{
  PW_TRY(divide(in, m, node));
  PW_TRY(pw_tets_create(in->nnode, in->x, m->npatch * m->per, node, &m->tets));
  m->nface = pw_tets_boundary(&m->tets, NULL);
  PW_TRY(pw_mem_alloc("mesh: boundary faces", m->nface, sizeof *m->face, &m->face));
  pw_tets_boundary(&m->tets, m->face);
  PW_TRY(pw_mem_alloc("mesh: coordinates", 3 * (pw_off)in->nnode, sizeof *m->x, &m->x));
  memcpy(m->x, in->x, 3 * (size_t)in->nnode * sizeof *m->x);
  PW_TRY(pw_mem_alloc("mesh: patches", (pw_off)in->ncell * in->nodes, sizeof *m->patch_node,
                      &m->patch_node));
  memcpy(m->patch_node, in->cell, (size_t)in->ncell * (size_t)in->nodes * sizeof *in->cell);
  return PW_OK;
}

pw_status pw_tet_mesh_create(const pw_tet_input *in, pw_tet_mesh *out)
{
  PW_TRY(check_input(in));
  pw_tet_mesh m = {.npatch = in->ncell, .per = in->nodes == 10 ? 8 : 1, .patch_nodes = in->nodes};
  pw_idx *node = NULL;
  pw_off n = 4 * (pw_off)m.npatch * m.per;
  pw_status s = pw_mem_alloc("mesh: elements", n, sizeof *node, &node);
  if (s == PW_OK) {
    s = pw_mem_alloc("mesh: places in patches", n, sizeof *m.local, &m.local);
  }
  if (s == PW_OK) {
    s = build(in, node, &m);
  }
  pw_mem_free(&node);
  if (s != PW_OK) {
    pw_tet_mesh_destroy(&m);
    return s;
  }
  *out = m;
  return PW_OK;
}

pw_status pw_tet_mesh_move(pw_tet_mesh *m, const pw_real *map, const pw_real *shift)
{
  const size_t n = (size_t)m->tets.nnode;
  const pw_real *start = m->tets.x;
  pw_real back[9], det = 0.0;
  for (int i = 0; i < 3; i++) { /* cofactors */
    for (int j = 0; j < 3; j++) {
      const pw_real *a = map + 3 * ((j + 1) % 3), *b = map + 3 * ((j + 2) % 3);
      back[3 * i + j] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
    det += map[i] * back[3 * i];
  }
  PW_REQUIRE(det > 0.0 && isfinite(det), PW_ERR_ARGUMENT,
             "a motion of the mesh that multiplies volumes by %g", det);
  for (int i = 0; i < 9; i++) {
    m->motion.back[i] = back[i] / det;
    m->motion.map[i] = map[i];
  }
  memcpy(m->motion.shift, shift, sizeof m->motion.shift);
  m->motion.moved = true;
  for (int c = 0; c < 3; c++) {
    for (size_t a = 0; a < n; a++) {
      m->x[(size_t)c * n + a] = map[3 * c] * start[a] + map[3 * c + 1] * start[n + a] +
                                map[3 * c + 2] * start[2 * n + a] + shift[c];
    }
  }
  return PW_OK;
}

void pw_tet_mesh_gradients(const pw_tet_mesh *m, pw_idx e, pw_real *gradient)
{
  const pw_real *b = m->motion.back;
  for (int i = 0; i < 4; i++) {
    const pw_real *g = m->tets.inverse + 16 * (size_t)e + 4 * i;
    for (int c = 0; c < 3; c++) {
      gradient[3 * i + c] =
          m->motion.moved ? b[c] * g[0] + b[3 + c] * g[1] + b[6 + c] * g[2] : g[c];
    }
  }
}

void pw_rotation_about(const pw_real *axis, pw_real angle, pw_real *rot)
{
  pw_real length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  pw_real n[3] = {axis[0] / length, axis[1] / length, axis[2] / length};
  pw_real s = sin(angle), half = sin(0.5 * angle), d = 2.0 * half * half;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      rot[3 * i + j] = d * n[i] * n[j] + (i == j ? 1.0 - d : 0.0);
    }
    rot[3 * i + (i + 1) % 3] -= s * n[(i + 2) % 3];
    rot[3 * i + (i + 2) % 3] += s * n[(i + 1) % 3];
  }
}
