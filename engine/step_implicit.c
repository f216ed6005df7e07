/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/step_implicit.h"

#include "engine/core/mem.h"
#include "engine/newton_archive.h"
#include "engine/update.h"

/* ---- the model as Newton's method sees it ---- */

static pw_status begin(void *ctx)
{
  pw_quad_steps *q = ctx;
  PW_TRY(q->status);
  return pw_quad_model_begin(&q->model);
}

static pw_status evaluate(void *ctx, const pw_real *u, bool tangent)
{
  pw_quad_steps *q = ctx;
  return pw_quad_model_evaluate(&q->model, u, tangent);
}

static void settle(void *ctx, bool on)
{
  pw_quad_steps *q = ctx;
  q->model.guide.settled = on;
}

/* Of the last evaluation, which was that of u. */
static void volumes(void *ctx, const pw_real *u, pw_real *ratio)
{
  const pw_quad_steps *q = ctx;
  (void)u;
  pw_quad_model_volumes(&q->model, ratio);
}

static void commit(void *ctx, const pw_real *u)
{
  pw_quad_steps *q = ctx;
  pw_quad_model_commit(&q->model, u);
}

static pw_status create_newton(pw_quad_steps *q, const pw_scene *scene)
{
  pw_quad_model *m = &q->model;
  pw_newton_options options = pw_newton_options_of(&scene->solid.implicit);
  const pw_newton_system system = {.ctx = q,
                                   .dofs = 2 * (size_t)m->sim->mesh.nnode,
                                   .csr = &m->csr,
                                   .equation = m->equation,
                                   .fixed = m->fixed,
                                   .prescribed = m->prescribed,
                                   .external = m->external,
                                   .force = m->force,
                                   .inertia = m->inertia.force,
                                   .lift = m->lift,
                                   .rounding = &m->rounding,
                                   .time = &m->time,
                                   .dt = &m->dt,
                                   .x = m->x,
                                   .symmetric = pw_quad_model_is_symmetric(m),
                                   .begin = begin,
                                   .evaluate = evaluate,
                                   .settle = m->guide.of ? settle : NULL,
                                   .volumes = volumes,
                                   .commit = commit};
  options.mechanisms = PW_MECHANISMS_IGNORE; /* they are found on tetrahedra */
  return pw_newton_create_for(&system, &options, &q->newton);
}

pw_status pw_quad_steps_create(pw_sim *sim)
{
  if (sim->scene.method.update != PW_IMPLICIT) {
    return PW_OK;
  }
  PW_TRY(pw_mem_alloc("implicit steps", 1, sizeof *sim->quad, &sim->quad));
  sim->quad->wanted = 1.0;
  PW_TRY(pw_quad_model_create(sim, &sim->quad->model));
  PW_TRY(create_newton(sim->quad, &sim->scene));
  sim->dt_next = sim->scene.time.end_s / sim->scene.solid.implicit.steps;
  return PW_OK;
}

void pw_quad_steps_destroy(pw_sim *sim)
{
  if (sim->quad) {
    pw_newton_destroy(&sim->quad->newton);
    pw_quad_model_destroy(&sim->quad->model);
    pw_mem_free(&sim->quad);
  }
}

/* ---- a step ---- */

/* Hooks read the part of the step from the simulation's time and step. */
static void set_time(pw_quad_steps *q, pw_real t0, pw_real t1)
{
  q->model.sim->time = q->start + t0 * q->length;
  q->model.sim->dt = (t1 - t0) * q->length;
}

static void keep_status(pw_quad_steps *q, pw_status s)
{
  q->status = q->status == PW_OK ? s : q->status;
}

static void apply(void *ctx, pw_tet_model *none, pw_real t0, pw_real t1)
{
  pw_quad_steps *q = ctx;
  (void)none;
  set_time(q, t0, t1);
  keep_status(q, pw_quad_model_load(&q->model));
}

static void converged(void *ctx, pw_tet_model *none, pw_real t1)
{
  pw_quad_steps *q = ctx;
  pw_sim *sim = q->model.sim;
  (void)none;
  sim->time = q->start + t1 * q->length;
  q->equations = q->model.csr.n;
  keep_status(q, pw_update_collect(sim));
  keep_status(q, pw_schedule_run(sim, PW_STAGE_END));
}

/* Before the first step: accelerations; forces out of balance, in the records of the nodes. */
static pw_status show_start(pw_quad_steps *q)
{
  pw_quad_model *m = &q->model;
  pw_sim *sim = m->sim;
  const pw_off n = sim->mesh.nnode;
  if (pw_schedule_count(sim, PW_STAGE_START) == 0 && !m->inertia.on) {
    return PW_OK;
  }
  set_time(q, 0.0, 0.0);
  PW_TRY(pw_quad_model_begin(m));
  PW_TRY(pw_quad_model_load(m));
  m->inertia.still = true;
  const pw_status status =
      pw_quad_model_evaluate(m, m->prescribed, false); /* zero: no time has passed */
  m->inertia.still = false;
  PW_TRY(status);
  if (m->inertia.on) {
    pw_quad_inertia_start(m);
  }
  for (pw_off k = 0; k < n; k++) {
    for (pw_off a = 0; a < 2; a++) {
      const pw_off at = a * n + k;
      sim->nodes.rec[k * PW_NODE + PW_NODE_FORCE + a] =
          m->equation[at] >= 0 ? m->external[at] - m->force[at] : 0.0;
    }
  }
  return pw_schedule_run(sim, PW_STAGE_START);
}

/* Length of the next step; what is left to the end is divided evenly when less than two remain. */
static pw_real choose_length(const pw_sim *sim)
{
  const pw_scene_implicit *p = &sim->scene.solid.implicit;
  const pw_real whole = sim->scene.time.end_s / p->steps, left = sim->scene.time.end_s - sim->time;
  const pw_real wanted = whole * (p->adaptive ? sim->quad->wanted : 1.0);
  if (left <= 0.0) { /* past the end: more of the same */
    return whole;
  }
  return left < 1.000001 * wanted ? left : left < 1.999999 * wanted ? 0.5 * left : wanted;
}

/* Steps that were easy make the next one longer. */
static void choose_next(pw_sim *sim)
{
  const pw_scene_implicit *p = &sim->scene.solid.implicit;
  pw_quad_steps *q = sim->quad;
  const pw_real whole = sim->scene.time.end_s / p->steps;
  const pw_newton_course course = {.least = p->step_least,
                                   .most = p->step_most,
                                   .easy = p->easy_iterations,
                                   .hard = p->hard_iterations,
                                   .grow = 1.5,
                                   .shrink = 0.5};
  if (p->adaptive) {
    q->wanted = pw_newton_next_size(&course, q->length / whole, &q->report);
  }
  sim->dt_next = whole * q->wanted;
}

pw_status pw_step_implicit(pw_sim *sim)
{
  pw_quad_steps *q = sim->quad;
  const pw_real end = sim->scene.time.end_s;
  q->status = PW_OK;
  q->start = sim->time;
  q->length = choose_length(sim);
  if (sim->step == 0) {
    PW_TRY(show_start(q));
  }
  const bool last = sim->time < end && q->start + q->length >= end * (1.0 - 1e-12);
  const pw_newton_load load = {
      .ctx = q, .start_s = q->start, .step_s = q->length, .apply = apply, .converged = converged};
  pw_newton_forget(q->newton);
  const pw_status s = pw_newton_step(q->newton, &load, &q->report);
  q->iterations += q->report.iterations;
  q->cuts += q->report.cuts;
  q->parts += q->report.parts;
  PW_TRY(s);
  PW_TRY(q->status);
  sim->time = last ? end : q->start + q->length;
  sim->dt = q->length;
  sim->step++;
  choose_next(sim);
  return PW_OK;
}

/* ---- reading ---- */

static pw_real last_residual(const pw_quad_steps *q)
{
  return q->report.count > 0 ? q->report.residual[q->report.count - 1] : 0.0;
}

void pw_quad_steps_history(const pw_sim *sim, pw_record *row)
{
  const pw_quad_steps *q = sim->quad;
  if (q) {
    pw_record_put(row, "iterations", q->report.iterations);
    pw_record_put(row, "cuts", q->report.cuts);
    pw_record_put(row, "residual", last_residual(q));
    pw_record_put(row, "equations", (pw_real)q->equations);
  }
}

void pw_quad_steps_results(const pw_sim *sim, pw_record *out)
{
  const pw_quad_steps *q = sim->quad;
  if (q) {
    pw_record_put(out, "iterations", (pw_real)q->iterations);
    pw_record_put(out, "cuts", (pw_real)q->cuts);
    pw_record_put(out, "residual", last_residual(q));
  }
}

pw_status pw_quad_steps_archive(pw_sim *sim, pw_archive *ar)
{
  pw_quad_steps *q = sim->quad;
  if (!q) {
    return PW_OK;
  }
  pw_off count[6] = {q->iterations,        q->cuts,       q->parts, q->equations,
                     q->report.iterations, q->report.cuts};
  pw_real number[2] = {q->wanted, last_residual(q)};
  PW_TRY(ar->offset(ar, "implicit/counts", count, 6));
  PW_TRY(ar->real(ar, "implicit/numbers", number, 2));
  if (ar->loading) {
    q->iterations = count[0];
    q->cuts = count[1];
    q->parts = count[2];
    q->equations = count[3];
    q->report.iterations = (int)count[4];
    q->report.cuts = (int)count[5];
    q->wanted = number[0];
    q->report.count = 1;
    q->report.residual[0] = number[1];
  }
  return pw_newton_archive(q->newton, ar);
}
