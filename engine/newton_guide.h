/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/newton_guide.h
 * @brief Increments whose substeps materials repeat while Newton's method converges (layer 3).
 *
 * A material that integrates an increment in substeps chooses their number and sizes by that
 * increment: its stress jumps, within its tolerance, where the choice changes, and no iteration gets
 * below such a jump. Once the iterates of a part are near its end, their increments are kept, and from
 * then on the substeps are those of the increments kept (pw_stress_args.guide): the stress is a smooth
 * function again, whose derivative the tangent is.
 */
#ifndef PW_ENGINE_NEWTON_GUIDE_H
#define PW_ENGINE_NEWTON_GUIDE_H

#include "engine/core/mem.h"
#include "kernels/material.h"

enum { PW_GUIDE_ROWS = 10 }; /**< strain, spin, volume ratio */

typedef struct pw_newton_guide {
  pw_real *of; /**< [PW_GUIDE_ROWS][ld] of the points; NULL: no material takes substeps */
  size_t ld;
  bool settled; /**< they are repeated; else those of the last evaluation are written here */
} pw_newton_guide;

/** @brief Allocate for points of leading dimension @p ld. */
static inline pw_status pw_guide_create(pw_newton_guide *g, pw_idx ld)
{
  g->ld = (size_t)ld;
  return pw_mem_alloc("points: increments to repeat", PW_GUIDE_ROWS * (pw_off)ld, sizeof *g->of,
                      &g->of);
}

/** @brief Row @p c of the increments at hand; [][ldi]. */
static inline const pw_real *pw_guide_row(const pw_stress_args *a, size_t c)
{
  const size_t l = (size_t)a->ldi;
  return c < 6 ? a->dstrain + c * l : c < 9 ? a->spin + (c - 6) * l : a->dvol;
}

/**
 * @brief Set a->guide for point @p k of a batch, which is point @p i of all.
 * @param[out] batch [PW_GUIDE_ROWS][ldi] those to repeat
 */
static inline void pw_guide_point(const pw_newton_guide *g, size_t i, size_t k, pw_stress_args *a,
                                  pw_real *batch)
{
  for (size_t c = 0; c < PW_GUIDE_ROWS; c++) {
    pw_real *kept = g->of + c * g->ld + i;
    if (g->settled) {
      batch[c * (size_t)a->ldi + k] = *kept;
    } else {
      *kept = pw_guide_row(a, c)[k];
    }
  }
  a->guide = g->settled ? batch : NULL;
}

#endif /* PW_ENGINE_NEWTON_GUIDE_H */
