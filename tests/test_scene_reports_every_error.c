/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every bad scene of tests/scenes/bad says in comments which errors it holds, as
 *   # expect: LINE:COLUMN: the start of the message
 * ("$" at the end: the whole message). The reader must report these, in this order, and no
 * others; under each stand the source line and a caret in that column. */
#include "tests/harness.h"

#include <dirent.h>
#include <stdlib.h>

#include "io/scene_file.h"

enum { LINE = 512 };

static const char folder[] = "scenes/bad";

static char *read_messages(const char *path, pw_status expected)
{
  static pw_scene scene, before;
  char *messages = NULL;
  memset(&scene, 0x5a, sizeof scene);
  before = scene;
  assert_int_equal(pw_scene_read_file(path, 0, NULL, &scene, &messages), expected);
  assert_non_null(messages);
  assert_memory_equal(&scene, &before, sizeof scene);
  return messages;
}

/* Next line of @p at into @p line; false at the end. */
static bool next_line(const char **at, char *line)
{
  size_t n = strcspn(*at, "\n");
  if (**at == '\0') {
    return false;
  }
  assert_true(n < LINE);
  memcpy(line, *at, n);
  line[n] = '\0';
  *at += n;
  *at += **at == '\n';
  return true;
}

/* The message that starts at @p at is the expected one, with its source line and caret. */
static void check_message(const char *path, const char *expect, const char **at)
{
  char line[LINE], source[LINE], caret[LINE], head[3 * LINE];
  int row = 0, column = 0, n = 0;
  assert_int_equal(sscanf(expect, "%d:%d: %n", &row, &column, &n), 2);
  const char *text = expect + n;
  bool whole = text[strlen(text) - 1] == '$';
  size_t length = strlen(text) - whole;
  if (!next_line(at, line) || !next_line(at, source) || !next_line(at, caret)) {
    fail_msg("%s: not reported: %s", path, expect);
  }
  snprintf(head, sizeof head, "%s:%d:%d: error: ", path, row, column);
  if (strncmp(line, head, strlen(head)) != 0 || strncmp(line + strlen(head), text, length) != 0 ||
      (whole && line[strlen(head) + length] != '\0')) {
    fail_msg("reported: %s\nexpected: %s%s", line, head, text);
  }
  size_t at_caret = strspn(caret, " \t");
  assert_string_equal(caret + at_caret, "^");
  assert_true(column > 80 || at_caret == (size_t)column + 1);
}

static void check_file(const char *name)
{
  char path[2 * LINE], line[LINE];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  char *messages = read_messages(path, PW_ERR_SCENE);
  const char *at = messages;
  int expected = 0;
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  while (fgets(line, sizeof line, file)) {
    line[strcspn(line, "\n")] = '\0';
    if (strncmp(line, "# expect: ", 10) == 0) {
      check_message(path, line + 10, &at);
      expected++;
    }
  }
  fclose(file);
  assert_true(expected > 0);
  if (*at) {
    fail_msg("%s: not expected: %s", path, at);
  }
  free(messages);
}

static void every_bad_scene_gets_its_errors(void **state)
{
  (void)state;
  DIR *dir = opendir(folder);
  assert_non_null(dir);
  int files = 0;
  for (struct dirent *entry = readdir(dir); entry; entry = readdir(dir)) {
    if (strstr(entry->d_name, ".yaml")) {
      check_file(entry->d_name);
      files++;
    }
  }
  closedir(dir);
  assert_true(files >= 70);
}

static void a_message_looks_like_this(void **state)
{
  (void)state;
  char *messages = read_messages("scenes/bad/unknown_key.yaml", PW_ERR_SCENE);
  assert_string_equal(messages, "scenes/bad/unknown_key.yaml:4:24: error: unknown key 'cel_m' in "
                                "grid; did you mean 'cell_m'?\n"
                                "  grid: {size_m: [2, 2], cel_m: 0.1}\n"
                                "                         ^\n");
  free(messages);
}

static void files_that_cannot_be_read_are_named(void **state)
{
  (void)state;
  char *messages = read_messages("scenes/absent.yaml", PW_ERR_FILE);
  assert_string_equal(messages,
                      "scenes/absent.yaml: error: cannot read it: No such file or directory\n");
  free(messages);
  messages = read_messages("scenes", PW_ERR_FILE);
  assert_string_equal(messages, "scenes: error: cannot read it: Is a directory\n");
  free(messages);
}

static char *text_messages(const char *text, size_t length)
{
  static pw_scene scene;
  char *messages = NULL;
  assert_int_equal(pw_scene_read_text(text, length, "text", 0, NULL, &scene, &messages),
                   PW_ERR_SCENE);
  assert_non_null(messages);
  return messages;
}

static void bytes_that_are_no_text_are_placed(void **state)
{
  (void)state;
  char *messages = text_messages("geometry: a\ngrid: \xff\n", 21);
  assert_non_null(strstr(messages, "text:2:7: error: not a text file in UTF-8"));
  free(messages);
  messages = text_messages("geometry:\0 a\n", 13);
  assert_non_null(strstr(messages, "text:1:10: error: not a text file in UTF-8"));
  free(messages);
  messages = text_messages("", 0);
  assert_non_null(strstr(messages, "text:1:1: error: the file is empty"));
  free(messages);
}

/* Columns count characters, not bytes: the caret stands under the value. */
static void columns_count_characters(void **state)
{
  (void)state;
  static const char text[] = "title: {\"h\xc3\xb6he \xe2\x88\x9e\": 1}\n";
  char *messages = text_messages(text, sizeof text - 1);
  assert_non_null(strstr(messages, "text:1:8: error: 'title' must be text, found a mapping\n"
                                   "  title: {\"h\xc3\xb6he \xe2\x88\x9e\": 1}\n"
                                   "         ^\n"));
  free(messages);
  static const char wide[] = "gravity: {\xc3\xa4\xc3\xb6: 1, ramp_s: no}\n";
  messages = text_messages(wide, sizeof wide - 1);
  assert_non_null(strstr(messages, "text:1:26: error: 'ramp_s' must be a number"));
  free(messages);
}

/* More errors than are kept are counted. */
static void very_many_errors_are_counted(void **state)
{
  (void)state;
  char text[8192];
  size_t n = 0;
  for (int i = 0; i < 300; i++) {
    n += (size_t)snprintf(text + n, sizeof text - n, "key%d: 1\n", i);
  }
  char *messages = text_messages(text, n);
  assert_non_null(strstr(messages, "text:50:1: error: unknown key 'key49' in the scene"));
  /* 300 unknown keys; geometry, grid, time, materials and bodies are missing; 100 are shown */
  assert_non_null(strstr(messages, "text: 205 further errors are not shown\n"));
  free(messages);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_bad_scene_gets_its_errors),
      cmocka_unit_test(a_message_looks_like_this),
      cmocka_unit_test(files_that_cannot_be_read_are_named),
      cmocka_unit_test(bytes_that_are_no_text_are_placed),
      cmocka_unit_test(columns_count_characters),
      cmocka_unit_test(very_many_errors_are_counted),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
