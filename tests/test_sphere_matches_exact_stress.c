/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Thick sphere under internal pressure, brought to rest by local damping (verification A8 d; Lame):
 * a = 1, b = 2, E = 1000, nu = 0.3, p = 1, in the r-z plane of axisymmetry:
 *   sigma_RR = A - 2 B / R^3, sigma_tt = A + B / R^3, A = p a^3 / (b^3 - a^3), B = A b^3 / 2,
 *   u_R = ((1 - 2 nu) A R + (1 + nu) B / R^2) / E,
 * so sigma_tt(a) = 0.714286, u(a) = 8.0e-4, u(b) = 3.0e-4. A quarter of the ring in polar domains,
 * 4 in a cell in each direction, with its cuts on the axis and on a plane of symmetry. The pressure
 * is a thousandth of 1, so that displacements stay small. */
#include "engine/bodies.h"
#include "engine/mesh.h"
#include "tests/engine_helpers.h"

static const double young = 1e3, poisson = 0.3, scale = 1e-3, inner = 1.0, outer = 2.0;
static const double pi = 3.14159265358979323846;

enum { NODES = 8, LOADED = 256, POINTS = 16384 };

/* Dead pressure on the inner rim: the force of each sector's exact arc, split between the two inner
 * corners of its domain, as nodal forces per radian at full pressure. */
typedef struct {
  int n;
  pw_idx node[LOADED * NODES];
  pw_real force[LOADED * NODES][2];
} inner_pressure;

/* Share of one corner: the arc from angle 0 to angle 1, p cos(angle) R (cos, sin) R. */
static void add_corner(const pw_mesh *mesh, const double *x, const double *angle, inner_pressure *c)
{
  double from = angle[0], to = angle[1], f[2];
  f[0] = 0.5 * (to - from) + 0.25 * (sin(2.0 * to) - sin(2.0 * from));
  f[1] = 0.5 * (sin(to) * sin(to) - sin(from) * sin(from));
  pw_real weight[4];
  pw_mesh_shape(mesh, x, c->node + c->n, weight);
  for (int k = 0; k < 4; k++) {
    for (int a = 0; a < 2; a++) {
      c->force[c->n + k][a] = weight[k] * f[a] * scale * inner * inner;
    }
  }
  c->n += 4;
}

static void find_load(pw_sim *sim, inner_pressure *c)
{
  pw_domains d = {.n = 0};
  int first = 0;
  assert_ok(pw_domains_create(&sim->scene, &d));
  for (double angle = 0.0; first < d.n && atan2(d.x[d.n + first], d.x[first]) > angle; first++) {
    angle = atan2(d.x[d.n + first], d.x[first]); /* angles ascend in a layer, the inner first */
  }
  assert_in_range(first, 2, LOADED);
  c->n = 0;
  for (int i = 0; i < first; i++) {
    double half = 0.25 * pi / first, middle = (2 * i + 1) * half;
    for (int side = -1; side <= 1; side += 2) {
      double x[2],
          angle[2] = {side < 0 ? middle - half : middle, side < 0 ? middle : middle + half};
      for (int a = 0; a < 2; a++) {
        x[a] = d.x[a * d.n + i] - d.half[a * d.n + i] + side * d.half[(2 + a) * d.n + i];
      }
      add_corner(&sim->mesh, x, angle, c);
    }
  }
  pw_domains_destroy(&d);
}

static pw_status load_apply(pw_sim *sim, void *ctx)
{
  const inner_pressure *c = ctx;
  pw_real *rec = pw_nodes_field(&sim->nodes, 0), ramp = fmin(1.0, sim->time / 5.0);
  for (int k = 0; k < c->n; k++) {
    for (int a = 0; a < 2; a++) {
      rec[(pw_off)c->node[k] * PW_NODE + PW_NODE_FORCE + a] += ramp * c->force[k][a];
    }
  }
  return PW_OK;
}

/* The first hook of the nodes' forces, so that damping sees it. */
static void add_load(pw_sim *sim, inner_pressure *c)
{
  pw_schedule *s = &sim->schedule;
  int at = s->start[PW_STAGE_NODE_FORCE];
  memmove(s->hook + at + 1, s->hook + at, (size_t)(s->n - at) * sizeof *s->hook);
  s->hook[at] = (pw_scheduled){
      .stage = PW_STAGE_NODE_FORCE, .fn = load_apply, .ctx = c, .effect = "inner pressure"};
  s->n++;
  for (int k = PW_STAGE_NODE_FORCE + 1; k <= PW_STAGE_COUNT; k++) {
    s->start[k]++;
  }
}

static void sphere_scene(pw_scene *s, int n)
{
  double h = 1.0 / n;
  pw_scene_default(s);
  s->geometry = PW_AXI;
  test_grid(s, (double[]){0.0, outer + 2.0 * h, 0.0, outer + 2.0 * h}, h);
  s->body[0] = (pw_scene_body){.name = "sphere",
                               .material = test_elastic(s, young, poisson, 1e3),
                               .shape = PW_SHAPE_RING,
                               .radius_m = outer,
                               .inner_radius_m = inner,
                               .angle_deg = {0.0, 90.0},
                               .point_size_m = 0.25 * h};
  s->nbody = 1;
  pw_damping_local_param *d = pw_scene_add_effect(s, "damping_local");
  d->coefficient = 0.3;
  pw_boundary_param *b = pw_scene_add_effect(s, "boundary");
  b->side = PW_SIDE_BOTTOM;
  b->fix_y = true;
}

typedef struct {
  double displacement, stress; /* relative L2 errors */
  double worst;                /* largest relative error of a radial displacement */
  double ends[3];              /* u(a), u(b), sigma_tt(a) over the pressure, means over the rims */
} lame;

/* Radial, hoop and meridional stress of point i at angle `angle`. */
static void polar(const pw_points *p, pw_idx i, double angle, double *out)
{
  double c = cos(angle), s = sin(angle);
  double xx = p->stress[i], yy = p->stress[p->ld + i], xy = p->stress[3 * p->ld + i];
  out[0] = c * c * xx + s * s * yy + 2.0 * s * c * xy;
  out[1] = p->stress[2 * p->ld + i];
  out[2] = s * s * xx + c * c * yy - 2.0 * s * c * xy;
}

static lame compare(const pw_sim *sim, const double *x0, int n)
{
  const pw_points *p = &sim->points;
  const double a = scale / 7.0, b = 4.0 * a;
  double eu = 0.0, u2 = 0.0, es = 0.0, s2 = 0.0, rim[2] = {0.0, 0.0};
  lame out = {.worst = 0.0};
  for (pw_idx i = 0; i < p->n; i++) {
    const double *x = x0 + 2 * p->id[i];
    double r = hypot(x[0], x[1]), angle = atan2(x[1], x[0]), s[3];
    double u = (x[0] * (p->x[i] - x[0]) + x[1] * (p->x[p->ld + i] - x[1])) / r;
    double exact = ((1.0 - 2.0 * poisson) * a * r + (1.0 + poisson) * b / (r * r)) / young;
    const double want[3] = {a - 2.0 * b / pow(r, 3), a + b / pow(r, 3), a + b / pow(r, 3)};
    polar(p, i, angle, s);
    eu += (u - exact) * (u - exact) * p->vol[i];
    u2 += exact * exact * p->vol[i];
    for (int k = 0; k < 3; k++) {
      es += (s[k] - want[k]) * (s[k] - want[k]) * p->vol[i];
      s2 += want[k] * want[k] * p->vol[i];
    }
    out.worst = fmax(out.worst, fabs(u / exact - 1.0));
    if (fmin(r - inner, outer - r) < 0.5 / n) { /* the outermost layers, carried to the rims */
      bool in = r < 1.5;
      double at = in ? inner : outer;
      double rim_u = ((1.0 - 2.0 * poisson) * a * at + (1.0 + poisson) * b / (at * at)) / young;
      out.ends[in ? 0 : 1] += u / exact * rim_u * p->vol[i];
      out.ends[2] += in ? s[1] / want[1] * (a + b) * p->vol[i] : 0.0;
      rim[in ? 0 : 1] += p->vol[i];
    }
  }
  out.ends[0] /= rim[0] * scale;
  out.ends[1] /= rim[1] * scale;
  out.ends[2] /= rim[0] * scale;
  out.displacement = sqrt(eu / u2);
  out.stress = sqrt(es / s2);
  return out;
}

static lame thick_sphere(int n)
{
  static pw_scene s;
  static double x0[2 * POINTS];
  static inner_pressure load;
  sphere_scene(&s, n);
  pw_sim *sim = test_sim(&s, 1);
  find_load(sim, &load);
  add_load(sim, &load);
  const pw_points *p = &sim->points;
  assert_in_range(p->n, 1, POINTS);
  for (pw_idx i = 0; i < p->n; i++) {
    x0[2 * p->id[i]] = p->x[i];
    x0[2 * p->id[i] + 1] = p->x[p->ld + i];
  }
  test_run_to(sim, 60.0);
  lame out = compare(sim, x0, n);
  pw_sim_destroy(&sim);
  return out;
}

static double rate(double coarse, double fine)
{
  return 0.5 * log2(fabs(coarse / fine)); /* over two halvings */
}

/* The rims' mean displacements converge faster than 1.5. Those of single points also differ with
 * the angle, since the grid's cells cut the rims anyhow: their norm falls with h^1.4 to h^1.5. */
static void thick_sphere_converges(void **state)
{
  (void)state;
  const double exact[3] = {8.0e-4, 3.0e-4, 5.0 / 7.0};
  lame e[3];
  for (int k = 0; k < 3; k++) {
    e[k] = thick_sphere(5 << k);
    print_message("%d cells: displacement %.2e (worst point %.2e), stress %.2e, u(a) %.4e, u(b) "
                  "%.4e, hoop stress at a %.5f\n",
                  5 << k, e[k].displacement, e[k].worst, e[k].stress, e[k].ends[0], e[k].ends[1],
                  e[k].ends[2]);
  }
  print_message("rates: displacement %.2f, stress %.2f, u(a) %.2f, u(b) %.2f\n",
                rate(e[0].displacement, e[2].displacement), rate(e[0].stress, e[2].stress),
                rate(e[0].ends[0] - exact[0], e[2].ends[0] - exact[0]),
                rate(e[0].ends[1] - exact[1], e[2].ends[1] - exact[1]));
  assert_true(e[2].worst <= 0.01);
  for (int k = 0; k < 3; k++) {
    assert_relative(e[2].ends[k], exact[k], 0.01);
  }
  for (int k = 0; k < 2; k++) {
    assert_true(rate(e[0].ends[k] - exact[k], e[2].ends[k] - exact[k]) >= 1.5);
  }
  assert_true(rate(e[0].displacement, e[2].displacement) >= 1.35);
  assert_true(rate(e[0].stress, e[2].stress) >= 0.9);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(thick_sphere_converges),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
