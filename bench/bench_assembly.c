/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Assembly of the implicit half, force and tangent, with one thread and with several in turns: two
 * models of one block of ten-node tetrahedra in von Mises plasticity, the same work to the last bit,
 * evaluated for the same displacements. Prints the ratio of each pair of neighbouring windows, median
 * and quartiles of the ratios, the ratio of the quickest tenths, which other programs disturb least,
 * and the bound that the division of the blocks sets.
 * usage: bench_assembly [BRICKS [THREADS [PAIRS [EVALUATIONS [none|increment|total]]]]]
 *        (12 2 15 3 increment: 10,368 cells, 82,944 tetrahedra) */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/tet_box.h"
#include "engine/tet_model.h"
#include "partition/share.h"

enum { PAIRS = 1000 };

static int fail(const char *what)
{
  fprintf(stderr, "%s: %s (%s)\n", what, pw_error_text(), pw_error_where());
  return 1;
}

static pw_tet_material clay(void)
{
  pw_tet_material m = {.model = pw_material_find("hencky_von_mises")};
  for (const pw_key *k = m.model->keys; k->name; k++) {
    pw_real *p = &m.param[k->offset / sizeof(pw_real)];
    *p = strcmp(k->name, "youngs_modulus_pa") == 0             ? 1e7
         : strcmp(k->name, "poisson_ratio") == 0               ? 0.45
         : strcmp(k->name, "density_kg_m3") == 0               ? 2000.0
         : strcmp(k->name, "undrained_shear_strength_pa") == 0 ? 1e4
                                                               : 0.0;
  }
  return m;
}

static pw_status create(pw_tet_mesh *mesh, const pw_tet_material *material, pw_fbar fbar,
                        int threads, pw_tet_model *out)
{
  pw_tet_fill fill = {.rule = PW_TET_RULE_ONE, .nmaterial = 1, .material = material};
  pw_tet_setup setup = {.mesh = mesh, .fill = &fill, .fbar = fbar, .threads = threads};
  PW_TRY(pw_tet_model_create(&setup, out));
  const pw_idx n = mesh->tets.nnode;
  for (pw_idx i = 0; i < 3 * n; i++) {
    out->fixed[i] = mesh->tets.x[n + i % n] == 0.0;
  }
  return pw_tet_model_begin(out);
}

/* Bulging by a few per cent: most points yield. */
static void displace(const pw_tet_mesh *mesh, pw_real *u)
{
  const pw_idx n = mesh->tets.nnode;
  for (pw_idx a = 0; a < n; a++) {
    const pw_real *x = mesh->tets.x, y = x[n + a];
    u[a] = 0.02 * y * sin(3.0 * x[a]);
    u[n + a] = -0.02 * y * (1.0 + x[2 * n + a]);
    u[2 * n + a] = 0.01 * y * cos(2.0 * x[a]);
  }
}

/* Seconds for @p count evaluations; negative after a failure. */
static double time_window(pw_tet_model *m, const pw_real *u, int count)
{
  const double start = omp_get_wtime();
  for (int k = 0; k < count; k++) {
    if (pw_tet_model_evaluate(m, u, true) != PW_OK) {
      return -1.0;
    }
  }
  return omp_get_wtime() - start;
}

static int ascending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double quickest_tenth(double *time, int n)
{
  double sum = 0.0;
  const int part = n > 10 ? n / 10 : 1;
  qsort(time, (size_t)n, sizeof *time, ascending);
  for (int k = 0; k < part; k++) {
    sum += time[k] / part;
  }
  return sum;
}

static bool same(const pw_tet_model *a, const pw_tet_model *b)
{
  const size_t dofs = 3 * (size_t)a->mesh->tets.nnode, values = (size_t)a->csr.start[a->csr.n];
  return memcmp(a->force, b->force, dofs * sizeof *a->force) == 0 &&
         memcmp(a->csr.value, b->csr.value, values * sizeof *a->csr.value) == 0;
}

static int compare(pw_tet_model *m, const pw_real *u, int pairs, int count)
{
  static double time[2][PAIRS], ratio[PAIRS];
  double coloured, plain;
  for (int k = -1; k < pairs; k++) { /* one pair to warm up */
    for (int i = 0; i < 2; i++) {
      const int which = k % 2 == 0 ? i : 1 - i;
      const double t = time_window(&m[which], u, count);
      if (t < 0.0) {
        return fail("evaluation");
      }
      time[which][k < 0 ? 0 : k] = t;
    }
    if (k >= 0) {
      ratio[k] = time[0][k] / time[1][k];
      printf("%2d: %.4f s, %.4f s, ratio %.3f\n", k + 1, time[0][k] / count, time[1][k] / count,
             ratio[k]);
      fflush(stdout);
    }
  }
  if (!same(&m[0], &m[1])) {
    fprintf(stderr, "forces or tangents differ\n");
    return 1;
  }
  qsort(ratio, (size_t)pairs, sizeof *ratio, ascending);
  pw_share_bound(&m[1].blocks, m[1].threads, &coloured, &plain);
  printf("%d threads over one: median %.3f, quartiles %.3f and %.3f, quickest tenths %.3f; blocks "
         "allow %.3f\n",
         m[1].threads, ratio[pairs / 2], ratio[pairs / 4], ratio[3 * pairs / 4],
         quickest_tenth(time[0], pairs) / quickest_tenth(time[1], pairs), coloured);
  return 0;
}

int main(int argc, char **argv)
{
  const pw_idx n = argc > 1 ? atoi(argv[1]) : 12;
  const int threads = argc > 2 ? atoi(argv[2]) : 2, pairs = argc > 3 ? atoi(argv[3]) : 15;
  const int count = argc > 4 ? atoi(argv[4]) : 3;
  const char *name = argc > 5 ? argv[5] : "increment";
  const pw_fbar fbar = strcmp(name, "none") == 0    ? PW_FBAR_NONE
                       : strcmp(name, "total") == 0 ? PW_FBAR_TOTAL
                                                    : PW_FBAR_INCREMENT;
  pw_tet_box box = {.bricks = {n, n, n}, .high = {1.0, 1.0, 1.0}, .per_brick = 6, .nodes = 10};
  pw_tet_input in;
  pw_tet_mesh mesh;
  pw_tet_model m[2];
  if (n < 1 || threads < 1 || pairs < 1 || pairs > PAIRS || count < 1) {
    fprintf(stderr, "usage: bench_assembly [BRICKS [THREADS [PAIRS [EVALUATIONS [FBAR]]]]]\n");
    return 2;
  }
  const pw_tet_material material = clay();
  if (pw_tet_box_create(&box, &in) != PW_OK || pw_tet_mesh_create(&in, &mesh) != PW_OK ||
      create(&mesh, &material, fbar, 1, &m[0]) != PW_OK ||
      create(&mesh, &material, fbar, threads, &m[1]) != PW_OK) {
    return fail("start");
  }
  pw_tet_box_destroy(&in);
  pw_real *u = calloc(3 * (size_t)mesh.tets.nnode, sizeof *u);
  displace(&mesh, u);
  printf("%d tetrahedra, %d equations, %lld nonzeros, %d blocks, %d colours\n",
         (int)mesh.tets.nelem, (int)m[1].csr.n, (long long)m[1].csr.start[m[1].csr.n],
         (int)m[1].blocks.nblock, (int)m[1].blocks.ncolour);
  const int rc = compare(m, u, pairs, count);
  free(u);
  pw_tet_model_destroy(&m[0]);
  pw_tet_model_destroy(&m[1]);
  pw_tet_mesh_destroy(&mesh);
  return rc;
}
