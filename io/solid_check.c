/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/solid_check.h"

#include <math.h>
#include <string.h>

#include "engine/core/mem.h"
#include "engine/implicit_state.h"
#include "io/progress.h"

/* Solutions per load step: 2 to 3 elastic, 4 to 7 while yield spreads, 1 to 3 on a plateau. */
static const pw_real usual_iterations = 4.0;

static void print_effects(const pw_implicit *sim, FILE *out)
{
  fprintf(out, "effects, in the order they are called:%s\n", sim->neffect == 0 ? " none" : "");
  for (int k = 0; k < sim->neffect; k++) {
    const pw_effect *type = sim->effect[k].type;
    if (type->many) {
      fprintf(out, "  %s.%d\n", type->name, sim->effect[k].number);
    } else {
      fprintf(out, "  %s\n", type->name);
    }
  }
}

static void print_bodies(const pw_implicit *sim, FILE *out)
{
  pw_idx count[PW_MAX_BODIES] = {0};
  pw_real volume[PW_MAX_BODIES] = {0}, mass[PW_MAX_BODIES] = {0};
  const pw_tet_points *p = &sim->model.points;
  for (pw_idx i = 0; i < p->n; i++) {
    count[p->body[i]]++;
    volume[p->body[i]] += p->volume[i];
    mass[p->body[i]] += p->mass[i];
  }
  fprintf(out, "bodies:\n");
  for (int b = 0; b < sim->scene.nbody; b++) {
    const pw_scene_material *m = &sim->scene.material[sim->scene.body[b].material];
    fprintf(out, "  %-16s %7d points of %s (%s), %.6g m3, %.6g kg\n", sim->scene.body[b].name,
            count[b], m->name, m->model->name, volume[b], mass[b]);
  }
}

static pw_idx held(const pw_implicit *sim)
{
  pw_idx n = 0;
  for (pw_off i = 0; i < 3 * (pw_off)sim->mesh.tets.nnode; i++) {
    n += sim->model.fixed[i];
  }
  return n;
}

static void print_sizes(const pw_implicit *sim, FILE *out)
{
  const pw_tets *t = &sim->mesh.tets;
  fprintf(out, "mesh         %d cells, %d elements, %d nodes\n", sim->mesh.npatch, t->nelem,
          t->nnode);
  fprintf(out, "extent       (%g, %g, %g) m to (%g, %g, %g) m\n", t->low[0], t->low[1], t->low[2],
          t->high[0], t->high[1], t->high[2]);
  fprintf(out, "points       %d\n", sim->model.points.n);
  fprintf(out, "held         %d components of %d\n", held(sim), 3 * t->nnode);
  fprintf(out, "blocks       %d, %d colours\n", sim->model.blocks.nblock,
          sim->model.blocks.ncolour);
  fprintf(out, "threads      %d\n", sim->model.threads);
}

/* The first step as far as its tangent at zero displacement. */
static pw_status begin(pw_implicit *sim, const pw_real *zero)
{
  pw_tet_model *m = &sim->model;
  pw_tet_rates *rates = pw_newton_rates(sim->newton);
  m->dt = sim->scene.solid.implicit.step_s;
  PW_TRY(pw_tet_model_begin(m));
  if (rates) {
    pw_tet_rates_start(m, rates);
    pw_tet_rates_update(m, rates, zero, m->dt);
  }
  return PW_OK;
}

/* Wall clock of one iteration with the tangent of the start. */
static pw_status time_iteration(pw_implicit *sim, pw_real *wall, pw_solver_counts *counts,
                                char *solver_text, size_t size)
{
  pw_tet_model *m = &sim->model;
  pw_real *zero = NULL, *x = NULL;
  pw_solver *solver = NULL;
  const pw_off dofs = 3 * (pw_off)sim->mesh.tets.nnode;
  pw_status s = pw_mem_alloc("check: displacement", dofs, sizeof *zero, &zero);
  s = s == PW_OK ? pw_mem_alloc("check: solution", dofs, sizeof *x, &x) : s;
  s = s == PW_OK ? begin(sim, zero) : s;
  pw_solver_options options = pw_solver_defaults(pw_tet_model_is_symmetric(m));
  options.engine = (pw_solver_engine)sim->scene.solid.implicit.solver;
  options.x = m->mesh->x;
  if (sim->scene.solid.implicit.mechanisms != PW_MECHANISMS_ERROR) {
    options.least_pivot = 0.0; /* as in a step */
  }
  s = s == PW_OK ? pw_solver_create(&options, &solver) : s;
  pw_real start = 0.0;
  for (int k = 0; k < 2 && s == PW_OK; k++) { /* the first time analyses the pattern */
    start = pw_wall_clock();
    s = pw_tet_model_evaluate(m, zero, true);
    s = s == PW_OK && m->csr.n > 0 ? pw_solver_factor(solver, &m->csr) : s;
    s = s == PW_OK && m->csr.n > 0 ? pw_solver_solve(solver, &m->csr, zero, x) : s;
  }
  *wall = pw_wall_clock() - start;
  if (solver) {
    *counts = pw_solver_counted(solver);
    snprintf(solver_text, size, "%s", pw_solver_describe(solver));
  }
  pw_solver_destroy(&solver);
  pw_mem_free(&zero);
  pw_mem_free(&x);
  return s;
}

static pw_status print_estimate(pw_implicit *sim, FILE *out)
{
  pw_real wall = 0.0;
  pw_solver_counts counts = {0};
  char text[32], solver_text[256] = "";
  pw_status s = time_iteration(sim, &wall, &counts, solver_text, sizeof solver_text);
  pw_implicit_report r;
  pw_implicit_report_now(sim, &r);
  fprintf(out, "matrix       %d equations, %lld nonzeros, %s\n", sim->model.csr.n,
          (long long)r.nonzeros, solver_text);
  fprintf(out, "memory       %.1f MiB without the solver\n", (pw_real)pw_mem_bytes() / 1048576.0);
  if (s != PW_OK) {
    fprintf(out, "start        the tangent cannot be factored\n");
    return s;
  }
  const int steps = sim->scene.solid.implicit.steps;
  fprintf(out, "factor       %lld nonzeros, %.1f MiB\n", (long long)counts.factor_nonzeros,
          (pw_real)counts.factor_nonzeros * 12.0 / 1048576.0);
  fprintf(out,
          "time         about %s for %d steps of %g iterations, of %.3g s each; elastic steps take "
          "2 or 3, steps in which yield spreads up to 7\n",
          pw_duration_text(wall * usual_iterations * steps, text, sizeof text), steps,
          usual_iterations, wall);
  return PW_OK;
}

/* Pieces that nothing holds, after the first step has begun. */
static pw_status print_mechanisms(const pw_implicit *sim, FILE *out)
{
  const pw_scene_implicit *p = &sim->scene.solid.implicit;
  pw_mechanism mechanism = {.piece = NULL};
  pw_mechanism_report r;
  if (pw_newton_rates(sim->newton) || p->mechanisms == PW_MECHANISMS_IGNORE) {
    return PW_OK;
  }
  PW_TRY(pw_mechanism_create(&sim->model, &mechanism));
  pw_mechanism_find(&sim->model, &mechanism, &r);
  pw_mechanism_destroy(&mechanism);
  PW_REQUIRE(r.free == 0 || p->mechanisms != PW_MECHANISMS_ERROR, PW_ERR_SCENE,
             "implicit.mechanisms: %d of %d pieces of the body, %d elements, are held by nothing; "
             "the first one has %d free motions",
             r.free, r.pieces, r.elements, r.motions);
  if (r.free > 0) {
    fprintf(out,
            "warning: %d of %d pieces of the body, %d elements, are held by nothing; the first one "
            "has %d free motions\n",
            r.free, r.pieces, r.elements, r.motions);
  }
  return PW_OK;
}

pw_status pw_solid_check_report(pw_implicit *sim, FILE *out)
{
  const char *text;
  print_effects(sim, out);
  print_bodies(sim, out);
  print_sizes(sim, out);
  const pw_status status = print_estimate(sim, out);
  for (int i = 0; (text = pw_implicit_warning(sim, i)) != NULL; i++) {
    fprintf(out, "warning: %s\n", text);
  }
  /* What holds the body tells more than a tangent that cannot be factored. */
  if (status == PW_OK || status == PW_RETRY_DIVERGED) {
    PW_TRY(print_mechanisms(sim, out));
  }
  return status;
}
