/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/domain_sites.h
 * @brief Corners and edges' middles of a CPDI domain: place, motion, mass, share of the surface
 *        (layer 3).
 *
 * A site of a domain is a place (s, t) of it at x_p + s r1 + t r2: sites 0 to 3 are the corners
 * (-1,-1), (1,-1), (1,1), (-1,1), sites 4 to 7 the middles of the edges that begin there. The
 * engine moves x_p with the mean of the four corner velocities u_c and r1, r2 with the velocity
 * gradient of kernels/transfer_cpdi.inc, so a site moves with sum_c w_c u_c,
 *
 *   w_c = (1 + s s_c + t t_c + s_c t_c (s a2 + t a1)) / 4,   a1 = r1x / (3 r_p), a2 = r2x / (3 r_p)
 *
 * (plane strain: a1 = a2 = 0; at a corner the weights 3/4, 1/4, 1/4, -1/4 of a fit of an affine
 * field). A force on the site is handed to the four corners' grid nodes with the same weights:
 * then force times motion is the work of the grid's nodes.
 */
#ifndef PW_ENGINE_DOMAIN_SITES_H
#define PW_ENGINE_DOMAIN_SITES_H

#include "engine/core/key.h"
#include "engine/nodes.h"
#include "engine/points.h"

#include <math.h>

enum { PW_SITES = 8 };

static const pw_real pw_site_s[PW_SITES] = {-1.0, 1.0, 1.0, -1.0, 0.0, 1.0, 0.0, -1.0};
static const pw_real pw_site_t[PW_SITES] = {-1.0, -1.0, 1.0, 1.0, -1.0, 0.0, 1.0, 0.0};

/** A domain. */
typedef struct pw_domain_now {
  pw_idx point;
  pw_real x[2];   /**< centre; m */
  pw_real r[4];   /**< half-sides r1x, r1y, r2x, r2y; m */
  pw_real a1, a2; /**< of axisymmetry: see above; - */
  bool axi;
} pw_domain_now;

static inline pw_domain_now pw_domain_of(const pw_points *p, pw_idx i, bool axi)
{
  const pw_idx ld = p->ld;
  pw_domain_now d = {.point = i,
                     .x = {p->x[i], p->x[ld + i]},
                     .r = {p->half[i], p->half[ld + i], p->half[2 * ld + i], p->half[3 * ld + i]},
                     .axi = axi};
  d.a1 = axi ? d.r[0] / (3.0 * d.x[0]) : 0.0;
  d.a2 = axi ? d.r[2] / (3.0 * d.x[0]) : 0.0;
  return d;
}

/** @brief Position of site @p c; one that has turned across the axis counts as on it.
 *  @param[out] x [2] m */
static inline void pw_site_place(const pw_domain_now *d, int c, pw_real *x)
{
  x[0] = d->x[0] + pw_site_s[c] * d->r[0] + pw_site_t[c] * d->r[2];
  x[0] = d->axi ? pw_max(x[0], 0.0) : x[0];
  x[1] = d->x[1] + pw_site_s[c] * d->r[1] + pw_site_t[c] * d->r[3];
}

/** @brief Shares of the four corners' velocities in the motion of site @p c. */
static inline void pw_site_weights(const pw_domain_now *d, int c, pw_real *w)
{
  const pw_real s = pw_site_s[c], t = pw_site_t[c], twist = s * d->a2 + t * d->a1;
  for (int k = 0; k < 4; k++) {
    pw_real sk = pw_site_s[k], tk = pw_site_t[k];
    w[k] = 0.25 * (1.0 + s * sk + t * tk + sk * tk * twist);
  }
}

/**
 * @brief 1 / mass with which site @p c answers to a force, from above; 1/kg.
 *
 * The grid's lumped kinetic energy is at least that of the masses f_k m_p at the domains' corners,
 * with their velocities interpolated (Jensen), whatever the grid and the neighbours.
 */
static inline pw_real pw_site_inverse_mass(const pw_domain_now *d, int c, pw_real mass)
{
  pw_real w[4], sum = 0.0;
  pw_site_weights(d, c, w);
  for (int k = 0; k < 4; k++) {
    pw_real f = 0.25 * (1.0 + pw_site_s[k] * d->a1 + pw_site_t[k] * d->a2);
    /* A domain that has turned far across the axis has corners without mass: no bound. */
    sum += f > 0.0 ? w[k] * w[k] / (f * mass) : PW_HUGE;
  }
  return sum;
}

/**
 * @brief Area of the surface of normal @p n that belongs to site @p c; m2 per metre or radian.
 *
 * Along an edge the sites have the shares of piecewise linear functions (a quarter, a half, a
 * quarter of its length); in axisymmetry the integrals of these times r. Of a corner's two edges
 * the one along the surface counts; of two equally oblique ones the mean.
 */
static inline pw_real pw_site_area(const pw_domain_now *d, int c, const pw_real *n)
{
  const pw_real s = pw_site_s[c], t = pw_site_t[c];
  pw_real l1 = fabs(d->r[1] * n[0] - d->r[0] * n[1]), l2 = fabs(d->r[3] * n[0] - d->r[2] * n[1]);
  pw_real h1 = d->r[0] * n[0] + d->r[1] * n[1], h2 = d->r[2] * n[0] + d->r[3] * n[1];
  pw_real w1 = h2 * h2, w2 = h1 * h1;
  if (d->axi) { /* radius at the middle of the edge along r1, of that along r2 */
    pw_real e1 = d->x[0] + t * d->r[2], e2 = d->x[0] + s * d->r[0];
    l1 *= pw_max(2.0 * (e1 + s * d->r[0]) + e1, 0.0) / 3.0;
    l2 *= pw_max(2.0 * (e2 + t * d->r[2]) + e2, 0.0) / 3.0;
  }
  if (c >= 4) {
    return t != 0.0 ? l1 : l2;
  }
  return 0.5 * (w1 * l1 + w2 * l2) / (w1 + w2);
}

/** @brief Half the edge of the square of the area of a domain's material (the domain itself may be
 *  limited, and flatter); m. */
static inline pw_real pw_domain_half_size(const pw_points *p, const pw_domain_now *d)
{
  return 0.5 * sqrt(p->vol[d->point] / (d->axi ? d->x[0] : 1.0));
}

/** The four grid nodes of a corner of point @p i: first record and weights. */
typedef struct pw_corner_nodes {
  pw_off record; /**< of the lower left node, in reals */
  pw_real n[4];  /**< lower left, lower right, upper left, upper right */
} pw_corner_nodes;

static inline pw_corner_nodes pw_corner_grid(const pw_points *p, pw_idx i, int c)
{
  pw_real a = p->local[c * p->ld + i], b = p->local[(4 + c) * p->ld + i];
  return (pw_corner_nodes){(pw_off)p->corner[c * p->ld + i] * PW_NODE,
                           {(1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b}};
}

/** @brief Add the force @p f [2] on site @p c to slot FORCE of the records.
 *  @param[in] row nodes of the grid along x */
static inline void pw_site_scatter(const pw_points *p, const pw_domain_now *d, int c, pw_idx row,
                                   const pw_real *f, pw_real *rec)
{
  pw_real w[4];
  pw_site_weights(d, c, w);
  for (int k = 0; k < 4; k++) {
    pw_corner_nodes g = pw_corner_grid(p, d->point, k);
    for (int j = 0; j < 4; j++) {
      pw_real *r = rec + g.record + ((j & 1) + (pw_off)(j >> 1) * row) * PW_NODE + PW_NODE_FORCE;
      r[0] += w[k] * g.n[j] * f[0];
      r[1] += w[k] * g.n[j] * f[1];
    }
  }
}

/** @brief Velocity of site @p c from nodal momentum and mass.
 *  @param[in]  cut_off nodes with less mass are at rest; kg
 *  @param[out] v       [2] m/s */
static inline void pw_site_velocity(const pw_points *p, const pw_domain_now *d, int c, pw_idx row,
                                    pw_real cut_off, const pw_real *rec, pw_real *v)
{
  pw_real w[4];
  pw_site_weights(d, c, w);
  v[0] = v[1] = 0.0;
  for (int k = 0; k < 4; k++) {
    pw_corner_nodes g = pw_corner_grid(p, d->point, k);
    for (int j = 0; j < 4; j++) {
      const pw_real *r = rec + g.record + ((j & 1) + (pw_off)(j >> 1) * row) * PW_NODE;
      pw_real share = r[PW_NODE_MASS] > cut_off ? w[k] * g.n[j] / r[PW_NODE_MASS] : 0.0;
      v[0] += share * r[PW_NODE_VEL];
      v[1] += share * r[PW_NODE_VEL + 1];
    }
  }
}

#endif /* PW_ENGINE_DOMAIN_SITES_H */
