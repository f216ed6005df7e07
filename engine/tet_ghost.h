/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/tet_ghost.h
 * @brief Ghost stabilisation: elements that hold little material follow their neighbours (layer 3).
 *
 * Nodes that only a barely filled element holds have next to no stiffness. Over every face between
 * two elements with points of which one is cut, the jump of the displacement gradient of the step
 * is penalised by the energy
 *
 *   W = gamma/2 sum_F (V1 + V2)/2 |grad u_1 - grad u_2|^2,
 *
 * V1, V2 the volumes of the two elements where the mesh is and gamma a stiffness in Pa, of the order
 * of a tenth of the shear modulus. With h = 3 (V1 + V2)/(2 A) the mean height over the face of area
 * A this is h A/3 times the jump squared, the weight of linear elements in Coombs, Int. J. Numer.
 * Meth. Engng 124 (2023) 4841-4875, doi 10.1002/nme.7332, after Sticko, Ludvigsson, Kreiss, Adv.
 * Comput. Math. 46 (2020); tangential parts of the jump vanish there. Displacements linear over
 * both elements, rigid motions among them, have no jump: forces of a step balance in themselves.
 *
 * An element is cut when an element beside it holds no points, or when its points fill less than
 * half of it.
 */
#ifndef PW_ENGINE_TET_GHOST_H
#define PW_ENGINE_TET_GHOST_H

#include "engine/tet_model.h"

/** @brief Faces of the step begun; nothing when the effect is off. */
void pw_tet_ghost_begin(pw_tet_model *m);

/** @brief Add forces and, when asked for, tangent and lift to those of the model. */
void pw_tet_ghost_add(pw_tet_model *m, const pw_real *u, bool tangent);

/** @brief Energy W of displacements @p u [3][nnode] over the step; J. */
pw_real pw_tet_ghost_energy(const pw_tet_model *m, const pw_real *u);

#endif /* PW_ENGINE_TET_GHOST_H */
