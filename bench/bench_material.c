/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cost of one stress update of each material model, in batches of PW_CHUNK points, at strain
 * increments of 1e-6, 1e-5 and 1e-4: median and least of repeats on one thread, in its CPU time (other
 * programs disturb it less).
 *
 * Every increment has a random direction of plane strain that turns slowly, as under a wave, and
 * the mean strain is steered back, so that the points stay within their range of pressures.
 */
#include "kernels/hypoplastic_clay.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { POINTS = 2048, REPEATS = 9, STEPS = 20 };

/* ROW is no power of two: rows of a point would fall into the same sets of the cache. */
enum { ROW = POINTS + 24 };

typedef struct arrays {
  pw_real stress[6][ROW], state[PW_MAX_STATE][ROW];
  pw_real dstrain[6][ROW], spin[3][ROW], dvol[ROW], jac[ROW];
  pw_real left_cg[6][ROW], density[ROW], speed[ROW];
  pw_real strain[6][ROW], heading[2][ROW];
} arrays;

static arrays w;

static double seconds(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double uniform(void)
{
  static uint64_t s = 88172645463325252u;
  s ^= s << 13;
  s ^= s >> 7;
  s ^= s << 17;
  return (double)(s >> 11) * 0x1p-53;
}

/** The defaults of the model's keys, and the values of a common case where there is none. */
static void parameters(const pw_material *m, bool intergranular, pw_real *v)
{
  const bool clay = strcmp(m->name, "hypoplastic_clay") == 0;
  const struct {
    const char *name;
    double value;
  } given[] = {{"youngs_modulus_pa", 1e7},
               {"yield_uniaxial_pa", 5e4},
               {"undrained_shear_strength_pa", strcmp(m->name, "tresca") == 0 ? 3e4 : 0.0},
               {"rigidity_index", 200},
               {"friction_angle_deg", 30},
               {"cohesion_pa", 1e3},
               {"compression_index_lambda", 0.2},
               {"swelling_index_kappa", 0.04},
               {"critical_stress_ratio", 1.0},
               {"overconsolidation_ratio", 1.0},
               {"compression_index_lambda_star", 0.11},
               {"swelling_index_kappa_star", 0.016},
               {"virgin_line_n", 1.375},
               {"stiffness_ratio_r", 0.4},
               {"poisson_ratio", 0.3},
               {"density_kg_m3", 1800},
               {"bulk_modulus_pa", 1e7},
               {"shear_modulus_pa", 5e6},
               {"grain_density_kg_m3", 2600},
               {"void_ratio", clay ? 0.0 : 0.65},
               {"critical_friction_angle_deg", 30},
               {"cohesion_shift_pa", 1600},
               {"granular_hardness_pa", 5.8e9},
               {"exponent_n", 0.28},
               {"void_ratio_d0", 0.53},
               {"void_ratio_c0", 0.84},
               {"void_ratio_i0", 1.0},
               {"exponent_alpha", 0.13},
               {"exponent_beta", 1.0},
               {"intergranular_strain", intergranular ? 1.0 : 0.0}};
  for (const pw_key *k = m->keys; k->name; k++) {
    double value = k->fallback ? strtod(k->fallback, NULL) : 0.0;
    for (size_t i = 0; i < sizeof given / sizeof given[0]; i++) {
      value = strcmp(given[i].name, k->name) == 0 ? given[i].value : value;
    }
    v[k->offset / sizeof(pw_real)] = value;
  }
  if (m->check(v) != PW_OK) {
    fprintf(stderr, "%s: %s\n", m->name, pw_error_text());
    exit(1);
  }
}

static void start(const pw_material *m, const pw_real *v)
{
  memset(&w, 0, sizeof w);
  for (int i = 0; i < POINTS; i++) {
    double p = 2e4 * pow(10.0, uniform());
    w.stress[0][i] = w.stress[2][i] = -p * (0.6 + 0.2 * uniform());
    w.stress[1][i] = -p;
    w.heading[0][i] = 6.2831853 * uniform();
    w.heading[1][i] = 0.2 * (uniform() - 0.5);
  }
  m->init(v, POINTS, ROW, w.stress[0], w.state[0]);
}

/** Increments of a step: a turning direction plus a pull back to zero strain. */
static void increments(double size)
{
  for (int p = 0; p < POINTS; p++) {
    double angle = w.heading[0][p] += w.heading[1][p], pull = 0.02;
    w.dstrain[0][p] = size * 0.7 * cos(angle) - pull * w.strain[0][p];
    w.dstrain[1][p] = -size * 0.6 * cos(angle + 0.3) - pull * w.strain[1][p];
    w.dstrain[3][p] = size * 0.4 * sin(angle) - pull * w.strain[3][p];
    w.spin[0][p] = 0.3 * size;
    for (int c = 0; c < 6; c++) {
      w.strain[c][p] += w.dstrain[c][p];
      w.left_cg[c][p] = (c < 3 ? 1.0 : 0.0) + 2.0 * w.strain[c][p];
    }
    w.dvol[p] = 1.0 + w.dstrain[0][p] + w.dstrain[1][p];
    w.jac[p] = 1.0 + w.strain[0][p] + w.strain[1][p];
    w.density[p] = 1600.0;
  }
}

/** One point after the other, without vector registers: what the batch forms are held against. */
static void one_by_one(const pw_material *m, const pw_real *v, pw_stress_args *a)
{
  pw_hypo_point at;
  if (strcmp(m->name, "hypoplastic_sand") == 0) {
    pw_hypo h;
    pw_hypo_derive(v, &h);
    const bool plane = pw_spin_is_plane(a->spin, ROW, a->n);
    for (pw_idx i = 0; i < a->n; i++) {
      pw_real modulus = 0.0;
      at = pw_hypo_read(&h, a, plane, i);
      (void)pw_hypo_integrate(&h, pw_t6_load(a->dstrain + i, ROW), a->dvol[i], &at, NULL, a->counts,
                              &modulus);
      pw_hypo_write(&h, a, &at, i);
      a->wave_speed[i] = sqrt(modulus / a->density[i]);
    }
    return;
  }
  pw_clay c;
  pw_clay_derive(v, &c);
  for (pw_idx i = 0; i < a->n; i++) {
    at = pw_hypo_read(&c.limits, a, true, i);
    (void)pw_clay_integrate(&c, pw_t6_load(a->dstrain + i, ROW), a->dvol[i], &at, NULL, a->counts);
    pw_hypo_write(&c.limits, a, &at, i);
    a->wave_speed[i] = sqrt(pw_clay_evaluate(&c, &at, (pw_t6){0}).modulus / a->density[i]);
  }
}

/** CPU seconds of an update, mean of STEPS steps of all points. */
static double repeat(const pw_material *m, const pw_real *v, double size, bool single,
                     pw_material_counts *n)
{
  double spent = 0.0;
  for (int step = 0; step < STEPS; step++) {
    increments(size);
    double t = seconds();
    for (int p = 0; p < POINTS; p += PW_CHUNK) {
      pw_stress_args a = {.n = PW_CHUNK,
                          .ld = ROW,
                          .ldi = ROW,
                          .dt = 1e-5,
                          .dstrain = w.dstrain[0] + p,
                          .spin = w.spin[0] + p,
                          .dvol = w.dvol + p,
                          .left_cg = w.left_cg[0] + p,
                          .jac = w.jac + p,
                          .density = w.density + p,
                          .stress = w.stress[0] + p,
                          .state = w.state[0] + p,
                          .wave_speed = w.speed + p,
                          .counts = n};
      if (single) {
        one_by_one(m, v, &a);
      } else {
        (void)m->update(v, &a);
      }
    }
    spent += seconds() - t;
  }
  return spent / ((double)STEPS * POINTS);
}

static int ascending(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void measure(const pw_material *m, const char *label, const pw_real *v, bool single)
{
  const double sizes[] = {1e-6, 1e-5, 1e-4};
  for (int k = 0; k < 3; k++) {
    double t[REPEATS];
    pw_material_counts n = {0};
    start(m, v);
    (void)repeat(m, v, sizes[k], single, NULL);
    for (int r = 0; r < REPEATS; r++) {
      t[r] = repeat(m, v, sizes[k], single, &n);
    }
    qsort(t, REPEATS, sizeof t[0], ascending);
    double updates = (double)REPEATS * STEPS * POINTS, middle = t[REPEATS / 2];
    printf("%-38s %7.0e %9.1f %9.1f %9.2f %9.2f %9.2f\n", label, sizes[k], 1e9 * middle, 1e9 * t[0],
           1e-6 / middle, (double)n.substeps / updates, (double)n.rhs / updates);
  }
}

int main(void)
{
  printf("%-38s %7s %9s %9s %9s %9s %9s\n", "model", "|dE|", "ns", "least", "M/s", "substeps",
         "rhs");
  for (int i = 0; pw_material_at(i); i++) {
    const pw_material *m = pw_material_at(i);
    pw_real v[PW_MAX_PARAMS] = {0};
    bool sand = strcmp(m->name, "hypoplastic_sand") == 0;
    if (m->needs_library) {
      continue; /* the time is that of the user's routine */
    }
    parameters(m, true, v);
    measure(m, sand ? "hypoplastic_sand, intergranular strain" : m->name, v, false);
    if (sand || strcmp(m->name, "hypoplastic_clay") == 0) {
      measure(m, "    the same, one by one", v, true);
    }
    if (sand) {
      parameters(m, false, v);
      measure(m, "hypoplastic_sand, without", v, false);
      measure(m, "    the same, one by one", v, true);
    }
  }
  return 0;
}
