/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/hypoplastic.h"

#include "kernels/hypoplastic_lanes.h"

enum { LANES = PW_HYPO_LANES };

typedef pw_real lane_tensor[6][LANES];

/** A group of points; lanes past the last point repeat it and are not written back. */
typedef struct group {
  lane_tensor stress, delta, de; /* sigma* and delta, rotated */
  pw_real size[LANES], void_ratio[LANES], dvol[LANES], step[LANES];
  pw_real able[LANES]; /* 1 where one substep does */
  lane_tensor k[3], d[3], at, at_delta;
  pw_real void_mid[LANES], void_end[LANES], modulus[LANES], error[LANES];
} group;

PW_HYPO_STAGES(stages, LANES);

static void copy_rows(const pw_real *from, size_t ld, int rows, pw_idx first, int n, pw_real *to)
{
  for (int c = 0; c < rows; c++) {
    const pw_real *row = from + (size_t)c * ld + (size_t)first;
    if (n == LANES) {
      memcpy(to + c * LANES, row, LANES * sizeof *to);
      continue;
    }
    for (int i = 0; i < LANES; i++) {
      to[c * LANES + i] = row[i < n ? i : n - 1];
    }
  }
}

/** Replace rows by those of @p from where @p stands is positive. */
PW_INLINE void merge_rows(pw_real (*from)[LANES], const pw_real *stands, int n, size_t ld,
                          pw_real *to)
{
  for (int c = 0; c < 6; c++) {
    pw_real *row = to + (size_t)c * ld;
#pragma omp simd
    for (int i = 0; i < n; i++) {
      row[i] = stands[i] > 0.0 ? from[c][i] : row[i];
    }
  }
}

static void rotate(const pw_hypo *h, pw_real spin[3][LANES], bool plane, group *g)
{
  const pw_real p_t = h->p_t;
  if (plane) {
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
      pw_t6 stress = pw_t6_rotate_plane(spin[0][i], pw_t6_load(&g->at[0][i], LANES));
      pw_t6 delta = pw_t6_rotate_plane(spin[0][i], pw_t6_load(&g->at_delta[0][i], LANES));
      pw_t6_store(pw_t6_shift(stress, -p_t), &g->stress[0][i], LANES);
      pw_t6_store(delta, &g->delta[0][i], LANES);
    }
  } else {
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
      pw_rot r = pw_rot_hughes_winget(spin[0][i], spin[1][i], spin[2][i]);
      pw_t6 stress = pw_t6_rotate(r, pw_t6_load(&g->at[0][i], LANES));
      pw_t6 delta = pw_t6_rotate(r, pw_t6_load(&g->at_delta[0][i], LANES));
      pw_t6_store(pw_t6_shift(stress, -p_t), &g->stress[0][i], LANES);
      pw_t6_store(delta, &g->delta[0][i], LANES);
    }
  }
}

/** Read @p n points from @p first on and rotate them; how many lanes one substep may do for. */
static pw_real gather(const pw_hypo *h, const pw_stress_args *a, bool plane, pw_idx first, int n,
                      group *g)
{
  size_t ld = (size_t)a->ld, ldi = (size_t)a->ldi;
  pw_real spin[3][LANES], substep[LANES];
  copy_rows(a->stress, ld, 6, first, n, g->at[0]);
  copy_rows(a->dstrain, ldi, 6, first, n, g->de[0]);
  copy_rows(a->spin, ldi, 3, first, n, spin[0]);
  copy_rows(a->dvol, ldi, 1, first, n, g->dvol);
  copy_rows(a->state, ld, 1, first, n, g->void_ratio);
  for (int i = 0; i < LANES; i++) {
    substep[i] = g->step[i] = 1.0;
  }
  if (h->intergranular) {
    copy_rows(a->state + PW_HYPO_STATE_DELTA * ld, ld, 6, first, n, g->at_delta[0]);
    copy_rows(a->state + PW_HYPO_STATE_SUBSTEP * ld, ld, 1, first, n, substep);
  } else {
    memset(g->at_delta, 0, sizeof g->at_delta);
  }
  rotate(h, spin, plane, g);
  const pw_real least = -3.0 * h->p_min * (1.0 + 1e-9);
  pw_real count = 0.0;
#pragma omp simd reduction(+ : count)
  for (int i = 0; i < LANES; i++) {
    pw_t6 de = pw_t6_load(&g->de[0][i], LANES);
    pw_real size2 = pw_t6_dot(de, de), turn = -pw_t6_dot(pw_t6_load(&g->delta[0][i], LANES), de);
    /* delta:D changes sign at the time turn / size2 */
    pw_real straight = turn <= 1e-6 * size2 ? 1.0 : (turn >= (1.0 - 1e-6) * size2 ? 1.0 : 0.0);
    pw_real trace = g->stress[0][i] + g->stress[1][i] + g->stress[2][i];
    pw_real specific = 1.0 + g->void_ratio[i];
    g->size[i] = sqrt(size2);
    g->void_mid[i] = specific * sqrt(g->dvol[i]) - 1.0;
    g->void_end[i] = specific * g->dvol[i] - 1.0;
    pw_real pressed = trace < least ? straight : 0.0; /* not stress-free */
    pw_real voids = g->void_end[i] > 1e-9 ? pressed : 0.0;
    g->able[i] = substep[i] >= 1.0 ? voids : 0.0;
    count += g->able[i];
  }
  return count;
}

/** Write the lanes that stand; how many. */
PW_INLINE int scatter(const pw_hypo *h, const pw_stress_args *a, group *g, pw_idx first, int n,
                      pw_real *done)
{
  const size_t ld = (size_t)a->ld;
  const pw_real tolerance = h->tolerance, p_t = h->p_t;
  pw_real count = 0.0;
#pragma omp simd reduction(+ : count)
  for (int i = 0; i < n; i++) {
    pw_real stands = g->error[i] <= tolerance ? g->able[i] : 0.0;
    done[i] = stands;
    count += stands;
    g->at[0][i] += p_t;
    g->at[1][i] += p_t;
    g->at[2][i] += p_t;
    pw_real void_ratio = a->state[first + i];
    a->state[first + i] = stands > 0.0 ? g->void_end[i] : void_ratio;
    a->wave_speed[first + i] = sqrt(g->modulus[i] / a->density[first + i]);
  }
  merge_rows(g->at, done, n, ld, a->stress + first);
  if (h->intergranular) {
    merge_rows(g->at_delta, done, n, ld, a->state + PW_HYPO_STATE_DELTA * ld + first);
  }
  return (int)count;
}

void pw_hypo_advance_smooth(const pw_hypo *h, bool plane, const pw_stress_args *a, pw_real *done)
{
  pw_hypo_smooth_with(h, stages[h->form], plane, a, done);
}

void pw_hypo_smooth_with(const pw_hypo *h, const pw_hypo_stage_fn rates[2], bool plane,
                         const pw_stress_args *a, pw_real *done)
{
  group g;
  const pw_hypo_substep s = {g.stress[0],
                             g.delta[0],
                             g.de[0],
                             g.size,
                             g.step,
                             {g.void_ratio, g.void_mid, g.void_end},
                             {g.k[0][0], g.k[1][0], g.k[2][0]},
                             {g.d[0][0], g.d[1][0], g.d[2][0]},
                             g.at[0],
                             g.at_delta[0],
                             g.able,
                             g.modulus,
                             g.error};
  for (pw_idx first = 0; first < a->n; first += LANES) {
    int n = a->n - first < LANES ? (int)(a->n - first) : LANES;
    if (gather(h, a, plane, first, n, &g) == 0.0) {
      memset(done + first, 0, (size_t)n * sizeof *done);
      continue;
    }
    pw_hypo_substep_lanes(h, &s, LANES, rates);
    int count = n == LANES ? scatter(h, a, &g, first, LANES, done + first)
                           : scatter(h, a, &g, first, n, done + first);
    if (a->counts) {
      a->counts->substeps += count;
      a->counts->rhs += 3 * count;
    }
  }
}
