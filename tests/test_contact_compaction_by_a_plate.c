/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A cube of 0.8 m pressed down by 0.2 m under a rigid plate (C10), corner contact: with nu = 0 and
 * logarithmic strain the stress is uniform, sigma = E ln(0.75) / 0.75 = -383 576 Pa. A stiffness of
 * p_f E / h leaves an overlap of stress / stiffness, so an error ~ 1 / p_f. */
#include "engine/effects/contact_corner.h"
#include "tests/contact_helpers.h"

static const pw_real YOUNGS = 1e6, SIDE = 0.8, WIDTH = 0.1, CELL = 0.1, PUSH = 0.2, SPEED = 0.2;
static const pw_real RAMP = 0.2; /* of the plate's velocity; s */

/* The plate comes down by PUSH, stops, and the cube comes to rest. */
static pw_sim *press(pw_real factor)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  s.method.noise_damping_per_s = 50.0; /* points' velocities that the grid does not see */
  test_grid(&s, (pw_real[]){-CELL, WIDTH + CELL, 0.0, 1.2}, CELL);
  int soft = test_material(&s, "hencky_von_mises");
  test_param(&s, soft, "youngs_modulus_pa", YOUNGS);
  test_param(&s, soft, "poisson_ratio", 0.0);
  test_param(&s, soft, "density_kg_m3", 1000.0);
  test_param(&s, soft, "undrained_shear_strength_pa", 1e9); /* never yields */
  test_rectangle(&s, soft, (pw_real[]){0.0, WIDTH, 0.0, SIDE}, 0.5 * CELL);
  test_rectangle(&s, soft, (pw_real[]){-CELL, WIDTH + CELL, SIDE, SIDE + 0.2}, 0.5 * CELL);
  s.body[1].kind = PW_BODY_RIGID;
  test_add_contact(&s, TEST_CORNER, 1, 0, 0.0, 0.0, 0.0);
  pw_contact_corner_param *c = (void *)pw_scene_find_effect(&s, "contact_corner");
  c->normal_stiffness_pa_m = factor * YOUNGS / CELL;
  pw_prescribed_motion_param *p = pw_scene_add_effect(&s, "prescribed_motion");
  p->body = 1;
  p->velocity_m_s[1] = -SPEED;
  p->ramp_s = RAMP; /* what a contact that begins at speed overlaps at first makes no force */
  pw_damping_local_param *d = pw_scene_add_effect(&s, "damping_local");
  d->coefficient = 0.3;
  d->body = 0;
  const pw_real box[3][4] = {
      {-1.0, 2.0, -1.0, 0.0}, {-1.0, 0.0, -1.0, 2.0}, {WIDTH, 2.0, -1.0, 2.0}};
  for (int k = 0; k < 3; k++) { /* bottom, rollers left and right: else it buckles */
    pw_boundary_param *b = pw_scene_add_effect(&s, "boundary");
    b->side = PW_SIDE_BOX;
    memcpy(b->x_m, box[k], sizeof b->x_m);
    memcpy(b->y_m, box[k] + 2, sizeof b->y_m);
    b->fix_x = k > 0;
    b->fix_y = k == 0;
    b->body = -1;
  }
  pw_fbar_param *f = pw_scene_add_effect(&s, "fbar"); /* points of a cell share its strain */
  f->body = 0;
  pw_sim *sim = test_sim(&s, 1);
  p = (void *)pw_scene_find_effect(&sim->scene, "prescribed_motion");
  test_run_to(sim, PUSH / SPEED + 0.5 * RAMP);
  p->velocity_m_s[1] = 0.0;
  test_run_to(sim, PUSH / SPEED + 0.5 * RAMP + 0.5);
  return sim;
}

static void stress_is_uniform_and_exact(void **state)
{
  (void)state;
  const pw_real ratio = 1.0 - PUSH / SIDE, exact = YOUNGS * log(ratio) / ratio;
  pw_real last = 0.0;
  assert_near(exact, -383576.0, 1.0);
  for (int k = 0; k < 5; k++) {
    const pw_real factor = pow(10.0, k);
    pw_sim *sim = press(factor);
    const pw_points *p = &sim->points;
    pw_real mean = 0.0, worst = 0.0;
    for (pw_idx i = 0; i < p->n; i++) {
      mean += p->stress[p->ld + i] / p->n;
      worst = pw_max(worst, fabs(p->stress[p->ld + i] / exact - 1.0));
    }
    pw_real error = mean / exact - 1.0;
    print_message("p_f = %.0e: stress %.0f Pa, error %.4f %%, times p_f %.4f; of a point %.2f %%; "
                  "%lld steps\n",
                  factor, mean, 100.0 * error, error * factor, 100.0 * worst, (long long)sim->step);
    if (k == 2 ||
        k == 3) { /* ~ 1 / p_f; then what the jolt of the stop leaves: 0.02 mm, no force */
      assert_near(log10(error / last), -1.0, 0.1);
    }
    assert_true(k < 2 || worst < 0.01);
    last = error;
    pw_sim_destroy(&sim);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stress_is_uniform_and_exact),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
