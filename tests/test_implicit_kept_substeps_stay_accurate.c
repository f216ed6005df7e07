/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sand and clay take their substeps from an increment of the third iteration while Newton's method
 * converges (engine/newton_guide.h). At the end of every load step the stress of all points is compared,
 * over its size, with that of substeps chosen anew for the increment the iteration ended with, and both
 * with substeps of a tolerance a thousand times as small. The first difference has to be within the
 * tolerance of the integration, substep_tolerance = 1e-3, and the stress no further from that of small
 * substeps than one tolerance. */
#include "engine/implicit_state.h"
#include "tests/implicit_helpers.h"

enum { MOST = 4096 };

typedef struct {
  pw_implicit *sim;
  double *tolerance; /* of the material */
  double guide[PW_GUIDE_ROWS * MOST], kept[6 * MOST], anew[6 * MOST];
  double apart, off, off_anew; /* findings: kept from anew, kept from fine, anew from fine */
  int steps;
} watch;

/* Largest difference of a point's stress over its size. */
static double difference(const pw_tet_points *q, const double *a, const double *b)
{
  const size_t l = (size_t)q->ld;
  double most = 0.0;
  for (size_t i = 0; i < (size_t)q->n; i++) {
    double sum = 0.0, size = 0.0;
    for (size_t c = 0; c < 6; c++) {
      const double d = a[c * l + i] - b[c * l + i], twice = c < 3 ? 1.0 : 2.0;
      sum += twice * d * d;
      size += twice * b[c * l + i] * b[c * l + i];
    }
    most = fmax(most, sqrt(sum / size));
  }
  return most;
}

/* Stress at u with the substeps that the tolerance asks for. */
static void evaluate(watch *w, const double *u, double tolerance)
{
  const double was = *w->tolerance;
  *w->tolerance = tolerance;
  w->sim->model.guide.settled = false;
  assert_ok(pw_tet_model_evaluate(&w->sim->model, u, false));
  *w->tolerance = was;
}

static void look(void *ctx, const pw_real *u, pw_real r)
{
  watch *w = ctx;
  pw_tet_model *m = &w->sim->model;
  const size_t l = (size_t)m->points.ld;
  if (!m->guide.settled || r > 1e-9) {
    return;
  }
  memcpy(w->guide, m->guide.of, PW_GUIDE_ROWS * l * sizeof *w->guide);
  memcpy(w->kept, m->points.stress_trial, 6 * l * sizeof *w->kept);
  evaluate(w, u, *w->tolerance);
  memcpy(w->anew, m->points.stress_trial, 6 * l * sizeof *w->anew);
  evaluate(w, u, 1e-3 * *w->tolerance);
  w->apart = fmax(w->apart, difference(&m->points, w->kept, w->anew));
  w->off = fmax(w->off, difference(&m->points, w->kept, m->points.stress_trial));
  w->off_anew = fmax(w->off_anew, difference(&m->points, w->anew, m->points.stress_trial));
  w->steps++;
  memcpy(m->guide.of, w->guide, PW_GUIDE_ROWS * l * sizeof *w->guide);
  m->guide.settled = true;
  assert_ok(pw_tet_model_evaluate(m, u, true)); /* as it was */
  assert_memory_equal(m->points.stress_trial, w->kept, 6 * l * sizeof *w->kept);
}

static void run(const char *scene, int nset, const char *const *set, int steps)
{
  static watch w;
  pw_implicit *sim = test_implicit(scene, nset, set);
  w = (watch){.sim = sim};
  for (const pw_key *k = sim->material[0].model->keys; k->name; k++) {
    w.tolerance = strcmp(k->name, "substep_tolerance") == 0
                      ? sim->material[0].param + k->offset / sizeof(pw_real)
                      : w.tolerance;
  }
  assert_non_null(w.tolerance);
  assert_true(sim->model.points.ld <= MOST);
  pw_newton_watch(sim->newton, (pw_newton_watcher){.ctx = &w, .look = look});
  test_implicit_run(sim);
  print_message(
      "%s in %d steps, kept in %d: kept from anew %.1e, from fine ones %.1e, anew from fine "
      "ones %.1e, tolerance %.0e\n",
      scene, steps, w.steps, w.apart, w.off, w.off_anew, *w.tolerance);
  assert_true(w.steps >= steps / 2);
  assert_true(w.apart <= *w.tolerance && w.off <= *w.tolerance);
  pw_implicit_destroy(&sim);
}

static void differences_are_within_the_tolerance(void **state)
{
  (void)state;
  const char *const few[] = {"implicit.steps=5"};
  run("scenes/confined_sand.yaml", 1, few, 5);
  run("scenes/confined_sand.yaml", 0, NULL, 20);
  run("scenes/confined_clay.yaml", 1, few, 5);
  run("scenes/confined_clay.yaml", 0, NULL, 20);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(differences_are_within_the_tolerance),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
