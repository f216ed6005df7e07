/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A UMAT for von Mises plasticity gives what the built-in models give where the equations are the
 * same: Hooke's law in rate form (linear_elastic), perfect plasticity in rate form (drucker_prager
 * without friction), and hardening on paths without rotation and change of volume, where the
 * Kirchhoff stress over the logarithmic strain of hencky_von_mises is the true stress. A routine
 * that takes the deformation gradient is hencky_von_mises on every path. */
#include "engine/element_test.h"
#include "tests/engine_helpers.h"
#include "tests/umat_helpers.h"

enum { ROWS = 700 };

/** Stresses, plastic strain and tangent-driven lateral strains of a test. */
typedef struct curve {
  int n;
  pw_real stress[ROWS][6], strain[ROWS][6], plastic[ROWS];
} curve;

static pw_status keep(void *ctx, const pw_element_row *row)
{
  curve *c = ctx;
  assert_true(c->n < ROWS);
  memcpy(c->stress[c->n], row->el->stress, sizeof *c->stress);
  memcpy(c->strain[c->n], row->el->strain, sizeof *c->strain);
  const bool user = strcmp(row->el->material->name, "umat") == 0;
  c->plastic[c->n++] = row->el->state[user ? PW_UMAT_OWN : 0];
  return PW_OK;
}

static pw_scene_material built_in(const char *name, const char *const *key, const double *value)
{
  pw_scene_material m = {.name = "soil", .model = pw_material_find(name)};
  assert_non_null(m.model);
  pw_scene_defaults(m.model->keys, m.param);
  umat_number(&m, "youngs_modulus_pa", 1e7);
  umat_number(&m, "poisson_ratio", 0.3);
  umat_number(&m, "density_kg_m3", 1800.0);
  for (int i = 0; key[i]; i++) {
    umat_number(&m, key[i], value[i]);
  }
  return m;
}

static void run(const pw_scene_material *m, pw_element_stage stage, double pressure, curve *c)
{
  static pw_element_test t;
  memset(&t, 0, sizeof t);
  t.material = *m;
  t.nstage = 1;
  t.stage[0] = stage;
  t.stage[0].steps = 100;
  for (int k = 0; k < 3; k++) {
    t.stress_pa[k] = -pressure;
  }
  c->n = 0;
  assert_ok(pw_element_test_run(&t, keep, c));
}

static void compare(const pw_scene_material *a, const pw_scene_material *b, pw_element_stage stage,
                    double pressure, double scale, bool plastic)
{
  static curve one, other;
  run(a, stage, pressure, &one);
  run(b, stage, pressure, &other);
  assert_int_equal(one.n, other.n);
  for (int i = 0; i < one.n; i++) {
    for (int c = 0; c < 6; c++) {
      assert_near(one.stress[i][c], other.stress[i][c], 1e-10 * scale);
      assert_near(one.strain[i][c], other.strain[i][c], 1e-10);
    }
    assert_true(!plastic || fabs(one.plastic[i] - other.plastic[i]) <= 1e-10);
  }
  assert_true(!plastic || one.plastic[one.n - 1] > 1e-3);
}

static const pw_element_stage undrained = {
    .kind = PW_STAGE_TRIAXIAL, .to_strain = {3, {-0.1, 0.05, -0.05}}, .cycles = 2};
static const pw_element_stage shear = {
    .kind = PW_STAGE_SIMPLE_SHEAR, .drained = true, .to_strain = {2, {0.5, -0.2}}, .cycles = 1};
static const pw_element_stage biaxial = {
    .kind = PW_STAGE_BIAXIAL, .drained = true, .to_strain = {2, {-0.01, 0.01}}, .cycles = 1};

static void elastic_paths_are_those_of_linear_elastic(void **state)
{
  (void)state;
  const char *const none[] = {NULL};
  pw_scene_material user = umat_material("umat_elastic_", 0.0, 0.0);
  pw_scene_material own = built_in("linear_elastic", none, NULL);
  compare(&user, &own, shear, 1e5, 1e5, false);
  compare(&user, &own, biaxial, 1e5, 1e5, false);
}

static void perfect_plasticity_is_that_of_drucker_prager(void **state)
{
  (void)state;
  const char *const key[] = {"friction_angle_deg", "cohesion_pa", NULL};
  const double value[] = {0.0, 2.5e4}; /* matched in compression: yield stress 2 c */
  pw_scene_material user = umat_material("", 5e4, 0.0);
  pw_scene_material own = built_in("drucker_prager", key, value);
  compare(&user, &own, shear, 1e5, 1e5, true);
  compare(&user, &own, undrained, 1e5, 1e5, true);
  pw_element_stage held = biaxial; /* up to 99 % of the strength under held lateral stress */
  held.to_strain = (pw_reals){2, {-0.004, 0.002}};
  compare(&user, &own, held, 1e5, 1e5, false);
}

static void hardening_is_that_of_hencky_von_mises(void **state)
{
  (void)state;
  const char *const key[] = {"yield_uniaxial_pa", "hardening_modulus_pa", NULL};
  const double value[] = {5e4, 5e5};
  pw_scene_material user = umat_material("umat_", 5e4, 5e5);
  pw_scene_material own = built_in("hencky_von_mises", key, value);
  compare(&user, &own, undrained, 0.0, 1e5, true);
}

/* A block that falls on a rough floor, in steps of a given length; a cylinder with PW_AXI. */
static void fall_with(const pw_scene_material *m, int geometry, bool fbar, int threads,
                      pw_sim **out)
{
  static pw_scene s;
  pw_scene_default(&s);
  s.geometry = geometry;
  s.time.dt_s = 5e-4;
  test_grid(&s, (pw_real[]){0.0, 1.2, 0.0, 1.0}, 0.1);
  s.material[s.nmaterial++] = *m;
  pw_scene_body *b = test_rectangle(&s, 0, (pw_real[]){0.3, 0.9, 0.0, 0.6}, 0.05);
  b->velocity_m_s[1] = -2.0;
  b->velocity_m_s[0] = 0.5;
  if (fbar) {
    ((pw_fbar_param *)pw_scene_add_effect(&s, "fbar"))->body = -1;
  }
  pw_boundary_param *floor = pw_scene_add_effect(&s, "boundary");
  assert_non_null(floor);
  floor->side = PW_SIDE_BOTTOM;
  floor->fix_x = floor->fix_y = true;
  *out = test_sim(&s, threads);
  test_run_to(*out, 0.03);
}

static void fall(const pw_scene_material *m, int threads, pw_sim **out)
{
  fall_with(m, PW_PLANE, false, threads, out);
}

/* A routine that takes DFGRD0 and DFGRD1 gets those of F-bar where there is one: its stress is that
 * of hencky_von_mises, and their ratio of volumes that of the material. */
static void finite_strain_is_that_of_hencky_von_mises(void **state)
{
  (void)state;
  const char *const key[] = {"yield_uniaxial_pa", "hardening_modulus_pa", NULL};
  const double value[] = {1e4, 5e5};
  pw_scene_material user = umat_material("umat_hencky_", 1e4, 5e5);
  pw_scene_material own = built_in("hencky_von_mises", key, value);
  umat_number(&user, "nstatv", 7);
  umat_number(&user, "ddsdde_measure", 1);
  umat_number(&user, "thread_safe", 1);
  compare(&user, &own, shear, 0.0, 1e5, true);
  compare(&user, &own, biaxial, 0.0, 1e5, true);
  for (int k = 0; k < 8; k++) {
    pw_sim *a = NULL, *b = NULL;
    fall_with(&user, k & 1 ? PW_AXI : PW_PLANE, k & 2, 1 + (k >> 2), &a);
    fall_with(&own, k & 1 ? PW_AXI : PW_PLANE, k & 2, 1 + (k >> 2), &b);
    pw_real plastic = 0.0, worst = 0.0;
    for (pw_idx i = 0; i < a->points.n; i++) {
      for (int c = 0; c < 6; c++) {
        pw_off at = (pw_off)c * a->points.ld + i;
        worst = pw_max(worst, fabs(a->points.stress[at] - b->points.stress[at]) / 1e5);
      }
      plastic = pw_max(plastic, a->points.state[(pw_off)PW_UMAT_OWN * a->points.ld + i]);
      assert_near(a->points.x[i], b->points.x[i], 1e-10);
    }
    print_message("%s F-bar %d: %.1e of 100 kPa, plastic strain %.2g\n", k & 1 ? "axi" : "plane",
                  (k & 2) / 2, worst, plastic);
    assert_true(worst <= 1e-10 && plastic > 1e-3);
    pw_sim_destroy(&a);
    pw_sim_destroy(&b);
  }
}

static void explicit_steps_give_the_same(void **state)
{
  (void)state;
  const char *const key[] = {"friction_angle_deg", "cohesion_pa", NULL};
  const double value[] = {0.0, 5e3};
  pw_scene_material user = umat_material("umat_", 1e4, 0.0);
  pw_scene_material own = built_in("drucker_prager", key, value);
  pw_sim *a = NULL, *b = NULL;
  fall(&user, 1, &a);
  fall(&own, 1, &b);
  pw_real plastic = 0.0;
  for (pw_idx i = 0; i < a->points.n; i++) {
    for (int c = 0; c < 6; c++) {
      pw_off at = (pw_off)c * a->points.ld + i;
      assert_near(a->points.stress[at], b->points.stress[at], 1e-10 * 1e5);
    }
    for (int c = 0; c < 2; c++) {
      pw_off at = (pw_off)c * a->points.ld + i;
      assert_near(a->points.x[at], b->points.x[at], 1e-10);
      assert_near(a->points.v[at], b->points.v[at], 1e-10);
    }
    plastic = pw_max(plastic, a->points.state[(pw_off)PW_UMAT_OWN * a->points.ld + i]);
  }
  assert_true(plastic > 1e-3);
  pw_sim_destroy(&a);
  pw_sim_destroy(&b);
}

/* Under the lock and without it, on one thread and on two. */
static void threads_give_the_same_bits(void **state)
{
  (void)state;
  pw_scene_material user = umat_material("umat_", 1e4, 1e5);
  pw_sim *first = NULL;
  fall(&user, 1, &first);
  for (int k = 0; k < 2; k++) {
    pw_sim *other = NULL;
    umat_number(&user, "thread_safe", k);
    fall(&user, 2, &other);
    const pw_points *p = &first->points, *q = &other->points;
    size_t real = sizeof(pw_real);
    assert_int_equal(p->ld, q->ld);
    for (pw_idx i = 0; i < p->n; i++) { /* blocks may differ: points by their number */
      pw_idx j = 0;
      while (q->id[j] != p->id[i]) {
        j++;
      }
      for (int c = 0; c < 6; c++) {
        pw_off at = (pw_off)c * p->ld;
        assert_memory_equal(&p->stress[at + i], &q->stress[at + j], real);
        assert_memory_equal(&p->state[at + 2 * p->ld + i], &q->state[at + 2 * p->ld + j], real);
      }
    }
    pw_sim_destroy(&other);
  }
  pw_sim_destroy(&first);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(elastic_paths_are_those_of_linear_elastic),
      cmocka_unit_test(perfect_plasticity_is_that_of_drucker_prager),
      cmocka_unit_test(hardening_is_that_of_hencky_von_mises),
      cmocka_unit_test(explicit_steps_give_the_same),
      cmocka_unit_test(finite_strain_is_that_of_hencky_von_mises),
      cmocka_unit_test(threads_give_the_same_bits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
