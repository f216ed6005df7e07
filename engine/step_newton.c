/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/step_newton.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"
#include "engine/newton_part.h"
#include "engine/scene_solid.h"
#include "engine/tet_follow.h"

static const pw_real rigid = 1e-9; /* change of lengths by a motion that only turns */

pw_newton_options pw_newton_defaults(void)
{
  return (pw_newton_options){.tolerance = 1e-9,
                             .max_iterations = 20,
                             .max_cuts = 10,
                             .from_previous = true,
                             .approach = 4,
                             .line_search = 4,
                             .volume_limit = 10.0,
                             .mechanisms = PW_MECHANISMS_WARN};
}

pw_newton_options pw_newton_options_of(const pw_scene_implicit *p)
{
  pw_newton_options o = pw_newton_defaults();
  o.tolerance = p->tolerance;
  o.max_iterations = p->max_iterations;
  o.max_cuts = p->max_cuts;
  o.from_previous = p->from_previous;
  o.approach = p->approach;
  o.line_search = p->line_search;
  o.cut_driven = p->cut_driven;
  o.mechanisms = (pw_mechanisms)p->mechanisms;
  o.solver = (pw_solver_engine)p->solver;
  return o;
}

static pw_status allocate(pw_newton *n)
{
  const pw_off dofs = (pw_off)n->dofs;
  const pw_newton_options *o = &n->options;
  PW_TRY(pw_mem_alloc("newton: displacement", dofs, sizeof *n->u, &n->u));
  PW_TRY(pw_mem_alloc("newton: displacement before", dofs, sizeof *n->previous, &n->previous));
  PW_TRY(pw_mem_alloc("newton: start out of balance", dofs, sizeof *n->rest, &n->rest));
  PW_TRY(pw_mem_alloc("newton: unbalanced", dofs, sizeof *n->unbalanced, &n->unbalanced));
  PW_TRY(pw_mem_alloc("newton: right-hand side", dofs, sizeof *n->right, &n->right));
  PW_TRY(pw_mem_alloc("newton: correction", dofs, sizeof *n->delta, &n->delta));
  if (o->approach > 0) {
    PW_TRY(pw_mem_alloc("newton: way to a part", dofs, sizeof *n->way, &n->way));
  }
  if (o->line_search > 0) {
    PW_TRY(pw_mem_alloc("newton: line search", dofs, sizeof *n->tried, &n->tried));
  }
  if (o->newmark.on) {
    PW_TRY(pw_tet_rates_create(n->model, &o->newmark, &n->rates));
  } else if (o->mechanisms != PW_MECHANISMS_IGNORE) {
    PW_TRY(pw_mechanism_create(n->model, &n->mechanism));
  }
  pw_solver_options solver = pw_solver_defaults(n->system.symmetric);
  solver.engine = o->solver;
  solver.x = n->system.x;
  if (o->mechanisms !=
      PW_MECHANISMS_ERROR) { /* such a matrix is singular, but its equations agree */
    solver.least_pivot = 0.0;
  }
  return pw_solver_create(&solver, &n->solver);
}

static pw_status check_options(const pw_newton_options *o)
{
  PW_REQUIRE(o->tolerance > 0.0 && o->max_iterations >= 1 &&
                 o->max_iterations <= PW_NEWTON_HISTORY && o->max_cuts >= 0 && o->max_cuts <= 40,
             PW_ERR_ARGUMENT, "a Newton iteration to %g in %d steps with %d cuts", o->tolerance,
             o->max_iterations, o->max_cuts);
  PW_REQUIRE(
      o->approach >= 0 && o->approach <= 20 && o->line_search >= 0 && o->line_search <= 20 &&
          o->volume_limit > 1.0,
      PW_ERR_ARGUMENT,
      "a Newton iteration with %d halvings of the way, %d parts of a correction, volumes changing "
      "by factors up to %g",
      o->approach, o->line_search, o->volume_limit);
  return PW_OK;
}

static pw_status create(const pw_newton_system *system, pw_tet_model *model,
                        const pw_newton_options *options, pw_newton **out)
{
  PW_TRY(check_options(options));
  pw_newton *n = NULL;
  PW_TRY(pw_mem_alloc("newton", 1, sizeof *n, &n));
  n->system = *system;
  n->model = model;
  n->options = *options;
  n->dofs = system->dofs;
  pw_status s = allocate(n);
  if (s != PW_OK) {
    pw_newton_destroy(&n);
    return s;
  }
  *out = n;
  return PW_OK;
}

static pw_status begin_tets(void *ctx)
{
  return pw_tet_model_begin(ctx);
}

static pw_status evaluate_tets(void *ctx, const pw_real *u, bool tangent)
{
  return pw_tet_model_evaluate(ctx, u, tangent);
}

static void reload_tets(void *ctx, const pw_real *u)
{
  pw_tet_follow_forces(ctx, u);
}

static void settle_tets(void *ctx, bool on)
{
  pw_tet_model *m = ctx;
  m->guide.settled = on;
}

static void volumes_of_tets(void *ctx, const pw_real *u, pw_real *ratio)
{
  pw_tet_model_volumes(ctx, u, ratio);
}

static void commit_tets(void *ctx, const pw_real *u)
{
  pw_tet_model_commit(ctx, u);
}

pw_status pw_newton_create(pw_tet_model *model, const pw_newton_options *options, pw_newton **out)
{
  const pw_newton_system system = {.ctx = model,
                                   .dofs = 3 * (size_t)model->mesh->tets.nnode,
                                   .csr = &model->csr,
                                   .equation = model->equation,
                                   .fixed = model->fixed,
                                   .prescribed = model->prescribed,
                                   .external = model->external,
                                   .follow = model->follow,
                                   .force = model->force,
                                   .lift = model->lift,
                                   .rounding = &model->rounding,
                                   .time = &model->time,
                                   .dt = &model->dt,
                                   .x = model->mesh->x,
                                   .symmetric = pw_tet_model_is_symmetric(model),
                                   .begin = begin_tets,
                                   .evaluate = evaluate_tets,
                                   .reload = model->follow ? reload_tets : NULL,
                                   .settle = model->guide.of ? settle_tets : NULL,
                                   .volumes = volumes_of_tets,
                                   .commit = commit_tets};
  return create(&system, model, options, out);
}

pw_status pw_newton_create_for(const pw_newton_system *system, const pw_newton_options *options,
                               pw_newton **out)
{
  PW_REQUIRE(!options->newmark.on && options->mechanisms == PW_MECHANISMS_IGNORE, PW_ERR_ARGUMENT,
             "dynamics and the search for mechanisms need a model of tetrahedra");
  return create(system, NULL, options, out);
}

void pw_newton_destroy(pw_newton **newton)
{
  pw_newton *n = *newton;
  if (!n) {
    return;
  }
  pw_solver_destroy(&n->solver);
  if (n->options.newmark.on) {
    pw_tet_rates_destroy(n->model, &n->rates);
  }
  pw_mechanism_destroy(&n->mechanism);
  pw_mem_free(&n->u);
  pw_mem_free(&n->previous);
  pw_mem_free(&n->rest);
  pw_mem_free(&n->unbalanced);
  pw_mem_free(&n->way);
  pw_mem_free(&n->tried);
  pw_mem_free(&n->right);
  pw_mem_free(&n->delta);
  pw_mem_free(newton);
}

void pw_newton_watch(pw_newton *n, pw_newton_watcher watcher)
{
  n->watcher = watcher;
}

const pw_real *pw_newton_displacement(const pw_newton *n)
{
  return n->u;
}

pw_tet_rates *pw_newton_rates(pw_newton *n)
{
  return n->options.newmark.on ? &n->rates : NULL;
}

const pw_solver *pw_newton_solver(const pw_newton *n)
{
  return n->solver;
}

static pw_status find_mechanisms(pw_newton *n, pw_newton_report *report)
{
  const pw_mechanism_report *r = &report->mechanisms;
  if (!n->mechanism.piece) {
    return PW_OK;
  }
  pw_mechanism_find(n->model, &n->mechanism, &report->mechanisms);
  PW_REQUIRE(r->free == 0 || n->options.mechanisms != PW_MECHANISMS_ERROR, PW_ERR_SCENE,
             "%d groups of elements with points, %d elements in all, hang on the rest by less than "
             "three nodes not in a line or on nothing; the first, of element %d, can move in %d "
             "ways without strain",
             (int)r->free, (int)r->elements, (int)r->first, (int)r->motions);
  return PW_OK;
}

/* Where the mesh turns without a change of shape, what it turns with goes on along with it: so does the
 * guess for the part that follows. */
static void turn_previous(pw_newton *n, const pw_motion *was)
{
  const pw_motion *is = &n->model->mesh->motion;
  const size_t l = n->dofs / 3;
  pw_real turn[9], off = 0.0;
  for (size_t i = 0; i < 9; i++) {
    const pw_real *row = is->map + i - i % 3, *column = was->back + i % 3;
    turn[i] =
        was->moved ? row[0] * column[0] + row[1] * column[3] + row[2] * column[6] : is->map[i];
  }
  for (size_t i = 0; i < 9; i++) {
    const pw_real *a = turn + i - i % 3, *b = turn + 3 * (i % 3);
    off = pw_max(off, fabs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] - (i % 4 == 0 ? 1.0 : 0.0)));
  }
  for (size_t a = 0; off <= rigid && a < l; a++) {
    const pw_real v[3] = {n->previous[a], n->previous[l + a], n->previous[2 * l + a]};
    for (size_t c = 0; c < 3; c++) {
      n->previous[c * l + a] = turn[3 * c] * v[0] + turn[3 * c + 1] * v[1] + turn[3 * c + 2] * v[2];
    }
  }
}

/* Put the mesh where it belongs. */
static pw_status move_mesh(pw_newton *n, const pw_newton_load *load, pw_real t1)
{
  if (!load->move) {
    return PW_OK;
  }
  const pw_motion was = n->model ? n->model->mesh->motion : (pw_motion){.moved = false};
  PW_TRY(load->move(load->ctx, n->model, t1));
  if (n->model && n->model->mesh->motion.moved) {
    turn_previous(n, &was);
  }
  return PW_OK;
}

/* A converged part becomes the past. */
static pw_status finish_part(pw_newton *n, const pw_newton_load *load, const pw_real *t)
{
  if (n->options.newmark.on) {
    pw_tet_rates_commit(n->model, &n->rates);
  }
  n->system.commit(n->system.ctx, n->u);
  for (size_t i = 0; i < n->dofs; i++) {
    n->previous[i] = n->u[i] / *n->system.dt; /* the next step may be longer */
  }
  n->has_previous = true;
  if (load->converged) {
    load->converged(load->ctx, n->model, t[1]);
  }
  return move_mesh(n, load, t[1]);
}

/* The error record names the residuals of the last attempt. */
static pw_status give_up(const pw_newton_report *report, const pw_real *t, const char *more)
{
  char text[256] = "", reason[256];
  size_t used = 0;
  snprintf(reason, sizeof reason, "%s", pw_error_text());
  for (int i = 0; i < report->count && used < sizeof text - 16; i++) {
    used += (size_t)snprintf(text + used, sizeof text - used, " %.2e", report->residual[i]);
  }
  return pw_error_set(PW_RETRY_DIVERGED, __FILE__, __LINE__, __func__,
                      "no balance between t = %g and %g of a load step after %d cuts (%s)%s; "
                      "residuals:%s",
                      t[0], t[1], report->cuts, reason, more, text);
}

/* Whether putting the mesh back in between changes what moves the body. */
static bool is_driven(const pw_newton *n, const pw_newton_load *load)
{
  bool driven = false;
  for (size_t i = 0; i < n->dofs && !load->move; i++) {
    driven = driven || (n->system.fixed[i] && n->system.prescribed[i] != 0.0);
  }
  return driven;
}

/* After a failure: a smaller part is to follow, or else what ends the step. */
static pw_status cut(pw_newton *n, const pw_newton_load *load, const pw_real *t, int cuts,
                     pw_newton_report *report)
{
  if (cuts == n->options.max_cuts) {
    return give_up(report, t, "");
  }
  if (!n->options.cut_driven && is_driven(n, load)) {
    return give_up(report, t,
                   ", and a cut would put the mesh back under its driven nodes: move the mesh with "
                   "them, take smaller steps, or allow cut_driven");
  }
  n->has_previous = false;
  report->cuts++;
  return PW_OK;
}

pw_status pw_newton_step(pw_newton *n, const pw_newton_load *load, pw_newton_report *report)
{
  pw_real t[2] = {0.0, 1.0}, size = 1.0;
  int cuts = 0;
  *report = (pw_newton_report){.last = PW_OK};
  PW_REQUIRE(!n->options.newmark.on || load->step_s > 0.0, PW_ERR_ARGUMENT,
             "a dynamic step of %g s", load->step_s);
  while (t[0] < 1.0) {
    t[1] = t[0] + size < 1.0 - 1e-9 ? t[0] + size : 1.0;
    PW_TRY(n->system.begin(n->system.ctx));
    PW_TRY(find_mechanisms(n, report));
    pw_status s = pw_newton_solve_part(n, load, t, report);
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
    PW_TRY(cut(n, load, t, cuts, report));
    size = 0.5 * (t[1] - t[0]);
    cuts++;
  }
  return PW_OK;
}

/* A step of a course as a load from 0 to 1. */
static void apply_course(void *ctx, pw_tet_model *model, pw_real t0, pw_real t1)
{
  const pw_newton_course *c = ctx;
  c->apply(c->ctx, model, c->now + t0 * c->size, c->now + t1 * c->size);
}

static pw_status move_course(void *ctx, pw_tet_model *model, pw_real t1)
{
  const pw_newton_course *c = ctx;
  return c->move(c->ctx, model, c->now + t1 * c->size);
}

pw_real pw_newton_next_size(const pw_newton_course *c, pw_real size, const pw_newton_report *report)
{
  const bool hard = report->cuts > 0 || report->approaches > 0 || report->iterations >= c->hard;
  const pw_real factor = hard ? c->shrink : report->iterations <= c->easy ? c->grow : 1.0;
  return pw_max(c->least, pw_min(c->most, factor * size));
}

pw_status pw_newton_advance(pw_newton *n, pw_newton_course *c, pw_newton_report *report)
{
  const pw_real left = c->end - c->now;
  pw_newton_course step = *c;
  *report = (pw_newton_report){.last = PW_OK};
  PW_REQUIRE(left > 0.0 && c->least > 0.0 && c->least <= c->most && c->easy < c->hard &&
                 c->grow >= 1.0 && c->shrink > 0.0 && c->shrink <= 1.0,
             PW_ERR_ARGUMENT,
             "a course from %g to %g s in steps of %g to %g s, growing by %g up to %d iterations, "
             "shrinking by %g from %d on",
             c->now, c->end, c->least, c->most, c->grow, c->easy, c->shrink, c->hard);
  step.size = pw_max(c->least, pw_min(c->most, c->size));
  const pw_real wanted = step.size;
  const bool last = step.size > (1.0 - 1e-9) * left;
  step.size = last ? left : step.size;
  const pw_newton_load load = {.ctx = &step,
                               .start_s = step.now,
                               .step_s = step.size,
                               .apply = apply_course,
                               .move = c->move ? move_course : NULL};
  PW_TRY(pw_newton_step(n, &load, report));
  c->now = last ? c->end : c->now + step.size;
  c->size = pw_newton_next_size(c, wanted, report);
  return PW_OK;
}
