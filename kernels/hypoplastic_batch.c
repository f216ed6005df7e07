/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/hypoplastic.h"

#include "kernels/hypoplastic_lanes.h"

enum { LANES = PW_HYPO_LANES };

typedef pw_real lane_tensor[6][LANES];

/** A group of points; lanes past the last point repeat it and are not written back. */
typedef struct group {
  const pw_idx *point; /* [n] */
  int n;
  bool straight;                 /* they follow each other */
  lane_tensor stress, delta, de; /* sigma* and delta, rotated */
  pw_real size[LANES], void_ratio[LANES], dvol[LANES], step[LANES];
  pw_real able[LANES]; /* 1 where one substep does */
  lane_tensor k[3], d[3], at, at_delta;
  pw_real void_mid[LANES], void_end[LANES], modulus[LANES], error[LANES];
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

static void copy_rows(const pw_real *from, size_t ld, int rows, const group *g, pw_real *to)
{
  for (int c = 0; c < rows; c++) {
    const pw_real *row = from + (size_t)c * ld;
    if (g->straight && g->n == LANES) {
      memcpy(to + c * LANES, row + g->point[0], LANES * sizeof *to);
      continue;
    }
    for (int i = 0; i < LANES; i++) {
      to[c * LANES + i] = row[g->point[i < g->n ? i : g->n - 1]];
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
  size_t ld = (size_t)a->ld, ldi = (size_t)a->ldi;
  pw_real spin[3][LANES], substep[LANES];
  copy_rows(a->stress, ld, 6, g, g->at[0]);
  copy_rows(a->dstrain, ldi, 6, g, g->de[0]);
  copy_rows(a->spin, ldi, 3, g, spin[0]);
  copy_rows(a->dvol, ldi, 1, g, g->dvol);
  copy_rows(a->state, ld, 1, g, g->void_ratio);
  for (int i = 0; i < LANES; i++) {
    substep[i] = g->step[i] = 1.0;
  }
  if (h->intergranular) {
    copy_rows(a->state + PW_HYPO_STATE_DELTA * ld, ld, 6, g, g->at_delta[0]);
    copy_rows(a->state + PW_HYPO_STATE_SUBSTEP * ld, ld, 1, g, substep);
  } else {
    memset(g->at_delta, 0, sizeof g->at_delta);
  }
  for (int i = 0; i < LANES; i++) {
    g->able[i] = substep[i] >= 1.0 ? 1.0 : 0.0;
  }
  rotate(h, spin, plane, g);
}

/** Choose the lanes that one substep may do for; how many. */
static pw_real choose(const pw_hypo *h, group *g)
{
  const pw_real least = -3.0 * h->p_min * (1.0 + 1e-9);
  pw_real count = 0.0;
#pragma omp simd reduction(+ : count)
  for (int i = 0; i < LANES; i++) {
    pw_t6 de = pw_t6_load(&g->de[0][i], LANES);
    pw_real size2 = pw_t6_dot(de, de), turn = -pw_t6_dot(pw_t6_load(&g->delta[0][i], LANES), de);
    /* delta:D changes sign at the time turn / size2 */
    pw_real straight = turn <= 1e-6 * size2 ? 1.0 : (turn >= (1.0 - 1e-6) * size2 ? 1.0 : 0.0);
    pw_real trace = g->stress[0][i] + g->stress[1][i] + g->stress[2][i];
    g->size[i] = sqrt(size2);
    g->void_end[i] = (1.0 + g->void_ratio[i]) * g->dvol[i] - 1.0;
    pw_real pressed = trace < least ? straight : 0.0; /* not stress-free */
    g->able[i] = g->void_end[i] > 1e-9 ? pressed * g->able[i] : 0.0;
    count += g->able[i];
  }
  return count;
}

/** Write the lanes that stand of points that follow each other. */
PW_INLINE void scatter(const pw_hypo *h, const pw_stress_args *a, const group *g,
                       const pw_real *speed, int n)
{
  const size_t ld = (size_t)a->ld;
  const pw_idx first = g->point[0];
  merge(speed, g->able, n, a->wave_speed + first);
  merge(g->void_end, g->able, n, a->state + first);
  for (size_t c = 0; c < 6; c++) {
    merge(g->at[c], g->able, n, a->stress + c * ld + first);
  }
  for (size_t c = 0; c < 6 && h->intergranular; c++) {
    merge(g->at_delta[c], g->able, n, a->state + (PW_HYPO_STATE_DELTA + c) * ld + first);
  }
}

/** The same for one lane, which stands. */
static void scatter_lane(const pw_hypo *h, const pw_stress_args *a, const group *g, pw_real speed,
                         int i)
{
  const size_t ld = (size_t)a->ld;
  const pw_idx p = g->point[i];
  a->wave_speed[p] = speed;
  a->state[p] = g->void_end[i];
  pw_t6_store(pw_t6_load(&g->at[0][i], LANES), a->stress + p, ld);
  if (h->intergranular) {
    pw_t6_store(pw_t6_load(&g->at_delta[0][i], LANES), a->state + PW_HYPO_STATE_DELTA * ld + p, ld);
  }
}

/** Write the lanes that stand after a substep of @p rhs evaluations. */
static void write_lanes(const pw_hypo *h, const pw_stress_args *a, group *g, int rhs, pw_real *done)
{
  const pw_real p_t = h->p_t;
  pw_real count = 0.0, speed[LANES], density[LANES];
  copy_rows(a->density, 0, 1, g, density);
  for (int i = 0; i < LANES; i++) {
    g->at[0][i] += p_t;
    g->at[1][i] += p_t;
    g->at[2][i] += p_t;
    speed[i] = sqrt(g->modulus[i] / density[i]);
  }
  for (int i = 0; i < g->n; i++) {
    done[g->point[i]] = g->able[i];
    count += g->able[i];
    if (!g->straight && g->able[i] > 0.0) {
      scatter_lane(h, a, g, speed[i], i);
    }
  }
  if (g->straight && g->n == LANES) {
    scatter(h, a, g, speed, LANES);
  } else if (g->straight) {
    scatter(h, a, g, speed, g->n);
  }
  if (a->counts) {
    a->counts->substeps += (int)count;
    a->counts->rhs += rhs * (int)count;
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

/** Order the points of a chunk: those small enough for a step of Heun's method, then the others, each
 *  in their order, so that a group holds one kind. How many are small. @param[in] none no such step */
static pw_idx order_by_size(const pw_hypo *hp, bool none, const pw_stress_args *a, pw_idx first,
                            pw_idx n, pw_idx *point)
{
  const pw_hypo h = *hp;
  const size_t ldi = (size_t)a->ldi;
  const pw_real tried = none ? 0.0 : 1.0;
  pw_real small[PW_CHUNK], count = 0.0;
#pragma omp simd reduction(+ : count)
  for (pw_idx i = 0; i < n; i++) {
    pw_real size = pw_t6_norm(pw_t6_load(a->dstrain + first + i, ldi));
    small[i] = tried * pw_hypo_heun_pays(&h, size);
    count += small[i];
  }
  const pw_idx total = (pw_idx)count;
  for (pw_idx i = 0, k = 0, other = total; i < n; i++) {
    point[small[i] > 0.0 ? k++ : other++] = first + i;
  }
  return total;
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
  pw_idx point[PW_CHUNK];
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
  for (pw_idx first = 0; first < a->n; first += PW_CHUNK) {
    const pw_idx n = a->n - first < PW_CHUNK ? a->n - first : PW_CHUNK;
    const pw_idx small = order_by_size(h, !heun_lanes, a, first, n, point);
    for (pw_idx k = 0; k < n; k += g.n) {
      const pw_idx room = (k < small ? small : n) - k;
      g.point = point + k;
      g.n = room < LANES ? (int)room : LANES;
      g.straight = g.point[g.n - 1] - g.point[0] == g.n - 1;
      gather(h, a, plane, &g);
      if (choose(h, &g) == 0.0) {
        continue;
      }
      if (k < small) {
        heun_lanes(h, &s, g.able);
      } else {
        three_stages(h, &s, rates, &g);
      }
      write_lanes(h, a, &g, k < small ? 2 : 3, done);
    }
  }
}
