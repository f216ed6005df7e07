/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every row of every key table is sound, carries its unit in its name, and is in the listing. */
#include "tests/harness.h"

#include <stdlib.h>

#include "engine/effect.h"
#include "engine/scene_keys.h"
#include "io/keys.h"
#include "io/scene_file_reader.h"

/* Numbers without a dimension. */
static const char *const dimensionless[] = {
    "cfl",
    "growth",
    "points_per_cell",
    "rod_elements",
    "mass_cut_off",
    "mass_terms",
    "step_ratio_max",
    "block_elements",
    "poisson_ratio",
    "void_ratio",
    "exponent_n",
    "void_ratio_d0",
    "void_ratio_c0",
    "void_ratio_i0",
    "exponent_alpha",
    "exponent_beta",
    "stiffness_ratio_m_r",
    "stiffness_ratio_m_t",
    "elastic_range_r",
    "exponent_beta_r",
    "exponent_chi",
    "substep_tolerance",
    "max_substeps",
    "rigidity_index",
    "compression_index_lambda",
    "swelling_index_kappa",
    "critical_stress_ratio",
    "overconsolidation_ratio",
    "compression_index_lambda_star",
    "swelling_index_kappa_star",
    "virgin_line_n",
    "stiffness_ratio_r",
    "k0",
    "porosity",
    "normal_factor",
    "shear_factor",
    "shear_ratio",
    "count",
    "friction",
    "stiffness_factor",
    "step_stiffness_ratio",
    "step_frequency_max",
    "domain_aspect_max",
    "split_factor",
    "thin_factor",
    "coefficient",
    "nprops",
    "props",
    "nstatv",
    "statev_initial",
    "statev_stress_tensors",
    "statev_strain_tensors",
    "size_factor",
    "bricks",
    "tets_per_brick",
    "steps",
    "tolerance",
    "max_iterations",
    "max_cuts",
    "step_least",
    "step_most",
    "easy_iterations",
    "hard_iterations",
    "approach",
    "line_search",
    "history_every_steps",
    "snapshot_every_steps",
    "checkpoint_every_steps",
    "picture_steps",
    "slice_part",
    "start_step",
    "ramp_steps",
    "axis",
    "stretch_end",
    "beta",
    "gamma",
};

typedef void (*table_fn)(const char *name, const pw_key *keys, void *context);

static void for_each_table(table_fn fn, void *context)
{
  fn("top level", pw_scene_keys_top, context);
  fn("grid:", pw_scene_keys_grid, context);
  fn("time:", pw_scene_keys_time, context);
  fn("method:", pw_scene_keys_method, context);
  fn("output:", pw_scene_keys_output, context);
  fn("implicit:", pw_scene_keys_grid_implicit, context);
  fn("bodies: NAME:", pw_scene_keys_body, context);
  fn("bodies: NAME: refine:", pw_scene_keys_refine, context);
  for (int i = 0; pw_material_at(i); i++) {
    fn(pw_material_at(i)->name, pw_material_at(i)->keys, context);
  }
  for (int i = 0; pw_effect_at(i); i++) {
    fn(pw_effect_at(i)->name, pw_effect_at(i)->keys, context);
    if (pw_effect_at(i)->rows) {
      char name[2 * PW_NAME];
      snprintf(name, sizeof name, "%s: %s:", pw_effect_at(i)->name, pw_effect_at(i)->rows->name);
      fn(name, pw_effect_at(i)->rows->keys, context);
    }
  }
}

static void for_each_solid_table(table_fn fn, void *context)
{
  fn("geometry solid, mesh:", pw_scene_keys_mesh, context);
  fn("geometry solid, implicit:", pw_scene_keys_implicit, context);
  fn("geometry solid, output:", pw_scene_keys_solid_output, context);
  fn("geometry solid, bodies: NAME:", pw_scene_keys_solid_body, context);
  for (int i = 0; pw_solid_effect_at(i); i++) {
    char name[2 * PW_NAME];
    snprintf(name, sizeof name, "geometry solid, %s:", pw_solid_effect_at(i)->name);
    fn(name, pw_solid_effect_at(i)->keys, context);
  }
}

static bool is_number(const pw_key *k)
{
  return k->type == PW_KEY_REAL || k->type == PW_KEY_PAIR || k->type == PW_KEY_TRIPLE ||
         k->type == PW_KEY_REALS || k->type == PW_KEY_INT;
}

static void check_units(const char *name, const pw_key *keys, void *context)
{
  (void)context;
  for (const pw_key *k = keys; k && k->name; k++) {
    bool listed = false;
    for (size_t i = 0; i < sizeof dimensionless / sizeof dimensionless[0]; i++) {
      listed = listed || strcmp(dimensionless[i], k->name) == 0;
    }
    bool has_unit = strcmp(pw_key_unit(k), "-") != 0;
    if (is_number(k) && listed == has_unit) {
      fail_msg("%s %s: unit '%s', %s", name, k->name, pw_key_unit(k),
               listed ? "but listed as dimensionless" : "and not listed as dimensionless");
    }
    if (!is_number(k) && has_unit) {
      fail_msg("%s %s: no number, but unit '%s'", name, k->name, pw_key_unit(k));
    }
  }
}

static void numbers_carry_their_unit(void **state)
{
  (void)state;
  for_each_table(check_units, NULL);
  for_each_solid_table(check_units, NULL);
}

static void units_follow_the_suffix(void **state)
{
  (void)state;
  static const char *const cases[][2] = {
      {"cell_m", "m"},
      {"end_s", "s"},
      {"velocity_m_s", "m/s"},
      {"velocity_x_m_s", "m/s"},
      {"a_m_s2", "m/s2"},
      {"density_kg_m3", "kg/m3"},
      {"tilt_deg", "deg"},
      {"normal_stiffness_pa_m", "Pa/m"},
      {"pressure_pa", "Pa"},
      {"domain_limit_cells", "cells"},
      {"exponent_n", "-"},
      {"void_ratio", "-"},
      {"m", "-"},
      {"_m", "-"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    pw_key key = {.name = cases[i][0]};
    assert_string_equal(pw_key_unit(&key), cases[i][1]);
  }
}

/* Fallback inside the range and among the choices; conditions speak of something that exists. */
static void check_row(const char *table, const pw_key *keys, const pw_key *k)
{
  union {
    pw_real align;
    unsigned char bytes[sizeof(pw_scene)];
  } *base = calloc(1, sizeof *base);
  assert_non_null(base);
  pw_key one[2] = {*k, {0}};
  one[0].offset = 0;
  if (is_number(k)) {
    assert_true(k->lo < k->hi);
  }
  if (k->fallback && is_number(k) && k->type != PW_KEY_INT) {
    pw_scene_defaults(one, base);
    pw_reals list;
    memcpy(&list, base, sizeof list);
    int n = k->type == PW_KEY_PAIR     ? 2
            : k->type == PW_KEY_TRIPLE ? 3
            : k->type == PW_KEY_REAL   ? 1
                                       : list.n;
    for (int i = 0; i < n; i++) {
      pw_real v;
      size_t first = k->type == PW_KEY_REALS ? offsetof(pw_reals, v) : 0;
      memcpy(&v, base->bytes + first + (size_t)i * sizeof v, sizeof v);
      if (!(v >= k->lo && v <= k->hi)) {
        fail_msg("%s %s: default %s is out of range", table, k->name, k->fallback);
      }
    }
  }
  if (k->type == PW_KEY_CHOICE) {
    assert_non_null(k->choices);
    assert_true(!k->fallback || pw_key_choice(k->choices, k->fallback) >= 0);
  }
  if (k->type == PW_KEY_BOOL && k->fallback) {
    assert_true(pw_key_choice("false|true", k->fallback) >= 0);
  }
  if (k->needs && !pw_key_needs_sibling(keys, k) && !pw_effect_find(k->needs)) {
    fail_msg("%s %s: needs %s, which is neither a sibling nor an effect", table, k->name, k->needs);
  }
  free(base);
}

static void check_table(const char *name, const pw_key *keys, void *context)
{
  (void)context;
  int n = 0;
  for (const pw_key *k = keys; k && k->name; k++, n++) {
    assert_ptr_equal(pw_key_find(keys, k->name), k);
    if (!k->meaning || !k->meaning[0]) {
      fail_msg("%s %s has no meaning", name, k->name);
    }
    assert_true(strlen(k->name) < PW_NAME);
    check_row(name, keys, k);
  }
  assert_true(n <= PW_READER_ROWS);
}

static void rows_are_sound(void **state)
{
  (void)state;
  for_each_table(check_table, NULL);
  for_each_solid_table(check_table, NULL);
  for (int i = 0; pw_material_at(i); i++) {
    const pw_key *keys = pw_material_at(i)->keys;
    for (const pw_key *k = keys; k->name; k++) {
      assert_int_equal(k->offset % sizeof(pw_real), 0);
      assert_true(k->offset / sizeof(pw_real) < PW_MAX_PARAMS);
    }
  }
}

static char *print(void (*fn)(FILE *))
{
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  assert_non_null(out);
  fn(out);
  assert_int_equal(fclose(out), 0);
  return text;
}

/* The row of a key stands under its table's title, with unit, default and meaning. */
static void find_rows(const char *name, const pw_key *keys, void *context)
{
  char line[2 * PW_NAME + 2];
  snprintf(line, sizeof line, "\n%s", name); /* a title stands at the start of a line, */
  const char *title = strstr(context, line);
  title = title ? title : strstr(context, name); /* that of a material at its end */
  if (!title) {
    fail_msg("%s is not listed", name);
  }
  const char *head = keys && keys->name ? strstr(title, "\n  key ") : title;
  assert_non_null(head);
  for (const pw_key *k = keys; k && k->name; k++) {
    char start[PW_NAME + 8];
    snprintf(start, sizeof start, "\n  %s ", k->name);
    const char *row = strstr(head, start);
    const char *unit = row ? strstr(row, pw_key_unit(k)) : NULL;
    const char *meaning = row ? strstr(row, k->meaning) : NULL;
    const char *end = row ? strchr(row + 1, '\n') : NULL;
    if (!row || !unit || !meaning || meaning > end || unit > end) {
      fail_msg("%s %s is not listed with unit and meaning", name, k->name);
    }
    if (k->fallback && is_number(k)) {
      const char *fallback = strstr(row, k->fallback);
      assert_true(fallback && fallback < end);
    }
  }
}

static void the_listing_holds_every_key(void **state)
{
  (void)state;
  char *text = print(pw_keys_print);
  for_each_table(find_rows, text);
  for_each_solid_table(find_rows, text);
  assert_non_null(strstr(text, "\n  cfl       -     number  > 0 and <= 0.95   0.5       -      "
                               "step as a fraction of"));
  free(text);
}

static void the_list_holds_every_choice(void **state)
{
  (void)state;
  char *text = print(pw_list_print);
  static const char *const words[] = {"plane_strain", "axisymmetric", "linear", "ugimp",
                                      "cpdi",         "axi_cpdi",     "musl",   "usl",
                                      "usf",          "rectangle",    "disc",   "pile"};
  for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
    assert_non_null(strstr(text, words[i]));
  }
  for (int i = 0; pw_material_at(i); i++) {
    assert_non_null(strstr(text, pw_material_at(i)->name));
    assert_non_null(strstr(text, pw_material_at(i)->brief));
  }
  for (int i = 0; pw_effect_at(i); i++) {
    assert_non_null(strstr(text, pw_effect_at(i)->name));
    assert_non_null(strstr(text, pw_effect_at(i)->brief));
  }
  free(text);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_carry_their_unit),
      cmocka_unit_test(units_follow_the_suffix),
      cmocka_unit_test(rows_are_sound),
      cmocka_unit_test(the_listing_holds_every_key),
      cmocka_unit_test(the_list_holds_every_choice),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
