/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/core/record.h
 * @brief Named numbers on their way to history.csv and summary.json (layer 0).
 *
 * Names carry their unit as the last part: "penetration_m". An owner calls the same puts, in the
 * same order, every time, so that the names of the first row are the header of the file.
 */
#ifndef PW_CORE_RECORD_H
#define PW_CORE_RECORD_H

#include "engine/core/types.h"

enum { PW_RECORD_MAX = 256, PW_RECORD_ARRAY = 128 };

/** One named value; count > 1 or array == true marks a list (set_per_blow_m). */
typedef struct pw_record_item {
  char name[64];
  pw_real value;        /**< when array is NULL */
  const pw_real *array; /**< borrowed from the owner until the record is dropped, or NULL */
  int count;            /**< elements of array */
} pw_record_item;

typedef struct pw_record {
  int n;
  int asked; /**< puts since n was 0, those with no room included */
  pw_record_item item[PW_RECORD_MAX];
} pw_record;

/** @brief Append @p name = @p value; only counted when the record is full. */
void pw_record_put(pw_record *r, const char *name, pw_real value);

/** @brief Append a list; @p array is borrowed. */
void pw_record_put_array(pw_record *r, const char *name, const pw_real *array, int count);

#endif /* PW_CORE_RECORD_H */
