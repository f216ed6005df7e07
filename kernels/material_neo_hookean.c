/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/material.h"
#include "kernels/tensor.h"

enum { BULK, SHEAR, DENSITY };

static const pw_key keys[] = {
    {"bulk_modulus_pa", PW_KEY_REAL, BULK * sizeof(pw_real), PW_TINY, PW_HUGE, NULL, NULL, NULL,
     "bulk modulus K at small strain"},
    {"shear_modulus_pa", PW_KEY_REAL, SHEAR * sizeof(pw_real), PW_TINY, PW_HUGE, NULL, NULL, NULL,
     "shear modulus mu at small strain"},
    {"density_kg_m3", PW_KEY_REAL, DENSITY * sizeof(pw_real), PW_TINY, PW_HUGE, NULL, NULL, NULL,
     "density of the unstressed material"},
    {NULL, PW_KEY_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

static const pw_state_def states[] = {{NULL, false}};

static pw_status check(const pw_real *param)
{
  (void)param;
  return PW_OK;
}

static int nstate(const pw_real *param)
{
  (void)param;
  return 0;
}

static pw_real density(const pw_real *param)
{
  return param[DENSITY];
}

static void init(const pw_real *param, pw_idx n, pw_idx ld, const pw_real *stress, pw_real *state)
{
  (void)param, (void)n, (void)ld, (void)stress, (void)state;
}

/** Largest eigenvalue of b from above: its mean and the bound on that of its deviator. */
static inline pw_real largest_stretch(pw_t6 b)
{
  pw_real mean = pw_t6_trace(b) * (1.0 / 3.0);
  pw_t6 dev = pw_t6_shift(b, -mean);
  return mean + pw_t6_largest_bound(0.5 * pw_t6_dot(dev, dev), pw_t6_det(dev));
}

/**
 * Column of d sigma for F <- (1 + de) F: d sigma = -sigma tr de + (lambda tr de 1 + mu (de b +
 * b de)) / J.
 */
static pw_t6 tangent_column(const pw_real *param, pw_t6 b, pw_real jac, pw_t6 sigma, pw_t6 de)
{
  pw_real lambda = param[BULK] - 2.0 / 3.0 * param[SHEAR], tr = pw_t6_trace(de);
  pw_real m = 2.0 * param[SHEAR] / jac;
  pw_t6 out = pw_t6_shift(pw_t6_scale(-tr, sigma), lambda * tr / jac);
  /* the symmetric part of de b */
  pw_t6 db = {.xx = de.xx * b.xx + de.xy * b.xy + de.zx * b.zx,
              .yy = de.xy * b.xy + de.yy * b.yy + de.yz * b.yz,
              .zz = de.zx * b.zx + de.yz * b.yz + de.zz * b.zz};
  db.xy = 0.5 *
          (de.xx * b.xy + de.xy * b.yy + de.zx * b.yz + de.xy * b.xx + de.yy * b.xy + de.yz * b.zx);
  db.yz = 0.5 *
          (de.xy * b.zx + de.yy * b.yz + de.yz * b.zz + de.zx * b.xy + de.yz * b.yy + de.zz * b.yz);
  db.zx = 0.5 *
          (de.zx * b.xx + de.yz * b.xy + de.zz * b.zx + de.xx * b.zx + de.xy * b.yz + de.zx * b.zz);
  return pw_t6_axpy(out, m, db);
}

static void fill_tangent(const pw_real *param, pw_stress_args *a, pw_idx i)
{
  size_t l = (size_t)a->ldi, p = (size_t)i;
  pw_t6 b = pw_t6_load(a->left_cg + p, l), sigma = pw_t6_load(a->stress + p, (size_t)a->ld);
  for (size_t col = 0; col < 6; col++) {
    pw_real unit[6] = {0}, rows[6];
    unit[col] = col < 3 ? 1.0 : 0.5; /* per engineering shear */
    pw_t6_store(tangent_column(param, b, a->jac[p], sigma, pw_t6_load(unit, 1)), rows, 1);
    for (size_t row = 0; row < 6; row++) {
      a->tangent[(6 * row + col) * l + p] = rows[row];
    }
  }
}

/**
 * J sigma = lambda ln J 1 + mu (b - 1), lambda = K - 2/3 mu, of @p n <= PW_CHUNK points from
 * @p first on; the first failing one, or -1.
 *
 * Wave speed: the acoustic tensor of a direction n is ((lambda + mu - lambda ln J) n n +
 * mu (n.b.n) 1) / J; its largest value is at most (max(0, lambda (1 - ln J) + mu) + mu b_max) / J,
 * reached when n is the direction of the largest stretch.
 */
static pw_idx update_chunk(const pw_real *param, const pw_stress_args *a, pw_idx first, pw_idx n)
{
  const pw_real mu = param[SHEAR], lambda = param[BULK] - 2.0 / 3.0 * mu;
  const size_t l = (size_t)a->ld, li = (size_t)a->ldi;
  const pw_real *left_cg = a->left_cg + first, *jacobian = a->jac + first;
  const pw_real *density_now = a->density + first;
  pw_real *stress = a->stress + first, *speed = a->wave_speed + first;
  pw_real flag[PW_CHUNK], count = 0.0;
#pragma omp simd reduction(+ : count)
  for (pw_idx i = 0; i < n; i++) {
    pw_t6 b = pw_t6_load(left_cg + i, li), old = pw_t6_load(stress + i, l);
    pw_real jac = jacobian[i], inv_j = 1.0 / jac, log_j = pw_log(jac);
    pw_t6 sigma = pw_t6_scale(inv_j, pw_t6_shift(pw_t6_scale(mu, b), lambda * log_j - mu));
    pw_real along = lambda * (1.0 - log_j) + mu;
    pw_real modulus = ((along > 0.0 ? along : 0.0) + mu * largest_stretch(b)) * inv_j;
    pw_real good = jac > 1e-300 ? pw_t6_is_finite(sigma) : 0.0;
    modulus = good > 0.0 ? modulus : lambda + 2.0 * mu;
    pw_t6_store(pw_t6_select(good, sigma, old), stress + i, l);
    speed[i] = sqrt(modulus / density_now[i]);
    flag[i] = good;
    count += good;
  }
  return count == (pw_real)n ? -1 : first + pw_first_zero(flag, n);
}

static pw_status update(const pw_real *param, pw_stress_args *a)
{
  a->bad = -1;
  for (pw_idx first = 0; first < a->n; first += PW_CHUNK) {
    pw_idx n = a->n - first < PW_CHUNK ? a->n - first : PW_CHUNK;
    pw_idx bad = update_chunk(param, a, first, n);
    a->bad = a->bad < 0 ? bad : a->bad;
  }
  for (pw_idx i = 0; a->tangent && i < a->n; i++) {
    fill_tangent(param, a, i);
  }
  return a->bad < 0 ? PW_OK : PW_RETRY_STRESS;
}

extern const pw_material pw_material_neo_hookean;
const pw_material pw_material_neo_hookean = {
    .name = "neo_hookean",
    .brief = "compressible neo-Hookean solid, J sigma = lambda ln J 1 + mu (b - 1)",
    .keys = keys,
    .states = states,
    .needs_left_cg = true,
    .of_f = true,
    .symmetric = true,
    .check = check,
    .nstate = nstate,
    .density = density,
    .init = init,
    .update = update,
};
