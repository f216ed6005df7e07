/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hencky elasticity with von Mises plasticity, multiplicative and integrated by the exponential
 * map, so that the return is the one of small strains in logarithmic strain. Source: Simo, Comput.
 * Methods Appl. Mech. Engrg 99 (1992) 61-112; de Souza Neto, Peric, Owen, Computational Methods
 * for Plasticity, section 14.
 *
 * With b the elastic left Cauchy-Green tensor, e = ln(b)/2 and J = det(b)^(1/2) = exp(tr e):
 *   tau = J sigma = K tr(e) 1 + 2 G dev(e),   |dev tau| <= R(plastic strain).
 * Stress and e determine each other, so that ln J is all that has to be kept beside the stress:
 * e = dev(J sigma)/(2 G) + ln J/3 1. A prescribed initial stress sets ln J; the stress-free state
 * of the material is then the one that unloading would reach. */
#include "kernels/rate_form.h"
#include "kernels/spectral.h"

enum {
  YOUNG,
  POISSON,
  DENSITY,
  RADIUS,
  UNIAXIAL,
  SHEAR_STRENGTH,
  HARDENING,
  YIELD_GRADIENT,
  YOUNG_GRADIENT,
  REFERENCE,
};
enum { PLASTIC_STRAIN, LOG_VOLUME, DEPTH };

#define REAL(name, index, lo, hi, fallback, meaning)                                               \
  {                                                                                                \
    name, PW_KEY_REAL, (index) * sizeof(pw_real), lo, hi, fallback, NULL, NULL, meaning            \
  }

static const pw_key keys[] = {
    REAL("youngs_modulus_pa", YOUNG, PW_TINY, PW_HUGE, NULL, "Young's modulus at small strain, E"),
    REAL("poisson_ratio", POISSON, -0.999, 0.4999999, NULL, "Poisson's ratio at small strain"),
    REAL("density_kg_m3", DENSITY, PW_TINY, PW_HUGE, NULL, "density at the start"),
    REAL("yield_radius_pa", RADIUS, 0, PW_HUGE, "0", "yield given as sqrt(2 J2); one of three"),
    REAL("yield_uniaxial_pa", UNIAXIAL, 0, PW_HUGE, "0",
         "yield given as the stress of a uniaxial test, sqrt(3 J2); one of three"),
    REAL("undrained_shear_strength_pa", SHEAR_STRENGTH, 0, PW_HUGE, "0",
         "yield given as the largest shear stress of simple shear, c_u = sqrt(J2); one of three"),
    REAL("hardening_modulus_pa", HARDENING, 0, PW_HUGE, "0",
         "slope of the uniaxial yield stress over plastic log strain"),
    REAL("yield_gradient_pa_m", YIELD_GRADIENT, 0, PW_HUGE, "0",
         "growth of the yield given, per metre below reference_y_m"),
    REAL("youngs_modulus_gradient_pa_m", YOUNG_GRADIENT, 0, PW_HUGE, "0",
         "growth of Young's modulus, per metre below reference_y_m"),
    REAL("reference_y_m", REFERENCE, -PW_HUGE, PW_HUGE, "0",
         "height at which the yield and Young's modulus given hold; above it too"),
    {NULL, PW_KEY_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

static const pw_state_def states[] = {
    {"plastic_strain", true}, /* sum of sqrt(2/3) |d e_p|: the uniaxial one; - */
    {"log_volume", false},    /* ln J, J the volume over that without stress; - */
    {"depth_m", false},       /* of the start, below reference_y_m; with gradients alone */
    {NULL, false},
};

static pw_status check(const pw_real *v)
{
  int given = (v[RADIUS] > 0.0) + (v[UNIAXIAL] > 0.0) + (v[SHEAR_STRENGTH] > 0.0);
  PW_REQUIRE(v[YOUNG] > 0.0 && v[DENSITY] > 0.0, PW_ERR_SCENE,
             "youngs_modulus_pa = %g and density_kg_m3 = %g must be positive", v[YOUNG],
             v[DENSITY]);
  PW_REQUIRE(v[POISSON] > -1.0 && v[POISSON] < 0.5, PW_ERR_SCENE,
             "poisson_ratio = %g must lie between -1 and 0.5", v[POISSON]);
  PW_REQUIRE(given == 1, PW_ERR_SCENE,
             "exactly one of yield_radius_pa, yield_uniaxial_pa, undrained_shear_strength_pa must "
             "be given and positive, not %d of them",
             given);
  PW_REQUIRE(v[HARDENING] >= 0.0 && v[YIELD_GRADIENT] >= 0.0 && v[YOUNG_GRADIENT] >= 0.0,
             PW_ERR_SCENE,
             "hardening_modulus_pa, yield_gradient_pa_m and youngs_modulus_gradient_pa_m must not "
             "be negative: %g, %g, %g",
             v[HARDENING], v[YIELD_GRADIENT], v[YOUNG_GRADIENT]);
  return PW_OK;
}

static bool graded(const pw_real *v)
{
  return v[YIELD_GRADIENT] > 0.0 || v[YOUNG_GRADIENT] > 0.0;
}

static int nstate(const pw_real *v)
{
  return graded(v) ? DEPTH + 1 : DEPTH;
}

static pw_real density(const pw_real *v)
{
  return v[DENSITY];
}

/** Moduli at the reference height and their growth with depth. */
typedef struct model {
  pw_real bulk, shear, radius, hardening; /* radius: sqrt(2 J2) at yield; hardening of it over the
                                             norm of the plastic strain */
  pw_real stiffer, stronger;              /* relative growth per metre */
  bool graded;
} model;

static model derive(const pw_real *v)
{
  pw_real radius = v[RADIUS] + sqrt(2.0 / 3.0) * v[UNIAXIAL] + sqrt(2.0) * v[SHEAR_STRENGTH];
  pw_real given = v[RADIUS] + v[UNIAXIAL] + v[SHEAR_STRENGTH];
  return (model){.bulk = v[YOUNG] / (3.0 * (1.0 - 2.0 * v[POISSON])),
                 .shear = 0.5 * v[YOUNG] / (1.0 + v[POISSON]),
                 .radius = radius,
                 .hardening = 2.0 / 3.0 * v[HARDENING],
                 .stiffer = v[YOUNG_GRADIENT] / v[YOUNG],
                 .stronger = v[YIELD_GRADIENT] / given,
                 .graded = graded(v)};
}

static void place(const pw_real *v, pw_idx n, pw_idx ld, const pw_real *y, pw_real *state)
{
  for (pw_idx i = 0; graded(v) && i < n; i++) {
    state[DEPTH * (size_t)ld + (size_t)i] = pw_max(v[REFERENCE] - y[i], 0.0);
  }
}

/** ln J of a given mean stress: K ln J = J sigma_m, by Newton's method from ln J = sigma_m/K. */
static pw_real log_volume(pw_real bulk, pw_real mean)
{
  pw_real x = 0.0, ratio = pw_min(mean / bulk, 0.3); /* 1/e is the largest there is */
  for (int i = 0; i < 50; i++) {
    pw_real e = ratio * exp(x), step = (x - e) / (1.0 - e);
    x -= step;
    if (fabs(step) <= 1e-16 * fabs(x)) {
      break;
    }
  }
  return x;
}

static void init(const pw_real *v, pw_idx n, pw_idx ld, const pw_real *stress, pw_real *state)
{
  const model m = derive(v);
  const size_t l = (size_t)ld;
  for (size_t i = 0; i < (size_t)n; i++) {
    pw_real depth = m.graded ? state[DEPTH * l + i] : 0.0;
    pw_real mean = pw_t6_trace(pw_t6_load(stress + i, l)) / 3.0;
    state[PLASTIC_STRAIN * l + i] = 0.0;
    state[LOG_VOLUME * l + i] = log_volume(m.bulk * (1.0 + m.stiffer * depth), mean);
  }
}

/** One point: what it starts from and what the return gives. */
typedef struct point {
  pw_real bulk, shear, radius; /* at its depth, with its hardening */
  pw_t6 strain;                /* trial elastic log strain */
  pw_t6 stress;
  pw_real plastic, log_j, keep; /* keep: length of dev tau over that of the trial */
  pw_real modulus;
} point;

/** Elastic left Cauchy-Green tensor moved by the increment in the plane. */
PW_INLINE pw_t6 push_plane(const pw_stress_args *a, bool exact, size_t p, pw_t6 b)
{
  const size_t l = (size_t)a->ldi;
  const pw_real *d = a->dstrain + p, *f = exact ? a->increment + p : d;
  pw_real w = a->spin[p];
  pw_real xx = exact ? f[0] : 1.0 + d[0], xy = exact ? f[l] : d[3 * l] + w;
  pw_real yx = exact ? f[3 * l] : d[3 * l] - w, yy = exact ? f[4 * l] : 1.0 + d[l];
  pw_real zz = exact ? f[8 * l] : 1.0 + d[2 * l];
  pw_real px = xx * b.xx + xy * b.xy, py = xx * b.xy + xy * b.yy; /* rows of f b */
  pw_real qx = yx * b.xx + yy * b.xy, qy = yx * b.xy + yy * b.yy;
  return (pw_t6){.xx = px * xx + py * xy,
                 .yy = qx * yx + qy * yy,
                 .zz = zz * b.zz * zz,
                 .xy = px * yx + py * yy};
}

static pw_t6 push(const pw_stress_args *a, size_t p, pw_t6 b)
{
  const size_t l = (size_t)a->ldi;
  const pw_real *d = a->dstrain + p, *w = a->spin + p, *f = a->increment;
  pw_rot r = {.xx = 1.0 + d[0],
              .xy = d[3 * l] + w[0],
              .xz = d[5 * l] - w[2 * l],
              .yx = d[3 * l] - w[0],
              .yy = 1.0 + d[l],
              .yz = d[4 * l] + w[l],
              .zx = d[5 * l] + w[2 * l],
              .zy = d[4 * l] - w[l],
              .zz = 1.0 + d[2 * l]};
  if (f) {
    f += p;
    r = (pw_rot){f[0], f[l], f[2 * l], f[3 * l], f[4 * l], f[5 * l], f[6 * l], f[7 * l], f[8 * l]};
  }
  return pw_t6_rotate(r, b); /* f b f^T whatever f is */
}

/** Moduli, yield and elastic strain of a point before the step. */
PW_INLINE point start_point(const model *m, const pw_stress_args *a, size_t p)
{
  const size_t l = (size_t)a->ld;
  /* without growth any row does: it is multiplied by zero, and the loop has no condition */
  pw_real depth = a->state[(m->graded ? DEPTH : PLASTIC_STRAIN) * l + p];
  pw_real stiffer = 1.0 + m->stiffer * depth;
  point t = {.bulk = m->bulk * stiffer,
             .shear = m->shear * stiffer,
             .plastic = a->state[PLASTIC_STRAIN * l + p],
             .log_j = a->state[LOG_VOLUME * l + p]};
  pw_t6 old = pw_t6_load(a->stress + p, l);
  pw_t6 dev = pw_t6_shift(old, -pw_t6_trace(old) * (1.0 / 3.0));
  pw_t6 shape = pw_t6_scale(0.5 * pw_exp(t.log_j) / t.shear, dev);
  t.strain = pw_t6_shift(shape, t.log_j * (1.0 / 3.0));
  t.radius = m->radius * (1.0 + m->stronger * depth) + m->hardening * sqrt(1.5) * t.plastic;
  return t;
}

/** Radial return from the trial strain; stress, state and a bound of the modulus. */
PW_INLINE void return_point(const model *m, point *t)
{
  pw_real log_j = pw_t6_trace(t->strain), size = pw_exp(-log_j);
  pw_t6 dev = pw_t6_scale(2.0 * t->shear, pw_t6_shift(t->strain, -log_j * (1.0 / 3.0)));
  pw_real norm = pw_t6_norm(dev), beyond = norm - t->radius;
  pw_real flow = beyond > 0.0 ? beyond / (2.0 * t->shear + m->hardening) : 0.0;
  t->keep = beyond > 0.0 ? (t->radius + m->hardening * flow) / norm : 1.0;
  t->plastic += sqrt(2.0 / 3.0) * flow;
  t->log_j = log_j;
  t->stress = pw_t6_scale(size, pw_t6_shift(pw_t6_scale(t->keep, dev), t->bulk * log_j));
  pw_real largest = fabs(t->bulk * log_j) + t->keep * norm;
  t->modulus = (t->bulk + 4.0 / 3.0 * t->shear + 2.0 * largest) * size;
}

/** Keep the result where it is a finite number; 1 then. */
PW_INLINE pw_real finish_point(const pw_stress_args *a, size_t p, const point *t)
{
  const size_t l = (size_t)a->ld;
  pw_real *plastic = a->state + PLASTIC_STRAIN * l + p, *log_j = a->state + LOG_VOLUME * l + p;
  pw_real good = pw_t6_is_finite(t->stress);
  pw_t6 old = pw_t6_load(a->stress + p, l);
  pw_t6_store(pw_t6_select(good, t->stress, old), a->stress + p, l);
  *plastic = good > 0.0 ? t->plastic : *plastic;
  *log_j = good > 0.0 ? t->log_j : *log_j;
  pw_real modulus = good > 0.0 ? t->modulus : t->bulk + 4.0 / 3.0 * t->shear;
  a->wave_speed[p] = sqrt(modulus / a->density[p]);
  return good;
}

PW_INLINE pw_real update_plane(const model *m, const pw_stress_args *a, bool exact, size_t p,
                               point *t)
{
  *t = start_point(m, a, p);
  t->strain = pw_t6_half_log_plane(push_plane(a, exact, p, pw_t6_exp_twice_plane(t->strain)));
  return_point(m, t);
  return finish_point(a, p, t);
}

/**
 * Column of d sigma for a further strain de. In the principal axes of the trial strain, with
 * x = e_i - e_j, d e_ij = x coth(x) de_ij; then the algorithmic tangent of the radial return.
 */
static pw_t6 tangent_column(const model *m, const point *t, const pw_spectrum *s, pw_t6 de)
{
  pw_rot axes = {s->vector[0], s->vector[1], s->vector[2], s->vector[3], s->vector[4],
                 s->vector[5], s->vector[6], s->vector[7], s->vector[8]};
  pw_rot back = {axes.xx, axes.yx, axes.zx, axes.xy, axes.yy, axes.zy, axes.xz, axes.yz, axes.zz};
  pw_real factor[3], tr = pw_t6_trace(de);
  for (int k = 0; k < 3; k++) { /* xy, yz, zx */
    pw_real x = s->value[k] - s->value[(k + 1) % 3], x2 = x * x;
    factor[k] = x2 < 1e-4 ? 1.0 + x2 * (1.0 / 3.0 - x2 / 45.0) : x / tanh(x);
  }
  pw_t6 d = pw_t6_rotate(axes, de);
  d.xy *= factor[0];
  d.yz *= factor[1];
  d.zx *= factor[2];
  d = pw_t6_rotate(back, d);
  pw_t6 dev = pw_t6_scale(2.0 * t->shear, pw_t6_shift(d, -tr / 3.0));
  pw_t6 out = pw_t6_shift(pw_t6_scale(t->keep, dev), t->bulk * tr);
  pw_t6 n = pw_t6_shift(t->strain, -pw_t6_trace(t->strain) / 3.0);
  pw_real norm = pw_t6_norm(n);
  if (t->keep < 1.0) {
    pw_real rest = m->hardening / (2.0 * t->shear + m->hardening) - t->keep;
    out = pw_t6_axpy(out, rest * pw_t6_dot(n, dev) / (norm * norm), n);
  }
  return pw_t6_axpy(pw_t6_scale(exp(-t->log_j), out), -tr, t->stress);
}

static void fill_tangent(const model *m, const point *t, const pw_stress_args *a, size_t p)
{
  pw_spectrum s = pw_t6_spectrum(t->strain);
  for (size_t col = 0; col < 6; col++) {
    pw_real unit[6] = {0}, rows[6];
    unit[col] = col < 3 ? 1.0 : 0.5; /* per engineering shear */
    pw_t6_store(tangent_column(m, t, &s, pw_t6_load(unit, 1)), rows, 1);
    for (size_t row = 0; row < 6; row++) {
      a->tangent[(6 * row + col) * (size_t)a->ldi + p] = rows[row];
    }
  }
}

static pw_real update_one(const model *m, const pw_stress_args *a, pw_idx i)
{
  const size_t p = (size_t)i;
  point t;
  pw_real good;
  if (pw_rate_is_plane(a, i, 1)) {
    good = update_plane(m, a, a->increment != NULL, p, &t);
  } else {
    t = start_point(m, a, p);
    t.strain = pw_t6_half_log(push(a, p, pw_t6_exp_twice(t.strain)));
    return_point(m, &t);
    good = finish_point(a, p, &t);
  }
  if (a->tangent) {
    fill_tangent(m, &t, a, p);
  }
  return good;
}

/** Advance @p n <= PW_CHUNK points from @p first on; the first failing one, or -1. */
static pw_idx update_chunk(const model *m, const pw_stress_args *a, pw_idx first, pw_idx n)
{
  const pw_stress_args arrays = *a;
  const model local = *m;
  pw_real good[PW_CHUNK], count = 0.0;
  if (!a->tangent && !a->increment && pw_rate_is_plane(a, first, n)) {
#pragma omp simd reduction(+ : count)
    for (pw_idx i = 0; i < n; i++) {
      point t;
      good[i] = update_plane(&local, &arrays, false, (size_t)(first + i), &t);
      count += good[i];
    }
  } else {
    for (pw_idx i = 0; i < n; i++) {
      good[i] = update_one(m, a, first + i);
      count += good[i];
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

extern const pw_material pw_material_hencky_von_mises;
const pw_material pw_material_hencky_von_mises = {
    .name = "hencky_von_mises",
    .brief = "Hencky elasticity with von Mises plasticity (Simo 1992), linear hardening, strength "
             "and stiffness that may grow with depth",
    .keys = keys,
    .states = states,
    .of_f = true,
    .symmetric = true,
    .takes_initial_stress = true,
    .check = check,
    .nstate = nstate,
    .density = density,
    .place = place,
    .init = init,
    .update = update,
};
