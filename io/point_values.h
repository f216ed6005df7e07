/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/point_values.h
 * @brief What output shows of a point: its domain, its material's states, friction angle (layer 4).
 */
#ifndef PW_IO_POINT_VALUES_H
#define PW_IO_POINT_VALUES_H

#include "engine/sim.h"

/** Component of points' state that holds a state variable, for each body; -1: it has none. */
typedef struct pw_state_column {
  const char *name; /**< with unit, of the material's table */
  int component[PW_MAX_BODIES];
} pw_state_column;

enum { PW_MAX_STATE_COLUMNS = 32 };

/**
 * @brief State variables marked for output of all bodies' materials, each name once.
 * @param[out] column [PW_MAX_STATE_COLUMNS]
 * @return their number.
 */
int pw_state_columns(const pw_scene *scene, pw_state_column *column);

/** @brief State variable of point @p i; NaN when its material has none. */
pw_real pw_point_state(const pw_points *p, const pw_state_column *column, pw_idx i);

/** @brief True when the material of body @p b gives a mobilised friction angle: soil. */
bool pw_body_has_angle(const pw_scene *scene, int b);

/** @brief Mobilised friction angle (Matsuoka-Nakai) of point @p i; degrees; NaN without one. */
pw_real pw_point_angle_deg(const pw_scene *scene, const pw_points *p, pw_idx i);

/** @brief True when points carry domains (half-side vectors). */
bool pw_points_have_domains(const pw_points *p);

/**
 * @brief Corners of the domain of point @p i, in order round it.
 * @param[out] xy [4][2] m
 */
void pw_point_corners(const pw_points *p, pw_idx i, pw_real *xy);

#endif /* PW_IO_POINT_VALUES_H */
