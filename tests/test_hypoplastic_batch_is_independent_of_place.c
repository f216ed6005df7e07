/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The update of a batch: bitwise the same for a point wherever it stands and whatever stands
 * beside it, and the result of the integration of one point. */
#include "kernels/material.h"
#include "tests/hypoplastic_reference.h"

enum { N = 61, LD = 70, LDI = 64, ROWS = 14 };

typedef struct batch {
  pw_real stress[6][LD], state[8][LD];
  pw_real dstrain[6][LDI], spin[3][LDI], dvol[LDI], density[LDI], speed[LDI];
  pw_material_counts counts;
} batch;

/** Point k of a family: some need one substep, some several, some are cut off, some turn. */
static void fill(batch *b, int place, int k, bool plane)
{
  uint64_t seed = 100 + (uint64_t)k;
  double p = k % 13 == 0 ? 50.0 : 1e3 * pow(200.0, test_random(&seed));
  double size = k % 7 == 0 ? 3e-4 : (k % 3 == 0 ? 1e-5 : 1e-6);
  for (int c = 0; c < 6; c++) {
    bool out = plane && c > 3;
    b->stress[c][place] = c < 3 ? -p * (0.8 + 0.4 * test_random(&seed)) + 1600.0
                                : (out ? 0.0 : 0.1 * p * (test_random(&seed) - 0.5));
    b->state[1 + c][place] = out ? 0.0 : 3e-5 * (test_random(&seed) - 0.5);
    b->dstrain[c][place] = out ? 0.0 : size * (test_random(&seed) - (k % 13 == 0 ? 0.0 : 0.6));
  }
  for (int c = 0; c < 3; c++) {
    b->spin[c][place] = plane && c > 0 ? 0.0 : size * (test_random(&seed) - 0.5);
  }
  b->state[0][place] = 0.6 + 0.3 * test_random(&seed);
  b->state[7][place] = k % 11 == 0 ? 0.3 : 1.0;
  b->dvol[place] = exp(b->dstrain[0][place] + b->dstrain[1][place] + b->dstrain[2][place]);
  b->density[place] = 1600.0 + k;
}

static int parameters; /* which of the two sets */

static pw_status update(batch *b, bool with, int first, int n)
{
  pw_real v[PW_HYPO_PARAMS];
  reference_set(parameters, 1e-3, v);
  v[PW_HYPO_P_MIN] = 100.0;
  v[PW_HYPO_INTERGRANULAR] = with ? 1.0 : 0.0;
  pw_stress_args a = {.n = n,
                      .ld = LD,
                      .ldi = LDI,
                      .dt = 1e-5,
                      .dstrain = &b->dstrain[0][first],
                      .spin = &b->spin[0][first],
                      .dvol = &b->dvol[first],
                      .density = &b->density[first],
                      .stress = &b->stress[0][first],
                      .state = &b->state[0][first],
                      .wave_speed = &b->speed[first],
                      .counts = &b->counts};
  pw_status s = pw_material_find("hypoplastic_sand")->update(v, &a);
  assert_int_equal(a.bad, -1);
  return s;
}

static void column(const batch *b, int place, pw_real *out)
{
  for (int c = 0; c < 6; c++) {
    out[c] = b->stress[c][place];
    out[6 + c] = b->state[c][place];
  }
  out[12] = b->state[6][place];
  out[13] = b->speed[place];
}

static void same_bits_at_every_place(void **unused)
{
  (void)unused;
  static batch straight, reversed, alone;
  for (int kind = 0; kind < 8; kind++) {
    bool plane = kind & 1, with = kind & 2;
    parameters = kind & 4 ? 1 : 0;
    memset(&straight, 0, sizeof straight);
    memset(&reversed, 0, sizeof reversed);
    for (int k = 0; k < N; k++) {
      fill(&straight, k, k, plane);
      fill(&reversed, N - 1 - k, k, plane);
    }
    assert_int_equal(update(&straight, with, 0, N), PW_OK);
    assert_int_equal(update(&reversed, with, 0, 17), PW_OK); /* and cut differently */
    assert_int_equal(update(&reversed, with, 17, N - 17), PW_OK);
    for (int k = 0; k < N; k++) {
      pw_real a[ROWS], b[ROWS], c[ROWS];
      memset(&alone, 0, sizeof alone);
      fill(&alone, 5, k, plane);
      assert_int_equal(update(&alone, with, 5, 1), PW_OK);
      column(&straight, k, a);
      column(&reversed, N - 1 - k, b);
      column(&alone, 5, c);
      assert_memory_equal(a, b, sizeof a);
      assert_memory_equal(a, c, sizeof a);
    }
    assert_memory_equal(&straight.counts, &reversed.counts, sizeof straight.counts);
  }
}

/** Points done at once against the integration of one point: rounding apart, the same. */
static void agreement(int set)
{
  static batch b;
  pw_real v[PW_HYPO_PARAMS];
  pw_hypo h;
  double worst = 0.0;
  parameters = set;
  reference_set(set, 1e-3, v);
  v[PW_HYPO_P_MIN] = 100.0;
  pw_hypo_derive(v, &h);
  for (int k = 0; k < N; k++) {
    fill(&b, k, k, false);
  }
  pw_hypo_point one[N];
  pw_real speed[N];
  for (int k = 0; k < N; k++) {
    pw_real modulus;
    pw_rot r = pw_rot_hughes_winget(b.spin[0][k], b.spin[1][k], b.spin[2][k]);
    one[k] = (pw_hypo_point){.stress = pw_t6_rotate(r, pw_t6_load(&b.stress[0][k], LD)),
                             .delta = pw_t6_rotate(r, pw_t6_load(&b.state[1][k], LD)),
                             .void_ratio = b.state[0][k],
                             .substep = b.state[7][k]};
    assert_int_equal(pw_hypo_integrate(&h, pw_t6_load(&b.dstrain[0][k], LDI), b.dvol[k], &one[k],
                                       NULL, NULL, &modulus),
                     PW_OK);
    speed[k] = sqrt(modulus / b.density[k]);
  }
  assert_int_equal(update(&b, true, 0, N), PW_OK);
  for (int k = 0; k < N; k++) {
    worst = fmax(worst, stress_error(pw_t6_load(&b.stress[0][k], LD), one[k].stress, h.p_t));
    worst = fmax(worst,
                 pw_t6_norm(pw_t6_axpy(pw_t6_load(&b.state[1][k], LD), -1.0, one[k].delta)) / h.r);
    worst = fmax(worst, fabs(b.speed[k] / speed[k] - 1.0));
    assert_near(b.state[0][k], one[k].void_ratio, 1e-14);
  }
  print_message("largest difference %.1e\n", worst);
  assert_true(worst < 1e-12);
}

static void batch_agrees_with_one_point(void **unused)
{
  (void)unused;
  agreement(0);
  agreement(1);
}

/** A failing point keeps its state, is reported, and leaves the others alone. */
static void a_bad_point_is_reported(void **unused)
{
  (void)unused;
  static batch b, good;
  pw_real v[PW_HYPO_PARAMS], before[ROWS], after[ROWS];
  reference_set(0, 1e-3, v);
  for (int k = 0; k < 20; k++) {
    fill(&b, k, k, false);
    fill(&good, k, k, false);
  }
  b.dvol[7] = 0.5;
  b.dstrain[2][12] = NAN;
  column(&b, 7, before);
  pw_stress_args a = {.n = 20,
                      .ld = LD,
                      .ldi = LDI,
                      .dstrain = b.dstrain[0],
                      .spin = b.spin[0],
                      .dvol = b.dvol,
                      .density = b.density,
                      .stress = b.stress[0],
                      .state = b.state[0],
                      .wave_speed = b.speed};
  assert_int_equal(pw_material_find("hypoplastic_sand")->update(v, &a), PW_RETRY_STRESS);
  assert_int_equal(a.bad, 7);
  column(&b, 7, after);
  assert_memory_equal(before, after, 13 * sizeof before[0]);
  a.dstrain = good.dstrain[0];
  a.spin = good.spin[0];
  a.dvol = good.dvol;
  a.stress = good.stress[0];
  a.state = good.state[0];
  a.density = good.density;
  a.wave_speed = good.speed;
  assert_int_equal(pw_material_find("hypoplastic_sand")->update(v, &a), PW_OK);
  for (int k = 0; k < 20; k++) {
    column(&b, k, before);
    column(&good, k, after);
    assert_true(k == 7 || k == 12 || memcmp(before, after, sizeof before) == 0);
    assert_true(isfinite(b.speed[k]) && b.speed[k] > 0.0);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(same_bits_at_every_place),
                                     cmocka_unit_test(batch_agrees_with_one_point),
                                     cmocka_unit_test(a_bad_point_is_reported)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
