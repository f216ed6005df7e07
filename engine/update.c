/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/update.h"

#include <math.h>
#include <string.h>

#include "engine/domain.h"
#include "engine/fbar.h"
#include "engine/rates.h"

/** Scratch of one batch of points; lives on the stack of its thread. */
typedef struct {
  pw_gradients grad;
  pw_real dstrain[6 * PW_CHUNK], spin[3 * PW_CHUNK], dvol[PW_CHUNK];
  pw_real left_cg[6 * PW_CHUNK], jac[PW_CHUNK], density[PW_CHUNK];
  pw_real def_grad[9 * PW_CHUNK];
  pw_real old_stress[6 * PW_CHUNK], wave_speed[PW_CHUNK];
} batch;

static void body_range(const pw_sim *sim, pw_idx block, int body, pw_idx *first, pw_idx *last)
{
  const pw_idx *start = sim->blocks.point_start + (pw_off)block * sim->nbody + body;
  *first = start[0];
  *last = start[1];
}

/* Call a kernel of the common shape for each body's range of a block. */
typedef void (*range_kernel)(const pw_transfer *, pw_real *, pw_idx, pw_idx);

static void each_body(pw_sim *sim, pw_idx block, range_kernel kernel)
{
  for (int b = 0; b < sim->nbody; b++) {
    pw_idx first, last;
    body_range(sim, block, b, &first, &last);
    if (first < last) {
      kernel(&sim->transfer, pw_rates_records(sim, block, sim->body[b].field), first, last);
    }
  }
}

void pw_block_p2g(void *ctx, pw_idx block)
{
  pw_sim *sim = ctx;
  each_body(sim, block, sim->kernels->p2g);
}

void pw_block_p2g_momentum(void *ctx, pw_idx block)
{
  pw_sim *sim = ctx;
  each_body(sim, block, sim->kernels->p2g_momentum);
}

static void velocity(pw_sim *sim, pw_idx block, bool remap)
{
  const pw_real pic = pw_min(1.0, sim->scene.method.noise_damping_per_s * pw_rates_dt(sim, block));
  pw_real settled = 0.0;
  for (int b = 0; b < sim->nbody; b++) {
    pw_idx first, last;
    body_range(sim, block, b, &first, &last);
    pw_real *rec = pw_nodes_field(&sim->nodes, sim->body[b].field);
    sim->kernels->g2p_velocity(&sim->transfer, pw_rates_records(sim, block, sim->body[b].field),
                               first, last);
    if (pic > 0.0) {
      settled += sim->kernels->g2p_settle(&sim->transfer, rec, pic, first, last);
    }
    if (remap) {
      sim->kernels->p2g_remap(&sim->transfer, rec, first, last);
    }
  }
  sim->sums[block].settled = settled;
}

void pw_block_velocity(void *ctx, pw_idx block)
{
  velocity(ctx, block, false);
}

void pw_block_velocity_remap(void *ctx, pw_idx block)
{
  velocity(ctx, block, true);
}

/* Deformation gradient F(n+1) = (I + grad du) F(n) (thesis eq. 2.28), volume, and the increments
 * that materials take. Returns the first point with a volume ratio that is not positive, or -1. */
static pw_idx deform(pw_sim *sim, batch *s, pw_idx first, pw_idx n)
{
  pw_points *p = &sim->points;
  const pw_idx ld = p->ld, none = INT32_MAX;
  pw_real *restrict f = p->def_grad + first, *restrict vol = p->vol + first;
  const pw_real *restrict mass = p->mass + first;
  pw_idx bad = none;
#pragma omp simd reduction(min : bad)
  for (pw_idx i = 0; i < n; i++) {
    pw_real xx = s->grad.du[0][i], xy = s->grad.du[1][i], yx = s->grad.du[2][i];
    pw_real yy = s->grad.du[3][i], zz = s->grad.du[4][i];
    pw_real f0 = f[i], f1 = f[ld + i], f2 = f[2 * ld + i], f3 = f[3 * ld + i];
    pw_real dj = ((1.0 + xx) * (1.0 + yy) - xy * yx) * (1.0 + zz);
    pw_idx bad_i = dj > 0.0 && dj < PW_HUGE ? none : i; /* NaN counts as bad */
    bad = bad_i < bad ? bad_i : bad;
    f[i] = f0 + xx * f0 + xy * f2;
    f[ld + i] = f1 + xx * f1 + xy * f3;
    f[2 * ld + i] = f2 + yx * f0 + yy * f2;
    f[3 * ld + i] = f3 + yx * f1 + yy * f3;
    f[4 * ld + i] *= 1.0 + zz;
    vol[i] *= dj;
    s->dvol[i] = dj;
    s->density[i] = mass[i] / vol[i];
    s->dstrain[i] = xx;
    s->dstrain[PW_CHUNK + i] = yy;
    s->dstrain[2 * PW_CHUNK + i] = zz;
    s->dstrain[3 * PW_CHUNK + i] = 0.5 * (xy + yx);
    s->dstrain[4 * PW_CHUNK + i] = s->dstrain[5 * PW_CHUNK + i] = 0.0;
    s->spin[i] = 0.5 * (xy - yx);
    s->spin[PW_CHUNK + i] = s->spin[2 * PW_CHUNK + i] = 0.0;
  }
  return bad == none ? -1 : first + bad;
}

/* b = F F^T and J for materials that follow from the deformation gradient. */
static void left_cauchy_green(const pw_sim *sim, batch *s, pw_idx first, pw_idx n)
{
  const pw_idx ld = sim->points.ld;
  const pw_real *restrict f = sim->points.def_grad + first;
#pragma omp simd
  for (pw_idx i = 0; i < n; i++) {
    pw_real xx = f[i], xy = f[ld + i], yx = f[2 * ld + i], yy = f[3 * ld + i], zz = f[4 * ld + i];
    s->left_cg[i] = xx * xx + xy * xy;
    s->left_cg[PW_CHUNK + i] = yx * yx + yy * yy;
    s->left_cg[2 * PW_CHUNK + i] = zz * zz;
    s->left_cg[3 * PW_CHUNK + i] = xx * yx + xy * yy;
    s->left_cg[4 * PW_CHUNK + i] = s->left_cg[5 * PW_CHUNK + i] = 0.0;
    s->jac[i] = (xx * yy - xy * yx) * zz;
  }
}

/* The deformation gradient in three dimensions. */
static void copy_def_grad(const pw_sim *sim, batch *s, pw_idx first, pw_idx n)
{
  static const int place[5] = {0, 1, 3, 4, 8}; /* of xx, xy, yx, yy, zz in rows */
  const pw_points *p = &sim->points;
  memset(s->def_grad, 0, sizeof s->def_grad);
  for (int c = 0; c < 5; c++) {
    for (pw_idx i = 0; i < n; i++) {
      s->def_grad[place[c] * PW_CHUNK + i] = p->def_grad[(pw_off)c * p->ld + first + i];
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

/* Largest (c + |v|) / h of the points, with the part c of the wave speeds that steps resolve and the
 * smallest cell h at each or beside it. */
static pw_real fastest_crossing(const pw_sim *sim, const batch *s, pw_real part, pw_idx first,
                                pw_idx n)
{
  const pw_points *p = &sim->points;
  pw_real rate = 0.0;
  for (pw_idx i = 0; i < n; i++) {
    pw_real x[2] = {p->x[first + i], p->x[p->ld + first + i]};
    pw_real vx = p->v[first + i], vy = p->v[p->ld + first + i];
    pw_real speed = part * s->wave_speed[i] + sqrt(vx * vx + vy * vy);
    rate = pw_max(rate, speed / pw_mesh_near_size(&sim->mesh, x));
  }
  return rate;
}

/* Work of the mean stress over the step, and the fastest signal c + |v| of what steps resolve. */
static void sum_batch(const pw_sim *sim, const batch *s, pw_real part, pw_idx first, pw_idx n,
                      pw_block_sums *sums)
{
  const pw_points *p = &sim->points;
  const pw_idx ld = p->ld;
  const pw_real *restrict sig = p->stress + first, *restrict vol = p->vol + first;
  const pw_real *restrict v = p->v + first;
  pw_real work = 0.0, kinetic = 0.0, speed = sums->speed_max;
  pw_idx bad = -1;
  for (pw_idx i = 0; i < n; i++) {
    pw_real w = 0.0;
    for (int c = 0; c < 4; c++) { /* xx yy zz xy: the others do no work in the plane */
      pw_real twice = c == 3 ? 2.0 : 1.0;
      w += twice * (sig[c * ld + i] + s->old_stress[c * PW_CHUNK + i]) *
           s->dstrain[c * PW_CHUNK + i];
    }
    pw_real v2 = v[i] * v[i] + v[ld + i] * v[ld + i];
    bad = v2 < PW_HUGE || bad >= 0 ? bad : first + i; /* NaN too */
    work += 0.5 * w * vol[i];
    kinetic += 0.5 * p->mass[first + i] * v2;
    speed = pw_max(speed, part * s->wave_speed[i] + sqrt(v2));
  }
  if (sim->mesh.graded) {
    sums->rate_max = pw_max(sums->rate_max, fastest_crossing(sim, s, part, first, n));
  }
  sums->strain_work += work;
  sums->kinetic += kinetic;
  set_bad(sums, bad, PW_RETRY_NAN);
  sums->speed_max = speed;
}

/* The deformation gradient with the volume ratio of F-bar. */
static void share_def_grad(const pw_sim *sim, batch *s, pw_idx first, pw_idx n)
{
  const bool axi = sim->scene.geometry == PW_AXI;
  for (pw_idx i = 0; i < n; i++) {
    pw_real *f = s->def_grad + i;
    pw_real own = (f[0] * f[4 * PW_CHUNK] - f[PW_CHUNK] * f[3 * PW_CHUNK]) * f[8 * PW_CHUNK];
    pw_real ratio = sim->points.volume_ratio[first + i] / own;
    pw_real scale = axi ? cbrt(ratio) : sqrt(ratio);
    for (int k = 0; k < 9; k++) {
      f[k * PW_CHUNK] *= axi || k != 8 ? scale : 1.0;
    }
  }
}

/* What the material sees in place of the points' own deformation. */
static void share_volume_change(pw_sim *sim, int b, batch *s, pw_idx first, pw_idx n)
{
  pw_fbar_apply(sim, b, first, n, s->dstrain, s->dvol);
  const bool axi = sim->scene.geometry == PW_AXI;
  if (sim->body[b].model->needs_def_grad) {
    share_def_grad(sim, s, first, n);
  }
  if (!sim->body[b].model->needs_left_cg) {
    return;
  }
  for (pw_idx i = 0; i < n; i++) {
    pw_real ratio = sim->points.volume_ratio[first + i] / s->jac[i];
    pw_real scale = axi ? cbrt(ratio * ratio) : ratio;
    for (int k = 0; k < 4; k++) {
      s->left_cg[k * PW_CHUNK + i] *= axi || k != 2 ? scale : 1.0;
    }
    s->jac[i] = sim->points.volume_ratio[first + i];
  }
}

static void stress_batch(pw_sim *sim, int b, batch *s, pw_idx first, pw_idx n, pw_block_sums *sums)
{
  const pw_idx block = (pw_idx)(sums - sim->sums);
  const pw_body *body = &sim->body[b];
  pw_points *p = &sim->points;
  for (int c = 0; c < 4; c++) {
    for (pw_idx i = 0; i < n; i++) {
      s->old_stress[c * PW_CHUNK + i] = p->stress[(pw_off)c * p->ld + first + i];
    }
  }
  pw_stress_args args = {.n = n,
                         .ld = p->ld,
                         .ldi = PW_CHUNK,
                         .dt = pw_rates_dt(sim, block),
                         .time = pw_rates_time(sim, block),
                         .step = sim->step,
                         .dstrain = s->dstrain,
                         .spin = s->spin,
                         .dvol = s->dvol,
                         .density = s->density,
                         .id = p->id + first,
                         .x = p->x + first,
                         .ldx = p->ld,
                         .dim = 2,
                         .of_f = body->model->of_f,
                         .stress = p->stress + first,
                         .state = p->state ? p->state + first : NULL,
                         .wave_speed = s->wave_speed,
                         .counts = &sums->material,
                         .bad = -1};
  if (body->model->needs_left_cg) {
    left_cauchy_green(sim, s, first, n);
    args.left_cg = s->left_cg;
    args.jac = s->jac;
  }
  if (body->model->needs_def_grad) {
    copy_def_grad(sim, s, first, n);
    args.def_grad = s->def_grad;
  }
  if (sim->fbar && sim->fbar->body[b]) {
    share_volume_change(sim, b, s, first, n);
  }
  if (body->model->update(body->param, &args) != PW_OK) {
    sums->why = sums->bad < 0 ? args.why : sums->why;
    set_bad(sums, first + args.bad, PW_RETRY_STRESS);
  }
  if (p->wave_speed) {
    memcpy(p->wave_speed + first, s->wave_speed, (size_t)n * sizeof *p->wave_speed);
  }
  sum_batch(sim, s, body->step_part, first, n, sums);
}

static void clear_sums(pw_block_sums *sums)
{
  *sums = (pw_block_sums){.settled = sums->settled, .bad = -1, .weights = {-1, -1, -1, 0}};
}

static void update_body(const pw_update_pass *pass, batch *s, pw_idx block, int b)
{
  pw_sim *sim = pass->sim;
  pw_block_sums *sums = &sim->sums[block];
  const pw_real *rec = pw_nodes_field(&sim->nodes, sim->body[b].field);
  const bool shared = sim->fbar && sim->fbar->body[b] && pass->stress;
  pw_idx first, last;
  body_range(sim, block, b, &first, &last);
  for (; first < last; first += PW_CHUNK) {
    pw_idx n = last - first < PW_CHUNK ? last - first : PW_CHUNK;
    if (shared) {
      pw_fbar_gradients(sim->fbar, sim->points.ld, first, n, &s->grad);
    } else {
      sim->kernels->g2p_gradient(&sim->transfer, rec, pass->slot, pw_rates_dt(sim, block),
                                 pass->move, first, first + n, &s->grad);
    }
    if (!pass->stress) {
      continue;
    }
    set_bad(sums, deform(sim, s, first, n), PW_RETRY_DOMAIN_INVERTED);
    stress_batch(sim, b, s, first, n, sums);
    if (sim->limit) {
      pw_domain_convect(sim, &s->grad, first, n, sums);
    }
  }
}

static void merge_weights(pw_weights_report *into, const pw_weights_report *from)
{
  into->lost = into->lost < 0 ? from->lost : into->lost;
  into->overrun = into->overrun < 0 ? from->overrun : into->overrun;
  into->inverted = into->inverted < 0 ? from->inverted : into->inverted;
  into->clamped += from->clamped;
}

void pw_block_update(void *ctx, pw_idx block)
{
  const pw_update_pass *pass = ctx;
  batch s;
  if (pass->stress) {
    clear_sums(&pass->sim->sums[block]);
  }
  for (int b = 0; b < pass->sim->nbody; b++) {
    update_body(pass, &s, block, b);
  }
  pw_block_weights(pass->sim, block);
}

void pw_block_weights(void *ctx, pw_idx block)
{
  pw_sim *sim = ctx;
  pw_weights_report report;
  pw_idx first, last, unused;
  body_range(sim, block, 0, &first, &unused);
  body_range(sim, block, sim->nbody - 1, &unused, &last);
  sim->kernels->weights(&sim->transfer, first, last, &report);
  sim->sums[block].weights = (pw_weights_report){-1, -1, -1, 0};
  merge_weights(&sim->sums[block].weights, &report);
}

void pw_block_wave_speed(void *ctx, pw_idx block)
{
  pw_sim *sim = ctx;
  batch s = {0};
  clear_sums(&sim->sums[block]);
  for (int b = 0; b < sim->nbody; b++) {
    pw_idx first, last;
    body_range(sim, block, b, &first, &last);
    for (; first < last; first += PW_CHUNK) {
      pw_idx n = last - first < PW_CHUNK ? last - first : PW_CHUNK;
      deform(sim, &s, first, n); /* gradients are zero: only density and increments are set */
      stress_batch(sim, b, &s, first, n, &sim->sums[block]);
    }
  }
}
