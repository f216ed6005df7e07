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

/** A smaller weight is one by rounding: the place is beyond the node's cells. */
#define EXTENT_WEIGHT 1e-9

/** A convex polygon: a parallelogram cut at the four sides of a cell has eight corners at most. */
enum { CONVEX = 8 };
typedef struct convex {
  int n;
  pw_real x[2][CONVEX];
} convex;

static inline void convex_add(convex *p, pw_real x, pw_real y)
{
  if (p->n < CONVEX) {
    p->x[0][p->n] = x;
    p->x[1][p->n++] = y;
  }
}

/** The parallelogram of centre x, y and half-sides @p h. */
static inline convex convex_of(pw_real x, pw_real y, const pw_real h[4])
{
  convex p = {0};
  convex_add(&p, x - h[0] - h[2], y - h[1] - h[3]);
  convex_add(&p, x + h[0] - h[2], y + h[1] - h[3]);
  convex_add(&p, x + h[0] + h[2], y + h[1] + h[3]);
  convex_add(&p, x - h[0] + h[2], y - h[1] + h[3]);
  return p;
}

/** What of @p p is not beyond @p at along axis @p a: above it for side 1, below it for side -1. */
static inline convex convex_cut(const convex *p, int a, pw_real side, pw_real at)
{
  convex out = {0};
  for (int k = 0; k < p->n; k++) {
    const int next = k + 1 < p->n ? k + 1 : 0;
    const pw_real beyond = side * (p->x[a][k] - at), then = side * (p->x[a][next] - at);
    if (beyond <= 0.0) {
      convex_add(&out, p->x[0][k], p->x[1][k]);
    }
    if ((beyond < 0.0 && then > 0.0) || (beyond > 0.0 && then < 0.0)) {
      const pw_real part = beyond / (beyond - then);
      const pw_real other = p->x[!a][k] + part * (p->x[!a][next] - p->x[!a][k]);
      convex_add(&out, a == 0 ? at : other, a == 0 ? other : at);
    }
  }
  return out;
}

/** Whether a record asks for extents (pw_kernels.p2g_extent). */
static inline bool asks(const pw_real *rec)
{
  return rec[PW_SURFACE_ASKS] < PW_HUGE;
}

/** How far a polygon reaches along the three directions of a record (pw_kernels.p2g_extent). */
static inline void raise_extents(pw_real *rec, const convex *p)
{
  const pw_real n[6] = {
      rec[0], rec[1], rec[2], rec[3], rec[4] * (rec[0] + rec[2]), rec[4] * (rec[1] + rec[3])};
  for (int d = 0; d < 3; d++) {
    pw_real *extent = rec + PW_SURFACE_EXTENT + d;
    for (int k = 0; k < p->n; k++) {
      const pw_real along = n[2 * d] * p->x[0][k] + n[2 * d + 1] * p->x[1][k];
      *extent = along > *extent ? along : *extent;
    }
  }
}

/** Scatter what @p set selects; always a literal, so unused terms are compiled away. */
enum { SET_MOMENTUM = 1, SET_FORCE = 2 };

#define PW_PASTE_(a, b)  a##_##b
#define PW_PASTE(a, b)   PW_PASTE_(a, b)
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

/** Four and two reals in a register. Values are put together in registers: written one by one to
 *  an array and read back as a vector, they would wait for the stores. */
typedef pw_real real4 __attribute__((vector_size(4 * sizeof(pw_real))));
typedef pw_real real2
    __attribute__((vector_size(2 * sizeof(pw_real)), aligned(sizeof(pw_real)), may_alias));

/** What a vertex adds to the nodes of its element: slots 0-3 and slots 4, 5 of their records. */
typedef struct vertex_value {
  real4 low;
  pw_real high[2];
} vertex_value;

/** rec += w value; rec is aligned to a cache line. */
#define RECORD_ADD(rec, w, value, nhigh)                                                           \
  do {                                                                                             \
    real4 *low_ = __builtin_assume_aligned((rec), PW_ALIGN);                                       \
    *low_ += (w) * (value)->low;                                                                   \
    for (int h_ = 0; h_ < (nhigh); h_++) {                                                         \
      (rec)[4 + h_] += (w) * (value)->high[h_];                                                    \
    }                                                                                              \
  } while (0)

/** Add a vertex' value to the four nodes of its element with the bilinear weights w. */
#define ELEMENT_ADD(rec, row, w, value, nhigh)                                                     \
  do {                                                                                             \
    pw_real *r_ = (rec);                                                                           \
    RECORD_ADD(r_, (w)[0], value, nhigh);                                                          \
    RECORD_ADD(r_ + NODE, (w)[1], value, nhigh);                                                   \
    RECORD_ADD(r_ + (pw_off)(row)*NODE, (w)[2], value, nhigh);                                     \
    RECORD_ADD(r_ + (pw_off)((row) + 1) * NODE, (w)[3], value, nhigh);                             \
  } while (0)

/** v += pic (u - v) for point i; returns the kinetic energy taken out. */
static inline pw_real settle(const pw_transfer *t, pw_idx i, pw_real pic, pw_real ux, pw_real uy)
{
  pw_real *vx = &t->v[i], *vy = &t->v[t->ld + i];
  pw_real before = *vx * *vx + *vy * *vy;
  *vx += pic * (ux - *vx);
  *vy += pic * (uy - *vy);
  return 0.5 * t->mass[i] * (before - *vx * *vx - *vy * *vy);
}

/** Row of an element number; exact below 2^52 / cells. */
static inline pw_idx element_row(pw_idx e, pw_real inv_cells)
{
  return (pw_idx)(((pw_real)e + 0.5) * inv_cells);
}

#endif /* PW_KERNELS_TRANSFER_COMMON_H */
