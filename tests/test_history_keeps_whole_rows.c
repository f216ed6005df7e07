/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A history holds whole rows only, goes on after a restart where the checkpoint stands, and a row
 * that finds no room is taken back. */
#include <signal.h>
#include <sys/resource.h>

#include "io/history.h"
#include "tests/output_helpers.h"

static const char *folder, *file;

static int set_up(void **unused)
{
  (void)unused;
  static char name[PW_PATH];
  folder = test_folder();
  snprintf(name, sizeof name, "%s", test_path(folder, "history.csv"));
  file = name;
  return 0;
}

static int tear_down(void **unused)
{
  (void)unused;
  test_remove_folder(folder);
  return 0;
}

static pw_record row(pw_real time, pw_off step, pw_real value)
{
  pw_record r = {.n = 0};
  pw_record_put(&r, "time_s", time);
  pw_record_put(&r, "step", (pw_real)step);
  pw_record_put(&r, "penetration_m", value);
  return r;
}

static void expect_file(const char *text)
{
  test_bytes b = test_read(file);
  assert_string_equal(b.data, text);
  free(b.data);
}

/* Rows of steps 0, 10, 20, 30 at 0.1 s each. */
static void write_four(void)
{
  pw_history *h = NULL;
  pw_record first = row(0.0, 0, 0.0);
  assert_ok(pw_history_open(file, &first, &h));
  for (int k = 0; k < 4; k++) {
    pw_record r = row(0.1 * k, 10 * k, 1.0 / 3.0 * k);
    assert_ok(pw_history_append(h, &r));
  }
  assert_ok(pw_history_sync(h));
  assert_ok(pw_history_close(&h));
  assert_null(h);
}

static void rows_stand_as_written(void **unused)
{
  (void)unused;
  write_four();
  expect_file("time_s,step,penetration_m\n0,0,0\n0.1,10,0.333333333\n0.2,20,0.666666667\n"
              "0.3,30,1\n");
}

static void every_row_is_in_the_file_at_once(void **unused)
{
  (void)unused;
  pw_history *h = NULL;
  pw_record r = row(0.0, 123456789012, -NAN);
  assert_ok(pw_history_open(file, &r, &h));
  expect_file("time_s,step,penetration_m\n");
  assert_ok(pw_history_append(h, &r));
  expect_file("time_s,step,penetration_m\n0,123456789012,nan\n");
  assert_ok(pw_history_close(&h));
}

static void resuming_drops_later_rows(void **unused)
{
  (void)unused;
  pw_history *h = NULL;
  write_four();
  FILE *f = fopen(file, "a");
  fputs("0.4,4", f); /* a row cut short */
  fclose(f);
  pw_record r = row(0.25, 25, 0.5);
  assert_ok(pw_history_resume(file, &r, 20, &h));
  assert_ok(pw_history_append(h, &r));
  assert_ok(pw_history_close(&h));
  expect_file("time_s,step,penetration_m\n0,0,0\n0.1,10,0.333333333\n0.2,20,0.666666667\n"
              "0.25,25,0.5\n");
}

static void resuming_drops_a_row_cut_short(void **unused)
{
  (void)unused;
  pw_history *h = NULL;
  pw_record r = row(0.0, 0, 0.0);
  const char cut[] = "time_s,step,penetration_m\n0,0,0\n0.1,10,0.33";
  test_write(file, cut, strlen(cut));
  assert_ok(pw_history_resume(file, &r, 10, &h));
  assert_ok(pw_history_close(&h));
  expect_file("time_s,step,penetration_m\n0,0,0\n");
}

static void resuming_without_a_file_starts_one(void **unused)
{
  (void)unused;
  pw_history *h = NULL;
  pw_record r = row(0.25, 25, 0.5);
  assert_ok(pw_history_resume(file, &r, 20, &h));
  assert_ok(pw_history_close(&h));
  expect_file("time_s,step,penetration_m\n");
}

static void other_columns_are_refused(void **unused)
{
  (void)unused;
  pw_history *h = NULL;
  pw_real list[2] = {1.0, 2.0};
  write_four();
  pw_record r = row(0.0, 0, 0.0);
  pw_record_put(&r, "force_n", 1.0);
  assert_int_equal(pw_history_resume(file, &r, 20, &h), PW_ERR_FILE);
  assert_error_says(file);
  assert_null(h);
  r = row(0.0, 0, 0.0);
  assert_ok(pw_history_open(file, &r, &h));
  pw_record_put(&r, "force_n", 1.0);
  assert_int_equal(pw_history_append(h, &r), PW_ERR_ARGUMENT);
  assert_ok(pw_history_close(&h));
  r = row(0.0, 0, 0.0);
  pw_record_put_array(&r, "set_per_blow_m", list, 2);
  assert_int_equal(pw_history_open(file, &r, &h), PW_ERR_ARGUMENT);
  r.n = 1;
  assert_int_equal(pw_history_open(file, &r, &h), PW_ERR_ARGUMENT);
}

static void a_row_without_room_is_taken_back(void **unused)
{
  (void)unused;
  struct rlimit limit;
  pw_history *h = NULL;
  write_four();
  test_bytes before = test_read(file);
  pw_record r = row(0.4, 40, 1.0 / 7.0);
  assert_ok(pw_history_resume(file, &r, 30, &h));
  signal(SIGXFSZ, SIG_IGN);
  getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = before.size + 5;
  setrlimit(RLIMIT_FSIZE, &limit);
  pw_status status = pw_history_append(h, &r);
  limit.rlim_cur = RLIM_INFINITY;
  setrlimit(RLIMIT_FSIZE, &limit);
  assert_int_equal(status, PW_ERR_FILE);
  assert_error_says(file);
  expect_file(before.data);
  assert_ok(pw_history_append(h, &r));
  assert_ok(pw_history_close(&h));
  test_bytes after = test_read(file);
  assert_memory_equal(after.data, before.data, before.size);
  assert_string_equal(after.data + before.size, "0.4,40,0.142857143\n");
  free(before.data);
  free(after.data);
}

/* What has no room is counted, so that a run can be refused before it loses columns. */
static void puts_without_room_are_counted(void **unused)
{
  (void)unused;
  pw_record r = row(0.0, 0, 0.0);
  assert_int_equal(r.asked, 3);
  for (int k = 3; k < PW_RECORD_MAX + 7; k++) {
    pw_record_put(&r, "load_n", k);
  }
  assert_int_equal(r.n, PW_RECORD_MAX);
  assert_int_equal(r.asked, PW_RECORD_MAX + 7);
  r.n = 0;
  pw_record_put(&r, "load_n", 1.0);
  assert_int_equal(r.asked, 1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
  const struct CMUnitTest tests[] = {
      TEST(rows_stand_as_written),
      TEST(every_row_is_in_the_file_at_once),
      TEST(resuming_drops_later_rows),
      TEST(resuming_drops_a_row_cut_short),
      TEST(resuming_without_a_file_starts_one),
      TEST(other_columns_are_refused),
      TEST(a_row_without_room_is_taken_back),
      TEST(puts_without_room_are_counted),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
