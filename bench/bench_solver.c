/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One engine of engine/solver.h on an elastic cube of ten-node tetrahedra, fixed at its bottom under
 * its own weight: times, memory and iterations for a first matrix, and for a second one after a
 * deformation of about one per cent.
 * usage: bench_solver BRICKS ENGINE [none|increment] [POISSON] [REDUCTION] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include "engine/solver.h"
#include "engine/tet_box.h"
#include "engine/tet_model.h"

static int fail(const char *what)
{
  fprintf(stderr, "%s: %s (%s)\n", what, pw_error_text(), pw_error_where());
  return 1;
}

/* Wall and processor time; s. */
typedef struct {
  double wall, cpu;
} stamp;

static stamp now(void)
{
  struct timespec w, c;
  clock_gettime(CLOCK_MONOTONIC, &w);
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &c);
  return (stamp){(double)w.tv_sec + 1e-9 * (double)w.tv_nsec,
                 (double)c.tv_sec + 1e-9 * (double)c.tv_nsec};
}

static void say(const char *what, stamp from)
{
  stamp to = now();
  printf("  %-28s %8.3f s wall %8.3f s cpu\n", what, to.wall - from.wall, to.cpu - from.cpu);
}

static double peak_gb(void)
{
  struct rusage use;
  getrusage(RUSAGE_SELF, &use);
  return 1024e-9 * (double)use.ru_maxrss;
}

static pw_status build(pw_idx bricks, double poisson, pw_fbar fbar, pw_tet_mesh *mesh,
                       pw_tet_material *material, pw_tet_model *model)
{
  pw_tet_box box = {
      .bricks = {bricks, bricks, bricks}, .high = {1.0, 1.0, 1.0}, .per_brick = 6, .nodes = 10};
  pw_tet_input in;
  PW_TRY(pw_tet_box_create(&box, &in));
  PW_TRY(pw_tet_mesh_create(&in, mesh));
  pw_tet_box_destroy(&in);
  material->model = pw_material_find("hencky_von_mises");
  for (const pw_key *k = material->model->keys; k->name; k++) {
    pw_real *p = &material->param[k->offset / sizeof(pw_real)];
    *p = strcmp(k->name, "youngs_modulus_pa") == 0             ? 1e7
         : strcmp(k->name, "poisson_ratio") == 0               ? poisson
         : strcmp(k->name, "density_kg_m3") == 0               ? 2000.0
         : strcmp(k->name, "undrained_shear_strength_pa") == 0 ? 1e9
                                                               : 0.0;
  }
  pw_tet_fill fill = {.rule = PW_TET_RULE_ONE, .nmaterial = 1, .material = material};
  pw_tet_setup setup = {.mesh = mesh, .fill = &fill, .fbar = fbar, .threads = 1};
  PW_TRY(pw_tet_model_create(&setup, model));
  const pw_idx n = mesh->tets.nnode;
  for (pw_idx a = 0; a < n; a++) {
    for (pw_idx c = 0; mesh->x[n + a] == 0.0 && c < 3; c++) {
      model->fixed[c * n + a] = 1;
    }
  }
  return pw_tet_model_begin(model);
}

/* Norm of b - A x over that of b. */
static double left_over(const pw_csr *m, const pw_real *b, const pw_real *x, pw_real *work)
{
  double left = 0.0, all = 0.0;
  pw_csr_multiply(m, x, work);
  for (pw_idx i = 0; i < m->n; i++) {
    left += (b[i] - work[i]) * (b[i] - work[i]);
    all += b[i] * b[i];
  }
  return sqrt(left / all);
}

static pw_status time_matrix(pw_solver *s, const pw_csr *m, const pw_real *b, pw_real *x,
                             pw_real *work)
{
  stamp from = now();
  PW_TRY(pw_solver_factor(s, m));
  say("factor or set-up", from);
  from = now();
  PW_TRY(pw_solver_solve(s, m, b, x));
  say("solve", from);
  printf("  %d iterations, residual %.1e\n", (int)pw_solver_counted(s).last,
         left_over(m, b, x, work));
  return PW_OK;
}

static pw_status time_engine(pw_solver *s, pw_tet_model *model, const pw_real *b, pw_real *x)
{
  const pw_csr *m = &model->csr;
  const size_t n = (size_t)model->mesh->tets.nnode;
  pw_real *u = calloc(3 * n, sizeof *u), *work = calloc((size_t)m->n, sizeof *work);
  const double before = peak_gb();
  pw_status status = time_matrix(s, m, b, x, work);
  printf("  %s\n", pw_solver_describe(s));
  if (status == PW_OK) {
    double most = 0.0;
    for (pw_idx i = 0; i < m->n; i++) {
      most = fabs(x[i]) > most ? fabs(x[i]) : most;
    }
    for (size_t i = 0; i < 3 * n; i++) {
      u[i] = model->equation[i] >= 0 ? 0.01 / most * x[model->equation[i]] : 0.0;
    }
    status = pw_tet_model_evaluate(model, u, true);
  }
  printf("after a deformation\n");
  status = status == PW_OK ? time_matrix(s, m, b, x, work) : status;
  pw_solver_counts c = pw_solver_counted(s);
  printf("  memory: %.3f GB before, %.3f GB more at its peak, factor %lld nonzeros, estimate %.3f "
         "GB, pivots %.1e\n",
         before, peak_gb() - before, (long long)c.factor_nonzeros, 1e-9 * (double)c.factor_bytes,
         c.pivot_ratio);
  free(u);
  free(work);
  return status;
}

static int run(const pw_solver_options *options, pw_tet_model *model, double reduction)
{
  pw_solver *s = NULL;
  pw_real *b = calloc((size_t)model->csr.n, sizeof *b);
  pw_real *x = calloc((size_t)model->csr.n, sizeof *x);
  pw_real *u = calloc(3 * (size_t)model->mesh->tets.nnode, sizeof *u);
  const pw_idx n = model->mesh->tets.nnode;
  pw_status status = pw_tet_model_evaluate(model, u, true);
  for (pw_idx a = 0; a < n; a++) {
    if (model->equation[n + a] >= 0) {
      b[model->equation[n + a]] = -1.0;
    }
  }
  status = status == PW_OK ? pw_solver_create(options, &s) : status;
  if (status == PW_OK) {
    pw_solver_aim(s, reduction);
    status = time_engine(s, model, b, x);
  }
  int rc = status == PW_OK ? 0 : fail("solver");
  pw_solver_destroy(&s);
  free(b);
  free(x);
  free(u);
  return rc;
}

int main(int argc, char **argv)
{
  pw_tet_mesh mesh;
  pw_tet_material material = {.model = NULL};
  pw_tet_model model;
  pw_solver_options options = pw_solver_defaults(argc < 4 || strcmp(argv[3], "none") == 0);
  if (argc < 3 || !pw_solver_find(argv[2], &options.engine)) {
    fprintf(stderr, "usage: bench_solver BRICKS ENGINE [none|increment] [POISSON] [REDUCTION]\n");
    return 2;
  }
  if (build(atoi(argv[1]), argc > 4 ? atof(argv[4]) : 0.3,
            options.symmetric ? PW_FBAR_NONE : PW_FBAR_INCREMENT, &mesh, &material,
            &model) != PW_OK) {
    return fail("start");
  }
  options.x = mesh.x;
  printf("%s: %d tets, %d equations, %lld nonzeros\n", argv[2], (int)mesh.tets.nelem,
         (int)model.csr.n, (long long)model.csr.start[model.csr.n]);
  int rc = run(&options, &model, argc > 5 ? atof(argv[5]) : 1e-8);
  pw_tet_model_destroy(&model);
  pw_tet_mesh_destroy(&mesh);
  return rc;
}
