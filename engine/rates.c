/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/rates.h"

#include "engine/assemble.h"
#include "engine/core/mem.h"
#include "engine/fbar.h"
#include "engine/ranges.h"
#include "engine/update.h"
#include "partition/share.h"

/* Cycles between divisions of the blocks among the threads. */
enum { REBALANCE = 16 };

/* A block rises by a level when its longer step would keep this part of the margin. */
static const pw_real RISE = 0.95;

int pw_rates_cycle(const pw_sim *sim)
{
  return sim->rates ? 1 << sim->rates->levels : 1;
}

pw_status pw_rates_create(pw_sim *sim)
{
  pw_rates *r;
  const pw_idx nblock = sim->blocks.nblock;
  PW_TRY(pw_mem_alloc("rates", 1, sizeof *r, &r));
  sim->rates = r;
  while ((2 << r->levels) <= sim->scene.method.step_ratio_max && r->levels < PW_MAX_LEVELS) {
    r->levels++;
  }
  r->begun = r->done = r->levels;
  r->done_below = -1;
  PW_TRY(pw_mem_alloc("rates: levels", nblock, sizeof *r->level, &r->level));
  PW_TRY(pw_mem_alloc("rates: pinned", nblock, sizeof *r->pinned, &r->pinned));
  for (int l = 0; l <= r->levels; l++) {
    if (l > 0) {
      PW_TRY(pw_nodes_create(sim->nodes.nnode, sim->nodes.nfield, &r->held[l]));
      pw_nodes_reset(&r->held[l]);
    }
    pw_blocks *set = &r->set[l];
    *set = sim->blocks;
    set->share_start = set->share_block = NULL;
    set->share_size = set->share_work = set->share_load = NULL;
    set->share_home = set->share_owner = set->share_order = NULL;
    PW_TRY(pw_share_create(set, sim->threads));
  }
  return PW_OK;
}

void pw_rates_destroy(pw_sim *sim)
{
  pw_rates *r = sim->rates;
  if (r) {
    for (int l = 0; l <= r->levels; l++) {
      pw_nodes_destroy(&r->held[l]);
      pw_share_destroy(&r->set[l]);
    }
    pw_mem_free(&r->level);
    pw_mem_free(&r->pinned);
  }
  pw_mem_free(&sim->rates);
}

static void divide(pw_sim *sim)
{
  pw_rates *r = sim->rates;
  for (int l = 0; l <= r->levels; l++) {
    for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
      const bool in = r->level[k] <= l;
      r->set[l].share_size[k] = in ? sim->blocks.share_size[k] : 0;
      r->set[l].share_work[k] = in ? sim->blocks.share_work[k] : 0;
    }
    pw_share_balance(&r->set[l]);
  }
  r->cycles = 0;
}

void pw_rates_renew(pw_sim *sim)
{
  pw_rates *r = sim->rates;
  for (int l = 1; l <= r->levels; l++) {
    pw_nodes_reset(&r->held[l]);
  }
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
    if (r->level[k] > 0) {
      pw_ranges_use(sim, k, &r->held[r->level[k]]);
    }
  }
  divide(sim);
}

/* Highest level that ends with short step k of n, or with step k - 1 when it is about to start. */
static int level_at(const pw_rates *r, int k)
{
  int l = 0;
  while (l < r->levels && k % (2 << l) == 0) {
    l++;
  }
  return l;
}

void pw_rates_begin(pw_sim *sim, int k, int n)
{
  pw_rates *r = sim->rates;
  if (!r) {
    return;
  }
  r->begun = k == 0 ? r->levels : level_at(r, k);
  r->done = k + 1 == n ? r->levels : level_at(r, k + 1);
  r->done_below = -1;
  for (int l = 0; l <= r->levels; l++) {
    r->span[l] = (l <= r->begun ? 0.0 : r->span[l]) + sim->dt;
  }
}

/* Groups in use [*first, *last) of one part of the nodes. */
static void part_of(const pw_nodes *nodes, int part, int parts, pw_idx *first, pw_idx *last)
{
  *first = (pw_idx)((pw_off)nodes->nused * part / parts);
  *last = (pw_idx)((pw_off)nodes->nused * (part + 1) / parts);
}

void pw_rates_clear_part(pw_sim *sim, int part, int parts)
{
  for (int l = 1; l <= sim->rates->begun; l++) {
    pw_nodes_clear_part(&sim->rates->held[l], part, parts);
  }
}

void pw_rates_add_part(pw_sim *sim, int part, int parts)
{
  const pw_rates *r = sim->rates;
  pw_idx i, end;
  for (part_of(&sim->nodes, part, parts, &i, &end); i < end; i++) {
    pw_off first, last;
    pw_nodes_group(&sim->nodes, i, &first, &last);
    for (int l = 1; l <= r->levels; l++) {
      if (!r->held[l].in_use[sim->nodes.used[i]]) {
        continue;
      }
      for (pw_off k = first; k < last; k++) {
        pw_real *node = sim->nodes.rec + k * PW_NODE;
        const pw_real *held = r->held[l].rec + k * PW_NODE;
        for (int c = 0; c < PW_NODE_REMAP; c++) { /* mass, momentum, force */
          node[c] += held[c];
        }
      }
    }
  }
}

/* Increments of velocity for a level: its momentum follows; slot REMAP sums them up, and becomes
 * what the points take when their step ends. Until then the momentum stands for theirs. */
static void follow(pw_real *node, pw_real *held, bool ends)
{
  for (int a = 0; a < 2; a++) {
    const pw_real dv = node[PW_NODE_FORCE + a];
    held[PW_NODE_VEL + a] += held[PW_NODE_MASS] * dv;
    held[PW_NODE_REMAP + a] += dv;
    if (ends) {
      held[PW_NODE_FORCE + a] = held[PW_NODE_REMAP + a];
    } else {
      node[PW_NODE_REMAP + a] += held[PW_NODE_VEL + a];
    }
  }
}

void pw_rates_increment_part(pw_sim *sim, int part, int parts)
{
  const pw_rates *r = sim->rates;
  pw_idx i, end;
  for (part_of(&sim->nodes, part, parts, &i, &end); i < end; i++) {
    pw_off first, last;
    pw_nodes_group(&sim->nodes, i, &first, &last);
    for (int l = 1; l <= r->levels; l++) {
      for (pw_off k = first; r->held[l].in_use[sim->nodes.used[i]] && k < last; k++) {
        follow(sim->nodes.rec + k * PW_NODE, r->held[l].rec + k * PW_NODE, l <= r->done);
      }
    }
  }
}

/* Levels that were not to end yet. */
static void end_part(void *ctx, int part, int parts)
{
  pw_sim *sim = ctx;
  const pw_rates *r = sim->rates;
  for (int l = r->done_below + 1; l <= r->levels; l++) {
    pw_idx i, end;
    for (part_of(&r->held[l], part, parts, &i, &end); i < end; i++) {
      pw_off k, last;
      for (pw_nodes_group(&r->held[l], i, &k, &last); k < last; k++) {
        pw_real *held = r->held[l].rec + k * PW_NODE;
        held[PW_NODE_FORCE] = held[PW_NODE_REMAP];
        held[PW_NODE_FORCE + 1] = held[PW_NODE_REMAP + 1];
      }
    }
  }
}

static void velocity_if(void *ctx, pw_idx block)
{
  if (pw_rates_ends(ctx, block)) {
    pw_block_velocity(ctx, block);
  }
}

static void gather_if(void *ctx, pw_idx block)
{
  const pw_update_pass *pass = ctx;
  if (pw_rates_ends(pass->sim, block)) {
    pw_block_fbar_gather(ctx, block);
  }
}

static void update_if(void *ctx, pw_idx block)
{
  const pw_update_pass *pass = ctx;
  if (pw_rates_ends(pass->sim, block)) {
    pw_block_update(ctx, block);
  }
}

pw_status pw_rates_join(pw_sim *sim)
{
  pw_rates *r = sim->rates;
  pw_update_pass pass = {sim, PW_NODE_REMAP, true, true};
  const pw_pass velocity = {end_part, velocity_if, NULL, true};
  r->done_below = r->done;
  r->done = r->levels;
  pw_assemble_pass(&sim->blocks, sim->threads, &velocity, sim);
  if (sim->fbar) {
    pw_fbar_clear(sim);
    pw_assemble_coloured(&sim->blocks, sim->threads, gather_if, &pass);
  }
  pw_for_blocks(&sim->blocks, sim->threads, update_if, &pass);
  PW_TRY(pw_update_collect(sim));
  return pw_update_energy(sim);
}

/* Fastest signal of a block over the cells beside it; 1/s. */
static pw_real signal_rate(const pw_sim *sim, pw_idx block)
{
  const pw_block_sums *s = &sim->sums[block];
  return sim->mesh.graded ? s->rate_max : s->speed_max / sim->mesh.cell;
}

void pw_rates_choose(pw_sim *sim)
{
  pw_rates *r = sim->rates;
  bool changed = false;
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
    pw_idx level = 0;
    const pw_real rate = signal_rate(sim, k), most = sim->scene.time.dt_max_s;
    while (level < r->levels && !r->pinned[k]) {
      pw_real step = sim->dt_next * (pw_real)(2 << level);
      pw_real part = level < r->level[k] ? 1.0 : RISE;
      if (step * rate > part * sim->scene.time.cfl || step > most) {
        break;
      }
      level++;
    }
    changed = changed || level != r->level[k];
    r->level[k] = level;
    r->pinned[k] = false;
  }
  if (changed) {
    pw_rates_renew(sim);
  } else if (++r->cycles >= REBALANCE) {
    pw_ranges_balance(sim);
    divide(sim);
  }
}

pw_status pw_rates_archive(pw_sim *sim, pw_archive *ar)
{
  return sim->rates ? ar->index(ar, "rates/level", sim->rates->level, sim->blocks.nblock) : PW_OK;
}
