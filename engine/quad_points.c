/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The points of a block in an implicit step: increments, stress, forces and tangent. */
#include "engine/quad_model.h"

#include <math.h>
#include <string.h>

#include "engine/domain.h"
#include "engine/update.h"
#include "kernels/log_increment.h"
#include "kernels/tensor.h"
#include "kernels/tet_element.h"

enum { COMPONENTS = 5 }; /* of a gradient: xx xy yx yy zz */

/* Where they stand in a tensor by rows. */
static const size_t place[COMPONENTS] = {0, 1, 3, 4, 8};

/* Gradients of a point's nodes where the points are now; 1/m. */
typedef struct {
  pw_real gx[PW_SUPPORT], gy[PW_SUPPORT], hoop[PW_SUPPORT];
} gradients;

/* What a batch of points of one body needs; [component][PW_CHUNK]. */
typedef struct {
  pw_idx first, n;
  pw_support support[PW_CHUNK];
  gradients now[PW_CHUNK];
  pw_log_increment log_f[PW_CHUNK];
  pw_real increment[9 * PW_CHUNK], dstrain[6 * PW_CHUNK], spin[3 * PW_CHUNK];
  pw_real dvol[PW_CHUNK], density[PW_CHUNK], wave_speed[PW_CHUNK], guide[PW_GUIDE_ROWS * PW_CHUNK];
  pw_real left_cg[6 * PW_CHUNK], jac[PW_CHUNK], def_grad[9 * PW_CHUNK];
  pw_real stress[6 * PW_CHUNK], state[PW_MAX_STATE * PW_CHUNK], tangent[36 * PW_CHUNK];
} batch;

/* F [5] of the part at a point, from the displacements of its nodes. */
static void increment_of(const pw_quad_evaluation *ev, const pw_support *s, pw_real radius,
                         pw_real f[COMPONENTS])
{
  const pw_real *ux = ev->u, *uy = ev->u + ev->m->csr.nnode;
  const bool axi = ev->m->sim->scene.geometry == PW_AXI;
  pw_real out = 0.0;
  f[0] = f[3] = f[4] = 1.0;
  f[1] = f[2] = 0.0;
  for (int k = 0; k < s->n; k++) {
    const pw_real x = ux[s->node[k]], y = uy[s->node[k]];
    f[0] += s->gx[k] * x;
    f[1] += s->gy[k] * x;
    f[2] += s->gx[k] * y;
    f[3] += s->gy[k] * y;
    out += s->move[k] * x;
  }
  f[4] += axi ? out / radius : 0.0;
}

/* Gradients by the places now: g F^-1. */
static void push_forward(const pw_support *s, const pw_real f[COMPONENTS], pw_real inv_radius,
                         gradients *out)
{
  const pw_real inv = 1.0 / (f[0] * f[3] - f[1] * f[2]), inv_hoop = inv_radius / f[4];
  for (int k = 0; k < s->n; k++) {
    out->gx[k] = inv * (s->gx[k] * f[3] - s->gy[k] * f[2]);
    out->gy[k] = inv * (s->gy[k] * f[0] - s->gx[k] * f[1]);
    out->hoop[k] = s->move[k] * inv_hoop;
  }
}

/* Increments of the material's kind: F itself and its parts, or ln V and R. */
static void set_increment(const pw_real f[COMPONENTS], bool of_f, pw_idx k, batch *b)
{
  pw_real full[9] = {f[0], f[1], 0.0, f[2], f[3], 0.0, 0.0, 0.0, f[4]};
  const pw_real strain[6] = {f[0] - 1.0, f[3] - 1.0, f[4] - 1.0, 0.5 * (f[1] + f[2]), 0.0, 0.0};
  const pw_real spin[3] = {0.5 * (f[1] - f[2]), 0.0, 0.0};
  const pw_log_increment *log_f = &b->log_f[k];
  if (!of_f) {
    pw_log_increment_of(full, &b->log_f[k]);
  }
  for (int c = 0; c < 9; c++) {
    b->increment[c * PW_CHUNK + k] = full[c];
  }
  for (int c = 0; c < 6; c++) {
    b->dstrain[c * PW_CHUNK + k] = of_f ? strain[c] : log_f->strain[c];
  }
  for (int c = 0; c < 3; c++) {
    b->spin[c * PW_CHUNK + k] = of_f ? spin[c] : log_f->spin[c];
  }
}

/* F, b and J since the beginning, for materials that follow from them. */
static void set_deformation(const pw_points *p, const pw_real f[COMPONENTS], pw_idx i, pw_idx k,
                            batch *b)
{
  const pw_real *old = p->def_grad + i;
  const pw_real a[4] = {old[0], old[p->ld], old[2 * p->ld], old[3 * p->ld]};
  const pw_real now[COMPONENTS] = {f[0] * a[0] + f[1] * a[2], f[0] * a[1] + f[1] * a[3],
                                   f[2] * a[0] + f[3] * a[2], f[2] * a[1] + f[3] * a[3],
                                   f[4] * old[4 * p->ld]};
  const pw_real left[6] = {now[0] * now[0] + now[1] * now[1],
                           now[2] * now[2] + now[3] * now[3],
                           now[4] * now[4],
                           now[0] * now[2] + now[1] * now[3],
                           0.0,
                           0.0};
  for (int c = 0; c < 9; c++) {
    b->def_grad[c * PW_CHUNK + k] = 0.0;
  }
  for (int c = 0; c < COMPONENTS; c++) {
    b->def_grad[place[c] * PW_CHUNK + (size_t)k] = now[c];
  }
  for (int c = 0; c < 6; c++) {
    b->left_cg[c * PW_CHUNK + k] = left[c];
  }
  b->jac[k] = (now[0] * now[3] - now[1] * now[2]) * now[4];
}

/* Weights and increments of a batch; the first point turned inside out, or -1. */
static pw_idx load_batch(const pw_quad_evaluation *ev, bool of_f, pw_idx block, batch *b)
{
  pw_quad_model *m = ev->m;
  pw_sim *sim = m->sim;
  const pw_points *p = &sim->points;
  const pw_off ld = p->ld;
  const bool axi = sim->scene.geometry == PW_AXI;
  for (pw_idx k = 0; k < b->n; k++) {
    const pw_idx i = b->first + k;
    pw_real f[COMPONENTS];
    sim->kernels->support(&sim->transfer, i, &b->support[k]);
    increment_of(ev, &b->support[k], p->x[i], f);
    const pw_real plane = f[0] * f[3] - f[1] * f[2], det = plane * f[4];
    if (!(plane > 0.0 && f[4] > 0.0 && det < PW_HUGE)) { /* NaN too */
      return i;
    }
    push_forward(&b->support[k], f, axi ? 1.0 / p->x[i] : 0.0, &b->now[k]);
    set_increment(f, of_f, k, b);
    set_deformation(p, f, i, k, b);
    m->range[2 * block] = pw_min(m->range[2 * block], det);
    m->range[2 * block + 1] = pw_max(m->range[2 * block + 1], det);
    b->dvol[k] = det;
    b->density[k] = p->mass[i] / (p->vol[i] * det);
    for (int c = 0; c < COMPONENTS; c++) {
      m->increment[c * ld + i] = f[c];
    }
    for (int c = 0; c < 6; c++) {
      b->stress[c * PW_CHUNK + k] = p->stress[c * ld + i];
    }
    for (int c = 0; c < p->nstate; c++) {
      b->state[c * PW_CHUNK + k] = p->state[c * ld + i];
    }
  }
  return -1;
}

static void store_batch(pw_quad_model *m, const batch *b)
{
  const pw_off ld = m->sim->points.ld;
  for (pw_idx k = 0; k < b->n; k++) {
    for (int c = 0; c < 6; c++) {
      m->stress_trial[c * ld + b->first + k] = b->stress[c * PW_CHUNK + k];
    }
    for (int c = 0; c < m->sim->points.nstate; c++) {
      m->state_trial[c * ld + b->first + k] = b->state[c * PW_CHUNK + k];
    }
  }
}

/* Stress of a batch, and its tangent by F; the first point without one, or -1. */
static pw_idx update_batch(const pw_quad_evaluation *ev, const pw_body *body, pw_block_sums *sums,
                           batch *b)
{
  const pw_points *p = &ev->m->sim->points;
  pw_stress_args args = {.n = b->n,
                         .ld = PW_CHUNK,
                         .ldi = PW_CHUNK,
                         .dt = ev->m->dt,
                         .time = ev->m->time,
                         .step = ev->m->sim->step,
                         .dstrain = b->dstrain,
                         .spin = b->spin,
                         .dvol = b->dvol,
                         .left_cg = body->model->needs_left_cg ? b->left_cg : NULL,
                         .jac = body->model->needs_left_cg ? b->jac : NULL,
                         .density = b->density,
                         .def_grad = body->model->needs_def_grad ? b->def_grad : NULL,
                         .increment = b->increment,
                         .id = p->id + b->first,
                         .x = p->x + b->first,
                         .ldx = p->ld,
                         .dim = 2,
                         .of_f = body->model->of_f,
                         .stress = b->stress,
                         .state = b->state,
                         .wave_speed = b->wave_speed,
                         .tangent = ev->tangent ? b->tangent : NULL,
                         .counts = &sums->material,
                         .bad = -1};
  for (pw_idx k = 0; body->model->substeps && k < b->n; k++) {
    pw_guide_point(&ev->m->guide, (size_t)(b->first + k), (size_t)k, &args, b->guide);
  }
  const pw_status status = body->model->update(body->param, &args);
  for (pw_idx k = 0; ev->tangent && !args.of_f && k < b->n; k++) {
    pw_log_increment_tangent(&b->log_f[k], b->stress + k, b->tangent + k, PW_CHUNK);
  }
  store_batch(ev->m, b);
  if (status != PW_OK) {
    sums->why = sums->bad < 0 ? args.why : sums->why;
    return b->first + (args.bad >= 0 ? args.bad : 0);
  }
  return -1;
}

static void add_forces(const pw_quad_evaluation *ev, const pw_support *s, const gradients *g,
                       const pw_real *stress)
{
  pw_real *fx = ev->m->force, *fy = ev->m->force + ev->m->csr.nnode;
  for (int k = 0; k < s->n; k++) {
    fx[s->node[k]] += stress[0] * g->gx[k] + stress[1] * g->gy[k] + stress[8] * g->hoop[k];
    fy[s->node[k]] += stress[3] * g->gx[k] + stress[4] * g->gy[k];
  }
}

/* G_i : a : G_j of all nodes of a point, with the modulus a [81] times its volume. */
static void tangent_of(const pw_support *s, const gradients *g, const pw_real *modulus, pw_real *k)
{
  pw_real a[COMPONENTS][COMPONENTS];
  for (int r = 0; r < COMPONENTS; r++) {
    for (int c = 0; c < COMPONENTS; c++) {
      a[r][c] = modulus[9 * place[r] + place[c]];
    }
  }
  for (int j = 0; j < s->n; j++) {
    pw_real x[COMPONENTS], y[COMPONENTS]; /* a : G_j of a displacement along x, along y */
    for (int r = 0; r < COMPONENTS; r++) {
      x[r] = a[r][0] * g->gx[j] + a[r][1] * g->gy[j] + a[r][4] * g->hoop[j];
      y[r] = a[r][2] * g->gx[j] + a[r][3] * g->gy[j];
    }
    for (int i = 0; i < s->n; i++) {
      pw_real *row = k + 4 * s->n * i + 2 * j, *next = row + 2 * s->n;
      row[0] = g->gx[i] * x[0] + g->gy[i] * x[1] + g->hoop[i] * x[4];
      row[1] = g->gx[i] * y[0] + g->gy[i] * y[1] + g->hoop[i] * y[4];
      next[0] = g->gx[i] * x[2] + g->gy[i] * x[3];
      next[1] = g->gx[i] * y[2] + g->gy[i] * y[3];
    }
  }
}

/* Tangent times what nodes are given. */
static void add_lift(pw_quad_model *m, const pw_support *s, const pw_real *k)
{
  const pw_off nnode = m->csr.nnode;
  for (int j = 0; j < 2 * s->n; j++) {
    const pw_off from = (j % 2) * nnode + s->node[j / 2];
    if (!m->fixed[from] || m->prescribed[from] == 0.0) {
      continue;
    }
    for (int i = 0; i < 2 * s->n; i++) {
      m->lift[(i % 2) * nnode + s->node[i / 2]] += k[2 * s->n * i + j] * m->prescribed[from];
    }
  }
}

/* Square of the force that a strain of 1 makes. */
static pw_real stiff_force(const pw_support *s, const gradients *g, const pw_real *modulus)
{
  const pw_real mean = (modulus[0] + modulus[40] + modulus[80]) / 3.0;
  pw_real sum = 0.0;
  for (int k = 0; k < s->n; k++) {
    sum += g->gx[k] * g->gx[k] + g->gy[k] * g->gy[k] + g->hoop[k] * g->hoop[k];
  }
  return mean * mean * sum;
}

static void scatter_batch(const pw_quad_evaluation *ev, pw_idx block, const batch *b)
{
  pw_quad_model *m = ev->m;
  pw_real matrix[4 * PW_SUPPORT * PW_SUPPORT];
  for (pw_idx k = 0; k < b->n; k++) {
    const pw_support *s = &b->support[k];
    const gradients *g = &b->now[k];
    pw_tet_sums sums = {{0.0}, {0.0}, {0.0}};
    pw_tet_add_point(m->sim->points.vol[b->first + k] * b->dvol[k], b->stress + k,
                     ev->tangent ? b->tangent + k : NULL, PW_CHUNK, &sums);
    add_forces(ev, s, g, sums.stress);
    if (ev->tangent) {
      tangent_of(s, g, sums.modulus, matrix);
      pw_quad_pattern_add(&m->pattern, &m->csr, s->n, s->node, matrix);
      add_lift(m, s, matrix);
      m->stiff[block] += stiff_force(s, g, sums.modulus);
    }
  }
}

static void set_bad(pw_block_sums *sums, pw_idx point, pw_status status)
{
  if (point >= 0 && sums->bad < 0) {
    sums->bad = point;
    sums->bad_status = status;
  }
}

void pw_quad_block_evaluate(void *ctx, pw_idx block)
{
  const pw_quad_evaluation *ev = ctx;
  pw_sim *sim = ev->m->sim;
  pw_block_sums *sums = &sim->sums[block];
  const pw_idx *start = sim->blocks.point_start + (pw_off)block * sim->nbody;
  batch b;
  sums->bad = -1;
  sums->why = NULL;
  ev->m->stiff[block] = 0.0;
  ev->m->range[2 * block] = ev->m->range[2 * block + 1] = 1.0;
  for (int body = 0; body < sim->nbody; body++) {
    for (b.first = start[body]; b.first < start[body + 1]; b.first += PW_CHUNK) {
      const pw_body *own = &sim->body[body];
      b.n = start[body + 1] - b.first < PW_CHUNK ? start[body + 1] - b.first : PW_CHUNK;
      const pw_idx inverted = load_batch(ev, own->model->of_f, block, &b);
      set_bad(sums, inverted, PW_RETRY_DOMAIN_INVERTED);
      if (inverted >= 0) {
        return;
      }
      set_bad(sums, update_batch(ev, own, sums, &b), PW_RETRY_STRESS);
      scatter_batch(ev, block, &b);
    }
  }
}

/* ---- the end of a part ---- */

/* Work of the mean stress over the part, as in an explicit step; per volume at its end. */
static pw_real work_of(const pw_quad_model *m, const pw_points *p, pw_idx i)
{
  const pw_off ld = p->ld;
  const pw_real *f = m->increment + i, *new = m->stress_trial + i, *old = p->stress + i;
  const pw_real strain[4] = {f[0] - 1.0, f[3 * ld] - 1.0, f[4 * ld] - 1.0, f[ld] + f[2 * ld]};
  pw_real sum = 0.0;
  for (int c = 0; c < 4; c++) {
    sum += 0.5 * (new[c * ld] + old[c * ld]) * strain[c];
  }
  return sum;
}

/* Returns its kinetic energy in dynamics. */
static pw_real commit_point(const pw_quad_evaluation *ev, pw_idx i)
{
  pw_quad_model *m = ev->m;
  pw_points *p = &m->sim->points;
  const pw_off ld = p->ld;
  const pw_real *f = m->increment + i;
  const pw_real xx = f[0], xy = f[ld], yx = f[2 * ld], yy = f[3 * ld];
  pw_real *g = p->def_grad + i;
  pw_support s;
  m->sim->kernels->support(&m->sim->transfer, i, &s);
  for (int k = 0; k < s.n; k++) {
    p->x[i] += s.move[k] * ev->u[s.node[k]];
    p->x[ld + i] += s.move[k] * ev->u[m->csr.nnode + s.node[k]];
  }
  for (int c = 0; c < 2; c++) {
    const pw_real upper = g[c * ld], lower = g[(2 + c) * ld];
    g[c * ld] = xx * upper + xy * lower;
    g[(2 + c) * ld] = yx * upper + yy * lower;
  }
  g[4 * ld] *= f[4 * ld];
  p->vol[i] *= (xx * yy - xy * yx) * f[4 * ld];
  for (int c = 0; c < 6; c++) {
    p->stress[c * ld + i] = m->stress_trial[c * ld + i];
  }
  for (int c = 0; c < p->nstate; c++) {
    p->state[c * ld + i] = m->state_trial[c * ld + i];
  }
  return m->inertia.on ? pw_quad_inertia_commit(m, &s, i) : 0.0;
}

void pw_quad_block_commit(void *ctx, pw_idx block)
{
  const pw_quad_evaluation *ev = ctx;
  pw_sim *sim = ev->m->sim;
  pw_block_sums *sums = &sim->sums[block];
  const pw_idx *start = sim->blocks.point_start + (pw_off)block * sim->nbody;
  for (pw_idx i = start[0]; i < start[sim->nbody]; i++) {
    const pw_real work = work_of(ev->m, &sim->points, i);
    sums->kinetic += commit_point(ev, i);
    sums->strain_work += work * sim->points.vol[i];
  }
  if (sim->limit) {
    pw_domain_convect(sim, NULL, start[0], start[sim->nbody] - start[0], sums);
  }
  pw_block_weights(sim, block);
}
