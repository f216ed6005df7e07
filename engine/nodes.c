/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/nodes.h"

#include <string.h>

#include "engine/core/key.h"
#include "engine/core/mem.h"

pw_status pw_nodes_create(pw_idx nnode, int nfield, pw_nodes *out)
{
  PW_REQUIRE(nnode > 0 && nfield >= 1 && nfield <= PW_MAX_FIELDS, PW_ERR_ARGUMENT,
             "%d nodes with %d velocity fields", nnode, nfield);
  pw_nodes nodes = {.nnode = nnode, .nfield = nfield};
  PW_TRY(pw_mem_alloc("nodes", (pw_off)nnode * nfield * PW_NODE, sizeof(pw_real), &nodes.rec));
  *out = nodes;
  return PW_OK;
}

void pw_nodes_destroy(pw_nodes *nodes)
{
  pw_mem_free(&nodes->rec);
  *nodes = (pw_nodes){0};
}

void pw_nodes_clear(pw_nodes *nodes)
{
  const pw_off count = (pw_off)nodes->nnode * nodes->nfield;
  pw_real *rec = nodes->rec;
#pragma omp parallel for default(none) shared(rec, count) schedule(static)
  for (pw_off k = 0; k < count; k++) {
    memset(rec + k * PW_NODE, 0, PW_NODE * sizeof *rec);
  }
}

void pw_nodes_momentum(pw_nodes *nodes, pw_real dt, pw_real cut_off)
{
  const pw_off count = (pw_off)nodes->nnode * nodes->nfield;
  pw_real *rec = nodes->rec;
#pragma omp parallel for default(none) shared(rec, count, dt, cut_off) schedule(static)
  for (pw_off k = 0; k < count; k++) {
    pw_real *r = rec + k * PW_NODE;
    pw_real active = r[PW_NODE_MASS] > cut_off ? 1.0 : 0.0;
    pw_real inv = active / pw_max(r[PW_NODE_MASS], PW_TINY);
    for (int a = 0; a < 2; a++) {
      pw_real v = r[PW_NODE_VEL + a] * inv;
      r[PW_NODE_VEL + a] = v + dt * r[PW_NODE_FORCE + a] * inv;
      r[PW_NODE_FORCE + a] = v;
    }
    r[PW_NODE_ACTIVE] = active;
  }
}

void pw_nodes_increment(pw_nodes *nodes)
{
  const pw_off count = (pw_off)nodes->nnode * nodes->nfield;
  pw_real *rec = nodes->rec;
#pragma omp parallel for default(none) shared(rec, count) schedule(static)
  for (pw_off k = 0; k < count; k++) {
    pw_real *r = rec + k * PW_NODE;
    r[PW_NODE_FORCE] = r[PW_NODE_VEL] - r[PW_NODE_FORCE];
    r[PW_NODE_FORCE + 1] = r[PW_NODE_VEL + 1] - r[PW_NODE_FORCE + 1];
  }
}

void pw_nodes_remap(pw_nodes *nodes)
{
  const pw_off count = (pw_off)nodes->nnode * nodes->nfield;
  pw_real *rec = nodes->rec;
#pragma omp parallel for default(none) shared(rec, count) schedule(static)
  for (pw_off k = 0; k < count; k++) {
    pw_real *r = rec + k * PW_NODE;
    pw_real inv = r[PW_NODE_ACTIVE] > 0.0 ? 1.0 / r[PW_NODE_MASS] : 0.0;
    r[PW_NODE_REMAP] *= inv;
    r[PW_NODE_REMAP + 1] *= inv;
  }
}
