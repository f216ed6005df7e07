/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/quad_model.h"

#include <math.h>
#include <string.h>

#include "engine/assemble.h"
#include "engine/core/mem.h"
#include "engine/update.h"

/* Strains of a part are sums of terms near 1, whose last digit is this large. */
static const pw_real strain_rounding = 1e-15;

void pw_quad_model_destroy(pw_quad_model *m)
{
  pw_quad_pattern_destroy(&m->pattern, &m->csr);
  pw_quad_ghost_destroy(&m->ghost);
  pw_quad_inertia_destroy(&m->inertia);
  pw_mem_free(&m->fixed);
  pw_mem_free(&m->prescribed);
  pw_mem_free(&m->external);
  pw_mem_free(&m->equation);
  pw_mem_free(&m->numbered);
  pw_mem_free(&m->force);
  pw_mem_free(&m->lift);
  pw_mem_free(&m->weight);
  pw_mem_free(&m->x);
  pw_mem_free(&m->stiff);
  pw_mem_free(&m->range);
  pw_mem_free(&m->stress_trial);
  pw_mem_free(&m->state_trial);
  pw_mem_free(&m->increment);
  pw_mem_free(&m->guide.of);
  memset(m, 0, sizeof *m);
}

static pw_status allocate_nodes(pw_quad_model *m)
{
  const pw_off n = m->sim->mesh.nnode;
  PW_TRY(pw_mem_alloc("nodes: held", 2 * n, sizeof *m->fixed, &m->fixed));
  PW_TRY(pw_mem_alloc("nodes: prescribed", 2 * n, sizeof *m->prescribed, &m->prescribed));
  PW_TRY(pw_mem_alloc("nodes: external force", 2 * n, sizeof *m->external, &m->external));
  PW_TRY(pw_mem_alloc("nodes: equations", 3 * n, sizeof *m->equation, &m->equation));
  PW_TRY(pw_mem_alloc("nodes: new equations", 3 * n, sizeof *m->numbered, &m->numbered));
  PW_TRY(pw_mem_alloc("nodes: internal force", 2 * n, sizeof *m->force, &m->force));
  PW_TRY(pw_mem_alloc("nodes: lift", 2 * n, sizeof *m->lift, &m->lift));
  PW_TRY(pw_mem_alloc("nodes: weights", n, sizeof *m->weight, &m->weight));
  PW_TRY(pw_mem_alloc("nodes: places", 3 * n, sizeof *m->x, &m->x));
  for (pw_idx k = 0; k < n; k++) {
    m->x[k] = pw_mesh_node_x(&m->sim->mesh, k);
    m->x[n + k] = pw_mesh_node_y(&m->sim->mesh, k);
  }
  return PW_OK;
}

static bool has_substeps(const pw_sim *sim)
{
  bool found = false;
  for (int b = 0; b < sim->nbody; b++) {
    found = found || sim->body[b].model->substeps;
  }
  return found;
}

static pw_status allocate(pw_quad_model *m)
{
  const pw_sim *sim = m->sim;
  const pw_off ld = sim->points.ld, blocks = sim->blocks.nblock;
  PW_TRY(allocate_nodes(m));
  PW_TRY(pw_mem_alloc("blocks: stiffness", blocks, sizeof *m->stiff, &m->stiff));
  PW_TRY(pw_mem_alloc("blocks: volumes", 2 * blocks, sizeof *m->range, &m->range));
  PW_TRY(pw_mem_alloc("points: trial stress", 6 * ld, sizeof *m->stress_trial, &m->stress_trial));
  PW_TRY(pw_mem_alloc("points: increments", 5 * ld, sizeof *m->increment, &m->increment));
  if (sim->points.nstate > 0) {
    PW_TRY(pw_mem_alloc("points: trial state", sim->points.nstate * ld, sizeof *m->state_trial,
                        &m->state_trial));
  }
  if (has_substeps(sim)) {
    PW_TRY(pw_guide_create(&m->guide, sim->points.ld));
  }
  PW_TRY(pw_quad_ghost_create(m));
  PW_TRY(pw_quad_inertia_create(m));
  return pw_quad_pattern_create(sim->mesh.nodes[0], sim->mesh.nnode, 2 * sim->blocks.reach + 1,
                                &m->pattern, &m->csr);
}

pw_status pw_quad_model_create(pw_sim *sim, pw_quad_model *out)
{
  *out = (pw_quad_model){.sim = sim, .dt = 1.0};
  pw_status s = allocate(out);
  if (s != PW_OK) {
    pw_quad_model_destroy(out);
  }
  return s;
}

bool pw_quad_model_is_symmetric(const pw_quad_model *m)
{
  bool symmetric = true;
  for (int b = 0; b < m->sim->nbody; b++) {
    symmetric = symmetric && m->sim->body[b].model->symmetric;
  }
  return symmetric;
}

/* ---- what is held and what acts ---- */

void pw_quad_model_hold(pw_quad_model *m, pw_idx node, int axis, int by, pw_real displacement)
{
  const pw_off at = (pw_off)axis * m->csr.nnode + node;
  if (m->fixed[at] == PW_HELD_FREE) {
    m->fixed[at] = (uint8_t)by;
    m->prescribed[at] = displacement;
  }
}

/* The axis of symmetry, then what hooks hold. */
static pw_status hold(pw_quad_model *m)
{
  pw_sim *sim = m->sim;
  const size_t n = (size_t)sim->mesh.nnode;
  memset(m->fixed, PW_HELD_FREE, 2 * n * sizeof *m->fixed);
  memset(m->prescribed, 0, 2 * n * sizeof *m->prescribed);
  if (sim->scene.geometry == PW_AXI && sim->mesh.origin[0] <= 0.0) {
    for (pw_idx k = 0; k < sim->mesh.nnode; k += sim->mesh.nodes[0]) {
      pw_quad_model_hold(m, k, 0, PW_HELD_AXIS, 0.0);
    }
  }
  return pw_schedule_run(sim, PW_STAGE_CONSTRAINT);
}

pw_status pw_quad_model_load(pw_quad_model *m)
{
  pw_sim *sim = m->sim;
  const pw_off n = sim->mesh.nnode;
  PW_TRY(hold(m));
  for (pw_off k = 0; k < n; k++) {
    pw_real *f = sim->nodes.rec + k * PW_NODE + PW_NODE_FORCE;
    f[0] = f[1] = 0.0;
  }
  PW_TRY(pw_schedule_run(sim, PW_STAGE_NODE_FORCE));
  for (pw_off k = 0; k < n; k++) {
    for (pw_off a = 0; a < 2; a++) {
      m->external[a * n + k] = sim->nodes.rec[k * PW_NODE + PW_NODE_FORCE + a];
    }
  }
  return PW_OK;
}

/* ---- beginning a part ---- */

static void clear_survey(void *ctx, int part, int parts)
{
  pw_quad_model *m = ctx;
  pw_nodes_clear_part(&m->sim->nodes, part, parts);
  if (part == 0) {
    const size_t n = (size_t)m->sim->mesh.nnode;
    memset(m->weight, 0, n * sizeof *m->weight);
    if (m->inertia.on) {
      memset(m->inertia.rec, 0, n * PW_NODE * sizeof *m->inertia.rec);
    }
    pw_quad_pattern_clear(&m->pattern);
  }
}

/* Masses, and which nodes the points of a block have. */
static void survey_block(void *ctx, pw_idx block)
{
  pw_quad_model *m = ctx;
  pw_sim *sim = m->sim;
  const pw_points *p = &sim->points;
  const pw_idx *start = sim->blocks.point_start + (pw_off)block * sim->nbody;
  sim->sums[block] = (pw_block_sums){.bad = -1, .weights = {-1, -1, -1, 0}};
  pw_block_p2g_momentum(sim, block);
  if (m->inertia.on) {
    pw_quad_inertia_scatter(m, block);
  }
  for (pw_idx i = start[0]; i < start[sim->nbody]; i++) {
    const pw_real x[2] = {p->x[i], p->x[p->ld + i]};
    pw_real h[2];
    pw_support s;
    sim->kernels->support(&sim->transfer, i, &s);
    pw_mesh_size_at(&sim->mesh, x, h);
    for (int k = 0; k < s.n; k++) {
      m->weight[s.node[k]] += p->vol[i] * (h[0] * fabs(s.gx[k]) + h[1] * fabs(s.gy[k]));
    }
    pw_quad_pattern_mark(&m->pattern, s.n, s.node);
  }
}

/* Nodes with next to nothing have weight 0 from here on. */
static void drop_light_nodes(pw_quad_model *m)
{
  const pw_sim *sim = m->sim;
  const pw_real cell = sim->mesh.cell, depth = sim->scene.geometry == PW_AXI ? cell : 1.0;
  const pw_real least = sim->scene.method.mass_cut_off * cell * cell * depth;
  for (pw_idx k = 0; k < sim->mesh.nnode; k++) {
    m->weight[k] = m->weight[k] > least ? m->weight[k] : 0.0;
  }
}

static pw_status number_equations(pw_quad_model *m)
{
  const pw_off nnode = m->sim->mesh.nnode;
  const size_t bytes = 3 * (size_t)nnode * sizeof *m->equation;
  pw_idx n = 0;
  for (pw_off a = 0; a < nnode; a++) {
    for (pw_off c = 0; c < 3; c++) {
      const bool free = c < 2 && m->weight[a] > 0.0 && !m->fixed[c * nnode + a];
      m->numbered[c * nnode + a] = free ? n++ : -1;
    }
  }
  const bool changed = m->csr.revision == 0 || memcmp(m->numbered, m->equation, bytes) != 0;
  memcpy(m->equation, m->numbered, bytes);
  return pw_quad_pattern_number(&m->pattern, &m->csr, m->equation, n, changed);
}

pw_status pw_quad_model_begin(pw_quad_model *m)
{
  pw_sim *sim = m->sim;
  if (sim->sort_needed) {
    PW_TRY(pw_update_sort(sim));
  }
  PW_TRY(pw_schedule_run(sim, PW_STAGE_BEGIN));
  const pw_pass pass = {.before = clear_survey, .block = survey_block};
  pw_assemble_pass(&sim->blocks, sim->threads, &pass, m);
  PW_TRY(pw_schedule_run(sim, PW_STAGE_P2G));
  drop_light_nodes(m);
  if (m->inertia.on) {
    pw_quad_inertia_begin(m);
  }
  PW_TRY(hold(m));
  pw_quad_ghost_begin(m);
  return number_equations(m);
}

/* ---- evaluation ---- */

/* Part of what blocks add to is set to zero. */
static void clear_part(void *ctx, int part, int parts)
{
  const pw_quad_evaluation *ev = ctx;
  pw_quad_model *m = ev->m;
  const size_t dofs = 2 * (size_t)m->sim->mesh.nnode;
  const size_t first = dofs * (size_t)part / (size_t)parts;
  const size_t bytes = (dofs * ((size_t)part + 1) / (size_t)parts - first) * sizeof *m->force;
  memset(m->force + first, 0, bytes);
  if (ev->tangent) {
    memset(m->lift + first, 0, bytes);
    pw_csr_clear(&m->csr, part, parts);
  }
}

static pw_status check_points(const pw_quad_model *m)
{
  const pw_sim *sim = m->sim;
  const pw_points *p = &sim->points;
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) {
    const pw_block_sums *s = &sim->sums[k];
    const pw_idx i = s->bad;
    PW_REQUIRE(i < 0, s->bad_status, "%s: point %d of body %s at (%g, %g) m",
               s->why ? s->why : pw_status_text(s->bad_status), (int)p->id[i],
               sim->body[p->body[i]].name, p->x[i], p->x[p->ld + i]);
  }
  return PW_OK;
}

pw_status pw_quad_model_evaluate(pw_quad_model *m, const pw_real *u, bool tangent)
{
  pw_sim *sim = m->sim;
  pw_quad_evaluation ev = {.m = m, .u = u, .tangent = tangent};
  const pw_pass pass = {.before = clear_part, .block = pw_quad_block_evaluate};
  pw_real sum = 0.0;
  memset(m->stiff, 0, (size_t)sim->blocks.nblock * sizeof *m->stiff);
  pw_assemble_pass(&sim->blocks, sim->threads, &pass, &ev);
  pw_quad_ghost_add(m, u, tangent);
  if (m->inertia.on && !m->inertia.still) {
    pw_quad_inertia_add(m, u, tangent);
  }
  for (pw_idx k = 0; k < sim->blocks.nblock; k++) { /* blocks without points have left 0 */
    sum += m->stiff[k];
  }
  m->rounding = tangent ? strain_rounding * sqrt(sum) : m->rounding;
  return check_points(m);
}

void pw_quad_model_volumes(const pw_quad_model *m, pw_real *ratio)
{
  ratio[0] = ratio[1] = 1.0;
  for (pw_idx k = 0; k < m->sim->blocks.nblock; k++) {
    const pw_idx *start = m->sim->blocks.point_start + (pw_off)k * m->sim->nbody;
    if (start[m->sim->nbody] > start[0]) {
      ratio[0] = pw_min(ratio[0], m->range[2 * k]);
      ratio[1] = pw_max(ratio[1], m->range[2 * k + 1]);
    }
  }
}

/* ---- the end of a part ---- */

/* Records of the nodes as an explicit step would leave them: hooks of PW_STAGE_END and pictures of
 * the grid read them. */
static void set_velocities(pw_quad_model *m, const pw_real *u)
{
  pw_sim *sim = m->sim;
  const pw_off n = sim->mesh.nnode;
  sim->node_slot = PW_NODE_VEL;
  for (pw_off k = 0; k < n; k++) {
    pw_real *r = sim->nodes.rec + k * PW_NODE;
    for (pw_off a = 0; a < 2; a++) {
      r[PW_NODE_VEL + a] = u[a * n + k] / m->dt;
      r[PW_NODE_FORCE + a] = 0.0;
      r[PW_NODE_REMAP + a] = r[PW_NODE_VEL + a];
    }
    r[PW_NODE_ACTIVE] = m->weight[k] > 0.0 ? 1.0 : 0.0;
  }
}

void pw_quad_model_commit(pw_quad_model *m, const pw_real *u)
{
  pw_quad_evaluation ev = {.m = m, .u = u};
  pw_for_blocks(&m->sim->blocks, m->sim->threads, pw_quad_block_commit, &ev);
  set_velocities(m, u);
}
