/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/hypoplastic.h"

#include "kernels/hypoplastic_lanes.h"

enum { LANES = PW_HYPO_REST_LANES };

typedef pw_real lane_tensor[6][LANES];

/** Points on their way; a lane that becomes free takes the next point. */
typedef struct pool {
  lane_tensor stress, delta, de; /* sigma* and delta now */
  pw_real size[LANES], specific[LANES], log_dvol[LANES];
  pw_real t[LANES], end[LANES]; /* time reached, end of the part before or after the turn */
  pw_real substep[LANES], step[LANES], void_ratio[3][LANES];
  lane_tensor k[3], d[3], at, at_delta;
  pw_real able[LANES], modulus[LANES], error[LANES];
  pw_real good[LANES], next[LANES];
  pw_idx point[LANES]; /* -1: free */
  int accepted[LANES], rejected[LANES];
} pool;

PW_HYPO_STAGES(stages, LANES);

pw_hypo_point pw_hypo_read(const pw_hypo *h, const pw_stress_args *a, bool plane, pw_idx i)
{
  size_t l = (size_t)a->ld, li = (size_t)a->ldi, p = (size_t)i;
  pw_hypo_point y = {.stress = pw_t6_load(a->stress + p, l), .substep = 1.0};
  pw_real wxy = a->spin[p];
  pw_rot r = {0};
  if (!plane) {
    r = pw_rot_hughes_winget(wxy, a->spin[li + p], a->spin[2 * li + p]);
  }
  y.void_ratio = a->state[p];
  y.stress = plane ? pw_t6_rotate_plane(wxy, y.stress) : pw_t6_rotate(r, y.stress);
  if (h->intergranular) {
    pw_t6 delta = pw_t6_load(a->state + PW_HYPO_STATE_DELTA * l + p, l);
    y.delta = plane ? pw_t6_rotate_plane(wxy, delta) : pw_t6_rotate(r, delta);
    y.substep = a->state[PW_HYPO_STATE_SUBSTEP * l + p];
  }
  return y;
}

void pw_hypo_write(const pw_hypo *h, const pw_stress_args *a, const pw_hypo_point *y, pw_idx i)
{
  size_t l = (size_t)a->ld, p = (size_t)i;
  pw_t6_store(y->stress, a->stress + p, l);
  a->state[p] = y->void_ratio;
  if (h->intergranular) {
    pw_t6_store(y->delta, a->state + PW_HYPO_STATE_DELTA * l + p, l);
    a->state[PW_HYPO_STATE_SUBSTEP * l + p] = y->substep;
  }
}

/** Free lanes hold some stress, so that their rates are numbers. */
static void empty(pool *g)
{
  memset(g, 0, sizeof *g);
  for (int lane = 0; lane < LANES; lane++) {
    g->point[lane] = -1;
    g->stress[0][lane] = g->stress[1][lane] = g->stress[2][lane] = -1e5;
    g->specific[lane] = 1.7;
  }
}

/** Put point @p i into a lane; false when it is one for the integration of one point. */
static bool enter(const pw_hypo *h, const pw_stress_args *a, bool plane, pw_idx i, pool *g,
                  int lane)
{
  pw_hypo_point y = pw_hypo_read(h, a, plane, i);
  pw_t6 shifted = pw_t6_shift(y.stress, -h->p_t), de = pw_t6_load(a->dstrain + i, (size_t)a->ldi);
  pw_real size = pw_t6_norm(de), dvol = a->dvol[i], specific = 1.0 + y.void_ratio;
  bool pressed = -pw_t6_trace(shifted) > 3.0 * h->p_min * (1.0 + 1e-9);
  bool volume = dvol > 0.0 && specific * dvol > 1.0 + 1e-9;
  bool small = !h->intergranular || size <= PW_HYPO_SWEEP * h->r;
  if (!pressed || !volume || !small || !(y.substep > 0.0 && y.substep <= 1.0)) {
    return false;
  }
  pw_real turn = h->intergranular ? pw_hypo_turning_time(y.delta, de) : 0.0;
  pw_t6_store(shifted, &g->stress[0][lane], LANES);
  pw_t6_store(y.delta, &g->delta[0][lane], LANES);
  pw_t6_store(de, &g->de[0][lane], LANES);
  g->size[lane] = size;
  g->specific[lane] = specific;
  g->log_dvol[lane] = log(dvol);
  g->t[lane] = 0.0;
  g->end[lane] = turn > 0.0 ? turn : 1.0;
  g->substep[lane] = y.substep;
  g->point[lane] = i;
  g->accepted[lane] = g->rejected[lane] = 0;
  return true;
}

/** Fill free lanes with points that are not done, from @p next on. */
static int refill(const pw_hypo *h, const pw_stress_args *a, bool plane, const pw_real *done,
                  pw_idx *next, pool *g)
{
  int busy = 0;
  for (int lane = 0; lane < LANES; lane++) {
    for (; g->point[lane] < 0 && *next < a->n; ++*next) {
      if (!(done[*next] > 0.0)) {
        (void)enter(h, a, plane, *next, g, lane);
      }
    }
    busy += g->point[lane] >= 0 ? 1 : 0;
  }
  return busy;
}

/** Choose the size of the next substeps and the void ratio at their stages. */
static void prepare(pool *g)
{
#pragma omp simd
  for (int i = 0; i < LANES; i++) {
    pw_real room = g->end[i] - g->t[i], t = g->t[i], rate = g->log_dvol[i];
    pw_real step = g->substep[i] >= room * (1.0 - 1e-9) ? room : g->substep[i];
    g->step[i] = step;
    g->void_ratio[0][i] = g->specific[i] * pw_exp(t * rate) - 1.0;
    g->void_ratio[1][i] = g->specific[i] * pw_exp((t + 0.5 * step) * rate) - 1.0;
    g->void_ratio[2][i] = g->specific[i] * pw_exp((t + step) * rate) - 1.0;
    g->able[i] = 1.0;
  }
}

/** Move the lanes whose error allows it; choose what to try next. */
static void decide(const pw_hypo *hp, pool *g)
{
  const pw_hypo h = *hp;
#pragma omp simd
  for (int i = 0; i < LANES; i++) {
    pw_real step = g->step[i], t = g->t[i], end = g->end[i], tried = g->substep[i];
    pw_real able = g->able[i], error = g->error[i];
    pw_real good = error <= h.tolerance ? able : 0.0;
    pw_real last = tried >= (end - t) * (1.0 - 1e-9) ? good : 0.0;
    pw_real next = pw_hypo_next_substep(&h, step, error);
    pw_real least = last > 0.0 ? tried : 0.0; /* the end of a part cut this substep short */
    g->next[i] = next > least ? next : least;
    pw_real moved = t + good * step;
    g->t[i] = last > 0.0 ? end : moved;
    g->good[i] = good;
  }
  for (int c = 0; c < 6; c++) {
    for (int i = 0; i < LANES; i++) {
      g->stress[c][i] = g->good[i] > 0.0 ? g->at[c][i] : g->stress[c][i];
      g->delta[c][i] = g->good[i] > 0.0 ? g->at_delta[c][i] : g->delta[c][i];
    }
  }
}

static void leave(const pw_hypo *h, const pw_stress_args *a, pool *g, int lane)
{
  pw_idx i = g->point[lane];
  pw_hypo_point y = {
      .stress = pw_t6_shift(pw_t6_load(&g->stress[0][lane], LANES), h->p_t),
      .delta = pw_t6_load(&g->delta[0][lane], LANES),
      .void_ratio = g->specific[lane] * a->dvol[i] - 1.0,
      .substep = g->substep[lane],
  };
  pw_hypo_write(h, a, &y, i);
  a->wave_speed[i] = sqrt(g->modulus[lane] / a->density[i]);
  if (a->counts) {
    a->counts->substeps += g->accepted[lane];
    a->counts->rejected += g->rejected[lane];
    a->counts->rhs += 3 * (g->accepted[lane] + g->rejected[lane]);
  }
}

/** Free the lanes that have arrived and those that met a limit. */
static void release(const pw_hypo *h, const pw_stress_args *a, pool *g, pw_real *done)
{
  for (int lane = 0; lane < LANES; lane++) {
    if (g->point[lane] < 0) {
      continue;
    }
    bool good = g->good[lane] > 0.0, limit = !(g->able[lane] > 0.0);
    bool smallest = !good && g->step[lane] <= PW_HYPO_SUBSTEP_MIN;
    g->accepted[lane] += good ? 1 : 0;
    g->rejected[lane] += good ? 0 : 1;
    g->substep[lane] = g->next[lane];
    bool arrived = g->t[lane] >= g->end[lane];
    if (limit || smallest || !(g->error[lane] >= 0.0) || g->accepted[lane] >= h->max_substeps) {
      g->point[lane] = -1;
    } else if (arrived && g->end[lane] < 1.0) {
      g->end[lane] = 1.0;
    } else if (arrived) {
      leave(h, a, g, lane);
      done[g->point[lane]] = 1.0;
      g->point[lane] = -1;
    }
    if (g->point[lane] < 0) { /* a free lane repeats its last state without moving */
      g->t[lane] = g->end[lane] = 1.0;
    }
  }
}

void pw_hypo_advance_rest(const pw_hypo *h, bool plane, const pw_stress_args *a, pw_real *done)
{
  pw_hypo_rest_with(h, stages[h->form], plane, a, done);
}

void pw_hypo_rest_with(const pw_hypo *h, const pw_hypo_stage_fn rates[2], bool plane,
                       const pw_stress_args *a, pw_real *done)
{
  pw_idx next = 0, left = 0;
  pool g;
  const pw_hypo_substep s = {g.stress[0],
                             g.delta[0],
                             g.de[0],
                             g.size,
                             g.step,
                             {g.void_ratio[0], g.void_ratio[1], g.void_ratio[2]},
                             {g.k[0][0], g.k[1][0], g.k[2][0]},
                             {g.d[0][0], g.d[1][0], g.d[2][0]},
                             g.at[0],
                             g.at_delta[0],
                             g.able,
                             g.modulus,
                             g.error};
  for (pw_idx i = 0; i < a->n; i++) {
    left += done[i] > 0.0 ? 0 : 1;
  }
  if (left == 0) {
    return;
  }
  empty(&g);
  while (refill(h, a, plane, done, &next, &g) > 0) {
    prepare(&g);
    pw_hypo_substep_lanes(h, &s, LANES, rates);
    decide(h, &g);
    release(h, a, &g, done);
  }
}
