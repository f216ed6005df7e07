/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/solid_mesh.h
 * @brief Cells of a solid scene with the groups that name their parts (layer 3).
 *
 * Made from a box here or read from a file by io/solid_mesh.h; an implicit simulation copies what
 * it needs.
 */
#ifndef PW_ENGINE_SOLID_MESH_H
#define PW_ENGINE_SOLID_MESH_H

#include "engine/scene.h"
#include "engine/tet_mesh.h"

/** A named part: a volume, a surface, a curve or a point. */
typedef struct pw_solid_group {
  char name[PW_NAME];
  int dim; /**< 3, 2, 1 or 0 */
  pw_idx nnode;
  pw_idx *node; /**< [nnode] ascending */
  pw_idx ncell;
  pw_idx *cell; /**< [ncell] of a volume, ascending */
  pw_idx nface;
  pw_idx *face; /**< [nface][3] linear triangles of a surface */
} pw_solid_group;

typedef struct pw_solid_mesh {
  pw_tet_input input; /**< arrays are owned */
  pw_off *node_tag;   /**< [nnode] as in the file, or NULL: node + 1 */
  pw_off *cell_tag;   /**< [ncell] likewise */
  int ngroup;
  pw_solid_group *group;     /**< [ngroup] */
  char source[PW_FILE_NAME]; /**< where it is from, for messages: the file, or "box" */
} pw_solid_mesh;

/** @brief Free; a zeroed struct is accepted. */
void pw_solid_mesh_destroy(pw_solid_mesh *m);

/** @brief The box of a scene, with groups x_min .. z_max and the volume all.
 *  @return PW_OK; PW_ERR_MEMORY. */
pw_status pw_solid_mesh_box(const pw_scene *scene, pw_solid_mesh *out);

/**
 * @brief Refuse what no run could be made of, naming cells and the groups they are in.
 * @return PW_OK; PW_ERR_SCENE, beginning with the path of a key, for cells inside out or flatter
 *         than a hundred-thousandth, parts of the mesh that share no face, and linear
 *         cells where patches or points per ten-node tetrahedron are asked for; PW_ERR_MEMORY.
 */
pw_status pw_solid_mesh_check(const pw_scene *scene, const pw_solid_mesh *m);

/**
 * @brief The group of that name; @p dim 3 asks for a volume, 2 for a surface, -1 for any, of which
 *        surfaces come first.
 * @param[in] path what names it, "boundary.0.group", for the message
 * @return PW_OK; PW_ERR_SCENE listing the groups there are.
 */
pw_status pw_solid_mesh_find(const pw_solid_mesh *m, int dim, const char *name, const char *path,
                             const pw_solid_group **group);

/** @brief Tag of a cell, as in the file. */
pw_off pw_solid_cell_tag(const pw_solid_mesh *m, pw_idx cell);

#endif /* PW_ENGINE_SOLID_MESH_H */
