/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effect.h
 * @brief An effect is one constant record and one .c file; a scene pays only for those it names.
 *
 * Layer 3. pw_schedule_build copies the hooks of the scene's effects into one array sorted by
 * stage; ties keep the order of engine/effects.def, never that of the scene file. An effect that
 * is not named allocates nothing and runs nothing.
 */
#ifndef PW_ENGINE_EFFECT_H
#define PW_ENGINE_EFFECT_H

#include "engine/core/archive.h"
#include "engine/core/record.h"
#include "engine/scene.h"

typedef struct pw_sim pw_sim;
typedef struct pw_solid_hooks pw_solid_hooks; /**< engine/implicit_state.h */

/** Where in a step a hook runs (engine/step_explicit.c). */
typedef enum pw_stage {
  PW_STAGE_START,      /**< implicit steps, once: FORCE slots hold what is out of balance; N */
  PW_STAGE_BEGIN,      /**< weights are known, nodes still empty */
  PW_STAGE_P2G,        /**< after the points' scatter: further scatters (own passes) */
  PW_STAGE_NODE_FORCE, /**< add to the nodes' force; momentum and mass are in the records */
  PW_STAGE_WEIGHT,     /**< the same, each record by itself: a part of them (pw_part_hook_fn) */
  PW_STAGE_NODE_TOTAL, /**< the same, by what all others together have added */
  PW_STAGE_CONSTRAINT, /**< change velocities at t(n+1); FORCE slots hold v(n) */
  PW_STAGE_MASS, /**< method.mass_terms: 2: what else than points has mass (engine/full_mass.h) adds M
                      times the velocities in slot FORCE to slot REMAP of the scratch records */
  PW_STAGE_REMAP_P2G, /**< MUSL: other momenta than the points' into slot REMAP; FORCE holds v(n) */
  PW_STAGE_REMAP,     /**< the same constraints on the velocities in slot sim->node_slot: remapped
                           ones (MUSL), or v(n+1) with another term of the mass matrix */
  PW_STAGE_MOTION,    /**< once a step, velocities are final: sums over a part of the records */
  PW_STAGE_MESH,      /**< points and interfaces have moved */
  PW_STAGE_END,       /**< probes, records; sim->time is t(n+1) */
  PW_STAGE_COUNT
} pw_stage;

typedef pw_status (*pw_hook_fn)(pw_sim *sim, void *ctx);
typedef struct pw_hook {
  pw_stage stage;
  pw_hook_fn fn;
} pw_hook; /**< a list ends with {0, NULL} */

/** Work of one thread on part @p part of @p parts of the nodal records (pw_nodes_part), each by
 *  itself unless velocities are final, in stages WEIGHT, CONSTRAINT, REMAP and MOTION of explicit
 *  steps: it runs within the loop over the records that the step makes anyway, as a pass on its
 *  own, or one thread that visits the records of the others, costs what the way between processors
 *  costs. In CONSTRAINT and REMAP only while no ordinary hook comes before; else in a loop. */
typedef void (*pw_part_hook_fn)(const pw_sim *sim, void *ctx, int part, int parts);
typedef struct pw_part_hook {
  pw_stage stage;
  pw_part_hook_fn fn;
} pw_part_hook; /**< a list ends with {0, NULL} */

/** A list of mappings inside an effect's section; each entry fills one row of an array in the
 *  parameter struct. */
typedef struct pw_effect_rows {
  const char *name;    /**< key of the list */
  const char *meaning; /**< one line for `pilewright keys` */
  const pw_key *keys;  /**< offsets into a row */
  size_t count;        /**< offset of the int that counts the rows */
  size_t first, size;  /**< offset of the first row; bytes of a row */
  int max;
} pw_effect_rows;

struct pw_effect {
  const char *name;           /**< key of its section in the scene file */
  const char *brief;          /**< one line for `pilewright list` */
  bool many;                  /**< the section is a list; each entry is one instance */
  bool lumped_only;           /**< not with method.mass_terms > 1 */
  bool own_velocity_fields;   /**< asks for one velocity field per body (contact) */
  const char *structure_key;  /**< its key that may name a body without points; NULL: none may */
  uint64_t point_fields;      /**< bits of pw_field_id to allocate */
  const pw_key *keys;         /**< offsets into its parameter struct */
  const pw_effect_rows *rows; /**< a list in its section, or NULL */
  const pw_hook *hooks;
  const pw_part_hook *part_hooks; /**< NULL: none */
  /** Hooks of implicit steps on the grid (engine/step_implicit.h), NULL: they do not know this
   *  effect. PW_STAGE_CONSTRAINT there holds nodes, PW_STAGE_NODE_FORCE adds what acts at
   *  sim->time + sim->dt; both run for every part of a step, and more than once. */
  const pw_hook *implicit;
  /** @brief Rules across keys; the section's name is added by the caller. May be NULL.
   *  @return PW_OK or PW_ERR_SCENE. */
  pw_status (*check)(const pw_scene *scene, const void *param);
  /** @brief Allocate its context. Points, mesh, nodes and blocks of @p sim exist; points have
   *  their initial mass, position and stress. May be NULL (context NULL).
   *  @param[in] param its parameter struct, borrowed for the life of the simulation */
  pw_status (*create)(pw_sim *sim, const void *param, void **ctx);
  void (*destroy)(void **ctx);
  /** @brief Columns of history.csv, same names every time; may be NULL. */
  void (*history)(const pw_sim *sim, void *ctx, pw_record *row);
  /** @brief Items of summary.json's `results`; may be NULL. */
  void (*results)(const pw_sim *sim, void *ctx, pw_record *out);
  /** @brief Save or load its state, under its own name; may be NULL. */
  pw_status (*archive)(pw_sim *sim, void *ctx, pw_archive *ar);
  /** What it does in scenes of geometry solid; the members from point_fields on are then not used,
   *  but keys, rows and check. NULL: an effect of plane and axisymmetric scenes. */
  const pw_solid_hooks *solid;
};

/** @brief The effect of that name, or NULL. */
const pw_effect *pw_effect_find(const char *name);

/** @brief The @p i-th effect of engine/effects.def, or NULL past its end. */
const pw_effect *pw_effect_at(int i);

/** @brief The @p i-th effect of engine/solid_effects.def, or NULL past its end. */
const pw_effect *pw_solid_effect_at(int i);

/** @brief The effect of that name for scenes of this one's geometry, or NULL. */
const pw_effect *pw_effect_of(const pw_scene *scene, const char *name);

#endif /* PW_ENGINE_EFFECT_H */
