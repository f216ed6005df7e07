/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file partition/graph.h
 * @brief Graphs as compressed rows: elements that share a face, blocks that share a node (layer 2).
 */
#ifndef PW_PARTITION_GRAPH_H
#define PW_PARTITION_GRAPH_H

#include "partition/blocks.h"

/** Undirected graph without loops; every edge stands in the rows of both its ends. */
typedef struct pw_graph {
  pw_idx n;      /**< vertices */
  pw_idx *start; /**< [n + 1] offsets into adj */
  pw_idx *adj;   /**< [start[n]] neighbours */
} pw_graph;

/**
 * @brief Elements of a grid of cells[0] x cells[1] that share a face.
 * @param[in] cells [2] each >= 1; at most 2^28 elements
 * @return PW_OK; PW_ERR_MEMORY.
 */
pw_status pw_graph_grid(const pw_idx *cells, pw_graph *out);

/**
 * @brief Blocks whose supports (nodes of all elements within `reach` cells) share a node.
 *
 * Built from lists of the blocks at each node, in a time proportional to the sum of all supports.
 * @param[in] b cells, reach, elem_start and elem must be set
 * @return PW_OK; PW_ERR_MEMORY.
 */
pw_status pw_graph_conflict(const pw_blocks *b, pw_graph *out);

/** @brief Free; a zeroed struct is accepted. */
void pw_graph_destroy(pw_graph *g);

#endif /* PW_PARTITION_GRAPH_H */
