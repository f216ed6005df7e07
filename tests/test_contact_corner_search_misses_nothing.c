/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The search of the corner contact looks from the centres of domains first and leaves out what cannot
 * be inside. Against all sites of all domains, one by one: the same are found, with flat, round and
 * sharp tips, of piles of points and rigid ones, with and without adhesion over a gap, while the pile
 * goes in. */
#include "engine/effects/contact_corner.h"
#include "tests/engine_scenes.h"

enum { LOOKS = 12, STEPS = 25 };

typedef struct {
  int kind, tip;
  pw_real tip_length, adhesion_gap;
} setting;

static void pile(pw_scene *s, const setting *set)
{
  test_hammered_pile(s, TEST_CORNER, 0.1);
  pw_scene_body *body = &s->body[1];
  body->tip = set->tip;
  body->tip_length_m = set->tip_length;
  body->kind = set->kind;
  body->point_size_m = set->kind == PW_BODY_POINTS ? body->point_size_m : 0.0;
  body->velocity_m_s[1] = -4.0;
  pw_contact_corner_param *p = NULL;
  for (int e = 0; e < s->neffect; e++) {
    if (strcmp(s->effect[e].type->name, "contact_corner") == 0) {
      p = (void *)s->effect[e].param;
    }
  }
  assert_non_null(p);
  p->adhesion_gap_m = set->adhesion_gap;
  p->adhesion_pa = set->adhesion_gap > 0.0 ? 1e3 : 0.0;
}

/* Whether a site is in contact, looked at by itself. */
static bool touches(const pw_corner *c, pw_idx i, int site)
{
  const pw_points *p = &c->sim->points;
  const pw_domain_now d = pw_domain_of(p, i, c->surface.line->axi);
  pw_real x[2], weight[4];
  pw_idx node[4];
  pw_round_place place;
  pw_site_place(&d, site, x);
  const pw_real arc = p->contact_arc[(pw_off)site * p->ld + i];
  if (arc >= 0.0) {
    pw_round_line_follow(&c->surface, arc, x, &place);
    return place.gap < c->param->adhesion_gap_m;
  }
  pw_mesh_shape(&c->sim->mesh, x, node, weight);
  return pw_round_line_near(&c->surface, x, node[0], c->sim->mesh.cell, &place) &&
         place.gap < c->param->adhesion_gap_m;
}

static pw_idx compare(pw_sim *sim, pw_corner *c)
{
  static bool expected[PW_SITES * 4096];
  const pw_idx n = sim->points.n;
  pw_idx count = 0;
  assert_true(n <= 4096);
  pw_round_line_update(&c->surface, &sim->mesh);
  for (pw_idx i = 0; i < n; i++) {
    for (int site = 0; site < PW_SITES; site++) {
      const bool slave = sim->points.body[i] == c->param->slave;
      expected[PW_SITES * i + site] = slave && touches(c, i, site);
      count += expected[PW_SITES * i + site];
    }
  }
  assert_ok(pw_corner_search(c));
  assert_int_equal(c->npair, count);
  for (pw_idx k = 0; k < c->npair; k++) {
    assert_true(expected[PW_SITES * c->pair[k].point + c->pair[k].site]);
  }
  return count;
}

static void finds_the_same(const setting *set)
{
  static pw_scene s;
  pw_sim *sim = NULL;
  pw_idx found = 0;
  pile(&s, set);
  assert_ok(pw_sim_create(&s, 1, &sim));
  pw_corner *c = pw_sim_effect_ctx(sim, "contact_corner");
  for (int look = 0; look < LOOKS; look++) {
    for (int k = 0; k < STEPS; k++) {
      assert_ok(pw_sim_step(sim, 0.0));
    }
    found += compare(sim, c);
  }
  print_message("kind %d, tip %d of %g m, gap %g m: %d sites in %d looks\n", set->kind, set->tip,
                set->tip_length, set->adhesion_gap, found, LOOKS);
  assert_true(found > 3 * LOOKS);
  pw_sim_destroy(&sim);
}

static void same_as_one_by_one(void **state)
{
  (void)state;
  const setting all[] = {
      {PW_BODY_POINTS, PW_TIP_FLAT, 0.0, 0.0},     {PW_BODY_POINTS, PW_TIP_ROUNDED, 0.15, 0.0},
      {PW_BODY_POINTS, PW_TIP_CONICAL, 0.3, 0.02}, {PW_BODY_RIGID, PW_TIP_ROUNDED, 0.15, 0.03},
      {PW_BODY_RIGID, PW_TIP_CONICAL, 0.85, 0.0}, /* sharper than rounding can follow */
      {PW_BODY_RIGID, PW_TIP_FLAT, 0.0, 0.05},
  };
  for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
    finds_the_same(&all[k]);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(same_as_one_by_one)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
