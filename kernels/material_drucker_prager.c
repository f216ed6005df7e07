/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Drucker-Prager with isotropic elasticity in rate form, its cone matched to Mohr-Coulomb:
 *   f = sqrt(J2) + eta p - xi c <= 0,   p = tr(sigma)/3,
 * flow sqrt(J2) + eta_bar p. Exact return to the cone or its apex p = c xi/eta. Source: de Souza
 * Neto, Peric, Owen, Computational Methods for Plasticity, sections 6.4.4 and 8.3. */
#include "kernels/rate_form.h"

enum { YOUNG, POISSON, DENSITY, FRICTION, DILATION, COHESION, MATCH };
enum { COMPRESSION, EXTENSION, PLANE_STRAIN };

#define RADIANS 0.017453292519943295769
#define REAL(name, index, lo, hi, fallback, meaning)                                               \
  {                                                                                                \
    name, PW_KEY_REAL, (index) * sizeof(pw_real), lo, hi, fallback, NULL, NULL, meaning            \
  }

static const pw_key keys[] = {
    REAL("youngs_modulus_pa", YOUNG, PW_TINY, PW_HUGE, NULL, "Young's modulus"),
    REAL("poisson_ratio", POISSON, -0.999, 0.4999999, NULL, "Poisson's ratio"),
    REAL("density_kg_m3", DENSITY, PW_TINY, PW_HUGE, NULL, "density at the start"),
    REAL("friction_angle_deg", FRICTION, 0, 89, NULL, "phi of the Mohr-Coulomb condition matched"),
    REAL("dilation_angle_deg", DILATION, 0, 89, "0", "psi of the flow, at most the friction angle"),
    REAL("cohesion_pa", COHESION, 0, PW_HUGE, "0", "c of the Mohr-Coulomb condition matched"),
    {"match", PW_KEY_CHOICE, MATCH * sizeof(pw_real), 0, 2, "compression",
     "compression|extension|plane_strain", NULL,
     "states in which both agree: triaxial compression, extension, or limit loads of plane strain "
     "with associated flow"},
    {NULL, PW_KEY_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

static const pw_state_def states[] = {
    {"plastic_strain", true}, /* sum of sqrt(2/3) |dev d e_p|; - */
    {NULL, false},
};

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
  return PW_OK;
}

static int nstate(const pw_real *v)
{
  (void)v;
  return 1;
}

static pw_real density(const pw_real *v)
{
  return v[DENSITY];
}

static void init(const pw_real *v, pw_idx n, pw_idx ld, const pw_real *stress, pw_real *state)
{
  (void)v, (void)ld, (void)stress;
  for (pw_idx i = 0; i < n; i++) {
    state[i] = 0.0;
  }
}

/** Moduli and the cone. */
typedef struct model {
  pw_real bulk, shear, eta, eta_bar, strength, apex; /* strength: xi c; apex: largest p */
  pw_real per_flow;                                  /* 1/(G + K eta eta_bar) */
} model;

/** Slope eta and xi of the cone for an angle. */
static void cone(int match, pw_real angle, pw_real *eta, pw_real *xi)
{
  pw_real s = sin(angle), c = cos(angle), t = s / c;
  pw_real f = 1.0 / (sqrt(3.0) * (match == EXTENSION ? 3.0 + s : 3.0 - s));
  *eta = match == PLANE_STRAIN ? 3.0 * t / sqrt(9.0 + 12.0 * t * t) : 6.0 * s * f;
  *xi = match == PLANE_STRAIN ? 3.0 / sqrt(9.0 + 12.0 * t * t) : 6.0 * c * f;
}

static model derive(const pw_real *v)
{
  model m = {.bulk = v[YOUNG] / (3.0 * (1.0 - 2.0 * v[POISSON])),
             .shear = 0.5 * v[YOUNG] / (1.0 + v[POISSON])};
  pw_real xi, unused;
  cone((int)v[MATCH], v[FRICTION] * RADIANS, &m.eta, &xi);
  cone((int)v[MATCH], v[DILATION] * RADIANS, &m.eta_bar, &unused);
  m.strength = xi * v[COHESION];
  m.apex = m.eta > 0.0 ? m.strength / m.eta : PW_HUGE;
  m.per_flow = 1.0 / (m.shear + m.bulk * m.eta * m.eta_bar);
  return m;
}

/** What the return of a point found. */
typedef struct result {
  pw_t6 dev;    /* of the trial stress */
  pw_real root; /* sqrt(J2) of the trial stress */
  pw_real keep; /* length of the deviator over that of the trial stress */
  bool flows, apex;
} result;

PW_INLINE pw_real update_point(const model *m, const pw_stress_args *a, size_t p, bool plane,
                               result *r)
{
  pw_t6 de = pw_t6_load(a->dstrain + p, (size_t)a->ldi);
  pw_real lambda = m->bulk - 2.0 / 3.0 * m->shear;
  pw_t6 trial = pw_rate_trial(pw_rate_turned(a, p, plane), lambda, m->shear, de);
  pw_real mean = pw_t6_trace(trial) * (1.0 / 3.0);
  r->dev = pw_t6_shift(trial, -mean);
  r->root = sqrt(0.5 * pw_t6_dot(r->dev, r->dev));
  pw_real f = r->root + m->eta * mean - m->strength, flow = f * m->per_flow;
  r->flows = f > 0.0;
  r->apex = f > 0.0 && r->root < m->shear * flow;
  pw_real keep = 1.0 - m->shear * flow / (r->root + 1e-300);
  r->keep = f > 0.0 ? (r->apex ? 0.0 : keep) : 1.0;
  mean = f > 0.0 ? (r->apex ? m->apex : mean - m->bulk * m->eta_bar * flow) : mean;
  pw_real strain = (1.0 - r->keep) * r->root / (sqrt(3.0) * m->shear);
  pw_t6 stress = pw_t6_shift(pw_t6_scale(r->keep, r->dev), mean);
  pw_real good = pw_rate_store(a, p, stress, m->bulk + 4.0 / 3.0 * m->shear);
  a->state[p] += good > 0.0 ? strain : 0.0;
  return good;
}

static pw_t6 tangent_column(const model *m, const result *r, pw_t6 de)
{
  pw_real tr = pw_t6_trace(de);
  pw_t6 dev = pw_t6_scale(2.0 * m->shear, pw_t6_shift(de, -tr / 3.0));
  if (r->apex) {
    return (pw_t6){0};
  }
  if (!r->flows) {
    return pw_t6_shift(dev, m->bulk * tr);
  }
  pw_real d_root = 0.5 * pw_t6_dot(r->dev, dev) / r->root; /* of the trial stress */
  pw_real d_flow = (d_root + m->eta * m->bulk * tr) * m->per_flow;
  pw_t6 out = pw_t6_scale(r->keep, dev);
  out = pw_t6_axpy(out, ((1.0 - r->keep) * d_root - m->shear * d_flow) / r->root, r->dev);
  return pw_t6_shift(out, m->bulk * (tr - m->eta_bar * d_flow));
}

static void fill_tangent(const model *m, const result *r, const pw_stress_args *a, size_t p)
{
  pw_real matrix[36];
  for (int col = 0; col < 6; col++) {
    pw_real unit[6] = {0}, rows[6];
    unit[col] = col < 3 ? 1.0 : 0.5; /* per engineering shear */
    pw_t6_store(tangent_column(m, r, pw_t6_load(unit, 1)), rows, 1);
    for (int row = 0; row < 6; row++) {
      matrix[6 * row + col] = rows[row];
    }
  }
  pw_rate_store_tangent(a, p, matrix);
}

/** Advance @p n <= PW_CHUNK points from @p first on; the first failing one, or -1. */
static pw_idx update_chunk(const model *m, const pw_stress_args *a, pw_idx first, pw_idx n)
{
  const pw_stress_args arrays = *a;
  const model local = *m;
  pw_real good[PW_CHUNK], count = 0.0;
  if (!a->tangent && pw_spin_is_plane(a->spin + first, (size_t)a->ldi, n)) {
#pragma omp simd reduction(+ : count)
    for (pw_idx i = 0; i < n; i++) {
      result r;
      good[i] = update_point(&local, &arrays, (size_t)(first + i), true, &r);
      count += good[i];
    }
  } else {
    for (pw_idx i = 0; i < n; i++) {
      const size_t p = (size_t)(first + i);
      result r;
      good[i] = update_point(m, a, p, pw_spin_is_plane(a->spin + p, (size_t)a->ldi, 1), &r);
      count += good[i];
      if (a->tangent) {
        fill_tangent(m, &r, a, p);
      }
    }
  }
  return count == (pw_real)n ? -1 : first + pw_first_zero(good, n);
}

static pw_status update(const pw_real *param, pw_stress_args *a)
{
  const model m = derive(param);
  a->bad = -1;
  for (pw_idx first = 0; first < a->n; first += PW_CHUNK) {
    pw_idx n = a->n - first < PW_CHUNK ? a->n - first : PW_CHUNK;
    pw_idx bad = update_chunk(&m, a, first, n);
    a->bad = a->bad < 0 ? bad : a->bad;
  }
  return a->bad < 0 ? PW_OK : PW_RETRY_STRESS;
}

extern const pw_material pw_material_drucker_prager;
const pw_material pw_material_drucker_prager = {
    .name = "drucker_prager",
    .brief = "Drucker-Prager cone matched to Mohr-Coulomb, non-associated, exact return",
    .keys = keys,
    .states = states,
    .takes_initial_stress = true,
    .check = check,
    .nstate = nstate,
    .density = density,
    .init = init,
    .update = update,
};
