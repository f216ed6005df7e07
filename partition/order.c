/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "partition/order.h"

#include <metis.h>
#include <string.h>

_Static_assert(sizeof(idx_t) == sizeof(pw_idx), "METIS must be built with 32-bit indices");

enum { SEED = 20160831 };

pw_status pw_order_blocks(const pw_graph *g, const pw_idx *weight, pw_idx nparts, pw_idx *part)
{
  if (nparts == 1) {
    memset(part, 0, (size_t)g->n * sizeof *part);
    return PW_OK;
  }
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = SEED;
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_CONTIG] = 1;
  idx_t n = g->n, constraints = 1, parts = nparts, cut = 0;
  /* METIS takes its input without const but does not change it. */
  int rc =
      METIS_PartGraphKway(&n, &constraints, (idx_t *)g->start, (idx_t *)g->adj, (idx_t *)weight,
                          NULL, NULL, &parts, NULL, NULL, options, &cut, part);
  PW_REQUIRE(rc != METIS_ERROR_MEMORY, PW_ERR_MEMORY, "METIS: no memory for %d elements", (int)n);
  PW_REQUIRE(rc == METIS_OK, PW_ERR_SOLVER, "METIS: error %d dividing %d elements into %d blocks",
             rc, (int)n, (int)nparts);
  return PW_OK;
}
