/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compaction of a column under its own weight to less than half its height, in 40 implicit steps on
 * the grid of quadrilaterals: Newton's method with the kernels' shape functions and the tangent of
 * the material. Column of 50 m, rho0 = 80, g = 10, E = 1e4 Pa, nu = 0, two points in a cell. Exact:
 * sigma = -rho0 g (H - Y) whatever the material. The error, sum |sigma - exact| V0 / (rho0 g H sum
 * V0), was computed by an independent one-dimensional program for each basis; that of GIMP agrees to
 * reading accuracy with the figure published for AMPLE (Coombs, Augarde, Adv. Engng Software 142
 * (2020) 102748): 4.14e-2, 1.28e-2, 3.65e-3, 1.04e-3, 4.35e-4 with 4 to 64 cells. */
#include "kernels/transfer.h"
#include "tests/tet_helpers.h"

enum { CELLS = 128, POINTS = 2 * CELLS, NX = 3, ROW = NX + 1, BELOW = 2, ABOVE = 1 };
enum { ROWS = CELLS + BELOW + ABOVE + 1, NODES = ROW * ROWS, RECORD = 8, STEPS = 40 };
enum { LINEAR = 0, GIMP = 1, CPDI = 2 };

typedef struct {
  const pw_kernels *kernels;
  pw_tet_material material;
  pw_idx cells, n; /* of the column */
  bool follow;     /* domains of points shrink with them */
  pw_real x[2 * POINTS], v[2 * POINTS], mass[POINTS], vol[POINTS], stress[6 * POINTS];
  pw_real half[4 * POINTS], local[8 * POINTS], rec[NODES * RECORD];
  pw_idx home[POINTS], corner[4 * POINTS];
  pw_real kept[6 * POINTS], state[3 * POINTS], old_state[3 * POINTS], begin[POINTS],
      volume0[POINTS];
  pw_real gradient[POINTS][ROWS]; /* of the shape function of a row of nodes */
  pw_real modulus[POINTS];
  pw_transfer t;
} column;

static const double height = 50.0, weight = 800.0;

static void start(column *c, const pw_kernels *kernels, bool follow, pw_idx cells)
{
  const pw_real h = height / cells;
  memset(c, 0, sizeof *c);
  c->kernels = kernels;
  c->follow = follow;
  c->cells = cells;
  c->n = 2 * cells;
  c->material = test_von_mises(1e4, 0.0, "yield_uniaxial_pa", 1e9, 0.0);
  for (pw_idx i = 0; i < c->n; i++) {
    c->x[i] = 1.5 * h;
    c->x[POINTS + i] = c->begin[i] = 0.5 * h * (0.5 + i);
    c->volume0[i] = c->vol[i] = 0.5 * h * h;
    c->mass[i] = 80.0 * c->vol[i];
    c->half[i] = 0.5 * h;
    c->half[3 * POINTS + i] = 0.25 * h;
  }
  c->t =
      (pw_transfer){.origin = {0.0, -BELOW * h}, .cell = h, .cells = {NX, cells + BELOW + ABOVE}};
  c->t.row = ROW;
  c->t.reach = 3;
  c->t.ld = POINTS;
  c->t.x = c->x, c->t.v = c->v, c->t.mass = c->mass, c->t.vol = c->vol, c->t.stress = c->stress;
  c->t.half = c->half, c->t.home = c->home, c->t.corner = c->corner, c->t.local = c->local;
}

static pw_idx rows(const column *c)
{
  return c->cells + BELOW + ABOVE + 1;
}

/* Put one value on all nodes of a row, into the slot of velocities along y. */
static void set_row(column *c, pw_idx row, pw_real value)
{
  for (pw_idx k = 0; k < ROW; k++) {
    c->rec[(row * ROW + k) * RECORD + 2] = value;
  }
}

/* Displacement gradient of every point for what is on the nodes; points are moved when asked for. */
static void gather(column *c, bool move, pw_real *out)
{
  static pw_gradients g;
  for (pw_idx first = 0; first < c->n; first += PW_CHUNK) {
    const pw_idx last = first + PW_CHUNK < c->n ? first + PW_CHUNK : c->n;
    c->kernels->g2p_gradient(&c->t, c->rec, 1, 1.0, move, first, last, &g);
    for (pw_idx i = first; i < last; i++) {
      out[i] = g.du[3][i - first];
    }
  }
}

/* Shape functions where the points are: gradients by row, weight by row. */
static void begin_step(column *c, pw_real *load)
{
  static pw_real column_of[POINTS];
  pw_weights_report report;
  for (pw_idx i = 0; i < c->n; i++) {
    c->home[i] = (pw_idx)((c->x[POINTS + i] - c->t.origin[1]) / c->t.cell) * NX + 1;
    c->v[POINTS + i] = -10.0;
  }
  c->kernels->weights(&c->t, 0, c->n, &report);
  assert_int_equal(report.lost, -1);
  assert_int_equal(report.clamped, 0);
  memset(c->rec, 0, sizeof c->rec);
  c->kernels->p2g_momentum(&c->t, c->rec, 0, c->n);
  for (pw_idx r = 0; r < rows(c); r++) {
    load[r] = 0.0;
    for (pw_idx k = 0; k < ROW; k++) {
      load[r] += c->rec[(r * ROW + k) * RECORD + 2];
    }
  }
  memset(c->rec, 0, sizeof c->rec);
  for (pw_idx r = 0; r < rows(c); r++) {
    set_row(c, r, 1.0);
    gather(c, false, column_of);
    set_row(c, r, 0.0);
    for (pw_idx i = 0; i < c->n; i++) {
      c->gradient[i][r] = column_of[i];
    }
  }
}

/* Stress of all points for the displacements [rows] of the step; forces V dP/dF G of the step. */
static void update(column *c, const pw_real *u, pw_real *force)
{
  static pw_real increment[9 * PW_CHUNK], strain[6 * PW_CHUNK], spin[3 * PW_CHUNK], dvol[PW_CHUNK];
  static pw_real density[PW_CHUNK], speed[PW_CHUNK], tangent[36 * PW_CHUNK];
  memcpy(c->stress, c->kept, sizeof c->kept);
  memcpy(c->state, c->old_state, sizeof c->state);
  memset(force, 0, (size_t)rows(c) * sizeof *force);
  for (pw_idx first = 0; first < c->n; first += PW_CHUNK) {
    const pw_idx n = first + PW_CHUNK < c->n ? PW_CHUNK : c->n - first;
    pw_stress_args a = {.n = n, .ld = POINTS, .ldi = PW_CHUNK, .dt = 1.0, .dstrain = strain};
    a.spin = spin, a.dvol = dvol, a.density = density, a.increment = increment;
    a.stress = c->stress + first, a.state = c->state + first, a.wave_speed = speed;
    a.tangent = tangent;
    for (pw_idx k = 0; k < n; k++) {
      pw_real e = 0.0;
      for (pw_idx r = 0; r < rows(c); r++) {
        e += c->gradient[first + k][r] * u[r];
      }
      increment[k] = increment[8 * PW_CHUNK + k] = 1.0;
      increment[4 * PW_CHUNK + k] = dvol[k] = 1.0 + e;
      strain[PW_CHUNK + k] = e;
      density[k] = 80.0;
    }
    assert_ok(c->material.model->update(c->material.param, &a));
    for (pw_idx k = 0; k < n; k++) { /* v/(1 + e) is the volume at the start of the step */
      const pw_idx i = first + k;
      c->modulus[i] = c->vol[i] * tangent[7 * PW_CHUNK + k] / dvol[k];
      for (pw_idx r = 0; r < rows(c); r++) {
        force[r] += c->vol[i] * c->stress[POINTS + i] * c->gradient[i][r];
      }
    }
  }
}

/* Solve K d = b for the rows that are free and held by points. */
static void solve(column *c, pw_real *b)
{
  static pw_real k[ROWS][ROWS];
  const pw_idx n = rows(c);
  memset(k, 0, sizeof k);
  for (pw_idx i = 0; i < c->n; i++) {
    for (pw_idx r = 0; r < n; r++) {
      for (pw_idx s = 0; c->gradient[i][r] != 0.0 && s < n; s++) {
        k[r][s] += c->modulus[i] * c->gradient[i][r] * c->gradient[i][s];
      }
    }
  }
  for (pw_idx r = 0; r < n; r++) {
    if (r <= BELOW || k[r][r] == 0.0) { /* the base is held */
      for (pw_idx s = 0; s < n; s++) {
        k[r][s] = k[s][r] = 0.0;
      }
      k[r][r] = 1.0;
      b[r] = 0.0;
    }
  }
  for (pw_idx r = 0; r < n; r++) { /* the band is four rows wide */
    for (pw_idx s = r + 1; s < n && s <= r + 4; s++) {
      const pw_real f = k[s][r] / k[r][r];
      for (pw_idx q = r; q < n && q <= r + 4; q++) {
        k[s][q] -= f * k[r][q];
      }
      b[s] -= f * b[r];
    }
  }
  for (pw_idx r = n - 1; r >= 0; r--) {
    for (pw_idx s = r + 1; s < n && s <= r + 4; s++) {
      b[r] -= k[r][s] * b[s];
    }
    b[r] /= k[r][r];
  }
}

/* One load step up to the part @p part of the weight. */
static void step(column *c, double part)
{
  static pw_real load[ROWS], u[ROWS], force[ROWS], right[ROWS], stretch[POINTS];
  const pw_idx n = rows(c);
  double left = 1.0;
  memset(u, 0, sizeof u);
  begin_step(c, load);
  for (int iteration = 0; left > 1e-10; iteration++) {
    assert_true(iteration < 20);
    update(c, u, force);
    double square = 0.0, all = 0.0;
    for (pw_idx r = 0; r < n; r++) {
      right[r] = part * load[r] - force[r];
      square += r > BELOW ? right[r] * right[r] : 0.0;
      all += part * part * load[r] * load[r];
    }
    left = sqrt(square / all);
    solve(c, right);
    for (pw_idx r = 0; r < n && left > 1e-10; r++) {
      u[r] += right[r];
    }
  }
  for (pw_idx r = 0; r < n; r++) {
    set_row(c, r, u[r]);
  }
  gather(c, true, stretch);
  for (pw_idx i = 0; i < c->n; i++) {
    c->vol[i] *= 1.0 + stretch[i];
    c->half[3 * POINTS + i] *= c->follow ? 1.0 + stretch[i] : 1.0;
  }
  memcpy(c->kept, c->stress, sizeof c->kept);
  memcpy(c->old_state, c->state, sizeof c->state);
}

/* Error of the stresses after all steps; height of the top edge of the last point's domain. */
static double settle(int basis, bool follow, pw_idx cells, double *top)
{
  static column c;
  double sum = 0.0, volume = 0.0;
  start(&c, pw_kernels_find(0, basis), follow, cells);
  for (int k = 1; k <= STEPS; k++) {
    step(&c, (double)k / STEPS);
  }
  for (pw_idx i = 0; i < c.n; i++) {
    sum += c.volume0[i] * fabs(c.stress[POINTS + i] + weight * (height - c.begin[i]));
    volume += c.volume0[i];
  }
  *top = c.x[POINTS + c.n - 1] + 0.25 * height / cells * c.vol[c.n - 1] / c.volume0[c.n - 1];
  return sum / volume / (weight * height);
}

enum { LEVELS = 6 }; /* 4, 8, ... 128 cells */

static void run(int basis, bool follow, const double *expected, double *error, double *top)
{
  for (int i = 0; i < LEVELS; i++) {
    error[i] = settle(basis, follow, 4 << i, top);
    print_message("%s, domains %s, %d cells: error %.4g, top %.4f m\n",
                  pw_kernels_find(0, basis)->name, follow ? "follow" : "kept", 4 << i, error[i],
                  *top);
    assert_relative(error[i], expected[i], 0.03);
  }
}

static void gimp_converges(void **state)
{
  (void)state;
  const double expected[] = {4.133e-2, 1.294e-2, 3.659e-3, 1.049e-3, 4.357e-4, 2.028e-4};
  double error[LEVELS], top;
  run(GIMP, true, expected, error, &top);
  for (int i = 0; i < 3; i++) { /* towards the error of 40 steps, which is of the first order */
    assert_true(log2(error[i] / error[i + 1]) >= 1.6);
  }
  assert_near(top, 24.058, 0.005); /* exact: 24.05965 */
}

static void cpdi_converges(void **state)
{
  (void)state;
  const double expected[] = {2.79e-2, 9.02e-3, 2.57e-3, 8.02e-4, 3.17e-4, 1.75e-4};
  double error[LEVELS], top;
  run(CPDI, true, expected, error, &top);
  assert_near(top, 24.058, 0.005);
}

/* Domains that keep their first size leave gaps and overlaps. */
static void gimp_of_kept_domains_stalls(void **state)
{
  (void)state;
  const double expected[] = {1.09e-1, 5.70e-2, 2.96e-2, 1.77e-2, 1.30e-2, 1.06e-2};
  double error[LEVELS], top;
  run(GIMP, false, expected, error, &top);
  assert_true(log2(error[4] / error[5]) < 0.4);
}

static void standard_mpm_stays_at_its_error(void **state)
{
  (void)state;
  const double expected[] = {6.33e-2, 9.70e-2, 8.67e-2, 8.01e-2, 8.29e-2, 9.53e-2};
  double error[LEVELS], top;
  run(LINEAR, false, expected, error, &top);
  for (int i = 1; i < LEVELS; i++) {
    assert_true(error[i] > 0.07 && error[i] < 0.11);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(gimp_converges),
      cmocka_unit_test(cpdi_converges),
      cmocka_unit_test(gimp_of_kept_domains_stalls),
      cmocka_unit_test(standard_mpm_stays_at_its_error),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
