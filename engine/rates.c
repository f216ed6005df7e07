/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/rates.h"

#include <string.h>

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

/* The steps of level 1 change when that leaves less than this part of the updates. */
static const pw_real STAY = 0.95;

/* Short steps in one of a level, when level 1 takes @p first of them. */
static pw_idx steps_of(pw_idx first, pw_idx level)
{
  return level > 0 ? first << (level - 1) : 1;
}

int pw_rates_cycle(const pw_sim *sim)
{
  const pw_rates *r = sim->rates;
  pw_idx highest = 0;
  for (pw_idx k = 0; r && k < sim->blocks.nblock; k++) {
    highest = r->level[k] > highest ? r->level[k] : highest;
  }
  return r ? steps_of(r->first, highest) : 1;
}

pw_status pw_rates_create(pw_sim *sim)
{
  pw_rates *r;
  const pw_idx nblock = sim->blocks.nblock;
  if (sim->scene.method.step_ratio_max <= 1) {
    return PW_OK;
  }
  PW_TRY(pw_mem_alloc("rates", 1, sizeof *r, &r));
  sim->rates = r;
  while ((2 << r->levels) <= sim->scene.method.step_ratio_max && r->levels < PW_MAX_LEVELS) {
    r->levels++;
  }
  r->first = 2;
  r->begun = r->done = r->levels;
  r->done_below = -1;
  PW_TRY(pw_mem_alloc("rates: levels", nblock, sizeof *r->level, &r->level));
  PW_TRY(pw_mem_alloc("rates: next levels", nblock, sizeof *r->next, &r->next));
  PW_TRY(pw_mem_alloc("rates: contacts", nblock, sizeof *r->longest, &r->longest));
  for (pw_idx k = 0; k < nblock; k++) {
    r->longest[k] = PW_HUGE;
  }
  for (int l = 0; l <= r->levels; l++) {
    if (l > 0) {
      PW_TRY(pw_nodes_create(sim->nodes.nnode, sim->nodes.nfield, &r->held[l]));
      pw_nodes_reset(&r->held[l]);
    }
    pw_blocks *set = &r->set[l];
    *set = pw_share_undivided(&sim->blocks);
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
    pw_mem_free(&r->next);
    pw_mem_free(&r->longest);
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
  for (pw_idx i = 0; i < sim->blocks.nblock; i++) {
    const pw_idx k = sim->blocks.share_line[i];
    if (r->level[k] > 0) {
      pw_ranges_use(sim, k, &r->held[r->level[k]]);
    }
  }
  divide(sim);
}

/* Highest level whose steps end after k short ones of a cycle. */
static int level_at(const pw_rates *r, int k)
{
  int l = 0;
  while (l < r->levels && k % steps_of(r->first, l + 1) == 0) {
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
    if (l <= r->begun) {
      const pw_idx steps = steps_of(r->first, l), left = n - k;
      r->ahead[l] = (pw_real)(steps < left ? steps : left) * sim->dt;
    }
  }
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
  for (pw_nodes_part(&sim->nodes, part, parts, &i, &end); i < end; i++) {
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
  for (pw_nodes_part(&sim->nodes, part, parts, &i, &end); i < end; i++) {
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
    for (pw_nodes_part(&r->held[l], part, parts, &i, &end); i < end; i++) {
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

/* Highest level that a block may take when level 1 has @p first short steps. */
static pw_idx level_for(const pw_sim *sim, pw_idx block, pw_idx first)
{
  const pw_rates *r = sim->rates;
  const pw_real rate = signal_rate(sim, block);
  const pw_idx now = steps_of(r->first, r->level[block]);
  /* Points are about to change blocks; an empty block does not know who comes. */
  const bool settled = !sim->sort_needed && sim->blocks.share_size[block] > 0;
  pw_idx level = 0;
  while (level < r->levels && settled) {
    const pw_idx steps = steps_of(first, level + 1);
    const pw_real step = sim->dt_next * (pw_real)steps, part = steps <= now ? 1.0 : RISE;
    if (steps > sim->scene.method.step_ratio_max || step > sim->scene.time.dt_max_s ||
        step * rate > part * sim->scene.time.cfl || step > part * r->longest[block]) {
      break;
    }
    level++;
  }
  return level;
}

/* Updates of points in a short step, in the mean over a cycle. */
static pw_real updates_for(const pw_sim *sim, pw_idx first)
{
  pw_real sum = 0.0;
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
    sum += (pw_real)sim->blocks.share_size[k] / (pw_real)steps_of(first, level_for(sim, k, first));
  }
  return sum;
}

/* Steps of level 1 with the fewest updates. */
static pw_idx choose_first(const pw_sim *sim)
{
  pw_idx first = sim->rates->first;
  pw_real least = STAY * updates_for(sim, first);
  for (pw_idx q = 2; q <= 4; q++) {
    pw_real updates = updates_for(sim, q);
    if (updates < least) {
      first = q;
      least = updates;
    }
  }
  return first;
}

void pw_rates_choose(pw_sim *sim)
{
  pw_rates *r = sim->rates;
  const pw_idx nblock = sim->blocks.nblock, first = choose_first(sim);
  bool changed = first != r->first;
  for (pw_idx k = 0; k < nblock; k++) {
    r->next[k] = level_for(sim, k, first);
    changed = changed || r->next[k] != r->level[k];
    r->longest[k] = PW_HUGE;
  }
  memcpy(r->level, r->next, (size_t)nblock * sizeof *r->level);
  r->first = first;
  if (changed) {
    pw_rates_renew(sim);
  } else if (++r->cycles >= REBALANCE) {
    pw_ranges_balance(sim);
    divide(sim);
  }
}

pw_status pw_rates_archive(pw_sim *sim, pw_archive *ar)
{
  if (!sim->rates) {
    return PW_OK;
  }
  pw_rates *r = sim->rates;
  PW_TRY(ar->index(ar, "rates/first", &r->first, 1));
  PW_TRY(ar->index(ar, "rates/level", r->level, sim->blocks.nblock));
  bool valid = r->first >= 2 && r->first <= 4;
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
    valid = valid && r->level[k] >= 0 && r->level[k] <= r->levels;
  }
  PW_REQUIRE(valid || !ar->loading, PW_ERR_FILE, "the checkpoint's steps of blocks are damaged");
  return PW_OK;
}
