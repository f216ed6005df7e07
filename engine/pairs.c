/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/pairs.h"

/* Rows of nodes that others hang on: the first is row 0 of the pairs, the last ends them. */
static pw_idx kept_rows(const pw_mesh *m)
{
  return (m->pair_row[1] - m->pair_row[0]) / 2 + 1;
}

/* Records of row j of field f, from the first column of pairs on: *n of them. */
static pw_real *row_of(const pw_sim *sim, int f, pw_idx j, pw_idx *n)
{
  const pw_mesh *m = &sim->mesh;
  *n = m->nodes[0] - m->pair_column;
  return pw_nodes_field(&sim->nodes, f) + ((pw_off)j * m->nodes[0] + m->pair_column) * PW_NODE;
}

void pw_pairs_use(pw_sim *sim)
{
  const pw_mesh *m = &sim->mesh;
  for (pw_idx j = m->pair_row[0]; pw_pairs_on(sim) && j <= m->pair_row[1]; j++) {
    for (int f = 0; f < sim->nodes.nfield; f++) {
      pw_nodes_use(&sim->nodes, f, j * m->nodes[0] + m->pair_column, m->nodes[0] - m->pair_column);
    }
  }
}

/* A kept row takes from those below and above it. */
static void take(const pw_sim *sim, int f, pw_idx j, int slot, int n)
{
  const pw_mesh *m = &sim->mesh;
  const pw_off row = (pw_off)m->nodes[0] * PW_NODE;
  pw_idx count;
  pw_real *to = row_of(sim, f, j, &count) + slot;
  for (pw_idx i = 0; i < count; i++, to += PW_NODE) {
    for (int c = 0; c < n; c++) {
      to[c] += (j > m->pair_row[0] ? 0.5 * to[c - row] : 0.0) +
               (j < m->pair_row[1] ? 0.5 * to[c + row] : 0.0);
    }
  }
}

static void clear(const pw_sim *sim, int f, pw_idx j, int slot, int n)
{
  pw_idx count;
  pw_real *at = row_of(sim, f, j, &count) + slot;
  for (pw_idx i = 0; i < count; i++, at += PW_NODE) {
    for (int c = 0; c < n; c++) {
      at[c] = 0.0;
    }
  }
}

static void spread(const pw_sim *sim, int f, pw_idx j, int slot, int n)
{
  const pw_off row = (pw_off)sim->mesh.nodes[0] * PW_NODE;
  pw_idx count;
  pw_real *at = row_of(sim, f, j, &count) + slot;
  for (pw_idx i = 0; i < count; i++, at += PW_NODE) {
    for (int c = 0; c < n; c++) {
      at[c] = 0.5 * (at[c - row] + at[c + row]);
    }
  }
}

/* Neighbouring kept rows share a hanging one, which is cleared when both have taken. From the top
 * down: with one field that is how the nodes are given to the threads (pw_nodes_part). */
void pw_pairs_collect(pw_sim *sim, int slot, int n)
{
  const pw_idx rows = kept_rows(&sim->mesh), first = sim->mesh.pair_row[0];
  const int fields = sim->nodes.nfield;
#pragma omp parallel default(none) shared(sim, rows, first, fields, slot, n)                       \
    num_threads(sim->threads)
  {
#pragma omp for schedule(static)
    for (pw_idx k = rows * fields - 1; k >= 0; k--) {
      take(sim, k / rows, first + 2 * (k % rows), slot, n);
    }
#pragma omp for schedule(static)
    for (pw_idx k = (rows - 1) * fields - 1; k >= 0; k--) {
      clear(sim, k / (rows - 1), first + 2 * (k % (rows - 1)) + 1, slot, n);
    }
  }
}

void pw_pairs_spread(pw_sim *sim, int slot, int n)
{
  const pw_idx pairs = kept_rows(&sim->mesh) - 1, first = sim->mesh.pair_row[0];
  const int fields = sim->nodes.nfield;
#pragma omp parallel for default(none) shared(sim, pairs, first, fields, slot, n)                  \
    num_threads(sim->threads) schedule(static)
  for (pw_idx k = pairs * fields - 1; k >= 0; k--) {
    spread(sim, k / pairs, first + 2 * (k % pairs) + 1, slot, n);
  }
}
