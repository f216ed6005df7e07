/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/interface_search.h
 * @brief Search of contact between the nodes of one interface line and the segments of another
 *        (layer 3).
 *
 * Source: Giridharan 2016, section 2.6.7, with the closest point of the line in place of the
 * condition 0 <= xi <= 1 on each segment (eq. 2.51), which leaves wedges at convex vertices that
 * belong to no segment and wedges at re-entrant ones that belong to two.
 */
#ifndef PW_ENGINE_INTERFACE_SEARCH_H
#define PW_ENGINE_INTERFACE_SEARCH_H

#include "engine/interface.h"
#include "kernels/interface_law.h"

/** Segments of a master by grid cell; renewed each step without touching empty cells. */
typedef struct pw_segment_bins {
  pw_idx ncell, row, rows; /**< bins are numbered as lower left nodes: row nodes along x */
  pw_idx capacity, used;
  pw_idx *head;    /**< [ncell] first entry of a cell, -1: none */
  pw_idx *touched; /**< [ncell] grid node carries momentum of the master line: stamp of the step */
  pw_idx *next;    /**< [capacity] */
  pw_idx *segment; /**< [capacity] */
  pw_idx *cell;    /**< [capacity] */
  pw_idx stamp;
} pw_segment_bins;

/** @brief Room for the segments of @p line on @p mesh. @return PW_OK; PW_ERR_MEMORY. */
pw_status pw_bins_create(const pw_interface *line, const pw_mesh *mesh, pw_segment_bins *out);
void pw_bins_destroy(pw_segment_bins *bins);

/** @brief Sort the segments of @p line into the cells they pass; the line must be located. */
void pw_bins_fill(pw_segment_bins *bins, const pw_interface *line);

/** @brief Whether the cell of lower left node @p first shares a grid node with a node of the line. */
bool pw_bins_near(const pw_segment_bins *bins, pw_idx first);

/**
 * @brief The segment nearest to @p x [2], which lies in the cell of lower left node @p cell.
 * @return -1 when none is closer than @p reach or the cell shares no grid node with the line.
 */
pw_idx pw_bins_nearest(const pw_segment_bins *bins, const pw_interface *master, pw_real reach,
                       pw_idx cell, const pw_real *x);

/**
 * @brief Steps one to three of the detection (thesis section 2.6.7) for a slave without contact.
 *
 * Shared grid nodes, then the nearest segment closer than a cell, then the sign of the gap: the
 * closest point of the line owns the slave, so that neither convex nor re-entrant vertices leave
 * a gap and exactly one segment answers.
 * @return the segment within whose body the slave lies (then @p pair is set), or -1.
 */
pw_idx pw_bins_detect(const pw_segment_bins *bins, const pw_interface *master, pw_real reach,
                      const pw_interface_node *slave, pw_pair *pair);

/**
 * @brief Follow a slave in contact from the segment it belonged to along the line.
 *
 * Goes to a neighbour only while that is closer, so a deep slave keeps the side it came in by.
 * @param[out] pair its place; gap >= 0 when it has left the body
 * @return the owner now.
 */
pw_idx pw_interface_track(const pw_interface *master, pw_idx owner, const pw_real *x,
                          pw_pair *pair);

/**
 * @brief Closest place of segment @p s to @p x, with the sign of the gap.
 * @param[out] pair normal and tangent of the place; at a re-entrant vertex the normal points from
 *             the slave to the vertex
 */
void pw_interface_closest(const pw_interface *line, pw_idx s, const pw_real *x, pw_pair *pair);

#endif /* PW_ENGINE_INTERFACE_SEARCH_H */
