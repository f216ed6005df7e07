/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Engines of PETSc, in a plug-in that is loaded when one is asked for. */
#include <dlfcn.h>

#include "engine/core/mem.h"
#include "engine/petsc/petsc_module.h"
#include "engine/solver_parts.h"

/* Present when the BLAS in use is OpenBLAS. */
extern void openblas_set_num_threads(int n) __attribute__((weak));

/* Doubles that a Krylov solve keeps for an equation: directions of GMRES and what it adds to them. */
enum { VECTORS = 110 };

typedef struct {
  const pw_petsc_module *module;
  void *system;
  bool multigrid, symmetric;
  int threads;
} engine;

#ifdef PW_HAVE_PETSC
/* The library is found beside the program, and stays loaded. */
static pw_status load_module(const pw_petsc_module **out)
{
  static const pw_petsc_module *module = NULL;
  char text[PW_PETSC_TEXT] = "";
  if (!module) {
    void *library = dlopen(PW_PETSC_LIBRARY, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    PW_REQUIRE(library, PW_ERR_UNSUPPORTED, "implicit.solver: PETSc cannot be loaded: %s",
               dlerror());
    const pw_petsc_module *found = dlsym(library, PW_PETSC_SYMBOL);
    PW_REQUIRE(found && found->version == PW_PETSC_VERSION, PW_ERR_UNSUPPORTED,
               "implicit.solver: %s belongs to another version of this program", PW_PETSC_LIBRARY);
    pw_status s = found->start(text);
    PW_REQUIRE(s == PW_OK, PW_ERR_UNSUPPORTED, "implicit.solver: PETSc does not start: %s", text);
    module = found;
  }
  *out = module;
  return PW_OK;
}
#else
static pw_status load_module(const pw_petsc_module **out)
{
  (void)out;
  return pw_error_set(PW_ERR_UNSUPPORTED, __FILE__, __LINE__, __func__,
                      "implicit.solver: this program was built without PETSc (Debian: petsc-dev), "
                      "which the engines petsc_gamg and petsc_ilu need");
}
#endif

bool pw_solver_has_petsc(void)
{
  const pw_petsc_module *module = NULL;
  return load_module(&module) == PW_OK;
}

pw_off pw_solver_petsc_bytes(const pw_csr *m)
{
  return m->start[m->n] * 2 * (pw_off)(sizeof(pw_real) + sizeof(pw_idx)) +
         (pw_off)m->n * VECTORS * (pw_off)sizeof(pw_real);
}

static pw_status engine_create(const pw_solver_options *options, void **state)
{
  engine *e = NULL;
  const pw_petsc_module *module = NULL;
  char text[PW_PETSC_TEXT] = "";
  PW_TRY(load_module(&module));
  PW_TRY(pw_mem_alloc("PETSc solver", 1, sizeof *e, &e));
  *e = (engine){.module = module,
                .multigrid = options->engine == PW_SOLVER_PETSC_GAMG,
                .symmetric = options->symmetric,
                .threads = options->threads};
  pw_petsc_setup setup = {.symmetric = e->symmetric, .multigrid = e->multigrid, .x = options->x};
  pw_status s = module->create(&setup, &e->system, text);
  if (s != PW_OK) {
    pw_mem_free(&e);
    return pw_error_set(s, __FILE__, __LINE__, __func__, "PETSc: %s", text);
  }
  *state = e;
  return PW_OK;
}

static void engine_destroy(void **state)
{
  engine *e = *state;
  e->module->destroy(&e->system);
  pw_mem_free(state);
}

static pw_status engine_factor(void *state, const pw_csr *m, pw_solver_counts *counts)
{
  engine *e = state;
  char text[PW_PETSC_TEXT] = "";
  if (&openblas_set_num_threads) {
    openblas_set_num_threads(e->threads);
  }
  counts->factors++;
  counts->factor_bytes = pw_solver_petsc_bytes(m);
  pw_status s = e->module->load(e->system, m, text);
  PW_REQUIRE(s == PW_OK, s, "PETSc: %s", text);
  return PW_OK;
}

static pw_status engine_solve(void *state, const pw_csr *m, pw_real reduction, const pw_real *b,
                              pw_real *x, pw_solver_counts *counts)
{
  engine *e = state;
  char text[PW_PETSC_TEXT] = "";
  int iterations = 0;
  (void)m;
  pw_status s = e->module->solve(e->system, reduction, b, x, &iterations, text);
  counts->last = iterations;
  PW_REQUIRE(s == PW_OK, s, "PETSc: %s", text);
  return PW_OK;
}

static void engine_forget(void *state)
{
  const engine *e = state;
  e->module->forget(e->system);
}

static const char *engine_describe(const void *state)
{
  const engine *e = state;
  return e->multigrid ? (e->symmetric ? "PETSc, conjugate gradients with algebraic multigrid"
                                      : "PETSc, GMRES with algebraic multigrid")
                      : (e->symmetric ? "PETSc, conjugate gradients with ICC(0)"
                                      : "PETSc, GMRES with ILU(0)");
}

const pw_solver_calls pw_solver_petsc_calls = {engine_create, engine_destroy, engine_factor,
                                               engine_solve,  engine_forget,  engine_describe};
