/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file partition/walk.h
 * @brief Which tetrahedron holds a point: walking from the last one, bins as fallback (layer 2).
 *
 * Algorithm 1 of Wang et al. walks from the previous parent through faces that separate the
 * element from the point. Taking always the first such face may go round for ever in a mesh that
 * is not Delaunay, so the face looked at first is drawn from a hash of the element and the number
 * of the step (the stochastic walk of Devillers, Pion, Teillaud, Int. J. Found. Comput. Sci. 13
 * (2002) 181-199), which gives equal walks on every run; a limit of steps stands behind it. A walk
 * that ends at the boundary or at the limit asks the bins, a grid of lists of elements, which know
 * every element and decide whether the point is outside.
 *
 * Owner of a point: the lowest of all elements that hold it within the tolerance of pw_tets. It
 * depends on the point alone, not on the start of the walk.
 */
#ifndef PW_PARTITION_WALK_H
#define PW_PARTITION_WALK_H

#include "partition/tets.h"

enum { PW_WALK_OUTSIDE = -1 }; /**< no element holds the point */

/** Where a mesh has gone from its start, turned, stretched and shifted as one: x = map X + shift. */
typedef struct pw_motion {
  bool moved;       /**< false: x = X exactly, the rest is not looked at */
  pw_real map[9];   /**< row-major */
  pw_real back[9];  /**< inverse of map */
  pw_real shift[3]; /**< m */
} pw_motion;

/** What searching has cost; summed by the caller over ranges. */
typedef struct pw_walk_counts {
  pw_off points;  /**< points searched */
  pw_off tests;   /**< elements tested on walks */
  pw_off moved;   /**< points whose parent has changed */
  pw_off ties;    /**< points so near to a face that the elements around were asked */
  pw_off binned;  /**< points that walking has not found */
  pw_off outside; /**< points that no element holds */
} pw_walk_counts;

/** Elements over a grid of bins; borrows the mesh. */
typedef struct pw_walk {
  const pw_tets *tets;
  pw_real inverse_cell[3]; /**< 1/m */
  pw_idx nbin[3];
  pw_idx *bin_start; /**< [nbin product + 1] offsets into bin_elem */
  pw_idx *bin_elem;  /**< elements whose bounding box meets the bin, ascending */
  pw_idx limit;      /**< steps of a walk */
} pw_walk;

/** @brief Build the bins. @return PW_OK; PW_ERR_MEMORY. */
pw_status pw_walk_create(const pw_tets *tets, pw_walk *out);

/** @brief Free; a zeroed struct is accepted. */
void pw_walk_destroy(pw_walk *w);

/**
 * @brief Owner of one point.
 * @param[in]     x      [3] in the coordinates of the start; m
 * @param[in]     from   element to start from, or PW_WALK_OUTSIDE: the bins are asked at once
 * @param[in,out] counts added to
 * @return element, or PW_WALK_OUTSIDE.
 */
pw_idx pw_walk_find(const pw_walk *w, const pw_real *x, pw_idx from, pw_walk_counts *counts);

/**
 * @brief Owners of @p n points on a mesh that has moved.
 *
 * The inverse matrices are kept and every point is taken back instead.
 * @param[in]     ld     leading dimension of @p x
 * @param[in]     x      [3][ld] m
 * @param[in,out] parent [n] element before and after; PW_WALK_OUTSIDE where there is none
 * @param[in,out] counts added to
 */
void pw_walk_points(const pw_walk *w, const pw_motion *motion, pw_idx n, pw_idx ld,
                    const pw_real *x, pw_idx *parent, pw_walk_counts *counts);

/** @brief Owner by testing all elements: the reference for tests. */
pw_idx pw_walk_search_all(const pw_tets *tets, const pw_real *x);

/** @brief Coordinates of the start of a point [3] of the moved mesh. */
void pw_motion_back(const pw_motion *motion, const pw_real *x, pw_real *back);

#endif /* PW_PARTITION_WALK_H */
