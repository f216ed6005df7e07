/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Values written in scenes/good_pile.yaml arrive unchanged; keys not given have their defaults. */
#include "tests/harness.h"

#include <stdlib.h>

#include "engine/effect.h"
#include "engine/effects/contact.h"
#include "engine/effects/params.h"
#include "engine/scene_keys.h"
#include "io/scene_file.h"

static pw_scene scene;

static int read_pile(void **state)
{
  (void)state;
  char *messages = NULL;
  pw_status status = pw_scene_read_file("scenes/good_pile.yaml", 0, NULL, &scene, &messages);
  if (status != PW_OK) {
    print_error("%s", messages ? messages : "");
  }
  free(messages);
  return status == PW_OK && !messages ? 0 : -1;
}

/* Decimal numbers must give the very double the compiler makes of them. */
#define assert_same(a, b) assert_near(a, b, 0)

#define assert_pair(pair, a, b)                                                                    \
  do {                                                                                             \
    assert_same((pair)[0], a);                                                                     \
    assert_same((pair)[1], b);                                                                     \
  } while (0)

static void sections_arrive(void **state)
{
  (void)state;
  assert_string_equal(scene.title, "driven pile: every key");
  assert_string_equal(scene.file, "scenes/good_pile.yaml");
  assert_int_equal(scene.geometry, PW_AXI);
  assert_pair(scene.grid.origin_m, 0, -1);
  assert_pair(scene.grid.size_m, 5, 16);
  assert_same(scene.grid.cell_m, 0.125);
  assert_same(scene.time.end_s, 12);
  assert_same(scene.time.cfl, 0.45);
  assert_same(scene.time.dt_max_s, 1e-3);
  assert_same(scene.time.dt_s, 0);
  assert_int_equal(scene.method.basis, PW_UGIMP);
  assert_int_equal(scene.method.update, PW_USL);
  assert_same(scene.method.domain_limit_cells, 0.75);
  assert_same(scene.method.mass_cut_off, 1e-8);
  assert_int_equal(scene.method.block_elements, 32);
}

static void output_arrives(void **state)
{
  (void)state;
  assert_same(scene.output.history_every_s, 0.002);
  assert_same(scene.output.snapshot_every_s, 0.5);
  assert_same(scene.output.checkpoint_every_s, 1);
  assert_false(scene.output.paraview);
  assert_false(scene.output.pictures);
  assert_int_equal(scene.output.picture_times_s.n, 3);
  assert_same(scene.output.picture_times_s.v[0], 2);
  assert_same(scene.output.picture_times_s.v[1], 2.5);
  assert_same(scene.output.picture_times_s.v[2], 12);
  assert_pair(scene.output.picture_x_m, 0, 2);
  assert_pair(scene.output.picture_y_m, 6, 15);
}

/* Parameter of a material by the name of its key: every value is stored as a pw_real. */
static pw_real parameter(const pw_scene_material *m, const char *name)
{
  const pw_key *key = pw_key_find(m->model->keys, name);
  assert_non_null(key);
  return m->param[key->offset / sizeof(pw_real)];
}

static void materials_arrive(void **state)
{
  (void)state;
  const pw_scene_material *sand = &scene.material[0], *steel = &scene.material[1];
  assert_int_equal(scene.nmaterial, 2);
  assert_string_equal(sand->name, "sand");
  assert_ptr_equal(sand->model, pw_material_find("hypoplastic_sand"));
  assert_same(parameter(sand, "grain_density_kg_m3"), 2600);
  assert_same(parameter(sand, "void_ratio"), 0.65);
  assert_same(parameter(sand, "void_ratio_rule"), 1);
  assert_same(parameter(sand, "critical_friction_angle_deg"), 33);
  assert_same(parameter(sand, "cohesion_shift_pa"), 1600);
  assert_same(parameter(sand, "granular_hardness_pa"), 5.8e9);
  assert_same(parameter(sand, "exponent_n"), 0.28);
  assert_same(parameter(sand, "void_ratio_d0"), 0.53);
  assert_same(parameter(sand, "void_ratio_c0"), 0.84);
  assert_same(parameter(sand, "void_ratio_i0"), 1);
  assert_same(parameter(sand, "exponent_alpha"), 0.13);
  assert_same(parameter(sand, "exponent_beta"), 1.05);
  assert_same(parameter(sand, "intergranular_strain"), 0);
  assert_string_equal(steel->name, "steel");
  assert_ptr_equal(steel->model, pw_material_find("linear_elastic"));
  assert_same(parameter(steel, "youngs_modulus_pa"), 1e8);
  assert_same(parameter(steel, "poisson_ratio"), 0.28);
  assert_same(pw_scene_density(&scene, 1), 2500);
}

static void bodies_arrive(void **state)
{
  (void)state;
  const pw_scene_body *soil = &scene.body[0], *pile = &scene.body[1];
  assert_int_equal(scene.nbody, 2);
  assert_int_equal(pw_scene_find_body(&scene, "soil"), 0);
  assert_int_equal(pw_scene_find_body(&scene, "pile"), 1);
  assert_int_equal(pw_scene_find_body(&scene, "sand"), -1);
  assert_int_equal(soil->material, 0);
  assert_int_equal(soil->shape, PW_SHAPE_RECTANGLE);
  assert_pair(soil->x_m, 0, 5);
  assert_pair(soil->y_m, -1, 10);
  assert_same(soil->point_size_m, 0.125);
  assert_pair(soil->velocity_m_s, 0, 0);
  assert_int_equal(soil->nrefine, 2);
  assert_pair(soil->refine[0].x_m, 0, 1);
  assert_pair(soil->refine[0].y_m, 5, 10);
  assert_same(soil->refine[0].point_size_m, 0.0625);
  assert_pair(soil->refine[1].x_m, 0, 0.5);
  assert_same(soil->refine[1].point_size_m, 0.03125);
  assert_int_equal(pile->material, 1);
  assert_int_equal(pile->shape, PW_SHAPE_PILE);
  assert_int_equal(pile->tip, PW_TIP_ROUNDED);
  assert_same(pile->radius_m, 0.15);
  assert_same(pile->tip_y_m, 9.85);
  assert_same(pile->length_m, 5);
  assert_same(pile->tip_length_m, 0.15); /* not given: the radius, so a half sphere */
  assert_pair(pile->velocity_m_s, 0, -1.5);
  assert_int_equal(pile->nrefine, 0);
}

static void single_effects_arrive(void **state)
{
  (void)state;
  const pw_initial_stress_param *stress = pw_scene_find_effect(&scene, "initial_stress");
  const pw_gravity_param *gravity = pw_scene_find_effect(&scene, "gravity");
  const pw_hammer_param *hammer = pw_scene_find_effect(&scene, "hammer");
  const pw_contact_frictional_param *contact = pw_scene_find_effect(&scene, "contact_frictional");
  assert_int_equal(stress->body, 0);
  assert_same(stress->k0, 0.45);
  assert_same(stress->top_y_m, 10);
  assert_same(gravity->acceleration_m_s2, 10);
  assert_same(gravity->ramp_s, 2);
  assert_same(gravity->tilt_deg, 0);
  assert_int_equal(hammer->body, 1);
  assert_same(hammer->pressure_pa, 1e6);
  assert_same(hammer->duration_s, 0.1);
  assert_same(hammer->period_s, 0.5);
  assert_int_equal(hammer->count, 20);
  assert_same(hammer->start_s, 2);
  assert_int_equal(hammer->pulse, PW_PULSE_HALF_SINE);
  assert_int_equal(contact->master, 1);
  assert_int_equal(contact->slave, 0);
  assert_same(contact->friction, 0.2);
  assert_int_equal(contact->normal, PW_NORMAL_AVERAGE);
  assert_int_equal(contact->detection, PW_DETECT_CLOSED_GAP);
  assert_true(contact->require_compression);
  assert_null(pw_scene_find_effect(&scene, "contact_penalty"));
}

static void lists_of_effects_arrive_in_order(void **state)
{
  (void)state;
  static const char *const order[] = {
      "initial_stress", "gravity",  "hammer",   "damping_local",      "damping_local",
      "boundary",       "boundary", "boundary", "contact_frictional", "pile_record"};
  assert_int_equal(scene.neffect, 10);
  for (int i = 0; i < 10; i++) {
    assert_string_equal(scene.effect[i].type->name, order[i]);
  }
  const pw_damping_local_param *damping = (const void *)scene.effect[3].param;
  assert_same(damping->coefficient, 0.7);
  assert_same(damping->until_s, 2);
  assert_int_equal(damping->body, -1);
  damping = (const void *)scene.effect[4].param;
  assert_same(damping->until_s, 0);
  assert_int_equal(damping->body, 0);
  const pw_boundary_param *side = (const void *)scene.effect[5].param;
  assert_int_equal(side->side, PW_SIDE_BOTTOM);
  assert_true(side->fix_x && side->fix_y);
  assert_int_equal(side->body, -1);
  side = (const void *)scene.effect[7].param;
  assert_int_equal(side->side, PW_SIDE_RIGHT);
  assert_true(side->fix_x && !side->fix_y);
  assert_int_equal(side->body, 0);
}

static void keys_not_given_have_their_defaults(void **state)
{
  (void)state;
  static const char text[] = "geometry: plane_strain\n"
                             "grid: {size_m: [1, 1], cell_m: 0.5}\n"
                             "time: {end_s: 2}\n"
                             "materials: {a: {model: neo_hookean, bulk_modulus_pa: 1,\n"
                             "  shear_modulus_pa: 1, density_kg_m3: 1}}\n"
                             "bodies: {b: {material: a, shape: disc, centre_m: [0.5, 0.5],\n"
                             "  radius_m: 0.5, point_size_m: 0.1}}\n"
                             "contact_frictional:\n"
                             "surcharge: []\n";
  static pw_scene small, empty;
  char *messages = NULL;
  /* no effect with a required key may be left empty, one without entries is none */
  assert_int_equal(pw_scene_read_text(text, sizeof text - 1, "small", 0, NULL, &small, &messages),
                   PW_ERR_SCENE);
  assert_non_null(strstr(messages, "small:8:1: error: missing key 'master'"));
  free(messages);
  const char *cut = strstr(text, "contact");
  assert_ok(pw_scene_read_text(text, (size_t)(cut - text), "small", 0, NULL, &small, &messages));
  assert_null(messages);
  pw_scene_default(&empty);
  assert_string_equal(small.title, "");
  assert_pair(small.grid.origin_m, 0, 0);
  assert_same(small.time.cfl, 0.5);
  assert_same(small.time.dt_max_s, 1);
  assert_int_equal(small.method.basis, PW_CPDI);
  assert_int_equal(small.method.update, PW_MUSL);
  assert_memory_equal(&small.method, &empty.method, sizeof small.method);
  assert_memory_equal(&small.output, &empty.output, sizeof small.output);
  assert_int_equal(small.neffect, 0);
  assert_ok(pw_scene_check(&small));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sections_arrive),
      cmocka_unit_test(output_arrives),
      cmocka_unit_test(materials_arrive),
      cmocka_unit_test(bodies_arrive),
      cmocka_unit_test(single_effects_arrive),
      cmocka_unit_test(lists_of_effects_arrive_in_order),
      cmocka_unit_test(keys_not_given_have_their_defaults),
  };
  return cmocka_run_group_tests(tests, read_pile, NULL);
}
