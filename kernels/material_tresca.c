/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Undrained clay after Tresca, strength and stiffness growing with depth: the return of
 * kernels/mohr_coulomb.c without friction. */
#include "kernels/mohr_coulomb.h"

enum { STRENGTH, STRENGTH_GRADIENT, RIGIDITY, POISSON, DENSITY, REFERENCE };

#define REAL(name, index, lo, hi, fallback, meaning)                                               \
  {                                                                                                \
    name, PW_KEY_REAL, (index) * sizeof(pw_real), lo, hi, fallback, NULL, NULL, meaning            \
  }

static const pw_key keys[] = {
    REAL("undrained_shear_strength_pa", STRENGTH, PW_TINY, PW_HUGE, NULL,
         "c_u, half of the largest difference of principal stresses, at reference_y_m"),
    REAL("undrained_shear_strength_gradient_pa_m", STRENGTH_GRADIENT, 0, PW_HUGE, "0",
         "growth of c_u, per metre below reference_y_m"),
    REAL("rigidity_index", RIGIDITY, PW_TINY, PW_HUGE, NULL,
         "G/c_u at every depth: the stiffness grows with the strength"),
    REAL("poisson_ratio", POISSON, 0.0, 0.4999999, "0.495",
         "near 0.5: the volume of undrained clay hardly changes"),
    REAL("density_kg_m3", DENSITY, PW_TINY, PW_HUGE, NULL, "density at the start, with its water"),
    REAL("reference_y_m", REFERENCE, -PW_HUGE, PW_HUGE, "0",
         "height at which c_u is as given; above it too"),
    {NULL, PW_KEY_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

static const pw_state_def states[] = {
    {"plastic_shear_strain", true}, /* sum of increments of e1 - e3, plastic; - */
    {"depth_m", false},             /* of the start, below reference_y_m; with a gradient alone */
    {NULL, false},
};

static pw_status check(const pw_real *v)
{
  PW_REQUIRE(v[STRENGTH] > 0.0 && v[RIGIDITY] > 0.0 && v[DENSITY] > 0.0, PW_ERR_SCENE,
             "undrained_shear_strength_pa, rigidity_index and density_kg_m3 must be positive: %g, "
             "%g, %g",
             v[STRENGTH], v[RIGIDITY], v[DENSITY]);
  PW_REQUIRE(v[POISSON] >= 0.0 && v[POISSON] < 0.5, PW_ERR_SCENE,
             "poisson_ratio = %g must lie between 0 and 0.5", v[POISSON]);
  return PW_OK;
}

static int nstate(const pw_real *v)
{
  return v[STRENGTH_GRADIENT] > 0.0 ? PW_MC_DEPTH + 1 : PW_MC_DEPTH;
}

static pw_real density(const pw_real *v)
{
  return v[DENSITY];
}

static void place(const pw_real *v, pw_idx n, pw_idx ld, const pw_real *y, pw_real *state)
{
  for (pw_idx i = 0; v[STRENGTH_GRADIENT] > 0.0 && i < n; i++) {
    state[PW_MC_DEPTH * (size_t)ld + (size_t)i] = pw_max(v[REFERENCE] - y[i], 0.0);
  }
}

static void init(const pw_real *v, pw_idx n, pw_idx ld, const pw_real *stress, pw_real *state)
{
  (void)v, (void)ld, (void)stress;
  for (pw_idx i = 0; i < n; i++) {
    state[i] = 0.0;
  }
}

static pw_status update(const pw_real *v, pw_stress_args *a)
{
  pw_real shear = v[RIGIDITY] * v[STRENGTH], growth = v[STRENGTH_GRADIENT] / v[STRENGTH];
  pw_mc m = {.lambda = 2.0 * shear * v[POISSON] / (1.0 - 2.0 * v[POISSON]),
             .shear = shear,
             .strength = 2.0 * v[STRENGTH],
             .tension = PW_HUGE,
             .stiffer = growth,
             .stronger = growth,
             .graded = growth > 0.0};
  return pw_mc_update(&m, a);
}

extern const pw_material pw_material_tresca;
const pw_material pw_material_tresca = {
    .name = "tresca",
    .brief = "undrained clay after Tresca; strength and stiffness grow with depth",
    .keys = keys,
    .states = states,
    .takes_initial_stress = true,
    .check = check,
    .nstate = nstate,
    .density = density,
    .place = place,
    .init = init,
    .update = update,
};
