/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of a run are whole PNG files with the right names, sizes and colours; what keeps
 * them from being drawn is named, and an old picture stays. */
#include <signal.h>
#include <sys/resource.h>

#include "io/history.h"
#include "io/pictures.h"
#include "tests/output_helpers.h"
#include "tests/output_scenes.h"

/* Width and height stand big-endian at bytes 16 and 20 (PNG specification, section 11.2.2). */
static void expect_png(const char *file, int width, int height)
{
  static const unsigned char end[8] = {'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
  test_bytes b = test_read(file);
  const unsigned char *u = (const unsigned char *)b.data;
  assert_true(b.size > 100);
  assert_memory_equal(b.data, "\x89PNG\r\n\x1a\n", 8);
  assert_memory_equal(b.data + b.size - 8, end, 8);
  assert_int_equal(u[18] << 8 | u[19], width);
  assert_int_equal(u[22] << 8 | u[23], height);
  free(b.data);
}

typedef struct pixel {
  int red, green, blue;
} pixel;

/* A pixel of a picture, counted from its upper left corner, as gnuplot reads it back. */
static pixel pixel_at(const char *folder, const char *name, int column, int row)
{
  pixel p = {-1, -1, -1};
  char command[3 * PW_PATH], line[256];
  const char *table = test_path(folder, "pixel.txt");
  snprintf(command, sizeof command,
           "gnuplot -e \"set table '%s'; plot '%s/%s' binary filetype=png every ::%d:%d:%d:%d with "
           "rgbimage\" 2>/dev/null",
           table, folder, name, column, row, column, row);
  assert_int_equal(system(command), 0);
  FILE *file = fopen(table, "r");
  assert_non_null(file);
  while (fgets(line, sizeof line, file)) {
    if (line[0] != '#') {
      sscanf(line, "%*d %*d %d %d %d", &p.red, &p.green, &p.blue);
    }
  }
  fclose(file);
  assert_true(p.red >= 0);
  return p;
}

static void expect_pixel(pixel p, int red, int green, int blue)
{
  assert_int_equal(p.red, red);
  assert_int_equal(p.green, green);
  assert_int_equal(p.blue, blue);
}

/* The end of a palette, which gnuplot meets to a few parts of 255. */
static void expect_colour(pixel p, int red, int green, int blue)
{
  assert_in_range(p.red, red - 3, red + 3);
  assert_in_range(p.green + 3, green, green + 6);
  assert_in_range(p.blue, blue - 3, blue + 3);
}

static void sand_is_coloured_and_the_pile_grey(void **unused)
{
  (void)unused;
  static pw_scene scene;
  const char *folder = test_folder(), *name = "vertical_stress_t00.000s.png";
  test_pile_on_sand(&scene);
  pw_sim *sim = test_sim(&scene, 2);
  assert_ok(pw_pictures_fields(folder, sim));
  /* the grid of 4 m x 6 m: 1006 pixels high within margins of 104 and 90, 125 and 190 */
  expect_png(test_path(folder, name), 125 + 670 + 190, 1200);
  expect_png(test_path(folder, "radial_stress_t00.000s.png"), 985, 1200);
  expect_png(test_path(folder, "void_ratio_t00.000s.png"), 985, 1200);
  expect_png(test_path(folder, "mobilised_friction_angle_t00.000s.png"), 985, 1200);
  assert_false(test_exists(test_path(folder, "speed_t00.000s.png")));
  assert_false(test_exists(test_path(folder, "vertical_stress_t00.000s.png.gp")));
  expect_pixel(pixel_at(folder, name, 160, 400), 0xb8, 0xb8, 0xb8); /* 0.2 m, 4.2 m: pile */
  expect_pixel(pixel_at(folder, name, 500, 400), 255, 255, 255);    /* 2.2 m, 4.2 m: air */
  /* The stress falls from the surface at row 607 to the base at 1109; the darkest end of the
   * colours is #440154, the brightest #fde725, and green grows all the way between. */
  pixel surface = pixel_at(folder, name, 500, 612), middle = pixel_at(folder, name, 500, 860);
  pixel base = pixel_at(folder, name, 500, 1105);
  assert_true(surface.green > 200 && surface.red > 200);
  assert_true(middle.green > 100 && middle.green < 200);
  assert_true(base.green < 20 && base.blue > 60);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void a_window_cuts_the_picture(void **unused)
{
  (void)unused;
  static pw_scene scene;
  const char *folder = test_folder();
  test_pile_on_sand(&scene);
  scene.output.picture_x_m[1] = 2.0;
  scene.output.picture_y_m[0] = 2.9;
  scene.output.picture_y_m[1] = 3.1;
  pw_sim *sim = test_sim(&scene, 2);
  assert_ok(pw_pictures_fields(folder, sim));
  /* 885 x 88 pixels: so low that the colour bar stands below, in 110 pixels more */
  expect_png(test_path(folder, "void_ratio_t00.000s.png"), 1200, 88 + 104 + 90 + 110);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void elastic_scenes_show_other_fields(void **unused)
{
  (void)unused;
  static pw_scene scene;
  const char *folder = test_folder();
  const int basis[3] = {PW_LINEAR, PW_UGIMP, PW_CPDI};
  for (int k = 0; k < 3; k++) {
    test_flying_block(&scene, basis[k]);
    pw_sim *sim = test_sim(&scene, 2);
    sim->time = 1.5 + k;
    char name[64];
    assert_ok(pw_pictures_fields(folder, sim));
    snprintf(name, sizeof name, "speed_t0%d.500s.png", 1 + k);
    expect_png(test_path(folder, name), 1200, 295 + 104 + 90); /* 6 m x 2 m in 885 x 295 */
    /* the block, 2 m x 1 m in the middle of the height, from 1 m to 3 m */
    expect_pixel(pixel_at(folder, name, 150, 250), 255, 255, 255);
    assert_true(pixel_at(folder, name, 430, 250).red < 100);
    expect_pixel(pixel_at(folder, name, 640, 250), 255, 255, 255);
    pw_sim_destroy(&sim);
  }
  assert_true(test_exists(test_path(folder, "horizontal_stress_t01.500s.png")));
  assert_true(test_exists(test_path(folder, "mean_stress_t01.500s.png")));
  assert_false(test_exists(test_path(folder, "void_ratio_t01.500s.png")));
  test_remove_folder(folder);
}

static void write_history(const char *file)
{
  pw_history *h = NULL;
  for (int k = 0; k <= 100; k++) {
    pw_record r = {.n = 0};
    pw_record_put(&r, "time_s", 0.01 * k);
    pw_record_put(&r, "step", k);
    pw_record_put(&r, "penetration_m", k == 0 ? NAN : 0.02 * k);
    pw_record_put(&r, "kinetic_j", 1e4 * sin(0.1 * k));
    pw_record_put(&r, "strain_work_j", 5e3 * k);
    pw_record_put(&r, "pile_y_m", 3.0 - 0.02 * k);
    pw_record_put(&r, "absent_n", 0.0);
    if (k == 0) {
      assert_ok(pw_history_open(file, &r, &h));
    }
    assert_ok(pw_history_append(h, &r));
  }
  assert_ok(pw_history_close(&h));
}

/* A block at 1 m/s, later at 3 m/s: drawn at once with the range so far, at the end both pictures
 * have the range from 1 to 3 m/s, the ends of the colours. */
static void one_colour_range_for_all_pictures_of_a_run(void **unused)
{
  (void)unused;
  static pw_scene scene;
  const char *folder = test_folder(), *early = "speed_t00.000s.png", *late = "speed_t01.000s.png";
  test_flying_block(&scene, PW_CPDI);
  pw_sim *sim = test_sim(&scene, 1);
  for (int k = 0; k < 2; k++) {
    for (pw_idx i = 0; i < sim->points.n; i++) {
      sim->points.v[i] = 1.0 + 2.0 * k;
      sim->points.v[sim->points.ld + i] = 0.0;
    }
    sim->time = k;
    assert_ok(pw_pictures_fields(folder, sim));
    assert_true(test_exists(
        test_path(folder, k == 0 ? "speed_t00.000s.png.field" : "speed_t01.000s.png.field")));
  }
  pixel before = pixel_at(folder, early, 420, 251), last = pixel_at(folder, late, 420, 251);
  assert_true(before.green > 100); /* alone: the middle of its range */
  expect_colour(last, 0xfd, 0xe7, 0x25);
  assert_ok(pw_pictures_finish(folder));
  expect_colour(pixel_at(folder, early, 420, 251), 0x44, 0x01, 0x54);
  expect_colour(pixel_at(folder, late, 420, 251), 0xfd, 0xe7, 0x25);
  assert_false(test_exists(test_path(folder, "speed_t00.000s.png.field")));
  assert_false(test_exists(test_path(folder, "speed_t01.000s.png.field")));
  assert_ok(pw_pictures_finish(folder)); /* nothing left to do */
  assert_ok(pw_pictures_finish("/nowhere"));
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void curves_of_the_columns_there_are(void **unused)
{
  (void)unused;
  const char *folder = test_folder(), *file = test_path(folder, "it's history.csv");
  write_history(file);
  assert_ok(pw_pictures_curves(folder, file, "A 'quoted' title with {braces}_and $signs"));
  expect_png(test_path(folder, "penetration.png"), 1200, 720);
  expect_png(test_path(folder, "energy.png"), 1200, 720);
  expect_png(test_path(folder, "position.png"), 1200, 720);
  assert_false(test_exists(test_path(folder, "force.png"))); /* zero all the time */
  test_write(file, "a,b\n", 4);
  assert_int_equal(pw_pictures_curves(folder, file, ""), PW_ERR_FILE);
  assert_error_says(file);
  assert_int_equal(pw_pictures_curves(folder, "/nowhere.csv", ""), PW_ERR_FILE);
  assert_error_says("/nowhere.csv");
  test_remove_folder(folder);
}

static void without_gnuplot_the_package_is_named(void **unused)
{
  (void)unused;
  static pw_scene scene;
  const char *folder = test_folder();
  char path[8192];
  snprintf(path, sizeof path, "%s", getenv("PATH"));
  test_flying_block(&scene, PW_LINEAR);
  pw_sim *sim = test_sim(&scene, 1);
  setenv("PATH", folder, 1);
  pw_status status = pw_pictures_fields(folder, sim);
  setenv("PATH", path, 1);
  assert_int_equal(status, PW_ERR_UNSUPPORTED);
  assert_error_says("gnuplot-nox");
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void no_room_keeps_the_old_picture(void **unused)
{
  (void)unused;
  static pw_scene scene;
  struct rlimit limit;
  const char *folder = test_folder(), *file = test_path(folder, "vertical_stress_t00.000s.png");
  test_flying_block(&scene, PW_LINEAR);
  scene.body[0].point_size_m = 0.5; /* few points: the script stays below the limit */
  pw_sim *sim = test_sim(&scene, 1);
  assert_ok(pw_pictures_fields(folder, sim));
  test_bytes before = test_read(file);
  signal(SIGXFSZ, SIG_IGN);
  getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = 6000;
  setrlimit(RLIMIT_FSIZE, &limit);
  pw_status status = pw_pictures_fields(folder, sim);
  limit.rlim_cur = RLIM_INFINITY;
  setrlimit(RLIMIT_FSIZE, &limit);
  assert_int_equal(status, PW_ERR_FILE);
  assert_error_says(file);
  assert_false(test_exists(test_path(folder, "vertical_stress_t00.000s.png.part")));
  assert_false(test_exists(test_path(folder, "vertical_stress_t00.000s.png.gp")));
  test_bytes after = test_read(file);
  assert_int_equal(after.size, before.size);
  assert_memory_equal(after.data, before.data, before.size);
  free(before.data);
  free(after.data);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

static void an_unusable_folder_is_named(void **unused)
{
  (void)unused;
  static pw_scene scene;
  const char *folder = test_folder(), *file = test_path(folder, "plain");
  test_flying_block(&scene, PW_LINEAR);
  pw_sim *sim = test_sim(&scene, 1);
  test_write(file, "x", 1);
  assert_int_equal(pw_pictures_fields(test_path(file, "pictures"), sim), PW_ERR_FILE);
  assert_error_says(file);
  pw_sim_destroy(&sim);
  test_remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sand_is_coloured_and_the_pile_grey),
      cmocka_unit_test(a_window_cuts_the_picture),
      cmocka_unit_test(elastic_scenes_show_other_fields),
      cmocka_unit_test(one_colour_range_for_all_pictures_of_a_run),
      cmocka_unit_test(curves_of_the_columns_there_are),
      cmocka_unit_test(without_gnuplot_the_package_is_named),
      cmocka_unit_test(no_room_keeps_the_old_picture),
      cmocka_unit_test(an_unusable_folder_is_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
