/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/element_driver.h
 * @brief One homogeneous element of material under mixed control of strain and stress (layer 1).
 *
 * Laboratory tests (biaxial, triaxial, oedometer, simple shear) are paths of one element on which
 * each of the six components prescribes either its strain increment or its stress. The strain
 * increments left open follow from Newton's method with the model's own algorithmic tangent.
 * Strain is the integral of the rate of deformation; the deformation gradient follows it as
 * F <- exp(dE + dW) F.
 */
#ifndef PW_KERNELS_ELEMENT_DRIVER_H
#define PW_KERNELS_ELEMENT_DRIVER_H

#include "kernels/material.h"

/** An element; plain values, so that an assignment is a copy of its state. */
typedef struct pw_element {
  const pw_material *material;
  const pw_real *param; /**< borrowed */
  pw_real stress[6];    /**< Pa */
  pw_real strain[6];    /**< since the start, tensor shears; - */
  pw_real state[PW_MAX_STATE];
  pw_real f[9];              /**< deformation gradient, row-major */
  pw_real density;           /**< now; kg/m3 */
  pw_real wave_speed;        /**< after the last move; m/s */
  pw_material_counts counts; /**< of accepted moves */
  pw_real last[6];           /**< strain increment of the last step under mixed control; - */
  pw_off moves;              /**< accepted */
  const char *why;           /**< what the material said when a move failed last, or NULL */
  pw_real tolerance;         /**< of a prescribed stress, relative to |stress| + 1 Pa */
} pw_element;

/** What one component prescribes. */
typedef enum pw_control { PW_CONTROL_STRAIN, PW_CONTROL_STRESS } pw_control;

/** One step of a path. */
typedef struct pw_element_step {
  pw_control control[6];
  pw_real value[6]; /**< strain increment (tensor shears), or stress at the end of the step in Pa */
  pw_real spin[3];  /**< spin increment xy, yz, zx; rad */
} pw_element_step;

/**
 * @brief Start an element from a stress, undeformed, with the model's initial state.
 * @param[in] stress [6] Pa
 * @return PW_OK; PW_ERR_SCENE from the model's check of @p param.
 */
pw_status pw_element_start(pw_element *el, const pw_material *material, const pw_real *param,
                           const pw_real *stress);

/**
 * @brief Move the element by a strain increment.
 * @param[in]  de      [6] tensor shears; -
 * @param[in]  spin    [3] xy, yz, zx; rad; NULL for none
 * @param[out] tangent [36] row-major with engineering shear columns, or NULL; Pa
 * @return PW_OK; PW_RETRY_STRESS, PW_RETRY_DOMAIN_INVERTED with the element unchanged.
 */
pw_status pw_element_move(pw_element *el, const pw_real *de, const pw_real *spin, pw_real *tangent);

/**
 * @brief Make one step under mixed control; it is cut into halves where Newton's method fails.
 * @return PW_OK; PW_RETRY_DIVERGED with the element unchanged when pieces of 1/1024 fail as well.
 */
pw_status pw_element_drive(pw_element *el, const pw_element_step *step);

#endif /* PW_KERNELS_ELEMENT_DRIVER_H */
