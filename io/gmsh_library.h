/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/gmsh_library.h
 * @brief gmsh's library, loaded when it is first asked for (layer 4, internal).
 */
#ifndef PW_IO_GMSH_LIBRARY_H
#define PW_IO_GMSH_LIBRARY_H

#include "io/gmsh_mesh.h"

#ifdef PW_GMSH_LIBRARY

#include <gmshc.h>

/* Functions of the library that are used. */
#define PW_GMSH_CALLS(X)                                                                           \
  X(gmshInitialize)                                                                                \
  X(gmshFinalize)                                                                                  \
  X(gmshFree)                                                                                      \
  X(gmshOpen)                                                                                      \
  X(gmshClear)                                                                                     \
  X(gmshWrite)                                                                                     \
  X(gmshLoggerGetLastError)                                                                        \
  X(gmshOptionSetNumber)                                                                           \
  X(gmshModelGetPhysicalGroups)                                                                    \
  X(gmshModelGetPhysicalName)                                                                      \
  X(gmshModelGetEntitiesForPhysicalGroup)                                                          \
  X(gmshModelMeshGenerate)                                                                         \
  X(gmshModelMeshSetOrder)                                                                         \
  X(gmshModelMeshGetElementTypes)                                                                  \
  X(gmshModelMeshGetElementsByType)                                                                \
  X(gmshModelMeshGetNodes)                                                                         \
  X(gmshModelMeshGetNodesForPhysicalGroup)

#define PW_GMSH_MEMBER(name) __typeof__(name) *name;
typedef struct pw_gmsh_library {
  void *handle;
  PW_GMSH_CALLS(PW_GMSH_MEMBER)
} pw_gmsh_library;

/**
 * @brief Start gmsh with a mesh open: that of a file, or one made by a recipe.
 * @param[in] recipe NULL: @p path is a mesh file
 * @return as pw_gmsh_read() and pw_gmsh_make(); only after PW_OK is pw_gmsh_close() to be called.
 */
pw_status pw_gmsh_open(const char *path, const pw_gmsh_recipe *recipe,
                       const pw_gmsh_library **library);

/** @brief End what pw_gmsh_open() has started. */
void pw_gmsh_close(const pw_gmsh_library *library);

#endif /* PW_GMSH_LIBRARY */

#endif /* PW_IO_GMSH_LIBRARY_H */
