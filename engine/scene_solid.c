/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/scene.h"

#include <math.h>
#include <string.h>

#include "engine/tet_model.h"

#define AT(member)       offsetof(pw_scene, solid.member)
#define AT_SCENE(member) offsetof(pw_scene, member)
#define AT_BODY(member)  offsetof(pw_scene_body, member)

#define FAR_M   1e6
#define SMALL_M 1e-6

/* clang-format off */
/* Rows of implicit: that both kinds of scenes have. */
#define KEYS_OF_LENGTH \
  {"adaptive", PW_KEY_BOOL, AT(implicit.adaptive), 0, 0, "false", NULL, NULL, \
   "steps longer or shorter than a load step, as the iterations they take ask for"}, \
  {"step_least", PW_KEY_REAL, AT(implicit.step_least), 1e-6, 1, "0.01", NULL, "adaptive=true", \
   "shortest step, in load steps"}, \
  {"step_most", PW_KEY_REAL, AT(implicit.step_most), 1, 1e6, "10", NULL, "adaptive=true", \
   "longest step, in load steps; of a solid scene history_every_steps limits it too"}, \
  {"easy_iterations", PW_KEY_INT, AT(implicit.easy_iterations), 0, 63, "4", NULL, "adaptive=true", \
   "a step of no more iterations makes the next one 1.5 times as long"}, \
  {"hard_iterations", PW_KEY_INT, AT(implicit.hard_iterations), 1, 64, "8", NULL, "adaptive=true", \
   "a step of as many, or one that had to be cut or approached, halves the next one"}

#define KEYS_OF_ITERATION \
  {"tolerance", PW_KEY_REAL, AT(implicit.tolerance), 1e-15, 0.1, "1e-9", NULL, NULL, \
   "forces out of balance over reactions and loads, as norms, at which a step has converged"}, \
  {"max_iterations", PW_KEY_INT, AT(implicit.max_iterations), 1, 64, "20", NULL, NULL, \
   "Newton iterations after which a step is cut"}, \
  {"max_cuts", PW_KEY_INT, AT(implicit.max_cuts), 0, 40, "10", NULL, NULL, \
   "halvings of a step in a row after which the run fails"}, \
  {"approach", PW_KEY_INT, AT(implicit.approach), 0, 20, "4", NULL, NULL, \
   "halvings of the way to a step that fails on a mesh that is put back, tried before it is cut; " \
   "0: it is cut at once"}, \
  {"cut_driven", PW_KEY_BOOL, AT(implicit.cut_driven), 0, 0, "false", NULL, NULL, \
   "cut steps also where nodes are driven and the mesh is put back in between"}, \
  {"line_search", PW_KEY_INT, AT(implicit.line_search), 0, 20, "4", NULL, NULL, \
   "parts of a correction to try, the whole one first, after which a step fails; 0: the whole one"}

#define KEYS_OF_SOLVER \
  {"solver", PW_KEY_CHOICE, AT(implicit.solver), 0, 0, "automatic", \
   "automatic|direct|krylov|petsc_gamg|petsc_ilu", NULL, \
   "linear solver: factorisation, Krylov with a factor kept for several matrices, or PETSc's; " \
   "automatic: by the number of equations"}, \
  {"from_previous", PW_KEY_BOOL, AT(implicit.from_previous), 0, 0, "true", NULL, NULL, \
   "start the iteration from the displacement of the step before"}

const pw_key pw_scene_keys_mesh[] = {
  {"kind", PW_KEY_CHOICE, AT(mesh.kind), 0, 0, "box", "box|file", NULL,
   "a box of equal bricks with groups x_min, x_max, y_min, y_max, z_min, z_max, or a file of gmsh's"},
  {"file", PW_KEY_FILE, AT(mesh.file), 0, 0, NULL, NULL, "kind=file",
   "mesh (.msh, version 2.2 or 4.1) or geometry (.geo) with physical groups; a geometry is meshed "
   "when the scene is read"},
  {"numbers", PW_KEY_TEXT, AT(mesh.numbers), 0, 0, "", NULL, "kind=file",
   "values for the constants that a geometry defines, as \"n=8 width=0.1\""},
  {"size_factor", PW_KEY_REAL, AT(mesh.size_factor), 0.01, 100, "1", NULL, "kind=file",
   "of a geometry: all sizes of cells times this"},
  {"low_m", PW_KEY_TRIPLE, AT(mesh.low_m), -FAR_M, FAR_M, NULL, NULL, "kind=box",
   "corner of the box with the least coordinates"},
  {"high_m", PW_KEY_TRIPLE, AT(mesh.high_m), -FAR_M, FAR_M, NULL, NULL, "kind=box",
   "corner of the box with the largest coordinates"},
  {"bricks", PW_KEY_TRIPLE, AT(mesh.bricks), 1, 1000, NULL, NULL, "kind=box",
   "whole numbers of bricks along x, y and z"},
  {"tets_per_brick", PW_KEY_INT, AT(mesh.tets_per_brick), 5, 6, "6", NULL, "kind=box",
   "tetrahedra in a brick: 6, all bricks alike (Kuhn), or 5, neighbours being mirror images"},
  {"cells", PW_KEY_CHOICE, AT(mesh.cells), 0, 0, "ten_node", "ten_node|linear", NULL,
   "tetrahedra of a box or geometry: of ten nodes, each divided into 8 elements, or linear ones"},
  {"diagonal", PW_KEY_CHOICE, AT(mesh.diagonal), 0, 0, "shortest",
   "shortest|49|57|68|along_x|along_y|along_z", NULL,
   "around which of its diagonals the octahedron in a ten-node tetrahedron is divided"},
  {0}};

const pw_key pw_scene_keys_implicit[] = {
  {"steps", PW_KEY_INT, AT(implicit.steps), 1, 1e6, NULL, NULL, NULL,
   "load steps of the run"},
  {"step_s", PW_KEY_REAL, AT(implicit.step_s), PW_TINY, 1e12, "1", NULL, NULL,
   "time of a load step"},
  KEYS_OF_LENGTH,
  {"fbar", PW_KEY_CHOICE, AT(implicit.fbar), 0, 0, "increment", "none|increment|total", NULL,
   "volume change averaged over patches: not, over the step, or since the beginning"},
  {"point_rule", PW_KEY_CHOICE, AT(implicit.point_rule), 0, 0, "four",
   "one|four|eleven_equal|eleven_keast|twenty", NULL,
   "places of points in a tetrahedron and their parts of its volume"},
  {"points_per", PW_KEY_CHOICE, AT(implicit.points_per), 0, 0, "element", "element|ten_node", NULL,
   "apply the rule in every element, or once in every ten-node tetrahedron"},
  {"negative_volumes", PW_KEY_BOOL, AT(implicit.negative_volumes), 0, 0, "false", NULL, NULL,
   "accept a rule that gives points negative volumes (eleven_keast)"},
  KEYS_OF_ITERATION,
  {"mechanisms", PW_KEY_CHOICE, AT(implicit.mechanisms), 0, 0, "warn", "ignore|warn|error", NULL,
   "what to do when pieces of the body are held by nothing"},
  KEYS_OF_SOLVER,
  {0}};

const pw_key pw_scene_keys_grid_implicit[] = {
  {"steps", PW_KEY_INT, AT(implicit.steps), 1, 1e6, "20", NULL, NULL,
   "load steps from the start to end_s; rows and files that fall into a step follow its end"},
  KEYS_OF_LENGTH,
  KEYS_OF_ITERATION,
  KEYS_OF_SOLVER,
  {0}};

const pw_key pw_scene_keys_solid_output[] = {
  {"history_every_steps", PW_KEY_INT, AT(output.history_every_steps), 0, 1e6, "1", NULL, NULL,
   "load steps between rows of history.csv; 0: a row for every step, whole or not"},
  {"snapshot_every_steps", PW_KEY_INT, AT(output.snapshot_every_steps), 0, 1e6, "0", NULL, NULL,
   "load steps between ParaView files; 0: only at the start and the end"},
  {"checkpoint_every_steps", PW_KEY_INT, AT(output.checkpoint_every_steps), 0, 1e6, "0", NULL, NULL,
   "load steps between checkpoints besides those at the start, the end and every 30 s of waiting"},
  {"paraview", PW_KEY_BOOL, AT_SCENE(output.paraview), 0, 0, "true", NULL, NULL,
   "write ParaView files"},
  {"pictures", PW_KEY_BOOL, AT_SCENE(output.pictures), 0, 0, "true", NULL, NULL,
   "draw pictures"},
  {"picture_steps", PW_KEY_REALS, AT(output.picture_steps), 0, 1e6, "[]", NULL, NULL,
   "load steps after which fields are drawn, besides the end"},
  {"slice_axis", PW_KEY_CHOICE, AT(output.slice_axis), 0, 0, "z", "x|y|z", NULL,
   "pictures of fields show a plane cut through the mesh: its normal"},
  {"slice_part", PW_KEY_REAL, AT(output.slice_part), 0, 1, "0.5", NULL, NULL,
   "place of the cut: 0 at the least, 1 at the largest coordinate of the mesh"},
  {0}};

const pw_key pw_scene_keys_solid_body[] = {
  {"material", PW_KEY_MATERIAL, AT_BODY(material), 0, 0, NULL, NULL, NULL,
   "one of the names under materials"},
  {"volume", PW_KEY_TEXT, AT_BODY(volume), 0, 0, "", NULL, NULL,
   "physical group of the mesh that it fills; absent: all of the mesh"},
  {"low_m", PW_KEY_TRIPLE, AT_BODY(low_m), -FAR_M, FAR_M, "[0, 0, 0]", NULL, NULL,
   "with high_m: only cells whose centroid lies in this box are filled; equal: all"},
  {"high_m", PW_KEY_TRIPLE, AT_BODY(high_m), -FAR_M, FAR_M, "[0, 0, 0]", NULL, NULL,
   "corner of that box with the largest coordinates"},
  {0}};
/* clang-format on */

void pw_scene_solid_times(pw_scene *s)
{
  const pw_real step = s->solid.implicit.step_s;
  const pw_scene_solid_output *o = &s->solid.output;
  s->time.end_s = step * s->solid.implicit.steps;
  s->output.history_every_s = step * o->history_every_steps;
  s->output.snapshot_every_s = step * o->snapshot_every_steps;
  s->output.checkpoint_every_s = step * o->checkpoint_every_steps;
  s->output.picture_times_s = o->picture_steps;
  for (int i = 0; i < o->picture_steps.n; i++) {
    s->output.picture_times_s.v[i] *= step;
  }
}

static pw_status check_box(const pw_scene_mesh *m)
{
  static const char axis[] = "xyz";
  pw_real cells = m->tets_per_brick * (m->cells == PW_CELLS_TEN_NODE ? 8.0 : 1.0);
  for (int c = 0; c < 3; c++) {
    PW_REQUIRE(m->high_m[c] - m->low_m[c] > SMALL_M, PW_ERR_SCENE,
               "high_m: along %c the box ends at %g m and begins at %g m", axis[c], m->high_m[c],
               m->low_m[c]);
    PW_REQUIRE(m->bricks[c] == floor(m->bricks[c]), PW_ERR_SCENE,
               "bricks: %g along %c is no whole number", m->bricks[c], axis[c]);
    cells *= m->bricks[c];
  }
  PW_REQUIRE(cells < 3e7, PW_ERR_SCENE,
             "bricks: they make %.3g elements, at most 3e7 can be handled", cells);
  return PW_OK;
}

static bool ends_with(const char *text, const char *ending)
{
  const size_t n = strlen(text), k = strlen(ending);
  return n > k && strcmp(text + n - k, ending) == 0;
}

pw_status pw_scene_check_mesh(const pw_scene *s)
{
  const pw_scene_mesh *m = &s->solid.mesh;
  if (m->kind == PW_MESH_BOX) {
    return check_box(m);
  }
  const bool geo = ends_with(m->file, ".geo");
  PW_REQUIRE(geo || ends_with(m->file, ".msh"), PW_ERR_SCENE,
             "file: it must be a mesh (.msh) or a geometry (.geo) of gmsh's");
  PW_REQUIRE(geo || !m->numbers[0], PW_ERR_SCENE, "numbers: a mesh takes none, a geometry does");
  PW_REQUIRE(geo || m->size_factor == 1.0, PW_ERR_SCENE,
             "size_factor: a mesh keeps its sizes, a geometry can change them");
  return PW_OK;
}

pw_status pw_scene_check_implicit(const pw_scene *s)
{
  const pw_scene_implicit *p = &s->solid.implicit;
  PW_REQUIRE(p->point_rule != PW_TET_RULE_ELEVEN_KEAST || p->negative_volumes, PW_ERR_SCENE,
             "point_rule: eleven_keast gives one point in eleven a negative volume; say "
             "negative_volumes: true to have it");
  PW_REQUIRE(p->easy_iterations < p->hard_iterations, PW_ERR_SCENE,
             "easy_iterations: %d must be less than hard_iterations = %d", p->easy_iterations,
             p->hard_iterations);
  return PW_OK;
}

pw_status pw_scene_check_solid_body(const pw_scene *s, int i)
{
  const pw_scene_body *b = &s->body[i];
  for (int k = 0; k < i; k++) {
    PW_REQUIRE(strcmp(s->body[k].name, b->name) != 0, PW_ERR_SCENE, "two bodies have the name '%s'",
               b->name);
  }
  PW_REQUIRE(b->material >= 0 && b->material < s->nmaterial, PW_ERR_SCENE,
             "material: body '%s' has no material", b->name);
  for (int c = 0; c < 3; c++) {
    PW_REQUIRE(b->low_m[c] <= b->high_m[c], PW_ERR_SCENE,
               "high_m: along %c the box ends at %g m and begins at %g m", "xyz"[c], b -> high_m[c],
               b -> low_m[c]);
  }
  return PW_OK;
}
