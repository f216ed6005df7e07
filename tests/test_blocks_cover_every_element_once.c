/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every element is in one block, blocks are connected and of even weight, lists agree, and equal
 * input gives equal blocks. */
#include "tests/harness.h"

#include <stdlib.h>

#include "partition/blocks.h"

static const pw_idx GRIDS[][2] = {{1, 1}, {1, 37}, {41, 84}, {100, 100}, {3, 2}};
enum { NGRID = sizeof GRIDS / sizeof GRIDS[0] };

static void check_lists(const pw_blocks *b)
{
  char *seen = calloc((size_t)b->nelem, 1);
  assert_int_equal(b->elem_start[0], 0);
  assert_int_equal(b->elem_start[b->nblock], b->nelem);
  for (pw_idx k = 0; k < b->nblock; k++) {
    assert_true(b->elem_start[k + 1] > b->elem_start[k]); /* no block is empty */
    for (pw_idx l = b->elem_start[k]; l < b->elem_start[k + 1]; l++) {
      pw_idx e = b->elem[l];
      assert_in_range(e, 0, b->nelem - 1);
      assert_int_equal(seen[e]++, 0);
      assert_int_equal(b->elem_block[e], k);
      assert_true(l == b->elem_start[k] || b->elem[l - 1] < e);
    }
    assert_true(k == 0 || b->elem[b->elem_start[k - 1]] < b->elem[b->elem_start[k]]);
  }
  free(seen);
  pw_idx listed = 0;
  assert_int_equal(b->colour_start[b->ncolour], b->nblock);
  for (pw_idx c = 0; c < b->ncolour; c++) {
    assert_true(b->colour_start[c + 1] > b->colour_start[c]);
    for (pw_idx l = b->colour_start[c]; l < b->colour_start[c + 1]; l++, listed++) {
      assert_int_equal(b->colour[b->colour_block[l]], c);
      assert_true(l == b->colour_start[c] || b->colour_block[l - 1] < b->colour_block[l]);
    }
  }
  assert_int_equal(listed, b->nblock);
}

/* Pieces a block falls into when its elements are joined across faces. */
static pw_idx pieces(const pw_blocks *b, pw_idx k)
{
  pw_idx first = b->elem_start[k], n = b->elem_start[k + 1] - first, found = 0, nx = b->cells[0];
  char *done = calloc((size_t)b->nelem, 1);
  pw_idx *stack = malloc((size_t)b->nelem * 4 * sizeof *stack);
  for (pw_idx l = 0; l < n; l++) {
    pw_idx top = 0;
    stack[top++] = b->elem[first + l];
    found += !done[b->elem[first + l]];
    while (top > 0) {
      pw_idx e = stack[--top];
      if (done[e]) {
        continue;
      }
      done[e] = 1;
      const pw_idx next[4] = {e % nx > 0 ? e - 1 : -1, e % nx < nx - 1 ? e + 1 : -1,
                              e >= nx ? e - nx : -1, e + nx < b->nelem ? e + nx : -1};
      for (int f = 0; f < 4; f++) {
        if (next[f] >= 0 && b->elem_block[next[f]] == k && !done[next[f]]) {
          stack[top++] = next[f];
        }
      }
    }
  }
  free(done);
  free(stack);
  return found;
}

static void every_element_is_in_one_block(void **state)
{
  (void)state;
  for (int g = 0; g < NGRID; g++) {
    for (pw_idx per_block = 1; per_block <= 64; per_block *= 4) {
      if (per_block == 1 && g > 1) {
        continue;
      }
      pw_blocks b = {0};
      assert_int_equal(pw_blocks_create(GRIDS[g], NULL, per_block, 1, 2, &b), PW_OK);
      check_lists(&b);
      assert_int_equal(b.nelem, GRIDS[g][0] * GRIDS[g][1]);
      assert_true(b.nblock <= b.nelem / per_block + 1);
      pw_blocks_destroy(&b);
      assert_null(b.elem);
    }
  }
}

static void fewer_elements_than_a_block_make_one_block(void **state)
{
  (void)state;
  pw_blocks b = {0};
  assert_int_equal(pw_blocks_create((pw_idx[]){5, 3}, NULL, 16, 1, 1, &b), PW_OK);
  assert_int_equal(b.nblock, 1);
  assert_int_equal(b.ncolour, 1);
  pw_blocks_destroy(&b);
}

/* Largest and smallest weight of a block (1 + points of its elements) against the mean. */
static void check_weights(const pw_blocks *b, const pw_idx *weight)
{
  double total = 0;
  for (pw_idx e = 0; e < b->nelem; e++) {
    total += 1 + (weight ? weight[e] : 0);
  }
  for (pw_idx k = 0; k < b->nblock; k++) {
    double sum = 0;
    for (pw_idx l = b->elem_start[k]; l < b->elem_start[k + 1]; l++) {
      sum += 1 + (weight ? weight[b->elem[l]] : 0);
    }
    assert_true(sum * b->nblock < 2 * total);
    assert_true(2 * sum * b->nblock > total);
  }
}

static void blocks_have_even_weight_and_are_connected(void **state)
{
  (void)state;
  srand(7);
  pw_idx *weight = malloc(10000 * sizeof *weight);
  for (int e = 0; e < 10000; e++) {
    weight[e] = rand() % 17;
  }
  for (int g = 2; g <= 3; g++) {
    for (int weighted = 0; weighted < 2; weighted++) {
      pw_blocks b = {0};
      assert_int_equal(pw_blocks_create(GRIDS[g], weighted ? weight : NULL, 32, 1, 2, &b), PW_OK);
      check_lists(&b);
      check_weights(&b, weighted ? weight : NULL);
      for (pw_idx k = 0; k < b.nblock; k++) {
        assert_int_equal(pieces(&b, k), 1);
      }
      pw_blocks_destroy(&b);
    }
  }
  free(weight);
}

static void equal_input_gives_equal_blocks(void **state)
{
  (void)state;
  pw_blocks a = {0}, b = {0};
  assert_int_equal(pw_blocks_create(GRIDS[2], NULL, 36, 1, 2, &a), PW_OK);
  (void)rand();
  assert_int_equal(pw_blocks_create(GRIDS[2], NULL, 36, 1, 2, &b), PW_OK);
  assert_int_equal(a.nblock, b.nblock);
  assert_int_equal(a.ncolour, b.ncolour);
  assert_memory_equal(a.elem_block, b.elem_block, (size_t)a.nelem * sizeof *a.elem_block);
  assert_memory_equal(a.colour, b.colour, (size_t)a.nblock * sizeof *a.colour);
  pw_blocks_destroy(&a);
  pw_blocks_destroy(&b);
}

static void size_comes_from_the_grid_alone(void **state)
{
  (void)state;
  for (pw_idx n = 1; n < 1 << 20; n = 2 * n + 1) {
    pw_idx size = pw_blocks_choose_size(n, 1);
    assert_in_range(size, 8, 256);
    assert_int_equal(size, pw_blocks_choose_size(n, 64));
  }
  assert_in_range(pw_blocks_choose_size(3444, 2), 30, 60);
  assert_in_range(pw_blocks_choose_size(5600, 2), 30, 60);
}

static void bad_input_is_refused(void **state)
{
  (void)state;
  pw_blocks b = {0};
  const pw_idx good[2] = {2, 2}, bad[2] = {0, 3}, huge[2] = {1 << 20, 1 << 20};
  const pw_idx negative[4] = {1, -1, 0, 0}, heavy[4] = {INT32_MAX, INT32_MAX, 0, 0};
  assert_int_equal(pw_blocks_create(bad, NULL, 8, 1, 1, &b), PW_ERR_ARGUMENT);
  assert_int_equal(pw_blocks_create(huge, NULL, 8, 1, 1, &b), PW_ERR_ARGUMENT);
  assert_int_equal(pw_blocks_create(good, NULL, 0, 1, 1, &b), PW_ERR_ARGUMENT);
  assert_int_equal(pw_blocks_create(good, NULL, 8, -1, 1, &b), PW_ERR_ARGUMENT);
  assert_int_equal(pw_blocks_create(good, NULL, 8, 1, 0, &b), PW_ERR_ARGUMENT);
  assert_int_equal(pw_blocks_create(good, negative, 8, 1, 1, &b), PW_ERR_ARGUMENT);
  assert_non_null(strstr(pw_error_text(), "element 1 has weight -1"));
  assert_int_equal(pw_blocks_create(good, heavy, 8, 1, 1, &b), PW_ERR_ARGUMENT);
  assert_null(b.elem);
}

/* A pile of points in tall cells: a few elements hold more than an even part each. Hardly a part is
 * left empty for them (at their full weight METIS would leave two fifths, and print about it). */
static void heavy_elements_leave_few_parts_empty(void **state)
{
  (void)state;
  enum { NX = 11, NY = 42, HEAVY = 130, PER_BLOCK = 8 };
  pw_idx weight[NX * NY];
  for (int e = 0; e < NX * NY; e++) {
    weight[e] = e % NX == 0 && e / NX >= 34 ? HEAVY : 1;
  }
  pw_blocks b = {0};
  assert_int_equal(pw_blocks_create((pw_idx[]){NX, NY}, weight, PER_BLOCK, 1, 2, &b), PW_OK);
  check_lists(&b);
  assert_in_range(b.nblock, 9 * (NX * NY / PER_BLOCK) / 10, NX * NY / PER_BLOCK);
  pw_blocks_destroy(&b);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_element_is_in_one_block),
      cmocka_unit_test(fewer_elements_than_a_block_make_one_block),
      cmocka_unit_test(blocks_have_even_weight_and_are_connected),
      cmocka_unit_test(heavy_elements_leave_few_parts_empty),
      cmocka_unit_test(equal_input_gives_equal_blocks),
      cmocka_unit_test(size_comes_from_the_grid_alone),
      cmocka_unit_test(bad_input_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
