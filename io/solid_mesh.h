/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/solid_mesh.h
 * @brief The mesh a solid scene names: a box, a mesh file, or a geometry that gmsh meshes (layer 4).
 */
#ifndef PW_IO_SOLID_MESH_H
#define PW_IO_SOLID_MESH_H

#include "engine/solid_mesh.h"

/**
 * @brief Make or read the mesh of a scene.
 * @return PW_OK; as pw_gmsh_read() and pw_gmsh_make(), PW_ERR_FILE becoming PW_ERR_SCENE and the
 *         text beginning with "mesh.file"; PW_ERR_MEMORY.
 */
pw_status pw_solid_mesh_load(const pw_scene *scene, pw_solid_mesh *out);

/** @brief The geometry that gmsh is going to mesh for the scene, which may take long. @return its
 *  name, borrowed; NULL where there is none. */
const char *pw_solid_mesh_geometry(const pw_scene *scene);

#endif /* PW_IO_SOLID_MESH_H */
