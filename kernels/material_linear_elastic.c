/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/material.h"
#include "kernels/tensor.h"

enum { YOUNG, POISSON, DENSITY };

static const pw_key keys[] = {
    {"youngs_modulus_pa", PW_KEY_REAL, YOUNG * sizeof(pw_real), PW_TINY, PW_HUGE, NULL, NULL, NULL,
     "Young's modulus"},
    {"poisson_ratio", PW_KEY_REAL, POISSON * sizeof(pw_real), -0.999, 0.4999, NULL, NULL, NULL,
     "Poisson's ratio"},
    {"density_kg_m3", PW_KEY_REAL, DENSITY * sizeof(pw_real), PW_TINY, PW_HUGE, NULL, NULL, NULL,
     "density of the unstressed material"},
    {NULL, PW_KEY_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

static const pw_state_def states[] = {{NULL, false}};

static pw_status check(const pw_real *param)
{
  PW_REQUIRE(param[POISSON] > -1.0 && param[POISSON] < 0.5, PW_ERR_SCENE,
             "poisson_ratio = %g must lie between -1 and 0.5", param[POISSON]);
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

static void fill_tangent(pw_real lambda, pw_real mu, pw_stress_args *a)
{
  size_t l = (size_t)a->ldi;
  for (size_t row = 0; row < 6; row++) {
    for (size_t col = 0; col < 6; col++) {
      pw_real value = row < 3 && col < 3 ? lambda : 0.0;
      if (row == col) {
        value += row < 3 ? 2.0 * mu : mu;
      }
      for (pw_idx i = 0; i < a->n; i++) {
        a->tangent[(6 * row + col) * l + (size_t)i] = value;
      }
    }
  }
}

/** sigma <- R sigma R^T + lambda tr(dE) 1 + 2 mu dE for point @p i; 1 when the result is finite. */
PW_INLINE pw_real update_point(pw_real lambda, pw_real mu, const pw_stress_args *a, pw_idx i,
                               bool plane)
{
  const size_t l = (size_t)a->ld, li = (size_t)a->ldi, p = (size_t)i;
  pw_t6 old = pw_t6_load(a->stress + p, l), de = pw_t6_load(a->dstrain + p, li);
  pw_t6 turned =
      plane ? pw_t6_rotate_plane(a->spin[p], old)
            : pw_t6_rotate(pw_rot_hughes_winget(a->spin[p], a->spin[li + p], a->spin[2 * li + p]),
                           old);
  pw_t6 now = pw_t6_shift(pw_t6_axpy(turned, 2.0 * mu, de), lambda * pw_t6_trace(de));
  pw_real good = pw_t6_is_finite(now);
  pw_t6_store(pw_t6_select(good, now, old), a->stress + p, l);
  a->wave_speed[p] = sqrt((lambda + 2.0 * mu) / a->density[p]);
  return good;
}

/** Advance @p n <= PW_CHUNK points from @p first on; the first failing one, or -1. */
static pw_idx update_chunk(pw_real lambda, pw_real mu, const pw_stress_args *a, pw_idx first,
                           pw_idx n)
{
  const pw_stress_args arrays = *a;
  pw_real good[PW_CHUNK], count = 0.0;
  if (pw_spin_is_plane(a->spin + first, (size_t)a->ldi, n)) {
#pragma omp simd reduction(+ : count)
    for (pw_idx i = 0; i < n; i++) {
      good[i] = update_point(lambda, mu, &arrays, first + i, true);
      count += good[i];
    }
  } else {
#pragma omp simd reduction(+ : count)
    for (pw_idx i = 0; i < n; i++) {
      good[i] = update_point(lambda, mu, &arrays, first + i, false);
      count += good[i];
    }
  }
  return count == (pw_real)n ? -1 : first + pw_first_zero(good, n);
}

static pw_status update(const pw_real *param, pw_stress_args *a)
{
  const pw_real mu = 0.5 * param[YOUNG] / (1.0 + param[POISSON]);
  const pw_real lambda = 2.0 * mu * param[POISSON] / (1.0 - 2.0 * param[POISSON]);
  a->bad = -1;
  for (pw_idx first = 0; first < a->n; first += PW_CHUNK) {
    pw_idx n = a->n - first < PW_CHUNK ? a->n - first : PW_CHUNK;
    pw_idx bad = update_chunk(lambda, mu, a, first, n);
    a->bad = a->bad < 0 ? bad : a->bad;
  }
  if (a->tangent) {
    fill_tangent(lambda, mu, a);
  }
  return a->bad < 0 ? PW_OK : PW_RETRY_STRESS;
}

extern const pw_material pw_material_linear_elastic;
const pw_material pw_material_linear_elastic = {
    .name = "linear_elastic",
    .brief = "isotropic linear elasticity in rate form with the Jaumann rate",
    .keys = keys,
    .states = states,
    .takes_initial_stress = true,
    .check = check,
    .nstate = nstate,
    .density = density,
    .init = init,
    .update = update,
};
