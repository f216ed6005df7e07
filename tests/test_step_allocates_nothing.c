/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All memory is taken at set-up: no step allocates, with every effect on and while points move
 * from block to block and are sorted. */
#include "tests/engine_scenes.h"

#include "engine/core/mem.h"

static void run(const pw_scene *s, int steps, pw_off least_sorts)
{
  pw_report r;
  pw_sim *sim = test_sim(s, 1);
  pw_off count = pw_mem_count(), bytes = pw_mem_bytes();
  for (int k = 0; k < steps; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
  assert_int_equal(pw_mem_count(), count);
  assert_int_equal(pw_mem_bytes(), bytes);
  pw_sim_report(sim, &r);
  assert_true(r.sorts >= least_sorts);
  pw_sim_destroy(&sim);
}

/* A block thrown along the floor, loaded, damped, braked by a prescribed end of the grid. */
static void loads_and_boundaries(void **state)
{
  (void)state;
  for (int basis = PW_UGIMP; basis <= PW_CPDI; basis++) {
    static pw_scene s;
    pw_scene_default(&s);
    s.method.basis = basis;
    s.method.update = PW_USL;
    s.method.block_elements = 16;
    test_grid(&s, (pw_real[]){0.0, 4.0, 0.0, 2.0}, 0.1);
    int m = test_elastic(&s, 1e5, 0.3, 1e3);
    pw_scene_body *b = test_rectangle(&s, m, (pw_real[]){0.2, 1.0, 0.2, 1.0}, 0.05);
    b->velocity_m_s[0] = 4.0;
    test_gravity(&s, 0.1);
    pw_surcharge_param *p = pw_scene_add_effect(&s, "surcharge");
    p->body = 0;
    p->side = PW_SIDE_TOP;
    p->pressure_pa = 10.0;
    pw_hammer_param *h = pw_scene_add_effect(&s, "hammer");
    h->body = 0;
    h->pressure_pa = 10.0;
    h->duration_s = 0.01;
    h->period_s = 0.02;
    h->count = 5;
    pw_damping_local_param *d = pw_scene_add_effect(&s, "damping_local");
    d->coefficient = 0.01;
    test_roller(&s, PW_SIDE_BOTTOM);
    run(&s, 200, 3);
  }
}

static void manufactured_motion(void **state)
{
  (void)state;
  static pw_scene s;
  pw_scene_default(&s);
  test_grid(&s, (pw_real[]){0.0, 1.0, 0.0, 1.0}, 0.1);
  int m = test_neo_hookean(&s, 8e6, 4e6, 1e3);
  test_rectangle(&s, m, (pw_real[]){0.0, 1.0, 0.0, 1.0}, 0.05);
  pw_body_force_param *f = pw_scene_add_effect(&s, "body_force");
  f->body = 0;
  f->amplitude_m = 0.01;
  for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_RIGHT; side++) {
    test_roller(&s, side);
  }
  run(&s, 200, 1);
}

static void contacts_and_records(void **state)
{
  (void)state;
  for (int contact = TEST_PENALTY; contact < TEST_CONTACTS; contact++) {
    static pw_scene s;
    test_hammered_pile(&s, contact, 0.125);
    run(&s, 200, 1);
    if (!test_acts_on_nodes(contact)) {
      s.method.mass_terms = 2;
      run(&s, 200, 1);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(loads_and_boundaries),
      cmocka_unit_test(manufactured_motion),
      cmocka_unit_test(contacts_and_records),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
