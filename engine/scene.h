/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/scene.h
 * @brief Plain description of a run: what a scene file is read into and tests fill by hand.
 *
 * Layer 3. Every section has a pw_key table (engine/scene.c, materials, effects); the reader
 * fills structs through the offsets of those tables, so a new key needs no new code there.
 */
#ifndef PW_ENGINE_SCENE_H
#define PW_ENGINE_SCENE_H

#include "engine/core/key.h"
#include "engine/core/status.h"
#include "engine/mesh.h"
#include "engine/scene_solid.h"
#include "kernels/material.h"

typedef struct pw_effect pw_effect;

typedef enum pw_geometry { PW_PLANE, PW_AXI, PW_SOLID } pw_geometry;
typedef enum pw_basis { PW_LINEAR, PW_UGIMP, PW_CPDI } pw_basis;
typedef enum pw_update { PW_MUSL, PW_USL, PW_USF, PW_IMPLICIT } pw_update;
typedef enum pw_shape { PW_SHAPE_RECTANGLE, PW_SHAPE_DISC, PW_SHAPE_PILE, PW_SHAPE_RING } pw_shape;
/** How a body is described: by material points, or as a structure (engine/structure.h). */
typedef enum pw_body_kind { PW_BODY_POINTS, PW_BODY_RIGID, PW_BODY_ROD } pw_body_kind;
typedef enum pw_tip { PW_TIP_FLAT, PW_TIP_ROUNDED, PW_TIP_CONICAL } pw_tip;

enum {
  PW_MAX_MATERIALS = 16,
  PW_MAX_EFFECTS = 32,
  PW_MAX_REFINE = 8,
  PW_EFFECT_BYTES = 512 /**< largest parameter struct of an effect */
};

/** One entry of `materials:`; @p param is in the order of model->keys. */
typedef struct pw_scene_material {
  char name[PW_NAME];
  const pw_material *model;
  pw_real param[PW_MAX_PARAMS];
} pw_scene_material;

/** One entry of a body's `refine:` list: points in the box get this size or smaller. */
typedef struct pw_scene_refine {
  pw_real x_m[2], y_m[2];
  pw_real point_size_m;
  int points_per_cell; /**< of a body with points_per_cell, in each direction */
} pw_scene_refine;

/** One entry of `bodies:`. */
typedef struct pw_scene_body {
  char name[PW_NAME];
  int material;                  /**< index into pw_scene.material */
  int kind;                      /**< pw_body_kind */
  int shape;                     /**< pw_shape */
  pw_real x_m[2], y_m[2];        /**< rectangle: extent */
  pw_real centre_m[2], radius_m; /**< disc, ring, and the pile's radius */
  pw_real inner_radius_m;        /**< ring */
  pw_real angle_deg[2];          /**< ring: from, to; anticlockwise from the x axis */
  pw_real tip_y_m, length_m;     /**< pile: height of its lowest point, whole length */
  int tip;                       /**< pw_tip */
  pw_real tip_length_m;          /**< pile: height of the rounded or conical part */
  pw_real point_size_m;          /**< edge of the largest domains; 0 with points_per_cell */
  int points_per_cell;           /**< domains in a cell in each direction; 0: by point_size_m */
  pw_real hole_centre_m[2];      /**< rectangle: domains centred in this circle are left out */
  pw_real hole_radius_m;         /**< 0: no hole */
  pw_real mass_kg;               /**< rigid: of the whole body; 0: from density and volume */
  int rod_elements;              /**< rod: elements along its length */
  pw_real surface_segment_m;     /**< rigid, rod: pieces of its surface; 0: chosen */
  pw_real velocity_m_s[2];
  char volume[PW_NAME];        /**< solid: group of the mesh that it fills; "": all of it */
  pw_real low_m[3], high_m[3]; /**< solid: box of the cells filled; equal: all */
  int nrefine;
  pw_scene_refine refine[PW_MAX_REFINE];
} pw_scene_body;

/** One entry of an effect's section. */
typedef struct pw_scene_effect {
  const pw_effect *type;
  _Alignas(16) unsigned char param[PW_EFFECT_BYTES]; /**< the effect's own parameter struct */
} pw_scene_effect;

struct pw_scene {
  char title[PW_NAME];
  char file[256]; /**< where it was read from, for reports; may be "" */
  int geometry;   /**< pw_geometry */
  pw_grid grid;
  struct {
    pw_real end_s, cfl, dt_max_s, dt_s; /**< dt_s > 0 fixes the step */
  } time;
  struct {
    int basis, update;           /**< pw_basis, pw_update */
    pw_real domain_limit_cells;  /**< half diagonal of a domain at most; 0: no limit */
    pw_real domain_aspect_max;   /**< longest to shortest half-side of a domain; 0: no limit */
    pw_real mass_cut_off;        /**< of the mass of a full cell's node; nodes below are passive */
    pw_real noise_damping_per_s; /**< rate at which points' velocities approach the grid's */
    int mass_terms;              /**< of the full mass matrix's inverse; 1: lumped masses */
    int step_ratio_max;          /**< most short steps that slow points take at once; 1: none */
    int block_elements;          /**< elements in a METIS block; 0: chosen from the grid */
  } method;
  struct {
    pw_real history_every_s, snapshot_every_s, checkpoint_every_s;
    bool paraview, pictures, picture_cell_mean;
    pw_reals picture_times_s;               /**< besides the end */
    pw_real picture_x_m[2], picture_y_m[2]; /**< window; equal ends: the whole grid */
  } output;
  int nmaterial, nbody, neffect;
  pw_scene_material material[PW_MAX_MATERIALS];
  pw_scene_body body[PW_MAX_BODIES];
  pw_scene_effect effect[PW_MAX_EFFECTS];
  pw_scene_solid solid; /**< with geometry PW_SOLID, instead of grid, time.cfl and method */
};

/** Key tables of the scene's own sections; offsets are into pw_scene for the first five. */
extern const pw_key pw_scene_keys_top[];    /**< title, geometry */
extern const pw_key pw_scene_keys_grid[];   /**< grid: */
extern const pw_key pw_scene_keys_time[];   /**< time: */
extern const pw_key pw_scene_keys_method[]; /**< method: */
extern const pw_key pw_scene_keys_output[]; /**< output: */
extern const pw_key pw_scene_keys_body[];   /**< an entry of bodies: offsets into pw_scene_body */
extern const pw_key pw_scene_keys_refine[]; /**< an entry of refine: into pw_scene_refine */

/** @brief Write the fallbacks of a key table into the struct at @p base. */
void pw_scene_defaults(const pw_key *keys, void *base);

/** @brief An empty scene with every default; no bodies, materials or effects. */
void pw_scene_default(pw_scene *out);

/**
 * @brief Rules that tie keys together (shapes inside the grid, materials' own checks, effects'
 *        own checks); single values were checked against their key rows before.
 * @return PW_OK; PW_ERR_SCENE with the rule and the section it concerns.
 */
pw_status pw_scene_check(const pw_scene *scene);

/** @brief Add an effect by name with its defaults. @return its parameter struct, or NULL when
 *  there is no such effect or no room. */
void *pw_scene_add_effect(pw_scene *scene, const char *name);

/** @brief Parameter struct of the first effect of that name in the scene, or NULL. */
const void *pw_scene_find_effect(const pw_scene *scene, const char *name);

/** @brief Index of the body of that name, or -1. */
int pw_scene_find_body(const pw_scene *scene, const char *name);

/** @brief Density of a stress-free point of body @p b; kg/m3. */
pw_real pw_scene_density(const pw_scene *scene, int b);

#endif /* PW_ENGINE_SCENE_H */
