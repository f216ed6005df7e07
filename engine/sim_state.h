/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/sim_state.h
 * @brief Inside of a simulation, for the engine's own files and its effects (layer 3).
 */
#ifndef PW_ENGINE_SIM_STATE_H
#define PW_ENGINE_SIM_STATE_H

#include "engine/effect.h"
#include "engine/nodes.h"
#include "engine/sim.h"
#include "engine/structure.h"
#include "kernels/transfer.h"
#include "partition/blocks.h"

/** A hook of the schedule with the context of its effect. */
typedef struct pw_scheduled {
  pw_stage stage;
  pw_hook_fn fn;
  void *ctx;
  const char *effect;
  pw_part_hook_fn part; /**< in place of fn */
} pw_scheduled;

typedef struct pw_schedule {
  int n;
  int start[PW_STAGE_COUNT + 1]; /**< hooks of stage s: [start[s], start[s + 1]) */
  pw_scheduled hook[PW_MAX_EFFECTS * PW_STAGE_COUNT];
} pw_schedule;

/** Sums a block keeps for itself; added in block order, so the totals are the same on any number
 *  of threads. */
typedef struct pw_block_sums {
  pw_real strain_work; /**< J per radian or metre, this step */
  pw_real kinetic;     /**< J per radian or metre, now */
  pw_real settled;     /**< taken out by the noise damping; J per radian or metre, this step */
  pw_real speed_max;   /**< max of c + |v|, of c what steps resolve; m/s */
  pw_real rate_max;    /**< graded grid: max of (c + |v|) / cell near the point; 1/s */
  pw_off limited, rebuilt, reshaped;
  pw_idx bad; /**< first point whose stress or domain failed, or -1 */
  pw_status bad_status;
  const char *why; /**< what its material says, or NULL */
  pw_weights_report weights;
  pw_material_counts material;
  char pad[PW_ALIGN]; /* neighbours in the array belong to other threads */
} pw_block_sums;

/** A body as the engine uses it. */
typedef struct pw_body {
  const char *name;
  const pw_material *model;
  const pw_real *param;
  int field;               /**< velocity field its points scatter to */
  pw_real step_part;       /**< of its wave speed, that steps resolve; - */
  bool prescribed;         /**< its motion is given (prescribed_motion) */
  pw_real prescribed_v[2]; /**< m/s, this step */
  pw_real start[2];        /**< centre of mass at the start; m */
} pw_body;

struct pw_sim {
  pw_scene scene;
  int threads;
  pw_mesh mesh;
  pw_points points;
  pw_nodes nodes;
  pw_blocks blocks;
  const pw_kernels *kernels;
  pw_transfer transfer; /**< the arrays above, as kernels see them */
  int nbody;
  pw_body body[PW_MAX_BODIES];
  int nstructure;
  pw_structure *structure;                   /**< [nstructure] bodies without points */
  pw_structure *structure_of[PW_MAX_BODIES]; /**< by body; NULL: it has points */
  pw_schedule schedule;
  void *ctx[PW_MAX_EFFECTS]; /**< contexts, same order as scene.effect */

  pw_real time;    /**< s, at the end of the last step */
  pw_off step;     /**< steps made */
  pw_real dt;      /**< of the step being made; s */
  pw_real dt_next; /**< stable step for the next; s */
  pw_real dt_min, dt_max;
  pw_real dt_contact;   /**< largest step a penalty contact allows, set by it each step; 0: none */
  pw_real measure;      /**< 2 pi (axisymmetric) or 1: times a per-radian value = whole body */
  pw_real mass_cut_off; /**< kg */
  pw_real mass;         /**< of all points; kg per metre or radian */
  pw_real signal_speed; /**< largest c + |v| at the end of the last step; m/s */
  pw_real load_factor;  /**< of gravity now, 0..1: the ramp; 1 without gravity */
  const pw_real *buoyant;     /**< mass of the water that the points at each node displace, in slot
                               MASS of [nnode][PW_NODE]; kg; NULL: no ground water */
  int buoyant_field;          /**< velocity field of those points */
  struct pw_fbar_cells *fbar; /**< engine/fbar.h; NULL: off */
  struct pw_quad_steps *quad; /**< engine/step_implicit.h; NULL: explicit steps */
  struct pw_rates *rates;     /**< engine/rates.h; NULL: all points take the same steps */
  struct pw_full_mass *full_mass; /**< engine/full_mass.h; NULL: lumped masses */
  int node_slot;    /**< PW_NODE_VEL or PW_NODE_REMAP: what a REMAP hook is to change */
  bool sort_needed; /**< points are not in the order of their blocks */

  pw_energy energy;       /**< kinetic: at the end of the last step */
  pw_real external_last;  /**< energy.external at the end of the last step; J */
  pw_real external_gross; /**< sum of the sizes of its changes; J */
  pw_real released;       /**< most that stresses have given up of what they held first; J */
  pw_real surplus;        /**< energy at the end of the last step beyond all that was supplied; J */
  pw_block_sums *sums;    /**< [nblock] */
  pw_real stage_wall[PW_TIMER_COUNT];
  pw_real wall;
  pw_off sorts, limited, rebuilt, reshaped, clamped;
  pw_off updates; /**< of points: steps times points, less what slow blocks leave out */
  pw_material_counts material;
  pw_real *limit;   /**< [n by id] half diagonal allowed to each domain; m, or on a graded grid in
                         cells where it is; NULL without CPDI */
  pw_idx *from;     /**< [n] sort scratch */
  pw_real *scratch; /**< [ld] */
};

/** @brief Run the hooks of @p stage in order, but for those by parts at its head, which
 *  pw_schedule_run_part() has run. @return the first status that is not PW_OK. */
pw_status pw_schedule_run(pw_sim *sim, pw_stage stage);

/** @brief Run one thread's part of the hooks by parts at the head of @p stage, in order. */
void pw_schedule_run_part(const pw_sim *sim, pw_stage stage, int part, int parts);

/** @brief Hooks of @p stage. */
static inline int pw_schedule_count(const pw_sim *sim, pw_stage stage)
{
  return sim->schedule.start[stage + 1] - sim->schedule.start[stage];
}

/** @brief Context of the first effect of that name in the scene, or NULL. */
void *pw_sim_effect_ctx(const pw_sim *sim, const char *name);

#endif /* PW_ENGINE_SIM_STATE_H */
