/* SPDX-License-Identifier: GPL-3.0-or-later */
/* summary.json parses, has every documented key with its value, and no NaN. */
#include <jansson.h>

#include "engine/effect.h"
#include "io/summary.h"
#include "tests/output_helpers.h"

static const pw_report report = {
    .threads = 2,
    .points = 1000,
    .nodes = 121,
    .elements = 100,
    .blocks = 8,
    .colours = 4,
    .steps = 500,
    .time_s = 0.25,
    .dt_min_s = 1e-4,
    .dt_max_s = 5e-4,
    .wall_s = 2.0,
    .stage_wall_s = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6},
    .bytes_per_point = 640,
    .energy = {.kinetic = 10.0,
               .strain_work = 60.0,
               .external = 100.0,
               .contact = 5.0,
               .spring = 4.0,
               .damping = 3.0,
               .absorbed = 2.0,
               .initial = -16.0 + 10.0},
    .point_updates = 10,
    .sorts = 11,
    .domains_limited = 12,
    .domains_rebuilt = 13,
    .domains_reshaped = 14,
    .vertices_clamped = 15,
    .material = {1, 2, 3, 4, 5},
};

static json_t *write_and_parse(const pw_record *results, const pw_summary_info *info)
{
  static pw_scene scene;
  const char *folder = test_folder(), *file = test_path(folder, "summary.json");
  json_error_t error;
  pw_scene_default(&scene);
  snprintf(scene.title, sizeof scene.title, "a test with \xff a wrong byte");
  snprintf(scene.file, sizeof scene.file, "cases/test.yaml");
  assert_non_null(pw_scene_add_effect(&scene, "gravity"));
  assert_non_null(pw_scene_add_effect(&scene, "boundary"));
  assert_non_null(pw_scene_add_effect(&scene, "boundary"));
  assert_ok(pw_summary_write_parts(file, &scene, &report, results, info));
  json_t *root = json_load_file(file, JSON_REJECT_DUPLICATES, &error);
  if (!root) {
    fail_msg("line %d: %s", error.line, error.text);
  }
  test_remove_folder(folder);
  return root;
}

static const char *text_of(const json_t *object, const char *key)
{
  const char *text = json_string_value(json_object_get(object, key));
  assert_non_null(text);
  return text;
}

static double number_of(const json_t *object, const char *key)
{
  const json_t *value = json_object_get(object, key);
  if (!json_is_number(value)) {
    fail_msg("no number %s", key);
  }
  return json_number_value(value);
}

static void run_keys_hold_the_report(void **unused)
{
  (void)unused;
  const char *const warning[2] = {"first", "second"};
  pw_record results = {.n = 0};
  pw_summary_info info = {
      .status = "finished", .first_step = 100, .nwarning = 2, .warning = warning};
  json_t *root = write_and_parse(&results, &info);
  assert_string_equal(text_of(root, "program"), "pilewright");
  assert_string_equal(text_of(root, "version"), pw_version());
  assert_string_equal(text_of(root, "git_revision"), pw_git_revision());
  assert_string_equal(text_of(root, "scene"), "cases/test.yaml");
  assert_string_equal(text_of(root, "title"), "a test with ? a wrong byte");
  assert_string_equal(text_of(root, "status"), "finished");
  assert_true(json_is_null(json_object_get(root, "error")));
  const struct {
    const char *key;
    double value;
  } number[] = {
      {"threads", 2},      {"points", 1000},
      {"nodes", 121},      {"elements", 100},
      {"blocks", 8},       {"colours", 4},
      {"steps", 500},      {"sim_time_s", 0.25},
      {"wall_s", 2},       {"dt_min_s", 1e-4},
      {"dt_max_s", 5e-4},  {"bytes_per_point", 640},
      {"first_step", 100}, {"point_steps_per_s", 1000 * 400 / 2.0},
  };
  for (size_t k = 0; k < sizeof number / sizeof *number; k++) {
    assert_true(number_of(root, number[k].key) == number[k].value);
  }
  assert_true(number_of(root, "peak_rss_bytes") > 1e6);
  const json_t *effects = json_object_get(root, "effects");
  assert_int_equal(json_array_size(effects), 2); /* one name though two boundaries */
  assert_string_equal(json_string_value(json_array_get(effects, 0)), "gravity");
  assert_string_equal(json_string_value(json_array_get(effects, 1)), "boundary");
  const json_t *warnings = json_object_get(root, "warnings");
  assert_int_equal(json_array_size(warnings), 2);
  assert_string_equal(json_string_value(json_array_get(warnings, 1)), "second");
  json_decref(root);
}

static void groups_hold_the_report(void **unused)
{
  (void)unused;
  static const char *const stage[PW_TIMER_COUNT] = {"sort",    "p2g",   "nodes",
                                                    "effects", "remap", "g2p_stress"};
  pw_record results = {.n = 0};
  pw_summary_info info = {.status = "stopped"};
  json_t *root = write_and_parse(&results, &info);
  const json_t *wall = json_object_get(root, "stage_wall_s");
  assert_int_equal(json_object_size(wall), PW_TIMER_COUNT);
  for (int k = 0; k < PW_TIMER_COUNT; k++) {
    assert_true(number_of(wall, stage[k]) == report.stage_wall_s[k]);
  }
  const json_t *energy = json_object_get(root, "energy");
  assert_true(number_of(energy, "initial_kinetic_j") == -6.0);
  assert_true(number_of(energy, "kinetic_j") == 10.0);
  assert_true(number_of(energy, "strain_work_j") == 60.0);
  assert_true(number_of(energy, "external_work_j") == 100.0);
  assert_true(number_of(energy, "contact_dissipated_j") == 5.0);
  assert_true(number_of(energy, "contact_spring_j") == 4.0);
  assert_true(number_of(energy, "damping_dissipated_j") == 3.0);
  assert_true(number_of(energy, "absorbed_j") == 2.0);
  /* -6 + 100 - (10 + 60 + 5 + 4 + 3 + 2) = 10; half the sum of magnitudes = 190 / 2 */
  assert_near(number_of(energy, "balance_error_j"), 10.0, 1e-12);
  assert_near(number_of(energy, "balance_error_relative"), 10.0 / 95.0, 1e-12);
  const json_t *counters = json_object_get(root, "counters");
  static const char *const name[] = {"point_updates",    "sorts",
                                     "domains_limited",  "domains_rebuilt",
                                     "domains_reshaped", "vertices_clamped"};
  for (int k = 0; k < 6; k++) {
    assert_true(number_of(counters, name[k]) == 10 + k);
  }
  static const char *const material[] = {"material_substeps", "material_rhs", "material_rejected",
                                         "material_forced", "material_cut_off"};
  for (int k = 0; k < 5; k++) {
    assert_true(number_of(counters, material[k]) == 1 + k);
  }
  json_decref(root);
}

static void results_are_numbers_lists_or_null(void **unused)
{
  (void)unused;
  const pw_real set[3] = {0.1, NAN, 0.3};
  pw_record results = {.n = 0};
  pw_summary_info info = {
      .status = "failed", .error = "point 7 is lost", .scene_file = "mine.yaml"};
  pw_record_put(&results, "penetration_m", 1.25);
  pw_record_put(&results, "base_vertical_stress_kpa", -INFINITY);
  pw_record_put_array(&results, "set_per_blow_m", set, 3);
  json_t *root = write_and_parse(&results, &info);
  const json_t *object = json_object_get(root, "results");
  assert_string_equal(text_of(root, "scene"), "mine.yaml");
  assert_string_equal(text_of(root, "error"), "point 7 is lost");
  assert_true(number_of(object, "penetration_m") == 1.25);
  assert_true(json_is_null(json_object_get(object, "base_vertical_stress_kpa")));
  const json_t *list = json_object_get(object, "set_per_blow_m");
  assert_int_equal(json_array_size(list), 3);
  assert_true(json_number_value(json_array_get(list, 0)) == 0.1);
  assert_true(json_is_null(json_array_get(list, 1)));
  json_decref(root);
}

static void an_unusable_folder_is_named(void **unused)
{
  (void)unused;
  static pw_scene scene;
  pw_record results = {.n = 0};
  pw_summary_info info = {.status = "finished"};
  pw_scene_default(&scene);
  assert_int_equal(
      pw_summary_write_parts("/nowhere/summary.json", &scene, &report, &results, &info),
      PW_ERR_FILE);
  assert_error_says("/nowhere/summary.json");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(run_keys_hold_the_report),
      cmocka_unit_test(groups_hold_the_report),
      cmocka_unit_test(results_are_numbers_lists_or_null),
      cmocka_unit_test(an_unusable_folder_is_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
