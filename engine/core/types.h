/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/core/types.h
 * @brief Number types, alignment and padding shared by every layer (layer 0).
 */
#ifndef PW_CORE_TYPES_H
#define PW_CORE_TYPES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef double pw_real; /**< every physical quantity, SI units */
typedef int32_t pw_idx; /**< point, node, element, block index */
typedef int64_t pw_off; /**< offsets into CSR arrays, byte and step counts */

#define PW_PI 3.14159265358979323846

enum {
  PW_ALIGN = 64, /**< bytes; one cache line, one AVX-512 vector */
  PW_LANES = 8,  /**< doubles in one alignment unit; arrays are padded to a multiple of it */
  PW_CHUNK = 64, /**< points handled at once by the fused point loops: sizes their stack scratch */
  PW_MAX_BODIES = 8,
  PW_MAX_FIELDS = 2 /**< velocity fields on the grid: 2 when a contact effect is on */
};

/** @brief @p n rounded up to a multiple of PW_LANES. */
static inline pw_idx pw_pad(pw_idx n)
{
  return (n + PW_LANES - 1) / PW_LANES * PW_LANES;
}

static inline pw_real pw_min(pw_real a, pw_real b)
{
  return a < b ? a : b;
}
static inline pw_real pw_max(pw_real a, pw_real b)
{
  return a > b ? a : b;
}

/** Larger than any quantity. */
#define PW_HUGE 1e300

#endif /* PW_CORE_TYPES_H */
