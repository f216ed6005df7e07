/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stress waves in a pile under the hammer pulse (verification A2): L = 5 m, E = 100 MPa,
 * rho = 2500 kg/m3, so c = 200 m/s; q = 1 MPa for 0.1 s = 4 L/c, nu = 0 with lateral rollers.
 * Exact (d'Alembert, p compressive, x from the head, s = -1 free toe, +1 fixed toe):
 *   p = sum_n (-s)^n [q(t - (2nL + x)/c) + s q(t - (2(n+1)L - x)/c)],
 *   v = sum_n (-s)^n [q(t - (2nL + x)/c) - s q(t - (2(n+1)L - x)/c)] / (rho c).
 * The pulse raises the strain to 2 %, so the elastic law in rate form differs from the linear one
 * by up to 1 %; where a row asks for more than that, the pressure is a thousandth of it. */
#include "tests/engine_helpers.h"

static const double length = 5.0, young = 1e8, density = 2500.0, speed = 200.0;

typedef struct {
  int n, update, terms; /* cells along the pile; terms of the mass matrix */
  bool free_toe;
  double pressure, rise, room; /* room: below a free toe */
} pile;

static pw_sim *pile_sim(const pile *c)
{
  static pw_scene s;
  double h = length / c->n, low = c->free_toe ? c->room : 0.0;
  pw_scene_default(&s);
  test_grid(&s, (double[]){0.0, h, 0.0, low + length + 2.0 * h}, h);
  int m = test_elastic(&s, young, 0.0, density);
  test_rectangle(&s, m, (double[]){0.0, h, low, low + length}, 0.5 * h);
  s.method.update = c->update;
  s.method.mass_terms = c->terms;
  s.time.dt_s = 0.4 * h / speed;
  for (int side = PW_SIDE_LEFT; side <= PW_SIDE_RIGHT; side++) {
    pw_boundary_param *b = pw_scene_add_effect(&s, "boundary");
    b->side = side;
    b->fix_x = true;
  }
  if (!c->free_toe) {
    pw_boundary_param *b = pw_scene_add_effect(&s, "boundary");
    b->side = PW_SIDE_BOTTOM;
    b->fix_y = true;
  }
  pw_hammer_param *hammer = pw_scene_add_effect(&s, "hammer");
  hammer->body = 0;
  hammer->pressure_pa = c->pressure;
  hammer->duration_s = 0.1;
  hammer->rise_s = c->rise;
  return test_sim(&s, 1);
}

/* q(t) / pressure: linear rise from 0 and fall from 0.1 s. */
static double pulse(double t, double rise)
{
  double up = rise > 0.0 ? t / rise : (t >= 0.0), down = rise > 0.0 ? (t - 0.1) / rise : (t >= 0.1);
  return fmin(fmax(up, 0.0), 1.0) - fmin(fmax(down, 0.0), 1.0);
}

/* Compressive stress over the pressure, and velocity times rho c over the pressure. */
static void exact(const pile *c, double t, double x, double *p, double *v)
{
  double s = c->free_toe ? -1.0 : 1.0, sign = 1.0;
  *p = *v = 0.0;
  for (int n = 0; n < 8; n++, sign *= -s) {
    double down = pulse(t - (2 * n * length + x) / speed, c->rise);
    double up = pulse(t - (2 * (n + 1) * length - x) / speed, c->rise);
    *p += sign * (down + s * up);
    *v += sign * (down - s * up);
  }
}

/* Mean stress and velocity of the points whose initial distance from the head is within half a
 * cell of x; in the units of exact(). */
static void near(const pw_sim *sim, const pile *c, double x, double *p, double *v)
{
  const pw_points *pt = &sim->points;
  double h = length / c->n, top = (c->free_toe ? c->room : 0.0) + length, sum = 0.0;
  pw_idx column = pt->n / (2 * c->n); /* points across */
  *p = *v = 0.0;
  for (pw_idx id = 0; id < pt->n; id++) {
    pw_idx i = pt->slot[id];
    double y0 = top - length + 0.5 * h * (0.5 + (double)(id / column)); /* ids row by row */
    if (fabs(top - y0 - x) < 0.5 * h) {
      *p -= pt->stress[pt->ld + i] / c->pressure;
      *v -= pt->v[pt->ld + i] * density * speed / c->pressure;
      sum += 1.0;
    }
  }
  *p /= sum;
  *v /= sum;
}

/* v_head, p_mid, then v_toe (free) or p_toe (fixed), in m/s and kPa at 1 MPa. */
typedef struct {
  double t, free_toe[3], fixed_toe[3];
} table_row;

static const table_row table[4] = {{0.010, {2, 0, 0}, {2, 0, 0}},
                                   {0.030, {2, 1000, 4}, {2, 1000, 2000}},
                                   {0.060, {6, 0, 4}, {-2, 2000, 2000}},
                                   {0.090, {6, 0, 8}, {-2, 0, 0}}};

static void exact_solution_is_that_of_the_table(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    for (int toe = 0; toe < 2; toe++) {
      pile c = {.free_toe = toe == 0};
      const double *want = toe == 0 ? table[k].free_toe : table[k].fixed_toe;
      double p, v, unused;
      exact(&c, table[k].t, 0.0, &unused, &v);
      assert_near(2.0 * v, want[0], 1e-12);
      exact(&c, table[k].t, 0.5 * length, &p, &unused);
      assert_near(1000.0 * p, want[1], 1e-12);
      exact(&c, table[k].t, length, &p, &v);
      assert_near(toe == 0 ? 2.0 * v : 1000.0 * p, want[2], 1e-12);
    }
  }
}

/* Head, middle and toe at the times of the table, pulse with flanks of 5 ms. */
static double largest_distance(const pile *c)
{
  pw_sim *sim = pile_sim(c);
  double worst = 0.0, h = length / c->n;
  const double place[3] = {0.5 * h, 0.5 * length, length - 0.5 * h};
  for (int k = 0; k < 5; k++) {
    test_run_to(sim, k < 4 ? table[k].t : 0.125);
    for (int j = 0; j < 3; j++) {
      double p, v, pe, ve;
      near(sim, c, place[j], &p, &v);
      exact(c, sim->time, place[j], &pe, &ve);
      worst = fmax(worst, fmax(fabs(p - pe), fabs(v - ve)));
    }
  }
  pw_sim_destroy(&sim);
  return worst;
}

static void stress_and_velocity_follow_the_exact_solution(void **state)
{
  (void)state;
  for (int update = PW_MUSL; update <= PW_USL; update++) {
    for (int toe = 0; toe < 2; toe++) {
      pile c = {160, update, 1, toe == 0, 1e3, 0.005, 0.25};
      double worst = largest_distance(&c);
      print_message("update %d, %s toe: at most %.3f q from the exact stress and velocity\n",
                    update, toe == 0 ? "free" : "fixed", worst);
      assert_true(worst <= 0.065); /* of values up to 4 q; the flanks are the worst places */
    }
  }
}

/* Impulse over mass: q A 0.1 s / (rho A L) = 8 m/s. */
static void momentum_is_that_of_the_hammer(void **state)
{
  (void)state;
  for (int update = PW_MUSL; update <= PW_USF; update++) {
    pile c = {80, update, 1, true, 1e6, 0.0, 1.25};
    pw_sim *sim = pile_sim(&c);
    test_run_to(sim, 0.125);
    const pw_points *p = &sim->points;
    double mass = 0.0, momentum = 0.0;
    for (pw_idx i = 0; i < p->n; i++) {
      mass += p->mass[i];
      momentum -= p->mass[i] * p->v[p->ld + i];
    }
    assert_near(momentum / mass, 8.0, 1e-10);
    pw_sim_destroy(&sim);
  }
}

typedef struct {
  double v_rms, toe_peak, plateau; /* m/s at 1 MPa; of the pressure; of the pressure */
  double mean;                     /* toe stress between 0.030 and 0.045 s over the pressure */
} toe_record;

static toe_record watch_fixed_toe(const pile *c)
{
  pw_sim *sim = pile_sim(c);
  toe_record r = {0.0, 0.0, 0.0, 0.0};
  double seconds = 0.0;
  const double stop[2] = {0.0375, 0.125}; /* middle of the plateau; after the pulse */
  for (int k = 0; k < 2; k++) {
    double p, v;
    while (sim->time < stop[k] * (1.0 - 1e-12)) {
      assert_ok(pw_sim_step(sim, stop[k] - sim->time));
      near(sim, c, length - 0.25 * length / c->n, &p, &v);
      r.toe_peak = fmax(r.toe_peak, p);
      if (sim->time > 0.030 && sim->time <= 0.045) {
        r.mean += p * sim->dt;
        seconds += sim->dt;
      }
    }
    r.plateau = k == 0 ? p : r.plateau;
  }
  const pw_points *p = &sim->points;
  double mass = 0.0, sum = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    mass += p->mass[i];
    sum += p->mass[i] * (p->v[i] * p->v[i] + p->v[p->ld + i] * p->v[p->ld + i]);
  }
  r.mean /= seconds;
  r.v_rms = sqrt(sum / mass) * 1e6 / c->pressure;
  pw_sim_destroy(&sim);
  return r;
}

/* Acceptance of verification A2: 1 % at 0.0375 s, at most 25 % over. A sharp front in a medium
 * whose short waves lag, omega = c k (1 - beta (k h)^2), becomes the integral of the Airy function,
 * whose maximum is 1.2743 whatever beta and h: a scheme that dissipates nothing overshoots by
 * 27.4 % at any resolution, and its ripples at a fixed time behind the front fade with h^(1/2) only.
 * MUSL (like USF) is of that kind: its peak is held to that figure and its plateau as a mean, USL,
 * which takes energy out of short waves, to the acceptance. */
static void toe_plateau_and_overshoot(void **state)
{
  (void)state;
  for (int update = PW_MUSL; update <= PW_USL; update++) {
    for (int k = 0; k < 3; k++) {
      pile c = {k == 1 ? 160 : 80, update, 1, false, 1e3, k == 2 ? 0.005 : 0.0, 0.0};
      toe_record r = watch_fixed_toe(&c);
      print_message(
          "update %d, %d cells, flanks %g s: toe plateau %.4f q, mean %.4f q, peak %.4f q "
          "(exact 2)\n",
          update, c.n, c.rise, r.plateau, r.mean, r.toe_peak);
      assert_relative(r.mean, 2.0, 0.01);
      if (update == PW_USL || k == 2) {
        assert_relative(r.plateau, 2.0, 0.01);
        assert_true(r.toe_peak <= 2.0 * 1.25);
      } else {
        assert_relative(r.toe_peak, 2.0 * 1.2743, 0.005);
      }
    }
  }
}

/* The same acceptance at the full 1 MPa, with USL and two terms of the mass matrix. */
static void second_term_meets_the_acceptance(void **state)
{
  (void)state;
  for (int n = 80; n <= 160; n *= 2) {
    pile c = {n, PW_USL, 2, false, 1e6, 0.0, 0.0};
    toe_record r = watch_fixed_toe(&c);
    print_message("1 MPa, two terms, %d cells: toe plateau %.4f q, mean %.4f q, peak %.4f q\n", n,
                  r.plateau, r.mean, r.toe_peak);
    assert_relative(r.plateau, 2.0, 0.01);
    assert_true(r.toe_peak <= 2.0 * 1.25);
  }
}

/* Velocity left after the pulse: of first order in h when its flanks last 5 ms. An independent
 * program left 0.287, 0.128 and 0.058 m/s (CPDI, USL). */
static void pile_is_quiet_after_the_pulse(void **state)
{
  (void)state;
  const double independent[3] = {0.287, 0.128, 0.058};
  for (int update = PW_MUSL; update <= PW_USL; update++) {
    double left[3];
    for (int k = 0; k < 3; k++) {
      pile c = {40 << k, update, 1, false, 1e3, 0.005, 0.0};
      left[k] = watch_fixed_toe(&c).v_rms;
      assert_true(left[k] <= independent[k]);
    }
    double rate = 0.5 * log2(left[0] / left[2]);
    print_message("update %d: %.4f, %.4f, %.4f m/s left, rate %.3f\n", update, left[0], left[1],
                  left[2], rate);
    assert_true(rate >= 1.0);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exact_solution_is_that_of_the_table),
      cmocka_unit_test(stress_and_velocity_follow_the_exact_solution),
      cmocka_unit_test(momentum_is_that_of_the_hammer),
      cmocka_unit_test(toe_plateau_and_overshoot),
      cmocka_unit_test(second_term_meets_the_acceptance),
      cmocka_unit_test(pile_is_quiet_after_the_pulse),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
