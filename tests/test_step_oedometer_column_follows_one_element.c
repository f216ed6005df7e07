/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A CPDI column of hypoplastic sand with intergranular strain, without weight, is loaded slowly
 * from zero to 160 kPa between rollers; the same path of one element of material gives the void
 * ratio it must end with. An independent program: 0.6330 for the column, 0.63305 for the element,
 * from e = 0.65. */
#include "kernels/element_driver.h"
#include "tests/engine_scenes.h"

static const double pressure = 160e3, height = 1.0;

/* Void ratio of one element at the vertical pressure, and its ratio of stresses. */
static void one_element(const pw_scene_material *m, double *e, double *k0)
{
  const double start[6] = {0.0}, de[6] = {0.0, -1e-6, 0.0, 0.0, 0.0, 0.0};
  pw_element el;
  assert_ok(pw_element_start(&el, m->model, m->param, start));
  while (-el.stress[1] < pressure) {
    assert_ok(pw_element_move(&el, de, NULL, NULL));
  }
  *e = el.state[0];
  *k0 = el.stress[0] / el.stress[1];
}

static void void_ratio_at_160_kpa(void **state)
{
  (void)state;
  static pw_scene s;
  double h = height / 8.0, want, want_k0;
  pw_scene_default(&s);
  test_grid(&s, (pw_real[]){0.0, h, 0.0, height}, h);
  int m = test_sand(&s, true);
  one_element(&s.material[m], &want, &want_k0);
  test_rectangle(&s, m, (pw_real[]){0.0, h, 0.0, height}, 0.5 * h);
  test_roller(&s, PW_SIDE_LEFT);
  test_roller(&s, PW_SIDE_RIGHT);
  test_roller(&s, PW_SIDE_BOTTOM);
  pw_surcharge_param *p = pw_scene_add_effect(&s, "surcharge");
  p->body = 0;
  p->side = PW_SIDE_TOP;
  p->pressure_pa = pressure;
  p->ramp_s = 4.0;
  pw_damping_local_param *d = pw_scene_add_effect(&s, "damping_local");
  d->coefficient = 0.2;
  pw_sim *sim = test_sim(&s, 1);
  test_run_to(sim, 4.0);
  const pw_points *pt = &sim->points;
  double mean = 0.0, lo = 1.0, hi = 0.0, stress = 0.0, k0 = 0.0;
  for (pw_idx i = 0; i < pt->n; i++) {
    double e = pt->state[i];
    mean += e / pt->n;
    lo = fmin(lo, e);
    hi = fmax(hi, e);
    stress -= pt->stress[pt->ld + i] / pt->n;
    k0 += pt->stress[i] / pt->stress[pt->ld + i] / pt->n;
  }
  print_message("column: e %.5f (%.5f to %.5f) at %.2f kPa, K0 %.4f; one element: %.5f, %.4f\n",
                mean, lo, hi, 1e-3 * stress, k0, want, want_k0);
  assert_near(want, 0.63305, 2e-5);
  assert_relative(stress, pressure, 1e-3);
  assert_near(mean, want, 1e-4);
  assert_true(lo >= want - 5e-4 && hi <= want + 5e-4);
  assert_near(k0, want_k0, 0.005);
  pw_sim_destroy(&sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(void_ratio_at_160_kpa),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
