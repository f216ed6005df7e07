/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The whole state, as a checkpoint would hold it, is the same bytes for 1, 2, 3 and 4 threads: two
 * discs that fly through the blocks of the grid and collide, by every update, and a pile struck
 * into sand, by every contact. */
#include "tests/engine_scenes.h"

#include <stdlib.h>

/* An archive in memory: every value written, one after another. */
typedef struct {
  pw_archive base;
  size_t used, size;
  unsigned char *bytes;
} memory;

static pw_status keep(pw_archive *ar, const void *value, size_t size)
{
  memory *m = (memory *)ar;
  if (m->used + size > m->size) {
    m->size = 2 * (m->used + size);
    m->bytes = realloc(m->bytes, m->size);
    assert_non_null(m->bytes);
  }
  memcpy(m->bytes + m->used, value, size);
  m->used += size;
  return PW_OK;
}

static pw_status keep_real(pw_archive *ar, const char *name, pw_real *value, pw_off count)
{
  (void)name;
  return keep(ar, value, (size_t)count * sizeof *value);
}

static pw_status keep_index(pw_archive *ar, const char *name, pw_idx *value, pw_off count)
{
  (void)name;
  return keep(ar, value, (size_t)count * sizeof *value);
}

static pw_status keep_offset(pw_archive *ar, const char *name, pw_off *value, pw_off count)
{
  (void)name;
  return keep(ar, value, (size_t)count * sizeof *value);
}

static memory state_after(const pw_scene *s, int threads, int steps, pw_report *report)
{
  memory m = {{false, keep_real, keep_index, keep_offset}, 0, 0, NULL};
  pw_sim *sim = test_sim(s, threads);
  for (int k = 0; k < steps; k++) {
    assert_ok(pw_sim_step(sim, 0.0));
  }
  assert_ok(pw_sim_archive(sim, &m.base));
  pw_sim_report(sim, report);
  pw_sim_destroy(&sim);
  return m;
}

static void compare(const pw_scene *s, const char *what, int steps, pw_off least_sorts)
{
  pw_report r;
  memory one = state_after(s, 1, steps, &r);
  print_message("%s: %d points in %d blocks, sorted %d times, %zu bytes\n", what, r.points,
                r.blocks, (int)r.sorts, one.used);
  assert_true(r.blocks > 4 && r.sorts >= least_sorts);
  for (int threads = 2; threads <= 4; threads++) {
    memory more = state_after(s, threads, steps, &r);
    assert_int_equal(more.used, one.used);
    assert_memory_equal(more.bytes, one.bytes, one.used);
    free(more.bytes);
  }
  free(one.bytes);
}

static void discs_that_collide(void **state)
{
  (void)state;
  static const char *const name[3] = {"musl", "usl", "usf"};
  for (int run = 0; run < 6; run++) {
    static pw_scene s;
    const int update = PW_MUSL + run % 3;
    pw_scene_default(&s);
    s.method.mass_terms = 1 + run / 3;
    test_grid(&s, (pw_real[]){0.0, 3.0, 0.0, 1.5}, 0.1);
    int m = test_neo_hookean(&s, 1e4, 5e3, 1e3);
    pw_scene_body *a = test_disc(&s, m, 0.7, 0.7, 0.3, 0.05);
    pw_scene_body *b = test_disc(&s, m, 1.9, 0.9, 0.3, 0.05);
    a->velocity_m_s[0] = 2.0;
    b->velocity_m_s[0] = -1.0;
    s.method.update = update;
    s.method.block_elements = 16;
    pw_damping_local_param *d = pw_scene_add_effect(&s, "damping_local");
    d->coefficient = 0.05;
    test_gravity(&s, 0.1);
    test_roller(&s, PW_SIDE_BOTTOM);
    compare(&s, name[update], 60, 3);
  }
}

static void pile_in_sand(void **state)
{
  (void)state;
  for (int contact = TEST_PENALTY; contact < TEST_CONTACTS; contact++) {
    static pw_scene s;
    test_hammered_pile(&s, contact, 0.125);
    compare(&s, test_contact_name[contact], 60, 1);
    if (!test_acts_on_nodes(contact)) {
      s.method.mass_terms = 2;
      compare(&s, "the same, two terms of the mass matrix", 60, 1);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(discs_that_collide),
      cmocka_unit_test(pile_in_sand),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
