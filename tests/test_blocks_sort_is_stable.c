/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pw_blocks_sort: by (block, body), stable, without allocation; creation survives every failed
 * allocation. */
#include "tests/harness.h"

#include <stdlib.h>

#include "engine/core/mem.h"
#include "partition/blocks.h"

static const pw_idx CELLS[2] = {41, 84};

static void agrees_with_brute_force(void **state)
{
  (void)state;
  enum { N = 10400, NBODY = 3 };
  pw_idx *elem = malloc(N * sizeof *elem), *body = malloc(N * sizeof *body);
  pw_idx *from = malloc(N * sizeof *from);
  pw_blocks b = {0};
  assert_int_equal(pw_blocks_create(CELLS, NULL, 36, 1, NBODY, &b), PW_OK);
  srand(3);
  for (int i = 0; i < N; i++) {
    elem[i] = rand() % b.nelem;
    body[i] = rand() % NBODY;
  }
  pw_off count = pw_mem_count();
  assert_true(pw_blocks_sort(&b, N, elem, body, from));
  assert_int_equal(pw_mem_count(), count);
  pw_idx at = 0;
  for (pw_idx key = 0; key < b.nblock * NBODY; key++) {
    assert_int_equal(b.point_start[key], at);
    for (pw_idx i = 0; i < N; i++) {
      if (b.elem_block[elem[i]] * NBODY + body[i] == key) {
        assert_int_equal(from[at++], i);
      }
    }
  }
  assert_int_equal(b.point_start[b.nblock * NBODY], N);
  pw_blocks_destroy(&b);
  free(elem);
  free(body);
  free(from);
}

static void sorted_points_stay_where_they_are(void **state)
{
  (void)state;
  pw_blocks b = {0};
  assert_int_equal(pw_blocks_create(CELLS, NULL, 36, 1, 1, &b), PW_OK);
  pw_idx *body = calloc((size_t)b.nelem, sizeof *body);
  pw_idx *from = malloc((size_t)b.nelem * sizeof *from);
  assert_false(pw_blocks_sort(&b, b.nelem, b.elem, body, from));
  for (pw_idx i = 0; i < b.nelem; i++) {
    assert_int_equal(from[i], i);
  }
  for (pw_idx k = 0; k <= b.nblock; k++) {
    assert_int_equal(b.point_start[k], b.elem_start[k]);
  }
  assert_false(pw_blocks_sort(&b, 0, b.elem, body, from));
  assert_int_equal(b.point_start[b.nblock], 0);
  pw_blocks_destroy(&b);
  free(body);
  free(from);
}

static void every_failed_allocation_is_reported_and_leaks_nothing(void **state)
{
  (void)state;
  pw_blocks b = {0};
  pw_off held = pw_mem_bytes(), trials = 0;
  pw_status s = PW_ERR_MEMORY;
  for (pw_off nth = 1; s != PW_OK; nth++, trials++) {
    pw_mem_fail_after(nth);
    s = pw_blocks_create((pw_idx[]){12, 9}, NULL, 9, 1, 2, &b);
    pw_mem_fail_after(0);
    if (s != PW_OK) {
      assert_int_equal(s, PW_ERR_MEMORY);
      assert_int_equal(pw_mem_bytes(), held);
      assert_null(b.elem);
    }
  }
  assert_true(trials > 20);
  pw_mem_fail_after(1);
  assert_int_equal(pw_blocks_check(&b), PW_ERR_MEMORY);
  pw_mem_fail_after(0);
  pw_blocks_destroy(&b);
  assert_int_equal(pw_mem_bytes(), held);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(agrees_with_brute_force),
      cmocka_unit_test(sorted_points_stay_where_they_are),
      cmocka_unit_test(every_failed_allocation_is_reported_and_leaks_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
