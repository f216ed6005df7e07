/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/scene_check.h
 * @brief Rules across the keys of a scene, one function for each section (layer 3).
 *
 * pw_scene_check (engine/scene.h) calls them all and stops at the first broken rule; the scene
 * reader calls them one by one, to report every section at its place in the file. Messages begin
 * with the key they concern where there is one. Single values are taken as checked against their
 * key rows. Every function returns PW_OK, or PW_ERR_SCENE with the broken rule.
 */
#ifndef PW_ENGINE_SCENE_CHECK_H
#define PW_ENGINE_SCENE_CHECK_H

#include "engine/scene.h"

/** @brief Whole numbers of cells, a grid that fits in memory, r >= 0 in axisymmetry. */
pw_status pw_scene_check_grid(const pw_scene *scene);

/** @brief Time step limits that do not contradict each other. */
pw_status pw_scene_check_time(const pw_scene *scene);
pw_status pw_scene_check_method(const pw_scene *scene);

/** @brief `implicit:` of a scene with a grid. */
pw_status pw_scene_check_grid_implicit(const pw_scene *scene);

/** @brief Windows of the pictures. */
pw_status pw_scene_check_output(const pw_scene *scene);

/** @brief Unique name and the model's own rules for material @p i. */
pw_status pw_scene_check_material(const pw_scene *scene, int i);

/** @brief Unique name, material, shape inside the grid, sizes of points for body @p i. */
pw_status pw_scene_check_body(const pw_scene *scene, int i);

/** @brief Rules for entry @p i of the effects: not given twice, one contact at most, bodies that
 *  exist, materials that take an initial stress, the effect's own rules. */
pw_status pw_scene_check_effect(const pw_scene *scene, int i);

/**
 * @brief Place of effect @p i in a scene file: "gravity", or "boundary.2" when its section is a
 *        list (entries counted from 0).
 * @param[out] out [PW_NAME + 16]
 */
void pw_scene_effect_path(const pw_scene *scene, int i, char *out);

#endif /* PW_ENGINE_SCENE_CHECK_H */
