/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/gmsh_mesh.h
 * @brief Tetrahedral meshes from gmsh files: .msh 2.2 and 4.1, text and binary (layer 4).
 *
 * gmsh's own library reads the file. It is loaded when the first mesh is asked for and costs nothing
 * before. Ten-node tetrahedra are made straight: middles of edges move to the middles of their
 * chords. Nodes and cells are numbered by ascending tags; nodes that no element of the file has are
 * left out. The order of nodes in a cell becomes that of engine/tet_mesh.h (gmsh swaps the last two).
 */
#ifndef PW_IO_GMSH_MESH_H
#define PW_IO_GMSH_MESH_H

#include "engine/tet_mesh.h"

enum { PW_GMSH_NAME = 64 };

/** A physical group: it names a volume, a boundary, an edge or a point. */
typedef struct pw_gmsh_group {
  char name[PW_GMSH_NAME]; /**< its tag in digits when the file gives no name */
  int dim, tag;
  pw_idx nnode;
  pw_idx *node; /**< [nnode] nodes of all its elements, ascending */
  pw_idx ncell;
  pw_idx *cell; /**< [ncell] its tetrahedra, ascending; with dim 3 alone */
  pw_idx nface;
  pw_idx *face; /**< [nface][3] its triangles, those of six nodes as four; with dim 2 alone */
} pw_gmsh_group;

typedef struct pw_gmsh_mesh {
  pw_tet_input mesh;    /**< arrays are owned */
  pw_off *node_tag;     /**< [nnode] as in the file, for messages */
  pw_off *cell_tag;     /**< [ncell] likewise */
  pw_real straightened; /**< the farthest that a middle node has been moved; m */
  int ngroup;
  pw_gmsh_group *group; /**< [ngroup] ascending by dimension and tag */
} pw_gmsh_mesh;

/** @brief False when the program was built without gmsh. */
bool pw_gmsh_available(void);

/**
 * @brief Read a mesh.
 * @return PW_OK; PW_ERR_FILE for a file that cannot be read or is no gmsh mesh; PW_ERR_SCENE naming
 *         file and tags for a mesh without tetrahedra, with elements of other shapes, with linear
 *         and ten-node ones at once, or with a node that no tetrahedron has; PW_ERR_UNSUPPORTED
 *         without gmsh or where its library cannot be loaded; PW_ERR_MEMORY.
 */
pw_status pw_gmsh_read(const char *path, pw_gmsh_mesh *out);

/** How a geometry is meshed. */
typedef struct pw_gmsh_recipe {
  const char *path;    /**< a .geo script: gmsh runs it */
  const char *numbers; /**< "n=8 width=0.1": constants that it defines, or "" */
  pw_real size_factor; /**< all sizes of cells times this */
  int nodes;           /**< of a tetrahedron: 10 or 4 */
} pw_gmsh_recipe;

/**
 * @brief Mesh a geometry, on one thread: the same geometry gives the same mesh.
 * @return as pw_gmsh_read(); PW_ERR_SCENE for numbers that are none and for a geometry that gmsh
 *         cannot mesh, with its message.
 */
pw_status pw_gmsh_make(const pw_gmsh_recipe *recipe, pw_gmsh_mesh *out);

/** @brief Free; a zeroed struct is accepted. */
void pw_gmsh_destroy(pw_gmsh_mesh *m);

/**
 * @brief The group of that dimension and name.
 * @return PW_OK; PW_ERR_SCENE listing the groups there are.
 */
pw_status pw_gmsh_find(const pw_gmsh_mesh *m, int dim, const char *name,
                       const pw_gmsh_group **group);

#endif /* PW_IO_GMSH_MESH_H */
