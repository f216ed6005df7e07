/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The record of a driven pile: points are moved by hand, so every figure is known. Its state and
 * that of the other effects survive an archive bitwise. */
#include "engine/effects/params.h"
#include "tests/engine_helpers.h"

enum { MAX_ARCHIVE = 1 << 22 };

static const pw_record_item *item(const pw_record *r, const char *name)
{
  for (int k = 0; k < r->n; k++) {
    if (strcmp(r->item[k].name, name) == 0) {
      return &r->item[k];
    }
  }
  fail_msg("no item %s", name);
  return NULL;
}

/* Soil of 2 m x 2 m, its surface at y = 0, and the pile of the thesis, 0.1 m above it. */
static void pile_and_soil(pw_scene *scene, int tip)
{
  pw_scene_default(scene);
  scene->geometry = PW_AXI;
  test_grid(scene, (pw_real[4]){0.0, 2.0, -2.0, 6.0}, 0.125);
  int soil = test_elastic(scene, 1e7, 0.2, 1600.0);
  test_rectangle(scene, soil, (pw_real[4]){0.0, 2.0, -2.0, 0.0}, 0.0625);
  int steel = test_elastic(scene, 1e8, 0.28, 2500.0);
  scene->body[1] = (pw_scene_body){.material = steel,
                                   .shape = PW_SHAPE_PILE,
                                   .radius_m = 0.15,
                                   .tip_y_m = 0.1,
                                   .length_m = 5.0,
                                   .tip = tip,
                                   .point_size_m = 0.05};
  snprintf(scene->body[1].name, sizeof scene->body[1].name, "pile");
  scene->nbody = 2;
  pw_hammer_param *h = pw_scene_add_effect(scene, "hammer");
  h->body = 1;
  h->pressure_pa = 1e6;
  h->duration_s = 0.1;
  h->period_s = 0.5;
  h->count = 3;
  h->start_s = 2.0;
  pw_pile_record_param *r = pw_scene_add_effect(scene, "pile_record");
  r->body = 1;
  r->soil = 0;
}

static void lower_body(pw_sim *sim, int body, pw_real by)
{
  for (pw_idx i = 0; i < sim->points.n; i++) {
    if (sim->points.body[i] == body) {
      sim->points.x[sim->points.ld + i] -= by;
    }
  }
}

/* Run the record's hook as if a step had ended at @p time. */
static void end_step(pw_sim *sim, pw_real time, pw_off step)
{
  const pw_effect *type = pw_effect_find("pile_record");
  sim->time = time;
  sim->step = step;
  assert_ok(type->hooks[0].fn(sim, pw_sim_effect_ctx(sim, "pile_record")));
}

static void penetration_and_sets_follow_the_tip(void **state)
{
  (void)state;
  for (int tip = PW_TIP_FLAT; tip <= PW_TIP_CONICAL; tip++) {
    pw_scene scene;
    pile_and_soil(&scene, tip);
    pw_sim *sim = test_sim(&scene, 1);
    pw_record row;
    pw_sim_history(sim, &row);
    assert_near(item(&row, "penetration_m")->value, -0.1, 1e-14);
    lower_body(sim, 1, 0.3);
    end_step(sim, 1.9, 1);
    end_step(sim, 2.0, 2); /* the hammer starts: gravity is over */
    lower_body(sim, 1, 0.25);
    end_step(sim, 2.3, 20); /* watched */
    lower_body(sim, 1, -0.05);
    end_step(sim, 2.5, 21);
    lower_body(sim, 1, 0.07);
    end_step(sim, 3.0, 22);
    lower_body(sim, 1, 0.01);
    pw_sim_results(sim, &row);
    assert_near(item(&row, "penetration_after_gravity_m")->value, 0.2, 1e-14);
    assert_near(item(&row, "penetration_m")->value, 0.48, 1e-14);
    const pw_record_item *set = item(&row, "set_per_blow_m");
    assert_int_equal(set->count, 3);
    assert_near(set->array[0], 0.2, 1e-14);
    assert_near(set->array[1], 0.07, 1e-14);
    assert_near(set->array[2], 0.01, 1e-14);                 /* the last blow so far */
    assert_near(item(&row, "rebound_m")->value, 0.0, 1e-14); /* 0.45 then, 0.48 now */
    end_step(sim, 3.5, 40);                                  /* three periods are over */
    lower_body(sim, 1, -0.1);
    pw_sim_results(sim, &row);
    assert_near(item(&row, "set_per_blow_m")->array[2], 0.01, 1e-14);
    assert_near(item(&row, "rebound_m")->value, 0.1, 1e-14);
    pw_sim_destroy(&sim);
  }
}

static void settlement_and_base_stress_are_means_of_their_points(void **state)
{
  (void)state;
  pw_scene scene;
  pile_and_soil(&scene, PW_TIP_FLAT);
  pw_initial_stress_param *s = pw_scene_add_effect(&scene, "initial_stress");
  s->body = 0;
  s->k0 = 0.5;
  s->acceleration_m_s2 = 10.0;
  pw_sim *sim = test_sim(&scene, 1);
  pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n; i++) { /* the soil sinks by 10 mm per metre of radius */
    p->x[p->ld + i] -= p->body[i] == 0 ? 0.01 * p->x[i] : 0.0;
  }
  lower_body(sim, 1, 0.5);
  pw_record row;
  pw_sim_history(sim, &row);
  /* Domains of 0.0625 m from r = 1.625 m (the first centres beyond 0.8 x 2 m) to 2 m; the mean of
   * r weighted with the masses of the points, 2 int r^2 dr / int r^2 as midpoint sums. */
  pw_real sum = 0.0, mass = 0.0;
  for (pw_real r = 1.0 / 32.0; r < 2.0; r += 1.0 / 16.0) {
    sum += r > 1.6 ? r * 0.01 * r : 0.0;
    mass += r > 1.6 ? r : 0.0;
  }
  assert_relative(item(&row, "settlement_far_field_m")->value, sum / mass, 1e-12);
  assert_near(item(&row, "penetration_m")->value, 0.4, 1e-14);
  assert_near(item(&row, "penetration_below_settled_m")->value, 0.4 - sum / mass, 1e-12);
  /* Middle of the lowest row of cells: 2 - 0.0625 m deep. */
  assert_relative(item(&row, "base_vertical_stress_kpa")->value, -16.0 * 1.9375, 1e-12);
  assert_near(item(&row, "pile_velocity_m_s")->value, 0.0, 0.0);
  pw_sim_destroy(&sim);
}

static void overlap_is_that_of_the_deepest_soil_point(void **state)
{
  (void)state;
  pw_scene scene;
  pile_and_soil(&scene, PW_TIP_FLAT);
  pw_sim *sim = test_sim(&scene, 1);
  pw_record row;
  end_step(sim, 2.1, 20);
  lower_body(sim, 1, 0.2); /* 0.1 m deep: rows of points at 0.03125 and 0.09375 m */
  pw_sim_history(sim, &row);
  /* Innermost points, r = 0.03125: shaft 0.11875 m away; top row: 0.1 - 0.03125 above the tip. */
  assert_near(item(&row, "overlap_m")->value, 0.1 - 0.03125, 1e-13);
  end_step(sim, 2.2, 40);
  lower_body(sim, 1, 0.4);
  end_step(sim, 2.6, 41); /* second blow, not watched */
  lower_body(sim, 1, -0.5);
  end_step(sim, 2.7, 60);
  pw_sim_results(sim, &row);
  const pw_record_item *overlap = item(&row, "overlap_per_blow_m");
  assert_int_equal(overlap->count, 2);
  assert_near(overlap->array[0], 0.06875, 1e-13);
  assert_near(overlap->array[1], 0.0, 0.0);
  assert_near(item(&row, "largest_overlap_m")->value, 0.06875, 1e-13);
  pw_sim_destroy(&sim);
}

static void other_bodies_are_refused(void **state)
{
  (void)state;
  pw_scene scene;
  pile_and_soil(&scene, PW_TIP_FLAT);
  pw_pile_record_param *r = (void *)scene.effect[1].param;
  const pw_effect *type = pw_effect_find("pile_record");
  assert_int_equal(type->check(&scene, r), PW_OK);
  r->soil = 1;
  assert_int_equal(type->check(&scene, r), PW_ERR_SCENE);
  r->body = 0;
  assert_int_equal(type->check(&scene, r), PW_ERR_SCENE);
  r->body = 1;
  r->soil = 0;
  r->far_field_x_m = 3.0;
  pw_sim *sim = NULL;
  assert_int_equal(pw_sim_create(&scene, 1, &sim), PW_ERR_SCENE);
}

/** An archive in memory: bytes in the order of the calls. */
typedef struct memory {
  pw_archive ar;
  size_t at;
  unsigned char *bytes;
} memory;

static pw_status move(pw_archive *ar, void *value, size_t size)
{
  memory *m = (memory *)ar;
  assert_true(m->at + size <= MAX_ARCHIVE);
  if (ar->loading) {
    memcpy(value, m->bytes + m->at, size);
  } else {
    memcpy(m->bytes + m->at, value, size);
  }
  m->at += size;
  return PW_OK;
}

static pw_status move_real(pw_archive *ar, const char *name, pw_real *value, pw_off count)
{
  (void)name;
  return move(ar, value, (size_t)count * sizeof *value);
}

static pw_status move_index(pw_archive *ar, const char *name, pw_idx *value, pw_off count)
{
  (void)name;
  return move(ar, value, (size_t)count * sizeof *value);
}

static pw_status move_offset(pw_archive *ar, const char *name, pw_off *value, pw_off count)
{
  (void)name;
  return move(ar, value, (size_t)count * sizeof *value);
}

static void archive(pw_sim *sim, unsigned char *bytes, bool loading)
{
  memory m = {.ar = {loading, move_real, move_index, move_offset}, .bytes = bytes};
  assert_ok(pw_sim_archive(sim, &m.ar));
}

static void assert_same(const pw_record *a, const pw_record *b)
{
  assert_int_equal(a->n, b->n);
  for (int k = 0; k < a->n; k++) {
    assert_string_equal(a->item[k].name, b->item[k].name);
    assert_memory_equal(&a->item[k].value, &b->item[k].value, sizeof(pw_real));
    assert_int_equal(a->item[k].count, b->item[k].count);
    for (int j = 0; j < a->item[k].count; j++) {
      assert_memory_equal(&a->item[k].array[j], &b->item[k].array[j], sizeof(pw_real));
    }
  }
}

/* Pile and soil on one velocity field, struck and given a moving wall: all effects with state. */
static void state_survives_an_archive(void **state)
{
  (void)state;
  pw_scene scene;
  pile_and_soil(&scene, PW_TIP_ROUNDED);
  pw_hammer_param *h = (void *)scene.effect[0].param;
  h->start_s = 0.002;
  h->duration_s = 0.004;
  h->period_s = 0.01;
  pw_gravity_param *g = pw_scene_add_effect(&scene, "gravity");
  g->ramp_s = 0.01;
  pw_boundary_param *b = pw_scene_add_effect(&scene, "boundary");
  b->side = PW_SIDE_BOTTOM;
  b->fix_x = b->fix_y = true;
  pw_damping_local_param *d = pw_scene_add_effect(&scene, "damping_local");
  d->coefficient = 0.1;
  unsigned char *bytes = test_malloc(MAX_ARCHIVE);
  pw_sim *whole = test_sim(&scene, 2), *halted = test_sim(&scene, 1), *resumed = NULL;
  for (int k = 0; k < 60; k++) {
    assert_ok(pw_sim_step(whole, 0.0));
    assert_ok(k < 25 ? pw_sim_step(halted, 0.0) : PW_OK);
    if (k == 24) {
      archive(halted, bytes, false);
      resumed = test_sim(&scene, 1);
      archive(resumed, bytes, true);
    }
    assert_ok(k > 24 ? pw_sim_step(resumed, 0.0) : PW_OK);
  }
  pw_record a, c;
  pw_sim_history(whole, &a);
  pw_sim_history(resumed, &c);
  assert_same(&a, &c);
  pw_sim_results(whole, &a);
  pw_sim_results(resumed, &c);
  assert_same(&a, &c);
  assert_true(item(&a, "hammer_impulse_n_s")->value > 0.0);
  assert_true(item(&a, "set_per_blow_m")->count > 0);
  pw_sim_destroy(&whole);
  pw_sim_destroy(&halted);
  pw_sim_destroy(&resumed);
  test_free(bytes);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(penetration_and_sets_follow_the_tip),
      cmocka_unit_test(settlement_and_base_stress_are_means_of_their_points),
      cmocka_unit_test(overlap_is_that_of_the_deepest_soil_point),
      cmocka_unit_test(other_bodies_are_refused),
      cmocka_unit_test(state_survives_an_archive),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
