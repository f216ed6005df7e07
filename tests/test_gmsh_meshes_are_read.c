/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mesh files of a box 1 x 2 x 1 with the volume "soil" (tag 7), the surface "base" (y = 0, tag 3) and
 * a surface without a name (y = 2, tag 5): both versions of the format, text and binary, linear and
 * ten-node tetrahedra. All forms must give the same mesh. */
#include "io/gmsh_mesh.h"
#include "tests/tet_helpers.h"

#include <stdlib.h>
#include <unistd.h>

static pw_gmsh_mesh read_box(const char *kind, const char *form)
{
  char path[128];
  pw_gmsh_mesh m;
  snprintf(path, sizeof path, "reference/gmsh/box_%s_%s.msh", kind, form);
  assert_ok(pw_gmsh_read(path, &m));
  return m;
}

/* A group holds the nodes of a plane y = level, and no others. */
static void check_plane(const pw_gmsh_mesh *m, const char *name, double level)
{
  const pw_gmsh_group *g;
  pw_idx count = 0;
  const double *y = m->mesh.x + m->mesh.nnode;
  assert_ok(pw_gmsh_find(m, 2, name, &g));
  for (pw_idx a = 0; a < m->mesh.nnode; a++) {
    count += fabs(y[a] - level) < 1e-12;
  }
  assert_int_equal(g->nnode, count);
  for (pw_idx i = 0; i < g->nnode; i++) {
    assert_near(y[g->node[i]], level, 1e-12);
    assert_true(i == 0 || g->node[i] > g->node[i - 1]);
  }
}

static void check_box(const pw_gmsh_mesh *m, int nodes)
{
  const pw_gmsh_group *soil;
  pw_tet_mesh mesh;
  assert_int_equal(m->mesh.nodes, nodes);
  assert_int_equal(m->ngroup, 3);
  assert_ok(pw_gmsh_find(m, 3, "soil", &soil));
  assert_int_equal(soil->tag, 7);
  assert_int_equal(soil->ncell, m->mesh.ncell);
  assert_int_equal(soil->nnode, m->mesh.nnode);
  check_plane(m, "base", 0.0);
  check_plane(m, "5", 2.0);
  assert_ok(pw_tet_mesh_create(&m->mesh, &mesh)); /* middles where they belong, volumes positive */
  assert_near(test_volume(&mesh), 2.0, 1e-12);
  pw_tet_mesh_destroy(&mesh);
}

static void all_forms_give_one_mesh(void **state)
{
  (void)state;
  const char *const kinds[] = {"linear", "ten"};
  const char *const forms[] = {"22_text", "22_binary", "41_text", "41_binary"};
  if (!pw_gmsh_available()) {
    skip();
  }
  for (int k = 0; k < 2; k++) {
    pw_gmsh_mesh first = read_box(kinds[k], forms[0]);
    check_box(&first, k ? 10 : 4);
    for (int f = 1; f < 4; f++) {
      pw_gmsh_mesh m = read_box(kinds[k], forms[f]);
      check_box(&m, k ? 10 : 4);
      assert_int_equal(m.mesh.nnode, first.mesh.nnode);
      assert_int_equal(m.mesh.ncell, first.mesh.ncell);
      for (pw_idx i = 0; i < 3 * m.mesh.nnode; i++) {
        assert_near(m.mesh.x[i], first.mesh.x[i], 1e-14);
      }
      assert_memory_equal(m.mesh.cell, first.mesh.cell,
                          (size_t)m.mesh.ncell * (size_t)m.mesh.nodes * sizeof(pw_idx));
      pw_gmsh_destroy(&m);
    }
    pw_gmsh_destroy(&first);
  }
}

static void expect(const char *path, pw_status code, const char *text)
{
  pw_gmsh_mesh m;
  assert_int_equal(pw_gmsh_read(path, &m), code);
  if (!strstr(pw_error_text(), text)) {
    fail_msg("\"%s\" does not say \"%s\"", pw_error_text(), text);
  }
}

static void expect_content(const char *content, pw_status code, const char *text)
{
  char path[] = "pw_gmsh_XXXXXX";
  int handle = mkstemp(path);
  assert_true(handle >= 0);
  FILE *file = fdopen(handle, "w");
  assert_non_null(file);
  fputs(content, file);
  fclose(file);
  expect(path, code, text);
  unlink(path);
}

static void bad_files_are_named(void **state)
{
  (void)state;
  const char head[] = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"
                      "4 0 0 1\n9 5 6 7\n$EndNodes\n$Elements\n";
  char text[512];
  if (!pw_gmsh_available()) {
    expect("reference/gmsh/box_ten_22_text.msh", PW_ERR_UNSUPPORTED, "libgmsh-dev");
    return;
  }
  expect("no/such/file.msh", PW_ERR_FILE, "no/such/file.msh: cannot be opened");
  expect_content("Point(1) = {0, 0, 0};\n", PW_ERR_FILE, "no gmsh mesh");
  expect_content("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0\n", PW_ERR_FILE,
                 "gmsh cannot read the file");
  snprintf(text, sizeof text, "%s1\n1 2 2 0 1 1 2 3\n$EndElements\n", head);
  expect_content(text, PW_ERR_SCENE, "no tetrahedra");
  snprintf(text, sizeof text, "%s2\n1 4 2 0 1 1 2 3 4\n2 2 2 0 1 1 2 9\n$EndElements\n", head);
  expect_content(text, PW_ERR_SCENE, "node 9 at (5, 6, 7) belongs to no tetrahedron");
  snprintf(text, sizeof text, "%s2\n1 4 2 0 1 1 2 3 4\n2 7 2 0 1 1 2 3 4 9\n$EndElements\n", head);
  expect_content(text, PW_ERR_SCENE, "type 7 are no tetrahedra");
  pw_gmsh_mesh m = read_box("ten", "41_text");
  const pw_gmsh_group *g;
  assert_int_equal(pw_gmsh_find(&m, 2, "pile", &g), PW_ERR_SCENE);
  assert_string_equal(pw_error_text(), "the mesh has no surface \"pile\"; it has surface \"base\", "
                                       "surface \"5\", volume \"soil\"");
  pw_gmsh_destroy(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_forms_give_one_mesh),
      cmocka_unit_test(bad_files_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
