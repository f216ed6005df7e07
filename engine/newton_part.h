/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/newton_part.h
 * @brief One part of a load step: first guess, iterations, approach (layer 3, internal).
 */
#ifndef PW_ENGINE_NEWTON_PART_H
#define PW_ENGINE_NEWTON_PART_H

#include "engine/step_newton.h"

struct pw_newton {
  pw_newton_system system;
  pw_tet_model *model; /* behind the system, or NULL: another one */
  pw_newton_options options;
  pw_solver *solver;
  size_t dofs;       /* of the system */
  pw_real *u;        /* [dofs] displacement over the part at hand */
  pw_real *previous; /* [dofs] displacement over the part before, per second of it; m/s */
  bool has_previous;
  pw_real *rest;          /* [dofs] R0 of the part, where it is known */
  pw_real *unbalanced;    /* [dofs] R0 times 1 - alpha */
  pw_real *way;           /* [dofs] last solution on the way to a part */
  pw_real *tried;         /* [dofs] where a line search starts */
  pw_real *right, *delta; /* [dofs] by equation */
  pw_real floor;          /* residual that rounding may leave */
  bool has_rest;
  bool approachable; /* the part at hand, should it fail */
  pw_newton_watcher watcher;
  pw_tet_rates rates; /* in dynamics */
  pw_mechanism mechanism;
};

/**
 * @brief Solve the part from t[0] to t[1] of a step that system.begin() has begun.
 * @return PW_OK with n->u in balance; a positive code where a smaller part may help; a negative one.
 */
pw_status pw_newton_solve_part(pw_newton *n, const pw_newton_load *load, const pw_real *t,
                               pw_newton_report *report);

#endif /* PW_ENGINE_NEWTON_PART_H */
