/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file partition/colour.h
 * @brief Colours for a graph: neighbours differ, colours are few and carry even work (layer 2).
 *
 * Greedy colouring in smallest-last order (Matula & Beck 1983, J. ACM 30:417-427), then iterated
 * greedy passes (Culberson & Luo 1996, DIMACS 26:245-284): colouring class by class again never
 * needs more colours and often fewer. Last, vertices move from heavy to light colours.
 * No random numbers: the same graph always gets the same colours.
 */
#ifndef PW_PARTITION_COLOUR_H
#define PW_PARTITION_COLOUR_H

#include "partition/graph.h"

/**
 * @brief Colour a graph.
 * @param[in]  work    [n] >= 0, balanced among the colours; NULL: all equal
 * @param[out] colour  [n] in [0, *ncolour)
 * @param[out] ncolour number of colours, at most the largest degree + 1; 0 for no vertices
 * @return PW_OK; PW_ERR_MEMORY.
 */
pw_status pw_colour_greedy(const pw_graph *g, const pw_idx *work, pw_idx *colour, pw_idx *ncolour);

#endif /* PW_PARTITION_COLOUR_H */
