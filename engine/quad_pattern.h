/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/quad_pattern.h
 * @brief Which nodes of a grid couple, and the sparse matrix that follows from it (layer 3).
 *
 * Two nodes couple when a point has both. Points move, so this changes from step to step; a table
 * of the neighbours of every node, by their distance in rows and columns, is marked anew for each,
 * and the matrix (engine/csr.h) renewed only when marks or equations have changed. Its node tables
 * stay empty: the places here lead to the values without a search.
 */
#ifndef PW_ENGINE_QUAD_PATTERN_H
#define PW_ENGINE_QUAD_PATTERN_H

#include "engine/csr.h"

typedef struct pw_quad_pattern {
  pw_idx row, nnode; /**< nodes along x, all nodes */
  pw_idx span;       /**< most rows or columns between two nodes of a point */
  pw_idx width;      /**< 2 span + 1 */
  uint8_t *mark;     /**< [nnode][width][width] 1: the two couple */
  uint8_t *before;   /**< the marks that the matrix was made for */
  pw_idx *place;     /**< [nnode][width][width] first column of that node in the rows of this one */
  pw_off room;       /**< values that there is memory for */
} pw_quad_pattern;

/** @brief Empty table of a grid of @p row by @p nnode / @p row nodes, and the rows of @p csr.
 *  @return PW_OK; PW_ERR_MEMORY. */
pw_status pw_quad_pattern_create(pw_idx row, pw_idx nnode, pw_idx span, pw_quad_pattern *out,
                                 pw_csr *csr);

/** @brief Free both; zeroed structs are accepted. */
void pw_quad_pattern_destroy(pw_quad_pattern *p, pw_csr *csr);

/** @brief Nothing couples. */
void pw_quad_pattern_clear(pw_quad_pattern *p);

/** @brief Row and column of a node. */
static inline void pw_quad_pattern_at(const pw_quad_pattern *p, pw_idx node, pw_idx *i, pw_idx *j)
{
  *j = node / p->row;
  *i = node - *j * p->row;
}

/** @brief Index into mark and place of the pair of node @p a and the node @p di columns and @p dj
 *  rows from it. */
static inline pw_off pw_quad_pattern_pair(const pw_quad_pattern *p, pw_idx a, pw_idx di, pw_idx dj)
{
  return ((pw_off)a * p->width + dj + p->span) * p->width + di + p->span;
}

/** @brief All @p n nodes couple with each other. */
void pw_quad_pattern_mark(pw_quad_pattern *p, int n, const pw_idx *node);

/**
 * @brief The matrix for the marks and equations there are now; csr->revision grows when it differs
 *        from the one before. Memory grows when there are more values than ever before.
 * @param[in] equation [3][nnode] as in pw_csr_number(), borrowed; the third components have none
 * @param[in] changed  equations are not those of the last call
 * @return PW_OK; PW_ERR_MEMORY.
 */
pw_status pw_quad_pattern_number(pw_quad_pattern *p, pw_csr *csr, const pw_idx *equation, pw_idx n,
                                 bool changed);

/** @brief The value at the diagonal of component @p c of a node, which must have an equation. */
static inline pw_real *pw_quad_pattern_diagonal(const pw_quad_pattern *p, const pw_csr *csr,
                                                pw_idx node, int c)
{
  const pw_off row = csr->start[csr->equation[(pw_off)c * csr->nnode + node]];
  const bool second = c == 1 && csr->equation[node] >= 0;
  return csr->value + row + p->place[pw_quad_pattern_pair(p, node, 0, 0)] + second;
}

/**
 * @brief Add the matrix of @p n nodes; rows and columns without equation are left out.
 * @param[in] k    [2 n][2 n] row-major, component c of node a at 2 a + c
 */
void pw_quad_pattern_add(const pw_quad_pattern *p, pw_csr *csr, int n, const pw_idx *node,
                         const pw_real *k);

#endif /* PW_ENGINE_QUAD_PATTERN_H */
