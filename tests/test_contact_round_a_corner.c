/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small domain slides round corners of the master (E22), corner contact: its site is held by one
 * place of the surface, always, the force keeps its size within 10 % from one step to the next (as a
 * spring over the overlap does), round a convex corner it turns with the normal of the vertex, and
 * in a re-entrant corner it changes from one side to the other where both are equally deep. */
#include "engine/effects/contact_corner_surface.h"
#include "tests/harness.h"

static const pw_real PI = 3.14159265358979323846, ROUNDING = 0.02, STEP = 2e-4;

typedef struct setting {
  pw_mesh mesh;
  pw_interface line;
  pw_round_line round;
} setting;

/* An L of two arms of width 0.5 m: convex corners, and a re-entrant one at (0.5, 0.5). */
static void l_shape(setting *s)
{
  const pw_real at[6][2] = {{0, 0}, {1, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 1}};
  pw_real xy[2 * 80];
  pw_idx n = 0;
  for (int k = 0; k < 6; k++) {
    const pw_real *a = at[k], *b = at[(k + 1) % 6];
    const int pieces = (int)(hypot(b[0] - a[0], b[1] - a[1]) / 0.05 + 0.5);
    for (int i = 0; i < pieces; i++, n++) {
      for (int c = 0; c < 2; c++) {
        xy[2 * n + c] = a[c] + (b[c] - a[c]) * i / pieces;
      }
    }
  }
  assert_ok(pw_mesh_create((pw_real[]){-1, -1}, (pw_real[]){3, 3}, 0.25, &s->mesh));
  assert_ok(pw_interface_create(xy, NULL, n, true, false, n, &s->line));
  assert_ok(pw_round_line_create(&s->line, ROUNDING, &s->mesh, &s->round));
  pw_round_line_update(&s->round, &s->mesh);
}

static void destroy(setting *s)
{
  pw_round_line_destroy(&s->round);
  pw_interface_destroy(&s->line);
}

/* Along a straight path; what is found anew and what is followed from the step before must agree. */
typedef struct ride {
  pw_real jump; /* of the depth between steps, over it */
  pw_real turn; /* of the normal between steps; rad */
} ride;

static ride follow(const setting *s, const pw_real *from, const pw_real *to, int steps)
{
  ride r = {0};
  pw_round_place last = {0};
  for (int i = 0; i <= steps; i++) {
    pw_real x[2], weight[4];
    pw_idx node[4];
    pw_round_place place, again;
    for (int c = 0; c < 2; c++) {
      x[c] = from[c] + (to[c] - from[c]) * i / steps;
    }
    pw_mesh_shape(&s->mesh, x, node, weight);
    assert_true(pw_round_line_find(&s->round, x, node[0], 0.25, &place));
    if (i > 0) {
      pw_round_line_follow(&s->round, last.arc, x, &again);
      assert_near(again.gap, place.gap, 1e-12);
      pw_real cosine = place.n[0] * last.n[0] + place.n[1] * last.n[1];
      r.jump = pw_max(r.jump, fabs(place.gap - last.gap) / pw_max(-place.gap, -last.gap));
      r.turn = pw_max(r.turn, acos(pw_min(cosine, 1.0)));
    }
    last = place;
  }
  return r;
}

/* Round the corner (1, 0.5), and straight on below the upper side of its arm towards it. */
static void convex(void **state)
{
  (void)state;
  setting s = {0};
  l_shape(&s);
  const pw_real depth = 0.004, radius = ROUNDING - depth, c[2] = {1.0 - ROUNDING, 0.5 - ROUNDING};
  pw_real jump = 0.0, turn = 0.0;
  for (int i = 0; i < 100; i++) {
    pw_real a = 0.5 * PI * i / 100.0, b = 0.5 * PI * (i + 1) / 100.0;
    const pw_real from[2] = {c[0] + radius * cos(a), c[1] + radius * sin(a)};
    const pw_real to[2] = {c[0] + radius * cos(b), c[1] + radius * sin(b)};
    ride r = follow(&s, from, to, 1);
    jump = pw_max(jump, r.jump);
    turn = pw_max(turn, r.turn);
  }
  print_message("convex: force changes by %.1e of itself a step, turns by %.4f rad\n", jump, turn);
  assert_true(jump < 1e-10);
  assert_near(turn, 0.5 * PI / 100.0, 1e-6);
  ride r =
      follow(&s, (pw_real[]){0.9, 0.5 - depth}, (pw_real[]){0.99, 0.5 - depth}, (int)(0.09 / STEP));
  print_message("straight on to the corner: by %.3f a step, turns by %.4f rad\n", r.jump, r.turn);
  assert_true(r.jump < 0.1 && r.turn < 0.1);
  destroy(&s);
}

/* In the corner (0.5, 0.5) the depth is that below the nearer of the two sides: it stays as it is all
 * the way, the normal changes once, where both are equally near. */
static void re_entrant(void **state)
{
  (void)state;
  setting s = {0};
  l_shape(&s);
  const pw_real at = 0.5 - 0.004, corner[2] = {at, at};
  ride in = follow(&s, (pw_real[]){0.6, at}, corner, 520);
  ride out = follow(&s, corner, (pw_real[]){at, 0.6}, 520);
  print_message(
      "re-entrant: force changes by %.1e, %.1e of itself a step, turns by %.3f, %.3f rad\n",
      in.jump, out.jump, in.turn, out.turn);
  assert_true(in.jump < 1e-10 && out.jump < 1e-10);
  assert_near(in.turn + out.turn, 0.5 * PI, 1e-6);
  destroy(&s);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(convex),
      cmocka_unit_test(re_entrant),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
