/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/newton_part.h"

#include <math.h>
#include <string.h>

static const pw_real hopeless = 1e8;    /* a residual this far above the first ends a part */
static const pw_real on_the_way = 1e-3; /* residual of a solution that only leads to another */
static const int settled_after = 2;     /* iterations that choose the substeps of materials */
static const pw_real slack = 0.8;       /* part of the slope a correction may leave */
static const pw_real sufficient = 0.5;  /* part of the residual that is good in any case */
static const pw_real shortest = 0.1;    /* of a correction, over the part tried before */
static const pw_real loosest = 1e-3;    /* part that an iterative solve may leave, at most */
static const pw_real tightest = 1e-12;  /* and at least */
static const pw_real negligible = 1e-9; /* part of the load that may act on nothing */
static const pw_real light = 1e-6;      /* the same on nodes that hardly have material */

static bool dynamic(const pw_newton *n)
{
  return n->options.newmark.on;
}

static pw_status evaluate(pw_newton *n, bool tangent)
{
  if (dynamic(n)) {
    pw_tet_rates_update(n->model, &n->rates, n->u, n->model->dt);
  }
  return n->system.evaluate(n->system.ctx, n->u, tangent);
}

static pw_real external_at(const pw_newton_system *m, size_t i)
{
  return m->external[i] + (m->follow ? m->follow[i] : 0.0);
}

static pw_real inertia_at(const pw_newton *n, size_t i)
{
  const pw_real *known = dynamic(n) ? n->model->inertia.force : n->system.inertia;
  return known ? known[i] : 0.0;
}

/* Loads for the part from t0 to t1, those that follow at the u at hand. */
static void apply(pw_newton *n, const pw_newton_load *load, pw_real t0, pw_real t1)
{
  load->apply(load->ctx, n->model, t0, t1);
  if (n->system.reload) {
    n->system.reload(n->system.ctx, n->u);
  }
}

/* Right-hand side from what is left at free components, and its norm over that of all loads. */
static pw_real residual(pw_newton *n)
{
  const pw_newton_system *m = &n->system;
  pw_real left = 0.0, load = 0.0;
  for (size_t i = 0; i < n->dofs; i++) {
    const pw_idx eq = m->equation[i];
    const pw_real inertia = inertia_at(n, i);
    if (eq >= 0) {
      const pw_real external = external_at(m, i);
      const pw_real r = external + n->unbalanced[i] - m->force[i] - inertia;
      n->right[eq] = r;
      left += r * r;
      load += external * external + inertia * inertia;
    } else if (m->fixed[i]) { /* a reaction */
      load += (m->force[i] + inertia) * (m->force[i] + inertia);
    }
  }
  if (!(load > 0.0)) { /* nothing acts: all that may be left is rounding */
    n->floor = 0.0;
    return sqrt(left) <= *m->rounding ? 0.0 : INFINITY;
  }
  n->floor = *m->rounding / sqrt(load);
  return sqrt(left / load);
}

/* What an iterative solve is to leave of the residual r: no more than Newton's method itself will,
 * by what the last correction did (Eisenstat & Walker, SIAM J. Sci. Comput. 17 (1996) 16, choice 2),
 * but nothing below the tolerance. */
static void aim(pw_newton *n, pw_real tolerance, const pw_newton_report *report)
{
  const int k = report->count - 1;
  const pw_real r = report->residual[k], before = k > 0 ? report->residual[k - 1] : INFINITY;
  const pw_real speed = k > 0 ? (r / before) * (r / before) : loosest;
  const pw_real enough = 0.1 * pw_max(tolerance, n->floor) / r;
  pw_solver_aim(n->solver, pw_max(tightest, pw_max(enough, pw_min(speed, loosest))));
}

/* Solve for the correction of the right-hand side. */
static pw_status solve(pw_newton *n)
{
  const pw_newton_system *m = &n->system;
  if (m->csr->n == 0) {
    return PW_OK;
  }
  PW_TRY(pw_solver_factor(n->solver, m->csr));
  return pw_solver_solve(n->solver, m->csr, n->right, n->delta);
}

/* u += part of the correction */
static void add_correction(pw_newton *n, pw_real part)
{
  const pw_newton_system *m = &n->system;
  for (size_t i = 0; i < n->dofs; i++) {
    n->u[i] += m->equation[i] >= 0 ? part * n->delta[m->equation[i]] : 0.0;
  }
}

static void prescribe(pw_newton *n)
{
  const pw_newton_system *m = &n->system;
  for (size_t i = 0; i < n->dofs; i++) {
    n->u[i] = m->fixed[i] ? m->prescribed[i] : n->u[i];
  }
}

/* First guess from the tangent at the start: free nodes follow the prescribed ones linearly. */
static pw_status predict(pw_newton *n)
{
  const pw_newton_system *m = &n->system;
  residual(n);
  for (size_t i = 0; i < n->dofs; i++) {
    if (m->equation[i] >= 0) {
      n->right[m->equation[i]] -= m->lift[i];
    }
  }
  pw_solver_aim(n->solver, loosest);
  PW_TRY(solve(n));
  add_correction(n, 1.0);
  prescribe(n);
  return PW_OK;
}

/* R0 from the forces at u = 0, known from the last evaluation; loads are taken to grow from their
 * values at t0. Leaves the loads of t0 behind. */
static void find_rest(pw_newton *n, const pw_newton_load *load, pw_real t0)
{
  const pw_newton_system *m = &n->system;
  apply(n, load, t0, t0);
  for (size_t i = 0; i < n->dofs; i++) {
    n->rest[i] = m->equation[i] >= 0 ? m->force[i] - external_at(m, i) : 0.0;
  }
  n->has_rest = true;
}

/* Loads at t1, and the part of R0 that stays until then. */
static void set_loads(pw_newton *n, const pw_newton_load *load, pw_real t0, pw_real t1)
{
  const pw_real kept = t1 >= 1.0 ? 0.0 : 1.0 - (t1 - t0) / (1.0 - t0);
  apply(n, load, t0, t1);
  for (size_t i = 0; i < n->dofs; i++) {
    n->unbalanced[i] = n->has_rest ? kept * n->rest[i] : 0.0;
  }
}

/* Loads of nodes without points would act on nothing, in a step that converges all the same. On a
 * grid loads come by way of points, but nodes with little of them are left out. */
static pw_status check_loads(const pw_newton *n)
{
  const pw_newton_system *m = &n->system;
  pw_real lost = 0.0, all = 0.0;
  for (size_t i = 0; i < n->dofs; i++) {
    const pw_real force = fabs(m->external[i]);
    all += force;
    lost += m->equation[i] < 0 && !m->fixed[i] ? force : 0.0;
  }
  PW_REQUIRE(n->model || lost <= light * all, PW_ERR_SCENE,
             "%.4g of %.4g N of load act on nodes that method.mass_cut_off leaves out: lower it; "
             "ghost_stabilisation lets such nodes follow their neighbours",
             lost, all);
  PW_REQUIRE(!n->model || lost <= negligible * all, PW_ERR_SCENE,
             "%.4g of %.4g N of load act on nodes without points: the body has left the surface of "
             "the mesh that is loaded; follower: true takes a pressure along with the body, "
             "moving_mesh the mesh",
             lost, all);
  return PW_OK;
}

/* Dynamics: nodes go on as they move. */
static pw_status start_moving(pw_newton *n, const pw_newton_load *load, const pw_real *t)
{
  pw_tet_model *m = n->model;
  const pw_real dt = m->dt;
  pw_tet_rates_start(m, &n->rates);
  if (!n->rates.begun) {
    load->apply(load->ctx, m, t[0], t[0]);
    PW_TRY(evaluate(n, false));
    pw_tet_rates_balance(m, &n->rates);
  }
  set_loads(n, load, t[0], t[1]);
  PW_TRY(check_loads(n));
  for (size_t i = 0; i < n->dofs; i++) {
    const pw_real far = dt * (n->rates.v0[i] + 0.5 * dt * n->rates.a0[i]);
    n->u[i] = m->equation[i] >= 0 ? far : 0.0;
  }
  prescribe(n);
  return PW_OK;
}

/* First guess. Where the part is not the rest of the step, or nothing better is known, the forces
 * and the tangent at the start are needed. */
static pw_status start_part(pw_newton *n, const pw_newton_load *load, const pw_real *t)
{
  const pw_newton_system *m = &n->system;
  const bool whole = t[1] >= 1.0, guess = n->options.from_previous && n->has_previous;
  const pw_real step = load->step_s > 0.0 ? load->step_s : 1.0;
  memset(n->u, 0, n->dofs * sizeof *n->u);
  n->has_rest = false;
  *m->dt = (t[1] - t[0]) * step;
  *m->time = load->start_s + t[0] * step;
  if (dynamic(n)) {
    return start_moving(n, load, t);
  }
  set_loads(n, load, t[0], t[1]);
  PW_TRY(check_loads(n));
  if (!whole || !guess) {
    PW_TRY(evaluate(n, !guess));
  }
  if (!whole && !m->inertia) { /* inertia takes R0 up */
    find_rest(n, load, t[0]);
    set_loads(n, load, t[0], t[1]);
  }
  if (!guess) {
    return predict(n);
  }
  for (size_t i = 0; i < n->dofs; i++) {
    n->u[i] = m->equation[i] >= 0 ? *m->dt * n->previous[i] : 0.0;
  }
  prescribe(n);
  return PW_OK;
}

/* What is out of balance, along the correction: the slope of the potential, where there is one. */
static pw_real slope(const pw_newton *n)
{
  pw_real sum = 0.0;
  for (pw_idx i = 0; i < n->system.csr->n; i++) {
    sum += n->right[i] * n->delta[i];
  }
  return sum;
}

/* The next part of a correction to try: to where the slope, taken as a line, ends. */
static pw_real shorten(pw_real part, pw_real start, pw_real end)
{
  const pw_real zero = start > 0.0 && end < 0.0 ? start / (start - end) : 0.5;
  return part * pw_max(shortest, pw_min(0.5, zero));
}

/* Add the correction or, in a line search, a part of it that takes enough off the slope or off the
 * residual (H. Matthies, G. Strang, Int. J. Numer. Meth. Engng 14 (1979) 1613-1626); r: the residual
 * before and after. Residuals alone mislead: large turns pass through larger ones. */
static pw_status advance(pw_newton *n, pw_real tolerance, pw_real *r, pw_newton_report *report)
{
  const int most = n->options.line_search;
  const pw_real before = *r, start = slope(n);
  pw_real part = 1.0;
  for (int k = 0; k < most; k++, report->searches++) {
    memcpy(n->tried, n->u, n->dofs * sizeof *n->u);
    add_correction(n, part);
    const pw_status s = evaluate(n, true);
    if (s < 0 || (s > 0 && n->approachable)) { /* an approach is cheaper than halves */
      return s;
    }
    pw_real end = start;
    if (s == PW_OK) {
      *r = residual(n);
      end = slope(n);
      const pw_real good = pw_max(sufficient * before, pw_max(tolerance, n->floor));
      if (*r <= good || fabs(end) <= slack * fabs(start)) {
        return PW_OK;
      }
    }
    memcpy(n->u, n->tried, n->dofs * sizeof *n->u);
    part = shorten(part, start, end);
  }
  PW_REQUIRE(most == 0, PW_RETRY_DIVERGED,
             "at a residual of %g no part of a correction helps, down to %g", before, part);
  add_correction(n, part);
  PW_TRY(evaluate(n, true));
  *r = residual(n);
  return PW_OK;
}

/* Near the end the substeps of materials no longer change. */
static void settle(const pw_newton *n, bool on)
{
  if (n->system.settle) {
    n->system.settle(n->system.ctx, on);
  }
}

/* Newton's method from the u at hand. */
static pw_status balance(pw_newton *n, pw_real tolerance, pw_newton_report *report)
{
  pw_real r;
  report->count = 0;
  PW_TRY(evaluate(n, true));
  r = residual(n);
  for (;;) {
    report->residual[report->count++] = r;
    if (n->watcher.look) {
      n->watcher.look(n->watcher.ctx, n->u, r);
    }
    if (r <= pw_max(tolerance, n->floor)) {
      return PW_OK;
    }
    PW_REQUIRE(r <= hopeless * report->residual[0] && report->count < n->options.max_iterations,
               PW_RETRY_DIVERGED, "the residual is %g after %d iterations", r, report->count - 1);
    report->iterations++;
    settle(n, report->count > settled_after && r <= on_the_way);
    aim(n, tolerance, report);
    PW_TRY(solve(n));
    PW_TRY(advance(n, tolerance, &r, report));
  }
}

static pw_status iterate(pw_newton *n, pw_real tolerance, pw_newton_report *report)
{
  const pw_status s = balance(n, tolerance, report);
  settle(n, false);
  return s;
}

/* Solve for the part s of the load of t, from the solution for the part `done` of it in n->way. */
static pw_status try_part(pw_newton *n, const pw_newton_load *load, const pw_real *t, pw_real done,
                          pw_real s, pw_newton_report *report)
{
  const pw_real to = s < 1.0 ? t[0] + s * (t[1] - t[0]) : t[1];
  *n->system.dt = (to - t[0]) * (load->step_s > 0.0 ? load->step_s : 1.0);
  set_loads(n, load, t[0], to);
  if (done > 0.0) {
    for (size_t i = 0; i < n->dofs; i++) {
      n->u[i] = s / done * n->way[i];
    }
    prescribe(n);
  } else {
    memset(n->u, 0, n->dofs * sizeof *n->u);
    PW_TRY(evaluate(n, true));
    PW_TRY(predict(n));
  }
  return iterate(n, s < 1.0 ? on_the_way : n->options.tolerance, report);
}

static pw_status approach(pw_newton *n, const pw_newton_load *load, const pw_real *t,
                          pw_newton_report *report)
{
  const pw_real least = ldexp(1.0, -n->options.approach);
  pw_real done = 0.0, size = 0.5;
  if (!n->has_rest) {
    memset(n->u, 0, n->dofs * sizeof *n->u);
    PW_TRY(evaluate(n, false));
    find_rest(n, load, t[0]);
  }
  report->approaches++;
  while (done < 1.0) {
    const pw_real s = pw_min(done + size, 1.0); /* sums of powers of 1/2 are exact */
    const pw_status status = try_part(n, load, t, done, s, report);
    if (status == PW_OK) {
      memcpy(n->way, n->u, n->dofs * sizeof *n->way);
      done = s;
      size *= 2.0;
    } else if (status < 0 || 0.5 * size < least) {
      return status;
    } else {
      size *= 0.5;
    }
  }
  return PW_OK;
}

/* A solution of another branch, with elements near collapse, is none. */
static pw_status check_volumes(const pw_newton *n)
{
  const pw_real limit = n->options.volume_limit;
  pw_real ratio[2];
  n->system.volumes(n->system.ctx, n->u, ratio);
  PW_REQUIRE(ratio[0] * limit >= 1.0 && ratio[1] <= limit, PW_RETRY_DOMAIN_INVERTED,
             "volumes of elements change by factors from %g to %g", ratio[0], ratio[1]);
  return PW_OK;
}

static pw_status solve_in_one(pw_newton *n, const pw_newton_load *load, const pw_real *t,
                              pw_newton_report *report)
{
  PW_TRY(start_part(n, load, t));
  PW_TRY(iterate(n, n->options.tolerance, report));
  return check_volumes(n);
}

pw_status pw_newton_solve_part(pw_newton *n, const pw_newton_load *load, const pw_real *t,
                               pw_newton_report *report)
{
  report->count = 0;
  n->approachable = n->options.approach > 0 && !dynamic(n) && !n->system.inertia && !load->move;
  const pw_status s = solve_in_one(n, load, t, report);
  if (s <= 0 || !n->approachable) {
    return s;
  }
  PW_TRY(approach(n, load, t, report));
  return check_volumes(n);
}
