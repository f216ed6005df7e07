/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/surface_load.h
 * @brief Pressure on one face of a body, carried by the edges of its points' domains (layer 3).
 *
 * The loaded edges are those that lie on the face of the body's initial bounding box. A pressure p
 * gives each edge the force p L (axisymmetry, per radian: p times the integral of r over the edge),
 * shared by its two ends as a linear edge element shares it and carried to the grid by the shape
 * functions at the ends. L is the length of the present edge projected on the face; the direction
 * is the face's initial inward normal: for edges that turn little this is the pressure's component
 * along that normal, and it adds no force across it. Where the basis has no domains the whole force
 * acts at the point, with the initial edge. Edges that overlap at the start (graded points) share
 * the load, so that the total is that of the face.
 */
#ifndef PW_EFFECTS_SURFACE_LOAD_H
#define PW_EFFECTS_SURFACE_LOAD_H

#include "engine/sim_state.h"

enum { PW_EDGE_NODES = 8 }; /**< two ends, four nodes each */

typedef struct pw_surface_load {
  int field;       /**< velocity field of the body */
  int along;       /**< axis along the face: 0 = x, 1 = y */
  pw_real normal;  /**< inward normal: +1 or -1 along the other axis */
  pw_real share;   /**< face over sum of edges at the start: 1 unless domains overlap */
  pw_idx n;        /**< loaded edges */
  pw_idx *id;      /**< [n] point ids, ascending */
  pw_idx *corner;  /**< [n] first corner of the edge; the second is the next of (-,-) (+,-) (+,+)
                        (-,+) */
  pw_real *length; /**< [n] initial length; m */
  pw_idx *node;    /**< [n * PW_EDGE_NODES] nodes loaded in this step */
  pw_real *force;  /**< [n * PW_EDGE_NODES] their forces along the inward normal; N (per radian) */
} pw_surface_load;

/**
 * @brief Find the edges of body @p b on @p side (pw_side, no box).
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_SCENE when no edge lies on that side.
 */
pw_status pw_surface_load_create(pw_sim *sim, int b, int side, pw_surface_load *out);

/** @brief Free; a zeroed struct is accepted. */
void pw_surface_load_destroy(pw_surface_load *load);

/** @brief Add the forces of @p pressure (Pa) to the FORCE slots of the body's field.
 *  @return the total force, whole body; N */
pw_real pw_surface_load_apply(pw_sim *sim, pw_surface_load *load, pw_real pressure);

/** @brief Work of the forces of the last call in this step, whole body; J. For PW_STAGE_END. */
pw_real pw_surface_load_work(const pw_sim *sim, const pw_surface_load *load);

#endif /* PW_EFFECTS_SURFACE_LOAD_H */
