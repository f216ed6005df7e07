/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/core/key.h
 * @brief Input keys as tables: name with unit, type, range, default, meaning (layer 0).
 *
 * Every quantity a scene may set is one row of a pw_key table that stands beside the code which
 * uses it (materials, effects, engine/scene.c). The scene reader, `pilewright keys`, range checks
 * and defaults are all driven by these rows. A row names the place of its value by offset into
 * the struct its table describes; the C type stored there follows from @ref pw_key_type.
 */
#ifndef PW_CORE_KEY_H
#define PW_CORE_KEY_H

#include "engine/core/types.h"

enum { PW_NAME = 64, PW_LIST = 64, PW_FILE_NAME = 256 };

/** What a key holds, and the C type at its offset. */
typedef enum pw_key_type {
  PW_KEY_REAL,     /**< pw_real, finite */
  PW_KEY_PAIR,     /**< pw_real[2], written [a, b] */
  PW_KEY_TRIPLE,   /**< pw_real[3], written [x, y, z] */
  PW_KEY_REALS,    /**< pw_reals, written [a, b, ...], at most PW_LIST */
  PW_KEY_INT,      /**< int */
  PW_KEY_BOOL,     /**< bool, written true | false */
  PW_KEY_CHOICE,   /**< int: index into pw_key.choices */
  PW_KEY_TEXT,     /**< char[PW_NAME] */
  PW_KEY_FILE,     /**< char[PW_FILE_NAME]: a path, relative to the file it is written in */
  PW_KEY_BODY,     /**< int: index of a body of the scene, -1 when absent */
  PW_KEY_MATERIAL, /**< int: index of a material of the scene */
} pw_key_type;

typedef struct pw_reals {
  int n;
  pw_real v[PW_LIST];
} pw_reals;

/** One input key. A table ends with a row whose name is NULL. */
typedef struct pw_key {
  const char *name; /**< as written in the scene, unit included: "cell_m" */
  pw_key_type type;
  size_t offset;        /**< bytes from the start of the table's struct */
  pw_real lo, hi;       /**< accepted range, inclusive, for each number */
  const char *fallback; /**< default as it would be written; NULL: the key is required */
  const char *choices;  /**< for PW_KEY_CHOICE: "musl|usl|usf", in index order; else NULL */
  const char *needs;    /**< effect that must be in the scene, or "sibling=a|b": a choice that a key
                             of the same section must have; or NULL */
  const char *meaning;  /**< one line for `pilewright keys` */
} pw_key;

/** Smallest accepted number where any positive one is; where any finite one is, PW_HUGE ends the range. */
#define PW_TINY 1e-300

#endif /* PW_CORE_KEY_H */
