/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vane shear on a mesh of gmsh's: torque, iterations and times of every step.
 * usage: bench_vane MESH.msh STEPS THREADS [none|increment|total] [ENGINE] */
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

#include "partition/share.h"
#include "tests/vane_helpers.h"

static int fail(const char *what)
{
  fprintf(stderr, "%s: %s (%s)\n", what, pw_error_text(), pw_error_where());
  return 1;
}

static pw_fbar fbar_of(const char *name)
{
  return strcmp(name, "none") == 0    ? PW_FBAR_NONE
         : strcmp(name, "total") == 0 ? PW_FBAR_TOTAL
                                      : PW_FBAR_INCREMENT;
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

static stamp since(stamp from)
{
  stamp to = now();
  return (stamp){to.wall - from.wall, to.cpu - from.cpu};
}

/* Keeps the shorter times; the first round, which allocates, does not count. */
static void keep(stamp took, int round, stamp *best)
{
  if (round <= 1 || took.wall < best->wall) {
    best->wall = took.wall;
  }
  if (round <= 1 || took.cpu < best->cpu) {
    best->cpu = took.cpu;
  }
}

/* One assembly, factorisation and solution by themselves, best of three. */
static void time_parts(vane *v, pw_solver_engine engine)
{
  static const char *name[3] = {"assembly", "factor or set-up", "solve"};
  stamp best[3] = {{0.0, 0.0}};
  pw_solver *s = NULL;
  pw_real *b = calloc((size_t)v->model.csr.n, sizeof *b);
  pw_real *x = calloc((size_t)v->model.csr.n, sizeof *b);
  pw_real *u = calloc(3 * (size_t)v->mesh.tets.nnode, sizeof *u);
  pw_solver_options options = pw_solver_defaults(v->model.fbar == PW_FBAR_NONE);
  options.engine = engine == PW_SOLVER_KRYLOV ? PW_SOLVER_DIRECT : engine;
  options.x = v->mesh.x;
  for (pw_idx i = 0; i < v->model.csr.n; i++) {
    b[i] = 1.0;
  }
  pw_status status = pw_solver_create(&options, &s);
  for (int k = 0; status == PW_OK && k < 4; k++) {
    stamp from = now();
    pw_tet_model_evaluate(&v->model, u, true);
    keep(since(from), k, &best[0]);
    from = now();
    status = pw_solver_factor(s, &v->model.csr);
    keep(since(from), k, &best[1]);
    from = now();
    status = status == PW_OK ? pw_solver_solve(s, &v->model.csr, b, x) : status;
    keep(since(from), k, &best[2]);
  }
  for (int i = 0; i < 3; i++) {
    printf("%s %.3f s wall, %.3f s cpu\n", name[i], best[i].wall, best[i].cpu);
  }
  printf("%s: %lld nonzeros, of the matrix %lld, %s\n", pw_solver_name(options.engine),
         (long long)pw_solver_counted(s).factor_nonzeros,
         (long long)v->model.csr.start[v->model.csr.n], pw_status_text(status));
  pw_solver_destroy(&s);
  free(b);
  free(x);
  free(u);
}

static pw_status start(char **argv, int argc, pw_solver_engine engine, vane *v)
{
  PW_TRY(vane_start(argv[1], fbar_of(argc > 4 ? argv[4] : "increment"), atoi(argv[3]), v));
  pw_newton_options options = pw_newton_defaults();
  options.tolerance = 1e-10;
  options.solver = engine;
  pw_newton_destroy(&v->newton);
  return pw_newton_create(&v->model, &options, &v->newton);
}

static pw_status take_steps(vane *v, int steps)
{
  double torque[2];
  pw_solver_counts before = {0};
  for (int k = 1; k <= steps; k++) {
    stamp from = now();
    PW_TRY(vane_turn(v, torque));
    stamp took = since(from);
    pw_solver_counts c = pw_solver_counted(pw_newton_solver(v->newton));
    printf("%3d %.2e rad: T/T_cyl %.5f, balance %.1e, %d equations, iterations %d cuts %d, factors "
           "%d, linear iterations %d, tests per point %.3f, %.3f s wall %.3f s cpu\n",
           k, v->angle, torque[0] / vane_cylinder(v->height), 1.0 + torque[1] / torque[0],
           (int)v->model.csr.n, v->report.iterations, v->report.cuts,
           (int)(c.factors - before.factors), (int)(c.iterations - before.iterations),
           (double)v->model.walked.tests / (double)v->model.walked.points, took.wall, took.cpu);
    before = c;
  }
  printf("%s\n", pw_solver_describe(pw_newton_solver(v->newton)));
  return PW_OK;
}

int main(int argc, char **argv)
{
  static vane v;
  pw_solver_engine engine = PW_SOLVER_AUTO;
  if (argc < 4 || (argc > 5 && !pw_solver_find(argv[5], &engine))) {
    fprintf(stderr, "usage: bench_vane MESH.msh STEPS THREADS [none|increment|total] [ENGINE]\n");
    return 2;
  }
  stamp from = now();
  if (start(argv, argc, engine, &v) != PW_OK) {
    return fail("start");
  }
  printf("%d tets, %d nodes, %d points, %d blocks, %d colours, set-up %.2f s\n",
         (int)v.mesh.tets.nelem, (int)v.mesh.tets.nnode, (int)v.model.points.n,
         (int)v.model.blocks.nblock, (int)v.model.blocks.ncolour, since(from).wall);
  from = now();
  if (take_steps(&v, atoi(argv[2])) != PW_OK) {
    return fail("step");
  }
  printf("%.2f s wall, %.2f s cpu for all steps\n", since(from).wall, since(from).cpu);
  pw_real coloured, plain;
  pw_share_bound(&v.model.blocks, v.model.threads, &coloured, &plain);
  printf("blocks bound the speed-up on %d threads by %.3f coloured, %.3f in any order\n",
         v.model.threads, coloured, plain);
  time_parts(&v, engine == PW_SOLVER_AUTO ? PW_SOLVER_DIRECT : engine);
  struct rusage use;
  getrusage(RUSAGE_SELF, &use);
  printf("%.3f GB at the peak\n", 1024e-9 * (double)use.ru_maxrss);
  vane_end(&v);
  return 0;
}
