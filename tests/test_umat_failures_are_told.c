/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A routine that stops, gives no numbers, asks for smaller steps or drops an increment: an error
 * that says so with the element as it was, or a step in pieces; wrong libraries and numbers of
 * constants are refused before anything runs. */
#include "engine/element_test.h"
#include "tests/engine_helpers.h"
#include "tests/umat_helpers.h"

/** A move fails, says @p words, and changes nothing but that. */
static void expect_failure(const char *symbol, const char *words)
{
  pw_scene_material m = umat_material(symbol, 0.0, 0.0);
  pw_element el = umat_element(&m, 1e5), before = el;
  const pw_real none[6] = {0}, de[6] = {1e-4, 0, 0, 2e-4, 0, 0};
  if (strcmp(symbol, "umat_writes_beyond_") != 0 && strcmp(symbol, "umat_reads_beyond_") != 0 &&
      strcmp(symbol, "umat_no_tangent_") != 0) {
    assert_ok(pw_element_move(&before, none, NULL, NULL)); /* well while nothing moves */
  }
  for (int k = 0; k < 3; k++) { /* and again: a failure leaves nothing behind */
    assert_int_equal(pw_element_move(&el, de, NULL, NULL), PW_RETRY_STRESS);
    if (!el.why || !strstr(el.why, words)) {
      fail_msg("%s: '%s' does not say '%s'", symbol, el.why ? el.why : "nothing", words);
    }
    assert_near(el.stress[0], -1e5, 0.0);
    assert_near(el.state[PW_UMAT_OWN], 0.0, 0.0);
    assert_near(el.strain[0], 0.0, 0.0);
  }
}

static void failures_become_errors(void **state)
{
  (void)state;
  expect_failure("umat_stop_", "ended with STOP: no convergence");
  expect_failure("umat_xit_", "called XIT");
  expect_failure("umat_reports_", "reported an error: bad constants");
  expect_failure("umat_nan_", "not a finite number");
  expect_failure("umat_reads_beyond_", "constants beyond nprops");
  expect_failure("umat_writes_beyond_", "wrote more state variables than nstatv");
  expect_failure("umat_never_content_", "PNEWDT");
  expect_failure("umat_lazy_", "a lost increment");
  expect_failure("umat_no_tangent_", "stiffness_bound_pa must be given");
}

/* 1.6e-3 in a step that the routine wants in pieces of 1e-4 at most: 16 of them. */
static void smaller_steps_are_made_when_asked_for(void **state)
{
  (void)state;
  pw_scene_material cut = umat_material("umat_small_steps_", 5e3, 5e5);
  pw_scene_material whole = umat_material("umat_", 5e3, 5e5);
  pw_element a = umat_element(&cut, 1e5), b = umat_element(&whole, 1e5);
  const pw_real de[6] = {-1.6e-3, 8e-4, 8e-4, 0, 0, 0};
  const pw_real part[6] = {-1e-4, 5e-5, 5e-5, 0, 0, 0};
  assert_ok(pw_element_move(&a, de, NULL, NULL));
  for (int k = 0; k < 16; k++) {
    assert_ok(pw_element_move(&b, part, NULL, NULL));
  }
  for (int c = 0; c < 6; c++) {
    assert_near(a.stress[c], b.stress[c], 1e-10 * 1e5);
  }
  assert_near(a.state[PW_UMAT_OWN], b.state[PW_UMAT_OWN], 1e-15);
  assert_int_equal(a.counts.substeps, 16);
  assert_true(a.counts.rejected > 0);
}

/* Flow at constant stress and strains too small to be seen are no lost increments. */
static void unchanged_stress_may_be_right(void **state)
{
  (void)state;
  pw_scene_material flow = umat_material("umat_", 5e4, 0.0);
  pw_element el = umat_element(&flow, 1e5);
  const pw_real de[6] = {-1e-2, 5e-3, 5e-3, 0, 0, 0}, tiny[6] = {1e-25, 0, 0, 0, 0, 0};
  for (int k = 0; k < 5; k++) { /* perfectly plastic: the tangent is zero along the path */
    assert_ok(pw_element_move(&el, de, NULL, NULL));
  }
  el = umat_element(&flow, 1e5);
  assert_ok(pw_element_move(&el, tiny, NULL, NULL));
  pw_scene_material lazy = umat_material("umat_lazy_", 0.0, 0.0);
  umat_number(&lazy, "unchanged_stress", 1);
  el = umat_element(&lazy, 1e5);
  assert_ok(pw_element_move(&el, de, NULL, NULL));
}

static pw_status ignore(void *ctx, const pw_element_row *row)
{
  (void)ctx, (void)row;
  return PW_OK;
}

/* In an element test and in a simulation the reason comes with its place. */
static void errors_say_where(void **state)
{
  (void)state;
  static pw_element_test t;
  static pw_scene s;
  pw_scene_material m = umat_material("umat_stop_", 0.0, 0.0);
  t.material = m;
  t.nstage = 1;
  t.stage[0] = (pw_element_stage){
      .kind = PW_STAGE_OEDOMETRIC, .to_strain = {1, {-0.01}}, .cycles = 1, .steps = 10};
  assert_int_equal(pw_element_test_run(&t, ignore, NULL), PW_RETRY_DIVERGED);
  assert_non_null(strstr(pw_error_text(), "stage 1, step 1: the UMAT ended with STOP"));
  pw_scene_default(&s);
  s.geometry = PW_PLANE;
  test_grid(&s, (pw_real[]){0.0, 1.0, 0.0, 1.0}, 0.1);
  s.material[s.nmaterial++] = m;
  test_rectangle(&s, 0, (pw_real[]){0.2, 0.8, 0.2, 0.8}, 0.05)->velocity_m_s[1] = -1.0;
  pw_boundary_param *floor = pw_scene_add_effect(&s, "boundary");
  assert_non_null(floor);
  floor->side = PW_SIDE_BOTTOM;
  floor->fix_x = floor->fix_y = true;
  for (int threads = 1; threads <= 2; threads++) {
    pw_sim *sim = test_sim(&s, threads);
    pw_status status = PW_OK;
    for (int k = 0; k < 2000 && status == PW_OK; k++) {
      status = pw_sim_step(sim, 0.0);
    }
    assert_int_equal(status, PW_RETRY_STRESS);
    assert_non_null(strstr(pw_error_text(), "STOP: no convergence: point"));
    pw_sim_destroy(&sim);
  }
}

static void refuses(const pw_scene_material *m, const char *words)
{
  pw_status status = m->model->check(m->param);
  status = status == PW_OK ? pw_umat_load(m->param) : status;
  assert_int_equal(status, PW_ERR_SCENE);
  if (strncmp(pw_error_text(), words, strlen(words)) != 0) {
    fail_msg("'%s' does not begin '%s'", pw_error_text(), words);
  }
}

static void bad_entries_are_refused(void **state)
{
  (void)state;
  const double list[3] = {1, 2, 3}, far[1] = {2};
  pw_scene_material m = umat_material("umat_", 5e4, 0.0), good = m;
  umat_word(&m, "library", "nowhere/umat.so");
  refuses(&m, "library: there is no file nowhere/umat.so");
  umat_word(&m, "library", "../LICENSE");
  refuses(&m, "library: cannot load it");
  m = good;
  umat_word(&m, "symbol", "umat_clay");
  refuses(&m, "symbol: there is no routine umat_clay in ");
  m = good;
  umat_number(&m, "nprops", 5);
  refuses(&m, "props holds 4 numbers, but nprops = 5");
  m = good;
  umat_list(&m, "statev_initial", 3, list);
  refuses(&m, "statev_initial holds 3 numbers, but nstatv = 1");
  m = good;
  umat_number(&m, "nstatv", 6);
  umat_list(&m, "statev_stress_tensors", 1, far);
  refuses(&m, "statev_stress_tensors: six variables from 2 on are not among nstatv = 6");
  m = good;
  umat_word(&m, "symbol", "UMAT_ELASTIC"); /* as Fortran writes it */
  assert_ok(pw_umat_load(m.param));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(failures_become_errors),
      cmocka_unit_test(smaller_steps_are_made_when_asked_for),
      cmocka_unit_test(unchanged_stress_may_be_right),
      cmocka_unit_test(errors_say_where),
      cmocka_unit_test(bad_entries_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
