/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every allocation of reading a scene and of creating its simulation fails once, the first, the
 * second and so on until none is left to fail: each failure is reported as PW_ERR_MEMORY, and what
 * was allocated before it is freed. The reader's allocations, those of libyaml among them, are
 * made by the C library, so this program puts itself before it and counts what is held; the
 * simulation's go through engine/core/mem.h, which counts itself. */
#include "tests/harness.h"

#include <stdlib.h>

#include "engine/core/mem.h"
#include "engine/sim.h"
#include "io/scene_file.h"

enum { LARGEST = 1 << 14, FAR = 100000 };

/* Between arm() and disarm() allocations are counted, and number fail_at fails. */
static struct {
  bool armed;
  long made, held, fail_at;
} watch;

/* Sanitizers and other C libraries have their own ways: there nothing is put before them. */
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PW_OWN_ALLOCATION 1
#else
#define PW_OWN_ALLOCATION 0
#endif

#if PW_OWN_ALLOCATION
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void __libc_free(void *block);

static bool refused(void)
{
  return watch.armed && ++watch.made == watch.fail_at;
}

static void *counted(void *block)
{
  watch.held += watch.armed && block;
  return block;
}

void *malloc(size_t size)
{
  return refused() ? NULL : counted(__libc_malloc(size));
}

void *calloc(size_t count, size_t size)
{
  return refused() ? NULL : counted(__libc_calloc(count, size));
}

void *realloc(void *block, size_t size)
{
  if (refused()) {
    return NULL;
  }
  void *moved = __libc_realloc(block, size);
  return block ? moved : counted(moved);
}

void free(void *block)
{
  watch.held -= watch.armed && block;
  __libc_free(block);
}
#endif

static void arm(long fail_at)
{
  watch.made = watch.held = 0;
  watch.fail_at = fail_at;
  watch.armed = true;
}

static void disarm(void)
{
  watch.armed = false;
}

static const char *const names[] = {"scenes/good_pile.yaml",        "scenes/small_penalty.yaml",
                                    "scenes/small_frictional.yaml", "scenes/small_elastic.yaml",
                                    "scenes/small_corner.yaml",     "scenes/bad/eight_errors.yaml"};

static size_t load(const char *name, char *text)
{
  FILE *file = fopen(name, "rb");
  assert_non_null(file);
  size_t length = fread(text, 1, LARGEST, file);
  fclose(file);
  assert_in_range(length, 1, LARGEST - 1);
  return length;
}

/* @return allocations of a read in which none fails. */
static long read_with_failures(const char *name, pw_status without)
{
  static char text[LARGEST];
  static pw_scene scene;
  static const char *const set[] = {"time.cfl=0.3", "title='set here'"};
  size_t length = load(name, text);
  for (long k = 1; k < FAR; k++) {
    char *messages = NULL;
    arm(k);
    pw_status status = pw_scene_read_text(text, length, name, 2, set, &scene, &messages);
    bool failed = watch.made >= k;
    if (failed) {
      assert_null(messages);
    }
    free(messages);
    disarm();
    assert_int_equal(watch.held, 0);
    if (!failed) {
      assert_int_equal(status, without);
      return k - 1;
    }
    if (status != PW_ERR_MEMORY) {
      fail_msg("%s: allocation %ld failed, the status is '%s'", name, k, pw_status_text(status));
    }
  }
  fail_msg("%s: reading does not end", name);
  return 0;
}

static void reader_reports_every_failure(void **state)
{
  (void)state;
  if (!PW_OWN_ALLOCATION) {
    skip();
  }
  for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
    bool bad = strstr(names[k], "bad/") != NULL;
    long made = read_with_failures(names[k], bad ? PW_ERR_SCENE : PW_OK);
    print_message("%s: %ld allocations\n", names[k], made);
    assert_true(made > 100);
  }
}

static void simulation_reports_every_failure(void **state)
{
  (void)state;
  static char text[LARGEST];
  static pw_scene scene;
  for (size_t k = 1; strstr(names[k], "bad/") == NULL; k++) {
    char *messages = NULL;
    size_t length = load(names[k], text);
    assert_ok(pw_scene_read_text(text, length, names[k], 0, NULL, &scene, &messages));
    scene.method.mass_terms = strstr(names[k], "penalty") ? 2 : 1;
    const pw_off before = pw_mem_bytes();
    pw_status status = PW_ERR_MEMORY;
    pw_off nth = 0;
    while (status == PW_ERR_MEMORY && nth < FAR) {
      pw_sim *sim = NULL;
      pw_mem_fail_after(++nth);
      status = pw_sim_create(&scene, 1, &sim);
      pw_mem_fail_after(0);
      assert_true((sim != NULL) == (status == PW_OK));
      pw_sim_destroy(&sim);
      assert_int_equal(pw_mem_bytes(), before);
    }
    print_message("%s: %lld allocations\n", names[k], (long long)nth - 1);
    assert_int_equal(status, PW_OK);
    assert_true(nth > 20);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(reader_reports_every_failure),
      cmocka_unit_test(simulation_reports_every_failure),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
