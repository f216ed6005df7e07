/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/wall_reference.h
 * @brief Thick cylinders in plane strain and thick spheres by line elements along the radius: an
 *        independent solution for a wall of von Mises material, at small or at large strain.
 *
 * Nothing of the engine is used. Directions of stress stay, so that Hencky's strains add: with the
 * stretches x', x/R and 1 (or x/R again) their logarithms are the strains of the radial return, which
 * gives Kirchhoff's stresses; at small strain u', u/R and 0 take their place. Balance is the virtual
 * work of linear elements with one point each, which do not lock: their error is of order 1/n^2.
 */
#ifndef PW_TESTS_WALL_REFERENCE_H
#define PW_TESTS_WALL_REFERENCE_H

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { WALL_LINES = 400 };

typedef struct wall_line {
  bool sphere, large;
  int n; /* elements, at most WALL_LINES */
  double inner, outer, young, poisson, yield;
  double u[WALL_LINES + 1];       /* m */
  double plastic[WALL_LINES][3];  /* at the start of the step */
  double next[WALL_LINES][3];     /* at the end of it */
  double force[WALL_LINES + 1];   /* N per radian and metre, or per steradian */
  double band[3][WALL_LINES + 1]; /* tangent: below, on and above the diagonal */
} wall_line;

static inline double wall_line_radius(const wall_line *w, int i)
{
  return w->inner + (w->outer - w->inner) * i / w->n;
}

/** Stress [3] (radial, round, third) of a strain [3], its derivatives, the plastic strain then. */
static inline void wall_line_return(const wall_line *w, const double *strain, const double *plastic,
                                    double *stress, double (*tangent)[3], double *next)
{
  const double shear = 0.5 * w->young / (1.0 + w->poisson);
  const double bulk = w->young / (3.0 * (1.0 - 2.0 * w->poisson));
  const double limit = sqrt(2.0 / 3.0) * w->yield;
  double volume = 0.0, dev[3], norm = 0.0;
  for (int k = 0; k < 3; k++) {
    volume += strain[k] - plastic[k];
  }
  for (int k = 0; k < 3; k++) {
    dev[k] = 2.0 * shear * (strain[k] - plastic[k] - volume / 3.0);
    norm += dev[k] * dev[k];
  }
  norm = sqrt(norm);
  const double keep = norm > limit ? limit / norm : 1.0;
  for (int k = 0; k < 3; k++) {
    stress[k] = bulk * volume + keep * dev[k];
    next[k] = plastic[k] + (1.0 - keep) * dev[k] / (2.0 * shear);
    for (int l = 0; l < 3; l++) {
      tangent[k][l] = bulk + 2.0 * shear * keep * ((k == l) - 1.0 / 3.0);
      tangent[k][l] -= keep < 1.0 ? 2.0 * shear * keep * dev[k] * dev[l] / (norm * norm) : 0.0;
    }
  }
}

/** Strains of element i and their derivatives by its two displacements. */
static inline void wall_line_strain(const wall_line *w, int i, double *strain, double (*by)[2])
{
  const double r[2] = {wall_line_radius(w, i), wall_line_radius(w, i + 1)};
  const double length = r[1] - r[0], middle = 0.5 * (r[0] + r[1]);
  const double slope = (w->u[i + 1] - w->u[i]) / length;
  const double round = 0.5 * (w->u[i] + w->u[i + 1]) / middle;
  const double scale[2] = {w->large ? 1.0 / (1.0 + slope) : 1.0,
                           w->large ? 1.0 / (1.0 + round) : 1.0};
  strain[0] = w->large ? log1p(slope) : slope;
  strain[1] = w->large ? log1p(round) : round;
  strain[2] = w->sphere ? strain[1] : 0.0;
  for (int a = 0; a < 2; a++) {
    by[0][a] = (a == 0 ? -1.0 : 1.0) / length * scale[0];
    by[1][a] = 0.5 / middle * scale[1];
    by[2][a] = w->sphere ? by[1][a] : 0.0;
  }
}

static inline void wall_line_add(wall_line *w, int i)
{
  double strain[3], by[3][2], stress[3], c[3][3];
  const double r[2] = {wall_line_radius(w, i), wall_line_radius(w, i + 1)};
  const double middle = 0.5 * (r[0] + r[1]);
  const double weight = (w->sphere ? middle * middle : middle) * (r[1] - r[0]);
  wall_line_strain(w, i, strain, by);
  wall_line_return(w, strain, w->plastic[i], stress, c, w->next[i]);
  for (int a = 0; a < 2; a++) {
    for (int k = 0; k < 3; k++) {
      w->force[i + a] += weight * stress[k] * by[k][a];
      for (int b = 0; b < 2; b++) {
        double sum = 0.0;
        for (int l = 0; l < 3; l++) {
          sum += c[k][l] * by[l][b];
        }
        sum -= w->large ? stress[k] * by[k][b] : 0.0; /* of the logarithm's slope */
        w->band[1 + b - a][i + a] += weight * by[k][a] * sum;
      }
    }
  }
}

/** Correct the free displacements; the largest correction. */
static inline double wall_line_correct(wall_line *w)
{
  double most = 0.0, pivot = w->band[1][1], above[WALL_LINES + 1], right[WALL_LINES + 1];
  for (int i = 1; i <= w->n; i++) { /* node 0 is prescribed */
    const double below = i > 1 ? w->band[0][i] : 0.0;
    pivot = w->band[1][i] - (i > 1 ? below * above[i - 1] : 0.0);
    above[i] = w->band[2][i] / pivot;
    right[i] = (-w->force[i] - (i > 1 ? below * right[i - 1] : 0.0)) / pivot;
  }
  for (int i = w->n; i >= 1; i--) {
    right[i] -= i < w->n ? above[i] * right[i + 1] : 0.0;
    w->u[i] += right[i];
    most = fmax(most, fabs(right[i]));
  }
  return most;
}

/** Move the bore to the displacement @p to. @return whether balance was found */
static inline bool wall_line_step(wall_line *w, double to)
{
  const double first = to - w->u[0];
  for (int i = 0; i <= w->n; i++) { /* first guess */
    w->u[i] += first * w->inner / wall_line_radius(w, i);
  }
  w->u[0] = to;
  for (int k = 0; k < 50; k++) {
    memset(w->force, 0, sizeof w->force);
    memset(w->band, 0, sizeof w->band);
    for (int i = 0; i < w->n; i++) {
      wall_line_add(w, i);
    }
    if (wall_line_correct(w) < 1e-13 * w->inner) {
      memcpy(w->plastic, w->next, sizeof w->plastic);
      return true;
    }
  }
  return false;
}

/** Pressure in the bore, on its radius now at large strain; Pa. */
static inline double wall_line_pressure(const wall_line *w)
{
  const double radius = w->inner + (w->large ? w->u[0] : 0.0);
  return w->force[0] / (w->sphere ? radius * radius : radius);
}

#endif /* PW_TESTS_WALL_REFERENCE_H */
