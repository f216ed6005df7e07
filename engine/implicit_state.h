/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/implicit_state.h
 * @brief Inside of an implicit simulation, for its effects (layer 3).
 *
 * Effects are created in the order of engine/solid_effects.def, those of one kind in the order of
 * the scene, and called in that order. Courses are functions of T, the number of load steps made,
 * whole or not.
 */
#ifndef PW_ENGINE_IMPLICIT_STATE_H
#define PW_ENGINE_IMPLICIT_STATE_H

#include "engine/effect.h"
#include "engine/implicit.h"

/** What an effect of solid scenes does; all but create may be NULL. */
struct pw_solid_hooks {
  /** @brief Allocate its context and hold nodes. Points are where they start.
   *  @param[in] mesh  as given to pw_implicit_create(), gone afterwards
   *  @param[in] param its parameter struct, borrowed for the life of the simulation
   *  @return PW_OK; PW_ERR_SCENE, beginning with the path of the key. */
  pw_status (*create)(pw_implicit *sim, const pw_solid_mesh *mesh, const void *param, void **ctx);
  void (*destroy)(void **ctx);
  /** @brief Add to model.prescribed what its nodes move from @p from to @p to, and to
   *  model.external its load at @p to; both are zero before. */
  void (*apply)(pw_implicit *sim, void *ctx, pw_real from, pw_real to);
  /** @brief A part of a step has converged at @p to: points have moved, the mesh has not, and the
   *  model has the forces. */
  void (*moved)(pw_implicit *sim, void *ctx, pw_real to);
  /** @brief Put the mesh where it belongs at @p to. One effect at most has this. */
  pw_status (*mesh)(pw_implicit *sim, void *ctx, pw_real to);
  /** @brief Columns of history.csv, same names every time. */
  void (*history)(const pw_implicit *sim, void *ctx, pw_record *row);
  /** @brief Items of summary.json's `results`; NULL: those of the history. */
  void (*results)(const pw_implicit *sim, void *ctx, pw_record *out);
  /** @brief Save or load its state, under its own name. */
  pw_status (*archive)(pw_implicit *sim, void *ctx, pw_archive *ar);
};

/** An effect at work. */
typedef struct pw_solid_instance {
  const pw_effect *type;
  const void *param;
  int number; /**< among those of its kind, from 0 */
  void *ctx;
} pw_solid_instance;

struct pw_implicit {
  pw_scene scene;
  pw_tet_material material[PW_MAX_BODIES]; /**< of a body */
  pw_tet_mesh mesh;
  pw_tet_model model;
  pw_newton *newton;
  pw_newton_report report; /**< of the last load step */
  pw_off step;
  pw_real now;    /**< T: load steps made, whole or not */
  pw_real size;   /**< of the step at hand, in load steps */
  pw_real wanted; /**< of the next one, adaptive */
  pw_off iterations, cuts, parts;
  pw_walk_counts walked;
  pw_off equations; /**< of the last part */
  pw_real wall;
  char warning[256]; /**< about free mechanisms, or "" */
  char note[256];    /**< about a body that will leave the nodes that move it, or "" */
  bool mesh_moves;   /**< an effect moves the mesh */
  bool has_axis;     /**< a driven boundary turns about it */
  pw_real axis[3], centre[3];
  int neffect;
  pw_solid_instance effect[PW_MAX_EFFECTS];
};

/** @brief Which instance of its kind, from 0, has the parameters @p param. */
int pw_solid_instance_of(const pw_implicit *sim, const void *param);

/** @brief Part of a load that acts at @p t: none up to load step @p start, all from @p ramp steps
 *  later on; a ramp of 0 lasts to the end of the run. */
pw_real pw_solid_course(const pw_implicit *sim, int start, int ramp, pw_real t);

/** @brief Torque about @p axis (of length 1) of @p force on the @p arm [3] from the axis; N m. */
static inline pw_real pw_solid_torque(const pw_real *axis, const pw_real *arm, const pw_real *force)
{
  pw_real sum = 0.0;
  for (int c = 0; c < 3; c++) {
    const int p = (c + 1) % 3, q = (c + 2) % 3;
    sum += axis[c] * (arm[p] * force[q] - arm[q] * force[p]);
  }
  return sum;
}

/** A load or motion's course in its effect's parameters. */
typedef struct pw_solid_ramp {
  int start_step, ramp_steps;
} pw_solid_ramp;

/** Rows of a key table for a pw_solid_ramp at the offset @p at. */
#define PW_SOLID_RAMP_KEYS(at)                                                                     \
  {"start_step", PW_KEY_INT, (at) + offsetof(pw_solid_ramp, start_step), 0, 1e6, "0",              \
   NULL,         NULL,       "load steps made before it begins to grow"},                          \
  {                                                                                                \
    "ramp_steps", PW_KEY_INT, (at) + offsetof(pw_solid_ramp, ramp_steps), 0, 1e6, "0", NULL, NULL, \
        "load steps in which it grows evenly to its whole value; 0: to the end of the run"         \
  }

#endif /* PW_ENGINE_IMPLICIT_STATE_H */
