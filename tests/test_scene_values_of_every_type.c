/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A key table of its own with every type and condition: what is stored, refused, required. */
#include "tests/harness.h"

#include <stdlib.h>

#include "io/scene_file_reader.h"

typedef struct {
  pw_real real;
  pw_real pair[2];
  pw_reals reals;
  int whole;
  bool flag;
  int choice;
  char text[PW_NAME];
  int body, material;
  pw_real with_b_or_c, with_flag, with_gravity;
} sample;

#define AT(member) offsetof(sample, member)

static const pw_key keys[] = {
    {"real_m", PW_KEY_REAL, AT(real), PW_TINY, PW_HUGE, "1.5e-3", NULL, NULL, "."},
    {"pair_m", PW_KEY_PAIR, AT(pair), -5, 5, "[-1, 2.5]", NULL, NULL, "."},
    {"reals_s", PW_KEY_REALS, AT(reals), 0, 100, "[1, 2, 3]", NULL, NULL, "."},
    {"whole", PW_KEY_INT, AT(whole), -3, 1000, "-2", NULL, NULL, "."},
    {"flag", PW_KEY_BOOL, AT(flag), 0, 0, "true", NULL, NULL, "."},
    {"choice", PW_KEY_CHOICE, AT(choice), 0, 0, "b", "a|b|c", NULL, "."},
    {"text", PW_KEY_TEXT, AT(text), 0, 0, "some words", NULL, NULL, "."},
    {"body", PW_KEY_BODY, AT(body), 0, 0, "", NULL, NULL, "."},
    {"material", PW_KEY_MATERIAL, AT(material), 0, 0, "", NULL, NULL, "."},
    {"with_b_or_c", PW_KEY_REAL, AT(with_b_or_c), 0, 9, NULL, NULL, "choice=b|c", "."},
    {"with_flag", PW_KEY_REAL, AT(with_flag), 0, 9, "7", NULL, "flag=true", "."},
    {"with_gravity", PW_KEY_REAL, AT(with_gravity), 0, 9, NULL, NULL, "gravity", "."},
    {0}};

static sample values;
static char *messages;

/* Reads the section `sample` of @p text after the defaults; messages is NULL without errors. */
static bool read_sample(const char *text)
{
  static pw_scene scene;
  pw_yaml_messages m = {.name = "text", .text = text, .length = strlen(text)};
  free(messages);
  messages = NULL;
  scene.nbody = 2;
  strcpy(scene.body[0].name, "soil");
  strcpy(scene.body[1].name, "pile");
  scene.nmaterial = 1;
  strcpy(scene.material[0].name, "sand");
  memset(&values, 0, sizeof values);
  pw_scene_defaults(keys, &values);
  pw_yaml_node *root = pw_yaml_parse(text, m.length, -1, &m);
  assert_non_null(root);
  pw_reader reader = {.m = &m, .root = root, .scene = &scene};
  pw_reader_section section = {"sample", keys, &values, 0, NULL};
  bool clean = pw_reader_keys(&reader, &section, pw_yaml_find(root, "sample"));
  if (m.n > 0) {
    messages = pw_yaml_messages_text(&m);
  }
  pw_yaml_free(&root);
  pw_yaml_messages_free(&m);
  assert_int_equal(clean, messages == NULL);
  return clean;
}

static void defaults_are_as_written(void **state)
{
  (void)state;
  assert_true(read_sample("sample: {choice: a}\n"));
  assert_near(values.real, 1.5e-3, 0);
  assert_near(values.pair[0], -1, 0);
  assert_near(values.pair[1], 2.5, 0);
  assert_int_equal(values.reals.n, 3);
  assert_near(values.reals.v[2], 3, 0);
  assert_int_equal(values.whole, -2);
  assert_true(values.flag);
  assert_int_equal(values.choice, 0);
  assert_string_equal(values.text, "some words");
  assert_int_equal(values.body, -1);
  assert_int_equal(values.material, -1);
  assert_near(values.with_flag, 7, 0);
}

static void values_are_stored(void **state)
{
  (void)state;
  assert_true(read_sample("sample:\n"
                          "  real_m: +2.5E+2\n"
                          "  pair_m: [-.5, 4.]\n"
                          "  reals_s: []\n"
                          "  whole: -3\n"
                          "  flag: false\n"
                          "  choice: c\n"
                          "  text: ''\n"
                          "  body: pile\n"
                          "  material: sand\n"
                          "  with_b_or_c: 4\n"));
  assert_near(values.real, 250, 0);
  assert_near(values.pair[0], -0.5, 0);
  assert_near(values.pair[1], 4, 0);
  assert_int_equal(values.reals.n, 0);
  assert_int_equal(values.whole, -3);
  assert_false(values.flag);
  assert_int_equal(values.choice, 2);
  assert_string_equal(values.text, "");
  assert_int_equal(values.body, 1);
  assert_int_equal(values.material, 0);
  assert_near(values.with_b_or_c, 4, 0);
}

static void conditions_are_kept(void **state)
{
  (void)state;
  static const char *const cases[][2] = {
      {"sample: {}\n", "missing key 'with_b_or_c' in sample"},
      {"sample: {choice: a, with_b_or_c: 1}\n", "text:1:21: error: 'with_b_or_c' needs choice=b|c"},
      {"sample: {choice: a, flag: false, with_flag: 1}\n", "'with_flag' needs flag=true"},
      {"sample: {choice: a, with_gravity: 1}\n",
       "'with_gravity' needs gravity, which is not in the scene"},
      {"gravity:\nsample: {choice: a}\n", "text:2:1: error: missing key 'with_gravity' in sample"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    if (read_sample(cases[i][0]) || !strstr(messages, cases[i][1])) {
      fail_msg("%s%s\nexpected: %s", cases[i][0], messages ? messages : "", cases[i][1]);
    }
  }
  assert_true(read_sample("gravity:\nsample: {choice: a, with_gravity: 3}\n"));
  assert_near(values.with_gravity, 3, 0);
  /* what depends on a wrong or misspelt value is neither missed nor refused */
  assert_false(read_sample("sample: {choice: x}\n"));
  assert_null(strstr(messages, "with_b_or_c"));
  assert_false(read_sample("sample: {chioce: a, with_b_or_c: 1}\n"));
  assert_null(strstr(messages, "needs"));
}

static void only_numbers_are_numbers(void **state)
{
  (void)state;
  static const char *const bad[] = {"0x1p3", "1e",  "1e+", ".",   "+",         "-.",   "1.2.3",
                                    "1_000", "1 2", "nan", "inf", "-Infinity", ".NaN", "1e400",
                                    "one",   "'1'", "1f",  "0b1", "1:30",      "--1",  "e5",
                                    "[1]",   "{}",  "~",   "null"};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    char text[128];
    snprintf(text, sizeof text, "sample:\n  choice: a\n  real_m: %s\n", bad[i]);
    if (read_sample(text) || !strstr(messages, "text:3:")) {
      fail_msg("%s was read as %g\n%s", bad[i], values.real, messages ? messages : "");
    }
  }
  static const char *const good[] = {"1", "01", "1.", ".5", "+.5e-0", "5e-324", "1E300"};
  for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
    char text[128];
    snprintf(text, sizeof text,
             "sample:\n  choice: a\n  pair_m: [0, 0]\n  reals_s: [0]\n  real_m: %s\n", good[i]);
    bool tiny = strcmp(good[i], "5e-324") == 0; /* a number, but not in the range */
    assert_int_equal(read_sample(text), !tiny);
    assert_true(!tiny || strstr(messages, "is out of range: it must be > 0 m"));
    assert_true(tiny || values.real == strtod(good[i], NULL));
  }
}

static void whole_numbers_are_whole(void **state)
{
  (void)state;
  assert_true(read_sample("sample: {choice: a, whole: 1e3}\n"));
  assert_int_equal(values.whole, 1000);
  assert_false(read_sample("sample: {choice: a, whole: 0.5}\n"));
  assert_non_null(strstr(messages, "must be a whole number, found '0.5'"));
  assert_false(read_sample("sample: {choice: a, whole: 1e10}\n"));
  assert_false(read_sample("sample: {choice: a, whole: 1001}\n"));
  assert_non_null(strstr(messages, "must be -3 to 1000\n"));
}

static void the_nearest_word_is_offered(void **state)
{
  (void)state;
  static const char *const words[] = {"cell_m",
                                      "size_m",
                                      "origin_m",
                                      "gravity",
                                      "acceleration_m_s2",
                                      "contact_penalty",
                                      "contact_frictional"};
  static const char *const cases[][2] = {
      {"cel_m", "cell_m"},
      {"cell", "cell_m"},
      {"szie_m", "size_m"},
      {"gravitation", "gravity"},
      {"acceleration", "acceleration_m_s2"},
      {"contact_friction", "contact_frictional"},
      {"Gravity", "gravity"},
      {"colour", NULL},
      {"x", NULL},
      {"", NULL},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    pw_yaml_nearest nearest = {.word = cases[i][0]};
    for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
      pw_yaml_nearest_offer(&nearest, words[k]);
    }
    if (cases[i][1]) {
      assert_non_null(nearest.best);
      assert_string_equal(nearest.best, cases[i][1]);
    } else {
      assert_null(nearest.best);
    }
  }
}

static int clean_up(void **state)
{
  (void)state;
  free(messages);
  return 0;
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(defaults_are_as_written), cmocka_unit_test(values_are_stored),
      cmocka_unit_test(conditions_are_kept),     cmocka_unit_test(only_numbers_are_numbers),
      cmocka_unit_test(whole_numbers_are_whole), cmocka_unit_test(the_nearest_word_is_offered),
  };
  return cmocka_run_group_tests(tests, NULL, clean_up);
}
