/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/interface_search.h"

#include <math.h>

#include "engine/core/mem.h"

/* Square of the distance of x from segment s; place: 0 inside, -1 at its first node, 1 at its
 * second. */
static pw_real distance2(const pw_interface *line, pw_idx s, const pw_real *x, int *place)
{
  const pw_real *a = line->node[s].x, *b = line->node[pw_interface_next(line, s)].x;
  pw_real tx = b[0] - a[0], ty = b[1] - a[1], dx = x[0] - a[0], dy = x[1] - a[1];
  pw_real along = dx * tx + dy * ty, l2 = tx * tx + ty * ty;
  if (along <= 0.0) {
    *place = -1;
    return dx * dx + dy * dy;
  }
  if (along >= l2) {
    *place = 1;
    dx -= tx;
    dy -= ty;
    return dx * dx + dy * dy;
  }
  pw_real cross = tx * dy - ty * dx;
  *place = 0;
  return cross * cross / l2;
}

/* Segment on the other side of an end of s; -1 at the free end of a line. */
static pw_idx neighbour(const pw_interface *line, pw_idx s, int place)
{
  pw_idx count = pw_interface_segments(line), k = s + place;
  if (k < 0 || k >= count) {
    return line->closed ? (k < 0 ? count - 1 : 0) : -1;
  }
  return k;
}

static void segment_normal(const pw_interface *line, pw_idx s, pw_real *n)
{
  const pw_real *a = line->node[s].x, *b = line->node[pw_interface_next(line, s)].x;
  pw_real tx = b[0] - a[0], ty = b[1] - a[1], inv = 1.0 / sqrt(tx * tx + ty * ty);
  n[0] = ty * inv;
  n[1] = -tx * inv;
}

/* Sum of the normals on both sides of an end of s; false at the free end of a line. On the axis of
 * symmetry the other side is the mirror image. */
static bool vertex_normal(const pw_interface *line, pw_idx s, int place, pw_real *n)
{
  pw_idx other = neighbour(line, s, place);
  pw_idx end = place < 0 ? s : pw_interface_next(line, s);
  pw_real m[2] = {0.0, 0.0};
  segment_normal(line, s, n);
  if (other >= 0) {
    segment_normal(line, other, m);
  } else if (line->node[end].axis) {
    m[0] = -n[0];
    m[1] = n[1];
  } else {
    return false;
  }
  n[0] += m[0];
  n[1] += m[1];
  return true;
}

/* The slave is nearest to an end of s. */
static void at_vertex(const pw_interface *line, pw_idx s, const pw_real *x, int place,
                      pw_pair *pair)
{
  pw_idx end = place < 0 ? s : pw_interface_next(line, s);
  pw_real d[2] = {x[0] - line->node[end].x[0], x[1] - line->node[end].x[1]}, n[2], sum[2];
  pw_real r = sqrt(d[0] * d[0] + d[1] * d[1]), length = pair->lever;
  segment_normal(line, s, n);
  pair->xi = place < 0 ? 0.0 : 1.0;
  if (!vertex_normal(line, s, place, sum)) {
    pair->gap = r; /* beyond the free end of a line nothing is inside */
    return;
  }
  bool inside = d[0] * sum[0] + d[1] * sum[1] < 0.0;
  pair->gap = inside ? -r : r;
  if (r > 1e-9 * length) {
    pair->n[0] = d[0] / pair->gap;
    pair->n[1] = d[1] / pair->gap;
    pair->t[0] = -pair->n[1];
    pair->t[1] = pair->n[0];
  }
  /* The couple P acts along n at nodes of the segment: its arm is the segment seen along t. */
  pw_real cosine = pair->n[0] * n[0] + pair->n[1] * n[1];
  pair->lever = length * pw_max(cosine, 0.1);
}

void pw_interface_closest(const pw_interface *line, pw_idx s, const pw_real *x, pw_pair *pair)
{
  int place;
  distance2(line, s, x, &place);
  *pair = pw_pair_project(x, line->node[s].x, line->node[pw_interface_next(line, s)].x);
  if (place != 0) {
    at_vertex(line, s, x, place, pair);
  }
}

pw_idx pw_interface_track(const pw_interface *master, pw_idx owner, const pw_real *x, pw_pair *pair)
{
  int place;
  pw_real best = distance2(master, owner, x, &place);
  for (pw_idx step = 0; step < pw_interface_segments(master); step++) {
    pw_idx from = owner;
    for (int side = -1; side <= 1; side += 2) {
      pw_idx k = neighbour(master, from, side);
      pw_real d2 = k >= 0 ? distance2(master, k, x, &place) : best;
      /* The margin keeps a slave half-way between two segments with the one it belongs to. */
      if (d2 < best * (1.0 - 1e-9)) {
        best = d2;
        owner = k;
      }
    }
    if (owner == from) {
      break;
    }
  }
  pw_interface_closest(master, owner, x, pair);
  return owner;
}

enum { CELLS = 6 /* bins per segment; one of at most a cell's length passes four */ };

static pw_status allocate(pw_segment_bins *bins)
{
  PW_TRY(pw_mem_alloc("segment bins", bins->ncell, sizeof(pw_idx), &bins->head));
  PW_TRY(pw_mem_alloc("segment bins", bins->ncell, sizeof(pw_idx), &bins->touched));
  PW_TRY(pw_mem_alloc("segment bins", bins->capacity, sizeof(pw_idx), &bins->next));
  PW_TRY(pw_mem_alloc("segment bins", bins->capacity, sizeof(pw_idx), &bins->segment));
  return pw_mem_alloc("segment bins", bins->capacity, sizeof(pw_idx), &bins->cell);
}

pw_status pw_bins_create(const pw_interface *line, const pw_mesh *mesh, pw_segment_bins *out)
{
  pw_segment_bins bins = {.ncell = mesh->nnode,
                          .row = mesh->nodes[0],
                          .rows = mesh->nodes[1],
                          .capacity = CELLS * line->capacity};
  pw_status status = allocate(&bins);
  if (status != PW_OK) {
    pw_bins_destroy(&bins);
    return status;
  }
  for (pw_idx c = 0; c < bins.ncell; c++) {
    bins.head[c] = -1;
  }
  *out = bins;
  return PW_OK;
}

void pw_bins_destroy(pw_segment_bins *bins)
{
  pw_mem_free(&bins->head);
  pw_mem_free(&bins->touched);
  pw_mem_free(&bins->next);
  pw_mem_free(&bins->segment);
  pw_mem_free(&bins->cell);
  *bins = (pw_segment_bins){0};
}

static void put(pw_segment_bins *bins, pw_idx cell, pw_idx segment)
{
  pw_idx e = bins->used;
  if (e < bins->capacity) {
    bins->segment[e] = segment;
    bins->cell[e] = cell;
    bins->next[e] = bins->head[cell];
    bins->head[cell] = e;
    bins->used++;
  }
}

/* Every cell of the box around a segment. */
static void put_segment(pw_segment_bins *bins, pw_idx s, pw_idx a, pw_idx b)
{
  pw_idx low = a < b ? a : b, high = a < b ? b : a;
  pw_idx rows = 0, columns = high - low;
  while (columns > bins->row / 2) { /* cells are numbered row by row */
    columns -= bins->row;
    rows++;
  }
  pw_idx first = columns < 0 ? low + columns : low;
  columns = columns < 0 ? -columns : columns;
  for (pw_idx j = 0; j <= rows; j++) {
    for (pw_idx i = 0; i <= columns; i++) {
      put(bins, first + j * bins->row + i, s);
    }
  }
}

void pw_bins_fill(pw_segment_bins *bins, const pw_interface *line)
{
  for (pw_idx e = 0; e < bins->used; e++) {
    bins->head[bins->cell[e]] = -1;
  }
  bins->used = 0;
  bins->stamp++;
  for (pw_idx k = 0; k < line->n; k++) {
    pw_idx first = line->node[k].node;
    bins->touched[first] = bins->touched[first + 1] = bins->stamp;
    bins->touched[first + bins->row] = bins->touched[first + bins->row + 1] = bins->stamp;
  }
  for (pw_idx s = 0; s < pw_interface_segments(line); s++) {
    put_segment(bins, s, line->node[s].node, line->node[pw_interface_next(line, s)].node);
  }
}

bool pw_bins_near(const pw_segment_bins *bins, pw_idx first)
{
  const pw_idx *t = bins->touched + first;
  return t[0] == bins->stamp || t[1] == bins->stamp || t[bins->row] == bins->stamp ||
         t[bins->row + 1] == bins->stamp;
}

pw_idx pw_bins_nearest(const pw_segment_bins *bins, const pw_interface *master, pw_real reach,
                       pw_idx cell, const pw_real *x)
{
  if (!pw_bins_near(bins, cell)) {
    return -1;
  }
  pw_idx owner = -1;
  pw_real best = reach * reach;
  for (int i = 0; i < 9; i++) {
    pw_idx near = cell + (i / 3 - 1) * bins->row + (i % 3 - 1);
    for (pw_idx e = near >= 0 && near < bins->ncell ? bins->head[near] : -1; e >= 0;
         e = bins->next[e]) {
      int place;
      pw_idx s = bins->segment[e];
      pw_real d2 = distance2(master, s, x, &place);
      if (d2 < best || (d2 == best && owner >= 0 && s < owner)) {
        best = d2;
        owner = s;
      }
    }
  }
  return owner;
}

pw_idx pw_bins_detect(const pw_segment_bins *bins, const pw_interface *master, pw_real reach,
                      const pw_interface_node *slave, pw_pair *pair)
{
  pw_idx owner = pw_bins_nearest(bins, master, reach, slave->node, slave->x);
  if (owner < 0) {
    return -1;
  }
  pw_interface_closest(master, owner, slave->x, pair);
  return pair->gap < 0.0 ? owner : -1;
}
