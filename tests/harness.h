/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/harness.h
 * @brief What every test program includes: cmocka and a few helpers.
 */
#ifndef PW_TESTS_HARNESS_H
#define PW_TESTS_HARNESS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "engine/core/status.h"

/** Fail with both values unless |a - b| <= tol. */
#define assert_near(a, b, tol)                                                                     \
  do {                                                                                             \
    double a_ = (a), b_ = (b), tol_ = (tol);                                                       \
    if (!(fabs(a_ - b_) <= tol_)) {                                                                \
      fail_msg("%s = %.17g, expected %.17g +- %.3g (off by %.3g)", #a, a_, b_, tol_, a_ - b_);     \
    }                                                                                              \
  } while (0)

/** Fail unless |a - b| <= rel |b|. */
#define assert_relative(a, b, rel) assert_near(a, b, fabs(b) * (rel))

/** Fail with the recorded error unless a call gives PW_OK. */
#define assert_ok(call)                                                                            \
  do {                                                                                             \
    pw_status s_ = (call);                                                                         \
    if (s_ != PW_OK) {                                                                             \
      fail_msg("%s: %s: %s (%s)", #call, pw_status_text(s_), pw_error_text(), pw_error_where());   \
    }                                                                                              \
  } while (0)

/** Deterministic numbers in [0, 1): splitmix64 (Steele, Lea, Flood 2014). */
static inline double test_random(uint64_t *state)
{
  uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

#endif /* PW_TESTS_HARNESS_H */
