/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/gmsh_mesh.h"

#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"

void pw_gmsh_destroy(pw_gmsh_mesh *m)
{
  for (int i = 0; i < m->ngroup; i++) {
    pw_mem_free(&m->group[i].node);
    pw_mem_free(&m->group[i].cell);
    pw_mem_free(&m->group[i].face);
  }
  pw_mem_free(&m->group);
  pw_mem_free(&m->mesh.x);
  pw_mem_free(&m->mesh.cell);
  pw_mem_free(&m->node_tag);
  pw_mem_free(&m->cell_tag);
  memset(m, 0, sizeof *m);
}

pw_status pw_gmsh_find(const pw_gmsh_mesh *m, int dim, const char *name,
                       const pw_gmsh_group **group)
{
  static const char *const kind[] = {"point", "curve", "surface", "volume"};
  char known[512] = "";
  size_t used = 0;
  PW_REQUIRE(dim >= 0 && dim <= 3, PW_ERR_ARGUMENT, "a group of dimension %d", dim);
  for (int i = 0; i < m->ngroup; i++) {
    const pw_gmsh_group *g = &m->group[i];
    if (g->dim == dim && strcmp(g->name, name) == 0) {
      *group = g;
      return PW_OK;
    }
    if (used + PW_GMSH_NAME + 24 < sizeof known) {
      used += (size_t)snprintf(known + used, sizeof known - used, "%s%s \"%s\"", used ? ", " : "",
                               kind[g->dim], g->name);
    }
  }
  return pw_error_set(PW_ERR_SCENE, __FILE__, __LINE__, __func__,
                      "the mesh has no %s \"%s\"; it has %s", kind[dim], name,
                      used ? known : "no physical groups");
}

#ifndef PW_GMSH_LIBRARY

bool pw_gmsh_available(void)
{
  return false;
}

pw_status pw_gmsh_read(const char *path, pw_gmsh_mesh *out)
{
  (void)out;
  PW_REQUIRE(false, PW_ERR_UNSUPPORTED,
             "%s: built without gmsh, no .msh files (Debian package: libgmsh-dev)", path);
  return PW_OK;
}

pw_status pw_gmsh_make(const pw_gmsh_recipe *recipe, pw_gmsh_mesh *out)
{
  return pw_gmsh_read(recipe->path, out);
}

#endif /* PW_GMSH_LIBRARY */
