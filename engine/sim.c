/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/sim.h"

#include <math.h>
#include <omp.h>
#include <string.h>

#include "engine/assemble.h"
#include "engine/bodies.h"
#include "engine/core/mem.h"
#include "engine/domain.h"
#include "engine/full_mass.h"
#include "engine/rates.h"
#include "engine/schedule.h"
#include "engine/sim_report.h"
#include "engine/step_explicit.h"
#include "engine/step_implicit.h"
#include "engine/structure_sim.h"
#include "engine/update.h"

/* The body a contact effect's key `master` names. */
static int contact_master(const pw_scene_effect *effect)
{
  int body = -1;
  for (const pw_key *key = effect->type->keys; key->name; key++) {
    if (strcmp(key->name, "master") == 0) {
      memcpy(&body, effect->param + key->offset, sizeof body);
    }
  }
  return body;
}

/* Field 1 is the contact's master, field 0 everybody else; without contact all share field 0. */
static int body_field(const pw_scene *scene, int body)
{
  for (int e = 0; e < scene->neffect; e++) {
    if (scene->effect[e].type->own_velocity_fields) {
      return contact_master(&scene->effect[e]) == body ? 1 : 0;
    }
  }
  return 0;
}

static bool has_points(const pw_scene *scene, int body)
{
  return scene->body[body].kind == PW_BODY_POINTS;
}

/* Velocity fields: two when both sides of a contact have points. */
static int field_count(const pw_scene *scene)
{
  int count = 1;
  for (int b = 0; b < scene->nbody; b++) {
    count = has_points(scene, b) && body_field(scene, b) == 1 ? 2 : count;
  }
  return count;
}

static void create_bodies(pw_sim *sim)
{
  const pw_scene *scene = &sim->scene;
  sim->nbody = scene->nbody;
  for (int b = 0; b < scene->nbody; b++) {
    const pw_scene_material *m = &scene->material[scene->body[b].material];
    const bool part = m->model->step_part != NULL;
    sim->body[b] = (pw_body){.name = scene->body[b].name,
                             .model = m->model,
                             .param = m->param,
                             .step_part = part ? m->model->step_part(m->param) : 1.0,
                             .field = has_points(scene, b) ? body_field(scene, b) : 0};
  }
}

static uint64_t point_fields(const pw_scene *scene, int nstate)
{
  uint64_t fields = nstate > 0 ? PW_FIELD_BIT(PW_FIELD_STATE) : 0;
  if (scene->method.basis == PW_CPDI) {
    fields |= PW_FIELD_BIT(PW_FIELD_HALF0) | PW_FIELD_BIT(PW_FIELD_HALF);
  }
  if (scene->method.basis == PW_UGIMP) {
    fields |= PW_FIELD_BIT(PW_FIELD_HALF);
  }
  for (int e = 0; e < scene->neffect; e++) {
    fields |= scene->effect[e].type->point_fields;
  }
  return fields;
}

static int state_count(const pw_scene *scene)
{
  int count = 0;
  for (int b = 0; b < scene->nbody; b++) {
    const pw_scene_material *m = &scene->material[scene->body[b].material];
    int n = m->model->nstate && has_points(scene, b) ? m->model->nstate(m->param) : 0;
    count = n > count ? n : count;
  }
  return count;
}

/* Half-sides of point i. uGIMP domains are squares to the grid: one that is not (a sector of a
 * disc) becomes the square of its area. */
static void set_half(pw_sim *sim, pw_idx i, pw_real half[4])
{
  pw_points *p = &sim->points;
  if (sim->scene.method.basis == PW_UGIMP && (half[1] != 0.0 || half[2] != 0.0)) {
    half[0] = half[3] = 0.5 * sqrt(pw_domain_area(half));
    half[1] = half[2] = 0.0;
  }
  for (int k = 0; k < 4; k++) {
    if (p->half) {
      p->half[k * p->ld + i] = half[k];
    }
    if (p->half0) {
      p->half0[k * p->ld + i] = half[k];
    }
  }
}

/* Points from the initial domains: mass and volume per radian or metre. */
static void fill_points(pw_sim *sim, const pw_domains *d)
{
  pw_points *p = &sim->points;
  const bool axi = sim->scene.geometry == PW_AXI;
  for (pw_idx i = 0; i < d->n; i++) {
    const pw_scene_body *body = &sim->scene.body[d->body[i]];
    pw_real half[4] = {d->half[i], d->half[d->n + i], d->half[2 * d->n + i], d->half[3 * d->n + i]};
    p->body[i] = d->body[i];
    for (int a = 0; a < 2; a++) {
      p->x[a * p->ld + i] = d->x[a * d->n + i];
      p->v[a * p->ld + i] = body->velocity_m_s[a];
    }
    p->vol[i] = pw_domain_area(half) * (axi ? p->x[i] : 1.0);
    p->mass[i] = p->vol[i] * pw_scene_density(&sim->scene, d->body[i]);
    p->def_grad[i] = p->def_grad[3 * p->ld + i] = p->def_grad[4 * p->ld + i] = 1.0;
    set_half(sim, i, half);
  }
  /* Padding lanes take part in nothing but must hold numbers. */
  for (pw_idx i = d->n; i < p->ld; i++) {
    p->mass[i] = p->vol[i] = p->x[i] = 1.0;
  }
}

/* Longer half diagonal with lengths along x and y in the given units; m. */
static pw_real half_diagonal(const pw_domains *d, pw_idx i, const pw_real unit[2])
{
  pw_real ax = d->half[i] + d->half[2 * d->n + i], ay = d->half[d->n + i] + d->half[3 * d->n + i];
  pw_real bx = d->half[i] - d->half[2 * d->n + i], by = d->half[d->n + i] - d->half[3 * d->n + i];
  ax /= unit[0], bx /= unit[0];
  ay /= unit[1], by /= unit[1];
  return sqrt(pw_max(ax * ax + ay * ay, bx * bx + by * by));
}

/* On a graded grid everything is in cells where the domain is; half of four cells at the start is
 * what a uniform grid allows (scene_check.c). */
static pw_status create_graded_limits(pw_sim *sim, const pw_domains *d, pw_real *largest)
{
  pw_real cells = sim->scene.method.domain_limit_cells;
  for (pw_idx i = 0; i < d->n; i++) {
    pw_real x[2] = {d->x[i], d->x[d->n + i]}, cell[2];
    pw_mesh_size_at(&sim->mesh, x, cell);
    pw_real start = half_diagonal(d, i, cell) * (1.0 + 1e-12);
    PW_REQUIRE(start <= 2.9, PW_ERR_SCENE,
               "body %s: a domain at (%g, %g) m is %.3g cells long from corner to corner: give "
               "points_per_cell, or refine it there",
               sim->scene.body[d->body[i]].name, x[0], x[1], 2.0 * start);
    sim->limit[i] = cells > 0.0 ? pw_max(start, cells) : 1e30;
    *largest = pw_max(*largest, cells > 0.0 ? sim->limit[i] : 4.0);
  }
  return PW_OK;
}

/* Allowed half diagonal of each CPDI domain: the scene's limit, or what it has at the start if that
 * is more. Returns the largest in cells. */
static pw_status create_limits(pw_sim *sim, const pw_domains *d, pw_real *largest)
{
  pw_real cells = sim->scene.method.domain_limit_cells;
  *largest = 0.0;
  if (sim->scene.method.basis != PW_CPDI) {
    return PW_OK;
  }
  PW_TRY(pw_mem_alloc("domain limit", d->n, sizeof(pw_real), &sim->limit));
  if (sim->mesh.graded) {
    return create_graded_limits(sim, d, largest);
  }
  for (pw_idx i = 0; i < d->n; i++) {
    pw_real start = half_diagonal(d, i, (pw_real[]){1.0, 1.0}) * (1.0 + 1e-12);
    sim->limit[i] = cells > 0.0 ? pw_max(start, cells * sim->mesh.cell) : 1e30;
    /* Without a limit domains may grow to four cells before the run stops. */
    *largest = pw_max(*largest, cells > 0.0 ? sim->limit[i] / sim->mesh.cell : 4.0);
  }
  return PW_OK;
}

/* A body may lie in its own hole. */
static pw_status check_filled(const pw_scene *scene, const pw_domains *d)
{
  bool filled[PW_MAX_BODIES] = {false};
  for (pw_idx i = 0; i < d->n; i++) {
    filled[d->body[i]] = true;
  }
  for (int b = 0; b < scene->nbody; b++) {
    PW_REQUIRE(filled[b] || !has_points(scene, b), PW_ERR_SCENE,
               "body '%s' gets no points: nothing of it is left", scene->body[b].name);
  }
  return PW_OK;
}

static pw_status create_points(pw_sim *sim, pw_real *reach_cells)
{
  pw_domains d = {0};
  PW_TRY(pw_domains_create(&sim->scene, &d));
  int nstate = state_count(&sim->scene);
  pw_status status = check_filled(&sim->scene, &d);
  if (status == PW_OK) {
    status = pw_points_create(d.n, point_fields(&sim->scene, nstate), nstate,
                              sim->kernels->vertices, &sim->points);
  }
  if (status == PW_OK) {
    fill_points(sim, &d);
    status = create_limits(sim, &d, reach_cells);
  }
  pw_domains_destroy(&d);
  return status;
}

static pw_status create_blocks(pw_sim *sim, pw_real reach_cells)
{
  const pw_mesh *m = &sim->mesh;
  const pw_points *p = &sim->points;
  pw_idx *weight = NULL;
  PW_TRY(pw_mem_alloc("block weights", m->nelem, sizeof(pw_idx), &weight));
  for (pw_idx i = 0; i < p->n; i++) {
    pw_real x[2] = {p->x[i], p->x[p->ld + i]};
    pw_idx e = pw_mesh_locate(m, x);
    if (e >= 0) {
      weight[e]++;
    }
  }
  /* Domains reach as far as their limit; two cells at least, so that points with small domains may
   * drift before they must be sorted again. */
  pw_idx reach = pw_domain_reach(m, reach_cells);
  pw_idx per_block = sim->scene.method.block_elements;
  pw_status status =
      per_block > 0 ? pw_blocks_create(m->cells, weight, per_block, reach, sim->nbody, &sim->blocks)
                    : pw_blocks_create_even(m->cells, weight, reach, sim->nbody, &sim->blocks);
  pw_mem_free(&weight);
  PW_TRY(status);
  PW_TRY(pw_share_create(&sim->blocks, sim->threads));
  PW_TRY(pw_mem_alloc("block sums", sim->blocks.nblock, sizeof(pw_block_sums), &sim->sums));
  PW_TRY(pw_mem_alloc("sort", p->n, sizeof(pw_idx), &sim->from));
  return pw_mem_alloc("scratch", p->ld, sizeof(pw_real), &sim->scratch);
}

static void bind_transfer(pw_sim *sim)
{
  pw_points *p = &sim->points;
  const pw_mesh *m = &sim->mesh;
  sim->transfer = (pw_transfer){.origin = {m->origin[0], m->origin[1]},
                                .cell = m->cell,
                                .cells = {m->cells[0], m->cells[1]},
                                .axis = m->graded ? sim->mesh.axis : NULL,
                                .row = m->nodes[0],
                                .reach = sim->blocks.reach,
                                .ld = p->ld,
                                .x = p->x,
                                .v = p->v,
                                .mass = p->mass,
                                .vol = p->vol,
                                .stress = p->stress,
                                .half = p->half,
                                .home = p->home,
                                .corner = p->corner,
                                .local = p->local};
}

/* State variables of every point for the stress it has; contiguous runs of one body. */
static void init_materials(pw_sim *sim)
{
  pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n;) {
    pw_idx j = i + 1;
    while (j < p->n && p->body[j] == p->body[i]) {
      j++;
    }
    const pw_body *b = &sim->body[p->body[i]];
    if (b->model->place && p->state) {
      b->model->place(b->param, j - i, p->ld, p->x + p->ld + i, p->state + i);
    }
    if (b->model->init) {
      b->model->init(b->param, j - i, p->ld, p->stress + i, p->state ? p->state + i : NULL);
    }
    i = j;
  }
}

static pw_status create_effects(pw_sim *sim)
{
  for (int e = 0; e < sim->scene.neffect; e++) {
    const pw_effect *type = sim->scene.effect[e].type;
    if (type->create) {
      PW_TRY(type->create(sim, sim->scene.effect[e].param, &sim->ctx[e]));
    }
  }
  pw_schedule_build(sim);
  return PW_OK;
}

static pw_status build(pw_sim *sim)
{
  const pw_scene *scene = &sim->scene;
  pw_real reach_cells = 0.0;
  PW_TRY(pw_scene_check(scene));
  PW_TRY(pw_mesh_create_grid(&scene->grid, &sim->mesh));
  sim->kernels = sim->mesh.graded ? pw_kernels_find_graded(scene->geometry, scene->method.basis)
                                  : pw_kernels_find(scene->geometry, scene->method.basis);
  PW_REQUIRE(sim->kernels, PW_ERR_UNSUPPORTED, "no kernels for this geometry and basis");
  PW_REQUIRE(scene->method.basis != PW_UGIMP || (sim->mesh.cells[0] > 1 && sim->mesh.cells[1] > 1),
             PW_ERR_SCENE, "grid: ugimp needs at least two cells in each direction");
  sim->measure = scene->geometry == PW_AXI ? 6.283185307179586 : 1.0;
  sim->load_factor = 1.0;
  sim->time = 0.0;
  create_bodies(sim);
  PW_TRY(pw_structures_create(sim));
  PW_TRY(create_points(sim, &reach_cells));
  PW_TRY(create_blocks(sim, reach_cells));
  PW_TRY(pw_nodes_create(sim->mesh.nnode, field_count(scene), &sim->nodes));
  bind_transfer(sim);
  PW_TRY(pw_rates_create(sim));
  PW_TRY(pw_full_mass_create(sim));
  init_materials(sim);
  PW_TRY(pw_update_sort(sim));
  pw_real density = PW_HUGE;
  for (int b = 0; b < sim->nbody; b++) {
    density = has_points(scene, b) ? pw_min(density, pw_scene_density(scene, b)) : density;
  }
  pw_real full = density * sim->mesh.cell * sim->mesh.cell;
  sim->mass_cut_off =
      scene->method.mass_cut_off * full * (scene->geometry == PW_AXI ? sim->mesh.cell : 1.0);
  PW_TRY(create_effects(sim));
  pw_for_blocks(&sim->blocks, sim->threads, pw_block_wave_speed, sim);
  PW_TRY(pw_update_collect(sim));
  sim->material = (pw_material_counts){0};
  sim->updates = 0;
  PW_TRY(pw_quad_steps_create(sim));
  for (pw_idx i = 0; i < sim->points.n; i++) {
    sim->mass += sim->points.mass[i];
  }
  for (int b = 0; b < sim->nbody; b++) {
    pw_real com[6];
    pw_body_centre(sim, b, com);
    sim->body[b].start[0] = com[0];
    sim->body[b].start[1] = com[1];
  }
  return PW_OK;
}

pw_status pw_sim_create(const pw_scene *scene, int threads, pw_sim **out)
{
  pw_sim *sim = NULL;
  PW_REQUIRE(scene->geometry != PW_SOLID, PW_ERR_SCENE,
             "geometry: a solid scene is run by implicit steps");
  PW_TRY(pw_mem_alloc("simulation", 1, sizeof *sim, &sim));
  sim->scene = *scene;
  sim->threads = threads > 0 ? threads : omp_get_max_threads();
  pw_status status = build(sim);
  if (status != PW_OK) {
    pw_sim_destroy(&sim);
    return status;
  }
  *out = sim;
  return PW_OK;
}

void pw_sim_destroy(pw_sim **sim_ptr)
{
  pw_sim *sim = *sim_ptr;
  if (!sim) {
    return;
  }
  for (int e = 0; e < sim->scene.neffect; e++) {
    if (sim->ctx[e] && sim->scene.effect[e].type->destroy) {
      sim->scene.effect[e].type->destroy(&sim->ctx[e]);
    }
  }
  pw_structures_destroy(sim);
  pw_quad_steps_destroy(sim);
  pw_full_mass_destroy(sim);
  pw_rates_destroy(sim);
  pw_points_destroy(&sim->points);
  pw_nodes_destroy(&sim->nodes);
  pw_blocks_destroy(&sim->blocks);
  pw_mesh_destroy(&sim->mesh);
  pw_mem_free(&sim->sums);
  pw_mem_free(&sim->limit);
  pw_mem_free(&sim->from);
  pw_mem_free(&sim->scratch);
  pw_mem_free(sim_ptr);
}

/* Short steps of the next cycle, at most what is left until dt_limit: as many as there are levels
 * for, or fewer and shorter; two even cycles rather than a full one and a sliver. */
static int plan_cycle(pw_sim *sim, pw_real dt_limit)
{
  const int most = pw_rates_cycle(sim);
  const pw_real full = most * sim->dt;
  if (dt_limit <= 0.0 || 2.0 * full <= dt_limit) {
    return most;
  }
  const pw_real length = full < dt_limit ? 0.5 * dt_limit : dt_limit;
  int n = 1;
  while (n < most && length > n * sim->dt * (1.0 + 1e-12)) {
    n++;
  }
  sim->dt = pw_min(sim->dt, length / n);
  return n;
}

/* A cycle ends early when the step it was made for has become too long by this part. */
static const pw_real SHORTER = 0.9;

static pw_status make_cycle(pw_sim *sim, int n)
{
  bool together = false;
  for (int k = 0; k < n && !together; k++) {
    pw_rates_begin(sim, k, n);
    PW_TRY(pw_step_explicit(sim));
    sim->dt_min = sim->step <= 1 ? sim->dt : pw_min(sim->dt_min, sim->dt);
    sim->dt_max = pw_max(sim->dt_max, sim->dt);
    together = sim->sort_needed || sim->dt_next < SHORTER * sim->dt ||
               (sim->dt_contact > 0.0 && sim->dt_contact < SHORTER * sim->dt);
    if (together && !pw_rates_together(sim)) {
      PW_TRY(pw_rates_join(sim));
    }
  }
  if (sim->rates) {
    pw_rates_choose(sim);
  }
  return PW_OK;
}

/* Implicit steps have their own length. */
static pw_status step_implicit(pw_sim *sim)
{
  PW_TRY(pw_step_implicit(sim));
  sim->dt_min = sim->step <= 1 ? sim->dt : pw_min(sim->dt_min, sim->dt);
  sim->dt_max = pw_max(sim->dt_max, sim->dt);
  return PW_OK;
}

pw_status pw_sim_step(pw_sim *sim, pw_real dt_limit)
{
  double start = omp_get_wtime();
  omp_set_num_threads(sim->threads);
  if (sim->step == 0) { /* here, not in pw_sim_create: the caller may have set velocities */
    sim->energy.initial = pw_kinetic_energy(sim);
  }
  sim->dt = sim->dt_next;
  if (sim->dt_contact > 0.0) {
    sim->dt = pw_min(sim->dt, sim->dt_contact);
  }
  pw_status status = sim->quad ? step_implicit(sim) : make_cycle(sim, plan_cycle(sim, dt_limit));
  sim->wall += omp_get_wtime() - start;
  return status;
}

pw_real pw_sim_time(const pw_sim *sim)
{
  return sim->time;
}

pw_off pw_sim_steps(const pw_sim *sim)
{
  return sim->step;
}

const pw_scene *pw_sim_scene(const pw_sim *sim)
{
  return &sim->scene;
}

const pw_mesh *pw_sim_mesh(const pw_sim *sim)
{
  return &sim->mesh;
}

const pw_points *pw_sim_points(const pw_sim *sim)
{
  return &sim->points;
}

void *pw_sim_effect_ctx(const pw_sim *sim, const char *name)
{
  for (int e = 0; e < sim->scene.neffect; e++) {
    if (strcmp(sim->scene.effect[e].type->name, name) == 0) {
      return sim->ctx[e];
    }
  }
  return NULL;
}
