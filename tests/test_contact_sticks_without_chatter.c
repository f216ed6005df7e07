/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A block on an incline at the friction angle itself, mu = tan(alpha) (1 +- 1e-6) (E34), corner
 * contact: no site changes between stick and slip more than once in 100 steps, and energy never
 * grows: neither that of block, springs and weight together, nor is anything given back of what the
 * contact took up. A site sticks again when its force has fallen a thousandth below the cap: all of
 * them are at the cap to a millionth here, and the last of the block's vibration moves them by
 * more. */
#include "engine/effects/contact_corner.h"
#include "tests/contact_helpers.h"

static const pw_real G = 10.0, PI = 3.14159265358979323846, HELD = 1e-3;

static pw_sim *incline(pw_real offset)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  test_grid(&s, (pw_real[]){-1.0, 3.0, -0.5, 1.0}, 0.25);
  int material = test_elastic(&s, 2e6, 0.0, 1000.0);
  test_rectangle(&s, material, (pw_real[]){-1.0, 3.0, -0.5, 0.0}, 0.125);
  s.body[0].kind = PW_BODY_RIGID;
  test_rectangle(&s, material, (pw_real[]){-0.5, 1.5, 0.0, 0.5}, 0.125);
  pw_gravity_param *gravity = pw_scene_add_effect(&s, "gravity");
  gravity->acceleration_m_s2 = G;
  gravity->ramp_s = 0.5;
  gravity->tilt_deg = 30.0;
  test_add_contact(&s, TEST_CORNER, 0, 1, tan(PI / 6.0) * (1.0 + offset), 0.0, 0.0);
  pw_damping_local_param *d = pw_scene_add_effect(&s, "damping_local");
  d->body = 1;
  d->coefficient = 0.3;
  test_hold(&s, 0);
  return test_sim(&s, 1);
}

typedef struct watch {
  int most;      /* switches of a site in a window of 100 steps */
  int all;       /* of all sites in all windows */
  pw_real gave;  /* largest fall of what the contact has taken up; J */
  pw_real grew;  /* largest growth of energy over its least value; J */
  pw_real whole; /* work of the weight so far; J */
  pw_real speed; /* at the end; m/s */
} watch;

enum { SITES = 8 * 1024, WINDOW = 100, WINDOWS = 30 };

/* Count the sites that have changed their state since the last step. */
static void count_switches(const pw_sim *sim, bool first, watch *w)
{
  static bool slips[SITES];
  static int count[SITES];
  static int step;
  const pw_corner *c = pw_sim_effect_ctx(sim, "contact_corner");
  const pw_points *p = &sim->points;
  step = first ? 0 : step + 1;
  if (step % WINDOW == 0) {
    memset(count, 0, sizeof count);
  }
  for (pw_idx k = 0; k < c->npair; k++) {
    const pw_corner_pair *q = &c->pair[k];
    const pw_idx at = PW_SITES * p->id[q->point] + q->site;
    pw_real slip = fabs(p->contact_slip[(pw_off)q->site * p->ld + q->point]);
    pw_real cap = c->param->friction * q->overlap;
    bool now = slip >= cap * (1.0 - (!first && slips[at] ? HELD : 1e-12));
    if (!first && now != slips[at]) {
      count[at]++;
      w->all++;
      w->most = count[at] > w->most ? count[at] : w->most;
    }
    slips[at] = now;
  }
}

static watch look(pw_real offset)
{
  pw_sim *sim = incline(offset);
  const pw_energy *e = &sim->energy;
  watch w = {.most = 0};
  assert_true(PW_SITES * sim->points.n <= SITES);
  test_run_to(sim, 2.0);
  pw_real taken = e->contact, least = e->kinetic + e->strain_work + e->spring - e->external;
  for (int step = 0; step < WINDOW * WINDOWS; step++) {
    assert_ok(pw_sim_step(sim, 0.0));
    count_switches(sim, step == 0, &w);
    w.gave = pw_max(w.gave, taken - e->contact);
    taken = pw_max(taken, e->contact);
    pw_real now = e->kinetic + e->strain_work + e->spring - e->external;
    w.grew = pw_max(w.grew, now - least);
    least = pw_min(least, now);
  }
  pw_real sum[5];
  test_body_sums(sim, 1, sum);
  w.speed = sum[1] / sum[0];
  w.whole = e->external;
  pw_sim_destroy(&sim);
  return w;
}

static void no_chatter_at_the_friction_angle(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    watch w = look(k == 0 ? 1e-6 : -1e-6);
    print_message(
        "mu = tan(alpha) (1 %s 1e-6): at most %d switches of a site in 100 steps, %d in all; "
        "energy grew by %.1e J at most, the contact gave back %.1e J, of %.1e J; speed "
        "%.1e m/s\n",
        k == 0 ? "+" : "-", w.most, w.all, w.grew, w.gave, w.whole, w.speed);
    assert_true(w.most <= 1);
    assert_true(w.gave <= 0.0 && w.grew <= 1e-5 * w.whole);
    assert_true(fabs(w.speed) < 1e-4);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_chatter_at_the_friction_angle),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
