/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A damaged scene never crashes the reader: it reads it, or says what is wrong with it. */
#include "tests/harness.h"

#include <stdlib.h>

#include "io/scene_file.h"

enum { LARGEST = 1 << 14, MUTANTS = 2000 };

static char good[LARGEST];
static size_t length;

static int load(void **state)
{
  (void)state;
  FILE *file = fopen("scenes/good_pile.yaml", "rb");
  if (!file) {
    return -1;
  }
  length = fread(good, 1, sizeof good, file);
  fclose(file);
  return length > 2000 && length < LARGEST ? 0 : -1;
}

/* @return whether the text is a good scene. */
static bool read_damaged(const char *text, size_t n)
{
  static pw_scene scene;
  char *copy = malloc(n + 1), *messages = NULL; /* a block of its own, for AddressSanitizer */
  assert_non_null(copy);
  memcpy(copy, text, n);
  pw_status status = pw_scene_read_text(copy, n, "damaged", 0, NULL, &scene, &messages);
  if (status == PW_OK) {
    assert_null(messages);
    assert_ok(pw_scene_check(&scene)); /* nothing may pass the reader that the engine refuses */
  } else {
    assert_int_equal(status, PW_ERR_SCENE);
    assert_non_null(messages);
    assert_non_null(strstr(messages, "damaged:"));
    assert_non_null(strstr(messages, ": error: "));
  }
  free(messages);
  free(copy);
  return status == PW_OK;
}

static void any_bytes_may_change(void **state)
{
  (void)state;
  static const char likely[] = " \t\n\r:-[]{}#,\"'&*!|>%@?0123456789.eE+\\~\xc2\x85\xff";
  uint64_t seed = 2024;
  int fine = 0;
  for (int i = 0; i < MUTANTS; i++) {
    char text[LARGEST];
    memcpy(text, good, length);
    int changes = 1 + (int)(4 * test_random(&seed));
    for (int c = 0; c < changes; c++) {
      size_t at = (size_t)((double)length * test_random(&seed));
      bool listed = test_random(&seed) < 0.7;
      double pick = test_random(&seed);
      text[at] = listed ? likely[(size_t)((double)(sizeof likely - 1) * pick)]
                        : (char)(unsigned char)(256 * pick);
    }
    fine += read_damaged(text, length);
  }
  /* some changes fall into comments or digits, most do harm */
  assert_in_range(fine, MUTANTS / 50, MUTANTS / 2);
}

static void any_part_may_be_cut_out(void **state)
{
  (void)state;
  uint64_t seed = 7;
  for (int i = 0; i < MUTANTS / 4; i++) {
    char text[LARGEST];
    size_t at = (size_t)((double)length * test_random(&seed));
    size_t n = (size_t)((double)(length - at) * test_random(&seed) * test_random(&seed));
    memcpy(text, good, at);
    memcpy(text + at, good + at + n, length - at - n);
    read_damaged(text, length - n);
  }
}

static void the_file_may_end_at_any_byte(void **state)
{
  (void)state;
  int fine = 0;
  for (size_t n = 0; n <= length; n++) {
    fine += read_damaged(good, n);
  }
  assert_true(fine > 0);
  assert_true(read_damaged(good, length));
  /* in front of the first key of a body, say, the scene cannot be whole */
  const char *bodies = strstr(good, "bodies:");
  assert_non_null(bodies);
  assert_false(read_damaged(good, (size_t)(bodies - good)));
}

static void very_large_input_is_refused(void **state)
{
  (void)state;
  size_t n = (size_t)3 << 20;
  char *text = malloc(n);
  assert_non_null(text);
  memset(text, '[', n);
  assert_false(read_damaged(text, n));
  assert_false(read_damaged(text, 100000));
  memset(text, ' ', n);
  assert_false(read_damaged(text, 100000));
  for (size_t i = 0; i + 4 <= n; i += 4) {
    memcpy(text + i, "a: \n", 4);
  }
  assert_false(read_damaged(text, 400000));
  free(text);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(any_bytes_may_change),
      cmocka_unit_test(any_part_may_be_cut_out),
      cmocka_unit_test(the_file_may_end_at_any_byte),
      cmocka_unit_test(very_large_input_is_refused),
  };
  return cmocka_run_group_tests(tests, load, NULL);
}
