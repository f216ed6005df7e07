/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rounded surface of a master (E21, E22): normal and gap without jumps around a convex edge,
 * outside and inside, one way along it all around, exact on straight parts; a deep place keeps its
 * side; nothing beyond a free end. */
#include "engine/effects/contact_corner_surface.h"
#include "tests/harness.h"

static const pw_real PI = 3.14159265358979323846, ROUNDING = 0.05, SEGMENT = 0.1;

typedef struct setting {
  pw_mesh mesh;
  pw_interface line;
  pw_round_line round;
} setting;

/* A unit square with its lower left corner at (0, 0), ten segments to a side. */
static void square(setting *s)
{
  pw_real xy[80];
  const pw_real at[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int k = 0; k < 40; k++) {
    const pw_real *a = at[k / 10], *b = at[(k / 10 + 1) % 4], part = (k % 10) / 10.0;
    for (int c = 0; c < 2; c++) {
      xy[2 * k + c] = (1.0 - part) * a[c] + part * b[c];
    }
  }
  assert_ok(pw_mesh_create((pw_real[]){-1, -1}, (pw_real[]){3, 3}, 0.25, &s->mesh));
  assert_ok(pw_interface_create(xy, NULL, 40, true, false, 40, &s->line));
  assert_ok(pw_round_line_create(&s->line, ROUNDING, &s->mesh, &s->round));
  pw_round_line_update(&s->round, &s->mesh);
}

static void destroy(setting *s)
{
  pw_round_line_destroy(&s->round);
  pw_interface_destroy(&s->line);
}

/* All around the square at the overlap `depth`: along sides and around the centres of its rounded
 * edges. @return the place number i of n. */
static void walk(pw_real depth, pw_real u, pw_real *x, pw_real *n)
{
  const pw_real straight = 1.0 - 2.0 * ROUNDING, bend = 0.5 * PI * ROUNDING;
  pw_real way = 4.0 * u, along = (way - floor(way)) * (straight + bend);
  int side = (int)way % 4;
  pw_real angle = -0.5 * PI + 0.5 * PI * side, tx, ty;
  pw_real turn = along > straight ? (along - straight) / ROUNDING : 0.0;
  along = along > straight ? straight : along;
  n[0] = cos(angle + turn);
  n[1] = sin(angle + turn);
  tx = -sin(angle);
  ty = cos(angle);
  const pw_real start[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  pw_real in[2] = {-cos(angle), -sin(angle)}, r = ROUNDING - depth;
  x[0] = start[side][0] + tx * (ROUNDING + along) + in[0] * ROUNDING + n[0] * r;
  x[1] = start[side][1] + ty * (ROUNDING + along) + in[1] * ROUNDING + n[1] * r;
}

static void exact_all_around(void **state)
{
  (void)state;
  setting s = {0};
  square(&s);
  assert_near(s.round.total, 4.0 * (1.0 - 2.0 * ROUNDING) + 2.0 * PI * ROUNDING, 1e-12);
  for (int inside = -1; inside <= 1; inside += 2) {
    pw_real before = -1.0, n[2], x[2], first = 0.0;
    for (int i = 0; i < 4000; i++) {
      pw_round_place place, again;
      walk(inside * 0.02, i / 4000.0, x, n);
      pw_idx node[4];
      pw_real weight[4];
      pw_mesh_shape(&s.mesh, x, node, weight);
      assert_int_equal(pw_round_line_find(&s.round, x, node[0], 0.25, &place), inside > 0);
      if (inside < 0) {
        continue;
      }
      assert_near(place.gap, -0.02, 1e-12);
      assert_near(place.n[0] * n[0] + place.n[1] * n[1], 1.0, 1e-12);
      first = i == 0 ? place.arc : first;
      pw_real step = i == 0 ? 0.0 : pw_round_line_way(&s.round, before, place.arc);
      assert_true(i == 0 || (step > 0.0 && step < 2e-3)); /* always onwards, never a jump */
      if (i > 0) {
        pw_round_line_follow(&s.round, before, x, &again);
        assert_near(pw_round_line_way(&s.round, place.arc, again.arc), 0.0, 1e-12);
      }
      before = place.arc;
    }
    assert_true(inside < 0 || pw_round_line_way(&s.round, before, first) > 0.0);
  }
  destroy(&s);
}

/* Round an edge in steps of 2 % of the rounding, the force turns by 2 % a step: no jump (E22). */
static void force_turns_without_a_jump(void **state)
{
  (void)state;
  setting s = {0};
  square(&s);
  pw_real worst = 0.0, last[2] = {0.0, -1.0};
  for (int i = 0; i <= 400; i++) {
    pw_real x[2], n[2];
    pw_round_place place;
    pw_idx node[4];
    pw_real weight[4];
    walk(0.01, 0.18 + 0.1 * i / 400.0, x, n);
    pw_mesh_shape(&s.mesh, x, node, weight);
    assert_true(pw_round_line_find(&s.round, x, node[0], 0.25, &place));
    worst = i > 0 ? pw_max(worst, hypot(place.n[0] - last[0], place.n[1] - last[1])) : 0.0;
    last[0] = place.n[0];
    last[1] = place.n[1];
  }
  print_message("largest change of the normal in a step: %.4f\n", worst);
  assert_true(worst < 0.03);
  destroy(&s);
}

/* Three segments deep near a side, followed from there, it keeps the side it came in by. */
static void deep_keeps_its_side(void **state)
{
  (void)state;
  setting s = {0};
  square(&s);
  pw_round_place place;
  pw_idx node[4];
  pw_real weight[4], x[2] = {0.35, 0.01};
  pw_mesh_shape(&s.mesh, x, node, weight);
  assert_true(pw_round_line_find(&s.round, x, node[0], 0.25, &place));
  x[1] = 3.0 * SEGMENT;
  pw_round_line_follow(&s.round, place.arc, x, &place);
  assert_near(place.gap, -3.0 * SEGMENT, 1e-12);
  assert_near(place.n[1], -1.0, 1e-12);
  destroy(&s);
}

static void nothing_beyond_a_free_end(void **state)
{
  (void)state;
  setting s = {0};
  const pw_real xy[6] = {1.0, 0.0, 0.5, 0.0, 0.0, 0.0}; /* the body below, normal upwards */
  assert_ok(pw_mesh_create((pw_real[]){-1, -1}, (pw_real[]){3, 3}, 0.5, &s.mesh));
  assert_ok(pw_interface_create(xy, NULL, 3, false, false, 3, &s.line));
  assert_ok(pw_round_line_create(&s.line, ROUNDING, &s.mesh, &s.round));
  pw_round_line_update(&s.round, &s.mesh);
  pw_round_place place;
  const pw_real in[2] = {1.0, -0.01}, out[2] = {1.01, -0.01};
  pw_round_line_place(&s.round, 0, in, &place);
  assert_near(place.gap, -0.01, 1e-14);
  pw_round_line_place(&s.round, 0, out, &place);
  assert_true(place.gap > 0.0);
  destroy(&s);
}

/* A disc of many segments: gap within a sagitta, normal within half a turn of the exact one; far
 * better than the polygon's own normals. */
static void disc_is_round(void **state)
{
  (void)state;
  enum { N = 64 };
  setting s = {0};
  pw_real xy[2 * N], worst = 0.0, sagitta = 0.5 * (1.0 - cos(PI / N));
  for (int k = 0; k < N; k++) {
    xy[2 * k] = 0.5 * sin(2.0 * PI * k / N);
    xy[2 * k + 1] = -0.5 * cos(2.0 * PI * k / N);
  }
  assert_ok(pw_mesh_create((pw_real[]){-1, -1}, (pw_real[]){2, 2}, 0.25, &s.mesh));
  assert_ok(pw_interface_create(xy, NULL, N, true, false, N, &s.line));
  assert_ok(pw_round_line_create(&s.line, 0.025, &s.mesh, &s.round));
  pw_round_line_update(&s.round, &s.mesh);
  for (int i = 0; i < 1000; i++) {
    pw_real angle = 2.0 * PI * i / 1000.0, n[2] = {sin(angle), -cos(angle)};
    pw_real x[2] = {0.49 * n[0], 0.49 * n[1]}, weight[4];
    pw_round_place place;
    pw_idx node[4];
    pw_mesh_shape(&s.mesh, x, node, weight);
    assert_true(pw_round_line_find(&s.round, x, node[0], 0.25, &place));
    assert_near(place.gap, -0.01, sagitta);
    worst = pw_max(worst, fabs(place.n[0] * n[1] - place.n[1] * n[0]));
  }
  assert_true(worst < 1.01 * PI / N);
  destroy(&s);
}

/* Place of x on the surface, when it is near. */
static bool place_of(const setting *s, const pw_real *x, pw_round_place *place)
{
  pw_real weight[4];
  pw_idx node[4];
  pw_mesh_shape(&s->mesh, x, node, weight);
  return pw_round_line_near(&s->round, x, node[0], 0.25, place);
}

/* The gap over a convex body is a convex function: beyond its tangent, and no steeper than one. What
 * the search leaves out rests on both. */
static void gap_is_supported_by_its_tangent(void **state)
{
  (void)state;
  setting s = {0};
  uint64_t seed = 5;
  int pairs = 0, outside = 0;
  square(&s);
  assert_true(s.round.convex);
  for (int i = 0; i < 20000; i++) {
    pw_real x[2], y[2], d[2];
    pw_round_place from, to;
    for (int c = 0; c < 2; c++) {
      x[c] = -0.25 + 1.5 * test_random(&seed);
      d[c] = 0.4 * (test_random(&seed) - 0.5);
      y[c] = x[c] + d[c];
    }
    if (!place_of(&s, x, &from) || !place_of(&s, y, &to)) {
      continue;
    }
    pairs++;
    pw_round_place sought;
    if (pw_round_line_seek(&s.round, (pw_idx)(40.0 * test_random(&seed)), x, &sought)) {
      outside++;
      assert_near(sought.gap, from.gap, 1e-14);
      assert_true(sought.n[0] * from.n[0] + sought.n[1] * from.n[1] > 1.0 - 1e-8);
    }
    assert_true(fabs(to.gap - from.gap) <= hypot(d[0], d[1]) + 1e-12);
    assert_true(to.gap >= from.gap + from.n[0] * d[0] + from.n[1] * d[1] - 1e-12);
  }
  assert_true(pairs > 5000 && outside > 2000);
  destroy(&s);
}

static void a_hollow_line_supports_nothing(void **state)
{
  (void)state;
  setting s = {0};
  const pw_real xy[12] = {0, 0, 1, 0, 1, 1, 0.5, 1, 0.5, 0.5, 0, 0.5};
  pw_round_place place;
  assert_ok(pw_mesh_create((pw_real[]){-1, -1}, (pw_real[]){3, 3}, 0.25, &s.mesh));
  assert_ok(pw_interface_create(xy, NULL, 6, true, false, 6, &s.line));
  assert_ok(pw_round_line_create(&s.line, ROUNDING, &s.mesh, &s.round));
  pw_round_line_update(&s.round, &s.mesh);
  assert_true(place_of(&s, (pw_real[]){0.25, -0.1}, &place));
  assert_near(place.gap, 0.1, 1e-12);
  assert_false(s.round.convex);
  destroy(&s);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exact_all_around),
      cmocka_unit_test(force_turns_without_a_jump),
      cmocka_unit_test(deep_keeps_its_side),
      cmocka_unit_test(nothing_beyond_a_free_end),
      cmocka_unit_test(disc_is_round),
      cmocka_unit_test(gap_is_supported_by_its_tangent),
      cmocka_unit_test(a_hollow_line_supports_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
