/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A checkpoint gives back every bit it was given, equal states give equal files, and a file that
 * is not a whole checkpoint of the same state is refused with its name and the reason. */
#include <hdf5.h>

#include "io/restart.h"
#include "tests/output_helpers.h"

enum { N = 1000 };

typedef struct state {
  pw_real stress[6 * N], lone[1];
  pw_idx id[N];
  pw_off count[3];
  int n;             /* values of id to visit */
  bool extra, lacks; /* one array more or less */
  bool swapped;      /* id is visited as offsets */
} state;

static const pw_restart_stamp stamp = {.title = "a test", .time_s = 0.1, .step = 42};

static pw_status walk(pw_archive *ar, void *ctx)
{
  state *s = ctx;
  PW_TRY(ar->real(ar, "points/stress", s->stress, 6 * N));
  if (s->swapped) {
    PW_TRY(ar->offset(ar, "points/id", s->count, 3));
  } else {
    PW_TRY(ar->index(ar, "points/id", s->id, s->n));
  }
  PW_TRY(ar->real(ar, "contact/pile/tip/force", s->lone, 1));
  PW_TRY(ar->real(ar, "contact/nothing", NULL, 0));
  if (s->extra) {
    PW_TRY(ar->real(ar, "points/extra", s->lone, 1));
  }
  return s->lacks ? PW_OK : ar->offset(ar, "counts", s->count, 3);
}

static void fill(state *s, uint64_t seed)
{
  memset(s, 0, sizeof *s);
  s->n = N;
  for (int i = 0; i < 6 * N; i++) {
    s->stress[i] = (test_random(&seed) - 0.5) * 1e6;
  }
  s->stress[0] = -0.0;
  s->stress[1] = NAN;
  s->stress[2] = -INFINITY;
  s->stress[3] = 4.9406564584124654e-324; /* smallest subnormal number */
  s->lone[0] = 0.1 + 0.2;
  for (int i = 0; i < N; i++) {
    s->id[i] = (pw_idx)(test_random(&seed) * 2e9) * (i % 2 ? 1 : -1);
  }
  s->count[0] = INT64_MAX;
  s->count[1] = INT64_MIN;
  s->count[2] = 7;
}

static const char *folder, *file;

static int set_up(void **unused)
{
  (void)unused;
  static char name[PW_PATH];
  folder = test_folder();
  snprintf(name, sizeof name, "%s", test_path(folder, "checkpoint.h5"));
  file = name;
  return 0;
}

static int tear_down(void **unused)
{
  (void)unused;
  test_remove_folder(folder);
  return 0;
}

static void every_bit_returns(void **unused)
{
  (void)unused;
  static state a, b;
  pw_restart_stamp found;
  fill(&a, 1);
  memset(&b, 0xff, sizeof b);
  b.n = N;
  b.extra = b.lacks = b.swapped = false;
  assert_ok(pw_archive_write(file, &stamp, walk, &a));
  assert_ok(pw_archive_read(file, walk, &b));
  assert_memory_equal(a.stress, b.stress, sizeof a.stress);
  assert_memory_equal(a.lone, b.lone, sizeof a.lone);
  assert_memory_equal(a.id, b.id, sizeof a.id);
  assert_memory_equal(a.count, b.count, sizeof a.count);
  assert_ok(pw_restart_peek(file, &found));
  assert_string_equal(found.title, "a test");
  assert_true(found.time_s == 0.1);
  assert_int_equal(found.step, 42);
}

static void equal_states_give_equal_bytes(void **unused)
{
  (void)unused;
  static state a;
  fill(&a, 2);
  assert_ok(pw_archive_write(file, &stamp, walk, &a));
  test_bytes first = test_read(file);
  sleep(1); /* a time kept in the file would now be another one */
  assert_ok(pw_archive_write(file, &stamp, walk, &a));
  test_bytes second = test_read(file);
  assert_int_equal(first.size, second.size);
  assert_memory_equal(first.data, second.data, first.size);
  a.stress[5 * N] = nextafter(a.stress[5 * N], 1e9);
  assert_ok(pw_archive_write(file, &stamp, walk, &a));
  test_bytes third = test_read(file);
  assert_int_equal(first.size, third.size);
  assert_memory_not_equal(first.data, third.data, first.size);
  free(first.data);
  free(second.data);
  free(third.data);
}

static void expect_refusal(state *s, const char *reason)
{
  pw_error_clear();
  assert_int_equal(pw_archive_read(file, walk, s), PW_ERR_FILE);
  assert_error_says(file);
  assert_error_says(reason);
}

static void another_scene_is_refused(void **unused)
{
  (void)unused;
  static state a, b;
  fill(&a, 3);
  fill(&b, 3);
  assert_ok(pw_archive_write(file, &stamp, walk, &a));
  b.n = N - 1;
  expect_refusal(&b, "points/id holds 1000 values, this scene needs 999");
  b.n = N;
  b.swapped = true;
  expect_refusal(&b, "points/id holds another type");
  b.swapped = false;
  b.extra = true;
  expect_refusal(&b, "no points/extra");
  b.extra = false;
  b.lacks = true;
  expect_refusal(&b, "another scene");
}

static void another_format_is_refused(void **unused)
{
  (void)unused;
  static state a;
  const int64_t later = 2;
  fill(&a, 4);
  assert_ok(pw_archive_write(file, &stamp, walk, &a));
  hid_t h5 = H5Fopen(file, H5F_ACC_RDWR, H5P_DEFAULT);
  hid_t attribute = H5Aopen(h5, "format_version", H5P_DEFAULT);
  assert_true(H5Awrite(attribute, H5T_NATIVE_INT64, &later) >= 0);
  H5Aclose(attribute);
  H5Fclose(h5);
  expect_refusal(&a, "format version 2");
}

static void other_files_are_refused(void **unused)
{
  (void)unused;
  static state a;
  fill(&a, 5);
  expect_refusal(&a, "No such file");
  test_write(file, "time_s,step\n", 12);
  expect_refusal(&a, "not a whole checkpoint");
  test_write(file, "", 0);
  expect_refusal(&a, "not a whole checkpoint");
  hid_t h5 = H5Fcreate(file, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(h5);
  expect_refusal(&a, "not a checkpoint of this program");
}

static void every_cut_is_refused(void **unused)
{
  (void)unused;
  static state a;
  int tried = 0;
  fill(&a, 6);
  assert_ok(pw_archive_write(file, &stamp, walk, &a));
  test_bytes whole = test_read(file);
  for (size_t cut = 0; cut < whole.size; cut += cut < 600 ? 7 : 311) {
    test_write(file, whole.data, cut);
    assert_int_equal(pw_archive_read(file, walk, &a), PW_ERR_FILE);
    tried++;
  }
  test_write(file, whole.data, whole.size - 1);
  assert_int_equal(pw_archive_read(file, walk, &a), PW_ERR_FILE);
  assert_true(tried > 200);
  free(whole.data);
}

static pw_status fail_late(pw_archive *ar, void *ctx)
{
  PW_TRY(walk(ar, ctx));
  return PW_RETRY_NAN;
}

static pw_status visit_twice(pw_archive *ar, void *ctx)
{
  PW_TRY(walk(ar, ctx));
  return walk(ar, ctx);
}

static void a_failing_walk_writes_nothing(void **unused)
{
  (void)unused;
  static state a;
  fill(&a, 7);
  assert_int_equal(pw_archive_write(file, &stamp, fail_late, &a), PW_RETRY_NAN);
  assert_false(test_exists(file));
  assert_int_equal(pw_archive_write(file, &stamp, visit_twice, &a), PW_ERR_FILE);
  assert_error_says("points/stress");
  assert_false(test_exists(file));
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
  const struct CMUnitTest tests[] = {
      TEST(every_bit_returns),
      TEST(equal_states_give_equal_bytes),
      TEST(another_scene_is_refused),
      TEST(another_format_is_refused),
      TEST(other_files_are_refused),
      TEST(every_cut_is_refused),
      TEST(a_failing_walk_writes_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
