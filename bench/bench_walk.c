/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walking search against the bins for every point, and against all elements for some.
 * usage: bench_walk BRICKS POINTS EVERY      cube of BRICKS^3 bricks in 6 linear tetrahedra each,
 * inner nodes moved at random; every EVERY-th point is compared with a search through all elements
 * exit status 1: a parent differs */
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

#include "engine/tet_box.h"

static double draw(uint64_t *state) /* splitmix64 */
{
  uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static pw_status make_mesh(pw_idx n, pw_tet_mesh *mesh)
{
  pw_tet_box box = {.bricks = {n, n, n}, .high = {1, 1, 1}, .per_brick = 6, .nodes = 4};
  pw_tet_input in;
  uint64_t seed = 1;
  PW_TRY(pw_tet_box_create(&box, &in));
  pw_real *x = (pw_real *)in.x; /* the box is ours */
  for (pw_idx i = 0; i < 3 * in.nnode; i++) {
    double shift = 0.15 / n * (2.0 * draw(&seed) - 1.0);
    x[i] += x[i] > 0.0 && x[i] < 1.0 ? shift : 0.0;
  }
  pw_status s = pw_tet_mesh_create(&in, mesh);
  pw_tet_box_destroy(&in);
  return s;
}

int main(int argc, char **argv)
{
  pw_tet_mesh mesh;
  pw_walk walk;
  if (argc < 4) {
    fprintf(stderr, "usage: bench_walk BRICKS POINTS EVERY\n");
    return 2;
  }
  if (make_mesh(atoi(argv[1]), &mesh) != PW_OK || pw_walk_create(&mesh.tets, &walk) != PW_OK) {
    fprintf(stderr, "%s\n", pw_error_text());
    return 2;
  }
  pw_walk_counts far = {0}, bins = {0};
  const long n = atol(argv[2]), every = atol(argv[3]);
  long wrong = 0, compared = 0;
  double walking = 0.0;
  uint64_t seed = 2;
  for (long i = 0; i < n; i++) {
    pw_real x[3] = {draw(&seed), draw(&seed), draw(&seed)};
    pw_idx from = (pw_idx)(draw(&seed) * mesh.tets.nelem);
    double t0 = omp_get_wtime();
    pw_idx owner = pw_walk_find(&walk, x, from, &far);
    walking += omp_get_wtime() - t0;
    wrong += owner != pw_walk_find(&walk, x, PW_WALK_OUTSIDE, &bins);
    if (every > 0 && i % every == 0) {
      wrong += owner != pw_walk_search_all(&mesh.tets, x);
      compared++;
    }
  }
  printf(
      "%d elements, %ld points from random starts: %.1f elements tested per point, %.2f us; %lld "
      "found by the bins, %ld compared with all elements, %ld differ\n",
      (int)mesh.tets.nelem, n, (double)far.tests / (double)n, 1e6 * walking / (double)n,
      (long long)far.binned, compared, wrong);
  pw_walk_destroy(&walk);
  pw_tet_mesh_destroy(&mesh);
  return wrong > 0;
}
