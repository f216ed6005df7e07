/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/tet_model.h"

#include <math.h>
#include <string.h>

#include "engine/assemble.h"
#include "engine/core/mem.h"
#include "engine/tet_follow.h"
#include "engine/tet_ghost.h"
#include "engine/tet_inertia.h"
#include "engine/tet_patch.h"

/* Logarithmic strains come from exponentials near 1, whose last digit is this large. */
static const pw_real strain_rounding = 1e-15;

enum { PATCH_WORK = 24 }; /* of a patch with points, counted in points */

enum { SEARCH_CHUNK = 4096 }; /* points one thread searches at a time */

void pw_tet_model_destroy(pw_tet_model *m)
{
  pw_walk_destroy(&m->walk);
  pw_blocks_destroy(&m->blocks);
  pw_csr_destroy(&m->csr);
  pw_tet_points_destroy(&m->points);
  pw_mem_free(&m->elem_start);
  pw_mem_free(&m->elem_point);
  pw_mem_free(&m->elem_order);
  pw_mem_free(&m->fixed);
  pw_mem_free(&m->prescribed);
  pw_mem_free(&m->external);
  pw_mem_free(&m->follow);
  pw_mem_free(&m->equation);
  pw_mem_free(&m->numbered);
  pw_mem_free(&m->active);
  pw_mem_free(&m->force);
  pw_mem_free(&m->lift);
  pw_mem_free(&m->stiff);
  pw_mem_free(&m->bad);
  pw_mem_free(&m->why);
  pw_mem_free(&m->chunk);
  pw_mem_free(&m->mass);
  pw_mem_free(&m->ghost.face);
  pw_mem_free(&m->ghost.cut);
  pw_mem_free(&m->guide.of);
  memset(m, 0, sizeof *m);
}

static bool has_substeps(const pw_tet_model *m)
{
  bool found = false;
  for (pw_idx i = 0; i < m->nmaterial; i++) {
    found = found || m->material[i].model->substeps;
  }
  return found;
}

static pw_status allocate(pw_tet_model *m, bool follower)
{
  const pw_off n = 3 * (pw_off)m->mesh->tets.nnode, nelem = m->mesh->tets.nelem;
  PW_TRY(
      pw_mem_alloc("points by element: offsets", nelem + 1, sizeof *m->elem_start, &m->elem_start));
  PW_TRY(pw_mem_alloc("points by element", m->points.n, sizeof *m->elem_point, &m->elem_point));
  PW_TRY(pw_mem_alloc("points by element: next", nelem, sizeof *m->elem_order, &m->elem_order));
  PW_TRY(pw_mem_alloc("nodes: fixed", n, sizeof *m->fixed, &m->fixed));
  PW_TRY(pw_mem_alloc("nodes: prescribed", n, sizeof *m->prescribed, &m->prescribed));
  PW_TRY(pw_mem_alloc("nodes: external force", n, sizeof *m->external, &m->external));
  if (follower) {
    PW_TRY(pw_mem_alloc("nodes: force that follows", n, sizeof *m->follow, &m->follow));
  }
  PW_TRY(pw_mem_alloc("nodes: equations", n, sizeof *m->equation, &m->equation));
  PW_TRY(pw_mem_alloc("nodes: new equations", n, sizeof *m->numbered, &m->numbered));
  PW_TRY(pw_mem_alloc("nodes: mass", n / 3, sizeof *m->mass, &m->mass));
  if (m->ghost.gamma > 0.0) {
    PW_TRY(pw_mem_alloc("ghost: faces", 2 * nelem, sizeof *m->ghost.face, &m->ghost.face));
    PW_TRY(pw_mem_alloc("ghost: cut elements", nelem, sizeof *m->ghost.cut, &m->ghost.cut));
  }
  if (has_substeps(m)) {
    PW_TRY(pw_guide_create(&m->guide, m->points.ld));
  }
  PW_TRY(pw_mem_alloc("nodes: active", n / 3, sizeof *m->active, &m->active));
  PW_TRY(pw_mem_alloc("nodes: internal force", n, sizeof *m->force, &m->force));
  PW_TRY(pw_mem_alloc("nodes: lift", n, sizeof *m->lift, &m->lift));
  PW_TRY(pw_mem_alloc("blocks: stiffness", m->blocks.nblock, sizeof *m->stiff, &m->stiff));
  PW_TRY(pw_mem_alloc("blocks: failures", m->blocks.nblock, sizeof *m->bad, &m->bad));
  PW_TRY(pw_mem_alloc("blocks: reasons", m->blocks.nblock, sizeof *m->why, &m->why));
  return pw_mem_alloc("search: counts", m->points.n / SEARCH_CHUNK + 1, sizeof *m->chunk,
                      &m->chunk);
}

static pw_status divide(pw_tet_model *m)
{
  pw_idx *weight = NULL;
  PW_TRY(pw_mem_alloc("points of patches", m->mesh->npatch, sizeof *weight, &weight));
  for (pw_idx i = 0; i < m->points.n; i++) {
    weight[m->points.elem[i] / m->mesh->per]++;
  }
  pw_idx size = pw_blocks_choose_size(m->mesh->npatch, m->threads);
  pw_status s = pw_patch_blocks_create(&m->mesh->tets, m->mesh->per, weight, size, &m->blocks);
  pw_mem_free(&weight);
  PW_TRY(s);
  return pw_share_create(&m->blocks, m->threads);
}

static pw_status build(const pw_tet_setup *setup, pw_tet_model *m)
{
  PW_TRY(pw_tet_points_create(m->mesh, setup->fill, &m->points));
  PW_TRY(pw_walk_create(&m->mesh->tets, &m->walk));
  PW_TRY(divide(m));
  const int coupled =
      (m->fbar != PW_FBAR_NONE ? PW_CSR_PATCHES : 0) | (m->ghost.gamma > 0.0 ? PW_CSR_FACES : 0);
  PW_TRY(pw_csr_create(m->mesh, coupled, &m->csr));
  return allocate(m, setup->follower);
}

pw_status pw_tet_model_create(const pw_tet_setup *setup, pw_tet_model *out)
{
  PW_REQUIRE(setup->threads >= 1, PW_ERR_ARGUMENT, "%d threads", setup->threads);
  PW_REQUIRE(setup->ghost >= 0.0, PW_ERR_ARGUMENT, "ghost stabilisation with %g Pa", setup->ghost);
  pw_tet_model m = {.mesh = setup->mesh,
                    .material = setup->fill->material,
                    .nmaterial = setup->fill->nmaterial,
                    .fbar = setup->fbar,
                    .threads = setup->threads,
                    .ghost = {.gamma = setup->ghost},
                    .dt = 1.0};
  pw_status s = build(setup, &m);
  if (s != PW_OK) {
    pw_tet_model_destroy(&m);
    return s;
  }
  *out = m;
  return PW_OK;
}

bool pw_tet_model_is_symmetric(const pw_tet_model *m)
{
  bool symmetric = m->fbar == PW_FBAR_NONE && !m->follow;
  for (pw_idx i = 0; i < m->nmaterial; i++) {
    symmetric = symmetric && m->material[i].model->symmetric;
  }
  return symmetric;
}

static void search(pw_tet_model *m)
{
  const pw_walk *w = &m->walk;
  const pw_motion *motion = &m->mesh->motion;
  pw_tet_points *q = &m->points;
  pw_walk_counts *counts = m->chunk;
  const pw_idx n = q->n, chunks = (n + SEARCH_CHUNK - 1) / SEARCH_CHUNK;
#pragma omp parallel for schedule(static) default(none) shared(w, motion, q, counts, n, chunks)    \
    num_threads(m->threads)
  for (pw_idx k = 0; k < chunks; k++) {
    const pw_idx first = k * SEARCH_CHUNK;
    memset(&counts[k], 0, sizeof counts[k]);
    pw_walk_points(w, motion, n - first < SEARCH_CHUNK ? n - first : SEARCH_CHUNK, q->ld,
                   q->x + first, q->elem + first, &counts[k]);
  }
  memset(&m->walked, 0, sizeof m->walked);
  for (pw_idx k = 0; k < chunks; k++) {
    m->walked.points += counts[k].points;
    m->walked.tests += counts[k].tests;
    m->walked.moved += counts[k].moved;
    m->walked.ties += counts[k].ties;
    m->walked.binned += counts[k].binned;
    m->walked.outside += counts[k].outside;
  }
}

static pw_status check_inside(const pw_tet_model *m)
{
  const pw_tet_points *q = &m->points;
  const size_t l = (size_t)q->ld;
  for (pw_idx i = 0; m->walked.outside > 0 && i < q->n; i++) {
    PW_REQUIRE(q->elem[i] != PW_WALK_OUTSIDE, PW_ERR_POINT_LOST,
               "point %d at (%g, %g, %g) m and %lld others are outside the mesh", (int)i, q->x[i],
               q->x[l + (size_t)i], q->x[2 * l + (size_t)i], (long long)(m->walked.outside - 1));
  }
  return PW_OK;
}

static void sort_points(pw_tet_model *m)
{
  const pw_idx nelem = m->mesh->tets.nelem;
  memset(m->elem_start, 0, ((size_t)nelem + 1) * sizeof *m->elem_start);
  for (pw_idx i = 0; i < m->points.n; i++) {
    m->elem_start[m->points.elem[i] + 1]++;
  }
  for (pw_idx e = 0; e < nelem; e++) {
    m->elem_start[e + 1] += m->elem_start[e];
    m->elem_order[e] = m->elem_start[e];
  }
  for (pw_idx i = 0; i < m->points.n; i++) {
    m->elem_point[m->elem_order[m->points.elem[i]]++] = i;
  }
}

static void number_equations(pw_tet_model *m)
{
  const pw_tets *t = &m->mesh->tets;
  const size_t nnode = (size_t)t->nnode;
  pw_idx n = 0;
  memset(m->active, 0, nnode);
  for (pw_idx e = 0; e < t->nelem; e++) {
    for (pw_idx i = 0; m->elem_start[e + 1] > m->elem_start[e] && i < 4; i++) {
      m->active[t->node[4 * e + i]] = 1;
    }
  }
  for (size_t a = 0; a < nnode; a++) {
    for (size_t c = 0; c < 3; c++) {
      m->numbered[c * nnode + a] = m->active[a] && !m->fixed[c * nnode + a] ? n++ : -1;
    }
  }
  if (m->csr.revision == 0 || memcmp(m->numbered, m->equation, 3 * nnode * sizeof n) != 0) {
    memcpy(m->equation, m->numbered, 3 * nnode * sizeof n);
    pw_csr_number(&m->csr, m->equation, n);
  }
}

/* Divide the blocks among the threads by what they hold: the matrix of a patch costs as much as many
 * points. No block counts as empty, so that each leaves its sums. */
static void share_blocks(pw_tet_model *m)
{
  pw_blocks *b = &m->blocks;
  const pw_idx per = m->mesh->per;
  for (pw_idx k = 0; k < b->nblock; k++) {
    pw_off work = 1;
    for (pw_idx l = b->elem_start[k]; l < b->elem_start[k + 1]; l++) {
      const pw_idx first = b->elem[l] * per;
      const pw_off points = m->elem_start[first + per] - m->elem_start[first];
      work += points > 0 ? PATCH_WORK + points : 0;
    }
    b->share_size[k] = b->share_work[k] = work;
  }
  pw_share_balance(b);
}

pw_status pw_tet_model_begin(pw_tet_model *m)
{
  search(m);
  PW_TRY(check_inside(m));
  sort_points(m);
  share_blocks(m);
  number_equations(m);
  m->has_mass = false;
  pw_tet_ghost_begin(m);
  return pw_tet_follow_begin(m);
}

/* One evaluation, shared by all blocks. */
typedef struct {
  pw_tet_model *m;
  const pw_real *u;
  bool tangent;
} evaluation;

/* Part of what blocks add to is set to zero. */
static void clear_part(void *ctx, int part, int parts)
{
  const evaluation *ev = ctx;
  pw_tet_model *m = ev->m;
  const size_t dofs = 3 * (size_t)m->mesh->tets.nnode;
  const size_t first = dofs * (size_t)part / (size_t)parts;
  const size_t bytes = (dofs * ((size_t)part + 1) / (size_t)parts - first) * sizeof *m->force;
  memset(m->force + first, 0, bytes);
  if (m->inertia.on) {
    memset(m->inertia.force + first, 0, bytes);
  }
  if (ev->tangent) {
    memset(m->lift + first, 0, bytes);
    pw_csr_clear(&m->csr, part, parts);
  }
}

static void scatter(pw_tet_model *m, pw_idx p, const pw_real *force, const pw_real *k)
{
  const size_t nnode = (size_t)m->mesh->tets.nnode;
  const pw_idx np = m->mesh->patch_nodes, *node = m->mesh->patch_node + p * np;
  pw_real given[PW_PATCH_DOFS];
  bool driven = false;
  for (pw_idx i = 0; i < 3 * np; i++) {
    const size_t at = (size_t)(i % 3) * nnode + (size_t)node[i / 3];
    m->force[at] += force[i];
    given[i] = m->fixed[at] ? m->prescribed[at] : 0.0;
    driven |= given[i] != 0.0;
  }
  if (!k) {
    return;
  }
  for (pw_idx i = 0; driven && i < 3 * np; i++) {
    pw_real sum = 0.0;
    for (pw_idx j = 0; j < 3 * np; j++) {
      sum += k[PW_PATCH_DOFS * i + j] * given[j];
    }
    m->lift[(size_t)(i % 3) * nnode + (size_t)node[i / 3]] += sum;
  }
  pw_csr_add(&m->csr, p, k);
}

static void scatter_inertia(pw_tet_model *m, pw_idx p, const pw_real *force)
{
  const size_t nnode = (size_t)m->mesh->tets.nnode;
  const pw_idx np = m->mesh->patch_nodes, *node = m->mesh->patch_node + p * np;
  for (pw_idx i = 0; i < 3 * np; i++) {
    m->inertia.force[(size_t)(i % 3) * nnode + (size_t)node[i / 3]] += force[i];
  }
}

static void evaluate_block(void *ctx, pw_idx block)
{
  const evaluation *ev = ctx;
  pw_tet_model *m = ev->m;
  pw_real force[PW_PATCH_DOFS], mass[PW_PATCH_DOFS], k[PW_PATCH_DOFS * PW_PATCH_DOFS];
  m->bad[block] = -1;
  m->why[block] = NULL;
  m->stiff[block] = 0.0;
  for (pw_idx l = m->blocks.elem_start[block]; l < m->blocks.elem_start[block + 1]; l++) {
    const pw_idx p = m->blocks.elem[l];
    pw_patch_motion motion;
    pw_idx bad = pw_patch_move(m, p, ev->u, &motion);
    if (bad < 0 && motion.nactive > 0) {
      bad = pw_patch_evaluate(m, p, &motion, force, ev->tangent ? k : NULL);
      if (m->inertia.on) {
        pw_patch_inertia(m, p, mass, ev->tangent ? k : NULL);
        scatter_inertia(m, p, mass);
      }
      scatter(m, p, force, ev->tangent ? k : NULL);
      m->stiff[block] += motion.rounding;
    }
    if (bad >= 0 && m->bad[block] < 0) {
      m->bad[block] = bad;
      m->why[block] = motion.why;
    }
  }
}

/* The lowest element that failed in its block, and why. */
static pw_status check_elements(const pw_tet_model *m, const pw_real *u)
{
  pw_idx bad = -1;
  const char *why = NULL;
  for (pw_idx k = 0; k < m->blocks.nblock; k++) {
    if (m->bad[k] >= 0 && (bad < 0 || m->bad[k] < bad)) {
      bad = m->bad[k];
      why = m->why[k];
    }
  }
  pw_patch_motion motion;
  const pw_idx *n = m->mesh->tets.node + 4 * (size_t)(bad < 0 ? 0 : bad);
  bool inverted = bad >= 0 && pw_patch_move(m, bad / m->mesh->per, u, &motion) >= 0;
  PW_REQUIRE(!inverted, PW_RETRY_DOMAIN_INVERTED,
             "element %d (nodes %d %d %d %d) is turned inside out", (int)bad, (int)n[0], (int)n[1],
             (int)n[2], (int)n[3]);
  PW_REQUIRE(bad < 0, PW_RETRY_STRESS, "no stress can be found in element %d%s%s", (int)bad,
             why ? ": " : "", why ? why : "");
  return PW_OK;
}

static void add_follow(pw_tet_model *m, const pw_real *u, bool tangent)
{
  pw_tet_follow_forces(m, u);
  if (tangent) {
    pw_tet_follow_tangent(m, u);
  }
}

pw_status pw_tet_model_evaluate(pw_tet_model *m, const pw_real *u, bool tangent)
{
  evaluation ev = {.m = m, .u = u, .tangent = tangent};
  const pw_pass pass = {.before = clear_part, .block = evaluate_block};
  pw_assemble_pass(&m->blocks, m->threads, &pass, &ev);
  pw_tet_ghost_add(m, u, tangent);
  if (m->surface) {
    add_follow(m, u, tangent);
  }
  pw_real sum = 0.0;
  for (pw_idx k = 0; k < m->blocks.nblock; k++) {
    sum += m->stiff[k];
  }
  m->rounding = tangent ? strain_rounding * sqrt(sum) : m->rounding;
  return check_elements(m, u);
}

void pw_tet_model_volumes(const pw_tet_model *m, const pw_real *u, pw_real *ratio)
{
  ratio[0] = INFINITY;
  ratio[1] = -INFINITY;
  for (pw_idx p = 0; p < m->mesh->npatch; p++) {
    pw_patch_motion motion;
    if (pw_patch_move(m, p, u, &motion) >= 0) { /* an element is turned inside out */
      ratio[0] = pw_min(ratio[0], 0.0);
      continue;
    }
    for (pw_idx s = 0; s < m->mesh->per && motion.nactive > 0; s++) {
      if (motion.active[s]) {
        ratio[0] = pw_min(ratio[0], motion.motion[s].det);
        ratio[1] = pw_max(ratio[1], motion.motion[s].det);
      }
    }
  }
}

static void move_point(const pw_tet_model *m, pw_idx e, pw_idx point, const pw_real *u)
{
  const size_t nnode = (size_t)m->mesh->tets.nnode, l = (size_t)m->points.ld, i = (size_t)point;
  const pw_idx *node = m->mesh->tets.node + 4 * (size_t)e;
  pw_real *x = m->points.x, now[3] = {x[i], x[l + i], x[2 * l + i]}, back[3], shape[4];
  pw_motion_back(&m->mesh->motion, now, back);
  pw_tets_shape(&m->mesh->tets, e, back, shape);
  for (size_t c = 0; c < 3; c++) {
    for (size_t a = 0; a < 4; a++) {
      x[c * l + i] += shape[a] * u[c * nnode + (size_t)node[a]];
    }
  }
}

static void commit_point(const pw_tet_points *q, pw_idx point, pw_real det)
{
  const size_t l = (size_t)q->ld, i = (size_t)point;
  q->volume[i] *= det;
  q->jac[i] *= det;
  q->jac_bar[i] = q->jac_bar_trial[i];
  for (size_t c = 0; c < 6; c++) {
    q->stress[c * l + i] = q->stress_trial[c * l + i];
    if (q->left_cg) {
      q->left_cg[c * l + i] = q->left_cg_trial[c * l + i];
    }
  }
  for (size_t c = 0; c < 9 && q->def_grad; c++) {
    q->def_grad[c * l + i] = q->def_grad_trial[c * l + i];
  }
  for (size_t c = 0; c < (size_t)q->nstate; c++) {
    q->state[c * l + i] = q->state_trial[c * l + i];
  }
}

static void commit_block(void *ctx, pw_idx block)
{
  const evaluation *ev = ctx;
  const pw_tet_model *m = ev->m;
  const pw_idx per = m->mesh->per;
  for (pw_idx l = m->blocks.elem_start[block]; l < m->blocks.elem_start[block + 1]; l++) {
    const pw_idx p = m->blocks.elem[l];
    pw_patch_motion motion;
    pw_patch_move(m, p, ev->u, &motion);
    for (pw_idx s = 0; s < per; s++) {
      const pw_idx e = p * per + s;
      for (pw_idx k = m->elem_start[e]; k < m->elem_start[e + 1]; k++) {
        move_point(m, e, m->elem_point[k], ev->u);
        commit_point(&m->points, m->elem_point[k], motion.motion[s].det);
      }
    }
  }
}

void pw_tet_model_commit(pw_tet_model *m, const pw_real *u)
{
  evaluation ev = {.m = m, .u = u};
  pw_for_blocks(&m->blocks, m->threads, commit_block, &ev);
  pw_tet_follow_commit(m, u);
  m->step++;
}
