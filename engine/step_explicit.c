/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/step_explicit.h"

#include <omp.h>

#include "engine/assemble.h"
#include "engine/fbar.h"
#include "engine/full_mass.h"
#include "engine/pairs.h"
#include "engine/ranges.h"
#include "engine/rates.h"
#include "engine/structure_sim.h"
#include "engine/update.h"

/* Steps between divisions of the blocks among the threads: substeps move with the waves. */
enum { REBALANCE = 32 };

/* Charge the time since the last call to a stage. */
static void lap(pw_sim *sim, pw_timer stage, double *since)
{
  double now = omp_get_wtime();
  sim->stage_wall[stage] += now - *since;
  *since = now;
}

/* No radial motion on the axis of symmetry: nodes at r = 0 of a part of the records, the slot of
 * the stage and, with v(n+1), v(n). */
static void axis_condition(pw_sim *sim, pw_stage stage, int part, int parts)
{
  const int slot = sim->node_slot;
  pw_idx first, last;
  if (sim->scene.geometry != PW_AXI || sim->mesh.origin[0] > 0.0) {
    return;
  }
  pw_nodes_part(&sim->nodes, part, parts, &first, &last);
  for (int f = 0; f < sim->nodes.nfield; f++) {
    pw_real *rec = pw_nodes_field(&sim->nodes, f);
    for (pw_idx j = 0; j < sim->mesh.nodes[1]; j++) {
      const pw_idx node = j * sim->mesh.nodes[0];
      if (!pw_nodes_in_part(&sim->nodes, f, node, first, last)) {
        continue;
      }
      pw_real *r = rec + (pw_off)node * PW_NODE;
      r[slot] = 0.0;
      r[PW_NODE_FORCE] = stage == PW_STAGE_CONSTRAINT ? 0.0 : r[PW_NODE_FORCE];
    }
  }
}

/* Constraints of a part of the records, whose velocities have just been made. */
static void constrain_part(pw_sim *sim, pw_stage stage, int part, int parts)
{
  axis_condition(sim, stage, part, parts);
  pw_schedule_run_part(sim, stage, part, parts);
}

/* F-bar: the stress that scatters read. */
static void force_stress(pw_sim *sim)
{
  if (sim->fbar) {
    const pw_blocks *blocks = pw_rates_starting(sim);
    pw_fbar_clear(sim);
    pw_assemble_coloured(blocks, sim->threads, pw_block_fbar_sum, sim);
    pw_for_blocks(blocks, sim->threads, pw_block_fbar_stress, sim);
  }
}

/* Loops over the nodes run inside the parallel regions of the scatters before or after them. */
static void clear_nodes(void *ctx, int part, int parts)
{
  pw_sim *sim = ctx;
  pw_nodes_clear_part(&sim->nodes, part, parts);
  if (sim->rates) {
    pw_rates_clear_part(sim, part, parts);
  }
}

static void add_held(void *ctx, int part, int parts)
{
  pw_rates_add_part(ctx, part, parts);
}

static void increment_nodes(void *ctx, int part, int parts)
{
  pw_sim *sim = ctx;
  pw_nodes_increment_part(&sim->nodes, part, parts);
  if (sim->rates) {
    pw_rates_increment_part(sim, part, parts);
  }
}

static void remap_nodes(void *ctx, int part, int parts)
{
  pw_sim *sim = ctx;
  pw_nodes_remap_part(&sim->nodes, part, parts);
  constrain_part(sim, PW_STAGE_REMAP, part, parts);
}

static void weigh_nodes(void *ctx, int part, int parts)
{
  pw_schedule_run_part(ctx, PW_STAGE_WEIGHT, part, parts);
}

static void new_velocities(void *ctx, int part, int parts)
{
  pw_sim *sim = ctx;
  pw_nodes_momentum_part(&sim->nodes, sim->dt, sim->mass_cut_off, part, parts);
  constrain_part(sim, PW_STAGE_CONSTRAINT, part, parts);
}

static void weigh_and_move(void *ctx, int part, int parts)
{
  weigh_nodes(ctx, part, parts);
  new_velocities(ctx, part, parts);
}

static void start_velocities(void *ctx, int part, int parts)
{
  pw_sim *sim = ctx;
  pw_nodes_momentum_part(&sim->nodes, 0.0, sim->mass_cut_off, part, parts);
  constrain_part(sim, PW_STAGE_REMAP, part, parts);
}

/* Scatter onto cleared nodes. */
static void scatter(pw_sim *sim, pw_block_fn block)
{
  const pw_pass pass = {clear_nodes, block, sim->rates ? add_held : NULL, false};
  force_stress(sim);
  pw_assemble_pass(pw_rates_starting(sim), sim->threads, &pass, sim);
}

/* Forces to new velocities of the nodes; when nothing else needs the sum of the forces, in one go. */
static pw_status move_nodes(pw_sim *sim)
{
  sim->node_slot = PW_NODE_VEL;
  if (pw_schedule_count(sim, PW_STAGE_NODE_TOTAL) == 0 && !pw_pairs_on(sim)) {
    pw_for_parts(sim->threads, weigh_and_move, sim);
    return PW_OK;
  }
  pw_for_parts(sim->threads, weigh_nodes, sim);
  PW_TRY(pw_schedule_run(sim, PW_STAGE_NODE_TOTAL));
  if (pw_pairs_on(sim)) { /* mass, momentum, force */
    pw_pairs_collect(sim, PW_NODE_MASS, PW_NODE_REMAP);
  }
  pw_for_parts(sim->threads, new_velocities, sim);
  return PW_OK;
}

static void first_term(void *ctx, int part, int parts)
{
  pw_full_mass_first_part(ctx, part, parts);
}

static void second_term(void *ctx, int part, int parts)
{
  pw_full_mass_second_part(ctx, part, parts);
  constrain_part(ctx, PW_STAGE_REMAP, part, parts);
}

/* From the lumped masses' increments of velocity towards those of the full mass matrix. */
static pw_status full_mass(pw_sim *sim, double *clock)
{
  const pw_pass pass = {NULL, pw_block_full_mass, second_term, false};
  pw_for_parts(sim->threads, first_term, sim);
  PW_TRY(pw_schedule_run(sim, PW_STAGE_MASS));
  sim->full_mass->adding = true;
  pw_assemble_pass(&sim->blocks, sim->threads, &pass, sim);
  const pw_status status = pw_schedule_run(sim, PW_STAGE_REMAP);
  sim->full_mass->adding = false;
  lap(sim, PW_TIMER_REMAP, clock);
  return status;
}

/* Points to grid, forces, new nodal velocities under all constraints. */
static pw_status grid_velocity(pw_sim *sim, double *clock)
{
  scatter(sim, pw_block_p2g);
  lap(sim, PW_TIMER_P2G, clock);
  PW_TRY(pw_schedule_run(sim, PW_STAGE_P2G));
  PW_TRY(pw_schedule_run(sim, PW_STAGE_NODE_FORCE));
  pw_structures_kick(sim);
  lap(sim, PW_TIMER_EFFECTS, clock);
  PW_TRY(move_nodes(sim));
  lap(sim, PW_TIMER_NODES, clock);
  PW_TRY(pw_schedule_run(sim, PW_STAGE_CONSTRAINT));
  lap(sim, PW_TIMER_EFFECTS, clock);
  if (pw_pairs_on(sim)) { /* velocities at the end and at the start of the step */
    pw_pairs_spread(sim, PW_NODE_VEL, 4);
    lap(sim, PW_TIMER_NODES, clock);
  }
  return PW_OK;
}

/* The velocities are final: sums over nodes, just before the points read the same records. */
static void sum_nodes(void *ctx, int part, int parts)
{
  const pw_update_pass *pass = ctx;
  pw_schedule_run_part(pass->sim, PW_STAGE_MOTION, part, parts);
}

/* Gather gradients; move, deform and stress the points. */
static void update_points(pw_sim *sim, pw_update_pass *pass)
{
  if (sim->fbar && pass->stress) {
    pw_fbar_clear(sim);
    pw_assemble_coloured(pw_rates_ending(sim), sim->threads, pw_block_fbar_gather, pass);
  }
  const bool sums = pass->move && pw_schedule_count(sim, PW_STAGE_MOTION) > 0;
  const pw_pass update = {sums ? sum_nodes : NULL, pw_block_update, NULL, true};
  pw_assemble_pass(pw_rates_ending(sim), sim->threads, &update, pass);
}

/* USF: stress from the velocities at the start of the step. */
static pw_status stress_first(pw_sim *sim, double *clock)
{
  scatter(sim, pw_block_p2g_momentum);
  PW_TRY(pw_schedule_run(sim, PW_STAGE_P2G));
  sim->node_slot = PW_NODE_VEL;
  pw_for_parts(sim->threads, start_velocities, sim);
  PW_TRY(pw_schedule_run(sim, PW_STAGE_REMAP));
  lap(sim, PW_TIMER_P2G, clock);
  pw_update_pass pass = {sim, PW_NODE_VEL, false, true};
  update_points(sim, &pass);
  lap(sim, PW_TIMER_G2P_STRESS, clock);
  PW_TRY(pw_update_collect(sim));
  return sim->sort_needed ? pw_update_sort(sim) : PW_OK; /* domains have changed: mind the halo */
}

/* MUSL: the points take their increments of velocity, and their momentum goes back on the grid. */
static pw_status remap_velocity(pw_sim *sim, double *clock)
{
  const bool pairs = pw_pairs_on(sim);
  const pw_pass pass = {increment_nodes, pw_block_velocity_remap, pairs ? NULL : remap_nodes,
                        false};
  PW_TRY(pw_schedule_run(sim, PW_STAGE_REMAP_P2G));
  lap(sim, PW_TIMER_EFFECTS, clock);
  sim->node_slot = PW_NODE_REMAP;
  pw_assemble_pass(pw_rates_ending(sim), sim->threads, &pass, sim);
  lap(sim, PW_TIMER_REMAP, clock);
  if (pairs) {
    pw_pairs_collect(sim, PW_NODE_REMAP, 2);
    pw_for_parts(sim->threads, remap_nodes, sim);
    lap(sim, PW_TIMER_NODES, clock);
  }
  PW_TRY(pw_schedule_run(sim, PW_STAGE_REMAP));
  lap(sim, PW_TIMER_EFFECTS, clock);
  if (pw_pairs_on(sim)) {
    pw_pairs_spread(sim, PW_NODE_REMAP, 2);
    lap(sim, PW_TIMER_NODES, clock);
  }
  return PW_OK;
}

pw_status pw_step_explicit(pw_sim *sim)
{
  const int update = sim->scene.method.update;
  double clock = omp_get_wtime();
  pw_update_pass pass = {sim, PW_NODE_VEL, true, update != PW_USF};

  if (sim->sort_needed) {
    PW_TRY(pw_update_sort(sim));
    lap(sim, PW_TIMER_SORT, &clock);
  } else if (sim->step % REBALANCE == 1 && !sim->rates) {
    pw_ranges_balance(sim);
  }
  pw_structures_clear(sim);
  sim->energy.spring =
      0.0; /* each effect with springs adds what they hold at the end of the step */
  PW_TRY(pw_schedule_run(sim, PW_STAGE_BEGIN));
  lap(sim, PW_TIMER_EFFECTS, &clock);
  if (update == PW_USF) {
    PW_TRY(stress_first(sim, &clock));
  }
  PW_TRY(grid_velocity(sim, &clock));
  if (sim->full_mass) {
    PW_TRY(full_mass(sim, &clock));
  }
  if (update == PW_MUSL) {
    PW_TRY(remap_velocity(sim, &clock));
  } else {
    const pw_pass velocity = {increment_nodes, pw_block_velocity, NULL, true};
    sim->node_slot = sim->full_mass ? PW_NODE_REMAP : PW_NODE_VEL;
    pw_assemble_pass(&sim->blocks, sim->threads, &velocity, sim);
    lap(sim, PW_TIMER_REMAP, &clock);
  }
  pass.slot = sim->node_slot;
  update_points(sim, &pass);
  lap(sim, PW_TIMER_G2P_STRESS, &clock);
  pw_structures_drift(sim);
  PW_TRY(pw_schedule_run(sim, PW_STAGE_MESH));
  sim->time += sim->dt;
  sim->step++;
  pw_status status = update == PW_USF ? pw_update_check(sim) : pw_update_collect(sim);
  lap(sim, PW_TIMER_EFFECTS, &clock);
  if (status == PW_OK) {
    status = pw_schedule_run(sim, PW_STAGE_END);
  }
  if (status == PW_OK) {
    status = pw_update_energy(sim);
  }
  lap(sim, PW_TIMER_EFFECTS, &clock);
  return status;
}
