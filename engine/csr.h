/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/csr.h
 * @brief Sparse matrix of a mesh of tetrahedra, filled patch by patch (layer 3).
 *
 * Which nodes couple is found once for the whole mesh: those of an element, or of a patch where
 * F-bar couples its elements. Which of their components are equations may change from step to step;
 * numbering anew allocates nothing. All components of a node have the same columns, so one table of
 * places per pair of nodes of a patch leads to every value without a search.
 */
#ifndef PW_ENGINE_CSR_H
#define PW_ENGINE_CSR_H

#include "engine/tet_mesh.h"

enum { PW_PATCH_NODES = 10, PW_PATCH_DOFS = 30 }; /**< of a patch, at most */

/** Nodes that couple beside those of an element; true is PW_CSR_PATCHES. */
enum {
  PW_CSR_PATCHES = 1, /**< all nodes of a patch (F-bar) */
  PW_CSR_FACES = 2    /**< the nodes opposite a face from its two sides (ghost stabilisation) */
};

typedef struct pw_csr {
  pw_idx n;               /**< rows */
  pw_off *start;          /**< [n + 1] offsets into col and value */
  pw_idx *col;            /**< ascending in each row */
  pw_real *value;         /**< values; the pattern is symmetric, the values need not be */
  pw_off revision;        /**< counts the changes of the pattern */
  const pw_idx *equation; /**< [3][nnode] row of a component of a node, or -1; borrowed */
  pw_idx nnode;
  pw_off *node_start; /**< [nnode + 1] offsets into node_col */
  pw_idx *node_col;   /**< nodes that couple with a node, itself included, ascending */
  pw_idx *place;      /**< [node_start[nnode]] first column of such a node in the rows of a node */
  pw_idx patch_nodes; /**< nodes of a patch */
  const pw_idx *patch_node; /**< [npatch][patch_nodes]; borrowed */
  pw_idx *pair; /**< [npatch][patch_nodes][patch_nodes] index into node_col less node_start,
                             or -1 for nodes of a patch that do not couple */
} pw_csr;

/**
 * @brief Find which nodes couple, and room for all equations there can be.
 * @param[in] mesh   borrowed as long as the matrix lives
 * @param[in] coupled PW_CSR_PATCHES, PW_CSR_FACES, both, or 0: the nodes of an element alone
 * @return PW_OK; PW_ERR_MEMORY.
 */
pw_status pw_csr_create(const pw_tet_mesh *mesh, int coupled, pw_csr *out);

/** @brief Free; a zeroed struct is accepted. */
void pw_csr_destroy(pw_csr *m);

/**
 * @brief Take a new set of equations.
 * @param[in] equation [3][nnode] rows 0 .. n - 1, each once, ascending by node and then component;
 *                     -1 where there is none; borrowed
 * @param[in] n        number of equations
 */
void pw_csr_number(pw_csr *m, const pw_idx *equation, pw_idx n);

/** @brief Set part @p part of @p parts of the values to zero. */
void pw_csr_clear(pw_csr *m, int part, int parts);

/**
 * @brief Add the matrix of a patch; rows and columns without equation are left out.
 * @param[in] k [3 patch_nodes][PW_PATCH_DOFS] row-major, component c of node a at 3 a + c
 */
void pw_csr_add(pw_csr *m, pw_idx patch, const pw_real *k);

/**
 * @brief Add the same matrix between nodes for each of the three components.
 * @param[in] count nodes, at most PW_PATCH_NODES; any two of them must couple
 * @param[in] node  [count]
 * @param[in] k     [count][count]
 */
void pw_csr_add_nodes(pw_csr *m, pw_idx count, const pw_idx *node, const pw_real *k);

/** @brief y = A x; both [n]. */
void pw_csr_multiply(const pw_csr *m, const pw_real *x, pw_real *y);

#endif /* PW_ENGINE_CSR_H */
