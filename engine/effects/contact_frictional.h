/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/effects/contact_frictional.h
 * @brief Nodes with mass of both bodies: direction of contact and gap (layer 3).
 *
 * The grid knows only to a cell where a body ends: bodies share a node when up to two cells are
 * between them, along a diagonal 2 sqrt(2). With `detection: closed_gap` the places of the points'
 * domains say it. Along a direction n out of the slave A, towards the master B, the gap at node i is
 *
 *   gap_i = min over B (x . n) - max over A (x . n)
 *
 * over the places x of domains with a weight at the node: of CPDI domains their parts in the node's
 * cells. (Their corners there are too little: a corner on the line of the next node has no weight here,
 * and a narrow body would come through the edge that leads to it. Whole domains are too much: a body
 * beside a curved one would be pushed early.) Of uGIMP the whole box counts, of points without domain a square
 * of their area. A gap above zero in any direction proves that these domains are apart,
 * and where flat faces meet, the largest gap is their distance. So three directions are tried, the
 * normals of master and slave and the line that halves their angle, and the largest gap is taken. Near
 * the edge of one body its own normal leans outwards, that of the other is right; where both end, the
 * line between them is. (Nairn, Hammerquist, Smith, Comput. Methods Appl. Mech. Engng 362, 112859,
 * 2020, find the plane between two bodies by regression over their points, and the gap from deformed
 * points as here.) The impulses act along the normal of the scene's choice: outlines of soil are too
 * rough to take the direction of the gap. Where blocks of points take longer steps than others, their
 * places are older than the gap: bodies may overlap by the way of one long step.
 */
#ifndef PW_EFFECTS_CONTACT_FRICTIONAL_H
#define PW_EFFECTS_CONTACT_FRICTIONAL_H

#include "engine/effects/contact.h"

/** Lowest and highest node along x and y, inclusive. */
typedef struct pw_node_window {
  pw_idx low[2], high[2];
} pw_node_window;

/** A node with mass of both bodies. */
typedef struct pw_contact_node {
  pw_idx node;
  bool facing;        /**< has a normal; by shared nodes: and no tension across it */
  bool touching;      /**< in this step */
  bool stuck;         /**< friction holds it */
  pw_real normal[2];  /**< out of the slave, unit */
  pw_real gap;        /**< that the bodies may still close, >= 0; m */
  pw_real impulse[2]; /**< on the master; N s (per metre or radian) */
  pw_real loss;       /**< energy lost, when slot FORCE holds v(n); J (likewise) */
} pw_contact_node;

/** Surfaces of slave and master at the nodes with mass of both. */
typedef struct pw_contact_surfaces {
  const pw_contact_frictional_param *param;
  const pw_sim *sim;
  pw_node_window *support; /**< [nblock] nodes that a block may scatter to */
  bool *near;              /**< [nblock] its support holds nodes of both bodies */
  pw_node_window meeting;  /**< what these nodes span, in this step */
  pw_real *rec;            /**< [2][nnode][PW_NODE] of slave and master: pw_kernels.p2g_surface */
  pw_idx count;            /**< nodes with mass of both bodies */
  pw_contact_node *list;   /**< [nnode], the first count of them in the order of their node */
  /** Kernel of the scatter in progress. */
  void (*scatter)(const pw_transfer *t, pw_real *surface, pw_idx first, pw_idx last);
} pw_contact_surfaces;

/** @brief Allocate for @p sim; destroy it also after an error. @return PW_OK or PW_ERR_MEMORY. */
pw_status pw_contact_surfaces_create(const pw_sim *sim, const pw_contact_frictional_param *param,
                                     pw_contact_surfaces *out);
void pw_contact_surfaces_destroy(pw_contact_surfaces *c);

/** @brief List the nodes of this step, after P2G, with their normals and gaps; nothing touches. */
void pw_contact_surfaces_update(pw_contact_surfaces *c);

#endif /* PW_EFFECTS_CONTACT_FRICTIONAL_H */
