/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/output_helpers.h
 * @brief Folders and files for tests of what the program writes.
 */
#ifndef PW_TESTS_OUTPUT_HELPERS_H
#define PW_TESTS_OUTPUT_HELPERS_H

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/atomic_file.h"
#include "tests/harness.h"

/** A file's bytes with a closing zero; freed by the caller. */
typedef struct test_bytes {
  char *data;
  size_t size;
} test_bytes;

/** Name of a fresh empty folder, in static storage. */
static inline const char *test_folder(void)
{
  static char name[PW_PATH];
  const char *base = getenv("TMPDIR");
  snprintf(name, sizeof name, "%s/pilewright-test-XXXXXX", base ? base : "/tmp");
  assert_non_null(mkdtemp(name));
  return name;
}

/** FOLDER/NAME in one of eight static buffers. */
static inline const char *test_path(const char *folder, const char *name)
{
  static char path[8][PW_PATH];
  static int next;
  next = (next + 1) % 8;
  assert_ok(pw_path_join(folder, name, path[next]));
  return path[next];
}

static inline bool test_exists(const char *path)
{
  return access(path, F_OK) == 0;
}

static inline test_bytes test_read(const char *path)
{
  test_bytes b = {NULL, 0};
  struct stat info;
  FILE *file = fopen(path, "rb");
  if (!file || fstat(fileno(file), &info) != 0) {
    fail_msg("cannot read %s", path);
  }
  b.size = (size_t)info.st_size;
  b.data = calloc(b.size + 1, 1);
  assert_non_null(b.data);
  assert_int_equal(fread(b.data, 1, b.size, file), b.size);
  fclose(file);
  return b;
}

/** Two files have the same bytes. */
static inline void test_same_files(const char *first, const char *second)
{
  test_bytes one = test_read(first), two = test_read(second);
  assert_int_equal(one.size, two.size);
  assert_memory_equal(one.data, two.data, one.size);
  free(one.data);
  free(two.data);
}

static inline void test_write(const char *path, const void *bytes, size_t size)
{
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
}

static inline void test_remove_folder(const char *folder)
{
  char command[PW_PATH + 16];
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  assert_int_equal(system(command), 0);
}

/** The last error's text must hold @p part. */
static inline void assert_error_says(const char *part)
{
  if (!strstr(pw_error_text(), part)) {
    fail_msg("the error text \"%s\" lacks \"%s\"", pw_error_text(), part);
  }
}

#endif /* PW_TESTS_OUTPUT_HELPERS_H */
