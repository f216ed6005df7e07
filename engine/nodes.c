/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/nodes.h"

#include <string.h>

#include "engine/core/key.h"
#include "engine/core/mem.h"

pw_status pw_nodes_create(pw_idx nnode, int nfield, pw_nodes *out)
{
  PW_REQUIRE(nnode > 0 && nfield >= 1 && nfield <= PW_MAX_FIELDS, PW_ERR_ARGUMENT,
             "%d nodes with %d velocity fields", nnode, nfield);
  pw_nodes nodes = {.nnode = nnode, .nfield = nfield, .count = (pw_off)nnode * nfield};
  nodes.ngroup = (pw_idx)((nodes.count + PW_NODE_GROUP - 1) / PW_NODE_GROUP);
  pw_status s = pw_mem_alloc("nodes", nodes.count * PW_NODE, sizeof(pw_real), &nodes.rec);
  if (s == PW_OK) {
    s = pw_mem_alloc("nodes: groups", nodes.ngroup, sizeof *nodes.used, &nodes.used);
  }
  if (s == PW_OK) {
    s = pw_mem_alloc("nodes: groups in use", nodes.ngroup, sizeof *nodes.in_use, &nodes.in_use);
  }
  if (s == PW_OK) {
    s = pw_mem_alloc("nodes: places of groups", nodes.ngroup, sizeof *nodes.place, &nodes.place);
  }
  if (s != PW_OK) {
    pw_nodes_destroy(&nodes);
    return s;
  }
  for (int f = 0; f < nfield; f++) {
    pw_nodes_use(&nodes, f, 0, nnode);
  }
  *out = nodes;
  return PW_OK;
}

void pw_nodes_destroy(pw_nodes *nodes)
{
  pw_mem_free(&nodes->rec);
  pw_mem_free(&nodes->used);
  pw_mem_free(&nodes->in_use);
  pw_mem_free(&nodes->place);
  *nodes = (pw_nodes){0};
}

void pw_nodes_reset(pw_nodes *nodes)
{
  memset(nodes->rec, 0, (size_t)nodes->count * PW_NODE * sizeof *nodes->rec);
  memset(nodes->in_use, 0, (size_t)nodes->ngroup * sizeof *nodes->in_use);
  nodes->nused = 0;
}

static void use_group(pw_nodes *nodes, pw_idx g)
{
  pw_off first, last;
  nodes->in_use[g] = true;
  nodes->place[g] = nodes->nused;
  nodes->used[nodes->nused++] = g;
  pw_nodes_group(nodes, nodes->nused - 1, &first, &last);
  memset(nodes->rec + first * PW_NODE, 0, (size_t)(last - first) * PW_NODE * sizeof *nodes->rec);
}

void pw_nodes_use(pw_nodes *nodes, int f, pw_idx first, pw_idx n)
{
  const pw_off from = (pw_off)f * nodes->nnode + first;
  const pw_idx end = (pw_idx)((from + n - 1) / PW_NODE_GROUP);
  for (pw_idx g = (pw_idx)(from / PW_NODE_GROUP); g <= end; g++) {
    if (!nodes->in_use[g]) {
      use_group(nodes, g);
    }
  }
}

/* The first part is the last of the line along which blocks are lined up (partition/share.h). */
void pw_nodes_part(const pw_nodes *nodes, int part, int parts, pw_idx *first, pw_idx *last)
{
  part = parts - 1 - part;
  *first = (pw_idx)((pw_off)nodes->nused * part / parts);
  *last = (pw_idx)((pw_off)nodes->nused * (part + 1) / parts);
}

void pw_nodes_clear_part(pw_nodes *nodes, int part, int parts)
{
  pw_idx i, end;
  for (pw_nodes_part(nodes, part, parts, &i, &end); i < end; i++) {
    pw_off k, last;
    pw_nodes_group(nodes, i, &k, &last);
    memset(nodes->rec + k * PW_NODE, 0, (size_t)(last - k) * PW_NODE * sizeof(pw_real));
  }
}

void pw_nodes_clear(pw_nodes *nodes)
{
  pw_nodes_clear_part(nodes, 0, 1);
}

void pw_nodes_momentum_part(pw_nodes *nodes, pw_real dt, pw_real cut_off, int part, int parts)
{
  pw_idx i, end;
  for (pw_nodes_part(nodes, part, parts, &i, &end); i < end; i++) {
    pw_off k, last;
    for (pw_nodes_group(nodes, i, &k, &last); k < last; k++) {
      pw_real *r = nodes->rec + k * PW_NODE;
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
}

void pw_nodes_increment_part(pw_nodes *nodes, int part, int parts)
{
  pw_idx i, end;
  for (pw_nodes_part(nodes, part, parts, &i, &end); i < end; i++) {
    pw_off k, last;
    for (pw_nodes_group(nodes, i, &k, &last); k < last; k++) {
      pw_real *r = nodes->rec + k * PW_NODE;
      r[PW_NODE_FORCE] = r[PW_NODE_VEL] - r[PW_NODE_FORCE];
      r[PW_NODE_FORCE + 1] = r[PW_NODE_VEL + 1] - r[PW_NODE_FORCE + 1];
    }
  }
}

void pw_nodes_remap_part(pw_nodes *nodes, int part, int parts)
{
  pw_idx i, end;
  for (pw_nodes_part(nodes, part, parts, &i, &end); i < end; i++) {
    pw_off k, last;
    for (pw_nodes_group(nodes, i, &k, &last); k < last; k++) {
      pw_real *r = nodes->rec + k * PW_NODE;
      pw_real inv = r[PW_NODE_ACTIVE] > 0.0 ? 1.0 / r[PW_NODE_MASS] : 0.0;
      r[PW_NODE_REMAP] *= inv;
      r[PW_NODE_REMAP + 1] *= inv;
    }
  }
}
