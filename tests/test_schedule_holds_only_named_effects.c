/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes pay only for the effects they name: the exact hooks of a step, in their order, and the
 * exact arrays of a point, for three scenes. */
#include "tests/engine_scenes.h"

static void assert_hooks(const pw_sim *sim, const char *want)
{
  char text[4096];
  pw_sim_schedule_text(sim, text, sizeof text);
  assert_string_equal(text, want);
}

/* Names of the arrays that exist, in the order of engine/fields.def. */
static void assert_fields(const pw_sim *sim, const char *want)
{
  char text[512] = "";
  for (int f = 0; f < PW_FIELD_COUNT; f++) {
    pw_field_info info = pw_points_field(pw_sim_points(sim), (pw_field_id)f);
    if (info.array) {
      strcat(text, text[0] ? " " : "");
      strcat(text, info.name);
    }
  }
  assert_string_equal(text, want);
}

static int contexts(const pw_sim *sim)
{
  int n = 0;
  for (int e = 0; e < PW_MAX_EFFECTS; e++) {
    n += sim->ctx[e] != NULL;
  }
  return n;
}

/* Weight and rollers; standard MPM, so that points have no domains. */
static void elastic_column(void **state)
{
  (void)state;
  static pw_scene s;
  pw_scene_default(&s);
  s.method.basis = PW_LINEAR;
  test_grid(&s, (pw_real[]){0.0, 1.0, 0.0, 10.0}, 1.0);
  int m = test_elastic(&s, 1e7, 0.3, 2e3);
  test_rectangle(&s, m, (pw_real[]){0.0, 1.0, 0.0, 8.0}, 0.5);
  test_roller(&s, PW_SIDE_BOTTOM);
  test_gravity(&s, 1.0);
  pw_sim *sim = test_sim(&s, 1);
  assert_hooks(sim, "node_force: gravity\nweight: gravity\n"
                    "constraint: boundary\n"
                    "remap: boundary\n"
                    "motion: gravity\nend: gravity\nend: boundary\n");
  assert_fields(sim, "id body home x v mass vol def_grad stress corner local");
  assert_int_equal(sim->nodes.nfield, 1);
  assert_null(sim->limit);
  assert_int_equal(contexts(sim), 2);
  pw_sim_destroy(&sim);
}

/* One cell of sand under a pressure on its right side, its top moved. */
static void biaxial_test(void **state)
{
  (void)state;
  static pw_scene s;
  pw_scene_default(&s);
  test_grid(&s, (pw_real[]){0.0, 2.0, 0.0, 1.0}, 1.0);
  int m = test_sand(&s, false);
  test_rectangle(&s, m, (pw_real[]){0.0, 1.0, 0.0, 1.0}, 1.0);
  test_roller(&s, PW_SIDE_BOTTOM);
  test_roller(&s, PW_SIDE_LEFT);
  test_roller(&s, PW_SIDE_TOP);
  pw_surcharge_param *p = pw_scene_add_effect(&s, "surcharge");
  p->body = 0;
  p->side = PW_SIDE_RIGHT;
  p->pressure_pa = 1e5;
  pw_initial_stress_param *i = pw_scene_add_effect(&s, "initial_stress");
  i->body = 0;
  i->kind = PW_STRESS_UNIFORM;
  i->stress_xx_pa = i->stress_yy_pa = i->stress_zz_pa = -1e5;
  pw_sim *sim = test_sim(&s, 1);
  assert_hooks(
      sim, "p2g: initial_stress\n"
           "node_force: surcharge\n"
           "constraint: boundary\nconstraint: boundary\nconstraint: boundary\n"
           "remap: boundary\nremap: boundary\nremap: boundary\n"
           "end: initial_stress\nend: surcharge\nend: boundary\nend: boundary\nend: boundary\n");
  assert_fields(sim, "id body home x v mass vol def_grad stress state half0 half corner local");
  assert_int_equal(sim->points.nstate, 1); /* the void ratio: intergranular strain is off */
  assert_int_equal(sim->nodes.nfield, 1);
  assert_int_equal(contexts(sim), 5);
  assert_null(sim->buoyant); /* no ground water */
  pw_sim_destroy(&sim);
}

static void hammered_pile(void **state)
{
  (void)state;
  static pw_scene s;
  test_hammered_pile(&s, TEST_PENALTY, 0.125);
  pw_sim *sim = test_sim(&s, 1);
  assert_hooks(sim, "p2g: initial_stress\np2g: contact_penalty\n"
                    "node_force: gravity\nnode_force: hammer\nnode_force: contact_penalty\n"
                    "weight: gravity\n"
                    "constraint: boundary\nconstraint: boundary\n"
                    "remap_p2g: contact_penalty\n"
                    "remap: boundary\nremap: boundary\n"
                    "motion: gravity\nmesh: contact_penalty\n"
                    "end: initial_stress\nend: gravity\nend: hammer\nend: boundary\nend: "
                    "boundary\nend: pile_record\n");
  assert_fields(sim, "id body home x v mass vol def_grad stress state half0 half corner local");
  assert_int_equal(sim->points.nstate, 8); /* void ratio, intergranular strain, substep */
  assert_int_equal(sim->nodes.nfield, 2);
  assert_true(pw_points_bytes_per_point(&sim->points) <= 700);
  pw_sim_destroy(&sim);
}

/* Stages that run by parts alone would leave out an ordinary hook; others a hook by parts. */
static void hooks_stand_in_stages_that_run_them(void **state)
{
  (void)state;
  for (int e = 0; pw_effect_at(e); e++) {
    for (const pw_hook *h = pw_effect_at(e)->hooks; h && h->fn; h++) {
      assert_true(h->stage != PW_STAGE_WEIGHT && h->stage != PW_STAGE_MOTION);
    }
    for (const pw_part_hook *h = pw_effect_at(e)->part_hooks; h && h->fn; h++) {
      assert_true(h->stage == PW_STAGE_WEIGHT || h->stage == PW_STAGE_CONSTRAINT ||
                  h->stage == PW_STAGE_REMAP || h->stage == PW_STAGE_MOTION);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(elastic_column),
      cmocka_unit_test(biaxial_test),
      cmocka_unit_test(hammered_pile),
      cmocka_unit_test(hooks_stand_in_stages_that_run_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
