/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/pictures_series.h
 * @brief One colour range for all pictures of a quantity in a run (layer 4).
 *
 * The range of a run is known at its end only. So each picture is drawn as soon as its data are
 * there, with the range of all pictures so far, and its data stay beside it ("name.png.field", a
 * script for gnuplot whose first line holds the ranges) until the end of the run, when those are
 * drawn again whose range has become wider since. A run that is resumed finds them.
 */
#ifndef PW_IO_PICTURES_SERIES_H
#define PW_IO_PICTURES_SERIES_H

#include <stdio.h>

#include "engine/core/status.h"
#include "io/atomic_file.h"

enum { PW_SERIES_NAME = 48 };

typedef struct pw_series_picture {
  char quantity[PW_SERIES_NAME]; /**< start of the file's name */
  char unit[PW_SERIES_NAME];     /**< "stress": Pa, kPa or MPa as the range asks; "-": none */
  pw_real own[2];                /**< colour range of this picture's own data; SI */
  pw_real drawn[2];              /**< colour range it was drawn with; SI */
  int width, height;             /**< pixels */
} pw_series_picture;

/**
 * @brief Open the file of the data of picture FOLDER/NAME; print to @p data what draws it, with the
 *        variable SCALE for the factor from SI to the unit shown, UNIT for that unit's text, and
 *        values up to the commands' end in SI. The colour range is set already.
 * @param[in,out] p drawn is set to the range of all pictures of this quantity in the folder
 * @return PW_OK; PW_ERR_FILE.
 */
pw_status pw_series_open(const char *folder, const char *name, pw_series_picture *p, FILE **data);

/** @brief Close @p data and draw the picture. @return as pw_plot_end. */
pw_status pw_series_draw(const char *folder, const char *name, FILE *data);

/** @brief Draw again what has an outdated range, and remove all data files of @p folder.
 *  @return as pw_plot_end, the first failure; a missing folder is fine. */
pw_status pw_series_finish(const char *folder);

#endif /* PW_IO_PICTURES_SERIES_H */
