/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/full_mass.h"

#include <string.h>

#include "engine/core/mem.h"

pw_status pw_full_mass_create(pw_sim *sim)
{
  pw_full_mass *m;
  if (sim->scene.method.mass_terms <= 1) {
    return PW_OK;
  }
  PW_TRY(pw_mem_alloc("full mass matrix", 1, sizeof *m, &m));
  sim->full_mass = m;
  PW_TRY(pw_mem_alloc("full mass matrix: nodes", sim->nodes.count * PW_NODE, sizeof(pw_real),
                      &m->rec));
  return pw_mem_alloc("full mass matrix: points", 2 * (pw_off)sim->points.ld, sizeof(pw_real),
                      &m->v);
}

void pw_full_mass_destroy(pw_sim *sim)
{
  if (sim->full_mass) {
    pw_mem_free(&sim->full_mass->rec);
    pw_mem_free(&sim->full_mass->v);
  }
  pw_mem_free(&sim->full_mass);
}

void pw_full_mass_first_part(pw_sim *sim, int part, int parts)
{
  const bool remaps = sim->scene.method.update == PW_MUSL;
  const pw_nodes *nodes = &sim->nodes;
  pw_idx i, end;
  for (pw_nodes_part(nodes, part, parts, &i, &end); i < end; i++) {
    pw_off k, last;
    for (pw_nodes_group(nodes, i, &k, &last); k < last; k++) {
      pw_real *r = nodes->rec + k * PW_NODE, *t = sim->full_mass->rec + k * PW_NODE;
      for (int a = 0; a < 2; a++) {
        t[PW_NODE_FORCE + a] = r[PW_NODE_VEL + a] - r[PW_NODE_FORCE + a];
        r[PW_NODE_REMAP + a] = remaps ? 0.0 : r[PW_NODE_VEL + a];
      }
    }
  }
}

void pw_block_full_mass(void *ctx, pw_idx block)
{
  const pw_sim *sim = ctx;
  pw_transfer t = sim->transfer;
  t.v = sim->full_mass->v;
  for (int b = 0; b < sim->nbody; b++) {
    const pw_idx *start = sim->blocks.point_start + (pw_off)block * sim->nbody + b;
    const pw_idx first = start[0], last = start[1];
    pw_real *rec = pw_full_mass_field(sim->full_mass, sim->body[b].field, sim->nodes.nnode);
    for (int a = 0; a < 2 && first < last; a++) {
      memset(t.v + (pw_off)a * t.ld + first, 0, (size_t)(last - first) * sizeof *t.v);
    }
    sim->kernels->g2p_velocity(&t, rec, first, last);
    sim->kernels->p2g_remap(&t, rec, first, last);
  }
}

void pw_full_mass_second_part(pw_sim *sim, int part, int parts)
{
  const pw_nodes *nodes = &sim->nodes;
  pw_idx i, end;
  for (pw_nodes_part(nodes, part, parts, &i, &end); i < end; i++) {
    pw_off k, last;
    for (pw_nodes_group(nodes, i, &k, &last); k < last; k++) {
      pw_real *r = nodes->rec + k * PW_NODE, *t = sim->full_mass->rec + k * PW_NODE;
      const pw_real active = r[PW_NODE_ACTIVE], inv = active / pw_max(r[PW_NODE_MASS], PW_TINY);
      for (int a = 0; a < 2; a++) {
        r[PW_NODE_VEL + a] += active * t[PW_NODE_FORCE + a] - inv * t[PW_NODE_REMAP + a];
        t[PW_NODE_REMAP + a] = 0.0;
      }
    }
  }
}
