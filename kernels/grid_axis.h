/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/grid_axis.h
 * @brief One axis of a graded grid: places of its nodes, and the cell of a coordinate in constant
 *        time (layer 1).
 *
 * The axis is divided into bins a little narrower than its smallest cell, so a bin and a thin margin
 * around it hold at most one node: the cell of a coordinate is the one below that node or the one
 * above. The comparison with the node decides; the margin is there for round-off in the number of
 * the bin.
 */
#ifndef PW_KERNELS_GRID_AXIS_H
#define PW_KERNELS_GRID_AXIS_H

#include "engine/core/types.h"

/** A stretch of an axis that holds at most one node. */
typedef struct pw_grid_bin {
  pw_real split; /**< upper node of `cell`; beyond the axis for the last cell; m */
  pw_idx cell;   /**< that holds the lower end of the bin */
} pw_grid_bin;

typedef struct pw_grid_axis {
  pw_idx cells, nbin;
  pw_real inv_bin;  /**< 1 / width of a bin; 1/m */
  pw_real *node;    /**< [cells + 1] coordinates, rising; m */
  pw_real *size;    /**< [cells] m */
  pw_real *inv;     /**< [cells] 1 / size; 1/m */
  pw_real *near;    /**< [cells] smallest size of the cell and its neighbours; m */
  pw_grid_bin *bin; /**< [nbin] */
} pw_grid_axis;

/** @brief @p x moved to the nearest place on the axis; NaN to its lower end. */
static inline pw_real pw_grid_axis_clamp(const pw_grid_axis *a, pw_real x)
{
  x = x > a->node[0] ? x : a->node[0];
  return x < a->node[a->cells] ? x : a->node[a->cells];
}

/** @brief Cell that holds @p x, which lies on the axis: at a node the upper one, at the end of the
 *  axis the last. */
static inline pw_idx pw_grid_axis_cell(const pw_grid_axis *a, pw_real x)
{
  pw_idx b = (pw_idx)((x - a->node[0]) * a->inv_bin);
  const pw_grid_bin *bin = &a->bin[b < a->nbin ? b : a->nbin - 1];
  return bin->cell + (x >= bin->split);
}

/**
 * @brief Cells and places of @p n coordinates, at most PW_CHUNK, in two passes: the arithmetic as a
 *        SIMD loop, then the table.
 * @param[out] cell   [n]
 * @param[out] local  [n] place in the cell, 0..1; coordinates outside are moved to the edge
 * @param[in,out] far [n] becomes 1 where one was moved by more than a hundredth of the cell
 */
static inline void pw_grid_axis_locate(const pw_grid_axis *a, pw_idx n, const pw_real *restrict x,
                                       pw_idx *restrict cell, pw_real *restrict local,
                                       pw_idx *restrict far)
{
  const pw_real lower = a->node[0], upper = a->node[a->cells], inv_bin = a->inv_bin;
  const pw_real *restrict node = a->node, *restrict inv = a->inv;
  const pw_grid_bin *restrict bin = a->bin;
  const pw_idx last = a->nbin - 1;
  pw_real at[PW_CHUNK];
#pragma omp simd
  for (pw_idx i = 0; i < n; i++) {
    pw_real k = x[i] > lower ? x[i] : lower; /* NaN too */
    at[i] = k < upper ? k : upper;
    pw_idx b = (pw_idx)((at[i] - lower) * inv_bin);
    cell[i] = b < last ? b : last;
  }
  for (pw_idx i = 0; i < n; i++) {
    const pw_grid_bin *b = &bin[cell[i]];
    pw_idx k = b->cell + (at[i] >= b->split);
    cell[i] = k;
    local[i] = (at[i] - node[k]) * inv[k];
    at[i] = (x[i] - at[i]) * inv[k];
  }
#pragma omp simd
  for (pw_idx i = 0; i < n; i++) {
    far[i] |= (at[i] > 0.01) | (at[i] < -0.01);
  }
}

#endif /* PW_KERNELS_GRID_AXIS_H */
