/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file partition/tets.h
 * @brief Linear tetrahedra: which share a face or a node, and their inverse matrices (layer 2).
 *
 * Node i of element e is node[4 e + i]; its face f is the one opposite node f, seen from outside
 * counter-clockwise as pw_tet_face[f]. The table of neighbours is Algorithm 2 of Wang et al., "An
 * implicit material point method for screw pile installation", with faces found by their smallest
 * node, so that it takes a time proportional to the number of elements.
 *
 * The volume coordinate of node f in element e is g . (x - x_b), where g is the gradient in
 * inverse[16 e + 4 f ..], |g| its length behind it, and b node 0 (node 1 for f = 0). Divided by |g|
 * it is the distance from face f, which makes one tolerance in metres serve all elements.
 */
#ifndef PW_PARTITION_TETS_H
#define PW_PARTITION_TETS_H

#include "engine/core/status.h"

/** Nodes of the face opposite each node, outwards for a positive volume. */
extern const int pw_tet_face[4][3];

/** The thinnest element accepted: six volumes over the cube of its longest edge. */
#define PW_TETS_THINNEST 1e-12

typedef struct pw_tets {
  pw_idx nnode, nelem;
  pw_real *x;         /**< [3][nnode] coordinates at the start; m */
  pw_idx *node;       /**< [nelem][4] */
  pw_idx *beside;     /**< [nelem][4] element across face f, or -1 on the boundary */
  pw_idx *node_start; /**< [nnode + 1] offsets into node_elem */
  pw_idx *node_elem;  /**< [4 nelem] elements at each node, ascending */
  pw_real *inverse;   /**< [nelem][4][4] gradient of each volume coordinate and its length; 1/m */
  pw_real *volume;    /**< [nelem] m3 */
  pw_real low[3];     /**< least coordinates; m */
  pw_real high[3];    /**< largest coordinates; m */
  pw_real tolerance;  /**< a point this far outside a face is still inside; m */
  pw_real near;       /**< a point this near to a face may be inside other elements as well; m */
} pw_tets;

/**
 * @brief Copy nodes and elements, and build all tables.
 * @param[in] x    [3][nnode] m
 * @param[in] node [nelem][4] in [0, nnode)
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_ARGUMENT naming element and nodes for: an index out of
 *         range, a coordinate that is no number, a node in no element, two nodes in one place, an
 *         inverted element, one thinner than PW_TETS_THINNEST, a face of three elements, two
 *         elements on the same side of a face, elements not joined to the first one by faces.
 */
pw_status pw_tets_create(pw_idx nnode, const pw_real *x, pw_idx nelem, const pw_idx *node,
                         pw_tets *out);

/** @brief Free; a zeroed struct is accepted. */
void pw_tets_destroy(pw_tets *t);

/** @brief Volume coordinates of @p x [3] in element @p e; @p shape [4]. */
void pw_tets_shape(const pw_tets *t, pw_idx e, const pw_real *x, pw_real *shape);

/** @brief True when element @p e holds @p x [3], its faces moved out by the tolerance. */
bool pw_tets_hold(const pw_tets *t, pw_idx e, const pw_real *x);

/** @brief Faces without a neighbour. @param[out] face [n] 4 e + f, ascending, or NULL
 *  @return their number. */
pw_idx pw_tets_boundary(const pw_tets *t, pw_idx *face);

#endif /* PW_PARTITION_TETS_H */
