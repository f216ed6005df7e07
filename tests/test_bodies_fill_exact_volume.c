/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Domains of a body have its exact volume, are right-handed and stay inside its outline but for
 * the overhang documented beside the shape. */
#include "tests/harness.h"

#include "engine/bodies.h"

static const double PI = 3.14159265358979323846;

static pw_scene scene_with(int geometry, pw_scene_body body)
{
  pw_scene s;
  memset(&s, 0, sizeof s);
  s.geometry = geometry;
  s.grid.size_m[0] = 5;
  s.grid.size_m[1] = 16;
  s.grid.cell_m = 0.125;
  s.nbody = 1;
  s.body[0] = body;
  return s;
}

static void half_of(const pw_domains *d, pw_idx i, double *half)
{
  for (int c = 0; c < 4; c++) {
    half[c] = d->half[c * d->n + i];
  }
  assert_true(half[0] * half[3] - half[1] * half[2] > 0); /* right-handed */
}

/* Sum of areas, in axisymmetry times the radius: volume per metre or per radian. */
static double volume(const pw_domains *d, bool axi)
{
  double sum = 0;
  for (pw_idx i = 0; i < d->n; i++) {
    double half[4];
    half_of(d, i, half);
    sum += pw_domain_area(half) * (axi ? d->x[i] : 1);
  }
  return sum;
}

/* Largest value of `outside` over all corners. */
static double overhang(const pw_domains *d, const pw_scene_body *b,
                       double (*outside)(const pw_scene_body *, double, double))
{
  double most = 0;
  for (pw_idx i = 0; i < d->n; i++) {
    double h[4];
    half_of(d, i, h);
    for (int k = 0; k < 4; k++) {
      double p = k % 2 ? 1 : -1, q = k / 2 ? 1 : -1;
      most = fmax(most,
                  outside(b, d->x[i] + p * h[0] + q * h[2], d->x[d->n + i] + p * h[1] + q * h[3]));
    }
  }
  return most;
}

static void a_rectangle_is_tiled_exactly(void **state)
{
  (void)state;
  pw_scene s = scene_with(PW_PLANE, (pw_scene_body){.shape = PW_SHAPE_RECTANGLE,
                                                    .x_m = {0.3, 1.37},
                                                    .y_m = {2, 2.9},
                                                    .point_size_m = 0.1});
  pw_domains d = {0};
  assert_int_equal(pw_domains_create(&s, &d), PW_OK);
  assert_int_equal(d.n, 11 * 9);
  assert_true(fabs(volume(&d, false) / (1.07 * 0.9) - 1) < 1e-12);
  assert_near(d.half[0], 1.07 / 22, 1e-15);
  assert_near(d.half[3 * d.n], 0.05, 1e-15);
  assert_near(d.x[0], 0.3 + 1.07 / 22, 1e-15);
  pw_domains_destroy(&d);
}

static double outside_disc(const pw_scene_body *b, double x, double y)
{
  return hypot(x - b->centre_m[0], y - b->centre_m[1]) - b->radius_m;
}

/* Polar moment pi R^4 / 2; a domain's own moment about its centre is A (r1^2 + r2^2) / 3. */
static void a_disc_has_its_area_and_moment(void **state)
{
  (void)state;
  const double size[4] = {0.8, 0.4, 0.2, 0.1};
  double error[4];
  for (int k = 0; k < 4; k++) {
    pw_scene s = scene_with(PW_PLANE, (pw_scene_body){.shape = PW_SHAPE_DISC,
                                                      .centre_m = {2, 3},
                                                      .radius_m = 1.6,
                                                      .point_size_m = size[k]});
    pw_domains d = {0};
    assert_int_equal(pw_domains_create(&s, &d), PW_OK);
    assert_true(fabs(volume(&d, false) / (PI * 1.6 * 1.6) - 1) < 1e-12);
    double moment = 0, centre[2] = {0, 0};
    for (pw_idx i = 0; i < d.n; i++) {
      double h[4], x = d.x[i] - 2, y = d.x[d.n + i] - 3;
      half_of(&d, i, h);
      double area = pw_domain_area(h);
      assert_true(2 * hypot(h[0], h[1]) <= size[k] + 1e-12);
      assert_true(2 * hypot(h[2], h[3]) <= size[k] + 1e-12);
      moment +=
          area * (x * x + y * y + (h[0] * h[0] + h[1] * h[1] + h[2] * h[2] + h[3] * h[3]) / 3);
      centre[0] += area * x;
      centre[1] += area * y;
    }
    assert_near(centre[0], 0, 1e-12);
    assert_near(centre[1], 0, 1e-12);
    error[k] = fabs(moment / (PI * pow(1.6, 4) / 2) - 1);
    /* 1 + 3 m (m + 1) points in m rings of thickness t = R / (m + 1/2); overhang below t / (5 m) */
    double rings = (sqrt(1 + 4 * (d.n - 1) / 3.0) - 1) / 2, t = 1.6 / (rings + 0.5);
    assert_true(overhang(&d, &s.body[0], outside_disc) < t / (5 * rings));
    pw_domains_destroy(&d);
  }
  assert_true(error[2] < 2e-5); /* the point size of the rolling cylinder */
  assert_true(error[0] < 1e-3 && error[3] < 1e-6);
}

/* Exact volumes: per metre 2 R L' + tip, per radian R^2 L' / 2 + tip, with the tips of ellipse and
 * ellipsoid (pi R H / 2, R^2 H / 3) and of triangle and cone (R H, R^2 H / 6). */
static double pile_volume(const pw_scene_body *b, double tip, bool axi)
{
  double r = b->radius_m, shaft = b->length_m - tip;
  if (axi) {
    return r * r * (shaft / 2 + (b->tip == PW_TIP_ROUNDED ? tip / 3 : tip / 6));
  }
  return 2 * r * shaft + (b->tip == PW_TIP_ROUNDED ? PI * r * tip / 2 : r * tip);
}

/* How far outside a pile with a hemisphere, a cone of height R or a flat end a place lies. */
static double outside_pile(const pw_scene_body *b, double x, double y)
{
  double r = fabs(x - b->centre_m[0]), shoulder = b->tip_y_m + b->radius_m;
  double side = fmax(r - b->radius_m, y - b->tip_y_m - b->length_m);
  if (b->tip == PW_TIP_FLAT) {
    return fmax(side, b->tip_y_m - y);
  }
  if (b->tip == PW_TIP_CONICAL) {
    return fmax(side, (r - b->radius_m - (y - shoulder)) / sqrt(2));
  }
  return y > shoulder ? side : hypot(r, y - shoulder) - b->radius_m;
}

static void a_pile_has_its_volume(void **state)
{
  (void)state;
  for (int kind = 0; kind < 2 * 3 * 3 * 5; kind++) {
    bool axi = kind % 2;
    int tip = kind / 2 % 3, columns = 1 + kind / 18;
    double height = tip == PW_TIP_FLAT ? 0 : 0.15 * (const double[]){1, 2, 0.5}[kind / 6 % 3];
    pw_scene s = scene_with(axi ? PW_AXI : PW_PLANE,
                            (pw_scene_body){.shape = PW_SHAPE_PILE,
                                            .radius_m = 0.15,
                                            .centre_m = {axi ? 0 : 2.3, 0},
                                            .tip_y_m = 10,
                                            .length_m = 5,
                                            .tip = tip,
                                            .tip_length_m = height == 0.15 ? NAN : height,
                                            .point_size_m = 0.15 / columns});
    pw_domains d = {0};
    assert_int_equal(pw_domains_create(&s, &d), PW_OK);
    assert_true(fabs(volume(&d, axi) / pile_volume(&s.body[0], height, axi) - 1) < 1e-12);
    if (height == 0 || height == 0.15) {
      double most = tip == PW_TIP_ROUNDED ? 0.15 * 0.15 / columns : 0;
      assert_true(overhang(&d, &s.body[0], outside_pile) <= most + 1e-12);
    }
    pw_domains_destroy(&d);
  }
}

static void a_domain_on_the_axis_has_r_equal_to_its_half_width(void **state)
{
  (void)state;
  pw_scene s = scene_with(PW_AXI, (pw_scene_body){.shape = PW_SHAPE_PILE,
                                                  .radius_m = 0.15,
                                                  .tip_y_m = 10,
                                                  .length_m = 5,
                                                  .tip = PW_TIP_ROUNDED,
                                                  .point_size_m = 0.05});
  s.nbody = 2;
  s.body[1] = (pw_scene_body){.shape = PW_SHAPE_RECTANGLE,
                              .x_m = {0, 5},
                              .y_m = {0, 10},
                              .point_size_m = 0.3,
                              .nrefine = 1,
                              .refine = {{{0, 1}, {2, 10}, 0.07}}};
  pw_domains d = {0};
  assert_int_equal(pw_domains_create(&s, &d), PW_OK);
  int touching = 0;
  for (pw_idx i = 0; i < d.n; i++) {
    assert_true(d.x[i] >= d.half[i]);
    touching += d.x[i] == d.half[i];
    assert_true(i == 0 || d.body[i - 1] <= d.body[i]);
  }
  assert_true(touching > 100);
  assert_true(fabs(volume(&d, true) - 0.15 * 0.15 * (4.85 / 2 + 0.15 / 3) - 125) < 1e-10);
  pw_domains_destroy(&d);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_rectangle_is_tiled_exactly),
      cmocka_unit_test(a_disc_has_its_area_and_moment),
      cmocka_unit_test(a_pile_has_its_volume),
      cmocka_unit_test(a_domain_on_the_axis_has_r_equal_to_its_half_width),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
