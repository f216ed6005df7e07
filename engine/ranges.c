/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/ranges.h"

#include "engine/pairs.h"
#include "engine/rates.h"
#include "partition/share.h"

/* What gather, deformation and domain of a point cost, in evaluations of the sand's rates. */
enum { POINT_WORK = 2 };

static pw_idx points_of(const pw_blocks *b, pw_idx block)
{
  const pw_idx *start = b->point_start + (pw_off)block * b->nbody;
  return start[b->nbody] - start[0];
}

void pw_ranges_balance(pw_sim *sim)
{
  pw_blocks *b = &sim->blocks;
  for (pw_idx k = 0; k < b->nblock; k++) {
    b->share_size[k] = points_of(b, k);
    b->share_work[k] = POINT_WORK * b->share_size[k] + sim->sums[k].material.rhs;
  }
  pw_share_balance(b);
}

static void clear_empty(pw_sim *sim)
{
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
    if (points_of(&sim->blocks, k) == 0) {
      sim->sums[k] = (pw_block_sums){.bad = -1, .weights = {-1, -1, -1, 0}};
    }
  }
}

/* Nodes of field f within reach of an element. */
static void use_support(const pw_blocks *b, pw_idx elem, int f, pw_nodes *nodes)
{
  const pw_idx row = b->cells[0] + 1, i = elem % b->cells[0], j = elem / b->cells[0];
  const pw_idx left = i > b->reach ? i - b->reach : 0;
  const pw_idx right = i + 1 + b->reach < b->cells[0] ? i + 1 + b->reach : b->cells[0];
  for (pw_idx y = j > b->reach ? j - b->reach : 0; y <= j + 1 + b->reach && y <= b->cells[1]; y++) {
    pw_nodes_use(nodes, f, y * row + left, right - left + 1);
  }
}

void pw_ranges_use(const pw_sim *sim, pw_idx block, pw_nodes *nodes)
{
  const pw_blocks *b = &sim->blocks;
  const pw_idx *home = sim->points.home;
  for (int body = 0; body < b->nbody; body++) {
    const pw_idx *start = b->point_start + (pw_off)block * b->nbody + body;
    for (pw_idx k = start[0]; k < start[1]; k++) {
      if (k == start[0] || home[k] != home[k - 1]) { /* neighbours mostly share an element */
        use_support(b, home[k], sim->body[body].field, nodes);
      }
    }
  }
}

static void use_nodes(pw_sim *sim)
{
  pw_nodes_reset(&sim->nodes);
  for (pw_idx l = 0; l < sim->blocks.nblock; l++) { /* so that a thread's nodes lie at its blocks */
    pw_ranges_use(sim, sim->blocks.share_line[l], &sim->nodes);
  }
  pw_pairs_use(sim);
}

void pw_ranges_renew(pw_sim *sim)
{
  clear_empty(sim);
  use_nodes(sim);
  pw_ranges_balance(sim);
  if (sim->rates) {
    pw_rates_renew(sim);
  }
}
