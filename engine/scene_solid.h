/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/scene_solid.h
 * @brief What a scene of `geometry: solid` says: mesh, load steps, outputs (layer 3).
 *
 * Such a scene is run by the implicit half (engine/implicit.h). Its materials and bodies are those
 * of pw_scene, its effects those of engine/solid_effects.def.
 */
#ifndef PW_ENGINE_SCENE_SOLID_H
#define PW_ENGINE_SCENE_SOLID_H

#include "engine/core/key.h"
#include "engine/core/status.h"

typedef struct pw_scene pw_scene;

typedef enum pw_mesh_kind { PW_MESH_BOX, PW_MESH_FILE } pw_mesh_kind;
typedef enum pw_mesh_cells { PW_CELLS_TEN_NODE, PW_CELLS_LINEAR } pw_mesh_cells;

/** `mesh:` of a solid scene. */
typedef struct pw_scene_mesh {
  int kind;                               /**< pw_mesh_kind */
  char file[PW_FILE_NAME];                /**< gmsh mesh (.msh) or geometry (.geo) */
  char numbers[PW_NAME];                  /**< "n=8 w=0.1": constants of a .geo file */
  pw_real size_factor;                    /**< of all sizes of cells of a .geo file */
  int cells;                              /**< pw_mesh_cells; a .msh file says itself */
  int diagonal;                           /**< pw_tet_diagonal */
  pw_real low_m[3], high_m[3], bricks[3]; /**< box */
  int tets_per_brick;
} pw_scene_mesh;

/** `implicit:` of a solid scene; of it, scenes with a grid use `steps` and, from `tolerance` on,
 *  all but mechanisms. */
typedef struct pw_scene_implicit {
  int steps;
  pw_real step_s;
  int fbar;       /**< pw_fbar */
  int point_rule; /**< pw_tet_rule */
  int points_per; /**< 0: element, 1: ten-node tetrahedron */
  bool negative_volumes;
  pw_real tolerance;
  int max_iterations, max_cuts;
  bool adaptive;
  pw_real step_least, step_most; /**< adaptive: in load steps */
  int easy_iterations, hard_iterations;
  int approach, line_search;
  bool cut_driven;
  bool from_previous;
  int mechanisms; /**< pw_mechanisms */
  int solver;     /**< pw_solver_engine */
} pw_scene_implicit;

/** `output:` of a solid scene, in load steps. */
typedef struct pw_scene_solid_output {
  int history_every_steps, snapshot_every_steps, checkpoint_every_steps;
  pw_reals picture_steps;
  int slice_axis;     /**< 0, 1, 2: normal of the cut that pictures show */
  pw_real slice_part; /**< where, as a part of the mesh's extent */
} pw_scene_solid_output;

typedef struct pw_scene_solid {
  pw_scene_mesh mesh;
  pw_scene_implicit implicit;
  pw_scene_solid_output output;
} pw_scene_solid;

/** Key tables; offsets are into pw_scene, of the last one into pw_scene_body. */
extern const pw_key pw_scene_keys_mesh[];          /**< mesh: */
extern const pw_key pw_scene_keys_implicit[];      /**< implicit: */
extern const pw_key pw_scene_keys_grid_implicit[]; /**< implicit: of scenes with a grid */
extern const pw_key pw_scene_keys_solid_output[];  /**< output: */
extern const pw_key pw_scene_keys_solid_body[];    /**< an entry of bodies: */

/** @brief Times of the run and of its outputs from numbers of steps. Called when a scene has been
 *  filled; changes nothing the second time. */
void pw_scene_solid_times(pw_scene *scene);

/** @brief Rules of `mesh:`. @return PW_OK or PW_ERR_SCENE, beginning with the key. */
pw_status pw_scene_check_mesh(const pw_scene *scene);

/** @brief Rules of `implicit:`. @return likewise. */
pw_status pw_scene_check_implicit(const pw_scene *scene);

/** @brief Rules of body @p i of a solid scene. @return likewise. */
pw_status pw_scene_check_solid_body(const pw_scene *scene, int i);

#endif /* PW_ENGINE_SCENE_SOLID_H */
