/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/contact_corner_surface.h
 * @brief The master's surface with rounded convex edges, and places on it (layer 3).
 *
 * The surface is what is `rounding` away from an inner line: the master's line moved inwards by
 * that much. On straight parts it is the line itself. At a convex vertex it is an arc, on which
 * the normal turns continuously, outside of the body and inside of it to a depth of `rounding`:
 * the closest point on the line itself would jump there from one side of the edge to the other.
 */
#ifndef PW_EFFECTS_CONTACT_CORNER_SURFACE_H
#define PW_EFFECTS_CONTACT_CORNER_SURFACE_H

#include "engine/interface_search.h"

/** A line with rounded edges. */
typedef struct pw_round_line {
  const pw_interface *line; /**< of the master; borrowed */
  pw_interface inner;       /**< the same nodes, moved inwards */
  pw_segment_bins bins;     /**< of the inner line */
  pw_real rounding;         /**< m */
  pw_real *arc;             /**< [n] place along the surface at which segment k begins, > 0; m */
  pw_real *length;          /**< [n] of the inner segments at the start; m */
  pw_real total;            /**< of a closed surface at the start; m */
  pw_real box[4];           /**< around the line now: x from, to, y from, to; m */
  /** The inner line is convex now, closed or from axis to axis: gap(x + d) >= gap(x) + n . d. */
  bool convex;
} pw_round_line;

/** A place on the surface and what lies over it. */
typedef struct pw_round_place {
  pw_idx segment;
  pw_real gap;        /**< of the position from the surface, negative inside; PW_HUGE beyond a free
                           end; m */
  pw_real n[2], t[2]; /**< normal, out of the master, and tangent, along the line */
  pw_real arc;        /**< along the surface as it was at the start: marks material; m */
  pw_real xi;         /**< on the master's own segment, 0 to 1 */
} pw_round_place;

/**
 * @brief A rounded surface on the master's line @p line, which stays borrowed.
 * @param[in] rounding m; taken smaller where segments are too short for it
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_ARGUMENT.
 */
pw_status pw_round_line_create(const pw_interface *line, pw_real rounding, const pw_mesh *mesh,
                               pw_round_line *out);
void pw_round_line_destroy(pw_round_line *r);

/** @brief Follow the line: inner line, box, segments by cell. Once a step. */
void pw_round_line_update(pw_round_line *r, const pw_mesh *mesh);

/** @brief Place of @p x [2] by segment @p segment and its ends. */
void pw_round_line_place(const pw_round_line *r, pw_idx segment, const pw_real *x,
                         pw_round_place *place);

/**
 * @brief Place of a position that was not in contact.
 * @param[in] cell  lower left node of the cell that holds @p x
 * @param[in] reach how far off the surface to look at most; m
 * @return true when it lies within @p reach of the surface or inside; @p place is then set.
 */
bool pw_round_line_near(const pw_round_line *r, const pw_real *x, pw_idx cell, pw_real reach,
                        pw_round_place *place);

/** @brief The same, true only when it lies inside. */
bool pw_round_line_find(const pw_round_line *r, const pw_real *x, pw_idx cell, pw_real reach,
                        pw_round_place *place);

/** @brief Place of a position outside of a convex line, looked for along it from segment @p from on.
 *  @return true when it lies outside of the surface: @p place then has the gap and the normal of
 *  the nearest segment, wherever that is; false when it may lie inside, or the line is not convex. */
bool pw_round_line_seek(const pw_round_line *r, pw_idx from, const pw_real *x,
                        pw_round_place *place);

/** @brief Place of a position that was at @p arc: goes along the surface only while that is nearer,
 *  so that a deep one stays with its side. */
void pw_round_line_follow(const pw_round_line *r, pw_real arc, const pw_real *x,
                          pw_round_place *place);

/** @brief Way along the surface from one place to another, the short way round. */
static inline pw_real pw_round_line_way(const pw_round_line *r, pw_real from, pw_real to)
{
  pw_real way = to - from;
  if (r->line->closed) {
    way += way < -0.5 * r->total ? r->total : (way > 0.5 * r->total ? -r->total : 0.0);
  }
  return way;
}

#endif /* PW_EFFECTS_CONTACT_CORNER_SURFACE_H */
