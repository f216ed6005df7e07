/* SPDX-License-Identifier: GPL-3.0-or-later */
/* `--set key.path=value`: changes values, makes keys, list entries and sections; its errors name
 * the entry. */
#include "tests/harness.h"

#include <stdlib.h>

#include "engine/effects/params.h"
#include "io/scene_file.h"

static const char text[] =
    "geometry: plane_strain\n"
    "grid: {size_m: [2, 2], cell_m: 0.1}\n"
    "time: {end_s: 1}\n"
    "materials:\n"
    "  rock: {model: linear_elastic, youngs_modulus_pa: 1e6, poisson_ratio: 0.3, density_kg_m3: "
    "1}\n"
    "bodies:\n"
    "  block: {material: rock, shape: rectangle, x_m: [0, 1], y_m: [0, 1], point_size_m: 0.05}\n"
    "output:\n"
    "boundary:\n"
    "  - {side: bottom, fix_y: true}\n";

static pw_scene scene;

static pw_status read_with(int n, const char *const *set, char **messages)
{
  return pw_scene_read_text(text, sizeof text - 1, "text", n, set, &scene, messages);
}

static void values_are_changed_and_made(void **state)
{
  (void)state;
  static const char *const set[] = {
      "time.end_s=0.25",
      "time.end_s=0.5", /* the last one counts */
      "time.cfl=.3",
      "grid.size_m=[3, 2.5]",
      "grid.size_m.1=2",
      "grid.origin_m.0=-1",
      "grid.origin_m.1=-0.5",
      "title=a: b = c",
      "materials.rock.poisson_ratio=0.25",
      "bodies.block.point_size_m=0.1",
      "bodies.block.refine.0={x_m: [0, 1], y_m: [0, 1], point_size_m: 0.05}",
      "output.picture_times_s=[0.1, 0.2]",
      "output.pictures=false",
      "boundary.0.side=left",
      "boundary.1.side=right",
      "boundary.1.fix_x=true",
      "boundary.1.body=block",
      "gravity.acceleration_m_s2=10",
  };
  char *messages = NULL;
  pw_status status = read_with(sizeof set / sizeof set[0], set, &messages);
  assert_null(messages);
  assert_ok(status);
  assert_near(scene.time.end_s, 0.5, 0);
  assert_near(scene.time.cfl, 0.3, 0);
  assert_near(scene.grid.size_m[0], 3, 0);
  assert_near(scene.grid.size_m[1], 2, 0);
  assert_near(scene.grid.origin_m[0], -1, 0);
  assert_near(scene.grid.origin_m[1], -0.5, 0);
  assert_string_equal(scene.title, "a: b = c");
  assert_near(scene.material[0].param[1], 0.25, 0);
  assert_near(scene.body[0].point_size_m, 0.1, 0);
  assert_int_equal(scene.body[0].nrefine, 1);
  assert_near(scene.body[0].refine[0].point_size_m, 0.05, 0);
  assert_int_equal(scene.output.picture_times_s.n, 2);
  assert_false(scene.output.pictures);
  assert_int_equal(scene.neffect, 3);
  const pw_boundary_param *side = (const void *)scene.effect[0].param;
  assert_int_equal(side->side, PW_SIDE_LEFT);
  assert_true(side->fix_y);
  side = (const void *)scene.effect[1].param;
  assert_int_equal(side->side, PW_SIDE_RIGHT);
  assert_true(side->fix_x);
  assert_int_equal(side->body, 0);
  const pw_gravity_param *gravity = pw_scene_find_effect(&scene, "gravity");
  assert_near(gravity->acceleration_m_s2, 10, 0);
}

static void errors_name_the_entry(void **state)
{
  (void)state;
  static const char *const cases[][2] = {
      {"novalue", "--set novalue: error: expected key.path=value\n"},
      {"=1", "--set =1: error: expected key.path=value\n"},
      {"time..cfl=1", "--set time..cfl=1: error: expected names and list indices"},
      {".cfl=1", "--set .cfl=1: error: expected names and list indices"},
      {"a.b.c.d.e.f.g.h.i=1", "error: expected names and list indices"},
      {"time.cfl=2", "--set time.cfl=2: error: 'cfl' = 2 is out of range: it must be > 0 and <= "
                     "0.95\n"},
      {"time.cfl=", "--set time.cfl=: error: 'cfl' has no value\n"},
      {"time.end_s=soon", "--set time.end_s=soon: error: 'end_s' must be a number, found 'soon'\n"},
      {"time.clf=0.1",
       "--set time.clf=0.1: error: unknown key 'clf' in time; did you mean 'cfl'?\n"},
      {"time.cfl.x=1", "--set time.cfl.x=1: error: 'cfl' must be a number, found a mapping\n"},
      {"time.end_s.x=1", "--set time.end_s.x=1: error: 'end_s' is a value, it has no 'x'\n"},
      {"grid.size_m=[1, 2", "--set grid.size_m=[1, 2: error: not valid YAML"},
      {"grid.size_m=[1]", "--set grid.size_m=[1]: error: 'size_m' must be two numbers"},
      {"boundary.2.side=left", "--set boundary.2.side=left: error: '2' must be the index of one of "
                               "1 list entries, or 1 to append\n"},
      {"boundary.left.fix_x=true", "error: 'left' must be the index of one of 1 list entries"},
      {"surcharge.0.body=block",
       "--set surcharge.0.body=block: error: missing key 'pressure_pa' in "
       "surcharge.0"},
      {"gravty.ramp_s=1",
       "--set gravty.ramp_s=1: error: unknown key 'gravty' in the scene; did you "
       "mean 'gravity'?\n"},
      {"bodies.block.y_m=[0, 3]", "text:7:3: error: body 'block' leaves the grid"},
      {"bodies.block.point_size_m=1",
       "--set bodies.block.point_size_m=1: error: point_size_m = 1 m "
       "is larger than 4 cells"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char *messages = NULL;
    pw_status status = read_with(1, &cases[i][0], &messages);
    if (status != PW_ERR_SCENE || !messages || !strstr(messages, cases[i][1])) {
      fail_msg("%s gives %d:\n%s\nexpected: %s", cases[i][0], status, messages ? messages : "",
               cases[i][1]);
    }
    free(messages);
  }
}

/* Errors of the file come first, then those of the entries in their order. */
static void errors_are_in_order(void **state)
{
  (void)state;
  static const char *const set[] = {"time.cfl=3", "bodies.block.material=stone", "method.basis=x"};
  char *messages = NULL;
  assert_int_equal(pw_scene_read_text("geometry: none\n", 15, "text", 3, set, &scene, &messages),
                   PW_ERR_SCENE);
  const char *file = strstr(messages, "text:1:11: error: 'geometry'");
  const char *first = strstr(messages, "--set time.cfl=3: error: ");
  const char *third = strstr(messages, "--set method.basis=x: error: 'basis' must be one of");
  assert_true(file && first && third && file < first && first < third);
  free(messages);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_are_changed_and_made),
      cmocka_unit_test(errors_name_the_entry),
      cmocka_unit_test(errors_are_in_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
