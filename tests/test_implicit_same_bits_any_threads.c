/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of patches, their colours, and steps whose results are bitwise the same on 1 to 4 threads. */
#include "engine/step_newton.h"
#include "tests/tet_helpers.h"

static void blocks_hold_whole_patches(void **state)
{
  (void)state;
  const pw_idx sizes[] = {1, 8, 30, 10000};
  pw_tet_box box = test_cube(5, 1.0, 6, 10);
  pw_tet_mesh mesh = test_box_mesh(&box);
  for (int i = 0; i < 4; i++) {
    pw_blocks b;
    assert_ok(pw_patch_blocks_create(&mesh.tets, 8, NULL, sizes[i], &b));
    assert_ok(pw_patch_blocks_check(&mesh.tets, 8, &b));
    assert_int_equal(b.nelem, mesh.npatch);
    assert_int_equal(b.elem_start[b.nblock], mesh.npatch);
    for (pw_idx k = 0; k < b.nblock; k++) {
      for (pw_idx l = b.elem_start[k]; l < b.elem_start[k + 1]; l++) {
        assert_int_equal(b.elem_block[b.elem[l]], k);
      }
    }
    if (b.nblock > 20) { /* the check finds a colour that is wrong */
      b.colour[1] = b.colour[0];
      b.colour[2] = b.colour[0];
      memset(b.colour, 0, (size_t)b.nblock * sizeof *b.colour);
      assert_int_equal(pw_patch_blocks_check(&mesh.tets, 8, &b), PW_ERR_ARGUMENT);
    }
    pw_blocks_destroy(&b);
  }
  pw_tet_mesh_destroy(&mesh);
}

static void press(void *ctx, pw_tet_model *m, pw_real t0, pw_real t1)
{
  const pw_tets *t = &m->mesh->tets;
  const double top = *(const double *)ctx;
  for (pw_idx a = 0; a < t->nnode; a++) {
    bool punch = t->x[t->nnode + a] == top && t->x[a] < 0.51;
    m->prescribed[t->nnode + a] = punch ? -0.01 * (t1 - t0) : 0.0;
  }
}

typedef struct {
  double force[8000], stress[100000], x[50000];
  pw_off nnz;
  double value[400000];
} outcome;

static void run(int threads, pw_fbar fbar, bool more, outcome *out)
{
  pw_tet_box box = test_cube(3, 1.0, 6, 10);
  pw_tet_mesh mesh = test_box_mesh(&box);
  pw_tet_material vm = test_von_mises(1e3, 0.49, "undrained_shear_strength_pa", 5.0, 0.0);
  pw_idx body[6 * 27];
  for (pw_idx p = 0; p < 6 * 27; p++) { /* the top layer of bricks is empty */
    body[p] = p / 18 % 3 < 2 ? 0 : -1;
  }
  pw_tet_fill fill = {.rule = PW_TET_RULE_FOUR, .body = body, .nmaterial = 1, .material = &vm};
  pw_tet_setup setup = {.mesh = &mesh, .fill = &fill, .fbar = fbar, .threads = threads};
  pw_newton_options options = pw_newton_defaults();
  setup.ghost = more ? 30.0 : 0.0;
  options.newmark = more ? pw_newmark_defaults() : options.newmark;
  double top = 0.0;
  pw_newton_load load = {.ctx = &top, .step_s = 0.01, .apply = press};
  pw_newton_report report;
  pw_newton *newton;
  pw_tet_model m;
  assert_ok(pw_tet_model_create(&setup, &m));
  const pw_idx n = mesh.tets.nnode;
  for (pw_idx a = 0; a < n; a++) { /* top of the points: the level of nodes at two thirds */
    double y = mesh.tets.x[n + a];
    top = fabs(y - 2.0 / 3.0) < 1e-9 ? y : top;
  }
  for (pw_idx a = 0; a < n; a++) {
    double y = mesh.tets.x[n + a];
    for (int c = 0; c < 3; c++) {
      double x = mesh.tets.x[c * n + a];
      m.fixed[c * n + a] = y == 0.0 || (c != 1 && (x == 0.0 || x == 1.0));
    }
    m.fixed[n + a] |= y == top && mesh.tets.x[a] < 0.51;
  }
  assert_ok(pw_newton_create(&m, &options, &newton));
  pw_off before = 0;
  for (int k = 0; k < 2; k++) {
    assert_ok(pw_newton_step(newton, &load, &report));
    assert_true(k == 0 || pw_mem_count() == before); /* steps allocate nothing */
    before = pw_mem_count();
  }
  assert_true(3 * n <= 8000 && 6 * m.points.ld <= 100000 && m.csr.start[m.csr.n] <= 400000);
  memset(out, 0, sizeof *out);
  memcpy(out->force, m.force, 3 * (size_t)n * sizeof(double));
  memcpy(out->stress, m.points.stress, 6 * (size_t)m.points.ld * sizeof(double));
  memcpy(out->x, m.points.x, 3 * (size_t)m.points.ld * sizeof(double));
  out->nnz = m.csr.start[m.csr.n];
  memcpy(out->value, m.csr.value, (size_t)out->nnz * sizeof(double));
  pw_newton_destroy(&newton);
  pw_tet_model_destroy(&m);
  pw_tet_mesh_destroy(&mesh);
}

/* Quasi-static, and with inertia and ghost stabilisation. */
static void threads_do_not_change_a_bit(void **state)
{
  (void)state;
  static outcome first, now;
  for (int fbar = PW_FBAR_NONE; fbar <= PW_FBAR_INCREMENT; fbar++) {
    for (int more = 0; more < 2; more++) {
      run(1, (pw_fbar)fbar, more, &first);
      for (int threads = 2; threads <= 4; threads += 2) {
        run(threads, (pw_fbar)fbar, more, &now);
        assert_memory_equal(&now, &first, sizeof now);
      }
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blocks_hold_whole_patches),
      cmocka_unit_test(threads_do_not_change_a_bit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
