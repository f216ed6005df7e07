/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Basis-function checks of every row of kernels/instances.def: partition of unity, linear
 * completeness, gradients, corner weights, axisymmetry (verification A0, A8 a-c; derivations in
 * kernels/transfer_cpdi.inc). */
#include "tests/harness.h"

#include <float.h>

#include "kernels/transfer.h"

enum { NX = 8, NY = 7, ROW = NX + 1, NNODE = ROW * (NY + 1), LD = 64, NODE = 8, AXI = 1, CPDI = 2 };

typedef struct {
  pw_real x[2 * LD], v[2 * LD], mass[LD], vol[LD], stress[6 * LD], half[4 * LD];
  pw_idx home[LD], corner[4 * LD];
  pw_real local[8 * LD], rec[NNODE * NODE];
  pw_transfer t;
} world;

static const pw_real cell = 0.5;

static void world_init(world *w, pw_real origin_x)
{
  memset(w, 0, sizeof *w);
  w->t = (pw_transfer){.origin = {origin_x, -1.0},
                       .cell = cell,
                       .cells = {NX, NY},
                       .row = ROW,
                       .reach = 3,
                       .ld = LD,
                       .x = w->x,
                       .v = w->v,
                       .mass = w->mass,
                       .vol = w->vol,
                       .stress = w->stress,
                       .half = w->half,
                       .home = w->home,
                       .corner = w->corner,
                       .local = w->local};
}

/* Random parallelograms well inside the grid. */
static void random_points(world *w, const pw_kernels *k, uint64_t seed)
{
  for (pw_idx i = 0; i < LD; i++) {
    pw_real gx = 1.5 + (NX - 3) * test_random(&seed), gy = 1.5 + (NY - 3) * test_random(&seed);
    w->x[i] = w->t.origin[0] + cell * gx;
    w->x[LD + i] = w->t.origin[1] + cell * gy;
    w->home[i] = (pw_idx)gy * NX + (pw_idx)gx;
    w->mass[i] = 0.5 + test_random(&seed);
    w->vol[i] = 0.5 + test_random(&seed);
    for (int c = 0; c < 6; c++) {
      w->stress[c * LD + i] = test_random(&seed) - 0.5;
    }
    bool sheared = k->basis == CPDI;
    w->half[i] = cell * (0.2 + 0.3 * test_random(&seed));
    w->half[LD + i] = sheared ? cell * 0.1 * test_random(&seed) : 0.0;
    w->half[2 * LD + i] = sheared ? -cell * 0.1 * test_random(&seed) : 0.0;
    w->half[3 * LD + i] = cell * (0.2 + 0.3 * test_random(&seed));
  }
}

static pw_real node_x(const world *w, int k)
{
  return w->t.origin[0] + cell * (k % ROW);
}
static pw_real node_y(const world *w, int k)
{
  return w->t.origin[1] + cell * (k / ROW);
}

static void weights(world *w, const pw_kernels *k)
{
  pw_weights_report r;
  k->weights(&w->t, 0, LD, &r);
  assert_int_equal(r.lost, -1);
  assert_int_equal(r.overrun, -1);
  assert_int_equal(r.inverted, -1);
  assert_int_equal(r.clamped, 0);
}

/* Linear nodal velocities give their exact gradient, and move each point with the field's value
 * at its centre. */
static void linear_field_has_exact_gradient(void **state)
{
  (void)state;
  static world w;
  for (int row = 0; pw_kernels_at(row); row++) {
    const pw_kernels *k = pw_kernels_at(row);
    world_init(&w, 2.0);
    random_points(&w, k, 11);
    weights(&w, k);
    const pw_real a[6] = {0.3, -0.7, 1.3, 0.4, 2.0, -0.9};
    for (int n = 0; n < NNODE; n++) {
      w.rec[n * NODE + 1] = a[0] + a[1] * node_x(&w, n) + a[2] * node_y(&w, n);
      w.rec[n * NODE + 2] = a[3] + a[4] * node_x(&w, n) + a[5] * node_y(&w, n);
    }
    static pw_gradients g;
    pw_real old[2 * LD];
    memcpy(old, w.x, sizeof old);
    k->g2p_gradient(&w.t, w.rec, 1, 1.0, true, 0, LD, &g);
    for (pw_idx i = 0; i < LD; i++) {
      const pw_real want[4] = {a[1], a[2], a[4], a[5]};
      for (int c = 0; c < 4; c++) {
        assert_near(g.du[c][i], want[c], 1e-13);
      }
      pw_real vx = a[0] + a[1] * old[i] + a[2] * old[LD + i];
      assert_near(w.x[i] - old[i], vx, 1e-13);
      assert_near(g.du[4][i], k->geometry == AXI ? vx / old[i] : 0.0, 1e-13);
    }
  }
}

/* Scattered mass, momentum and force have the sums of the points' (partition of unity, no net
 * internal force from gradients: sum_i grad S_ip = 0). */
static void scatter_conserves(void **state)
{
  (void)state;
  static world w;
  for (int row = 0; pw_kernels_at(row); row++) {
    const pw_kernels *k = pw_kernels_at(row);
    world_init(&w, 3.0);
    random_points(&w, k, 5);
    weights(&w, k);
    pw_real mass = 0.0, momentum = 0.0, hoop = 0.0, sum[NODE] = {0.0};
    for (pw_idx i = 0; i < LD; i++) {
      w.v[i] = 0.1 * i;
      mass += w.mass[i];
      momentum += w.mass[i] * w.v[i];
      hoop += k->geometry == AXI ? w.vol[i] * w.stress[2 * LD + i] / w.x[i] : 0.0;
    }
    k->p2g(&w.t, w.rec, 0, LD);
    for (int n = 0; n < NNODE; n++) {
      for (int c = 0; c < NODE; c++) {
        sum[c] += w.rec[n * NODE + c];
      }
    }
    assert_relative(sum[0], mass, 1e-13);
    assert_relative(sum[1], momentum, 1e-13);
    assert_near(sum[3], -hoop, 1e-12);
    assert_near(sum[4], 0.0, 1e-12);
  }
}

/* The CPDI gradient of the linear field with the vectors of the catalogue's example, r1 = (.3,.05),
 * r2 = (-.04,.25) full sides: exactly (1.3, -0.7), where thesis eq. 2.25 as printed is wrong. */
static void cpdi_gradient_example(void **state)
{
  (void)state;
  static world w;
  const pw_kernels *k = pw_kernels_find(0, CPDI);
  world_init(&w, 0.0);
  random_points(&w, k, 3);
  const pw_real half[4] = {0.15, 0.025, -0.02, 0.125};
  for (int c = 0; c < 4; c++) {
    w.half[c * LD] = half[c];
  }
  weights(&w, k);
  for (int n = 0; n < NNODE; n++) {
    w.rec[n * NODE + 1] = 1.3 * node_x(&w, n) - 0.7 * node_y(&w, n);
  }
  static pw_gradients g;
  k->g2p_gradient(&w.t, w.rec, 1, 1.0, false, 0, 1, &g);
  assert_near(g.du[0][0], 1.3, 1e-13);
  assert_near(g.du[1][0], -0.7, 1e-13);
}

/* Axisymmetric corner weights against the integral of r N_c over the parallelogram / (r_p A),
 * by 3 x 3 Gauss quadrature (exact: the integrand is of degree 2 in each direction). */
static void axisymmetric_mass_is_r_weighted(void **state)
{
  (void)state;
  static world w;
  const pw_kernels *k = pw_kernels_find(AXI, CPDI);
  world_init(&w, 0.0);
  random_points(&w, k, 9);
  weights(&w, k);
  const pw_real at[3] = {-0.7745966692414834, 0.0, 0.7745966692414834};
  const pw_real wt[3] = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  for (pw_idx i = 0; i < LD; i++) {
    memset(w.rec, 0, sizeof w.rec);
    k->p2g_momentum(&w.t, w.rec, i, i + 1);
    /* Moment of the scattered mass about the axis: sum_c f_c r_c = integral of r^2 / (r_p A). */
    pw_real moment = 0.0, exact = 0.0;
    for (int n = 0; n < NNODE; n++) {
      moment += w.rec[n * NODE] * node_x(&w, n);
    }
    for (int a = 0; a < 3; a++) {
      for (int b = 0; b < 3; b++) {
        pw_real r = w.x[i] + at[a] * w.half[i] + at[b] * w.half[2 * LD + i];
        exact += 0.25 * wt[a] * wt[b] * r * r / w.x[i];
      }
    }
    assert_relative(moment, w.mass[i] * exact, 1e-13);
  }
}

/* A tiling of the strip 0 <= r <= NX cells with two points per cell and direction. */
static pw_idx tile(world *w, int axi, int columns, int rows, pw_real shift)
{
  pw_idx n = 0;
  pw_real l = cell / 2.0;
  for (int j = 0; j < rows; j++) {
    for (int i = 0; i < columns; i++, n++) {
      w->x[n] = l * (i + 0.5);
      w->x[LD + n] = -1.0 + 2.0 * cell + shift + l * (j + 0.5);
      w->half[n] = w->half[3 * LD + n] = 0.5 * l;
      w->vol[n] = w->mass[n] = l * l * (axi ? w->x[n] : 1.0);
      pw_idx hj = (pw_idx)((w->x[LD + n] + 1.0) / cell);
      w->home[n] = hj * NX + (pw_idx)(w->x[n] / cell);
    }
  }
  return n;
}

/* The node on the axis has the exact mass h/6 per radian and unit height (A8 c: the plane formula
 * is 12.5 % too heavy), interior nodes r_i h. */
static void axis_node_mass(void **state)
{
  (void)state;
  static world w;
  const pw_kernels *k = pw_kernels_find(AXI, CPDI);
  world_init(&w, 0.0);
  pw_idx n = tile(&w, AXI, 8, 8, 0.0);
  pw_weights_report r;
  k->weights(&w.t, 0, n, &r);
  k->p2g_momentum(&w.t, w.rec, 0, n);
  int j = 4; /* a row of nodes inside the tiling */
  pw_real dz = cell;
  assert_relative(w.rec[(j * ROW) * NODE], cell * cell / 6.0 * dz, 1e-13);
  assert_relative(w.rec[(j * ROW + 1) * NODE], cell * cell * dz, 1e-13);
  assert_relative(w.rec[(j * ROW + 2) * NODE], 2.0 * cell * cell * dz, 1e-13);
}

/* Uniform isotropic stress leaves no force at interior nodes, those next to the axis included
 * (A8 b). */
static void constant_stress_is_in_equilibrium(void **state)
{
  (void)state;
  static world w;
  for (int row = 0; pw_kernels_at(row); row++) {
    const pw_kernels *k = pw_kernels_at(row);
    for (int s = 0; s < 2; s++) {
      if (k->basis == 0 && s == 1) {
        continue; /* one point rule per cell: exact only where points sit at quadrature points */
      }
      world_init(&w, 0.0);
      pw_idx n = tile(&w, k->geometry, 8, 8, s * 0.37 * cell);
      for (pw_idx i = 0; i < n; i++) {
        w.stress[i] = w.stress[LD + i] = w.stress[2 * LD + i] = 1.0;
      }
      pw_weights_report r;
      k->weights(&w.t, 0, n, &r);
      k->p2g_force(&w.t, w.rec, 0, n);
      for (int i = 1; i < 3; i++) {
        assert_near(w.rec[(4 * ROW + i) * NODE + 3], 0.0, 1e-13);
        assert_near(w.rec[(4 * ROW + i) * NODE + 4], 0.0, 1e-13);
      }
    }
  }
}

/* v_r = a r, v_z = b z gives eps_rr = eps_tt = a, eps_zz = b in every point, the one that touches
 * the axis included (A8 a). */
static void uniform_radial_strain_at_the_axis(void **state)
{
  (void)state;
  static world w;
  for (int basis = 0; basis < 3; basis++) {
    const pw_kernels *k = pw_kernels_find(AXI, basis);
    world_init(&w, 0.0);
    pw_idx n = tile(&w, AXI, 8, 8, 0.21);
    for (int m = 0; m < NNODE; m++) {
      w.rec[m * NODE + 1] = 0.7 * node_x(&w, m);
      w.rec[m * NODE + 2] = -0.4 * node_y(&w, m);
    }
    pw_weights_report r;
    k->weights(&w.t, 0, n, &r);
    static pw_gradients g;
    k->g2p_gradient(&w.t, w.rec, 1, 1.0, false, 0, n, &g);
    for (pw_idx i = 0; i < n; i++) {
      assert_near(g.du[0][i], 0.7, 1e-13);
      assert_near(g.du[3][i], -0.4, 1e-13);
      assert_near(g.du[4][i], 0.7, 1e-13);
    }
  }
}

/* In 1D, a velocity that changes along x alone, the gradient of CPDI is that of uGIMP; the values
 * differ (trapezoid against exact mean). */
static void cpdi_and_gimp_gradients_agree(void **state)
{
  (void)state;
  static world w;
  static pw_gradients g[2];
  pw_real along[ROW];
  uint64_t seed = 22;
  for (int i = 0; i < ROW; i++) {
    along[i] = test_random(&seed) - 0.5;
  }
  for (int b = 0; b < 2; b++) {
    const pw_kernels *k = pw_kernels_find(0, b == 0 ? 1 : CPDI);
    world_init(&w, 0.0);
    random_points(&w, pw_kernels_find(0, 1), 21); /* square to the grid */
    weights(&w, k);
    for (int n = 0; n < NNODE; n++) {
      w.rec[n * NODE + 1] = along[n % ROW];
    }
    k->g2p_gradient(&w.t, w.rec, 1, cell, false, 0, LD, &g[b]);
  }
  for (pw_idx i = 0; i < LD; i++) {
    assert_near(g[0].du[0][i], g[1].du[0][i], 1e-14);
  }
}

/* Bad points are named, never skipped: outside, not a number, inverted, beyond the reach. */
static void weights_report_bad_points(void **state)
{
  (void)state;
  static world w;
  pw_weights_report r;
  const pw_kernels *k = pw_kernels_find(0, CPDI);
  world_init(&w, 0.0);
  random_points(&w, k, 2);
  w.x[7] = NAN;
  w.x[LD + 9] = 1e9;
  w.half[12] = -w.half[12];
  w.home[5] = 0;
  w.t.reach = 1;
  k->weights(&w.t, 0, LD, &r);
  assert_int_equal(r.lost, 7);
  assert_int_equal(r.inverted, 12);
  assert_true(r.overrun >= 0 && r.overrun <= 5);
}

/* Half-planes a . x <= b of a point's domain and of the cells of a node; x from the origin. */
typedef struct {
  pw_real a[8][2], b[8];
  int n;
} planes;

static void planes_add(planes *p, pw_real ax, pw_real ay, pw_real b)
{
  p->a[p->n][0] = ax;
  p->a[p->n][1] = ay;
  p->b[p->n++] = b;
}

static planes domain_of(const world *w, const pw_kernels *k, pw_idx i)
{
  const pw_real side = 0.5 * sqrt(w->vol[i] / (k->geometry == AXI ? w->x[i] : 1.0));
  const bool square = k->basis == 0;
  const pw_real *g = w->half + i, x = w->x[i] - w->t.origin[0], y = w->x[LD + i] - w->t.origin[1];
  const pw_real h[4] = {square ? side : g[0], square ? 0.0 : g[LD], square ? 0.0 : g[2 * LD],
                        square ? side : g[3 * LD]};
  const pw_real area = h[0] * h[3] - h[1] * h[2];
  planes p = {0};
  for (int s = -1; s <= 1; s += 2) {
    planes_add(&p, s * h[3], -s * h[2], area + s * (h[3] * x - h[2] * y));
    planes_add(&p, -s * h[1], s * h[0], area + s * (h[0] * y - h[1] * x));
  }
  return p;
}

/* Largest x . n within the half-planes: the best of the places where two of their sides meet. */
static pw_real farthest_within(const planes *p, const pw_real *n)
{
  pw_real far = -DBL_MAX;
  for (int k = 0; k < p->n * p->n; k++) {
    const int i = k / p->n, j = k % p->n;
    const pw_real *a = p->a[i], *c = p->a[j], det = a[0] * c[1] - a[1] * c[0];
    const pw_real x = (p->b[i] * c[1] - p->b[j] * a[1]) / det;
    const pw_real y = (a[0] * p->b[j] - c[0] * p->b[i]) / det;
    bool within = fabs(det) > 1e-9;
    for (int m = 0; within && m < p->n; m++) {
      within = p->a[m][0] * x + p->a[m][1] * y <= p->b[m] + 1e-13;
    }
    far = within ? pw_max(far, n[0] * x + n[1] * y) : far;
  }
  return far;
}

/* Farthest place of the domain of point i from the origin along n, if it has a weight at a node; of
 * CPDI domains in the node's cells. */
static pw_real farthest(const world *w, const pw_kernels *k, pw_idx i, int node, const pw_real *n)
{
  const pw_real at[2] = {node_x(w, node) - w->t.origin[0], node_y(w, node) - w->t.origin[1]};
  planes part = domain_of(w, k, i);
  pw_support s;
  k->support(&w->t, i, &s);
  bool counts = false;
  for (int m = 0; m < s.n; m++) {
    counts = counts || (s.node[m] == node && s.s[m] > 1e-9);
  }
  for (int side = -1; k->basis == CPDI && side <= 1; side += 2) {
    planes_add(&part, side, 0.0, side * at[0] + cell);
    planes_add(&part, 0.0, side, side * at[1] + cell);
  }
  return counts ? farthest_within(&part, n) : -DBL_MAX;
}

/* Ask for extents along random directions, at all nodes but every fifth. */
static void ask_extents(world *w)
{
  uint64_t seed = 29;
  for (int n = 0; n < NNODE; n++) {
    for (int d = 0; d < 2; d++) {
      pw_real angle = 6.3 * test_random(&seed);
      w->rec[n * NODE + 2 * d] = cos(angle);
      w->rec[n * NODE + 2 * d + 1] = sin(angle);
    }
    w->rec[n * NODE + 4] = test_random(&seed);
    for (int d = 0; d < 3; d++) {
      w->rec[n * NODE + PW_SURFACE_EXTENT + d] = n % 5 == 0 ? PW_HUGE : -DBL_MAX;
    }
  }
}

/* How far bodies reach, by looking at every place of every point; the grid's lines known from the
 * cell, and read from a table as on graded grids. */
static void extents_are_those_of_the_domains(void **state)
{
  (void)state;
  static world w;
  pw_real line[2][NX + 1];
  const pw_grid_axis axis[2] = {{.node = line[0]}, {.node = line[1]}};
  for (int run = 0; pw_kernels_at(run / 2); run++) {
    const pw_kernels *k = pw_kernels_at(run / 2);
    int reached = 0;
    world_init(&w, 2.0);
    random_points(&w, k, 7);
    weights(&w, k);
    for (int a = 0; a < 2 * (NX + 1); a++) {
      line[a % 2][a / 2] = w.t.origin[a % 2] + cell * (a / 2);
    }
    ask_extents(&w);
    w.t.axis = run % 2 ? axis : NULL;
    k->p2g_extent(&w.t, w.rec, 0, LD / 2);
    k->p2g_extent(&w.t, w.rec, LD / 2, LD);
    for (int n = 0; n < 3 * NNODE; n++) {
      const pw_real *r = w.rec + n / 3 * NODE;
      const pw_real along[6] = {r[0], r[1], r[2], r[3], r[4] * (r[0] + r[2]), r[4] * (r[1] + r[3])};
      const bool asked = n / 3 % 5 != 0;
      pw_real want = asked ? -DBL_MAX : PW_HUGE, got = r[PW_SURFACE_EXTENT + n % 3];
      for (pw_idx i = 0; asked && i < LD; i++) {
        want = pw_max(want, farthest(&w, k, i, n / 3, along + n % 3 * 2));
      }
      assert_true(got == want || fabs(got - want) < 1e-12);
      reached += asked && want > -DBL_MAX;
    }
    assert_in_range(reached, 60, 3 * NNODE);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(extents_are_those_of_the_domains),
      cmocka_unit_test(linear_field_has_exact_gradient),
      cmocka_unit_test(scatter_conserves),
      cmocka_unit_test(cpdi_gradient_example),
      cmocka_unit_test(axisymmetric_mass_is_r_weighted),
      cmocka_unit_test(axis_node_mass),
      cmocka_unit_test(constant_stress_is_in_equilibrium),
      cmocka_unit_test(uniform_radial_strain_at_the_axis),
      cmocka_unit_test(cpdi_and_gimp_gradients_agree),
      cmocka_unit_test(weights_report_bad_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
