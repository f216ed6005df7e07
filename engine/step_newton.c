/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/step_newton.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"

static const pw_real hopeless = 1e8; /* a residual this far above the first ends a part */

struct pw_newton {
  pw_tet_model *model;
  pw_newton_options options;
  pw_solver *solver;
  size_t dofs;       /* 3 nnode */
  pw_real *u;        /* [3][nnode] displacement over the part at hand */
  pw_real *previous; /* [3][nnode] displacement over the part before, per unit of t */
  bool has_previous;
  pw_real *unbalanced;    /* [3][nnode] R0 times 1 - alpha */
  pw_real *right, *delta; /* [3 nnode] by equation */
  pw_real floor;          /* residual that rounding may leave */
};

pw_newton_options pw_newton_defaults(void)
{
  return (pw_newton_options){
      .tolerance = 1e-9, .max_iterations = 20, .max_cuts = 10, .from_previous = true};
}

static pw_status allocate(pw_newton *n)
{
  const pw_off dofs = (pw_off)n->dofs;
  PW_TRY(pw_mem_alloc("newton: displacement", dofs, sizeof *n->u, &n->u));
  PW_TRY(pw_mem_alloc("newton: displacement before", dofs, sizeof *n->previous, &n->previous));
  PW_TRY(pw_mem_alloc("newton: unbalanced", dofs, sizeof *n->unbalanced, &n->unbalanced));
  PW_TRY(pw_mem_alloc("newton: right-hand side", dofs, sizeof *n->right, &n->right));
  PW_TRY(pw_mem_alloc("newton: correction", dofs, sizeof *n->delta, &n->delta));
  return pw_solver_create(n->model->fbar == PW_FBAR_NONE, 1, &n->solver);
}

pw_status pw_newton_create(pw_tet_model *model, const pw_newton_options *options, pw_newton **out)
{
  PW_REQUIRE(options->tolerance > 0.0 && options->max_iterations >= 1 &&
                 options->max_iterations <= PW_NEWTON_HISTORY && options->max_cuts >= 0 &&
                 options->max_cuts <= 40,
             PW_ERR_ARGUMENT, "a Newton iteration to %g in %d steps with %d cuts",
             options->tolerance, options->max_iterations, options->max_cuts);
  pw_newton *n = NULL;
  PW_TRY(pw_mem_alloc("newton", 1, sizeof *n, &n));
  n->model = model;
  n->options = *options;
  n->dofs = 3 * (size_t)model->mesh->tets.nnode;
  pw_status s = allocate(n);
  if (s != PW_OK) {
    pw_newton_destroy(&n);
    return s;
  }
  *out = n;
  return PW_OK;
}

void pw_newton_destroy(pw_newton **newton)
{
  pw_newton *n = *newton;
  if (!n) {
    return;
  }
  pw_solver_destroy(&n->solver);
  pw_mem_free(&n->u);
  pw_mem_free(&n->previous);
  pw_mem_free(&n->unbalanced);
  pw_mem_free(&n->right);
  pw_mem_free(&n->delta);
  pw_mem_free(newton);
}

const pw_real *pw_newton_displacement(const pw_newton *n)
{
  return n->u;
}

const pw_solver *pw_newton_solver(const pw_newton *n)
{
  return n->solver;
}

/* Right-hand side from what is left at free components, and its norm over that of all loads. */
static pw_real residual(pw_newton *n)
{
  const pw_tet_model *m = n->model;
  pw_real left = 0.0, load = 0.0;
  for (size_t i = 0; i < n->dofs; i++) {
    const pw_idx eq = m->equation[i];
    pw_real r = m->external[i] + n->unbalanced[i] - m->force[i];
    if (eq >= 0) {
      n->right[eq] = r;
      left += r * r;
      load += m->external[i] * m->external[i];
    } else { /* a reaction */
      load += m->fixed[i] ? m->force[i] * m->force[i] : 0.0;
    }
  }
  if (!(load > 0.0)) { /* nothing acts: all that may be left is rounding */
    n->floor = 0.0;
    return sqrt(left) <= m->rounding ? 0.0 : INFINITY;
  }
  n->floor = m->rounding / sqrt(load);
  return sqrt(left / load);
}

static pw_status correct(pw_newton *n)
{
  const pw_tet_model *m = n->model;
  if (m->csr.n == 0) {
    return PW_OK;
  }
  PW_TRY(pw_solver_factor(n->solver, &m->csr));
  PW_TRY(pw_solver_solve(n->solver, &m->csr, n->right, n->delta));
  for (size_t i = 0; i < n->dofs; i++) {
    n->u[i] += m->equation[i] >= 0 ? n->delta[m->equation[i]] : 0.0;
  }
  return PW_OK;
}

static void prescribe(pw_newton *n)
{
  const pw_tet_model *m = n->model;
  for (size_t i = 0; i < n->dofs; i++) {
    n->u[i] = m->fixed[i] ? m->prescribed[i] : n->u[i];
  }
}

/* First guess from the tangent at the start: free nodes follow the prescribed ones linearly. */
static pw_status predict(pw_newton *n)
{
  const pw_tet_model *m = n->model;
  residual(n);
  for (size_t i = 0; i < n->dofs; i++) {
    if (m->equation[i] >= 0) {
      n->right[m->equation[i]] -= m->lift[i];
    }
  }
  PW_TRY(correct(n));
  prescribe(n);
  return PW_OK;
}

/* First guess. Where the part is not the rest of the step, or nothing better is known, the forces
 * and the tangent at the start are needed. */
static pw_status start_part(pw_newton *n, const pw_newton_load *load, pw_real t0, pw_real t1)
{
  pw_tet_model *m = n->model;
  const pw_real alpha = (t1 - t0) / (1.0 - t0);
  const bool whole = t1 >= 1.0, guess = n->options.from_previous && n->has_previous;
  memset(n->u, 0, n->dofs * sizeof *n->u);
  memset(n->unbalanced, 0, n->dofs * sizeof *n->unbalanced);
  load->apply(load->ctx, m, t0, t1);
  if (!whole || !guess) {
    PW_TRY(pw_tet_model_evaluate(m, n->u, !guess));
  }
  if (!whole) { /* loads are taken to grow from their values at t0 */
    load->apply(load->ctx, m, t0, t0);
    for (size_t i = 0; i < n->dofs; i++) {
      n->unbalanced[i] = m->equation[i] >= 0 ? (1.0 - alpha) * (m->force[i] - m->external[i]) : 0.0;
    }
    load->apply(load->ctx, m, t0, t1);
  }
  if (!guess) {
    return predict(n);
  }
  for (size_t i = 0; i < n->dofs; i++) {
    n->u[i] = m->equation[i] >= 0 ? (t1 - t0) * n->previous[i] : 0.0;
  }
  prescribe(n);
  return PW_OK;
}

/* One part: PW_OK with u at balance, or a positive code where a smaller part may help. */
static pw_status solve_part(pw_newton *n, const pw_newton_load *load, const pw_real *t,
                            pw_newton_report *report)
{
  report->count = 0;
  PW_TRY(start_part(n, load, t[0], t[1]));
  for (;;) {
    PW_TRY(pw_tet_model_evaluate(n->model, n->u, true));
    pw_real r = residual(n);
    report->residual[report->count++] = r;
    if (r <= pw_max(n->options.tolerance, n->floor)) {
      return PW_OK;
    }
    PW_REQUIRE(r <= hopeless * report->residual[0], PW_RETRY_DIVERGED,
               "the residual is %g after %d iterations", r, report->count - 1);
    PW_REQUIRE(report->count < n->options.max_iterations, PW_RETRY_DIVERGED,
               "the residual is %g after %d iterations", r, report->count - 1);
    report->iterations++;
    PW_TRY(correct(n));
  }
}

/* A converged part becomes the past. */
static pw_status finish_part(pw_newton *n, const pw_newton_load *load, const pw_real *t)
{
  pw_tet_model_commit(n->model, n->u);
  for (size_t i = 0; i < n->dofs; i++) {
    n->previous[i] = n->u[i] / (t[1] - t[0]);
  }
  n->has_previous = true;
  return load->move ? load->move(load->ctx, n->model, t[1]) : PW_OK;
}

/* The error record names the residuals of the last attempt. */
static pw_status give_up(const pw_newton_report *report, const pw_real *t)
{
  char text[256] = "", reason[256];
  size_t used = 0;
  snprintf(reason, sizeof reason, "%s", pw_error_text());
  for (int i = 0; i < report->count && used < sizeof text - 16; i++) {
    used += (size_t)snprintf(text + used, sizeof text - used, " %.2e", report->residual[i]);
  }
  return pw_error_set(PW_RETRY_DIVERGED, __FILE__, __LINE__, __func__,
                      "no balance between t = %g and %g of a load step after %d cuts (%s); "
                      "residuals:%s",
                      t[0], t[1], report->cuts, reason, text);
}

pw_status pw_newton_step(pw_newton *n, const pw_newton_load *load, pw_newton_report *report)
{
  pw_real t[2] = {0.0, 1.0}, size = 1.0;
  int cuts = 0;
  *report = (pw_newton_report){.last = PW_OK};
  while (t[0] < 1.0) {
    t[1] = t[0] + size < 1.0 - 1e-9 ? t[0] + size : 1.0;
    PW_TRY(pw_tet_model_begin(n->model));
    pw_status s = solve_part(n, load, t, report);
    if (s == PW_OK) {
      PW_TRY(finish_part(n, load, t));
      t[0] = t[1];
      size *= cuts > 0 ? 1.0 : 2.0;
      cuts = 0;
      report->parts++;
      continue;
    }
    report->last = s;
    if (s < 0) {
      return s;
    }
    if (cuts == n->options.max_cuts) {
      return give_up(report, t);
    }
    n->has_previous = false;
    size = 0.5 * (t[1] - t[0]);
    cuts++;
    report->cuts++;
  }
  return PW_OK;
}
