/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Division of blocks among threads: each block that holds something has one owner in its colour and
 * one among all blocks, the others none; no share exceeds the mean by more than one block, which is
 * Graham's bound for any list schedule (1969); the pile's division is more even than equal numbers
 * of blocks. Records of nodes out of use never carry mass. */
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
  for (int t = 0; t < b->nthread; t++) {
    const pw_idx *start = b->share_start + (pw_off)c * b->nthread + t;
    pw_off own = 0;
    for (pw_idx l = start[0]; l < start[1]; l++) {
      pw_idx k = b->share_block[l];
      assert_true(all || b->colour[k] == c);
      assert_true(l == start[0] || b->share_block[l - 1] < k);
      seen[k]++;
      own += load[k];
      largest = load[k] > largest ? load[k] : largest;
    }
    sum += own;
    most = own > most ? own : most;
  }
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

/* With one block of 7, one of 5 and two of 3 in the colours of a row, by hand: 7 and 5 + 3 + 3. */
static void bounds_are_those_of_the_shares(void **state)
{
  (void)state;
  pw_real coloured, plain;
  pw_idx one_colour[2] = {0, 4}, blocks[4] = {0, 1, 2, 3};
  pw_off load[4] = {7, 5, 3, 3};
  pw_blocks b = {.nblock = 4, .ncolour = 1, .colour_start = one_colour, .colour_block = blocks};
  b.share_size = b.share_work = load;
  pw_share_bound(&b, 2, &coloured, &plain);
  assert_near(coloured, 18.0 / 12.0, 1e-15); /* equal numbers: 7 + 5 against 3 + 3 */
  assert_near(plain, 18.0 / 12.0, 1e-15);
  b.share_size = b.share_work = NULL;
  assert_ok(pw_share_create(&b, 2));
  memcpy(b.share_size, load, sizeof load);
  memcpy(b.share_work, load, sizeof load);
  pw_share_balance(&b);
  pw_share_bound(&b, 2, &coloured, &plain);
  assert_near(coloured, 18.0 / 10.0, 1e-15); /* 7 + 3 against 5 + 3 */
  assert_near(plain, 18.0 / 10.0, 1e-15);
  b.colour_start = b.colour_block = NULL;
  pw_blocks_destroy(&b);
}

static void out_of_use_is_without_mass(void **state)
{
  (void)state;
  for (int contact = TEST_PENALTY; contact < TEST_CONTACTS; contact++) {
    static pw_scene s;
    test_hammered_pile(&s, contact, 0.125);
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
      cmocka_unit_test(out_of_use_is_without_mass),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
