/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/scene_keys.h
 * @brief Values of key tables: parsing the written form, storing, conditions (layer 3).
 *
 * The only place that knows which C type stands behind each pw_key_type. A material's table stores
 * every number as a pw_real (kernels/material.h); it is recognised by its address among
 * kernels/materials.def, so that callers need not care.
 */
#ifndef PW_ENGINE_SCENE_KEYS_H
#define PW_ENGINE_SCENE_KEYS_H

#include "engine/core/key.h"

/** A value on its way into a struct. */
typedef struct pw_key_value {
  int n; /**< numbers in v; 1 for INT, BOOL, CHOICE, BODY and MATERIAL (an index) */
  pw_real v[PW_LIST];
  char text[PW_FILE_NAME]; /**< for PW_KEY_TEXT and PW_KEY_FILE */
} pw_key_value;

/**
 * @brief Read a decimal number: optional sign, digits with at most one point, optional exponent;
 *        nothing before or after. Hexadecimal, "inf" and "nan" are no numbers.
 * @return true; the value may be infinite when it exceeds the range of a double.
 */
bool pw_key_number(const char *text, pw_real *out);

/** @brief Index of the choice @p word in a list "musl|usl|usf", or -1. */
int pw_key_choice(const char *choices, const char *word);

/** @brief The @p i-th choice of a list into @p out [PW_NAME]. @return false past the end. */
bool pw_key_choice_at(const char *choices, int i, char *out);

/** @brief Store @p value for the row @p key of the table @p keys in the struct at @p base. */
void pw_key_store(const pw_key *keys, const pw_key *key, const pw_key_value *value, void *base);

/** @brief The row of that name, or NULL. */
const pw_key *pw_key_find(const pw_key *keys, const char *name);

/** @brief Name of the effect @p key needs, or NULL (no condition, or one on a sibling). */
const char *pw_key_needs_effect(const pw_key *key);

/**
 * @brief The sibling row a condition "shape=disc|pile" of @p key speaks of, or NULL when it has no
 *        such condition.
 */
const pw_key *pw_key_needs_sibling(const pw_key *keys, const pw_key *key);

/** @brief Whether the sibling condition of @p key holds for the struct at @p base; true without
 *  one. Siblings are choices or booleans. */
bool pw_key_needs_met(const pw_key *keys, const pw_key *key, const void *base);

#endif /* PW_ENGINE_SCENE_KEYS_H */
