/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Search of contact: bins against brute force, vertices (E22), deep slaves (E21). */
#include "engine/core/mem.h"
#include "engine/interface_search.h"
#include "tests/harness.h"

static const pw_real PI = 3.14159265358979323846;

typedef struct fixture {
  pw_mesh mesh;
  pw_interface line;
  pw_segment_bins bins;
} fixture;

static void set_up(fixture *f, const pw_real *xy, pw_idx n, bool closed)
{
  const pw_real origin[2] = {-2.0, -2.0}, size[2] = {4.0, 4.0};
  assert_ok(pw_mesh_create(origin, size, 0.125, &f->mesh));
  assert_ok(pw_interface_create(xy, NULL, n, closed, false, n, &f->line));
  assert_ok(pw_bins_create(&f->line, &f->mesh, &f->bins));
  pw_interface_locate(&f->line, &f->mesh);
  pw_bins_fill(&f->bins, &f->line);
}

static void tear_down(fixture *f)
{
  pw_bins_destroy(&f->bins);
  pw_interface_destroy(&f->line);
}

/* Side of an axis-aligned box, counter-clockwise, in segments of `step`. */
static pw_idx box(pw_real half, pw_idx per_side, pw_real *xy)
{
  const pw_real corner[5][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
  pw_idx n = 0;
  for (int s = 0; s < 4; s++) {
    for (pw_idx k = 0; k < per_side; k++, n++) {
      pw_real a = (pw_real)k / (pw_real)per_side;
      for (int i = 0; i < 2; i++) {
        xy[2 * n + i] = half * ((1.0 - a) * corner[s][i] + a * corner[s + 1][i]);
      }
    }
  }
  return n;
}

static pw_idx detect(const fixture *f, pw_real x, pw_real y, pw_pair *p)
{
  pw_interface slave;
  const pw_real xy[4] = {x, y, x + 0.01, y};
  assert_ok(pw_interface_create(xy, NULL, 2, false, false, 2, &slave));
  pw_interface_locate(&slave, &f->mesh);
  pw_idx owner = pw_bins_detect(&f->bins, &f->line, f->mesh.cell, &slave.node[0], p);
  pw_interface_destroy(&slave);
  return owner;
}

/* Radius and inside of a five-pointed star with convex and re-entrant vertices. */
static void bins_find_what_brute_force_finds(void **state)
{
  (void)state;
  pw_real xy[2 * 200];
  for (int k = 0; k < 200; k++) {
    pw_real a = 2.0 * PI * k / 200.0, r = 1.0 + 0.3 * cos(5.0 * a);
    xy[2 * k] = r * cos(a);
    xy[2 * k + 1] = r * sin(a);
  }
  fixture f;
  set_up(&f, xy, 200, true);
  uint64_t seed = 7;
  int inside = 0;
  for (int trial = 0; trial < 20000; trial++) {
    pw_real a = 2.0 * PI * test_random(&seed);
    pw_real r = 1.0 + 0.3 * cos(5.0 * a) + 0.2 * (test_random(&seed) - 0.5);
    const pw_real x[2] = {r * cos(a), r * sin(a)};
    pw_pair found = {0}, p, best = {.gap = 1e9};
    for (pw_idx s = 0; s < 200; s++) {
      pw_interface_closest(&f.line, s, x, &p);
      best = fabs(p.gap) < fabs(best.gap) ? p : best;
    }
    pw_idx owner = detect(&f, x[0], x[1], &found);
    assert_int_equal(owner >= 0, best.gap < 0.0);
    if (owner >= 0) {
      assert_near(found.gap, best.gap, 1e-14);
      inside++;
    }
  }
  assert_true(inside > 5000);
  tear_down(&f);
}

/* Round a convex corner of 90 degrees at constant depth below both sides, and round a re-entrant
 * one: one owner everywhere inside, a gap (so a force) without jumps, to the size of the walk. */
static void force_is_continuous_round_corners(void **state)
{
  (void)state;
  pw_real xy[2 * 80];
  pw_idx n = box(0.5, 20, xy);
  fixture f;
  set_up(&f, xy, n, true);
  pw_real before = 0.0;
  const pw_real depth = 0.01, step = 1e-4;
  for (int i = 0; i < 2000; i++) { /* below the right side, up to and through the upper side */
    pw_pair p = {0};
    pw_real y = 0.4 + step * i;
    pw_idx owner = detect(&f, 0.5 - depth, y, &p);
    assert_int_equal(owner >= 0, y < 0.5);
    if (owner >= 0) {
      assert_near(p.gap, -pw_min(depth, 0.5 - y), 1e-14);
      assert_true(i == 0 || fabs(p.gap - before) < 0.1 * depth);
      before = p.gap;
    }
  }
  tear_down(&f);
  const pw_real notch[8] = {-0.1, -0.1, 0.0, 0.0, 0.1, -0.1, 0.0, 0.1}; /* arrow head */
  set_up(&f, notch, 4, true);
  for (int i = -20; i <= 20; i++) {
    pw_pair p = {0};
    pw_real a = 0.5 * PI + i * 0.01; /* seen from the notch all these are nearest to its vertex */
    assert_true(detect(&f, 0.02 * cos(a), 0.02 * sin(a), &p) >= 0);
    assert_near(p.gap, -0.02, 1e-14);
    assert_near(p.n[0], -cos(a), 1e-12);
    assert_near(p.n[1], -sin(a), 1e-12);
  }
  tear_down(&f);
}

/* The couple of a re-entrant vertex balances the moment of the tangential force. */
static void vertex_vectors_balance(void **state)
{
  (void)state;
  const pw_real notch[8] = {-0.1, -0.1, 0.0, 0.0, 0.1, -0.1, 0.0, 0.1};
  fixture f;
  set_up(&f, notch, 4, true);
  pw_pair p = {0};
  const pw_real x[2] = {0.004, 0.02};
  pw_idx s = detect(&f, x[0], x[1], &p);
  pw_real cn[6], ct[6], sum[2] = {0.0, 0.0}, moment = 0.0;
  pw_pair_vectors(&p, cn, ct);
  const pw_real *at[3] = {x, f.line.node[s].x, f.line.node[pw_interface_next(&f.line, s)].x};
  for (int k = 0; k < 3; k++) {
    sum[0] += ct[2 * k];
    sum[1] += ct[2 * k + 1];
    moment += at[k][0] * ct[2 * k + 1] - at[k][1] * ct[2 * k];
  }
  assert_near(sum[0], 0.0, 1e-14);
  assert_near(sum[1], 0.0, 1e-14);
  assert_near(moment, 0.0, 1e-14);
  tear_down(&f);
}

/* A slave that came in by the right side of a box keeps to it when another side is nearer. */
static void deep_slave_keeps_its_side(void **state)
{
  (void)state;
  pw_real xy[2 * 80];
  pw_idx n = box(0.5, 20, xy);
  fixture f;
  set_up(&f, xy, n, true);
  pw_pair p;
  pw_real x[2] = {0.499, 0.2};
  pw_idx owner = detect(&f, x[0], x[1], &p);
  assert_true(owner >= 20 && owner < 40);
  for (int i = 0; i < 70; i++) { /* to 0.35 below the right side, 0.15 below the upper one */
    x[0] -= 0.005;
    x[1] += 0.15 / 70.0;
    owner = pw_interface_track(&f.line, owner, x, &p);
    assert_true(owner >= 20 && owner < 40);
    assert_near(p.n[0], 1.0, 1e-14);
    assert_near(p.gap, x[0] - 0.5, 1e-12);
  }
  tear_down(&f);
}

/* Beyond the free end of an open line nothing is inside; at an end on the axis of symmetry the
 * mirror image closes the body. */
static void ends_of_open_lines(void **state)
{
  (void)state;
  const pw_real flat[4] = {-0.1, 0.0, 0.1, 0.0};
  fixture f;
  pw_pair p;
  set_up(&f, flat, 2, false);
  assert_true(detect(&f, 0.0, 0.01, &p) >= 0);
  assert_true(detect(&f, 0.101, 0.01, &p) < 0);
  assert_true(detect(&f, 0.0, -0.01, &p) < 0);
  tear_down(&f);
  const pw_real cone[4] = {0.0, 0.0, 0.1, 0.1};
  pw_interface axis;
  assert_ok(pw_interface_create(cone, NULL, 2, false, true, 2, &axis));
  const pw_real inside[2] = {0.0, 0.01}, outside[2] = {0.0, -0.01};
  pw_interface_closest(&axis, 0, inside, &p);
  assert_near(p.gap, -0.01 * sqrt(0.5), 1e-15);
  pw_interface_closest(&axis, 0, outside, &p);
  assert_near(p.gap, 0.01, 1e-15);
  pw_interface_destroy(&axis);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bins_find_what_brute_force_finds),
      cmocka_unit_test(force_is_continuous_round_corners),
      cmocka_unit_test(vertex_vectors_balance),
      cmocka_unit_test(deep_slave_keeps_its_side),
      cmocka_unit_test(ends_of_open_lines),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
