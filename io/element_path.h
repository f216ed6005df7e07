/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/element_path.h
 * @brief Strain paths of element tests from CSV files (layer 4).
 */
#ifndef PW_IO_ELEMENT_PATH_H
#define PW_IO_ELEMENT_PATH_H

#include "engine/core/status.h"

/** Strains and turns of a path, from its start. */
typedef struct pw_element_path {
  int n;
  pw_real (*row)[9]; /**< [n] xx yy zz xy yz zx (tensor shears), spin xy yz zx in rad */
} pw_element_path;

/**
 * @brief Read a path: a header line with column names, then one line of numbers a row.
 * @return PW_OK; PW_ERR_FILE with "file:line: what is wrong"; PW_ERR_MEMORY.
 */
pw_status pw_element_path_read(const char *file, pw_element_path *out);

/** @brief Free a path; an empty one is accepted. */
void pw_element_path_free(pw_element_path *path);

#endif /* PW_IO_ELEMENT_PATH_H */
