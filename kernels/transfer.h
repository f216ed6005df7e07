/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/transfer.h
 * @brief Point-grid transfer kernels, specialised for each geometry and basis (layer 1).
 *
 * Each row of kernels/instances.def compiles kernels/transfer_cpdi.inc or transfer_tensor.inc once
 * with literal sizes.
 * A vertex is where a basis samples the grid's shape functions: the four corners of a CPDI domain
 * (Sadeghirad, Brannon, Burghardt 2011, with the r-weighted corner weights of axisymmetry), or the
 * point itself (linear MPM, uGIMP). All kernels work on a contiguous range of points of one body;
 * scatters touch only nodes within `reach` cells of the points' home elements, so that blocks of
 * one colour may scatter at the same time.
 */
#ifndef PW_KERNELS_TRANSFER_H
#define PW_KERNELS_TRANSFER_H

#include "engine/core/types.h"
#include "kernels/grid_axis.h"

/** The grid and point arrays a kernel works on; everything borrowed. Layouts: engine/points.h,
 *  engine/nodes.h. */
typedef struct pw_transfer {
  pw_real origin[2]; /**< lower left corner of the grid; m */
  pw_real cell;      /**< of a uniform grid; m */
  pw_idx cells[2];
  const pw_grid_axis *axis;  /**< [2] of a graded grid; NULL: uniform */
  pw_idx row;                /**< nodes along x: node above node k is k + row */
  pw_idx reach;              /**< cells from the home element within which vertices may lie */
  pw_idx ld;                 /**< leading dimension of the point arrays */
  pw_real *x, *v;            /**< [2][ld] */
  const pw_real *mass, *vol; /**< [ld] */
  const pw_real *stress;     /**< [6][ld] */
  const pw_real *half;       /**< [4][ld] half-side vectors; NULL for the linear basis */
  const pw_idx *home;        /**< [ld] */
  pw_idx *corner;            /**< [vertices][ld] first node of each vertex' element */
  pw_real *local;            /**< [2 vertices][ld] local coordinates, xi of all, then eta */
} pw_transfer;

/** What pw_kernels.weights finds in a range; indices are points, -1 = none. */
typedef struct pw_weights_report {
  pw_idx lost;     /**< first point whose centre is outside the grid or not finite */
  pw_idx overrun;  /**< first point with a vertex beyond `reach`: sort before scattering */
  pw_idx inverted; /**< first point whose domain has no positive area */
  pw_off clamped;  /**< vertices outside the grid, moved to its edge */
} pw_weights_report;

/** Gathered increments of a batch: displacement gradient over the step, [5][PW_CHUNK]:
 *  du_x/dx, du_x/dy, du_y/dx, du_y/dy, hoop u_r/r (0 in plane strain). */
typedef struct pw_gradients {
  pw_real du[5][PW_CHUNK];
} pw_gradients;

/** First and last of the three slots of p2g_extent. */
enum { PW_SURFACE_EXTENT = 5, PW_SURFACE_ASKS = PW_SURFACE_EXTENT + 2 };

enum { PW_SUPPORT = 16 }; /**< nodes of a point, at most */

/** Nodes of one point, each once, and its weights there. In axisymmetry the hoop strain is
 *  sum move_i u_i / r_p. */
typedef struct pw_support {
  int n;
  pw_idx node[PW_SUPPORT];
  pw_real s[PW_SUPPORT];                  /**< mean shape function, as masses are scattered */
  pw_real gx[PW_SUPPORT], gy[PW_SUPPORT]; /**< gradients, as forces are; 1/m */
  pw_real move[PW_SUPPORT];               /**< what moves the point */
} pw_support;

/** One row of the list. @p rec are the records of one velocity field. */
typedef struct pw_kernels {
  const char *name; /**< "axi_cpdi_quad4" */
  int geometry;     /**< pw_geometry */
  int basis;        /**< pw_basis */
  int vertices;
  /** Locate the vertices of points [first, last) in the grid; always finishes. */
  void (*weights)(const pw_transfer *t, pw_idx first, pw_idx last, pw_weights_report *report);
  /** Scatter mass, momentum and minus the internal force. */
  void (*p2g)(const pw_transfer *t, pw_real *rec, pw_idx first, pw_idx last);
  /** Scatter mass and momentum only (USF). */
  void (*p2g_momentum)(const pw_transfer *t, pw_real *rec, pw_idx first, pw_idx last);
  /** Scatter minus the internal force only (USF). */
  void (*p2g_force)(const pw_transfer *t, pw_real *rec, pw_idx first, pw_idx last);
  /** Gather velocity increments (slot FORCE): v += sum S_ip dv_i. */
  void (*g2p_velocity)(const pw_transfer *t, const pw_real *rec, pw_idx first, pw_idx last);
  /** Move velocities by the fraction @p pic towards the grid's (slot VEL): v += pic (sum S_ip v_i
   *  - v). Returns the kinetic energy that this takes out; J. */
  pw_real (*g2p_settle)(const pw_transfer *t, const pw_real *rec, pw_real pic, pw_idx first,
                        pw_idx last);
  /** Scatter the momentum of the updated points into slot REMAP (MUSL). */
  void (*p2g_remap)(const pw_transfer *t, pw_real *rec, pw_idx first, pw_idx last);
  /** Gather dt times the gradient of the velocity in slot @p slot for points [first, last), at
   *  most PW_CHUNK; when @p move, also x += dt times the domain's mean velocity. */
  void (*g2p_gradient)(const pw_transfer *t, const pw_real *rec, int slot, pw_real dt, bool move,
                       pw_idx first, pw_idx last, pw_gradients *out);
  /** Scatter what a surface normal and traction follow from, into @p surface [nnode][PW_NODE]:
   *  slots 0, 1: sum_p V_p (grad S_ip + hoop term) = the integral of N_i n over the body's
   *  surface, the outward normal times area (m2, per radian or metre); slots 2, 3, 4:
   *  sum_p V_p S_ip sigma_p (xx, yy, xy; J); slot 5: sum_p V_p S_ip (m3). */
  void (*p2g_surface)(const pw_transfer *t, pw_real *surface, pw_idx first, pw_idx last);
  /** How far a body reaches, at the nodes where slot PW_SURFACE_ASKS is below PW_HUGE, along three
   *  directions n: those in slots 0, 1 and 2, 3 of @p surface
   *  [nnode][PW_NODE], and slot 4 times their sum. Raise the three slots from PW_SURFACE_EXTENT on to
   *  the largest (x - origin) . n, m, over all places x of domains with a weight at the node; of CPDI
   *  domains only those in the node's cells. Points of the linear basis stand for squares of their
   *  area. */
  void (*p2g_extent)(const pw_transfer *t, pw_real *surface, pw_idx first, pw_idx last);
  /** Nodes and weights of point @p i, for systems of equations. Nodes without any weight are left
   *  out. */
  void (*support)(const pw_transfer *t, pw_idx i, pw_support *out);
} pw_kernels;

/** @brief The row for a geometry and basis (pw_geometry, pw_basis), or NULL. */
const pw_kernels *pw_kernels_find(int geometry, int basis);

/** @brief The row for a graded grid (pw_transfer.axis is set): where it differs, its kernels look
 *  up the sizes of cells. NULL for uGIMP, whose means over a domain need equal cells. */
const pw_kernels *pw_kernels_find_graded(int geometry, int basis);

/** @brief The @p i-th row, or NULL past the end. */
const pw_kernels *pw_kernels_at(int i);

#endif /* PW_KERNELS_TRANSFER_H */
