/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/tet_patch.h"

#include <math.h>
#include <string.h>

#include "kernels/log_increment.h"
#include "kernels/tensor.h"

static void node_values(const pw_tet_model *m, pw_idx e, const pw_real *u, pw_real *out)
{
  const size_t n = (size_t)m->mesh->tets.nnode;
  const pw_idx *node = m->mesh->tets.node + 4 * (size_t)e;
  for (size_t a = 0; a < 4; a++) {
    for (size_t c = 0; c < 3; c++) {
      out[3 * a + c] = u[c * n + (size_t)node[a]];
    }
  }
}

pw_idx pw_patch_move(const pw_tet_model *m, pw_idx p, const pw_real *u, pw_patch_motion *out)
{
  const pw_tet_points *q = &m->points;
  pw_real before = 0.0;
  out->nactive = 0;
  out->now = 0.0;
  out->why = NULL;
  for (pw_idx s = 0; s < m->mesh->per; s++) {
    const pw_idx e = p * m->mesh->per + s;
    const pw_idx first = m->elem_start[e], last = m->elem_start[e + 1];
    pw_real start[12], nodal[12], volume = 0.0;
    out->active[s] = last > first;
    if (last == first) {
      continue;
    }
    pw_tet_mesh_gradients(m->mesh, e, start);
    node_values(m, e, u, nodal);
    pw_tet_motion_of(start, nodal, &out->motion[s]);
    if (!(out->motion[s].det > 0.0)) {
      return e;
    }
    for (pw_idx k = first; k < last; k++) {
      const pw_idx i = m->elem_point[k];
      volume += q->volume[i];
      before += m->fbar == PW_FBAR_TOTAL ? q->volume[i] / q->jac[i] : q->volume[i];
    }
    out->volume[s] = volume * out->motion[s].det;
    out->now += out->volume[s];
    out->nactive++;
  }
  out->ratio = out->now / before;
  return -1;
}

/* What a batch of points of one element and body needs; [component][PW_CHUNK]. */
typedef struct {
  pw_idx n, point[PW_CHUNK];
  pw_real increment[9 * PW_CHUNK], dstrain[6 * PW_CHUNK], spin[3 * PW_CHUNK];
  pw_real dvol[PW_CHUNK], density[PW_CHUNK], wave_speed[PW_CHUNK];
  pw_real left_cg[6 * PW_CHUNK], jac[PW_CHUNK]; /* where the points keep b */
  pw_real def_grad[9 * PW_CHUNK], x[3 * PW_CHUNK], guide[PW_GUIDE_ROWS * PW_CHUNK];
  pw_real stress[6 * PW_CHUNK], state[PW_MAX_STATE * PW_CHUNK], tangent[36 * PW_CHUNK];
} batch;

/* F, and the parts of F - 1. */
static void set_increment(const pw_real *f, pw_real scale, size_t k, batch *b)
{
  static const int row[6] = {0, 1, 2, 0, 1, 2}, col[6] = {0, 1, 2, 1, 2, 0};
  for (size_t ij = 0; ij < 9; ij++) {
    b->increment[ij * PW_CHUNK + k] = scale * f[ij];
  }
  for (size_t c = 0; c < 6; c++) {
    pw_real up = f[3 * row[c] + col[c]], down = f[3 * col[c] + row[c]];
    b->dstrain[c * PW_CHUNK + k] = 0.5 * scale * (up + down) - (c < 3 ? 1.0 : 0.0);
    if (c >= 3) { /* xy, yz, and xz for zx */
      b->spin[(c - 3) * PW_CHUNK + k] = 0.5 * scale * (up - down);
    }
  }
}

/* For models in rate form: strain and rotation of F. */
static void set_log_increment(const pw_log_increment *log_f, pw_real scale, size_t k, batch *b)
{
  const pw_real more = log(scale);
  for (size_t c = 0; c < 6; c++) {
    b->dstrain[c * PW_CHUNK + k] = log_f->strain[c] + (c < 3 ? more : 0.0);
  }
  for (size_t c = 0; c < 3; c++) {
    b->spin[c * PW_CHUNK + k] = log_f->spin[c];
  }
}

/* F at the end of the step, from what the points keep and the increment. */
static void set_def_grad(const pw_tet_points *q, size_t i, size_t k, batch *b)
{
  const size_t l = (size_t)q->ld, n = PW_CHUNK;
  for (size_t r = 0; r < 9; r++) {
    const pw_real *f = b->increment + k + (r - r % 3) * n, *g = q->def_grad + i + r % 3 * l;
    pw_real now = f[0] * g[0] + f[n] * g[3 * l] + f[2 * n] * g[6 * l];
    b->def_grad[r * n + k] = q->def_grad_trial[r * l + i] = now;
  }
}

/* b and J at the end of the step, from what the points keep and the increment. */
static void set_left_cg(const pw_tet_points *q, size_t i, size_t k, batch *b)
{
  const size_t l = (size_t)q->ld, n = PW_CHUNK;
  const pw_real *f = b->increment + k;
  pw_rot r = {f[0], f[n], f[2 * n], f[3 * n], f[4 * n], f[5 * n], f[6 * n], f[7 * n], f[8 * n]};
  pw_t6 now = pw_t6_rotate(r, pw_t6_load(q->left_cg + i, l)); /* f b f^T whatever f is */
  pw_t6_store(now, b->left_cg + k, n);
  pw_t6_store(now, q->left_cg_trial + i, l);
  b->jac[k] = q->jac_bar_trial[i];
}

/* Cube root of theta: how much F-bar scales the increment of point i. */
static pw_real scaling(const pw_tet_model *m, const pw_patch_motion *t, pw_real det, pw_idx i)
{
  const pw_tet_points *q = &m->points;
  if (m->fbar == PW_FBAR_INCREMENT) {
    return t->nactive > 1 ? cbrt(t->ratio / det) : 1.0;
  }
  if (m->fbar == PW_FBAR_TOTAL) {
    pw_real wanted = t->nactive > 1 ? t->ratio : q->jac[i] * det;
    return cbrt(wanted / (det * q->jac_bar[i]));
  }
  return 1.0;
}

static void load_batch(const pw_tet_model *m, const pw_patch_motion *t, pw_idx s,
                       const pw_log_increment *log_f, batch *b)
{
  const pw_tet_points *q = &m->points;
  const pw_tet_motion *e = &t->motion[s];
  const pw_tet_material *material = &m->material[q->body[b->point[0]]];
  const pw_real density = material->model->density(material->param);
  for (size_t k = 0; k < (size_t)b->n; k++) {
    const size_t i = (size_t)b->point[k], l = (size_t)q->ld;
    pw_real scale = scaling(m, t, e->det, b->point[k]), det = scale * scale * scale * e->det;
    set_increment(e->increment, scale, k, b);
    if (!material->model->of_f) {
      set_log_increment(log_f, scale, k, b);
    }
    b->dvol[k] = det;
    b->density[k] = density / (q->jac_bar[i] * det);
    q->jac_bar_trial[i] = q->jac_bar[i] * det;
    if (q->left_cg) {
      set_left_cg(q, i, k, b);
    }
    if (q->def_grad) {
      set_def_grad(q, i, k, b);
    }
    for (size_t c = 0; c < 3; c++) {
      b->x[c * PW_CHUNK + k] = q->x[c * l + i];
    }
    for (size_t c = 0; c < 6; c++) {
      b->stress[c * PW_CHUNK + k] = q->stress[c * l + i];
    }
    for (size_t c = 0; c < (size_t)q->nstate; c++) {
      b->state[c * PW_CHUNK + k] = q->state[c * l + i];
    }
  }
}

static void store_batch(const pw_tet_points *q, const batch *b)
{
  for (size_t k = 0; k < (size_t)b->n; k++) {
    const size_t i = (size_t)b->point[k], l = (size_t)q->ld;
    for (size_t c = 0; c < 6; c++) {
      q->stress_trial[c * l + i] = b->stress[c * PW_CHUNK + k];
    }
    for (size_t c = 0; c < (size_t)q->nstate; c++) {
      q->state_trial[c * l + i] = b->state[c * PW_CHUNK + k];
    }
  }
}

/* What a model in rate form gives by its strain, by that of F. */
static void finish_tangent(const pw_log_increment *log_f, batch *b)
{
  for (pw_idx k = 0; k < b->n; k++) {
    pw_log_increment_tangent(log_f, b->stress + k, b->tangent + k, PW_CHUNK);
  }
}

static pw_status update_batch(const pw_tet_model *m, pw_patch_motion *t, pw_idx s,
                              const pw_log_increment *log_f, bool tangent, batch *b)
{
  const pw_tet_material *material = &m->material[m->points.body[b->point[0]]];
  load_batch(m, t, s, log_f, b);
  pw_stress_args args = {.n = b->n,
                         .ld = PW_CHUNK,
                         .ldi = PW_CHUNK,
                         .dt = m->dt,
                         .time = m->time,
                         .step = m->step,
                         .dstrain = b->dstrain,
                         .spin = b->spin,
                         .dvol = b->dvol,
                         .left_cg = m->points.left_cg ? b->left_cg : NULL,
                         .jac = m->points.left_cg ? b->jac : NULL,
                         .density = b->density,
                         .def_grad = m->points.def_grad ? b->def_grad : NULL,
                         .increment = b->increment,
                         .id = b->point,
                         .x = b->x,
                         .ldx = PW_CHUNK,
                         .dim = 3,
                         .of_f = material->model->of_f,
                         .stress = b->stress,
                         .state = b->state,
                         .wave_speed = b->wave_speed,
                         .tangent = tangent ? b->tangent : NULL};
  for (pw_idx k = 0; material->model->substeps && k < b->n; k++) {
    pw_guide_point(&m->guide, (size_t)b->point[k], (size_t)k, &args, b->guide);
  }
  pw_status status = material->model->update(material->param, &args);
  t->why = status != PW_OK && !t->why ? args.why : t->why;
  if (tangent && !args.of_f) {
    finish_tangent(log_f, b);
  }
  store_batch(&m->points, b);
  return status;
}

static bool has_rate_form(const pw_tet_model *m)
{
  bool found = false;
  for (pw_idx i = 0; i < m->nmaterial; i++) {
    found = found || !m->material[i].model->of_f;
  }
  return found;
}

/* Stress of all points of an element and the sums over them; false when one fails. */
static bool sum_points(const pw_tet_model *m, pw_idx p, pw_idx s, pw_patch_motion *t, bool tangent,
                       pw_tet_sums *sums)
{
  const pw_tet_points *q = &m->points;
  const pw_idx e = p * m->mesh->per + s, last = m->elem_start[e + 1];
  pw_idx k = m->elem_start[e];
  bool good = true;
  pw_log_increment log_f;
  batch b;
  if (has_rate_form(m)) {
    pw_log_increment_of(t->motion[s].increment, &log_f);
  }
  memset(sums, 0, sizeof *sums);
  while (k < last) {
    const pw_idx body = q->body[m->elem_point[k]];
    b.n = 0;
    while (k < last && b.n < PW_CHUNK && q->body[m->elem_point[k]] == body) {
      b.point[b.n++] = m->elem_point[k++];
    }
    good = update_batch(m, t, s, &log_f, tangent, &b) == PW_OK && good;
    for (pw_idx i = 0; i < b.n; i++) {
      pw_tet_add_point(q->volume[b.point[i]] * t->motion[s].det, b.stress + i,
                       tangent ? b.tangent + i : NULL, PW_CHUNK, sums);
    }
  }
  return good;
}

/* Mean of the shape gradients of the elements, by volume: what div u of the patch is made of. */
static void mean_gradient(const pw_tet_model *m, pw_idx p, const pw_patch_motion *t, pw_real *mean)
{
  memset(mean, 0, PW_PATCH_DOFS * sizeof *mean);
  for (pw_idx s = 0; s < m->mesh->per; s++) {
    const int8_t *local = m->mesh->local + 4 * (size_t)(p * m->mesh->per + s);
    for (int i = 0; t->active[s] && i < 12; i++) {
      mean[3 * local[i / 3] + i % 3] += t->volume[s] / t->now * t->motion[s].g[i];
    }
  }
}

static void add_tangent(const int8_t *local, const pw_tet_sums *sums, const pw_real *g, pw_real *k)
{
  pw_real own[144];
  pw_tet_tangent(sums, g, own);
  for (int i = 0; i < 12; i++) {
    pw_real *row = k + PW_PATCH_DOFS * (3 * local[i / 3] + i % 3);
    for (int j = 0; j < 12; j++) {
      row[3 * local[j / 3] + j % 3] += own[12 * i + j];
    }
  }
}

/* The rank-one term of F-bar: (g Q) (T - t). */
static void add_patch_term(const int8_t *local, const pw_tet_sums *sums, const pw_real *g,
                           const pw_real *mean, pw_real *k)
{
  pw_real pull[12], rest[PW_PATCH_DOFS];
  pw_tet_volumetric_force(sums, g, pull);
  memcpy(rest, mean, sizeof rest);
  for (int i = 0; i < 12; i++) {
    rest[3 * local[i / 3] + i % 3] -= g[i];
  }
  for (int i = 0; i < 12; i++) {
    pw_real *row = k + PW_PATCH_DOFS * (3 * local[i / 3] + i % 3);
    for (int j = 0; j < PW_PATCH_DOFS; j++) {
      row[j] += pull[i] * rest[j];
    }
  }
}

/* Square of the force that a strain of 1 makes. */
static pw_real stiff_force(const pw_tet_sums *sums, const pw_real *g)
{
  const pw_real modulus = (sums->modulus[0] + sums->modulus[40] + sums->modulus[80]) / 3.0;
  pw_real length = 0.0;
  for (int i = 0; i < 12; i++) {
    length += g[i] * g[i];
  }
  return modulus * modulus * length;
}

pw_idx pw_patch_evaluate(const pw_tet_model *m, pw_idx p, pw_patch_motion *motion, pw_real *force,
                         pw_real *k)
{
  const bool spread = m->fbar != PW_FBAR_NONE && motion->nactive > 1;
  pw_real mean[PW_PATCH_DOFS], own[12];
  pw_tet_sums sums;
  pw_idx bad = -1;
  memset(force, 0, PW_PATCH_DOFS * sizeof *force);
  motion->rounding = 0.0;
  if (k) {
    memset(k, 0, (size_t)PW_PATCH_DOFS * PW_PATCH_DOFS * sizeof *k);
    mean_gradient(m, p, motion, mean);
  }
  for (pw_idx s = 0; s < m->mesh->per; s++) {
    const pw_idx e = p * m->mesh->per + s;
    const int8_t *local = m->mesh->local + 4 * (size_t)e;
    const pw_real *g = motion->motion[s].g;
    if (!motion->active[s]) {
      continue;
    }
    if (!sum_points(m, p, s, motion, k != NULL, &sums) && bad < 0) {
      bad = e;
    }
    pw_tet_force(&sums, g, own);
    for (int i = 0; i < 12; i++) {
      force[3 * local[i / 3] + i % 3] += own[i];
    }
    if (k) {
      add_tangent(local, &sums, g, k);
      motion->rounding += stiff_force(&sums, g);
    }
    if (k && spread) {
      add_patch_term(local, &sums, g, mean, k);
    }
  }
  return bad;
}
