/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/bodies_shapes.h
 * @brief What the files of engine/bodies*.c share: the list being filled, one filler per shape
 *        (layer 3, internal).
 */
#ifndef PW_ENGINE_BODIES_SHAPES_H
#define PW_ENGINE_BODIES_SHAPES_H

#include "engine/bodies.h"

/** Domains being counted or written. */
typedef struct pw_domain_list {
  pw_domains *out;     /**< NULL: only count */
  pw_off n;            /**< domains so far */
  pw_idx body;         /**< body of the domains added now */
  const pw_mesh *mesh; /**< the grid, for points_per_cell */
  const pw_real *hole; /**< centre of the hole of the present body */
  pw_real hole_radius; /**< domains centred in it are not added; 0: no hole */
} pw_domain_list;

/** @brief Add the domain of centre @p x [2] and half vectors r1 = (a, b), r2 = (c, d); m. */
void pw_domain_add(pw_domain_list *list, const pw_real *x, const pw_real *half4);

/**
 * @brief Domains of one body; counts when list->out is NULL.
 * @return PW_OK; PW_ERR_SCENE when there would be more than 2^30 domains.
 */
pw_status pw_body_fill_rectangle(const pw_scene_body *b, pw_domain_list *list);
pw_status pw_body_fill_disc(const pw_scene_body *b, pw_domain_list *list);
pw_status pw_body_fill_ring(const pw_scene_body *b, pw_domain_list *list);
pw_status pw_body_fill_pile(const pw_scene_body *b, pw_geometry geometry, pw_domain_list *list);

/** @brief The rectangle of a body with points_per_cell. @return as the others. */
pw_status pw_body_fill_cells(const pw_scene_body *b, const pw_mesh *mesh, pw_domain_list *list);

/** @brief Refuse a body of more than 2^30 points. @return PW_OK; PW_ERR_SCENE. */
pw_status pw_body_check_count(const pw_scene_body *b, pw_real points);

/** @brief Equal pieces, none longer than @p size, into which @p length is divided: at least 1. */
pw_real pw_body_pieces(pw_real length, pw_real size);

/** @brief Height of a pile's tip part: 0 if flat, tip_length_m if positive, else the radius; m. */
pw_real pw_pile_tip_height(const pw_scene_body *b);

#endif /* PW_ENGINE_BODIES_SHAPES_H */
