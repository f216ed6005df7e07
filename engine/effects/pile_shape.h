/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/pile_shape.h
 * @brief How deep a place lies inside the exact outline of a pile (layer 3).
 *
 * The axis of a pile is x = 0. Its lower end is flat, a half ellipse with the half-axes radius and
 * tip length (rounded), or a straight cone.
 */
#ifndef PW_EFFECTS_PILE_SHAPE_H
#define PW_EFFECTS_PILE_SHAPE_H

#include "engine/scene.h"

typedef struct pw_pile_shape {
  int tip;            /**< pw_tip */
  pw_real radius;     /**< m */
  pw_real tip_length; /**< 0 for a flat tip; m */
  pw_real length;     /**< whole length, tip included; m */
} pw_pile_shape;

/** @brief Shape of a scene's pile. */
pw_pile_shape pw_pile_shape_of(const pw_scene_body *body);

/**
 * @brief Distance to the outline of a place inside it.
 * @param[in] x from the axis; m
 * @param[in] z above the lowest point; m
 * @return m; 0 outside and on the outline
 */
pw_real pw_pile_depth(const pw_pile_shape *s, pw_real x, pw_real z);

#endif /* PW_EFFECTS_PILE_SHAPE_H */
