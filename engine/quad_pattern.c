/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/quad_pattern.h"

#include <string.h>

#include "engine/core/mem.h"
#include "kernels/transfer.h"

void pw_quad_pattern_destroy(pw_quad_pattern *p, pw_csr *csr)
{
  pw_mem_free(&p->mark);
  pw_mem_free(&p->before);
  pw_mem_free(&p->place);
  pw_mem_free(&csr->start);
  pw_mem_free(&csr->col);
  pw_mem_free(&csr->value);
  memset(p, 0, sizeof *p);
  memset(csr, 0, sizeof *csr);
}

static pw_off pairs(const pw_quad_pattern *p)
{
  return (pw_off)p->nnode * p->width * p->width;
}

pw_status pw_quad_pattern_create(pw_idx row, pw_idx nnode, pw_idx span, pw_quad_pattern *out,
                                 pw_csr *csr)
{
  *out = (pw_quad_pattern){.row = row, .nnode = nnode, .span = span, .width = 2 * span + 1};
  *csr = (pw_csr){.nnode = nnode};
  PW_TRY(pw_mem_alloc("matrix: coupled nodes", pairs(out), 1, &out->mark));
  PW_TRY(pw_mem_alloc("matrix: coupled before", pairs(out), 1, &out->before));
  PW_TRY(pw_mem_alloc("matrix: places", pairs(out), sizeof *out->place, &out->place));
  return pw_mem_alloc("matrix: row offsets", 2 * (pw_off)nnode + 1, sizeof *csr->start,
                      &csr->start);
}

void pw_quad_pattern_clear(pw_quad_pattern *p)
{
  memset(p->mark, 0, (size_t)pairs(p));
}

void pw_quad_pattern_mark(pw_quad_pattern *p, int n, const pw_idx *node)
{
  pw_idx i[PW_SUPPORT], j[PW_SUPPORT];
  for (int a = 0; a < n; a++) {
    pw_quad_pattern_at(p, node[a], &i[a], &j[a]);
  }
  for (int a = 0; a < n; a++) {
    for (int b = 0; b < n; b++) {
      p->mark[pw_quad_pattern_pair(p, node[a], i[b] - i[a], j[b] - j[a])] = 1;
    }
  }
}

static bool has_equation(const pw_csr *csr, pw_off node)
{
  return csr->equation[node] >= 0 || csr->equation[csr->nnode + node] >= 0;
}

/* Columns of the rows of node a, counted or, when there is room, filled; ascending. */
static pw_idx columns(const pw_quad_pattern *p, const pw_csr *csr, pw_idx a, pw_idx *col)
{
  const pw_off size = (pw_off)p->width * p->width, first = a * size;
  pw_idx count = 0;
  for (pw_off l = 0; l < size; l++) {
    if (!p->mark[first + l]) {
      continue;
    }
    const pw_off b = a + (l / p->width - p->span) * p->row + l % p->width - p->span;
    p->place[first + l] = count;
    for (pw_off c = 0; c < 2; c++) {
      const pw_idx eq = csr->equation[c * csr->nnode + b];
      if (eq >= 0) {
        if (col) {
          col[count] = eq;
        }
        count++;
      }
    }
  }
  return count;
}

/* Offsets of the rows; returns the number of values. */
static pw_off count_rows(const pw_quad_pattern *p, pw_csr *csr)
{
  pw_off at = 0;
  for (pw_idx a = 0; a < p->nnode; a++) {
    const pw_idx count = has_equation(csr, a) ? columns(p, csr, a, NULL) : 0;
    for (pw_off c = 0; c < 2; c++) {
      const pw_idx eq = csr->equation[c * csr->nnode + a];
      if (eq >= 0) {
        csr->start[eq] = at;
        at += count;
      }
    }
  }
  csr->start[csr->n] = at;
  return at;
}

static pw_status make_room(pw_quad_pattern *p, pw_csr *csr, pw_off values)
{
  if (values <= p->room) {
    return PW_OK;
  }
  p->room = 0;
  pw_mem_free(&csr->col);
  pw_mem_free(&csr->value);
  const pw_off room = values + values / 4;
  PW_TRY(pw_mem_alloc("matrix: columns", room, sizeof *csr->col, &csr->col));
  PW_TRY(pw_mem_alloc("matrix: values", room, sizeof *csr->value, &csr->value));
  p->room = room;
  return PW_OK;
}

pw_status pw_quad_pattern_number(pw_quad_pattern *p, pw_csr *csr, const pw_idx *equation, pw_idx n,
                                 bool changed)
{
  if (!changed && csr->revision > 0 && memcmp(p->mark, p->before, (size_t)pairs(p)) == 0) {
    return PW_OK;
  }
  csr->equation = equation;
  csr->n = n;
  csr->revision++;
  PW_TRY(make_room(p, csr, count_rows(p, csr)));
  for (pw_idx a = 0; a < p->nnode; a++) {
    for (pw_off c = 0; c < 2; c++) {
      const pw_idx eq = equation[c * csr->nnode + a];
      if (eq >= 0) {
        columns(p, csr, a, csr->col + csr->start[eq]);
      }
    }
  }
  memcpy(p->before, p->mark, (size_t)pairs(p));
  return PW_OK;
}

void pw_quad_pattern_add(const pw_quad_pattern *p, pw_csr *csr, int n, const pw_idx *node,
                         const pw_real *k)
{
  pw_idx i[PW_SUPPORT], j[PW_SUPPORT], eq[PW_SUPPORT][2];
  for (int a = 0; a < n; a++) {
    pw_quad_pattern_at(p, node[a], &i[a], &j[a]);
    eq[a][0] = csr->equation[node[a]];
    eq[a][1] = csr->equation[csr->nnode + node[a]];
  }
  for (int ac = 0; ac < 2 * n; ac++) {
    const int a = ac / 2;
    if (eq[a][ac % 2] < 0) {
      continue;
    }
    pw_real *row = csr->value + csr->start[eq[a][ac % 2]];
    for (int b = 0; b < n; b++) {
      pw_real *v = row + p->place[pw_quad_pattern_pair(p, node[a], i[b] - i[a], j[b] - j[a])];
      for (int c = 0; c < 2; c++) {
        if (eq[b][c] >= 0) {
          *v++ += k[2 * n * ac + 2 * b + c];
        }
      }
    }
  }
}
