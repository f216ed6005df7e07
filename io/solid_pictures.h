/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/solid_pictures.h
 * @brief Pictures of a plane cut through a solid scene, drawn by gnuplot (layer 4).
 *
 * Every element that the plane cuts is drawn as the polygon they have in common, coloured by the
 * mean of its points; elements without points are left out. One colour range for all pictures of a
 * quantity, as in io/pictures.h.
 */
#ifndef PW_IO_SOLID_PICTURES_H
#define PW_IO_SOLID_PICTURES_H

#include "engine/implicit.h"

/** @brief Pictures of the mean and of the von Mises stress now: FOLDER/mean_stress_t020.000s.png.
 *  @return as pw_pictures_fields(). */
pw_status pw_solid_pictures(const char *folder, const pw_implicit *sim);

#endif /* PW_IO_SOLID_PICTURES_H */
