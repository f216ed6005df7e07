/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/pictures_plot.h
 * @brief One PNG or SVG file from one gnuplot script (layer 4).
 *
 * The script, data included, is a file beside the picture ("name.png.gp") that is removed when
 * gnuplot has read it; the picture is checked for completeness before it replaces an old one.
 */
#ifndef PW_IO_PICTURES_PLOT_H
#define PW_IO_PICTURES_PLOT_H

#include <stdio.h>

#include "engine/core/status.h"
#include "io/atomic_file.h"

typedef struct pw_plot {
  FILE *script; /**< commands are printed here between begin and end */
  char path[PW_PATH], temp[PW_PATH], commands[PW_PATH]; /**< picture, its first name, script */
} pw_plot;

/**
 * @brief Start the picture FOLDER/NAME of @p width x @p height pixels; a name that ends with .svg
 *        makes an SVG file, every other one a PNG file.
 * @return PW_OK; PW_ERR_FILE when the path is too long or the script cannot be written.
 */
pw_status pw_plot_begin(const char *folder, const char *name, int width, int height, pw_plot *out);

/** @brief Print @p text as one gnuplot string with its quotes. */
void pw_plot_text(pw_plot *plot, const char *text);

/**
 * @brief Run gnuplot on the script, check the picture and put it in place. Always ends the plot.
 * @return PW_OK; PW_ERR_UNSUPPORTED without gnuplot; PW_ERR_FILE with gnuplot's message or the
 *         reason.
 */
pw_status pw_plot_end(pw_plot *plot);

#endif /* PW_IO_PICTURES_PLOT_H */
