/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Separation and return (E33), corner contact: a pile that stands on elastic soil is struck, and
 * rebounds. A site only ever pushes; once the gap is open there is no force at all, the pile falls
 * freely, and meets the soil again. */
#include "engine/effects/contact_corner.h"
#include "tests/contact_helpers.h"

static const pw_real G = 10.0, BLOW = 0.02;

static pw_sim *struck(int kind)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_AXI;
  test_grid(&s, (pw_real[]){0.0, 1.0, 0.0, 2.5}, 0.1);
  int soil = test_elastic(&s, 1e7, 0.3, 1500.0), steel = test_elastic(&s, 1e8, 0.3, 2500.0);
  test_rectangle(&s, soil, (pw_real[]){0.0, 1.0, 0.0, 1.0}, 0.05);
  s.body[s.nbody++] = (pw_scene_body){.name = "pile",
                                      .material = steel,
                                      .kind = kind,
                                      .shape = PW_SHAPE_PILE,
                                      .radius_m = 0.15,
                                      .tip_y_m = 1.0,
                                      .length_m = 1.0,
                                      .tip = PW_TIP_FLAT,
                                      .rod_elements = 20};
  test_add_contact(&s, TEST_CORNER, 1, 0, 0.3, 0.0, 0.0);
  pw_gravity_param *g = pw_scene_add_effect(&s, "gravity");
  g->acceleration_m_s2 = G;
  pw_hammer_param *h = pw_scene_add_effect(&s, "hammer");
  h->body = 1;
  h->pressure_pa = 2e5;
  h->duration_s = BLOW;
  for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_RIGHT; side += PW_SIDE_RIGHT) {
    pw_boundary_param *b = pw_scene_add_effect(&s, "boundary");
    b->side = side;
    b->fix_y = side == PW_SIDE_BOTTOM;
    b->fix_x = side == PW_SIDE_RIGHT;
    b->body = -1;
  }
  return test_sim(&s, 1);
}

/* Least force of a site on the soil along the normal out of the pile; negative: it pulls. */
static pw_real least_push(const pw_sim *sim)
{
  const pw_corner *c = pw_sim_effect_ctx(sim, "contact_corner");
  pw_real least = 0.0;
  for (pw_idx k = 0; k < c->npair; k++) {
    const pw_corner_pair *q = &c->pair[k];
    least = pw_min(least, q->force[0] * q->place.n[0] + q->force[1] * q->place.n[1]);
  }
  return least;
}

static void check(int kind)
{
  pw_sim *sim = struck(kind);
  const pw_contact_tally *t = pw_contact_tally_of(sim);
  const pw_structure *pile = sim->structure_of[1];
  pw_real least = 0.0, push = 0.0, height = 0.0, com[6], before = 0.0, fall = 0.0, flight = 0.0;
  int flights = 0, returns = 0;
  bool flying = false;
  while (sim->time < 1.0) {
    assert_ok(pw_sim_step(sim, 0.0));
    least = pw_min(least, least_push(sim));
    push = pw_max(push, t->force[PW_REACTION_Y]);
    const pw_corner *c = pw_sim_effect_ctx(sim, "contact_corner");
    pw_structure_centre(pile, com);
    if (c->npair == 0) {
      assert_near(hypot(t->force[PW_REACTION_X], t->force[PW_REACTION_Y]), 0.0, 0.0);
      if (sim->time > BLOW) {
        fall = pw_max(fall, fabs((com[3] - before) / sim->dt + G));
        flight += sim->dt;
        height = pw_max(height, pw_structure_tip(pile) - 1.0);
      }
      flights += flying ? 0 : 1;
    } else {
      returns += flying ? 1 : 0;
    }
    flying = c->npair == 0;
    before = com[3];
  }
  print_message(
      "%s: pushes %.0f N at most, pulls %.1e N; %.3f s in flight, up to %.4f m, %d flights "
      "%d returns; acceleration there off by %.1e m/s2\n",
      kind == PW_BODY_RIGID ? "rigid" : "rod", push, -least, flight, height, flights, returns,
      fall);
  assert_near(least, 0.0, 0.0);
  assert_true(push > 1000.0 && flight > 0.05 && height > 0.01);
  assert_true(flights >= 2 && returns >= 2);
  assert_near(fall, 0.0, 1e-9 * G / 1e-4);
  pw_sim_destroy(&sim);
}

static void pile_rebounds_freely(void **state)
{
  (void)state;
  check(PW_BODY_RIGID);
  check(PW_BODY_ROD);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pile_rebounds_freely),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
