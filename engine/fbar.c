/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/fbar.h"

#include <math.h>
#include <string.h>

#include "engine/rates.h"

static pw_real *cell_sums(const pw_sim *sim, int body)
{
  return sim->fbar->sum + 2 * (pw_off)body * sim->mesh.nelem;
}

void pw_fbar_clear(pw_sim *sim)
{
  for (int b = 0; b < sim->nbody; b++) {
    if (sim->fbar->body[b]) {
      memset(cell_sums(sim, b), 0, 2 * (size_t)sim->mesh.nelem * sizeof(pw_real));
    }
  }
}

/* Cells of points [first, first + n); -1: outside, or one whose points take other steps. */
static void find_cells(const pw_sim *sim, pw_idx block, pw_idx first, pw_idx n)
{
  const pw_points *p = &sim->points;
  pw_idx *e = sim->fbar->element + first;
  pw_mesh_locate_points(&sim->mesh, p->x + first, p->ld, n, e);
  for (pw_idx i = 0; sim->rates && i < n; i++) {
    e[i] = e[i] >= 0 && pw_rates_share(sim, block, e[i]) ? e[i] : -1;
  }
}

/* The part of the stress that works on a change of volume, where F-bar scales the components. */
static pw_real mean_stress(const pw_sim *sim, pw_idx i)
{
  const pw_real *s = sim->points.stress + i;
  const pw_idx ld = sim->points.ld;
  return sim->scene.geometry == PW_AXI ? (s[0] + s[ld] + s[2 * ld]) / 3.0 : 0.5 * (s[0] + s[ld]);
}

void pw_block_fbar_sum(void *ctx, pw_idx block)
{
  pw_sim *sim = ctx;
  pw_fbar_cells *c = sim->fbar;
  const pw_points *p = &sim->points;
  for (int b = 0; b < sim->nbody; b++) {
    const pw_idx *range = sim->blocks.point_start + (pw_off)block * sim->nbody + b;
    pw_real *sum = cell_sums(sim, b);
    if (c->body[b]) {
      find_cells(sim, block, range[0], range[1] - range[0]);
    }
    for (pw_idx i = range[0]; c->body[b] && i < range[1]; i++) {
      const pw_idx e = c->element[i];
      if (e >= 0) {
        sum[2 * (pw_off)e] += p->vol[i];
        sum[2 * (pw_off)e + 1] += p->vol[i] * mean_stress(sim, i);
      }
    }
  }
}

void pw_block_fbar_stress(void *ctx, pw_idx block)
{
  pw_sim *sim = ctx;
  pw_fbar_cells *c = sim->fbar;
  const pw_points *p = &sim->points;
  const pw_idx ld = p->ld;
  const int scaled = sim->scene.geometry == PW_AXI ? 3 : 2;
  for (int b = 0; b < sim->nbody; b++) {
    const pw_idx *range = sim->blocks.point_start + (pw_off)block * sim->nbody + b;
    const pw_real *sum = cell_sums(sim, b);
    for (pw_idx i = range[0]; i < range[1]; i++) {
      const pw_idx e = c->body[b] ? c->element[i] : -1;
      pw_real more = e >= 0 ? sum[2 * (pw_off)e + 1] / sum[2 * (pw_off)e] - mean_stress(sim, i) : 0;
      for (int k = 0; k < 6; k++) {
        c->stress[k * ld + i] = p->stress[k * ld + i] + (k < scaled ? more : 0.0);
      }
    }
  }
}

static pw_real volume_ratio(const pw_real *du, pw_off stride)
{
  pw_real xx = du[0], xy = du[stride], yx = du[2 * stride], yy = du[3 * stride];
  return ((1.0 + xx) * (1.0 + yy) - xy * yx) * (1.0 + du[4 * stride]);
}

static void gather_range(const pw_update_pass *pass, pw_idx block, int b, pw_idx first, pw_idx n)
{
  pw_sim *sim = pass->sim;
  pw_fbar_cells *c = sim->fbar;
  const pw_points *p = &sim->points;
  pw_real *sum = cell_sums(sim, b);
  pw_gradients grad;
  find_cells(sim, block, first, n);
  sim->kernels->g2p_gradient(&sim->transfer, pw_nodes_field(&sim->nodes, sim->body[b].field),
                             pass->slot, pw_rates_dt(sim, block), pass->move, first, first + n,
                             &grad);
  for (int k = 0; k < 5; k++) {
    memcpy(c->du + (pw_off)k * p->ld + first, grad.du[k], (size_t)n * sizeof(pw_real));
  }
  for (pw_idx i = 0; i < n; i++) {
    const pw_idx e = c->element[first + i];
    if (e >= 0) {
      sum[2 * (pw_off)e] += p->vol[first + i];
      sum[2 * (pw_off)e + 1] += p->vol[first + i] * volume_ratio(&grad.du[0][i], PW_CHUNK);
    }
  }
}

void pw_block_fbar_gather(void *ctx, pw_idx block)
{
  const pw_update_pass *pass = ctx;
  pw_sim *sim = pass->sim;
  for (int b = 0; b < sim->nbody; b++) {
    const pw_idx *range = sim->blocks.point_start + (pw_off)block * sim->nbody + b;
    for (pw_idx first = range[0]; sim->fbar->body[b] && first < range[1]; first += PW_CHUNK) {
      gather_range(pass, block, b, first,
                   range[1] - first < PW_CHUNK ? range[1] - first : PW_CHUNK);
    }
  }
}

void pw_fbar_gradients(const pw_fbar_cells *c, pw_idx ld, pw_idx first, pw_idx n,
                       pw_gradients *grad)
{
  for (int k = 0; k < 5; k++) {
    memcpy(grad->du[k], c->du + (pw_off)k * ld + first, (size_t)n * sizeof(pw_real));
  }
}

/* Cube root; for ratios of one step, which are near 1, by its series, whose next term is below
 * 1e-16. */
static pw_real root3(pw_real ratio)
{
  const pw_real x = ratio - 1.0;
  if (!(fabs(x) < 1e-3)) {
    return cbrt(ratio);
  }
  return 1.0 + x * (1.0 / 3.0 + x * (-1.0 / 9.0 + x * (5.0 / 81.0 - x * (10.0 / 243.0))));
}

void pw_fbar_apply(pw_sim *sim, int body, pw_idx first, pw_idx n, pw_real *dstrain, pw_real *dvol)
{
  const pw_fbar_cells *c = sim->fbar;
  const bool axi = sim->scene.geometry == PW_AXI;
  const pw_real *sum = cell_sums(sim, body);
  pw_real *total = sim->points.volume_ratio + first, *vol = sim->points.vol + first;
  for (pw_idx i = 0; i < n; i++) {
    const pw_idx e = c->element[first + i];
    pw_real mean = e >= 0 ? sum[2 * (pw_off)e + 1] / sum[2 * (pw_off)e] : dvol[i];
    pw_real ratio = mean / dvol[i], scale = axi ? root3(ratio) : sqrt(ratio);
    dstrain[i] = scale * (1.0 + dstrain[i]) - 1.0;
    dstrain[PW_CHUNK + i] = scale * (1.0 + dstrain[PW_CHUNK + i]) - 1.0;
    dstrain[2 * PW_CHUNK + i] =
        axi ? scale * (1.0 + dstrain[2 * PW_CHUNK + i]) - 1.0 : dstrain[2 * PW_CHUNK + i];
    dstrain[3 * PW_CHUNK + i] *= scale;
    dvol[i] = mean;
    vol[i] *= ratio;
    total[i] *= mean;
  }
}
