/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of one colour never share a node of their supports. Two elements' supports share a node
 * exactly when the elements are at most 2 reach + 1 cells apart along both axes. */
#include "tests/harness.h"

#include <stdlib.h>

#include "partition/blocks.h"
#include "partition/colour.h"
#include "partition/graph.h"

/* conflict[a * nblock + b] from all pairs of near elements. */
static char *conflicts(const pw_blocks *b)
{
  char *c = calloc((size_t)b->nblock * (size_t)b->nblock, 1);
  pw_idx far = 2 * b->reach + 1;
  for (pw_idx e = 0; e < b->nelem; e++) {
    pw_idx i = e % b->cells[0], j = e / b->cells[0];
    for (pw_idx y = j - far; y <= j + far; y++) {
      for (pw_idx x = i - far; x <= i + far; x++) {
        if (x >= 0 && y >= 0 && x < b->cells[0] && y < b->cells[1]) {
          c[b->elem_block[e] * b->nblock + b->elem_block[y * b->cells[0] + x]] = 1;
        }
      }
    }
  }
  return c;
}

static void check_colouring(const pw_idx *cells, const pw_idx *weight, pw_idx size, pw_idx reach)
{
  pw_blocks b = {0};
  pw_graph g = {0};
  assert_int_equal(pw_blocks_create(cells, weight, size, reach, 1, &b), PW_OK);
  assert_int_equal(pw_blocks_check(&b), PW_OK);
  assert_int_equal(pw_graph_conflict(&b, &g), PW_OK);
  char *c = conflicts(&b);
  for (pw_idx k = 0; k < b.nblock; k++) {
    pw_idx degree = 0;
    assert_in_range(b.colour[k], 0, b.ncolour - 1);
    for (pw_idx l = 0; l < b.nblock; l++) {
      if (l != k && c[k * b.nblock + l]) {
        assert_int_not_equal(b.colour[k], b.colour[l]);
        degree++;
      }
    }
    assert_int_equal(g.start[k + 1] - g.start[k], degree);
    for (pw_idx l = g.start[k]; l < g.start[k + 1]; l++) {
      assert_true(g.adj[l] != k && c[k * b.nblock + g.adj[l]]);
    }
  }
  free(c);
  pw_graph_destroy(&g);
  pw_blocks_destroy(&b);
}

static void blocks_of_one_colour_share_no_node(void **state)
{
  (void)state;
  const pw_idx grids[][2] = {{1, 1}, {1, 60}, {41, 84}, {100, 100}, {7, 5}};
  for (int g = 0; g < 5; g++) {
    for (pw_idx reach = 0; reach <= 2; reach++) {
      check_colouring(grids[g], NULL, g == 3 ? 24 : 12, reach);
      check_colouring(grids[g], NULL, 48, reach);
    }
  }
  check_colouring(grids[2], NULL, 36, 100); /* the halo covers the grid: all blocks conflict */
}

static void random_weights_change_nothing(void **state)
{
  (void)state;
  srand(11);
  pw_idx weight[41 * 84];
  for (int trial = 0; trial < 4; trial++) {
    for (int e = 0; e < 41 * 84; e++) {
      weight[e] = rand() % 4 ? 0 : rand() % 64;
    }
    check_colouring((pw_idx[]){41, 84}, weight, 20 + 10 * trial, trial % 3);
  }
}

static void check_names_the_blocks(void **state)
{
  (void)state;
  pw_blocks b = {0};
  assert_int_equal(pw_blocks_create((pw_idx[]){8, 1}, NULL, 4, 1, 1, &b), PW_OK);
  assert_int_equal(b.nblock, 2);
  assert_int_equal(b.ncolour, 2);
  b.ncolour = 1;
  b.colour_start[1] = 2;
  b.colour[0] = b.colour[1] = 0;
  b.colour_block[0] = 0;
  b.colour_block[1] = 1;
  assert_int_equal(pw_blocks_check(&b), PW_ERR_ARGUMENT);
  assert_non_null(strstr(pw_error_text(), "blocks 0 and 1 of colour 0"));
  b.colour[1] = 1;
  assert_int_equal(pw_blocks_check(&b), PW_ERR_ARGUMENT);
  assert_non_null(strstr(pw_error_text(), "listed in colour 0"));
  pw_blocks_destroy(&b);
}

/* Colours and evenness on the grid of the pile (41 x 84 cells) with a halo of one cell: greedy
 * colouring alone needs 13 colours for 431 blocks, 6 for 108 and 6 for 54; these are not exceeded,
 * and two threads have work for at least 90 % of the time if blocks take equal time. */
static void colours_are_few_and_even(void **state)
{
  (void)state;
  const pw_idx size[3] = {8, 32, 64}, most[3] = {13, 6, 6};
  for (int s = 0; s < 3; s++) {
    pw_blocks b = {0};
    assert_int_equal(pw_blocks_create((pw_idx[]){41, 84}, NULL, size[s], 1, 1, &b), PW_OK);
    pw_idx turns = 0;
    for (pw_idx c = 0; c < b.ncolour; c++) {
      turns += (b.colour_start[c + 1] - b.colour_start[c] + 1) / 2;
    }
    assert_true(b.ncolour <= most[s]);
    assert_true(b.nblock >= 0.9 * 2 * turns);
    pw_blocks_destroy(&b);
  }
}

/* Graphs on which smallest-last greedy colouring is exact: odd and even rings, the complete and
 * the complete bipartite graph, no edges. */
static void known_graphs_get_their_number(void **state)
{
  (void)state;
  pw_idx start[41], adj[40 * 39], colour[40], n;
  for (int kind = 0; kind < 5; kind++) {
    pw_graph g = {.n = kind == 0 ? 39 : 40, .start = start, .adj = adj};
    const pw_idx expected[5] = {3, 2, 40, 2, 1};
    pw_idx k = 0;
    for (pw_idx v = 0; v < g.n; v++) {
      start[v] = k;
      for (pw_idx u = 0; u < g.n; u++) {
        bool ring = u == (v + 1) % g.n || v == (u + 1) % g.n;
        bool bipartite = (u + v) % 2 == 1;
        bool edge[5] = {ring, ring, u != v, bipartite, false};
        if (edge[kind]) {
          adj[k++] = u;
        }
      }
    }
    start[g.n] = k;
    assert_int_equal(pw_colour_greedy(&g, NULL, colour, &n), PW_OK);
    assert_int_equal(n, expected[kind]);
    for (pw_idx v = 0; v < g.n; v++) {
      for (pw_idx l = start[v]; l < start[v + 1]; l++) {
        assert_int_not_equal(colour[v], colour[adj[l]]);
      }
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blocks_of_one_colour_share_no_node),
      cmocka_unit_test(random_weights_change_nothing),
      cmocka_unit_test(check_names_the_blocks),
      cmocka_unit_test(colours_are_few_and_even),
      cmocka_unit_test(known_graphs_get_their_number),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
