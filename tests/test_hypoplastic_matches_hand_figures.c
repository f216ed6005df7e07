/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Isotropic states and element tests of the Karlsruhe sand set with p_t = 0, computed by an
 * independent program with Heun's method at a fixed strain step (5e-7 up to 1 % of strain with
 * intergranular strain, 1.7e-5 elsewhere). Accepted: 0.2 % of the fine-step entries, 1 % of the
 * others, at substep tolerance 1e-4. */
#include "kernels/element_driver.h"
#include "tests/hypoplastic_reference.h"

static void set_without_shift(bool intergranular, pw_real *v)
{
  reference_set(0, 1e-4, v);
  v[PW_HYPO_P_T] = 0.0;
  v[PW_HYPO_P_MIN] = 100.0;
  v[PW_HYPO_INTERGRANULAR] = intergranular ? 1.0 : 0.0;
}

static void check(double value, double expected, double accept, const char *what)
{
  double off = fabs(value / expected - 1.0);
  if (off > accept) {
    print_message("%s: %.6g, expected %.6g\n", what, value, expected);
  }
  assert_true(off <= accept);
}

/** Isotropic p (kPa) and e = 0.65: f_b (kPa), f_e, f_d; L, N, L - N, L + N, m_R L (kPa) in
 *  isotropic compression; speed of m_R L at 1576 kg/m3. */
static const double isotropic[4][10] = {
    {1, 218.594, 1.27005, 0.89441, 1700.5, 760.3, 940.2, 2460.8, 17005, 103.9},
    {10, 1156.370, 1.25023, 0.90338, 8855.1, 3998.9, 4856.2, 12854.0, 88551, 237.1},
    {100, 6162.566, 1.21332, 0.91933, 45797.5, 21047.1, 24750.4, 66844.6, 457975, 539.1},
    {170, 9077.229, 1.20112, 0.92441, 66779.9, 30859.6, 35920.4, 97639.5, 667799, 651.0}};

/** Stiffness in oedometric direction yy for isotropic stress: d sigma_yy / d eps_yy. */
static double modulus_yy(bool intergranular, double p, double del_yy, double direction)
{
  pw_real v[PW_HYPO_PARAMS];
  pw_hypo h;
  pw_hypo_rates r;
  set_without_shift(intergranular, v);
  pw_hypo_derive(v, &h);
  pw_hypo_point at = {.stress = {.xx = -p, .yy = -p, .zz = -p}, .void_ratio = 0.65};
  at.delta.yy = del_yy;
  pw_hypo_evaluate(&h, &at, (pw_t6){.yy = direction}, &r);
  return r.stress.yy / direction;
}

static void isotropic_factors(void **unused)
{
  (void)unused;
  for (int i = 0; i < 4; i++) {
    const double *row = isotropic[i], p = 1e3 * row[0];
    pw_real v[PW_HYPO_PARAMS];
    pw_hypo h;
    pw_hypo_rates r;
    set_without_shift(true, v);
    pw_hypo_derive(v, &h);
    assert_true(fabs(h.a - 3.06186) < 5e-6);
    pw_hypo_point at = {.stress = {.xx = -p, .yy = -p, .zz = -p}, .void_ratio = 0.65};
    pw_hypo_evaluate(&h, &at, (pw_t6){.yy = -1.0}, &r);
    check(r.f_b, 1e3 * row[1], 5e-6, "f_b");
    check(r.f_e, row[2], 5e-6, "f_e");
    check(r.f_d, row[3], 1e-5, "f_d");
    double load = modulus_yy(false, p, 0.0, -1.0), unload = modulus_yy(false, p, 0.0, 1.0);
    check(0.5 * (load + unload), 1e3 * row[4], 1e-4, "L");
    check(0.5 * (unload - load), 1e3 * row[5], 1e-4, "N");
    check(load, 1e3 * row[6], 1e-4, "L - N");
    check(unload, 1e3 * row[7], 1e-4, "L + N");
    check(modulus_yy(true, p, 0.0, -1.0), 1e3 * row[8], 1e-4, "m_R L, no delta");
    check(modulus_yy(true, p, -5e-5, 1.0), 1e3 * row[8], 1e-4, "m_R L, reversal");
    check(modulus_yy(true, p, -5e-5, -1.0), 1e3 * row[6], 1e-4, "L - N, mobilised");
    check(sqrt(modulus_yy(true, p, 0.0, -1.0) / 1576.0), row[9], 5e-4, "speed of m_R L");
    /* the bound holds m_R L and a margin of 10 % of stiffness for isotropic stress */
    check(sqrt(r.modulus / 1576.0), sqrt(1.1) * row[9], 1e-3, "wave speed");
  }
}

/** Unit ratios do not switch the intergranular strain off: N still grows with rho. */
static void unit_ratios_are_not_off(void **unused)
{
  (void)unused;
  const double rho[3] = {0.0, 0.5, 1.0}, expected[3] = {45798e3, 35274e3, 24750e3};
  pw_real v[PW_HYPO_PARAMS];
  pw_hypo h;
  pw_hypo_rates r;
  set_without_shift(true, v);
  v[PW_HYPO_M_R] = v[PW_HYPO_M_T] = 1.0;
  pw_hypo_derive(v, &h);
  for (int i = 0; i < 3; i++) {
    pw_hypo_point at = {.stress = {.xx = -1e5, .yy = -1e5, .zz = -1e5}, .void_ratio = 0.65};
    at.delta.yy = -5e-5 * rho[i];
    pw_hypo_evaluate(&h, &at, (pw_t6){.yy = -1.0}, &r);
    check(-r.stress.yy, expected[i], 1e-4, "m_R = m_T = 1");
  }
}

typedef enum test_kind { BIAXIAL, TRIAXIAL, OEDOMETER } test_kind;

/** Shorten the element along y to @p to; the peak of q on the way goes to @p peak. */
static void shorten(pw_element *el, test_kind kind, double to, double *peak, double *peak_at)
{
  pw_element_step step = {.control = {PW_CONTROL_STRESS}};
  step.control[0] = kind == OEDOMETER ? PW_CONTROL_STRAIN : PW_CONTROL_STRESS;
  step.control[2] = kind == TRIAXIAL ? PW_CONTROL_STRESS : PW_CONTROL_STRAIN;
  step.value[0] = kind == OEDOMETER ? 0.0 : -1e5;
  step.value[2] = kind == TRIAXIAL ? -1e5 : 0.0;
  int n = (int)ceil(to + el->strain[1] > 1e-3 ? (to + el->strain[1]) / 2e-4 : 20.0);
  double from = el->strain[1];
  for (int i = 0; i < n; i++) {
    step.value[1] = (-to - from) / n;
    assert_int_equal(pw_element_drive(el, &step), PW_OK);
    double q = el->stress[0] - el->stress[1];
    if (q > *peak) {
      *peak = q;
      *peak_at = -el->strain[1];
    }
  }
}

static void start(pw_element *el, const pw_real *v)
{
  const pw_real stress[6] = {-1e5, -1e5, -1e5, 0, 0, 0};
  assert_int_equal(pw_element_start(el, pw_material_find("hypoplastic_sand"), v, stress), PW_OK);
}

/** Follow a table of strain and stress (kPa): q, or sigma_v in the oedometer. */
static void follow(test_kind kind, bool intergranular, const double rows[][2], int n, double peak,
                   double peak_at)
{
  pw_real v[PW_HYPO_PARAMS];
  pw_element el;
  double q_peak = 0.0, at = 0.0;
  set_without_shift(intergranular, v);
  start(&el, v);
  for (int i = 0; i < n; i++) {
    shorten(&el, kind, rows[i][0], &q_peak, &at);
    double value = kind == OEDOMETER ? -el.stress[1] : el.stress[0] - el.stress[1];
    check(value, 1e3 * rows[i][1], rows[i][0] <= 1e-2 ? 2e-3 : 1e-2, "stress");
  }
  if (peak > 0.0) {
    check(q_peak, 1e3 * peak, 2e-3, "peak");
    check(at, peak_at, 2e-2, "strain at the peak");
  }
  if (kind == OEDOMETER && !intergranular) {
    check(el.stress[0] / el.stress[1], 0.521, 1e-2, "K of the oedometer");
  }
}

static void biaxial_tests(void **unused)
{
  (void)unused;
  const double with[10][2] = {{1e-4, 23.384}, {5e-4, 52.035}, {1e-3, 64.214}, {2e-3, 84.845},
                              {5e-3, 141.92}, {1e-2, 218.62}, {2e-2, 293.8},  {5e-2, 296.3},
                              {1e-1, 288.4},  {2e-1, 278.5}};
  const double without[8][2] = {{1e-3, 23.19}, {2e-3, 45.67}, {5e-3, 108.78}, {1e-2, 196.87},
                                {2e-2, 291.3}, {5e-2, 298.1}, {1e-1, 289.6},  {2e-1, 279.3}};
  follow(BIAXIAL, true, with, 10, 304.5, 0.0286);
  follow(BIAXIAL, false, without, 8, 307.0, 0.0295);
}

static void triaxial_tests(void **unused)
{
  (void)unused;
  const double with[6][2] = {{1e-4, 20.625}, {5e-4, 45.985}, {1e-3, 56.788},
                             {2e-3, 74.340}, {5e-3, 118.30}, {1e-2, 169.72}};
  const double without[5][2] = {
      {1e-3, 22.30}, {2e-3, 42.83}, {5e-3, 94.57}, {1e-2, 155.17}, {2e-2, 217.82}};
  follow(TRIAXIAL, true, with, 6, 0.0, 0.0);
  follow(TRIAXIAL, false, without, 5, 0.0, 0.0);
}

/** Without intergranular strain: peak, and the state at 60 % of strain. */
static void triaxial_to_large_strain(void **unused)
{
  (void)unused;
  pw_real v[PW_HYPO_PARAMS];
  pw_element el;
  double peak = 0.0, at = 0.0;
  set_without_shift(false, v);
  start(&el, v);
  shorten(&el, TRIAXIAL, 0.6, &peak, &at);
  check(peak, 250.48e3, 2e-3, "peak");
  check(at, 0.0499, 2e-2, "strain at the peak");
  double q = el.stress[0] - el.stress[1], sum = -el.stress[0] - el.stress[1];
  check(asin(q / sum) * 180.0 / 3.14159265358979, 30.84, 1e-3, "friction angle at 60 %");
  check(el.state[0], 0.7436, 1e-3, "void ratio at 60 %");
}

static void oedometer_tests(void **unused)
{
  (void)unused;
  const double with[6][2] = {{1e-4, 134.196}, {5e-4, 184.137}, {1e-3, 206.283},
                             {2e-3, 246.714}, {5e-3, 398.84},  {1e-2, 783.57}};
  const double without[4][2] = {{1e-3, 126.16}, {2e-3, 155.66}, {5e-3, 269.96}, {1e-2, 573.36}};
  follow(OEDOMETER, true, with, 6, 0.0, 0.0);
  follow(OEDOMETER, false, without, 4, 0.0, 0.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(isotropic_factors),
                                     cmocka_unit_test(unit_ratios_are_not_off),
                                     cmocka_unit_test(biaxial_tests),
                                     cmocka_unit_test(triaxial_tests),
                                     cmocka_unit_test(triaxial_to_large_strain),
                                     cmocka_unit_test(oedometer_tests)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
