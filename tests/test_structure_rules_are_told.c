/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a body without points cannot be or take part in is refused, with the key it concerns. */
#include "engine/effects/contact.h"
#include "tests/structure_helpers.h"

static pw_scene scene;

static void expect(const char *rule)
{
  assert_int_equal(pw_scene_check(&scene), PW_ERR_SCENE);
  if (!strstr(pw_error_text(), rule)) {
    fail_msg("'%s' does not say '%s'", pw_error_text(), rule);
  }
}

static pw_scene_body *with_soil(int kind)
{
  pw_scene_body *b = test_structure(&scene, PW_AXI, kind, PW_TIP_FLAT);
  test_rectangle(&scene, 0, (pw_real[]){0.0, 1.0, 0.0, 3.0}, 0.1);
  assert_ok(pw_scene_check(&scene));
  return b;
}

static void shapes_and_places(void **state)
{
  (void)state;
  pw_scene_body *b = with_soil(PW_BODY_ROD);
  b->tip_y_m = 6.0; /* the head 1 m above the grid */
  assert_ok(pw_scene_check(&scene));
  b->tip_y_m = 10.5;
  expect("body 'pile' is outside the grid: its bottom is at 10.5 m");
  b->tip_y_m = -6.0;
  expect("body 'pile' is outside the grid: its top is at -1 m");
  b = with_soil(PW_BODY_ROD);
  b->shape = PW_SHAPE_RECTANGLE;
  memcpy(b->x_m, (pw_real[]){0.0, 0.5}, sizeof b->x_m);
  memcpy(b->y_m, (pw_real[]){4.0, 5.0}, sizeof b->y_m);
  expect("shape: a body of kind rod is a pile");
  b->kind = PW_BODY_RIGID;
  assert_ok(pw_scene_check(&scene));
  b = with_soil(PW_BODY_ROD);
  b->rod_elements = 0;
  expect("rod_elements");
  b = with_soil(PW_BODY_RIGID);
  b->surface_segment_m = 0.1;
  assert_ok(pw_scene_check(&scene));
  b->surface_segment_m = 0.11; /* the search for contact looks one cell around */
  expect("surface_segment_m = 0.11 m must not be longer than a cell, 0.1 m");
  b = with_soil(PW_BODY_RIGID);
  b->velocity_m_s[0] = 1.0;
  expect("velocity_m_s: in axisymmetry a rigid body moves along y only");
  b = with_soil(PW_BODY_RIGID);
  b->nrefine = 1;
  expect("refine: a body of kind rigid has no points");
}

static void materials(void **state)
{
  (void)state;
  pw_scene_body *b = with_soil(PW_BODY_RIGID);
  b->material = test_neo_hookean(&scene, 1e6, 1e5, 1000.0);
  assert_ok(pw_scene_check(&scene));
  b->kind = PW_BODY_ROD;
  expect("material: a rod is linear_elastic, 'm1' is neo_hookean");
}

static void contacts_need_points(void **state)
{
  (void)state;
  for (int turn = 0; turn < 2; turn++) {
    with_soil(PW_BODY_RIGID);
    pw_contact_penalty_param *p = pw_scene_add_effect(&scene, "contact_penalty");
    p->master = turn;
    p->slave = 1 - turn;
    expect("'pile' has no points, which contact_penalty needs: contact_corner takes it");
    with_soil(PW_BODY_ROD);
    pw_contact_frictional_param *f = pw_scene_add_effect(&scene, "contact_frictional");
    f->master = turn;
    f->slave = 1 - turn;
    expect("'pile' has no points, which contact_frictional needs: contact_corner takes it");
  }
}

static void other_effects_need_points(void **state)
{
  (void)state;
  with_soil(PW_BODY_RIGID);
  pw_surcharge_param *q = pw_scene_add_effect(&scene, "surcharge");
  q->body = 0;
  q->side = PW_SIDE_TOP;
  expect("body: 'pile' has no points, which surcharge needs");
  with_soil(PW_BODY_RIGID);
  pw_damping_local_param *d = pw_scene_add_effect(&scene, "damping_local");
  d->body = 0;
  expect("body: 'pile' has no points, which damping_local needs");
  d->body = -1;
  assert_ok(pw_scene_check(&scene));
  with_soil(PW_BODY_RIGID);
  pw_boundary_param *b = pw_scene_add_effect(&scene, "boundary");
  b->fix_y = true;
  b->side = PW_SIDE_BOTTOM;
  b->body = 0;
  expect("body: 'pile' has no points, which boundary needs");
  with_soil(PW_BODY_RIGID);
  pw_pile_record_param *r = pw_scene_add_effect(&scene, "pile_record");
  r->body = 0;
  r->soil = 1;
  assert_ok(pw_scene_check(&scene));
  test_structure(&scene, PW_AXI, PW_BODY_RIGID, PW_TIP_FLAT);
  scene.body[scene.nbody] = scene.body[0];
  strcpy(scene.body[scene.nbody++].name, "other");
  r = pw_scene_add_effect(&scene, "pile_record");
  r->body = 0;
  r->soil = 1;
  expect("soil: 'other' has no points, which pile_record needs");
}

static void loads_that_do_not_fit(void **state)
{
  (void)state;
  pw_scene_body *b = test_structure(&scene, PW_PLANE, PW_BODY_RIGID, PW_TIP_FLAT);
  b->shape = PW_SHAPE_DISC;
  b->centre_m[1] = 5.0;
  pw_hammer_param *h = pw_scene_add_effect(&scene, "hammer");
  h->body = 0;
  h->duration_s = 0.1;
  expect("the disc 'pile' has no head");
  test_structure(&scene, PW_PLANE, PW_BODY_ROD, PW_TIP_FLAT);
  pw_prescribed_motion_param *p = pw_scene_add_effect(&scene, "prescribed_motion");
  p->body = 0;
  p->velocity_m_s[0] = 1.0;
  expect("velocity_m_s: the rod 'pile' moves along y only");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shapes_and_places),     cmocka_unit_test(materials),
      cmocka_unit_test(contacts_need_points),  cmocka_unit_test(other_effects_need_points),
      cmocka_unit_test(loads_that_do_not_fit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
