/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/vtk_files.h
 * @brief Plain C face of VTK's XML writers and readers (layer 4).
 *
 * Implemented in io/vtk_files.cxx; io/vtk_missing.c takes its place in a build without VTK. Files
 * are raw appended, compressed with zlib level 1, and replace the old one at once
 * (io/atomic_file.h). No exception and no message of VTK leaves these functions.
 */
#ifndef PW_IO_VTK_FILES_H
#define PW_IO_VTK_FILES_H

#ifdef __cplusplus
extern "C" {
#endif

#include "engine/core/status.h"

enum { PW_VTK_NAME = 64 };

/** Values of all cells (or all nodes of a grid), components together; one of the two is set. */
typedef struct pw_vtk_array {
  char name[PW_VTK_NAME];
  int ncomp;
  const float *real;    /**< [n][ncomp] */
  const int32_t *index; /**< [n][ncomp] */
} pw_vtk_array;

typedef enum pw_vtk_kind { PW_VTK_VERTICES, PW_VTK_LINES, PW_VTK_POLYGONS } pw_vtk_kind;

/** Cells of one kind, each with its own run of vertices: cell i has [start[i], start[i + 1]). */
typedef struct pw_vtk_cells {
  pw_vtk_kind kind;
  pw_idx ncell;
  const pw_idx *start; /**< [ncell + 1] */
  const float *xy;     /**< [start[ncell]][2] m */
  const float *xyz;    /**< [start[ncell]][3] m instead, or NULL */
  int narray;
  const pw_vtk_array *array; /**< [narray] cell data */
  pw_real time_s;
} pw_vtk_cells;

/** Linear tetrahedra with values of nodes and of elements. */
typedef struct pw_vtk_tets {
  pw_idx nnode, nelem;
  const float *xyz;   /**< [nnode][3] m */
  const pw_idx *node; /**< [nelem][4] */
  int nnode_array, nelem_array;
  const pw_vtk_array *node_array, *elem_array;
  pw_real time_s;
} pw_vtk_tets;

/** A structured grid of nodes, x first. */
typedef struct pw_vtk_grid {
  pw_idx nodes[2];
  pw_real origin[2], cell; /**< m */
  const pw_real *node[2];  /**< [nodes] coordinates along an axis of a graded grid; NULL: uniform */
  int narray;
  const pw_vtk_array *array; /**< [narray] node data */
  pw_real time_s;
} pw_vtk_grid;

/** What is in a file: see pw_vtk_read_array. */
typedef struct pw_vtk_shape {
  pw_off points, cells; /**< of the whole file */
  int narray;           /**< arrays of cell data (.vtp) or node data (.vtu, .vti, .vtr) */
  int ncomp;            /**< components of the array asked for */
  pw_off count;         /**< values of it: tuples times ncomp */
  pw_real time_s;
} pw_vtk_shape;

/** @brief False in a build without VTK. */
bool pw_vtk_available(void);

/**
 * @brief Write a .vtp file.
 * @return PW_OK; PW_ERR_FILE with path and reason; PW_ERR_MEMORY; PW_ERR_UNSUPPORTED without VTK,
 *         with the name of the missing package.
 */
pw_status pw_vtk_write_cells(const char *path, const pw_vtk_cells *cells);

/** @brief Write a .vti file, of a graded grid a .vtr file. @return as pw_vtk_write_cells. */
pw_status pw_vtk_write_grid(const char *path, const pw_vtk_grid *grid);

/** @brief Write a .vtu file. @return as pw_vtk_write_cells. */
pw_status pw_vtk_write_tets(const char *path, const pw_vtk_tets *tets);

/**
 * @brief Read one array of a .vtp, .vtu, .vti or .vtr file back with VTK's own reader.
 * @param[in]  name  of the array; NULL: the coordinates of the points, three components (.vtp,
 *                   .vtu)
 * @param[out] value [max] the first @p max values
 * @return PW_OK; PW_ERR_FILE when the file cannot be read or has no such array;
 *         PW_ERR_UNSUPPORTED.
 */
pw_status pw_vtk_read_array(const char *path, const char *name, float *value, pw_off max,
                            pw_vtk_shape *shape);

#ifdef __cplusplus
}
#endif

#endif /* PW_IO_VTK_FILES_H */
