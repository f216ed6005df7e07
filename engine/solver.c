/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/solver.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"
#include "engine/solver_parts.h"

static const struct {
  const char *name;
  const pw_solver_calls *calls;
} engines[PW_SOLVER_ENGINES] = {
    [PW_SOLVER_AUTO] = {"automatic", NULL},
    [PW_SOLVER_DIRECT] = {"direct", &pw_solver_direct_calls},
    [PW_SOLVER_KRYLOV] = {"krylov", &pw_solver_krylov_calls},
    [PW_SOLVER_PETSC_GAMG] = {"petsc_gamg", &pw_solver_petsc_calls},
    [PW_SOLVER_PETSC_ILU] = {"petsc_ilu", &pw_solver_petsc_calls},
};

struct pw_solver {
  pw_solver_options options;
  pw_solver_engine chosen; /* PW_SOLVER_AUTO: not yet */
  bool unlucky;            /* iterations of the engine chosen have not converged */
  const pw_solver_calls *calls;
  void *state;
  pw_real reduction;
  pw_solver_counts counts;
  char text[256];
};

pw_solver_options pw_solver_defaults(bool symmetric)
{
  return (pw_solver_options){
      .engine = PW_SOLVER_AUTO, .symmetric = symmetric, .threads = 1, .least_pivot = 1e-13};
}

const char *pw_solver_name(pw_solver_engine engine)
{
  return engine >= 0 && engine < PW_SOLVER_ENGINES ? engines[engine].name : "unknown";
}

bool pw_solver_find(const char *name, pw_solver_engine *engine)
{
  for (int i = 0; i < PW_SOLVER_ENGINES; i++) {
    if (strcmp(name, engines[i].name) == 0) {
      *engine = (pw_solver_engine)i;
      return true;
    }
  }
  return false;
}

/* Replaces the engine at work. */
static pw_status take_engine(pw_solver *s, pw_solver_engine engine)
{
  pw_solver_options options = s->options;
  void *state = NULL;
  options.engine = engine;
  PW_TRY(engines[engine].calls->create(&options, &state));
  if (s->calls) {
    s->calls->destroy(&s->state);
  }
  s->calls = engines[engine].calls;
  s->state = state;
  s->chosen = engine;
  return PW_OK;
}

pw_status pw_solver_create(const pw_solver_options *options, pw_solver **out)
{
  pw_solver *s = NULL;
  PW_REQUIRE(options->threads >= 1, PW_ERR_ARGUMENT, "%d threads for a solver", options->threads);
  PW_REQUIRE(options->engine >= 0 && options->engine < PW_SOLVER_ENGINES, PW_ERR_ARGUMENT,
             "no solver has number %d", (int)options->engine);
  PW_TRY(pw_mem_alloc("linear solver", 1, sizeof *s, &s));
  s->options = *options;
  s->reduction = 1e-10;
  pw_status status = PW_OK;
  if (options->engine != PW_SOLVER_AUTO) {
    status = take_engine(s, options->engine);
  }
  if (status != PW_OK) {
    pw_solver_destroy(&s);
    return status;
  }
  *out = s;
  return PW_OK;
}

void pw_solver_destroy(pw_solver **solver)
{
  pw_solver *s = *solver;
  if (!s) {
    return;
  }
  if (s->calls) {
    s->calls->destroy(&s->state);
  }
  pw_mem_free(solver);
}

static pw_idx most_direct(const pw_solver *s)
{
  if (s->options.most_direct > 0) {
    return s->options.most_direct;
  }
  return s->options.symmetric ? PW_SOLVER_DIRECT_SYMMETRIC : PW_SOLVER_DIRECT_GENERAL;
}

/* The rule of the header. It looks at the matrix alone, so that a restart chooses alike. */
static pw_status choose(pw_solver *s, const pw_csr *m)
{
  if (s->options.engine != PW_SOLVER_AUTO) {
    return PW_OK;
  }
  pw_solver_engine engine = PW_SOLVER_DIRECT;
  if (m->n > most_direct(s)) {
    engine = !s->unlucky && pw_solver_has_petsc() ? PW_SOLVER_PETSC_GAMG : PW_SOLVER_KRYLOV;
  }
  return engine == s->chosen ? PW_OK : take_engine(s, engine);
}

static void write_text(pw_solver *s, const pw_csr *m)
{
  const char *kind = s->options.symmetric ? "symmetric" : "unsymmetric";
  int used = snprintf(s->text, sizeof s->text, "%s: %s, %d %s equations", pw_solver_name(s->chosen),
                      s->calls->describe(s->state), (int)m->n, kind);
  if (s->options.engine == PW_SOLVER_AUTO && used > 0 && (size_t)used < sizeof s->text) {
    snprintf(s->text + used, sizeof s->text - (size_t)used, " (direct up to %d)",
             (int)most_direct(s));
  }
}

pw_status pw_solver_factor(pw_solver *s, const pw_csr *m)
{
  PW_REQUIRE(m->n > 0, PW_ERR_ARGUMENT, "a matrix of %d equations", (int)m->n);
  PW_TRY(choose(s, m));
  write_text(s, m);
  return s->calls->factor(s->state, m, &s->counts);
}

void pw_solver_aim(pw_solver *s, pw_real reduction)
{
  s->reduction = reduction;
}

pw_status pw_solver_solve(pw_solver *s, const pw_csr *m, const pw_real *b, pw_real *x)
{
  PW_REQUIRE(s->calls, PW_ERR_ARGUMENT, "a solver without a matrix");
  pw_status status = s->calls->solve(s->state, m, s->reduction, b, x, &s->counts);
  if (status == PW_RETRY_DIVERGED && s->options.engine == PW_SOLVER_AUTO &&
      s->chosen == PW_SOLVER_PETSC_GAMG) {
    s->unlucky = true;
    PW_TRY(pw_solver_factor(s, m));
    status = s->calls->solve(s->state, m, s->reduction, b, x, &s->counts);
  }
  PW_TRY(status);
  s->counts.solves++;
  s->counts.iterations += s->counts.last;
  pw_real sum = 0.0;
  for (pw_idx i = 0; i < m->n; i++) {
    sum += x[i];
  }
  PW_REQUIRE(isfinite(sum), PW_RETRY_NAN, "the solution of %d equations is no number", (int)m->n);
  return PW_OK;
}

void pw_solver_forget(pw_solver *s)
{
  s->unlucky = false;
  if (s->calls) {
    s->calls->forget(s->state);
  }
}

pw_solver_counts pw_solver_counted(const pw_solver *s)
{
  return s->counts;
}

const char *pw_solver_describe(const pw_solver *s)
{
  return s->calls ? s->text : "no matrix yet";
}

/* Memory that Linux says can be had without swapping; 0: unknown. */
static pw_off bytes_available(void)
{
  long long kib = 0;
  char line[128];
  FILE *f = fopen("/proc/meminfo", "r");
  while (f && kib == 0 && fgets(line, sizeof line, f)) {
    if (sscanf(line, "MemAvailable: %lld kB", &kib) != 1) {
      kib = 0;
    }
  }
  if (f) {
    fclose(f);
  }
  return (pw_off)kib * 1024;
}

pw_status pw_solver_check_memory(const char *what, const pw_csr *m, pw_off bytes, pw_off most)
{
  const pw_off room = most > 0 ? most : bytes_available();
  const pw_off other = pw_solver_petsc_bytes(m);
  PW_REQUIRE(room == 0 || bytes <= room, PW_ERR_MEMORY,
             "%s: the factor of %d equations needs about %.3g GB, %.3g GB can be had: petsc_gamg "
             "would need about %.2g GB%s",
             what, (int)m->n, 1e-9 * (double)bytes, 1e-9 * (double)room, 1e-9 * (double)other,
             other > room ? ", too much as well" : "");
  return PW_OK;
}
