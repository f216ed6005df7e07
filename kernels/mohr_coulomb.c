/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/mohr_coulomb.h"

#include "kernels/rate_form.h"
#include "kernels/spectral.h"

/* Planes of the sorted principal stresses, and the sets of them that can be active together. */
enum { F13, F12, F23, T1, T2, T3, PLANES };
enum { BY_SHEAR = 1 << F13 | 1 << F12 | 1 << F23 };

static const unsigned char sets[] = {
    1 << F13,
    1 << T1,
    1 << F13 | 1 << F12, /* s2 = s3 */
    1 << F13 | 1 << F23, /* s1 = s2 */
    1 << F13 | 1 << T1,
    1 << T1 | 1 << T2,
    1 << F13 | 1 << F12 | 1 << T1,
    1 << F13 | 1 << T1 | 1 << T2,
    1 << F13 | 1 << F23 | 1 << T1,
    1 << T1 | 1 << T2 | 1 << T3,
};

typedef struct plane {
  pw_real n[3], flow[3], c_flow[3]; /* normal, direction of flow, elastic stiffness times it */
  pw_real limit;                    /* n.s <= limit */
} plane;

static void make_planes(const pw_mc *m, plane *p)
{
  const int high[3] = {0, 0, 1}, low[3] = {2, 1, 2};
  for (int k = 0; k < PLANES; k++) {
    p[k] = (plane){.limit = k < T1 ? m->strength : m->tension};
    if (k < T1) {
      p[k].n[high[k]] = 1.0 + m->sin_phi;
      p[k].n[low[k]] = m->sin_phi - 1.0;
      p[k].flow[high[k]] = 1.0 + m->sin_psi;
      p[k].flow[low[k]] = m->sin_psi - 1.0;
    } else {
      p[k].n[k - T1] = p[k].flow[k - T1] = 1.0;
    }
    pw_real sum = p[k].flow[0] + p[k].flow[1] + p[k].flow[2];
    for (int c = 0; c < 3; c++) {
      p[k].c_flow[c] = m->lambda * sum + 2.0 * m->shear * p[k].flow[c];
    }
  }
}

static pw_real dot(const pw_real *a, const pw_real *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** Inverse of the leading n x n part of a by Gauss and Jordan; false when it is singular. */
static bool invert(int n, pw_real a[3][6])
{
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) {
      a[i][n + j] = i == j ? 1.0 : 0.0;
    }
  }
  for (int k = 0; k < n; k++) {
    int best = k;
    for (int i = k + 1; i < n; i++) {
      best = fabs(a[i][k]) > fabs(a[best][k]) ? i : best;
    }
    pw_real pivot = a[best][k];
    if (!(fabs(pivot) > 1e-12 * (fabs(a[0][0]) + fabs(pivot)))) {
      return false;
    }
    for (int j = 0; j < 2 * n; j++) {
      pw_real swap = a[best][j];
      a[best][j] = a[k][j];
      a[k][j] = swap / pivot;
    }
    for (int i = 0; i < n; i++) {
      pw_real f = a[i][k];
      for (int j = 0; i != k && j < 2 * n; j++) {
        a[i][j] -= f * a[k][j];
      }
    }
  }
  return true;
}

/** One active set with the inverse of n_i.C.flow_j. */
typedef struct active {
  int n, plane[3];
  pw_real inverse[3][3];
  pw_real stress[3];
} active;

/** Stress on the planes of a set; false when a multiplier is negative or a plane is exceeded by
 *  more than @p margin[0] and [1]; Pa. */
static bool try_set(const plane *p, unsigned set, const pw_real *trial, const pw_real *margin,
                    active *s)
{
  pw_real a[3][6];
  s->n = 0;
  for (int k = 0; k < PLANES; k++) {
    if (set >> k & 1u) {
      s->plane[s->n++] = k;
    }
  }
  for (int i = 0; i < s->n; i++) {
    for (int j = 0; j < s->n; j++) {
      a[i][j] = dot(p[s->plane[i]].n, p[s->plane[j]].c_flow);
    }
  }
  if (!invert(s->n, a)) {
    return false;
  }
  bool valid = true;
  memcpy(s->stress, trial, sizeof s->stress);
  for (int j = 0; j < s->n; j++) {
    const plane *pj = &p[s->plane[j]];
    pw_real lambda = 0.0;
    for (int i = 0; i < s->n; i++) {
      const plane *pi = &p[s->plane[i]];
      s->inverse[j][i] = a[j][s->n + i];
      lambda += s->inverse[j][i] * (dot(pi->n, trial) - pi->limit);
    }
    pw_real moved = fabs(pj->c_flow[0]) + fabs(pj->c_flow[1]) + fabs(pj->c_flow[2]);
    valid = valid && lambda * moved >= -margin[0];
    for (int c = 0; c < 3; c++) {
      s->stress[c] -= lambda * pj->c_flow[c];
    }
  }
  for (int k = 0; k < PLANES; k++) {
    valid = valid && dot(p[k].n, s->stress) - p[k].limit <= margin[1];
  }
  return valid;
}

static void set_tangent(const pw_mc *m, const plane *p, const active *s, pw_real *tangent)
{
  for (int r = 0; r < 3; r++) {
    for (int c = 0; c < 3; c++) {
      tangent[3 * r + c] = m->lambda + (r == c ? 2.0 * m->shear : 0.0);
    }
  }
  for (int i = 0; i < s->n; i++) {
    for (int j = 0; j < s->n; j++) {
      const pw_real *n = p[s->plane[j]].n, *flow = p[s->plane[i]].c_flow;
      pw_real sum = n[0] + n[1] + n[2];
      for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
          pw_real n_c = m->lambda * sum + 2.0 * m->shear * n[c];
          tangent[3 * r + c] -= flow[r] * s->inverse[i][j] * n_c;
        }
      }
    }
  }
}

/** Round-off of the return, as parts of the stress. The later pairs are for the few trial stresses
 *  that the first leaves without a set: the planes of an edge are nearly parallel in the metric of
 *  a nearly incompressible stiffness, or of a large friction angle. */
static const pw_real slack[][2] = {{1e-13, 1e-12}, {1e-8, 1e-8}, {1e-6, 1e-6}};
enum { TRIES = sizeof sets * sizeof slack / sizeof slack[0] };

/** Whether the return is to equal stresses @p top: then the elastic strain of the trial stress beyond
 *  them (here times 2 G) is a sum of flows of the planes that meet there. With (1 + sin psi, sin psi
 *  - 1) on any two axes and strains in order, these are two conditions. */
static bool beyond_apex(const pw_mc *m, const pw_real *trial, pw_real top, bool cut)
{
  const pw_real sum = trial[0] + trial[1] + trial[2] - 3.0 * top;
  const pw_real even = top + m->lambda / (3.0 * m->lambda + 2.0 * m->shear) * sum;
  const pw_real e[3] = {trial[0] - even, trial[1] - even, trial[2] - even};
  const pw_real less = 1.0 - m->sin_psi, more = 1.0 + m->sin_psi;
  return cut ? e[2] >= 0.0
             : less * (e[0] + e[1]) + more * e[2] >= 0.0 &&
                   less * e[0] + more * (e[1] + e[2]) >= 0.0;
}

/** Press a stress that a later pair of slacks leaves outside back onto the planes. */
static void press_back(const plane *p, pw_real *stress)
{
  pw_real by = 0.0;
  for (int k = 0; k < PLANES; k++) {
    const pw_real over = dot(p[k].n, stress) - p[k].limit;
    const pw_real across = p[k].n[0] + p[k].n[1] + p[k].n[2];
    by = over > 0.0 && across > 0.0 ? pw_max(by, over / across) : by;
  }
  for (int c = 0; c < 3; c++) {
    stress[c] -= by;
  }
}

bool pw_mc_return(const pw_mc *m, const pw_real *trial, pw_real *stress, pw_real *tangent)
{
  plane p[PLANES];
  active s = {.n = 0};
  make_planes(m, p);
  const pw_real apex = m->sin_phi > 0.0 ? m->strength / (2.0 * m->sin_phi) : PW_HUGE;
  const bool cut = m->tension < apex;
  bool outside = dot(p[F13].n, trial) > p[F13].limit || (cut && trial[0] > m->tension),
       done = false;
  pw_real size = fabs(trial[0]) + fabs(trial[2]) + m->strength;
  memcpy(s.stress, trial, sizeof s.stress);
  const pw_real top = pw_min(apex, m->tension);
  bool at_apex = false;
  for (size_t k = 0; outside && !done && !at_apex && k < TRIES; k++) {
    const unsigned set = sets[k % sizeof sets];
    const pw_real *part = slack[k / sizeof sets], margin[2] = {part[0] * size, part[1] * size};
    if (cut || !(set & ~(unsigned)BY_SHEAR)) {
      done = try_set(p, set, trial, margin, &s);
    }
    if (done && k >= sizeof sets) {
      press_back(p, s.stress);
    }
    at_apex = k + 1 == sizeof sets && top < PW_HUGE && beyond_apex(m, trial, top, cut);
  }
  if (outside && !done && top < PW_HUGE) { /* no set of planes: the apex */
    s.n = 3;
    s.stress[0] = s.stress[1] = s.stress[2] = top;
    memset(s.inverse, 0, sizeof s.inverse);
  }
  memcpy(stress, s.stress, sizeof s.stress);
  if (tangent && s.n == 3) { /* a corner: the stress is a constant */
    memset(tangent, 0, 9 * sizeof *tangent);
  } else if (tangent) {
    set_tangent(m, p, &s, tangent);
  }
  return outside;
}

/** Full tangent from that of principal stresses. Out of the principal axes,
 *  d s_ij = 2 G (s_i - s_j)/(trial_i - trial_j) d e_ij. */
static void full_tangent(pw_real shear, const pw_spectrum *axes, const pw_real *stress,
                         const pw_real *principal, pw_real *matrix)
{
  const pw_real *v = axes->vector;
  pw_rot in = {v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]};
  pw_rot back = {v[0], v[3], v[6], v[1], v[4], v[7], v[2], v[5], v[8]};
  pw_real twice[3], size = fabs(axes->value[0]) + fabs(axes->value[2]);
  for (int k = 0; k < 3; k++) {
    int i = k, j = (k + 1) % 3;
    pw_real gap = axes->value[i] - axes->value[j];
    pw_real limit =
        0.5 * (principal[4 * i] - principal[3 * i + j] + principal[4 * j] - principal[3 * j + i]);
    twice[k] = fabs(gap) > 1e-9 * size ? 2.0 * shear * (stress[i] - stress[j]) / gap : limit;
  }
  for (int col = 0; col < 6; col++) {
    pw_real unit[6] = {0}, rows[6];
    unit[col] = col < 3 ? 1.0 : 0.5;
    pw_t6 d = pw_t6_rotate(in, pw_t6_load(unit, 1));
    pw_t6 s = {.xx = principal[0] * d.xx + principal[1] * d.yy + principal[2] * d.zz,
               .yy = principal[3] * d.xx + principal[4] * d.yy + principal[5] * d.zz,
               .zz = principal[6] * d.xx + principal[7] * d.yy + principal[8] * d.zz,
               .xy = twice[0] * d.xy,
               .yz = twice[1] * d.yz,
               .zx = twice[2] * d.zx};
    pw_t6_store(pw_t6_rotate(back, s), rows, 1);
    for (int row = 0; row < 6; row++) {
      matrix[6 * row + col] = rows[row];
    }
  }
}

/** Largest principal value first. */
static pw_spectrum sorted(pw_t6 t)
{
  pw_spectrum s = pw_t6_spectrum(t), out;
  int order[3] = {0, 1, 2};
  for (int k = 0; k < 3; k++) { /* bubble: three comparisons */
    int i = k == 1 ? 1 : 0, j = i + 1;
    if (s.value[order[i]] < s.value[order[j]]) {
      int swap = order[i];
      order[i] = order[j];
      order[j] = swap;
    }
  }
  for (int k = 0; k < 3; k++) {
    out.value[k] = s.value[order[k]];
    memcpy(out.vector + 3 * k, s.vector + 3 * order[k], 3 * sizeof *out.vector);
  }
  return out;
}

/** Constants of a point. */
PW_INLINE pw_mc at_depth(const pw_mc *m, const pw_stress_args *a, size_t p)
{
  pw_mc here = *m;
  pw_real depth = m->graded ? a->state[PW_MC_DEPTH * (size_t)a->ld + p] : 0.0;
  here.lambda *= 1.0 + m->stiffer * depth;
  here.shear *= 1.0 + m->stiffer * depth;
  here.strength *= 1.0 + m->stronger * depth;
  return here;
}

/** Return of one point from its trial stress. */
static pw_real return_point(const pw_mc *m, const pw_stress_args *a, size_t p, pw_t6 trial)
{
  pw_real stress[3], principal[9], matrix[36];
  const pw_mc here = at_depth(m, a, p);
  if (pw_t6_is_finite(trial) == 0.0) {
    return pw_rate_store(a, p, trial, here.lambda + 2.0 * here.shear);
  }
  pw_spectrum axes = sorted(trial);
  bool outside = pw_mc_return(&here, axes.value, stress, a->tangent ? principal : NULL);
  if (outside) {
    pw_real high = axes.value[0] - stress[0], low = axes.value[2] - stress[2];
    trial = pw_spectrum_tensor(&axes, stress);
    a->state[PW_MC_PLASTIC * (size_t)a->ld + p] += fabs(high - low) / (2.0 * here.shear);
  }
  if (a->tangent && outside) {
    full_tangent(here.shear, &axes, stress, principal, matrix);
    pw_rate_store_tangent(a, p, matrix);
  } else if (a->tangent) {
    pw_elastic_matrix(here.lambda, here.shear, matrix);
    pw_rate_store_tangent(a, p, matrix);
  }
  return pw_rate_store(a, p, trial, here.lambda + 2.0 * here.shear);
}

/** Elastic step in the plane: stored and 1 when the trial stress is inside, else 0 and kept in
 *  @p trial [6][PW_CHUNK]. A margin of round-off leaves doubtful points to the return. */
PW_INLINE pw_real elastic_plane(const pw_mc *m, const pw_stress_args *a, size_t p, pw_real *trial)
{
  const size_t l = (size_t)a->ld;
  /* without growth any row does: it is multiplied by zero, and the loop has no condition */
  pw_real depth = a->state[(m->graded ? PW_MC_DEPTH : PW_MC_PLASTIC) * l + p];
  pw_real stiffer = 1.0 + m->stiffer * depth, strength = m->strength * (1.0 + m->stronger * depth);
  pw_real lambda = m->lambda * stiffer, shear = m->shear * stiffer;
  pw_t6 de = pw_t6_load(a->dstrain + p, (size_t)a->ldi), old = pw_t6_load(a->stress + p, l);
  pw_t6 t = pw_rate_trial(pw_t6_rotate_plane(a->spin[p], old), lambda, shear, de);
  pw_real mean = 0.5 * (t.xx + t.yy), d = 0.5 * (t.xx - t.yy), r = sqrt(d * d + t.xy * t.xy);
  pw_real above = mean + r, below = mean - r;
  pw_real high = above > t.zz ? above : t.zz, low = below < t.zz ? below : t.zz;
  pw_real f = (high - low) + (high + low) * m->sin_phi - strength;
  pw_real margin = 1e-13 * (fabs(high) + fabs(low) + strength);
  pw_real inside = f < -margin ? 1.0 : 0.0;
  inside = high < m->tension - margin ? inside : 0.0;
  pw_t6_store(t, trial, PW_CHUNK);
  pw_t6_store(pw_t6_select(inside, t, old), a->stress + p, l);
  a->wave_speed[p] = sqrt((lambda + 2.0 * shear) / a->density[p]);
  return inside;
}

static pw_idx update_chunk(const pw_mc *m, const pw_stress_args *a, pw_idx first, pw_idx n)
{
  const pw_stress_args arrays = *a;
  const pw_mc local = *m;
  pw_real trial[6 * PW_CHUNK], done[PW_CHUNK];
  pw_idx bad = -1;
  bool flat = pw_rate_is_plane(a, first, n);
  if (flat && !a->tangent) {
#pragma omp simd
    for (pw_idx i = 0; i < n; i++) {
      done[i] = elastic_plane(&local, &arrays, (size_t)(first + i), trial + i);
    }
  } else {
    for (pw_idx i = 0; i < n; i++) {
      const size_t p = (size_t)(first + i);
      const pw_mc here = at_depth(m, a, p);
      pw_t6 de = pw_t6_load(a->dstrain + p, (size_t)a->ldi);
      bool spin_plane = pw_spin_is_plane(a->spin + p, (size_t)a->ldi, 1);
      pw_t6 turned = pw_rate_turned(a, p, spin_plane);
      pw_t6_store(pw_rate_trial(turned, here.lambda, here.shear, de), trial + i, PW_CHUNK);
      done[i] = 0.0;
    }
  }
  for (pw_idx i = 0; i < n; i++) {
    if (done[i] == 0.0 &&
        return_point(m, a, (size_t)(first + i), pw_t6_load(trial + i, PW_CHUNK)) == 0.0) {
      bad = bad < 0 ? first + i : bad;
    }
  }
  return bad;
}

pw_status pw_mc_update(const pw_mc *m, pw_stress_args *a)
{
  a->bad = -1;
  for (pw_idx first = 0; first < a->n; first += PW_CHUNK) {
    pw_idx n = a->n - first < PW_CHUNK ? a->n - first : PW_CHUNK;
    pw_idx bad = update_chunk(m, a, first, n);
    a->bad = a->bad < 0 ? bad : a->bad;
  }
  return a->bad < 0 ? PW_OK : PW_RETRY_STRESS;
}
