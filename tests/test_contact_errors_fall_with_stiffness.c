/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweep of the contact's stiffness over three decades (C9), for the penalty and the corner contact:
 * - a block at rest sinks in by pressure / stiffness: rate -1;
 * - a plate that starts to move under it stretches the tangential springs before it slips; what
 *   speed that costs the block falls as stiffness^-1/2.
 * Reference: a mass m per area on a spring k that slips at mu m g, plate's acceleration A = 2 mu g:
 * it slips after pi / 3 w, w^2 = k / m, and lacks mu g / w (sqrt 3 - pi / 3) for good. */
#include "tests/contact_helpers.h"

static const pw_real PI = 3.14159265358979323846, G = 10.0, MU = 0.3, HEIGHT = 0.5, DENSITY = 1e3;
static const pw_real SLIDE = 0.5;
enum { DECADES = 3 };

/* A whole number of periods of the block on its springs: weight that grows over them leaves it at
 * rest. Local damping would leave it off its place, for it acts as friction on slow motion. */
static pw_real settling_time(pw_real stiffness)
{
  const pw_real period = 2.0 * PI * sqrt(DENSITY * HEIGHT / stiffness);
  return pw_max(2.0, ceil(0.2 / period)) * period;
}

/* A stiff flat block on a plate, at rest under its weight at first; then the plate's velocity grows
 * with 2 mu g. */
static pw_sim *belt(test_contact kind, pw_real stiffness)
{
  const pw_real settled = settling_time(stiffness);
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  test_grid(&s, (pw_real[]){-3.0, 6.0, -1.0, 2.0}, 0.5);
  int material = test_elastic(&s, 2e9, 0.0, DENSITY);
  test_rectangle(&s, material, (pw_real[]){-2.0, 4.5, -0.5, 0.0}, 0.25);
  test_rectangle(&s, material, (pw_real[]){-1.0, 3.0, 0.0, HEIGHT}, 0.25);
  test_add_contact(&s, kind, 0, 1, MU, stiffness, 0.25);
  if (kind == TEST_CORNER) {
    pw_contact_corner_param *c = (void *)pw_scene_find_effect(&s, "contact_corner");
    c->normal_stiffness_pa_m = stiffness;
  }
  pw_gravity_param *gravity = pw_scene_add_effect(&s, "gravity");
  gravity->acceleration_m_s2 = G;
  gravity->ramp_s = settled;
  pw_prescribed_motion_param *p = pw_scene_add_effect(&s, "prescribed_motion");
  p->body = 0;
  p->start_s = settled;
  p->ramp_s = SLIDE;
  p->velocity_m_s[0] = 2.0 * MU * G * SLIDE;
  return test_sim(&s, 1);
}

typedef struct errors {
  pw_real overlap; /* m */
  pw_real lost;    /* speed; m/s */
} errors;

static errors measure(test_contact kind, pw_real stiffness)
{
  pw_sim *sim = belt(kind, stiffness);
  pw_real sum[5];
  errors e;
  const pw_real settled = settling_time(stiffness);
  test_run_to(sim, settled);
  e.overlap = pw_contact_tally_of(sim)->overlap;
  test_run_to(sim, settled + SLIDE);
  test_body_sums(sim, 1, sum);
  e.lost = MU * G * SLIDE - sum[1] / sum[0];
  pw_sim_destroy(&sim);
  return e;
}

static void sweep(test_contact kind)
{
  errors first = {0}, last = {0};
  for (int k = 0; k <= DECADES; k++) {
    pw_real stiffness = 1e5 * pow(10.0, k), w = sqrt(stiffness / (DENSITY * HEIGHT));
    pw_real overlap = DENSITY * HEIGHT * G / stiffness, lost = MU * G / w * (sqrt(3.0) - PI / 3.0);
    errors e = measure(kind, stiffness);
    print_message("%s, %.0e Pa/m: overlap %.4g m (%.4f of the exact one), speed lost %.4g m/s "
                  "(%.4f)\n",
                  test_contact_name[kind], stiffness, e.overlap, e.overlap / overlap, e.lost,
                  e.lost / lost);
    /* The end nodes of the penalty's line carry half of a segment of the block's sides as well. */
    assert_relative(e.overlap, overlap, kind == TEST_CORNER ? 0.01 : 0.1);
    assert_relative(e.lost, lost, 0.1);
    if (k > 0) {
      assert_near(log10(e.overlap / last.overlap), -1.0, 0.1);
      assert_near(log10(e.lost / last.lost), -0.5, 0.1);
    }
    first = k == 0 ? e : first;
    last = e;
  }
  print_message("%s: rates %.4f and %.4f over three decades\n", test_contact_name[kind],
                log10(last.overlap / first.overlap) / DECADES,
                log10(last.lost / first.lost) / DECADES);
}

static void corner(void **state)
{
  (void)state;
  sweep(TEST_CORNER);
}

static void penalty(void **state)
{
  (void)state;
  sweep(TEST_PENALTY);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(corner),
      cmocka_unit_test(penalty),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
