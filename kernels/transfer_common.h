/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/transfer_common.h
 * @brief What the bodies of kernels/transfer.c share (layer 1, private to that file).
 */
#ifndef PW_KERNELS_TRANSFER_COMMON_H
#define PW_KERNELS_TRANSFER_COMMON_H

#include "kernels/transfer.h"

enum { NODE = 8 }; /* reals in a nodal record, as in engine/nodes.h */

/* Slots of a nodal record, as in engine/nodes.h. */
enum { SLOT_VEL = 1, SLOT_FORCE = 3, SLOT_REMAP = 5 };

/** Scatter what @p set selects; always a literal, so unused terms are compiled away. */
enum { SET_MOMENTUM = 1, SET_FORCE = 2 };

#define PW_PASTE_(a, b) a##_##b
#define PW_PASTE(a, b) PW_PASTE_(a, b)
#define PW_NAME_OF(verb) PW_PASTE(verb, PW_TAG)

/** A coordinate in cells from the grid's corner, moved inside [0, cells]; NaN becomes 0. */
static inline pw_real grid_clamp(pw_real g, pw_real cells)
{
  g = g > 0.0 ? g : 0.0;
  return g < cells ? g : cells;
}

/** Bilinear weights of a vertex at local coordinates (a, b): lower left, lower right, upper left,
 *  upper right. */
static inline void quad_weights(pw_real a, pw_real b, pw_real w[4])
{
  w[0] = (1.0 - a) * (1.0 - b);
  w[1] = a * (1.0 - b);
  w[2] = (1.0 - a) * b;
  w[3] = a * b;
}

/** rec[0..7] += w * value[0..7]: one or two vector operations. */
static inline void record_add(pw_real *restrict rec, pw_real w, const pw_real *restrict value)
{
  for (int k = 0; k < NODE; k++) {
    rec[k] += w * value[k];
  }
}

/** Row of an element number; exact below 2^52 / cells. */
static inline pw_idx element_row(pw_idx e, pw_real inv_cells)
{
  return (pw_idx)(((pw_real)e + 0.5) * inv_cells);
}

#endif /* PW_KERNELS_TRANSFER_COMMON_H */
