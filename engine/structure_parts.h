/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/structure_parts.h
 * @brief What the files of engine/structure*.c share (layer 3, internal).
 */
#ifndef PW_ENGINE_STRUCTURE_PARTS_H
#define PW_ENGINE_STRUCTURE_PARTS_H

#include "engine/structure.h"

/** Integrals over a slice of a shape per unit of density; per radian or metre. */
typedef struct pw_slice {
  pw_real vol;   /**< int dV; m3 */
  pw_real y;     /**< int y dV; m4 */
  pw_real yy;    /**< int y^2 dV; m5 */
  pw_real wide2; /**< int x^2 dV, x from the body's middle or the axis; m5 */
} pw_slice;

/** @brief Integrals of a body's exact shape between the heights @p y0 and @p y1, to rounding. */
pw_slice pw_shape_slice(const pw_scene *scene, int body, pw_real y0, pw_real y1);

/** @brief Lowest and highest place of a body, and its middle (axisymmetry: the axis).
 *  @param[out] y [2] m @return x of the middle; m */
pw_real pw_shape_extent(const pw_scene *scene, int body, pw_real *y);

void pw_rigid_create(const pw_scene *scene, int body, pw_rigid *out);
void pw_rigid_kick(pw_structure *s, pw_real dt, const pw_real *given);
void pw_rigid_drift(pw_structure *s, pw_real dt);
void pw_rigid_place(const pw_structure *s, pw_idx node, pw_real *x, pw_real *v);
void pw_rigid_add(pw_structure *s, const pw_real *x, const pw_real *f, bool load);
pw_status pw_rigid_archive(pw_rigid *r, const char *name, pw_archive *ar);

pw_status pw_rod_create(const pw_scene *scene, int body, pw_rod *out);
void pw_rod_destroy(pw_rod *rod);
void pw_rod_kick(pw_structure *s, pw_real dt, const pw_real *given);
void pw_rod_drift(pw_structure *s, pw_real dt);
void pw_rod_place(const pw_structure *s, pw_idx node, pw_real *x, pw_real *v);
/** @brief Add an axial force at height @p y0 of the start. */
void pw_rod_add(pw_rod *rod, pw_real y0, pw_real f);
void pw_rod_add_weight(pw_rod *rod, pw_real a);
pw_real pw_rod_kinetic(const pw_rod *rod);
pw_real pw_rod_strain(const pw_rod *rod);
pw_status pw_rod_archive(pw_rod *rod, const char *name, pw_archive *ar);

#endif /* PW_ENGINE_STRUCTURE_PARTS_H */
