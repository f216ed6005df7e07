/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/implicit.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"
#include "engine/effects/solid_params.h"
#include "engine/newton_archive.h"
#include "kernels/tensor.h"

/* ---- creation ---- */

static void copy_materials(pw_implicit *sim)
{
  const pw_scene *s = &sim->scene;
  for (int b = 0; b < s->nbody; b++) {
    const pw_scene_material *m = &s->material[s->body[b].material];
    sim->material[b].model = m->model;
    memcpy(sim->material[b].param, m->param, sizeof m->param);
  }
}

static bool in_box(const pw_solid_mesh *mesh, const pw_scene_body *b, pw_idx cell)
{
  const pw_tet_input *in = &mesh->input;
  bool inside = true;
  for (int c = 0; c < 3; c++) {
    pw_real sum = 0.0;
    for (int i = 0; i < 4; i++) {
      sum += in->x[(pw_off)c * in->nnode + in->cell[(pw_off)cell * in->nodes + i]];
    }
    inside = inside && 0.25 * sum >= b->low_m[c] && 0.25 * sum <= b->high_m[c];
  }
  return inside;
}

/* Fill the cells of a body that no body before it has. */
static pw_status fill_body(const pw_implicit *sim, const pw_solid_mesh *mesh, int index,
                           pw_idx *body)
{
  const pw_scene_body *b = &sim->scene.body[index];
  const pw_solid_group *group = NULL;
  char path[2 * PW_NAME];
  bool box = false;
  pw_idx filled = 0;
  for (int c = 0; c < 3; c++) {
    box = box || b->low_m[c] < b->high_m[c];
  }
  if (b->volume[0]) {
    snprintf(path, sizeof path, "bodies.%.40s.volume", b->name);
    PW_TRY(pw_solid_mesh_find(mesh, 3, b->volume, path, &group));
  }
  const pw_idx n = group ? group->ncell : mesh->input.ncell;
  for (pw_idx k = 0; k < n; k++) {
    const pw_idx cell = group ? group->cell[k] : k;
    if (body[cell] < 0 && (!box || in_box(mesh, b, cell))) {
      body[cell] = (pw_idx)index;
      filled++;
    }
  }
  PW_REQUIRE(filled > 0, PW_ERR_SCENE, "bodies.%s: it fills no cell of the mesh%s", b->name,
             box ? ": no centroid lies in its box that is not in a body before it"
                 : ": bodies before it have them all");
  return PW_OK;
}

static pw_status create_model(pw_implicit *sim, const pw_idx *body, int threads)
{
  const pw_scene_implicit *p = &sim->scene.solid.implicit;
  pw_tet_fill fill = {.rule = (pw_tet_rule)p->point_rule,
                      .per_patch = p->points_per == 1,
                      .allow_negative = p->negative_volumes,
                      .body = body,
                      .nmaterial = sim->scene.nbody,
                      .material = sim->material};
  pw_tet_setup setup = {
      .mesh = &sim->mesh, .fill = &fill, .fbar = (pw_fbar)p->fbar, .threads = threads};
  pw_newton_options options = pw_newton_options_of(p);
  pw_solid_model_options(&sim->scene, &setup, &options);
  PW_TRY(pw_tet_model_create(&setup, &sim->model));
  return pw_newton_create(&sim->model, &options, &sim->newton);
}

static pw_status fill_mesh(pw_implicit *sim, const pw_solid_mesh *mesh, int threads)
{
  pw_idx *body = NULL;
  pw_status s = PW_OK;
  PW_TRY(pw_mem_alloc("bodies of cells", mesh->input.ncell, sizeof *body, &body));
  memset(body, 0xff, (size_t)mesh->input.ncell * sizeof *body);
  for (int b = 0; b < sim->scene.nbody && s == PW_OK; b++) {
    s = fill_body(sim, mesh, b, body);
  }
  if (s == PW_OK) {
    s = create_model(sim, body, threads);
  }
  pw_mem_free(&body);
  return s;
}

/* Effects in the order of the list, those of one kind in the order of the scene. */
static pw_status create_effects(pw_implicit *sim, const pw_solid_mesh *mesh)
{
  for (int rank = 0; pw_solid_effect_at(rank); rank++) {
    const pw_effect *type = pw_solid_effect_at(rank);
    int number = 0;
    for (int e = 0; e < sim->scene.neffect; e++) {
      if (sim->scene.effect[e].type != type) {
        continue;
      }
      pw_solid_instance *i = &sim->effect[sim->neffect++];
      *i = (pw_solid_instance){type, sim->scene.effect[e].param, number++, NULL};
      PW_TRY(type->solid->create(sim, mesh, i->param, &i->ctx));
      sim->mesh_moves = sim->mesh_moves || type->solid->mesh;
    }
  }
  return PW_OK;
}

static pw_status build(pw_implicit *sim, const pw_solid_mesh *mesh, int threads)
{
  PW_TRY(pw_solid_mesh_check(&sim->scene, mesh));
  PW_TRY(pw_tet_mesh_create(&mesh->input, &sim->mesh));
  copy_materials(sim);
  PW_TRY(fill_mesh(sim, mesh, threads));
  return create_effects(sim, mesh);
}

pw_status pw_implicit_create(const pw_scene *scene, const pw_solid_mesh *mesh, int threads,
                             pw_implicit **out)
{
  pw_implicit *sim = NULL;
  *out = NULL;
  PW_REQUIRE(scene->geometry == PW_SOLID, PW_ERR_SCENE,
             "geometry: implicit steps need a solid scene");
  PW_TRY(pw_scene_check(scene));
  PW_TRY(pw_mem_alloc("implicit simulation", 1, sizeof *sim, &sim));
  sim->scene = *scene;
  pw_scene_solid_times(&sim->scene);
  sim->wanted = 1.0;
  pw_status s = build(sim, mesh, threads > 0 ? threads : omp_get_max_threads());
  if (s != PW_OK) {
    pw_implicit_destroy(&sim);
    return s;
  }
  *out = sim;
  return PW_OK;
}

void pw_implicit_destroy(pw_implicit **simulation)
{
  pw_implicit *sim = *simulation;
  if (!sim) {
    return;
  }
  for (int k = 0; k < sim->neffect; k++) {
    if (sim->effect[k].type->solid->destroy) {
      sim->effect[k].type->solid->destroy(&sim->effect[k].ctx);
    }
  }
  pw_newton_destroy(&sim->newton);
  pw_tet_model_destroy(&sim->model);
  pw_tet_mesh_destroy(&sim->mesh);
  pw_mem_free(simulation);
}

/* Whole load steps are counted exactly. */
static pw_real snapped(pw_real t)
{
  return fabs(t - round(t)) < 1e-9 ? round(t) : t;
}

/* Load steps done at t of the present one. */
static pw_real time_at(const pw_implicit *sim, pw_real t)
{
  return t >= 1.0 ? snapped(sim->now + sim->size) : sim->now + sim->size * t;
}

/* ---- the load step ---- */

static void apply(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  pw_implicit *sim = ctx;
  const size_t bytes = 3 * (size_t)m->mesh->tets.nnode * sizeof(pw_real);
  memset(m->prescribed, 0, bytes);
  memset(m->external, 0, bytes);
  for (int k = 0; k < sim->neffect; k++) {
    const pw_solid_hooks *hooks = sim->effect[k].type->solid;
    if (hooks->apply) {
      hooks->apply(sim, sim->effect[k].ctx, time_at(sim, t0), time_at(sim, t1));
    }
  }
}

static void converged(void *ctx, pw_tet_model *m, pw_real t1)
{
  pw_implicit *sim = ctx;
  const pw_walk_counts *w = &m->walked;
  const pw_real to = time_at(sim, t1);
  sim->equations = m->csr.n;
  sim->walked.points += w->points;
  sim->walked.tests += w->tests;
  sim->walked.moved += w->moved;
  sim->walked.ties += w->ties;
  sim->walked.binned += w->binned;
  for (int k = 0; k < sim->neffect; k++) {
    const pw_solid_hooks *hooks = sim->effect[k].type->solid;
    if (hooks->moved) {
      hooks->moved(sim, sim->effect[k].ctx, to);
    }
  }
}

static pw_status move(void *ctx, pw_tet_model *m, pw_real t1)
{
  pw_implicit *sim = ctx;
  const pw_real to = time_at(sim, t1);
  (void)m;
  for (int k = 0; k < sim->neffect; k++) {
    const pw_solid_hooks *hooks = sim->effect[k].type->solid;
    if (hooks->mesh) {
      PW_TRY(hooks->mesh(sim, sim->effect[k].ctx, to));
    }
  }
  return PW_OK;
}

/* The first pieces that nothing holds are told of. */
static void note_mechanisms(pw_implicit *sim, pw_off step)
{
  const pw_mechanism_report *r = &sim->report.mechanisms;
  if (r->free == 0 || sim->warning[0]) {
    return;
  }
  const pw_idx *node = sim->mesh.tets.node + 4 * (pw_off)r->first;
  snprintf(
      sim->warning, sizeof sim->warning,
      "step %lld: %d of %d pieces of the body, %d elements, are held by nothing, the first one "
      "with element %d (nodes %d %d %d %d) has %d free motions",
      (long long)step, r->free, r->pieces, r->elements, r->first, node[0], node[1], node[2],
      node[3], r->motions);
}

const char *pw_implicit_warning(const pw_implicit *sim, int i)
{
  const char *const known[] = {sim->note, sim->warning};
  for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
    if (known[k][0] && i-- == 0) {
      return known[k];
    }
  }
  return NULL;
}

/* Length of the next step in load steps: one, or as the iterations before suggest, and what is left
 * to @p limit where that is less. */
static pw_real choose_size(const pw_implicit *sim, pw_real limit)
{
  const pw_real left = limit > 0.0 ? limit : sim->scene.solid.implicit.steps - sim->now;
  const pw_real wanted = sim->scene.solid.implicit.adaptive ? sim->wanted : 1.0;
  return wanted > (1.0 - 1e-9) * left ? left : wanted;
}

/* Steps that were easy make the next one longer; those cut short for an output tell nothing. */
static void choose_next(pw_implicit *sim)
{
  const pw_scene_implicit *p = &sim->scene.solid.implicit;
  const pw_newton_course course = {.least = p->step_least,
                                   .most = p->step_most,
                                   .easy = p->easy_iterations,
                                   .hard = p->hard_iterations,
                                   .grow = 1.5,
                                   .shrink = 0.5};
  const bool whole = sim->size >= (1.0 - 1e-9) * sim->wanted;
  const pw_real next = pw_newton_next_size(&course, sim->size, &sim->report);
  if (whole || next < sim->size) {
    sim->wanted = next;
  }
}

pw_status pw_implicit_advance(pw_implicit *sim, pw_real limit_s)
{
  const pw_scene_implicit *p = &sim->scene.solid.implicit;
  const pw_real start = omp_get_wtime();
  sim->size = choose_size(sim, p->adaptive ? limit_s / p->step_s : 1.0);
  pw_newton_load load = {.ctx = sim,
                         .start_s = p->step_s * sim->now,
                         .step_s = p->step_s * sim->size,
                         .apply = apply,
                         .converged = converged,
                         .move = sim->mesh_moves ? move : NULL};
  pw_newton_forget(sim->newton);
  pw_status s = pw_newton_step(sim->newton, &load, &sim->report);
  sim->iterations += sim->report.iterations;
  sim->cuts += sim->report.cuts;
  sim->parts += sim->report.parts;
  if (s == PW_OK) {
    sim->step++;
    sim->now = time_at(sim, 1.0);
    choose_next(sim);
  }
  note_mechanisms(sim, sim->step + (s != PW_OK));
  sim->wall += omp_get_wtime() - start;
  return s;
}

pw_status pw_implicit_step(pw_implicit *sim)
{
  return pw_implicit_advance(sim, 0.0);
}

/* ---- reading ---- */

pw_real pw_implicit_time(const pw_implicit *sim)
{
  return sim->scene.solid.implicit.step_s * sim->now;
}

pw_off pw_implicit_steps(const pw_implicit *sim)
{
  return sim->step;
}

const pw_scene *pw_implicit_scene(const pw_implicit *sim)
{
  return &sim->scene;
}

const pw_tet_model *pw_implicit_model(const pw_implicit *sim)
{
  return &sim->model;
}

const pw_newton_report *pw_implicit_newton(const pw_implicit *sim)
{
  return &sim->report;
}

const pw_real *pw_implicit_displacement(const pw_implicit *sim)
{
  return pw_newton_displacement(sim->newton);
}

static pw_real last_residual(const pw_implicit *sim)
{
  return sim->report.count > 0 ? sim->report.residual[sim->report.count - 1] : 0.0;
}

static pw_off bytes_per_point(const pw_tet_points *p)
{
  pw_off reals = 3 + 3 + 12 + 2 * p->nstate + 1; /* x, volumes, stresses, states, mass */
  reals += (p->left_cg ? 12 : 0) + (p->def_grad ? 18 : 0) + (p->velocity ? 6 : 0) + 1;
  return reals * (pw_off)sizeof(pw_real) + 3 * (pw_off)sizeof(pw_idx);
}

void pw_implicit_report_now(const pw_implicit *sim, pw_implicit_report *out)
{
  const pw_tet_model *m = &sim->model;
  const pw_solver *solver = pw_newton_solver(sim->newton);
  *out = (pw_implicit_report){
      .threads = m->threads,
      .points = m->points.n,
      .nodes = sim->mesh.tets.nnode,
      .cells = sim->mesh.npatch,
      .elements = sim->mesh.tets.nelem,
      .blocks = m->blocks.nblock,
      .colours = m->blocks.ncolour,
      .steps = sim->step,
      .time_s = pw_implicit_time(sim),
      .iterations = sim->iterations,
      .cuts = sim->cuts,
      .parts = sim->parts,
      .walked = sim->walked,
      .equations = (pw_idx)sim->equations,
      .nonzeros = m->csr.revision > 0 ? m->csr.start[m->csr.n] : 0,
      .solver = pw_solver_counted(solver),
      .solver_text = pw_solver_describe(solver),
      .residual = last_residual(sim),
      .wall_s = sim->wall,
      .bytes_per_point = bytes_per_point(&m->points),
  };
}

void pw_implicit_history(const pw_implicit *sim, pw_record *row)
{
  const pw_walk_counts *w = &sim->model.walked;
  row->n = 0;
  pw_record_put(row, "time_s", pw_implicit_time(sim));
  pw_record_put(row, "step", (pw_real)sim->step);
  pw_record_put(row, "iterations", sim->report.iterations);
  pw_record_put(row, "cuts", sim->report.cuts);
  pw_record_put(row, "residual", last_residual(sim));
  pw_record_put(row, "equations", (pw_real)sim->equations);
  pw_record_put(row, "tests_per_point",
                w->points > 0 ? (pw_real)w->tests / (pw_real)w->points : 0.0);
  for (int k = 0; k < sim->neffect; k++) {
    if (sim->effect[k].type->solid->history) {
      sim->effect[k].type->solid->history(sim, sim->effect[k].ctx, row);
    }
  }
}

void pw_implicit_results(const pw_implicit *sim, pw_record *out)
{
  const pw_walk_counts *w = &sim->walked;
  out->n = 0;
  pw_record_put(out, "iterations", (pw_real)sim->iterations);
  pw_record_put(out, "cuts", (pw_real)sim->cuts);
  pw_record_put(out, "residual", last_residual(sim));
  pw_record_put(out, "tests_per_point",
                w->points > 0 ? (pw_real)w->tests / (pw_real)w->points : 0.0);
  pw_record_put(out, "points_changed_element", (pw_real)w->moved);
  pw_record_put(out, "points_found_by_bins", (pw_real)w->binned);
  for (int k = 0; k < sim->neffect; k++) {
    const pw_solid_hooks *hooks = sim->effect[k].type->solid;
    void (*results)(const pw_implicit *, void *, pw_record *) =
        hooks->results ? hooks->results : hooks->history;
    if (results) {
      results(sim, sim->effect[k].ctx, out);
    }
  }
}

pw_real pw_tet_points_mean_stress(const pw_tet_points *p, pw_idx point)
{
  return pw_t6_trace(pw_t6_load(p->stress + point, (size_t)p->ld)) / 3.0;
}

pw_real pw_tet_points_von_mises(const pw_tet_points *p, pw_idx point)
{
  const pw_t6 s = pw_t6_load(p->stress + point, (size_t)p->ld);
  const pw_t6 d = pw_t6_shift(s, -pw_t6_trace(s) / 3.0);
  return sqrt(1.5 * pw_t6_dot(d, d));
}

/* ---- for effects ---- */

int pw_solid_instance_of(const pw_implicit *sim, const void *param)
{
  for (int k = 0; k < sim->neffect; k++) {
    if (sim->effect[k].param == param) {
      return sim->effect[k].number;
    }
  }
  return 0;
}

pw_real pw_solid_course(const pw_implicit *sim, int start, int ramp, pw_real t)
{
  const int steps = sim->scene.solid.implicit.steps;
  const int length = ramp > 0 ? ramp : steps > start ? steps - start : 1;
  const pw_real part = (t - start) / length;
  return part <= 0.0 ? 0.0 : part >= 1.0 ? 1.0 : part;
}
