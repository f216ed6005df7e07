/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/rates.h
 * @brief Blocks of slow points take longer steps (method.step_ratio_max; layer 3).
 *
 * The stable step is that of the few points where signals are fastest and cells smallest. A block
 * of level l > 0 takes one step of q 2^(l - 1) of the short ones, with q = 2, 3 or 4, whichever
 * leaves the fewest updates of points. In a cycle of short steps
 *
 *  - a block scatters mass, momentum and force at the start of its own step. What the blocks of a
 *    level gave to the grid is held in records of that level and added to the nodes in each short
 *    step: the force stays, the momentum follows the node, mass times the increments of velocity;
 *  - at the end of its step the points of the block take the sum of those increments, which
 *    conserves momentum exactly, and move and strain with the node's velocity as it then is times
 *    their own step. For a node that only such points reach this is the long step itself, to
 *    rounding. A chain of fast and slow springs stays stable up to 0.6 of both limits, with narrow
 *    resonances above (for 2, 3, 4, 6 and 8 steps), whereas with the displacement summed over the
 *    short steps, or with stress that is updated every few steps only, its force lags and it grows
 *    by 1 to 20 % in each long step. In an elastic bar of points the energy grows by 3 % in 12,000
 *    short steps at cfl 0.5; in twos it grows less, in fours and eights by 11 %; not at cfl 0.25;
 *  - at the end of a cycle all blocks are at the same time.
 *
 * Levels follow from the block's fastest signal with the margin of time.cfl, and from what its
 * contacts resolve (engine/effects/contact_corner.h): their forces, too, are those at the start of the
 * block's own step and stay until its end. Mixed time integration: Belytschko, Yen, Mullen,
 * Comput. Methods Appl. Mech. Engrg 17/18 (1979); on grids of material points own work.
 */
#ifndef PW_ENGINE_RATES_H
#define PW_ENGINE_RATES_H

#include "engine/sim_state.h"

enum { PW_MAX_LEVELS = 4 };

/** Context; sim->rates points to it. */
typedef struct pw_rates {
  int levels;       /**< highest level there is room for */
  pw_idx first;     /**< short steps of level 1; each further level takes twice as many */
  pw_idx *level;    /**< [nblock] */
  pw_idx *next;     /**< [nblock] scratch: levels to come */
  pw_real *longest; /**< [nblock] steps that contacts let a block take in the next cycle; s */
  pw_nodes held[PW_MAX_LEVELS + 1]; /**< by level from 1 on: what its blocks gave to the grid */
  pw_blocks set[PW_MAX_LEVELS + 1]; /**< blocks of levels up to this, divided among threads;
                                            borrows all but the division */
  pw_real span[PW_MAX_LEVELS + 1];  /**< since the start of the level's step; s */
  pw_real ahead[PW_MAX_LEVELS + 1]; /**< length of the level's step, as planned at its start; s */
  int begun;                        /**< levels up to this start in the present short step */
  int done_below;                   /**< levels above this and */
  int done;                         /**< up to this end in it */
  int cycles;                       /**< since the blocks were last divided */
} pw_rates;

/** @brief Memory, if the scene has method.step_ratio_max > 1; all blocks have level 0.
 *  @return PW_OK; PW_ERR_MEMORY. */
pw_status pw_rates_create(pw_sim *sim);
void pw_rates_destroy(pw_sim *sim);

/** @brief Short steps of a full cycle, which are those of the highest level in use; 1 without
 *  levels. */
int pw_rates_cycle(const pw_sim *sim);

/** @brief Before short step @p k of a cycle of @p n. */
void pw_rates_begin(pw_sim *sim, int k, int n);

/** @brief End the steps of all blocks with the last short step, when points must be sorted before
 *  the next. @return as pw_update_collect. */
pw_status pw_rates_join(pw_sim *sim);

/** @brief After a cycle: levels of the next. */
void pw_rates_choose(pw_sim *sim);

/** @brief After a sort, a change of levels, or loading. */
void pw_rates_renew(pw_sim *sim);

/** @brief Save or load the levels and their steps. @return as the archive; PW_ERR_FILE: damaged. */
pw_status pw_rates_archive(pw_sim *sim, pw_archive *ar);

/** @brief Blocks that start, or end, their steps in this one. */
static inline const pw_blocks *pw_rates_starting(const pw_sim *sim)
{
  return sim->rates ? &sim->rates->set[sim->rates->begun] : &sim->blocks;
}
static inline const pw_blocks *pw_rates_ending(const pw_sim *sim)
{
  return sim->rates ? &sim->rates->set[sim->rates->done] : &sim->blocks;
}

/** @brief Whether a block starts a step of its own now. */
static inline bool pw_rates_starts(const pw_sim *sim, pw_idx block)
{
  return !sim->rates || sim->rates->level[block] <= sim->rates->begun;
}

/** @brief Length of the step that a block has started last, as planned then; s. */
static inline pw_real pw_rates_ahead(const pw_sim *sim, pw_idx block)
{
  return sim->rates ? sim->rates->ahead[sim->rates->level[block]] : sim->dt;
}

/** @brief A contact resolves steps of a block up to @p dt; s. */
static inline void pw_rates_limit(const pw_sim *sim, pw_idx block, pw_real dt)
{
  if (sim->rates) {
    sim->rates->longest[block] = pw_min(sim->rates->longest[block], dt);
  }
}

/** @brief Whether the step of a block ends now. */
static inline bool pw_rates_ends(const pw_sim *sim, pw_idx block)
{
  const pw_rates *r = sim->rates;
  return !r || (r->level[block] > r->done_below && r->level[block] <= r->done);
}

/** @brief Whether all blocks are at the same time at the end of this step. */
static inline bool pw_rates_together(const pw_sim *sim)
{
  return !sim->rates || sim->rates->done == sim->rates->levels;
}

/** @brief Step of a block's points; s. */
static inline pw_real pw_rates_dt(const pw_sim *sim, pw_idx block)
{
  return sim->rates ? sim->rates->span[sim->rates->level[block]] : sim->dt;
}

/** @brief Time at the start of that step, in the pass that ends it; s. A join follows the last
 *  short step, when sim->time is its end. */
static inline pw_real pw_rates_time(const pw_sim *sim, pw_idx block)
{
  const pw_rates *r = sim->rates;
  const pw_real behind = r && r->done_below >= 0 ? 0.0 : sim->dt;
  return r ? sim->time - (pw_rates_dt(sim, block) - behind) : sim->time;
}

/** @brief Records of field @p f that a block scatters to and takes increments of velocity from. */
static inline pw_real *pw_rates_records(const pw_sim *sim, pw_idx block, int f)
{
  const pw_idx level = sim->rates ? sim->rates->level[block] : 0;
  return pw_nodes_field(level > 0 ? &sim->rates->held[level] : &sim->nodes, f);
}

/** @brief Whether points of a block share cell @p e with those of its own level. */
static inline bool pw_rates_share(const pw_sim *sim, pw_idx block, pw_idx e)
{
  const pw_rates *r = sim->rates;
  return !r || r->level[sim->blocks.elem_block[e]] == r->level[block];
}

/** @brief Parts of the loops over nodes: clear the records of starting levels; add what is held to
 *  the nodes; pass the increments of velocity on. */
void pw_rates_clear_part(pw_sim *sim, int part, int parts);
void pw_rates_add_part(pw_sim *sim, int part, int parts);
void pw_rates_increment_part(pw_sim *sim, int part, int parts);

#endif /* PW_ENGINE_RATES_H */
