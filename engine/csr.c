/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/csr.h"

#include <string.h>

#include "engine/core/mem.h"

void pw_csr_destroy(pw_csr *m)
{
  pw_mem_free(&m->start);
  pw_mem_free(&m->col);
  pw_mem_free(&m->value);
  pw_mem_free(&m->node_start);
  pw_mem_free(&m->node_col);
  pw_mem_free(&m->place);
  pw_mem_free(&m->pair);
  memset(m, 0, sizeof *m);
}

static void sort(pw_idx *list, pw_idx n)
{
  for (pw_idx i = 1; i < n; i++) {
    pw_idx v = list[i], k = i;
    for (; k > 0 && list[k - 1] > v; k--) {
      list[k] = list[k - 1];
    }
    list[k] = v;
  }
}

/* The node behind the face of element e that is opposite its node a, or -1. */
static pw_idx node_beyond(const pw_tets *t, pw_idx e, pw_idx a)
{
  const pw_idx *own = t->node + 4 * (size_t)e;
  int f = 0;
  while (own[f] != a) {
    f++;
  }
  const pw_idx other = t->beside[4 * (size_t)e + (size_t)f];
  for (size_t i = 0; other >= 0 && i < 4; i++) {
    if (t->beside[4 * (size_t)other + i] == e) {
      return t->node[4 * (size_t)other + i];
    }
  }
  return -1;
}

/* Nodes that couple with node a; written to list unless it is NULL. seen [nnode] holds the last
 * node, plus 1, that met a node. */
static pw_idx nodes_beside(const pw_tet_mesh *mesh, int coupled, pw_idx a, pw_idx *seen,
                           pw_idx *list)
{
  const pw_tets *t = &mesh->tets;
  const bool whole = (coupled & PW_CSR_PATCHES) != 0;
  pw_idx n = 0;
  for (pw_idx l = t->node_start[a]; l < t->node_start[a + 1]; l++) {
    pw_idx e = t->node_elem[l], p = e / mesh->per, beyond = node_beyond(t, e, a);
    const pw_idx *near = whole ? mesh->patch_node + p * mesh->patch_nodes : t->node + 4 * e;
    const pw_idx count = whole ? mesh->patch_nodes : 4;
    for (pw_idx i = 0; i < count + ((coupled & PW_CSR_FACES) != 0 && beyond >= 0); i++) {
      const pw_idx b = i < count ? near[i] : beyond;
      if (seen[b] != a + 1) {
        seen[b] = a + 1;
        if (list) {
          list[n] = b;
        }
        n++;
      }
    }
  }
  if (list) {
    sort(list, n);
  }
  return n;
}

static pw_status list_pairs(const pw_tet_mesh *mesh, int coupled, pw_csr *m, pw_idx *seen)
{
  for (pw_idx a = 0; a < m->nnode; a++) {
    m->node_start[a + 1] = m->node_start[a] + nodes_beside(mesh, coupled, a, seen, NULL);
  }
  pw_off n = m->node_start[m->nnode];
  PW_TRY(pw_mem_alloc("matrix: coupled nodes", n, sizeof *m->node_col, &m->node_col));
  PW_TRY(pw_mem_alloc("matrix: places", n, sizeof *m->place, &m->place));
  memset(seen, 0, (size_t)m->nnode * sizeof *seen);
  for (pw_idx a = 0; a < m->nnode; a++) {
    nodes_beside(mesh, coupled, a, seen, m->node_col + m->node_start[a]);
  }
  return PW_OK;
}

/* Index of node b among those that couple with node a, or -1. */
static pw_idx find_pair(const pw_csr *m, pw_idx a, pw_idx b)
{
  const pw_idx *list = m->node_col + m->node_start[a];
  pw_idx low = 0, high = (pw_idx)(m->node_start[a + 1] - m->node_start[a]);
  while (low < high) {
    pw_idx middle = (low + high) / 2;
    if (list[middle] < b) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low < m->node_start[a + 1] - m->node_start[a] && list[low] == b ? low : -1;
}

static void tabulate_pairs(const pw_tet_mesh *mesh, pw_csr *m)
{
  const pw_idx n = mesh->patch_nodes;
  for (pw_idx p = 0; p < mesh->npatch; p++) {
    const pw_idx *node = mesh->patch_node + p * n;
    for (pw_idx i = 0; i < n * n; i++) {
      m->pair[(pw_off)p * n * n + i] = find_pair(m, node[i / n], node[i % n]);
    }
  }
}

static pw_status build(const pw_tet_mesh *mesh, int coupled, pw_csr *m)
{
  pw_idx *seen = NULL;
  pw_off n = m->nnode, pairs = (pw_off)mesh->npatch * mesh->patch_nodes * mesh->patch_nodes;
  PW_TRY(pw_mem_alloc("matrix: node offsets", n + 1, sizeof *m->node_start, &m->node_start));
  PW_TRY(pw_mem_alloc("matrix: marks", n, sizeof *seen, &seen));
  pw_status s = list_pairs(mesh, coupled, m, seen);
  pw_mem_free(&seen);
  PW_TRY(s);
  PW_TRY(pw_mem_alloc("matrix: pairs in patches", pairs, sizeof *m->pair, &m->pair));
  tabulate_pairs(mesh, m);
  pw_off room = 9 * m->node_start[m->nnode];
  PW_TRY(pw_mem_alloc("matrix: row offsets", 3 * n + 1, sizeof *m->start, &m->start));
  PW_TRY(pw_mem_alloc("matrix: columns", room, sizeof *m->col, &m->col));
  return pw_mem_alloc("matrix: values", room, sizeof *m->value, &m->value);
}

pw_status pw_csr_create(const pw_tet_mesh *mesh, int coupled, pw_csr *out)
{
  pw_csr m = {
      .nnode = mesh->tets.nnode, .patch_nodes = mesh->patch_nodes, .patch_node = mesh->patch_node};
  pw_status s = build(mesh, coupled, &m);
  if (s != PW_OK) {
    pw_csr_destroy(&m);
    return s;
  }
  *out = m;
  return PW_OK;
}

/* Columns of the rows of node a; returns how many. */
static pw_idx fill_columns(pw_csr *m, pw_idx a, pw_idx *col)
{
  const size_t n = (size_t)m->nnode;
  pw_idx count = 0;
  for (pw_off l = m->node_start[a]; l < m->node_start[a + 1]; l++) {
    m->place[l] = count;
    for (size_t c = 0; c < 3; c++) {
      pw_idx eq = m->equation[c * n + (size_t)m->node_col[l]];
      if (eq >= 0) {
        col[count++] = eq;
      }
    }
  }
  return count;
}

void pw_csr_number(pw_csr *m, const pw_idx *equation, pw_idx n)
{
  pw_off at = 0;
  m->equation = equation;
  m->n = n;
  m->revision++;
  for (pw_idx a = 0; a < m->nnode; a++) {
    pw_idx count = -1, *first = m->col + at;
    for (size_t c = 0; c < 3; c++) {
      pw_idx eq = equation[c * (size_t)m->nnode + (size_t)a];
      if (eq < 0) {
        continue;
      }
      if (count < 0) {
        count = fill_columns(m, a, first);
      } else {
        memcpy(m->col + at, first, (size_t)count * sizeof *first);
      }
      m->start[eq] = at;
      at += count;
    }
  }
  m->start[n] = at;
}

void pw_csr_clear(pw_csr *m, int part, int parts)
{
  const pw_off first = m->start[m->n] * part / parts, end = m->start[m->n] * (part + 1) / parts;
  memset(m->value + first, 0, (size_t)(end - first) * sizeof *m->value);
}

void pw_csr_add(pw_csr *m, pw_idx patch, const pw_real *k)
{
  const pw_idx np = m->patch_nodes, *node = m->patch_node + patch * np;
  const pw_idx *pair = m->pair + (pw_off)patch * np * np;
  pw_idx eq[PW_PATCH_NODES][3];
  for (pw_idx a = 0; a < np; a++) {
    for (pw_idx c = 0; c < 3; c++) {
      eq[a][c] = m->equation[(size_t)c * (size_t)m->nnode + (size_t)node[a]];
    }
  }
  for (pw_idx a = 0; a < np; a++) {
    for (pw_idx b = 0; b < np; b++) {
      if (pair[np * a + b] < 0) {
        continue;
      }
      pw_idx place = m->place[m->node_start[node[a]] + pair[np * a + b]];
      for (pw_idx i = 0; i < 3; i++) {
        if (eq[a][i] < 0) {
          continue;
        }
        pw_real *v = m->value + m->start[eq[a][i]] + place;
        for (pw_idx j = 0; j < 3; j++) {
          if (eq[b][j] >= 0) {
            *v++ += k[PW_PATCH_DOFS * (3 * a + i) + 3 * b + j];
          }
        }
      }
    }
  }
}

void pw_csr_add_nodes(pw_csr *m, pw_idx count, const pw_idx *node, const pw_real *k)
{
  const size_t n = (size_t)m->nnode;
  for (pw_idx ab = 0; ab < count * count; ab++) {
    const pw_idx a = node[ab / count], b = node[ab % count];
    pw_idx place = m->place[m->node_start[a] + find_pair(m, a, b)];
    for (size_t c = 0; c < 3; c++) {
      const pw_idx row = m->equation[c * n + (size_t)a], col = m->equation[c * n + (size_t)b];
      if (row >= 0 && col >= 0) {
        m->value[m->start[row] + place] += k[ab];
      }
      place += col >= 0;
    }
  }
}

void pw_csr_multiply(const pw_csr *m, const pw_real *x, pw_real *y)
{
  for (pw_idx i = 0; i < m->n; i++) {
    pw_real sum = 0.0;
    for (pw_off k = m->start[i]; k < m->start[i + 1]; k++) {
      sum += m->value[k] * x[m->col[k]];
    }
    y[i] = sum;
  }
}
