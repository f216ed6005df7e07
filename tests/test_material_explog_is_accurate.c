/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pw_exp and pw_log against the long double functions of the library. */
#include "kernels/explog.h"
#include "tests/harness.h"

static void exponential(void **unused)
{
  (void)unused;
  uint64_t seed = 1;
  for (int i = 0; i < 300000; i++) {
    double x = (test_random(&seed) - 0.5) * (i % 3 == 0 ? 1400.0 : (i % 3 == 1 ? 20.0 : 0.01));
    assert_true(fabsl(pw_exp(x) / expl(x) - 1.0L) < 1e-15L);
  }
  assert_true(pw_exp(0.0) == 1.0);
  assert_true(isnan(pw_exp(NAN)));
  assert_true(pw_exp(1e4) == pw_exp(700.0));
  assert_true(pw_exp(-1e4) == pw_exp(-700.0) && pw_exp(-1e4) > 0.0);
}

static void logarithm(void **unused)
{
  (void)unused;
  uint64_t seed = 2;
  for (int i = 0; i < 300000; i++) {
    double x = exp((test_random(&seed) - 0.5) * (i % 3 == 0 ? 1400.0 : (i % 3 == 1 ? 20.0 : 0.01)));
    assert_true(fabsl(pw_log(x) - logl(x)) <= 1e-15L * fabsl(logl(x)));
  }
  assert_true(pw_log(1.0) == 0.0);
  assert_true(isnan(pw_log(NAN)));
}

/** A loop that may be vectorised gives the bits of a call on its own. */
static void the_lane_does_not_matter(void **unused)
{
  (void)unused;
  enum { N = 1003 };
  double x[N], e[N], l[N];
  uint64_t seed = 3;
  for (int i = 0; i < N; i++) {
    x[i] = 1e-3 + 30.0 * test_random(&seed);
  }
#pragma omp simd
  for (int i = 0; i < N; i++) {
    e[i] = pw_exp(-x[i]);
    l[i] = pw_log(x[i]);
  }
  for (int i = 0; i < N; i++) {
    volatile double alone = x[i];
    double a = pw_exp(-alone), b = pw_log(alone);
    assert_memory_equal(&a, &e[i], sizeof a);
    assert_memory_equal(&b, &l[i], sizeof b);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(exponential), cmocka_unit_test(logarithm),
                                     cmocka_unit_test(the_lane_does_not_matter)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
