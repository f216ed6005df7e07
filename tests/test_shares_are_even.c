/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Division of blocks among threads: each block that holds something has one owner in its colour and
 * one among all blocks or is left to whoever is free, the others none; when the latter go to the
 * thread that has done least, no share exceeds the mean by more than one block, which is Graham's
 * bound for any list schedule (1969); the pile's division is more even than equal numbers of
 * blocks; blocks run with the thread that holds their part of the grid or close to it; the size
 * chosen for blocks has colours that two and four threads can share evenly. Records of nodes out of
 * use never carry mass. */
#include "tests/engine_scenes.h"

#include <stdlib.h>

#include "engine/ranges.h"
#include "partition/share.h"

/* Every list of a division: shares are disjoint, complete, and as even as Graham's bound says. */
static void check_list(const pw_blocks *b, pw_idx c, const pw_off *load)
{
  const bool all = c == b->ncolour;
  pw_off sum = 0, largest = 0, most = 0;
  int *seen = calloc((size_t)b->nblock, sizeof *seen);
  const pw_idx *start = b->share_start + (pw_off)c * (b->nthread + 1);
  pw_off own[32] = {0}, tail = 0;
  for (int t = 0; t <= b->nthread; t++) {
    int to = t;
    for (pw_idx l = start[t]; l < start[t + 1]; l++) {
      pw_idx k = b->share_block[l];
      assert_true(all || b->colour[k] == c);
      assert_true(t == b->nthread || l == start[t] || b->share_block[l - 1] < k);
      seen[k]++;
      for (int free_one = 0; t == b->nthread && free_one < t; free_one++) {
        to = to == t || own[free_one] < own[to] ? free_one : to;
      }
      tail += t == b->nthread ? load[k] : 0;
      own[to] += load[k];
      to = t;
      largest = load[k] > largest ? load[k] : largest;
    }
  }
  for (int t = 0; t < b->nthread; t++) {
    sum += own[t];
    most = own[t] > most ? own[t] : most;
  }
  assert_true(10 * tail <= sum + 10);
  for (pw_idx k = 0; k < b->nblock; k++) {
    assert_int_equal(seen[k], (all || b->colour[k] == c) && b->share_size[k] > 0);
  }
  assert_true((most - largest) * b->nthread <= sum);
  free(seen);
}

static void each_block_has_one_owner(void **state)
{
  (void)state;
  const pw_idx reach[2] = {1, 2};
  srand(11);
  for (int threads = 1; threads <= 17; threads += 4) {
    for (int r = 0; r < 2; r++) {
      pw_blocks b = {0};
      assert_ok(pw_blocks_create((pw_idx[]){41, 84}, NULL, 36, reach[r], 1, &b));
      assert_ok(pw_share_create(&b, threads));
      for (int trial = 0; trial < 20; trial++) {
        for (pw_idx k = 0; k < b.nblock; k++) {
          b.share_size[k] = rand() % 4 > 0 ? rand() % 200 : 0;
          b.share_work[k] = b.share_size[k] * (2 + rand() % 8);
        }
        pw_share_balance(&b);
        for (pw_idx c = 0; c <= b.ncolour; c++) {
          check_list(&b, c, c < b.ncolour ? b.share_size : b.share_work);
        }
      }
      pw_blocks_destroy(&b);
    }
  }
}

/* Four blocks of one colour in a row, by hand: in equal numbers, and divided. */
static void check_bound(const pw_off *load, pw_real equal, pw_real divided)
{
  pw_real coloured, plain;
  pw_idx one_colour[2] = {0, 4}, blocks[4] = {0, 1, 2, 3};
  pw_off own[4], all = 0;
  for (int k = 0; k < 4; k++) {
    all += own[k] = load[k];
  }
  pw_blocks b = {.nblock = 4,
                 .ncolour = 1,
                 .cells = {1, 4},
                 .colour_start = one_colour,
                 .colour_block = blocks};
  b.share_size = b.share_work = own;
  pw_share_bound(&b, 2, &coloured, &plain);
  assert_near(coloured, (pw_real)all / equal, 1e-15);
  assert_near(plain, (pw_real)all / equal, 1e-15);
  b.share_size = b.share_work = NULL;
  assert_ok(pw_share_create(&b, 2));
  memcpy(b.share_size, load, sizeof own);
  memcpy(b.share_work, load, sizeof own);
  pw_share_balance(&b);
  pw_share_bound(&b, 2, &coloured, &plain);
  assert_near(coloured, (pw_real)all / divided, 1e-15);
  assert_near(plain, (pw_real)all / divided, 1e-15);
  b.colour_start = b.colour_block = NULL;
  pw_blocks_destroy(&b);
}

static void bounds_are_those_of_the_shares(void **state)
{
  (void)state;
  /* 7 against 5 + 3 + 3: the border lies after the first block; a 3 would cost 4.5 where it is far,
   * 11.5 against 8. */
  check_bound((const pw_off[]){7, 5, 3, 3}, 12.0, 11.0);
  /* 1 + 1 + 3 against 3: a 1 costs 1.5 on the other side, 4.5 against 4. */
  check_bound((const pw_off[]){1, 1, 3, 3}, 6.0, 4.0);
}

/* The part of a list's work that is run by other threads than those that hold its part of the grid,
 * and farther than a quarter of the grid from there. */
static pw_real part_far_off(const pw_blocks *b, pw_idx c, const pw_off *load)
{
  const pw_idx *start = b->share_start + (pw_off)c * (b->nthread + 1);
  pw_off all = 0, before = 0, far = 0, sum = 0;
  for (pw_idx k = 0; k < b->nblock; k++) {
    all += b->share_work[k];
  }
  for (pw_idx i = b->nblock - 1; i >= 0; i--) { /* thread 0 holds the top, or the right */
    const pw_idx k = b->share_line[i];
    const pw_real at = (pw_real)(2 * before + b->share_work[k]) / (pw_real)(2 * all);
    before += b->share_work[k];
    for (int t = 0; t < b->nthread; t++) {
      const pw_real first = (pw_real)t / b->nthread, last = (pw_real)(t + 1) / b->nthread;
      for (pw_idx l = start[t]; l < start[t + 1]; l++) {
        if (b->share_block[l] == k) {
          sum += load[k];
          far += at < first - 0.25 || at > last + 0.25 ? load[k] : 0;
        }
      }
    }
  }
  return sum > 0 ? (pw_real)far / (pw_real)sum : 0.0;
}

/* Along the line that blocks form, places in the grid do not fall; few are run far from there. */
static void check_places(pw_blocks *b, const pw_off *size)
{
  for (int threads = 2; threads <= 4; threads++) {
    assert_ok(pw_share_create(b, threads));
    memcpy(b->share_size, size, (size_t)b->nblock * sizeof *size);
    memcpy(b->share_work, size, (size_t)b->nblock * sizeof *size);
    pw_share_balance(b);
    pw_real far = 0.0;
    for (pw_idx c = 0; c < b->ncolour; c++) {
      far += part_far_off(b, c, size) / b->ncolour;
    }
    print_message("%d threads: %.1f %% of the scatters and %.1f %% of the rest far off\n", threads,
                  100.0 * far, 100.0 * part_far_off(b, b->ncolour, size));
    assert_true(far <= 0.05 && part_far_off(b, b->ncolour, size) <= 0.01);
    const bool wide = b->cells[0] > b->cells[1];
    const pw_idx first = b->elem[b->elem_start[b->share_line[0]]];
    const pw_idx last = b->elem[b->elem_start[b->share_line[b->nblock - 1]]];
    assert_true(wide ? first % b->cells[0] < b->cells[0] / 8
                     : first / b->cells[0] < b->cells[1] / 8);
    assert_true(wide ? last % b->cells[0] > b->cells[0] * 3 / 4
                     : last / b->cells[0] > b->cells[1] * 3 / 4);
    pw_share_destroy(b);
  }
}

/* A wide grid is cut across, not along. */
static void wide_grids_are_cut_across(void **state)
{
  (void)state;
  pw_blocks b = {0};
  pw_off size[300] = {0};
  assert_ok(pw_blocks_create((pw_idx[]){160, 24}, NULL, 48, 2, 1, &b));
  assert_true(b.nblock <= 300);
  for (pw_idx e = 0; e < b.nelem; e++) {
    size[b.elem_block[e]] += 4;
  }
  check_places(&b, size);
  pw_blocks_destroy(&b);
}

/* The grid of cases/hammered_pile: 10 m of soil and the pile's column above it. */
static void chosen_sizes_divide_evenly(void **state)
{
  (void)state;
  enum { NX = 40, NY = 128 };
  const pw_idx cells[2] = {NX, NY};
  pw_idx *weight = calloc(NX * NY, sizeof *weight);
  for (int e = 0; e < NX * NY; e++) {
    int i = e % NX, j = e / NX;
    weight[e] = j < 80 ? (i < 29 ? 4 : 1) : i < 2 && j < 120 ? 5 : 0;
  }
  pw_blocks b = {0};
  assert_ok(pw_blocks_create_even(cells, weight, 2, 2, &b));
  pw_off *size = calloc((size_t)b.nblock, sizeof *size);
  for (int e = 0; e < NX * NY; e++) {
    size[b.elem_block[e]] += weight[e];
  }
  pw_real on_2, on_4;
  assert_ok(pw_share_plan(&b, 2, size, &on_2));
  assert_ok(pw_share_plan(&b, 4, size, &on_4));
  print_message("%d blocks, %d colours: bounds %.3f on 2 threads, %.3f on 4\n", b.nblock, b.ncolour,
                on_2, on_4);
  assert_true(on_2 >= 1.95 && on_2 <= 2.0 && on_4 >= 3.6 && on_4 <= 4.0);
  check_places(&b, size);
  free(size);
  free(weight);
  pw_blocks_destroy(&b);
}

static void out_of_use_is_without_mass(void **state)
{
  (void)state;
  for (int contact = TEST_PENALTY; contact < TEST_CONTACTS; contact++) {
    static pw_scene s;
    test_hammered_pile(&s, contact, 0.125);
    s.method.block_elements = 8; /* by itself this small scene takes a few large blocks */
    pw_sim *sim = test_sim(&s, 2);
    for (int k = 0; k < 120; k++) {
      assert_ok(pw_sim_step(sim, 0.0));
      for (pw_off r = 0; r < sim->nodes.count; r++) {
        const pw_real *rec = sim->nodes.rec + r * PW_NODE;
        assert_true(pw_nodes_in_use(&sim->nodes, 0, (pw_idx)r) || rec[PW_NODE_MASS] == 0.0);
      }
    }
    assert_true(sim->nodes.nused < sim->nodes.ngroup);
    pw_real coloured[2], plain[2];
    pw_ranges_balance(sim);
    pw_share_bound(&sim->blocks, 2, &coloured[0], &plain[0]);
    sim->blocks.nthread = 0;
    pw_share_bound(&sim->blocks, 2, &coloured[1], &plain[1]);
    print_message("%s: %d of %d groups in use; bounds %.3f %.3f, equal numbers %.3f %.3f\n",
                  test_contact_name[contact], sim->nodes.nused, sim->nodes.ngroup, coloured[0],
                  plain[0], coloured[1], plain[1]);
    assert_true(coloured[0] > coloured[1] && plain[0] > plain[1] && plain[0] > 1.95);
    pw_sim_destroy(&sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_block_has_one_owner),
      cmocka_unit_test(bounds_are_those_of_the_shares),
      cmocka_unit_test(chosen_sizes_divide_evenly),
      cmocka_unit_test(wide_grids_are_cut_across),
      cmocka_unit_test(out_of_use_is_without_mass),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
