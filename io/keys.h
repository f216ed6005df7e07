/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/keys.h
 * @brief Listings of everything a scene may say, from the tables of the code (layer 4).
 */
#ifndef PW_IO_KEYS_H
#define PW_IO_KEYS_H

#include <stdio.h>

#include "engine/core/key.h"

enum { PW_KEY_RANGE = 64 };

/** @brief Unit of a key, from the suffix of its name: "m/s2" for "acceleration_m_s2"; "-" when it
 *  has none. */
const char *pw_key_unit(const pw_key *key);

/** @brief Accepted range of a number in words: "> 0 and <= 0.95", "0 to 90", "any"; "" for other
 *  types. @param[out] out [PW_KEY_RANGE] */
void pw_key_range(const pw_key *key, char *out);

/** @brief What a key holds, as shown to users: "number", "two numbers", ... */
const char *pw_key_type_text(pw_key_type type);

/** @brief One table of keys under a title; @p brief may be NULL. */
void pw_keys_print_table(FILE *out, const char *title, const char *brief, const pw_key *keys);

/** @brief All input keys of all sections, materials and effects with unit, type, range, default,
 *  condition and meaning. */
void pw_keys_print(FILE *out);

/** @brief Geometries, bases, updates, shapes, materials and effects with a line on each. */
void pw_list_print(FILE *out);

#endif /* PW_IO_KEYS_H */
