/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/solid_mesh.h"

#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"
#include "io/gmsh_mesh.h"

/* Arrays change owner. */
static void take_group(pw_gmsh_group *from, pw_solid_group *to)
{
  snprintf(to->name, sizeof to->name, "%s", from->name);
  to->dim = from->dim;
  to->nnode = from->nnode;
  to->node = from->node;
  to->ncell = from->ncell;
  to->cell = from->cell;
  to->nface = from->nface;
  to->face = from->face;
  from->node = from->cell = from->face = NULL;
}

static pw_status take_mesh(pw_gmsh_mesh *from, pw_solid_mesh *to)
{
  PW_TRY(pw_mem_alloc("groups of the mesh", from->ngroup, sizeof *to->group, &to->group));
  to->ngroup = from->ngroup;
  for (int i = 0; i < from->ngroup; i++) {
    take_group(&from->group[i], &to->group[i]);
  }
  to->input = from->mesh;
  to->node_tag = from->node_tag;
  to->cell_tag = from->cell_tag;
  from->mesh.x = NULL;
  from->mesh.cell = NULL;
  from->node_tag = from->cell_tag = NULL;
  return PW_OK;
}

/* The message of a file is one of the key that names it. */
static pw_status at_key(pw_status status)
{
  char text[512];
  snprintf(text, sizeof text, "%s", pw_error_text());
  if (status == PW_ERR_MEMORY) {
    return status;
  }
  return pw_error_set(status == PW_ERR_FILE ? PW_ERR_SCENE : status, __FILE__, __LINE__, __func__,
                      "%s%s", strncmp(text, "mesh.", 5) == 0 ? "" : "mesh.file: ", text);
}

static bool is_geometry(const char *file)
{
  const char *dot = strrchr(file, '.');
  return dot && strcmp(dot, ".geo") == 0;
}

const char *pw_solid_mesh_geometry(const pw_scene *scene)
{
  const pw_scene_mesh *m = &scene->solid.mesh;
  const bool made = scene->geometry == PW_SOLID && m->kind != PW_MESH_BOX && is_geometry(m->file);
  return made ? m->file : NULL;
}

static pw_status load_file(const pw_scene_mesh *m, pw_solid_mesh *out)
{
  pw_gmsh_mesh file = {.ngroup = 0};
  const pw_gmsh_recipe recipe = {.path = m->file,
                                 .numbers = m->numbers,
                                 .size_factor = m->size_factor,
                                 .nodes = m->cells == PW_CELLS_TEN_NODE ? 10 : 4};
  pw_status s = is_geometry(m->file) ? pw_gmsh_make(&recipe, &file) : pw_gmsh_read(m->file, &file);
  if (s != PW_OK) {
    return at_key(s);
  }
  file.mesh.diagonal = (pw_tet_diagonal)m->diagonal;
  snprintf(out->source, sizeof out->source, "%s", m->file);
  s = take_mesh(&file, out);
  pw_gmsh_destroy(&file);
  return s;
}

pw_status pw_solid_mesh_load(const pw_scene *scene, pw_solid_mesh *out)
{
  const pw_scene_mesh *m = &scene->solid.mesh;
  pw_solid_mesh mesh = {.ngroup = 0};
  if (m->kind == PW_MESH_BOX) {
    return pw_solid_mesh_box(scene, out);
  }
  pw_status s = load_file(m, &mesh);
  if (s != PW_OK) {
    pw_solid_mesh_destroy(&mesh);
    return s;
  }
  *out = mesh;
  return PW_OK;
}
