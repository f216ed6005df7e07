/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mohr-Coulomb with isotropic elasticity in rate form; the return is in kernels/mohr_coulomb.c. */
#include "kernels/mohr_coulomb.h"

enum {
  YOUNG,
  POISSON,
  DENSITY,
  FRICTION,
  DILATION,
  COHESION,
  CUT_OFF,
  TENSION,
  COHESION_GRADIENT,
  YOUNG_GRADIENT,
  REFERENCE
};

#define RADIANS 0.017453292519943295769
#define REAL(name, index, lo, hi, fallback, meaning)                                               \
  {                                                                                                \
    name, PW_KEY_REAL, (index) * sizeof(pw_real), lo, hi, fallback, NULL, NULL, meaning            \
  }

static const pw_key keys[] = {
    REAL("youngs_modulus_pa", YOUNG, PW_TINY, PW_HUGE, NULL, "Young's modulus"),
    REAL("poisson_ratio", POISSON, -0.999, 0.4999999, NULL, "Poisson's ratio"),
    REAL("density_kg_m3", DENSITY, PW_TINY, PW_HUGE, NULL, "density at the start"),
    REAL("friction_angle_deg", FRICTION, 0, 89, NULL,
         "phi of (s1 - s3) + (s1 + s3) sin(phi) = 2 c cos(phi); 0 is Tresca's condition"),
    REAL("dilation_angle_deg", DILATION, 0, 89, "0", "psi of the flow, at most the friction angle"),
    REAL("cohesion_pa", COHESION, 0, PW_HUGE, "0", "c; with phi = 0 the undrained strength"),
    {"tension_cutoff", PW_KEY_BOOL, CUT_OFF * sizeof(pw_real), 0, 1, "false", NULL, NULL,
     "principal stresses are at most tensile_strength_pa"},
    REAL("tensile_strength_pa", TENSION, 0, PW_HUGE, "0", "with tension_cutoff"),
    REAL("cohesion_gradient_pa_m", COHESION_GRADIENT, 0, PW_HUGE, "0",
         "growth of the cohesion, per metre below reference_y_m"),
    REAL("youngs_modulus_gradient_pa_m", YOUNG_GRADIENT, 0, PW_HUGE, "0",
         "growth of Young's modulus, per metre below reference_y_m"),
    REAL("reference_y_m", REFERENCE, -PW_HUGE, PW_HUGE, "0",
         "height at which cohesion and Young's modulus are as given; above it too"),
    {NULL, PW_KEY_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

static const pw_state_def states[] = {
    {"plastic_shear_strain", true}, /* sum of increments of e1 - e3, plastic; - */
    {"depth_m", false},             /* of the start, below reference_y_m; with gradients alone */
    {NULL, false},
};

static bool graded(const pw_real *v)
{
  return v[COHESION_GRADIENT] > 0.0 || v[YOUNG_GRADIENT] > 0.0;
}

static pw_status check(const pw_real *v)
{
  PW_REQUIRE(v[YOUNG] > 0.0 && v[DENSITY] > 0.0, PW_ERR_SCENE,
             "youngs_modulus_pa = %g and density_kg_m3 = %g must be positive", v[YOUNG],
             v[DENSITY]);
  PW_REQUIRE(v[POISSON] > -1.0 && v[POISSON] < 0.5, PW_ERR_SCENE,
             "poisson_ratio = %g must lie between -1 and 0.5", v[POISSON]);
  PW_REQUIRE(v[FRICTION] > 0.0 || v[COHESION] > 0.0, PW_ERR_SCENE,
             "friction_angle_deg = 0 needs a cohesion_pa above 0: the material has no strength");
  PW_REQUIRE(v[DILATION] <= v[FRICTION], PW_ERR_SCENE,
             "dilation_angle_deg = %g must not exceed friction_angle_deg = %g", v[DILATION],
             v[FRICTION]);
  PW_REQUIRE(v[COHESION_GRADIENT] == 0.0 || v[COHESION] > 0.0, PW_ERR_SCENE,
             "cohesion_gradient_pa_m = %g needs a cohesion_pa above 0", v[COHESION_GRADIENT]);
  PW_REQUIRE(v[TENSION] == 0.0 || v[CUT_OFF] > 0.5, PW_ERR_SCENE,
             "tensile_strength_pa = %g needs tension_cutoff: true", v[TENSION]);
  return PW_OK;
}

static int nstate(const pw_real *v)
{
  return graded(v) ? PW_MC_DEPTH + 1 : PW_MC_DEPTH;
}

static pw_real density(const pw_real *v)
{
  return v[DENSITY];
}

static void place(const pw_real *v, pw_idx n, pw_idx ld, const pw_real *y, pw_real *state)
{
  for (pw_idx i = 0; graded(v) && i < n; i++) {
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
  pw_real shear = 0.5 * v[YOUNG] / (1.0 + v[POISSON]);
  pw_mc m = {.lambda = 2.0 * shear * v[POISSON] / (1.0 - 2.0 * v[POISSON]),
             .shear = shear,
             .sin_phi = sin(v[FRICTION] * RADIANS),
             .sin_psi = sin(v[DILATION] * RADIANS),
             .strength = 2.0 * v[COHESION] * cos(v[FRICTION] * RADIANS),
             .tension = v[CUT_OFF] > 0.5 ? v[TENSION] : PW_HUGE,
             .stiffer = v[YOUNG_GRADIENT] / v[YOUNG],
             .stronger = v[COHESION] > 0.0 ? v[COHESION_GRADIENT] / v[COHESION] : 0.0,
             .graded = graded(v)};
  return pw_mc_update(&m, a);
}

extern const pw_material pw_material_mohr_coulomb;
const pw_material pw_material_mohr_coulomb = {
    .name = "mohr_coulomb",
    .brief =
        "Mohr-Coulomb, non-associated, tension cut-off, exact return to planes, edges and apex",
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
