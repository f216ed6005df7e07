/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/hypoplastic.h"

#include "kernels/hypoplastic_rates.h"

/** Points taken at once: a multiple of any vector length, few enough to stay in cache. */
enum { LANES = 16 };

typedef struct lanes {
  pw_real t[6][LANES];
} lanes;

/** A group of points; lanes past the last point repeat it and are not written back. */
typedef struct group {
  lanes stress, delta, de; /* sigma* and delta, rotated */
  pw_real size[LANES], void_ratio[LANES], dvol[LANES];
  pw_real able[LANES]; /* 1 where one substep may do */
  lanes k1, k2, k3, d1, d2, d3, at, at_delta;
  pw_real void_at[LANES], modulus[LANES];
} group;

PW_INLINE pw_t6 get(const lanes *a, int i)
{
  return (pw_t6){a->t[0][i], a->t[1][i], a->t[2][i], a->t[3][i], a->t[4][i], a->t[5][i]};
}

PW_INLINE void put(lanes *a, int i, pw_t6 v)
{
  a->t[0][i] = v.xx;
  a->t[1][i] = v.yy;
  a->t[2][i] = v.zz;
  a->t[3][i] = v.xy;
  a->t[4][i] = v.yz;
  a->t[5][i] = v.zx;
}

static void copy_rows(const pw_real *from, size_t ld, int rows, pw_idx first, int n, pw_real *to)
{
  for (int c = 0; c < rows; c++) {
    const pw_real *row = from + (size_t)c * ld + (size_t)first;
    for (int i = 0; i < n; i++) {
      to[c * LANES + i] = row[i];
    }
    for (int i = n; i < LANES; i++) {
      to[c * LANES + i] = row[n - 1];
    }
  }
}

/** Read @p n points from @p first on and rotate them. */
static void gather(const pw_hypo *h, const pw_stress_args *a, bool plane, pw_idx first, int n,
                   group *g)
{
  size_t ld = (size_t)a->ld, ldi = (size_t)a->ldi;
  pw_real spin[3][LANES], substep[LANES];
  copy_rows(a->stress, ld, 6, first, n, g->at.t[0]);
  copy_rows(a->dstrain, ldi, 6, first, n, g->de.t[0]);
  copy_rows(a->spin, ldi, 3, first, n, spin[0]);
  copy_rows(a->dvol, ldi, 1, first, n, g->dvol);
  copy_rows(a->state, ld, 1, first, n, g->void_ratio);
  if (h->intergranular) {
    copy_rows(a->state + PW_HYPO_STATE_DELTA * ld, ld, 6, first, n, g->at_delta.t[0]);
    copy_rows(a->state + PW_HYPO_STATE_SUBSTEP * ld, ld, 1, first, n, substep);
  } else {
    g->at_delta = (lanes){0};
    for (int i = 0; i < LANES; i++) {
      substep[i] = 1.0;
    }
  }
  const pw_real p_t = h->p_t;
  if (plane) {
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
      put(&g->stress, i, pw_t6_shift(pw_t6_rotate_plane(spin[0][i], get(&g->at, i)), -p_t));
      put(&g->delta, i, pw_t6_rotate_plane(spin[0][i], get(&g->at_delta, i)));
    }
  } else {
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
      pw_rot r = pw_rot_hughes_winget(spin[0][i], spin[1][i], spin[2][i]);
      put(&g->stress, i, pw_t6_shift(pw_t6_rotate(r, get(&g->at, i)), -p_t));
      put(&g->delta, i, pw_t6_rotate(r, get(&g->at_delta, i)));
    }
  }
#pragma omp simd
  for (int i = 0; i < LANES; i++) {
    pw_t6 de = get(&g->de, i);
    pw_real size2 = pw_t6_dot(de, de), turn = -pw_t6_dot(get(&g->delta, i), de);
    pw_real straight = turn <= 1e-6 * size2 ? 1.0 : (turn >= (1.0 - 1e-6) * size2 ? 1.0 : 0.0);
    pw_real volume = (1.0 + g->void_ratio[i]) * g->dvol[i] > 1.0 + 1e-9 ? 1.0 : 0.0;
    g->size[i] = sqrt(size2);
    g->able[i] = substep[i] >= 1.0 ? straight * volume : 0.0;
  }
}

/** Arrays of one evaluation, each of LANES points. */
typedef struct stage_in {
  const lanes *stress, *delta, *de;
  const pw_real *void_ratio, *size;
} stage_in;

/** Rates of a group; @p modulus is NULL but at the last stage. */
PW_INLINE void evaluate(const pw_hypo *hp, stage_in in, lanes *restrict k, lanes *restrict d,
                        pw_real *restrict able, pw_real *restrict modulus, bool intergranular,
                        bool last)
{
  const pw_hypo h = *hp;
  const lanes *restrict stress = in.stress, *restrict delta = in.delta, *restrict de = in.de;
  const pw_real *restrict void_ratio = in.void_ratio, *restrict size = in.size;
#pragma omp simd
  for (int i = 0; i < LANES; i++) {
    pw_hypo_slope s = pw_hypo_slope_of(&h, get(stress, i), get(delta, i), void_ratio[i], get(de, i),
                                       size[i], intergranular);
    put(k, i, s.stress);
    put(d, i, s.delta);
    able[i] *= s.inside;
    if (last) {
      modulus[i] = pw_hypo_modulus(&h, s);
    }
  }
}

/* One instance for each pair of literals, so that the loops hold no branches. */
static void inner_with(const pw_hypo *h, stage_in in, lanes *k, lanes *d, pw_real *able)
{
  evaluate(h, in, k, d, able, NULL, true, false);
}

static void inner_without(const pw_hypo *h, stage_in in, lanes *k, lanes *d, pw_real *able)
{
  evaluate(h, in, k, d, able, NULL, false, false);
}

static void last_with(const pw_hypo *h, stage_in in, lanes *k, lanes *d, pw_real *able,
                      pw_real *modulus)
{
  evaluate(h, in, k, d, able, modulus, true, true);
}

static void last_without(const pw_hypo *h, stage_in in, lanes *k, lanes *d, pw_real *able,
                         pw_real *modulus)
{
  evaluate(h, in, k, d, able, modulus, false, true);
}

/** The three stages of a substep that is the whole increment. */
static void run_stages(const pw_hypo *h, group *g)
{
  const bool with = h->intergranular;
  stage_in at = {&g->stress, &g->delta, &g->de, g->void_ratio, g->size};
  (with ? inner_with : inner_without)(h, at, &g->k1, &g->d1, g->able);
  at = (stage_in){&g->at, &g->at_delta, &g->de, g->void_at, g->size};
#pragma omp simd
  for (int i = 0; i < LANES; i++) {
    put(&g->at, i, pw_t6_axpy(get(&g->stress, i), 0.5, get(&g->k1, i)));
    put(&g->at_delta, i, pw_t6_axpy(get(&g->delta, i), 0.5, get(&g->d1, i)));
    g->void_at[i] = (1.0 + g->void_ratio[i]) * sqrt(g->dvol[i]) - 1.0;
  }
  (with ? inner_with : inner_without)(h, at, &g->k2, &g->d2, g->able);
#pragma omp simd
  for (int i = 0; i < LANES; i++) {
    pw_t6 end = pw_t6_axpy(get(&g->stress, i), -1.0, get(&g->k1, i));
    pw_t6 end_delta = pw_t6_axpy(get(&g->delta, i), -1.0, get(&g->d1, i));
    put(&g->at, i, pw_t6_axpy(end, 2.0, get(&g->k2, i)));
    put(&g->at_delta, i, pw_t6_axpy(end_delta, 2.0, get(&g->d2, i)));
    g->void_at[i] = (1.0 + g->void_ratio[i]) * g->dvol[i] - 1.0;
  }
  (with ? last_with : last_without)(h, at, &g->k3, &g->d3, g->able, g->modulus);
}

/** Combine the stages into g->at, g->at_delta and mark the lanes whose result stands. */
static void combine(const pw_hypo *hp, group *g)
{
  const pw_hypo h = *hp;
  const pw_real sixth = 1.0 / 6.0, per_r = h.intergranular ? 1.0 / h.r : 0.0;
#pragma omp simd
  for (int i = 0; i < LANES; i++) {
    pw_t6 k1 = get(&g->k1, i), k2 = get(&g->k2, i), k3 = get(&g->k3, i);
    pw_t6 sum = pw_t6_axpy(pw_t6_axpy(k1, 4.0, k2), 1.0, k3);
    pw_t6 err = pw_t6_axpy(pw_t6_axpy(k1, -2.0, k2), 1.0, k3);
    pw_t6 stress = pw_t6_axpy(get(&g->stress, i), sixth, sum);
    pw_real on_stress = pw_t6_norm(err) / (pw_t6_norm(stress) + 1000.0);
    k1 = get(&g->d1, i);
    k2 = get(&g->d2, i);
    k3 = get(&g->d3, i);
    sum = pw_t6_axpy(pw_t6_axpy(k1, 4.0, k2), 1.0, k3);
    err = pw_t6_axpy(pw_t6_axpy(k1, -2.0, k2), 1.0, k3);
    pw_t6 delta = pw_t6_axpy(get(&g->delta, i), sixth, sum);
    pw_real rho2 = pw_t6_dot(delta, delta) * h.inv_r2;
    pw_real clip = rho2 > 1.0 ? 1.0 / sqrt(rho2) : 1.0;
    pw_real stays = g->able[i] * pw_hypo_inside_stress(&h, stress);
    stays = sixth * on_stress <= h.tolerance ? stays : 0.0;
    g->able[i] = sixth * pw_t6_norm(err) * per_r <= h.tolerance ? stays : 0.0;
    put(&g->at, i, pw_t6_shift(stress, h.p_t));
    put(&g->at_delta, i, pw_t6_scale(clip, delta));
  }
}

/** Write the lanes that stand. */
static void scatter(const pw_hypo *h, const pw_stress_args *a, const group *g, pw_idx first, int n,
                    pw_real *done)
{
  size_t ld = (size_t)a->ld;
  const pw_real *able = g->able;
  for (int c = 0; c < 6; c++) {
    pw_real *row = a->stress + (size_t)c * ld + (size_t)first;
    for (int i = 0; i < n; i++) {
      row[i] = able[i] > 0.0 ? g->at.t[c][i] : row[i];
    }
  }
  for (int c = 0; h->intergranular && c < 6; c++) {
    pw_real *row = a->state + (size_t)(PW_HYPO_STATE_DELTA + c) * ld + (size_t)first;
    for (int i = 0; i < n; i++) {
      row[i] = able[i] > 0.0 ? g->at_delta.t[c][i] : row[i];
    }
  }
  pw_real *row = a->state + first;
  int count = 0;
  for (int i = 0; i < n; i++) {
    row[i] = able[i] > 0.0 ? g->void_at[i] : row[i];
    a->wave_speed[first + i] = sqrt(g->modulus[i] / a->density[first + i]);
    done[first + i] = able[i];
    count += able[i] > 0.0 ? 1 : 0;
  }
  if (a->counts) {
    a->counts->substeps += count;
    a->counts->rhs += 3 * count;
  }
}

void pw_hypo_advance_smooth(const pw_hypo *h, bool plane, const pw_stress_args *a, pw_real *done)
{
  group g;
  for (pw_idx first = 0; first < a->n; first += LANES) {
    int n = a->n - first < LANES ? (int)(a->n - first) : LANES;
    gather(h, a, plane, first, n, &g);
    run_stages(h, &g);
    combine(h, &g);
    scatter(h, a, &g, first, n, done);
  }
}
