/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/umat_helpers.h
 * @brief Parameters of the material `umat` with the routines of tests/umat_library.c.
 */
#ifndef PW_TESTS_UMAT_HELPERS_H
#define PW_TESTS_UMAT_HELPERS_H

#include "engine/scene.h"
#include "engine/scene_keys.h"
#include "engine/umat.h"
#include "kernels/element_driver.h"
#include "tests/harness.h"

/** Set a number, a list or a text by its key's name. */
static inline void umat_set(pw_scene_material *m, const char *name, const pw_key_value *value)
{
  const pw_key *key = pw_key_find(m->model->keys, name);
  assert_non_null(key);
  pw_key_store(m->model->keys, key, value, m->param);
}

static inline void umat_number(pw_scene_material *m, const char *name, double number)
{
  umat_set(m, name, &(pw_key_value){.n = 1, .v = {number}});
}

static inline void umat_list(pw_scene_material *m, const char *name, int n, const double *v)
{
  pw_key_value value = {.n = n};
  memcpy(value.v, v, (size_t)n * sizeof *v);
  umat_set(m, name, &value);
}

static inline void umat_word(pw_scene_material *m, const char *name, const char *text)
{
  pw_key_value value = {.n = 0};
  snprintf(value.text, sizeof value.text, "%s", text);
  umat_set(m, name, &value);
}

/** A routine of the test library; E = 10 MPa, nu = 0.3, and a yield stress and a hardening modulus
 *  when @p yield > 0; one state variable. Loaded. */
static inline pw_scene_material umat_material(const char *symbol, double yield, double hardening)
{
  const double props[4] = {1e7, 0.3, yield, hardening};
  pw_scene_material m = {.name = "soil", .model = pw_material_find("umat")};
  assert_non_null(m.model);
  pw_scene_defaults(m.model->keys, m.param);
  umat_word(&m, "library", UMAT_LIBRARY);
  umat_word(&m, "symbol", symbol);
  umat_number(&m, "density_kg_m3", 1800.0);
  umat_number(&m, "nprops", yield > 0.0 ? 4 : 2);
  umat_list(&m, "props", yield > 0.0 ? 4 : 2, props);
  umat_number(&m, "nstatv", 1);
  assert_ok(pw_umat_load(m.param));
  return m;
}

/** An element of it under a pressure. */
static inline pw_element umat_element(const pw_scene_material *m, double pressure)
{
  const pw_real stress[6] = {-pressure, -pressure, -pressure, 0, 0, 0};
  pw_element el;
  assert_ok(pw_element_start(&el, m->model, m->param, stress));
  return el;
}

#endif /* PW_TESTS_UMAT_HELPERS_H */
