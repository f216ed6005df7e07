/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/contact_helpers.h
 * @brief Scenes with two bodies in contact, for tests of the contact effects.
 */
#ifndef PW_TESTS_CONTACT_HELPERS_H
#define PW_TESTS_CONTACT_HELPERS_H

#include "engine/effects/contact.h"
#include "tests/engine_helpers.h"

/** The contacts; TEST_GAP is the frictional one where the gap closes. */
typedef enum test_contact {
  TEST_PENALTY,
  TEST_FRICTIONAL,
  TEST_CORNER,
  TEST_GAP,
  TEST_CONTACTS
} test_contact;

static const char *const test_contact_name[TEST_CONTACTS] = {"penalty", "frictional", "corner",
                                                             "frictional with a gap"};

/** Add a contact between bodies @p master and @p slave. */
static inline void test_add_contact(pw_scene *scene, test_contact kind, int master, int slave,
                                    pw_real friction, pw_real stiffness, pw_real segment)
{
  if (kind == TEST_PENALTY) {
    pw_contact_penalty_param *p = pw_scene_add_effect(scene, "contact_penalty");
    assert_non_null(p);
    p->master = master;
    p->slave = slave;
    p->friction = friction;
    p->normal_stiffness_pa_m = stiffness;
    p->segment_m = segment;
  } else if (kind == TEST_CORNER) { /* stiffness by its own rule */
    pw_contact_corner_param *p = pw_scene_add_effect(scene, "contact_corner");
    assert_non_null(p);
    p->master = master;
    p->slave = slave;
    p->friction = friction;
    p->segment_m = segment;
  } else {
    pw_contact_frictional_param *p = pw_scene_add_effect(scene, "contact_frictional");
    assert_non_null(p);
    p->master = master;
    p->slave = slave;
    p->friction = friction;
    p->require_compression = true;
    p->normal = PW_NORMAL_MASTER;
    p->detection = kind == TEST_GAP ? PW_DETECT_CLOSED_GAP : PW_DETECT_SHARED_NODES;
  }
}

/** Acts on velocities at the nodes of the grid. */
static inline bool test_acts_on_nodes(test_contact kind)
{
  return kind == TEST_FRICTIONAL || kind == TEST_GAP;
}

static inline pw_scene_body *test_disc(pw_scene *scene, int material, pw_real x, pw_real y,
                                       pw_real radius, pw_real size)
{
  pw_scene_body *b = &scene->body[scene->nbody];
  *b = (pw_scene_body){.material = material,
                       .shape = PW_SHAPE_DISC,
                       .centre_m = {x, y},
                       .radius_m = radius,
                       .point_size_m = size};
  snprintf(b->name, sizeof b->name, "body%d", scene->nbody++);
  return b;
}

/** Hold a body at rest. */
static inline void test_hold(pw_scene *scene, int body)
{
  pw_prescribed_motion_param *p = pw_scene_add_effect(scene, "prescribed_motion");
  assert_non_null(p);
  p->body = body;
}

/** An elastic punch that falls on an elastic block from @p height; @p kind TEST_CONTACTS: without
 *  contact. Far apart the penalty's lines have no mass. */
static inline void test_drop(pw_scene *s, int kind, int geometry, pw_real height)
{
  pw_scene_default(s);
  s->geometry = geometry;
  s->method.block_elements = 12;
  test_grid(s, (pw_real[]){0.0, 2.0, 0.0, 2.5}, 0.25);
  int soft = test_neo_hookean(s, 1e5, 5e4, 1500.0), stiff = test_elastic(s, 1e7, 0.2, 2500.0);
  pw_real left = geometry == PW_AXI ? 0.0 : 0.5;
  test_rectangle(s, soft, (pw_real[]){0.0, 2.0, 0.0, 1.0}, 0.125);
  test_rectangle(s, stiff, (pw_real[]){left, left + 0.5, 1.0 + height, 1.75 + height}, 0.125);
  s->body[1].velocity_m_s[1] = -5.0;
  pw_gravity_param *gravity = pw_scene_add_effect(s, "gravity");
  gravity->acceleration_m_s2 = 10.0;
  if (kind < TEST_CONTACTS) {
    test_add_contact(s, kind, 1, 0, 0.4, 2e7, 0.125);
    if (kind == TEST_PENALTY) {
      pw_contact_penalty_param *p = (void *)pw_scene_find_effect(s, "contact_penalty");
      p->thickness_m = height > 0.1 ? 0.0 : 0.001;
    }
  }
  for (int side = PW_SIDE_BOTTOM; side <= PW_SIDE_RIGHT; side++) {
    pw_boundary_param *b = pw_scene_add_effect(s, "boundary");
    b->side = side;
    b->fix_x = true;
    b->fix_y = side == PW_SIDE_BOTTOM;
    b->body = -1;
  }
}

/** Mass, momentum along x and y, centre x and y of a body, plain sums over its points. */
static inline void test_body_sums(const pw_sim *sim, int body, pw_real *out)
{
  const pw_points *p = &sim->points;
  pw_real sum[5] = {0.0, 0.0, 0.0, 0.0, 0.0};
  for (pw_idx id = 0; id < p->n; id++) {
    pw_idx i = p->slot[id];
    if (p->body[i] != body && body >= 0) {
      continue;
    }
    sum[0] += p->mass[i];
    for (int a = 0; a < 2; a++) {
      sum[1 + a] += p->mass[i] * p->v[a * p->ld + i];
      sum[3 + a] += p->mass[i] * p->x[a * p->ld + i];
    }
  }
  sum[3] /= sum[0];
  sum[4] /= sum[0];
  for (int i = 0; i < 5; i++) {
    out[i] = sum[i];
  }
}

#endif /* PW_TESTS_CONTACT_HELPERS_H */
