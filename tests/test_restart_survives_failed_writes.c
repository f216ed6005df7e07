/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whatever happens to a write, the previous checkpoint stays whole. */
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>

#include "io/restart.h"
#include "tests/output_helpers.h"

enum { N = 200000, CHANGES = 12, MOST_KILLS = 1000 };

static const pw_restart_stamp stamp = {.title = "a test", .time_s = 1.0, .step = 1};
static pw_real values[N];

static pw_status walk(pw_archive *ar, void *ctx)
{
  return ar->real(ar, "points/stress", ctx, N);
}

static void fill(pw_real value)
{
  for (int i = 0; i < N; i++) {
    values[i] = value;
  }
}

/* The file holds N times the same number; gives it. */
static pw_real whole_content(const char *file)
{
  static pw_real found[N];
  assert_ok(pw_archive_read(file, walk, found));
  for (int i = 1; i < N; i++) {
    assert_true(found[i] == found[0]);
  }
  return found[0];
}

/* A file may grow to @p bytes at most: a write beyond fails as on a disk that is full. */
static void limit_file_size(rlim_t bytes)
{
  struct rlimit limit;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
  limit.rlim_cur = bytes;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

static void no_room_keeps_the_old_file(void **unused)
{
  (void)unused;
  const char *folder = test_folder(), *file = test_path(folder, "checkpoint.h5");
  const char *part = test_path(folder, "checkpoint.h5.part");
  fill(1.0);
  assert_ok(pw_archive_write(file, &stamp, walk, values));
  fill(2.0);
  signal(SIGXFSZ, SIG_IGN);
  for (rlim_t room = 0; room < N * sizeof *values; room += N * sizeof *values / 7) {
    limit_file_size(room);
    pw_status status = pw_archive_write(file, &stamp, walk, values);
    limit_file_size(RLIM_INFINITY);
    assert_int_equal(status, PW_ERR_FILE);
    assert_error_says(file);
    assert_error_says("File too large"); /* the system's text for EFBIG */
    assert_false(test_exists(part));
    assert_true(whole_content(file) == 1.0);
  }
  assert_ok(pw_archive_write(file, &stamp, walk, values));
  assert_true(whole_content(file) == 2.0);
  test_remove_folder(folder);
}

/* A device that is always full stands where the temporary file is written. */
static void a_full_device_keeps_the_old_file(void **unused)
{
  (void)unused;
  const char *folder = test_folder(), *file = test_path(folder, "checkpoint.h5");
  fill(1.0);
  assert_ok(pw_archive_write(file, &stamp, walk, values));
  assert_int_equal(symlink("/dev/full", test_path(folder, "checkpoint.h5.part")), 0);
  fill(2.0);
  assert_int_equal(pw_archive_write(file, &stamp, walk, values), PW_ERR_FILE);
  assert_error_says("No space left on device");
  assert_true(whole_content(file) == 1.0);
  test_remove_folder(folder);
}

static void an_unusable_folder_is_named(void **unused)
{
  (void)unused;
  const char *folder = test_folder(), *file = test_path(folder, "plain");
  const char *below = test_path(file, "checkpoint.h5");
  test_write(file, "x", 1);
  assert_int_equal(pw_archive_write(below, &stamp, walk, values), PW_ERR_FILE);
  assert_error_says(below);
  assert_error_says("Not a directory");
  assert_int_equal(pw_archive_write("/nowhere/checkpoint.h5", &stamp, walk, values), PW_ERR_FILE);
  assert_error_says("No such file or directory");
  test_remove_folder(folder);
}

/* Write 2, 3, 4 ... until killed. */
static void write_for_ever(const char *file)
{
  for (pw_real value = 2.0;; value += 1.0) {
    fill(value);
    if (pw_archive_write(file, &stamp, walk, values) != PW_OK) {
      _exit(1);
    }
  }
}

static void a_killed_write_keeps_a_whole_file(void **unused)
{
  (void)unused;
  const char *folder = test_folder(), *file = test_path(folder, "checkpoint.h5");
  uint64_t seed = 11;
  int changed = 0;
  pw_real longest = 5e6; /* ns; grows until children get as far as a rename on this machine */
  fill(1.0);
  assert_ok(pw_archive_write(file, &stamp, walk, values));
  for (int k = 0; k < MOST_KILLS && changed < CHANGES; k++) {
    pw_real before = whole_content(file);
    int state;
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
      write_for_ever(file);
    }
    struct timespec pause = {0, (long)(longest * test_random(&seed))};
    nanosleep(&pause, NULL);
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_int_equal(waitpid(child, &state, 0), child);
    assert_true(WIFSIGNALED(state) && WTERMSIG(state) == SIGKILL);
    if (whole_content(file) != before) {
      changed++;
    } else {
      longest = pw_min(1.1 * longest, 9e8);
    }
  }
  assert_int_equal(changed, CHANGES);
  test_remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_room_keeps_the_old_file),
      cmocka_unit_test(a_full_device_keeps_the_old_file),
      cmocka_unit_test(an_unusable_folder_is_named),
      cmocka_unit_test(a_killed_write_keeps_a_whole_file),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
