/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/material.h
 * @brief Material models: parameter tables and the batch stress update (layer 1).
 *
 * A material is one .c file and one line in kernels/materials.def. Stress and strain always have
 * six components, in the order xx yy zz xy yz zx, tension positive; shear strains are TENSOR
 * components (half the engineering ones). In axisymmetry x = r, y = z (axial), zz = hoop.
 *
 * The update works on a batch of points: every pointer is already offset to the first point of
 * the batch; component c of point i is at [c * ld + i] for arrays kept by the points and at
 * [c * ldi + i] for the scratch arrays of one step. Kernels never return early: a failing point
 * gets a safe value (its old state) and the first failing index is reported.
 */
#ifndef PW_KERNELS_MATERIAL_H
#define PW_KERNELS_MATERIAL_H

#include "engine/core/key.h"
#include "engine/core/status.h"

enum { PW_MAX_PARAMS = 320, PW_MAX_STATE = 64 };

/** Counters a batch adds to; summed over blocks in block order. */
typedef struct pw_material_counts {
  pw_off substeps; /**< accepted substeps */
  pw_off rhs;      /**< right-hand-side evaluations */
  pw_off rejected; /**< substeps repeated with a smaller size */
  pw_off forced;   /**< substeps accepted at the limits of size or number */
  pw_off cut_off;  /**< states moved to the low-stress or stress-ratio limit */
} pw_material_counts;

/** Arguments of one batch update; all arrays borrowed. */
typedef struct pw_stress_args {
  pw_idx n;                   /**< points in the batch, at most PW_CHUNK in a step */
  pw_idx ld;                  /**< leading dimension of stress and state */
  pw_idx ldi;                 /**< leading dimension of the increments and outputs */
  pw_real dt;                 /**< s */
  pw_real time;               /**< at the start of the step; s */
  pw_off step;                /**< steps made before this one */
  const pw_real *dstrain;     /**< [6][ldi] increment of strain D dt, tensor shears; - */
  const pw_real *spin;        /**< [3][ldi] increment of spin W dt: xy, yz, zx with
                               W_xy = (dv_x/dy - dv_y/dx)/2; rad */
  const pw_real *dvol;        /**< [ldi] volume ratio J(n+1)/J(n) of the step; - */
  const pw_real *left_cg;     /**< [6][ldi] b = F F^T at the end of the step, or NULL unless the
                               material sets needs_left_cg */
  const pw_real *jac;         /**< [ldi] J = det F at the end of the step, or NULL likewise */
  const pw_real *density;     /**< [ldi] at the end of the step; kg/m3 */
  const pw_real *def_grad;    /**< [9][ldi] F at the end of the step, row-major, or NULL unless the
                               material sets needs_def_grad; - */
  const pw_real *increment;   /**< [9][ldi] F(n+1) F(n)^-1 of the step, row-major, or NULL: it is
                               1 + dstrain + spin; - */
  pw_real *stress;            /**< [6][ld] Cauchy stress, in and out; Pa */
  pw_real *state;             /**< [nstate][ld] state variables, in and out; may be NULL if none */
  pw_real *wave_speed;        /**< [ldi] out: upper bound of the wave speed; m/s */
  const pw_idx *id;           /**< [n] the number of each point, from 0, or NULL */
  const pw_real *x;           /**< [dim][ldx] where the points are, or NULL; m */
  pw_idx ldx;                 /**< leading dimension of x */
  int dim;                    /**< coordinates of x: 2 or 3 */
  const pw_real *guide;       /**< [10][ldi] strain, spin and volume ratio of an increment whose
                               substeps are to be taken, whatever the increment; NULL: substeps as
                               the increment needs them. For models that set substeps */
  pw_real *tangent;           /**< [36][ldi] out, row-major d stress / d strain with ENGINEERING
                               shear columns, or NULL when not asked for; Pa. Models in rate form:
                               by the increment dstrain; models of F: by a further strain e of
                               F(n+1) <- (1 + e) F(n+1) in the same step */
  bool of_f;                  /**< in: as of the material; out: as its tangent is */
  pw_material_counts *counts; /**< added to, or NULL */
  pw_idx bad;                 /**< out: first failing point of the batch, or -1 */
  const char *why;            /**< out, where a model can tell: why that point failed; its text
                               outlives the run */
} pw_stress_args;

/** A state variable: its name with unit, for output ("void_ratio", "intergranular_strain_xx"). */
typedef struct pw_state_def {
  const char *name;
  bool output; /**< written to ParaView files; checkpoints hold every one */
} pw_state_def;

/** A material model; constant. */
typedef struct pw_material {
  const char *name;           /**< as written in a scene: "hypoplastic_sand" */
  const char *brief;          /**< one line, with its source */
  const pw_key *keys;         /**< parameters: rows whose offset is index * sizeof(pw_real): every
                                  number is stored as a pw_real (false = 0, true = 1, a choice as
                                  its index), a list as its count and its numbers from there on,
                                  texts and files as bytes from there on */
  const pw_state_def *states; /**< all state variables it may carry, in order */
  bool needs_left_cg;         /**< stress follows from F, not from increments */
  bool needs_def_grad;        /**< wants F beside the increments where there is one */
  bool needs_library;         /**< a shared library must be loaded first (engine/umat.h) */
  bool of_f;                  /**< takes b, or F of the increment where there is one; its tangent is
                                   by F */
  bool symmetric;             /**< the tangent by F makes a symmetric stiffness matrix: no friction
                               with other flow, no rate form */
  bool substeps;              /**< takes an increment in substeps that depend on it */
  bool takes_initial_stress;  /**< may start from a prescribed stress */
  /** @brief Cross-parameter rules. @return PW_OK or PW_ERR_SCENE with the broken rule. */
  pw_status (*check)(const pw_real *param);
  /** @brief State variables carried with these parameters (0 .. PW_MAX_STATE). */
  int (*nstate)(const pw_real *param);
  /** @brief Density of a stress-free point; kg/m3. */
  pw_real (*density)(const pw_real *param);
  /** @brief Part of its wave speed that an explicit step is to resolve; NULL: all of it. Less
   *  than 1 for a stiffness that lasts for the smallest of strains only: what oscillates there
   *  cannot grow beyond them. */
  pw_real (*step_part)(const pw_real *param);
  /** @brief Tell @p n points their height once, before any init(); NULL when the model does not
   *  depend on it. @param[in] y [n] vertical coordinate at the start; m */
  void (*place)(const pw_real *param, pw_idx n, pw_idx ld, const pw_real *y, pw_real *state);
  /** @brief Set the state of @p n points for the stress they have now; arrays as in the update.
   *  May be called again after the stress has been changed: it keeps what place() has set. */
  void (*init)(const pw_real *param, pw_idx n, pw_idx ld, const pw_real *stress, pw_real *state);
  /** @brief Advance stress and state over one step.
   *  @return PW_OK; PW_RETRY_STRESS with args->bad set (no error record: the caller writes it). */
  pw_status (*update)(const pw_real *param, pw_stress_args *args);
  /** @brief Matsuoka-Nakai mobilised friction angle of a stress, or NULL; rad.
   *  @param[in] stress [6] Pa */
  pw_real (*mobilised_angle)(const pw_real *param, const pw_real *stress);
} pw_material;

/** @brief The material of that name, or NULL. */
const pw_material *pw_material_find(const char *name);

/** @brief The @p i-th material of the list, or NULL past its end. */
const pw_material *pw_material_at(int i);

#endif /* PW_KERNELS_MATERIAL_H */
