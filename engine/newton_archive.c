/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/newton_archive.h"

#include "engine/newton_part.h"

pw_status pw_newton_archive(pw_newton *n, pw_archive *ar)
{
  const pw_off dofs = (pw_off)n->dofs;
  pw_idx flags[3] = {n->has_previous, n->rates.begun, n->rates.given};
  PW_TRY(ar->index(ar, "newton/flags", flags, 3));
  n->has_previous = flags[0] != 0;
  PW_TRY(ar->real(ar, "newton/previous", n->previous, dofs));
  if (!n->options.newmark.on) {
    return PW_OK;
  }
  n->rates.begun = flags[1] != 0;
  n->rates.given = flags[2] != 0;
  PW_TRY(ar->real(ar, "newton/velocity", n->rates.v, dofs));
  return ar->real(ar, "newton/acceleration", n->rates.a, dofs);
}

void pw_newton_forget(pw_newton *n)
{
  pw_solver_forget(n->solver);
}
