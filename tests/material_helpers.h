/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/material_helpers.h
 * @brief Parameters by name, single updates and checks that every plastic material shares.
 */
#ifndef PW_TESTS_MATERIAL_HELPERS_H
#define PW_TESTS_MATERIAL_HELPERS_H

#include <stdlib.h>

#include "kernels/element_driver.h"
#include "kernels/spectral.h"
#include "tests/harness.h"

/** A material with its parameters, set by the names of its keys. */
typedef struct test_material {
  const pw_material *model;
  pw_real v[PW_MAX_PARAMS];
} test_material;

static inline const pw_key *test_key(const pw_material *m, const char *name)
{
  for (const pw_key *k = m->keys; k->name; k++) {
    if (strcmp(k->name, name) == 0) {
      return k;
    }
  }
  fail_msg("%s has no key %s", m->name, name);
  return NULL;
}

static inline void test_set(test_material *m, const char *name, double value)
{
  m->v[test_key(m->model, name)->offset / sizeof(pw_real)] = value;
}

/** Index of a choice of a key, -1 if there is none. */
static inline int test_choice(const char *choices, const char *word)
{
  size_t n = strlen(word);
  int index = 0;
  for (const char *at = choices; at; index++) {
    if (strncmp(at, word, n) == 0 && (at[n] == '|' || at[n] == '\0')) {
      return index;
    }
    at = strchr(at, '|');
    at = at ? at + 1 : NULL;
  }
  return -1;
}

/** The model with every default in place. */
static inline test_material test_material_of(const char *name)
{
  test_material m = {.model = pw_material_find(name)};
  assert_non_null(m.model);
  for (const pw_key *k = m.model->keys; k->name; k++) {
    pw_real value = 0.0;
    if (k->fallback) {
      value = k->type == PW_KEY_REAL     ? strtod(k->fallback, NULL)
              : k->type == PW_KEY_CHOICE ? test_choice(k->choices, k->fallback)
                                         : strcmp(k->fallback, "true") == 0;
    }
    m.v[k->offset / sizeof(pw_real)] = value;
  }
  return m;
}

/** The check of the parameters fails and its message holds @p words. */
static inline void test_refuses(const test_material *m, const char *words)
{
  pw_error_clear();
  assert_int_equal(m->model->check(m->v), PW_ERR_SCENE);
  if (!strstr(pw_error_text(), words)) {
    fail_msg("'%s' does not say '%s'", pw_error_text(), words);
  }
}

static inline pw_element test_start(const test_material *m, double pressure)
{
  const pw_real stress[6] = {-pressure, -pressure, -pressure, 0, 0, 0};
  pw_element el;
  assert_ok(pw_element_start(&el, m->model, m->v, stress));
  return el;
}

/** Second invariant of the deviator, sqrt(2 J2) being its norm. */
static inline double test_dev_norm(const pw_real *stress)
{
  pw_t6 s = pw_t6_load(stress, 1);
  return pw_t6_norm(pw_t6_shift(s, -pw_t6_trace(s) / 3.0));
}

/** A random increment of a given size. */
static inline void test_random_strain(uint64_t *seed, double size, pw_real *de)
{
  for (int c = 0; c < 6; c++) {
    de[c] = 2.0 * size * (test_random(seed) - 0.5);
  }
}

/** One update with the increment's deformation gradient given as @p f (row-major) or NULL. */
static inline pw_status test_update(const pw_element *el, const pw_real *de, const pw_real *f,
                                    pw_element *out, pw_real *tangent)
{
  const pw_real none[3] = {0};
  pw_real dvol = 1.0, jac = 1.0, b[6] = {1, 1, 1, 0, 0, 0};
  *out = *el;
  pw_stress_args a = {.n = 1,
                      .ld = 1,
                      .ldi = 1,
                      .dt = 1.0,
                      .dstrain = de,
                      .spin = none,
                      .dvol = &dvol,
                      .left_cg = b,
                      .jac = &jac,
                      .density = &el->density,
                      .increment = f,
                      .stress = out->stress,
                      .state = out->state,
                      .wave_speed = &out->wave_speed,
                      .tangent = tangent};
  if (!f) {
    dvol = exp(de[0] + de[1] + de[2]);
  }
  return el->material->update(el->param, &a);
}

/** The largest difference of a tangent in rate form from central differences, over @p scale. */
static inline double test_tangent_error(const pw_element *el, const pw_real *de, double h,
                                        double scale)
{
  pw_real tangent[36], worst = 0.0;
  pw_element out, plus, minus;
  assert_ok(test_update(el, de, NULL, &out, tangent));
  for (int j = 0; j < 6; j++) {
    pw_real d[6];
    memcpy(d, de, sizeof d);
    d[j] = de[j] + h;
    assert_ok(test_update(el, d, NULL, &plus, NULL));
    d[j] = de[j] - h;
    assert_ok(test_update(el, d, NULL, &minus, NULL));
    for (int i = 0; i < 6; i++) {
      double slope = (plus.stress[i] - minus.stress[i]) / (2.0 * h * (j < 3 ? 1.0 : 2.0));
      worst = pw_max(worst, fabs(tangent[6 * i + j] - slope));
    }
  }
  return worst / scale;
}

/** Turn a stressed element by ten turns; largest change of the stress in the turned axes. */
static inline double test_turning_error(pw_element *el)
{
  const double axis[3] = {0.48, -0.64, 0.6};
  const pw_real none[6] = {0};
  const int steps = 2000;
  const double angle = 20.0 * 3.14159265358979323846 / steps;
  pw_spectrum before = pw_t6_spectrum(pw_t6_load(el->stress, 1));
  double a = before.value[0] + before.value[1] + before.value[2], size = fabs(a);
  double j2 = test_dev_norm(el->stress), det = pw_t6_det(pw_t6_load(el->stress, 1));
  for (int i = 0; i < steps; i++) {
    pw_real spin[3] = {axis[0] * angle, axis[1] * angle, axis[2] * angle};
    assert_ok(pw_element_move(el, none, spin, NULL));
  }
  pw_t6 s = pw_t6_load(el->stress, 1);
  size = pw_max(size, j2);
  double worst = fabs(pw_t6_trace(s) - a) / size;
  worst = pw_max(worst, fabs(test_dev_norm(el->stress) - j2) / size);
  return pw_max(worst, fabs(pw_t6_det(s) - det) / (size * size * size));
}

/**
 * Pressure that opens a long cavity from nothing in an infinite body without volume change: with
 * u = r/r0 = e^strain, p = int_1^inf (s_r - s_theta) du/(u (u^2 - 1)). Every shell follows the
 * same path of pure shear, so that one element gives the integrand.
 */
static inline double test_cavity_pressure(pw_element *el, double smallest, double ratio)
{
  double at = 0.0, pressure = 0.0;
  for (double next = smallest; next < 20.0; at = next, next *= ratio) {
    /* the integrand over the strain, at the middle of the step by the midpoint rule */
    double step = next - at, middle = at + 0.5 * step;
    const pw_real half[6] = {-0.5 * step, 0.5 * step, 0, 0, 0, 0};
    assert_ok(pw_element_move(el, half, NULL, NULL));
    pressure += fabs(el->stress[1] - el->stress[0]) * step / expm1(2.0 * middle);
    assert_ok(pw_element_move(el, half, NULL, NULL));
  }
  return pressure;
}

#endif /* PW_TESTS_MATERIAL_HELPERS_H */
