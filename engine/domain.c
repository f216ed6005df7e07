/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/domain.h"

#include <math.h>
#include <string.h>

#include "engine/domain_sites.h"

/* Shorten the half diagonals r1 + r2 and r1 - r2 to at most limit; true when one was longer. */
static bool limit_diagonals(pw_real r[4], pw_real limit)
{
  pw_real ax = r[0] + r[2], ay = r[1] + r[3], bx = r[0] - r[2], by = r[1] - r[3];
  pw_real a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, l2 = limit * limit;
  if (a2 <= l2 && b2 <= l2) {
    return false;
  }
  pw_real sa = a2 > l2 ? limit / sqrt(a2) : 1.0, sb = b2 > l2 ? limit / sqrt(b2) : 1.0;
  r[0] = 0.5 * (sa * ax + sb * bx);
  r[1] = 0.5 * (sa * ay + sb * by);
  r[2] = 0.5 * (sa * ax - sb * bx);
  r[3] = 0.5 * (sa * ay - sb * by);
  return true;
}

/* The same with lengths measured in the cells at the domain's centre; limit in cells. */
static bool limit_in_cells(pw_real r[4], const pw_real *cell, pw_real limit)
{
  const pw_real inv[2] = {1.0 / cell[0], 1.0 / cell[1]};
  pw_real s[4] = {r[0] * inv[0], r[1] * inv[1], r[2] * inv[0], r[3] * inv[1]};
  if (!limit_diagonals(s, limit)) {
    return false;
  }
  for (int k = 0; k < 4; k++) {
    r[k] = s[k] * cell[k % 2];
  }
  return true;
}

/* Limits domain i; @p limit becomes the largest half diagonal of a square there, in metres. */
static bool limit_domain(const pw_sim *sim, pw_idx i, pw_real r[4], pw_real *limit)
{
  const pw_points *p = &sim->points;
  *limit = sim->limit[p->id[i]];
  if (!sim->mesh.graded) {
    return limit_diagonals(r, *limit);
  }
  pw_real x[2] = {p->x[i], p->x[p->ld + i]}, cell[2], cells = *limit;
  pw_mesh_size_at(&sim->mesh, x, cell);
  *limit = cells * pw_min(cell[0], cell[1]);
  return limit_in_cells(r, cell, cells);
}

/* Replace a degenerate domain by a square and its initial half-sides by F^-1 of it. */
static void rebuild(pw_points *p, pw_idx i, pw_real area, pw_real limit, pw_real r[4])
{
  const pw_idx ld = p->ld;
  pw_real h = pw_min(0.5 * sqrt(area), limit * sqrt(0.5));
  pw_real f0 = p->def_grad[i], f1 = p->def_grad[ld + i];
  pw_real f2 = p->def_grad[2 * ld + i], f3 = p->def_grad[3 * ld + i];
  pw_real scale = h / (f0 * f3 - f1 * f2);
  r[0] = r[3] = h;
  r[1] = r[2] = 0.0;
  p->half0[i] = scale * f3;
  p->half0[ld + i] = -scale * f2;
  p->half0[2 * ld + i] = -scale * f1;
  p->half0[3 * ld + i] = scale * f0;
}

/*
 * Keep the ratio of the principal half-sides of a domain: above @p aspect the longer one is
 * shortened and the shorter one lengthened until the area is @p area. True when that was needed.
 */
static bool limit_aspect(pw_real r[4], pw_real area, pw_real aspect)
{
  const pw_real det = r[0] * r[3] - r[1] * r[2];
  const pw_real xx = r[0] * r[0] + r[2] * r[2], yy = r[1] * r[1] + r[3] * r[3];
  const pw_real xy = r[0] * r[1] + r[2] * r[3];
  if (!(det > 0.0) || xx + yy <= det * (aspect + 1.0 / aspect) * (1.0 + 1e-12)) {
    return false;
  }
  const pw_real mean = 0.5 * (xx + yy), dev = 0.5 * (xx - yy), root = sqrt(dev * dev + xy * xy);
  const pw_real big = mean + root, small = det * det / big; /* squares of the half-sides */
  const pw_real longer = sqrt(0.25 * area * aspect / big);
  const pw_real shorter = sqrt(0.25 * area / aspect / small);
  /* S = shorter I + (longer - shorter) u u^T, u the direction of the longer half-side. */
  const pw_real c2 = 0.5 * (1.0 + dev / root), s2 = 0.5 * (1.0 - dev / root), cs = 0.5 * xy / root;
  const pw_real sxx = shorter + (longer - shorter) * c2, syy = shorter + (longer - shorter) * s2;
  const pw_real sxy = (longer - shorter) * cs;
  for (int k = 0; k < 4; k += 2) {
    pw_real x = r[k], y = r[k + 1];
    r[k] = sxx * x + sxy * y;
    r[k + 1] = sxy * x + syy * y;
  }
  return true;
}

/* Whether the aspect of a point's domain is measured in cells: where points were divided by cells. Those
 * of one size are square whatever the cells, a pile's too, that stands in the tall ones above the soil. */
static bool aspect_in_cells(const pw_sim *sim, pw_idx i)
{
  return sim->mesh.graded && sim->scene.body[sim->points.body[i]].points_per_cell > 0;
}

/* The same with lengths measured in the cell that holds the point; the initial half-sides follow
 * (F^-1 r). A domain that deforms on is reshaped a little in every step, so it never jumps. */
static bool reshape(pw_sim *sim, pw_idx i, pw_real area, pw_real r[4])
{
  pw_points *p = &sim->points;
  const pw_idx ld = p->ld;
  pw_real x[2] = {p->x[i], p->x[ld + i]}, cell[2] = {1.0, 1.0};
  if (aspect_in_cells(sim, i)) {
    pw_mesh_size_at(&sim->mesh, x, cell);
  }
  pw_real s[4] = {r[0] / cell[0], r[1] / cell[1], r[2] / cell[0], r[3] / cell[1]};
  if (!limit_aspect(s, area / (cell[0] * cell[1]), sim->scene.method.domain_aspect_max)) {
    return false;
  }
  pw_real f[4];
  for (int k = 0; k < 4; k++) {
    f[k] = p->def_grad[k * ld + i];
    r[k] = s[k] * cell[k % 2];
  }
  const pw_real inv = 1.0 / (f[0] * f[3] - f[1] * f[2]);
  for (int k = 0; k < 2; k++) {
    p->half0[2 * k * ld + i] = inv * (f[3] * r[2 * k] - f[1] * r[2 * k + 1]);
    p->half0[(2 * k + 1) * ld + i] = inv * (f[0] * r[2 * k + 1] - f[2] * r[2 * k]);
  }
  return true;
}

/*
 * A domain that is held by the master and changes its shape keeps its place at the master: the
 * centre takes back the mean jump of the sites that are held. A domain that grew into the master
 * instead would be pushed out with the soil around it, and the contact would do work that no load
 * supplies.
 */
static void hold_place(pw_points *p, pw_idx i, bool axi)
{
  const pw_idx ld = p->ld;
  pw_real *j = p->contact_jump + i, shift[2] = {0.0, 0.0}, held = 0.0;
  for (int site = 0; site < PW_SITES; site++) {
    if (p->contact_arc[site * ld + i] >= 0.0) {
      shift[0] -= pw_site_s[site] * j[0] + pw_site_t[site] * j[2 * ld];
      shift[1] -= pw_site_s[site] * j[ld] + pw_site_t[site] * j[3 * ld];
      held += 1.0;
    }
  }
  if (held > 0.0) {
    const pw_real most = axi ? 0.1 * p->x[i] : PW_HUGE;
    j[4 * ld] = pw_max(-most, pw_min(shift[0] / held, most));
    j[5 * ld] = shift[1] / held;
    p->x[i] += j[4 * ld];
    p->x[ld + i] += j[5 * ld];
  }
}

/* Domains of a chunk on their way. */
typedef struct domains {
  pw_real r[4][PW_CHUNK], inv[2][PW_CHUNK]; /* half-sides, m; 1 / cell where the point is, 1/m */
  pw_real limit[PW_CHUNK];                  /* of half diagonals, in cells */
  pw_real loose[PW_CHUNK];                  /* 1 where a limit may be exceeded */
} domains;

/* Where rows are in pairs cells are twice as high. */
static void measure_in_pairs(const pw_sim *sim, pw_idx first, pw_idx n, domains *d)
{
  const pw_mesh *m = &sim->mesh;
  if (m->pair_column == m->cells[0]) {
    return;
  }
  const pw_real *x = sim->points.x + first, *y = x + sim->points.ld;
  const pw_real left = m->axis[0].node[m->pair_column];
  const pw_real low = m->axis[1].node[m->pair_row[0]], high = m->axis[1].node[m->pair_row[1]];
  for (pw_idx i = 0; i < n; i++) {
    d->inv[1][i] *= x[i] >= left && y[i] >= low && y[i] < high ? 0.5 : 1.0;
  }
}

/* Half-sides that follow the deformation, and what their limits are measured with. */
static void follow(const pw_sim *sim, pw_idx first, pw_idx n, domains *d)
{
  const pw_points *p = &sim->points;
  const pw_idx ld = p->ld, *id = p->id + first;
  const pw_real *f = p->def_grad + first, *r0 = p->half0 + first, *limit = sim->limit;
  for (int k = 0; k < 4; k += 2) {
    const pw_real *x0 = r0 + k * ld, *y0 = x0 + ld;
#pragma omp simd
    for (pw_idx i = 0; i < n; i++) {
      d->r[k][i] = f[i] * x0[i] + f[ld + i] * y0[i];
      d->r[k + 1][i] = f[2 * ld + i] * x0[i] + f[3 * ld + i] * y0[i];
    }
  }
  for (pw_idx i = 0; i < n; i++) {
    d->limit[i] = limit[id[i]];
  }
  for (int a = 0; a < 2; a++) {
    const pw_grid_axis axis = sim->mesh.axis[a];
    const pw_real *x = p->x + a * ld + first;
    for (pw_idx i = 0; i < n; i++) {
      d->inv[a][i] = sim->mesh.graded
                         ? axis.inv[pw_grid_axis_cell(&axis, pw_grid_axis_clamp(&axis, x[i]))]
                         : 1.0;
    }
  }
  measure_in_pairs(sim, first, n, d);
}

/* Find the domains that are not, beyond round-off, within all limits: most are, and need no
 * divisions. How many.
 * @param spread aspect + 1 / aspect of the most slender domain; 0: no such limit
 * @param by_cells how aspects are measured */
static pw_real find_loose(pw_idx n, pw_real spread, bool by_cells, domains *d)
{
  const pw_real within = 1.0 - 1e-9, any = spread > 0.0 ? 0.0 : 1.0;
  pw_real count = 0.0;
#pragma omp simd reduction(+ : count)
  for (pw_idx i = 0; i < n; i++) {
    const pw_real inv0 = d->inv[0][i], inv1 = d->inv[1][i], limit = d->limit[i];
    const pw_real s0 = d->r[0][i] * inv0, s1 = d->r[1][i] * inv1;
    const pw_real s2 = d->r[2][i] * inv0, s3 = d->r[3][i] * inv1;
    const pw_real xx = s0 * s0 + s2 * s2, yy = s1 * s1 + s3 * s3;
    const pw_real across = 2.0 * (s0 * s2 + s1 * s3), square = xx + yy;
    const pw_real a0 = by_cells ? inv0 : 1.0, a1 = by_cells ? inv1 : 1.0;
    const pw_real r0 = d->r[0][i] * a0, r1 = d->r[1][i] * a1;
    const pw_real r2 = d->r[2][i] * a0, r3 = d->r[3][i] * a1;
    const pw_real sides = r0 * r0 + r1 * r1 + r2 * r2 + r3 * r3, area = r0 * r3 - r1 * r2;
    const pw_real round = sides <= area * spread * within ? 1.0 : any;
    /* the longer diagonal */
    const pw_real close = square + fabs(across) <= limit * limit * within ? round : 0.0;
    d->loose[i] = 1.0 - close;
    count += d->loose[i];
  }
  return count;
}

/* Put domain i, the k-th of its chunk, within its limits; it stays loose only if it was changed. */
static void tighten(pw_sim *sim, pw_idx i, pw_idx k, domains *d, pw_block_sums *sums)
{
  pw_points *p = &sim->points;
  const pw_real area = sim->scene.geometry == PW_AXI ? p->vol[i] / p->x[i] : p->vol[i];
  pw_real r[4] = {d->r[0][k], d->r[1][k], d->r[2][k], d->r[3][k]}, limit;
  bool changed = sim->scene.method.domain_aspect_max > 0.0 && reshape(sim, i, area, r);
  sums->reshaped += changed ? 1 : 0;
  if (limit_domain(sim, i, r, &limit)) {
    changed = true;
    sums->limited++;
    if (4.0 * (r[0] * r[3] - r[1] * r[2]) < PW_DOMAIN_DEGENERATE * area) {
      rebuild(p, i, area, limit, r);
      sums->rebuilt++;
    }
  }
  d->loose[k] = changed ? 1.0 : 0.0;
  for (int c = 0; c < 4; c++) {
    d->r[c][k] = r[c];
  }
}

/* What the half-sides have changed beyond their deformation, r - (I + grad du) r_before. */
static void note_jumps(pw_points *p, pw_idx first, pw_idx n, const pw_gradients *grad,
                       const domains *d)
{
  const pw_idx ld = p->ld;
  for (int k = 0; k < 4; k += 2) {
    const pw_real *half = p->half + k * ld + first;
    pw_real *jump = p->contact_jump + k * ld + first;
#pragma omp simd
    for (pw_idx i = 0; i < n; i++) {
      const pw_real x = half[i], y = half[ld + i];
      jump[i] = d->r[k][i] - (x + grad->du[0][i] * x + grad->du[1][i] * y);
      jump[ld + i] = d->r[k + 1][i] - (y + grad->du[2][i] * x + grad->du[3][i] * y);
    }
  }
  memset(p->contact_jump + 4 * ld + first, 0, (size_t)n * sizeof *p->contact_jump);
  memset(p->contact_jump + 5 * ld + first, 0, (size_t)n * sizeof *p->contact_jump);
}

static void convect(pw_sim *sim, const pw_gradients *grad, pw_idx first, pw_idx n,
                    pw_block_sums *sums)
{
  pw_points *p = &sim->points;
  const pw_idx ld = p->ld;
  const pw_real aspect = sim->scene.method.domain_aspect_max;
  domains d;
  follow(sim, first, n, &d);
  const bool any = find_loose(n, aspect > 0.0 ? aspect + 1.0 / aspect : 0.0,
                              aspect_in_cells(sim, first), &d) > 0.0;
  for (pw_idx k = 0; any && k < n; k++) {
    if (d.loose[k] > 0.0) {
      tighten(sim, first + k, k, &d, sums);
    }
  }
  if (p->contact_jump) {
    note_jumps(p, first, n, grad, &d);
    for (pw_idx k = 0; any && k < n; k++) {
      if (d.loose[k] > 0.0) {
        hold_place(p, first + k, sim->scene.geometry == PW_AXI);
      }
    }
  }
  for (int c = 0; c < 4; c++) {
    memcpy(p->half + c * ld + first, d.r[c], (size_t)n * sizeof *p->half);
  }
}

void pw_domain_convect(pw_sim *sim, const pw_gradients *grad, pw_idx first, pw_idx n,
                       pw_block_sums *sums)
{
  const pw_idx last = first + n;
  for (; first < last; first += PW_CHUNK) { /* one chunk where there are gradients */
    convect(sim, grad, first, last - first < PW_CHUNK ? last - first : PW_CHUNK, sums);
  }
}

/* Cells from cell k of an axis outwards, one way, that are `length` long together. */
static pw_idx cells_within(const pw_grid_axis *a, pw_idx k, int way, pw_real length)
{
  pw_idx n = 0;
  pw_real sum = 0.0;
  for (k += way; k >= 0 && k < a->cells && sum < length * (1.0 - 1e-9); k += way) {
    sum += a->size[k];
    n++;
  }
  return n;
}

pw_idx pw_domain_reach(const pw_mesh *mesh, pw_real limit)
{
  pw_idx reach = (pw_idx)ceil(limit - 1e-9);
  for (int d = 0; d < 2 && mesh->graded; d++) {
    const pw_grid_axis *a = &mesh->axis[d];
    for (pw_idx k = 0; k < a->cells; k++) {
      pw_real below = a->size[k > 0 ? k - 1 : k], above = a->size[k + 1 < a->cells ? k + 1 : k];
      pw_real length = limit * pw_max(a->size[k], pw_max(below, above));
      pw_idx down = cells_within(a, k, -1, length), up = cells_within(a, k, 1, length);
      reach = down > reach ? down : reach;
      reach = up > reach ? up : reach;
    }
  }
  if (mesh->pair_column < mesh->cells[0]) {
    /* Counted from the lower row of the pair: the upper one, and the limit in rows. */
    const pw_idx rows = 1 + (pw_idx)ceil(2.0 * limit - 1e-9);
    reach = rows > reach ? rows : reach;
  }
  return reach < 2 ? 2 : reach;
}
