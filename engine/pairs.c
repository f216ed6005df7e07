/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/pairs.h"

/* Rows of nodes that others hang on: the first is row 0 of the pairs, the last ends them. */
static pw_idx kept_rows(const pw_mesh *m)
{
  return (m->pair_row[1] - m->pair_row[0]) / 2 + 1;
}

static pw_real *record(const pw_sim *sim, pw_idx i, pw_idx j)
{
  return sim->nodes.rec + ((pw_off)j * sim->mesh.nodes[0] + i) * PW_NODE;
}

void pw_pairs_use(pw_sim *sim)
{
  const pw_mesh *m = &sim->mesh;
  for (pw_idx j = m->pair_row[0]; pw_pairs_on(sim) && j <= m->pair_row[1]; j++) {
    pw_nodes_use(&sim->nodes, 0, j * m->nodes[0] + m->pair_column, m->nodes[0] - m->pair_column);
  }
}

/* Each kept row takes from those below and above it, which it shares with its neighbours: they are
 * cleared afterwards, by the row below them. */
void pw_pairs_collect(pw_sim *sim, int slot, int n)
{
  const pw_mesh *m = &sim->mesh;
  const pw_idx rows = kept_rows(m);
#pragma omp parallel default(none) shared(sim, m, rows, slot, n) num_threads(sim->threads)
  {
#pragma omp for schedule(static)
    for (pw_idx k = 0; k < rows; k++) {
      const pw_idx j = m->pair_row[0] + 2 * k;
      for (pw_idx i = m->pair_column; i < m->nodes[0]; i++) {
        pw_real *to = record(sim, i, j) + slot;
        for (int c = 0; c < n; c++) {
          to[c] += (k > 0 ? 0.5 * record(sim, i, j - 1)[slot + c] : 0.0) +
                   (k < rows - 1 ? 0.5 * record(sim, i, j + 1)[slot + c] : 0.0);
        }
      }
    }
#pragma omp for schedule(static)
    for (pw_idx k = 0; k < rows - 1; k++) {
      for (pw_idx i = m->pair_column; i < m->nodes[0]; i++) {
        pw_real *hanging = record(sim, i, m->pair_row[0] + 2 * k + 1) + slot;
        for (int c = 0; c < n; c++) {
          hanging[c] = 0.0;
        }
      }
    }
  }
}

void pw_pairs_spread(pw_sim *sim, int slot, int n)
{
  const pw_mesh *m = &sim->mesh;
  const pw_idx pairs = kept_rows(m) - 1;
#pragma omp parallel for default(none) shared(sim, m, pairs, slot, n) num_threads(sim->threads)    \
    schedule(static)
  for (pw_idx k = 0; k < pairs; k++) {
    const pw_idx j = m->pair_row[0] + 2 * k + 1;
    for (pw_idx i = m->pair_column; i < m->nodes[0]; i++) {
      const pw_real *below = record(sim, i, j - 1) + slot, *above = record(sim, i, j + 1) + slot;
      pw_real *hanging = record(sim, i, j) + slot;
      for (int c = 0; c < n; c++) {
        hanging[c] = 0.5 * (below[c] + above[c]);
      }
    }
  }
}
