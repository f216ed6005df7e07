/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/element_run.h
 * @brief Running an element test: its stages, a CSV file, curves (layer 4).
 */
#ifndef PW_IO_ELEMENT_RUN_H
#define PW_IO_ELEMENT_RUN_H

#include "io/element_file.h"
#include "io/run.h"

/** What the command line asks for; all texts borrowed. */
typedef struct pw_element_options {
  const char *test_file;
  const char *out; /**< folder; NULL: out/NAME of the file */
  int nset;
  const char *const *set; /**< [nset] "key.path=value" */
} pw_element_options;

/**
 * @brief Read a test, run it, write FOLDER/element.csv and FOLDER/pictures.
 * @param[in] out where it says what was written
 * @param[in] err messages of what went wrong
 * @return exit status as of pw_run(); after a failed step the rows before it are written.
 */
pw_exit pw_element_main(const pw_element_options *options, FILE *out, FILE *err);

/** @brief Draw the curves of a CSV file into a folder as PNG and SVG files.
 *  @return PW_OK; PW_ERR_UNSUPPORTED without gnuplot; PW_ERR_FILE. */
pw_status pw_element_curves(const char *folder, const char *csv, const pw_element_test *t);

/** @brief Print the keys of element tests. */
void pw_element_keys_print(FILE *out);

enum { PW_ELEMENT_COLUMNS = 23 /**< those before the state variables */ };

/** @brief Name of column @p i (0 .. PW_ELEMENT_COLUMNS - 1). */
const char *pw_element_column(int i);

#endif /* PW_IO_ELEMENT_RUN_H */
