/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/bodies.h
 * @brief Material points of a scene's bodies: graded rectangles, discs, piles, rings (layer 3).
 */
#ifndef PW_ENGINE_BODIES_H
#define PW_ENGINE_BODIES_H

#include "engine/points.h"
#include "engine/scene.h"

/** Initial domains of points before they become pw_points. */
typedef struct pw_domains {
  pw_idx n;
  pw_real *x;    /**< [2][n] centre; m */
  pw_real *half; /**< [4][n] half-side vectors r1x r1y r2x r2y; m */
  pw_idx *body;  /**< [n] */
} pw_domains;

/** @brief Domains of every body, bodies in order. @return PW_OK; PW_ERR_MEMORY; PW_ERR_SCENE when
 *  a body is empty, has a bad size, leaves the grid, or crosses r = 0. */
pw_status pw_domains_create(const pw_scene *scene, pw_domains *out);
void pw_domains_destroy(pw_domains *d);

/** @brief Area of a domain in the plane, |4 r1 x r2|; m2. */
pw_real pw_domain_area(const pw_real *half4);

/**
 * @brief Outline of a body as a closed polyline, counter-clockwise (body to the left), from its
 *        exact shape: rectangle, circle, outer circle of a whole ring, part of a ring, pile (in
 *        axisymmetry the half at r >= 0, starting and ending on the axis and not closed).
 * A closed outline does not repeat its first vertex. A piece belongs to the tip when both its ends
 * do; the base of a flat pile is its tip.
 * @param[in]  segment largest length of a piece; m
 * @param[out] xy  [2 * max] pairs; NULL to count
 * @param[out] tip [max] true for a vertex on a pile's tip part; may be NULL
 * @return vertices of the outline, or -1 when max is too small.
 */
int pw_body_outline(const pw_scene *scene, int body, pw_real segment, pw_real *xy, bool *tip,
                    int max);

/** @brief Smallest box around a ring or the part of one: {left, right, bottom, top}; m. */
void pw_body_ring_box(const pw_scene_body *b, pw_real box[4]);

/** @brief Radii and angles of a ring. @return PW_OK; PW_ERR_SCENE. */
pw_status pw_body_check_ring(const pw_scene_body *b);

#endif /* PW_ENGINE_BODIES_H */
