/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file partition/order.h
 * @brief Division of a graph into connected parts of even weight: the only door to METIS (layer 2).
 *
 * METIS 5.1, multilevel k-way partitioning (Karypis & Kumar 1998, J. Parallel Distrib. Comput.
 * 48:96-129), with a fixed seed, so that equal input gives equal parts on every run.
 */
#ifndef PW_PARTITION_ORDER_H
#define PW_PARTITION_ORDER_H

#include "partition/graph.h"

/**
 * @brief Divide a connected graph into at most @p nparts connected parts of about equal weight.
 * @param[in]  weight [n] >= 0, work of a vertex
 * @param[in]  nparts >= 1
 * @param[out] part   [n] part of each vertex, in [0, nparts); parts may be empty
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_SOLVER when METIS fails.
 */
pw_status pw_order_blocks(const pw_graph *g, const pw_idx *weight, pw_idx nparts, pw_idx *part);

#endif /* PW_PARTITION_ORDER_H */
