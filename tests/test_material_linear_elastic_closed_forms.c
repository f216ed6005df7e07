/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linear elasticity with the Jaumann rate: uniaxial strain, dilation, finite simple shear
 * (sigma_xy = mu sin gamma, sigma_xx = mu (1 - cos gamma): Dienes, Acta Mech. 32 (1979) 217-232),
 * rigid rotation, tangent, wave speed, failing points. */
#include "kernels/element_driver.h"
#include "kernels/tensor.h"
#include "tests/harness.h"

static const pw_real param[3] = {10e6, 0.3, 2000.0};
static const double mu = 10e6 / 2.6, lambda = 10e6 * 0.3 / (1.3 * 0.4);
static const double pi = 3.14159265358979323846;

static void start(pw_element *el, const pw_real *stress)
{
  assert_ok(pw_element_start(el, pw_material_find("linear_elastic"), param, stress));
}

static void strains_give_hookes_stress(void **unused)
{
  (void)unused;
  const pw_real zero[6] = {0};
  pw_element el;
  const pw_real uniaxial[6] = {0, -1e-3, 0, 0, 0, 0}, dilation[6] = {1e-3, 1e-3, 1e-3, 0, 0, 0};
  start(&el, zero);
  assert_ok(pw_element_move(&el, uniaxial, NULL, NULL));
  assert_relative(el.stress[1], -1e-3 * (lambda + 2 * mu), 1e-14);
  assert_relative(el.stress[0], -1e-3 * lambda, 1e-14);
  assert_relative(el.stress[2], -1e-3 * lambda, 1e-14);
  start(&el, zero);
  assert_ok(pw_element_move(&el, dilation, NULL, NULL));
  assert_relative(el.stress[2], 1e-3 * (3 * lambda + 2 * mu), 1e-14);
  for (int c = 3; c < 6; c++) { /* tensor shears */
    pw_real shear[6] = {0};
    shear[c] = 2e-4;
    start(&el, zero);
    assert_ok(pw_element_move(&el, shear, NULL, NULL));
    for (int k = 0; k < 6; k++) {
      assert_near(el.stress[k], k == c ? 2.0 * mu * 2e-4 : 0.0, 1e-9);
    }
  }
}

/** v_x = gamma_dot y: D_xy = W_xy = gamma_dot / 2, to gamma = 2. */
static double shear_error(int steps)
{
  const pw_real zero[6] = {0}, half = 2.0 / steps / 2.0;
  const pw_real de[6] = {0, 0, 0, half, 0, 0}, spin[3] = {half, 0, 0};
  pw_element el;
  start(&el, zero);
  for (int i = 0; i < steps; i++) {
    assert_ok(pw_element_move(&el, de, spin, NULL));
  }
  assert_near(el.stress[0], -el.stress[1], 1e-6);
  assert_near(el.stress[2], 0.0, 1e-9);
  return fmax(fabs(el.stress[3] - mu * sin(2.0)), fabs(el.stress[0] - mu * (1.0 - cos(2.0)))) / mu;
}

/** Rotation and strain taken one after the other: an error of first order. */
static void finite_simple_shear(void **unused)
{
  (void)unused;
  double coarse = shear_error(1000), fine = shear_error(2000);
  assert_true(fine < 1e-3);
  assert_near(coarse / fine, 2.0, 0.02);
}

static void rotation_has_the_sign_of_the_spin(void **unused)
{
  (void)unused;
  const pw_real stress[6] = {1e5, 0, 0, 0, 0, 0}, none[6] = {0};
  /* W_ij = (dv_i/dx_j - dv_j/dx_i) / 2: positive xy, yz, zx turn x to -y, y to -z, z to -x */
  const int shear[3] = {3, 4, 5};
  for (int c = 0; c < 3; c++) {
    pw_real from[6] = {0}, spin[3] = {0};
    pw_element el;
    from[c] = stress[0];
    spin[c] = 1e-3;
    start(&el, from);
    assert_ok(pw_element_move(&el, none, spin, NULL));
    assert_near(el.stress[shear[c]], -1e5 * 1e-3, 1e-3);
  }
}

static void ten_turns_keep_the_invariants(void **unused)
{
  (void)unused;
  const double axis[3][3] = {{1, 0, 0}, {0, 0, 1}, {0.48, -0.64, 0.6}};
  const pw_real stress[6] = {-1e5, -2e5, -1.5e5, 3e4, -2e4, 1e4}, none[6] = {0};
  const int steps = 5000;
  for (int k = 0; k < 3; k++) {
    pw_real spin[3];
    pw_element el;
    start(&el, stress);
    for (int c = 0; c < 3; c++) { /* a step turns by 2 atan(|w| / 2) */
      spin[c] = axis[k][c] * 2.0 * tan(10.0 * pi / steps);
    }
    for (int i = 0; i < steps; i++) {
      assert_ok(pw_element_move(&el, none, spin, NULL));
    }
    pw_t6 a = pw_t6_load(stress, 1), b = pw_t6_load(el.stress, 1);
    assert_relative(pw_t6_trace(b), pw_t6_trace(a), 1e-10);
    assert_relative(pw_t6_norm(b), pw_t6_norm(a), 1e-10);
    assert_relative(pw_t6_det(b), pw_t6_det(a), 1e-10);
    for (int c = 0; c < 6; c++) {
      assert_near(el.stress[c], stress[c], 1e-10 * 2e5);
    }
  }
}

/** The plane rotation has the bits of the general one with two spins zero: a point's result must
 *  not depend on whether its neighbours in a batch spin out of plane. */
static void plane_and_general_rotation_agree(void **unused)
{
  (void)unused;
  pw_t6 a = {-1e5, -2e5, -1.5e5, 3e4, -2e4, 1e4};
  for (double w = -2.0; w < 2.0; w += 0.1) {
    pw_t6 b = pw_t6_rotate_plane(w, a), c = pw_t6_rotate(pw_rot_hughes_winget(w, 0.0, 0.0), a);
    assert_memory_equal(&b, &c, sizeof b);
  }
}

static void tangent_is_the_elastic_matrix(void **unused)
{
  (void)unused;
  const pw_real zero[6] = {0};
  pw_real tangent[36];
  pw_element el;
  start(&el, zero);
  assert_ok(pw_element_move(&el, zero, NULL, tangent));
  for (int i = 0; i < 6; i++) {
    for (int j = 0; j < 6; j++) {
      double expected = i < 3 && j < 3 ? lambda : 0.0;
      expected += i == j ? (i < 3 ? 2 * mu : mu) : 0.0;
      assert_near(tangent[6 * i + j], expected, 1e-6);
    }
  }
  assert_relative(el.wave_speed, sqrt((lambda + 2 * mu) / 2000.0), 1e-14);
}

/** Uniaxial stress under mixed control: strain ratio -nu, modulus E. */
static void uniaxial_stress(void **unused)
{
  (void)unused;
  const pw_real zero[6] = {0};
  pw_element el;
  pw_element_step step = {.control = {PW_CONTROL_STRESS, PW_CONTROL_STRAIN, PW_CONTROL_STRESS}};
  step.value[1] = -1e-3;
  start(&el, zero);
  assert_ok(pw_element_drive(&el, &step));
  assert_relative(el.stress[1], -1e-3 * 10e6, 1e-10);
  assert_relative(el.strain[0], 0.3e-3, 1e-8);
}

static void a_bad_point_is_reported(void **unused)
{
  (void)unused;
  enum { N = 9 };
  pw_real de[6][N] = {{0}}, spin[3][N] = {{0}}, stress[6][N] = {{0}}, speed[N], density[N], dvol[N];
  for (int i = 0; i < N; i++) {
    de[0][i] = i == 4 ? NAN : (i == 6 ? INFINITY : 1e-3);
    stress[1][i] = 7.0;
    density[i] = 2000.0;
    dvol[i] = 1.0;
  }
  pw_stress_args a = {.n = N,
                      .ld = N,
                      .ldi = N,
                      .dstrain = de[0],
                      .spin = spin[0],
                      .dvol = dvol,
                      .density = density,
                      .stress = stress[0],
                      .wave_speed = speed};
  assert_int_equal(pw_material_find("linear_elastic")->update(param, &a), PW_RETRY_STRESS);
  assert_int_equal(a.bad, 4);
  assert_near(stress[1][4], 7.0, 0.0);
  assert_near(stress[0][6], 0.0, 0.0);
  assert_relative(stress[0][5], 1e-3 * (lambda + 2 * mu), 1e-14);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(strains_give_hookes_stress),
                                     cmocka_unit_test(finite_simple_shear),
                                     cmocka_unit_test(rotation_has_the_sign_of_the_spin),
                                     cmocka_unit_test(ten_turns_keep_the_invariants),
                                     cmocka_unit_test(plane_and_general_rotation_agree),
                                     cmocka_unit_test(tangent_is_the_elastic_matrix),
                                     cmocka_unit_test(uniaxial_stress),
                                     cmocka_unit_test(a_bad_point_is_reported)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
