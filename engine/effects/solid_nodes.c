/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effects/solid_params.h"

#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"

static bool has_box(const pw_solid_nodes *p)
{
  bool box = false;
  for (int c = 0; c < 3; c++) {
    box = box || p->low_m[c] != 0.0 || p->high_m[c] != 0.0;
  }
  return box;
}

pw_status pw_solid_nodes_check(const pw_solid_nodes *p)
{
  for (int c = 0; c < 3; c++) {
    PW_REQUIRE(p->low_m[c] <= p->high_m[c], PW_ERR_SCENE,
               "high_m: along %c the box ends at %g m and begins at %g m", "xyz"[c], p -> high_m[c],
               p -> low_m[c]);
  }
  PW_REQUIRE(p->group[0] || has_box(p), PW_ERR_SCENE,
             "neither group nor the box low_m, high_m is given");
  PW_REQUIRE(!p->group[0] || !has_box(p), PW_ERR_SCENE,
             "group: it and the box low_m, high_m exclude each other");
  return PW_OK;
}

/* Nodes in the box, counted only where there is no room yet. */
static pw_idx collect_box(const pw_tets *t, const pw_solid_nodes *p, pw_idx *node)
{
  pw_real size = 0.0;
  pw_idx n = 0;
  for (int c = 0; c < 3; c++) {
    size = pw_max(size, t->high[c] - t->low[c]);
  }
  for (pw_idx a = 0; a < t->nnode; a++) {
    bool inside = true;
    for (int c = 0; c < 3; c++) {
      const pw_real x = t->x[(pw_off)c * t->nnode + a];
      inside = inside && x >= p->low_m[c] - 1e-9 * size && x <= p->high_m[c] + 1e-9 * size;
    }
    if (inside && node) {
      node[n] = a;
    }
    n += inside;
  }
  return n;
}

pw_status pw_solid_nodes_find(const pw_implicit *sim, const pw_solid_mesh *mesh,
                              const pw_solid_nodes *p, const char *path, pw_idx **node,
                              pw_idx *count)
{
  const pw_solid_group *group = NULL;
  char key[2 * PW_NAME];
  if (p->group[0]) {
    snprintf(key, sizeof key, "%s.group", path);
    PW_TRY(pw_solid_mesh_find(mesh, -1, p->group, key, &group));
  }
  const pw_idx n = group ? group->nnode : collect_box(&sim->mesh.tets, p, NULL);
  PW_REQUIRE(n > 0, PW_ERR_SCENE, "%s.%s: it holds no node of the mesh", path,
             group ? "group" : "low_m");
  PW_TRY(pw_mem_alloc("nodes of an effect", n, sizeof **node, node));
  if (group) {
    memcpy(*node, group->node, (size_t)n * sizeof **node);
  } else {
    collect_box(&sim->mesh.tets, p, *node);
  }
  *count = n;
  return PW_OK;
}
