/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/hypoplastic.h"

#include "kernels/hypoplastic_lanes.h"

enum { LANES = PW_HYPO_LANES };

typedef pw_real lane_tensor[6][LANES];

/** A group of points; lanes past the last point repeat it and are not written back. */
typedef struct group {
  pw_idx first;
  int n;                         /* points, from `first` on */
  lane_tensor stress, delta, de; /* sigma* and delta, rotated */
  pw_real size[LANES], void_ratio[LANES], dvol[LANES], step[LANES];
  pw_real able[LANES]; /* 1 where one substep does */
  lane_tensor k[3], d[3], at, at_delta;
  pw_real void_mid[LANES], void_end[LANES], modulus[LANES], error[LANES];
  pw_real small[LANES]; /* 1 where a step of Heun's method is tried */
} group;

PW_HYPO_STAGES(stages, LANES);

#define HEUN(form)                                                                                 \
  static void heun_##form(const pw_hypo *h, const pw_hypo_substep *s, pw_real *good)               \
  {                                                                                                \
    pw_hypo_heun_lanes(h, s, good, LANES, form);                                                   \
  }
HEUN(1)
HEUN(3)
static const pw_hypo_heun_fn heun[PW_HYPO_FORMS] = {NULL, heun_1, NULL, heun_3};

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

/** Replace a row by @p from where @p stands is positive. */
PW_INLINE void merge(const pw_real *from, const pw_real *stands, int n, pw_real *row)
{
#pragma omp simd
  for (int i = 0; i < n; i++) {
    pw_real was = row[i], is = from[i];
    row[i] = stands[i] > 0.0 ? is : was;
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

/** Read the points of a group and rotate them. */
static void gather(const pw_hypo *h, const pw_stress_args *a, bool plane, group *g)
{
  const pw_idx first = g->first;
  const int n = g->n;
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
  for (int i = 0; i < LANES; i++) {
    g->able[i] = substep[i] >= 1.0 ? 1.0 : 0.0;
  }
  rotate(h, spin, plane, g);
}

/** Choose the lanes that one substep may do for: small ones by a step of Heun's method where
 *  @p heun, others by three stages; how many of each. */
static void choose(const pw_hypo *h, bool heun_too, group *g, pw_real count[2])
{
  const pw_hypo c = *h;
  const pw_real least = -3.0 * c.p_min * (1.0 + 1e-9), tried = heun_too ? 1.0 : 0.0;
  pw_real small = 0.0, other = 0.0;
#pragma omp simd reduction(+ : small, other)
  for (int i = 0; i < LANES; i++) {
    pw_t6 de = pw_t6_load(&g->de[0][i], LANES);
    pw_real size2 = pw_t6_dot(de, de), turn = -pw_t6_dot(pw_t6_load(&g->delta[0][i], LANES), de);
    /* delta:D changes sign at the time turn / size2 */
    pw_real straight = turn <= 1e-6 * size2 ? 1.0 : (turn >= (1.0 - 1e-6) * size2 ? 1.0 : 0.0);
    pw_real trace = g->stress[0][i] + g->stress[1][i] + g->stress[2][i];
    g->size[i] = sqrt(size2);
    g->void_end[i] = (1.0 + g->void_ratio[i]) * g->dvol[i] - 1.0;
    pw_real pressed = trace < least ? straight : 0.0; /* not stress-free */
    pw_real able = g->void_end[i] > 1e-9 ? pressed * g->able[i] : 0.0;
    g->small[i] = able * tried * pw_hypo_heun_pays(&c, g->size[i]);
    g->able[i] = able - g->small[i];
    small += g->small[i];
    other += g->able[i];
  }
  count[0] = small;
  count[1] = other;
}

/** Write the lanes that stand; how many. */
PW_INLINE int scatter(const pw_hypo *h, const pw_stress_args *a, group *g, const pw_real *stands,
                      int n, pw_real *done)
{
  const size_t ld = (size_t)a->ld;
  const pw_idx first = g->first;
  const pw_real p_t = h->p_t;
  pw_real count = 0.0, speed[LANES];
#pragma omp simd reduction(+ : count)
  for (int i = 0; i < n; i++) {
    done[first + i] += stands[i];
    count += stands[i];
    g->at[0][i] += p_t;
    g->at[1][i] += p_t;
    g->at[2][i] += p_t;
    speed[i] = sqrt(g->modulus[i] / a->density[first + i]);
  }
  merge(speed, stands, n, a->wave_speed + first);
  merge(g->void_end, stands, n, a->state + first);
  for (size_t c = 0; c < 6; c++) {
    merge(g->at[c], stands, n, a->stress + c * ld + first);
  }
  for (size_t c = 0; c < 6 && h->intergranular; c++) {
    merge(g->at_delta[c], stands, n, a->state + (PW_HYPO_STATE_DELTA + c) * ld + first);
  }
  return (int)count;
}

/** Write the lanes that stand after a substep of @p rhs evaluations. */
static void write_lanes(const pw_hypo *h, const pw_stress_args *a, group *g, const pw_real *stands,
                        int rhs, pw_real *done)
{
  int count =
      g->n == LANES ? scatter(h, a, g, stands, LANES, done) : scatter(h, a, g, stands, g->n, done);
  if (a->counts) {
    a->counts->substeps += count;
    a->counts->rhs += rhs * count;
  }
}

/** A substep of three stages; able stays 1 where it stands. */
static void three_stages(const pw_hypo *h, const pw_hypo_substep *s,
                         const pw_hypo_stage_fn rates[2], group *g)
{
  for (int i = 0; i < LANES; i++) {
    g->void_mid[i] = (1.0 + g->void_ratio[i]) * sqrt(g->dvol[i]) - 1.0;
  }
  pw_hypo_substep_lanes(h, s, LANES, rates);
  for (int i = 0; i < LANES; i++) {
    g->able[i] = g->error[i] <= h->tolerance ? g->able[i] : 0.0;
  }
}

void pw_hypo_advance_smooth(const pw_hypo *h, bool plane, const pw_stress_args *a, pw_real *done)
{
  pw_hypo_smooth_with(h, stages[h->form], heun[h->form], plane, a, done);
}

void pw_hypo_smooth_with(const pw_hypo *h, const pw_hypo_stage_fn rates[2],
                         pw_hypo_heun_fn heun_lanes, bool plane, const pw_stress_args *a,
                         pw_real *done)
{
  group g;
  pw_real count[2]; /* of lanes that try a step of Heun's method, of others */
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
  memset(done, 0, (size_t)a->n * sizeof *done);
  for (g.first = 0; g.first < a->n; g.first += LANES) {
    g.n = a->n - g.first < LANES ? (int)(a->n - g.first) : LANES;
    gather(h, a, plane, &g);
    choose(h, heun_lanes != NULL, &g, count);
    if (count[0] > 0.0) {
      heun_lanes(h, &s, g.small);
      write_lanes(h, a, &g, g.small, 2, done);
    }
    if (count[1] > 0.0) {
      three_stages(h, &s, rates, &g);
      write_lanes(h, a, &g, g.able, 3, done);
    }
  }
}
