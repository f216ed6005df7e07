/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/pictures.h
 * @brief PNG pictures of fields and histories, drawn by gnuplot (layer 4).
 *
 * Fields: each point as its filled domain, coloured, with colour bar and unit, equal axes, the
 * outline of the pile or interface as a line. When some bodies have a mobilised friction angle
 * (soil) the others (a pile) are grey and do not count for the colour range. Which fields: the
 * vertical and radial (plane strain: horizontal) stress, void ratio, mobilised friction angle
 * where the materials have them; mean stress and speed where no material has them.
 *
 * All pictures of a quantity in one folder have one colour range, that of all of them: while a run
 * goes on, of those drawn so far; pw_pictures_finish draws the earlier ones again.
 */
#ifndef PW_IO_PICTURES_H
#define PW_IO_PICTURES_H

#include "engine/sim.h"

/**
 * @brief Pictures of the fields now: FOLDER/vertical_stress_t02.000s.png and so on, with more
 *        decimals where pictures are less than 1 ms apart. The folder is made when missing.
 * @return PW_OK; PW_ERR_UNSUPPORTED when there is no gnuplot, with the name of the package;
 *         PW_ERR_FILE when gnuplot failed, with its message, or the file cannot be written;
 *         PW_ERR_MEMORY.
 */
pw_status pw_pictures_fields(const char *folder, const pw_sim *sim);

/**
 * @brief At the end of a run: give all pictures of a quantity the same colour range and remove the
 *        files kept for that ("name.png.field"). A missing folder is fine.
 * @return as pw_pictures_fields.
 */
pw_status pw_pictures_finish(const char *folder);

/**
 * @brief Pictures of the columns of @p history (a file of io/history.h) against time:
 *        penetration.png, energy.png, position.png, force.png, those that have columns.
 * @param[in] title of the scene
 * @return as pw_pictures_fields; PW_ERR_FILE when @p history cannot be read.
 */
pw_status pw_pictures_curves(const char *folder, const char *history, const char *title);

#endif /* PW_IO_PICTURES_H */
