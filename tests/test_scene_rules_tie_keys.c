/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pw_scene_check on scenes filled by hand: the first broken rule is named with its section. */
#include "tests/harness.h"

#include "engine/effect.h"
#include "engine/effects/contact.h"
#include "engine/effects/params.h"
#include "engine/scene_keys.h"

static pw_scene s;

static void put(pw_scene_material *m, const char *name, pw_real value)
{
  const pw_key *key = pw_key_find(m->model->keys, name);
  assert_non_null(key);
  m->param[key->offset / sizeof(pw_real)] = value;
}

static void add_material(const char *name, const char *model, const char *stiffness)
{
  pw_scene_material *m = &s.material[s.nmaterial++];
  strcpy(m->name, name);
  m->model = pw_material_find(model);
  pw_scene_defaults(m->model->keys, m->param);
  put(m, stiffness, 1e6);
  put(m, strcmp(model, "neo_hookean") == 0 ? "shear_modulus_pa" : "poisson_ratio", 0.3);
  put(m, "density_kg_m3", 1000);
}

static pw_scene_body *add_rectangle(const char *name, int material, pw_real x0, pw_real x1)
{
  pw_scene_body *b = &s.body[s.nbody++];
  pw_scene_defaults(pw_scene_keys_body, b);
  strcpy(b->name, name);
  b->material = material;
  b->shape = PW_SHAPE_RECTANGLE;
  b->x_m[0] = x0;
  b->x_m[1] = x1;
  b->y_m[1] = 1;
  b->point_size_m = 0.05;
  return b;
}

/* Two blocks side by side on a grid of 2 m x 2 m. */
static int make_scene(void **state)
{
  (void)state;
  pw_scene_default(&s);
  s.grid.size_m[0] = s.grid.size_m[1] = 2;
  s.grid.cell_m = 0.1;
  s.time.end_s = 1;
  add_material("rock", "linear_elastic", "youngs_modulus_pa");
  add_material("rubber", "neo_hookean", "bulk_modulus_pa");
  add_rectangle("left", 0, 0, 1);
  add_rectangle("right", 1, 1, 2);
  return 0;
}

static void expect_rule(const char *text)
{
  pw_error_clear();
  assert_int_equal(pw_scene_check(&s), PW_ERR_SCENE);
  if (!strstr(pw_error_text(), text)) {
    fail_msg("\"%s\"\nexpected: \"%s\"", pw_error_text(), text);
  }
}

static void a_sound_scene_passes(void **state)
{
  (void)state;
  assert_ok(pw_scene_check(&s));
  /* touching the edge of the grid from inside is allowed, round-off included */
  s.grid.origin_m[0] = 0.1 + 0.2 - 0.3;
  assert_ok(pw_scene_check(&s));
}

static void counts_are_limited(void **state)
{
  (void)state;
  s.nbody = 0;
  expect_rule("bodies: 0, from 1 to 8 are needed");
  s.nbody = PW_MAX_BODIES + 1;
  expect_rule("bodies: 9, from 1 to 8 are needed");
  s.nbody = 2;
  s.nmaterial = PW_MAX_MATERIALS + 1;
  expect_rule("materials: 17, at most 16");
}

static void the_grid_is_whole_and_of_a_size(void **state)
{
  (void)state;
  s.grid.size_m[0] = 2.04;
  expect_rule("grid: size_m: the width 2.04 m is not a whole number of cells of 0.1 m");
  s.grid.size_m[0] = 1e6;
  s.grid.size_m[1] = 1e6;
  s.grid.cell_m = 1e-3;
  expect_rule("grid: cell_m = 0.001 m: more than 32768 cells along one side");
  s.grid.size_m[0] = s.grid.size_m[1] = 20;
  expect_rule("grid: cell_m = 0.001 m gives 4e+08 nodes, at most 2e+08 can be handled");
  s.method.basis = PW_UGIMP;
  s.grid.size_m[0] = 1e-3;
  expect_rule("grid: size_m: ugimp needs at least two cells in each direction");
}

static void rows_in_pairs_need_a_fine_zone(void **state)
{
  (void)state;
  s.grid.paired_rows_x_m = 1.0;
  expect_rule("grid: paired_rows_x_m = 1 m needs the rows of a fine zone: fine_y_m");
  s.grid.growth = 1.2;
  s.grid.fine_x_m[1] = 1.5;
  s.grid.fine_y_m[1] = 1.5;
  s.method.basis = PW_CPDI;
  expect_rule("grid: paired_rows_x_m = 1 m lies within the fine zone, which ends at 1.5 m");
  s.grid.paired_rows_x_m = 2.0;
  expect_rule("grid: paired_rows_x_m = 2 m lies beyond the grid, which ends at 2 m");
  s.grid.paired_rows_x_m = 1.5;
  assert_ok(pw_scene_check(&s));
  s.method.update = PW_USF;
  expect_rule("grid: paired_rows_x_m needs basis cpdi and update musl or usl");
  s.method.update = PW_MUSL;
  pw_contact_frictional_param *c = pw_scene_add_effect(&s, "contact_frictional");
  c->master = 0;
  c->slave = 1;
  expect_rule("grid: paired_rows_x_m: not with absorbing, damping_local, "
              "contact_frictional or contact_penalty");
}

static void two_terms_of_the_mass_matrix_need_what_knows_them(void **state)
{
  (void)state;
  s.method.mass_terms = 2;
  assert_ok(pw_scene_check(&s));
  s.method.step_ratio_max = 4;
  expect_rule("method: mass_terms = 2: not with step_ratio_max = 4");
  s.method.step_ratio_max = 1;
  s.method.update = PW_IMPLICIT;
  expect_rule("method: mass_terms = 2: implicit steps have the full mass matrix");
  s.method.update = PW_USL;
  s.method.basis = PW_CPDI;
  s.grid.growth = 1.2;
  s.grid.fine_x_m[1] = s.grid.fine_y_m[1] = 1.5;
  s.grid.paired_rows_x_m = 1.5;
  expect_rule("method: mass_terms = 2: not with grid: paired_rows_x_m");
  s.grid.paired_rows_x_m = 0.0;
  pw_contact_frictional_param *c = pw_scene_add_effect(&s, "contact_frictional");
  c->master = 0;
  c->slave = 1;
  expect_rule("method: mass_terms = 2: contact_frictional knows lumped masses only");
}

static void names_are_unique(void **state)
{
  (void)state;
  strcpy(s.body[1].name, "left");
  expect_rule("bodies.left: two bodies have the name 'left'");
  strcpy(s.body[1].name, "right");
  strcpy(s.material[1].name, "rock");
  expect_rule("materials.rock: two materials have the name 'rock'");
}

static void bodies_lie_in_the_grid(void **state)
{
  (void)state;
  s.body[1].x_m[1] = 2.001;
  expect_rule("bodies.right: body 'right' leaves the grid: its right is at 2.001 m");
  s.body[1].shape = PW_SHAPE_DISC;
  s.body[1].centre_m[0] = 1.5;
  s.body[1].centre_m[1] = 0.4;
  s.body[1].radius_m = 0.5;
  expect_rule("bodies.right: body 'right' leaves the grid: its bottom is at -0.1 m");
}

static void shapes_are_sound(void **state)
{
  (void)state;
  s.geometry = PW_AXI;
  pw_scene_body *b = &s.body[1];
  b->shape = PW_SHAPE_PILE;
  b->radius_m = 0.3;
  b->tip_y_m = 1;
  b->length_m = 0.2;
  assert_ok(pw_scene_check(&s)); /* half a pile at r >= 0, flat */
  b->tip = PW_TIP_ROUNDED;
  expect_rule("bodies.right: length_m = 0.2 m is shorter than the pile's tip of 0.3 m");
  b->shape = PW_SHAPE_DISC;
  b->centre_m[1] = 0.5;
  b->centre_m[0] = 0.3;
  assert_ok(pw_scene_check(&s)); /* a ring that closes on the axis */
  b->centre_m[0] = 0.2;
  expect_rule("bodies.right: body 'right' crosses the axis x = 0");
  s.body[0].material = -1;
  expect_rule("bodies.left: material: body 'left' has no material");
}

static void sizes_of_points_are_sound(void **state)
{
  (void)state;
  pw_scene_body *b = &s.body[0];
  b->point_size_m = 0.41;
  expect_rule("bodies.left: point_size_m = 0.41 m is larger than 4 cells (0.4 m)");
  b->shape = PW_SHAPE_DISC;
  b->nrefine = 1;
  b->radius_m = b->centre_m[0] = b->centre_m[1] = 0.5;
  expect_rule("bodies.left: refine: only a rectangle can be refined");
  b->shape = PW_SHAPE_RECTANGLE;
  b->nrefine = 0;
  b->point_size_m = 1e-5;
  expect_rule("bodies.left: point_size_m: domains of 1e-05 m may give 1e+10 points");
  b->point_size_m = 0.1;
  b->nrefine = 1;
  b->refine[0] = (pw_scene_refine){{0, 1}, {0, 1}, 0.2, 0};
  expect_rule("bodies.left: refine: point_size_m = 0.2 m of entry 0 is larger");
  b->refine[0] = (pw_scene_refine){{1, 0}, {0, 1}, 0.1, 0};
  expect_rule("bodies.left: refine: x_m and y_m of entry 0 must be written [smaller, larger]");
}

static void limits_of_domains_and_tilt_make_sense(void **state)
{
  (void)state;
  s.method.domain_aspect_max = 0.5;
  expect_rule("method: domain_aspect_max = 0.5: longest to shortest half-side, 1 at least");
  s.method.domain_aspect_max = 1;
  pw_gravity_param *g = pw_scene_add_effect(&s, "gravity");
  g->tilt_deg = -10;
  assert_ok(pw_scene_check(&s));
  s.geometry = PW_AXI;
  expect_rule("gravity: tilt_deg = -10: in axisymmetry gravity acts along the axis");
  g->tilt_deg = 0;
  assert_ok(pw_scene_check(&s));
}

static void materials_check_themselves(void **state)
{
  (void)state;
  put(&s.material[0], "poisson_ratio", 0.5);
  expect_rule("materials.rock: poisson_ratio = 0.5 must lie between");
}

static void effects_are_given_once(void **state)
{
  (void)state;
  assert_null(pw_scene_add_effect(&s, "gravitation"));
  assert_non_null(pw_scene_add_effect(&s, "gravity"));
  assert_ok(pw_scene_check(&s));
  assert_non_null(pw_scene_add_effect(&s, "gravity"));
  expect_rule("gravity: gravity is given twice");
  s.neffect = 0;
  for (int i = 0; i < PW_MAX_EFFECTS; i++) {
    pw_damping_local_param *damping = pw_scene_add_effect(&s, "damping_local");
    assert_non_null(damping);
    assert_int_equal(damping->body, -1);
  }
  assert_null(pw_scene_add_effect(&s, "damping_local"));
}

static void references_of_effects_exist(void **state)
{
  (void)state;
  pw_damping_local_param *damping = pw_scene_add_effect(&s, "damping_local");
  assert_ok(pw_scene_check(&s)); /* every body */
  damping->body = 2;
  expect_rule("damping_local.0: body: no such body");
  s.neffect = 0;
  pw_scene_add_effect(&s, "pile_record");
  expect_rule("pile_record: body: no such body");
}

static void one_contact_at_most(void **state)
{
  (void)state;
  pw_contact_penalty_param *penalty = pw_scene_add_effect(&s, "contact_penalty");
  pw_contact_frictional_param *friction = pw_scene_add_effect(&s, "contact_frictional");
  penalty->master = friction->master = 0;
  penalty->slave = friction->slave = 1;
  penalty->normal_stiffness_pa_m = 1e8;
  assert_int_equal(pw_scene_check(&s), PW_ERR_SCENE);
  s.neffect = 1;
  assert_ok(pw_scene_check(&s));
}

static void initial_stress_needs_a_material_that_takes_it(void **state)
{
  (void)state;
  pw_initial_stress_param *stress = pw_scene_add_effect(&s, "initial_stress");
  stress->body = 0;
  stress->k0 = 0.5;
  stress->top_y_m = 1;
  stress->acceleration_m_s2 = 10;
  assert_ok(pw_scene_check(&s));
  stress->body = 1;
  expect_rule("initial_stress: body: 'right' is of neo_hookean, which cannot start from a "
              "prescribed stress");
}

static void times_do_not_contradict(void **state)
{
  (void)state;
  s.time.dt_s = 0.1;
  assert_ok(pw_scene_check(&s));
  s.time.dt_max_s = 0.01;
  expect_rule("time: dt_s = 0.1 s is larger than dt_max_s = 0.01 s");
}

#define RULE(name) cmocka_unit_test_setup(name, make_scene)

int main(void)
{
  const struct CMUnitTest tests[] = {
      RULE(a_sound_scene_passes),
      RULE(counts_are_limited),
      RULE(the_grid_is_whole_and_of_a_size),
      RULE(rows_in_pairs_need_a_fine_zone),
      RULE(two_terms_of_the_mass_matrix_need_what_knows_them),
      RULE(names_are_unique),
      RULE(bodies_lie_in_the_grid),
      RULE(shapes_are_sound),
      RULE(sizes_of_points_are_sound),
      RULE(limits_of_domains_and_tilt_make_sense),
      RULE(materials_check_themselves),
      RULE(effects_are_given_once),
      RULE(references_of_effects_exist),
      RULE(one_contact_at_most),
      RULE(initial_stress_needs_a_material_that_takes_it),
      RULE(times_do_not_contradict),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
