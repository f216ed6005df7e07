/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/newton_part.h
 * @brief One part of a load step: first guess, iterations, approach (layer 3, internal).
 */
#ifndef PW_ENGINE_NEWTON_PART_H
#define PW_ENGINE_NEWTON_PART_H

#include "engine/step_newton.h"

struct pw_newton {
  pw_tet_model *model;
  pw_newton_options options;
  pw_solver *solver;
  size_t dofs;       /* 3 nnode */
  pw_real *u;        /* [3][nnode] displacement over the part at hand */
  pw_real *previous; /* [3][nnode] displacement over the part before, per second of it; m/s */
  bool has_previous;
  pw_real *rest;          /* [3][nnode] R0 of the part, where it is known */
  pw_real *unbalanced;    /* [3][nnode] R0 times 1 - alpha */
  pw_real *way;           /* [3][nnode] last solution on the way to a part */
  pw_real *tried;         /* [3][nnode] where a line search starts */
  pw_real *right, *delta; /* [3 nnode] by equation */
  pw_real floor;          /* residual that rounding may leave */
  bool has_rest;
  pw_tet_rates rates; /* in dynamics */
  pw_mechanism mechanism;
};

/**
 * @brief Solve the part from t[0] to t[1] of a step that pw_tet_model_begin() has begun.
 * @return PW_OK with n->u in balance; a positive code where a smaller part may help; a negative one.
 */
pw_status pw_newton_solve_part(pw_newton *n, const pw_newton_load *load, const pw_real *t,
                               pw_newton_report *report);

#endif /* PW_ENGINE_NEWTON_PART_H */
